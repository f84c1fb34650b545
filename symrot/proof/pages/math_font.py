"""The mathematical font of pages in HTML: a subset of STIX Math, so that brackets stretch in any browser.

``font/LICENSE.txt`` has its licence, the SIL Open Font License; ``.ci/math_font.py`` builds it.
"""

from base64 import b64encode
from functools import cache
from pathlib import Path

__all__ = ["FILE", "characters", "content", "face"]

FILE = "math.woff2"
FOLDER = Path(__file__).parent / "font"


def content() -> bytes:
    """Return the font file."""
    return (FOLDER / FILE).read_bytes()


def characters() -> frozenset[str]:
    """Return the characters that the font has."""
    return frozenset(chr(int(code, 16)) for code in (FOLDER / "characters.txt").read_text("ascii").split())


@cache
def face(source: str = "") -> str:
    """Return CSS rules that show formulas in the font; ``source`` is the address of its file, or empty to embed it."""
    address = source or f"data:font/woff2;base64,{b64encode(content()).decode('ascii')}"
    return (
        f'@font-face {{ font-family: "symrot math"; src: url("{address}") format("woff2"); }}\n'
        'math { font-family: "symrot math", "STIX Two Math", "Latin Modern Math", "Cambria Math", math; }\n'
    )

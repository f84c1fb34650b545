"""The mathematical font of pages in HTML: a subset of STIX Math, so that brackets stretch in any browser."""

from base64 import b64encode
from functools import cache
from pathlib import Path

__all__ = ["FILE", "characters", "content", "face"]

# font/LICENSE.txt has its licence, the SIL Open Font License; .ci/math_font.py builds it
FILE = "math.woff2"
FOLDER = Path(__file__).parent / "font"


def content() -> bytes:
    """Return the bytes of the font file, in the format WOFF2."""
    return (FOLDER / FILE).read_bytes()


def characters() -> frozenset[str]:
    """Return the set of characters for which the font has a shape."""
    return frozenset(chr(int(code, 16)) for code in (FOLDER / "characters.txt").read_text("ascii").split())


@cache
def face(source: str = "") -> str:
    """Return CSS rules by which a browser shows formulas in the font, from the file at the address ``source``.

    If ``source`` is empty, the rules contain the font.
    """
    address = source or f"data:font/woff2;base64,{b64encode(content()).decode('ascii')}"
    return (
        f'@font-face {{ font-family: "symrot math"; src: url("{address}") format("woff2"); }}\n'
        'math { font-family: "symrot math", "STIX Two Math", "Latin Modern Math", "Cambria Math", math; }\n'
    )

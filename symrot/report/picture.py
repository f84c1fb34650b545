"""The style of all matplotlib figures, and functions that write figures to PDF, SVG or PNG files without a date.

PNG files of figures without shades get a palette of few colours, which makes them small.
"""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from symrot import __version__
from symrot.files.writing import write
from symrot.report.layout import one_line

__all__ = ["COLOURS", "GREY", "STYLE", "draw", "literal", "save_page"]

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")  # Okabe & Ito, 2008
GREY = "#606060"
STYLE = {
    "font.size": 9.0, "axes.titlesize": 10.0, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": GREY, "axes.linewidth": 0.8,
    "grid.color": "#e4e4e4", "grid.linewidth": 0.6, "lines.linewidth": 1.2, "legend.frameon": False,
    "legend.fontsize": 8.5, "svg.hashsalt": "symrot", "axes.formatter.useoffset": False,
}  # fmt: skip
UNDATED: dict[str, dict[str, Any]] = {
    ".png": {"Software": f"symrot {__version__}"},
    ".pdf": {"Creator": f"symrot {__version__}", "CreationDate": None},
    ".svg": {"Creator": f"symrot {__version__}", "Date": None},
}

PALETTE = 128  # colours: a few curves, their shades on white, greys


def literal(text: str) -> str:
    """Return text on one line, in which matplotlib sees no formula.

    Dollar signs, at which formulas begin, are escaped, and backslashes become slashes.
    """
    return one_line(text).replace("\\", "/").replace("$", r"\$")


def draw(figure: Callable[[], Any], path: Path, dpi: int = 150, few_colours: bool = True) -> None:
    """Call ``figure`` for a matplotlib Figure in symrot's style, and write it to the file ``path``.

    The other arguments are explained at :func:`save_page`.
    """
    import matplotlib

    with matplotlib.rc_context({**matplotlib.rcParamsDefault, **STYLE}):
        save_page(figure(), path, dpi, few_colours)


def save_page(page: Any, path: Path, dpi: int, few_colours: bool = True) -> None:
    """Write ``page``, a matplotlib Figure, to a file; the suffix of ``path`` decides the format.

    ``dpi`` is the number of pixels per inch; ``few_colours`` makes a PNG smaller, for a figure without shades.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    suffix = path.suffix.lower()

    def put(stream: BinaryIO) -> None:
        page.savefig(stream, format=suffix[1:], dpi=dpi, metadata=UNDATED[suffix])

    write(path, (lambda stream: _palette(page, dpi, stream)) if few_colours and suffix == ".png" else put)


def _palette(page: Any, dpi: int, stream: BinaryIO) -> None:
    """Write a figure into ``stream`` as a PNG with a palette of few colours, so that the file is small.

    This uses Pillow; matplotlib requires it anyway.
    """
    from PIL import Image
    from PIL.PngImagePlugin import PngInfo

    whole = BytesIO()
    page.savefig(whole, format="png", dpi=dpi)
    words = PngInfo()
    for name, text in UNDATED[".png"].items():
        words.add_text(name, text)
    with Image.open(whole) as picture:
        few = picture.convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
    few.save(stream, format="PNG", optimize=True, pnginfo=words, dpi=(dpi, dpi))

"""Writing of matplotlib figures to PDF, SVG or PNG files, without a date; a palette makes PNG files small."""

from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from symrot.files.writing import write
from symrot.report.plot import UNDATED

__all__ = ["save_page"]

PALETTE = 128  # colours: a few curves, their shades on white, greys


def save_page(page: Any, path: Path, dpi: int) -> None:
    """Write a matplotlib Figure to a file; the suffix of ``path`` decides the format.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    suffix = path.suffix.lower()

    def put(stream: BinaryIO) -> None:
        page.savefig(stream, format=suffix[1:], dpi=dpi, metadata=UNDATED[suffix])

    write(path, (lambda stream: _palette(page, dpi, stream)) if suffix == ".png" else put)


def _palette(page: Any, dpi: int, stream: BinaryIO) -> None:
    """Write a figure as a PNG with few colours, using Pillow, which matplotlib requires anyway."""
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

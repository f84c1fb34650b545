"""Figures of exercises for each format: an image for Markdown and Moodle, TikZ for LaTeX."""

import re
from base64 import b64encode
from collections.abc import Iterator
from xml.etree.ElementTree import Element, fromstring

from symrot.errors import InputError
from symrot.figures.picture import COLOURS

__all__ = ["image", "image_address", "tikz", "title_of"]

SVG = "{http://www.w3.org/2000/svg}"
POINTS, WIDEST = 0.75, 450.0
"""Points of paper for each unit of a drawing, and the width in points to which wider drawings are scaled."""

LETTERS = {
    "α": r"\alpha", "β": r"\beta", "θ": r"\theta", "ϕ": r"\phi", "ψ": r"\psi", "ω": r"\omega", "Ω": r"\Omega",
    "τ": r"\tau", "′": "'", "″": "''", "‴": "'''", "−": "-",
}  # fmt: skip
"""Letters in drawings -> LaTeX."""

WIDTHS = {"bar": 3.75, "thick": 1.2, "thin": 0.5}
"""Class of a line in a drawing -> its width on paper, points; other lines have 0.8 points."""


def title_of(svg: str) -> str:
    """Return the title of a drawing in SVG: words for readers who do not see it."""
    return fromstring(svg).findtext(f"{SVG}title", "")


def image(svg: str) -> bytes:
    """Return a drawing as the content of an SVG file, on white.

    A drawing inside a page follows the page's light or dark colours; a file is shown on pages of any colour.
    """
    x, y, width, height = fromstring(svg).get("viewBox", "0 0 0 0").split()
    white = f'<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="white"/>'
    light = re.sub(r"@media[^<]*", "", svg)
    return light.replace("</style>", f"</style>{white}", 1).encode()


def image_address(svg: str) -> str:
    """Return the address of a drawing for Markdown, ``data:image/svg+xml;base64,..``, which contains the drawing."""
    return f"data:image/svg+xml;base64,{b64encode(image(svg)).decode()}"


def tikz(svg: str) -> str:
    r"""Return a drawing of :class:`symrot.figures.picture.Picture` as a ``tikzpicture`` for LaTeX.

    Raises
    ------
    InputError
        If the drawing has an element other than path, text, title, desc and style.
    """
    drawing = fromstring(svg)
    width = float(drawing.get("viewBox", "0 0 1 1").split()[2])
    points = min(POINTS, WIDEST / width)
    scale = f"xscale={points:.3g},yscale=-{points:.3g}"  # in SVG, y points down
    return "\n".join(
        [rf"\begin{{tikzpicture}}[{scale},line cap=round,line join=round]", *_commands(drawing), r"\end{tikzpicture}"]
    )


def _commands(drawing: Element) -> Iterator[str]:
    for element in drawing:
        kind, has = element.tag.removeprefix(SVG), element.attrib
        if kind == "text":
            place = f"({has['x']}pt,{has['y']}pt)"
            yield rf"\node[anchor=base,inner sep=0pt] at {place} {{{_words(element)}}};"
        elif kind == "path":
            corners = has["d"].removeprefix("M").removesuffix("Z").split(" ")
            points = " -- ".join("({}pt,{}pt)".format(*corner.split(",")) for corner in corners)
            yield rf"\path[{_style(has['class'].split())}] {points}{' -- cycle' if has['d'].endswith('Z') else ''};"
        elif kind not in ("title", "desc", "style"):
            raise InputError(f"expected a drawing of paths and texts, got an element {kind!r}")


def _words(text: Element) -> str:
    """Return a label as LaTeX: letters as mathematics with their subscripts, and words upright."""
    if text.get("class") == "word":
        # the angle in "ϕ about x" is a letter among words
        return "".join(f"${LETTERS[letter]}$" if letter in LETTERS else letter for letter in text.text or "")
    parts = [_letters(text.text or "")]
    for span in text:
        inner = _letters(span.text or "")
        parts += [f"_{{{inner}}}" if span.get("dy") == "4" else inner, _letters(span.tail or "")]
    return f"${''.join(parts)}$"


def _letters(text: str) -> str:
    letters = "".join(f"{LETTERS[letter]} " if letter in LETTERS else letter for letter in text)
    return re.sub(r" (?='|$)", "", letters).replace("m g", r"m\,g")


def _style(classes: list[str]) -> str:
    """Return the options of a path in TikZ for the classes that it has in SVG."""
    colour = next(name for name in COLOURS if name in classes or f"fill-{name}" in classes)
    red, green, blue = (int(COLOURS[colour][0][n : n + 2], 16) for n in (1, 3, 5))
    rgb = f"{{rgb,255:red,{red};green,{green};blue,{blue}}}"
    if f"fill-{colour}" in classes:
        return f"fill={rgb}" + ("" if "solid" in classes else ",fill opacity=0.13")
    width = next((WIDTHS[name] for name in classes if name in WIDTHS), 0.8)
    return f"draw={rgb},line width={width:g}pt" + (",dash pattern=on 3pt off 2.6pt" if "dashed" in classes else "")

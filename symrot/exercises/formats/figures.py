"""Figures of exercises for each format: an image for Markdown and Moodle, TikZ for LaTeX."""

import re
from base64 import b64encode
from collections.abc import Iterator
from xml.etree.ElementTree import Element, fromstring

from symrot.errors import InputError

__all__ = ["image", "image_address", "tikz", "title_of"]

SVG = "{http://www.w3.org/2000/svg}"
POINTS = 0.75
"""Points of paper for each unit of a drawing."""

LETTERS = {
    "α": r"\alpha", "β": r"\beta", "θ": r"\theta", "φ": r"\phi", "ψ": r"\psi", "ω": r"\omega", "Ω": r"\Omega",
    "₁": "_1", "₂": "_2", "₃": "_3", "′": "'",
}  # fmt: skip
"""Letters in drawings -> LaTeX."""


def title_of(svg: str) -> str:
    """Return the title of a drawing in SVG: words for readers who do not see it."""
    return fromstring(svg).findtext(f"{SVG}title", "")


def image(svg: str) -> bytes:
    """Return a drawing as the content of an SVG file, black on white.

    A drawing inside a page has the colour of the page's text; a file has no such colour.
    """
    white = '<rect width="100%" height="100%" fill="white" stroke="none"/>'
    return svg.replace("currentColor", "black").replace("<title>", f"{white}<title>", 1).encode()


def image_address(svg: str) -> str:
    """Return the address of a drawing for Markdown, ``data:image/svg+xml;base64,..``, which contains the drawing."""
    return f"data:image/svg+xml;base64,{b64encode(image(svg)).decode()}"


def tikz(svg: str) -> str:
    r"""Return a drawing in SVG as a ``tikzpicture`` for LaTeX, with the TikZ library ``svg.path``.

    Raises
    ------
    InputError
        If the drawing has an element other than path, circle, text and title.
    """
    scale = f"xscale={POINTS:g},yscale=-{POINTS:g}"  # in SVG, y points down
    return "\n".join(
        [rf"\begin{{tikzpicture}}[{scale},line cap=round]", *_commands(fromstring(svg)), r"\end{tikzpicture}"]
    )


def _commands(drawing: Element) -> Iterator[str]:
    for element in drawing:
        kind, has = element.tag.removeprefix(SVG), element.attrib
        if kind == "text":
            letters = "".join(f"{LETTERS[letter]} " if letter in LETTERS else letter for letter in element.text or "")
            letters = re.sub(r" (?=_|'|$)", "", letters)
            yield rf"\node[anchor=base,inner sep=0pt] at ({has['x']}pt,{has['y']}pt) {{${letters}$}};"
        elif kind == "circle":
            yield rf"\draw[{_style(has)}] ({has['cx']}pt,{has['cy']}pt) circle[radius={has['r']}pt];"
        elif kind == "path":
            yield rf"\draw[{_style(has)}] svg {{{has['d']}}};"
        elif kind != "title":
            raise InputError(f"expected a drawing of paths, circles and texts, got an element {kind!r}")


def _style(has: dict[str, str]) -> str:
    styles = [f"line width={float(has['stroke-width']) * POINTS:g}pt"]
    if has.get("fill", "none") != "none":
        styles.append("fill=black")
    if "stroke-dasharray" in has:
        on, off = (float(length) * POINTS for length in has["stroke-dasharray"].split())
        styles.append(f"dash pattern=on {on:g}pt off {off:g}pt")
    return ",".join(styles)

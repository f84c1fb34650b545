"""Pictures as SVG, made of lines, areas, arrows, arcs and labels; they have the same bytes on every machine.

Coordinates are rounded to two decimals, nothing depends on the time or on the order of a set, and the colours are
classes of CSS that follow the reader's choice of a light or a dark page.
"""

import re
from collections.abc import Iterator
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.figures.view import Floats, Plane, Points, View

__all__ = ["COLOURS", "STYLE", "Picture"]

MARGIN = 8.0
ARROW, HALF_WIDTH = 9.0, 3.4  # length and half the width of the head of an arrow, SVG units
LETTER, LINE = 7.6, 15.0  # upper bounds of the width of a letter and of the height of a label, SVG units
NUDGE = 3.7e-5  # keeps coordinates such as 0.125 away from the border between two roundings

COLOURS = {  # name: (on a light page, on a dark page)
    "ink": ("#1f2328", "#e6e6e6"),
    "soft": ("#8a8f98", "#8f959e"),
    "blue": ("#0b62a8", "#6cb6ff"),
    "red": ("#c2410c", "#ff9a62"),
    "green": ("#15803d", "#5fd38d"),
    "violet": ("#7e22ce", "#c79bff"),
}


def _colours(number: int) -> str:
    strokes = (
        f".sf .{name}{{stroke:{pair[number]}}}.sf .fill-{name}{{fill:{pair[number]}}}" for name, pair in COLOURS.items()
    )
    return "".join(strokes) + f".sf text{{fill:{COLOURS['ink'][number]}}}"


STYLE = (
    ".sf path{fill:none;stroke-width:1.3;stroke-linejoin:round;stroke-linecap:round}"
    ".sf path.thick{stroke-width:2.2}.sf path.thin{stroke-width:.8}"
    ".sf path.dashed{stroke-dasharray:4 3.5;stroke-width:1}"
    ".sf path.area{stroke:none;fill-opacity:.13}.sf path.solid{stroke:none;fill-opacity:1}"
    ".sf text{font:italic 15px 'STIX Two Text',Georgia,'Times New Roman',serif;text-anchor:middle;stroke:none}"
    ".sf text.word{font-style:normal;font-size:13px}.sf tspan{font-size:11px}"
    f"{_colours(0)}@media (prefers-color-scheme:dark){{{_colours(1)}}}"
)
PHONE, LEAST = 358.0, 12.5  # width of a figure on a phone, and the least size of letters there, CSS pixels
BARS = ".sf path.bar{stroke-width:5}"  # for pictures with rods


def _narrow(width: float) -> str:
    """Return CSS that enlarges the letters of a picture where it is shown as narrow as on a phone.

    ``width`` is the full width of the picture, CSS pixels. The result is empty if the letters of the picture are
    legible on a phone without being enlarged.
    """
    factor = LEAST / 13.0 * width / PHONE
    if factor < 1.1:
        return ""
    sizes = zip((" text", " text.word", " tspan"), (15, 13, 11), strict=True)
    rules = "".join(f".sf.sf{width:.0f}{name}{{font-size:{_number(factor * size)}px}}" for name, size in sizes)
    # in an image the rule sees the width of the image; in a page, the width of the page
    return f".sf{{overflow:visible}}@media (max-width:{_number(0.8 * width + 62)}px){{{rules}}}"


class Picture:
    """A picture to which lines, areas, arrows and labels are added; :meth:`svg` returns it, cropped to its content."""

    def __init__(self) -> None:
        # Of all methods: points are rows in the coordinates of view; style names classes of STYLE, a colour among them.
        self._parts: list[str] = []
        self._corners: list[Floats] = []

    def curve(
        self, view: View | Plane, points: Points, style: str = "ink", visible: NDArray[np.bool_] | None = None,
        closed: bool = False, hidden: str = "dashed",
    ) -> None:  # fmt: skip
        """Draw a line through points, with the style ``hidden`` for the points at which ``visible`` is false.

        If ``closed``, the last point is joined to the first.
        """
        places = view.project(points)
        if visible is None:
            self._path(places, style, closed)
            return
        for front, run in _runs(visible):
            self._path(places[run], style if front else f"{style.split()[0]} {hidden}")

    def area(self, view: View | Plane, points: Points, style: str = "fill-blue") -> None:
        """Fill an area with a faint colour, or with the full colour if ``style`` contains ``solid``."""
        self._path(view.project(points), style if "solid" in style else f"{style} area", True)

    def arrow(
        self, view: View | Plane, start: ArrayLike, end: ArrayLike, label: str = "", style: str = "ink",
        aside: tuple[float, float] | None = None,
    ) -> None:  # fmt: skip
        """Draw an arrow with its label beyond the tip, or moved from the tip by ``aside`` (SVG units, y downward)."""
        tail, tip = view.project(np.array([start, end], dtype=float))
        length = float(np.hypot(*(tip - tail)))
        if length > 1e-9:
            self._path(np.array([tail, tip - (tip - tail) / length * min(ARROW, length) * 0.7]), style)
            self._head(tip, (tip - tail) / length, style)
        if label:
            direction = (tip - tail) / length if length > 1e-9 else np.array([0.0, -1.0])
            width = _width(label)
            beyond = direction * np.array([7 + width / 2, 12.0])
            self._text(tip + (beyond if aside is None else np.array(aside)), label)

    def arc(
        self, view: View | Plane, points: ArrayLike, label: str = "", style: str = "ink", head: bool = True,
        out: float = 11.0,
    ) -> None:  # fmt: skip
        """Draw a curve through ``points`` with an arrow head at its end if ``head``, and ``label`` beside
        its middle.
        """
        places = view.project(points)
        self._path(places, style)
        if head:
            step = places[-1] - places[-2 if len(places) < 8 else -4]
            size = float(np.hypot(*step))
            if size > 1e-9:
                self._head(places[-1], step / size, style)
        if label:
            middle = places[len(places) // 2]
            away = middle - (places[0] + places[-1]) / 2
            size = float(np.hypot(*away))
            # the outer, convex side of the curve
            direction = away / size if size > 1e-9 else np.array([0.0, -1.0])
            self._text(middle + out * direction * np.array([max(1.0, _width(label) / 16), 1.0]), label)

    def dot(self, view: View | Plane, point: ArrayLike, style: str = "ink", radius: float = 2.6) -> None:
        """Draw a point as a filled circle."""
        (centre,) = view.project(point)
        turn = np.linspace(0.0, 2 * np.pi, 17)
        self._path(centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1), f"fill-{style} solid", True)

    def label(self, view: View | Plane, point: ArrayLike, text: str, aside: tuple[float, float] = (0.0, 0.0)) -> None:
        """Write a label at a point, moved by ``aside`` (SVG units, y downward).

        A letter, with or without a subscript after ``_``, and a product such as ``m g`` are in italics; other text is
        upright.
        """
        (place,) = view.project(point)
        self._text(place + np.array(aside), text)

    def svg(self, title: str, description: str = "") -> str:
        """Return the picture as SVG text; screen readers read its title and its description, if there is one."""
        corners = np.concatenate(self._corners)
        low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
        (x, y), (width, height) = low, high - low
        box = " ".join(map(_number, (x, y, width, height)))
        size = f'width="{_number(width)}" height="{_number(height)}"'
        narrow = _narrow(width)
        # a page with several pictures has the styles of all of them: rules for one picture need a name of its own
        names = f"sf sf{width:.0f}" if narrow else "sf"
        head = f'<svg xmlns="http://www.w3.org/2000/svg" class="{names}" role="img" viewBox="{box}" {size}>'
        words = [f"<title>{escape(title)}</title>", *([f"<desc>{escape(description)}</desc>"] if description else [])]
        bars = BARS if any('bar"' in part for part in self._parts) else ""
        return "\n".join([head, *words, f"<style>{bars}{STYLE}{narrow}</style>", *self._parts, "</svg>"]) + "\n"

    def _path(self, places: Floats, style: str, closed: bool = False) -> None:
        self._corners.append(places)
        if len(places) > 2 and not closed and _is_straight(places):
            places = places[[0, -1]]
        steps: list[str] = []
        for place in places:
            step = f"{_number(place[0])},{_number(place[1])}"
            if not steps or step != steps[-1]:
                steps.append(step)
        end = "Z" if closed else ""
        self._parts.append(f'<path class="{style}" d="M{" ".join(steps)}{end}"/>')

    def _head(self, tip: Floats, direction: Floats, style: str) -> None:
        across = np.array([-direction[1], direction[0]]) * HALF_WIDTH
        back = tip - ARROW * direction
        colour = next(name for name in style.split() if name in COLOURS)
        self._path(np.array([tip, back + across, back - across]), f"fill-{colour} solid", True)

    def _text(self, place: Floats, text: str) -> None:
        half = np.array([_width(text) / 2, LINE / 2])
        self._corners.append(np.array([place - half, place + half]))
        kind = "" if _is_symbol(text) else ' class="word"'
        x, y = _number(place[0]), _number(place[1] + 4.5)
        self._parts.append(f'<text{kind} x="{x}" y="{y}">{"".join(_spans(text))}</text>')


def _is_straight(places: Floats) -> bool:
    """Return whether all points are on the line from the first to the last point, within 0.005 SVG units."""
    chord = places[-1] - places[0]
    length = float(np.hypot(*chord))
    offsets = places - places[0]
    return length > 1e-9 and bool(np.all(np.abs(offsets[:, 0] * chord[1] - offsets[:, 1] * chord[0]) < 0.005 * length))


def _number(value: float) -> str:
    text = f"{float(value) + NUDGE:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _runs(visible: NDArray[np.bool_]) -> Iterator[tuple[bool, slice]]:
    """Yield the visible and hidden sections of a line: whether the section is visible, and the slice of its points."""
    changes = np.flatnonzero(np.diff(visible.astype(int))) + 1
    bounds = [0, *changes.tolist(), len(visible)]
    for first, last in pairwise(bounds):
        # each section ends with the first point of the next, so that no gap remains
        yield bool(visible[first]), slice(first, min(last + 1, len(visible)))


SYMBOL = re.compile(r"[−]?[A-Za-zΑ-ωϕ][′″‴]?(_[\w⊥∥]+)?")


def _is_symbol(text: str) -> bool:
    return all(SYMBOL.fullmatch(factor) for factor in text.split(" "))


def _width(text: str) -> float:
    return LETTER * len(re.sub(r"[_̇]", "", text))


def _spans(text: str) -> Iterator[str]:
    """Yield the parts of a label as SVG text; letters that follow ``_`` become a subscript, as in ``ω_1``."""
    for number, piece in enumerate(re.split(r"_([\w⊥∥]+)", text)):
        if not number % 2:
            after = ' dy="-4"' if number else ""
            yield (
                f'<tspan{after} style="font-size:inherit">{escape(piece)}</tspan>' if after and piece else escape(piece)
            )
        else:
            yield f'<tspan dy="4">{escape(piece)}</tspan>'

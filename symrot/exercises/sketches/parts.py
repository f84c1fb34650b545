"""Parts of sketches: lines, arrows, arcs and letters of a :class:`symrot.figures.picture.Picture`.

A part is a function that adds lines to a picture. Coordinates are units of SVG, y downward; angles are in degrees,
clockwise on the screen from the x axis.
"""

from collections.abc import Callable
from math import atan2, cos, hypot, pi, radians, sin

import numpy as np

from symrot.figures.picture import Picture
from symrot.figures.view import Floats, Plane

__all__ = [
    "BAR", "THIN", "Part", "arc", "arrow", "box", "circle", "dashed", "dot", "drawing", "ellipse", "ground", "letter",
    "line", "rod", "shape", "span", "together", "turn",
]  # fmt: skip

Part = Callable[[Picture], None]

SHEET = Plane(1.0, scale_y=-1.0)
BAR, USUAL, THIN = "ink bar", "ink thick", "ink"
DASHED = "ink dashed"
BASELINE = 4.5  # height of the middle of a label, where Picture.label expects its position, above its baseline


def drawing(title: str, *parts: Part) -> str:
    """Return the SVG of a sketch that consists of ``parts``; screen readers read its title."""
    picture = Picture()
    together(*parts)(picture)
    return picture.svg(title)


def together(*parts: Part) -> Part:
    """Return several parts as one."""

    def draw(picture: Picture) -> None:
        for part in parts:
            part(picture)

    return draw


def curve(points: Floats, style: str, closed: bool = False) -> Part:
    """Return the line through points, shape (n, 2)."""
    return lambda picture: picture.curve(SHEET, points, style, closed=closed)


def letter(x: float, y: float, text: str) -> Part:
    """Return a letter, such as ``"ω_3"``, or several, such as ``"m g"``; (x, y) is the middle of their baseline."""
    return lambda picture: picture.label(SHEET, (x, y - BASELINE), text)


def line(x: float, y: float, to_x: float, to_y: float, width: str = USUAL) -> Part:
    """Return a straight line; ``width`` is :data:`BAR`, the usual width or :data:`THIN`."""
    return curve(np.array([(x, y), (to_x, to_y)]), width)


def dashed(x: float, y: float, to_x: float, to_y: float) -> Part:
    """Return a thin dashed line."""
    return line(x, y, to_x, to_y, DASHED)


def rod(x: float, y: float, to_x: float, to_y: float) -> Part:
    """Return a thick line for a rod."""
    return line(x, y, to_x, to_y, BAR)


def shape(*points: tuple[float, float]) -> Part:
    """Return the outline of the closed polygon through points."""
    return curve(np.array(points), USUAL, closed=True)


def arrow(x: float, y: float, to_x: float, to_y: float, width: str = USUAL) -> Part:
    """Return an arrow to the point (to_x, to_y)."""
    return lambda picture: picture.arrow(SHEET, (x, y), (to_x, to_y), "", width)


def span(x: float, y: float, to_x: float, to_y: float) -> Part:
    """Return a thin arrow with two heads that marks a length."""
    middle = (x + to_x) / 2, (y + to_y) / 2
    return together(arrow(*middle, to_x, to_y, THIN), arrow(*middle, x, y, THIN))


def around(x: float, y: float, wide: float, high: float, first: float, last: float) -> Floats:
    """Return points, shape (n, 2), of the ellipse about (x, y) with the half axes ``wide`` and ``high``.

    ``first`` and ``last`` are angles of the ellipse, degrees; there is a point at least every 5 degrees.
    """
    angles = np.radians(np.linspace(first, last, max(2, int(abs(last - first) / 5) + 2)))
    return np.stack([x + wide * np.cos(angles), y + high * np.sin(angles)], axis=1)


def arc(x: float, y: float, wide: float, high: float, first: float, last: float, style: str = USUAL) -> Part:
    """Return an arc of the ellipse about (x, y) with the half axes ``wide`` and ``high``.

    It goes from the angle ``first`` to the angle ``last``, degrees, as in :func:`around`.
    """
    return curve(around(x, y, wide, high, first, last), style)


def turn(x: float, y: float, wide: float, high: float, first: float, last: float) -> Part:
    """Return a curved arrow along an arc of an ellipse, with its head at the angle ``last``.

    The parameters are those of :func:`arc`.
    """
    end, sense = radians(last), 1 if last > first else -1
    tip = x + wide * cos(end), y + high * sin(end)
    # the head begins where the ellipse is about 8 units from the tip, so that it lies along the curve
    back = 8 / max(hypot(wide * sin(end), high * cos(end)), max(wide, high) / 3) * 180 / pi * sense
    before = x + wide * cos(radians(last - back)), y + high * sin(radians(last - back))
    direction = atan2(tip[1] - before[1], tip[0] - before[0])
    start = tip[0] - 9 * cos(direction), tip[1] - 9 * sin(direction)
    return together(arc(x, y, wide, high, first, last - back), arrow(*start, *tip))


def circle(x: float, y: float, radius: float, fill: bool = False) -> Part:
    """Return a circle, filled if ``fill``."""
    if fill:
        return lambda picture: picture.area(SHEET, around(x, y, radius, radius, 0, 360)[:-1], "fill-ink solid")
    return ellipse(x, y, radius, radius)


def dot(x: float, y: float) -> Part:
    """Return a point as a small filled circle."""
    return lambda picture: picture.dot(SHEET, (x, y), radius=4)


def ellipse(x: float, y: float, wide: float, high: float, style: str = USUAL) -> Part:
    """Return an ellipse with the half axes ``wide`` and ``high``."""
    return curve(around(x, y, wide, high, 0, 360)[:-1], style, closed=True)


def ground(x: float, to_x: float, y: float) -> Part:
    """Return a level line with hatches below it."""
    hatches = (line(k, y + 8, k + 8, y, THIN) for k in range(int(x), int(to_x) - 7, 12))
    return together(line(x, y, to_x, y), *hatches)


def box(x: float, y: float, wide: float, high: float, deep: float) -> Part:
    """Return a box in oblique projection; (x, y) is the upper left corner of its front."""
    dx, dy = 0.7 * deep, -0.45 * deep
    top = np.array([(x, y), (x + dx, y + dy), (x + wide + dx, y + dy), (x + wide, y)])
    side = np.array([(x + wide + dx, y + dy), (x + wide + dx, y + high + dy), (x + wide, y + high)])
    front = shape((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))
    return together(front, curve(top, USUAL), curve(side, USUAL))

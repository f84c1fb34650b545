"""Sketches of bodies whose moments of inertia are asked for, and of pendulums."""

from math import cos, radians, sin

from symrot.exercises.sketches.parts import (
    THIN,
    arc,
    arrow,
    box,
    circle,
    dashed,
    dot,
    drawing,
    ellipse,
    ground,
    letter,
    line,
    rod,
    shape,
    span,
    turn,
)

__all__ = [
    "book",
    "box_with_axis",
    "cone_on_apex",
    "crate_on_edge",
    "disk_on_nail",
    "hanging_rod",
    "level_rod",
    "ring_with_two_radii",
    "rod_about_end",
    "rod_beside_centre",
    "rod_with_ball",
    "set_square",
    "two_masses",
]


def hanging_rod() -> str:
    """Return an SVG drawing of a rod that hangs from an axis at its upper end, with length and centre marked."""
    return drawing(
        "A rod that hangs from an axis at its upper end",
        line(50, 22, 110, 22), rod(80, 30, 120, 170), dashed(80, 30, 80, 175),
        dot(80, 30), dot(100, 100), arc(80, 30, 60, 60, 74, 90, THIN),
        letter(66, 48, "O"), letter(117, 98, "C"), letter(132, 150, "L"), letter(91, 112, "θ"),
    )  # fmt: skip


def level_rod() -> str:
    """Return an SVG drawing of a rod that is released where it is level, with an axis at its left end."""
    return drawing(
        "A level rod with an axis at its left end, which is released",
        ground(15, 65, 62), line(40, 62, 40, 50), rod(40, 50, 210, 50), dot(40, 50), dot(125, 50),
        arrow(125, 56, 125, 110), turn(40, 50, 170, 170, 4, 26), span(40, 30, 210, 30),
        letter(24, 46, "O"), letter(125, 24, "L"), letter(144, 106, "m g"),
    )  # fmt: skip


def rod_about_end() -> str:
    """Return an SVG drawing of a rod that rotates about an axis through its end, perpendicular to the rod."""
    return drawing(
        "A rod that rotates about an axis through its end",
        dashed(50, 15, 50, 105), turn(50, 24, 18, 6, 150, -150), rod(50, 65, 220, 65), dot(50, 65), dot(135, 65),
        span(50, 88, 220, 88), letter(36, 62, "O"), letter(135, 54, "C"), letter(135, 108, "L"),
    )  # fmt: skip


def rod_beside_centre() -> str:
    """Return an SVG drawing of a rod that rotates about an axle between its centre and its end."""
    return drawing(
        "A rod that rotates about an axle away from its centre",
        dashed(90, 15, 90, 105), turn(90, 24, 18, 6, 150, -150), rod(30, 65, 220, 65), dot(90, 65), dot(125, 65),
        span(30, 88, 220, 88), letter(78, 58, "O"), letter(131, 54, "C"), letter(125, 108, "L"),
    )  # fmt: skip


def ring_with_two_radii() -> str:
    """Return an SVG drawing of the cross section of a tube or a washer, with its inner and outer radius."""
    return drawing(
        "A section across the axis, with the inner and the outer radius",
        circle(90, 85, 70), circle(90, 85, 38), dot(90, 85), arrow(90, 85, 90 + 38 * 0.8, 85 - 38 * 0.6, THIN),
        arrow(90, 85, 90 - 70 * 0.8, 85 - 70 * 0.6, THIN), letter(112, 88, "R_1"), letter(62, 46, "R_2"),
    )  # fmt: skip


def box_with_axis() -> str:
    """Return an SVG drawing of a box with its three side lengths and the axis z through its centre."""
    return drawing(
        "A box and the axis z through its centre",
        box(40, 70, 110, 90, 60), dashed(116, 10, 116, 56), arrow(116, 30, 116, 8), turn(116, 26, 20, 6, 150, -150),
        letter(132, 14, "z"), letter(95, 178, "a"), letter(182, 158, "b"), letter(205, 100, "c"),
    )  # fmt: skip


def book() -> str:
    """Return an SVG drawing of a thrown book that rotates about the axis parallel to its side of middle length."""
    return drawing(
        "A book that rotates about the axis parallel to its middle side",
        box(40, 95, 140, 26, 90), dashed(60, 140.1, 110, 108), dot(110, 108), dashed(194, 54, 248, 19.3),
        turn(230, 31, 9, 18, 130, 400), letter(140, 139, "a"), letter(224, 112, "b"), letter(28, 113, "c"),
        letter(262, 44, "Ω"),
    )  # fmt: skip


def crate_on_edge() -> str:
    """Return an SVG drawing of a crate with the sides a and b that tips about its lower edge O, seen along the edge."""
    along, up = (cos(radians(25)), -sin(radians(25))), (-sin(radians(25)), -cos(radians(25)))
    base = (90.0, 150.0)
    right = base[0] + 120 * along[0], base[1] + 120 * along[1]
    top = base[0] + 80 * up[0], base[1] + 80 * up[1]
    far = right[0] + 80 * up[0], right[1] + 80 * up[1]
    middle = (base[0] + far[0]) / 2, (base[1] + far[1]) / 2
    return drawing(
        "A crate that tips about its lower edge",
        ground(20, 235, 155), shape(base, right, far, top), dot(*base), dot(*middle), dashed(*base, *middle),
        letter(76, 146, "O"), letter(152, 142, "a"), letter(58, 108, "b"), letter(middle[0] + 14, middle[1], "C"),
    )  # fmt: skip


def disk_on_nail() -> str:
    """Return an SVG drawing of a disk that hangs from a nail at its rim and swings in its own plane."""
    return drawing(
        "A disk that hangs from a nail at its rim",
        circle(80, 90, 60), dot(80, 30), dot(80, 90), line(80, 90, 80 + 60 * 0.8, 90 + 60 * 0.6, THIN),
        letter(66, 26, "O"), letter(66, 96, "C"), letter(110, 102, "R"),
    )  # fmt: skip


def cone_on_apex() -> str:
    """Return an SVG drawing of a cone that stands on its apex, with a rotation axis through the apex.

    The rotation axis is perpendicular to the cone's axis of symmetry.
    """
    return drawing(
        "A cone and an axis through its apex, perpendicular to its own axis",
        dashed(25, 160, 195, 160), line(110, 160, 50, 45), line(110, 160, 170, 45), ellipse(110, 45, 60, 20),
        line(110, 45, 170, 45, THIN), dashed(110, 45, 110, 160), dot(110, 160), dot(110, 74),
        letter(98, 178, "O"), letter(134, 40, "R"), letter(120, 118, "h"), letter(124, 82, "C"),
    )  # fmt: skip


def rod_with_ball() -> str:
    """Return an SVG drawing of a rod that hangs from its upper end, with a ball at its lower end."""
    return drawing(
        "A rod with a ball at its lower end",
        line(45, 22, 105, 22), rod(75, 30, 75, 140), dot(75, 30), circle(75, 170, 30), dot(75, 170),
        line(75, 170, 105, 170, THIN), span(120, 30, 120, 140),
        letter(60, 44, "O"), letter(134, 90, "L"), letter(90, 186, "R"), letter(58, 96, "m_1"),
        letter(122, 184, "m_2"),
    )  # fmt: skip


def set_square() -> str:
    """Return an SVG drawing of a right triangle with its legs along x and y and the origin at the right angle."""
    return drawing(
        "A plate in the shape of a right triangle, with its legs along x and y",
        arrow(40, 150, 215, 150, THIN), arrow(40, 150, 40, 15, THIN), shape((40, 150), (170, 150), (40, 50)),
        dot(83.3, 116.7), letter(105, 170, "b"), letter(26, 104, "h"), letter(210, 142, "x"), letter(54, 24, "y"),
        letter(97, 114, "C"),
    )  # fmt: skip


def two_masses() -> str:
    """Return an SVG drawing of two small masses in the x-y plane at (a, b) and (-b, c)."""
    return drawing(
        "Two small masses in the plane of x and y",
        arrow(20, 140, 235, 140, THIN), arrow(110, 170, 110, 12, THIN),
        dashed(195, 140, 195, 80), dashed(110, 80, 195, 80), dashed(50, 140, 50, 50), dashed(110, 50, 50, 50),
        circle(195, 80, 6, True), circle(50, 50, 6, True),
        letter(212, 78, "m_1"), letter(30, 40, "m_2"), letter(152, 156, "a"), letter(78, 156, "b"),
        letter(206, 116, "b"), letter(38, 100, "c"), letter(230, 132, "x"), letter(124, 20, "y"),
    )  # fmt: skip

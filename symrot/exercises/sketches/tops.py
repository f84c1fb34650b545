"""Sketches of tops, gyroscopes, rotors and free symmetric bodies."""

from math import cos, radians, sin

from symrot.exercises.sketches.parts import (
    THIN,
    Part,
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
    shape,
    span,
    together,
    turn,
)

__all__ = [
    "axis_omega_momentum",
    "level_top",
    "person_on_turntable",
    "rotation_about_axis",
    "rotor_in_bearings",
    "satellite_with_wheel",
    "tilted_top",
    "unbalanced_rotor",
    "upright_top",
    "wheel_on_cord",
]


def _top(angle: float) -> tuple[Part, tuple[float, float], tuple[float, float]]:
    """Return a top with its tip at (100, 180), and two points: the centre of mass and the end of the axis.

    ``angle`` is the inclination of the axis from the vertical, degrees.
    """
    axis = sin(radians(angle)), -cos(radians(angle))
    side = -axis[1], axis[0]

    def point(along: float, across: float) -> tuple[float, float]:
        return 100 + along * axis[0] + across * side[0], 180 + along * axis[1] + across * side[1]

    body = shape(
        point(0, 0), point(78, 42), point(92, 42), point(104, 6), point(104, -6), point(92, -42), point(78, -42)
    )
    return together(body, line(*point(104, 0), *point(140, 0))), point(74, 0), point(140, 0)


def tilted_top() -> str:
    """Return an SVG drawing of a top that precesses, with its inclination, its weight and its centre of mass."""
    body, centre, end = _top(35)
    return drawing(
        "A top that spins about its inclined axis and precesses about the vertical",
        ground(40, 190, 182), dashed(100, 180, 100, 10), body, dot(*centre),
        arrow(*centre, centre[0], centre[1] + 52), turn(100, 24, 22, 7, 150, -150),
        turn(end[0] + 6, end[1] - 6, 16, 9, 200, -60), arc(100, 180, 48, 48, 270, 305, THIN),
        letter(84, 200, "O"), letter(centre[0] + 22, centre[1] + 54, "m g"), letter(115, 124, "θ"),
        letter(132, 18, "ϕ"), letter(end[0] + 32, end[1] - 14, "ω_3"), letter(centre[0] - 14, centre[1] - 4, "C"),
    )  # fmt: skip


def upright_top() -> str:
    """Return an SVG drawing of a top that spins upright."""
    body, centre, end = _top(0)
    return drawing(
        "A top that spins with its axis upright",
        ground(40, 160, 182), body, dot(*centre), turn(100, end[1] + 10, 20, 7, 150, -150),
        letter(84, 200, "O"), letter(132, 46, "ω_3"), span(160, 180, 160, centre[1]), letter(174, 148, "h"),
        dashed(centre[0], centre[1], 164, centre[1]),
    )  # fmt: skip


def level_top() -> str:
    """Return an SVG drawing of a top on a stand whose axis is level, with its weight and its precession."""
    return drawing(
        "A top whose axis is level and precesses about the vertical",
        ground(30, 110, 172), line(70, 172, 70, 80), dashed(70, 80, 70, 15), dot(70, 80), line(70, 80, 215, 80),
        shape((150, 38), (164, 38), (164, 122), (150, 122)), dot(157, 80), arrow(157, 80, 157, 160),
        turn(70, 28, 22, 7, 150, -150), turn(200, 80, 8, 24, 140, -140), span(70, 140, 157, 140),
        letter(54, 84, "O"), letter(112, 134, "h"), letter(176, 158, "m g"), letter(102, 24, "ϕ"),
        letter(222, 64, "ω_3"),
    )  # fmt: skip


def wheel_on_cord() -> str:
    """Return an SVG drawing of a spinning wheel whose level axle hangs from a cord at one end."""
    return drawing(
        "A wheel on a level axle that hangs from a cord",
        line(40, 20, 120, 20), line(80, 20, 80, 110), line(80, 110, 190, 110), dot(80, 110),
        ellipse(160, 110, 14, 58), dot(160, 110), turn(80, 60, 24, 7, 150, -150), turn(190, 110, 8, 22, 140, -140),
        span(80, 184, 160, 184), arrow(160, 110, 160, 172), letter(120, 178, "a"), letter(116, 58, "Ω"),
        letter(214, 100, "ω_3"), letter(180, 168, "m g"),
    )  # fmt: skip


def rotor_in_bearings() -> str:
    """Return an SVG drawing of a rotor between two bearings, in a frame that rotates about the vertical."""
    return drawing(
        "A rotor between two bearings in a frame that rotates",
        line(40, 95, 230, 95), shape((125, 50), (145, 50), (145, 140), (125, 140)),
        shape((50, 103), (66, 103), (58, 95)), shape((204, 103), (220, 103), (212, 95)),
        ground(40, 76, 103), ground(194, 230, 103), turn(235, 95, 8, 22, 140, -140), dashed(135, 50, 135, 10),
        turn(135, 22, 22, 7, 150, -150), span(58, 160, 212, 160), letter(135, 180, "L"), letter(168, 20, "Ω"),
        letter(256, 84, "ω_3"),
    )  # fmt: skip


def unbalanced_rotor() -> str:
    """Return an SVG drawing of a shaft in two bearings with two masses on opposite sides."""
    return drawing(
        "A shaft in two bearings that is not balanced",
        arrow(30, 80, 262, 80), ground(40, 76, 92), ground(184, 220, 92), circle(58, 86, 5), circle(202, 86, 5),
        line(100, 80, 100, 38), line(160, 80, 160, 122), circle(100, 30, 8, True),
        circle(160, 130, 8, True), turn(238, 80, 8, 22, 140, -140), letter(260, 70, "z"),
        letter(236, 120, "Ω"),
    )  # fmt: skip


def satellite_with_wheel() -> str:
    """Return an SVG drawing of a satellite and its reaction wheel, which rotate in opposite directions."""
    return drawing(
        "A satellite with a reaction wheel",
        box(75, 60, 90, 90, 50), line(20, 95, 75, 95), line(190, 95, 245, 95), ellipse(120, 105, 30, 11),
        dashed(120, 160, 120, 14), turn(120, 94, 34, 12, 20, 160), turn(120, 24, 22, 7, 150, -150),
        letter(150, 142, "ω_3"), letter(106, 84, "C"), letter(150, 20, "Ω"), letter(176, 164, "A"),
    )  # fmt: skip


def person_on_turntable() -> str:
    """Return an SVG drawing of a person on a turntable who holds a spinning wheel with a vertical axis."""
    return drawing(
        "A person on a turntable who holds a spinning wheel",
        ellipse(100, 185, 60, 12), circle(100, 40, 14), line(100, 54, 100, 120), line(100, 120, 82, 180),
        line(100, 120, 118, 180), line(100, 74, 170, 96), line(170, 120, 170, 70), ellipse(170, 92, 42, 11),
        turn(170, 76, 26, 8, 150, -150), turn(100, 185, 74, 16, 20, 70), letter(212, 70, "ω_3"),
        letter(222, 100, "C"),
    )  # fmt: skip


def axis_omega_momentum() -> str:
    """Return an SVG drawing of a free symmetric body with its axis, angular velocity and angular momentum."""
    return drawing(
        "The axis of a symmetric body, its angular velocity and its angular momentum",
        arrow(90, 190, 90, 15), arrow(90, 190, 136, 32), arrow(90, 190, 196, 74),
        arc(90, 190, 70, 70, 270, 312.4, THIN),
        arc(90, 190, 110, 110, 286.2, 312.4, THIN), shape((172, 124), (202, 90), (166, 59), (136, 93)),
        letter(76, 26, "H"), letter(146, 28, "ω"), letter(208, 70, "3"), letter(147, 82, "β"),
        letter(104, 138, "θ"),
    )  # fmt: skip


def rotation_about_axis() -> str:
    """Return an SVG drawing of a point that is rotated by an angle about an inclined axis."""
    return drawing(
        "A point that is rotated about an axis",
        arrow(110, 195, 110, 12), ellipse(110, 80, 75, 24, "ink dashed"), dot(172, 93.5), dot(110, 104),
        arrow(110, 195, 172, 97), arrow(110, 195, 110, 108), line(110, 80, 172, 93.5, THIN),
        line(110, 80, 110, 104, THIN),
        turn(110, 80, 46, 15, 84, 40), letter(96, 22, "n"), letter(132, 112, "α"), letter(190, 98, "r′"),
        letter(98, 122, "r"),
    )  # fmt: skip

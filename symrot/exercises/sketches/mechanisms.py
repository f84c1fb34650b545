"""Sketches of struck and rolling bodies, gears and linkages."""

from math import cos, radians, sin

from symrot.exercises.sketches.parts import (
    BAR,
    THIN,
    arc,
    arrow,
    circle,
    dashed,
    dot,
    drawing,
    ground,
    letter,
    line,
    rod,
    shape,
    span,
    turn,
)

__all__ = [
    "ball_and_cue",
    "bat",
    "bullet_and_rod",
    "crank_and_slider",
    "ladder",
    "planetary_gear",
    "roller_on_incline",
    "rolling_wheel",
    "scotch_yoke",
    "struck_rod",
]


def struck_rod() -> str:
    """Return an SVG drawing of a free rod that is struck at a distance from its centre."""
    return drawing(
        "A free rod that is struck away from its centre",
        rod(30, 70, 240, 70), dot(135, 70), arrow(195, 138, 195, 78), span(135, 94, 195, 94),
        span(30, 44, 240, 44),
        letter(135, 62, "C"), letter(165, 112, "d"), letter(135, 38, "L"), letter(210, 132, "J"),
    )  # fmt: skip


def bullet_and_rod() -> str:
    """Return an SVG drawing of a hanging rod and a bullet that flies towards its lower end."""
    return drawing(
        "A hanging rod and a bullet that flies towards its lower end",
        line(130, 22, 190, 22), rod(160, 30, 160, 175), dot(160, 30), circle(40, 172, 5, True),
        arrow(50, 172, 110, 172), letter(146, 44, "O"), letter(176, 106, "L"), letter(142, 106, "m_1"),
        letter(40, 160, "m_2"), letter(82, 162, "v"),
    )  # fmt: skip


def bat() -> str:
    """Return an SVG drawing of a bat that is held at one end and hit at its sweet spot."""
    return drawing(
        "A bat that is held at one end and hit beside its other end",
        rod(40, 60, 240, 60), circle(40, 60, 9), dot(140, 60), arrow(173.3, 130, 173.3, 68), span(40, 36, 240, 36),
        letter(22, 64, "O"), letter(140, 84, "C"), letter(140, 30, "L"), letter(188, 126, "J"),
    )  # fmt: skip


def roller_on_incline() -> str:
    """Return an SVG drawing of a round body that rolls down an incline, with the height and the angle."""
    slope = radians(25)
    foot, head = (220.0, 160.0), (220 - 200 * cos(slope), 160 - 200 * sin(slope))
    contact = foot[0] - 140 * cos(slope), foot[1] - 140 * sin(slope)
    centre = contact[0] + 30 * sin(slope), contact[1] - 30 * cos(slope)
    return drawing(
        "A round body that rolls down an incline",
        shape(foot, head, (head[0], foot[1])), circle(*centre, 30), dot(*centre), line(*centre, *contact, THIN),
        turn(*centre, 40, 40, -100, -20), arc(*foot, 52, 52, 180, 205, THIN),
        span(head[0] - 14, foot[1], head[0] - 14, head[1]), letter(head[0] - 26, 124, "h"),
        letter(156, 154, "α"), letter(centre[0] - 12, centre[1] + 16, "R"),
    )  # fmt: skip


def rolling_wheel() -> str:
    """Return an SVG drawing of a wheel that rolls on level ground, with its rate and the speed of its centre."""
    return drawing(
        "A wheel that rolls on level ground",
        ground(20, 210, 145), circle(100, 85, 60), dot(100, 85), arrow(100, 85, 165, 85),
        line(100, 85, 100, 145, THIN),
        turn(100, 85, 38, 38, -150, -70), letter(178, 90, "v"), letter(112, 124, "R"), letter(88, 70, "ω"),
    )  # fmt: skip


def ball_and_cue() -> str:
    """Return an SVG drawing of a billiard ball that a cue hits at a height above the table."""
    return drawing(
        "A billiard ball that a cue hits above its centre",
        ground(20, 240, 145), circle(150, 85, 60), dot(150, 85), line(150, 85, 210, 85, THIN),
        arrow(20, 61, 95, 61), span(70, 145, 70, 61), letter(56, 108, "h"), letter(180, 80, "R"),
        letter(38, 50, "J"),
    )  # fmt: skip


def planetary_gear() -> str:
    """Return an SVG drawing of a planetary train: sun, three planets on a carrier, and ring."""
    places = [(120 + 57 * cos(radians(k)), 110 + 57 * sin(radians(k))) for k in (-90, 30, 150)]
    return drawing(
        "A planetary gear train with sun, planets, carrier and ring",
        circle(120, 110, 88), circle(120, 110, 98), circle(120, 110, 26),
        *(circle(x, y, 31) for x, y in places), *(rod(120, 110, x, y) for x, y in places),
        *(dot(x, y) for x, y in places), dot(120, 110), letter(120, 131, "S"), letter(136, 62, "P"),
        letter(210, 200, "R"), letter(106, 64, "C"),
    )  # fmt: skip


def crank_and_slider() -> str:
    """Return an SVG drawing of a crank, a connecting rod and a piston on a line through the crank's axis."""
    return drawing(
        "A crank, a connecting rod and a piston",
        dashed(10, 90, 290, 90), line(60, 90, 95, 38, BAR), line(95, 38, 225, 90, BAR),
        shape((225, 72), (271, 72), (271, 108), (225, 108)), arc(60, 90, 24, 24, 0, -56, THIN),
        arc(225, 90, 60, 60, 180, 201.8, THIN), circle(60, 90, 5, True), dot(95, 38), dot(225, 90),
        letter(68, 56, "r"), letter(168, 54, "L"), letter(96, 82, "ϕ"), letter(152, 86, "ψ"),
    )  # fmt: skip


def scotch_yoke() -> str:
    """Return an SVG drawing of a crank whose pin slides in the slot of a yoke."""
    return drawing(
        "A crank whose pin slides in the slot of a yoke",
        dashed(10, 80, 110, 80), circle(80, 80, 5, True), line(80, 80, 118, 42, BAR), dot(118, 42),
        shape((110, 20), (126, 20), (126, 140), (110, 140)), line(126, 80, 250, 80, BAR), arrow(200, 62, 240, 62),
        arc(80, 80, 24, 24, 0, -45, THIN), turn(80, 80, 54, 54, 220, 160), letter(88, 56, "r"),
        letter(100, 96, "ϕ"),
        letter(20, 52, "Ω"), letter(256, 66, "x"),
    )  # fmt: skip


def ladder() -> str:
    """Return an SVG drawing of a ladder that leans on a wall while its foot slides away."""
    return drawing(
        "A ladder that leans on a wall and slides",
        line(40, 10, 40, 155), ground(40, 220, 155), rod(40, 35, 150, 155), dot(150, 155),
        arrow(158, 145, 205, 145),
        arc(150, 155, 34, 34, 180, 227.5, THIN), letter(108, 92, "L"), letter(106, 146, "θ"),
        letter(186, 136, "v"),
    )  # fmt: skip

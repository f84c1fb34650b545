"""Line drawings for exercises, as SVG in the colour of the text and with a title for screen readers.

A drawing shows the arrangement and the letters of an exercise, not its numbers.
"""

from collections.abc import Callable
from math import atan2, cos, degrees, hypot, pi, radians, sin

__all__ = ["SKETCHES", "sketch"]

THICK, USUAL, THIN = "5", "2", "1"
DASHES = ' stroke-dasharray="3 5"'


def _drawing(title: str, width: int, height: int, *parts: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        f'role="img" fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round">'
        f"<title>{title}</title>{''.join(parts)}</svg>"
    )


def _letter(x: float, y: float, text: str) -> str:
    style = 'font-family="serif" font-style="italic" font-size="16" fill="currentColor" stroke="none"'
    return f'<text x="{_number(x)}" y="{_number(y)}" {style} text-anchor="middle">{text}</text>'


def _number(value: float) -> str:
    """Return a coordinate with one digit after the point, so that the text is the same on every machine."""
    return f"{round(value, 1) + 0:g}"


def _path(points: str, width: str = USUAL, more: str = "") -> str:
    return f'<path d="{points}" stroke-width="{width}"{more}/>'


def _line(x: float, y: float, to_x: float, to_y: float, width: str = USUAL, more: str = "") -> str:
    return _path(f"M{_number(x)} {_number(y)} L{_number(to_x)} {_number(to_y)}", width, more)


def _dashed(x: float, y: float, to_x: float, to_y: float) -> str:
    return _line(x, y, to_x, to_y, THIN, DASHES)


def _shape(*points: tuple[float, float], width: str = USUAL, fill: str = "none") -> str:
    """Return the closed polygon through the points."""
    corners = " L".join(f"{_number(x)} {_number(y)}" for x, y in points)
    return _path(f"M{corners} Z", width, f' fill="{fill}"' if fill != "none" else "")


def _head(x: float, y: float, angle: float) -> str:
    """Return the head of an arrow with its tip at (x, y).

    ``angle`` is the arrow's direction in degrees: 0 points right, 90 down.
    """
    sides = [(x - 9 * cos(radians(angle + k)), y - 9 * sin(radians(angle + k))) for k in (20, -20)]
    return _shape((x, y), *sides, width=THIN, fill="currentColor")


def _arrow(x: float, y: float, to_x: float, to_y: float, width: str = USUAL) -> str:
    length = hypot(to_x - x, to_y - y)
    short = max(length - 6, 0) / length
    line = _line(x, y, x + short * (to_x - x), y + short * (to_y - y), width)
    return line + _head(to_x, to_y, degrees(atan2(to_y - y, to_x - x)))


def _span(x: float, y: float, to_x: float, to_y: float) -> str:
    """Return a thin arrow with two heads that marks a length."""
    angle = degrees(atan2(to_y - y, to_x - x))
    return _line(x, y, to_x, to_y, THIN) + _head(to_x, to_y, angle) + _head(x, y, angle + 180)


def _arc(
    x: float, y: float, wide: float, high: float, first: float, last: float, more: str = "", width: str = USUAL
) -> str:
    """Return a part of the ellipse about (x, y) with the half axes ``wide`` and ``high``.

    ``first`` and ``last`` are angles of the ellipse in degrees, clockwise on the screen from the x axis.
    """
    start, end = ((x + wide * cos(radians(k)), y + high * sin(radians(k))) for k in (first, last))
    flags = f"{int(abs(last - first) > 180)} {int(last > first)}"
    points = f"M{_number(start[0])} {_number(start[1])} A{_number(wide)} {_number(high)} 0 {flags} "
    return _path(f"{points}{_number(end[0])} {_number(end[1])}", width, more)


def _turn(x: float, y: float, wide: float, high: float, first: float, last: float) -> str:
    """Return a curved arrow along an ellipse; the parameters are explained at :func:`_arc`."""
    end = radians(last)
    sense = 1 if last > first else -1
    angle = degrees(atan2(sense * high * cos(end), -sense * wide * sin(end)))
    back = 5 / max(wide, high) * 180 / pi * sense
    tip = _head(x + wide * cos(end), y + high * sin(end), angle - 0.6 * back)
    return _arc(x, y, wide, high, first, last - back) + tip


def _circle(x: float, y: float, radius: float, fill: str = "none", width: str = USUAL) -> str:
    return f'<circle cx="{_number(x)}" cy="{_number(y)}" r="{_number(radius)}" fill="{fill}" stroke-width="{width}"/>'


def _dot(x: float, y: float) -> str:
    return _circle(x, y, 4, "currentColor")


def _ellipse(x: float, y: float, wide: float, high: float, more: str = "") -> str:
    return "".join(_arc(x, y, wide, high, first, first + 90, more) for first in (0, 90, 180, 270))


def _ground(x: float, to_x: float, y: float) -> str:
    hatches = (_line(k, y + 8, k + 8, y, THIN) for k in range(int(x), int(to_x) - 7, 12))
    return _line(x, y, to_x, y) + "".join(hatches)


def _rod(x: float, y: float, to_x: float, to_y: float) -> str:
    return _line(x, y, to_x, to_y, THICK)


def hanging_rod() -> str:
    """Return an SVG drawing of a rod that hangs from an axis at its upper end, with length and centre marked."""
    return _drawing(
        "A rod that hangs from an axis at its upper end", 160, 200,
        _line(50, 22, 110, 22), _rod(80, 30, 120, 170), _dashed(80, 30, 80, 175),
        _dot(80, 30), _dot(100, 100), _arc(80, 30, 60, 60, 74, 90, width=THIN),
        _letter(66, 48, "O"), _letter(117, 98, "C"), _letter(132, 150, "L"), _letter(91, 112, "θ"),
    )  # fmt: skip


def level_rod() -> str:
    """Return an SVG drawing of a rod that is released where it is level, with an axis at its left end."""
    return _drawing(
        "A level rod with an axis at its left end, which is released", 250, 150,
        _ground(15, 65, 62), _line(40, 62, 40, 50), _rod(40, 50, 210, 50), _dot(40, 50), _dot(125, 50),
        _arrow(125, 56, 125, 110), _turn(40, 50, 170, 170, 4, 26), _span(40, 30, 210, 30),
        _letter(24, 46, "O"), _letter(125, 24, "L"), _letter(144, 106, "m g"),
    )  # fmt: skip


def rod_about_end() -> str:
    """Return an SVG drawing of a rod that rotates about an axis through its end, perpendicular to the rod."""
    return _drawing(
        "A rod that rotates about an axis through its end", 250, 120,
        _dashed(50, 15, 50, 105), _turn(50, 24, 18, 6, 150, -150), _rod(50, 65, 220, 65), _dot(50, 65), _dot(135, 65),
        _span(50, 88, 220, 88), _letter(36, 62, "O"), _letter(135, 54, "C"), _letter(135, 108, "L"),
    )  # fmt: skip


def rod_beside_centre() -> str:
    """Return an SVG drawing of a rod that rotates about an axle between its centre and its end."""
    return _drawing(
        "A rod that rotates about an axle beside its centre", 250, 120,
        _dashed(90, 15, 90, 105), _turn(90, 24, 18, 6, 150, -150), _rod(30, 65, 220, 65), _dot(90, 65), _dot(125, 65),
        _span(30, 88, 220, 88), _letter(78, 58, "O"), _letter(131, 54, "C"), _letter(125, 108, "L"),
    )  # fmt: skip


def ring_with_two_radii() -> str:
    """Return an SVG drawing of the cross section of a tube or a washer, with its inner and outer radius."""
    return _drawing(
        "A section across the axis, with the inner and the outer radius", 180, 170,
        _circle(90, 85, 70), _circle(90, 85, 38), _dot(90, 85), _arrow(90, 85, 90 + 38 * 0.8, 85 - 38 * 0.6, THIN),
        _arrow(90, 85, 90 - 70 * 0.8, 85 - 70 * 0.6, THIN), _letter(112, 88, "R₁"), _letter(48, 72, "R₂"),
    )  # fmt: skip


def _box(x: float, y: float, wide: float, high: float, deep: float) -> str:
    """Return a box in perspective; (x, y) is the upper left corner of its front."""
    dx, dy = 0.7 * deep, -0.45 * deep
    return (
        _shape((x, y), (x + wide, y), (x + wide, y + high), (x, y + high))
        + _path(f"M{_number(x)} {_number(y)} L{_number(x + dx)} {_number(y + dy)} L{_number(x + wide + dx)} "
                f"{_number(y + dy)} L{_number(x + wide)} {_number(y)}")
        + _path(f"M{_number(x + wide + dx)} {_number(y + dy)} L{_number(x + wide + dx)} {_number(y + high + dy)} "
                f"L{_number(x + wide)} {_number(y + high)}")
    )  # fmt: skip


def box_with_axis() -> str:
    """Return an SVG drawing of a box with its three side lengths and the axis z through its centre."""
    return _drawing(
        "A box and the axis z through its centre", 240, 200,
        _box(40, 70, 110, 90, 60), _dashed(116, 10, 116, 56), _arrow(116, 30, 116, 8), _turn(116, 26, 20, 6, 150, -150),
        _letter(132, 14, "z"), _letter(95, 178, "a"), _letter(182, 158, "b"), _letter(205, 100, "c"),
    )  # fmt: skip


def book() -> str:
    """Return an SVG drawing of a thrown book that rotates about the axis parallel to its side of middle length."""
    return _drawing(
        "A book that rotates about the axis parallel to its middle side", 280, 165,
        _box(40, 95, 140, 26, 90), _dashed(60, 140.1, 110, 108), _dot(110, 108), _dashed(194, 54, 248, 19.3),
        _turn(230, 31, 9, 18, 130, 400), _letter(140, 139, "a"), _letter(224, 112, "b"), _letter(28, 113, "c"),
        _letter(262, 44, "Ω"),
    )  # fmt: skip


def crate_on_edge() -> str:
    """Return an SVG drawing of a crate with the sides a and b that tips about its lower edge O, seen along the edge."""
    along, up = (cos(radians(25)), -sin(radians(25))), (-sin(radians(25)), -cos(radians(25)))
    base = (90.0, 150.0)
    right = base[0] + 120 * along[0], base[1] + 120 * along[1]
    top = base[0] + 80 * up[0], base[1] + 80 * up[1]
    far = right[0] + 80 * up[0], right[1] + 80 * up[1]
    middle = (base[0] + far[0]) / 2, (base[1] + far[1]) / 2
    return _drawing(
        "A crate that tips about its lower edge", 250, 180,
        _ground(20, 235, 155), _shape(base, right, far, top), _dot(*base), _dot(*middle), _dashed(*base, *middle),
        _letter(76, 146, "O"), _letter(152, 142, "a"), _letter(58, 108, "b"), _letter(middle[0] + 14, middle[1], "C"),
    )  # fmt: skip


def disk_on_nail() -> str:
    """Return an SVG drawing of a disk that hangs from a nail at its rim and swings in its own plane."""
    return _drawing(
        "A disk that hangs from a nail at its rim", 160, 170,
        _circle(80, 90, 60), _dot(80, 30), _dot(80, 90), _line(80, 90, 80 + 60 * 0.8, 90 + 60 * 0.6, THIN),
        _letter(66, 26, "O"), _letter(66, 96, "C"), _letter(110, 102, "R"),
    )  # fmt: skip


def cone_on_apex() -> str:
    """Return an SVG drawing of a cone that stands on its apex, with a rotation axis through the apex.

    The rotation axis is perpendicular to the cone's axis of symmetry.
    """
    return _drawing(
        "A cone and an axis through its apex, perpendicular to its own axis", 220, 190,
        _dashed(25, 160, 195, 160), _path("M110 160 L50 45 M110 160 L170 45"), _ellipse(110, 45, 60, 15),
        _line(110, 45, 170, 45, THIN), _dashed(110, 45, 110, 160), _dot(110, 160), _dot(110, 74),
        _letter(98, 178, "O"), _letter(134, 40, "R"), _letter(120, 118, "h"), _letter(124, 82, "C"),
    )  # fmt: skip


def rod_with_ball() -> str:
    """Return an SVG drawing of a rod that hangs from its upper end, with a ball at its lower end."""
    return _drawing(
        "A rod with a ball at its lower end", 170, 220,
        _line(45, 22, 105, 22), _rod(75, 30, 75, 140), _dot(75, 30), _circle(75, 170, 30), _dot(75, 170),
        _line(75, 170, 105, 170, THIN), _span(120, 30, 120, 140),
        _letter(60, 44, "O"), _letter(134, 90, "L"), _letter(90, 186, "R"), _letter(58, 96, "m₁"),
        _letter(122, 184, "m₂"),
    )  # fmt: skip


def set_square() -> str:
    """Return an SVG drawing of a right triangle with its legs along x and y and the origin at the right angle."""
    return _drawing(
        "A plate in the shape of a right triangle, with its legs along x and y", 230, 180,
        _arrow(40, 150, 215, 150, THIN), _arrow(40, 150, 40, 15, THIN), _shape((40, 150), (170, 150), (40, 50)),
        _dot(83.3, 116.7), _letter(105, 170, "b"), _letter(26, 104, "h"), _letter(210, 142, "x"), _letter(54, 24, "y"),
        _letter(97, 114, "C"),
    )  # fmt: skip


def two_masses() -> str:
    """Return an SVG drawing of two small masses in the x-y plane at (a, b) and (-b, c)."""
    return _drawing(
        "Two small masses in the plane of x and y", 250, 180,
        _arrow(20, 140, 235, 140, THIN), _arrow(110, 170, 110, 12, THIN),
        _dashed(195, 140, 195, 80), _dashed(110, 80, 195, 80), _dashed(50, 140, 50, 50), _dashed(110, 50, 50, 50),
        _circle(195, 80, 6, "currentColor"), _circle(50, 50, 6, "currentColor"),
        _letter(212, 78, "m₁"), _letter(36, 46, "m₂"), _letter(152, 156, "a"), _letter(78, 156, "b"),
        _letter(206, 116, "b"), _letter(38, 100, "c"), _letter(230, 132, "x"), _letter(124, 20, "y"),
    )  # fmt: skip


def _top(angle: float) -> tuple[str, tuple[float, float], tuple[float, float]]:
    """Return the SVG of a top with its tip at (100, 180), and two points: the centre of mass and the end of the axis.

    ``angle`` is the inclination of the axis from the vertical, degrees.
    """
    axis = sin(radians(angle)), -cos(radians(angle))
    side = -axis[1], axis[0]

    def point(along: float, across: float) -> tuple[float, float]:
        return 100 + along * axis[0] + across * side[0], 180 + along * axis[1] + across * side[1]

    body = _shape(
        point(0, 0), point(78, 42), point(92, 42), point(104, 6), point(104, -6), point(92, -42), point(78, -42)
    )
    return body + _line(*point(104, 0), *point(140, 0)), point(74, 0), point(140, 0)


def tilted_top() -> str:
    """Return an SVG drawing of a top that precesses, with its inclination, its weight and its centre of mass."""
    body, centre, end = _top(35)
    return _drawing(
        "A top that spins about its inclined axis and precesses about the vertical", 260, 215,
        _ground(40, 190, 182), _dashed(100, 180, 100, 10), body, _dot(*centre),
        _arrow(*centre, centre[0], centre[1] + 52), _turn(100, 24, 22, 7, 150, -150),
        _turn(end[0] + 6, end[1] - 6, 16, 9, 200, -60), _arc(100, 180, 48, 48, 270, 305, width=THIN),
        _letter(84, 200, "O"), _letter(centre[0] + 22, centre[1] + 54, "m g"), _letter(115, 124, "θ"),
        _letter(132, 18, "φ"), _letter(end[0] + 32, end[1] - 14, "ω₃"), _letter(centre[0] - 14, centre[1] - 4, "C"),
    )  # fmt: skip


def upright_top() -> str:
    """Return an SVG drawing of a top that spins upright."""
    body, centre, end = _top(0)
    return _drawing(
        "A top that spins with its axis upright", 200, 215,
        _ground(40, 160, 182), body, _dot(*centre), _turn(100, end[1] + 10, 20, 7, 150, -150),
        _letter(84, 200, "O"), _letter(132, 46, "ω₃"), _span(160, 180, 160, centre[1]), _letter(174, 148, "h"),
        _dashed(centre[0], centre[1], 164, centre[1]),
    )  # fmt: skip


def level_top() -> str:
    """Return an SVG drawing of a top on a stand whose axis is level, with its weight and its precession."""
    return _drawing(
        "A top whose axis is level and precesses about the vertical", 260, 190,
        _ground(30, 110, 172), _line(70, 172, 70, 80), _dashed(70, 80, 70, 15), _dot(70, 80), _line(70, 80, 215, 80),
        _shape((150, 38), (164, 38), (164, 122), (150, 122)), _dot(157, 80), _arrow(157, 80, 157, 160),
        _turn(70, 28, 22, 7, 150, -150), _turn(200, 80, 8, 24, 140, -140), _span(70, 140, 157, 140),
        _letter(54, 84, "O"), _letter(112, 134, "h"), _letter(176, 158, "m g"), _letter(102, 24, "φ"),
        _letter(222, 64, "ω₃"),
    )  # fmt: skip


def wheel_on_cord() -> str:
    """Return an SVG drawing of a spinning wheel whose level axle hangs from a cord at one end."""
    return _drawing(
        "A wheel on a level axle that hangs from a cord", 250, 200,
        _line(40, 20, 120, 20), _line(80, 20, 80, 110), _line(80, 110, 190, 110), _dot(80, 110),
        _ellipse(160, 110, 14, 58), _dot(160, 110), _turn(80, 60, 24, 7, 150, -150), _turn(190, 110, 8, 22, 140, -140),
        _span(80, 184, 160, 184), _arrow(160, 110, 160, 172), _letter(120, 178, "a"), _letter(116, 58, "Ω"),
        _letter(214, 100, "ω₃"), _letter(180, 168, "m g"),
    )  # fmt: skip


def rotor_in_bearings() -> str:
    """Return an SVG drawing of a rotor between two bearings, in a frame that rotates about the vertical."""
    return _drawing(
        "A rotor between two bearings in a frame that rotates", 270, 190,
        _line(40, 95, 230, 95), _shape((125, 50), (145, 50), (145, 140), (125, 140)),
        _shape((50, 103), (66, 103), (58, 95), width=USUAL), _shape((204, 103), (220, 103), (212, 95), width=USUAL),
        _ground(40, 76, 103), _ground(194, 230, 103), _turn(235, 95, 8, 22, 140, -140), _dashed(135, 50, 135, 10),
        _turn(135, 22, 22, 7, 150, -150), _span(58, 160, 212, 160), _letter(135, 180, "L"), _letter(168, 20, "Ω"),
        _letter(256, 84, "ω₃"),
    )  # fmt: skip


def unbalanced_rotor() -> str:
    """Return an SVG drawing of a shaft in two bearings with two masses on opposite sides."""
    return _drawing(
        "A shaft in two bearings that is not balanced", 270, 160,
        _arrow(30, 80, 262, 80), _ground(40, 76, 92), _ground(184, 220, 92), _circle(58, 86, 5), _circle(202, 86, 5),
        _line(100, 80, 100, 38), _line(160, 80, 160, 122), _circle(100, 30, 8, "currentColor"),
        _circle(160, 130, 8, "currentColor"), _turn(238, 80, 8, 22, 140, -140), _letter(260, 70, "z"),
        _letter(236, 120, "Ω"),
    )  # fmt: skip


def satellite_with_wheel() -> str:
    """Return an SVG drawing of a satellite and its reaction wheel, which rotate in opposite directions."""
    return _drawing(
        "A satellite with a reaction wheel", 260, 190,
        _box(75, 60, 90, 90, 50), _line(20, 95, 75, 95), _line(190, 95, 245, 95), _ellipse(120, 105, 30, 11),
        _dashed(120, 160, 120, 14), _turn(120, 94, 34, 12, 20, 160), _turn(120, 24, 22, 7, 150, -150),
        _letter(150, 142, "ω₃"), _letter(106, 84, "C"), _letter(150, 20, "Ω"), _letter(176, 164, "A"),
    )  # fmt: skip


def person_on_turntable() -> str:
    """Return an SVG drawing of a person on a turntable who holds a spinning wheel with a vertical axis."""
    return _drawing(
        "A person on a turntable who holds a spinning wheel", 240, 210,
        _ellipse(100, 185, 60, 12), _circle(100, 40, 14), _line(100, 54, 100, 120), _line(100, 120, 82, 180),
        _line(100, 120, 118, 180), _line(100, 74, 170, 96), _line(170, 120, 170, 70), _ellipse(170, 92, 42, 11),
        _turn(170, 76, 26, 8, 150, -150), _turn(100, 185, 74, 16, 20, 70), _letter(212, 70, "ω₃"),
        _letter(222, 100, "C"),
    )  # fmt: skip


def struck_rod() -> str:
    """Return an SVG drawing of a free rod that is struck at a distance from its centre."""
    return _drawing(
        "A free rod that is struck beside its centre", 270, 150,
        _rod(30, 70, 240, 70), _dot(135, 70), _arrow(195, 138, 195, 78), _span(135, 94, 195, 94),
        _span(30, 44, 240, 44),
        _letter(135, 62, "C"), _letter(165, 112, "d"), _letter(135, 38, "L"), _letter(210, 132, "J"),
    )  # fmt: skip


def bullet_and_rod() -> str:
    """Return an SVG drawing of a hanging rod and a bullet that flies towards its lower end."""
    return _drawing(
        "A hanging rod and a bullet that flies towards its lower end", 230, 200,
        _line(130, 22, 190, 22), _rod(160, 30, 160, 175), _dot(160, 30), _circle(40, 172, 5, "currentColor"),
        _arrow(50, 172, 110, 172), _letter(146, 44, "O"), _letter(176, 106, "L"), _letter(142, 106, "m₁"),
        _letter(40, 160, "m₂"), _letter(82, 162, "v"),
    )  # fmt: skip


def bat() -> str:
    """Return an SVG drawing of a bat that is held at one end and hit at its sweet spot."""
    return _drawing(
        "A bat that is held at one end and hit beside its other end", 270, 140,
        _rod(40, 60, 240, 60), _circle(40, 60, 9), _dot(140, 60), _arrow(173.3, 130, 173.3, 68), _span(40, 36, 240, 36),
        _letter(22, 64, "O"), _letter(140, 84, "C"), _letter(140, 30, "L"), _letter(188, 126, "J"),
    )  # fmt: skip


def roller_on_incline() -> str:
    """Return an SVG drawing of a round body that rolls down an incline, with the height and the angle."""
    slope = radians(25)
    foot, head = (220.0, 160.0), (220 - 200 * cos(slope), 160 - 200 * sin(slope))
    contact = foot[0] - 140 * cos(slope), foot[1] - 140 * sin(slope)
    centre = contact[0] + 30 * sin(slope), contact[1] - 30 * cos(slope)
    return _drawing(
        "A round body that rolls down an incline", 260, 185,
        _shape(foot, head, (head[0], foot[1])), _circle(*centre, 30), _dot(*centre), _line(*centre, *contact, THIN),
        _turn(*centre, 40, 40, -100, -20), _arc(*foot, 52, 52, 180, 205, width=THIN),
        _span(head[0] - 14, foot[1], head[0] - 14, head[1]), _letter(head[0] - 26, 124, "h"),
        _letter(156, 154, "α"), _letter(centre[0] - 12, centre[1] + 16, "R"),
    )  # fmt: skip


def rolling_wheel() -> str:
    """Return an SVG drawing of a wheel that rolls on level ground, with its rate and the speed of its centre."""
    return _drawing(
        "A wheel that rolls on level ground", 230, 170,
        _ground(20, 210, 145), _circle(100, 85, 60), _dot(100, 85), _arrow(100, 85, 165, 85),
        _line(100, 85, 100, 145, THIN),
        _turn(100, 85, 38, 38, -150, -70), _letter(178, 90, "v"), _letter(112, 124, "R"), _letter(88, 70, "ω"),
    )  # fmt: skip


def ball_and_cue() -> str:
    """Return an SVG drawing of a billiard ball that a cue hits at a height above the table."""
    return _drawing(
        "A billiard ball that a cue hits above its centre", 260, 170,
        _ground(20, 240, 145), _circle(150, 85, 60), _dot(150, 85), _line(150, 85, 210, 85, THIN),
        _arrow(20, 61, 95, 61, "3"), _span(70, 145, 70, 61), _letter(56, 108, "h"), _letter(180, 80, "R"),
        _letter(38, 50, "J"),
    )  # fmt: skip


def planetary_gear() -> str:
    """Return an SVG drawing of a planetary train: sun, three planets on a carrier, and ring."""
    places = [(120 + 57 * cos(radians(k)), 110 + 57 * sin(radians(k))) for k in (-90, 30, 150)]
    return _drawing(
        "A planetary gear train with sun, planets, carrier and ring", 240, 225,
        _circle(120, 110, 88), _circle(120, 110, 98), _circle(120, 110, 26),
        *(_circle(x, y, 31) for x, y in places), *(_line(120, 110, x, y, THICK) for x, y in places),
        *(_dot(x, y) for x, y in places), _dot(120, 110), _letter(120, 131, "S"), _letter(136, 62, "P"),
        _letter(210, 200, "R"), _letter(106, 64, "C"),
    )  # fmt: skip


def crank_and_slider() -> str:
    """Return an SVG drawing of a crank, a connecting rod and a piston on a line through the crank's axis."""
    return _drawing(
        "A crank, a connecting rod and a piston", 300, 130,
        _dashed(10, 90, 290, 90), _line(60, 90, 95, 38, "4"), _line(95, 38, 225, 90, "3"),
        _shape((225, 72), (271, 72), (271, 108), (225, 108)), _arc(60, 90, 24, 24, 0, -56, width=THIN),
        _arc(225, 90, 60, 60, 180, 201.8, width=THIN), _circle(60, 90, 5, "currentColor"), _dot(95, 38), _dot(225, 90),
        _letter(68, 56, "r"), _letter(168, 54, "L"), _letter(96, 82, "φ"), _letter(152, 86, "ψ"),
    )  # fmt: skip


def scotch_yoke() -> str:
    """Return an SVG drawing of a crank whose pin slides in the slot of a yoke."""
    return _drawing(
        "A crank whose pin slides in the slot of a yoke", 290, 160,
        _dashed(10, 80, 110, 80), _circle(80, 80, 5, "currentColor"), _line(80, 80, 118, 42, "4"), _dot(118, 42),
        _shape((110, 20), (126, 20), (126, 140), (110, 140)), _line(126, 80, 250, 80, "3"), _arrow(200, 62, 240, 62),
        _arc(80, 80, 24, 24, 0, -45, width=THIN), _turn(80, 80, 54, 54, 220, 160), _letter(88, 56, "r"),
        _letter(100, 96, "φ"),
        _letter(20, 52, "Ω"), _letter(256, 66, "x"),
    )  # fmt: skip


def ladder() -> str:
    """Return an SVG drawing of a ladder that leans on a wall while its foot slides away."""
    return _drawing(
        "A ladder that leans on a wall and slides", 230, 180,
        _line(40, 10, 40, 155), _ground(40, 220, 155), _rod(40, 35, 150, 155), _dot(150, 155),
        _arrow(158, 145, 205, 145),
        _arc(150, 155, 34, 34, 180, 227.5, width=THIN), _letter(108, 92, "L"), _letter(106, 146, "θ"),
        _letter(186, 136, "v"),
    )  # fmt: skip


def axis_omega_momentum() -> str:
    """Return an SVG drawing of a free symmetric body with its axis, angular velocity and angular momentum."""
    return _drawing(
        "The axis of a symmetric body, its angular velocity and its angular momentum", 230, 210,
        _arrow(90, 190, 90, 15), _arrow(90, 190, 136, 32), _arrow(90, 190, 196, 74),
        _arc(90, 190, 70, 70, 270, 312.4, width=THIN),
        _arc(90, 190, 110, 110, 286.2, 312.4, width=THIN), _shape((172, 124), (202, 90), (166, 59), (136, 93)),
        _letter(76, 26, "H"), _letter(146, 28, "ω"), _letter(208, 70, "3"), _letter(147, 82, "β"),
        _letter(104, 138, "θ"),
    )  # fmt: skip


def rotation_about_axis() -> str:
    """Return an SVG drawing of a point that is rotated by an angle about an inclined axis."""
    return _drawing(
        "A point that is rotated about an axis", 230, 210,
        _arrow(110, 195, 110, 12), _ellipse(110, 80, 75, 24, DASHES), _dot(172, 93.5), _dot(110, 104),
        _arrow(110, 195, 172, 97), _arrow(110, 195, 110, 108), _line(110, 80, 172, 93.5, THIN),
        _line(110, 80, 110, 104, THIN),
        _turn(110, 80, 46, 15, 84, 40), _letter(96, 22, "n"), _letter(132, 112, "α"), _letter(190, 98, "r′"),
        _letter(98, 122, "r"),
    )  # fmt: skip


SKETCHES: dict[str, Callable[[], str]] = {
    "period_of_rod": hanging_rod,
    **dict.fromkeys(("falling_rod", "start_of_fall"), level_rod),
    **dict.fromkeys(("rod_about_end", "radius_of_gyration"), rod_about_end),
    "rod_about_point": rod_beside_centre,
    **dict.fromkeys(("hollow_cylinder", "drilled_disk"), ring_with_two_radii),
    "box_about_axis": box_with_axis,
    "box_about_edge": crate_on_edge,
    **dict.fromkeys(("disk_about_rim", "period_of_disk"), disk_on_nail),
    "cone_about_apex": cone_on_apex,
    "rod_with_ball": rod_with_ball,
    "product_of_triangle": set_square,
    "product_of_two_masses": two_masses,
    "thrown_book": book,
    **dict.fromkeys(("spin_for_precession", "slowest_spin", "momentum_about_vertical", "energy_of_top",
    "slow_precession",
                     "space_direction_of_axis", "rate_about_vertical"), tilted_top),
    "level_precession": level_top,
    "sleeping_top": upright_top,
    "wheel_on_cord": wheel_on_cord,
    **dict.fromkeys(("bearing_torque", "bearing_forces"), rotor_in_bearings),
    "unbalanced_shaft": unbalanced_rotor,
    "reaction_wheel": satellite_with_wheel,
    "tilted_wheel": person_on_turntable,
    **dict.fromkeys(("struck_rod", "struck_place", "energy_of_blow", "resting_point"), struck_rod),
    "bullet_and_rod": bullet_and_rod,
    "percussion_of_racket": bat,
    **dict.fromkeys(("acceleration_on_incline", "least_friction", "speed_at_bottom"), roller_on_incline),
    **dict.fromkeys(("share_of_rotation", "top_of_wheel"), rolling_wheel),
    "cue_height": ball_and_cue,
    **dict.fromkeys(("ring_fixed", "sun_fixed", "carrier_fixed", "both_driven", "planet_rate", "torque_of_carrier"),
                    planetary_gear),
    **dict.fromkeys(("piston_speed", "acceleration_at_dead_centre", "rod_rate", "crank_torque"), crank_and_slider),
    "scotch_yoke": scotch_yoke,
    "ladder": ladder,
    **dict.fromkeys(("body_precession", "space_precession", "body_cone", "angle_of_momentum"), axis_omega_momentum),
    **dict.fromkeys(("rotated_point", "trace_of_rotation", "matrix_of_axis_angle", "rodrigues_parameter"),
                    rotation_about_axis),
}  # fmt: skip
"""Name of a template -> the function that draws its sketch; a template that is not here has none."""


def sketch(template: str) -> str:
    """Return the sketch of a template as SVG, or an empty text if it has none."""
    return SKETCHES[template]() if template in SKETCHES else ""

"""Sketches of rotations, Euler angles, gimbals and quaternions: pictures in space."""

import numpy as np

from symrot.figures import attitude
from symrot.figures.curves import frame, rotated, rotation, unit
from symrot.figures.picture import Picture
from symrot.figures.view import Floats, Plane, View

__all__ = [
    "euler_angles", "gimbal", "gimbal_near_lock", "locked_gimbal", "pointer_in_two_orders", "rate_in_body_axes",
    "rotated_axis", "same_axis", "turned_once", "turned_twice", "two_attitudes", "two_cameras", "two_steps",
]  # fmt: skip

ANGLES = ("ϕ", "θ", "ψ")
VIEW = View(azimuth=30, elevation=22, scale=120)
LETTERS = "xyz"


def euler_angles(sequence: str) -> str:
    """Return an SVG drawing of the three rotations of an intrinsic sequence such as ``"ZXZ"``, one in each panel."""
    azimuth = 8.0 if sequence.startswith("ZY") else 32.0  # no axis points at the viewer
    return attitude.three_rotations(sequence, (40.0, 34.0, 42.0), ANGLES, azimuth).svg(
        f"The three rotations of {sequence}, each about an axis of the frame before it"
    )


def _gimbal(sequence: str, middle: float, title: str) -> str:
    picture, angles = Picture(), (25.0, middle, 20.0)
    normals = attitude.ring_normals(sequence, angles)

    def clear(view: View) -> float:
        across = np.abs(normals @ view.toward)
        return float(np.minimum(across, 1 - across).min())

    # of several views, the one in which each ring is seen neither as a line nor as a circle
    views = [View(azimuth=azimuth, elevation=24, scale=88) for azimuth in range(-90, 91, 10)]
    attitude.gimbal_rings(picture, max(views, key=clear), sequence, angles, ANGLES)
    return picture.svg(title)


def gimbal(sequence: str) -> str:
    """Return an SVG drawing of gimbal rings for a sequence, in an attitude in which the three axes differ."""
    return _gimbal(sequence, 50.0, f"Gimbal rings for {sequence}: the axes of the three angles")


def gimbal_near_lock(sequence: str) -> str:
    """Return an SVG drawing of gimbal rings near lock, where the first and the third axis nearly coincide."""
    middle = 14.0 if sequence[0] == sequence[2] else 76.0
    return _gimbal(sequence, middle, f"Gimbal rings for {sequence} near gimbal lock")


def locked_gimbal(sequence: str) -> str:
    """Return an SVG drawing of gimbal rings at gimbal lock, where the first and the third axis coincide."""
    return _gimbal(sequence, 0.0 if sequence[0] == sequence[2] else 90.0, f"Gimbal rings for {sequence} at lock")


def _fixed_axes(picture: Picture, length: float = 1.3) -> None:
    for i in range(3):
        picture.arrow(VIEW, (0, 0, 0), length * np.eye(3)[i], LETTERS[i], "soft")


def _path(picture: Picture, start: Floats, axis: str, angle: float, letter: str, style: str) -> Floats:
    """Draw the path of a point that is rotated about a fixed axis by an angle in degrees; return its last position."""
    points = rotated(start, np.eye(3)[LETTERS.index(axis)], angle)
    foot = start * np.eye(3)[LETTERS.index(axis)]
    for end in (start, points[-1]):
        picture.curve(VIEW, [foot, end], f"{style} dashed")
    picture.arc(VIEW, points, letter, style)
    last: Floats = points[-1]
    return last


def turned_twice(first: str, second: str) -> str:
    """Return an SVG drawing of a point that is rotated about one fixed axis and then about another one."""
    picture, start = Picture(), np.array([0.95, 0.35, 0.4])
    _fixed_axes(picture)
    middle = _path(picture, start, first, 62.0, "ϕ", "blue")
    end = _path(picture, middle, second, 55.0, "θ", "red")
    for point in (start, middle, end):
        picture.dot(VIEW, point)
    picture.label(VIEW, start, "r", (-9, 10))
    picture.label(VIEW, end, "r′", (14, -4))
    return picture.svg(f"A point that is rotated about {first} and then about {second}")


def two_steps(first: str, second: str) -> str:
    """Return an SVG drawing of a box in three attitudes: at the start, and after each of two rotations.

    The rotations are about the fixed axes ``first`` and ``second``.
    """
    picture = Picture()
    axes = [np.eye(3)[LETTERS.index(letter)] for letter in (first, second)]
    after = rotation(axes[0], 40.0)
    matrices = (np.eye(3), after, rotation(axes[1], 50.0) @ after)
    for column, matrix in enumerate(matrices):
        attitude.brick(picture, View(azimuth=30, elevation=22, scale=52, origin=(190.0 * column, 0.0)), matrix)
    for column, words in enumerate((f"ϕ about {first}", f"θ about {second}")):
        middle = 190.0 * column + 95
        picture.arrow(Plane(1.0), (middle - 18, 0), (middle + 18, 0), style="soft thick")
        picture.label(Plane(1.0), (middle, 24), words)
    return picture.svg(f"A box that is rotated about {first} and then about {second}")


def pointer_in_two_orders(first: str, second: str) -> str:
    """Return an SVG drawing of a pointer along a fixed axis after two rotations in one order and in the other.

    The pointer is along the axis ``first``, so that a rotation about this axis does not move it.
    """
    picture, angles = Picture(), {first: 60.0, second: 50.0}
    _fixed_axes(picture)
    axis = {letter: np.eye(3)[LETTERS.index(letter)] for letter in (first, second)}
    pointer = axis[first]
    one = rotated(pointer, axis[second], angles[second])
    two = rotated(one[-1], axis[first], angles[first])
    picture.arrow(VIEW, (0, 0, 0), pointer, "", "ink thick")
    picture.arc(VIEW, one, "θ", "blue")
    picture.arc(VIEW, two, "ϕ", "red")
    picture.arrow(VIEW, (0, 0, 0), one[-1], "", "blue thick")
    picture.arrow(VIEW, (0, 0, 0), two[-1], "", "red thick")
    picture.curve(VIEW, [one[-1], two[-1]], "ink dashed")
    picture.label(VIEW, (one[-1] + two[-1]) / 2, "d", (-4, 12))
    return picture.svg(f"A pointer along {first} after two rotations, in both orders")


def two_cameras(first: str, second: str) -> str:
    """Return an SVG drawing of two boxes that are rotated from the same attitude about two axes."""
    picture = Picture()
    for side, axis, letter in ((-1.0, first, "ϕ"), (1.0, second, "θ")):
        matrix = rotation(np.eye(3)[LETTERS.index(axis)], 42.0)
        view = View(azimuth=30, elevation=22, scale=52, origin=(115.0 * side, 0.0))
        attitude.brick(picture, view, matrix)
        picture.label(view, (0, 0, 0), f"{letter} about {axis}", (0, 100))
    return picture.svg(f"Two cameras, one rotated about {first}, the other about {second}")


def same_axis(axis: str, *letters: str) -> str:
    """Return an SVG drawing of a shaft, seen along its axis, that is rotated by one or two angles."""
    picture, plane, angle = Picture(), Plane(90), 0.0
    turn = np.linspace(0.0, 2 * np.pi, 121)
    picture.area(plane, np.stack([np.cos(turn), np.sin(turn)], axis=1), "fill-soft")
    picture.curve(plane, np.stack([np.cos(turn), np.sin(turn)], axis=1), "soft", closed=True)
    picture.curve(plane, [(0, 0), (1.25, 0)], "ink dashed")
    for letter, style in zip(letters, ("blue", "red"), strict=False):
        points = rotated((0.55, 0, 0), (0, 0, 1), 48.0)[:, :2] @ rotation((0, 0, 1), angle)[:2, :2].T
        picture.arc(plane, points, letter, style)
        angle += 48.0
        end = 1.25 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        picture.arrow(plane, (0, 0), end, "", f"{style} thick")
    picture.dot(plane, (0, 0))
    picture.label(plane, (0, 0), axis, (-12, 10))
    return picture.svg(f"Rotations about one axis, {axis}, seen along it")


def turned_once(axis: str) -> str:
    """Return an SVG drawing of a frame that is rotated by an angle about one of its axes."""
    picture, number = Picture(), LETTERS.index(axis)
    matrix = rotation(np.eye(3)[number], 50.0)
    for i in range(3):
        if i != number:
            picture.arrow(VIEW, (0, 0, 0), np.eye(3)[i], LETTERS[i], "soft")
            picture.arrow(VIEW, (0, 0, 0), matrix[:, i], f"{LETTERS[i]}′", "blue thick")
    picture.arrow(VIEW, (0, 0, 0), 1.2 * np.eye(3)[number], axis, "ink thick")
    across = np.eye(3)[(number + 1) % 3]
    picture.arc(VIEW, rotated(0.6 * across, np.eye(3)[number], 50.0), "α", "blue")
    return picture.svg(f"A frame that is rotated about {axis}")


def _frames(picture: Picture, matrix: Floats, style: str, prefix: str) -> None:
    for i, (start, end) in enumerate(frame(matrix)):
        picture.arrow(VIEW, start, end, f"{prefix}{i + 1}", style)


def rotated_axis(name: str) -> str:
    """Return an SVG drawing of a frame and of one of its axes, ``"1"``, ``"2"`` or ``"3"``, after a rotation."""
    picture, number, axis = Picture(), int(name) - 1, unit((-0.2, 0.75, 0.7))
    matrix = rotation(axis, 75.0)
    for i in range(3):
        picture.arrow(VIEW, (0, 0, 0), np.eye(3)[i], f"e_{i + 1}", "soft" if i != number else "blue thick")
    vector = matrix[:, number]
    picture.arrow(VIEW, (0, 0, 0), vector, "v", "red thick")
    picture.arrow(VIEW, (0, 0, 0), 1.2 * axis, "n", "green")
    picture.arc(VIEW, rotated(np.eye(3)[number], axis, 75.0), "", "red")
    return picture.svg(f"Unit vector {name} before and after a rotation about an axis")


def rate_in_body_axes() -> str:
    """Return an SVG drawing of a body's axes in space, with the angular velocity and its components along them."""
    picture = Picture()
    matrix = rotation((0.5, -0.2, 0.8), 35.0)
    _fixed_axes(picture, length=1.15)
    _frames(picture, matrix, "blue", "")
    omega = matrix @ np.array([0.55, 0.7, 0.65])
    picture.arrow(VIEW, (0, 0, 0), omega, "ω", "red thick")
    for _, end in frame(matrix):
        foot = (omega @ end) * end
        picture.curve(VIEW, [omega, foot], "red dashed")
        picture.dot(VIEW, foot, "red")
    return picture.svg("The axes of a body in space, and its angular velocity")


def two_attitudes() -> str:
    """Return an SVG drawing of two frames, p and q, and the rotation by an angle from one to the other."""
    picture, first = Picture(), rotation((0.2, -0.3, 0.9), 20.0)
    axis = unit((0.3, 0.25, 0.9))
    second = rotation(axis, 55.0) @ first
    _frames(picture, first, "blue", "p_")
    _frames(picture, second, "red", "q_")
    picture.arrow(VIEW, (0, 0, 0), 1.3 * axis, "n", "green")
    side = unit(first[:, 0] - (first[:, 0] @ axis) * axis)
    picture.arc(VIEW, 0.5 * axis + 0.3 * rotated(side, axis, 55.0), "α", "green")
    return picture.svg("Two attitudes, p and q, and the rotation from one to the other")

"""Figures of attitude: rotations, Euler angles, gimbals, quaternions, and the velocity of points."""

from collections.abc import Sequence

import numpy as np

from symrot.figures.curves import CIRCLE, arc_between, circle, frame, rotated, rotation, unit
from symrot.figures.picture import Picture
from symrot.figures.view import Floats, Plane, View
from symrot.kinematics.conversions import axis_angle_to_quaternion, euler_to_dcm

__all__ = [
    "angular_velocity", "brick", "double_cover", "gimbal_lock", "gimbal_rings", "gimbals", "intermediate_frames",
    "order_of_rotations", "plane_rotation", "projected_quaternions", "proper_euler", "ring_normals",
    "rodrigues_rotation", "rotation_vectors", "tait_bryan", "three_rotations", "two_points",
]  # fmt: skip

LETTERS = "xyz"
COLOURS = ("blue", "red", "green")  # of the frames after the first, second and third rotation
PRIMES = ("", "′", "″", "‴")


def plane_rotation() -> Picture:
    """Draw a frame, the same frame rotated about an axis normal to the page, and a vector's components in both."""
    picture, plane, angle = Picture(), Plane(150), 28.0
    turned = rotation((0, 0, 1), angle)[:2, :2]
    vector = np.array([0.62, 0.86])
    for matrix, style, names in ((np.eye(2), "ink", ("x", "y")), (turned, "blue", ("x′", "y′"))):
        for i in range(2):
            picture.arrow(plane, (0, 0), 1.15 * matrix[:, i], names[i], style)
            foot = (vector @ matrix[:, i]) * matrix[:, i]
            picture.curve(plane, np.array([vector, foot]), f"{style} dashed")
    picture.arrow(plane, (0, 0), vector, "v", "red thick")
    arc = rotated((0.42, 0, 0), (0, 0, 1), angle)[:, :2]
    picture.arc(plane, arc, "α")
    return picture


def rodrigues_rotation() -> Picture:
    """Draw a vector before and after a rotation, with its components along the axis and perpendicular to it."""
    picture, view = Picture(), View(azimuth=35, elevation=22, scale=150)
    axis, vector = np.array([0.0, 0.0, 1.0]), np.array([0.75, -0.35, 0.85])
    along = (vector @ axis) * axis
    path = rotated(vector, axis, 105.0)
    picture.curve(view, circle(along, axis, float(np.linalg.norm(vector - along))), "soft dashed")
    picture.arrow(view, (0, 0, 0), 1.45 * axis, "n", "green thick")
    picture.arrow(view, (0, 0, 0), vector, "v", "blue thick")
    picture.arrow(view, (0, 0, 0), path[-1], "v′", "red thick")
    picture.arrow(view, along, vector, style="blue")
    picture.arrow(view, along, path[-1], style="red")
    picture.label(view, (along + vector) / 2, "v_⊥", (-6, 12))
    picture.label(view, along / 2, "v_∥", (-14, 0))
    picture.arc(view, along + 0.42 * (path - along), "α")
    picture.dot(view, (0, 0, 0))
    return picture


def order_of_rotations() -> Picture:
    """Draw a box after quarter rotations about x and about y, first in one order and then in the other."""
    picture = Picture()
    about_x, about_y = rotation((1, 0, 0), 90.0), rotation((0, 1, 0), 90.0)
    rows = (
        ("about x, then about y", (np.eye(3), about_x, about_y @ about_x)),
        ("about y, then about x", (np.eye(3), about_y, about_x @ about_y)),
    )
    for row, (words, matrices) in enumerate(rows):
        for column, matrix in enumerate(matrices):
            view = View(azimuth=30, elevation=22, scale=52, origin=(175.0 * column, 205.0 * row))
            brick(picture, view, matrix)
            if column:
                picture.arrow(Plane(1.0), (175.0 * column - 105, -205.0 * row), (175.0 * column - 70, -205.0 * row),
                              style="soft thick")  # fmt: skip
        picture.label(Plane(1.0), (175.0, -205.0 * row - 106), words)
    return picture


def brick(picture: Picture, view: View, matrix: Floats) -> None:
    """Draw a box in the attitude ``matrix`` with its axes; only the faces that point toward the viewer are drawn."""
    half = np.array([0.9, 0.55, 0.22])
    for i in range(3):
        for sign in (1.0, -1.0):
            normal = sign * matrix[:, i]
            if normal @ view.toward <= 1e-9:
                continue
            j, k = (i + 1) % 3, (i + 2) % 3
            signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
            corners = [normal * half[i] + a * half[j] * matrix[:, j] + b * half[k] * matrix[:, k] for a, b in signs]
            picture.area(view, corners, f"fill-{COLOURS[i]}")
            picture.curve(view, corners, "ink", closed=True)
    for i in range(3):
        direction = matrix[:, i]
        hidden = direction @ view.toward < -1e-9
        start = half[i] * direction
        picture.arrow(view, start, start + 0.65 * direction, LETTERS[i], f"{COLOURS[i]}{' dashed' if hidden else ''}")


def intermediate_frames(sequence: str, angles: Sequence[float]) -> list[Floats]:
    """Return four frames: before the first of the three rotations of an intrinsic sequence, and after each of them.

    Each frame is a matrix whose columns are its axes; ``angles`` are in degrees.
    """
    steps = [[angle if i < n else 0.0 for i, angle in enumerate(angles)] for n in range(4)]
    return [np.asarray(euler_to_dcm(step, sequence, degrees=True), dtype=float) for step in steps]


def three_rotations(sequence: str, angles: Sequence[float], letters: Sequence[str], azimuth: float) -> Picture:
    """Draw the three rotations of an intrinsic sequence, one in each panel; angles in degrees.

    ``letters`` are the labels of the angles; ``azimuth`` is the direction from which the frames are seen, in degrees.
    """
    picture, frames = Picture(), intermediate_frames(sequence, angles)
    for n in range(3):
        view = View(azimuth, elevation=25, scale=82, origin=(220.0 * n, 0.0))
        before, after = frames[n], frames[n + 1]
        axis = "XYZ".index(sequence[n])
        for matrix, style, prime in ((before, "soft", PRIMES[n]), (after, f"{COLOURS[n]} thick", PRIMES[n + 1])):
            for i, (start, end) in enumerate(frame(matrix)):
                if i == axis and matrix is before:
                    continue
                picture.arrow(view, start, 1.05 * end, "", style)
                picture.label(view, 1.22 * end, f"{LETTERS[i]}{prime}")
        others = [i for i in range(3) if i != axis]
        for i in others:
            arc = rotated(0.62 * before[:, i], before[:, axis], angles[n])
            picture.arc(view, arc, letters[n] if i == others[0] else "", style=COLOURS[n], out=9)
        picture.label(view, (0, 0, 0), f"{n + 1}: about {LETTERS[axis]}{PRIMES[n]}", (0, 108))
    return picture


def proper_euler() -> Picture:
    """Draw the three rotations of the sequence ZXZ: precession, nutation and spin."""
    return three_rotations("ZXZ", (40.0, 38.0, 45.0), ("ϕ", "θ", "ψ"), 35.0)


def tait_bryan() -> Picture:
    """Draw the three rotations of the sequence ZYX: yaw, pitch and roll."""
    return three_rotations("ZYX", (40.0, 30.0, 40.0), ("ϕ", "θ", "ψ"), 8.0)


def gimbals(sequence: str, angles: Sequence[float]) -> list[Floats]:
    """Return the space components of the axes of a gimbal's outer, middle and inner ring; angles in degrees."""
    frames = intermediate_frames(sequence, angles)
    return [frames[n][:, "XYZ".index(letter)] for n, letter in enumerate(sequence)]


def gimbal_lock() -> Picture:
    """Draw a gimbal in a general attitude, and at gimbal lock, where the outer and the inner axis coincide."""
    picture = Picture()
    for column, (words, angles) in enumerate((("three axes", (25.0, 35.0, 20.0)), ("locked", (25.0, 90.0, 20.0)))):
        view = View(azimuth=32, elevation=24, scale=88, origin=(330.0 * column, 0.0))
        gimbal_rings(picture, view, "ZYX", angles, ("ϕ", "θ", "ψ"))
        picture.label(view, (0, 0, 0), words, (0, 165))
    return picture


def ring_normals(sequence: str, angles: Sequence[float]) -> Floats:
    """Return the normals of the outer, middle and inner ring of a gimbal as rows; angles in degrees."""
    axes, body = gimbals(sequence, angles), intermediate_frames(sequence, angles)[3]
    # each ring contains its own axis and the axis of the ring inside it; the inner ring is around the body
    inner = body[:, ("XYZ".index(sequence[2]) + 2) % 3]
    return np.array([np.cross(axes[0], axes[1]), np.cross(axes[1], axes[2]), inner])


def gimbal_rings(picture: Picture, view: View, sequence: str, angles: Sequence[float], letters: Sequence[str]) -> None:
    """Draw the three rings of a gimbal for a sequence, with the letters of its angles at the axes.

    Angles are in degrees.
    """
    axes, normals = gimbals(sequence, angles), ring_normals(sequence, angles)
    for n, radius in enumerate((1.25, 1.0, 0.72)):
        ring = circle((0, 0, 0), normals[n], radius)
        picture.curve(view, ring, f"{COLOURS[n]} thick", ring @ view.toward > 0, hidden="thin")
    for n, reach in enumerate((1.25, 1.0, 0.72)):
        outer = (1.65, 1.3, 1.5)[n]
        # where outer and inner axis have the same direction, the inner arrow ends inside the ring
        if n == 2 and axes[0] @ axes[2] > 0.999:
            outer = 1.0
        picture.arrow(view, reach * axes[n], outer * axes[n], letters[n], COLOURS[n])
        picture.curve(view, [-reach * axes[n], -(outer - 0.2) * axes[n]], COLOURS[n])


def double_cover() -> Picture:
    """Draw the unit quaternions of all rotations about one axis: a circle, traversed once in two full rotations."""
    picture, plane, angle = Picture(), Plane(120), 100.0
    one = np.asarray(axis_angle_to_quaternion((0, 0, 1), angle, degrees=True))[[0, 3]]
    turn = np.linspace(0.0, 720.0, 145)
    path = np.array([np.asarray(axis_angle_to_quaternion((0, 0, 1), a, degrees=True))[[0, 3]] for a in turn])
    signs = np.where(turn <= 360.0, 1.0, -1.0)[:, None] * np.where(path[:, 1:] < -1e-9, -1.0, 1.0)
    first = path[:73] * signs[:73]
    picture.curve(plane, first, "blue thick")
    picture.curve(plane, -first, "red thick")
    picture.arrow(plane, (-1.3, 0), (1.4, 0), "q_0", "soft")
    picture.arrow(plane, (0, -1.25), (0, 1.35), "", "soft")
    picture.label(plane, (0, 1.35), "q · n", (0, -13))
    for point, label, aside, colour in (
        (one, "q", (12, -8), "blue"), (-one, "−q", (-14, 8), "red"), ((1, 0), "0, 4π", (26, -11), "ink"),
        ((-1, 0), "2π", (-18, -11), "ink"),
    ):  # fmt: skip
        picture.dot(plane, point, colour, 3.2)
        picture.label(plane, point, label, aside)
    picture.curve(plane, [one, -one], "ink dashed")
    picture.arc(plane, arc_between((1, 0, 0), (*one, 0), 0.36)[:, :2], "α/2")
    return picture


def projected_quaternions() -> Picture:
    """Draw the projection of a unit quaternion to the classical and to the modified Rodrigues parameters."""
    picture, plane, angle = Picture(), Plane(110), 104.0
    q = np.asarray(axis_angle_to_quaternion((0, 0, 1), angle, degrees=True))[[3, 0]]  # q0 upward
    picture.curve(plane, CIRCLE, "soft")
    picture.curve(plane, [(-1.3, 1), (1.9, 1)], "blue")
    picture.curve(plane, [(-1.3, 0), (1.9, 0)], "red")
    classical, modified = np.array([q[0] / q[1], 1.0]), np.array([q[0] / (1 + q[1]), 0.0])
    picture.curve(plane, [(0, 0), classical], "blue dashed")
    picture.curve(plane, [(0, -1), q], "red dashed")
    picture.arrow(plane, (0, 1), classical, "", "blue thick")
    picture.arrow(plane, (0, 0), modified, "", "red thick")
    for point, label, aside in (
        ((0, 1), "1", (-8, -11)), ((0, 0), "0", (-10, 10)), ((0, -1), "−1", (-4, 13)), (q, "q", (13, 4)),
        (classical, "g", (10, -11)), (modified, "s", (12, 11)),
    ):  # fmt: skip
        picture.dot(plane, point)
        picture.label(plane, point, label, aside)
    picture.arc(plane, arc_between((0, 1, 0), (*q, 0), 0.42)[:, :2], "α/2")
    picture.arc(plane, arc_between((0, 1, 0), (q[0], q[1] + 1, 0), 0.62, (0, -1, 0))[:, :2], "α/4")
    return picture


def angular_velocity() -> Picture:
    """Draw the velocity of a point of a rotating body, perpendicular to the axis and to the radius."""
    picture, view = Picture(), View(azimuth=35, elevation=22, scale=150)
    axis = unit((0.25, 0.1, 1.0))
    point = np.array([0.3, 0.75, 0.75])
    along = (point @ axis) * axis
    radius = float(np.linalg.norm(point - along))
    picture.curve(view, circle(along, axis, radius), "soft dashed")
    picture.arrow(view, (0, 0, 0), 1.45 * axis, "ω", "red thick")
    picture.arrow(view, (0, 0, 0), point, "r", "blue thick")
    velocity = np.cross(axis, point)
    picture.arrow(view, point, point + velocity, "", "green thick")
    picture.label(view, point + velocity, "ω × r", (6, -13))
    picture.curve(view, [along, point], "soft")
    picture.arc(view, arc_between(axis, point, 0.4), "θ")
    picture.label(view, (along + point) / 2, "r sin θ", (4, -11))
    picture.dot(view, (0, 0, 0))
    return picture


def rotation_vectors() -> Picture:
    """Draw the ball of rotation vectors of length up to pi, with two vectors of one rotation."""
    picture, plane = Picture(), Plane(38)
    picture.area(plane, np.pi * CIRCLE)
    picture.curve(plane, np.pi * CIRCLE, "blue")
    direction = np.array([np.cos(0.5), np.sin(0.5)])
    # alpha n is inside the ball; (alpha - 2 pi) n points the opposite way beyond it
    short, long = 2.1 * direction, (2.1 - 2 * np.pi) * direction
    picture.arrow(plane, (0, 0), short, "", "red thick")
    picture.arrow(plane, (0, 0), long, "", "red dashed")
    picture.label(plane, short, "α n", (16, -9))
    picture.label(plane, long, "(α − 2π) n", (0, 15))
    picture.dot(plane, (0, 0))
    end = (np.pi * np.cos(2.2), np.pi * np.sin(2.2))
    picture.arrow(plane, (0, 0), end, "", "soft")
    picture.label(plane, np.array(end) / 2, "π", (11, -4))
    picture.label(plane, (0, 0), "no rotation", (0, 14))
    return picture


def two_points() -> Picture:
    """Draw the velocities of two points of a body in plane motion."""
    picture, plane = Picture(), Plane(120)
    first, second, speed = np.array([0.0, 0.0]), np.array([1.35, 0.55]), 0.55
    carried = np.array([0.7, -0.25])
    across = speed * np.array([-(second - first)[1], (second - first)[0]])
    body = (0.68, 0.24) + CIRCLE @ np.array([[1.15, 0.3], [0.0, 0.74]])
    picture.area(plane, body)
    picture.curve(plane, body, "blue")
    picture.arrow(plane, first, second, "", "ink")
    picture.label(plane, (first + second) / 2, "R d", (-8, -13))
    picture.arrow(plane, first, first + carried, "v", "green thick", (4, -11))
    picture.arrow(plane, second, second + carried, "", "green")
    picture.label(plane, second + carried, "v", (10, 8))
    picture.arrow(plane, second, second + across, "", "red")
    picture.label(plane, second + across, "ω × R d", (-30, -8))
    picture.arrow(plane, second, second + carried + across, "", "violet thick")
    picture.label(plane, second + carried + across, "velocity", (10, -12))
    for tip in (carried, across):
        picture.curve(plane, [second + tip, second + carried + across], "soft dashed")
    picture.dot(plane, first)
    picture.dot(plane, second)
    picture.label(plane, first, "P", (-10, 10))
    picture.arc(plane, rotated((-0.27, -0.06, 0), (0, 0, 1), 110.0)[:, :2], "ω", "red")
    return picture

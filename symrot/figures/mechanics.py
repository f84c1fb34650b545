"""Figures of inertia, angular momentum, blows, rolling bodies, gears and linkages."""

import numpy as np
from mpmath import mp

from symrot.figures.curves import CIRCLE, TURN, arc_between, circle, outline, rotated, rotation, unit
from symrot.figures.picture import Picture
from symrot.figures.plots import Axes
from symrot.figures.view import Floats, Plane, View
from symrot.inertia.solids import solid
from symrot.propagation.propagate import propagator
from symrot.scene.scene import Scene

__all__ = [
    "driven_rates", "elliptic_curves", "four_bar_positions", "four_bars", "momentum_and_rate", "parallel_axes",
    "planetary_gear", "principal_axes", "rolling_disk", "slider_crank", "struck_rod", "struck_velocities",
    "torque_and_rate",
]  # fmt: skip


def momentum_and_rate() -> Picture:
    """Draw the energy ellipsoid with omega and the angular momentum; the momentum is normal to the surface at omega."""
    picture, view = Picture(), View(azimuth=-28, elevation=20, scale=120)
    moments = np.array([0.55, 1.0, 2.2])
    axes = 1 / np.sqrt(moments)
    omega = axes * unit((0.62, 0.1, 0.75))
    momentum = moments * omega
    picture.area(view, outline(np.diag(moments), view))
    picture.curve(view, outline(np.diag(moments), view), "blue", closed=True)
    across = np.array([TURN * 0, np.cos(TURN), np.sin(TURN)]).T
    for n in range(3):
        ring = np.roll(across, n, axis=1) * axes
        picture.curve(view, ring, "blue thin", (ring * moments) @ view.toward > 0)
    for i in range(3):
        direction = np.eye(3)[i]
        picture.arrow(view, axes[i] * direction, (axes[i] + 0.3) * direction, "xyz"[i], "soft")
    picture.arrow(view, (0, 0, 0), omega, "", "red thick")
    picture.label(view, omega, "ω", (-10, -10))
    picture.arrow(view, omega, omega + 0.55 * unit(momentum), "L", "green thick")
    first = unit(np.cross(momentum, (0, 1, 0.2)))
    second = unit(np.cross(momentum, first))
    tangent = [omega + 0.42 * (a * first + b * second) for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    picture.area(view, tangent, "fill-green")
    picture.curve(view, tangent, "green thin", closed=True)
    picture.dot(view, (0, 0, 0))
    return picture


def parallel_axes() -> Picture:
    """Draw a body with an axis through its centre of mass and a parallel axis at a distance."""
    picture, view = Picture(), View(azimuth=-70, elevation=20, scale=105)
    shape = np.diag([1 / 1.2**2, 1 / 0.8**2, 1 / 0.45**2])
    picture.area(view, outline(shape, view))
    picture.curve(view, outline(shape, view), "blue", closed=True)
    offset, up = np.array([1.75, 0.1, 0.0]), np.array([0.0, 0.0, 1.0])
    for place, label, colour in ((np.zeros(3), "through c", "blue"), (offset, "through P", "red")):
        picture.arrow(view, place - 0.95 * up, place + 1.25 * up, "", f"{colour} thick")
        picture.label(view, place + 1.25 * up, label, (0, -14))
        ring = circle(place + 0.95 * up, up, 0.2, np.linspace(-0.4, 4.9, 41))
        picture.arc(view, ring, "", colour)
    picture.curve(view, [np.zeros(3), offset], "ink dashed")
    picture.label(view, offset * 0.78, "d", (0, -11))
    picture.dot(view, (0, 0, 0))
    picture.label(view, (0, 0, 0), "c", (-11, 9))
    picture.dot(view, offset)
    picture.label(view, offset, "P", (13, 8))
    return picture


def principal_axes() -> Picture:
    """Draw a body in axes in which its inertia tensor is not diagonal, and with its principal axes."""
    picture, plane = Picture(), Plane(110)
    turned = rotation((0, 0, 1), 32.0)[:2, :2]
    body = (CIRCLE * (1.05, 0.5)) @ turned.T
    picture.area(plane, body)
    picture.curve(plane, body, "blue", closed=True)
    for matrix, style, names in ((np.eye(2), "soft", ("x", "y")), (turned, "red thick", ("x′", "y′"))):
        for i in range(2):
            picture.arrow(plane, (0, 0), 1.35 * matrix[:, i], names[i], style)
    picture.arc(plane, rotated((0.6, 0, 0), (0, 0, 1), 32.0)[:, :2], "α")
    picture.dot(plane, (0, 0))
    return picture


def struck_velocities(offset: float, points: Floats) -> Floats:
    """Return the velocity, perpendicular to a rod of length 2, of its points after a blow at ``offset`` from the
    centre.
    """
    # mass and impulse are 1
    moment = float(solid("rod", length=2).with_mass(1).inertia[0, 0])
    velocities: Floats = 1.0 + offset / moment * points
    return velocities


def struck_rod() -> Picture:
    """Draw a rod after an off-centre blow, with the velocities of its points and the point that stays at rest."""
    picture, plane = Picture(), Plane(105)
    offset = 0.62
    points = np.linspace(-1.0, 1.0, 9)
    velocities = 0.27 * struck_velocities(offset, points)
    rest = -1.0 / (struck_velocities(offset, np.array([1.0]))[0] - 1.0)
    picture.curve(plane, [(-1, 0), (1, 0)], "ink thick")
    picture.curve(plane, np.stack([points, velocities], axis=1), "red")
    for x, v in zip(points, velocities, strict=True):
        picture.arrow(plane, (x, 0), (x, v), "", "red")
    picture.arrow(plane, (offset, -0.75), (offset, -0.04), "", "green thick")
    picture.label(plane, (offset, -0.75), "J", (12, -4))
    picture.dot(plane, (0, 0))
    picture.label(plane, (0, 0), "c", (0, 13))
    picture.dot(plane, (rest, 0), "blue", 4)
    picture.label(plane, (rest, 0), "at rest", (0, 16))
    picture.curve(plane, [(0, -0.42), (offset, -0.42)], "soft")
    picture.label(plane, (offset / 2, -0.42), "h", (0, 10))
    return picture


def torque_and_rate() -> Picture:
    """Draw how the angular momentum of a body changes in a short time in the direction of the torque."""
    picture, view = Picture(), View(azimuth=-60, elevation=18, scale=150)
    start = np.array([0.2, 0.1, 1.0])
    torque = np.array([0.55, 0.3, 0.05])
    picture.arrow(view, (0, 0, 0), start, "", "green thick")
    picture.label(view, start, "L(t)", (-26, 0))
    picture.arrow(view, (0, 0, 0), start + torque, "", "green thick")
    picture.label(view, start + torque, "L(t + dt)", (42, 0))
    picture.arrow(view, start, start + torque, "", "violet thick")
    picture.label(view, start + torque / 2, "τ dt", (0, -13))
    picture.arrow(view, (0, 0, 0), (0.65, -0.35, 0.75), "ω", "red")
    picture.dot(view, (0, 0, 0))
    return picture


def rolling_disk() -> Picture:
    """Draw a wheel that rolls without slipping, the velocities of its points, and the path of one point."""
    picture, plane, angle = Picture(), Plane(75), np.radians(230.0)
    turn = np.linspace(0.0, 2 * np.pi, 181)
    path = np.stack([turn - np.sin(turn), 1 - np.cos(turn)], axis=1)
    centre = np.array([angle, 1.0])
    picture.curve(plane, [(-0.4, 0), (7.4, 0)], "ink")
    picture.curve(plane, path, "blue thick")
    picture.area(plane, centre + CIRCLE)
    picture.curve(plane, centre + CIRCLE, "ink", closed=True)
    contact = np.array([angle, 0.0])
    for point in (centre, *(centre + np.eye(2)[::-1]), path[115]):
        velocity = np.array([(point - contact)[1], -(point - contact)[0]])
        picture.arrow(plane, point, point + 0.6 * velocity, "", "red")
        picture.curve(plane, [contact, point], "soft dashed")
        picture.dot(plane, point)
    picture.dot(plane, contact, "green", 4)
    picture.label(plane, contact, "contact, at rest", (0, 15))
    picture.label(plane, centre, "v", (52, -8))
    picture.arc(plane, centre + 0.35 * np.stack([np.cos(-turn[10:80]), np.sin(-turn[10:80])], axis=1), "", "red")
    picture.label(plane, centre, "ω", (-10, -12))
    return picture


TEETH = {"sun": 24, "planet": 12, "ring": 48}


def _gear(
    picture: Picture, plane: Plane, centre: Floats, teeth: int, start: float, style: str, inner: bool = False
) -> None:
    """Draw the outline of a gear around ``centre``; ``start`` is the angle of a tooth's edge, rad."""
    angles = start + np.linspace(0, 2 * np.pi, teeth * 12 + 1)
    # the pitch radius is teeth/24
    radius = teeth / 24 + 0.028 * np.tanh(4 * np.sin(teeth * (angles - start)))
    points = centre + radius[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    # the ring, with teeth inward, is not filled
    if not inner:
        picture.area(plane, points, f"fill-{style}")
    picture.curve(plane, points, style, closed=True)


def planetary_gear() -> Picture:
    """Draw a planetary gear: sun, three planets on a carrier, and a ring."""
    picture, plane = Picture(), Plane(70)
    zero = np.zeros(2)
    ring = (TEETH["ring"] / 24 + 0.22) * CIRCLE
    picture.curve(plane, ring, "soft", closed=True)
    _gear(picture, plane, zero, TEETH["sun"], np.pi / 2 / TEETH["sun"], "blue")
    _gear(picture, plane, zero, TEETH["ring"], np.pi / 2 / TEETH["ring"], "soft", inner=True)
    distance = (TEETH["sun"] + TEETH["planet"]) / 24
    for n in range(3):
        angle = np.pi / 2 + n * 2 * np.pi / 3
        centre = distance * np.array([np.cos(angle), np.sin(angle)])
        # a planet's gap meets a tooth of the sun on the line of centres
        phase_of_sun = TEETH["sun"] * (angle - np.pi / 2 / TEETH["sun"])
        start = angle + np.pi - (np.pi - phase_of_sun) / TEETH["planet"]
        _gear(picture, plane, centre, TEETH["planet"], start, "red")
        picture.curve(plane, [zero, centre], "green thick")
        picture.dot(plane, centre, "green", 4)
    picture.dot(plane, zero, "green", 4)
    for words, place in (
        ("sun", (0.45, 0.1)),
        ("ring", (2.25, -1.25)),
        ("planet", (0, 1.72)),
        ("carrier", (-0.38, -0.55)),
    ):
        picture.label(plane, place, words)
    return picture


def slider_crank() -> Picture:
    """Draw a slider-crank: crank, rod, slider, and the angles of both bars."""
    picture, plane = Picture(), Plane(120)
    crank, rod, phi = 0.75, 1.75, np.radians(58.0)
    pin = crank * np.array([np.cos(phi), np.sin(phi)])
    psi = np.arcsin(crank * np.sin(phi) / rod)
    slider, right = np.array([pin[0] + rod * np.cos(psi), 0.0]), np.array([1.0, 0.0])
    picture.curve(plane, crank * CIRCLE, "soft dashed")
    picture.curve(plane, [(-0.2, 0), (3.0, 0)], "soft")
    picture.curve(plane, [(0, 0), pin], "blue thick")
    picture.curve(plane, [pin, slider], "red thick")
    box = [slider + np.array(corner) for corner in ((-0.2, -0.13), (0.2, -0.13), (0.2, 0.13), (-0.2, 0.13))]
    picture.area(plane, box, "fill-green")
    picture.curve(plane, box, "green", closed=True)
    for point in (np.zeros(2), pin, slider):
        picture.dot(plane, point)
    picture.arc(plane, arc_between((1, 0, 0), (*pin, 0), 0.3)[:, :2], "ϕ", "blue")
    picture.arc(plane, slider + arc_between((-1, 0, 0), (*(pin - slider), 0), 0.55)[:, :2], "ψ", "red")
    picture.label(plane, pin / 2, "r", (-9, -8))
    picture.label(plane, (pin + slider) / 2, "L", (4, -12))
    picture.arrow(plane, slider + 0.22 * right, slider + 0.6 * right, "", "ink")
    picture.label(plane, slider + 0.6 * right, "x", (6, -11))
    return picture


BARS = {"a": 0.6, "b": 1.5, "c": 1.2, "ground": 1.55}


def four_bar_positions(phi: Floats) -> tuple[Floats, Floats]:
    """Return the positions of the two moving pins of a four-bar linkage, each of shape (n, 2), at crank
    angles in rad.
    """
    first = BARS["a"] * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    ground = np.array([BARS["ground"], 0.0])
    # the second pin is where the circles of two bars intersect
    between = ground - first
    distance = np.linalg.norm(between, axis=1)
    along = (BARS["b"] ** 2 - BARS["c"] ** 2 + distance**2) / (2 * distance)
    height = np.sqrt(BARS["b"] ** 2 - along**2)
    direction = between / distance[:, None]
    across = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    second: Floats = first + along[:, None] * direction + height[:, None] * across
    return first, second


def four_bars() -> Picture:
    """Draw a four-bar linkage, with the path of a coupler point over a full rotation of the crank."""
    picture, plane = Picture(), Plane(120)
    first, second = four_bar_positions(TURN)
    coupler = second - first
    path = first + 0.5 * coupler + 0.35 * np.stack([-coupler[:, 1], coupler[:, 0]], axis=1)
    number = 24
    a, b, ground = first[number], second[number], np.array([BARS["ground"], 0.0])
    picture.curve(plane, path, "violet thick")
    picture.curve(plane, first, "soft dashed")
    picture.curve(plane, second[np.argsort(second[:, 0])], "soft dashed")
    picture.area(plane, [a, b, path[number]], "fill-red")
    picture.curve(plane, [a, path[number], b], "red")
    picture.curve(plane, [(0, 0), ground], "soft thick")
    for start, end, style, label, aside in (
        (np.zeros(2), a, "blue thick", "a", (-12, 0)), (a, b, "red thick", "b", (2, 13)),
        (ground, b, "green thick", "c", (12, 4)),
    ):  # fmt: skip
        picture.curve(plane, [start, end], style)
        picture.label(plane, (start + end) / 2, label, aside)
    picture.label(plane, ground / 2, "h", (0, 12))
    for point in (np.zeros(2), a, b, ground):
        picture.dot(plane, point)
    picture.dot(plane, path[number], "violet", 4)
    picture.arc(plane, arc_between((1, 0, 0), (*a, 0), 0.25)[:, :2], "ϕ", "blue")
    picture.arc(plane, ground + arc_between((1, 0, 0), (*(b - ground), 0), 0.25)[:, :2], "ψ", "green")
    return picture


def elliptic_curves() -> Picture:
    """Plot Jacobi's elliptic functions sn, cn and dn over their argument."""
    picture, parameter = Picture(), 0.8
    argument = np.linspace(0.0, 4 * float(mp.ellipk(parameter)), 161)
    plot = Axes(picture, (0.0, argument[-1]), (-1.15, 1.15), (400, 190))
    for name, colour, at in (("sn", "blue", 0.25), ("cn", "red", 0.06), ("dn", "green", 0.66)):
        values = np.array([float(mp.ellipfun(name, u, m=parameter)) for u in argument])
        plot.curve(argument, values, f"{colour} thick", name, at)
    for number in range(1, 5):
        plot.upright(argument[-1] * number / 4, ("K", "2K", "3K", "4K")[number - 1], 0.0, 0.04)
    plot.frame("x", "")
    return picture


def driven_rates() -> Picture:
    """Plot the closed form of omega for a body under a constant torque and damping about its symmetry axis."""
    picture, times = Picture(), np.linspace(0.0, 5.0, 101)
    plot = Axes(picture, (0.0, 5.0), (0.0, 2.2), (380, 170))
    for start, colour in ((0.0, "blue"), (2.0, "red"), (1.0, "green")):
        scene = {
            "schema": 1,
            "title": "driven body of a figure",
            "body": {"principal": [1, 1, 1]},
            "initial": {"omega": [0, 0, start]},
            "torque": [{"kind": "constant_body", "torque": [0, 0, 1]}, {"kind": "damping", "linear": 1}],
            "span": {"t": [0, 1], "samples": 2},
        }
        plot.curve(times, propagator(Scene.from_dict(scene, "figure"))(times).omega[:, 2], f"{colour} thick")
    plot.level(1.0, "τ/b")
    plot.frame("t", "ω")
    return picture

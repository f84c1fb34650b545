"""Figures of tops, wheels and pendulums, from motions in closed form and from the derived effective potential."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from sympy import Matrix, Rational, cos, diag, lambdify, solve

from symrot import symbols
from symrot.figures.curves import CIRCLE, arc_between, circle, cone, outline, rotated, unit
from symrot.figures.picture import Picture
from symrot.figures.plots import Axes
from symrot.figures.view import Floats, Plane, View
from symrot.kinematics.conversions import euler_to_dcm
from symrot.kinematics.euler import rate_jacobian
from symrot.propagation.propagate import propagator
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene

__all__ = [
    "START", "cusps", "effective_potential", "hung_wheel", "loops", "pendulum_phases", "sleeping_potential",
    "spherical_pendulum", "tidal_field", "top_motion", "top_with_angles", "waves",
]  # fmt: skip

A, C, SPIN = 1.0, 0.8, 2.2 / 0.8  # kg m^2, kg m^2, rad/s; weight times arm is 1 N m
START = np.radians(40.0)  # nutation at the start, a turning point


def top_motion(omega: Any, nutation: float, times: Floats, moments: tuple[float, float] = (A, C)) -> Trajectory:
    """Return the motion, at ``times``, of a heavy symmetric top that starts with ``omega``, rad/s, and ``nutation``,
    rad.
    """
    # weight 1 N, centre of mass 1 m from the tip, moments across and along the axis about the tip
    scene = {
        "schema": 1,
        "title": "heavy top of a figure",
        "body": {
            "principal": [moments[0], moments[0], moments[1]], "mass": 1, "about": "fixed_point",
            "center_of_mass": [0, 0, 1],
        },
        "initial": {
            "omega": [float(x) for x in omega],
            "attitude": {"sequence": "ZXZ", "angles": [0, float(nutation), 0]},
        },
        "torque": [{"kind": "gravity", "gravity": 1}],
        "span": {"t": [0, 1], "samples": 2},
    }  # fmt: skip
    return propagator(Scene.from_dict(scene, "figure"))(times)


@cache
def effective_potential() -> Callable[..., Any]:
    """Return the effective potential (J) of a heavy symmetric top as a function of (theta, p_phi, p_psi, A, C)."""
    dphi, dtheta, dpsi = symbols.angle_rates
    moments = diag(symbols.A, symbols.A, symbols.C)
    omega = rate_jacobian("ZXZ") * Matrix(symbols.angle_rates)
    kinetic = Rational(1, 2) * omega.dot(moments * omega)
    p_phi, _, p_psi = symbols.momenta
    cyclic = solve([kinetic.diff(dphi) - p_phi, kinetic.diff(dpsi) - p_psi], (dphi, dpsi), dict=True)[0]
    # the energy at constant nutation and momenta
    energy = kinetic.subs(cyclic).subs(dtheta, 0) + symbols.W * symbols.c_3 * cos(symbols.theta)
    names = (symbols.theta, p_phi, p_psi, symbols.A, symbols.C, symbols.W, symbols.c_3, symbols.psi)
    function = lambdify(names, energy, "numpy")
    # weight 1 N, centre of mass 1 m from the tip
    return lambda theta, phi, psi, a, c: function(theta, phi, psi, a, c, 1.0, 1.0, 0.0)


def _potential_and_path(precession: float) -> Picture:
    """Draw the effective potential with its turning points, and the path of the top's axis on a sphere."""
    picture = Picture()
    # an initial precession, rad/s, below, at or above zero gives loops, cusps or waves
    motion = top_motion((0.0, precession * np.sin(START), SPIN), START, np.linspace(0.0, 13.6, 681))
    axis = motion.dcm[:, :, 2]
    nutation = np.arccos(np.clip(axis[:, 2], -1, 1))
    p_phi, p_psi = float(motion.angular_momentum_space[0, 2]), float(motion.angular_momentum_body[0, 2])
    turning = float(nutation.min()), float(nutation.max())
    theta = np.radians(np.linspace(18.0, 84.0, 200))
    potential = effective_potential()(theta, p_phi, p_psi, A, C)
    energy = float(effective_potential()(START, p_phi, p_psi, A, C))
    low = float(potential.min())
    plot = Axes(picture, (theta[0], theta[-1]), (low - 0.06, low + 0.42), (250, 190))
    plot.curve(theta, potential)
    plot.level(energy, "E", "red")
    for number, angle in enumerate(turning):
        plot.upright(angle, f"θ_{number + 1}", high=energy)
    plot.frame("θ", "U")
    view = View(azimuth=-90, elevation=38, scale=150, origin=(490.0, -30.0))
    picture.area(view, outline(np.eye(3), view), "fill-soft")
    picture.curve(view, outline(np.eye(3), view), "soft", closed=True)
    for angle in turning:
        ring = circle((0, 0, np.cos(angle)), (0, 0, 1), float(np.sin(angle)))
        picture.curve(view, ring, "soft thin", ring @ view.toward > 0)
    picture.curve(view, axis, "blue thick", axis @ view.toward > 0)
    picture.arrow(view, (0, 0, 1), (0, 0, 1.35), "z", "soft")
    picture.dot(view, axis[0], "red")
    return picture


def loops() -> Picture:
    """Draw the effective potential, and the looping path of a top that starts with a backward precession."""
    return _potential_and_path(-0.42)


def cusps() -> Picture:
    """Draw the effective potential, and the path with cusps of a top whose axis starts at rest."""
    return _potential_and_path(0.0)


def waves() -> Picture:
    """Draw the effective potential, and the wavy path of a top that starts with a forward precession."""
    return _potential_and_path(0.22)


def top_with_angles() -> Picture:
    """Draw a top on its tip with precession, nutation and spin, the line of nodes and the weight."""
    picture, view = Picture(), View(azimuth=28, elevation=22, scale=150)
    phi, theta, psi = 55.0, 38.0, 60.0
    nodes = np.asarray(euler_to_dcm((phi, 0, 0), "ZXZ", degrees=True))[:, 0]
    tilted = np.asarray(euler_to_dcm((phi, theta, 0), "ZXZ", degrees=True))
    matrix = np.asarray(euler_to_dcm((phi, theta, psi), "ZXZ", degrees=True))
    axis = matrix[:, 2]
    floor = circle((0, 0, 0), (0, 0, 1), 0.8)
    picture.curve(view, floor, "soft thin")
    rim, sides = cone(axis, np.radians(27), 0.92, view)
    picture.area(view, rim)
    picture.curve(view, rim, "blue", closed=True)
    for side in sides:
        picture.curve(view, side, "blue")
    if len(sides) == 2:
        picture.area(view, np.array([sides[0][1], sides[0][0], sides[1][1]]))
    for direction, label, style in (((1.0, 0, 0), "x", "soft"), ((0, 1.0, 0), "y", "soft"), ((0, 0, 1.45), "z", "soft"),
                                    (1.0 * nodes, "", "ink")):  # fmt: skip
        picture.arrow(view, (0, 0, 0), direction, label, style)
    picture.label(view, 1.0 * nodes, "line of nodes", (6, 13))
    picture.arrow(view, (0, 0, 0), 1.45 * axis, "e_3", "blue thick")
    picture.arc(view, arc_between((1, 0, 0), nodes, 0.5), "ϕ", "red")
    picture.arc(view, arc_between((0, 0, 1), axis, 0.95), "θ", "red")
    centre = 1.15 * axis
    spin = centre + rotated(0.2 * tilted[:, 0], axis, 280.0)
    picture.arc(view, spin, "", "red")
    picture.label(view, centre + 0.2 * tilted[:, 0], "ψ", (-14, 6))
    weight = 0.62 * axis
    picture.dot(view, weight)
    picture.arrow(view, weight, weight - np.array([0, 0, 0.5]), "W", "green thick")
    picture.dot(view, (0, 0, 0))
    return picture


def hung_wheel() -> Picture:
    """Draw a spinning wheel whose axle hangs on a cord at one end, with angular momentum and torque."""
    picture, view = Picture(), View(azimuth=-62, elevation=22, scale=120)
    motion = propagator("precessing_wheel")(np.linspace(0.0, 0.75, 41))
    axle = motion.dcm[0][:, 2]
    end, speed = 1.25 * axle, motion.omega_space
    picture.curve(view, circle((0, 0, 0), (0, 0, 1), 1.25), "soft thin")
    picture.curve(view, [(0, 0, 0), (0, 0, 1.1)], "ink")
    picture.label(view, (0, 0, 1.1), "cord", (22, 6))
    wheel = circle(end, axle, 0.62)
    picture.area(view, wheel)
    picture.curve(view, [(0, 0, 0), end], "ink thick")
    picture.curve(view, wheel, "blue thick", closed=True)
    for angle in np.linspace(0, 2 * np.pi, 9)[:-1]:
        picture.curve(view, [end, circle(end, axle, 0.62, np.array([angle]))[0]], "blue thin")
    picture.arrow(view, end, end + 0.75 * axle * np.sign(speed[0] @ axle), "L", "green thick")
    torque = np.cross(end, (0, 0, -1.0))
    picture.arrow(view, (0, 0, 0), 0.62 * torque, "τ", "violet thick")
    picture.arrow(view, end, end + np.array([0, 0, -0.75]), "W", "red")
    path = 1.25 * motion.dcm[:, :, 2]
    picture.arc(view, path[18:], "", "red thick")
    picture.label(view, path[30], "precession", (30, -17))
    picture.dot(view, (0, 0, 0))
    return picture


def sleeping_potential() -> Picture:
    """Plot the effective potential near the vertical for a fast top, a slow top, and a top at the limit."""
    picture = Picture()
    angle = np.radians(np.linspace(-78.5, 78.5, 158))
    plot = Axes(picture, (angle[0], angle[-1]), (-0.35, 0.75), (340, 220))
    for momentum, colour, label in ((2.6, "blue", "fast"), (2.0, "green", "limit"), (1.3, "red", "slow")):
        potential = effective_potential()(angle, momentum, momentum, A, C) - momentum**2 / (2 * C) - 1.0
        plot.curve(angle, potential, f"{colour} thick")
        inside = np.flatnonzero(potential < 0.75)[-1]
        picture.label(plot.plane, (angle[inside], potential[inside]), label, (24, 0))
    plot.frame("θ", "U")
    return picture


def pendulum_phases() -> Picture:
    """Draw a pendulum and its phase curves: oscillations, full rotations, and the motion that ends at the top."""
    picture, plane = Picture(), Plane(120, (0.0, -60.0))
    angle = np.radians(38.0)
    bob = np.array([np.sin(angle), -np.cos(angle)])
    picture.curve(plane, [(-0.35, 0), (0.35, 0)], "ink thick")
    picture.curve(plane, [(0, 0), (0, -1.15)], "soft dashed")
    picture.curve(plane, [(0, 0), bob], "ink thick")
    picture.dot(plane, bob, "blue", 8)
    picture.arrow(plane, bob, bob + np.array([0, -0.5]), "W", "green thick")
    picture.arc(plane, arc_between((0, -1, 0), (*bob, 0), 0.5)[:, :2], "θ")
    swing = 1.0 * np.stack([np.sin(np.linspace(-angle, angle, 41)), -np.cos(np.linspace(-angle, angle, 41))], axis=1)
    picture.curve(plane, swing, "blue dashed")
    plot = Axes(picture, (-np.pi, np.pi), (-2.9, 2.9), (300, 230), (150.0, 60.0))
    for speed, colour in ((0.7, "blue"), (1.4, "blue"), (2.0, "red"), (2.5, "green")):
        for sign in (1.0, -1.0):
            for direction in (1.0, -1.0):
                theta, rate = pendulum_angle(sign * speed, direction * np.linspace(0.0, 9.0, 361))
                inside = np.abs(theta) <= np.pi
                last = len(inside) if inside.all() else int(np.argmin(inside))
                back = np.flatnonzero(rate[1:] * rate[:-1] < 0)
                last = min(last, int(back[0]) + 2) if len(back) else last
                plot.curve(theta[:last], rate[:last], f"{colour}{' thick' if colour == 'red' else ''}")
    plot.frame("θ", "dθ/dt")
    return picture


def pendulum_angle(speed: float, times: Floats) -> tuple[Floats, Floats]:
    """Return angle, rad, and angular rate of a pendulum at the times, in closed form.

    It starts at the lowest position with the rate ``speed``, rad/s.
    """
    motion = top_motion((speed, 0.0, 0.0), np.pi, np.sort(times), (1.0, 0.5))
    q = motion.quaternion
    half = np.unwrap(np.arctan2(q[:, 1], q[:, 0]))
    start = int(np.argmin(np.abs(np.sort(times))))
    theta, rate = 2 * (half - half[start]), motion.omega[:, 0]
    return (theta, rate) if times[-1] >= 0 else (theta[::-1], rate[::-1])


def spherical_pendulum() -> Picture:
    """Draw the path of a spherical pendulum seen from above and from the side."""
    picture = Picture()
    nutation = np.radians(125.0)
    path = top_motion((0.0, 0.62 * np.sin(nutation), 0.62 * np.cos(nutation)), nutation, np.linspace(0, 22, 601),
                      (1.0, 0.5)).dcm[:, :, 2]  # fmt: skip
    for place, elevation in ((0.0, 12.0), (330.0, 90.0)):
        view = View(azimuth=-90, elevation=elevation, scale=135, origin=(place, 0.0))
        picture.curve(view, outline(np.eye(3), view), "soft", closed=True)
        picture.curve(view, circle((0, 0, 0), (0, 0, 1), 1.0), "soft thin")
        picture.curve(view, path, "blue")
        picture.curve(view, [(0, 0, 0), path[0]], "ink thick")
        picture.dot(view, path[0], "red", 5)
        picture.dot(view, (0, 0, 0))
        picture.label(view, (0, 0, 0), "from the side" if elevation < 45 else "from above", (0, 155))
    return picture


def tidal_field() -> Picture:
    """Draw a long satellite on its orbit, with the tidal forces on its ends and the torque that they cause."""
    picture, plane = Picture(), Plane(100)
    planet = Plane(100, (-215.0, 40.0))
    picture.area(planet, 0.42 * CIRCLE, "fill-green")
    picture.curve(planet, 0.42 * CIRCLE, "green", closed=True)
    orbit = 1.15 * CIRCLE
    picture.curve(planet, orbit, "soft dashed")
    place = 1.15 * np.array([0.0, 1.0])
    _satellite(picture, planet, place, 0.22)
    picture.arrow(planet, (0, 0), 0.93 * place, "", "soft")
    picture.label(planet, 0.6 * place, "r", (10, 0))
    turn = np.linspace(0, 2 * np.pi, 17)[:-1]
    for angle in turn:
        offset = 0.95 * np.array([np.cos(angle), np.sin(angle)])
        picture.arrow(plane, offset, offset + 0.2 * tidal_force(offset, np.array([0.0, 1.0])), "", "soft")
    _satellite(picture, plane, np.zeros(2), 0.85)
    for sign in (1.0, -1.0):
        end = sign * 0.85 * SATELLITE
        picture.arrow(plane, end, end + 0.3 * tidal_force(end, np.array([0.0, 1.0])), "", "red thick")
    picture.arc(plane, arc_between((*SATELLITE, 0), (0, 1, 0), 0.6)[:, :2], "", "violet thick")
    picture.label(plane, (0.0, 0.6), "τ", (-11, 6))
    picture.curve(plane, [(0, 0), (0, 0.78)], "soft")
    return picture


SATELLITE = unit((np.sin(np.radians(32)), np.cos(np.radians(32))))


def _satellite(picture: Picture, plane: Plane, place: Floats, half: float) -> None:
    across = 0.16 * half * np.array([SATELLITE[1], -SATELLITE[0]])
    along = half * SATELLITE
    corners = [place + along + across, place + along - across, place - along - across, place - along + across]
    picture.area(plane, corners)
    picture.curve(plane, corners, "blue thick", closed=True)


def tidal_force(offset: Floats, radius: Floats) -> Floats:
    """Return the tidal force on a unit mass at ``offset`` from a satellite's centre, to first order in the offset.

    ``radius`` is the position of this centre; the planet at the origin attracts with 1/distance^2.
    """
    step = 1e-6

    def pull(place: Floats) -> Floats:
        value: Floats = -place / float(np.linalg.norm(place)) ** 3
        return value

    # the derivative of the inverse-square attraction along the offset
    force: Floats = (pull(radius + step * offset) - pull(radius - step * offset)) / (2 * step)
    return force

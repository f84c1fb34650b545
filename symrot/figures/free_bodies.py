"""Figures of free bodies: Poinsot's construction, polhodes and cones, drawn from motions in closed form."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot.figures.curves import TURN, clear_of, cone, outline, turning, unit
from symrot.figures.picture import Picture
from symrot.figures.plots import Axes
from symrot.figures.view import Floats, View
from symrot.propagation.propagate import propagator
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene

__all__ = [
    "cone_vectors", "contact_ellipsoid", "direct_cones", "flips", "free_motion", "momentum_sphere", "poinsot",
    "polhode_curves", "polhodes", "rates", "retrograde_cones", "rolling_ellipsoid", "separatrix",
]  # fmt: skip

MOMENTS = np.array([1.0, 1.6, 2.4])  # kg m^2, principal, of a body with three different moments
VIEW = View(azimuth=58, elevation=24, scale=120)


def free_motion(moments: ArrayLike, omega: ArrayLike, times: Floats, quaternion: Any = None) -> Trajectory:
    """Return the torque-free motion of a body with given principal moments, kg m^2, and initial omega, rad/s.

    ``quaternion`` is the initial attitude; without it, body axes and space axes agree at the start.
    """
    scene = {
        "schema": 1,
        "title": "free body of a figure",
        "body": {"inertia": dict(zip(("xx", "yy", "zz"), np.asarray(moments, dtype=float).tolist(), strict=True))},
        "initial": {"omega": list(map(float, np.asarray(omega, dtype=float)))},
        "span": {"t": [0, 1], "samples": 2},
    }
    return propagator(Scene.from_dict(scene, "figure"))(times, quaternion=quaternion)


def one_period(moments: ArrayLike, start: Floats) -> Trajectory:
    """Return a free motion over one period of omega, whose initial value is ``start``, rad/s, in body components.

    Exactly one component of ``start`` must be zero, and its sign must change: the zeros of this component mark the
    period.
    """
    (zero,) = np.flatnonzero(start == 0.0)
    times = np.linspace(0.0, 80.0, 4001)
    component = free_motion(moments, start, times).omega[:, zero]
    changes = np.flatnonzero(component[1:-1] * component[2:] < 0) + 1  # one after half a period, one after a period
    before, after = component[changes[1]], component[changes[1] + 1]
    period = times[changes[1]] + (times[1] - times[0]) * before / (before - after)
    return free_motion(moments, start, np.linspace(0.0, period, 121))


def rolling_ellipsoid() -> tuple[Floats, Trajectory]:
    """Return the principal moments and the motion of the body in the figure of Poinsot's construction.

    The angular momentum points straight down in space.
    """
    moments, start = np.array([1.0, 1.5, 2.3]), np.array([0.9, 0.0, 0.8])
    return moments, free_motion(moments, start, np.linspace(0.0, 20.0, 401), turning(moments * start, (0, 0, -1)))


def contact_ellipsoid(moments: Floats, motion: Trajectory, place: int) -> Floats:
    """Return the matrix S of the energy ellipsoid ``x · S x = 1`` in space axes, at sample ``place`` of a motion."""
    dcm = motion.dcm[place]
    # the angular velocity is a point of it
    shape: Floats = dcm @ np.diag(moments) @ dcm.T / (moments @ motion.omega[place] ** 2)
    return shape


def poinsot() -> Picture:
    """Draw Poinsot's construction: the energy ellipsoid on the invariable plane, with polhode and herpolhode."""
    place = 40
    moments, motion = rolling_ellipsoid()
    start = motion.omega[0]
    shape, omega = contact_ellipsoid(moments, motion, place), motion.omega_space
    view, picture = View(azimuth=152, elevation=16, scale=125), Picture()
    height, reach = omega[0, 2], 1.5
    sides = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) * reach
    plate = np.array([[x, y, height] for x, y in sides])
    border = np.concatenate([np.linspace(a, b, 60) for a, b in pairwise(plate)])
    picture.area(view, plate, "fill-soft")
    picture.curve(view, border, "soft", clear_of(shape, border, view))
    picture.curve(view, omega, "red thick", clear_of(shape, omega, view))
    picture.area(view, outline(shape, view))
    picture.curve(view, outline(shape, view), "blue", closed=True)
    polhode = one_period(moments, start).omega @ motion.dcm[place].T
    picture.curve(view, polhode, "blue thick", polhode @ shape @ view.toward > 0)
    contact = omega[place]
    picture.arrow(view, (0, 0, 0), contact, style="ink thick")
    picture.label(view, contact, "ω", (15, 4))
    picture.arrow(view, (0, 0, 0), (0, 0, 1.75 * height), "L", "green thick")
    picture.dot(view, (0, 0, 0))
    corner = plate[view.project(plate)[:, 1].argmax()]
    picture.label(view, corner, "invariable plane", (-6, 14))
    return picture


def polhode_curves() -> tuple[list[Floats], Floats]:
    """Return several polhodes, rad/s in body axes, and the two curves of the separatrix between those about axes 1 and
    3.
    """
    # the ellipsoid of the kinetic energy 1/2
    axes = 1 / np.sqrt(MOMENTS)
    starts = []
    for axis in (0, 2):
        for angle in (12.0, 24.0, 36.0):
            direction = np.zeros(3)
            direction[axis], direction[1] = np.cos(np.radians(angle)), np.sin(np.radians(angle))
            starts += [axes * direction, -axes * direction]
    loops = [one_period(MOMENTS, start).omega for start in starts]
    a, b, c = MOMENTS
    slope = np.sqrt(c * (c - b) / (a * (b - a)))  # omega_1 / omega_3 on the planes of the separatrix, from B * 2T = L^2
    planes = []
    for sign in (1.0, -1.0):
        across = np.array([sign * slope, 0.0, 1.0])
        across /= np.sqrt(across @ (MOMENTS * across))
        planes.append(np.outer(np.cos(TURN), across) + np.outer(np.sin(TURN), [0.0, axes[1], 0.0]))
    return loops, np.array(planes)


def polhodes(largest_first: bool = False) -> Picture:
    """Draw polhodes and the separatrix on an energy ellipsoid.

    The moments increase from axis 1 to axis 3, or decrease if ``largest_first``.
    """
    picture, shape = Picture(), np.diag(MOMENTS)
    loops, planes = polhode_curves()
    # axes 1, 2, 3 of a body whose moments decrease are the axes z, -y, x here, seen from the side of -y
    view = View(-VIEW.azimuth if largest_first else VIEW.azimuth, VIEW.elevation, 170)
    picture.area(view, outline(shape, view), "fill-soft")
    picture.curve(view, outline(shape, view), "soft", closed=True)
    for loop in loops:
        picture.curve(view, loop, "blue", loop @ shape @ view.toward > 0)
    for plane in planes:
        picture.curve(view, plane, "red thick", plane @ shape @ view.toward > 0)
    axes = np.eye(3)[::-1] * [[1], [-1], [1]] if largest_first else np.eye(3)
    for number, direction in enumerate(axes):
        semi_axis = direction / np.sqrt(MOMENTS @ direction**2)
        picture.arrow(view, semi_axis, semi_axis + 0.32 * direction, f"ω_{number + 1}")
    return picture


def momentum_sphere() -> Picture:
    """Draw the paths of the angular momentum in body axes, on a sphere, for several energies."""
    picture, view = Picture(), View(VIEW.azimuth, VIEW.elevation, 125)
    picture.area(view, outline(np.eye(3), view), "fill-soft")
    picture.curve(view, outline(np.eye(3), view), "soft", closed=True)
    loops, planes = polhode_curves()
    for number, loop in enumerate([*loops, *planes]):
        momenta = loop * MOMENTS
        momenta = momenta / np.linalg.norm(momenta, axis=1)[:, None]
        style = "blue" if number < len(loops) else "red thick"
        picture.curve(view, momenta, style, momenta @ view.toward > 0)
    for i in range(3):
        direction = np.eye(3)[i]
        picture.arrow(view, direction, 1.3 * direction, f"L_{i + 1}")
    return picture


def cone_vectors(moments: tuple[float, float], nutation: float) -> tuple[Floats, Floats, Floats]:
    """Return the directions of L, omega and the symmetry axis of a free symmetric body, in space components.

    ``moments`` are those across and along the axis, kg m^2; ``nutation`` is the angle from L to the axis, rad.
    """
    a, c = moments
    momentum = np.array([np.sin(nutation), 0.0, np.cos(nutation)])  # in the body, |L| = 1
    start = momentum / np.array([a, a, c])
    motion = free_motion((a, a, c), start, np.linspace(0, 1, 2), turning(momentum, (0, 0, 1)))
    return np.array([0.0, 0.0, 1.0]), unit(motion.omega_space[0]), motion.dcm[0][:, 2]


def _cones(moments: tuple[float, float], nutation: float, view: View) -> Picture:
    """Draw the body cone and the space cone of a free symmetric body; they touch along omega.

    The arguments are explained at :func:`cone_vectors`.
    """
    momentum, omega, axis = cone_vectors(moments, nutation)
    picture = Picture()
    for direction, colour, label in ((momentum, "green", "space cone"), (axis, "blue", "body cone")):
        half = float(np.arccos(np.clip(omega @ direction, -1, 1)))
        rim, sides = cone(direction, half, 1.0, view)
        front = np.ones(len(rim), dtype=bool) if unit(direction) @ view.toward > -0.05 else None
        picture.area(view, rim, f"fill-{colour}")
        for side in sides:
            picture.curve(view, side, colour)
        if len(sides) == 2:
            picture.area(view, np.array([sides[0][1], sides[0][0], sides[1][1]]), f"fill-{colour}")
        picture.curve(view, rim, f"{colour} thick", front, closed=True)
        across = view.project(rim)[:, 0]
        outer = rim[across.argmin() if colour == "blue" else across.argmax()]
        picture.label(view, outer, label, (-36, -4) if colour == "blue" else (42, 0))
    picture.arrow(view, (0, 0, 0), 1.35 * omega, "ω", "red thick")
    picture.arrow(view, (0, 0, 0), (0, 0, 1.5), "L", "green thick")
    picture.arrow(view, (0, 0, 0), 1.45 * axis, "e_3", "blue thick")
    picture.dot(view, (0, 0, 0))
    return picture


def direct_cones() -> Picture:
    """Draw the cones of a slender body: the body cone rolls on the outside of the space cone."""
    return _cones((3.0, 1.0), np.radians(50), View(azimuth=-75, elevation=24, scale=150))


def retrograde_cones() -> Picture:
    """Draw the cones of a flat body: the body cone encloses the space cone and rolls around it."""
    return _cones((1.0, 1.7), np.radians(26), View(azimuth=-75, elevation=24, scale=150))


def rates() -> Picture:
    """Plot the three components of omega over time for a free body with three different moments."""
    times = np.linspace(0.0, 23.0, 361)
    motion = free_motion(MOMENTS, (0.25, 0.9, 0.65), times)
    return _components(times, motion.omega)


def _components(times: Floats, omega: Floats, at: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Picture:
    """Plot the components of omega over time, with labels at the fractions ``at`` of the span."""
    picture = Picture()
    limit = 1.12 * float(np.abs(omega).max())
    axes = Axes(picture, (times[0], times[-1]), (-limit, limit), (420, 200))
    for i, colour in enumerate(("blue", "red", "green")):
        axes.curve(times, omega[:, i], f"{colour} thick", f"ω_{i + 1}", at[i])
    axes.frame("t", "ω")
    return picture


def flips() -> Picture:
    """Plot the components of omega over time for the T-handle, whose intermediate axis reverses again and again."""
    times = np.linspace(0.0, 3.6, 541)
    return _components(times, propagator("t_handle")(times).omega)


def separatrix() -> Picture:
    """Plot the components of omega over time for the motion on the separatrix."""
    _, planes = polhode_curves()
    times = np.linspace(-12.0, 12.0, 361)
    return _components(times, free_motion(MOMENTS, planes[0][0], times).omega, (0.55, 0.9, 0.45))

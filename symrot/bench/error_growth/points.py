"""Points moved step by step: tangent steps enlarge a body, secant steps do not.

The tangent step ``r' = r + h omega x r`` lengthens r, since ``|r'|^2 = |r|^2 + h^2 |omega x r|^2``. The secant step
``r' = r + h omega x (r + r')/2`` keeps the length.

Source: Chen, Rigid Body Rotation, slides 25-27.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.propagate import propagator
from symrot.scene.scene import Scene

__all__ = ["Carried", "carried", "laws"]

Floats = NDArray[np.float64]


class Carried(NamedTuple):
    """How much a body grows and deforms if its points are moved in steps by one scheme."""

    # tangent step; tangent step, then r rescaled to its length; secant step; exact rotation
    scheme: str
    h: float  # s
    growth: float  # largest |r| at the end divided by largest |r| at the start
    derived: float  # growth of the tangent step by the law, along the exact motion; 1 for other schemes
    strain: float  # largest relative change of a distance between two points, apart from uniform growth
    error: float  # largest error of positions, relative to the size of the body


def laws() -> list[tuple[str, bool]]:
    """Try to prove three formulas for the length of a position r after one step; return (formula, whether proven).

    Two formulas are for the tangent step ``r' = r + h omega x r``, one for the secant step ``r' = r + h omega x (r +
    r')/2``.
    """
    from sympy import Matrix, eye, symbols

    from symrot.exact import is_zero
    from symrot.kinematics.rotations import skew

    *r, a, b, c, h = symbols("x y z a b c h", real=True)
    place, omega = Matrix(r), Matrix([a, b, c])
    tangent, turn = place + h * omega.cross(place), h / 2 * skew(omega)
    secant = (eye(3) - turn).inv() * (eye(3) + turn) * place  # r' = r + h omega x (r + r')/2, solved for r'
    across = {c: -(a * r[0] + b * r[1]) / r[2]}  # omega perpendicular to r
    half = h * omega.cross(place + secant) / 2
    claims = {
        "tangent: |r'|^2 = |r|^2 + h^2 |omega x r|^2":
            [tangent.dot(tangent) - place.dot(place) - h**2 * omega.cross(place).dot(omega.cross(place))],
        "tangent, omega across r: |r'| = |r| sqrt(1 + (omega h)^2)":
            [(tangent.dot(tangent) - (1 + h**2 * omega.dot(omega)) * place.dot(place)).xreplace(across)],
        "secant: r' = r + h omega x (r + r')/2 has |r'| = |r|":
            [secant.dot(secant) - place.dot(place), *(secant - place - half)],
    }  # fmt: skip
    return [(name, all(is_zero(expression) for expression in expressions)) for name, expressions in claims.items()]


def _corners(size: tuple[float, float, float]) -> Floats:
    a, b, c = (length / 2 for length in size)
    return np.array([[x, y, z] for x in (-a, a) for y in (-b, b) for z in (-c, c)])


def _turned(axis: Floats, angle: float, points: Floats) -> Floats:
    """Return points rotated about a unit axis by ``angle``, rad."""
    rotated: Floats = (
        points * math.cos(angle) + np.cross(axis, points) * math.sin(angle)
        + np.outer(points @ axis, axis) * (1.0 - math.cos(angle))
    )  # fmt: skip
    return rotated


def _tangent(r: Floats, w: Floats, middle: Floats, h: float) -> Floats:
    return r + h * np.cross(w, r)


def _rescaled(r: Floats, w: Floats, middle: Floats, h: float) -> Floats:
    moved = _tangent(r, w, middle, h)
    scaled: Floats = moved * (np.linalg.norm(r, axis=1) / np.linalg.norm(moved, axis=1))[:, None]
    return scaled


def _secant(r: Floats, w: Floats, middle: Floats, h: float) -> Floats:
    speed = float(np.linalg.norm(middle))
    return _turned(middle / speed, 2.0 * math.atan(h * speed / 2.0), r) if speed else r  # Cayley's


def _rotation(r: Floats, w: Floats, middle: Floats, h: float) -> Floats:
    speed = float(np.linalg.norm(middle))
    return _turned(middle / speed, h * speed, r) if speed else r


SCHEMES = {
    "tangent": _tangent, "tangent, rescaled": _rescaled, "secant (midpoint)": _secant, "rotation": _rotation,
}  # fmt: skip


def carried(scene: Scene, stop: float, steps: tuple[float, ...], size: Any = (1.0, 2.0, 3.0)) -> list[Carried]:
    """Move the corners of a box along a motion in steps, from time 0 to ``stop``; return how the box grows and deforms.

    The result has one :class:`Carried` for each step size of ``steps``, s, and each scheme in ``SCHEMES``, such as the
    tangent step ``r' = r + h omega x r``. ``size`` holds the lengths of the box's edges.
    """
    points, results = _corners(size), []
    motion = propagator(scene)
    for h in steps:
        count = round(stop / h)
        trajectory = motion(np.arange(2 * count + 1) * (h / 2.0))
        omega, start, end = trajectory.omega_space, *trajectory.dcm[[0, -1]]
        first, last = points @ start.T, points @ end.T
        for name, step in SCHEMES.items():
            r, logarithm = first.copy(), np.zeros(len(first))
            for n in range(count):
                r = step(r, omega[2 * n], omega[2 * n + 1], h)
                if name == "tangent":
                    place = points @ trajectory.dcm[2 * n].T
                    across = np.cross(omega[2 * n], place)
                    logarithm += 0.5 * np.log1p(h * h * (across**2).sum(axis=1) / (place**2).sum(axis=1))
            sizes = [float(np.linalg.norm(each, axis=1).max()) for each in (first, r)]
            derived = float(np.exp(logarithm.max()))
            results.append(Carried(name, h, sizes[1] / sizes[0], derived, _strain(first, r), _apart(r, last)))
    return results


def _strain(first: Floats, last: Floats) -> float:
    """Return ``r_max/r_min - 1``, where r is the distance between two points after a motion divided by the distance
    before.

    The result is zero if all distances grow by the same factor.
    """
    pairs = np.triu_indices(len(first), 1)
    before, after = (np.linalg.norm(each[pairs[0]] - each[pairs[1]], axis=1) for each in (first, last))
    ratios = after[before > 0.0] / before[before > 0.0]
    return float(ratios.max() / ratios.min() - 1.0)


def _apart(computed: Floats, expected: Floats) -> float:
    return float(np.linalg.norm(computed - expected, axis=1).max() / np.linalg.norm(expected, axis=1).max())

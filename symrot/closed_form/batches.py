"""The numbers of many motions in closed form, as arrays: those of each motion to the last bit as they are alone.

Where all digits of a sum may cancel, integers find it, one motion after the other; pairs of doubles do the rest.
"""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import GRID, LARGEST, SMALLEST, attitude, pair, quotient
from symrot.closed_form.build import Floats
from symrot.closed_form.free_body.motion import NEGLIGIBLE, Body, Defect
from symrot.closed_form.gyrostat.motion import Gyrostat
from symrot.closed_form.heavy_top.motion import Top
from symrot.closed_form.many import Batch
from symrot.formula import exact_numbers as number
from symrot.inertia.principal import Principal

__all__ = ["Column", "attitudes", "free_bodies", "free_bodies_of_moments", "gyrostats", "tops", "tops_of", "usual"]

Column = Floats | Fraction
"""A constant: of each motion, shape (n,), or the same of all."""

_SPREAD = 2.0**-300  # components of a quaternion farther apart are left to fractions
_DOUBT = 2.0**-12  # of a step of the grid: pairs of doubles err by less than a quarter of it
_TIE = 2.0**-40  # of the last bit


def attitudes(quaternions: Floats) -> Floats:
    """Return unit quaternions as :func:`symrot.closed_form.arithmetic.pairs.attitude` has them, shape (n, 8).

    Pairs of doubles settle all but one of some thousand; exact numbers settle that one.
    """
    scaled = np.ldexp(quaternions, -np.frexp(abs(quaternions).max(axis=1))[1][:, None])
    square = dd.two_product(scaled, scaled)
    total = (square[0][:, 0], square[1][:, 0])
    for k in range(1, 4):
        total = dd.add(total, (square[0][:, k], square[1][:, k]))
    root = np.sqrt(total[0])
    back = dd.two_product(root, root)
    rest = (((total[0] - back[0]) - back[1]) + total[1]) / (2.0 * root)
    root, rest = root[:, None], rest[:, None]  # the norm
    high = scaled / root
    back = dd.two_product(high, root)
    low = (((scaled - back[0]) - back[1]) - high * rest) / root
    high, low = high + low, low - ((high + low) - high)
    last = np.where(abs(high) > _SPREAD, np.spacing(abs(high)), 1.0)
    part, steps = abs(low) / last, low / (last * GRID)
    doubtful = abs(abs(steps - np.floor(steps)) - 0.5) < _DOUBT
    doubtful |= (abs(part - 0.5) < _TIE) | (abs(part - 0.25) < _TIE) | ((high != 0) & (abs(high) <= _SPREAD))
    found = np.empty((len(high), 8))
    found[:, ::2], found[:, 1::2] = high + 0.0, np.rint(steps) * (last * GRID) + 0.0  # zeros without a sign
    for i in np.flatnonzero(doubtful.any(axis=1)).tolist():
        found[i] = attitude(number.unit(list(map(Fraction, quaternions[i].tolist()))))
    return found


def _pairs(values: Floats) -> Floats:
    """Return doubles with zeros between them."""
    found = np.zeros((*values.shape[:-1], 2 * values.shape[-1]))
    found[..., ::2] = values
    return found


def _columns(values: Sequence[Column], n: int) -> Floats:
    """Return constants as pairs, shape (n, 2 k)."""
    found = np.zeros((n, 2 * len(values)))
    for k, value in enumerate(values):
        if isinstance(value, Fraction):
            found[:, 2 * k : 2 * k + 2] = pair(value)
        else:
            found[:, 2 * k] = value
    return found


def usual(omega: Floats) -> NDArray[np.bool_]:
    """Return which angular velocities (n, 3) lie where these arrays are exact; others are a matter for one motion."""
    largest = abs(omega).max(axis=1)
    found: NDArray[np.bool_] = (largest <= LARGEST) & ((largest >= SMALLEST) | (largest == 0))
    return found


def _noticed(omega: Floats) -> Floats:
    """Return angular velocities with zeros for components that a motion alone takes for zero."""
    return np.where(abs(omega) < np.ldexp(abs(omega).max(axis=1), -NEGLIGIBLE)[:, None], 0.0, omega)


def free_bodies(principal: Principal, omega: Floats, start: Floats) -> Batch:
    """Return the motions of one free body from :func:`usual` angular velocities and attitudes (8,) or (n, 8)."""
    body, rates, exact = Body(principal), _pairs(_noticed(omega)), np.empty((len(omega), 8))
    exact[:, :6] = body.gaps
    for i, given in enumerate(rates[:, ::2].tolist() if body.axes is None else omega.tolist()):
        integers = _integers(given)
        if body.axes is not None:
            integers, shared = body.along(given)
            rates[i] = [part for x in integers for part in quotient(x, shared)]
        exact[i, 6:] = body.defect(integers)
    axes = None if body.axes is None else np.array(body.axes)
    return Batch("free_body", (np.array(body.moments), rates, start, exact, axes))


def free_bodies_of_moments(moments: Floats, omega: Floats, start: Floats) -> Batch:
    """Return the motions of free bodies in their principal axes: moments (n, 3), the rest as :func:`free_bodies`."""
    omega, exact = _noticed(omega), np.empty((len(omega), 8))
    for k in range(3):
        exact[:, 2 * k], exact[:, 2 * k + 1] = dd.two_sum(moments[:, (k + 1) % 3], -moments[:, (k + 2) % 3])
    for i, (own, given) in enumerate(zip(moments.tolist(), omega.tolist(), strict=True)):
        exact[i, 6:] = Defect(_integers(own))(_integers(given))
    return Batch("free_body", (_pairs(moments), _pairs(omega), start, exact, None))


def _integers(values: list[float]) -> list[int]:
    """Return integers in the ratios of doubles."""
    (a, over_a), (b, over_b), (c, over_c) = (value.as_integer_ratio() for value in values)
    if over_a == over_b == over_c:
        return [a, b, c]
    shared = max(over_a, over_b, over_c)  # powers of two
    return [a * (shared // over_a), b * (shared // over_b), c * (shared // over_c)]


def tops(top: Top, omega: Floats, start: Floats) -> Batch:
    """Return the motions of one plain heavy top; arguments as :func:`free_bodies`."""
    space = np.array(top.space)
    return Batch("heavy_top", (np.array(top.moments), np.array(top.pull), _pairs(omega), start, space, None))


def tops_of(across: Column, own: Column, pull: Floats, space: Floats, omega: Floats, start: Floats) -> Batch:
    """Return the motions of plain heavy tops: weight times height as pairs (n, 2), the rest as :func:`tops`."""
    return Batch("heavy_top", (_columns([across, own], len(omega)), pull, _pairs(omega), start, space, None))


def gyrostats(body: Gyrostat, omega: Floats, start: Floats) -> Batch:
    """Return the motions of one gyrostat; arguments as :func:`free_bodies`."""
    named = np.array([*map(float, body.named), 0.0])
    rates = _pairs(np.ascontiguousarray(omega[:, body.named]))
    return Batch("gyrostat", (np.array(body.moments), np.array(body.rotor), rates, start, named))

"""Constants of many motions in closed form, as arrays (a batch); every bit is the same as for single motions.

C then computes the motions from these constants. Arguments: ``omega`` are the initial angular velocities, rad/s, shape
(n, 3); ``start`` are the initial attitudes that :func:`attitudes` returns, shape (n, 8), or (8,) if all motions share
one; ``across`` and ``own`` are moments of inertia, kg m^2, about an axis normal to the symmetry axis and about the
symmetry axis. A double-double number, or pair, is a sum hi + lo of two doubles.
"""

# Sums in which all digits may cancel are computed in integers, one motion after the other; all other constants are
# computed in double-double arithmetic, for all motions at once.

from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import (
    GRID,
    LARGEST,
    SMALLEST,
    attitude,
    over_common_denominator,
    pair,
    quotient,
)
from symrot.closed_form.axial.compiled import Constants
from symrot.closed_form.axial.motion import turned_about
from symrot.closed_form.build import Floats
from symrot.closed_form.free_body import bodies
from symrot.closed_form.free_body.motion import Defect, FreeRigidBody, gaps
from symrot.closed_form.heavy_top.motion import Frame
from symrot.closed_form.many import Batch
from symrot.closed_form.spin_up.compiled import limits
from symrot.formula import exact_numbers as number
from symrot.kinematics.hamilton import hamilton

__all__ = [
    "Column", "attitudes", "driven", "fits_batch", "free_bodies", "free_bodies_of_moments", "free_bodies_of_tensors",
    "gyrostats", "spin_ups", "tops", "turned",
]  # fmt: skip

Column = Floats | Fraction
"""The values of a constant: an array with one value for each motion, shape (n,), or one Fraction for all motions."""

_SPREAD = 2.0**-300  # quaternions whose components differ by a larger factor are computed in fractions
_DOUBT = 2.0**-12  # part of a grid step; the errors of double-double numbers are less than a quarter of it
_TIE = 2.0**-40  # part of the last bit
_TURNED = 2.0**-99  # error of products of unit quaternions: 2^-100 of the units, 2^-102 of each product


def attitudes(quaternions: Floats) -> Floats:
    """Return quaternions divided by their norms, as double-double numbers, shape (n, 8): hi, lo of each component."""
    # the same numbers as from pairs.attitude: exact arithmetic decides the last bit of about one row in a thousand
    high, low = _units(quaternions)
    return _on_grid(high, low, 0.0, lambda i: attitude(_unit(quaternions[i])))


def turned(frame: Frame, quaternions: Floats) -> Floats:
    """Convert attitudes of a heavy top, shape (n, 4), to the axes of space and body in ``frame``.

    The formulas of the motion hold in these axes. The result has the shape (n, 8): double-double numbers, hi and lo of
    each component.
    """
    # the same numbers as from Frame.start for each attitude
    attitudes = _units(quaternions)
    if frame.before is not None:
        attitudes = _product(frame.before, True, attitudes)
    if frame.after is not None:
        attitudes = _product(frame.after, False, attitudes)
    return _on_grid(*attitudes, _TURNED, lambda i: frame.start(_unit(quaternions[i])))


def _unit(quaternion: Floats) -> Sequence[Fraction]:
    return number.unit(list(map(Fraction, quaternion.tolist())))


def _units(quaternions: Floats) -> dd.Pair:
    """Return quaternions, shape (n, 4), divided by their norms, as double-double numbers."""
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
    # the error of each component is below _DOUBT/4 grid steps, which _DOUBT in _on_grid includes
    return dd.normalized(high, low)


def _sign(i: int, j: int) -> float:
    """Return the sign of the product of units i and j of the quaternions: i j = k gives ``_sign(1, 2) = 1``."""
    # the units 1, i, j, k have the numbers 0 to 3
    one, other = ([float(k == unit) for k in range(4)] for unit in (i, j))
    return float(hamilton(one, other)[i ^ j])


def _product(constant: Sequence[Fraction], before: bool, q: dd.Pair) -> dd.Pair:
    """Return the products of one constant unit quaternion with many unit quaternions q, shape (n, 4).

    If ``before``, the constant is the left factor.
    """
    # the error is 2^-102
    product: dd.Pair | None = None
    for i, (high, low) in enumerate(map(pair, constant)):
        places = [i ^ k for k in range(4)]  # unit j with i*j = k or -k
        signs = np.array([_sign(i, j) if before else _sign(j, i) for j in places])
        term = dd.multiply((high * signs, low * signs), (q[0][:, places], q[1][:, places]))
        product = term if product is None else dd.add(product, term)
    assert product is not None
    return product


def _on_grid(high: Floats, low: Floats, error: float, exactly: Callable[[int], Sequence[float]]) -> Floats:
    """Return the sums ``high + low`` of n quaternions as doubles hi, lo, hi, lo, .., shape (n, 8), with lo rounded.

    If the errors of the sums leave the rounding of quaternion i in doubt, ``exactly(i)`` computes its 8 doubles.
    """
    # as in arithmetic.pairs.on_grid, lo becomes a multiple of a grid step, GRID times the last bit of hi
    last = np.where(abs(high) > _SPREAD, np.spacing(abs(high)), 1.0)
    part, steps = abs(low) / last, low / (last * GRID)
    # high + low may differ from the exact number by error plus _DOUBT/4 grid steps
    wide = error / last
    doubtful = abs(abs(steps - np.floor(steps)) - 0.5) < _DOUBT + wide / GRID
    doubtful |= (abs(part - 0.5) < _TIE + wide) | (abs(part - 0.25) < _TIE + wide)
    doubtful |= ((high != 0) | (error > 0)) & (abs(high) <= _SPREAD)
    pairs = np.empty((len(high), 8))
    pairs[:, ::2], pairs[:, 1::2] = high + 0.0, np.rint(steps) * (last * GRID) + 0.0  # -0.0 becomes 0.0
    for i in np.flatnonzero(doubtful.any(axis=1)).tolist():
        pairs[i] = exactly(i)
    return pairs


def _pairs(values: Floats) -> Floats:
    """Return doubles as double-double numbers: ``[a, b]`` gives ``[a, 0, b, 0]``."""
    pairs = np.zeros((*values.shape[:-1], 2 * values.shape[-1]))
    pairs[..., ::2] = values
    return pairs


def _columns(values: Sequence[Column], n: int) -> Floats:
    """Return k constants of n motions as double-double numbers, shape (n, 2 k): hi and lo of each constant."""
    columns = np.zeros((n, 2 * len(values)))
    for k, value in enumerate(values):
        if isinstance(value, Fraction):
            columns[:, 2 * k : 2 * k + 2] = pair(value)
        else:
            columns[:, 2 * k] = value
    return columns


def _together(values: Sequence[Column], n: int) -> Floats:
    """Return k constants as double-double numbers: shape (2 k,) if all motions share them, else (n, 2 k)."""
    return _columns(values, n)[0] if all(isinstance(value, Fraction) for value in values) else _columns(values, n)


def fits_batch(omega: Floats) -> NDArray[np.bool_]:
    """Return for each angular velocity, shape (n, 3), whether a batch can compute its motion.

    The largest absolute value of its components must be zero or from SMALLEST to LARGEST; other motions must be
    computed one by one.
    """
    largest = abs(omega).max(axis=1)
    is_fitting: NDArray[np.bool_] = (largest <= LARGEST) & ((largest >= SMALLEST) | (largest == 0))
    return is_fitting


def _noticed(omega: Floats) -> Floats:
    """Return angular velocities, shape (n, 3), with zeros for components too small to affect the motion."""
    # single motions ignore these components too, so that a batch gives the same bits
    return np.where(abs(omega) < np.ldexp(abs(omega).max(axis=1), -number.NEGLIGIBLE_BITS)[:, None], 0.0, omega)


def free_bodies(body: FreeRigidBody, omega: Floats, start: Floats) -> Batch:
    """Return the motions of one free body from n initial states as a batch.

    ``omega`` are the initial angular velocities, rad/s, shape (n, 3); :func:`fits_batch` must be True for each.
    ``start`` are the initial attitudes that :func:`attitudes` returns: two doubles for each component of a quaternion,
    shape (n, 8), or (8,) if all motions share one attitude.
    """
    exact = np.empty((len(omega), 8))
    exact[:, :6] = body.gaps
    if body.axes is None:
        omega = _noticed(omega)
    rates, exact[:, 6:], doubtful = bodies.rates_of_body(body.fixed, omega)
    for i in doubtful.tolist():
        integers, shared = body.along(omega[i].tolist())
        rates[i] = [part for x in integers for part in quotient(x, shared)]
        exact[i, 6:] = body.defect(integers)
    axes = None if body.axes is None else np.array(body.axes)
    return Batch("free_body", (np.array(body.moments), rates, start, exact, axes))


def free_bodies_of_moments(moments: Sequence[Column], omega: Floats, start: Floats) -> Batch:
    """Return the motions of n free bodies as a batch.

    ``moments`` are the three principal moments, kg m^2: each is an array of n values, or one Fraction for all bodies.
    ``omega`` are the initial angular velocities along the principal axes, rad/s, shape (n, 3). ``start`` are the
    initial attitudes that :func:`attitudes` returns: two doubles for each component of a quaternion, shape (n, 8), or
    (8,) if all motions share one attitude.
    """
    omega, n = _noticed(omega), len(omega)
    exact, pairs = np.empty((n, 8)), _columns(moments, n)
    if not pairs[:, 1::2].any():  # the low parts are zero, since moments are doubles
        table = np.ascontiguousarray(pairs[:, ::2])
        for k in range(3):
            exact[:, 2 * k], exact[:, 2 * k + 1] = dd.two_sum(table[:, (k + 1) % 3], -table[:, (k + 2) % 3])
        exact[:, 6:], doubtful = bodies.defects(table, omega)
        for i in doubtful.tolist():
            exact[i, 6:] = Defect(_integers(table[i].tolist()))(_integers(omega[i].tolist()))
    else:
        own = zip(*([x] * n if isinstance(x, Fraction) else x.tolist() for x in moments), strict=True)
        for i, (row, rates) in enumerate(zip(own, omega.tolist(), strict=True)):
            integers, shared = over_common_denominator(row)
            exact[i, :6] = gaps(integers, shared)
            exact[i, 6:] = Defect(integers)(_integers(rates))
    return Batch("free_body", (pairs, _pairs(omega), start, exact, None))


def free_bodies_of_tensors(
    entries: Sequence[Column], omega: Floats, start: Floats
) -> tuple[Batch | None, NDArray[np.bool_]]:
    """Return (batch, settled): the motions of n free bodies from their inertia tensors, and n Booleans as an array.

    ``settled[i]`` is True if the batch has the constants of motion i with the same bits as if motion i were computed
    alone; the caller must compute the other motions alone. ``entries`` are the tensor components xx, yy, zz, xy, xz and
    yz, kg m^2: each is an array of n values, or one Fraction for all bodies. ``omega`` are the initial angular
    velocities, rad/s, shape (n, 3); ``start`` are the initial attitudes that :func:`attitudes` returns. If a component
    that all bodies share is nonzero and not between SMALLEST and LARGEST in absolute value, the batch is None and all
    entries of ``settled`` are False.
    """
    settled = np.ones(len(omega), np.bool_)
    principal = bodies.principal_bodies(entries, omega)
    if principal is None:
        return None, ~settled
    settled[principal.doubtful] = False
    return Batch("free_body", (principal.moments, principal.rates, start, principal.exact, principal.axes)), settled


def _integers(values: list[float]) -> list[int]:
    """Return three doubles as integers, all multiplied by the same power of two, so that their ratios are exact."""
    (a, over_a), (b, over_b), (c, over_c) = (value.as_integer_ratio() for value in values)
    if over_a == over_b == over_c:
        return [a, b, c]
    shared = max(over_a, over_b, over_c)  # powers of two
    return [a * (shared // over_a), b * (shared // over_b), c * (shared // over_c)]


def tops(
    across: Column, own: Column, pull: Floats, frame: Frame, omega: Floats, start: Floats,
) -> Batch:  # fmt: skip
    """Return the motions of n symmetric heavy tops as a batch.

    ``across`` and ``own`` are the moments of inertia, kg m^2, about an axis normal to the symmetry axis and about the
    symmetry axis: each is an array of n values, or one Fraction for all tops. ``pull`` is the weight times the distance
    of the centre of mass from the fixed point, N m, as a sum of two doubles hi and lo: shape (n, 2), or (2,) if all
    tops share it. ``omega`` are the initial angular velocities, rad/s, shape (n, 3). ``start`` are the initial
    attitudes, converted to the axes of the formulas, ``frame``, by :func:`turned`: two doubles hi and lo for each
    component of a quaternion, shape (n, 8), or (8,) if all motions share one attitude.
    """
    rates = _pairs(np.ascontiguousarray(omega[:, frame.named]))
    axes = None if frame.axes is None else np.array(frame.axes)
    return Batch("heavy_top", (_together([across, own], len(omega)), pull, rates, start, np.array(frame.space), axes))


def gyrostats(across: Column, own: Column, rotor: Column, axis: int, omega: Floats, start: Floats) -> Batch:
    """Return the motions of n symmetric gyrostats as a batch.

    ``across`` and ``own`` are the moments of inertia, kg m^2, about an axis normal to the symmetry axis and about the
    symmetry axis, whose index is ``axis`` (0, 1 or 2). ``rotor`` is the rotor's angular momentum, kg m^2/s, along this
    axis. Each of the three is an array of n values, or one Fraction for all gyrostats. ``omega`` are the initial
    angular velocities, rad/s, shape (n, 3). ``start`` are the initial attitudes that :func:`attitudes` returns.
    """
    named = [(axis + 1) % 3, (axis + 2) % 3, axis]
    rates = _pairs(np.ascontiguousarray(omega[:, named]))
    constants = [_together([across, own], len(omega)), _together([rotor], len(omega))]
    return Batch("gyrostat", (*constants, rates, start, np.array([*map(float, named), 0.0])))


def spin_ups(across: Column, own: Column, torque: Column, axis: int, omega: Floats, start: Floats) -> Batch:
    """Return the motions of n symmetric bodies under a constant torque about the body axis ``axis``, as a batch.

    ``across`` and ``own`` are the moments of inertia, kg m^2, about an axis normal to the driven axis and about the
    driven axis; ``torque`` is in N m. Each of the three is an array of n values, or one Fraction for all bodies.
    ``omega`` are the initial angular velocities, rad/s, shape (n, 3). ``start`` are the initial attitudes that
    :func:`attitudes` returns.
    """
    numbers = np.empty((len(omega), 20))
    numbers[:, :6] = _columns([across, own, torque], len(omega))
    numbers[:, 6:12] = _pairs(omega[:, [axis - 2, axis - 1, axis]])
    numbers[:, 12:] = start
    return Batch("spin_up", (numbers, np.array([axis, *limits()])))


def driven(constants: Constants | Sequence[Constants], omega: Floats, start: Floats) -> Batch:
    """Return the motions of n bodies driven about one axis as a batch.

    ``constants`` are the :class:`Constants` of one body, or a list of n, all with the same axis. ``omega`` are the
    initial angular velocities, rad/s, shape (n, 3). ``start`` are the initial attitudes that :func:`attitudes` returns:
    two doubles for each component of a quaternion, shape (n, 8), or (8,) if all motions share one attitude.
    """
    bodies = [constants] * len(omega) if isinstance(constants, Constants) else constants
    axis = bodies[0].axis
    turned: NDArray[np.bool_] = (omega[:, [axis - 2, axis - 1]] != 0).any(axis=1)
    moving = zip(bodies, omega[:, axis].tolist(), turned.tolist(), strict=True)
    records = np.zeros((len(omega), 65))  # numbers in the struct `axial` of axial.h
    records[:, 8:26] = [each.moving(rate, across) for each, rate, across in moving]
    records[turned, 26:40], records[turned, 12:26] = records[turned, 12:26], 0.0
    records[:, :8] = constants.head(False) if isinstance(constants, Constants) else [c.head(False) for c in constants]
    records[:, 2] = turned
    for k, value in enumerate(bodies[0].omega_rows(omega[:, axis - 2], omega[:, axis - 1])):
        records[:, 40 + k] = value
    attitude = start.reshape(-1, 8)[:, ::2]
    records[:, 49::4], records[:, 50::4] = attitude, np.column_stack(turned_about(axis, list(attitude.T)))
    return Batch("axial", (records,))

"""Asymptotic series for a driven symmetric body far from resonance, in inverse powers of an angular velocity.

The rotating axes (see :mod:`symrot.closed_form.spin_up.motion`) rotate with the transverse angular velocity, whose
length is W. Their own angular velocity is ``(W, 0, Omega)``. The axial rate Omega grows at the constant rate s and is
zero at resonance. Divided by sqrt(s), the angular velocity is ``(kappa, 0, x)``; its length is
``r = sqrt(kappa^2 + x^2)``. x is also the time after resonance in units of 1/sqrt(s).

The axes rotate about a vector n, fixed in space, near the direction of their angular velocity. With ``v = 1/r^2``, the
components of n along the rotating axes are

    n1 = (kappa/r) a(v),  n2 = (kappa/r) v c(v),  n3 = (x/r) b(v),  b - a = -v^2 g(v).

The angle of rotation about n is the integral of r over x plus the change of ``delta = (x/r) e(v)``. The functions a, b,
c, e and g have asymptotic series in powers of v. These series do not converge, but for abs(x) above :data:`NEAR`, or
kappa above :data:`WIDE`, their terms fall below 1e-18 before they grow. Polynomials in ``y = radius2 v`` replace the
series: radius2 is kappa^2 if kappa is above :data:`WIDE`, else NEAR^2 + kappa^2, so that y is from 0 to 1.

Source: DLMF 12.9 and 12.10, for the parabolic cylinder functions whose modulus and phase these series are. Proof:
``derivations/driven_rotation.md``.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from symrot.closed_form.build import Floats

__all__ = ["DEGREE", "MOST", "NEAR", "WIDE", "Series", "series"]

NEAR = 10.0
"""Largest scaled time abs(x), before or after resonance, that counts as near resonance.

x = Omega/sqrt(s), where Omega is the axial rate, which is zero at resonance, and s is the rate at which Omega grows. At
larger abs(x) the asymptotic series are accurate for every transverse angular velocity.
"""

WIDE = 9.0
"""Smallest kappa = W/sqrt(s) for which the asymptotic series are accurate at all times, even at resonance.

W is the length of the transverse angular velocity, and s is the rate at which the axial rate grows. At resonance the
axial rate is zero.
"""

MOST = 1e13
"""Largest angle of rotation, rad, that is computed with sums of two doubles, which have too few digits beyond it."""

DEGREE = 12
"""Degree of the polynomials that replace the asymptotic series (see :class:`Series`)."""

_ORDERS = 14  # number of powers of v^2
_SMALL = 0.2  # kappa^2/radius2: below it the angle is counted from infinity
_TERMS = 32  # powers of kappa^2 v that are used where kappa^2 v <= _SMALL


class Series(NamedTuple):
    """Three polynomials that replace the asymptotic series of a driven body, as coefficients, lowest power first.

    The rotating axes rotate about a vector n, fixed in space and near the direction of their angular velocity
    (kappa, 0, x), of the length r. The polynomials ``g`` and ``c`` give the components of n normal to the angular
    velocity. ``e`` gives delta: the angle of rotation between two times is the integral of r plus the change of delta.
    The variable of the polynomials is y = radius2/r^2, from 0 to 1. The symbols are those of the module's docstring.
    """

    # whether kappa is at least WIDE: the series are then accurate at every x, otherwise for |x| of at least NEAR
    wide: bool
    # perpendicular to the angular velocity, n has the components (kappa/r) (x/r) v^2 g and (kappa/r) v c
    g: Floats  # times v^2 at y = 1
    c: Floats  # times v at y = 1
    e: Floats  # rad


@cache
def _nodes() -> tuple[Floats, Floats]:
    """Return DEGREE + 1 values of y, Chebyshev points between 0 and 1, and the powers of each value."""
    y = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    return y, np.vander(y, 3 * _ORDERS + 1, increasing=True)


def _first(share: float, v: float) -> Floats:
    """Return the coefficients of a as a polynomial in y, lowest power first; (kappa/r) a is the first component of n.

    The symbols are those of the module's docstring. ``share`` is kappa^2/radius2, and ``v`` is 1/radius2.
    """
    # n' = n x (kappa, 0, x) gives c = -(a + 2 v a'), b - a = -v^2 g with g = 3 c + 2 v c', and 2 (1 - kappa^2 v) b' =
    # kappa^2 (b + c), so that each coefficient follows from the previous ones
    order, total = {0: 1.0}, [0.0] * (3 * _ORDERS + 1)
    total[0] = 1.0
    for _ in range(_ORDERS):
        next_order: dict[int, float] = {}
        for power, value in order.items():
            j = power + 2
            gap = (2 * j - 1) * (2 * j - 3) * v * v * value  # b_j - a_j
            next_order[j] = next_order.get(j, 0.0) - gap
            next_order[j + 1] = next_order.get(j + 1, 0.0) + share * (2 * j + 1) * gap / (2 * j + 2)
        for power, value in next_order.items():
            total[power] += value
        order = next_order
    return np.array(total)


def _excess(share: float, v: float, h: Floats) -> Floats:
    """Return e = delta r/x at the values of y in :func:`_nodes`, where delta is the small part of the angle about n.

    The symbols are those of the module's docstring: the rotating axes have the angular velocity (kappa, 0, x) of length
    r, and rotate about the vector n by the integral of r over the scaled time x, plus the change of delta. The variable
    is y = radius2/r^2, where radius2 is the least r^2 for which the series are used. ``share`` is kappa^2/radius2, and
    ``v`` is 1/radius2. ``h`` are the coefficients of the polynomial in y with ``d delta/dx = kappa^2 h/r^5``, lowest
    power first.
    """
    powers = _nodes()[1]
    if share >= _SMALL:  # from x = 0
        e = np.zeros(len(h) + 2)
        for j in range(len(h), -1, -1):
            e[j] = ((v * h[j - 1] if j else 0.0) + 2 * (j + 1) * e[j + 1] / share) / (1 + 2 * j)
    else:  # from infinity
        e = np.zeros(_TERMS)
        for j in range(_TERMS - 1):
            e[j + 1] = share * ((1 + 2 * j) * e[j] - (v * h[j - 1] if 0 < j <= len(h) else 0.0)) / (2 * j + 2)
    angle: Floats = powers[:, : len(e)] @ e
    return angle


def series(kappa2: float, inverse: float) -> Series:
    """Return the polynomials that replace the asymptotic series of the module for one value of kappa = W/sqrt(s).

    W is the transverse angular velocity, and s the rate at which the axial rate grows. ``kappa2`` is kappa^2, and
    ``inverse`` is 1/kappa^2; one of them may be too small for a double, and is then 0.
    """
    wide = kappa2 >= WIDE * WIDE
    radius2 = kappa2 if wide else NEAR * NEAR + kappa2
    share, v = (1.0, inverse) if wide else (kappa2 / radius2, 1.0 / radius2)
    y, powers = _nodes()
    square = powers[:, : DEGREE + 1]
    a, twice = _first(share, v), 2.0 * np.arange(powers.shape[1])
    g, c = -powers @ ((twice + 3.0) * (twice + 1.0) * a), -powers @ ((twice + 1.0) * a)
    first2 = share * y * (1.0 - share * y) * (v * y) ** 4 * g * g
    second2 = share * y * (v * y) ** 2 * c * c
    h = np.asarray(np.linalg.solve(square, -c / (1.0 + np.sqrt(1.0 - first2 - second2))), np.float64)
    e = _excess(share, v, h)
    coefficients = np.asarray(np.linalg.solve(square, np.stack([v * v * g, v * c, e], axis=1)), np.float64)
    return Series(wide, coefficients[:, 0], coefficients[:, 1], coefficients[:, 2])

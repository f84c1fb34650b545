"""Asymptotic series for a driven symmetric body far from resonance, in inverse powers of its angular velocity.

In axes in which a body rotates at ``(kappa, 0, x)``, where ``x`` is the scaled time, a vector ``n`` at rest in space
obeys ``n' = n x (kappa, 0, x)``. One such vector follows the axis of rotation. With ``r^2 = x^2 + kappa^2``, ``v =
1/r^2`` and

    n1 = (kappa/r) a(v),  n2 = (kappa/r) v c(v),  n3 = (x/r) b(v),

the equation becomes ``c = -(a + 2 v a')``, ``b - a = -v^2 g`` with ``g = 3 c + 2 v c'``, and ``2 (1 - kappa^2 v) b' =
kappa^2 (b + c)``, so each coefficient of a series follows from the previous coefficients. The coefficients are ordered
by powers of ``v^2``; the coefficient of each power is a polynomial in ``kappa^2 v``, which is at most 1. The series do
not converge, but for x above :data:`NEAR`, or kappa above :data:`WIDE`, their terms fall below 1e-18 before they grow.

In axes whose third axis is the axis of rotation, the first two components of ``n`` are ``(kappa/r) (x/r) v^2 g`` and
``(kappa/r) v c``. The angle of rotation about ``n`` exceeds the integral of ``r`` by ``delta``, which defines the
function e: ``delta = (x/r) e(v)``.

Source: DLMF 12.9 and 12.10, for the parabolic cylinder functions whose modulus and phase these series are. Proof:
``derivations/driven_rotation.md``.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from symrot.closed_form.build import Floats

__all__ = ["DEGREE", "MOST", "NEAR", "WIDE", "Series", "series"]

NEAR = 10.0
"""Smallest x for which the series is accurate for every kappa."""

WIDE = 9.0
"""Smallest kappa for which the series is accurate for every x."""

MOST = 1e13
"""Phase, rad, above which double-double numbers have too few digits."""

DEGREE = 12
"""Degree of the polynomials that replace the series."""

_ORDERS = 14  # number of powers of v^2
_SMALL = 0.2  # kappa^2/radius2: below it the angle is counted from infinity
_TERMS = 32  # powers of kappa^2 v that are used where kappa^2 v <= _SMALL


class Series(NamedTuple):
    """Three series, as polynomials in y, for the rotation of a body that is driven about its symmetry axis.

    x is the scaled time and kappa the transverse angular velocity, so that ``r^2 = x^2 + kappa^2`` is the squared
    angular velocity; ``v = 1/r^2``. A certain vector n at rest in space has, perpendicular to the angular velocity, the
    two small components ``(kappa/r) (x/r) v^2 g`` and ``(kappa/r) v c``, and the body rotates about it by the integral
    of r plus ``(x/r) e``, rad. The fields are the polynomials ``v^2 g``, ``v c`` and ``e``, lowest power first. The
    variable ``y = radius2/r^2`` lies between 0 and 1. If kappa is large (``wide``), the series are accurate at every
    time x, and ``radius2`` is kappa^2. Otherwise they are accurate for x above NEAR, and ``radius2`` is NEAR^2 +
    kappa^2.
    """

    wide: bool
    g: Floats  # times v^2 at y = 1
    c: Floats  # times v at y = 1
    e: Floats  # rad


@cache
def _nodes() -> tuple[Floats, Floats]:
    """Return DEGREE + 1 Chebyshev points between 0 and 1, and the powers of each point."""
    y = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    return y, np.vander(y, 3 * _ORDERS + 1, increasing=True)


def _first(share: float, v: float) -> Floats:
    """Return the coefficients of a(v) as a polynomial in ``y = radius2 v``, lowest power first.

    ``(kappa/r) a(v)`` is the first component of a vector that is at rest in space, in axes in which the body rotates at
    ``(kappa, 0, x)``; x is the scaled time, ``r^2 = x^2 + kappa^2`` and ``v = 1/r^2``. ``radius2`` is a constant (see
    :class:`Series`). ``share`` is kappa^2/radius2, and the argument ``v`` is 1/radius2, the value of v at y = 1.
    """
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


def _angle(share: float, v: float, h: Floats) -> Floats:
    """Return the values of the function e at the Chebyshev points of y; ``(x/r) e`` is an angle delta, in rad.

    x is the scaled time, ``r^2 = x^2 + kappa^2`` with a constant kappa, ``v = 1/r^2`` and ``y = radius2 v``. delta
    solves the equation ``d delta/dx = kappa^2 v^(5/2) h``, where h is a polynomial in y: ``h`` lists its coefficients,
    lowest power first. ``share`` is kappa^2/radius2, and the argument ``v`` is 1/radius2, the value of v at y = 1.
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
    """Return the series for the rotation of a driven body with kappa^2 = ``kappa2``, in powers of 1/r.

    r = sqrt(x^2 + kappa^2) is the angular velocity in units in which its axial part equals the time x; kappa is the
    constant transverse part in these units. ``inverse`` is 1/kappa^2; it is passed too because one of the two may be
    too small for a double, and is then 0.
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
    e = _angle(share, v, h)
    coefficients = np.asarray(np.linalg.solve(square, np.stack([v * v * g, v * c, e], axis=1)), np.float64)
    return Series(wide, coefficients[:, 0], coefficients[:, 1], coefficients[:, 2])

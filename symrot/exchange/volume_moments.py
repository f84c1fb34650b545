"""Integrals of x^l y^m z^n over a polyhedron, from its triangles: exact, or in doubles with a bound of the error.

A triangle (a, b, c) spans a tetrahedron with the origin. Its integral is

    det(a, b, c) * l! m! n! / (l + m + n + 3)! * h,

where h is the coefficient of s^l t^m u^n in 1/((1 - a.v)(1 - b.v)(1 - c.v)), v = (s, t, u).
"""

from collections.abc import Mapping
from fractions import Fraction
from math import factorial, frexp, fsum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.exchange.surface import Surface
from symrot.inertia.tensor import dot

__all__ = ["Exponents", "VolumeMoments", "approximate_moments", "exact_moments", "exponents"]

Exponents = tuple[int, int, int]
Corner = tuple[Any, Any, Any]

CHUNK = 1 << 14  # triangles at a time, so that arrays stay in the cache of the processor
BLOCK = 32  # terms that are added in doubles before the sums are added exactly
ROUNDING = 2.0**-53
TINY = 1e-290  # above the sum of all underflows of one triangle, whose coordinates are at most 1


class VolumeMoments(NamedTuple):
    """The integrals of x^l y^m z^n over a polyhedron, with coordinates measured from a centre.

    Attributes
    ----------
    center : tuple of 3 Fraction
        The point from which the coordinates are measured.
    values : dict
        (l, m, n) -> the integral.
    errors : dict
        (l, m, n) -> a bound of the error of the integral; 0 if it is exact.
    """

    center: tuple[Fraction, Fraction, Fraction]
    values: Mapping[Exponents, Fraction]
    errors: Mapping[Exponents, Fraction]


def exponents(degree: int) -> list[Exponents]:
    """Return all exponents (l, m, n) of monomials x^l y^m z^n up to a degree, in the order of their degrees."""
    return [
        (first, second, total - first - second)
        for total in range(degree + 1)
        for first in range(total, -1, -1)
        for second in range(total - first, -1, -1)
    ]


def _lower(powers: Exponents, axis: int) -> Exponents:
    first, second, third = (power - (index == axis) for index, power in enumerate(powers))
    return first, second, third


def _coefficients(corners: tuple[Corner, Corner, Corner], degree: int, one: Any) -> dict[Exponents, Any]:
    """Return the coefficient of s^l t^m u^n in 1/((1 - a.v)(1 - b.v)(1 - c.v)) for each (l, m, n) up to a degree.

    v is the vector (s, t, u). Each corner a, b, c of the triangles consists of three arrays, the coordinates, with an
    entry for each triangle. ``one`` is the number 1 in the type of the results: 1 for integers, 1.0 for doubles.
    """
    # one recurrence for each factor
    before: dict[Exponents, Any] = {}
    for corner in corners:
        now: dict[Exponents, Any] = {(0, 0, 0): one}
        for powers in exponents(degree)[1:]:
            terms = [corner[axis] * now[_lower(powers, axis)] for axis in range(3) if powers[axis]]
            if powers in before:
                terms.append(before[powers])
            now[powers] = sum(terms[1:], terms[0])
        before = now
    return before


def _weight(powers: Exponents) -> Fraction:
    top = factorial(powers[0]) * factorial(powers[1]) * factorial(powers[2])
    return Fraction(top, factorial(sum(powers) + 3))


def _columns(points: NDArray[Any]) -> Corner:
    x, y, z = (np.ascontiguousarray(points[:, axis]) for axis in range(3))
    return x, y, z


def _cross(left: Corner, right: Corner, sign: int = -1) -> Corner:
    """Return the cross products of arrays of vectors.

    With ``sign`` = 1 their terms are added instead of subtracted: sums of magnitudes bound the rounding errors.
    """
    x, y, z = (left[j] * right[k] + sign * (left[k] * right[j]) for j, k in ((1, 2), (2, 0), (0, 1)))
    return x, y, z


# --- exact ------------------------------------------------------------------------------------------------------------


def _integers(vertices: NDArray[np.float64]) -> tuple[NDArray[Any], int]:
    """Return the coordinates as Python integers in units of a power of two, and the exponent of this power."""
    mantissa, exponent = np.frexp(vertices)
    digits = (mantissa * 2.0**53).astype(np.int64)
    low = (digits & -digits).astype(np.float64)  # the lowest set bit
    places = np.where(digits == 0, 0, np.frexp(low)[1] - 1).astype(np.int64)
    shifts = exponent.astype(np.int64) - 53 + places
    unit = int(shifts[digits != 0].min()) if np.any(digits) else 0
    odd = (digits >> places).ravel().tolist()
    left = np.where(digits == 0, 0, shifts - unit).ravel().tolist()
    whole = np.empty(vertices.size, dtype=object)
    whole[:] = [number << shift for number, shift in zip(odd, left, strict=True)]
    return whole.reshape(vertices.shape), unit


def exact_moments(surface: Surface, degree: int) -> VolumeMoments:
    """Return the exact integrals up to a degree over the polyhedron that a closed surface bounds.

    The vertices are doubles, so that the integrals are rational; they take about 10 us for each triangle.
    """
    points, unit = _integers(surface.vertices)
    middle = [(min(column) + max(column)) // 2 for column in points.T.tolist()]
    points = points - np.array(middle, dtype=object)
    totals = dict.fromkeys(exponents(degree), 0)
    for start in range(0, len(surface.triangles), CHUNK):
        triangles = surface.triangles[start : start + CHUNK]
        a, b, c = (_columns(points[triangles[:, corner]]) for corner in range(3))
        determinant = dot(a, _cross(b, c))
        for powers, value in _coefficients((a, b, c), degree, 1).items():
            totals[powers] += int((determinant * value).sum())
    scale = Fraction(2) ** unit
    center = middle[0] * scale, middle[1] * scale, middle[2] * scale
    values = {p: total * _weight(p) * scale ** (sum(p) + 3) for p, total in totals.items()}
    return VolumeMoments(center, values, dict.fromkeys(values, Fraction(0)))


# --- in doubles, with a bound -----------------------------------------------------------------------------------------


def _sum(terms: NDArray[np.float64]) -> float:
    """Return the sum of an array, added in blocks; each term takes part in at most BLOCK + 1 rounded additions."""
    whole = len(terms) // BLOCK * BLOCK
    return fsum([*terms[:whole].reshape(-1, BLOCK).sum(axis=1).tolist(), *terms[whole:].tolist()])


def _bound(powers: Exponents) -> float:
    """Return a bound of the error of an integral, relative to the sum of the magnitudes of all its terms.

    The bound follows from the number of rounded operations of one term.
    """
    # determinant 8 (edges and corners are differences), coefficient 5 k + 9, product 1, sum BLOCK + 1
    count = 8 + 5 * sum(powers) + 9 + 1 + BLOCK + 1
    return count * ROUNDING * 1.001


def approximate_moments(surface: Surface, degree: int) -> VolumeMoments:
    """Return the integrals over the enclosed volume up to a degree in doubles, each with a bound of its error."""
    lowest, highest = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    middle = lowest / 2 + highest / 2
    shift = frexp(float(np.max(highest - lowest)))[1]
    totals: dict[Exponents, list[float]] = {powers: [] for powers in exponents(degree)}
    sizes: dict[Exponents, list[float]] = {powers: [] for powers in exponents(degree)}
    for start in range(0, len(surface.triangles), CHUNK):
        triangles = surface.triangles[start : start + CHUNK]
        p, q, r = (surface.vertices.take(triangles[:, corner], axis=0) for corner in range(3))
        a, b, c = (_columns(np.ldexp(end - middle, -shift)) for end in (p, q, r))
        # Each triangle spans a tetrahedron with the middle of the bounding box. Edges instead of corners in the
        # determinant keep all digits of triangles that are small and far from the middle.
        first, second = (_columns(np.ldexp(end - p, -shift)) for end in (q, r))
        determinant = dot(a, _cross(first, second))
        for powers, value in _coefficients((a, b, c), degree, 1.0).items():
            totals[powers].append(_sum(determinant * value))
        a, b, c, first, second = (_magnitude(item) for item in (a, b, c, first, second))
        magnitude = dot(a, _cross(first, second, 1))
        for powers, value in _coefficients((a, b, c), degree, 1.0).items():
            sizes[powers].append(float((magnitude * value).sum()))
    scale = Fraction(2) ** shift
    x, y, z = (Fraction(float(item)) for item in middle)
    units = {p: _weight(p) * scale ** (sum(p) + 3) for p in totals}
    return VolumeMoments(
        (x, y, z),
        {p: Fraction(fsum(parts)) * units[p] for p, parts in totals.items()},
        {p: Fraction(fsum(sizes[p]) * _bound(p) + TINY * len(surface.triangles)) * units[p] for p in totals},
    )


def _magnitude(corner: Corner) -> Corner:
    x, y, z = map(np.abs, corner)
    return x, y, z

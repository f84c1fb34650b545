"""Rational points of quadrics, which are the zeros of polynomials of degree 2.

A search gives one point with coordinates such as 3/5; every other point lies on a straight line through that point.
"""

from collections.abc import Sequence
from math import isqrt
from random import Random
from typing import Any

from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement

from symrot.exact.ring.polynomials import value_at

__all__ = ["SIMPLE", "point_of_quadric", "rational_square_root"]

SIMPLE = tuple(
    QQ(above, below)
    for above, below in (
        (0, 1), (1, 1), (-1, 1), (3, 5), (4, 5), (2, 1), (1, 2), (-3, 5), (-4, 5), (1, 3), (2, 3), (3, 1), (-2, 1),
        (-1, 2), (-2, 3), (4, 1), (5, 1), (5, 13), (12, 13),
    )
)  # fmt: skip
"""Numbers that are tried as coordinates of a point, the simplest first."""

TRIES = 60
"""The largest number of attempts to find a first point on a quadric, and of lines tried through this point."""


def rational_square_root(value: Any) -> Any:
    """Return the square root of a rational number if the root is rational, else None."""
    if value < 0:
        return None
    above, below = isqrt(int(value.numerator)), isqrt(int(value.denominator))
    return QQ(above, below) if above**2 == value.numerator and below**2 == value.denominator else None


def point_of_quadric(poly: PolyElement, places: Sequence[int], source: Random) -> dict[int, Any] | None:
    """Return a random rational point at which a polynomial of degree 2 vanishes; None if the search fails.

    The point is a map from the index of each unknown to its value.

    Parameters
    ----------
    poly : PolyElement
        A polynomial of degree 2 over the rationals.
    places : sequence of int
        The indices of the unknowns that occur in it, at least two.
    source : Random
    """
    base = _simple_point(poly, places, source)
    if base is None or source.random() < 0.3:
        return base
    slopes = {n: value_at(poly.diff(n), base) for n in places}
    leading = poly.new({mono: c for mono, c in poly.items() if sum(mono) == 2})
    for _ in range(TRIES):
        line = {n: QQ(source.randint(-5, 5)) for n in places}
        along, curved = sum((slopes[n] * line[n] for n in places), QQ(0)), value_at(leading, line)
        if along and curved:  # the line leaves the point and meets the quadric once more
            return {n: base[n] - along / curved * line[n] for n in places}
    return base


def _simple_point(poly: PolyElement, places: Sequence[int], source: Random) -> dict[int, Any] | None:
    """Return a rational point at which a polynomial of degree 2 vanishes, as {index: value}; None if none is found.

    ``places`` are the indices of the unknowns. All of them but one get values from SIMPLE, which have few digits; the
    value of the last one solves the equation.
    """
    for attempt in range(TRIES):
        last = source.choice(places)
        pool = SIMPLE[: 3 + attempt // 4]
        point = {n: source.choice(pool) for n in places if n != last}
        rest = poly.subs(list(point.items()))
        a, b, c = (rest.coeff(poly.ring.gens[last] ** power if power else 1) for power in (2, 1, 0))
        if a:
            root = rational_square_root(b * b - 4 * a * c)
            if root is None:
                continue
            point[last] = (-b + source.choice((1, -1)) * root) / (2 * a)
        elif b:
            point[last] = -c / b
        else:
            continue
        return point
    return None

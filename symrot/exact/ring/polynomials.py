"""Polynomials of a ring: the variables that occur in them, their values at points, and those in one variable."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from sympy.polys.rings import PolyElement, PolyRing

__all__ = ["occurring", "univariate", "value_at"]


def occurring(polynomials: Iterable[PolyElement]) -> set[int]:
    """Return the indices of the ring's variables that occur in polynomials."""
    return {place for poly in polynomials for mono in poly for place, power in enumerate(mono) if power}


def value_at(poly: PolyElement, values: Mapping[int, Any], number: Callable[[Any], Any] = lambda value: value) -> Any:
    """Return the value of a polynomial at a point.

    Parameters
    ----------
    poly : PolyElement
    values : mapping
        Index of a variable -> its value, for all variables that occur.
    number : callable
        Converts a coefficient to the kind of number that the values are.
    """
    total = number(poly.ring.domain.zero)
    for mono, coefficient in poly.items():
        term = number(coefficient)
        for place, power in enumerate(mono):
            if power:
                term = term * values[place] ** power
        total = total + term
    return total


def univariate(ring: PolyRing, place: int, coefficients: Sequence[int]) -> PolyElement:
    """Return the polynomial in the variable number ``place`` with the given coefficients, lowest power first."""
    generator = ring.gens[place]
    return sum((generator**power * number for power, number in enumerate(coefficients) if number), ring.zero)

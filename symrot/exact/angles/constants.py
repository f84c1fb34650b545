"""Prove that a number made of roots and of cosines of rational multiples of pi is zero or is not zero.

An algebraic integer that is not zero has a smallest possible size, which its conjugates bound. So an interval around
the number that is narrower than this bound decides.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import lcm, prod
from typing import Any

from mpmath import iv
from sympy.polys.rings import PolyElement

from symrot.exact.ring.polynomials import occurring

__all__ = ["MOST_BITS", "Number", "cosine_number", "root_number", "vanishes", "without_zeros"]

MOST_BITS = 40_000
"""Largest working precision, in bits; a sum that would need more is not decided."""

Monomial = tuple[int, ...]

# Separation bound: the product of the conjugates of an algebraic integer other than 0 is a nonzero whole number, so the
# integer is at least B^(1 - D) in size, if B bounds all its conjugates and D is the degree of the field.
# (Burnikel, Funke, Mehlhorn, Schirra, Schmitt, A separation bound for real algebraic expressions, 2001)


@dataclass(frozen=True)
class Number:
    """An algebraic number that is a variable of the polynomial ring: a root, or ``2 cos(pi/order)``."""

    place: int  # index of the variable
    degree: int  # bound on the degree that the number adds to the field
    multiplier: int  # multiplier * number is an algebraic integer
    bound: int  # the conjugates of this algebraic integer are at most 2^bound in size
    order: int = 0  # of a cosine
    index: int = 0  # of a root: 2 for a square root
    inside: PolyElement | None = None  # radicand of a root
    needs: frozenset[int] = frozenset()  # indices of the variables in the radicand


class NotReal(ArithmeticError):
    """The exception for an even root of a negative number, which is not real."""


def cosine_number(place: int, degree: int, order: int) -> Number:
    """Return ``2 cos(pi/order)`` as an algebraic number; ``place`` is the index of its variable in the ring."""
    return Number(place, degree, 1, 1, order)


def root_number(place: int, index: int, inside: PolyElement, known: Mapping[int, Number]) -> Number:
    """Return the root ``inside^(1/index)`` as an algebraic number; ``place`` is the index of its variable in the ring.

    ``inside`` is a polynomial in the numbers ``known`` (index of the variable -> number).
    """
    needs = frozenset(occurring([inside]))
    needs = needs.union(*(known[n].needs for n in needs))
    multiplier, bound = _integral(inside.items(), known)
    # (multiplier g)^index = multiplier^(index - 1) * (multiplier * inside)
    bound = -(-((index - 1) * multiplier.bit_length() + bound) // index)
    return Number(place, index, multiplier, bound, index=index, inside=inside, needs=needs)


def vanishes(poly: PolyElement, known: Mapping[int, Number]) -> bool:
    """Return whether a polynomial in the algebraic numbers ``known`` is proven to be zero.

    ``known`` maps indices of variables to numbers.
    """
    terms = list(poly.items())
    if not terms:
        return True
    if len(terms) == 1:
        return False
    used = occurring([poly])
    used = used.union(*(known[n].needs for n in used))
    multiplier, bound = _integral(terms, known)
    bits = bound * (prod(known[n].degree for n in used) - 1) + multiplier.bit_length()
    before, iv.prec = iv.prec, 100
    try:
        while True:
            size = abs(_enclosed(terms, known, {}))
            if size.a > 0:
                return False
            if size.b < iv.mpf(2) ** -bits:
                return True
            # a proof that needs too many digits is given up
            if iv.prec > min(bits + bound + 200, MOST_BITS):
                return False
            iv.prec = min(4 * iv.prec, bits + bound + 201)
    except NotReal:
        return False
    finally:
        iv.prec = before


def without_zeros(poly: PolyElement, numbers: Mapping[int, Number]) -> PolyElement:
    """Return a polynomial without the terms whose coefficients are proven to be zero.

    A coefficient is a sum of products of the algebraic ``numbers``.
    """
    groups: dict[Monomial, dict[Monomial, Any]] = {}
    for mono, coefficient in poly.items():
        free = tuple(0 if n in numbers else power for n, power in enumerate(mono))
        number = tuple(power if n in numbers else 0 for n, power in enumerate(mono))
        groups.setdefault(free, {})[number] = coefficient
    for free, terms in groups.items():
        # the relations do not show every such zero
        coefficient = poly.new(terms)
        if vanishes(coefficient, numbers):
            poly = poly - coefficient.mul_monom(free)
    return poly


def _integral(terms: Iterable[tuple[Monomial, Any]], known: Mapping[int, Number]) -> tuple[int, int]:
    """Return (multiplier, bits) for the sum of ``terms``: the sum times ``multiplier`` is an algebraic integer.

    All conjugates of this integer have absolute values below 2^bits.
    """
    terms = list(terms)
    most = [max(column) for column in zip(*(mono for mono, _ in terms), strict=True)]
    whole = lcm(*(int(c.denominator) for _, c in terms))
    multiplier = whole * prod(known[n].multiplier ** power for n, power in enumerate(most) if power)
    total = 0
    for mono, c in terms:
        rest = abs(int(c.numerator)) * whole // int(c.denominator)
        for n, power in enumerate(mono):
            if most[n]:
                rest *= known[n].multiplier ** (most[n] - power) << known[n].bound * power
        total += rest
    return multiplier, total.bit_length()


def _enclosed(terms: Sequence[tuple[Monomial, Any]], known: Mapping[int, Number], values: dict[int, Any]) -> Any:
    total = iv.mpf(0)
    for mono, c in terms:
        term = iv.mpf(int(c.numerator)) / int(c.denominator)
        for n, power in enumerate(mono):
            if power:
                if n not in values:
                    values[n] = _value(known[n], known, values)
                term = term * values[n] ** power
        total = total + term
    return total


def _value(number: Number, known: Mapping[int, Number], values: dict[int, Any]) -> Any:
    if number.order:
        return 2 * iv.cos(iv.pi / number.order)
    assert number.inside is not None
    inside = _enclosed(list(number.inside.items()), known, values)
    if not inside.b >= 0:
        raise NotReal
    inside = iv.mpf([max(inside.a, 0), inside.b])
    if number.index == 2:
        return iv.sqrt(inside)
    if not inside.a > 0:
        raise NotReal
    return iv.exp(iv.log(inside) / number.index)

"""Bounds of a formula that hold for all real values of its symbols.

``cos(x) - 2`` lies between -3 and -1, so ``sqrt(cos(x) - 2)`` is not real for any x. Bounds are fractions or infinite.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import inf
from typing import Any

import sympy
from sympy import Expr

from symrot.exact.domain.needs import Need, is_leaf
from symrot.exact.intervals import enclosure, fraction_of_end

__all__ = [
    "REALS",
    "Range",
    "fails_everywhere",
    "power_of_range",
    "product_of_ranges",
    "range_everywhere",
    "sum_of_ranges",
]

Bound = Any  # Fraction or +-inf
Range = tuple[Bound, Bound]

REALS: Range = (-inf, inf)
MOST_BITS = 2000
"""Largest size of a bound, in bits; with a larger one, both bounds of a formula are replaced by infinite bounds."""


def fails_everywhere(need: Need) -> bool:
    """Return whether a condition (:class:`Need`), such as ``cos(x) - 2 >= 0``, is proven to hold at no real point."""
    low, high = range_everywhere(need.formula)
    return bool({">= 0": high < 0, "> 0": high <= 0, "!= 0": low == high == 0}.get(need.sign, False))


def range_everywhere(formula: Expr) -> Range:
    """Return (low, high): bounds of a formula at all real points where it is defined, -3 and -1 for ``cos(x) - 2``."""
    # an unknown bound is infinite
    return _range(formula, {})


def _range(node: Expr, known: dict[Expr, Range]) -> Range:
    if node not in known:
        low, high = _computed(node, known)
        size = [abs(bound.numerator).bit_length() for bound in (low, high) if isinstance(bound, Fraction)]
        known[node] = REALS if max(size, default=0) > MOST_BITS or low > high else (low, high)
    return known[node]


def _computed(node: Expr, known: dict[Expr, Range]) -> Range:
    if node.is_Rational:
        return Fraction(int(node.p), int(node.q)), Fraction(int(node.p), int(node.q))
    if is_leaf(node):
        return (Fraction(0) if node.is_nonnegative else -inf), (Fraction(0) if node.is_nonpositive else inf)
    if not node.free_symbols and not any(map(is_leaf, sympy.preorder_traversal(node))):
        return _of_number(node)
    parts = [_range(part, known) for part in node.args]
    if node.is_Add or node.is_Mul:
        total = parts[0]
        for part in parts[1:]:
            total = sum_of_ranges(total, part) if node.is_Add else product_of_ranges(total, part)
        return total
    if node.is_Pow:
        return _power(parts[0], node.exp)
    return _OF[type(node)](*parts) if type(node) in _OF else REALS


def _of_number(node: Expr) -> Range:
    held = enclosure(node)
    if held is None:
        return REALS
    try:
        return _end(held.a), _end(held.b)
    except OverflowError:  # exp(-3000): only its sign is used
        return (Fraction(0) if held.a >= 0 else -inf), (Fraction(0) if held.b <= 0 else inf)


def _end(value: Any) -> Fraction:
    """Return an endpoint of an mpmath interval as an exact fraction.

    Raise OverflowError if it is too large or too small.
    """
    _, _, power, _ = value._mpi_[0]
    if abs(power) > MOST_BITS:
        raise OverflowError
    return fraction_of_end(value)


def sum_of_ranges(a: Range, b: Range) -> Range:
    """Return the bounds of x + y for x in the range ``a`` and y in the range ``b``."""
    low, high = (next((end for end in ends if end in (inf, -inf)), ends[0] + ends[1] if _finite(ends) else None)
                 for ends in zip(a, b, strict=True))  # fmt: skip
    return low, high


def _finite(ends: Sequence[Bound]) -> bool:
    return all(isinstance(end, Fraction) for end in ends)


def product_of_ranges(a: Range, b: Range) -> Range:
    """Return the bounds of x*y for x in the range ``a`` and y in the range ``b``."""
    ends = [_product(x, y) for x in a for y in b]
    return min(ends), max(ends)


def _product(x: Bound, y: Bound) -> Bound:
    if not x or not y:
        return Fraction(0)
    if _finite((x, y)):
        return x * y
    return inf if (x > 0) == (y > 0) else -inf


def _power(base: Range, exponent: Expr) -> Range:
    low, high = base
    if not exponent.is_Rational:
        return Fraction(0), inf  # range of a power of a positive number
    if exponent.q > 1:
        return (Fraction(0), inf)
    power = int(exponent)
    if power < 0:
        return (Fraction(0), inf) if power % 2 == 0 or low >= 0 else (-inf, Fraction(0)) if high <= 0 else REALS
    return power_of_range(base, power)


def power_of_range(base: Range, power: int) -> Range:
    """Return the bounds of x^power for x in the range ``base``; the power is a whole number above zero."""
    low, high = base
    ends = (low**power, high**power)
    if power % 2:
        return ends
    return (Fraction(0) if low <= 0 <= high else min(ends)), max(ends)


def _monotone(function: Callable[[Expr], Expr], least: Bound, most: Bound) -> Callable[[Range], Range]:
    """Return a function from the range of u to that of f(u), for a rising f with values from ``least`` to ``most``."""

    def of(argument: Range) -> Range:
        # the limits replace f(low) and f(high) where these have no finite value: log(0) is -infinity
        low, high = (_at(function, end) for end in argument)
        return (least if low is None else low[0]), (most if high is None else high[1])

    return of


def _at(function: Callable[[Expr], Expr], end: Bound) -> Range | None:
    if not isinstance(end, Fraction):
        return None
    held = enclosure(function(sympy.Rational(end.numerator, end.denominator)))
    try:
        return None if held is None else (_end(held.a), _end(held.b))
    except OverflowError:
        return None


def _absolute(argument: Range) -> Range:
    low, high = argument
    return (Fraction(0) if low <= 0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))


def _between(low: Bound, high: Bound) -> Callable[..., Range]:
    return lambda *arguments: (low, high)


ZERO, ONE, PI = Fraction(0), Fraction(1), Fraction(22, 7)  # above pi

_OF: dict[type, Callable[..., Range]] = {
    sympy.sin: _between(-ONE, ONE),
    sympy.cos: _between(-ONE, ONE),
    sympy.tanh: _between(-ONE, ONE),
    sympy.sign: _between(-ONE, ONE),
    sympy.asin: _between(-PI / 2, PI / 2),
    sympy.atan: _between(-PI / 2, PI / 2),
    sympy.acos: _between(ZERO, PI),
    sympy.atan2: _between(-PI, PI),
    sympy.exp: _monotone(sympy.exp, ZERO, inf),
    sympy.log: _monotone(sympy.log, -inf, inf),
    sympy.cosh: _between(ONE, inf),
    sympy.acosh: _between(ZERO, inf),
    sympy.Abs: _absolute,
}

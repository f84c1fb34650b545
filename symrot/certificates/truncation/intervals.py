"""Intervals of real numbers, from mpmath, and the functions of intervals that rates may contain."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from functools import lru_cache
from math import inf, nextafter
from typing import Any

from mpmath import iv

from symrot.errors import InputError
from symrot.exact.intervals import arc_tangent

__all__ = ["FUNCTIONS", "Functions", "interval", "number", "precision", "quotient", "range_of", "root", "upper"]

BITS = 64  # of the ends of intervals


@contextmanager
def precision() -> Iterator[None]:
    """Run a ``with`` block in which mpmath computes the ends of intervals with ``BITS`` bits."""
    before, iv.prec = iv.prec, BITS
    try:
        yield
    finally:
        iv.prec = before


def number(value: Fraction) -> Any:
    """Return an interval that contains a fraction, about as narrow as the precision allows."""
    return _number(value, iv.prec)


@lru_cache(maxsize=4096)
def _number(value: Fraction, bits: int) -> Any:
    return iv.mpf(value.numerator) / value.denominator


def interval(low: Fraction, high: Fraction) -> Any:
    """Return an interval that contains all numbers from ``low`` to ``high``."""
    return iv.mpf([number(low).a, number(high).b])


def upper(value: Any) -> float:
    """Return a float that is not less than any number in an interval."""
    near = float(value.b)
    return near if iv.mpf(near) >= value.b else nextafter(near, inf)


def quotient(above: Any, below: Any) -> Any:
    """Return a quotient of intervals or whole numbers; raise ZeroDivisionError if the divisor may be zero."""
    if not isinstance(below, int) and 0 in below:
        raise ZeroDivisionError
    if isinstance(above, int) and isinstance(below, int):
        # as a float, 1/3 would not be in the interval of any value computed from it
        return above // below if above % below == 0 else iv.mpf(above) / below
    return above / below


def range_of(terms: list[tuple[Fraction, tuple[tuple[str, int], ...]]], values: Mapping[str, Any]) -> Any:
    """Return an interval that contains all values of a polynomial on a box.

    Parameters
    ----------
    terms : list
        The terms of the polynomial, as :meth:`PackedPolynomial.terms` returns them.
    values : mapping
        The interval of each variable, by name.
    """
    total = iv.mpf(0)
    for value, powers in terms:
        term = number(value)
        for name, power in powers:
            # the interval of an even power contains no negative numbers
            term = term * values[name] ** power
        total = total + term
    return total


def _positive(x: Any) -> Any:
    """Return the interval ``x`` if all its numbers are positive; otherwise raise ZeroDivisionError."""
    if not x.a > 0:
        raise ZeroDivisionError
    return x


def root(x: Any) -> Any:
    """Return the interval of the square roots of positive numbers; raise ZeroDivisionError for other numbers."""
    return iv.sqrt(_positive(x))


FUNCTIONS: Mapping[str, Callable[[Any], Any]] = {
    "sqrt": root, "sin": iv.sin, "cos": iv.cos, "tan": lambda x: quotient(iv.sin(x), iv.cos(x)), "exp": iv.exp,
    "log": lambda x: iv.log(_positive(x)), "sinh": lambda x: (iv.exp(x) - iv.exp(-x)) / 2,
    "cosh": lambda x: (iv.exp(x) + iv.exp(-x)) / 2, "tanh": lambda x: 1 - 2 / (iv.exp(2 * x) + 1),
    "atan": lambda x: arc_tangent(x, iv.mpf(1)),
}  # fmt: skip
"""Functions of intervals by name; where sqrt, log or tan may not be differentiable, they raise ZeroDivisionError."""


class Functions(dict[str, Callable[..., Any]]):
    """A map from names to functions; the value of any other name is a function that raises InputError."""

    def __missing__(self, name: str) -> Callable[..., Any]:
        def refuse(*arguments: Any) -> Any:
            raise InputError(
                f"expected rates that contain only + - * / and the functions {', '.join(FUNCTIONS)}, so that the "
                f"truncation error of a step can be bounded, got {name}"
            )

        return refuse

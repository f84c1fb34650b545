"""Multiples of inverse trigonometric functions, as angles whose sine and cosine are known."""

from collections.abc import Iterator
from fractions import Fraction

from sympy import Expr

from symrot.exact.angles.angles import LinearForm
from symrot.exact.angles.inverse import INVERSE, cosine_sine

__all__ = ["halved", "is_bound", "parts_of", "unbound"]


def is_bound(atom: Expr, coefficient: Fraction) -> bool:
    """Return whether the sine and cosine of a multiple of an atom are known.

    They are for an inverse function times an integer, or divided by a power of two.
    """
    return type(atom) in INVERSE and coefficient.denominator in (1, 2, 4, 8)


def unbound(form: LinearForm) -> LinearForm:
    """Return an angle without those parts whose sine and cosine are known."""
    return LinearForm(tuple(term for term in form.terms if not is_bound(*term)), form.half_turns)


def halved(coefficient: Fraction) -> Iterator[tuple[int, int]]:
    """Yield pairs (h, n) such that a multiple of an angle is the sum of n times the angle halved h times."""
    left, halvings = coefficient, 0
    while left:
        times = int(left)
        if times:
            yield halvings, times
        left, halvings = 2 * (left - times), halvings + 1


def parts_of(atom: Expr, coefficient: Fraction) -> list[Expr]:
    """Return the cosines and sines from which the cosine and sine of a multiple of an inverse function are formed."""
    return [part for halvings, _ in halved(coefficient) for part in cosine_sine(atom, halvings)]

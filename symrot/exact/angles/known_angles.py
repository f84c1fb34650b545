"""Multiples of inverse trigonometric functions, as angles whose sine and cosine can be computed."""

from collections.abc import Iterator
from fractions import Fraction

from sympy import Expr

from symrot.exact.angles.angles import LinearForm
from symrot.exact.angles.inverse import INVERSE, cosine_sine

__all__ = ["halved", "is_bound", "parts_of", "unbound"]


def is_bound(atom: Expr, coefficient: Fraction) -> bool:
    """Return whether the sine and cosine of ``coefficient * atom`` can be computed.

    They can if the atom is an inverse trigonometric function and the denominator of the coefficient is a power of two.
    """
    return type(atom) in INVERSE and coefficient.denominator in (1, 2, 4, 8)


def unbound(form: LinearForm) -> LinearForm:
    """Return an angle without its multiples of inverse trigonometric functions (see :func:`is_bound`)."""
    return LinearForm(tuple(term for term in form.terms if not is_bound(*term)), form.half_turns)


def halved(coefficient: Fraction) -> Iterator[tuple[int, int]]:
    """Yield pairs (h, n) such that ``coefficient`` times an angle is the sum of n times the angle halved h times."""
    left, halvings = coefficient, 0
    while left:
        times = int(left)
        if times:
            yield halvings, times
        left, halvings = 2 * (left - times), halvings + 1


def parts_of(atom: Expr, coefficient: Fraction) -> list[Expr]:
    """Return the cosines and sines that make up the cosine and sine of a multiple of an inverse function."""
    return [part for halvings, _ in halved(coefficient) for part in cosine_sine(atom, halvings)]

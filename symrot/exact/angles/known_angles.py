"""Multiples of inverse trigonometric functions, such as 2 asin(u), as angles whose sine and cosine are computable."""

from collections.abc import Iterator
from fractions import Fraction

from sympy import Expr

from symrot.exact.angles.angles import LinearForm
from symrot.exact.angles.inverse import INVERSE, cosine_sine

__all__ = ["halved", "is_bound", "parts_of", "unbound"]


def is_bound(atom: Expr, coefficient: Fraction) -> bool:
    """Return whether ``coefficient * atom`` has a sine and a cosine made of roots alone, as ``2*asin(u)`` has."""
    # halving an angle whose cosine and sine are known gives square roots
    return type(atom) in INVERSE and coefficient.denominator in (1, 2, 4, 8)


def unbound(form: LinearForm) -> LinearForm:
    """Return an angle without its multiples of inverse functions (see :func:`is_bound`): ``x + 2*asin(u)`` gives x."""
    return LinearForm(tuple(term for term in form.terms if not is_bound(*term)), form.half_turns)


def halved(coefficient: Fraction) -> Iterator[tuple[int, int]]:
    """Yield pairs (h, n) for which ``coefficient`` is the sum of all n/2^h: 5/4 gives (0, 1) and (2, 1)."""
    left, halvings = coefficient, 0
    while left:
        times = int(left)
        if times:
            yield halvings, times
        left, halvings = 2 * (left - times), halvings + 1


def parts_of(atom: Expr, coefficient: Fraction) -> list[Expr]:
    """Return cosines and sines from which those of ``coefficient * atom`` follow by the formulas for sums of angles.

    They are listed as cos, sin, cos, sin, ..: for 5/4, cosine and sine of ``atom``, then of ``atom/4``.

    Examples
    --------
    >>> from sympy import asin, symbols
    >>> u = symbols("u", real=True)
    >>> parts_of(asin(u), Fraction(2))  # cos(asin(u)) and sin(asin(u)), which give cos(2*asin(u)) and sin(2*asin(u))
    [sqrt(1 - u**2), u]
    """
    return [part for halvings, _ in halved(coefficient) for part in cosine_sine(atom, halvings)]

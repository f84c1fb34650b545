"""Known angles: multiples of inverse trigonometric functions, such as 2 asin(u), whose sine and cosine are roots."""

from collections.abc import Iterator
from fractions import Fraction

from sympy import Expr

from symrot.exact.angles.angles import LinearForm
from symrot.exact.angles.inverse import INVERSE, cosine_sine

__all__ = ["halved", "is_known_angle", "parts_of", "without_known_angles"]


def is_known_angle(atom: Expr, coefficient: Fraction) -> bool:
    """Return whether the sine and cosine of ``coefficient * atom`` can be written with roots instead of functions.

    ``atom`` must be an inverse trigonometric function, and the denominator of ``coefficient`` at most 8 and a power of
    two. For ``2*asin(u)`` the result is True: its sine is ``2*u*sqrt(1 - u^2)``. For ``2*x`` it is False.
    """
    # halving an angle whose cosine and sine are known gives square roots
    return type(atom) in INVERSE and coefficient.denominator in (1, 2, 4, 8)


def without_known_angles(form: LinearForm) -> LinearForm:
    """Return an angle without its terms that are known angles, such as ``2*asin(u)``: ``x + 2*asin(u)`` gives x."""
    return LinearForm(tuple(term for term in form.terms if not is_known_angle(*term)), form.half_turns)


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

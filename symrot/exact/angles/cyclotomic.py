"""Sines and cosines of rational multiples of pi other than multiples of pi/24, as polynomials in one number.

With ``g = 2 cos(pi/N)``, N even, ``2 cos(k pi/N)`` is a polynomial in g with integer coefficients. A sine is the cosine
of the complementary angle.
"""

from fractions import Fraction
from functools import cache

from sympy import Poly, cyclotomic_poly, totient
from sympy.abc import x

__all__ = [
    "LARGEST_DEGREE",
    "degree",
    "doubled_cosine",
    "has_affordable_degree",
    "minimal_polynomial",
    "multiples",
    "order",
]

LARGEST_DEGREE = 160
"""Largest degree of a minimal polynomial: multiples of pi/180 need 48, multiples of pi/360 need 96.

Beyond it a constant stays a symbol."""


def order(denominator: int) -> int:
    """Return the smallest even multiple N of ``denominator``.

    The cosines and sines of all k pi/denominator are then polynomials in 2 cos(pi/N).

    Examples
    --------
    >>> order(7), order(18)
    (14, 18)
    """
    return denominator if denominator % 2 == 0 else 2 * denominator


def has_affordable_degree(denominator: int) -> bool:
    """Return whether the algebraic number 2 cos(pi/N) has a degree of at most LARGEST_DEGREE.

    If so, cosines of multiples of pi/denominator are written as polynomials in the number. N is ``order(denominator)``,
    the smallest even multiple of the denominator.
    """
    # beyond this degree the polynomials would be too long: the sines and cosines stay symbols
    return order(denominator) <= 12 * LARGEST_DEGREE and degree(order(denominator)) <= LARGEST_DEGREE


def degree(n: int) -> int:
    """Return the degree over the rationals of the algebraic number 2 cos(pi/n), n >= 2."""
    return int(totient(2 * n)) // 2


@cache
def minimal_polynomial(n: int) -> tuple[int, ...]:
    """Return the coefficients, lowest power first, of the minimal polynomial of 2 cos(pi/n), n >= 2; the last is 1."""
    # the cyclotomic polynomial of order 2n is x^d M(x + 1/x), with the minimal polynomial M of degree d
    symmetric = [int(c) for c in Poly(cyclotomic_poly(2 * n, x), x).all_coeffs()]
    middle = len(symmetric) // 2
    total = [symmetric[middle]] + [0] * middle
    before, last = [2], [0, 1]  # x^j + x^-j in g = x + 1/x: 2, g, g^2 - 2, ..
    for j in range(1, middle + 1):
        for power, coefficient in enumerate(last):
            total[power] += symmetric[middle + j] * coefficient
        before, last = last, _minus([0, *last], before)
    return tuple(total)


@cache
def doubled_cosine(times: int, n: int) -> tuple[int, ...]:
    """Return the coefficients, lowest power first, of 2 cos(times pi/n) as a polynomial in g = 2 cos(pi/n)."""
    times = abs(times) % (2 * n)
    times = min(times, 2 * n - times)
    relation = minimal_polynomial(n)
    before, last = [2], _rest([0, 1], relation)
    if times == 0:
        return tuple(before)
    for _ in range(times - 1):
        before, last = last, _rest(_minus([0, *last], before), relation)
    return tuple(last)


def multiples(turns: Fraction, n: int) -> tuple[int, int]:
    """Return whole numbers (k, l) with ``cos(turns*pi) = cos(k*pi/n)`` and ``sin(turns*pi) = cos(l*pi/n)``.

    ``n`` must be even, and the product ``n * turns`` a whole number.

    Examples
    --------
    >>> multiples(Fraction(2, 7), 14)
    (4, 3)
    """
    k = int(turns * n)
    return k, n // 2 - k


def _minus(first: list[int], second: list[int]) -> list[int]:
    return [a - (second[n] if n < len(second) else 0) for n, a in enumerate(first)]


def _rest(poly: list[int], relation: tuple[int, ...]) -> list[int]:
    """Return the remainder of the division of ``poly`` by the monic polynomial ``relation``.

    Both are lists of coefficients, lowest power first.
    """
    poly = list(poly)
    size = len(relation) - 1
    while len(poly) > size:
        lead = poly.pop()
        if lead:
            for power in range(size):
                poly[len(poly) - size + power] -= lead * relation[power]
    return poly

"""Angles as linear combinations of atoms with rational coefficients; atoms are symbols, or products such as ``x*y``.

``2*phi - psi/2 + pi/3`` has the linear form ``{phi: 2, psi: -1/2}`` plus ``1/3`` of pi. All multiples of one atom that
occur, such as theta/2 and theta/3, are whole multiples of its base angle, here theta/6 (``docs/exact_decisions.md``,
section 4).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from math import gcd, lcm

from sympy import Expr, Rational, chebyshevt_poly, chebyshevu_poly, cos, pi, sin, sqrt

from symrot.errors import InputError

PARTS = 24
"""Number n such that sines and cosines of multiples of pi/n are numbers in the field Q(sqrt 2, sqrt 3, cos(pi/8)).

For other fractions of pi, pi is an atom like a symbol.
"""


@dataclass(frozen=True)
class LinearForm:
    """An angle in rad as ``sum(coefficient * atom) + half_turns * pi``: a linear combination of atoms.

    An atom is a symbol or another expression without a rational coefficient: ``2*phi + 3*x*y`` has the atoms ``phi``
    and ``x*y``.
    """

    terms: tuple[tuple[Expr, Fraction], ...]  # pairs (atom, coefficient); no atom is rational
    # a multiple of 1/24, from 0 to below 2 (full turns are left out); a constant angle with another denominator is a
    # term with the atom ``pi``
    half_turns: Fraction


def linear_form(argument: Expr, turns: bool = True) -> LinearForm:
    """Return the linear form of an angle (rad): ``2*phi - psi/2 + pi/3`` gives ``{phi: 2, psi: -1/2}`` plus 1/3 of pi.

    With ``turns`` false, a multiple of pi is a term like any other, with the atom ``pi``.

    Raises
    ------
    InputError
        If the angle contains a floating point number.
    """
    coefficients: dict[Expr, Fraction] = {}
    half_turns = Fraction(0)
    for term in argument.expand().as_ordered_terms():
        number, atom = term.as_coeff_Mul()
        if not number.is_Rational:
            raise InputError(f"expected rational coefficients, such as 1/2, in an angle; got {number} in {argument}")
        coefficient = Fraction(int(number.p), int(number.q))
        # false for the exponent of an exponential
        if turns and atom == pi and PARTS % coefficient.denominator == 0:
            half_turns += coefficient
        elif coefficient:
            coefficients[atom] = coefficients.get(atom, Fraction(0)) + coefficient
    terms = sorted(((a, c) for a, c in coefficients.items() if c), key=lambda item: item[0].sort_key())
    return LinearForm(tuple(terms), half_turns % 2)


def base_coefficients(forms: Iterable[LinearForm]) -> dict[Expr, Fraction]:
    """Return, for each atom, the greatest common divisor of its coefficients in all ``forms``.

    The angles theta and theta/2 give ``{theta: 1/2}``.
    """
    bases: dict[Expr, Fraction] = {}
    for form in forms:
        for atom, coefficient in form.terms:
            known = bases.get(atom, Fraction(0))
            denominator = lcm(known.denominator, coefficient.denominator)
            bases[atom] = Fraction(gcd(int(known * denominator), int(coefficient * denominator)), denominator)
    return bases


def constant_cosine_sine(half_turns: Fraction) -> tuple[Expr, Expr]:
    """Return the exact cosine and sine of ``half_turns * pi``, a multiple of pi/24, in square roots and cos(pi/8)."""
    odd = half_turns * PARTS % 2 == 1
    rest = half_turns - Fraction(1, 8) if odd else half_turns
    angle = Rational(rest.numerator, rest.denominator) * pi
    cosine, sine = cos(angle), sin(angle)
    if not odd:
        return cosine, sine
    # only cos(pi/8) is a new root: sin(pi/8) would be a second one that depends on it
    c8 = cos(pi / 8)
    s8 = (sqrt(2) - 1) * c8
    return cosine * c8 - sine * s8, sine * c8 + cosine * s8


def base_angle(atom: Expr, coefficient: Fraction) -> Expr:
    """Return the base angle ``coefficient * atom`` in rad, such as ``theta/2``, as an expression."""
    return Rational(coefficient.numerator, coefficient.denominator) * atom


@cache
def chebyshev(multiple: int) -> tuple[list[int], list[int]]:
    """Return the Chebyshev polynomials T_n and U_(n-1), n = ``multiple`` >= 1, as lists of integer coefficients.

    The lowest power comes first.
    """
    # cos(n x) = T_n(cos x) and sin(n x) = sin(x) U_(n-1)(cos x)
    first, second = (
        polynomial(degree, polys=True).all_coeffs()
        for polynomial, degree in ((chebyshevt_poly, multiple), (chebyshevu_poly, multiple - 1))
    )
    return [int(c) for c in reversed(first)], [int(c) for c in reversed(second)]

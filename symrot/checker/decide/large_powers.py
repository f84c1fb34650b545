"""Equations with powers too large to be expanded, such as ``(a - x)**6000 == (x - a)**6000``.

Among the powers of a base u, the smallest becomes a letter Z, and others become ``Z u^m``. An equation that holds for
all values of the letters holds for the powers. A false one is refuted at a point.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice, product
from typing import Any

from mpmath import iv, mpf, nstr, workdps
from sympy import Dummy, Expr, Mul, Pow, Rational, pi, preorder_traversal

from symrot.exact.angles import cyclotomic
from symrot.exact.angles.angles import base_coefficients, linear_form
from symrot.exact.decide import is_zero
from symrot.exact.domain.known_points import holds
from symrot.exact.domain.needs import Need, leaves_of, needs_of
from symrot.exact.evidence import Counterexample
from symrot.exact.intervals import DIGITS, enclosure

__all__ = ["LARGEST_DEGREE", "ShorterPowers", "degree_of", "point_of_difference", "shorter_powers"]

LARGEST_DEGREE = 240
"""The largest degree in symbols, sines and cosines of a formula that is expanded."""

LARGEST_EXPANDED = 64
"""A power is replaced by a letter if its exponent times the degree of its base is larger than this."""

HIGHEST_OF_BASE = 4
"""The largest n for which the bases of large powers are compared: the comparison tests whether one base is the n-th
power of another base, up to the sign. For instance, ``1 - cos(x)**2`` is the second power of sin(x)."""

MOST_POINTS = 500
MOST_BASES = 12
VALUES = tuple(Rational(n, d) for n, d in ((1, 1), (0, 1), (-1, 1), (2, 1), (-2, 1), (1, 2), (1, 3)))
"""Values that symbols get in the search for a point at which the sides differ."""

LONGEST_WHOLE_NUMBER = 40
"""The largest number of digits of a whole number that is written exactly."""

DIGITS_WRITTEN = (10, 20, 30, 40, 50)
"""Numbers of digits for writing the values of both sides at a counterexample, tried in turn until the two values differ
as texts."""


# -- the degree of formulas -------------------------------------------------------------------------------------------


def degree_of(formulas: Sequence[Expr]) -> int:
    """Return an upper bound on the largest degree of a formula in ``formulas`` after multiplying out; 0 for no formula.

    The degree is in symbols, sines and cosines: 3 for ``x*sin(y)^2``.
    """
    # a large degree shows early that an expansion would take too long
    plain = sum(map(_size, formulas)) <= LARGEST_DEGREE
    bases = {} if plain else _base_multiples(formulas)
    known: dict[Expr, int] = {}
    return max((_degree(formula, known, bases) for formula in formulas), default=0)


def _size(formula: Expr) -> int:
    return _degree(formula, {}, {})


def _base_multiples(formulas: Sequence[Expr]) -> Mapping[Expr, Fraction]:
    """Return {x: b}, where b is the greatest common divisor of the coefficients of x in the arguments of functions.

    The formulas sin(x/2) and sin(3*x) give {x: 1/2}.
    """
    arguments = {
        node.args[0]
        for formula in formulas
        for node in preorder_traversal(formula)
        if node.is_Function and len(node.args) == 1
    }
    # in the sine and cosine of x/2, sin(3*x) has the degree 6
    return base_coefficients(linear_form(argument, turns=False) for argument in arguments)


def _degree(node: Expr, known: dict[Expr, int], bases: Mapping[Expr, Fraction]) -> int:
    """Return an upper bound on the degree of a formula's numerator plus that of its denominator.

    ``known`` stores results; ``bases`` is a result of :func:`_base_multiples`.
    """
    if node not in known:
        below = [_degree(part, known, bases) for part in node.args]
        if isinstance(node, Mul):
            known[node] = sum(below)
        elif isinstance(node, Pow) and node.exp.is_Rational:
            known[node] = below[0] * max(1, abs(int(node.exp.p)))
        elif node.is_Function and len(node.args) == 1 and not node.args[0].is_Symbol:
            known[node] = max(_angle_degree(node.args[0], bases), 1)
        elif node.is_number:
            known[node] = 0
        else:
            known[node] = max([*below, 1]) if not node.is_Add else max(below)
    return known[node]


def _angle_degree(argument: Expr, bases: Mapping[Expr, Fraction]) -> int:
    """Return roughly the degree of ``sin(argument)``, written as a polynomial in sines and cosines of base angles.

    The base angle of a symbol x is b*x if ``bases`` maps x to b: a term c*x of the argument then adds c/b. If ``bases``
    lacks x, a term ``(p/q)*x`` adds p*q: ``3*x + y/2`` gives 3 + 2.
    """
    total = 0
    for term in argument.as_ordered_terms() if argument.is_Add else [argument]:
        number, atom = term.as_coeff_Mul()
        constant = atom is pi and cyclotomic.has_affordable_degree(int(number.q))
        if atom in bases and number.is_Rational:
            total += abs(int(Fraction(int(number.p), int(number.q)) / bases[atom]))
        else:
            total += abs(int(number.p)) * int(number.q) if number.is_Rational and not constant else 1
    return total


# -- powers as letters ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ShorterPowers:
    """Formulas in which letters replace large powers.

    Attributes
    ----------
    formulas : tuple of Expr
    bases : mapping
        Letter -> the base of its power.
    """

    formulas: tuple[Expr, ...]
    bases: Mapping[Expr, Expr]


def shorter_powers(formulas: Sequence[Expr]) -> ShorterPowers | None:
    """Return ``formulas`` with letters for large powers, Z for ``(a - x)**6000``; None without large powers, or with
    too many bases.
    """
    powers = {node for formula in formulas for node in formula.atoms(Pow) if node.exp.is_Integer}
    large = {node for node in powers if abs(node.exp) * max(1, _size(node.base)) > LARGEST_EXPANDED}
    bases: dict[Expr, dict[Expr, int]] = {}
    for base in sorted({node.base for node in large}, key=lambda base: (_size(base), str(base))):
        # with another power of sin(x), (1 - cos(x)**2)**64 becomes sin(x)**128
        same, power = next(((other, power) for other in bases for power in range(1, HIGHEST_OF_BASE + 1)
                            if _equal_up_to_sign(base, other**power)), (base, 1))  # fmt: skip
        bases.setdefault(same, {})[base] = power
    if not large or len(bases) > MOST_BASES:
        return None
    values: dict[Expr, Expr] = {}
    letters: dict[Expr, Expr] = {}
    for base, members in bases.items():
        own = [node for node in large if node.base in members]
        least = min(abs(int(node.exp)) * members[node.base] for node in own)
        letter = Dummy("Z", real=True)
        letters[letter] = base
        for node in own:
            direction = 1 if node.exp > 0 else -1
            rest = abs(int(node.exp)) * members[node.base] - least
            sign = 1 if is_zero(node.base - base ** members[node.base]) else (-1) ** int(node.exp)
            values[node] = sign * letter**direction * base ** (direction * rest)
    return ShorterPowers(tuple(formula.xreplace(values) for formula in formulas), letters)


def _equal_up_to_sign(first: Expr, second: Expr) -> bool:
    return first == second or is_zero(first - second) or is_zero(first + second)


# -- points at which the sides differ ---------------------------------------------------------------------------------


def point_of_difference(left: Expr, right: Expr, stated: Sequence[Need]) -> Counterexample | None:
    """Return a point with small numbers where the sides are real and differ, and the conditions ``stated`` hold; or
    None.
    """
    leaves = leaves_of([left, right, *(need.formula for need in stated)])
    needs = [*needs_of([left, right]), *stated]
    for numbers in islice(product(VALUES, repeat=len(leaves)), MOST_POINTS):
        point = dict(zip(leaves, numbers, strict=True))
        sides = [enclosure(side, point) for side in (left, right)]
        if None in sides or 0 in iv.mpf(0) + sides[0] - sides[1]:
            continue
        if all(holds(need, point) for need in needs):
            texts = ([_written(side, digits) for side in sides] for digits in DIGITS_WRITTEN)
            return Counterexample(tuple(point.items()), None, *next(pair for pair in texts if pair[0] != pair[1]))
    return None


def _written(value: Any, digits: int) -> str:
    """Return the middle of an interval as text: a short integer if exact, otherwise ``digits`` digits: ``3.1416..``."""
    middle = mpf(value.mid)
    if value.a == value.b and middle == int(middle) and len(str(int(middle))) <= LONGEST_WHOLE_NUMBER:
        return str(int(middle))
    with workdps(DIGITS):
        return f"{nstr(middle, digits)}.."

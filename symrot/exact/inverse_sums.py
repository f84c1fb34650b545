"""Proofs that sums of inverse trigonometric functions, or of logarithms, are zero.

The proof takes the sine and cosine, or the exponential, of the sum, and bounds the range of the sum.

A rational combination D of ``asin``, ``acos``, ``atan``, ``atan2`` and ``pi`` is zero if ``sin D = 0``, ``cos D = 1``
and D lies strictly between -2 pi and 2 pi. If D only lies between -4 pi and 4 pi, ``sin(D/2) = 0`` and ``cos(D/2) = 1``
show that it is zero. A real D with logarithms is zero if and only if ``exp D = 1``.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mpmath import iv
from sympy import Abs, Expr, Integer, Rational, acos, asin, atan, atan2, cos, exp, log, pi, sin, tan
from sympy.polys.rings import PolyElement

from symrot.errors import InputError
from symrot.exact.angles.inverse import INVERSE, range_of
from symrot.exact.floats import seems_zero
from symrot.exact.intervals import enclosure
from symrot.exact.ring.ring import FormulaRing
from symrot.exact.sign_cases import vanishes_for_all_signs

__all__ = ["Lift", "PrincipalValueProof", "lifts", "principal", "proof", "vanishes"]

MOST_TERMS = 60
"""Largest number of terms of a residual that is factored."""

_NAMES = (*INVERSE, log)


@dataclass(frozen=True)
class Lift:
    """A sufficient condition for a polynomial to be zero: polynomials of another ``ring`` (``numerators``) are zero.

    A lift of ``asin(x) + acos(x) - pi/2`` says that its sine is 0 and its cosine 1; asin and acos do not occur in it.
    """

    ring: FormulaRing
    numerators: tuple[PolyElement, ...]


def vanishes(ring: FormulaRing, numerator: PolyElement) -> bool:
    """Return whether the polynomial ``numerator`` of the ring is proven to be zero; see :func:`proof`."""
    return proof(ring, numerator) is not None


def proof(ring: FormulaRing, numerator: PolyElement) -> tuple[FormulaRing, ...] | None:
    """Prove that the polynomial ``numerator`` of the ring, such as the numerator of left - right, is zero.

    Return None if no proof was found. The proof may show that a factor such as ``D = asin(x) + acos(x) - pi/2`` is
    zero, by computing sin D and cos D in another polynomial ring. The result has these further rings; it is () if the
    relations of ``ring`` suffice. The proof holds where no divisor in these rings is zero.
    """
    numerator = ring.reduce(numerator)
    if not numerator:
        return ()
    if vanishes_for_all_signs(ring, numerator):
        return ()
    for lift in lifts(ring, numerator, only_zero=not ring.hypotheses):
        further = [proof(lift.ring, poly) for poly in lift.numerators]
        if None not in further:
            return (lift.ring, *(other for rings in further if rings for other in rings))
    return None


def lifts(ring: FormulaRing, numerator: PolyElement, only_zero: bool = False) -> Iterator[Lift]:
    """Yield conditions, each of which is sufficient for the polynomial ``numerator`` to be zero.

    ``numerator`` is zero if one of its factors is. Only factors with inverse functions or logarithms give conditions:
    ``asin(x) + acos(x) - pi/2`` is zero if its sine is 0 and its cosine 1; a factor with logarithms, if its exponential
    is 1. Each :class:`Lift` has the polynomials, in another ring, that must be zero for that. With ``only_zero``,
    factors that are clearly nonzero in double precision give none, since their conditions cannot hold.
    """
    places = {number for leaf, number in ring.symbols.items() if isinstance(leaf, _NAMES)}
    if not places or len(numerator) > MOST_TERMS or not any(mono[n] for mono in numerator for n in places):
        return
    for factor, _ in numerator.factor_list()[1]:
        used = {number for number in places if any(mono[number] for mono in factor)}
        if used and (not only_zero or seems_zero(factor.as_expr(*ring.generators), ring.domain)):
            with suppress(InputError):  # a condition that cannot be read proves nothing
                yield from _lifts_of(ring, factor, used)


def _lifts_of(ring: FormulaRing, factor: PolyElement, used: set[int]) -> Iterator[Lift]:
    names = {number: leaf for leaf, number in ring.symbols.items()}
    if any(sum(mono[n] for n in used) > 1 for mono in factor):
        return
    difference = factor.as_expr(*ring.generators)
    if all(isinstance(names[n], log) for n in used):
        yield _lifted(ring, [(exp(difference.expand()), Integer(1))])
    elif not any(isinstance(names[n], log) for n in used):
        terms = _combination(ring, factor, names)
        if terms is not None:
            for part, period in ((Integer(1), 2), (Rational(1, 2), 4)):
                if _keeps_within(terms, period):
                    yield _lifted(ring, [(sin(part * difference), Integer(0)), (cos(part * difference), Integer(1))])


@dataclass(frozen=True)
class PrincipalValueProof:
    """A proof that an expression is zero wherever the formulas ``nonnegative`` are >= 0 and ``positive`` are > 0.

    For ``asin(sin(x)) - x``, ``nonnegative`` has pi/2 - x and pi/2 + x: the expression is zero where x is between -pi/2
    and pi/2. ``rings`` are the polynomial rings that the proof uses; no divisor in them may be zero.
    """

    nonnegative: tuple[Expr, ...]
    positive: tuple[Expr, ...]
    rings: tuple[FormulaRing, ...]


def principal(ring: FormulaRing, numerator: PolyElement) -> PrincipalValueProof | None:
    """Return a proof that ``numerator`` is zero where an angle is a principal value, as asin(sin(x)) - x is; or None.

    The polynomial must have a factor ``asin(S) - w``, and S must be provable to be sin(w). Such a factor is zero
    exactly where w is a principal value: in [-pi/2, pi/2] for asin. Factors with acos (w in [0, pi]), with atan (w
    between -pi/2 and pi/2) and ``atan2(r sin w, r cos w) - w`` (w in (-pi, pi], positive r) are proven likewise.
    """
    names = {number: leaf for leaf, number in ring.symbols.items() if type(leaf) in (*_PRINCIPAL, atan2)}
    if not names or len(numerator) > MOST_TERMS:
        return None
    for factor, _ in numerator.factor_list()[1]:
        used = [number for number in names if any(mono[number] for mono in factor)]
        if len(used) == 2 and (multiple := _principal_multiple(ring, factor, names)) is not None:
            return multiple
        if len(used) != 1 or factor.degrees()[used[0]] != 1:
            continue
        (place,) = used
        slope = factor.diff(ring.ring.gens[place])
        if not slope.is_ground:
            continue
        leaf, number = names[place], slope.as_expr(*ring.generators)
        angle = (leaf - factor.as_expr(*ring.generators) / number).expand()
        if isinstance(leaf, atan2):
            return _principal_direction(ring, leaf, angle)
        function, least, most = _PRINCIPAL[type(leaf)]
        with suppress(InputError):  # an angle that cannot be read proves nothing
            other = FormulaRing([function(angle), leaf.args[0]], ring.hypotheses, ring.domain)
            further = proof(other, other.difference(function(angle), leaf.args[0]).numerator)
            if further is not None:
                ends = (angle - least, most - angle)
                inside, edge = (ends, ()) if isinstance(leaf, atan) else ((), ends)
                return PrincipalValueProof(edge, inside, (other, *further))
    return None


def _principal_multiple(ring: FormulaRing, factor: PolyElement, names: dict[int, Expr]) -> PrincipalValueProof | None:
    """Return a proof of where a combination of two inverse functions is zero, as ``asin(3*x - 4*x^3) - 3*asin(x)`` is.

    ``factor`` is the combination, a polynomial of ``ring`` in the variables ``names``. In the example, S = 3*x - 4*x^3
    is proven to be the sine of w = 3*asin(x). So the difference is zero exactly where w lies in [-pi/2, pi/2], and
    these bounds of w are bounds of x, which the proof lists. Return None for other combinations.
    """
    terms = _combination(ring, factor, {**dict(enumerate(ring.generators)), **names})
    leaves = [(leaf, multiple) for leaf, multiple in terms or () if leaf is not pi]
    if len(leaves) != 2 or any(type(leaf) not in _PRINCIPAL for leaf, _ in leaves):
        return None
    constant = sum((Rational(multiple) * pi for leaf, multiple in terms or () if leaf is pi), Integer(0))
    for (leaf, own), (inner, multiple) in (leaves, leaves[::-1]):
        factor_of_inner, shift = -Rational(multiple / own), -constant / Rational(own)
        angle = factor_of_inner * inner + shift
        function, least, most = _PRINCIPAL[type(leaf)]
        with suppress(InputError):  # an angle that cannot be read proves nothing
            other = FormulaRing([function(angle), leaf.args[0]], ring.hypotheses, ring.domain)
            further = proof(other, other.difference(function(angle), leaf.args[0]).numerator)
            if further is not None:
                bounds = sorted([(least - shift) / factor_of_inner, (most - shift) / factor_of_inner])
                ends = _ends_of_argument(inner, *bounds)
                inside, edge = (ends, ()) if isinstance(leaf, atan) else ((), ends)
                return PrincipalValueProof(edge, inside, (other, *further))
    return None


def _ends_of_argument(inner: Expr, low: Expr, high: Expr) -> tuple[Expr, ...]:
    """Return formulas that are nonnegative where the value of ``inner``, an asin, acos or atan, lies in [low, high].

    They are bounds of its argument, one for each end that is not an end of the function's range anyway: for asin(x) in
    [-pi/6, pi/6], they are x + 1/2 and 1/2 - x.
    """
    function, least, most = _PRINCIPAL[type(inner)]
    sign = -1 if isinstance(inner, acos) else 1  # acos decreases
    ends = []
    if low > least:
        ends.append(sign * (inner.args[0] - function(low)))
    if high < most:
        ends.append(sign * (function(high) - inner.args[0]))
    return tuple(ends)


def _principal_direction(ring: FormulaRing, leaf: Expr, angle: Expr) -> PrincipalValueProof | None:
    """Return a proof that ``atan2(y, x) = w`` wherever r = x cos w + y sin w is positive; None if there is none.

    ``leaf`` is the call of atan2 and ``angle`` is w. The proof requires ``y cos w = x sin w``; then y = r sin w and x =
    r cos w.
    """
    y, x = leaf.args
    left, right = y * cos(angle), x * sin(angle)
    with suppress(InputError):  # an angle that cannot be read proves nothing
        radius = (x * cos(angle) + y * sin(angle)).expand()
        other = FormulaRing([left, right, radius], ring.hypotheses, ring.domain)
        further = proof(other, other.difference(left, right).numerator)
        ratio = other.difference(radius, Integer(0))
        if further is not None:
            if not ratio.factors:
                radius = other.reduce(ratio.numerator).as_expr(*other.generators) / ratio.constant
            if not radius.is_nonpositive:
                return PrincipalValueProof((pi - angle,), (angle + pi, radius), (other, *further))
    return _principal_direction_of_root(ring, leaf, angle)


def _principal_direction_of_root(ring: FormulaRing, leaf: Expr, angle: Expr) -> PrincipalValueProof | None:
    """Return a proof that ``atan2(y, x) = w`` under conditions, if y or x is a root or an absolute value; else None.

    For ``y = sqrt(P)``, if ``P = r^2 sin(w)^2`` is proven for r = x/cos(w), the value is w for w in [0, pi] and
    positive r. For ``x = sqrt(P)``, if ``P = r^2 cos(w)^2`` is proven for r = y/sin(w), the value is w for w in
    [-pi/2, pi/2] and positive r.
    """
    y, x = leaf.args
    for root, other_part, own, other_function, ends in (
        (y, x, sin, cos, (angle, pi - angle)),
        (x, y, cos, sin, (angle + pi / 2, pi / 2 - angle)),
    ):
        below = _square(root)
        radius = (other_part / other_function(angle)).cancel()
        if below is None or radius.has(other_function(angle)) or radius.is_nonpositive:
            continue
        square = radius**2 * own(angle) ** 2
        with suppress(InputError):  # an angle that cannot be read proves nothing
            other = FormulaRing([below, square], ring.hypotheses, ring.domain)
            further = proof(other, other.difference(below, square).numerator)
            if further is not None:
                return PrincipalValueProof(ends, (radius,), (other, *further))
    return None


def _square(formula: Expr) -> Expr | None:
    """Return u for a square root sqrt(u), u^2 for an absolute value |u|, and None for any other formula."""
    if formula.is_Pow and formula.exp == Rational(1, 2):
        return formula.base
    return formula.args[0] ** 2 if isinstance(formula, Abs) else None


_PRINCIPAL = {asin: (sin, -pi / 2, pi / 2), acos: (cos, Integer(0), pi), atan: (tan, -pi / 2, pi / 2)}
"""Inverse function -> (the function that it inverts, lower bound of its values, upper bound)."""


def _lifted(ring: FormulaRing, equations: Sequence[tuple[Expr, Expr]]) -> Lift:
    other = FormulaRing([side for sides in equations for side in sides], ring.hypotheses, ring.domain)
    numerators = (other.reduce(other.difference(left, right).numerator) for left, right in equations)
    return Lift(other, tuple(numerators))


def _combination(ring: FormulaRing, factor: PolyElement, names: dict[int, Expr]) -> list[tuple[Expr, Fraction]] | None:
    """Return a polynomial as a sum of multiples of inverse functions and pi: pairs (function or pi, rational factor).

    ``2*asin(x) - pi`` gives (asin(x), 2) and (pi, -1). Return None for any other polynomial. ``names`` maps the indices
    of variables to functions.
    """
    terms = []
    for mono, coefficient in factor.items():
        places = [number for number, power in enumerate(mono) if power]
        leaf = names.get(places[0]) if len(places) == 1 and mono[places[0]] == 1 else None
        if leaf is None or not (leaf is pi or type(leaf) in INVERSE):
            return None
        terms.append((leaf, Fraction(int(coefficient.numerator), int(coefficient.denominator))))
    return terms


def _keeps_within(terms: Sequence[tuple[Expr, Fraction]], period: int) -> bool:
    """Return whether a sum of multiples of inverse functions lies strictly between -p pi and p pi, p = ``period``.

    ``terms`` holds pairs (inverse function or pi, factor). The proof uses the ranges of the functions; False means that
    they do not suffice.
    """
    low, high = Fraction(0), Fraction(0)
    low_taken = high_taken = True
    for leaf, coefficient in terms:
        least, most, least_taken, most_taken = _range(leaf)
        if coefficient < 0:
            least, most, least_taken, most_taken = most, least, most_taken, least_taken
        low, high = low + coefficient * least, high + coefficient * most
        low_taken, high_taken = low_taken and least_taken, high_taken and most_taken
    return (low > -period or (low == -period and not low_taken)) and (
        high < period or (high == period and not high_taken)
    )


def _range(leaf: Expr) -> tuple[Fraction, Fraction, bool, bool]:
    if leaf is pi:
        return Fraction(1), Fraction(1), True, True
    held = enclosure(leaf) if leaf.is_number else None
    if held is None:
        return range_of(leaf)
    turns = held / iv.pi
    return _fraction(turns.a), _fraction(turns.b), True, True


def _fraction(end: Any) -> Fraction:
    """Return an endpoint of an mpmath interval as an exact fraction."""
    sign, mantissa, power, _ = end._mpi_[0]
    return (-1 if sign else 1) * int(mantissa) * Fraction(2) ** int(power)

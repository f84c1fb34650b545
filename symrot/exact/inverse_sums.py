"""Proofs that sums of inverse trigonometric functions, or of logarithms, are zero.

A rational combination D of inverse functions and pi, strictly between -2 pi and 2 pi, is zero if ``sin D = 0`` and
``cos D = 1``. A real D with logarithms is zero if and only if ``exp D = 1``. A proof holds where no divisor in its
polynomial rings is zero.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction

from mpmath import iv
from sympy import Abs, Expr, Integer, Rational, acos, asin, atan, atan2, cos, exp, log, pi, sin, tan
from sympy.polys.rings import PolyElement

from symrot.errors import InputError
from symrot.exact.angles.inverse import INVERSE, range_of
from symrot.exact.factors import factor_list
from symrot.exact.floats import seems_zero
from symrot.exact.intervals import enclosure, fraction_of_end
from symrot.exact.ring.ring import FormulaRing
from symrot.exact.sign_cases import vanishes_for_all_signs

__all__ = ["Lift", "PrincipalValueProof", "lifts", "principal", "proof", "vanishes"]

MOST_TERMS = 60
"""Largest number of terms of a polynomial that is factored; a longer one is not proven zero by its factors."""

_NAMES = (*INVERSE, log)


@dataclass(frozen=True)
class Lift:
    """A sufficient condition for a sum of inverse functions or of logarithms to be zero: some polynomials are zero.

    The polynomials are ``numerators``, in the polynomial ring ``ring``.

    Example: ``D = asin(x) + acos(x) - pi/2`` lies between -2 pi and 2 pi, and is zero if ``sin(D)`` and ``cos(D) - 1``
    are zero.
    """

    ring: FormulaRing
    numerators: tuple[PolyElement, ...]  # for this D those of sin(D) and cos(D) - 1, without asin and acos


def vanishes(ring: FormulaRing, numerator: PolyElement) -> bool:
    """Return whether the polynomial ``numerator`` of the ring is proven to be zero; see :func:`proof`."""
    return proof(ring, numerator) is not None


def proof(ring: FormulaRing, numerator: PolyElement) -> tuple[FormulaRing, ...] | None:
    """Prove that the polynomial ``numerator`` is zero; return the rings that the proof uses in addition to ``ring``.

    The tuple may be empty; None means that no proof is found.
    """
    numerator = ring.reduce(numerator)
    if not numerator:
        return ()
    if vanishes_for_all_signs(ring, numerator):
        return ()
    # a factor such as asin(x) + acos(x) - pi/2 is zero by its sine and cosine, in another ring; the proof holds where
    # no divisor of that ring is zero
    for lift in lifts(ring, numerator, only_zero=not ring.hypotheses):
        further = [proof(lift.ring, poly) for poly in lift.numerators]
        if None not in further:
            return (lift.ring, *(other for rings in further if rings for other in rings))
    return None


def lifts(ring: FormulaRing, numerator: PolyElement, only_zero: bool = False) -> Iterator[Lift]:
    """Yield conditions, each of which is sufficient for the polynomial ``numerator`` to be zero.

    Each condition makes one factor of ``numerator`` zero, a sum of inverse functions or of logarithms.

    With ``only_zero``, factors whose values in double precision are clearly not zero are skipped.
    """
    places = {number for leaf, number in ring.symbols.items() if isinstance(leaf, _NAMES)}
    if not places or len(numerator) > MOST_TERMS or not any(mono[n] for mono in numerator for n in places):
        return
    # the polynomial is zero if one of its factors is
    for factor, _ in factor_list(numerator)[1]:
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
            # with D between -4 pi and 4 pi, the sine and cosine of D/2 decide
            for part, period in ((Integer(1), 2), (Rational(1, 2), 4)):
                if _keeps_within(terms, period):
                    yield _lifted(ring, [(sin(part * difference), Integer(0)), (cos(part * difference), Integer(1))])


@dataclass(frozen=True)
class PrincipalValueProof:
    """A proof that an expression is zero wherever the formulas ``nonnegative`` are >= 0 and ``positive`` are > 0."""

    nonnegative: tuple[Expr, ...]  # pi/2 - x and pi/2 + x for asin(sin(x)) - x
    positive: tuple[Expr, ...]
    rings: tuple[FormulaRing, ...]  # no divisor in these rings may be zero


def principal(ring: FormulaRing, numerator: PolyElement) -> PrincipalValueProof | None:
    """Return a proof that ``numerator`` is zero under conditions, or None if no proof is found.

    For example, asin(sin(x)) - x is zero for x from -pi/2 to pi/2.
    """
    names = {number: leaf for leaf, number in ring.symbols.items() if type(leaf) in (*_PRINCIPAL, atan2)}
    if not names or len(numerator) > MOST_TERMS:
        return None
    for factor, _ in factor_list(numerator)[1]:
        used = [number for number in names if any(mono[number] for mono in factor)]
        if len(used) == 2 and (multiple := _principal_multiple(ring, factor, names)) is not None:
            return multiple
        if len(used) > 2 and (of_sum := _principal_sum(ring, factor, names)) is not None:
            return of_sum
        if len(used) != 1 or factor.degrees()[used[0]] != 1:
            continue
        (place,) = used
        slope = factor.diff(ring.ring.gens[place])
        if not slope.is_ground:
            continue
        # the factor is a multiple of asin(S) - w; it is zero where S = sin(w) and w is a value of asin
        leaf, number = names[place], slope.as_expr(*ring.generators)
        angle = (leaf - factor.as_expr(*ring.generators) / number).expand()
        if isinstance(leaf, atan2):
            return _principal_direction(ring, leaf, angle)
        result = _principal_angle(ring, leaf, angle)
        if result is not None:
            return result
    return None


def _principal_angle(ring: FormulaRing, leaf: Expr, angle: Expr) -> PrincipalValueProof | None:
    """Return a proof that the inverse function ``leaf``, such as asin(S), equals ``angle`` if the angle is in range.

    The range is that of the inverse function. None if ``sin(angle) = S`` is not proven.
    """
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
    """Return a proof that ``factor``, with two inverse functions, is zero under conditions, or None if none is found.

    For example, ``asin(3*x - 4*x^3) - 3*asin(x)`` is zero if abs(x) <= 1/2.
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
                # the angle w = 3*asin(x) must lie in [-pi/2, pi/2]; bounds of w are bounds of x
                bounds = sorted([(least - shift) / factor_of_inner, (most - shift) / factor_of_inner])
                ends = _ends_of_argument(inner, *bounds)
                if ends is None:
                    continue
                inside, edge = (ends, ()) if isinstance(leaf, atan) else ((), ends)
                return PrincipalValueProof(edge, inside, (other, *further))
    return None


def _principal_sum(ring: FormulaRing, factor: PolyElement, names: dict[int, Expr]) -> PrincipalValueProof | None:
    """Return a proof that ``factor``, a sum of inverse functions, is zero under conditions, or None if none is found.

    For example, ``asin(x) + asin(y) - asin(u)`` is zero, for u = x sqrt(1 - y^2) + y sqrt(1 - x^2), if the sum of the
    first two terms is in the range of asin.
    """
    terms = _combination(ring, factor, {**dict(enumerate(ring.generators)), **names}) or ()
    leaves = [(leaf, multiple) for leaf, multiple in terms if leaf is not pi]
    if any(type(leaf) not in _PRINCIPAL for leaf, _ in leaves):
        return None
    # the leaf with the longest argument is the inverse function of the sum of the others
    for leaf, own in sorted(leaves, key=lambda pair: -pair[0].count_ops())[:1]:
        angle = sum((-Rational(multiple / own) * other for other, multiple in terms if other is not leaf), Integer(0))
        return _principal_angle(ring, leaf, angle)
    return None


def _ends_of_argument(inner: Expr, low: Expr, high: Expr) -> tuple[Expr, ...] | None:
    """Return formulas that are nonnegative exactly where the asin, acos or atan ``inner`` lies in [low, high].

    The result is None if ``inner`` never lies there.
    """
    function, least, most = _PRINCIPAL[type(inner)]
    if high < least or low > most:
        return None  # acos(x) never lies in [2*pi, 3*pi]
    sign = -1 if isinstance(inner, acos) else 1  # acos decreases
    ends = []
    # an end of the function's own range bounds nothing
    if low > least:
        # asin(x) in [-pi/6, pi/6] gives x + 1/2 and 1/2 - x
        ends.append(sign * (inner.args[0] - function(low)))
    if high < most:
        ends.append(sign * (function(high) - inner.args[0]))
    return tuple(ends)


def _principal_direction(ring: FormulaRing, leaf: Expr, angle: Expr) -> PrincipalValueProof | None:
    """Return a proof, with its conditions, that ``leaf``, an ``atan2(y, x)``, equals ``angle``, w; None if not found.

    The conditions are -pi < w <= pi and x cos w + y sin w > 0, or those of :func:`_principal_direction_of_root`.
    """
    y, x = leaf.args
    left, right = y * cos(angle), x * sin(angle)
    with suppress(InputError):  # an angle that cannot be read proves nothing
        radius = (x * cos(angle) + y * sin(angle)).expand()
        other = FormulaRing([left, right, radius], ring.hypotheses, ring.domain)
        # if y cos w = x sin w, then y = r sin w and x = r cos w
        further = proof(other, other.difference(left, right).numerator)
        ratio = other.difference(radius, Integer(0))
        if further is not None:
            if not ratio.factors:
                radius = other.reduce(ratio.numerator).as_expr(*other.generators) / ratio.constant
            if not radius.is_nonpositive:
                return PrincipalValueProof((pi - angle,), (angle + pi, radius), (other, *further))
    return _principal_direction_of_root(ring, leaf, angle)


def _principal_direction_of_root(ring: FormulaRing, leaf: Expr, angle: Expr) -> PrincipalValueProof | None:
    """Return a proof, with its conditions, that ``leaf``, an ``atan2(y, x)``, equals ``angle``.

    Return None if no proof is found.
    """
    y, x = leaf.args
    # y or x must be a root or an absolute value.
    # y = sqrt(P): if P = r^2 sin(w)^2 for r = x/cos(w), the value is w for w in [0, pi] and positive r; for x = sqrt(P)
    # likewise, with r = y/sin(w) and w in [-pi/2, pi/2]
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
    """Return the pairs (leaf, number) of a sum of multiples: (asin(x), 2) and (pi, -1) for ``2*asin(x) - pi``.

    The result is None if ``factor`` is not a sum of multiples of inverse functions and pi.
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
    """Return whether a sum of multiples of inverse functions provably lies strictly between -p pi and p pi.

    p is ``period``.
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
    return fraction_of_end(turns.a), fraction_of_end(turns.b), True, True

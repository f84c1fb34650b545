"""Counterexamples: exact points at which two formulas differ, with numbers that are short enough to read.

With symbols, angles and unit vectors alone, the point is rational: ``cos x = 4/5, sin x = 3/5``. Otherwise the symbols
are rational or multiples of pi, and 50-digit interval arithmetic proves that the sides differ.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from math import prod
from random import Random
from typing import Any

from sympy import Expr, Rational, Symbol, acos, asin, atan, atan2, cos, pi, preorder_traversal, sin
from sympy.concrete.expr_with_limits import ExprWithLimits
from sympy.core.function import AppliedUndef
from sympy.polys.rings import PolyElement

from symrot.errors import InputError
from symrot.exact.angles.angles import base_angle
from symrot.exact.domain.domain import free_angles
from symrot.exact.domain.needs import fits_assumptions
from symrot.exact.evidence import Counterexample
from symrot.exact.floats import NoValue, float_at
from symrot.exact.intervals import enclosure, is_nonnegative_at
from symrot.exact.limits.size import pieces
from symrot.exact.ring.polynomials import occurring, value_at
from symrot.exact.ring.ratio import Ratio, TooLarge
from symrot.exact.ring.ring import FormulaRing

__all__ = ["closed_form_witness", "coordinates_of", "rational_witness"]

ATTEMPTS = 60
"""Number of random points that a search for a counterexample tries.

A nonzero polynomial of degree d is zero at a random rational point with a probability of at most about d/40, because
each symbol takes any of its values with a probability of at most about 1/40.
"""

SIMPLER_TERMS = 200_000
"""Largest number of terms that are evaluated in the search for a counterexample with shorter numbers.

A trial replaces one number and evaluates all terms of left - right once."""

UNMOVED = 20
"""Number of random points that are tried unchanged; later points are first moved into the domain if necessary."""

MOST_ROOTS_SHORTENED = 6
"""Largest number of roots in a number that is expanded to test whether it is rational; each root doubles its terms."""

MOST_NESTED = 2
"""Largest depth of nested functions into which SymPy substitutes numbers."""

_INVERSE = (asin, acos, atan, atan2)
_TRIANGLES = [Rational(n, d) for n, d in ((3, 5), (-4, 5), (3, 4), (-4, 3), (1, 1), (-1, 1), (2, 1), (-2, 1), (1, 2))]
"""Values tried for the symbols of formulas with asin, acos, atan, ..: many sines and cosines are then rational.

For example, ``cos(asin(3/5))`` is 4/5, as in a right triangle with the sides 3, 4 and 5."""

_CIRCLE = tuple(tuple(map(Fraction, point.split())) for point in ("0 1", "1 0", "0 -1", "-1 0", "3/5 4/5", "4/5 3/5"))
"""Pairs (sine, cosine): the quarter turns, and the acute angles of the triangle with the sides 3, 4 and 5."""

_TURNS = [Rational(n, d) * pi for n, d in ((1, 1), (-1, 1), (2, 1), (1, 2), (-1, 2), (3, 1), (1, 3), (3, 2), (-2, 3))]
"""Values of angles at which sines and cosines are simple."""


@dataclass(frozen=True)
class FreeChoice:
    """Variables of a ring whose values are chosen together: a symbol, an angle's sine and cosine, or a unit vector."""

    generators: tuple[int, ...]  # indices of the variables
    simple: tuple[tuple[Fraction, ...], ...]  # a few choices with short numbers
    random: Callable[[Random], tuple[Fraction, ...]]  # draws further choices


def rational_witness(
    ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None
) -> Counterexample | None:
    """Return a counterexample to ``left = right`` in rational numbers, or None if the search ends without one.

    ``entry`` is stored in the counterexample: the row and column of the two sides in a matrix, or None.
    """
    # roots, inverse functions and exponentials are seldom rational: no search
    if ring.outside_scope or ring.roots or ring.fine or ring.exponentials:
        return None
    if len(free_angles(ring)) < len(ring.bases):
        return None
    coordinates, solved = _coordinates(ring)
    differ, size = _difference(ring, left, right)
    domain = [ring.ratio(formula) for formula in ring.domain]

    def point(choices: Sequence[tuple[Fraction, ...]]) -> dict[int, Fraction] | None:
        """Return the point with the values ``choices`` of the free variables; None if it is no counterexample."""
        values: dict[int, Fraction] = {}
        for coordinate, choice in zip(coordinates, choices, strict=True):
            values.update(zip(coordinate.generators, choice, strict=True))
        for generator, hypothesis in solved:
            if not _solve(hypothesis, generator, values):
                return None
        admissible = (
            all(fits_assumptions(leaf, values[number]) for leaf, number in ring.symbols.items())
            and not any(_value(hypothesis, values) for hypothesis in ring.hypothesis_numerators)
            and all(_value(factor, values) for factor in ring.ratios.factors)
            and all(_ratio_value(ring, formula, values) >= 0 for formula in domain)
        )
        return values if admissible and differ(values) else None

    source = Random(1)
    for _ in range(ATTEMPTS):
        choices = [coordinate.random(source) for coordinate in coordinates]
        if point(choices) is not None:
            break
    else:
        return None
    affordable = SIMPLER_TERMS // max(size, 1)
    for place, coordinate in enumerate(coordinates):
        for simpler in coordinate.simple:
            affordable -= 1
            if affordable < 0:
                break
            trial = [*choices[:place], simpler, *choices[place + 1 :]]
            if point(trial) is not None:
                choices = trial
                break
    values = point(choices)
    assert values is not None
    lhs, rhs = (_rational(_formula_value(ring, side, values, {})) for side in (left, right))
    numbers = {place: _rational(value) for place, value in values.items()}
    return Counterexample(tuple(coordinates_of(ring, numbers, (left, right, *ring.hypotheses))), entry, lhs, rhs)


def _difference(ring: FormulaRing, left: Expr, right: Expr) -> tuple[Callable[[dict[int, Fraction]], bool], int]:
    """Return (test, cost): ``test(values)`` is True if both sides are defined and differ at a point.

    A test evaluates ``cost`` terms.
    """
    # the shorter of two forms is evaluated: the polynomial left - right, or the formulas as they are written
    written = pieces((left, right))
    try:
        residual = ring.difference(left, right).numerator
        if len(residual) <= written:
            return lambda values: bool(_value(residual, values)), len(residual)
    except TooLarge:
        ring.ratios.products = 0  # its symbols, sines and cosines are read with a budget of their own

    def differ(values: dict[int, Fraction]) -> bool:
        known: dict[Expr, Fraction] = {}
        try:
            return _formula_value(ring, left, values, known) != _formula_value(ring, right, values, known)
        except ZeroDivisionError:
            return False

    return differ, written


def closed_form_witness(
    ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None
) -> Counterexample | None:
    """Return a counterexample to ``left = right``: a point at which 50-digit intervals prove that the sides differ.

    The values of the symbols at the point are rational or multiples of pi. ``entry`` is stored in the counterexample,
    as by :func:`rational_witness`. The result is None if the search finds no such point.
    """
    places = {number: leaf for leaf, number in ring.symbols.items() if ring.leaves[leaf]}
    bound = occurring(ring.hypothesis_numerators)
    if not bound <= places.keys():
        return None
    coordinates, solved = _coordinates(ring)
    tied = [c for c in coordinates if bound & set(c.generators)]
    radicands = [radical.base for radical in ring.radicals.values()]
    formulas = (left, right, *ring.ratios.sources, *ring.domain, *radicands)  # SymPy may have cancelled a divisor
    variables = sorted({variable for formula in formulas for variable in _variables(formula)}, key=str)
    source = Random(2)
    simple = [Rational(1), Rational(2), Rational(-1), Rational(1, 2), Rational(3), Rational(-1, 3)]
    if left.has(*_INVERSE) or right.has(*_INVERSE):
        simple = _TRIANGLES
    angles = _pure_angles(ring)
    within = [*(radical.base for radical in ring.radicals.values() if radical.base != -1), *ring.domain]
    for attempt in range(ATTEMPTS):
        early = attempt < ATTEMPTS // 2
        pool = simple if early else [Rational(n, 7) for n in range(-40, 41) if n]
        # points of spheres and solutions of linear equations satisfy the hypotheses
        numbers = {number: value for c in tied for number, value in zip(c.generators, c.random(source), strict=True)}
        if not all(_solve(hypothesis, generator, numbers) for generator, hypothesis in solved):
            continue
        if any(_value(hypothesis, numbers) for hypothesis in ring.hypothesis_numerators):
            continue
        fixed = {places[number]: _rational(value) for number, value in numbers.items()}
        values = dict(fixed)
        if not all(fits_assumptions(leaf, value) for leaf, value in values.items()):
            continue
        for leaf in variables:
            if leaf not in values:
                # multiples of pi have simple sines and cosines
                choices = _TURNS if early and leaf in angles else pool
                values[leaf] = source.choice([v for v in choices if fits_assumptions(leaf, v)] or [Rational(1)])
        if attempt >= UNMOVED:
            _move_within(within, values, [leaf for leaf in variables if leaf not in fixed], simple)
        if not all(_seems_nonnegative(formula, values) for formula in within):
            continue
        if not all(_nonnegative(formula, values) for formula in within):
            continue
        if not all(_nonzero(source, values) for source in ring.ratios.sources):
            continue
        enclosures = [_enclosure(side, values) for side in (left, right)]
        if None not in enclosures and 0 not in enclosures[0] - enclosures[1]:
            sides = left.xreplace(values), right.xreplace(values)
            return Counterexample(tuple(sorted(values.items(), key=str)), entry, *map(_shortest, sides))
    return None


def _move_within(
    formulas: Sequence[Expr], values: dict[Expr, Expr], movable: Sequence[Expr], simple: Sequence[Expr]
) -> None:
    """Change ``values``, a point: for each formula that is negative there, one symbol gets another value.

    The values ``simple`` of the symbols ``movable`` are tried until the formula is nonnegative; if none helps, the
    point stays.
    """
    for formula in formulas:
        if _seems_nonnegative(formula, values) and _nonnegative(formula, values):
            continue
        # one symbol gets the first simple value that helps
        own = formula.free_symbols
        trials = ({**values, leaf: v} for leaf in movable if leaf in own for v in simple if fits_assumptions(leaf, v))
        moved = next((t for t in trials if _seems_nonnegative(formula, t) and _nonnegative(formula, t)), values)
        values.update(moved)


def _pure_angles(ring: FormulaRing) -> set[Expr]:
    """Return the symbols and functions of time that occur only inside sines and cosines."""
    inside = [atom for atom in ring.bases if atom.is_Symbol or isinstance(atom, AppliedUndef)]
    others = [*ring.symbols, *ring.exponent_bases, *(atom for atom in ring.bases if atom not in inside)]
    return {atom for atom in inside if not any(other.has(atom) for other in others)}


def _enclosure(formula: Expr, values: dict[Expr, Expr]) -> Any:
    """Return an interval that is proven to contain the value of a formula at a point, or None if no proof is found."""
    held = enclosure(formula, values)
    # SymPy's substitution may succeed where interval arithmetic alone fails
    return enclosure(formula.xreplace(values)) if held is None and _is_flat(formula) else held


def _nonnegative(formula: Expr, values: dict[Expr, Expr]) -> bool:
    """Return whether a formula is proven to be nonnegative at a point."""
    is_proven = is_nonnegative_at(formula, values)
    # SymPy's substitution also proves exact zeros, as of ``1 + cos(x)`` at pi
    return is_proven or (_is_flat(formula) and is_nonnegative_at(formula.xreplace(values), {}))


def _seems_nonnegative(formula: Expr, values: dict[Expr, Expr]) -> bool:
    """Return whether a formula is nonnegative in double precision, a fast test before the proof by intervals."""
    try:
        return float_at(formula, {leaf: float(value) for leaf, value in values.items()}, {}) > -1e-9
    except (NoValue, TypeError, OverflowError):
        return False


def _nonzero(formula: Expr, values: dict[Expr, Expr]) -> bool:
    held = _enclosure(formula, values)
    return held is not None and 0 not in held


def _is_flat(formula: Expr, deep: int = MOST_NESTED) -> bool:
    """Return whether a formula has no integral or sum, and functions nested at most ``deep`` levels."""
    # SymPy then substitutes numbers quickly, and no variable of integration is replaced
    inside = deep - formula.is_Function
    if inside < 0 or isinstance(formula, ExprWithLimits):
        return False
    return all(_is_flat(part, inside) for part in formula.args if part.args)


def _shortest(number: Expr) -> Expr:
    """Return a closed-form number as a rational, if it is one: 3 for ``sqrt(4) + 1``; otherwise unchanged."""
    if number.is_Rational or not number.is_number:
        return number
    try:
        own = FormulaRing([number])
        # many roots would take long to test
        if len(own.roots) > MOST_ROOTS_SHORTENED:
            return number
        short = own.expression(own.ratio(number))
    except InputError:  # the budget is exhausted
        return number
    return short if short.is_Rational else number


# -- rational points ------------------------------------------------------------------------------------------------


def _coordinates(ring: FormulaRing) -> tuple[list[FreeChoice], list[tuple[int, PolyElement]]]:
    """Return (free, solved): how the values of the ring's variables at a point are chosen.

    ``free`` are groups of variables with free values, such as the sine and cosine of an angle; ``solved`` are pairs
    (index of a variable, hypothesis that is solved for this variable).
    """
    fixed: set[int] = set()
    coordinates: list[FreeChoice] = []
    solved: list[tuple[int, PolyElement]] = []
    leaf_numbers = set(ring.symbols.values())
    for hypothesis in ring.hypothesis_numerators:
        # ``q0^2 + q1^2 + q2^2 + q3^2 = 1`` makes its variables one choice, a unit vector
        sphere = _sphere(hypothesis)
        if sphere and not fixed & set(sphere):
            coordinates.append(FreeChoice(sphere, _simple_sphere(len(sphere)), _random_sphere(len(sphere))))
            fixed |= set(sphere)
            continue
        degrees = hypothesis.degrees() if hypothesis else ()
        linear = [n for n, degree in enumerate(degrees) if degree == 1 and n in leaf_numbers - fixed]
        if linear:
            solved.append((linear[0], hypothesis))
            fixed.add(linear[0])
    for atom, place in ring.sines.items():
        pair = (place, ring.cosines[atom])
        coordinates.append(FreeChoice(pair, _CIRCLE, _random_sphere(2)))
    for leaf, number in ring.symbols.items():
        if number not in fixed:
            simple = tuple((Fraction(v),) for v in (0, 1, -1, 2, 3) if fits_assumptions(leaf, Fraction(v)))
            coordinates.append(FreeChoice((number,), simple, _random_number(leaf)))
    return coordinates, solved[::-1]


def _sphere(poly: PolyElement) -> tuple[int, ...] | None:
    """Return the variables of a hypothesis ``x^2 + y^2 + .. = 1``, or None if the hypothesis has another form."""
    if not poly:
        return None
    constant = poly.coeff(1)
    places = []
    for mono, coefficient in poly.items():
        if not any(mono):
            continue
        if sorted(mono)[-1] != 2 or sum(mono) != 2 or coefficient != -constant:
            return None
        places.append(mono.index(2))
    return tuple(sorted(places)) if constant and len(places) > 1 else None


def _simple_sphere(size: int) -> tuple[tuple[Fraction, ...], ...]:
    """Return simple rational unit vectors with ``size`` components, such as (3/5, 4/5, 0) or (1/3, 2/3, 2/3)."""
    points = [tuple(Fraction(int(i == j)) for i in range(size)) for j in range(size)]
    for numbers in ("3/5 4/5", "1/3 2/3 2/3", "1/2 1/2 1/2 1/2"):
        seed = tuple(map(Fraction, numbers.split()))
        for places in product(range(size), repeat=len(seed)):
            if list(places) == sorted(set(places)):
                point = [Fraction(0)] * size
                for place, value in zip(places, seed, strict=True):
                    point[place] = value
                points.append(tuple(point))
    return tuple(points)


def _random_sphere(size: int) -> Callable[[Random], tuple[Fraction, ...]]:
    """Return a function that draws random rational unit vectors with ``size`` components."""

    # stereographic projection of random points of a plane
    def draw(source: Random) -> tuple[Fraction, ...]:
        flat = [Fraction(source.randint(-9, 9), source.randint(1, 5)) for _ in range(size - 1)]
        square = sum((value * value for value in flat), Fraction(0))
        return (*(2 * value / (1 + square) for value in flat), (1 - square) / (1 + square))

    return draw


def _random_number(leaf: Expr) -> Callable[[Random], tuple[Fraction, ...]]:
    """Return a function that draws random rational values of the symbol ``leaf``."""

    def draw(source: Random) -> tuple[Fraction, ...]:
        # if no value fits the symbol's assumptions, such as positive, the point is refused later
        for _ in range(20):
            value = Fraction(source.randint(-20, 20), 1 if leaf.is_integer else source.randint(1, 4))
            if fits_assumptions(leaf, value):
                break
        return (value,)

    return draw


def _solve(hypothesis: PolyElement, generator: int, values: dict[int, Fraction]) -> bool:
    """Solve a hypothesis for a variable in which it is linear, and store the result in ``values`` under ``generator``.

    Return False if another variable in it has no value yet, or if its slope in this variable is zero.
    """
    values[generator] = Fraction(0)
    if not occurring([hypothesis]) <= values.keys():
        return False
    constant = _value(hypothesis, values)
    values[generator] = Fraction(1)
    slope = _value(hypothesis, values) - constant
    if not slope:
        return False
    values[generator] = -constant / slope
    return True


def _value(poly: PolyElement, values: dict[int, Fraction]) -> Fraction:
    value: Fraction = value_at(poly, values, lambda number: Fraction(int(number.numerator), int(number.denominator)))
    return value


def _ratio_value(ring: FormulaRing, ratio: Ratio, values: dict[int, Fraction]) -> Fraction:
    return _value(ratio.numerator, values) / _value(ring.ratios.denominator(ratio), values)


def _formula_value(ring: FormulaRing, node: Expr, values: dict[int, Fraction], known: dict[Expr, Fraction]) -> Fraction:
    """Return the value of the formula ``node`` at the point ``values``, or raise ``ZeroDivisionError``.

    ``known`` stores values of subexpressions at this point.
    """
    if node in ring.symbols:
        return values[ring.symbols[node]]
    if node not in known:
        if node.is_Rational:
            known[node] = Fraction(int(node.p), int(node.q))
        elif node.is_Add or node.is_Mul:
            parts = [_formula_value(ring, part, values, known) for part in node.args]
            known[node] = sum(parts, Fraction(0)) if node.is_Add else prod(parts, start=Fraction(1))
        elif node.is_Pow and node.exp.is_Integer:
            known[node] = _formula_value(ring, node.base, values, known) ** int(node.exp)
        else:
            known[node] = _ratio_value(ring, ring.ratio(node), values)
    return known[node]


def coordinates_of(
    ring: FormulaRing, values: Mapping[int, Expr], formulas: Sequence[Expr]
) -> Iterator[tuple[Expr, Expr]]:
    """Yield the point of a counterexample as pairs (symbol, value), for the symbols and angles in ``formulas``.

    ``values`` maps indices of the ring's variables to exact numbers. An angle that is no multiple of pi/2 is shown by
    its cosine and its sine.
    """
    used = set().union(*map(preorder_traversal, formulas))
    quarter_turns = {(0, 1): 0, (1, 0): 1, (0, -1): 2, (-1, 0): 3}
    for leaf, place in ring.symbols.items():
        if leaf in used and place in values:
            yield leaf, values[place]
    for atom, place in ring.sines.items():
        if place not in values or not atom.atoms(Symbol, AppliedUndef) & used:
            continue
        sine, cosine = values[place], values[ring.cosines[atom]]
        base = base_angle(atom, ring.bases[atom])
        if (sine, cosine) in quarter_turns:
            yield atom, quarter_turns[sine, cosine] * pi / 2 * atom / base
        else:
            yield cos(base), cosine
            yield sin(base), sine


def _rational(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


# -- closed-form numbers --------------------------------------------------------------------------------------------


def _variables(expression: Expr) -> list[Expr]:
    """Return the symbols, functions of time and derivatives in an expression, each once, sorted by their text.

    The t of f(t) does not count.
    """
    variables: list[Expr] = []
    stack = [expression]
    while stack:
        node = stack.pop()
        if node.is_Symbol or isinstance(node, AppliedUndef) or node.is_Derivative:
            if node not in variables:
                variables.append(node)
        else:
            stack.extend(node.args)
    return sorted(variables, key=str)

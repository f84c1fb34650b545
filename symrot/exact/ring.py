"""Expressions as fractions of polynomials, in one ring made for the problem at hand.

Generators, highest first: roots (outer before inner), sines, then everything else (cosines, parameters, rates,
functions of time). The order is lexicographic, so each relation

    root:    g^n = P           circle:    s^2 = 1 - c^2           hypothesis:    q0^2 = 1 - q1^2 - q2^2 - q3^2

leads with a power of its own generator. Leading powers of different generators are coprime: the relations are a
Groebner basis as they stand, and replacing leading powers gives the unique normal form. Hypotheses which lead with
anything else are completed by Buchberger's algorithm (research: VERIFICATION.md, section 1, step (f)).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd
from typing import Any

from sympy import Abs, Derivative, E, Expr, I, Integer, Pow, Rational, cos, cot, csc, pi, preorder_traversal, sec, sin, sympify, tan
from sympy import Eq as Equality
from sympy.core.function import AppliedUndef
from sympy.matrices.expressions.matexpr import MatrixElement
from sympy.polys.domains import QQ, ZZ
from sympy.polys.groebnertools import groebner
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import InputError
from symrot.exact.angles import (
    LinearForm,
    base_angle,
    base_coefficients,
    chebyshev,
    constant_cosine_sine,
    linear_form,
)
from symrot.exact.roots import Radical, radical

__all__ = ["FormulaRing", "Ratio", "as_zero"]

# function -> (numerator, denominator) as words in cosine "c", sine "s" and one "1" of its argument
TRIGONOMETRIC = {
    sin: ("s", "1"),
    cos: ("c", "1"),
    tan: ("s", "c"),
    cot: ("c", "s"),
    sec: ("1", "c"),
    csc: ("1", "s"),
}
CONSTANTS_OUT_OF_SCOPE = (pi, E)
"""As numbers next to sines and cosines these would need Schanuel's conjecture; they are free generators here."""


@dataclass(frozen=True)
class Ratio:
    """``numerator / (constant * product of factors)``; factors by their number in the ring's list, with exponents."""

    numerator: PolyElement
    constant: int = 1
    factors: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Rule:
    """``generator^power = replacement``, the replacement free of that generator and of all higher ones."""

    generator: int
    power: int
    replacement: PolyElement


def as_zero(relation: Any) -> Expr:
    """Return the expression that a hypothesis puts to zero: an expression itself, or left - right of an equation.

    Raises
    ------
    InputError
        If the hypothesis is false, or is no expression.
    """
    relation = sympify(relation)
    if relation is sympify(True):
        return Integer(0)
    if isinstance(relation, Equality):
        return relation.lhs - relation.rhs
    if not isinstance(relation, Expr):
        raise InputError(f"a hypothesis is an equation, or an expression that is zero; got {relation}")
    return relation


class FormulaRing:
    """The polynomial ring, its relations and its known denominators, for a fixed set of expressions.

    Parameters
    ----------
    expressions : sequence of Expr
        Everything that will be read into the ring.
    relations : sequence of Expr
        Hypotheses, each an expression that is zero.

    Raises
    ------
    InputError
        If an expression holds a floating point number, an infinity, or something that is not a scalar formula.
    """

    def __init__(self, expressions: Sequence[Expr], relations: Sequence[Expr] = ()) -> None:
        self.relations = tuple(relations)
        self.forms: dict[Expr, LinearForm] = {}  # argument of a sine or cosine -> its linear form
        self.radicals: dict[Expr, Radical] = {}  # node with a fractional power -> what it is made of
        self.leaves: dict[Expr, bool] = {}  # symbols, functions of time, unknown functions -> in scope?
        self._collect([*expressions, *relations])

        self.bases = base_coefficients(self.forms.values())
        atoms = sorted(self.bases, key=_order)
        roots = sorted({r for radical_ in self.radicals.values() for r in radical_.roots}, key=_depth, reverse=True)
        leaves = sorted(self.leaves, key=_order)
        self.roots = {root: number for number, root in enumerate(roots)}
        self.sines = {atom: len(roots) + number for number, atom in enumerate(atoms)}
        self.symbols = {leaf: len(roots) + len(atoms) + number for number, leaf in enumerate(leaves)}
        self.cosines = {atom: len(roots) + len(atoms) + len(leaves) + n for n, atom in enumerate(atoms)}
        self.generators: list[Expr] = [
            *(root.expression for root in roots),
            *(sin(base_angle(atom, self.bases[atom])) for atom in atoms),
            *leaves,
            *(cos(base_angle(atom, self.bases[atom])) for atom in atoms),
        ]
        if not self._relate(ZZ):
            self._relate(QQ)

    # -- what occurs ------------------------------------------------------------------------------------------------

    def _collect(self, expressions: Iterable[Expr]) -> None:
        """Find angles, roots and leaves; constants of angles bring their own square roots."""
        stack, seen = list(expressions), set()
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if node.is_Symbol:
                self.leaves[node] = True
            elif node.is_Rational:
                continue
            elif node.is_Add or node.is_Mul:
                stack.extend(node.args)
            elif node.is_Pow and node.exp.is_Integer:
                stack.append(node.base)
            elif _is_root(node):
                found = radical(node, self._radicand)
                self.radicals[node] = found
                stack.extend(found.parts)
                stack.append(found.rational)
            elif type(node) in TRIGONOMETRIC:
                argument = node.args[0]
                form = self.forms[argument] = linear_form(argument)
                if form.half_turns:
                    stack.extend(constant_cosine_sine(form.half_turns))
            else:
                self._collect_leaf(node)

    def _radicand(self, base: Expr) -> tuple[Rational, Expr, Expr]:
        """Return a radicand as positive rational, numerator and denominator, reduced by the hypotheses without roots."""
        plain = [relation for relation in self.relations if not any(map(_is_root, preorder_traversal(relation)))]
        inner = FormulaRing([base], plain)
        return inner.lowest_terms(inner.ratio(base))

    def _collect_leaf(self, node: Expr) -> None:
        if node.is_Float:
            raise InputError(f"exact decision takes exact numbers, such as Rational(1, 2); got the float {node}")
        if not isinstance(node, Expr) or node.is_commutative is False or node.is_finite is False:
            raise InputError(f"exact decision takes finite scalar formulas, got {node}")
        if node.is_number and node.is_comparable is False and node.is_finite is None:
            raise InputError(f"exact decision takes finite numbers, got {node}")
        jet = isinstance(node, (AppliedUndef, MatrixElement)) or (
            isinstance(node, Derivative) and isinstance(node.expr, AppliedUndef)
        )
        self.leaves[node] = jet

    @property
    def outside_scope(self) -> tuple[Expr, ...]:
        """Terms about which the ring knows less than mathematics does: a nonzero normal form proves nothing."""
        return tuple(sorted((leaf for leaf, known in self.leaves.items() if not known), key=_order))

    # -- relations --------------------------------------------------------------------------------------------------

    def _relate(self, domain: Any) -> bool:
        """Build the ring over ``domain`` with its rules; False if the rules need fractions that it lacks."""
        self.ring = PolyRing([f"x{n}" for n in range(len(self.generators))], domain, lex)
        self.domain = domain
        self.denominators: list[PolyElement] = []  # known factors of denominators, primitive, not constant
        self.divided: dict[int, Expr] = {}  # factor -> the expression by which somebody divided
        self.rules: list[Rule] = []
        self.basis: list[PolyElement] = []
        self._memory: dict[Expr, Ratio] = {}
        self._pairs: dict[Expr, tuple[Ratio, Ratio]] = {}
        gens = self.ring.gens
        rules = [
            Rule(self.sines[atom], 2, 1 - gens[self.cosines[atom]] ** 2) for atom in self.bases
        ]
        for root, number in self.roots.items():
            value = self.ratio(root.power_expression)
            if value.constant != 1 or value.factors:
                raise InputError(f"internal: the radicand of {root.expression} is not a polynomial")
            rules.append(Rule(number, root.index, value.numerator))
        hypotheses = [self.ratio(relation).numerator for relation in self.relations]
        self._memory.clear()
        self._pairs.clear()
        self.rules = sorted(rules, key=lambda rule: rule.generator)
        for hypothesis in hypotheses:
            reduced = self.reduce(hypothesis)
            if not reduced:
                continue
            rule = self._as_rule(reduced)
            if rule is None:
                if domain is ZZ:
                    return False
                self._complete(hypotheses)
                return True
            self.rules = sorted([*self.rules, rule], key=lambda rule: rule.generator)
        return True

    def _as_rule(self, poly: PolyElement) -> Rule | None:
        """Return the hypothesis ``poly = 0`` as a rule for a generator that has none yet, or None."""
        lead = poly.leading_expv()
        places = [number for number, power in enumerate(lead) if power]
        if len(places) != 1 or any(rule.generator == places[0] for rule in self.rules):
            return None
        place = places[0]
        if any(mono[place] for mono in poly if mono != lead):
            return None
        coefficient = poly[lead]
        if self.domain is ZZ and abs(coefficient) != 1:
            return None
        rest = poly - self.ring.term_new(lead, coefficient)
        # rules must not feed each other: a rule already there may hold this generator in its replacement only if higher
        return Rule(place, lead[place], (-rest).quo_ground(coefficient))

    def _complete(self, hypotheses: list[PolyElement]) -> None:
        gens = self.ring.gens
        relations = [gens[rule.generator] ** rule.power - rule.replacement for rule in self.rules]
        self.rules = []
        self.basis = groebner([p for p in [*relations, *hypotheses] if p], self.ring)
        if any(p.is_ground for p in self.basis):
            raise InputError(f"the hypotheses contradict each other: {', '.join(map(str, self.relations))}")

    def reduce(self, poly: PolyElement) -> PolyElement:
        """Return the normal form of a polynomial: zero exactly when it follows from the relations."""
        for rule in self.rules:
            poly = _replace(poly, rule)
        return poly.rem(self.basis) if self.basis and poly else poly

    # -- arithmetic -------------------------------------------------------------------------------------------------

    def ratio(self, expression: Expr) -> Ratio:
        """Return the expression as a fraction; ``InputError`` if it divides by what is identically zero."""
        known = self._memory.get(expression)
        if known is None:
            known = self._memory[expression] = self._read(expression)
        return known

    def _read(self, node: Expr) -> Ratio:
        if node in self.symbols:
            return Ratio(self.ring.gens[self.symbols[node]])
        if node.is_Rational:
            return Ratio(self.ring.ground_new(self.domain(int(node.p))), int(node.q))
        if node.is_Add:
            return self.add([self.ratio(term) for term in node.args])
        if node.is_Mul:
            return self.multiply([self.ratio(factor) for factor in node.args])
        if node in self.radicals:
            return self._read_radical(self.radicals[node])
        if node.is_Pow:
            power = int(node.exp)
            base = self.ratio(node.base)
            return self.power(base, power) if power >= 0 else self.power(self.invert(base, node.base), -power)
        top, bottom = TRIGONOMETRIC[type(node)]
        cosine, sine = self.cosine_sine(node.args[0])
        values = {"c": cosine, "s": sine, "1": Ratio(self.ring.one)}
        if bottom == "1":
            return values[top]
        below = {"c": cos, "s": sin}[bottom](node.args[0])
        return self.multiply([values[top], self.invert(values[bottom], below)])

    def _read_radical(self, found: Radical) -> Ratio:
        factors = [Ratio(self.ring.gens[self.roots[root]]) for root in found.roots]
        value = self.multiply([self.ratio(found.rational), *factors])
        if found.below != 1:
            value = self.multiply([value, self.invert(self.ratio(found.below), found.below)])
        if found.power >= 0:
            return self.power(value, found.power)
        return self.power(self.invert(value, found.expression), -found.power)

    def cosine_sine(self, argument: Expr) -> tuple[Ratio, Ratio]:
        """Return the cosine and sine of an angle in those of the base angles (angle addition, Chebyshev)."""
        known = self._pairs.get(argument)
        if known is not None:
            return known
        form = self.forms[argument]
        gens, ring = self.ring.gens, self.ring
        cosine, sine = ring.one, ring.zero
        for atom, coefficient in form.terms:
            multiple = int(coefficient / self.bases[atom])
            first, second = chebyshev(abs(multiple))
            c = _polynomial(ring, self.cosines[atom], first)
            s = _polynomial(ring, self.cosines[atom], second) * gens[self.sines[atom]]
            s = s if multiple > 0 else -s
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        pair = Ratio(cosine), Ratio(sine)
        if form.half_turns:
            c0, s0 = map(self.ratio, constant_cosine_sine(form.half_turns))
            minus = Ratio(-ring.one)
            pair = (
                self.add([self.multiply([pair[0], c0]), self.multiply([minus, pair[1], s0])]),
                self.add([self.multiply([pair[1], c0]), self.multiply([pair[0], s0])]),
            )
        self._pairs[argument] = pair
        return pair

    def add(self, terms: Sequence[Ratio]) -> Ratio:
        """Return the sum; terms of equal denominator are added before anything is cross-multiplied."""
        groups: dict[tuple[int, tuple[tuple[int, int], ...]], PolyElement] = {}
        for term in terms:
            key = (term.constant, term.factors)
            groups[key] = groups[key] + term.numerator if key in groups else term.numerator
        if len(groups) == 1:
            ((constant, factors), numerator), = groups.items()
            return Ratio(numerator, constant, factors)
        common_constant, common = 1, {}
        for constant, factors in groups:
            common_constant = common_constant * constant // gcd(common_constant, constant)
            for number, power in factors:
                common[number] = max(power, common.get(number, 0))
        total = self.ring.zero
        for (constant, factors), numerator in groups.items():
            own = dict(factors)
            for number, power in sorted(common.items()):
                missing = power - own.get(number, 0)
                if missing:
                    numerator = numerator * self.denominators[number] ** missing
            total = total + numerator.mul_ground(self.domain(common_constant // constant))
        return Ratio(total, common_constant, tuple(sorted(common.items())))

    def multiply(self, factors: Sequence[Ratio]) -> Ratio:
        """Return the product of fractions."""
        numerator, constant = self.ring.one, 1
        below: dict[int, int] = {}
        for factor in sorted(factors, key=lambda f: len(f.numerator)):
            numerator = numerator * factor.numerator
            constant *= factor.constant
            for number, power in factor.factors:
                below[number] = below.get(number, 0) + power
        return Ratio(numerator, constant, tuple(sorted(below.items())))

    def power(self, base: Ratio, exponent: int) -> Ratio:
        """Return a fraction to a power >= 0."""
        return Ratio(
            base.numerator**exponent if exponent else self.ring.one,
            base.constant**exponent,
            tuple((number, power * exponent) for number, power in base.factors if exponent),
        )

    def invert(self, value: Ratio, source: Expr) -> Ratio:
        """Return 1/value; its numerator becomes known factors of denominators, remembered as ``source != 0``.

        Raises
        ------
        InputError
            If the value is zero everywhere.
        """
        numerator = self.reduce(value.numerator)
        if not numerator:
            raise InputError(f"the formula divides by {source}, which is zero everywhere")
        above = self.ring.ground_new(self.domain(value.constant))
        for number, power in value.factors:
            above = above * self.denominators[number] ** power
        constant, below = self._split(numerator, source)
        if isinstance(constant, Fraction):
            above = above.mul_ground(self.domain(constant.denominator))
            constant = constant.numerator
        if constant < 0:
            above, constant = -above, -constant
        return Ratio(above, constant, below)

    def _split(self, poly: PolyElement, source: Expr) -> tuple[Any, tuple[tuple[int, int], ...]]:
        """Return a polynomial as a rational constant times known factors, learning the ones that are new."""
        constant: Any = 1
        if self.domain is QQ:
            scale, poly = poly.clear_denoms()
            constant = Fraction(1, int(scale))
        content, poly = poly.primitive()
        constant = constant * int(content)
        if poly.LC < 0:
            poly, constant = -poly, -constant
        powers: dict[int, int] = {}
        shared = [min(column) for column in zip(*poly, strict=True)]
        for place, power in enumerate(shared):
            if power:
                powers[self._factor(self.ring.gens[place], self.generators[place])] = power
        if any(shared):
            poly = poly.new({tuple(m - s for m, s in zip(mono, shared, strict=True)): c for mono, c in poly.items()})
        for number, known in enumerate(self.denominators):
            while len(known) > 1 and not poly.is_ground:
                quotient, rest = divmod(poly, known)
                if rest:
                    break
                poly, powers[number] = quotient, powers.get(number, 0) + 1
        if poly.is_ground:
            constant = constant * Fraction(int(poly.LC.numerator), int(poly.LC.denominator))
        else:
            powers[self._factor(poly, source)] = 1
        constant = Fraction(constant)
        return (int(constant) if constant.denominator == 1 else constant), tuple(sorted(powers.items()))

    def _factor(self, poly: PolyElement, source: Expr) -> int:
        for number, known in enumerate(self.denominators):
            if known == poly:
                return number
        self.denominators.append(poly)
        self.divided[len(self.denominators) - 1] = source
        return len(self.denominators) - 1

    # -- back to SymPy ----------------------------------------------------------------------------------------------

    def denominator(self, value: Ratio) -> PolyElement:
        """Return the denominator multiplied out."""
        below = self.ring.ground_new(self.domain(value.constant))
        for number, power in value.factors:
            below = below * self.denominators[number] ** power
        return below

    def lowest_terms(self, value: Ratio) -> tuple[Rational, Expr, Expr]:
        """Return (c, P, Q) with value = c*P/Q, c a positive rational, P and Q primitive over the integers; (0, 0, 1)."""
        numerator = self.reduce(value.numerator)
        if not numerator:
            return Integer(0), Integer(0), Integer(1)
        pair = numerator.cancel(self.reduce(self.denominator(value)))
        scales, parts = zip(*(poly.clear_denoms() for poly in pair), strict=True)
        contents, parts = zip(*(poly.primitive() for poly in parts), strict=True)
        constant = Rational(int(contents[0]) * int(scales[1]), int(contents[1]) * int(scales[0]))
        above, below = (part.as_expr(*self.generators) for part in parts)
        return constant, above, below

    def expression(self, value: Ratio) -> Expr:
        """Return the fraction in lowest terms as a SymPy expression; exactly 0 if its numerator reduces to zero."""
        numerator = self.reduce(value.numerator)
        if not numerator:
            return Integer(0)
        numerator, below = numerator.cancel(self.reduce(self.denominator(value)))
        return numerator.as_expr(*self.generators) / below.as_expr(*self.generators)


def _is_root(node: Expr) -> bool:
    """Return whether the node is a fractional power, i, or the absolute value of something real."""
    if node is I:
        return True
    if isinstance(node, Pow):
        return bool(node.exp.is_Rational and not node.exp.is_Integer)
    return isinstance(node, Abs) and bool(node.args[0].is_extended_real)


def _order(node: Expr) -> tuple[str, str]:
    """Return a key that does not depend on hashing: names as a person sorts them."""
    return (str(node), type(node).__name__)


def _depth(root: Any) -> tuple[int, str, str]:
    return (root.depth, str(root.expression), str(root.power_expression))


def _polynomial(ring: PolyRing, place: int, coefficients: Sequence[int]) -> PolyElement:
    """Return the polynomial in one generator with these integer coefficients, low to high."""
    gen = ring.gens[place]
    return sum((gen**power * c for power, c in enumerate(coefficients) if c), ring.zero)


def _replace(poly: PolyElement, rule: Rule) -> PolyElement:
    """Replace every power >= rule.power of the generator, in one pass."""
    place, power = rule.generator, rule.power
    low: dict[tuple[int, ...], Any] = {}
    high: dict[int, dict[tuple[int, ...], Any]] = {}
    for mono, coefficient in poly.items():
        times, left = divmod(mono[place], power)
        if times:
            high.setdefault(times, {})[(*mono[:place], left, *mono[place + 1 :])] = coefficient
        else:
            low[mono] = coefficient
    if not high:
        return poly
    total = poly.new(low)
    for times in sorted(high):
        total = total + poly.new(high[times]) * rule.replacement**times
    return total


"""Formulas as fractions of polynomials, in a ring of polynomials made for the formulas of one problem.

The variables are, highest first: roots, sines, symbols, exponentials, and cosines. Each relation, such as ``g^n = P``
or ``s^2 = 1 - c^2``, replaces a power of its own variable. That gives the unique normal form
(``docs/exact_decisions.md``, sections 2 to 4).
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import sympy
from sympy import Abs, Expr, I, Integer, Pow, Rational, S, cos, pi, preorder_traversal, sin
from sympy.core.function import AppliedUndef
from sympy.polys.domains import QQ, ZZ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import InputError
from symrot.exact.angles import cyclotomic
from symrot.exact.angles.angles import (
    LinearForm,
    base_angle,
    base_coefficients,
    constant_cosine_sine,
    linear_form,
)
from symrot.exact.angles.constants import Number, cosine_number, root_number, without_zeros
from symrot.exact.angles.inverse import INVERSE
from symrot.exact.angles.known_angles import is_known_angle, parts_of, without_known_angles
from symrot.exact.functions import REWRITTEN, TRIGONOMETRIC, is_function_of_time
from symrot.exact.limits.budget import remembered, spend_ring
from symrot.exact.limits.operations import spend
from symrot.exact.ring.angles import Angles
from symrot.exact.ring.logarithms import logarithms_in, product_of, sums_of_logarithms
from symrot.exact.ring.polynomials import occurring, univariate
from symrot.exact.ring.radicands import Dependence, dependences, take_squares, without_circles
from symrot.exact.ring.ratio import Ratio, Ratios, TooLarge
from symrot.exact.ring.relations import Relations, Rule, relate
from symrot.exact.ring.roots import Radical, Radicand, Root, is_root, radical, square_root_of_number, written

__all__ = ["FormulaRing", "as_zero"]

MOST_NESTED_TERMS = 40
"""Largest number of terms (numerator and denominator) of a radicand that itself contains roots.

A larger radicand raises TooLarge, because each level of nested roots multiplies the work."""


def as_zero(relation: Any) -> Expr:
    """Return the expression that a hypothesis says is zero: an expression itself, or left - right of an equation.

    Raises
    ------
    InputError
        If the hypothesis is false, or is neither an expression nor an equation of scalars.
    """
    expected = "expected a hypothesis that is an equation, or an expression that is zero"
    try:
        relation = sympy.sympify(relation, strict=isinstance(relation, str))
    except sympy.SympifyError:
        raise InputError(f"{expected}; got {relation!r}") from None
    if relation is S.true:
        return Integer(0)
    if isinstance(relation, sympy.Eq):
        relation = relation.lhs - relation.rhs
    if not isinstance(relation, Expr):
        raise InputError(f"{expected}; got {relation}")
    return relation


# Sines, cosines and exponentials have base angles as arguments: x/6 if the formulas contain x/2 and x/3. The order of
# monomials is lexicographic, outer roots before inner ones, so the leading term of each relation is a power of its own
# variable. Constants have the relation M(2 cos(pi/N)) = 0, with the minimal polynomial M.


class NeedsFractions(ArithmeticError):
    """The exception for a relation with fractional coefficients in a ring over the integers.

    The ring is then built again over the rational numbers.
    """


class FormulaRing:
    """The polynomial ring for a fixed set of expressions, with relations between its variables and known denominators.

    Parameters
    ----------
    expressions : sequence of Expr
        All expressions that will be read into the ring.
    relations : sequence of Expr
        Hypotheses, each an expression that is zero.
    domain : sequence of Expr
        Formulas that are nonnegative wherever the expressions are defined, such as radicands that SymPy cancelled.

    Raises
    ------
    InputError
        If an expression contains a floating point number, an infinity, or a term that is not a scalar formula, if a
        divisor is zero everywhere, or if the hypotheses contradict each other.
    TooLarge
        If the budget of the current decision is exhausted (:mod:`symrot.exact.limits.budget`), or if the relations are
        too large to expand.
    """

    def __init__(
        self, expressions: Sequence[Expr], relations: Sequence[Expr] = (), domain: Sequence[Expr] = ()
    ) -> None:
        spend_ring()
        self.hypotheses = tuple(relations)
        self.domain = tuple(domain)
        self.forms: dict[Expr, LinearForm] = {}  # argument of a sine or cosine -> its linear form
        self.exponents: dict[Expr, LinearForm] = {}  # argument of an exponential -> its linear form
        self.rewritten: dict[Expr, Expr] = {}  # node -> the equal expression that is read instead
        self.radicals: dict[Expr, Radical] = {}  # node with a fractional power -> its factors and roots
        self.leaves: dict[Expr, bool] = {}  # symbol or function -> whether it is in the scope of the theorem
        self.logarithms = self._sums_of_logarithms([*expressions, *relations, *domain])
        self.own_logarithms = {leaf for total in self.logarithms.values() for leaf in total.atoms(sympy.log)}
        self._collect([*expressions, *relations, *domain])

        # atom of an angle, such as theta -> coefficient of its base angle, such as 1/6 for theta/6
        self.bases = base_coefficients(map(without_known_angles, self.forms.values()))
        # N if the ring has a variable for 2 cos(pi/N), else 0
        self.fine = self._take_constant_angles()
        self.exponent_bases = base_coefficients(self.exponents.values())
        self.dependences: dict[Root, Dependence] = {}
        roots = {root for new in self.radicals.values() for root in new.generators}
        while True:
            self._number_generators(sorted(roots - set(self.dependences), key=_depth))
            relations_found = self._relate(ZZ) or self._relate(QQ)
            assert relations_found is not None  # rational coefficients suffice for any polynomial
            self.relations: Relations = relations_found
            new = without_circles(self._dependences(), self.dependences)
            if not new:
                break
            self.dependences |= new
            for dependence in new.values():
                roots |= {factor for factor, _ in dependence.divisors if isinstance(factor, Root)}
                roots |= set(square_root_of_number(dependence.number)[1])
        if self.relations.contradictory:
            raise InputError(f"the hypotheses contradict each other: {', '.join(map(str, self.hypotheses))}")

    def _number_generators(self, roots: Sequence[Root]) -> None:
        atoms = sorted(self.bases, key=_order)
        exponents = sorted(self.exponent_bases, key=_order)
        leaves = sorted(self.leaves, key=_order)
        self.generators: list[Expr] = []
        self.roots = self._number((root, root.expression) for root in roots)
        self.sines = self._number((atom, sin(base_angle(atom, self.bases[atom]))) for atom in atoms)
        self.symbols = self._number((leaf, leaf) for leaf in leaves)
        self.exponentials = self._number(
            (atom, sympy.exp(base_angle(atom, self.exponent_bases[atom]))) for atom in exponents
        )
        self.cosines = self._number((atom, cos(base_angle(atom, self.bases[atom]))) for atom in atoms)
        self.own = {self.generators[n]: n for n in range(len(self.roots), len(self.generators))}
        constants = [(pi, 2 * cos(pi / self.fine))] if self.fine else []
        self.fine_place = self._number(constants).get(pi, -1)

    def _number(self, named: Iterable[tuple[Any, Expr]]) -> dict[Any, int]:
        """Append a variable to the ring for each pair (key, expression), and return a map from key to its index."""
        numbers = {}
        for key, expression in named:
            numbers[key] = len(self.generators)
            self.generators.append(expression)
        return numbers

    # -- what occurs ------------------------------------------------------------------------------------------------

    def _sums_of_logarithms(self, expressions: Sequence[Expr]) -> dict[Expr, Expr]:
        """Return, for each logarithm in expressions, an equal sum of logarithms of irreducible factors.

        ``log(a^2*b)`` gives ``2*log(|a|) + log(b)``.
        """
        logarithms = [node for node in logarithms_in(expressions) if _is_of_real(node)]
        if not logarithms:
            return {}
        plain = tuple(
            each for each in self.hypotheses if not each.has(sympy.log) and not any(map(is_root, each.atoms(Pow)))
        )
        inner = FormulaRing([node.args[0] for node in logarithms], plain)
        roots = {place: (root.index, inner._polynomial(root)) for root, place in inner.roots.items()}
        products = {}
        for node in logarithms:
            content, above, below = inner.lowest_polynomials(inner.ratio(node.args[0]))
            if content:
                products[node] = product_of(content, above, below, inner.generators, roots)
        return sums_of_logarithms(products)

    def _exponential(self, node: Expr) -> Expr:
        """Return an exponential whose exponent contains no logarithms of products.

        ``exp(b*log(a^2))`` becomes ``exp(2*b*log(|a|))``.
        """
        return sympy.exp(node.args[0].xreplace(self.logarithms).expand()) if self.logarithms else node

    def _collect(self, expressions: Iterable[Expr]) -> None:
        """Store the parts of ``expressions`` that need a variable of the ring: symbols, roots, angles, exponentials."""
        stack, seen = list(expressions), set()
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            spend(20)
            if node.is_Symbol and node.is_commutative:
                self.leaves[node] = True
            elif node.is_Rational:
                continue
            elif node.is_Add or node.is_Mul:
                stack.extend(node.args)
            elif node.is_Pow and node.exp.is_Integer:
                stack.append(node.base)
            elif is_root(node):
                root = self.radicals[node] = radical(node, self._radicand)
                stack.extend(root.parts)
            elif type(node) in TRIGONOMETRIC:
                form = self.forms[node.args[0]] = linear_form(node.args[0])
                if form.half_turns:
                    # the angle x + pi/8 needs the square roots in cos(pi/8) and sin(pi/8)
                    stack.extend(constant_cosine_sine(form.half_turns))
                for atom, coefficient in form.terms:
                    if is_known_angle(atom, coefficient):
                        stack.extend(parts_of(atom, coefficient))
            elif self.logarithms.get(node, node) != node and node not in self.own_logarithms:
                self.rewritten[node] = self.logarithms[node]
                stack.append(self.rewritten[node])
            elif isinstance(node, sympy.exp) and self._exponential(node) != node:
                self.rewritten[node] = self._exponential(node)
                stack.append(self.rewritten[node])
            elif isinstance(node, sympy.exp) and node.args[0].is_extended_real is not False:
                self.exponents[node.args[0]] = linear_form(node.args[0], turns=False)
            elif type(node) in REWRITTEN:
                self.rewritten[node] = REWRITTEN[type(node)](*node.args)
                stack.append(self.rewritten[node])
            elif node is S.Exp1:
                self.exponents[Integer(1)] = linear_form(Integer(1))
            else:
                self.leaves[node] = is_function_of_time(node)

    def _radicand(self, base: Expr, index: int) -> Radicand:
        """Return the factors of ``base``, an expression under a root with the given ``index`` (2 for a square root)."""
        # hypotheses without roots shorten it: with q0^2 + q1^2 = 1, 1 - q1^2 becomes q0^2
        plain = tuple(each for each in self.hypotheses if not any(map(is_root, preorder_traversal(each))))
        radicand: Radicand = remembered(("radicand", base, index, plain), lambda: _taken_apart(base, index, plain))
        return radicand

    def _dependences(self) -> dict[Root, Dependence]:
        """Return a map from square roots to the equal products of other roots: from sqrt(a*b) to sqrt(a)*sqrt(b)."""
        places = {root: n for root, n in self.roots.items() if root.index == 2 and not root.power_expression.is_number}
        plain = [root for root in places if not isinstance(root.expression, Abs)]
        if not plain or len(places) < 2:
            return {}
        return dependences({root: self._polynomial(root) for root in places}, self.generators)

    def _take_constant_angles(self) -> int:
        """Return N, and delete pi from ``bases``, if the ring needs a variable for 2 cos(pi/N); else return 0.

        The ring needs it if constant angles, such as 3 pi/7, are no multiples of pi/24. The sines and cosines of these
        angles are then polynomials in 2 cos(pi/N), where N is the smallest even multiple of their denominators: 14 for
        3 pi/7. If N is too large, the result is 0, and pi stays in ``bases``, the map from each quantity in the angles,
        such as theta or pi, to the coefficient of its base angle, such as theta/6 or pi/1009. Sine and cosine of a base
        angle are two variables of the ring.
        """
        # multiples of pi/24 have square roots as sines and cosines
        if pi not in self.bases or not cyclotomic.has_affordable_degree(self.bases[pi].denominator):
            return 0
        return cyclotomic.order(self.bases.pop(pi).denominator)

    @property
    def outside_scope(self) -> tuple[Expr, ...]:
        """Functions and angles between which unknown relations may hold, such as functions without a definition."""
        # if there are any, a nonzero normal form does not prove that a formula is not zero
        atoms = [atom for atom in self.bases if atom.is_number or atom.has(*INVERSE, sympy.log)]
        return tuple(sorted([*atoms, *(leaf for leaf, known in self.leaves.items() if not known)], key=_order))

    # -- the ring and its relations ---------------------------------------------------------------------------------

    def _relate(self, domain: Any) -> Relations | None:
        """Build the ring over ``domain``, the integers or the rationals; return the relations of its variables.

        The result is None if ``domain`` is the integers, but a relation contains fractions.
        """
        self.ring = PolyRing([f"x{number}" for number in range(len(self.generators))], domain, lex)
        self.relations = Relations()
        self.numbers: dict[int, Number] = {}
        self.ratios = Ratios(self.ring, self.generators, self.reduce)
        self._read_already: dict[Expr, Ratio] = {}
        self._angles = Angles(
            self.ratios, self.ratio, self.forms, self.bases, self.cosines, self.sines, self.fine, self.fine_place
        )
        rules = [Rule(self.sines[atom], 2, 1 - self.ring.gens[self.cosines[atom]] ** 2) for atom in self.bases]
        if self.fine:
            *low, _ = cyclotomic.minimal_polynomial(self.fine)
            rules.append(Rule(self.fine_place, len(low), -univariate(self.ring, self.fine_place, low), minimal=True))
            self.relations = Relations(tuple(rules[-1:]))
        try:
            rules += [Rule(number, root.index, self._polynomial(root)) for root, number in self.roots.items()]
        except NeedsFractions:
            return None
        self.relations = Relations(tuple(sorted(rules, key=lambda rule: rule.generator)))
        self.hypothesis_numerators = [self.ratio(hypothesis).numerator for hypothesis in self.hypotheses]
        self.numbers = self._tangled_numbers(rules)
        return relate(rules, self.hypothesis_numerators)

    def _polynomial(self, root: Root) -> PolyElement:
        """Return the polynomial P of the relation ``g^n = P`` of a root g.

        Raise ``NeedsFractions`` if P has fractional coefficients.
        """
        value = self.ratio(root.power_expression)
        above, below = self.reduce(value.numerator).cancel(self.ratios.denominator(value))
        if not below.is_ground:
            raise InputError(f"expected a polynomial as the radicand of {root.expression}, got {above}/{below}")
        if abs(below.LC) == 1:
            return above.mul_ground(below.LC)
        if self.ring.domain is ZZ:
            raise NeedsFractions
        return above.quo_ground(below.LC)

    def _tangled_numbers(self, rules: Sequence[Rule]) -> dict[int, Number]:
        """Return a map from the index of a variable to the algebraic number, such as 2^(1/3), for which it stands.

        Several algebraic numbers may satisfy equations that do not follow from the ring's relations, such as
        ``sqrt(3 + 2 sqrt(2)) = 1 + sqrt(2)``. If such an equation is possible, the map has all algebraic numbers of the
        ring. It is empty if none is possible: for a single number, and for square roots of primes alone. It is also
        empty if the ring contains the imaginary unit, because symrot proves such equations for real numbers only.
        ``rules`` are the relations of the ring's variables.
        """
        known: dict[int, Number] = {}
        if self.fine:
            known[self.fine_place] = cosine_number(self.fine_place, cyclotomic.degree(self.fine), self.fine)
        inside = {rule.generator: rule.replacement for rule in rules}
        for root, place in reversed(self.roots.items()):
            if root.power_expression.is_number and all(n in known for n in occurring([inside[place]])):
                known[place] = root_number(place, root.index, inside[place], known)
        simple = all(number.index == 2 and not number.needs for number in known.values())
        return {} if simple or len(known) < 2 or I in self.generators else known

    def reduce(self, poly: PolyElement) -> PolyElement:
        """Return the normal form of a polynomial modulo the relations, which is 0 for a sum of multiples of relations.

        Algebraic numbers that are zero are also removed, such as ``sqrt(3 + 2 sqrt(2)) - 1 - sqrt(2)``.
        """
        poly = self.relations.reduce(poly)
        return without_zeros(poly, self.numbers) if self.numbers and poly else poly

    # -- reading ----------------------------------------------------------------------------------------------------

    def ratio(self, expression: Expr) -> Ratio:
        """Return an expression as a fraction of polynomials of the ring, not in lowest terms.

        Raise ``InputError`` if a divisor is zero everywhere.
        """
        # equal expressions may give different fractions
        known = self._read_already.get(expression)
        if known is None:
            known = self._read_already[expression] = self._read(expression)
        return known

    def difference(self, left: Expr, right: Expr) -> Ratio:
        """Return left - right as a fraction of polynomials; the sides are equal if its numerator reduces to 0."""
        minus_right = self.ratios.multiply([self.ratios.number(-1), self.ratio(right)])
        return self.ratios.add([self.ratio(left), minus_right])

    def _read(self, node: Expr) -> Ratio:
        ratios = self.ratios
        if node in self.own:
            return Ratio(self.ring.gens[self.own[node]])
        if node.is_Rational:
            return ratios.number(int(node.p), int(node.q))
        if node in self.rewritten:
            return self.ratio(self.rewritten[node])
        if node is S.Exp1 or isinstance(node, sympy.exp):
            exponent = node.args[0] if node.args else Integer(1)
            # SymPy writes a power of a variable exp(x) as exp(2*x), which need not occur in the formulas
            return self._read_exponential(self.exponents.get(exponent) or linear_form(exponent, turns=False))
        if node.is_Add:
            return ratios.add([self.ratio(term) for term in node.args])
        if node.is_Mul:
            return ratios.multiply([self.ratio(factor) for factor in node.args])
        if node in self.radicals:
            return self._read_radical(self.radicals[node])
        if node.is_Pow:
            return self._power(self.ratio(node.base), int(node.exp), node.base)
        above, below = TRIGONOMETRIC[type(node)]
        cosine, sine = self._angles.cosine_sine(node.args[0])
        values = {"cos": cosine, "sin": sine, None: ratios.number(1)}
        if below is None:
            return values[above]
        return ratios.multiply([values[above], ratios.invert(values[below], getattr(sympy, below)(node.args[0]))])

    def _power(self, base: Ratio, exponent: int, source: Expr) -> Ratio:
        return self.ratios.power(base if exponent >= 0 else self.ratios.invert(base, source), abs(exponent))

    def _read_radical(self, parts: Radical) -> Ratio:
        factors = [self._root(root) for root in parts.roots]
        below = self.ratios.invert(self.ratio(parts.below), parts.below)
        value = self.ratios.multiply([self.ratio(parts.rational), below, *factors, *self._outside(parts.outside)])
        return self._power(value, parts.power, parts.base)

    def _root(self, root: Root) -> Ratio:
        dependence = self.dependences.get(root)
        if dependence is None:
            return Ratio(self.ring.gens[self.roots[root]])
        divisors = self._outside((factor, -times) for factor, times in dependence.divisors)
        rational, primes = square_root_of_number(dependence.number)
        number = self.ratios.number(int(rational.p), int(rational.q))
        return self.ratios.multiply([number, *map(self._root, (*primes, *dependence.roots)), *divisors])

    def _outside(self, factors: Iterable[tuple[Root | Expr, int]]) -> Iterator[Ratio]:
        """Yield factor^n for each pair (factor, n) of ``factors``, as fractions of the ring.

        n is negative for a factor below the fraction bar.
        """
        for factor, times in factors:
            if isinstance(factor, Root):
                yield self._power(self._root(factor), times, factor.expression)
            else:
                yield self._power(self.ratio(factor), times, factor)

    def _read_exponential(self, form: LinearForm) -> Ratio:
        factors = []
        for atom, coefficient in form.terms:
            base = self.exponent_bases[atom]
            generator, multiple = Ratio(self.ring.gens[self.exponentials[atom]]), coefficient / base
            if multiple.denominator != 1:
                raise AssertionError(
                    f"expected a whole multiple of {base}*{atom} in an exponent, got {coefficient}*{atom}"
                )
            factors.append(self._power(generator, int(multiple), self.generators[self.exponentials[atom]]))
        return self.ratios.multiply(factors)

    # -- back to SymPy ----------------------------------------------------------------------------------------------

    def expression(self, value: Ratio) -> Expr:
        """Return a fraction in lowest terms as a SymPy expression; exactly 0 if its numerator reduces to zero."""
        constant, above, below = self.lowest_polynomials(value)
        return constant * above.as_expr(*self.generators) / below.as_expr(*self.generators)

    def lowest_polynomials(self, value: Ratio) -> tuple[Rational, PolyElement, PolyElement]:
        """Return (c, P, Q) with value = c*P/Q in lowest terms; c is a rational number >= 0, P and Q are polynomials."""
        numerator = self.reduce(value.numerator)
        if not numerator:
            return Integer(0), self.ring.zero, self.ring.one
        pair = numerator.cancel(self.reduce(self.ratios.denominator(value)))
        # the coefficients of P, and those of Q, become integers without a common divisor
        scales, parts = zip(*(poly.clear_denoms() for poly in pair), strict=True)
        contents, (above, below) = zip(*(poly.primitive() for poly in parts), strict=True)
        constant = Rational(int(contents[0]) * int(scales[1]), int(contents[1]) * int(scales[0]))
        return constant, above, below


def _taken_apart(base: Expr, index: int, hypotheses: Sequence[Expr]) -> Radicand:
    inner = FormulaRing([base], hypotheses)
    content, above, below = inner.lowest_polynomials(inner.ratio(base))
    if inner.roots and len(above) + len(below) > MOST_NESTED_TERMS:
        raise TooLarge(f"a radicand that contains roots has more than {MOST_NESTED_TERMS} terms; simplify it")
    if index != 2:
        return Radicand(content, above.as_expr(*inner.generators), below.as_expr(*inner.generators))
    rest, outside, loose = take_squares(above, below, inner.generators)
    return Radicand(content, rest, Integer(1), outside, loose)


def _is_of_real(logarithm: Expr) -> bool:
    """Return whether the argument of a logarithm contains only real symbols and functions.

    Only then may the logarithm be written as a sum.
    """
    leaves = logarithm.atoms(sympy.Symbol, AppliedUndef)
    return not logarithm.has(I) and all(leaf.is_extended_real for leaf in leaves)


def _order(node: Expr) -> tuple[str, str]:
    """Return a sort key of an expression that is the same in every run: its text and its type."""
    return (written(node), type(node).__name__)


def _depth(root: Root) -> tuple[int, str, str]:
    """Return a sort key of a root; outer roots come before the roots inside them."""
    return (-root.depth, written(root.expression), written(root.power_expression))

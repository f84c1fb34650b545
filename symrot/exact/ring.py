"""Expressions as fractions of polynomials, in one ring made for the problem at hand.

Generators, highest first: roots (outer before inner), sines, then symbols and functions of time, then cosines. The
order is lexicographic, so each relation

    root:    g^n = P           circle:    s^2 = 1 - c^2           hypothesis:    q0^2 = 1 - q1^2 - q2^2 - q3^2

leads with a power of its own generator, and replacing leading powers gives the unique normal form
(:mod:`symrot.exact.relations`; research: VERIFICATION.md, section 1, steps (b) to (f)).
"""

from collections.abc import Iterable, Sequence
from typing import Any

import sympy
from sympy import Derivative, Expr, Integer, Rational, S, cos, preorder_traversal, sin
from sympy.core.function import AppliedUndef
from sympy.matrices.expressions.matexpr import MatrixElement
from sympy.polys.domains import QQ, ZZ
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
from symrot.exact.ratio import Ratio, Ratios
from symrot.exact.relations import Relations, Rule, relate
from symrot.exact.roots import Radical, Root, is_root, radical

__all__ = ["FormulaRing", "as_zero"]

TRIGONOMETRIC = {
    sympy.sin: ("sin", None),
    sympy.cos: ("cos", None),
    sympy.tan: ("sin", "cos"),
    sympy.cot: ("cos", "sin"),
    sympy.sec: (None, "cos"),
    sympy.csc: (None, "sin"),
}
"""Function -> (above, below) in the sine and cosine of its argument; None is 1."""


def as_zero(relation: Any) -> Expr:
    """Return the expression that a hypothesis puts to zero: an expression itself, or left - right of an equation.

    Raises
    ------
    InputError
        If the hypothesis is false, or is neither an expression nor an equation of scalars.
    """
    relation = sympy.sympify(relation)
    if relation is S.true:
        return Integer(0)
    if isinstance(relation, sympy.Eq):
        relation = relation.lhs - relation.rhs
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
        If an expression holds a floating point number, an infinity, or something that is not a scalar formula, if it
        divides by what is zero everywhere, or if the hypotheses contradict each other.
    """

    def __init__(self, expressions: Sequence[Expr], relations: Sequence[Expr] = ()) -> None:
        self.hypotheses = tuple(relations)
        self.forms: dict[Expr, LinearForm] = {}  # argument of a sine or cosine -> its linear form
        self.radicals: dict[Expr, Radical] = {}  # node with a fractional power -> what it is made of
        self.leaves: dict[Expr, bool] = {}  # symbols, functions of time, other functions -> in scope?
        self._collect([*expressions, *relations])

        self.bases = base_coefficients(self.forms.values())
        atoms = sorted(self.bases, key=_order)
        leaves = sorted(self.leaves, key=_order)
        roots = sorted({root for found in self.radicals.values() for root in found.roots}, key=_depth)
        first_leaf, first_cosine = len(roots) + len(atoms), len(roots) + len(atoms) + len(leaves)
        self.roots = {root: number for number, root in enumerate(roots)}
        self.sines = {atom: len(roots) + number for number, atom in enumerate(atoms)}
        self.symbols = {leaf: first_leaf + number for number, leaf in enumerate(leaves)}
        self.cosines = {atom: first_cosine + number for number, atom in enumerate(atoms)}
        self.generators: list[Expr] = [
            *(root.expression for root in roots),
            *(sin(base_angle(atom, self.bases[atom])) for atom in atoms),
            *leaves,
            *(cos(base_angle(atom, self.bases[atom])) for atom in atoms),
        ]
        relations_found = self._relate(ZZ) or self._relate(QQ)
        assert relations_found is not None  # the rationals suffice for any polynomial
        self.relations: Relations = relations_found
        if self.relations.contradictory:
            raise InputError(f"the hypotheses contradict each other: {', '.join(map(str, self.hypotheses))}")

    # -- what occurs ------------------------------------------------------------------------------------------------

    def _collect(self, expressions: Iterable[Expr]) -> None:
        """Find angles, roots and leaves; constants of angles bring their own square roots."""
        stack, seen = list(expressions), set()
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if node.is_Symbol and node.is_commutative:
                self.leaves[node] = True
            elif node.is_Rational:
                continue
            elif node.is_Add or node.is_Mul:
                stack.extend(node.args)
            elif node.is_Pow and node.exp.is_Integer:
                stack.append(node.base)
            elif is_root(node):
                found = self.radicals[node] = radical(node, self._radicand)
                stack.extend(found.parts)
            elif type(node) in TRIGONOMETRIC:
                form = self.forms[node.args[0]] = linear_form(node.args[0])
                if form.half_turns:
                    stack.extend(constant_cosine_sine(form.half_turns))
            else:
                self.leaves[node] = _is_jet(node)

    def _radicand(self, base: Expr) -> tuple[Rational, Expr, Expr]:
        """Return a radicand in lowest terms, reduced by those hypotheses that hold no roots themselves."""
        plain = [relation for relation in self.hypotheses if not any(map(is_root, preorder_traversal(relation)))]
        inner = FormulaRing([base], plain)
        return inner.lowest_terms(inner.ratio(base))

    @property
    def outside_scope(self) -> tuple[Expr, ...]:
        """Functions about which the ring knows less than mathematics does: a nonzero normal form proves nothing."""
        atoms = [atom for atom in self.bases if atom.is_number]
        return tuple(sorted([*atoms, *(leaf for leaf, known in self.leaves.items() if not known)], key=_order))

    # -- the ring and its relations ---------------------------------------------------------------------------------

    def _relate(self, domain: Any) -> Relations | None:
        """Build the ring over a domain and return its relations; None if they need fractions that it lacks."""
        self.ring = PolyRing([f"x{number}" for number in range(len(self.generators))], domain, lex)
        self.relations = Relations()
        self.ratios = Ratios(self.ring, self.generators, self.reduce)
        self._read_already: dict[Expr, Ratio] = {}
        self._angles_read: dict[Expr, tuple[Ratio, Ratio]] = {}
        rules = [Rule(self.sines[atom], 2, 1 - self.ring.gens[self.cosines[atom]] ** 2) for atom in self.bases]
        rules += [Rule(number, root.index, self._polynomial(root)) for root, number in self.roots.items()]
        self.relations = Relations(tuple(sorted(rules, key=lambda rule: rule.generator)))
        self.hypothesis_numerators = [self.ratio(hypothesis).numerator for hypothesis in self.hypotheses]
        return relate(rules, self.hypothesis_numerators)

    def _polynomial(self, root: Root) -> PolyElement:
        """Return the polynomial to which a power of a root is equal."""
        value = self.ratio(root.power_expression)
        above, below = value.numerator.cancel(self.ratios.denominator(value))
        if not below.is_ground or abs(below.LC) != 1:
            raise InputError(f"the square root {root.expression} has a radicand that is no polynomial: {above}/{below}")
        return above.mul_ground(below.LC)

    def reduce(self, poly: PolyElement) -> PolyElement:
        """Return the normal form of a polynomial: zero exactly when it follows from the relations."""
        return self.relations.reduce(poly)

    # -- reading ----------------------------------------------------------------------------------------------------

    def ratio(self, expression: Expr) -> Ratio:
        """Return the expression as a fraction; ``InputError`` if it divides by what is zero everywhere."""
        known = self._read_already.get(expression)
        if known is None:
            known = self._read_already[expression] = self._read(expression)
        return known

    def difference(self, left: Expr, right: Expr) -> Ratio:
        """Return left - right as a fraction."""
        minus_right = self.ratios.multiply([self.ratios.number(-1), self.ratio(right)])
        return self.ratios.add([self.ratio(left), minus_right])

    def _read(self, node: Expr) -> Ratio:
        ratios = self.ratios
        if node in self.symbols:
            return Ratio(self.ring.gens[self.symbols[node]])
        if node.is_Rational:
            return ratios.number(int(node.p), int(node.q))
        if node.is_Add:
            return ratios.add([self.ratio(term) for term in node.args])
        if node.is_Mul:
            return ratios.multiply([self.ratio(factor) for factor in node.args])
        if node in self.radicals:
            return self._read_radical(self.radicals[node])
        if node.is_Pow:
            return self._power(self.ratio(node.base), int(node.exp), node.base)
        above, below = TRIGONOMETRIC[type(node)]
        cosine, sine = self._cosine_sine(node.args[0])
        values = {"cos": cosine, "sin": sine, None: ratios.number(1)}
        if below is None:
            return values[above]
        return ratios.multiply([values[above], ratios.invert(values[below], getattr(sympy, below)(node.args[0]))])

    def _power(self, base: Ratio, exponent: int, source: Expr) -> Ratio:
        return self.ratios.power(base if exponent >= 0 else self.ratios.invert(base, source), abs(exponent))

    def _read_radical(self, found: Radical) -> Ratio:
        factors = [Ratio(self.ring.gens[self.roots[root]]) for root in found.roots]
        below = self.ratios.invert(self.ratio(found.below), found.below)
        value = self.ratios.multiply([self.ratio(found.rational), below, *factors])
        return self._power(value, found.power, found.base)

    def _cosine_sine(self, argument: Expr) -> tuple[Ratio, Ratio]:
        """Return the cosine and sine of an angle in those of the base angles (angle addition, Chebyshev)."""
        known = self._angles_read.get(argument)
        if known is not None:
            return known
        form = self.forms[argument]
        cosine, sine = self.ring.one, self.ring.zero
        for atom, coefficient in form.terms:
            multiple = int(coefficient / self.bases[atom])
            first, second = chebyshev(abs(multiple))
            c = self._in_cosine(atom, first)
            s = self._in_cosine(atom, second) * self.ring.gens[self.sines[atom]]
            s = s if multiple > 0 else -s
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        c0, s0 = map(self.ratio, constant_cosine_sine(form.half_turns))
        minus_s0 = self.ratios.multiply([self.ratios.number(-1), s0])
        turn, add = self.ratios.multiply, self.ratios.add
        pair = (
            add([turn([Ratio(cosine), c0]), turn([Ratio(sine), minus_s0])]),
            add([turn([Ratio(sine), c0]), turn([Ratio(cosine), s0])]),
        )
        self._angles_read[argument] = pair
        return pair

    def _in_cosine(self, atom: Expr, coefficients: Sequence[int]) -> PolyElement:
        """Return the polynomial in one cosine with these integer coefficients, low to high."""
        gen = self.ring.gens[self.cosines[atom]]
        return sum((gen**power * number for power, number in enumerate(coefficients) if number), self.ring.zero)

    # -- back to SymPy ----------------------------------------------------------------------------------------------

    def expression(self, value: Ratio) -> Expr:
        """Return the fraction in lowest terms as a SymPy expression; exactly 0 if its numerator reduces to zero."""
        constant, above, below = self.lowest_terms(value)
        return constant * above / below

    def lowest_terms(self, value: Ratio) -> tuple[Rational, Expr, Expr]:
        """Return (c, P, Q) with value = c*P/Q: c a rational >= 0, P and Q primitive over the integers."""
        numerator = self.reduce(value.numerator)
        if not numerator:
            return Integer(0), Integer(0), Integer(1)
        pair = numerator.cancel(self.reduce(self.ratios.denominator(value)))
        scales, parts = zip(*(poly.clear_denoms() for poly in pair), strict=True)
        contents, parts = zip(*(poly.primitive() for poly in parts), strict=True)
        constant = Rational(int(contents[0]) * int(scales[1]), int(contents[1]) * int(scales[0]))
        above, below = (part.as_expr(*self.generators) for part in parts)
        return constant, above, below


def _is_jet(node: Expr) -> bool:
    """Return whether a leaf is free: a function of time, a derivative of one, a matrix entry.

    Raises
    ------
    InputError
        If it is no finite exact scalar at all.
    """
    if node.is_Float:
        raise InputError(f"exact decision takes exact numbers, such as Rational(1, 2); got the float {node}")
    if not isinstance(node, Expr) or not node.is_commutative or node is S.NaN or node.is_infinite:
        raise InputError(f"exact decision takes finite scalar formulas, got {node}")
    if any(part.is_Float for part in preorder_traversal(node)):
        raise InputError(f"exact decision takes exact numbers, such as Rational(1, 2); got a float in {node}")
    if isinstance(node, Derivative):
        return isinstance(node.expr, AppliedUndef)
    return isinstance(node, (AppliedUndef, MatrixElement))


def _order(node: Expr) -> tuple[str, str]:
    """Return a key that does not depend on hashing."""
    return (str(node), type(node).__name__)


def _depth(root: Root) -> tuple[int, str, str]:
    """Return a key that puts outer roots before the roots inside them."""
    return (-root.depth, str(root.expression), str(root.power_expression))

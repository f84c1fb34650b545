"""Chains of equal expressions from the left side of an equation to the right side, as a proof that people can follow.

Each side is rewritten to its normal form, which is the same for both. The chain is the rewriting of the left side,
followed by the reversed rewriting of the right side.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Integer, Mul, cos, sin
from sympy.polys.rings import PolyElement

from symrot.exact.angles.angles import base_angle
from symrot.exact.decision import flatten, place_in_matrix
from symrot.exact.functions import TRIGONOMETRIC
from symrot.exact.ring.ratio import Ratio
from symrot.exact.ring.relations import Rule
from symrot.exact.ring.ring import FormulaRing, as_zero

__all__ = ["Chain", "Link", "chains"]


@dataclass(frozen=True)
class Link:
    """One expression in a chain of equal expressions, with the ``reason`` why it equals the expression before it."""

    expression: Expr
    reason: str
    rule: tuple[Expr, Expr] | None = None  # (left, right) of the relation that was substituted
    # pairs (polynomial, expression that is zero by the hypotheses) whose products were subtracted
    cofactors: tuple[tuple[Expr, Expr], ...] = ()


@dataclass(frozen=True)
class Chain:
    """A chain of equal expressions from the left side of an equation to the right side.

    The sides are scalars, or the same ``entry`` of two matrices.
    """

    entry: tuple[int, int] | None  # (row, column), counted from 1; None for a scalar
    links: tuple[Link, ...]


def chains(left: Any, right: Any, relations: Sequence[Any] = ()) -> tuple[Chain, ...]:
    """Return, for every entry whose sides differ as written, a chain of equal expressions from left to right.

    Parameters
    ----------
    left, right : Expr or Matrix
        Two sides, of the same shape, of an equation that normal forms prove.
    relations : sequence of Expr or Eq
        The hypotheses of the equation.

    Raises
    ------
    InputError
        If the sides cannot be read.
    ValueError
        If the normal form of left - right is not zero, as for sides that are equal for another reason, such as
        ``asin(x) + acos(x)`` and pi/2.
    """
    (lefts, shape), (rights, _) = flatten(left), flatten(right)
    hypotheses = [as_zero(relation) for relation in relations]
    entry_chains = []
    for place, (a, b) in enumerate(zip(lefts, rights, strict=True)):
        if a != b:
            entry_chains.append(Chain(place_in_matrix(place, shape), _chain(a, b, hypotheses)))
    return tuple(entry_chains)


def _chain(left: Expr, right: Expr, hypotheses: list[Expr]) -> tuple[Link, ...]:
    ring = FormulaRing([left, right], hypotheses)
    if ring.reduce(ring.difference(left, right).numerator):
        raise ValueError(f"expected two sides that are proven equal, got {left} and {right}")
    forward, backward = list(_way(ring, left)), list(_way(ring, right))
    links = [Link(left, ""), *forward]
    if forward[-1].expression != backward[-1].expression:
        links.append(Link(backward[-1].expression, "both sides agree after cross-multiplication of the fractions"))
    return _cleaned([*links, *_reversed(right, backward)])


def _reversed(start: Expr, way: list[Link]) -> Iterator[Link]:
    """Yield the links of a chain in reverse: if ``way`` leads from ``start`` = a to b and c, the links b and a."""
    places = [start, *(link.expression for link in way)]
    for number in range(len(way) - 1, -1, -1):
        # each reason stays between the same two expressions
        yield Link(places[number], way[number].reason, way[number].rule, way[number].cofactors)


def _cleaned(links: list[Link]) -> tuple[Link, ...]:
    """Return the links of a chain without those whose expression equals the one before."""
    distinct = links[:1]
    for link in links[1:]:
        if link.expression != distinct[-1].expression:
            distinct.append(link)
    return tuple(distinct)


def _way(ring: FormulaRing, side: Expr) -> Iterator[Link]:
    """Yield the links of a chain of equal expressions from ``side`` (not included) to its normal form."""
    angles = {node: value for node, value in _angles(ring, side) if value != node}
    if angles:
        yield Link(side.xreplace(angles), "sums and multiples of angles")
    value = ring.ratio(side)
    yield Link(_fraction(ring, value.numerator, value), "products multiplied out over a common denominator")
    numerator = value.numerator
    for rule in ring.relations.rules:
        reduced = type(ring.relations)((rule,)).reduce(numerator)
        if reduced != numerator:
            numerator = reduced
            yield Link(_fraction(ring, numerator, value), "a relation", _rule_formulas(ring, rule))
    if ring.relations.basis:
        quotients, rest = numerator.div(list(ring.relations.basis))
        if rest != numerator:
            numerator = rest
            pairs = zip(quotients, ring.relations.basis, strict=True)
            cofactors = tuple((_plain(ring, q), _plain(ring, b)) for q, b in pairs if q)
            yield Link(
                _fraction(ring, numerator, value),
                "multiples of expressions that are zero by hypothesis",
                None,
                cofactors,
            )
    yield Link(ring.expression(value), "common factors")


def _angles(ring: FormulaRing, side: Expr) -> Iterator[tuple[Expr, Expr]]:
    """Yield each trigonometric call in one side of an equation, with its value in sines and cosines of base angles."""
    base = {base_angle(atom, coefficient) for atom, coefficient in ring.bases.items()}
    for node in sorted(side.atoms(*TRIGONOMETRIC), key=str):
        if not (isinstance(node, (sin, cos)) and node.args[0] in base):
            value = ring.ratio(node)
            yield node, _fraction(ring, value.numerator, value)


def _plain(ring: FormulaRing, poly: PolyElement) -> Expr:
    formula: Expr = poly.as_expr(*ring.generators)
    return formula


def _fraction(ring: FormulaRing, numerator: PolyElement, value: Ratio) -> Expr:
    """Return ``numerator`` over the denominator of ``value`` as an expression.

    The factors of the denominator are not multiplied out.
    """
    below = [_plain(ring, ring.ratios.factors[number]) ** power for number, power in value.factors]
    return Mul(_plain(ring, numerator), Mul(*below, Integer(value.constant)) ** -1)


def _rule_formulas(ring: FormulaRing, rule: Rule) -> tuple[Expr, Expr]:
    return ring.generators[rule.generator] ** rule.power, _plain(ring, rule.replacement)

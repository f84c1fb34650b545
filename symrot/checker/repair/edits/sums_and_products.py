"""Edits of one sum or one product: a sign, a factor, a term, brackets, the order of factors.

The argument ``is_matrix`` of the functions tells whether a node is a matrix or vector.
"""

import itertools
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from math import isqrt

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, negated, number, product, sum_of, walk
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import neighbours, spelled_like
from symrot.checker.repair.edits.trees import substituted

__all__ = ["PartEdit", "bracketed", "edits_of_product", "edits_of_sum"]

MOST_NAMES_EXCHANGED = 6
"""A product with more names gets no edits that exchange two of them."""

MOST_TERMS_IN_PAIRS = 6
"""A sum with more terms gets no edits that change two signs, add brackets, or double or halve the whole sum."""

PartEdit = tuple[str, Node, float]
"""An edit of a part: (code of the corrected fault, new tree of the part, cost in addition to ``COST[code]``)."""


def edits_of_sum(node: Node, is_matrix: Callable[[Node], bool]) -> Iterator[PartEdit]:
    terms = list(node.args)
    plain = [term.args[0] if term.kind == "neg" else term for term in terms]
    if len(terms) == 2 and all(p.kind == "product" for p in plain) and is_matrix(plain[0]):
        first, second = (set(p.args) for p in plain)
        if first == second:
            yield "commutator_order", sum_of([negated(term) for term in terms]), 0.0
    for both in itertools.combinations(range(len(terms)), 2) if 2 < len(terms) <= MOST_TERMS_IN_PAIRS else ():
        signs = [negated(term) if place in both else term for place, term in enumerate(terms)]
        yield "two_faults", sum_of(signs), 0.0
    for factor in (number(2), number(Fraction(1, 2))) if len(terms) <= MOST_TERMS_IN_PAIRS else ():
        yield "factor", product([factor, node]), COST["product_doubled_or_halved"]
    if len(terms) <= MOST_TERMS_IN_PAIRS:
        for made in bracketed(terms):
            yield "lost_brackets", made, 0.0
    for place, term in enumerate(terms):
        others = [*terms[:place], *terms[place + 1 :]]
        yield "sign_of_term", sum_of([*terms[:place], negated(term), *terms[place + 1 :]]), 0.0
        yield "extra_term", sum_of(others), 0.0
        for factor in (number(2), number(Fraction(1, 2))):
            yield "factor", sum_of([*terms[:place], product([factor, term]), *terms[place + 1 :]]), 0.0


def bracketed(terms: Sequence[Node]) -> Iterator[Node]:
    """Yield the sum of ``terms`` with brackets that it may have lost: ``(a - b)*c`` for the terms of ``a - b*c``."""
    for first, last in itertools.combinations(range(len(terms)), 2):
        before, after = terms[:first], terms[last + 1 :]
        start, is_negative = (terms[first].args[0], True) if terms[first].kind == "neg" else (terms[first], False)
        end, is_end_negative = (terms[last].args[0], True) if terms[last].kind == "neg" else (terms[last], False)
        inside = terms[first + 1 : last]
        if end.kind == "product" and end.args[0].kind != "inv":
            *rest, factor = end.args
            lone = negated(product(rest)) if is_end_negative else product(rest)
            whole = product([sum_of([start, *inside, lone]), factor])
            yield sum_of([*before, negated(whole) if is_negative else whole, *after])
        if start.kind == "product" and start.args[1].kind != "inv":
            factor, *others = start.args
            whole = product([factor, sum_of([product(others), *inside, terms[last]])])
            yield sum_of([*before, negated(whole) if is_negative else whole, *after])


def edits_of_product(node: Node, is_matrix: Callable[[Node], bool], order: str) -> Iterator[PartEdit]:
    factors = list(node.args)
    for place in range(len(factors) - 1):
        first, second = factors[place : place + 2]
        if is_matrix(first) and is_matrix(second) and first != second:
            yield order, product([*factors[:place], second, first, *factors[place + 2 :]]), 0.0
    if len(factors) > 1 and all(factor.kind == "call" and factor.value in ROTATIONS for factor in factors):
        yield from _of_sequence(factors)
    for place in range(len(factors)):
        rest = [*factors[:place], *factors[place + 1 :]]
        if all(factor.kind == "inv" for factor in rest):
            rest = [number(1), *rest]
        yield "factor", product(rest), COST["factor_removed"]
    yield from _of_quotients(factors)
    yield from _with_exchanged_names(node, is_matrix)
    yield from _with_roots(node, is_matrix)
    if not any(map(is_matrix, factors)):
        yield "factor", product([number(2), node]), COST["product_doubled_or_halved"]
        yield "factor", product([number(Fraction(1, 2)), node]), COST["product_doubled_or_halved"]


def _with_roots(node: Node, is_matrix: Callable[[Node], bool]) -> Iterator[PartEdit]:
    """Yield edits of a product that take the root of some factors: ``2*sqrt(g*h)``, ``g*h*sqrt(2)`` for ``2*g*h``.

    Yield nothing for a product with a matrix or vector.
    """
    if any(map(is_matrix, node.args)):
        return
    kinds = [any(part.kind in ("name", "call") and part.value != "pi" for _, part in walk(f)) for f in node.args]
    numbers, others = (
        [f for f, named in zip(node.args, kinds, strict=True) if named == kind] for kind in (False, True)
    )
    for rooted, rest in ((numbers, others), (others, numbers)):
        if rooted and rest and not all(map(_is_square, rooted)):
            yield "exponent", product([*rest, Node("call", "sqrt", (product(rooted),))]), COST["root_left_out"]


def _is_square(node: Node) -> bool:
    """Return whether a factor is the square of a rational number, such as 4/9, or 1 divided by such a square."""
    value = (node.args[0] if node.kind == "inv" else node).value
    return isinstance(value, Fraction) and all(isqrt(n) ** 2 == n for n in (value.numerator, value.denominator))


def _with_exchanged_names(node: Node, is_matrix: Callable[[Node], bool]) -> Iterator[PartEdit]:
    """Yield the edits of a product that exchange two vectors or easily confused letters, such as phi and theta."""
    names = list(dict.fromkeys(part for _, part in walk(node) if part.kind == "name" and part.value != "pi"))
    if len(names) > MOST_NAMES_EXCHANGED or all(part.kind == "name" for part in node.args):
        return
    for first, second in itertools.combinations(names, 2):
        if (is_matrix(first) and is_matrix(second)) or second.value in neighbours(first.value, [second.value]):
            hole = Node("name", "?")
            made = substituted(substituted(substituted(node, first, hole), second, first), hole, second)
            yield "wrong_symbol", made, COST["names_exchanged"]


def _of_quotients(factors: list[Node]) -> Iterator[PartEdit]:
    """Yield edits of a product of ``factors`` that invert a quotient of two letters: ``b/a*c`` for ``a/b*c``."""
    for below, divisor in enumerate(factors):
        if divisor.kind != "inv" or divisor.args[0].kind != "name":
            continue
        for above, factor in enumerate(factors):
            if factor.kind == "name":
                made = list(factors)
                made[above], made[below] = divisor.args[0], Node("inv", None, (factor,))
                yield "wrong_symbol", product(made), COST["quotient_inverted"]


def _of_sequence(factors: list[Node]) -> Iterator[PartEdit]:
    """Yield edits of a product of elementary rotations: ``Rx(b)*Rz(a)`` and ``Ry(a)*Rx(b)`` for ``Rz(a)*Rx(b)``."""
    yield "wrong_sequence_type", product(factors[::-1]), COST["sequence_reversed"]
    angles = [factor.args for factor in factors]
    for place, factor in enumerate(factors):
        for axis in spelled_like(factor.value):
            if axis != factor.value:
                made = [*factors[:place], Node("call", axis, factor.args), *factors[place + 1 :]]
                yield "wrong_sequence_type", product(made), 0.0
    if len(factors) == 3:
        for axes in itertools.product(spelled_like(factors[0].value), repeat=3):
            if axes[0] != axes[1] != axes[2]:
                made = [Node("call", axis, args) for axis, args in zip(axes, angles, strict=True)]
                yield "wrong_sequence_type", product(made), COST["three_axes_changed"]

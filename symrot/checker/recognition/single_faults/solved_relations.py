"""Equations solved for one of their letters: ``I w1 + M t = I w2`` gives a formula for each of I, w1, M, t and w2.

With them, the search for faults, which compares two formulas for the same quantity, can compare equations too.
"""

from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.solving import Solve
from symrot.checker.claim.tree import Node, negated, number, product, sum_of, text, walk
from symrot.checker.recognition.known_formulas import Known, by_fingerprint
from symrot.checker.recognition.printed_text import read_printed
from symrot.checker.repair.edits.trees import square_of

__all__ = ["put_back", "solved_claims", "solved_relations"]

SQUARED = ", squared"


class SolvedRelation(NamedTuple):
    """A known relation solved for the symbol ``name``: ``known.text`` is the formula for this symbol.

    If ``known.name`` ends with ", squared", ", acos" or ", asin", ``known.text`` is the formula for the square, the
    cosine or the sine of this symbol.
    """

    name: str
    known: Known


class Solution(NamedTuple):
    """An equation solved for a letter, in the form ``coefficient * letter**exponent == rest``."""

    letter: Node
    coefficient: Node
    rest: Node
    exponent: int


@cache
def solved_relations() -> tuple[SolvedRelation, ...]:
    """Return the known relations (equations), each solved for its symbols where this is easy.

    An equation is solved for a symbol w if some of its terms are free of w and all others are proportional to w, or all
    others are proportional to w^2. It is solved for an angle theta if some of its terms are free of theta and all
    others are proportional to cos(theta), or all others to sin(theta).
    """
    solved = []
    for known in (known for group in by_fingerprint().values() for known in group if known.is_relation):
        tree = read_printed(known.text)
        for name in dict.fromkeys(str(node.value) for _, node in walk(tree) if node.kind == "name"):
            solution = _solution(_terms(tree), Node("name", name)) if name != "pi" else None
            if solution is not None:
                value = product([solution.rest, Node("inv", None, (solution.coefficient,))])
                title = known.name + SQUARED * (solution.exponent == 2)
                solved.append(SolvedRelation(name, Known(title, known.source, text(value))))
        for name, known_angle in _solved_for_angles(known, tree):
            solved.append(SolvedRelation(name, known_angle))
    return tuple(solved)


def _solved_for_angles(known: Known, tree: Node) -> Iterator[tuple[str, Known]]:
    """Yield (angle, formula for its cosine or sine) for each angle that occurs only in its cosine or only in its sine.

    For ``H*cos(theta) == C*omega`` the angle is theta and the formula C*omega/H.
    """
    for function, inverse in (("cos", "acos"), ("sin", "asin")):
        calls = [node for _, node in walk(tree) if node.kind == "call" and node.value == function]
        for call in dict.fromkeys(calls):
            angle = call.args[0]
            solution = _solution(_terms(tree), call) if angle.kind == "name" else None
            if solution is None or solution.exponent != 1:
                continue
            if any(node == angle for part in (solution.coefficient, solution.rest) for _, node in walk(part)):
                continue
            value = product([solution.rest, Node("inv", None, (solution.coefficient,))])
            yield str(angle.value), Known(f"{known.name}, {inverse}", known.source, text(value))


def solved_claims(left: Node, right: Node, atoms: Sequence[Node]) -> Iterator[NamedFormula]:
    """Yield ``left == right`` solved for each of ``atoms`` (letters and rates): ``I*w2 == I*w1 + M*t`` for w2."""
    terms = [*_terms(left), *map(negated, _terms(right))]
    # possible if the letter occurs in one power only, 1 or 2; its factor stays on the left
    for atom in atoms:
        solution = _solution(terms, atom)
        if solution is None:
            continue
        coefficient, rest = solution.coefficient, solution.rest
        if coefficient.kind == "neg":
            coefficient, rest = negated(coefficient), sum_of([negated(term) for term in _terms(rest)])
        name = atom.args[0] if atom.value == "diff" else atom
        power = atom if solution.exponent == 1 else square_of(atom)
        side = product([coefficient, power]) if coefficient != number(1) else power
        yield NamedFormula(str(name.value), side, rest, name is not atom, _solve(coefficient, solution.exponent))


def put_back(left: Node, right: Node, named: NamedFormula, tree: Node) -> tuple[Node, Node] | None:
    """Return the two sides of the equation ``left == right`` after the repair of one of their terms.

    ``named`` is the same equation solved for a letter, and ``tree`` is its formula after the repair. If exactly one
    term of ``tree`` differs from the term of ``named.formula`` at the same place, the new term replaces the old one in
    ``left`` and ``right``. Return None if several terms differ, if none differs, or if the formulas have different
    numbers of terms.
    """
    before, after = _terms(named.formula), _terms(tree)
    changed = [(old, new) for old, new in zip(before, after, strict=False) if old != new]
    if len(before) != len(after) or len(changed) != 1:
        return None
    ((old, new),) = changed
    exchanged = {old: new, negated(old): negated(new)}
    sides = [[exchanged.get(term, term) for term in _terms(side)] for side in (left, right)]
    return sum_of(sides[0]), sum_of(sides[1])


def _solve(coefficient: Node, exponent: int) -> Solve:
    """Return a function that turns a formula for ``coefficient * letter**exponent`` into a formula for the letter."""

    def solved(formula: Node) -> Node:
        quotient = product([formula, Node("inv", None, (coefficient,))]) if coefficient != number(1) else formula
        return quotient if exponent == 1 else Node("call", "sqrt", (quotient,))

    return solved


def _terms(tree: Node) -> list[Node]:
    return list(tree.args) if tree.kind == "sum" else [tree] if tree != number(0) else []


def _solution(terms: Sequence[Node], letter: Node) -> Solution | None:
    """Return the solution of ``sum of terms == 0`` for a letter w.

    Return None if w is in no term or in every term, if a term with w is neither proportional to w nor to w^2, or if one
    term is proportional to w and another one to w^2.
    """
    with_letter = [term for term in terms if letter in (node for _, node in walk(term))]
    rest = [negated(term) for term in terms if term not in with_letter]
    coefficients = [_without(term, letter) for term in with_letter]
    exponents = {exponent for _, exponent in filter(None, coefficients)}
    # the letter must be a factor of each term that contains it, always in the same power, 1 or 2
    if not rest or None in coefficients or len(exponents) != 1:
        return None
    return Solution(letter, sum_of([made for made, _ in filter(None, coefficients)]), sum_of(rest), exponents.pop())


def _without(term: Node, letter: Node) -> tuple[Node, int] | None:
    """Return (``term`` without the factor w or w^2, exponent 1 or 2) for the letter w, or None for other terms."""
    if term.kind == "neg":
        inner = _without(term.args[0], letter)
        return None if inner is None else (negated(inner[0]), inner[1])
    factors = list(term.args) if term.kind == "product" else [term]
    square = square_of(letter)
    own = [factor for factor in factors if factor in (letter, square)]
    others = [factor for factor in factors if factor not in own]
    if len(own) != 1 or any(letter == node for factor in others for _, node in walk(factor)):
        return None
    return product(others), 1 if own[0] == letter else 2

"""Repairs that add what a claim lacks: a term read off the exact difference, a matrix factor, another definition."""

from collections.abc import Iterator, Sequence
from typing import Any

from symrot.checker.decision import shown
from symrot.checker.edits import Edit
from symrot.checker.entries import always
from symrot.checker.reader import read_expression
from symrot.checker.sieve import SIDES, Change, Found, Sieve, at, cells_of, pieces, speaks
from symrot.checker.tree import Node, Path, number, product, replaced, sum_of, walk
from symrot.errors import InputError
from symrot.exact.decide import flatten, normal_form
from symrot.exact.ratio import TooLarge

__all__ = ["lacking_matrix", "lacking_term", "renamed"]

MOST_BRACKETS = 8
MOST_LETTERS = 120
"""Length of a missing term that is still offered."""


def lacking_term(sieve: Sieve) -> Iterator[Found]:
    """Yield the claim with the one term that it lacks, read off the exact difference of its sides."""
    problem = sieve.claim.problem()
    (lefts, shape), (rights, other) = flatten(problem.left), flatten(problem.right)
    if shape != other:
        return
    try:
        residuals = [normal_form(a - b, problem.hypotheses) for a, b in zip(lefts, rights, strict=True)]
    except (TooLarge, InputError):
        return
    lacking = {n: term for n, term in enumerate(residuals) if term != 0}
    if any(not _is_term(term) for term in lacking.values()):
        return
    for place, sign in (("right", 1), ("left", -1)):
        tree = sieve.tree_at(place)
        cells = {0: ()} if shape is None else cells_of(tree)
        if not speaks(tree) or tree.kind == "name" or not lacking.keys() <= cells.keys():
            continue
        made = tree
        for number_of, term in lacking.items():
            piece = at(made, cells[number_of])
            assert piece is not None
            added = read_expression(shown(sign * term))
            whole = added if piece == number(0) else sum_of([piece, added])
            made = replaced(made, cells[number_of], always(whole))
        cost = 1.7 * len(lacking)
        yield cost, "missing_term", (Change(place, Edit("missing_term", cost, (), made)),)
    if shape is None:
        yield from _inside(sieve, residuals[0], problem.hypotheses)


def _inside(sieve: Sieve, residual: Any, hypotheses: Sequence[Any]) -> Iterator[Found]:
    """Yield a side with the one term that a bracket in it lacks: ``a (b + m)`` for ``a b``."""
    meaning = sieve.claim.meaning()
    for place, sign in (("right", 1), ("left", -1)):
        tree = sieve.tree_at(place)
        for path, piece in [found for found in _linear_pieces(tree) if found[0]][:MOST_BRACKETS]:
            ends = [meaning.read(replaced(tree, path, always(number(value)))) for value in (0, 1)]
            try:
                term = normal_form(sign * residual / (ends[1] - ends[0]), hypotheses)
            except (TooLarge, InputError):
                continue
            if not _is_term(term):
                continue
            made = replaced(tree, path, always(sum_of([piece, read_expression(shown(term))])))
            yield 1.8, "missing_term", (Change(place, Edit("missing_term", 1.8, path, made)),)


def lacking_matrix(sieve: Sieve) -> Iterator[Found]:
    """Yield a tree with one matrix multiplied by another one that occurs, from the left or the right."""
    named = [Node("name", name) for name in sorted(sieve.matrix_names)]
    factors = [*named, *(Node("transpose", None, (factor,)) for factor in named)]
    for place in SIDES:
        tree = sieve.tree_at(place)
        for path, piece in pieces(tree):
            for factor in factors if sieve.is_matrix(piece) and speaks(tree) else ():
                for both in ([factor, piece], [piece, factor]):
                    made = replaced(tree, path, always(product(both)))
                    change = Change(place, Edit("factor", 1.4 + 0.05 * len(path), path, made))
                    if sieve.holds([change]):
                        yield change.cost, "factor", (change,)


def renamed(sieve: Sieve) -> Iterator[Found]:
    """Yield the claim with one name of a definition in the place of another."""
    used = [name for name in sieve.definitions if name not in sieve.symbols]
    for place in SIDES:
        tree = sieve.tree_at(place)
        for path, node in walk(tree):
            for name in used if node.kind == "name" and node.value in used else ():
                change = Change(
                    place, Edit("wrong_symbol", 1.3, path, replaced(tree, path, always(Node("name", name))))
                )
                if name != node.value and sieve.holds([change]):
                    yield 1.3, "wrong_symbol", (change,)


def _is_term(term: Any) -> bool:
    """Return whether an expression is one product, short and without a divisor, as a term that was left out is."""
    above, below = term.as_numer_denom()
    return bool(below.is_number and not above.is_Add and term.free_symbols and len(shown(term)) <= MOST_LETTERS)


def _linear_pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield the pieces in which a tree is linear and that may be brackets: factors, not divisors."""
    yield path, tree
    for place, child in enumerate(tree.args if tree.kind in ("sum", "product", "neg") else ()):
        if child.kind not in ("inv", "number") and (tree.kind != "product" or child.kind in ("sum", "name", "call")):
            yield from _linear_pieces(child, (*path, place))

"""Repairs that add what a claim lacks: a term read off the exact difference, a matrix factor, another definition."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sympy import Add, Expr, Integer, factor

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, Path, number, product, replaced, sum_of, text, walk
from symrot.checker.repair.edits import Edit
from symrot.checker.repair.entries import always
from symrot.checker.repair.filter import SIDES, Change, Found, NumericFilter, at, is_nontrivial, matrix_entries, pieces
from symrot.errors import InputError
from symrot.exact.decision import flatten
from symrot.exact.inverse_sums import vanishes
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero

__all__ = ["lacking_matrix", "lacking_term", "renamed"]

MOST_BRACKETS = 12
MOST_BRACKETS_OF_LARGE = 2
LARGE = 300
"""Pieces of an entry from which on fewer brackets are looked into."""

MOST_TERMS = 60
MOST_LETTERS = 240
"""Length of a missing term that is still offered."""

MOST_TERMS_READ, MOST_ROOTS_READ = 1000, 12
"""Of a difference of the sides that is still brought to its shortest form to see whether it is one term."""


def lacking_term(sieve: NumericFilter) -> Iterator[Found]:
    """Yield the claim with the one term that it lacks, read off the exact difference of its sides."""
    equation = sieve.claim.equation
    (lefts, shape), (rights, other) = flatten(equation.left), flatten(equation.right)
    if shape != other:
        return
    try:
        residuals = [_short_form(a - b, equation.hypotheses) for a, b in zip(lefts, rights, strict=True)]
    except (TooLarge, InputError):
        return
    lacking = {n: residual for n, residual in enumerate(residuals) if residual != 0}
    for place, sign in (("right", 1), ("left", -1)):
        tree = sieve.tree_at(place)
        cells = {0: ()} if shape is None else matrix_entries(tree)
        if not is_nontrivial(tree) or tree.kind == "name" or not lacking.keys() <= cells.keys():
            continue
        yield from _whole(sieve, place, {cells[n]: sign * residual for n, residual in lacking.items()})
    for place, sign in (("right", 1), ("left", -1)):
        cells = {0: ()} if shape is None else matrix_entries(sieve.tree_at(place))
        if len(lacking) == 1 and lacking.keys() <= cells.keys():
            ((number_of, residual),) = lacking.items()
            yield from _inside(sieve, place, cells[number_of], sign * residual, equation.hypotheses)


def _short_form(formula: Expr, hypotheses: Sequence[Any]) -> Expr:
    """Return a normal form; ``TooLarge`` where it is far too long to be one term."""
    ring = FormulaRing([formula], [as_zero(hypothesis) for hypothesis in hypotheses])
    residual = ring.reduce(ring.ratio(formula).numerator)
    if len(residual) > MOST_TERMS_READ or len(ring.roots) > MOST_ROOTS_READ:
        raise TooLarge("the difference of the sides is too long to be one term")
    return Integer(0) if vanishes(ring, residual) else ring.expression(ring.ratio(formula))


def _whole(sieve: NumericFilter, place: str, lacking: Mapping[Path, Any]) -> Iterator[Found]:
    """Yield a side with what each of its entries lacks, where that is one term."""
    made = sieve.tree_at(place)
    for path, residual in lacking.items():
        piece = at(made, path)
        term = _term(residual, piece)
        if term is None or piece is None:
            return
        whole = term if piece == number(0) else sum_of([piece, term])
        made = replaced(made, path, always(whole))
    cost = 1.75 * len(lacking)
    yield cost, "missing_term", (Change(place, Edit("missing_term", cost, (), made)),)


def _inside(sieve: NumericFilter, place: str, cell: Path, residual: Any, hypotheses: Sequence[Any]) -> Iterator[Found]:
    """Yield a side with the one term that a bracket in it lacks: ``a (b + m)`` for ``a b``."""
    interpreter = sieve.claim.interpreter()
    tree = sieve.tree_at(place)
    whole = at(tree, cell)
    assert whole is not None
    most = MOST_BRACKETS if sum(1 for _ in walk(whole)) < LARGE else MOST_BRACKETS_OF_LARGE
    brackets = sorted(_linear_pieces(whole), key=lambda found: found[1].kind != "sum")
    for path, piece in [found for found in brackets if found[0]][:most]:
        ends = [interpreter.read(replaced(whole, path, always(number(value)))) for value in (0, 1)]
        try:
            term = _term(_short_form(residual / (ends[1] - ends[0]), hypotheses), whole)
        except (TooLarge, InputError):
            continue
        if term is not None:
            made = replaced(tree, (*cell, *path), always(sum_of([piece, term])))
            yield 1.8, "missing_term", (Change(place, Edit("missing_term", 1.8, path, made)),)


def lacking_matrix(sieve: NumericFilter) -> Iterator[Found]:
    """Yield a tree with one matrix multiplied by another one that occurs, from the left or the right."""
    named = [Node("name", name) for name in sorted(sieve.matrix_names)]
    factors = [*named, *(Node("transpose", None, (by,)) for by in named)]
    for place in SIDES:
        tree = sieve.tree_at(place)
        for path, piece in pieces(tree):
            for by in factors if sieve.is_matrix(piece) and is_nontrivial(tree) else ():
                for both in ([by, piece], [piece, by]):
                    made = replaced(tree, path, always(product(both)))
                    change = Change(place, Edit("factor", 1.4 + 0.05 * len(path), path, made))
                    if sieve.holds([change]):
                        yield change.cost, "factor", (change,)


def renamed(sieve: NumericFilter) -> Iterator[Found]:
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


def _term(residual: Any, piece: Node | None) -> Node | None:
    """Return a residual as a term that a piece lacks: one product, short and without a divisor.

    One of brackets must be much shorter than the piece: to add the difference of the sides repairs anything.
    """
    above, below = residual.as_numer_denom()
    if not below.is_number or not residual.free_symbols:
        return None
    if above.is_Add:
        residual = factor(residual) if len(above.args) <= MOST_TERMS else above
    letters = len(as_text(residual))
    if residual.is_Add or letters > MOST_LETTERS:
        return None
    if residual.has(Add) and piece != number(0) and (piece is None or letters > len(text(piece)) // 2):
        return None
    return read_expression(as_text(residual))


def _linear_pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield the pieces in which a tree is linear and that may be brackets: factors, not divisors."""
    yield path, tree
    for place, child in enumerate(tree.args if tree.kind in ("sum", "product", "neg") else ()):
        if child.kind not in ("inv", "number") and (tree.kind != "product" or child.kind in ("sum", "name", "call")):
            yield from _linear_pieces(child, (*path, place))

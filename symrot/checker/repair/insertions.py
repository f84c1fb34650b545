"""Repairs that insert or exchange a part: a missing term, a missing matrix factor, another definition.

A missing term is computed exactly, as the difference of the two sides of the claim.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sympy import Add, Expr, Integer

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, Path, number, product, replaced, sum_of, text, walk
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.single import Edit
from symrot.checker.repair.filter import Candidate, Change, NumericFilter, at, is_nontrivial, matrix_entries, pieces
from symrot.errors import InputError
from symrot.exact.decision import flatten
from symrot.exact.factors import factored
from symrot.exact.inverse_sums import vanishes
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero

__all__ = ["exchanged_definitions", "missing_matrices", "missing_terms"]

MOST_BRACKETS = 12
"""Largest number of places inside a formula (a side or matrix entry) where the search adds a missing term in brackets.

In ``a*b`` the places are a and b: a missing term m gives ``(a + m)*b`` and ``a*(b + m)``.
"""

MOST_BRACKETS_OF_LARGE = 2
"""Largest number of places where the search adds a missing term in brackets to a large formula.

It replaces MOST_BRACKETS for a formula with at least ``LARGE`` nodes (symbols, numbers and operations).
"""

LARGE = 300

MOST_TERMS = 60
"""The largest number of terms in a sum that is factored to become one term."""

MOST_LETTERS = 240
"""The largest number of characters in a term that a repair may add to a side of a claim."""

MOST_TERMS_READ, MOST_ROOTS_READ = 1000, 12
"""Largest numbers of terms and of roots in left side minus right side for the search for a missing term.

The missing term is computed from this difference. If the difference is longer, no missing term is looked for.
"""


def missing_terms(numeric: NumericFilter) -> Iterator[Candidate]:
    """Yield repairs that add one missing term to each wrong entry of a side (to the whole side, if it is a scalar).

    The term is the exact difference of the two sides in the entry. If only one entry is wrong, repairs follow that add
    a term to a part of the entry: if ``a*b`` lacks a*m, to the factor b, which gives ``a*(b + m)``.
    """
    equation = numeric.claim.equation
    (lefts, shape), (rights, other) = flatten(equation.left), flatten(equation.right)
    if shape != other:
        return
    try:
        residuals = [_short_form(a - b, equation.hypotheses) for a, b in zip(lefts, rights, strict=True)]
    except (TooLarge, InputError):
        return
    lacking = {n: residual for n, residual in enumerate(residuals) if residual != 0}
    signs = {"right": 1, "left": -1}
    for place in numeric.sides_to_edit:
        sign, tree = signs[place], numeric.tree_at(place)
        cells = {0: ()} if shape is None else matrix_entries(tree)
        if not is_nontrivial(tree) or tree.kind == "name" or not lacking.keys() <= cells.keys():
            continue
        yield from _whole(numeric, place, {cells[n]: sign * residual for n, residual in lacking.items()})
    for place in numeric.sides_to_edit:
        sign = signs[place]
        cells = {0: ()} if shape is None else matrix_entries(numeric.tree_at(place))
        if len(lacking) == 1 and lacking.keys() <= cells.keys():
            ((number_of, residual),) = lacking.items()
            yield from _inside(numeric, place, cells[number_of], sign * residual, equation.hypotheses)


def _short_form(formula: Expr, hypotheses: Sequence[Any]) -> Expr:
    """Return the normal form of ``formula``, the difference of two sides; 0 if it vanishes under the hypotheses.

    Raise TooLarge if the normal form is long.
    """
    ring = FormulaRing([formula], [as_zero(hypothesis) for hypothesis in hypotheses])
    residual = ring.reduce(ring.ratio(formula).numerator)
    if len(residual) > MOST_TERMS_READ or len(ring.roots) > MOST_ROOTS_READ:
        raise TooLarge("the difference of the sides is too long to be added to one side as a term")
    return Integer(0) if vanishes(ring, residual) else ring.expression(ring.ratio(formula))


def _whole(numeric: NumericFilter, place: str, lacking: Mapping[Path, Any]) -> Iterator[Candidate]:
    """Yield the repair that adds the formulas ``lacking`` to the wrong entries of a side, unless they are too long."""
    # lacking: path of a wrong entry -> formula to be added there; adding a*b + c*d would repair anything
    made = numeric.tree_at(place)
    for path, residual in lacking.items():
        piece = at(made, path)
        term = _term(residual, piece)
        if term is None or piece is None:
            return
        whole = term if piece == number(0) else sum_of([piece, term])
        made = replaced(made, path, whole)
    cost = COST["missing_term_of_entry"] * len(lacking)
    yield Candidate(cost, "missing_term", (Change(place, Edit("missing_term", cost, (), made)),))


def _inside(
    numeric: NumericFilter, place: str, cell: Path, residual: Any, hypotheses: Sequence[Any]
) -> Iterator[Candidate]:
    """Yield repairs that add one term m to a part of a wrong entry: ``a*(b + m)`` in place of ``a*b``.

    ``cell`` is the path of the entry in the side ``place``, and ``residual`` is what the entry lacks, here a*m.
    """
    interpreter = numeric.claim.interpreter()
    tree = numeric.tree_at(place)
    whole = at(tree, cell)
    assert whole is not None
    most = MOST_BRACKETS if sum(1 for _ in walk(whole)) < LARGE else MOST_BRACKETS_OF_LARGE
    brackets = sorted(_linear_pieces(whole), key=lambda bracket: bracket[1].kind != "sum")
    for path, piece in [bracket for bracket in brackets if bracket[0]][:most]:
        # residual, a*m, divided by the factor of the bracket, a, gives the term
        ends = [interpreter.read(replaced(whole, path, number(value))) for value in (0, 1)]
        try:
            term = _term(_short_form(residual / (ends[1] - ends[0]), hypotheses), whole)
        except (TooLarge, InputError):
            continue
        if term is not None:
            made = replaced(tree, (*cell, *path), sum_of([piece, term]))
            cost = COST["missing_term_in_bracket"]
            yield Candidate(cost, "missing_term", (Change(place, Edit("missing_term", cost, path, made)),))


def missing_matrices(numeric: NumericFilter) -> Iterator[Candidate]:
    """Yield repairs that multiply a matrix in a side by a named matrix of the claim, or by its transpose.

    ``R*J`` becomes ``R*J*R^T``. A claim with a side 0 gets none.
    """
    named = [Node("name", name) for name in sorted(numeric.matrix_names)]
    factors = [*named, *(Node("transpose", None, (by,)) for by in named)]
    for place in numeric.sides_to_edit:
        tree = numeric.tree_at(place)
        if number(0) in (numeric.left, numeric.right):
            continue  # a multiple of a side that is not zero says less
        for path, piece in pieces(tree):
            for by in factors if numeric.is_matrix(piece) and is_nontrivial(tree) else ():
                for both in ([by, piece], [piece, by]):
                    made = replaced(tree, path, product(both))
                    cost = COST["missing_matrix"] + COST["per_level_of_matrix"] * len(path)
                    change = Change(place, Edit("factor", cost, path, made))
                    if numeric.holds([change]):
                        yield Candidate(change.cost, "factor", (change,))


def exchanged_definitions(numeric: NumericFilter) -> Iterator[Candidate]:
    """Yield repairs that replace the name of a definition in a side by the name of another definition of the claim."""
    used = [name for name in numeric.definitions if name not in numeric.symbols]
    for place in numeric.sides_to_edit:
        tree = numeric.tree_at(place)
        for path, node in walk(tree):
            for name in used if node.kind == "name" and node.value in used else ():
                made = replaced(tree, path, Node("name", name))
                change = Change(place, Edit("wrong_symbol", COST["other_definition"], path, made))
                if name != node.value and numeric.holds([change]):
                    yield Candidate(COST["other_definition"], "wrong_symbol", (change,))


def _term(residual: Any, piece: Node | None) -> Node | None:
    """Return ``residual``, the difference of the claim's sides, as the tree of one short term.

    Return None if it is not one term or too long, and if it has no letters, or letters in a denominator. ``piece`` is
    the formula to which the term is to be added. A term with a sum in brackets may be at most half as long as this
    formula, unless the formula is 0.
    """
    above, below = residual.as_numer_denom()
    if not below.is_number or not residual.free_symbols:
        return None
    # m*(a + b) must be much shorter than the formula to which it is added, or it would repair anything
    most = MOST_LETTERS if piece == number(0) else 0 if piece is None else len(text(piece)) // 2  # of a bracketed term
    if above.is_Add:
        if len(above.free_symbols) > most:
            return None  # a term with that many names is longer, and factoring takes seconds
        residual = factored(residual) if len(above.args) <= MOST_TERMS else above
    letters = len(as_text(residual))
    if residual.is_Add or letters > MOST_LETTERS:
        return None
    if residual.has(Add) and letters > most:
        return None
    return read_expression(as_text(residual))


def _linear_pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield (path, node) for the parts on which a tree depends linearly, such as a and b in ``2*(a + b)``."""
    yield path, tree
    for place, child in enumerate(tree.args if tree.kind in ("sum", "product", "neg") else ()):
        if child.kind not in ("inv", "number") and (tree.kind != "product" or child.kind in ("sum", "name", "call")):
            yield from _linear_pieces(child, (*path, place))

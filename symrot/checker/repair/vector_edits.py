"""Repairs of formulas with vectors and matrices: M^2 for a matrix M, M for M^2, or a missing term ``p0*q``."""

from collections.abc import Iterator

from symrot.checker.claim.tree import Node, Path, negated, product, replaced, sum_of, walk
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.single import Edit
from symrot.checker.repair.edits.trees import square_of
from symrot.checker.repair.filter import Candidate, Change, NumericFilter

__all__ = ["vector_edits"]

MOST_TERMS = 80
"""The largest number of terms, products of a scalar and a vector, that are tried in one sum."""


def vector_edits(numeric: NumericFilter) -> Iterator[Candidate]:
    """Yield repairs that replace a matrix M by M^2, or a power of M by M, or add a vector times a letter to a sum.

    Repairs of the right side come before those of the left side, whatever they cost. All are true at the test points.
    """
    if not numeric.matrix_names:
        return
    for place in numeric.sides_to_edit:
        tree = numeric.tree_at(place)
        for path, made, code in (*_squares(tree, numeric), *_terms(tree, numeric)):
            edit = Edit(code, COST[code], path, replaced(tree, path, made))
            change = Change(place, edit)
            if numeric.holds([change]):
                yield Candidate(change.cost, code, (change,))


def _squares(tree: Node, numeric: NumericFilter) -> Iterator[tuple[Path, Node, str]]:
    """Yield (path, new part, "exponent") with M^2 for each matrix M in a tree, and with M for each power of a matrix M.

    The path leads to the part that the new part replaces; "exponent" is the code of the corrected fault.
    """
    squares = [path for path, node in walk(tree) if node.kind == "power"]
    for path, node in walk(tree):
        if node.kind == "power" and numeric.is_matrix(node.args[0]):
            yield path, node.args[0], "exponent"
        elif node.kind in ("name", "call") and path[:-1] not in squares and numeric.is_matrix(node):
            yield path, square_of(node), "exponent"


def _terms(tree: Node, numeric: NumericFilter) -> Iterator[tuple[Path, Node, str]]:
    """Yield (path, new sum, "missing_term") for each sum of vectors in a tree and each term that may be missing in it.

    The term is a letter times a vector, with either sign; "missing_term" is the code of the corrected fault.
    """
    vectors = [Node("name", name) for name in sorted(numeric.matrix_names)]
    scalars = [Node("name", name) for name in numeric.names if name not in numeric.matrix_names]
    letters = {node.value for _, node in walk(tree) if node.kind == "name"}
    for path, node in walk(tree):
        if node.kind != "sum" or not numeric.is_matrix(node):
            continue
        terms = [product([scalar, vector]) for vector in vectors if vector.value in letters for scalar in scalars]
        for term in [term for term in terms if term not in node.args][:MOST_TERMS]:
            for own in (term, negated(term)):
                yield path, sum_of([*node.args, own]), "missing_term"

"""Usual faults in formulas of vectors, matrices and quaternions, and the edits that undo them.

A wrong order of factors or a missing transpose changes all entries at once. The search for one wrong part of a formula
does not see such faults; so this module edits the whole formula and computes its values at random test points.
"""

import re
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from itertools import chain, combinations, islice
from typing import Any, NamedTuple

from symrot.checker.claim.tree import Node, number, product, replaced, walk, with_names
from symrot.checker.recognition.single_faults.parts import Letters, Values, near, values_of
from symrot.checker.recognition.single_faults.variants import FUNCTIONS, LACKING
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.single import Edit, single_edits
from symrot.checker.repair.edits.sums_and_products import bracketed
from symrot.checker.repair.edits.trees import flattened, square_of
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.repair.rows import entries_of, is_matrix, shape_of

__all__ = ["ArrayFault", "agree", "array_faults", "has_arrays", "matching"]

MOST_TERMS = 6
"""The largest number of terms in a sum for which missing parentheses are tried, ``(a - b)*c`` for ``a - b*c``."""
MOST_EDITS = 700
"""The largest number of edits of one formula that are evaluated."""
CLOSE = 1e-8
"""The largest relative difference between numbers that count as equal.

The numbers are entries of two matrices, or the sum of all entries of each matrix; `matching` compares these sums first.
"""
OPERATIONS = ("skew", "cross", "dot", "qmul", "conjugate", "trace")
"""Names of the functions that take vectors, matrices or quaternions."""
LEFT_OUT = ("extra_term", "overall_sign")
"""Codes of the faults that are not looked for: a superfluous term, and the wrong sign of a whole formula.

A claim with one more term, or with the opposite vector, is probably a correct formula for something else.
"""


class ArrayFault(NamedTuple):
    """A possible fault of a formula: the edit that undoes it, and the edited formula's values at the test points."""

    # the sum of the entries of values[0], by which faults are sorted and looked up
    total: float
    edit: Edit
    values: Values


def has_arrays(formula: Node, numeric: NumericFilter) -> bool:
    """Return whether a formula contains a vector, matrix or quaternion, or an operation such as ``cross``."""
    return any(
        (node.kind == "name" and numeric.is_matrix(node)) or (node.kind == "call" and node.value in OPERATIONS)
        for _, node in walk(formula)
    )


def array_faults(formula: Node, numeric: NumericFilter, letters: Letters) -> list[ArrayFault]:
    """Return at most MOST_EDITS edits that may undo a fault of a formula, each with the edited formula's values.

    These are the values of the edited formula at the test points ``letters.points``. The edits are sorted by the sum of
    the entries that the edited formula has at the first test point. The function `matching` looks up edits by this sum,
    to find those that give a formula the values that it should have. Edits of a scalar formula only add parentheses or
    exchange two moments of inertia.
    """
    # other faults of scalar formulas are sought part by part, in the module `parts`
    if has_arrays(formula, numeric):
        edits = _edits(formula, numeric, letters)
    else:
        edits = chain(_brackets(formula), _exchanges(formula, letters))
    faults = []
    for edit in islice(edits, MOST_EDITS):
        values = values_of(edit.tree, letters.points)
        if values is not None:
            faults.append(ArrayFault(_total(values), edit, values))
    return sorted(faults, key=lambda fault: fault.total)  # for a look-up by value


def matching(faults: Sequence[ArrayFault], needed: Values) -> Iterator[Edit]:
    """Yield the edits in ``faults`` that give the formula the values ``needed`` at the test points."""
    total = _total(needed)
    slack = CLOSE * (abs(total) + max(map(abs, entries_of(needed[0]))))
    for fault in islice(faults, bisect_left(faults, total - slack, key=lambda fault: fault.total), None):
        if fault.total > total + slack:
            return
        if all(map(agree, fault.values, needed)):
            yield fault.edit


def _total(values: Values) -> float:
    return float(sum(entries_of(values[0])))


def agree(left: Any, right: Any) -> bool:
    """Return whether two scalars or matrices have one shape and agree to about eight digits of the largest entry."""
    if shape_of(left) != shape_of(right):
        return False
    size = max(map(abs, entries_of(right)))
    pairs = zip(entries_of(left), entries_of(right), strict=True)
    return all(near(a, b) or abs(a - b) <= CLOSE * size for a, b in pairs)


def _edits(formula: Node, numeric: NumericFilter, letters: Letters) -> Iterator[Edit]:
    for edit in single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving):
        if edit.code not in LEFT_OUT and edit.tree != formula:
            yield edit
    yield from _powers(formula, numeric)
    yield from _conjugates(formula)
    yield from _factors(formula, numeric, letters)
    yield from _products(formula, numeric)


def _brackets(formula: Node) -> Iterator[Edit]:
    """Yield edits that put parentheses into a sum: ``(a - b)*c`` for ``a - b*c``."""
    for path, node in walk(formula):
        if node.kind == "sum" and len(node.args) <= MOST_TERMS:
            for made in bracketed(node.args):
                cost = COST["lost_brackets"] + COST["per_level"] * len(path)
                yield Edit("lost_brackets", cost, path, flattened(replaced(formula, path, made)))


def _exchanges(formula: Node, letters: Letters) -> Iterator[Edit]:
    """Yield edits that exchange two moments of inertia of a scalar formula, such as I_1 and I_3."""
    # the letters of lengths, a and b, may mean either length
    moments = [name for name in letters.names if re.fullmatch(r"[IJ](_\w+|[1-3])", name)]
    for first, second in combinations(moments, 2):
        tree = with_names(formula, {first: second, second: first})
        yield Edit("wrong_symbol", COST["wrong_symbol"] + COST["names_exchanged"], (), tree)


def _powers(formula: Node, numeric: NumericFilter) -> Iterator[Edit]:
    """Yield edits of a formula that put ``R^2`` for a matrix ``R``, or ``R`` for ``R^2``."""
    kinds = {path: node.kind for path, node in walk(formula)}
    for path, node in walk(formula):
        if node.kind in ("name", "call") and numeric.is_matrix(node) and kinds.get(path[:-1]) != "power":
            squared = square_of(node)
            yield Edit("exponent", COST["exponent"], path, replaced(formula, path, squared))
        elif node.kind == "power" and numeric.is_matrix(node.args[0]):
            base = node.args[0]
            yield Edit("exponent", COST["exponent"], path, replaced(formula, path, base))


def _conjugates(formula: Node) -> Iterator[Edit]:
    """Yield edits that conjugate one factor of a product: ``qmul(conjugate(q), p)`` for ``qmul(q, p)``, or undo it."""
    for path, node in walk(formula):
        for place, factor in enumerate(node.args if node.kind == "call" and node.value == "qmul" else ()):
            is_conjugate = factor.kind == "call" and factor.value == "conjugate"
            made = factor.args[0] if is_conjugate else Node("call", "conjugate", (factor,))
            cost = COST["active_passive_transpose"] + COST["quaternion_conjugated"]
            tree = replaced(formula, (*path, place), made)
            yield Edit("active_passive_transpose", cost, (*path, place), tree)


def _factors(formula: Node, numeric: NumericFilter, letters: Letters) -> Iterator[Edit]:
    """Yield edits that multiply a vector or matrix term by one more scalar: ``sin(phi)*a`` for ``a``."""
    scalars = [*_scalars(formula, numeric, letters)]
    kinds = {path: node.kind for path, node in walk(formula)}
    for path, node in walk(formula):
        is_term = kinds.get(path[:-1], "sum") in ("sum", "neg") or path == ()
        if not is_term or node.kind == "neg" or not numeric.is_matrix(node):
            continue
        for factor in scalars:
            made = product([factor, node])
            tree = flattened(replaced(formula, path, made))
            yield Edit("factor", COST["solved_factor"] + COST["per_piece_added"], path, tree)


def _products(formula: Node, numeric: NumericFilter) -> Iterator[Edit]:
    """Yield edits that multiply a vector v by a matrix R or another vector a: ``R*v`` or ``cross(a, v)`` for v."""
    shapes = {node: _shape(node, numeric) for _, node in walk(formula) if numeric.is_matrix(node)}
    names = sorted({*numeric.matrix_names})
    named = {name: _shape(Node("name", name), numeric) for name in names}
    for path, node in walk(formula):
        if shapes.get(node) != VECTOR or node.kind in ("neg", "sum"):
            continue
        for name, shape in named.items():
            other = Node("name", name)
            if shape == SQUARE:
                made = product([other, node])
            elif shape == VECTOR and other != node:
                made = Node("call", "cross", (other, node))
            else:
                continue
            tree = flattened(replaced(formula, path, made))
            yield Edit("factor", COST["missing_matrix"] + COST["per_level"] * len(path), path, tree)


VECTOR, SQUARE = (3, 1), (3, 3)


def _shape(node: Node, numeric: NumericFilter) -> tuple[int, int] | None:
    values = values_of(node, numeric.points[:1])
    return shape_of(values[0]) if values else None


def _scalars(formula: Node, numeric: NumericFilter, letters: Letters) -> Iterator[Node]:
    """Yield factors that a claim's formula may have lost: if it contains the angle phi, sin(phi) and 1/sin(phi)."""
    made: dict[Node, None] = dict.fromkeys([LACKING] if LACKING in letters.atoms else [])
    for angle in letters.angles:
        for function in ("sin", "cos", "tan"):
            assert function in FUNCTIONS
            made[Node("call", function, (angle,))] = None
        cosine = Node("call", "cos", (angle,))
        made[Node("sum", None, (number(1), Node("neg", None, (cosine,))))] = None
        made[Node("sum", None, (number(1), cosine))] = None
    for _, node in walk(formula):
        is_letter = node.kind == "name" and node in letters.atoms
        if (is_letter or node.kind == "sum") and not numeric.is_matrix(node):
            values = values_of(node, letters.points)
            if values is not None and not any(map(is_matrix, values)):
                made[node] = None
    for node in tuple(made):
        yield node
        yield square_of(node)
        yield Node("inv", None, (node,))

"""Edits of one function call, matrix or quaternion: a cosine for a sine, half an angle, a transpose, another order."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import replace

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, Path, negated, number, product
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import INVERSE_OPPOSITE, OPPOSITE, neighbours, spelled_like
from symrot.checker.repair.edits.sums_and_products import PartEdit

__all__ = ["edits_of_call", "edits_of_quaternion", "edits_of_rows", "is_own_transpose"]


def edits_of_rows(node: Node) -> Iterator[PartEdit]:
    """Yield the edit that transposes a matrix if it is square and its rows are written out; otherwise yield nothing."""
    (written,) = node.args
    size = len(written.args)
    if size > 1 and all(row.kind == "list" and len(row.args) == size for row in written.args):
        columns = zip(*(row.args for row in written.args), strict=True)
        rows = tuple(replace(row, args=tuple(column)) for row, column in zip(written.args, columns, strict=True))
        transposed = replace(node, args=(replace(written, args=rows),))
        yield "active_passive_transpose", transposed, COST["rows_as_columns"]


def is_own_transpose(node: Node) -> bool:
    """Return whether a node is a call whose transpose is no useful edit, such as ``diag(..)``."""
    # a transposed rotation matrix has the angle with the other sign, which another edit gives
    return node.kind == "call" and node.value in ("vee", "qmul", "Matrix", "eye", "diag", "cross", *ROTATIONS)


def _scalars_in_front(node: Node, is_matrix: Callable[[Node], bool]) -> tuple[list[Node], Node]:
    """Return the scalar factors of a vector, and the vector without these factors: ([m], v) for ``m*v``."""
    scalars = [factor for factor in node.args if not is_matrix(factor)] if node.kind == "product" else []
    rest = [factor for factor in node.args if factor not in scalars]
    return (scalars, product(rest)) if scalars and rest else ([], node)


def edits_of_call(
    node: Node, path: Path, functions: Collection[str], is_matrix: Callable[[Node], bool]
) -> Iterator[PartEdit]:
    """Yield edits of a function call at ``path``: another function, half of or double the angle, arguments exchanged.

    ``functions`` are the names of functions of time, any of which may be confused with another one.
    """
    name, arguments = node.value, node.args
    if name in OPPOSITE:
        yield "sin_cos_swap", replace(node, value=OPPOSITE[name]), 0.0
        (argument,) = arguments
        yield "half_angle", replace(node, args=(product([argument, Node("inv", None, (number(2),))]),)), 0.0
        yield "double_half_angle", replace(node, args=(product([number(2), argument]),)), 0.0
    elif name in INVERSE_OPPOSITE:
        yield "sin_cos_swap", replace(node, value=INVERSE_OPPOSITE[name]), 0.0
    elif name == "atan2":
        yield "wrong_symbol", replace(node, args=arguments[::-1]), COST["names_exchanged"]
    elif name == "sqrt":
        yield "exponent", arguments[0], COST["root_left_out"]
    elif name in ROTATIONS:
        yield "active_passive_transpose", replace(node, args=(negated(arguments[0]),)), 0.0
        for axis in spelled_like(name):
            if axis != name:
                yield "wrong_sequence_type", replace(node, value=axis), 0.0
    elif name == "qmul":
        yield "quaternion_product_order", replace(node, args=arguments[::-1]), 0.0
    elif name == "cross":
        first, second = (_scalars_in_front(argument, is_matrix) for argument in arguments)
        made = product([*first[0], *second[0], replace(node, args=(second[1], first[1]))])
        yield "sign_of_term", made, COST["cross_product_order" if path else "whole_cross_product_order"]
    elif name in functions:
        for other in neighbours(name, functions):
            yield "wrong_symbol", replace(node, value=other), 0.0
    if len(arguments) == 4 and name == "dcm_of":
        yield from edits_of_quaternion(node)


def edits_of_quaternion(node: Node) -> Iterator[PartEdit]:
    """Yield edits of a quaternion with written-out components: another order of storage, or the conjugate."""
    first, *vector = node.args
    yield "quaternion_storage_order", replace(node, args=(*vector, first)), 0.0
    yield "quaternion_storage_order", replace(node, args=(node.args[3], *node.args[:3])), 0.0
    if all(member.kind == "list" for member in node.args):
        conjugate = [replace(member, args=tuple(map(negated, member.args))) for member in vector]
    else:
        conjugate = [negated(member) for member in vector]
    yield "active_passive_transpose", replace(node, args=(first, *conjugate)), COST["quaternion_conjugated"]

"""The canonical form of a tree, which is equal for formulas that differ only in the order of terms and factors."""

from collections.abc import Callable
from fractions import Fraction

from symrot.checker.claim.tree import Node, negated, number, product, sum_of, text

__all__ = ["canonical"]


def canonical(node: Node, is_matrix: Callable[[Node], bool]) -> Node:
    """Return a tree with sorted terms and scalar factors; numbers come first, with the signs in front of them.

    Parameters
    ----------
    node : Node
    is_matrix : function
        Whether a piece is a matrix; matrices in a product stay in their order.
    """
    args = [canonical(child, is_matrix) for child in node.args]
    if node.kind == "sum":
        return sum_of(sorted(sum_of(args).args or args, key=text))
    if node.kind == "neg":
        return negated(args[0])
    if node.kind == "inv" and args[0].kind == "number" and args[0].value:
        return Node("number", 1 / args[0].value)
    if node.kind == "product":
        return _product(args, is_matrix)
    if node.kind == "power" and args[1] == number(1):
        return args[0]
    return Node(node.kind, node.value, tuple(args))


def _product(args: list[Node], is_matrix: Callable[[Node], bool]) -> Node:
    whole = product(args)
    inner = whole.args[0] if whole.kind == "neg" else whole
    size = Fraction(1)
    scalars: list[Node] = []
    matrices: list[Node] = []
    for factor in inner.args if inner.kind == "product" else (inner,):
        if factor.kind == "number":
            size *= factor.value
        else:
            (matrices if is_matrix(factor) else scalars).append(factor)
    front = [Node("number", size)] if size != 1 or not (scalars or matrices) else []
    made = product([*front, *sorted(scalars, key=text), *matrices])
    return negated(made) if whole.kind == "neg" else made

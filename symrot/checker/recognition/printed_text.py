"""Trees of known formulas from their printed text, read by Python's own parser.

The reader of typed formulas gives the same trees, but takes ten times as long, and refuses names such as a_{k}.
"""

import ast
import re
from collections.abc import Mapping

from symrot.checker.claim.tree import Node, negated, number, product, sum_of

__all__ = ["read_printed"]

MARKED = re.compile(r"\\?\w+(?:_\{[^{}]*\}|')")
"""Pattern of names that are not valid in Python: with an index in braces, as a_{k-2}, or with a prime, as c'."""


def read_printed(text: str) -> Node:
    """Return the tree of a formula that symrot printed, such as ``m*(a**2 + b**2)/12``."""
    names: dict[str, str] = {}  # name in Python -> name in the formula
    source = MARKED.sub(lambda match: _stored(match[0], names), text)
    return _tree(ast.parse(source, mode="eval").body, names)


def _stored(name: str, names: dict[str, str]) -> str:
    """Return a valid Python name for ``name``, a name in a formula, and record the pair in ``names``."""
    own = f"marked_{len(names)}"
    names[own] = name
    return own


def _tree(node: ast.expr, names: Mapping[str, str]) -> Node:
    if isinstance(node, ast.BinOp):
        return _operation(node.op, _tree(node.left, names), _tree(node.right, names))
    if isinstance(node, ast.UnaryOp):
        return negated(_tree(node.operand, names))
    if isinstance(node, ast.Constant):
        return number(int(str(node.value)))
    if isinstance(node, ast.Name):
        return Node("name", names.get(node.id, node.id))
    if isinstance(node, ast.List):
        return Node("list", ("[", "]"), tuple(_tree(member, names) for member in node.elts))
    assert isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    return Node("call", node.func.id, tuple(_tree(argument, names) for argument in node.args))


def _operation(sign: ast.operator, left: Node, right: Node) -> Node:
    if isinstance(sign, ast.Pow):
        return Node("power", None, (left, right))
    if isinstance(sign, ast.Mult):
        return product([left, right])
    if isinstance(sign, ast.Div):
        return product([left, Node("inv", None, (right,))])
    assert isinstance(sign, ast.Add | ast.Sub)
    return sum_of([left, negated(right) if isinstance(sign, ast.Sub) else right])

"""The atoms of formulas: symbols, functions of time and their derivatives."""

from collections.abc import Iterable

from sympy import Expr
from sympy.core.function import AppliedUndef

__all__ = ["atoms_of"]


def atoms_of(formulas: Iterable[Expr]) -> set[Expr]:
    """Return symbols, functions of time and derivatives, but not the ``f(t)`` inside of ``diff(f(t), t)``."""
    atoms: set[Expr] = set()
    stack = list(formulas)
    while stack:
        node = stack.pop()
        if node.is_Symbol or isinstance(node, AppliedUndef) or node.is_Derivative:
            atoms.add(node)
        else:
            stack.extend(node.args)
    return atoms

"""The atoms of formulas: the symbols, functions of time and derivatives that occur in a formula."""

from collections.abc import Iterable

from sympy import Expr
from sympy.core.function import AppliedUndef

__all__ = ["atoms_of"]


def atoms_of(formulas: Iterable[Expr]) -> set[Expr]:
    """Return the symbols, functions of time ``f(t)``, and derivatives in formulas: x and ``diff(f(t), t)`` for
    ``x*diff(f(t), t)``.
    """
    atoms: set[Expr] = set()
    stack = list(formulas)
    while stack:
        node = stack.pop()
        if node.is_Symbol or isinstance(node, AppliedUndef) or node.is_Derivative:
            # the f(t) inside a derivative is no atom of its own
            atoms.add(node)
        else:
            stack.extend(node.args)
    return atoms

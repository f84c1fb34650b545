"""The atoms of formulas: the symbols, functions of time and derivatives that a formula consists of."""

from collections.abc import Iterable

from sympy import Expr
from sympy.core.function import AppliedUndef

__all__ = ["atoms_of"]


def atoms_of(formulas: Iterable[Expr]) -> set[Expr]:
    """Return the atoms of formulas: symbols, functions of time ``f(t)``, and derivatives.

    The ``f(t)`` inside of a derivative ``diff(f(t), t)`` is not an atom by itself.
    """
    atoms: set[Expr] = set()
    stack = list(formulas)
    while stack:
        node = stack.pop()
        if node.is_Symbol or isinstance(node, AppliedUndef) or node.is_Derivative:
            atoms.add(node)
        else:
            stack.extend(node.args)
    return atoms

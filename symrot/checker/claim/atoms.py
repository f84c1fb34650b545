"""The atoms of formulas: the symbols, functions of time and derivatives on which the value of a formula depends."""

from collections.abc import Iterable

from sympy import Expr
from sympy.core.function import AppliedUndef

__all__ = ["atoms_of"]


def atoms_of(formulas: Iterable[Expr]) -> set[Expr]:
    """Return the atoms of formulas: symbols, functions of time ``f(t)``, and derivatives.

    A derivative ``diff(f(t), t)`` is one atom; the ``f(t)`` inside it does not count as a second one.
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

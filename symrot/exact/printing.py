"""SymPy values as text in the language of claims, such as ``diff(phi(t), t) == omega``."""

from typing import Any

from sympy import Derivative, Expr
from sympy.core.relational import Relational
from sympy.printing.str import StrPrinter

__all__ = ["as_text"]


class _Printer(StrPrinter):  # type: ignore[misc]
    """A SymPy printer whose output is a valid claim text: a derivative is printed as ``diff(phi(t), t)``."""

    def _print_Derivative(self, node: Derivative) -> str:
        variables = ", ".join(self._print(v) for v, times in node.variable_count for _ in range(int(times)))
        return f"diff({self._print(node.expr)}, {variables})"

    def _print_Abs(self, node: Expr) -> str:
        return f"abs({self._print(node.args[0])})"

    def _print_Relational(self, node: Relational) -> str:
        return f"{self._print(node.lhs)} {node.rel_op} {self._print(node.rhs)}"


_PRINTER = _Printer()


def as_text(value: Any) -> str:
    """Return a SymPy value as text in the language of claims, which symrot's parser of claims reads back.

    A claim is a text such as ``sin(2*x) == 2*sin(x)*cos(x)``, which states that two formulas are equal. A derivative is
    written ``diff(phi(t), t)``.
    """
    return str(_PRINTER.doprint(value))

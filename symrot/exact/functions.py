"""Tables of the functions that may occur in exact decisions, and the test for functions of time and matrix entries."""

import sympy
from sympy import Derivative, Expr, S, preorder_traversal
from sympy.core.function import AppliedUndef
from sympy.matrices.expressions.matexpr import MatrixElement

from symrot.errors import InputError

__all__ = ["REWRITTEN", "TRIGONOMETRIC", "is_function_of_time"]

REWRITTEN = {
    sympy.sinh: lambda u: (sympy.exp(u) - sympy.exp(-u)) / 2,
    sympy.cosh: lambda u: (sympy.exp(u) + sympy.exp(-u)) / 2,
    sympy.tanh: lambda u: (sympy.exp(2 * u) - 1) / (sympy.exp(2 * u) + 1),
    sympy.coth: lambda u: (sympy.exp(2 * u) + 1) / (sympy.exp(2 * u) - 1),
    sympy.asinh: lambda u: sympy.log(u + sympy.sqrt(u**2 + 1)),
    sympy.acosh: lambda u: sympy.log(u + sympy.sqrt(u - 1) * sympy.sqrt(u + 1)),
    sympy.atanh: lambda u: (sympy.log(1 + u) - sympy.log(1 - u)) / 2,
}
"""Hyperbolic functions and their inverses, expressed by exponentials and logarithms."""

TRIGONOMETRIC = {
    sympy.sin: ("sin", None),
    sympy.cos: ("cos", None),
    sympy.tan: ("sin", "cos"),
    sympy.cot: ("cos", "sin"),
    sympy.sec: (None, "cos"),
    sympy.csc: (None, "sin"),
}
"""Function -> (numerator, denominator) in terms of the sine and cosine of its argument; None means 1."""


def is_function_of_time(node: Expr) -> bool:
    """Return whether an expression is a function of time, a derivative of one, or a matrix entry.

    Raises
    ------
    InputError
        If the node is not a finite exact scalar.
    """
    if node.is_Float:
        raise InputError(f"expected exact numbers, such as Rational(1, 2), in a claim; got the float {node}")
    if not isinstance(node, Expr) or not node.is_commutative or node is S.NaN or node.is_infinite:
        raise InputError(f"expected a claim made of finite numbers and scalar formulas, got {node}")
    if any(part.is_Float for part in preorder_traversal(node)):
        raise InputError(f"expected exact numbers, such as Rational(1, 2), in a claim; got a float in {node}")
    # such a node is a free real number, like a symbol
    if isinstance(node, Derivative):
        return isinstance(node.expr, AppliedUndef)
    return isinstance(node, (AppliedUndef, MatrixElement))

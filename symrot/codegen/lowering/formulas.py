"""Translation of SymPy expressions into formula trees, term by term, without any rewriting."""

from collections.abc import Sequence
from fractions import Fraction

from sympy import Abs, Expr, Function, S

from symrot.errors import InputError
from symrot.formula.tree import FUNCTIONS, Node
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = ["chain", "function_name", "to_node"]


def to_node(expr: Expr) -> Node:
    """Return the formula tree of a SymPy expression, translated term by term.

    Raises
    ------
    InputError
        If the expression contains a float, or a function or power that kernels do not support.
    """
    if expr.is_Rational:
        return ("number", Fraction(int(expr.p), int(expr.q)))
    if expr.is_Symbol or expr is S.Pi:
        return ("symbol", str(expr))
    if expr is S.Exp1:
        return ("call", "exp", (("number", Fraction(1)),))
    if expr.is_Pow:
        base, power = expr.as_base_exp()
        if (2 * power).is_Integer:
            if power < 0:
                return ("/", ("number", Fraction(1)), to_node(base**-power))
            node = to_node(base) if power.is_Integer else ("call", "sqrt", (to_node(base),))
            count = int(power) if power.is_Integer else int(2 * power)
            return node if count == 1 else ("**", node, count)
    if expr.is_Mul:
        top, bottom = expr.as_numer_denom()
        if bottom != 1:
            return ("/", to_node(top), to_node(bottom))
        coefficient, rest = expr.as_coeff_Mul()
        if coefficient == -1:
            return ("neg", to_node(rest))
        return chain("*", [to_node(factor) for factor in expr.as_ordered_factors()])
    if expr.is_Add:
        terms = sorted(expr.as_ordered_terms(), key=lambda term: term.could_extract_minus_sign())
        node = to_node(terms[0])
        for term in terms[1:]:
            negative = term.could_extract_minus_sign()
            node = ("-" if negative else "+", node, to_node(-term if negative else term))
        return node
    name = function_name(expr)
    return ("call", name, tuple(to_node(argument) for argument in expr.args))


def chain(mark: str, nodes: Sequence[Node]) -> Node:
    """Return the tree of one operator applied from left to right: ``(a + b) + c`` for the nodes a, b, c and ``"+"``."""
    result = nodes[0]
    for node in nodes[1:]:
        result = (mark, result, node)
    return result


def function_name(expr: Expr) -> str:
    """Return the name by which kernels call the function of an expression such as ``Abs(x)``, here ``"abs"``.

    Raises
    ------
    InputError
        If the expression is not a call of a function that kernels support.
    """
    name = "abs" if isinstance(expr, Abs) else "exp" if expr.func.__name__ == "exp" else str(expr.func)
    if not isinstance(expr, Function) or (FUNCTIONS | OWN_FUNCTIONS).get(name) != len(expr.args):
        raise InputError(f"expected a formula of + - * /, whole and half powers and {', '.join(FUNCTIONS)}; got {expr}")
    return name

"""Functions that are defined by other functions: coth, sech, csch, their inverses, asec, acsc, and arg.

acot is not among them, since books define it by two formulas.
"""

from collections.abc import Callable, Mapping

from symrot.checker.claim.tree import Node, negated, number, product, sum_of

__all__ = ["DEFINED", "INVERSES", "TWO_CONVENTIONS"]


def _call(name: str) -> Callable[[Node], Node]:
    return lambda x: Node("call", name, (x,), x.span)


_sinh, _cosh, _log, _root, _asin, _acos = map(_call, ("sinh", "cosh", "log", "sqrt", "asin", "acos"))
ONE = number(1)


def _over(above: Node, below: Node) -> Node:
    return product([above, Node("inv", None, (below,), below.span)], below.span)


def _square(x: Node) -> Node:
    return Node("power", None, (x, number(2)), x.span)


def _half_log(above: Node, below: Node) -> Node:
    return _over(_log(_over(above, below)), number(2))


DEFINED: Mapping[str, Callable[[Node], Node]] = {
    "coth": lambda x: _over(_cosh(x), _sinh(x)),
    "sech": lambda x: _over(ONE, _cosh(x)),
    "csch": lambda x: _over(ONE, _sinh(x)),
    "asinh": lambda x: _log(sum_of([x, _root(sum_of([_square(x), ONE]))], x.span)),
    "acosh": lambda x: _log(sum_of([x, _root(sum_of([_square(x), negated(ONE)]))], x.span)),
    "atanh": lambda x: _half_log(sum_of([ONE, x]), sum_of([ONE, negated(x)])),
    "acoth": lambda x: _half_log(sum_of([x, ONE]), sum_of([x, negated(ONE)])),
    "asech": lambda x: _log(_over(sum_of([ONE, _root(sum_of([ONE, negated(_square(x))]))]), x)),
    "arg": lambda x: Node("call", "atan2", (Node("call", "imaginary_part", (x,)), Node("call", "real_part", (x,)))),
    "acsch": lambda x: _log(sum_of([_over(ONE, x), _root(sum_of([_over(ONE, _square(x)), ONE]))])),
    "asec": lambda x: _acos(_over(ONE, x)),
    "acsc": lambda x: _asin(_over(ONE, x)),
}
"""Function of one scalar -> the formula that it is, with the principal values of the inverses."""

INVERSES = {name: f"a{name}" for name in ("sin", "cos", "tan", "sec", "csc")} | {
    name: f"a{name}" for name in ("sinh", "cosh", "tanh", "coth", "sech", "csch")
}
"""Function -> its inverse, which ``sin^-1 x`` usually means."""

TWO_CONVENTIONS = "one of the two conventions for the inverse of cot, atan(1/x) or pi/2 - atan(x)"
"""What a message asks for instead of acot(x) or cot^-1 x."""

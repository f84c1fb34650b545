"""Functions that are defined by other functions: coth, sech, csch, the inverses of hyperbolic functions, and arg."""

from collections.abc import Callable, Mapping

from symrot.checker.claim.tree import Node, negated, number, quotient, sum_of

__all__ = ["DEFINED", "DISPUTED", "DISPUTED_NAMES", "INVERSES", "instead"]


def _call(name: str) -> Callable[[Node], Node]:
    return lambda x: Node("call", name, (x,), x.span)


_sinh, _cosh, _log, _root = map(_call, ("sinh", "cosh", "log", "sqrt"))
ONE = number(1)


def _square(x: Node) -> Node:
    return Node("power", None, (x, number(2)), x.span)


def _half_log(above: Node, below: Node) -> Node:
    return quotient(_log(quotient(above, below)), number(2))


DEFINED: Mapping[str, Callable[[Node], Node]] = {
    "coth": lambda x: quotient(_cosh(x), _sinh(x)),
    "sech": lambda x: quotient(ONE, _cosh(x)),
    "csch": lambda x: quotient(ONE, _sinh(x)),
    "asinh": lambda x: _log(sum_of([x, _root(sum_of([_square(x), ONE]))], x.span)),
    "acosh": lambda x: _log(sum_of([x, _root(sum_of([_square(x), negated(ONE)]))], x.span)),
    "atanh": lambda x: _half_log(sum_of([ONE, x]), sum_of([ONE, negated(x)])),
    "acoth": lambda x: _half_log(sum_of([x, ONE]), sum_of([x, negated(ONE)])),
    "asech": lambda x: _log(quotient(sum_of([ONE, _root(sum_of([ONE, negated(_square(x))]))]), x)),
    "arg": lambda x: Node("call", "atan2", (Node("call", "imaginary_part", (x,)), Node("call", "real_part", (x,)))),
    "acsch": lambda x: _log(sum_of([quotient(ONE, x), _root(sum_of([quotient(ONE, _square(x)), ONE]))])),
}
"""Name of a function -> a function from its argument x to a formula: ``coth`` -> cosh(x)/sinh(x).

The formulas of the inverses give their principal values.
"""

INVERSES = {name: f"a{name}" for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "coth", "sech", "csch")}
"""Function -> its inverse, which ``sin^-1 x`` usually means."""

DISPUTED = {"cot": "atan(1/x) or pi/2 - atan(x)", "sec": "acos(1/x)", "csc": "asin(1/x)"}
"""Function -> what to write instead of its inverse, whose values for x < 0 differ from book to book."""

DISPUTED_NAMES = {f"{prefix}{name}": name for name in DISPUTED for prefix in ("a", "arc")}
"""``acot`` and ``arccot`` -> the function cot; likewise for sec and csc."""


def instead(name: str) -> str:
    """Return words for an error message on acot, asec or acsc, the inverse of the function ``name``."""
    return f"{DISPUTED[name]} instead of the inverse function of {name} (books differ on it for x < 0)"

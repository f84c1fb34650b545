"""The functions that formulas of scenes may call, for floats."""

import math
from collections.abc import Callable, Mapping

from symrot.formula.tree import FUNCTIONS, Node, evaluate

__all__ = ["FLOAT_FUNCTIONS", "float_value"]

FLOAT_FUNCTIONS: dict[str, Callable[..., float]] = {
    name: abs if name == "abs" else getattr(math, name) for name in FUNCTIONS
}


def float_value(node: Node, values: Mapping[str, float]) -> float:
    """Return the value of a formula as a double, given the values of its symbols."""
    return float(evaluate(node, values, FLOAT_FUNCTIONS, float))

"""The functions that formulas of scenes may call, for floats."""

import math
from collections.abc import Callable

from symrot.formula.tree import FUNCTIONS

__all__ = ["FLOAT_FUNCTIONS"]

FLOAT_FUNCTIONS: dict[str, Callable[..., float]] = {
    name: abs if name == "abs" else getattr(math, name) for name in FUNCTIONS
}

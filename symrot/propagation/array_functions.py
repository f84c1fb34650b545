"""NumPy versions of the functions that the formulas of a scene may call, such as sin and atan2."""

import numpy as np

__all__ = ["ARRAY_FUNCTIONS"]

ARRAY_FUNCTIONS: dict[str, np.ufunc] = {
    "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tan": np.tan, "exp": np.exp, "log": np.log, "abs": np.abs,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2,
}  # fmt: skip

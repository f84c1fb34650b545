"""Formulas of torques over arrays of any floating-point type: Python's own grammar and NumPy's functions, no code of
symrot.

The truth of a case is computed in extended precision (:data:`EXTENDED`), and again in doubles where it matters how much
the rounding of the formula itself changes the torque.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

__all__ = ["EXTENDED", "STATES", "SWITCHES", "compiled", "names_of", "torque_function"]

EXTENDED = np.longdouble
STATES = ("omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3")
SWITCHES = ("step", "sign", "min", "max", "clip", "floor", "mod", "where")
"""The functions of formulas that jump or bend."""


def _all(fold: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    def function(first: Any, *others: Any) -> Any:
        for other in others:
            first = fold(first, other)
        return first

    return function


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tan": np.tan, "exp": np.exp, "log": np.log, "abs": np.abs,
    "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2,
    "step": lambda x: np.where(x >= 0, x * 0 + 1, x * 0), "sign": np.sign, "floor": np.floor, "mod": np.mod,
    "min": _all(np.minimum), "max": _all(np.maximum), "clip": lambda x, low, high: np.minimum(np.maximum(x, low), high),
    "where": np.where,
}  # fmt: skip


def names_of(text: str) -> set[str]:
    """Return the names that a formula mentions, functions included."""
    return set(re.findall(r"(?<![\w.])[A-Za-z_]\w*", text))


def compiled(text: str, parameters: Mapping[str, float], kind: Any = EXTENDED) -> Callable[[Mapping[str, Any]], Any]:
    """Return a formula as a function of its variables by name, in the floating-point type ``kind``.

    Numbers written in the formula are doubles, as symrot rounds them; so are the parameters.
    """
    code = compile(text, text, "eval")
    pi = kind("3.14159265358979323846264338327950288") if kind is EXTENDED else kind(np.pi)
    known = {**FUNCTIONS, "pi": pi, **{name: kind(value) for name, value in parameters.items()}}

    def function(variables: Mapping[str, Any]) -> Any:
        with np.errstate(all="ignore"):
            return eval(code, {"__builtins__": {}}, {**known, **variables})

    return function


def torque_function(
    texts: Sequence[str], parameters: Mapping[str, float], kind: Any = EXTENDED
) -> Callable[[Any, Any], Any]:
    """Return the torque, shape (..., 3), as a function of times (...) and states (..., 7): omega, then the quaternion."""
    parts = [compiled(text, parameters, kind) for text in texts]

    def torque(t: Any, y: Any) -> Any:
        t, y = np.asarray(t, dtype=kind), np.asarray(y, dtype=kind)
        variables = {"t": np.broadcast_to(t, y.shape[:-1]), **{name: y[..., i] for i, name in enumerate(STATES)}}
        out = np.empty((*y.shape[:-1], 3), dtype=kind)
        for i, part in enumerate(parts):
            out[..., i] = part(variables)
        return out

    return torque

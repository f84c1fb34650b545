"""Dual numbers: a value together with its derivatives, which may be floats, Fractions, symbols or other numbers.

A computation that is written once for any kind of number, evaluated with dual numbers, also gives the derivatives of
its results (forward accumulation). Source: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., section 3.1.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from symrot.codegen.powers import power
from symrot.errors import InputError

__all__ = ["Dual", "dual_functions"]


class Dual:
    """A number with its derivatives: the variable x at 3 is ``Dual(3, {"x": 1})``, its square ``Dual(9, {"x": 6})``."""

    def __init__(self, value: Any, slopes: Mapping[str, Any]) -> None:
        # slopes: name of a variable -> derivative with respect to it; an absent variable has the derivative 0
        self.value, self.slopes = value, slopes

    def _with(self, value: Any, factor: Any) -> "Dual":
        """Return the dual number ``value`` whose derivatives are those of this number times ``factor`` (chain rule)."""
        return Dual(value, {name: factor * slope for name, slope in self.slopes.items()})

    def __add__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value + other, self.slopes)
        slopes = dict(self.slopes)
        for name, slope in other.slopes.items():
            slopes[name] = slopes[name] + slope if name in slopes else slope
        return Dual(self.value + other.value, slopes)

    __radd__ = __add__

    def __neg__(self) -> "Dual":
        return Dual(-self.value, {name: -slope for name, slope in self.slopes.items()})

    def __sub__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value - other, self.slopes)
        slopes = dict(self.slopes)
        for name, slope in other.slopes.items():
            slopes[name] = slopes[name] - slope if name in slopes else -slope
        return Dual(self.value - other.value, slopes)

    def __rsub__(self, other: Any) -> "Dual":
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return self._with(self.value * other, other)
        return self._with(self.value * other.value, other.value) + other._with(0, self.value)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value / other, {name: slope / other for name, slope in self.slopes.items()})
        value = self.value / other.value
        above = self + other._with(0, -value)
        return Dual(value, {name: slope / other.value for name, slope in above.slopes.items()})

    def __rtruediv__(self, other: Any) -> "Dual":
        return Dual(other, {}) / self

    def __pow__(self, exponent: int) -> "Dual":
        raised = power(self, exponent)
        return raised if isinstance(raised, Dual) else Dual(raised, {})


def dual_functions(functions: Mapping[str, Callable[..., Any]], least_root: Any = 0) -> dict[str, Callable[..., Any]]:
    """Return functions of dual numbers, by name; ``functions`` are the same functions for plain numbers.

    ``least_root`` is added to the divisor of the derivative of a root: a tiny number makes the derivative of
    sqrt(x**2) zero, not undefined, at x = 0. Derivatives of floats that do not exist are NaN.

    Raises
    ------
    InputError
        When the function abs of the result is called: abs has no derivative at zero.
    """
    f = functions
    rules: dict[str, Callable[[Any, Any], Any]] = {  # derivative at x of the function with the value y
        "sqrt": lambda x, y: 1 / (2 * y + least_root),
        "sin": lambda x, y: f["cos"](x),
        "cos": lambda x, y: -f["sin"](x),
        "tan": lambda x, y: 1 + y * y,
        "exp": lambda x, y: y,
        "log": lambda x, y: 1 / x,
        "sinh": lambda x, y: f["cosh"](x),
        "cosh": lambda x, y: f["sinh"](x),
        "tanh": lambda x, y: 1 - y * y,
        "asin": lambda x, y: 1 / f["sqrt"](1 - x * x),
        "acos": lambda x, y: -1 / f["sqrt"](1 - x * x),
        "atan": lambda x, y: 1 / (1 + x * x),
    }

    def of(name: str) -> Callable[[Any], Any]:
        def function(argument: Any) -> Any:
            if not isinstance(argument, Dual):
                return f[name](argument)
            value = f[name](argument.value)
            if not argument.slopes:
                return Dual(value, {})
            try:
                return argument._with(value, rules[name](argument.value, value))
            # of floats: the function has no derivative there, for example sqrt at zero
            except ZeroDivisionError:
                return argument._with(value, math.nan)

        return function

    def atan2(y: Any, x: Any) -> Dual:
        top, right = (each if isinstance(each, Dual) else Dual(each, {}) for each in (y, x))
        size = right.value * right.value + top.value * top.value
        # a plain number of any kind cannot multiply a dual number from the left
        try:
            moved = top._with(0, right.value / size) + right._with(0, -top.value / size)
        except ZeroDivisionError:
            moved = top._with(0, math.nan) + right._with(0, math.nan)
        return Dual(f["atan2"](top.value, right.value), moved.slopes)

    def absolute(argument: Any) -> Any:
        raise InputError("expected formulas with derivatives, got abs, which has none at zero")

    return {**{name: of(name) for name in rules}, "atan2": atan2, "abs": absolute}

"""Values of functions, such as exp, at exact numbers: rational values are exact, other values are rounded once.

mpmath computes what :mod:`symrot.formula.exact_numbers` does not.
"""

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from typing import Any

from symrot.formula import exact_numbers as number
from symrot.formula.tree import FUNCTIONS, Node, evaluate

__all__ = ["EXACT_FUNCTIONS", "exact_value"]

GUARD_BITS = 64  # additional bits of mpmath's working precision
# largest argument of an exponential, and largest number of bits by which the size of an argument raises the precision
MOST_BITS = 1 << 20


def _transcendental(name: str, *arguments: Fraction) -> Fraction:
    """Return the value of the named function at exact arguments, computed by mpmath with a relative error below 2^-300.

    An exponential far below every double is returned as 2^-1048576.

    Raises
    ------
    ValueError
        If the function has no real value, such as the logarithm of a negative number.
    OverflowError
        If an exponential is far beyond the range of a double.
    """
    # imported only if a formula needs it
    from symrot.formula.precision import bits, mp

    sizes = [max(x.numerator.bit_length(), x.denominator.bit_length()) for x in arguments]
    if name in ("exp", "sinh", "cosh") and abs(arguments[0]) > MOST_BITS:
        if name == "exp" and arguments[0] < 0:
            return Fraction(1, 1 << MOST_BITS)
        raise OverflowError(f"{name} of {number.show(arguments[0])} exceeds the range of a double")
    with bits(number.BITS + GUARD_BITS + min(max(sizes), MOST_BITS)):  # 1 + a tiny number keeps its digits
        values = [mp.mpf(x.numerator) / x.denominator for x in arguments]
        result: Any = None
        if not (name == "atan2" and not any(arguments)) and not (name == "log" and not arguments[0]):
            result = getattr(mp, name)(*values)
    if not isinstance(result, mp.mpf) or not mp.isfinite(result):
        listed = ", ".join(map(number.show, arguments))
        raise ValueError(f"{name}({listed}) has no real value")
    sign, mantissa, exponent, _ = result._mpf_
    value = Fraction(mantissa) * Fraction(2) ** exponent
    return Fraction(-value if sign else value)


EXACT_FUNCTIONS: dict[str, Callable[..., Fraction]] = {
    **{name: partial(_transcendental, name) for name in FUNCTIONS},
    "sqrt": number.sqrt,
    "sin": number.sin,
    "cos": number.cos,
    "abs": abs,
}


def exact_value(node: Node, values: Mapping[str, Fraction]) -> Fraction | float:
    """Return the value of a formula, given a value for each name in it; NaN if the formula has no real value.

    Raises
    ------
    OverflowError
        If an exponential in it is far beyond the range of a double.
    """
    try:
        value: Fraction | float = evaluate(node, values, EXACT_FUNCTIONS)
    except (ValueError, ZeroDivisionError):
        return math.nan
    return value

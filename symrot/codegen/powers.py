"""Integer powers of numbers of any kind, by repeated squaring."""

from fractions import Fraction
from typing import Any

__all__ = ["power"]


def power(base: Any, exponent: int) -> Any:
    """Return ``base**exponent``, with few multiplications: x^5 is ``(x*x)*(x*x)*x``, and x^0 is Fraction(1)."""
    if exponent == 0:
        return Fraction(1)
    if exponent < 0:
        return 1 / power(base, -exponent)
    result = base
    for bit in format(exponent, "b")[1:]:
        result = result * result
        result = result * base if bit == "1" else result
    return result

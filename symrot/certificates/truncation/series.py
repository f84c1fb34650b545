"""Power series in the size h of a step, whose coefficients are intervals or polynomials.

For example, a state during the step is the series x0 + x1 h + x2 h^2 + ..; functions of it are series again.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import truediv
from typing import Any, Self

from mpmath import iv

from symrot.certificates.truncation.intervals import FUNCTIONS, quotient, root

__all__ = ["SERIES_FUNCTIONS", "Majorant", "PowerSeries", "of_number_or_series"]


@dataclass(frozen=True)
class PowerSeries:
    """A power series, cut after ``len(terms)`` coefficients; a coefficient that is the integer 0 is exactly zero."""

    terms: tuple[Any, ...]

    @classmethod
    def of(cls, value: Any, count: int) -> Self:
        """Return ``value`` if it is a series, otherwise the constant series ``value`` with ``count`` coefficients."""
        return value if isinstance(value, cls) else cls((value, *(0,) * (count - 1)))

    def _alike(self, value: Any) -> Self:
        return self.of(value, len(self.terms))

    @property
    def rates(self) -> list[Any]:
        """The coefficients of the derivative with respect to h; there is one fewer than in the series."""
        return [(k + 1) * self.terms[k + 1] for k in range(len(self.terms) - 1)]

    def __add__(self, other: Any) -> Self:
        return type(self)(tuple(a + b for a, b in zip(self.terms, self._alike(other).terms, strict=True)))

    __radd__ = __add__

    def __neg__(self) -> Self:
        return type(self)(tuple(-a for a in self.terms))

    def __sub__(self, other: Any) -> Self:
        return self + -self._alike(other)

    def __rsub__(self, other: Any) -> Self:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Self:
        a, b = self.terms, self._alike(other).terms
        return type(self)(tuple(_dot(a[: n + 1], b[n::-1]) for n in range(len(a))))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Self:
        a, b = self.terms, self._alike(other).terms
        terms: list[Any] = []
        for n in range(len(a)):
            terms.append(quotient(a[n] - _dot(terms, b[n:0:-1]), b[0]))
        return type(self)(tuple(terms))

    def __rtruediv__(self, other: Any) -> Self:
        return self._alike(other).__truediv__(self)

    def __pow__(self, exponent: int) -> Any:
        result: Any = 1
        for _ in range(abs(exponent)):
            result = self * result
        return result if exponent >= 0 else 1 / result

    def integrated(self, start: Any, slope: "PowerSeries") -> "PowerSeries":
        """Return the series of a function f of this series x(h): f(x(h)), computed from its derivative.

        ``start`` is f(x(0)), and ``slope`` is the series f'(x(h)). For the logarithm f, this is the series 1/x(h).
        """
        rates = self.rates
        return PowerSeries((start, *(_dot(slope.terms[: n + 1], rates[n::-1]) / (n + 1) for n in range(len(rates)))))


class Majorant(PowerSeries):
    """A power series whose coefficients bound the absolute values of another series' coefficients.

    Operations give bounds for sums and products of the other series. Bounds add up, so ``-a`` is ``a``, and ``a - b``
    is ``a + b``.
    """

    def __neg__(self) -> Self:
        return self

    def __truediv__(self, other: Any) -> Self:
        divisor = self._alike(other).terms[0]  # polynomial rates are divided by numbers only
        return type(self)(tuple(a / divisor for a in self.terms))


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Return the sum of the products ``a[i]*b[i]``, without those that have the integer 0 as a factor."""
    return sum((x * y for x, y in zip(a, b, strict=True) if not (_is_zero(x) or _is_zero(y))), start=0)


def _is_zero(value: Any) -> bool:
    return isinstance(value, int) and value == 0


def _sine_and_cosine(x: PowerSeries, sign: int, functions: tuple[str, str]) -> tuple[PowerSeries, PowerSeries]:
    """Return the power series (sin x, cos x) if ``sign`` is -1, or (sinh x, cosh x) if ``sign`` is 1.

    ``functions`` has the names of the two functions.
    """
    rates = x.rates
    s, c = ([FUNCTIONS[name](iv.mpf(x.terms[0]))] for name in functions)
    for n in range(len(rates)):
        # coefficient n + 1 of each follows from the coefficients up to n of the other
        s.append(_dot(c[: n + 1], rates[n::-1]) / (n + 1))
        c.append(sign * _dot(s[: n + 1], rates[n::-1]) / (n + 1))
    return PowerSeries(tuple(s)), PowerSeries(tuple(c))


def _exponential(x: PowerSeries) -> PowerSeries:
    terms, rates = [iv.exp(iv.mpf(x.terms[0]))], x.rates
    for n in range(len(rates)):
        terms.append(_dot(terms[: n + 1], rates[n::-1]) / (n + 1))
    return PowerSeries(tuple(terms))


def _root(x: PowerSeries) -> PowerSeries:
    terms = [root(iv.mpf(x.terms[0]))]
    for n in range(1, len(x.terms)):
        terms.append((x.terms[n] - _dot(terms[1:], terms[:0:-1])) / (2 * terms[0]))
    return PowerSeries(tuple(terms))


SERIES_FUNCTIONS: dict[str, Callable[[PowerSeries], PowerSeries]] = {
    "sqrt": _root,
    "sin": lambda x: _sine_and_cosine(x, -1, ("sin", "cos"))[0],
    "cos": lambda x: _sine_and_cosine(x, -1, ("sin", "cos"))[1],
    "tan": lambda x: truediv(*_sine_and_cosine(x, -1, ("sin", "cos"))),
    "exp": _exponential,
    "log": lambda x: x.integrated(FUNCTIONS["log"](iv.mpf(x.terms[0])), 1 / x),
    "sinh": lambda x: _sine_and_cosine(x, 1, ("sinh", "cosh"))[0],
    "cosh": lambda x: _sine_and_cosine(x, 1, ("sinh", "cosh"))[1],
    "tanh": lambda x: truediv(*_sine_and_cosine(x, 1, ("sinh", "cosh"))),
    "atan": lambda x: x.integrated(FUNCTIONS["atan"](iv.mpf(x.terms[0])), 1 / (1 + x * x)),
}
"""The functions of :data:`FUNCTIONS` for power series with intervals as coefficients."""


def of_number_or_series(name: str) -> Callable[[Any], Any]:
    """Return the function ``name``, such as ``"sin"``, of a power series, or of an interval or whole number."""

    def function(x: Any) -> Any:
        return SERIES_FUNCTIONS[name](x) if isinstance(x, PowerSeries) else FUNCTIONS[name](iv.mpf(x))

    return function

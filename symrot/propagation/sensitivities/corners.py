"""Points at which a root such as ``|omega|`` is zero: whether the rates of a motion have derivatives there.

A product x*r has the derivative ``r x'`` where x = 0, if x has a derivative and r is continuous: so ``|omega|*omega``
has one at omega = 0, and ``|omega|`` alone has none. A number that is zero and has no derivative is *bent* if its
difference quotients are bounded, as those of ``|omega|`` are, *steep* if they are not, and an *edge* if nearby states
have no value.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.codegen.powers import power
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Program
from symrot.formula.switches import STATES

__all__ = ["rests_at_corner"]

Floats = NDArray[np.float64]
BENT, STEEP, EDGE = math.nan, math.inf, -math.inf
PLACES = (0.137, 0.389, 0.613, 0.871)  # parts of the span
Slopes = Mapping[str, float]


def places_within(begin: float, times: Floats) -> Floats:
    """Return the times at which :func:`rests_at_corner` examines a motion from ``begin``, s, to all ``times``.

    There are four arbitrary times between ``begin`` and the smallest of ``times``, and four between ``begin`` and the
    largest. A smallest or largest time that equals ``begin`` is left out.
    """
    ends = {float(times.min()), float(times.max())} - {begin} if len(times) else set[float]()
    return np.array([begin + part * (end - begin) for end in sorted(ends) for part in PLACES])


def rests_at_corner(
    rates: Program, depends: Sequence[Sequence[str]], p: Sequence[float], times: Floats, samples: Floats
) -> bool:
    """Return whether a motion stays where its rates have no derivatives with respect to states or parameters.

    The rates are examined at n arbitrary times. A motion that only passes a point without derivatives is there at a
    single time, which the arbitrary times miss.

    Parameters
    ----------
    rates : Program
        The time derivatives of the states.
    depends : sequence of sequences of str
        For each variable, the names of the parameters that depend on it.
    p : sequence of float
        The parameters.
    times, samples : arrays, shapes (n,) and (n, 7 + 7 m)
        Times, s, with the states and their derivatives with respect to the m variables.
    """
    names = [name for argument in rates.signature.arguments if argument.name == "p" for name, *_ in argument.components]
    moving = set().union(*depends)

    def is_corner(t: float, row: Sequence[float]) -> bool:
        size = len(STATES)
        changes: list[bool] = (np.asarray(row[size:]).reshape(-1, size) != 0.0).any(axis=0).tolist()
        values: dict[str, Any] = {
            name: _Number(x, {name: 1.0} if change else {})
            for name, x, change in zip(STATES, row[:size], changes, strict=True)
        }
        values |= {
            name: _Number(x, {name: 1.0} if name in moving else {}, x > 0.0) for name, x in zip(names, p, strict=False)
        }
        values["t"] = _Number(t, {}, timed=True)
        results = rates.evaluate(values, _FUNCTIONS, float).values()
        slopes = [slope for each in results if isinstance(each, _Number) for slope in each.slopes.values()]
        return not all(map(math.isfinite, slopes))

    return any(is_corner(t, row) for t, row in zip(times.tolist(), samples.tolist(), strict=True))


class _Number:
    """A number with its derivatives with respect to states and parameters.

    BENT, STEEP or EDGE stands for a derivative that does not exist. BENT: its difference quotients are bounded, as for
    ``|omega|`` at 0; STEEP: the quotients are not bounded; EDGE: for some nearby states the number has no value.
    """

    def __init__(self, value: float, slopes: Slopes, positive: bool = False, timed: bool = False) -> None:
        # positive: nowhere negative, whatever the states; timed: contains the time, and may be zero by chance
        self.value, self.slopes, self.positive, self.timed = value, slopes, positive, timed

    def _zero(self, other: "_Number") -> bool:
        """Return whether a product rule's term, this number times a derivative of ``other``, is zero.

        The term may be zero even if the derivative does not exist: at omega = 0, ``omega_1*|omega|`` has the derivative
        0, though ``|omega|`` has none.
        """
        if EDGE in other.slopes.values():
            return False
        rough = [slope for slope in self.slopes.values() if not math.isfinite(slope)]
        both = all(math.isnan(slope) for slope in (*rough, *other.slopes.values()) if not math.isfinite(slope))
        return self.value == 0.0 and not self.timed and (not rough or (other.value == 0.0 and both))

    def __add__(self, other: Any) -> "_Number":
        b = _number(other)
        slopes = {name: _sum(self.slopes.get(name, 0.0), b.slopes.get(name, 0.0)) for name in {*self.slopes, *b.slopes}}
        return _Number(self.value + b.value, slopes, self.positive and b.positive, self.timed or b.timed)

    __radd__ = __add__

    def __neg__(self) -> "_Number":
        return _Number(
            -self.value, {name: _times(slope, -1.0) for name, slope in self.slopes.items()}, False, self.timed
        )

    def __sub__(self, other: Any) -> "_Number":
        return self + -_number(other)

    def __rsub__(self, other: Any) -> "_Number":
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> "_Number":
        b = _number(other)
        slopes = {}
        for name in {*self.slopes, *b.slopes}:
            left, right = self.slopes.get(name, 0.0), b.slopes.get(name, 0.0)
            first = 0.0 if b._zero(self) else _times(left, b.value)
            slopes[name] = _sum(first, 0.0 if self._zero(b) else _times(right, self.value))
        positive = self is b or (self.positive and b.positive)
        return _Number(self.value * b.value, slopes, positive, self.timed or b.timed)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "_Number":
        b = _number(other)
        inverse = 1.0 / b.value
        slopes = {name: _times(slope, -inverse * inverse) for name, slope in b.slopes.items()}
        return self * _Number(inverse, slopes, b.positive, b.timed)

    def __rtruediv__(self, other: Any) -> "_Number":
        inverse: _Number = _number(other) / self
        return inverse

    def __pow__(self, exponent: int) -> Any:
        result = power(self, exponent)
        if isinstance(result, _Number) and exponent % 2 == 0:
            result.positive = True
        return result


def _number(value: Any) -> _Number:
    return value if isinstance(value, _Number) else _Number(float(value), {}, value >= 0)


def _times(slope: float, factor: float) -> float:
    return slope * factor if math.isfinite(slope) else slope


def _sum(left: float, right: float) -> float:
    if math.isfinite(left) and math.isfinite(right):
        return left + right
    return next((worst for worst in (EDGE, STEEP) if worst in (left, right)), BENT)


def _root(x: Any) -> _Number:
    number = _number(x)
    value = math.sqrt(number.value)
    if value:
        slopes = {name: _times(slope, 0.5 / value) for name, slope in number.slopes.items()}
    else:
        kind = EDGE if not number.positive else STEEP if any(number.slopes.values()) else BENT
        slopes = dict.fromkeys(number.slopes, kind)
    return _Number(value, slopes, True, number.timed)


def _function(name: str) -> Any:
    def function(*arguments: Any) -> _Number:
        numbers = list(map(_number, arguments))
        value = FLOAT_FUNCTIONS[name](*(number.value for number in numbers))
        # the slopes matter only if they are not finite; sin, exp and other smooth functions keep them so
        slopes: dict[str, float] = {}
        for number in numbers:
            slopes |= {each: _sum(slopes.get(each, 0.0), slope) for each, slope in number.slopes.items()}
        return _Number(value, slopes, name in ("exp", "cosh"), any(number.timed for number in numbers))

    return function


_FUNCTIONS = {**{name: _function(name) for name in FLOAT_FUNCTIONS}, "sqrt": _root}

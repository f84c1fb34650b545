"""Laws by which a value varies in a sweep: distributions, whose values are drawn, and grids, whose values are listed.

A law is written as text, ``normal(0, 0.1)`` or ``linspace(1, 2, 50)``. A new law is a new row of :data:`DISTRIBUTIONS`
or :data:`GRIDS`.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import read, show

__all__ = ["DISTRIBUTIONS", "GRIDS", "Distribution", "Grid", "Law", "read_law"]

Floats = NDArray[np.float64]
MOST_GRID_VALUES = 10_000_000
MOST_DEVIATIONS = 9
"""Number of deviations from the mean that no value drawn from a normal distribution exceeds.

The smallest probability that is drawn is 2^-53: a normal distribution exceeds 8.2 deviations with this probability."""


class _Family(NamedTuple):
    """A family of distributions: a description of its parameters, a test of their values, and its quantile function.

    ``largest`` takes the values of the parameters and returns about the largest intermediate result of the quantile
    function. If this number is infinite, the values are refused.
    """

    parameters: tuple[str, ...]
    condition: str
    valid: Callable[..., bool]
    largest: Callable[..., float]
    quantile: Callable[..., Floats]


def _normal(u: Floats, mean: float, deviation: float) -> Floats:
    from scipy.special import ndtri

    values: Floats = mean + deviation * ndtri(u)
    return values


DISTRIBUTIONS: dict[str, _Family] = {
    "normal": _Family(
        ("mean", "deviation"),
        "deviation > 0",
        lambda mean, deviation: deviation > 0,
        lambda mean, deviation: abs(mean) + MOST_DEVIATIONS * deviation,
        _normal,
    ),
    "uniform": _Family(
        ("low", "high"),
        "low < high",
        lambda low, high: low < high,
        lambda low, high: high - low,
        lambda u, low, high: low + (high - low) * u,
    ),
    "loguniform": _Family(
        ("low", "high"),
        "0 < low < high",
        lambda low, high: 0 < low < high,
        lambda low, high: high,
        lambda u, low, high: np.exp(np.log(low) + (np.log(high) - np.log(low)) * u),
    ),
}
"""Name of a distribution -> its family."""

GRIDS = {
    "linspace": "linspace(first, last, count)",
    "geomspace": "geomspace(first, last, count)",
    "values": "values(a, b, ...)",
}
"""Name of a law that lists the values of a quantity in a sweep, such as ``linspace`` -> its form."""


@dataclass(frozen=True)
class Distribution:
    """A distribution: the name of its family and its parameters."""

    family: str
    numbers: tuple[float, ...]

    def quantile(self, u: Floats) -> Floats:
        """Return the quantiles of the distribution for the probabilities ``u``, 0 < u < 1."""
        return DISTRIBUTIONS[self.family].quantile(u, *self.numbers)


@dataclass(frozen=True)
class Grid:
    """A list of the values that one quantity takes in a sweep.

    Each value is combined with all values of the other grids.
    """

    values: tuple[float, ...]

    def __len__(self) -> int:
        return len(self.values)


Law = Distribution | Grid
_CALL = re.compile(r"\s*([A-Za-z_]\w*)\s*\((.*)\)\s*", re.DOTALL)


def read_law(law: object, where: str) -> Law:
    """Return the law that a text or a list of numbers describes.

    Parameters
    ----------
    law : str, or sequence of numbers
        ``normal(mean, deviation)``, ``uniform(low, high)``, ``loguniform(low, high)``, ``linspace(first, last,
        count)``, ``geomspace(first, last, count)``, ``values(a, b, ...)``, or the values of a grid as a sequence. A law
        is returned unchanged.
    where : str
        Name of the value that varies, for error messages.

    Raises
    ------
    InputError
        If the law is unknown, or if its numbers are not valid.
    """
    if isinstance(law, Distribution | Grid):
        return law
    if not isinstance(law, str):
        return Grid(_numbers(_items(law, where), where))
    match = _CALL.fullmatch(law)
    if match is None:
        _refuse(where, law)
    name, arguments = match.groups()
    if name not in (*DISTRIBUTIONS, *GRIDS):
        _refuse(where, law, name)
    numbers = _numbers(_split(arguments), where)
    return _distribution(name, numbers, law, where) if name in DISTRIBUTIONS else _grid(name, numbers, law, where)


def _refuse(where: str, law: object, unknown: str = "") -> NoReturn:
    """Raise InputError because ``law`` is no law; the message lists all laws.

    A law says how a value varies: a distribution such as ``normal(mean, deviation)``, or a grid such as
    ``linspace(first, last, count)``. ``where`` is the name of the value. ``unknown`` is the name of the law in ``law``,
    if it has one: the message then suggests a law with a similar name.
    """
    laws = [f"{name}({', '.join(family.parameters)})" for name, family in DISTRIBUTIONS.items()]
    message = f"{where}: expected one of {', '.join([*laws, *GRIDS.values()])}, got {show(law)}"
    raise InputError(with_hint(message, unknown, (*DISTRIBUTIONS, *GRIDS)))


def _items(law: object, where: str) -> Sequence[object]:
    if not isinstance(law, Sequence | np.ndarray):
        _refuse(where, law)
    return np.asarray(law).ravel().tolist() if isinstance(law, np.ndarray) else list(law)


def _split(arguments: str) -> list[str]:
    """Return the arguments of a call, split at commas outside brackets: ``a, f(b, c)`` -> ``a`` and ``f(b, c)``."""
    parts, depth = [""], 0
    for character in arguments:
        depth += (character == "(") - (character == ")")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


def _numbers(items: Sequence[object], where: str) -> tuple[float, ...]:
    if not 1 <= len(items) <= MOST_GRID_VALUES:
        raise InputError(f"{where}: expected 1 to {MOST_GRID_VALUES} values, got {len(items)}")
    return tuple(float(read(item, where, "a number")) for item in items)


def _distribution(name: str, numbers: tuple[float, ...], law: str, where: str) -> Distribution:
    family = DISTRIBUTIONS[name]
    if len(numbers) != len(family.parameters) or not family.valid(*numbers):
        expected = f"{name}({', '.join(family.parameters)}) with {family.condition}"
        raise InputError(f"{where}: expected {expected}, got {show(law)}")
    if not isfinite(family.largest(*numbers)):
        expected = f"{name}({', '.join(family.parameters)}) with a range within that of a double"
        raise InputError(f"{where}: expected {expected}, got {show(law)}")
    return Distribution(name, numbers)


def _grid(name: str, numbers: tuple[float, ...], law: str, where: str) -> Grid:
    if name == "values":
        return Grid(numbers)
    expected = f"{where}: expected {GRIDS[name]}, with a whole number from 1 to {MOST_GRID_VALUES} as count"
    if len(numbers) != 3 or numbers[2] != int(numbers[2]) or not 1 <= numbers[2] <= MOST_GRID_VALUES:
        raise InputError(f"{expected}, got {show(law)}")
    first, last, count = numbers[0], numbers[1], int(numbers[2])
    if name == "geomspace" and not (min(first, last) > 0 or max(first, last) < 0):
        raise InputError(f"{where}: expected {GRIDS[name]}, with first and last of the same sign, got {show(law)}")
    space = np.linspace if name == "linspace" else np.geomspace
    with np.errstate(over="ignore", invalid="ignore"):
        values = space(first, last, count)
    if not np.isfinite(values).all():
        raise InputError(f"{where}: expected {GRIDS[name]} with a range within that of a double, got {show(law)}")
    return Grid(tuple(values.tolist()))

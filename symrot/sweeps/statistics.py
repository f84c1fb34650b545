"""Statistics of the outputs of a sweep, over all trajectories: mean, envelope, percentiles, histogram.

They are computed from the store in blocks of a fixed number of trajectories. So they need little memory, and their
bits do not depend on the chunks of the sweep.
"""

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import read, show
from symrot.sweeps.layout import TIME, Store, Table, Variable

__all__ = ["STATISTICS", "Statistic", "order_statistics", "read_statistics", "statistics_of"]

Floats = NDArray[np.float64]
Keys = NDArray[np.uint64]
Blocks = Callable[[], Iterator[Floats]]

BLOCK = 16384  # trajectories that are read at once
BINS = 4096  # intervals in which values are counted
MOST_VALUES = 200_000  # values of one interval that are sorted in memory
MOST_BINS = 100_000
STATISTICS = ("mean", "envelope", "percentiles", "histogram")
PERCENTILE, BIN, EDGE = "percentile", "bin", "edge"
_CALL = re.compile(r"\s*(\w+)\s*(?:\((.*)\))?\s*", re.DOTALL)


@dataclass(frozen=True)
class Statistic:
    """One statistic: its name in :data:`STATISTICS`, with percentages (for percentiles) or bins (for a histogram)."""

    name: str
    numbers: tuple[float, ...] = ()


def read_statistics(texts: Sequence[str]) -> tuple[Statistic, ...]:
    """Return the statistics that texts such as ``percentiles(5, 50, 95)`` describe.

    Raises
    ------
    InputError
        If a statistic is unknown or occurs twice, a percentage is not from 0 to 100, or a number of bins is not a whole
        number.
    """
    statistics = tuple(_read(text) for text in texts)
    names = [statistic.name for statistic in statistics]
    twice = next((name for k, name in enumerate(names) if name in names[:k]), None)
    if twice is not None:
        # their results have one name
        hint = "; write all percentages in one, as percentiles(5, 50, 95)" if twice == "percentiles" else ""
        raise InputError(f"statistics: expected each statistic once, got {twice} a second time{hint}")
    return statistics


def _read(text: object) -> Statistic:
    known = "mean, envelope, percentiles(5, 50, 95), histogram(BINS)"
    match = _CALL.fullmatch(text) if isinstance(text, str) else None
    if match is None or match[1] not in STATISTICS:
        message = f"statistics: expected one of {known}, got {show(text)}"
        raise InputError(with_hint(message, match[1] if match else text, STATISTICS))
    name, inside = match[1], (match[2] or "").strip()
    numbers = tuple(float(read(part, "statistics", "a number")) for part in inside.split(",")) if inside else ()
    if name == "percentiles":
        good = numbers and all(0 <= x <= 100 for x in numbers)
    elif name == "histogram":
        good = len(numbers) == 1 and numbers[0] == int(numbers[0]) and 1 <= numbers[0] <= MOST_BINS
    else:
        good = not numbers
    if not good:
        raise InputError(f"statistics: expected one of {known}, with percentages from 0 to 100 and 1 to {MOST_BINS} "
                         f"bins, got {show(text)}")  # fmt: skip
    return Statistic(name, numbers)


def statistics_of(
    store: Store, statistics: Sequence[Statistic], variables: Sequence[Variable], progress: Callable[[str], None]
) -> list[Table]:
    """Return statistics of ``variables`` (outputs) as arrays, over all trajectories that have a value.

    The list also has, for each output, an array with the number of these trajectories. If percentiles are requested,
    its last array has their percentages, such as 5, 50 and 95. ``store`` must have all chunks; ``progress`` is called
    with a text for each output.
    """
    tables = []
    for variable in variables:
        progress(f"computing statistics of {variable.name} ..")
        tables += _of_variable(store, statistics, variable)
    labels = tuple(x for each in statistics if each.name == "percentiles" for x in each.numbers)
    if labels and variables:
        tables.append(Table(PERCENTILE, (PERCENTILE,), np.array(labels), {"long_name": "percentage"}))
    return tables


def _of_variable(store: Store, statistics: Sequence[Statistic], variable: Variable) -> list[Table]:
    def blocks() -> Iterator[Floats]:
        for start in range(0, store.header.count, BLOCK):
            values = store.read(variable.name, start, min(start + BLOCK, store.header.count))
            yield values.reshape(len(values), -1)

    dimensions = (TIME,) if TIME in variable.dimensions else ()
    shape = (len(store.header.times),) if dimensions else ()
    size = max(1, math.prod(shape))
    survey = _survey(blocks, size)

    def table(name: str, values: NDArray[Any], meaning: str, lead: tuple[str, ...] = (), unit: bool = True) -> Table:
        attributes = variable.attributes | {"long_name": f"{variable.name}, {meaning}"}
        if not unit:
            attributes.pop("units", None)
        values = values.reshape(len(values), *shape) if lead else values.reshape(-1, *shape)[0]
        return Table(f"{variable.name}_{name}", (*lead, *dimensions), values, attributes)

    tables = [table("number", survey.number, "number of trajectories with a value", unit=False)]
    for each in statistics:
        if each.name == "mean":
            tables.append(table("mean", survey.mean, "mean"))
            tables.append(table("std", _deviation(blocks, survey), "standard deviation"))
        elif each.name == "envelope":
            tables.append(table("min", survey.low, "smallest value"))
            tables.append(table("max", survey.high, "largest value"))
        elif each.name == "percentiles":
            values = _percentiles(blocks, survey, np.array(each.numbers))
            tables.append(table(PERCENTILE, values, "percentiles", (PERCENTILE,)))
        else:
            counts, edges = _histogram(blocks, survey, int(each.numbers[0]))
            tables.append(table("histogram", counts, "trajectories in each bin", (BIN,), unit=False))
            tables.append(table("edges", edges, "edges of the bins", (EDGE,)))
    return tables


@dataclass(frozen=True)
class _Survey:
    """The number of values, the extremes and the mean of each column of an output, over all trajectories.

    An output has a column for each sample time, or a single one if it has one value for each trajectory.
    """

    number: NDArray[np.int64]
    low: Floats
    high: Floats
    mean: Floats


def _survey(blocks: Blocks, size: int) -> _Survey:
    number = np.zeros(size, dtype=np.int64)
    low, high, sums = np.full(size, np.inf), np.full(size, -np.inf), list[Floats]()
    for block in blocks():
        good = ~np.isnan(block)
        number += good.sum(axis=0)
        low = np.minimum(low, np.where(good, block, np.inf).min(axis=0))
        high = np.maximum(high, np.where(good, block, -np.inf).max(axis=0))
        sums.append(np.where(good, block, 0.0).sum(axis=0))
    empty = number == 0
    low, high = (np.where(empty, np.nan, bound) for bound in (low, high))
    return _Survey(number, low, high, _total(sums, size) / np.where(empty, np.nan, number))


def _total(sums: Sequence[Floats], size: int) -> Floats:
    """Return the total of each of ``size`` columns from the sums of the blocks of rows, correctly rounded."""
    return np.array([math.fsum(block[k] for block in sums) for k in range(size)])


def _deviation(blocks: Blocks, survey: _Survey) -> Floats:
    """Return the standard deviation of each column, with divisor n as numpy.std; NaN counts as missing."""
    sums = []
    # divided by a power of 2, which loses no digit, tiny and huge differences have squares in the range of doubles
    _, exponent = np.frexp(np.maximum(survey.high - survey.mean, survey.mean - survey.low))
    for block in blocks():
        squares = np.ldexp(block - survey.mean, -exponent) ** 2
        sums.append(np.where(np.isnan(squares), 0.0, squares).sum(axis=0))
    scaled = np.sqrt(_total(sums, len(survey.mean)) / np.where(survey.number == 0, np.nan, survey.number))
    deviation: Floats = np.ldexp(scaled, exponent)
    return deviation


def _histogram(blocks: Blocks, survey: _Survey, bins: int) -> tuple[NDArray[np.int64], Floats]:
    """Return counts, shape (bins, columns), and edges, shape (bins + 1, columns), as numpy.histogram does."""
    size = len(survey.mean)
    counts, edges = np.zeros((bins, size), dtype=np.int64), np.full((bins + 1, size), np.nan)
    for k in np.flatnonzero(survey.number):
        # equal intervals of the range of the column
        edges[:, k] = _edges(survey.low[k], survey.high[k], bins)
    for block in blocks():
        for k in np.flatnonzero(survey.number):
            column = block[:, k]
            counts[:, k] += np.histogram(column[~np.isnan(column)], edges[:, k])[0]
    return counts, edges


def _edges(low: float, high: float, bins: int) -> Floats:
    """Return the edges of ``bins`` equal intervals of the range from ``low`` to ``high``, as numpy.histogram does."""
    try:
        return np.histogram_bin_edges([low, high], bins)
    except ValueError:
        # too few doubles lie between both: a range wide enough for different edges
        margin = 2 * bins * float(np.spacing(max(abs(low), abs(high))))
        return np.histogram_bin_edges([low - margin, high + margin], bins)


# --- percentiles ------------------------------------------------------------------------------------------------------


# Percentiles are exact: doubles are mapped to integers (keys) in the same order, the values are counted in intervals
# of keys, and intervals that contain a percentile are narrowed until their values fit in memory.
def _percentiles(blocks: Blocks, survey: _Survey, shares: Floats) -> Floats:
    """Return percentiles, shape (len(shares), columns), by linear interpolation as numpy.percentile.

    ``shares`` are the percentages, from 0 to 100.
    """
    places = np.maximum(survey.number - 1, 0)[None, :] * (shares / 100)[:, None]
    lower = np.floor(places).astype(np.int64)
    upper = np.minimum(lower + 1, np.maximum(survey.number - 1, 0))
    ranks = np.concatenate([lower, upper])
    first, second = np.split(order_statistics(blocks, survey.low, survey.high, ranks), 2)
    part, difference = places - lower, second - first
    values: Floats = np.where(part < 0.5, first + difference * part, second - difference * (1 - part))
    return values


def order_statistics(blocks: Blocks, low: Floats, high: Floats, ranks: NDArray[np.int64]) -> Floats:
    """Return, in each column, the values with given ranks, shape (r, columns); rank 0 is the smallest value.

    Parameters
    ----------
    blocks : function
        Returns the values in blocks, shape (rows, columns); NaN marks a missing value.
    low, high : arrays, shape (columns,)
        Smallest and largest value of each column; NaN if the column has none.
    ranks : array, shape (r, columns)
        Numbers from 0, below the number of values.
    """
    results = np.full(ranks.shape, np.nan)
    searches = []
    for k in np.flatnonzero(~np.isnan(low)).tolist():
        first, last = (int(key) for key in _keys(np.array([low[k], high[k]])))
        searches.append(_Search(k, first, last, {int(rank): int(rank) for rank in ranks[:, k]}))
    values: dict[tuple[int, int], float] = {}
    while searches:
        searches = _narrowed(blocks, searches, values)
    for place, rank in np.ndenumerate(ranks):
        results[place] = values.get((place[1], int(rank)), np.nan)
    return results


@dataclass
class _Search:
    """A search in one column for the values of given ranks; their keys lie between ``first`` and ``last``.

    A key is an integer; keys have the same order as the values (:func:`_keys`).
    """

    column: int
    first: int
    last: int
    # rank among the values in the interval -> rank among all values of the column
    ranks: dict[int, int]
    number: int = -1  # number of values in the interval; -1: unknown


def _narrowed(blocks: Blocks, searches: list[_Search], values: dict[tuple[int, int], float]) -> list[_Search]:
    """Narrow the intervals of searches for values of given ranks; return the searches that are not finished.

    A value that was found is put into ``values`` under the key (column, rank). The blocks are read at most once.
    """
    open_searches = []
    for search in searches:
        if search.first == search.last:
            value = float(_values(np.array([search.first], dtype=np.uint64))[0])
            values |= {(search.column, rank): value for rank in search.ranks.values()}
        else:
            open_searches.append(search)
    if not open_searches:
        return []
    small = [0 <= search.number <= MOST_VALUES for search in open_searches]
    shifts = [max(0, (search.last - search.first).bit_length() - BINS.bit_length() + 1) for search in open_searches]
    counts = [np.zeros(BINS, dtype=np.int64) for _ in open_searches]
    members: list[list[Keys]] = [[] for _ in open_searches]
    for block in blocks():
        keys: dict[int, Keys] = {}
        for k, search in enumerate(open_searches):
            if search.column not in keys:
                column = block[:, search.column]
                keys[search.column] = _keys(column[~np.isnan(column)])
            own = keys[search.column]
            own = own[(own >= np.uint64(search.first)) & (own <= np.uint64(search.last))]
            if small[k]:
                members[k].append(own)
            else:
                bins = ((own - np.uint64(search.first)) >> np.uint64(shifts[k])).astype(np.int64)
                counts[k] += np.bincount(bins, minlength=BINS)
    narrower = []
    for k, search in enumerate(open_searches):
        if small[k]:
            # few values are sorted
            ordered = _values(np.sort(np.concatenate(members[k])))
            values |= {(search.column, rank): float(ordered[r]) for r, rank in search.ranks.items()}
        else:
            narrower += _split(search, counts[k], shifts[k])
    return narrower


def _split(search: _Search, counts: NDArray[np.int64], shift: int) -> list[_Search]:
    """Split the interval of ``search`` into parts, and return a search in each part that contains a value of its ranks.

    The interval is one of keys, integers in the same order as the values; a part has 2^shift keys, and ``counts`` has
    the number of values in each part. Rank 0 is the smallest value. For ``counts`` 5 and 7, rank 6 becomes rank 1 of a
    search in the second part.
    """
    ends = np.cumsum(counts)
    parts: dict[int, _Search] = {}
    for rank, whole in search.ranks.items():
        k = int(np.searchsorted(ends, rank, side="right"))
        first = search.first + (k << shift)
        last = min(search.last, first + (1 << shift) - 1)
        part = parts.setdefault(k, _Search(search.column, first, last, {}, int(counts[k])))
        part.ranks[rank - int(ends[k] - counts[k])] = whole
    return list(parts.values())


_SIGN = np.uint64(2**63)


def _keys(values: Floats) -> Keys:
    """Return an integer (key) for each of the doubles ``values``, in the same order; -0.0 has the key of 0.0."""
    bits = np.ascontiguousarray(values + 0.0).view(np.uint64)
    keys: Keys = np.where(bits & _SIGN, ~bits, bits | _SIGN)
    return keys


def _values(keys: Keys) -> Floats:
    """Return the doubles whose keys, integers in the same order, are ``keys``: the inverse of :func:`_keys`."""
    return np.where(keys & _SIGN, keys ^ _SIGN, ~keys).view(np.float64)

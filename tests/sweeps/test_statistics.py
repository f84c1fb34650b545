"""Statistics of a sweep are those of NumPy for all values at once, whatever the distribution of the values."""

import math

import numpy as np
import pytest

from symrot.errors import InputError
from symrot.sweeps import statistics
from symrot.sweeps.layout import Variable
from symrot.sweeps.statistics import order_statistics, read_statistics, statistics_of

RNG = np.random.default_rng(1)
N = 3000
SHARES = (0, 1, 5, 33.3, 50, 95, 99.9, 100)
COLUMNS = {
    "normal": RNG.normal(size=N),
    "narrow": 20 + 1e-12 * RNG.normal(size=N),
    "heavy tails": RNG.standard_cauchy(N) ** 5,
    "equal": np.full(N, 3.0),
    "two values": RNG.choice([-1.0, 1.0], N),
    "zeros of both signs": RNG.choice([-0.0, 0.0, 1.0], N),
    "with gaps": np.where(RNG.random(N) < 0.3, np.nan, RNG.normal(size=N)),
    "one value": np.where(np.arange(N) == 7, 5.0, np.nan),
}
TABLE = np.stack(list(COLUMNS.values()), axis=1)


class Rows:
    """A store of one output with one column for each distribution."""

    class header:
        count, times = N, np.arange(len(COLUMNS))

    @staticmethod
    def read(name, start, stop):
        return TABLE[start:stop]


@pytest.fixture(params=[200_000, 10], ids=["sorted at once", "narrowed"])
def tables(request, monkeypatch):
    monkeypatch.setattr(statistics, "MOST_VALUES", request.param)
    monkeypatch.setattr(statistics, "BLOCK", 700)
    chosen = read_statistics(["mean", "envelope", f"percentiles{SHARES}", "histogram(7)"])
    output = Variable("x", ("time",), "m", "", "place")
    return {table.name: table for table in statistics_of(Rows, chosen, [output], str)}


def test_percentiles_are_those_of_numpy(tables):
    assert np.array_equal(tables["x_percentile"].values, np.nanpercentile(TABLE, SHARES, axis=0))


def test_envelope_mean_and_deviation_are_those_of_numpy(tables):
    assert np.array_equal(tables["x_min"].values, np.nanmin(TABLE, axis=0))
    assert np.array_equal(tables["x_max"].values, np.nanmax(TABLE, axis=0))
    assert tables["x_number"].values.tolist() == (~np.isnan(TABLE)).sum(axis=0).tolist()
    for k, column in enumerate(TABLE.T):
        values = column[~np.isnan(column)]
        mean = math.fsum(values) / len(values)
        scale = np.abs(values).max()
        # one rounding for each addition in a block of 700 rows, at most
        assert abs(tables["x_mean"].values[k] - mean) <= 700 * 2**-53 * scale
        assert abs(tables["x_std"].values[k] - values.std()) <= 1e-12 * values.std() + 1e-15 * scale


def test_histograms_are_those_of_numpy(tables):
    for k, column in enumerate(TABLE.T):
        counts, edges = np.histogram(column[~np.isnan(column)], 7)
        assert np.array_equal(tables["x_histogram"].values[:, k], counts)
        assert np.array_equal(tables["x_edges"].values[:, k], edges)


@pytest.mark.parametrize("values", [[1e20, 1e20], [2.0**53], [1.0, 1 + 2**-52], [-1e300, -1e300, math.nan]])
def test_a_range_with_few_doubles_has_a_histogram(values):
    """NumPy refuses to divide it; the sweep was then lost with a traceback."""

    class Store:
        class header:
            count, times = len(values), np.arange(1)

        @staticmethod
        def read(name, start, stop):
            return np.array(values)[:, None]

    output = Variable("x", ("time",), "J", "", "energy")
    tables = {table.name: table for table in statistics_of(Store, read_statistics(["histogram(7)"]), [output], str)}
    edges, here = tables["x_edges"].values[:, 0], [x for x in values if not math.isnan(x)]
    assert (np.diff(edges) > 0).all() and edges[0] <= min(here) <= max(here) <= edges[-1]
    assert tables["x_histogram"].values.sum() == len(here)


def test_units_and_meanings_go_with_the_statistics(tables):
    assert tables["x_mean"].attributes == {"units": "m", "long_name": "x, mean", "description": "place"}
    assert "units" not in tables["x_number"].attributes
    assert tables["percentile"].values.tolist() == list(SHARES)


def test_order_statistics_of_extreme_doubles():
    column = np.array([[-np.inf], [-1.7e308], [-5e-324], [0.0], [5e-324], [1.7e308], [np.inf]])
    ranks = np.arange(7)[:, None]
    values = order_statistics(lambda: iter([column[::-1]]), column[0], column[-1], ranks)
    assert np.array_equal(values, column)


@pytest.mark.parametrize(
    "text", ["percentile(5)", "percentiles", "percentiles(101)", "histogram(0)", "histogram(1.5)", "mean(3)", "", 3]
)
def test_a_statistic_that_cannot_be_used_is_one_sentence(text):
    with pytest.raises(InputError, match=r"statistics: expected one of mean, envelope"):
        read_statistics([text])


@pytest.mark.parametrize("size", [1e-200, 1e200])
def test_the_deviation_of_tiny_and_huge_values(size):
    class Store:
        class header:
            count, times = 4, np.arange(1)

        @staticmethod
        def read(name, start, stop):
            return size * np.array([[1.0], [2.0], [3.0], [4.0]])

    output = Variable("x", ("time",), "J", "", "energy")
    tables = {table.name: table for table in statistics_of(Store, read_statistics(["mean"]), [output], str)}
    assert tables["x_std"].values / size == pytest.approx([np.sqrt(1.25)], rel=1e-14)


@pytest.mark.parametrize("texts", [["percentiles(0)", "percentiles(50, 100)"], ["histogram(2)", "histogram(4)"]])
def test_a_statistic_that_would_replace_another_is_refused(texts):
    with pytest.raises(InputError, match="expected each statistic once"):
        read_statistics(texts)

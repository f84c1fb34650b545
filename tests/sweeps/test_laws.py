"""Laws of varied values: their text, and their quantiles against SciPy's distributions."""

import numpy as np
import pytest
import scipy

from symrot.errors import InputError
from symrot.sweeps.laws import Grid, read_law

SHARES = np.linspace(0.001, 0.999, 57)


@pytest.mark.parametrize(
    ("text", "name", "parameters"),
    [
        ("normal(2, 0.1)", "norm", (2, 0.1)),
        ("uniform(-1, 3)", "uniform", (-1, 4)),
        ("loguniform(1/1000, 10)", "loguniform", (1e-3, 10)),
    ],
)
def test_quantiles_are_those_of_scipy(text, name, parameters):
    reference = getattr(scipy.stats, name)(*parameters)
    assert np.allclose(read_law(text, "x").quantile(SHARES), reference.ppf(SHARES), rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize(
    ("law", "values"),
    [
        ("linspace(1, 2, 3)", (1.0, 1.5, 2.0)),
        ("geomspace(1, 100, 3)", (1.0, 10.0, 100.0)),
        ("geomspace(1e-200, 1e-180, 3)", (1e-200, 1e-190, 1e-180)),
        ("geomspace(-1e-200, -1e-180, 3)", (-1e-200, -1e-190, -1e-180)),
        ("values(1/4, (1 + 1)*2)", (0.25, 4.0)),
        ([1, "1/2"], (1.0, 0.5)),
        (np.array([3.0]), (3.0,)),
    ],
)
def test_grids_list_their_values(law, values):
    assert read_law(law, "x") == Grid(pytest.approx(values, rel=1e-15))


@pytest.mark.parametrize(
    ("law", "message"),
    [
        ("norml(0, 1)", "x: expected one of normal(mean, deviation), .* (did you mean 'normal'?)"),
        ("normal(0, -1)", "x: expected normal(mean, deviation) with deviation > 0, got 'normal(0, -1)'"),
        ("normal(0)", "x: expected normal(mean, deviation)"),
        ("uniform(2, 1)", "low < high"),
        ("loguniform(0, 1)", "0 < low < high"),
        ("linspace(0, 1, 2.5)", "with a whole number"),
        ("geomspace(-1, 1, 3)", "of the same sign"),
        ("geomspace(0, 1, 3)", "of the same sign"),
        ("linspace(-1e308, 1e308, 3)", "a range within that of a double"),
        ("uniform(-1e308, 1e308)", "x: expected uniform(low, high) with a range within that of a double"),
        ("normal(0, 1e308)", "x: expected normal(mean, deviation) with a range within that of a double"),
        ("values()", "a number"),
        ("normal(0, x)", "x: expected a number, got ' x'"),
        ([], "x: expected 1 to"),
        (3, "x: expected one of"),
        ("3", "x: expected one of"),
    ],
)
def test_a_law_that_cannot_be_used_is_one_sentence(law, message):
    with pytest.raises(InputError) as error:
        read_law(law, "x")
    assert "\n" not in str(error.value)
    for part in message.split(".*"):
        assert part.strip() in str(error.value)

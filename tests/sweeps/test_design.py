"""Designs: products of grids with draws, counts, and names that a scene does not have."""

import numpy as np
import pytest
import scipy

from symrot.errors import InputError
from symrot.scene.scene import Scene
from symrot.sweeps.design import read_design
from tests.sweeps.scenes import DAMPED_TOP

SCENE = Scene.from_dict(DAMPED_TOP)


def design(vary, **options):
    return read_design(SCENE, DAMPED_TOP, vary, **options)


def test_every_draw_is_used_at_every_grid_point():
    values = design(
        {"omega_1": "normal(0, 1)", "weight": "values(1, 2)", "omega_3": "values(5, 6, 7)"}, count=24
    ).draws(0, 24).values  # fmt: skip
    table = values.reshape(4, 2, 3, 3)
    assert (table[..., 0] == table[:, :1, :1, 0]).all() and len(set(table[:, 0, 0, 0])) == 4
    assert (table[..., 1] == np.array([1, 2])[:, None]).all() and (table[..., 2] == [5, 6, 7]).all()


@pytest.mark.parametrize("sampling", ["random", "sobol"])
def test_a_longer_sweep_begins_with_the_shorter_one(sampling):
    vary = {"omega_1": "normal(0, 1)", "omega_2": "uniform(0, 1)", "weight": "values(1, 2)"}
    short, long = (design(vary, count=n, sampling=sampling, attitudes="uniform") for n in (20, 60))
    assert np.array_equal(short.draws(0, 20).values, long.draws(0, 60).values[:20])
    assert np.array_equal(short.draws(0, 20).attitudes, long.draws(0, 60).attitudes[:20])


@pytest.mark.parametrize(("start", "stop"), [(0, 1), (3, 9), (39, 40), (5, 5)])
def test_draws_depend_on_the_index_alone(start, stop):
    whole = design(
        {"omega_1": "normal(0, 1)", "weight": "values(1, 2)"}, count=40, attitudes="uniform", sampling="latin"
    )
    part = whole.draws(start, stop)
    assert np.array_equal(part.values, whole.draws(0, 40).values[start:stop])
    assert np.array_equal(part.attitudes, whole.draws(0, 40).attitudes[start:stop])


def test_draws_have_their_distribution():
    values = design({"omega_1": "normal(2, 0.1)", "weight": "loguniform(1, 9)"}, count=4000).draws(0, 4000).values
    assert scipy.stats.kstest(values[:, 0], scipy.stats.norm(2, 0.1).cdf).pvalue > 1e-3
    assert scipy.stats.kstest(values[:, 1], scipy.stats.loguniform(1, 9).cdf).pvalue > 1e-3


@pytest.mark.parametrize(
    ("vary", "options", "message"),
    [
        ({"wieght": "values(1)"}, {}, "did you mean 'weight'?"),
        ({"body.principel[0]": "values(1)"}, {}, "did you mean 'body.principal[0]'?"),
        ({"torque[0].direction[1]": "values(1)"}, {}, "expected a number in the scene file"),
        ({"direction_1": "values(1)"}, {}, "direction is the same for all"),
        ({"body.about": "values(1)"}, {}, "contains a number"),
        ({"omega_1": "normal(0, 1)"}, {}, "count: expected the number of trajectories"),
        ({"omega_1": "values(1, 2)"}, {"count": 3}, "count: expected 2, the number of grid points"),
        ({"omega_1": "normal(0, 1)", "weight": "values(1, 2)"}, {"count": 5}, "multiple of 2, .*such as 4, got 5"),
        ({"omega_1": "normal(0, 1)"}, {"count": "1e2.5"}, "count: expected a whole number"),
        ({"omega_1": "normal(0, 1)"}, {"count": 0}, "count: expected a whole number"),
        ({"omega_1": "normal(0, 1)"}, {"count": 2, "seed": -1}, "seed: expected a whole number"),
        ({"omega_1": "normal(0, 1)"}, {"count": 2, "sampling": "sobl"}, "did you mean 'sobol'?"),
        ({"omega_1": [1, 2]}, {"sampling": "latin"}, "sampling: leave it out unless values are drawn"),
        ({"omega_1": [1, 2]}, {"seed": 7}, "seed: leave it out unless values are drawn"),
        ({"omega_1": "normal(0, 1)"}, {"count": 2, "attitudes": "unifrom"}, "did you mean 'uniform'?"),
        ({}, {"count": 2}, "at least one value that varies"),
        ({"omega_1": "values(1)", "initial.omega[0]": "values(1)"}, {}, "either by name or by path"),
        ({"weight": "values(1)", "torque[0].weight": "values(1)"}, {}, "either by name or by path"),
        ({"initial.attitude.angles[0]": "values(1)"}, {"attitudes": "uniform"}, "got both"),
    ],
)
def test_a_design_that_cannot_be_used_is_one_sentence(vary, options, message):
    with pytest.raises(InputError) as error:
        design(vary, **options)
    assert "\n" not in str(error.value)
    for part in message.split(".*"):
        assert part in str(error.value)

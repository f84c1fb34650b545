"""Points of the unit cube: each depends only on seed, name and index; they have the distribution of their sampling."""

import numpy as np
import pytest
import scipy
from scipy.spatial.transform import Rotation

from symrot.sweeps.points import SAMPLINGS, permuted, unit_points
from symrot.sweeps.rotations import uniform_rotations

NAMES = ("a", "b", "c")


@pytest.mark.parametrize("sampling", SAMPLINGS)
@pytest.mark.parametrize("part", [1, 37, 64, 1000])
def test_parts_have_the_bits_of_the_whole(sampling, part):
    whole = unit_points(sampling, 7, NAMES, 1000, 0, 1000)
    starts = list(range(0, 1000, part))[:: max(1, 100 // part)]
    for start in [*reversed(starts), *starts]:
        stop = min(start + part, 1000)
        assert np.array_equal(unit_points(sampling, 7, NAMES, 1000, start, stop), whole[start:stop])


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_points_are_uniform_and_independent(sampling):
    points = unit_points(sampling, 3, NAMES, 4096, 0, 4096)
    assert ((points > 0) & (points < 1)).all()
    assert all(scipy.stats.kstest(column, "uniform").pvalue > 1e-3 for column in points.T)
    # the correlation of n independent pairs has the standard deviation 1/sqrt(n) = 1/64
    assert abs(np.corrcoef(points.T) - np.eye(3)).max() < 5 / 64


def test_another_seed_or_name_gives_other_points():
    points = [unit_points("random", seed, (name,), 9, 0, 9) for seed, name in ((1, "a"), (2, "a"), (1, "b"))]
    assert len({array.tobytes() for array in points}) == 3


def test_random_points_do_not_depend_on_other_names():
    alone = unit_points("random", 1, ("b",), 9, 0, 9)
    assert np.array_equal(unit_points("random", 1, ("a", "b"), 9, 0, 9)[:, 1:], alone)


def test_the_words_are_those_of_philox_in_order():
    key = np.random.SeedSequence(5, spawn_key=tuple(b"a")).generate_state(2, np.uint64)
    words = np.random.Philox(key=key).random_raw(11)
    expected = ((words >> np.uint64(12)).astype(float) + 0.5) / 2**52
    assert np.array_equal(unit_points("random", 5, ("a",), 11, 3, 11)[:, 0], expected[3:])


@pytest.mark.parametrize("count", [1, 2, 3, 10, 1000, 1024, 1025])
def test_a_latin_hypercube_has_one_point_in_each_interval(count):
    points = unit_points("latin", 7, NAMES, count, 0, count)
    for column in points.T:
        assert np.array_equal(np.sort(np.floor(column * count)), np.arange(count))


@pytest.mark.parametrize("count", [1, 2, 5, 64, 1000])
def test_a_feistel_network_is_a_permutation(count):
    places = permuted(np.arange(count, dtype=np.uint64), count, np.arange(6, dtype=np.uint64))
    assert sorted(places.tolist()) == list(range(count))


def test_sobol_points_are_those_of_scipy():
    points = unit_points("sobol", 7, NAMES, 64, 0, 64)
    reference = scipy.stats.qmc.Sobol(3, seed=7).random(64)
    assert np.array_equal(points, reference + 2.0**-31)  # the middles of the cells


def test_rotations_are_uniform():
    """The angle of a uniform rotation has the distribution (a - sin a)/pi; its axis has a uniform third component."""
    quaternions = uniform_rotations(unit_points("random", 7, NAMES, 4096, 0, 4096))
    assert np.abs((quaternions**2).sum(axis=1) - 1).max() < 1e-15
    vectors = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]]).as_rotvec()
    angles = np.linalg.norm(vectors, axis=1)
    assert scipy.stats.kstest(angles, lambda a: (a - np.sin(a)) / np.pi).pvalue > 1e-3
    assert scipy.stats.kstest(vectors[:, 2] / angles, scipy.stats.uniform(-1, 2).cdf).pvalue > 1e-3

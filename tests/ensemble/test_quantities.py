"""Quantities, statistics and single motions of an ensemble agree with those of each trajectory alone."""

import pickle
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.scene.tables import QUANTITIES, Output

pytestmark = pytest.mark.usefixtures("quick_compiler")
TIMES = [0.0, 0.1, 0.2]
RATES = np.outer(np.linspace(0.9, 1.1, 4), [0.1, 1.0, 15.0])
WEIGHTS = np.array([1.0, 2.0, 0.5, 3.0])


@pytest.fixture(scope="module")
def ensemble():
    scene = symrot.load_scene("heavy_top_loops")
    scene = replace(scene, output=Output(tuple(QUANTITIES), "ZXZ", False))
    return symrot.propagate_ensemble(scene, omega=RATES, parameters={"weight": WEIGHTS}, t=TIMES)


def alone(ensemble, k):
    scene = ensemble.scene
    torque = scene.torques[0].with_constant("weight", None, Fraction(float(WEIGHTS[k])))
    return symrot.propagator(replace(scene, torques=(torque,)))(TIMES, omega=RATES[k])


@pytest.mark.parametrize("name", QUANTITIES)
def test_a_quantity_of_all_motions_is_that_of_each(ensemble, name):
    values = ensemble.quantity(name)
    assert values.shape[:2] == (4, 3)
    for k, member in enumerate(ensemble):
        expected = alone(ensemble, k).quantity(name)
        assert np.abs(values[k] - expected).max() <= 1e-13 * np.abs(expected).max()
        assert np.abs(member.quantity(name) - values[k]).max() <= 1e-15 * np.abs(expected).max()


def test_moments_of_inertia_that_vary_enter_the_energy():
    moments = np.array([[1.0, 2.0, 2.5], [1.0, 2.0, 2.6], [2.0, 2.0, 3.0]])
    ensemble = symrot.propagate_ensemble("tumbling_prism", parameters={"principal": moments}, t=TIMES)
    assert np.abs(ensemble.energy - (ensemble.omega**2 * moments[:, None]).sum(axis=-1) / 2).max() < 1e-14
    assert np.abs(ensemble.angular_momentum_body - ensemble.omega * moments[:, None]).max() < 1e-14


def test_a_member_is_one_motion(ensemble):
    member = ensemble[-1]
    assert member.t.tolist() == TIMES and member.omega.tolist() == ensemble.omega[3].tolist()
    assert (member.method, member.message, member.success, len(member)) == (ensemble.methods[3], "", True, 3)
    assert member.scene.torques[0].constant("weight", None) == 3
    assert np.abs(member.rotation.as_matrix() - member.dcm).max() < 1e-14
    assert "Motion 3 of <Ensemble of heavy_top_loops" in repr(member) and len(list(ensemble)) == 4
    for k in (4, -5):
        with pytest.raises(IndexError):
            ensemble[k]


def test_members_have_their_own_times():
    times = np.array([[0.0, 1.0], [2.0, 3.0]])
    ensemble = symrot.propagate_ensemble("t_handle", omega=RATES[:2], t=times)
    assert ensemble[1].t.tolist() == [2.0, 3.0] and ensemble.energy.shape == (2, 2)
    with pytest.raises(InputError, match="t: expected sample times that all motions share, for statistics"):
        ensemble.mean("omega")
    frame = ensemble.to_dataframe(["omega"]) if _has("pandas") else None
    assert frame is None or frame.index.tolist() == [(0, 0.0), (0, 1.0), (1, 2.0), (1, 3.0)]
    assert not _has("xarray") or ensemble.to_xarray(["omega"]).t.dims == ("trajectory", "time")


def _has(package):
    try:
        __import__(package)
    except ImportError:
        return False
    return True


def test_statistics_are_those_of_numpy(ensemble):
    assert ensemble.mean("omega").tolist() == ensemble.omega.mean(axis=0).tolist()
    middle = ensemble.percentiles("energy", [25, 50])
    assert middle.tolist() == np.percentile(ensemble.energy, [25, 50], axis=0).tolist()
    assert ensemble.percentiles("energy", 50).tolist() == middle[1].tolist()
    assert ensemble.mean("omega", omit_stopped=True).tolist() == ensemble.mean("omega").tolist()


def test_statistics_say_where_a_motion_stopped(recwarn):
    scene = symrot.load_scene("t_handle")
    ensemble = symrot.propagate_ensemble(scene, omega=RATES, t=TIMES)
    ensemble._omega = ensemble.omega.copy()
    ensemble._omega[1, 1:] = np.nan  # as after a motion that stopped early
    ensemble._omega[:, 2] = np.nan
    assert np.isnan(ensemble.mean("omega")[1:]).all() and not np.isnan(ensemble.mean("omega")[0]).any()
    others = ensemble.omega[[0, 2, 3], 1]
    assert np.abs(ensemble.mean("omega", omit_stopped=True)[1] - others.mean(axis=0)).max() < 1e-15
    assert np.abs(ensemble.percentiles("omega", 50, True)[1] - np.median(others, axis=0)).max() < 1e-15
    assert np.isnan(ensemble.mean("omega", omit_stopped=True)[2]).all() and not recwarn.list


@pytest.mark.parametrize("name", ["quaternion", "euler", "dcm", "speed", 3, ["omega"]], ids=str)
def test_statistics_of_attitudes_and_unknown_quantities_are_refused(ensemble, name):
    with pytest.raises(InputError, match="quantity: expected one of omega, omega_space, energy, "):
        ensemble.mean(name)


@pytest.mark.parametrize("q", [101, -1, [50, float("nan")], "half"])
def test_percentages_beyond_0_to_100_are_refused(ensemble, q):
    with pytest.raises(InputError, match="q: expected percentages from 0 to 100"):
        ensemble.percentiles("omega", q)


def test_an_ensemble_pickles_with_its_quantities(ensemble):
    other = pickle.loads(pickle.dumps(ensemble))
    assert other.energy.tolist() == ensemble.energy.tolist() and other[1].scene == ensemble[1].scene


def test_tables_have_one_row_for_each_sample_of_each_motion(ensemble):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    frame = ensemble.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and frame.index.names == ["trajectory", "t"] and len(frame) == 12
    assert frame.loc[2, 0.1]["energy"] == ensemble.energy[2, 1] and frame.attrs["units"]["energy"] == "J"
    data = ensemble.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.energy.dims == ("trajectory", "time")
    assert data.dcm.dims == ("trajectory", "time", "space_axis", "body_axis")
    assert data.omega.sel(time=0.2, body_axis=3)[1].item() == ensemble.omega[1, 2, 2]

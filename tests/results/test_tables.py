"""Samples as rotations of SciPy, data frames and data sets: the same numbers, with units, and at other times."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.scene.tables import QUANTITIES, Output

pytestmark = pytest.mark.usefixtures("quick_compiler")
TIMES = np.linspace(0.0, 2.0, 9)


@pytest.fixture(scope="module")
def trajectory():
    scene = symrot.load_scene("t_handle")
    scene = replace(scene, output=Output(tuple(QUANTITIES), "ZXZ", True))
    return symrot.propagator(scene)(TIMES, events=["omega_3 == 0", {"formula": "omega_1 - 100"}])


def test_rotation_is_the_attitude(trajectory):
    assert np.abs(trajectory.rotation.as_matrix() - trajectory.dcm).max() < 1e-14
    vectors = trajectory.rotation.apply(trajectory.omega)
    assert np.abs(vectors - trajectory.omega_space).max() < 1e-14 * np.abs(vectors).max()


def test_a_symmetry_axis_that_is_no_body_axis_keeps_its_angle_to_the_momentum():
    """As in a regular precession: I = 2 E - n n^T with n = (1, 1, 0)/sqrt(2)."""
    scene = symrot.Scene.build(
        body={"inertia": [["3/2", "-1/2", 0], ["-1/2", "3/2", 0], [0, 0, 2]]},
        initial={"omega": [0.5, 1, 3]},
        span={"t": [0, 5], "samples": 20},
    )
    motion = symrot.propagate(scene)
    heights = np.einsum("ni,ni->n", motion.axis, motion.angular_momentum_space)
    assert np.abs(motion.axis[0]) == pytest.approx([np.sqrt(0.5), np.sqrt(0.5), 0])
    assert np.ptp(heights) < 1e-10 and np.ptp(motion.axis, axis=0).max() > 1
    many = symrot.propagate_ensemble(scene, omega=[[0.5, 1, 3]] * 2)
    assert np.abs(many.axis - motion.axis).max() < 1e-10


def test_the_trajectory_at_other_times_is_the_one_propagated_there(trajectory):
    times = [0.3, 1.7, 0.3, 0.0]
    for method in ("auto", "taylor"):
        propagator = symrot.propagator("t_handle", method)
        other = propagator(TIMES).at(times)
        direct = propagator(times)
        assert type(other) is symrot.Trajectory and other.t.tolist() == times and other.events is None
        for name in ("omega", "quaternion", "energy", "angular_momentum_space"):
            assert np.abs(getattr(other, name) - getattr(direct, name)).max() < 1e-10, name
    assert trajectory.at(0.5).t.tolist() == [0.5]


def test_resampling_takes_a_number_or_times(trajectory):
    assert trajectory.resample(3).t.tolist() == [0.0, 1.0, 2.0]
    assert trajectory.resample([0.5]).t.tolist() == [0.5]
    assert trajectory.resample(np.int64(2)).omega[1].tolist() == trajectory.omega[-1].tolist()


@pytest.mark.parametrize("t", [2.5, -0.1, [0.1, float("nan")], [[0.1]], "now"])
def test_times_outside_the_motion_are_refused(trajectory, t):
    with pytest.raises(InputError, match="t: expected"):
        trajectory.at(t)


@pytest.mark.parametrize("count", [1, 0, -3])
def test_fewer_than_two_samples_are_refused(trajectory, count):
    with pytest.raises(InputError, match="times: expected 2 or more as the number of new samples"):
        trajectory.resample(count)


def test_events_are_trajectories_at_their_times(trajectory):
    crossings, never = trajectory.at_events
    assert crossings.t.tolist() == trajectory.t_events[0].tolist() and len(crossings) == 1
    assert abs(crossings.omega[0, 2]) < 1e-12 and len(never) == 0
    assert [event.formula for event in trajectory.events] == ["omega_3 == 0", "omega_1 - 100"]
    assert abs(crossings.energy[0] - trajectory.energy[0]) < 1e-12
    assert symrot.propagate("t_handle").at_events == []


def test_a_data_frame_has_all_components_with_units(trajectory):
    pandas = pytest.importorskip("pandas")
    frame = trajectory.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t" and frame.index.tolist() == TIMES.tolist()
    assert frame[["omega_1", "omega_2", "omega_3"]].to_numpy().tolist() == trajectory.omega.tolist()
    assert frame["dcm_12"].tolist() == trajectory.dcm[:, 0, 1].tolist()
    assert frame["euler_ZXZ_2"].tolist() == trajectory.euler("ZXZ", degrees=True)[:, 1].tolist()
    assert frame["energy"].tolist() == trajectory.energy.tolist()
    assert set(frame.attrs["units"]) == {"t", *frame.columns}
    assert (frame.attrs["units"]["omega_1"], frame.attrs["units"]["euler_ZXZ_1"]) == ("rad/s", "deg")
    assert frame.attrs["frames"]["L_x"] == "space" and frame.attrs["scene"] == "t_handle"
    assert trajectory.to_dataframe(["energy"]).columns.tolist() == ["energy"]
    assert trajectory.to_dataframe("energy").columns.tolist() == ["energy"]


def test_a_data_set_has_axes_units_and_names(trajectory):
    xarray = pytest.importorskip("xarray")
    data = trajectory.to_xarray()
    assert isinstance(data, xarray.Dataset) and set(data.data_vars) == {*QUANTITIES, "euler_lock"}
    assert data.omega.dims == ("time", "body_axis") and data.dcm.dims == ("time", "space_axis", "body_axis")
    assert data.omega.attrs == {
        "units": "rad/s",
        "long_name": "angular velocity, body components",
        "frame": "body",
    }
    assert data.time.attrs["units"] == "s" and data.attrs["method"] == trajectory.method
    turned = xarray.dot(data.dcm, data.omega, dim="body_axis")
    assert np.abs(turned - data.omega_space).max() < 1e-14 * np.abs(data.omega).max()
    assert data.omega.sel(body_axis=3, time=1.0).item() == trajectory.omega[4, 2]
    assert data.quaternion.sel(component="q0")[0].item() == trajectory.quaternion[0, 0]


def test_unknown_quantities_are_refused_in_a_sentence(trajectory):
    with pytest.raises(InputError, match=r"quantities: expected names among omega, .* got 'speed'"):
        trajectory._labelled(["speed"])
    with pytest.raises(InputError, match=r"got 'enrgy' \(did you mean 'energy'\?\)"):
        trajectory._labelled(["enrgy"])


@pytest.mark.parametrize(("quantities", "message"), [
    (3, "expected a name or a list of names such as 'omega', got 3"),
    ([["omega"]], r"expected a name or a list of names such as 'omega', got \[\['omega'\]\]"),
    (["omega", "omega"], "expected each quantity once, got 'omega' twice"),
])  # fmt: skip
def test_names_of_quantities_are_texts_and_occur_once(trajectory, tmp_path, quantities, message):
    path = tmp_path / "motion.npz"
    trajectory.save(path)
    for make in (trajectory.to_dataframe, trajectory.to_xarray, symrot.load(path)._labelled):
        with pytest.raises(InputError, match=f"^quantities: {message}$"):
            make(quantities)
    with pytest.raises(InputError, match=f"^quantities: {message}$"):
        symrot.save(trajectory, path, quantities)


def test_a_missing_package_is_named_with_its_extra():
    code = (
        "import sys; sys.modules['pandas'] = sys.modules['xarray'] = None\n"
        "import symrot\n"
        "for name in ('to_dataframe', 'to_xarray'):\n"
        "    try: getattr(symrot.propagate('t_handle'), name)()\n"
        "    except symrot.InputError as error: print(error)"
    )
    lines = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.splitlines()
    assert [line.split(", but")[0] for line in lines] == [
        "to_dataframe: expected pandas",
        "to_xarray: expected xarray",
    ]
    assert all("pip install 'symrot[frames]'" in line for line in lines)

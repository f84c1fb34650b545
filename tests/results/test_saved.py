"""Files of trajectories: what is saved is loaded again, bit by bit, and other files are refused in one sentence."""

import json
import subprocess
import sys
import zipfile
from dataclasses import replace

import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.scene.tables import QUANTITIES, Output

pytestmark = pytest.mark.usefixtures("quick_compiler")
EVENTS = ["omega_3 == 0", {"formula": "omega_1 - 100"}]


@pytest.fixture(scope="module")
def trajectory():
    scene = symrot.load_scene("t_handle")
    scene = replace(scene, output=Output(tuple(QUANTITIES), "ZXZ", True))
    return symrot.propagator(scene)(np.linspace(0.0, 2.0, 9), events=EVENTS)


@pytest.fixture
def path(trajectory, tmp_path):
    trajectory.save(tmp_path / "motion.npz")
    return tmp_path / "motion.npz"


def test_a_saved_trajectory_is_loaded_bit_by_bit(trajectory, path):
    saved = symrot.load(path)
    for name in ("t", *QUANTITIES, "omega_space", "dcm"):
        same = trajectory.t if name == "t" else trajectory.quantity(name)
        assert (saved.t if name == "t" else saved.quantity(name)).tobytes() == same.tobytes(), name
    assert saved.energy.tolist() == trajectory.energy.tolist() and len(saved) == 9 and saved.success
    assert (saved._about, saved.method) == (trajectory._about, trajectory.method)
    labels, own = ({item.name: item[2:] for item in each._labelled()} for each in (saved, trajectory))
    assert labels == own


def test_events_are_loaded_with_their_states(trajectory, path):
    saved = symrot.load(path)
    assert [t.tolist() for t in saved.t_events] == [t.tolist() for t in trajectory.t_events]
    assert saved.event_kinds == trajectory.event_kinds
    assert saved.at_events[0].energy.tolist() == trajectory.at_events[0].energy.tolist()
    assert [event["formula"] for event in saved.metadata["events"]] == ["omega_3 == 0", "omega_1 - 100"]


def test_quantities_that_follow_from_omega_and_attitude_are_computed(trajectory, tmp_path):
    trajectory.save(tmp_path / "motion.npz", ["omega", "quaternion"])
    saved = symrot.load(tmp_path / "motion.npz")
    assert saved.dcm.tolist() == trajectory.dcm.tolist()
    assert saved.omega_space.tolist() == trajectory.omega_space.tolist()
    assert saved.euler("XYZ").tolist() == trajectory.euler("XYZ").tolist()
    with pytest.raises(InputError, match="energy: expected a file with this quantity, got a file with t, omega"):
        saved.quantity("energy")
    for samples in (saved, trajectory):
        with pytest.raises(InputError, match=r"got \['omega'\]|\['omega'\]: expected a file with this quantity"):
            samples.quantity(["omega"])
    with pytest.raises(AttributeError, match="no quantity 'energy'; it has t, omega, quaternion"):
        _ = saved.energy


def test_files_of_the_command_line_are_loaded(tmp_path):
    assert main(["run", "t_handle", "--out", str(tmp_path / "motion.npz")]) == 0
    saved = symrot.load(str(tmp_path / "motion.npz"))
    assert saved.omega.tolist() == symrot.propagate("t_handle").omega.tolist() and saved.at_events == []


def test_a_loaded_trajectory_makes_tables(path):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    saved = symrot.load(path)
    assert isinstance(saved.to_dataframe(["energy"]), pandas.DataFrame)
    assert saved.to_xarray().omega.attrs["units"] == "rad/s" and isinstance(saved.to_xarray(), xarray.Dataset)


def test_a_csv_file_lists_events(trajectory, tmp_path):
    trajectory.save(tmp_path / "motion.csv", ["omega"])
    text = (tmp_path / "motion.csv").read_text()
    assert f"t = {float(trajectory.t_events[0][0])!r} s" in text


def test_loading_needs_no_cache_no_compiler_and_no_sympy(path):
    code = (
        "import symrot, sys; saved = symrot.load(sys.argv[1]); saved.energy, saved.euler('ZXZ'), saved.at_events[0].t;"
        "print([m for m in ('sympy', 'scipy', 'symrot.propagation', 'symrot.build') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)
    assert (done.stdout.strip(), done.stderr) == ("[]", "")


def rewritten(path, change):
    """Rewrite a file of a trajectory with changed arrays and metadata."""
    with np.load(path) as content:
        arrays = {name: content[name] for name in content.files}
    metadata = json.loads(str(arrays.pop("metadata")))
    change(arrays, metadata)
    np.savez(path, metadata=np.array(json.dumps(metadata)), **arrays)


DAMAGE = {
    "fewer rows": lambda arrays, metadata: arrays.update(omega=arrays["omega"][1:]),
    "fewer columns": lambda arrays, metadata: arrays.update(omega=arrays["omega"][:, 1:]),
    "no array": lambda arrays, metadata: arrays.pop("omega"),
    "no event": lambda arrays, metadata: arrays.pop("event_1_t"),
    "texts": lambda arrays, metadata: arrays.update(omega=arrays["omega"].astype(str)),
    "no scene": lambda arrays, metadata: metadata.pop("scene"),
    "no status": lambda arrays, metadata: metadata.pop("status"),
    "no times": lambda arrays, metadata: metadata["arrays"].pop("t"),
    "no arrays": lambda arrays, metadata: metadata["arrays"].clear(),
    "arrays as a list": lambda arrays, metadata: metadata.update(arrays=[1]),
    "events as a number": lambda arrays, metadata: metadata.update(events=3),
    "no record of derivatives": lambda arrays, metadata: metadata.update(sensitivities={}),
    "no variables": lambda arrays, metadata: metadata.update(
        sensitivities={"variables": [], "units": [], "groups": {}}
    ),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_damaged_files_are_refused_in_one_sentence(path, damage):
    rewritten(path, DAMAGE[damage])
    with pytest.raises(InputError, match=r"load: expected an NPZ file written by trajectory\.save") as caught:
        symrot.load(path)
    assert "\n" not in str(caught.value)


def other_files(folder):
    (folder / "text.npz").write_text("t,omega\n")
    np.save(folder / "array.npy", np.arange(3.0))
    np.savez(folder / "arrays.npz", t=np.arange(3.0))
    np.savez(folder / "objects.npz", metadata=np.array([{"a": 1}], dtype=object))
    with zipfile.ZipFile(folder / "other.zip", "w") as archive:
        archive.writestr("a", "b")
    (folder / "empty.npz").write_bytes(b"")
    return [*sorted(folder.iterdir()), folder, folder / "missing.npz"]


def test_other_files_are_refused_in_one_sentence(tmp_path):
    for file in other_files(tmp_path):
        with pytest.raises(InputError, match="load: expected an NPZ file written by") as caught:
            symrot.load(file)
        assert "\n" not in str(caught.value) and str(file) in str(caught.value)


def test_only_a_trajectory_is_saved(path):
    many = symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2]], t=[0, 1])
    for other in (symrot.load(path), many, many[0], "t_handle"):
        with pytest.raises(InputError, match=r"save: expected a trajectory, as symrot\.propagate returns it, got "):
            symrot.save(other, path)


def test_a_truncated_file_is_refused(path):
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(InputError, match="load: expected an NPZ file"):
        symrot.load(path)


def test_a_name_that_is_no_file_of_samples_is_refused_before_anything_is_computed(trajectory, tmp_path):
    with pytest.raises(InputError, match=r"save: expected a file name that ends in \.npz, \.csv"):
        trajectory.save(tmp_path / "motion.txt")


def test_each_vector_of_a_file_is_an_attribute_also_without_omega_and_quaternion(tmp_path):
    motion = symrot.propagate("t_handle", t=[0, 0.5, 1])
    for name in ("dcm", "omega_space", "polhode", "herpolhode", "axis"):
        motion.save(tmp_path / "motion.npz", [name])
        assert np.array_equal(getattr(symrot.load(tmp_path / "motion.npz"), name), motion.quantity(name))


def test_the_table_of_a_file_says_where_an_euler_sequence_is_at_gimbal_lock(tmp_path):
    pytest.importorskip("pandas")
    motion = symrot.propagate("heavy_top_loops", t=[0, 0.5, 1])
    motion.save(tmp_path / "motion.npz", ["euler", "omega"])
    table = symrot.load(tmp_path / "motion.npz").to_dataframe(["euler", "omega"])
    assert table.equals(motion.to_dataframe(["euler", "omega"])) and "euler_lock" in table

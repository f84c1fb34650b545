"""Torques by samples in scene files: the same motion as with the argument ``torque=``, and messages on files that
cannot be read.
"""

import json

import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.scene.file import names_with_kernels, shipped_names
from symrot.scene.samples import COLUMNS, LARGEST_FILE
from symrot.scene.scene import Scene, load_scene

pytestmark = pytest.mark.usefixtures("quick_compiler")
HEAD = ", ".join(COLUMNS)
ROWS = [[0, 0.1, 0, 0.2], [1, 0.2, 0.1, 0.1], [2, 0.1, 0, 0], [3, 0, -0.1, 0], [4, 0, 0, 0.1]]
CSV = "\n".join([HEAD, *(", ".join(map(str, row)) for row in ROWS)])


def content(torque, stop=4, **tables):
    return {
        "schema": 1,
        "body": {"principal": [1, 2, 3]},
        "initial": {"omega": [0.1, 1, 0.3]},
        "torque": [torque],
        "span": {"t": [0, stop], "samples": 21},
        **tables,
    }


def table(**fields):
    return {"kind": "table", "t": [row[0] for row in ROWS], "moment": [row[1:] for row in ROWS], **fields}


def scene(stop=4, **fields):
    return Scene.from_dict(content(table(**fields), stop))


def free():
    return Scene.from_dict({key: value for key, value in content({}).items() if key != "torque"})


def written(folder, text, line='file = "moments.csv"', stop=4):
    """Write a scene and its samples; return the path of the scene."""
    if text is not None:
        (folder / "moments.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    path = folder / "pushed.toml"
    path.write_text(
        f"schema = 1\nbody.principal = [1, 2, 3]\ninitial.omega = [0.1, 1, 0.3]\nspan = {{t = [0, {stop}], samples = 21}}\n"
        f'[[torque]]\nkind = "table"\n{line}\n'
    )
    return path


@pytest.mark.parametrize("frame", ["body", "space"])
def test_a_table_in_a_scene_is_the_table_of_python(frame):
    found = symrot.propagate(scene(frame=frame))
    samples = np.array(ROWS)
    expected = symrot.propagator(free(), torque=(samples[:, 0], samples[:, 1:]), torque_frame=frame)()
    assert found.method == "dop853" and np.array_equal(found.y, expected.y)


def test_samples_of_a_polynomial_move_as_its_formula():
    """A cubic spline through samples of a cubic is that cubic, on each side of a jump."""
    before, after = (lambda t: [t**3 / 50, 0.1 * t, 0]), (lambda t: [0.2, 0, t * (4 - t) / 10])
    t = [0, 0.5, 1, 1.5, 2, 2, 2.5, 3, 3.5, 4]
    moments = [*map(before, t[:5]), *map(after, t[5:])]
    found = symrot.propagate(scene(t=t, moment=moments, switching_times=[2]))

    def formulas(torque, omega, quaternion, span):
        start = {"omega": omega, "attitude": {"quaternion": quaternion}}
        torque = {"kind": "expression", "torque": torque}
        return Scene.from_dict({**content(torque), "initial": start, "span": {"t": span, "samples": 11}})

    first = symrot.propagate(formulas(["t**3/50", "t/10", "0"], [0.1, 1, 0.3], [1, 0, 0, 0], [0, 2]))
    jump = first.y[:, -1].tolist()
    second = symrot.propagate(formulas(["1/5", "0", "t*(4 - t)/10"], jump[:3], jump[3:], [2, 4]))
    assert np.abs(found.y[:, :11] - first.y).max() < 1e-11 and np.abs(found.y[:, 10:] - second.y).max() < 1e-11


def test_a_table_acts_besides_formulas_and_from_other_starts():
    both = content(table())
    both["torque"].append({"kind": "damping", "linear": "1/5"})
    made = symrot.propagator(Scene.from_dict(both))
    assert made.scene.torque_kinds == ("damping", "table")
    plain, other = made(), made(omega=[0.1, 1, 0.3], quaternion=[0, 1, 0, 0])
    assert np.abs(plain.omega - other.omega).max() < 1e-12  # a torque in the body does not ask for the attitude
    assert np.abs(plain.omega - symrot.propagate(scene()).omega).max() > 0.1


def test_files_are_found_beside_the_scene(tmp_path, monkeypatch):
    path = written(tmp_path, CSV + "\n\n")
    monkeypatch.chdir("/")
    assert load_scene(path).table == scene().table


def test_the_shipped_scene():
    switched = {"thruster_train", "friction_wheel", "quadcopter_motor_failure"}
    assert set(shipped_names()) - set(names_with_kernels()) == {"thruster_pulse"} | switched
    found = symrot.propagate("thruster_pulse")
    quiet = found.t <= 2
    assert np.ptp(found.kinetic_energy[quiet]) < 1e-12 * found.kinetic_energy[0]  # nothing acts before the pulse
    assert np.ptp(found.kinetic_energy[found.t >= 6]) < 1e-11 * found.kinetic_energy[-1]  # nor after it
    assert found.kinetic_energy[-1] > 5 * found.kinetic_energy[0]


def test_steps_end_at_samples():
    """At samples the third derivative of the torque jumps: a step across one would miss its tolerance a hundredfold."""
    for tolerance in (1e-8, 1e-10, 1e-12):
        found, fine = (symrot.propagator("thruster_pulse", tolerance=x)([30.0]) for x in (tolerance, 1e-14))
        assert np.abs(found.y - fine.y).max() < tolerance


REFUSED = {
    "empty": (b"", "got an empty file"),
    "blank": (b"\n \n", "got an empty file"),
    "no header": (b"0, 0, 0, 0\n1, 0, 0, 0\n", "line 1: expected the columns t, M1, M2, M3"),
    "other columns": (b"t, M1, M2\n0, 0, 0\n", "line 1: expected the columns"),
    "a column short": (CSV.replace("1, 0.2, 0.1, 0.1", "1, 0.2, 0.1").encode(), "line 3: expected four finite numbers"),
    "NaN": (CSV.replace("0.2", "nan").encode(), "line 2: expected four finite numbers"),
    "infinite": (CSV.replace("-0.1", "1e999").encode(), "line 5: expected four finite numbers"),
    "words": (CSV.replace("-0.1", "none").encode(), "line 5: expected four finite numbers"),
    "not of a CSV": (CSV.replace("-0.1", "1_0").encode(), "line 5: expected four finite numbers"),
    "unsorted": (CSV.replace("\n3,", "\n1.5,").encode(), "line 5: expected increasing times, got 1.5 s after 2.0 s"),
    "unsorted after a blank line": (CSV.replace("\n3,", "\n\n1.5,").encode(), "line 6: expected increasing times"),
    "repeated": (
        CSV.replace("\n3,", "\n2,").encode(),
        "line 5: expected increasing times; only a switching time may occur twice",
    ),
    "one row": (f"{HEAD}\n0, 0, 0, 0".encode(), "two samples or more, got 1"),
    "header alone": (HEAD.encode(), "two samples or more, got 0"),
    "too short": (CSV.rsplit("\n", 1)[0].encode(), "cover the span of the scene, 0.0 to 4.0 s, got 0.0 to 3.0 s"),
    "binary": (b"\x89PNG\r\n\x1a\n\xff\x00", "expected UTF-8 text, got a byte of another encoding at position 0"),
    "zeros": (b"\0" * 1000, "line 1: expected the columns"),
    "huge": (b"0" * (LARGEST_FILE + 1), "at most 20 MB"),
    "missing": (None, "No such file"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_files_that_cannot_be_used_are_named_in_one_sentence(name, tmp_path, capsys):
    text, said = REFUSED[name]
    assert main(["run", str(written(tmp_path, text))]) == 2
    error = capsys.readouterr().err
    assert said in error and "moments.csv" in error and error.count("\n") == 1 and len(error) < 500


def test_folders_and_devices_are_no_files(tmp_path):
    for name in (".", "/dev/zero", "a\\u0000b"):
        with pytest.raises(InputError, match=r"CSV file|line of text") as refused:
            load_scene(written(tmp_path, None, f'file = "{name}"'), table_folders="/dev")
        assert str(refused.value).count("expected") == 1


@pytest.mark.parametrize("fields, said", [
    ({"t": None}, "the keys t and moment, or the key file, got moment"),
    ({"file": "moments.csv"}, "the keys t and moment, or the key file, got t and moment and file"),
    ({"t": None, "moment": None}, "the keys t and moment, or the key file, got none of them"),
    ({"t": [0, 1, 2]}, "one torque for each of the 3 times, got 5"),
    ({"t": [0, 1, 3, 2, 4]}, r"torque\[0\].t\[3\]: expected increasing times, got 2.0 s after 3.0 s"),
    ({"t": [0, 1, 1, 1, 4], "switching_times": [1]}, "two samples or more between switching times, got only one, at 1.0 s"),
    ({"t": [0, 1, 2, 4, 4], "switching_times": [4]}, "two samples or more between switching times, got only one, at 4.0 s"),
    ({"t": [0, 1, 2, 3, "nan"]}, r"t\[4\]: expected a time in s"),
    ({"moment": [[0, 0]] * 5}, r"moment\[0\]: expected three numbers"),
    ({"moment": [[0, 0, float("nan")]] * 5}, r"moment\[0\]\[2\]: expected"),
    ({"interpolation": "linear"}, 'one of "cubic_spline", got'),
    ({"frame": "orbit"}, 'one of "body", "space"'),
    ({"switching_times": 2}, "a list of times"),
    ({"switching_times": [2]}, r"switching_times: expected times that occur twice.*got 2.0 s"),
    ({"switching_times": [9]}, r"switching_times: expected times that occur twice.*got 9.0 s"),
    ({"t": [0, 1e-99, 2, 3, 4], "moment": [[0, 0, 0], [1e10, 0, 0]] + [[0, 0, 0]] * 3}, "at most 1e.100 N m/s between them"),
    ({"units": "N m"}, "one of the keys kind, t, moment, file"),
])  # fmt: skip
def test_tables_that_cannot_be_used_are_named_in_one_sentence(fields, said):
    given = {key: value for key, value in table(**fields).items() if value is not None}
    with pytest.raises(InputError, match=said):
        Scene.from_dict(content(given))


def test_two_tables_are_refused():
    both = content(table())
    both["torque"].append(table())
    with pytest.raises(InputError, match=r"torque\[1\].kind: expected at most one torque of kind table"):
        Scene.from_dict(both)


def test_no_torque_is_made_up_outside_the_samples():
    made = symrot.propagator(scene())
    with pytest.raises(InputError, match=r"expected times from 0.0 to 4.0 s, the span of the table, got 5.0 s"):
        made([1.0, 5.0])


@pytest.mark.parametrize("option", [{"method": "taylor"}, {"method": "exact"}, {"state": "ZXZ"}, {"torque": max}])
def test_options_that_need_a_formula_are_refused(option):
    with pytest.raises(InputError, match=r"without a formula|of kind table"):
        symrot.propagator(scene(), **option)


@pytest.mark.parametrize("command", [
    ["emit"], ["bench", "--quick"], ["certify"], ["bench", "--skip"], ["bench", "--stability"],
])  # fmt: skip
def test_commands_that_need_a_formula_say_so(command, capsys):
    assert main([command[0], "thruster_pulse", *command[1:]]) == 2
    error = capsys.readouterr().err
    assert ("torques that are formulas" in error or "no formula" in error) and error.count("\n") == 1


def test_run_and_explain_take_it(capsys):
    assert main(["run", "thruster_pulse", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["torques"] == ["table"] and found["method"]["name"] == "dop853"
    assert main(["explain", "thruster_pulse", "--json"]) == 0
    rows = {row["item"]: row for row in json.loads(capsys.readouterr().out)["rows"]}
    assert "jumps at 2, 6 s" in rows["torque by samples"]["why"] and not rows["attitude"]["skipped"]

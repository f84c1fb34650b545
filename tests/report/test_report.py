"""Results in files: they read back as the same numbers, with the texts that describe them."""

import json
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.cli import main as cli
from symrot.errors import InputError
from symrot.files.writing import write
from symrot.report import layout

LOCKED = """
schema = 1
title = "Through gimbal lock"
[body]
principal = [1, 2, 2.5]
[initial]
omega = [0, 0, 1]
[span]
t = [0, 1]
samples = 5
[output]
quantities = ["t_placeholder"]
"""


def _scene(tmp_path, quantities, more=""):
    path = tmp_path / "scene.toml"
    path.write_text(LOCKED.replace('["t_placeholder"]', json.dumps(quantities)) + more)
    return path


def _columns(path):
    lines = path.read_text().splitlines()
    head = next(number for number, line in enumerate(lines) if not line.startswith("#"))
    values = np.array([[float(x) for x in line.split(",")] for line in lines[head + 1 :]])
    return lines[:head], dict(zip(lines[head].split(","), values.T, strict=True))


def test_npz_holds_the_motion_and_says_what_it_is(tmp_path, capsys):
    path = tmp_path / "motion.npz"
    assert cli.main(["run", "heavy_top_loops", "--out", str(path)]) == 0
    assert f"{path}: t, omega" in " ".join(capsys.readouterr().out.split())
    motion = symrot.propagator("heavy_top_loops")()
    with np.load(path, allow_pickle=False) as found:
        about = json.loads(str(found["metadata"]))
        assert set(found.files) == {"metadata", *about["arrays"]}
        assert np.array_equal(found["t"], motion.t) and np.array_equal(found["quaternion"], motion.quaternion)
        assert np.array_equal(found["euler"], motion.euler("ZXZ", degrees=True))
        assert found["euler_lock"].dtype == bool and not found["euler_lock"].any()
    assert about["arrays"]["euler"]["unit"] == "deg"
    assert about["arrays"]["euler"]["components"] == ["euler_ZXZ_1", "euler_ZXZ_2", "euler_ZXZ_3"]
    assert about["arrays"]["omega"] | {"meaning": ""} == {
        "components": ["omega_1", "omega_2", "omega_3"], "unit": "rad/s", "frame": "body", "meaning": "",
    }  # fmt: skip
    assert about["symrot"] == symrot.__version__ and about["tolerance"] == 1e-12 and "Goldstein" in about["source"]
    assert "scalar first" in about["conventions"]


def test_csv_reads_back_to_the_same_doubles(tmp_path, capsys):
    path = tmp_path / "motion.csv"
    assert cli.main(["run", "gravity_gradient_satellite", "--out", str(path)]) == 0
    head, columns = _columns(path)
    motion = symrot.propagator("gravity_gradient_satellite")()
    assert np.array_equal(columns["t"], motion.t)
    for number in range(3):
        assert np.array_equal(columns[f"omega_{number + 1}"], motion.omega[:, number])
        assert np.array_equal(columns[f"euler_ZYX_{number + 1}"], motion.euler("ZYX", degrees=True)[:, number])
    assert any("omega_1" in line and "rad/s" in line and "body" in line for line in head)
    assert any("tolerance: 1e-12" in line for line in head) and any("Hughes" in line for line in head)


@pytest.mark.parametrize("suffix", ["npz", "csv"])
def test_every_quantity_has_its_columns_and_files_are_the_same_twice(tmp_path, capsys, suffix):
    from symrot.scene.tables import QUANTITIES

    scene = _scene(tmp_path, list(QUANTITIES), 'sequence = "zyx"\n')
    for name in ("one", "two"):
        assert cli.main(["run", str(scene), "--out", str(tmp_path / f"{name}.{suffix}")]) == 0
    assert (tmp_path / f"one.{suffix}").read_bytes() == (tmp_path / f"two.{suffix}").read_bytes()
    if suffix == "csv":
        names = list(_columns(tmp_path / "one.csv")[1])
        assert len(names) == len(set(names)) == 1 + 8 * 3 + 4 + 9 + 2 + 1


def test_gimbal_lock_is_flagged(tmp_path, capsys):
    """ZXZ is singular at the identity, where the nutation angle is zero; a spin about z stays singular."""
    scene, out = _scene(tmp_path, ["euler"], 'sequence = "ZXZ"\n'), tmp_path / "motion.csv"
    assert cli.main(["run", str(scene), "--out", str(out)]) == 0
    columns = _columns(out)[1]
    assert columns["euler_lock"].tolist() == [1.0] * 5
    total = columns["euler_ZXZ_1"] + columns["euler_ZXZ_3"]
    assert np.allclose(total, columns["t"], atol=1e-12)


def test_a_failed_write_leaves_the_earlier_file_and_nothing_else(tmp_path):
    path = tmp_path / "motion.npz"
    path.write_bytes(b"earlier")

    def full(stream):
        stream.write(b"half")
        raise OSError(28, "No space left on device")

    with pytest.raises(InputError, match="No space left"):
        write(path, full)
    assert path.read_bytes() == b"earlier" and list(tmp_path.iterdir()) == [path]


def test_a_link_keeps_pointing_to_its_file(tmp_path):
    target, link = tmp_path / "target.csv", tmp_path / "link.csv"
    target.write_bytes(b"earlier")
    link.symlink_to(target)
    write(link, lambda stream: stream.write(b"now"))
    assert link.is_symlink() and target.read_bytes() == b"now"


@pytest.mark.parametrize(("value", "said"), [
    (Fraction(51, 80), "51/80"), (Fraction(5), "5"), (Fraction(1, 3**40), repr(1 / 3**40)),
])  # fmt: skip
def test_exact_numbers_stay_exact_where_that_is_short(value, said):
    assert layout.exact(value) == said


@pytest.mark.parametrize(("seconds", "said"), [(2.5, "2.5 s"), (0.0125, "12.5 ms"), (3.2e-5, "32 us"), (0.0, "0 us")])
def test_durations_have_a_unit_that_suits_them(seconds, said):
    assert layout.duration(seconds) == said


def test_tables_align_and_wrap_one_column():
    rows = [("name", "why", "n"), ("a", "one two three four five six", "10"), ("bb", "short", "2")]
    lines = layout.columns(rows, width=31, wrap=1, right=(2,))
    assert lines == [
        "name  why                     n",
        "a     one two three four     10",
        "      five six",
        "bb    short                   2",
    ]
    assert layout.columns([]) == []


def test_text_of_a_scene_is_one_printable_line():
    assert layout.one_line("a\n b\t\x1b[31m") == "a b ?[31m"


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((0, 20), ["0", "20"]),
        ((0, 1 / 3), ["0", "0.333333"]),
        ((1e9, 1e9 + 8), ["1000000000", "1000000008"]),
        ((1e9 + 0.5, 1e9 + 8.25), ["1000000000.5", "1000000008.25"]),
        ((-1e-9, 1e9), ["-1e-09", "1e+09"]),
        ((1.0, 1.0 + 2**-52), ["1", "1.0000000000000002"]),
        ((1e6 + 1 / 7, 1e6, 1e6 + 1), ["1000000.1429", "1000000", "1000001"]),
        ((-1.7e308, 1.7e308), ["-1.7e+308", "1.7e+308"]),
        ((2.5, 2.5), ["2.5", "2.5"]),
    ],
)
def test_times_are_shown_with_the_digits_that_tell_them_apart(values, said):
    assert layout.apart(*values) == said


def test_a_run_far_from_zero_says_when_it_was(tmp_path, capsys):
    path = _scene(tmp_path, ["omega"])
    path.write_text(path.read_text().replace("t = [0, 1]", "t = [1e9, 1000000008]"))
    assert cli.main(["run", str(path)]) == 0
    text = capsys.readouterr().out
    assert "1000000000 to 1000000008 s, 5 samples" in text and "t = 1000000008 s" in text

"""The command sweep: its summary, its JSON and its sentences about bad input."""

import json

import pytest

from symrot.cli.main import main

pytest.importorskip("zarr")
pytestmark = pytest.mark.usefixtures("quick_compiler")
BASE = ["sweep", "heavy_top_loops", "--vary", "omega_1 ~ normal(0, 0.1)", "--count", "6", "--workers", "1"]


def test_the_command_writes_a_file_and_says_so(tmp_path, capsys):
    path = str(tmp_path / "a.zarr")
    assert main([*BASE, "-o", path, "--output", "omega_3@end", "--times", "linspace(0, 1, 3)"]) == 0
    assert (
        capsys.readouterr().out == f"{path}: 6 of 6 trajectories complete\n  open it with xarray.open_zarr({path!r})\n"
    )


def test_json_names_trajectories_without_a_motion(tmp_path, capsys):
    command = [
        "sweep",
        "heavy_top_loops",
        "--vary",
        "body.mass = values(1, -1)",
        "-o",
        str(tmp_path / "a.zarr"),
        "--json",
    ]
    assert main(command) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["complete"], facts["impossible"]) == (1, 1)
    assert facts["reasons"][0]["trajectory"] == 1 and "positive mass" in facts["reasons"][0]["reason"]


def test_a_full_disk_is_a_sentence_that_says_how_to_go_on(tmp_path, capsys, monkeypatch):
    pytest.importorskip("pyarrow")
    from symrot.sweeps.stores import parquet_store

    def fill(stream):
        raise OSError(28, "No space left on device")

    write = parquet_store.write
    with monkeypatch.context() as patch:
        patch.setattr(
            parquet_store, "write", lambda path, content: write(path, fill if "02." in path.name else content)
        )
        assert main([*BASE, "--chunk", "2", "-o", str(tmp_path / "a.parquet")]) == 2
    said = capsys.readouterr().err
    assert "a.parquet: No space left on device; the complete chunks are saved, run the same command again" in said
    assert main([*BASE, "--chunk", "2", "-o", str(tmp_path / "a.parquet")]) == 0


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ([], "expected the file to write"),
        (["-o", "a.csv"], "ends in .zarr, .parquet"),
        (["-o", "a.zarr", "--vary", "omega_2"], "--vary: expected 'NAME ~ DISTRIBUTION'"),
        (["-o", "a.zarr", "--vary", "omega_2 = normal(0, 1)"], "write 'omega_2 ~ normal(0, 1)'"),
        (["-o", "a.zarr", "--vary", "omega_1 ~ normal(0, 1)"], "got omega_1 a second time"),
        (["-o", "a.zarr", "--vary", "omega_9 ~ normal(0, 1)"], "did you mean 'omega_"),
        (["-o", "a.zarr", "--times", "normal(0, 1)"], "--times: expected a grid"),
        (["-o", "a.zarr", "--seed", "x"], "seed: expected a whole number"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, monkeypatch, capsys, more, message):
    monkeypatch.chdir(tmp_path)
    assert main([*BASE, *more]) == 2
    error = capsys.readouterr().err
    assert error.startswith("symrot: ") and error.count("\n") == 1 and message in error
    assert not any(tmp_path.iterdir())

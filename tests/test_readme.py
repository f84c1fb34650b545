"""README says what is so: its scene runs, its code runs, its tables are complete."""

import os
import re
import subprocess
import sys
from pathlib import Path

from symrot.cli.main import main
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.inertia.shapes import SHAPES
from symrot.scene.scene import QUANTITIES

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCENES = (ROOT / "symrot" / "scene" / "README.md").read_text(encoding="utf-8")


def block(language):
    """The first code block of a language."""
    return re.search(rf"```{language}\n(.*?)```", README, re.DOTALL)[1]


def test_the_scene_of_ones_own_runs(tmp_path, capsys):
    scene = tmp_path / "book.toml"
    scene.write_text(block("toml"), encoding="utf-8")
    assert main(["run", str(scene), "--out", str(tmp_path / "book.csv")]) == 0
    assert "A spinning book" in capsys.readouterr().out
    assert (tmp_path / "book.csv").read_text().count("\n") > 1001


def test_the_python_runs():
    done = subprocess.run([sys.executable, "-c", block("python")], capture_output=True, text=True, env=os.environ)
    assert done.returncode == 0, done.stderr


def test_the_printed_run_is_what_is_printed(capsys):
    """All of it but times, steps and the rounding of the last digits."""
    assert main(["run", "tumbling_prism"]) == 0
    printed = capsys.readouterr().out

    def stable(text):
        lines = [line for line in text.splitlines() if line.strip() and "written" not in line and "cost" not in line]
        return [re.sub(r"\d\.\de-\d\d|\d\.\d{8,}(e-\d+)?|\s+", " ", line).strip() for line in lines]

    assert stable(block("text")) == stable(printed)


def test_every_shape_torque_and_quantity_is_named():
    for name in [*SHAPES, *TORQUE_KINDS, *QUANTITIES]:
        assert f"`{name}`" in SCENES, name

"""The command line: what it prints, to which stream, and with which exit code."""

import json
import os
import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import symrot
from symrot.cli import main as cli
from symrot.workshop import kernel_files as kernels
from symrot.workshop.derivation_pages import illustrated
from symrot.workshop.doctor import EXTRAS
from tests.bad_scenes import bad_scenes

ROOT = Path(symrot.__file__).parents[1]


def run(capsys, *words):
    """Return a function that runs a command and returns exit code, standard output and standard error."""
    code = cli.main([str(word) for word in words])
    said = capsys.readouterr()
    return code, said.out, said.err


def refused(capsys, *words):
    """Return a function that runs a command and returns the one sentence with which it is refused."""
    code, out, err = run(capsys, *words)
    assert (code, out) == (2, "")
    assert err.startswith("symrot: ") and err.count("\n") == 1 and "Traceback" not in err
    return err


def process(*words, **options):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **options.pop("env", {})}
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, env=environment, **options)


# --- run ----------------------------------------------------------------------------------------------------------------


def test_run_says_body_method_cost_and_what_is_kept(capsys):
    code, out, err = run(capsys, "run", "tumbling_prism")
    assert (code, err) == (0, "")
    for said in ("Tumbling prism", "Brown University", "asymmetric", "5, 20, 17 kg m^2", "exact", "1e-12", "no steps",
                 "closed form", "no torque acts", "energy", "8.501 J", "t = 20 s", "nothing; --out"):  # fmt: skip
        assert said in out
    assert max(map(len, out.splitlines())) <= 112 and len(out.splitlines()) <= 32


def test_run_as_json_agrees_with_the_motion(capsys):
    code, out, _ = run(capsys, "run", "chen_cylinder", "--json")
    found, motion = json.loads(out), symrot.propagator("chen_cylinder")()
    assert code == 0
    assert found["body"]["principal_moments"] == ["51/80", "51/80", "3/40"]
    assert found["body"]["class"] == "symmetric"
    assert found["final"]["omega"] == motion.omega[-1].tolist()
    assert found["final"]["quaternion"] == motion.quaternion[-1].tolist()
    assert [item["drift"] for item in found["invariants"]] == [item.drift for item in motion.invariants]
    assert found["cost"]["steps"] == motion.stats.accepted


def test_tolerance_and_method_are_obeyed(capsys):
    loose = json.loads(run(capsys, "run", "tumbling_prism", "--method", "dop853", "--tolerance", "1e-4", "--json")[1])
    assert loose["method"]["tolerance"] == 1e-4 and loose["cost"]["steps"] < 60
    scipy = json.loads(run(capsys, "run", "tumbling_prism", "--tolerance", "1e-6", "--method", "scipy", "--json")[1])
    assert scipy["method"]["name"] == "scipy"
    assert np.allclose(scipy["final"]["omega"], loose["final"]["omega"], atol=1e-2)


def test_what_is_not_conserved_is_said(capsys):
    _, out, _ = run(capsys, "run", "damped_disk")
    assert "not kept" in out and "damping" in out


# --- bad use ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("words", "said"), [
    (["rnu"], "did you mean 'run'?"),
    (["run"], "SCENE"),
    (["run", "tumbling_prsm"], "did you mean 'tumbling_prism'?"),
    (["run", "tumbling_prism", "--fast"], "--fast"),
    (["run", "tumbling_prism", "--tol", "1e-3"], "--tol"),
    (["run", "tumbling_prism", "--method", "rk4"], "'rk4'"),
    (["run", "tumbling_prism", "--method", "scipy:RK5"], "RK5"),
    (["run", "tumbling_prism", "--tolerance", "0"], "1e-15"),
    (["run", "tumbling_prism", "--tolerance", "nan"], "tolerance"),
    (["run", "tumbling_prism", "--tolerance", "small"], "small"),
    (["run", "tumbling_prism", "--out", "motion.txt"], ".npz, .csv"),
    (["run", "tumbling_prism", "--out", "motion"], ".npz, .csv"),
    (["run", "tumbling_prism", "--plot", "motion.gif"], ".png, .pdf, .svg"),
    (["run", "tumbling_prism", "--out", "nowhere/motion.npz"], "nowhere/motion.npz"),
    (["run", "tumbling_prism", "--out", "x" * 300 + ".npz"], "name"),
    (["run", "."], "folder"),
    (["run", ""], "scene"),
    (["emit"], "exactly one of"),
    (["emit", "tumbling_prism", "--all"], "exactly one of"),
    (["emit", "tumbling_prism", "--target", "fortran"], "fortran"),
    (["emit", "--check", "-o", "nowhere"], "nowhere"),
    (["explain", "nothing_like_it"], "nothing_like_it"),
    (["derive", "nothing_like_it"], "nothing_like_it"),
    (["derive", "--all", "--check"], "at most one of"),
    (["derive", "--check", "-o", "nowhere"], "nowhere"),
], ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else "")  # fmt: skip
def test_bad_use_is_one_sentence(capsys, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    assert said in refused(capsys, *words)
    assert not any(tmp_path.iterdir())


def _bad():
    return [pytest.param(item, id=item[0]) for item in bad_scenes()]


@pytest.mark.thinned(3)
@pytest.mark.parametrize("item", _bad())
def test_bad_scenes_are_one_sentence_and_leave_outputs_alone(capsys, tmp_path, item):
    _, content, _ = item
    scene, out = tmp_path / "bad.toml", tmp_path / "out.npz"
    scene.write_bytes(content)
    out.write_bytes(b"earlier")
    sentence = refused(capsys, "run", scene, "--out", out)
    assert "bad.toml" in sentence
    assert out.read_bytes() == b"earlier"


def test_no_command_shows_the_help(capsys):
    code, out, err = run(capsys)
    assert code == 2 and out == "" and "tumbling_prism" in err


# --- the others ---------------------------------------------------------------------------------------------------------


def test_scenes_are_listed(capsys):
    code, out, _ = run(capsys, "scenes")
    assert code == 0 and len(out.splitlines()) == len(symrot.shipped_scenes())
    found = json.loads(run(capsys, "scenes", "--json")[1])
    assert [(item["name"], item["title"], item["source"]) for item in found] == symrot.shipped_scenes()


def test_explain_counts_what_each_rule_saves(capsys):
    code, out, err = run(capsys, "explain", "heavy_top_loops", "--json")
    found = json.loads(out)
    ladder = [row for row in found["rows"] if row["operations"] is not None]
    totals = [sum(row["operations"].values()) for row in ladder]
    assert (code, err) == (0, "")
    assert [row["saved"] for row in ladder[1:]] == [a - b for a, b in pairwise(totals)]
    assert (totals[0], totals[-1]) == (found["operations"]["general"], found["operations"]["specialised"])
    assert totals[-1] < totals[0]


def test_explain_is_a_table_and_that_of_the_plan(capsys):
    code, out, _ = run(capsys, "explain", "tumbling_prism")
    assert code == 0
    for said in ("products of inertia", "skipped", "kept", "euler_equations", "mul", "not asked for: omega_space"):
        assert said in out
    kept = "deriving the kernel"  # depends on the cache
    assert out.partition(kept)[0] == symrot.explain("tumbling_prism").partition(kept)[0]


def test_emit_prints_what_the_library_emits(capsys):
    found = symrot.emit("t_handle", target="c")
    assert run(capsys, "emit", "t_handle")[:2] == (0, f"{found.header}\n{found.source}")
    assert run(capsys, "emit", "t_handle", "--target", "numpy")[1] == symrot.emit("t_handle", target="numpy").source


def test_emitted_files_compile_together(capsys, tmp_path):
    code, out, _ = run(capsys, "emit", "gyrostat", "-o", tmp_path / "new" / "folder")
    assert code == 0
    assert [Path(line).name for line in out.splitlines()] == [
        "gyrostat_rates.h",
        "gyrostat_rates.c",
        "gyrostat_rates.cert.json",
    ]
    source = tmp_path / "new" / "folder" / "gyrostat_rates.c"
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-c", str(source), "-o", os.devnull]
    assert subprocess.run(command, capture_output=True, text=True).stderr == ""


def test_stale_kernels_are_shown_as_a_diff(capsys, monkeypatch, tmp_path):
    """Only a few kernels are tested; `.ci/run` runs `symrot emit --check` on all kernels."""
    monkeypatch.setattr(kernels, "kernel_names", lambda: ("quaternion_dcm",))
    monkeypatch.setattr(kernels, "names_with_kernels", lambda: ("t_handle",))
    assert run(capsys, "emit", "--all", "-o", tmp_path)[0] == 0
    assert run(capsys, "emit", "--check", "-o", tmp_path) == (0, "", "")
    assert run(capsys, "emit", "--all", "-o", tmp_path) == (0, "", "")
    changed, gone = tmp_path / "c/scenes/t_handle_rates.c", tmp_path / "numpy/scenes/t_handle_rates.py"
    changed.write_text(changed.read_text() + "/* by hand */\n")
    gone.unlink()
    extra, others = tmp_path / "c/scenes/of_no_scene.h", tmp_path / "c/main.c"
    extra.write_text(changed.with_suffix(".h").read_text())
    others.write_text("int main(void) { return 0; }\n")
    code, out, _ = run(capsys, "emit", "--check", "-o", tmp_path)
    assert code == 1
    assert "-/* by hand */" in out and "+def t_handle_rates" in out and "of_no_scene.h (on disk)" in out
    assert run(capsys, "emit", "--all", "-o", tmp_path)[0] == 0
    assert not extra.exists() and run(capsys, "emit", "--check", "-o", tmp_path)[0] == 0
    assert others.exists()  # a file that symrot did not print


def test_derivations_are_listed_and_printed(capsys):
    names = run(capsys, "derive")[1].split()
    assert "parallel_axis" in names
    page = illustrated(symrot.derivation("parallel_axis"))
    assert run(capsys, "derive", "parallel_axis")[1] == page.markdown()
    assert run(capsys, "derive", "parallel_axis", "--format", "latex")[1] == page.latex()


def test_doctor_lists_every_extra_and_its_own_packages():
    with (ROOT / "pyproject.toml").open("rb") as stream:
        extras = tomllib.load(stream)["project"]["optional-dependencies"]
    assert set(EXTRAS) == set(extras) - {"docs"}
    for name, packages in EXTRAS.items():
        assert set(packages) <= {requirement.split(">")[0] for requirement in extras[name]}


def test_doctor_compiles_and_tells_of_a_broken_compiler(capsys, monkeypatch, tmp_path):
    code, out, _ = run(capsys, "doctor", "--json")
    found = json.loads(out)
    assert code == 0 and found["problems"] == [] and found["compiler"]["version"] and found["needed"]["sympy"]
    assert "all is well" in run(capsys, "doctor")[1]
    broken = tmp_path / "cc"
    broken.write_text("#!/bin/sh\necho 'error: out of order' >&2\nexit 1\n")
    broken.chmod(0o755)
    for compiler, said in ((broken, "out of order"), ("no-such-compiler", "no-such-compiler")):
        monkeypatch.setenv("CC", str(compiler))
        code, out, _ = run(capsys, "doctor")
        assert code == 1 and said in out


def test_the_cache_is_cleared(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path))
    run(capsys, "run", "tumbling_prism")
    assert json.loads(run(capsys, "doctor", "--json")[1])["cache"]["files"] > 0
    assert "removed" in run(capsys, "doctor", "--clear-cache")[1]
    assert json.loads(run(capsys, "doctor", "--json")[1])["cache"]["files"] == 0


# --- as a process -------------------------------------------------------------------------------------------------------


def test_a_warm_run_imports_no_sympy_scipy_or_matplotlib():
    process("-m", "symrot", "run", "tumbling_prism")
    listed = "import sys; from symrot.cli.main import main; main(['run', 'tumbling_prism']); print(*sys.modules)"
    done = process("-c", listed)
    loaded = {name.partition(".")[0] for name in done.stdout.splitlines()[-1].split()}
    assert "numpy" in loaded and not loaded & {"sympy", "scipy", "matplotlib", "mpmath"}


@pytest.mark.parametrize("words", [["--help"], ["--version"], ["scenes"], ["run", "nothing"], ["rnu"]], ids=" ".join)
def test_small_things_import_no_numpy(words):
    listed = (
        f"import sys; from symrot.cli.main import main\ntry: main({words!r})\nfinally: sys.exit('numpy' in sys.modules)"
    )
    assert process("-c", listed).returncode == 0


def test_exit_codes_of_processes(tmp_path):
    assert process("-m", "symrot", "scenes").returncode == 0
    done = process("-m", "symrot", "run", "nothing_like_it")
    assert (done.returncode, done.stdout) == (2, "") and done.stderr.startswith("symrot: nothing_like_it")


def test_a_reader_that_leaves_early_is_no_error():
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "symrot", "scenes"], stdout=writer, stderr=subprocess.PIPE, cwd=ROOT
        )
    finally:
        os.close(writer)
    assert (done.returncode, done.stderr) == (141, b"")


def test_an_interrupt_is_quiet(capsys, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(symrot, "load_scene", interrupted)
    assert run(capsys, "run", "tumbling_prism") == (130, "", "")


def test_letters_that_the_terminal_lacks_are_no_error(tmp_path):
    scene = tmp_path / "scene.toml"
    text = (ROOT / "symrot/scene/shipped/tumbling_prism.toml").read_text(encoding="utf-8")
    scene.write_text(text.replace('title = "', 'title = "Kreisel \N{GREEK SMALL LETTER OMEGA} '), encoding="utf-8")
    done = process("-m", "symrot", "run", str(scene), env={"PYTHONIOENCODING": "ascii"})
    assert done.returncode == 0 and "Kreisel ?" in done.stdout


def test_bold_only_on_a_terminal_that_wants_it(monkeypatch):
    from io import StringIO

    from symrot.report.layout import emphasis

    class Terminal(StringIO):
        def isatty(self):
            return True

    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert emphasis("x", Terminal()) == "\x1b[1mx\x1b[0m" and emphasis("x", StringIO()) == "x"
    monkeypatch.setenv("NO_COLOR", "1")
    assert emphasis("x", Terminal()) == "x"


def test_a_pipe_or_device_is_no_place_for_an_output(tmp_path, capsys):
    """A renamed file would replace it."""
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    assert cli.main(["run", "chen_cylinder", "--out", str(pipe)]) == 2
    assert "device or pipe" in capsys.readouterr().err and pipe.is_fifo()


def test_an_output_keeps_the_permissions_of_the_file_it_replaces(tmp_path):
    target = tmp_path / "motion.csv"
    target.touch(mode=0o600)
    assert cli.main(["run", "chen_cylinder", "--out", str(target)]) == 0
    assert target.stat().st_mode & 0o777 == 0o600 and target.stat().st_size > 1000


@pytest.mark.parametrize(("closed", "code"), [(">&-", 0), ("2>&-", 0)])
def test_a_closed_stream_is_no_failure(closed, code):
    command = f"{sys.executable} -m symrot run chen_cylinder {closed}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == code and "Traceback" not in done.stderr


def test_hostile_keys_and_formulas_are_one_sentence(tmp_path, capsys):
    scene = tmp_path / "bad.toml"
    scene.write_text(".".join(["a"] * 5000) + " = 1\n")
    assert cli.main(["run", str(scene)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    good = 'schema = 1\ntitle = "x"\n[body]\nprincipal = [1, 2, 3]\n[initial]\nomega = [1, 1, 1]\n[span]\nt = [0, 1]\n[[torque]]\nkind = "expression"\n'
    for formula in ("1/0", "1/(2 - 2)", "0**-1", "t/(t - t)"):
        scene.write_text(f'{good}torque = ["{formula}", "0", "0"]\n')
        assert cli.main(["run", str(scene)]) == 2
        assert "divides by zero" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [("emit", "--list"), ("bound", "quaternion_product")])
def test_lists_and_bounds_fit_a_terminal_of_80_columns(arguments, monkeypatch, capsys):
    monkeypatch.setattr(kernels, "kernel_names", lambda: ("quaternion_dcm", "quaternion_of_dcm", "quaternion_product"))
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    assert cli.main(list(arguments)) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) > 4 and max(map(len, lines)) <= 80

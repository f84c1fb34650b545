"""External programs that hang, cannot start or start others: each wait ends, with one sentence."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from symrot.certificates.coq import check as coq_check
from symrot.certificates.object_code import build as object_code_build
from symrot.certificates.object_code import disassembly
from symrot.certificates.tools import run_tool
from symrot.cli.main import main
from symrot.errors import CompilerError

KERNEL = Path(__file__).parents[2] / "generated" / "c" / "quaternion_dcm.c"


@pytest.fixture
def hanging(tmp_path, monkeypatch):
    """Put programs named gcc, clang, objdump and coqc first on the path; each starts another program and waits for it."""
    for name in ("gcc", "clang", "objdump", "coqc"):
        program = tmp_path / name
        program.write_text(f"#!/bin/sh\nsleep 100 &\necho $! >> {tmp_path}/pids\nwait\n")
        program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    return tmp_path


WAITS = {
    "version": (object_code_build, "SECONDS_TO_ANSWER", lambda place: object_code_build.compiler_version("gcc")),
    "compile": (object_code_build, "SECONDS",
                lambda place: object_code_build.compile_object("gcc", ["-O2"], KERNEL, place / "k.o")),
    "objdump": (disassembly, "SECONDS", lambda place: disassembly._objdump(place / "gcc", "-t")),
    "coqc": (coq_check, "SECONDS_TO_ANSWER", lambda place: coq_check.coq_version("coqc")),
}  # fmt: skip


@pytest.mark.parametrize("wait", WAITS)
def test_a_program_that_hangs_is_stopped_with_all_that_it_started(wait, hanging, monkeypatch):
    module, limit, call = WAITS[wait]
    monkeypatch.setattr(module, limit, 0.5)
    start = time.perf_counter()
    with pytest.raises(CompilerError, match=r"was stopped, because it did not end within 0\.5 s"):
        call(hanging)
    assert time.perf_counter() - start < 20
    for pid in map(int, (hanging / "pids").read_text().split()):
        assert _gone(pid)


def _gone(pid):
    for _ in range(200):
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def test_a_theorem_whose_check_hangs_is_not_checked(hanging):
    complaint, printed = coq_check._compile("coqc", hanging, "rotation", 0.5)
    assert "it did not end within 0.5 s" in complaint and printed == ""


def test_the_command_ends_in_a_sentence_when_a_compiler_hangs(hanging, monkeypatch, capsys):
    monkeypatch.setattr(object_code_build, "SECONDS_TO_ANSWER", 0.5)
    assert main(["certify", "quaternion_dcm", "--objects"]) == 2
    assert "was stopped, because it did not end within 0.5 s" in capsys.readouterr().err


def test_a_program_that_cannot_be_run_is_named(tmp_path):
    (tmp_path / "gcc").write_text("no program")
    with pytest.raises(CompilerError, match="gcc cannot be started: Permission denied"):
        run_tool([str(tmp_path / "gcc")], 1)


def test_what_a_program_says_comes_back():
    done = run_tool([sys.executable, "-c", "import sys; print(1); sys.exit('\xe9')"], 60, environment={**os.environ})
    assert (done.returncode, done.stdout) == (1, "1\n")
    assert isinstance(done, subprocess.CompletedProcess) and done.stderr

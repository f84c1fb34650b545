"""The self-test refuses machines that round otherwise, flush to zero, contract or have a poor libm; C programs imitate
them.
"""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from mpmath import mp, mpf, workdps

from symrot.build import cache as library
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.selftest import LIBM_ULP as TESTED
from symrot.certificates.selftest import NAMES, run_selftest, selftest_files
from symrot.cli import main as cli

GENERATED = Path(__file__).parents[2] / "generated" / "c"
needs_compiler = pytest.mark.skipif(bool(library.missing()), reason="needs a C compiler")
needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")

PROGRAM = """#include <stdio.h>
#include <math.h>
#include "symrot_selftest.h"
%s
int main(void)
{
    double ulps[SYMROT_SELFTEST_FUNCTIONS];
    int failure;
%s
    failure = symrot_selftest(%d, ulps);
    printf("%%d\\n%%s\\n", failure, symrot_selftest_sentence(failure));
    return failure != 0;
}
"""


def ran(directory, before="", during="", bits=1, compiler=("gcc", "-std=c99"), flags=("-O2", "-ffp-contract=off")):
    """Compile the printed self-test into a program, and return its number and sentence."""
    for name, text in selftest_files().items():
        (directory / name).write_text(text)
    (directory / "main.c").write_text(PROGRAM % (before, during, bits))
    command = [*compiler, *flags, "main.c", "symrot_selftest.c", "-o", "program", "-lm"]
    built = subprocess.run(command, cwd=directory, capture_output=True, text=True)
    if built.returncode:
        return -1, built.stderr
    done = subprocess.run([directory / "program"], capture_output=True, text=True)
    number, sentence = done.stdout.splitlines()
    assert done.returncode == (int(number) != 0)
    return int(number), sentence


@needs_gcc
@pytest.mark.parametrize(
    "compiler", [("gcc", "-std=c99"), ("gcc", "-std=c99", "-O3", "-march=native"), ("clang", "-std=c99"),
                 ("g++", "-x", "c++", "-std=c++17")], ids=str
)  # fmt: skip
def test_a_sound_machine_passes_without_a_warning(tmp_path, compiler):
    if shutil.which(compiler[0]) is None:
        pytest.skip(f"needs {compiler[0]}")
    warnings = ("-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Wconversion", "-Werror")
    assert ran(tmp_path, compiler=compiler, flags=warnings) == (0, "the machine computes as the certificates assume")


@needs_gcc
@pytest.mark.parametrize("mode", ["FE_UPWARD", "FE_DOWNWARD", "FE_TOWARDZERO"])
def test_other_rounding_modes_are_refused(tmp_path, mode):
    number, sentence = ran(tmp_path, "#include <fenv.h>", f"    fesetround({mode});", flags=("-O2", "-frounding-math"))
    assert number == 1 and "expected rounding to nearest" in sentence


@needs_gcc
@pytest.mark.parametrize("bit", ["0x8000", "0x0040"], ids=["flush to zero", "denormals are zero"])
def test_flushing_to_zero_is_refused(tmp_path, bit):
    during = f"    _mm_setcsr(_mm_getcsr() | {bit});"
    number, sentence = ran(tmp_path, "#include <xmmintrin.h>", during)
    assert number == 2 and "flushes them to zero" in sentence


@needs_gcc
def test_flushing_is_seen_by_computing_too(tmp_path):
    """The test does not read the processor's control register, as on a machine that has none."""
    for name, text in selftest_files().items():
        (tmp_path / name).write_text(text.replace("defined(__SSE2__)", "0"))
    (tmp_path / "main.c").write_text(PROGRAM % ("#include <xmmintrin.h>", "    _mm_setcsr(_mm_getcsr() | 0x8000);", 1))
    subprocess.run(["gcc", "-O2", "main.c", "symrot_selftest.c", "-o", "p", "-lm"], cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "p"], capture_output=True, text=True).stdout.startswith("2\n")


@needs_gcc
@pytest.mark.skipif(
    not Path("/proc/cpuinfo").exists() or " fma " not in Path("/proc/cpuinfo").read_text(), reason="needs FMA"
)
def test_contraction_is_refused_where_the_bits_are_wanted(tmp_path):
    flags = ("-O2", "-mfma", "-ffp-contract=fast")
    number, sentence = ran(tmp_path, flags=flags, compiler=("gcc",))
    assert number == 3 and "-ffp-contract=off" in sentence
    assert ran(tmp_path, bits=0, flags=flags, compiler=("gcc",))[0] == 0


@needs_gcc
@pytest.mark.parametrize(
    ("name", "real", "number"), [("sin", "double", 4), ("cos", "double", 5), ("sinf", "float", 8), ("cosf", "float", 9)]
)
def test_a_function_that_errs_by_three_ulp_is_refused(tmp_path, name, real, number):
    """A function in the program replaces that of libm and returns a value that is wrong by three ulp."""
    step = "nextafter" if real == "double" else "nextafterf"
    whole = {"sin": "sinl", "cos": "cosl", "sinf": "sin", "cosf": "cos"}[name]
    fake = (
        f"{real} {name}({real} x)\n{{\n    volatile {real} y = ({real}){whole}(x);\n"
        f"    for (int i = 0; i < 3; ++i) {{ y = {step}(y, ({real})10); }}\n    return y;\n}}"
    )
    output = ran(tmp_path, fake, flags=("-O2", "-ffp-contract=off", "-fno-builtin"))
    assert output == (number, f"expected {name} to have an error of at most 1 ulp: on this machine its error is larger")


@needs_gcc
@pytest.mark.parametrize(
    ("flag", "reason"), [("-ffast-math", "-ffast-math"), ("-Ofast", "-Ofast"), ("-mfpmath=387", "FLT_EVAL_METHOD 0")]
)
def test_flags_that_void_certificates_do_not_compile(tmp_path, flag, reason):
    number, complaint = ran(tmp_path, flags=("-O2", flag))
    assert number == -1 and "symrot: expected" in complaint and reason in complaint


def test_the_stored_values_are_rounded_correctly():
    """In each row of each table, value + rest*ulp equals the function, computed by mpmath at another precision."""
    text = selftest_files()["symrot_selftest.c"]
    rows = 0
    for name in NAMES:
        digits = 24 if name.endswith("f") else 53
        table = re.search(rf"symrot_points_of_{name}\[\] = {{\n(.*?)\n}};", text, re.DOTALL)[1]
        for row in table.split("\n"):
            y, x, value, rest, ulp = (float(item) for item in row.strip(" {},").split(", "))
            with workdps(90):
                bare = name.removesuffix("f")
                exact = mp.atan2(mpf(y), mpf(x)) if bare == "atan2" else getattr(mp, bare)(mpf(x))
                assert abs((exact - mpf(value)) / mpf(ulp)) <= mpf("0.5")
                assert abs(mpf(value) + mpf(rest) * mpf(ulp) - exact) <= mpf(ulp) * mpf("1e-6")
                assert mpf(2) ** (digits - 1) <= abs(exact) / mpf(ulp) < mpf(2) ** digits
            rows += 1
    assert rows > 200


def test_the_assumption_is_the_one_of_the_error_bounds():
    assert TESTED == LIBM_ULP


def test_the_printed_files_are_those_of_the_library():
    for name, text in selftest_files().items():
        assert (GENERATED / name).read_text() == text
        assert all(len(line) <= 120 for line in text.splitlines())


@needs_compiler
def test_this_machine_passes_and_the_errors_are_shown(capsys):
    result = run_selftest()
    assert result.passed, result.sentence
    assert list(result.ulps) == list(NAMES) and all(0 < ulp < 1 for ulp in result.ulps.values())
    assert cli.main(["selftest", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["passed"] and facts["ulps"] == result.ulps
    assert cli.main(["selftest"]) == 0
    assert capsys.readouterr().out.startswith("good: the machine computes as the certificates assume\n")


@needs_compiler
def test_a_library_that_changed_this_process_is_found_out():
    """The command tests its own thread, in which this test has set rounding upward."""
    code = (
        "import ctypes, ctypes.util, sys\n"
        "from symrot.cli import main as cli\n"
        "libm = ctypes.CDLL(ctypes.util.find_library('m'))\n"
        "if libm.fesetround(0x800): sys.exit(77)\n"
        "sys.exit(cli.main(['selftest']))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    if done.returncode == 77 or sys.platform != "linux":
        pytest.skip("another name of the rounding mode here")
    assert done.returncode == 1 and done.stdout.startswith("refused: expected rounding to nearest"), done


def test_without_a_compiler_one_sentence_says_so(monkeypatch, capsys):
    monkeypatch.setenv("CC", "no_such_compiler")
    assert cli.main(["selftest"]) == 2
    assert capsys.readouterr().err.endswith("CC='no_such_compiler' names no program; set CC to one\n")

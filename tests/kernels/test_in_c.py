"""Kernels in a user's program: C99 and C++17 without warnings, vectorised batches, sine and cosine within 1 ulp."""

import ctypes
import os
import shutil
import struct
import subprocess
from pathlib import Path

import mpmath
import numpy as np
import pytest

from symrot.bench import ulps
from symrot.cli.main import main
from symrot.codegen.printing.build_files import FLAGS, build_files
from symrot.codegen.printing.c_source import c_functions
from symrot.codegen.printing.math_header import FAR, math_header

ROOT = Path(__file__).parents[2]
KERNELS = ROOT / "generated" / "c"
EXAMPLE = ROOT / "tests" / "example" / "program.c"
HARNESS = ROOT / "tests" / "reference" / "sine_harness.c"
STRICT = ["-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Werror", f"-I{KERNELS}"]
USED = ("quaternion_dcm", "euler_zyx_body_rates", "heavy_top")
COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
needs_cc = pytest.mark.skipif(not COMPILERS, reason="needs gcc or clang")


def compiled(*arguments):
    return subprocess.run(list(map(str, arguments)), check=True, capture_output=True, text=True)


@pytest.mark.thinned(3)
@needs_cc
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("language", [["-x", "c", "-std=c99"], ["-x", "c++", "-std=c++17"]], ids=["c99", "c++17"])
def test_a_program_of_ones_own_builds_and_runs(compiler, language, tmp_path):
    if "c++" in language and not shutil.which({"gcc": "g++", "clang": "clang++"}[compiler]):
        pytest.skip("needs a C++ compiler")
    program = tmp_path / "program"
    files = [EXAMPLE, *(KERNELS / f"{name}.c" for name in USED)]
    compiled(compiler, *language, "-O2", *STRICT, *files, "-o", program, "-lm")
    assert compiled(program).stdout == "kernels agree\n"


@pytest.mark.thinned(4)
@needs_cc
@pytest.mark.parametrize("name", ["euler_zxz_body_rates", "euler_zyx_dcm", "rotation_vector_body_jacobian", "rotation_vector_space_rates",
                                  "rotation_vector_dcm", "rotation_vector_of_quaternion", "euler_zyx_of_quaternion",
                                  "euler_zxz_of_quaternion", "quaternion_of_dcm", "mrp_shadow", "heavy_top", "rigid_body_tensor", "quaternion_dcm"])  # fmt: skip
def test_compilers_vectorise_batches(name, tmp_path):
    """Compilers vectorise the loops of double and of float, with sine, cosine and arc tangent in them."""
    told = {"gcc": ["-O3", "-fopt-info-vec-optimized"], "clang": ["-O2", "-Rpass=loop-vectorize"]}
    for compiler in COMPILERS:
        found = compiled(compiler, "-std=c99", "-fno-math-errno", *told[compiler], "-c", KERNELS / f"{name}.c", "-o",
                         tmp_path / "x.o")  # fmt: skip
        places = {
            line.split(":")[1] for line in found.stderr.splitlines() if "vectorized l" in line or "loop vec" in line
        }
        assert len(places) >= 2, (compiler, found.stderr)


@pytest.mark.thinned(2)
@pytest.mark.skipif("clang" not in COMPILERS, reason="needs clang, which warns of loops that it was told to vectorise")
@pytest.mark.parametrize(
    "flags", [["-O1"], ["-O2"], ["-O1", "-fno-math-errno"], ["-Os", "-fno-math-errno"]], ids=" ".join
)
def test_clang_warns_of_no_loop(flags, tmp_path):
    """Loops with functions that may set errno cannot be vectorised; the text may not ask for it, or clang would warn."""
    for name in ("quaternion_of_dcm", "torque_damping_quadratic", "rotation_vector_body_rates", "rodrigues_quaternion"):
        compiled("clang", "-std=c99", *flags, *STRICT, "-c", KERNELS / f"{name}.c", "-o", tmp_path / "x.o")


def harness(directory, *flags):
    (directory / "symrot_math.h").write_text(math_header())
    library = directory / "sine.so"
    compiled(COMPILERS[0], "-std=c99", "-O2", *flags, f"-I{directory}", "-shared", "-fPIC", HARNESS, "-o", library,
             "-lm")  # fmt: skip
    found = ctypes.CDLL(str(library))
    for name in ("symrot_worst_double", "symrot_worst_float", "symrot_worst_at_multiples"):
        getattr(found, name).restype = ctypes.c_double
    found.symrot_worst_double.argtypes = (ctypes.c_ulonglong, ctypes.c_double, ctypes.c_ulonglong)
    found.symrot_worst_at_multiples.argtypes = (ctypes.c_ulonglong,)
    found.symrot_worst_float.argtypes = (ctypes.c_uint32, ctypes.c_uint32)
    return found


def bits(value):
    return struct.unpack("I", struct.pack("f", value))[0]


CONTRACTION = [["-ffp-contract=off"], ["-ffp-contract=fast", "-march=native"]]
MULTIPLES = int(FAR["binary64"] * 2 / np.pi)


@needs_cc
@pytest.mark.parametrize("flags", CONTRACTION, ids=["unfused", "fused"])
def test_sine_and_cosine_are_within_one_unit_in_the_last_place(flags, tmp_path):
    """References are 64-bit sines; arguments include doubles next to multiples of pi/2, where digits cancel."""
    found = harness(tmp_path, *flags)
    assert found.symrot_worst_at_multiples(MULTIPLES) <= 1
    assert found.symrot_worst_double(50_000, float(FAR["binary64"]), 7) <= 1
    assert found.symrot_worst_double(50_000, 4.0, 8) <= 1
    assert found.symrot_worst_float(bits(0.75), bits(0.8)) <= 1


@needs_cc
@pytest.mark.campaign
@pytest.mark.parametrize("flags", CONTRACTION, ids=["unfused", "fused"])
def test_sine_and_cosine_campaign(flags, tmp_path):
    """Ten million doubles in range, and every float in range."""
    found = harness(tmp_path, *flags)
    assert found.symrot_worst_double(5_000_000, float(FAR["binary64"]), 1) <= 1
    assert found.symrot_worst_double(5_000_000, 4.0, 2) <= 1
    assert found.symrot_worst_float(0, bits(float(FAR["binary32"])) + 1) <= 1


@needs_cc
def test_what_kernels_call_is_within_its_stated_error(monkeypatch):
    """One sample and a batch, double and float: 4 ulp at removable singularities, 1 ulp elsewhere."""
    points = ulps._points
    monkeypatch.setattr(ulps, "_points", lambda *given: points(*given)[:, ::3])
    found = list(ulps.measured(80, ("fused",)))
    both, batch = ({"one", "batch"}, {"batch"})
    stated = {"sinc": both, "sine_gap": both, "tangent_gap": both, "tangent_gap >pi": both, "arc_ratio": both,
              "sine_bend": both, "tangent_bend": both, "tangent_bend >pi": both,
              "sin": batch, "cos": batch, "atan2": batch}  # fmt: skip
    assert {(row.name, row.real, row.form) for row in found} == {
        (name, real, form) for name, forms in stated.items() for real in ("double", "float") for form in forms
    }
    assert [row for row in found if not row.ulp <= (1 if row.name in ("sin", "cos", "atan2") else 4)] == []


@needs_cc
def test_arc_tangents_at_zeros_and_beyond_numbers():
    """Signed zeros as in C, axes and diagonals to the last bit, and NaN for NaN."""
    text = ulps._text("rotation_vector_of_quaternion")
    loaded = ctypes.CDLL(str(ulps.cache.build(text, "ulps", ulps.FLAGS)))
    sides = (0.0, -0.0, 1.0, -1.0, 3.0, -3.0)
    given = np.array([(y, x) for y in sides for x in sides if abs(y) == abs(x) or not y * x]).T
    for real, kind in ((ulps.DOUBLE, np.float64), (ulps.FLOAT, np.float32)):
        found = np.array(ulps._called(loaded, f"batch_atan2{real.suffix}", given, real))
        wanted = (
            np.arctan2(*given).astype(kind).astype(float)
        )  # NumPy's own for float32 is off by a bit on some machines
        assert np.array_equal(found, wanted) and np.array_equal(np.signbit(found), np.signbit(wanted))
        odd = np.array([(np.nan, 1), (1, np.nan), (np.inf, 1), (1, -np.inf), (np.inf, np.inf), (0, np.nan)]).T
        assert np.isnan(ulps._called(loaded, f"batch_atan2{real.suffix}", odd, real)).all()


@needs_cc
@pytest.mark.parametrize(("end", "kind"), [("", np.float64), ("f", np.float32)], ids=["double", "float"])
def test_a_batch_chooses_as_one_sample_does_at_zeros_of_either_sign(end, kind, tmp_path):
    """-0.0 >= 0.0 is true. The difference -0.0 - 0.0 has the sign of a negative number."""
    library = tmp_path / "kernel.so"
    compiled(COMPILERS[0], "-O2", "-shared", "-fPIC", KERNELS / "mrp_of_quaternion.c", "-o", library, "-lm")
    loaded = ctypes.CDLL(str(library))
    one, batch = (getattr(loaded, f"symrot_mrp_of_quaternion{end}{form}") for form in ("", "_batch"))
    halves = [(zero, 0.6, -0.8, other) for zero in (0.0, -0.0, 0.6, -0.6) for other in (0.0, -0.0)]
    given, found = np.array(halves, kind).T.copy(), np.empty((3, len(halves)), kind)
    batch(ctypes.c_size_t(len(halves)), given.ctypes, found.ctypes)
    for sample, place in zip(given.T.copy(), range(len(halves)), strict=True):
        wanted = np.empty(3, kind)
        one(sample.ctypes, wanted.ctypes)
        assert np.array_equal(found[:, place], wanted), sample


@needs_cc
@pytest.mark.parametrize(("real", "end"), [("double", ""), ("float", "f")])
def test_choices_without_branches_compare_as_c_does(real, end, tmp_path):
    """All pairs of finite numbers of different size and sign, zeros of either sign included."""
    numbers = [sign * size for sign in (1.0, -1.0) for size in (0.0, 1e-45, 1e-30, 1.0, 1.0000001, 3e38)]
    rows = ", ".join(f"({real}){number!r}" for number in numbers)
    checks = "".join(
        f'    if (symrot_{name}{end}(x, y, 1, 2) != (x {relation} y ? 1 : 2)) return printf("%g {relation} %g\\n", (double)x, (double)y);\n'
        for name, relation in (("select_lt", "<"), ("select_eq", "=="), ("choose_ge", ">="))
    )
    (tmp_path / "symrot_math.h").write_text(math_header())
    (tmp_path / "choices.c").write_text(
        f'#include <stdio.h>\n#include "symrot_math.h"\nint main(void)\n{{\n    volatile {real} numbers[] = {{{rows}}};\n'
        f"    for (int i = 0; i < {len(numbers)}; ++i) for (int j = 0; j < {len(numbers)}; ++j) {{\n"
        f"    const {real} x = numbers[i], y = numbers[j];\n{checks}    }}\n    return 0;\n}}\n"
    )
    compiled(COMPILERS[0], "-O2", tmp_path / "choices.c", "-o", tmp_path / "choices", "-lm")
    assert subprocess.run([tmp_path / "choices"], capture_output=True, text=True).stdout == ""


@needs_cc
def test_a_power_that_overflows_is_seen(monkeypatch):
    """Where x^3 overflows, (x - sin x)/x^3 is computed as 0, but its value is 1/x^2: the measurement shows this error."""

    def altered(*given, **options):
        return c_functions(*given, **options).replace("(1.0 - sin(x)/x)/x/x", "(x - sin(x))/(t*x)")

    monkeypatch.setattr(ulps, "c_functions", altered)
    monkeypatch.setattr(ulps, "FUNCTIONS", [each for each in ulps.FUNCTIONS if each.name == "sine_gap"])
    found = {row.form: row.ulp for row in ulps.measured(200, ("unfused",)) if row.real == "double"}
    assert found["one"] > 1e10 and found["batch"] < 4


@needs_cc
def test_a_coefficient_that_is_off_in_its_last_digits_is_seen(monkeypatch):
    def altered(*given, **options):
        return c_functions(*given, **options).replace("0.16666666666666666 +", "0.16666666666666682 +")

    monkeypatch.setattr(ulps, "c_functions", altered)
    monkeypatch.setattr(ulps, "FUNCTIONS", [each for each in ulps.FUNCTIONS if each.name == "sine_gap"])
    assert all(row.ulp > 4 for row in ulps.measured(200, ("unfused",)) if row.real == "double")


def test_coefficients_are_the_series_to_the_last_bit():
    """The polynomials differ from sine and cosine by less than 1/8 ulp."""
    from symrot.codegen.printing import math_header as made

    with mpmath.workdps(40):
        for precision, digits in (("binary64", 53), ("binary32", 24)):
            for first, count in zip((3, 4), made._COUNT[precision], strict=True):
                polynomial = made.tail_coefficients(first, count)
                for x in np.linspace(0.01, np.pi / 4, 300):
                    x = mpmath.mpf(x)
                    tail = mpmath.fsum(
                        mpmath.mpf(a.numerator) / a.denominator * x ** (2 * k) for k, a in enumerate(polynomial)
                    )
                    exact, start = (mpmath.sin(x), x) if first == 3 else (mpmath.cos(x), 1 - x**2 / 2)
                    assert abs(start + tail * x**first - exact) <= abs(exact) * mpmath.mpf(2) ** -(digits + 3)


@needs_cc
def test_fast_math_is_refused(tmp_path):
    with pytest.raises(subprocess.CalledProcessError) as refused:
        compiled(COMPILERS[0], "-std=c99", "-ffast-math", "-c", KERNELS / "euler_zyx_dcm.c", "-o", tmp_path / "x.o")
    assert "without -ffast-math" in refused.value.stderr


WORKS = "-DCMAKE_C_COMPILER_WORKS=1"  # saves CMake a program that it compiles to learn this
needs_cmake = pytest.mark.skipif(not shutil.which("cmake"), reason="needs CMake")


def project(folder, components, linked):
    """Write a CMake project that takes kernels by name, and return the command that configures it."""
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.13)\nproject(firmware C)\n"
        f"find_package(symrot 0.2 REQUIRED COMPONENTS {components} PATHS {KERNELS} NO_DEFAULT_PATH)\n"
        f"add_executable(firmware {EXAMPLE})\ntarget_link_libraries(firmware PRIVATE {linked})\n"
    )
    return ["cmake", "-S", folder, "-B", folder / "build", WORKS]


@needs_cc
@needs_cmake
def test_cmake_compiles_the_kernels_that_are_linked_and_no_others(tmp_path):
    linked = " ".join(f"symrot::{name}" for name in USED)
    compiled(*project(tmp_path / "firmware", " ".join((*USED, "euler_zxz_dcm")), linked))
    compiled("cmake", "--build", tmp_path / "firmware" / "build")
    assert compiled(tmp_path / "firmware" / "build" / "firmware").stdout == "kernels agree\n"
    objects = {path.name for path in (tmp_path / "firmware" / "build").rglob("*.o")}
    assert objects == {"program.c.o", *(f"{name}.c.o" for name in USED)}


@needs_cc
@needs_cmake
def test_a_component_that_is_no_kernel_is_refused_in_a_sentence(tmp_path):
    with pytest.raises(subprocess.CalledProcessError) as refused:
        compiled(*project(tmp_path / "firmware", "heavy_topp", "symrot::kernels"))
    assert "expected a kernel with a file heavy_topp.c" in " ".join(refused.value.stderr.split())


@needs_cc
@needs_cmake
@pytest.mark.skipif(not shutil.which("pkg-config"), reason="needs pkg-config")
def test_pkg_config_knows_installed_kernels_by_name(tmp_path):
    """Three kernels are built and installed; a program takes them by pkg-config, also after a step from another folder."""
    compiled(
        "cmake", "-S", KERNELS, "-B", tmp_path / "build", WORKS, f"-DSYMROT_KERNELS={';'.join(USED)}",
        f"-DCMAKE_INSTALL_PREFIX={tmp_path / 'prefix'}",
    )  # fmt: skip
    compiled("cmake", "--build", tmp_path / "build", "--target", "install")
    assert len([*(tmp_path / "build").rglob("*.c.o")]) == len(USED)
    assert main(["emit", "tumbling_prism", "--step", "rk4", "--cmake", "-o", str(tmp_path / "step")]) == 0
    compiled(
        "cmake", "-S", tmp_path / "step", "-B", tmp_path / "other", WORKS,
        f"-DCMAKE_INSTALL_PREFIX={tmp_path / 'prefix'}",
    )  # fmt: skip
    compiled("cmake", "--build", tmp_path / "other", "--target", "install")
    search = {"PKG_CONFIG_PATH": str(tmp_path / "prefix" / "lib" / "pkgconfig")}
    names = [f"symrot-{name}" for name in (*USED, "tumbling_prism_rk4_step")]
    options = subprocess.run(["pkg-config", "--cflags", "--libs", *names], env=os.environ | search, check=True,
                             capture_output=True, text=True).stdout  # fmt: skip
    compiled(COMPILERS[0], EXAMPLE, *options.split(), "-o", tmp_path / "program")
    assert compiled(tmp_path / "program").stdout == "kernels agree\n"


def test_build_files_are_printed():
    for name, text in build_files().items():
        assert (KERNELS / name).read_text(encoding="utf-8") == text
    assert all(flag in build_files()["symrotConfig.cmake"] for flag in FLAGS)

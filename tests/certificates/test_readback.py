"""The reader of emitted C: its operations are those that a compiler computes, and it refuses any other C."""

import ctypes
import math
import random
import re
import subprocess
from pathlib import Path

import pytest

from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.errors import CertificateError

GENERATED = Path(__file__).parents[2] / "generated" / "c"
KERNELS = sorted(path for path in GENERATED.rglob("*.c") if not path.stem.startswith("symrot_"))
FUNCTIONS = {
    name: getattr(math, name)
    for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "atan2", "asin", "acos", "copysign")
}

PLAIN = """
static inline double square(double x) { return x*x; }
void plain(double t, const double y[2], double dy[2])
{
    const double a = t < 0.0 ? -y[0] : square(y[0] + 1.5);
    dy[0] = a/y[1] - 0x1.8p-1;
    dy[1] = -(a - 2.0)*cos(t);
}
"""


def replayed(operations, values):
    return operations.evaluate(values, FUNCTIONS, float)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.stem)
def test_one_sample_and_batch_are_the_same_operations(path):
    text = path.read_text(encoding="utf-8")
    one, batch = (
        read_kernel(text, f"symrot_{path.stem}", path.name),
        read_batch(text, f"symrot_{path.stem}_batch", path.name),
    )
    assert one.digest() == batch.digest()


@pytest.fixture(scope="module")
def compiled(request, tmp_path_factory):
    """Return a library with the kernels of the cases that run, compiled without contraction."""
    name = test_what_is_read_is_what_the_compiler_makes_of_it.__name__
    paths = [item.callspec.params["path"] for item in request.session.items if item.originalname == name]
    library = tmp_path_factory.mktemp("readback") / "kernels.so"
    flags = ["-O0", "-ffp-contract=off", "-shared", "-fPIC"]
    subprocess.run(["cc", *flags, *map(str, paths), "-o", str(library), "-lm"], check=True)
    return ctypes.CDLL(str(library))


@pytest.mark.thinned(3)
@pytest.mark.parametrize("path", KERNELS[::4], ids=lambda path: path.stem)
def test_what_is_read_is_what_the_compiler_makes_of_it(path, compiled):
    """Without contraction, the operations and the compiled code give the same bits at random points."""
    operations = read_kernel(path.read_text(encoding="utf-8"), f"symrot_{path.stem}", path.name)
    function = getattr(compiled, f"symrot_{path.stem}")
    sizes = {}
    for place in (*operations.inputs, *(place for place, _ in operations.outputs)):
        name = place.partition("[")[0]
        sizes[name] = sizes.get(name, 0) + 1
    rng = random.Random(7)
    for _ in range(20):
        values = {place: rng.uniform(-2, 2) for place in operations.inputs}
        arrays = {name: (ctypes.c_double * size)() for name, size in sizes.items()}
        taken = []
        for name in sizes:
            if name in operations.inputs:
                taken.append(ctypes.c_double(values[name]))
                continue
            for index in range(sizes[name]):
                arrays[name][index] = values.get(f"{name}[{index}]", 0.0)
            taken.append(arrays[name])
        function(*taken)
        for place, value in replayed(operations, values).items():
            name, index = re.fullmatch(r"(\w+)\[(\d+)\]", place).groups()
            assert arrays[name][int(index)] == value, place


def test_functions_of_the_file_and_choices_are_read():
    operations = read_kernel(PLAIN, "plain")
    for t, y in ((-1.0, (2.0, 4.0)), (0.5, (-3.0, 0.25))):
        a = -y[0] if t < 0 else (y[0] + 1.5) ** 2
        expected = {"dy[0]": a / y[1] - 0.75, "dy[1]": -(a - 2) * math.cos(t)}
        assert replayed(operations, {"t": t, "y[0]": y[0], "y[1]": y[1]}) == expected


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("cos(t)", "cosh2(t)", "function of <math.h>"),
        ("cos(t)", "cosf(t)", "function of <math.h>"),
        ("cos(t)", "cos(t, t)", "function of <math.h>"),
        ("cos(t)", "cos(--t)", "a name"),  # not t, but t - 1
        ("y[1] -", "y[2] -", "below 2"),
        ("dy[1]", "dy[0]", "one assignment"),
        ("dy[1]", "dy[01]", "an index"),  # octal in C
        ("dy[1] =", "dy[1] +=", "'='"),
        ("    dy[1] = -(a - 2.0)*cos(t);\n", "", "assign dy[1]"),
        ("2.0", "2", "literal of type double"),
        ("2.0", "2.0f", "literal of type double"),
        ("const double a", "double a", "output array"),
        ("a/y[1]", "b/y[1]", "a name that has a value"),
        ("a/y[1]", "dy[1]/y[1]", "input array"),
        ("return x*x", "return square(x)", "recursion"),
        ("return x*x;", "x*x;", "expected"),
        ("static", "#define cos sin\nstatic", "#include"),
        ("static", '#include "other/file.h"\nstatic', "#include"),
        ("static", "int x; static", "a function whose arguments are of type double or float"),
        ("static", "/\\\n* */ static", "backslash"),
        ("< 0.0", "< 0.0 < 1.0", "'?'"),
        ("cos(t)", "cos(t", "expected"),
        ("cos(t)", "(" * 300 + "t" + ")" * 300, "200 levels of brackets"),
    ],
)
def test_what_is_not_understood_is_refused(old, new, said):
    assert old in PLAIN
    with pytest.raises(CertificateError, match=re.escape(said)):
        read_kernel(PLAIN.replace(old, new, 1), "plain", "plain.c")


BLOCKS = (GENERATED / "euler_zxz_body_rates.c").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("symrot_sin(psi)", "symrot_cos(psi)", "the same"),
        ("symrot_sin(psi)", "symrot_sin(phi)", "has a value"),
        ("symrot_sin(psi)", "symrot_tan(psi)", "<math.h>"),
        (" + symrot_far(theta)", "", "for each argument"),
        ("symrot_far(theta)", "symrot_far(omega_1)", "for each argument"),
        ("symrot_far(theta)", "symrot_near(theta)", "symrot_far"),
        ("beyond += ", "beyond -= ", "'+'"),
        ("beyond == 0 ? start : end", "beyond == 0 ? end : start", "'start'"),
        ("beyond == 0", "beyond == 1", "'0'"),
        ("uint64_t beyond = 0", "uint64_t beyond = 1", "'0'"),
        ("start += SYMROT_BLOCK", "start += 2*SYMROT_BLOCK", "SYMROT_BLOCK"),
        ("n - start < SYMROT_BLOCK ? n", "n - start < SYMROT_BLOCK ? start", "'n'"),
        ("k = start; k < end", "k = start; k < n", "'end'"),
        ("k = start; k < again", "k = 0; k < again", "'start'"),
        ("again; ++k) {\n            const double psi = angles[2*n", "again; ++k) {\n            const double psi = angles[n", "the same"),
    ],
)  # fmt: skip
def test_a_batch_in_blocks_is_read_whole_or_refused(old, new, said):
    """A block calls symrot_math.h, tests every angle, and computes large angles again with the C library."""
    start = BLOCKS.index("void symrot_euler_zxz_body_rates_batch")
    assert old in BLOCKS[start:]
    with pytest.raises(CertificateError, match=re.escape(said)):
        read_batch(BLOCKS[:start] + BLOCKS[start:].replace(old, new, 1), "symrot_euler_zxz_body_rates_batch", "x.c")


@pytest.mark.parametrize("name", ["n", "x"])
def test_an_index_of_samples_that_hides_another_variable_is_refused(name):
    """C runs no sample if the index hides the number of samples: ``n < n`` is false."""
    text = "void f_batch(size_t n, const double *x, double *y) { for (size_t k = 0; k < n; ++k) { y[k] = 2.0*x[k]; } }"
    assert read_batch(text, "f_batch").nodes
    with pytest.raises(CertificateError, match="not yet used"):
        read_batch(text.replace("k", name), "f_batch")


def test_sine_of_symrot_is_for_batches_alone():
    text = BLOCKS.replace("= sin(psi)", "= symrot_sin(psi)", 1)
    with pytest.raises(CertificateError, match=r"<math\.h>"):
        read_kernel(text, "symrot_euler_zxz_body_rates", "x.c")


def test_an_edited_kernel_is_refused_or_computes_something_else():
    """Every change of one token changes the operations or is refused."""
    path = next(path for path in KERNELS if path.stem == "gravity_gradient_satellite_rates")
    text = path.read_text(encoding="utf-8")
    start = text.index("{", text.index(f"void symrot_{path.stem}("))
    end = text.index(f"void symrot_{path.stem}_batch")
    original = read_kernel(text, f"symrot_{path.stem}").digest()
    swaps = {"+": "-", "-": "+", "*": "/", "/": "*", "sin": "cos", "cos": "sin", "0.5": "0.25", "[0]": "[1]", "[1]": "[0]",
             "q1": "q2", "q2": "q1", "p0": "p1"}  # fmt: skip
    places = [
        m
        for m in re.finditer(r"\b(?:sin|cos)\b|0\.5|\[[01]\]|[-+*/]|\b(?:q1|q2|p0)\b", text)
        if start < m.start() < end
    ]
    assert len(places) > 60
    for match in places:
        changed = text[: match.start()] + swaps[match[0]] + text[match.end() :]
        try:
            digest = read_kernel(changed, f"symrot_{path.stem}").digest()
        except CertificateError:
            continue
        assert digest != original, changed[match.start() - 30 : match.end() + 30]

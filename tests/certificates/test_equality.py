"""The equality of C text and formula is proven for every kernel, and refused for every corrupted text."""

import random
import re
from fractions import Fraction
from pathlib import Path

import pytest
from sympy import symbols

from symrot.certificates.laws.equality import prove_equal
from symrot.certificates.readback.intended_constants import intended_value, rounds_to
from symrot.certificates.readback.readback import read_kernel
from symrot.errors import CertificateError
from symrot.formula.exact_numbers import PI
from symrot.kernels.library import definition, kernel_names
from symrot.kernels.removable import sine_gap

GENERATED = Path(__file__).parents[2] / "generated" / "c"
SLICE = ("quaternion_dcm", "quaternion_of_dcm", "euler_zyx_body_rates", "euler_zxz_of_quaternion",
         "rotation_vector_body_jacobian", "rotation_vector_of_quaternion", "inertia_cone", "mrp_shadow",
         "euler_equations_principal", "torque_gravity")  # fmt: skip


def proven(name, text, suffix=""):
    kernel = definition(name)
    places = {
        (a.name if a.is_scalar else f"{a.name}[{i}]"): component[0]
        for a in kernel.inputs
        for i, component in enumerate(a.components)
    }
    formulas = {f"{a.name}[{i}]": formula for a, each in kernel.results for i, formula in enumerate(each)}
    return prove_equal(read_kernel(text, f"symrot_{name}{suffix}", name), places, formulas, kernel.named)


def text_of(name):
    return (GENERATED / f"{name}.c").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", SLICE)
@pytest.mark.parametrize("suffix", ["", "f"], ids=["double", "float"])
def test_the_c_text_is_the_formula(name, suffix):
    proof = proven(name, text_of(name), suffix)
    for truncation in proof.truncations:
        assert truncation.relative < Fraction(1, 2 ** (26 if suffix else 55))


@pytest.mark.campaign
@pytest.mark.parametrize("name", kernel_names())
def test_every_c_text_is_its_formula(name):
    for suffix in ("", "f"):
        proven(name, text_of(name), suffix)


SHARED = """static inline double symrot_sine_gap(double x)
{
    return x*x < 0.25 ? 0.16666666666666666 + x*x*-0.008333333333333333 : (x - sin(x))/(x*x*x);
}
void gap(const double a[2], double b[1])
{
    b[0] = symrot_sine_gap(a[0]) + a[1]*0.16666666666666666;
}
"""


def test_a_constant_of_a_series_counts_outside_the_series_too():
    x, y = symbols("x y", real=True)
    operations, places = read_kernel(SHARED, "gap"), {"a[0]": "x", "a[1]": "y"}
    prove_equal(operations, places, {"b[0]": sine_gap(x) + y / 6})
    with pytest.raises(CertificateError, match="computes another value"):
        prove_equal(operations, places, {"b[0]": sine_gap(x)})


SWAPS = {"+": "-", "-": "+", "*": "/", "/": "*", "sin": "cos", "cos": "sin", "0.5": "0.25", "2.0": "3.0", "[0]": "[1]",
         "[1]": "[2]", ">=": "<", "<": ">=", "1.0": "1.5", "==": ">=", "sqrt": "fabs"}  # fmt: skip


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", SLICE)
def test_a_corrupted_text_is_refused(name):
    """One token is changed in the one-sample function or in a function that it calls."""
    text = text_of(name)
    for start, end in (m.span(1) for m in re.finditer(r"(?:double|void) \w+\([^)]*\)\n\{(.*?)\n\}", text, re.DOTALL)):
        head = text[text.rfind("\n", 0, text.rfind("(", 0, start)) : start]
        if "batch" in head or "float" in head or "near" in head:
            continue
        tokens = re.compile(r"\bsin\b|\bcos\b|\bsqrt\b|0\.5|[12]\.0|\[[01]\]|[>=]=|<|[-+*/]")
        places = [m for m in tokens.finditer(text, start, end) if text[m.start() - 1] != "e"]
        for match in random.Random(3).sample(places, min(12, len(places))):
            changed = text[: match.start()] + SWAPS[match[0]] + text[match.end() :]
            with pytest.raises(CertificateError):
                proven(name, changed)


def test_the_number_a_constant_stands_for():
    assert intended_value(Fraction(1 / 3), "binary64").fraction == Fraction(1, 3)
    assert intended_value(Fraction(0.5), "binary64").fraction == Fraction(1, 2)
    pi = intended_value(Fraction(3.141592653589793), "binary64")
    assert pi.times_pi and pi.fraction == 1
    two_pi = intended_value(rounds_to(2 * PI, "binary32"), "binary32")
    assert two_pi.times_pi and two_pi.fraction == 2
    with pytest.raises(CertificateError, match="simple fraction"):
        intended_value(Fraction(0.123456789012345678), "binary64")

"""Inequalities: true by a proof, false at an exact point, or a condition on letters."""

from random import Random

import mpmath
import pytest
import sympy

import symrot
from symrot.cli.main import main

TRUE = (
    "sin²x ≤ 1", "|x+y| ≤ |x|+|y|", "|x-y| ≥ |x|-|y|", "x² + 1 > 0", "x^2 >= 0", "a b <= (a^2+b^2)/2", "cosh x >= 1",
    "e^x > 0", "sin x + cos x <= 2", "x < x + 1", r"\sin\theta \le 1", "x^4 + 1 > x", "sqrt(2) < 3/2",
    "(a x + b y)^2 <= (a^2 + b^2)(x^2+y^2)", r"|\sin x| \le 1",
)  # fmt: skip
FALSE = ("x^2 > 0", "cosh x > 1", "sin x <= x", "sin x + cos x <= 1", "x + 1/x >= 2", "pi > 22/7", "x < x", "3/x > 0")
CONDITIONS = ("x > 0", r"v^2 > \frac{4 M g l I_1}{m I_3}", "a < b + c")


@pytest.mark.parametrize("text", TRUE)
def test_a_proven_inequality_is_true(text):
    assert symrot.check(text).verdict == "true"


@pytest.mark.parametrize("text", FALSE)
def test_a_false_inequality_has_a_counterexample(text):
    verdict = symrot.check(text)
    assert verdict.verdict == "false"
    assert verdict.counterexample is not None


@pytest.mark.parametrize("text", CONDITIONS)
def test_a_condition_on_letters_is_no_claim(text):
    assert symrot.check(text).verdict == "definition"


def test_the_least_spin_of_a_top_is_known():
    """The opposite sign is no fault: a top with less spin falls."""
    verdict = symrot.check(r"\omega_3 \ge \frac{1}{I_3}\sqrt{M g l I_1\cos\theta}")
    repairs = [each.text for each in verdict.repairs]
    assert (verdict.verdict, repairs) == ("doubtful", [r"\omega_3 \geq \frac{2}{I_3} \sqrt{M g l I_1 \cos(\theta)}"])
    assert symrot.check("ω_3 ≤ (2/I₃) √(M g l I₁ cos θ)").verdict == "definition"


def test_a_domain_is_a_condition():
    assert symrot.check("sqrt(x) >= 0").conditions == ("x >= 0",)


@pytest.mark.parametrize("text", ["I_1 + I_2 ≥ I_3", "A + B >= C", "A - B <= C", r"I_{xx} + I_{yy} \ge I_{zz}"])
def test_moments_of_inertia_obey_the_triangle_inequality(text):
    assert symrot.check(text).verdict == "recognised"


@pytest.mark.parametrize("text", ["I_1 + I_2 ≤ I_3", "A + B < C"])
def test_the_reversed_inequality_is_repaired(text):
    verdict = symrot.check(text)
    assert verdict.verdict == "doubtful"
    assert symrot.check(verdict.repairs[0].text).verdict == "recognised"


def test_a_plate_is_the_exception_to_the_strict_inequality():
    assert symrot.check("I_1 + I_2 > I_3").verdict == "conditional"


def test_vectors_and_complex_numbers_have_no_order():
    with pytest.raises(symrot.InputError, match="expected real numbers on both sides"):
        symrot.check("e^{ix} > 0")


def test_random_inequalities_agree_with_their_values():
    """No proven inequality fails at a sampled point, and every refuted one fails at its counterexample."""
    source = Random(3)
    x, y = sympy.symbols("x y", real=True)
    pieces = ("x", "y", "x^2", "y^2", "x*y", "sin(x)", "cos(y)", "abs(x)", "abs(x - y)", "exp(x)", "cosh(y)", "x^4")
    decided = 0
    for _ in range(30):
        terms = [f"{source.randint(-2, 3)}*{piece}" for piece in source.sample(pieces, 3)]
        sign = source.choice((">", ">="))
        left = f"{' + '.join(terms)} + {source.randint(0, 4)}"
        verdict = symrot.check(f"{left} {sign} x - x")
        formula = sympy.lambdify((x, y), sympy.sympify(left.replace("^", "**"), {"x": x, "y": y}), "mpmath")
        decided += verdict.verdict in ("true", "false")
        if verdict.verdict == "true":
            values = [formula(*(mpmath.mpf(source.uniform(-6, 6)) for _ in "xy")) for _ in range(60)]
            assert min(values) >= 0, left
        elif verdict.verdict == "false":
            point = {name: mpmath.mpf(sympy.N(sympy.sympify(value), 30)) for name, value in
                     verdict.counterexample.values.items()}  # fmt: skip
            value = formula(point.get("x", 0), point.get("y", 0))
            assert value < 0 or (sign == ">" and abs(value) < 1e-12), left
    assert decided > 15


@pytest.mark.parametrize("claim", ["|x + y| ≤ |x| + |y|", "x² + 1 > 0", r"x^2 \ge 0"])
def test_the_command_line_takes_an_inequality_for_a_claim_and_not_for_a_file(claim, capsys):
    assert main(["check", claim]) == 0
    assert capsys.readouterr().out.startswith("true")


def test_a_power_with_a_letter_in_its_exponent_has_a_sign_for_a_positive_base_only():
    """(-2)^3 is negative."""
    verdict = symrot.check("x^y >= 0")
    assert (verdict.verdict, verdict.requires) == ("conditional", ("x > 0",))
    verdict = symrot.check("2^x > 0")
    assert verdict.verdict == "true" and 0 < verdict.seconds < 60


@pytest.mark.parametrize("text", ["atan(x) < 2", "asin(x) + acos(y) < 5"])
def test_the_range_of_an_inverse_function_proves_an_inequality(text):
    assert symrot.check(text).verdict == "true"

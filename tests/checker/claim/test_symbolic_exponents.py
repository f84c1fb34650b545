"""Powers with an exponent that is no number, over a positive base; the letter e, and the letters i and j."""

import pytest

import symrot
from symrot.errors import InputError

TRUE = (
    ("a**b*a**c == a**(b+c)", ("a > 0",)), ("a**b*a**(-b) == 1", ("a > 0",)), ("2**n*2 == 2**(n+1)", ()),
    ("4**n == 2**(2*n)", ()), ("(1/2)**n == 2**(-n)", ()), ("x**n*x == x**(n+1)", ("x > 0",)),
    ("diff(x**n, x) == n*x**(n-1)", ("x > 0",)), ("diff(a**x, x) == a**x*log(a)", ("a > 0",)),
    ("a**(2*x) - 1 == (a**x - 1)*(a**x + 1)", ("a > 0",)), ("9**x == 3**x*3**x", ()), ("(a+b)**n == (b+a)**n", ("a + b > 0",)),
    ("2^x * 8^(y/3) = 2^(x + y)", ()), ("a**b == exp(b*log(a))", ("a > 0",)), ("e^(2x) = (e^x)^2", ()), ("e**x == exp(x)", ()),
    ("e^x e = e^(x + 1)", ()), ("e^-kt = exp(-k t)", ()), (r"e^{x} e^{y} = e^{x + y}", ()), (r"2^{n} \cdot 2^{m} = 2^{n + m}", ()),
)  # fmt: skip


@pytest.mark.parametrize(("claim", "conditions"), TRUE)
def test_laws_of_powers_hold_where_the_base_is_positive(claim, conditions):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    assert verdict.conditions == conditions


@pytest.mark.parametrize("claim", [
    "a**b == b**a", "a**b*a**c == a**(b*c)", "a**(b+c) == a**b + a**c", "diff(x**n, x) == n*x**n", "2**n*2 == 2**(n+2)",
    "5**x == 2**x", "e^x = e + 1", "e^(2x) = 2 e^x", "x**y == 1", "4**n == 2**n",
])  # fmt: skip
def test_wrong_laws_of_powers_have_a_counterexample(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false"
    assert verdict.counterexample is not None


@pytest.mark.parametrize(
    "claim", ["(a*b)**n == a**n*b**n", "(a**b)**c == a**(b*c)", "x**n == abs(x)**n", "(-a)**n == a**n"]
)
def test_laws_that_need_more_than_one_logarithm_are_never_wrong(claim):
    assert symrot.check(claim).verdict in ("true", "undecided")


@pytest.mark.parametrize(("claim", "words"), [
    ("(-1)**n == 1", "a positive number"), ("0**x == 0", "a positive number"), ("x**x**x == 1", "a number as an exponent"),
    ("x**sin(y) == 1", "without functions"), ("Matrix([[1, x], [0, 1]])**n == eye(2)", "a number as an exponent"),
    ("m*exp(x) == m*E**x", "means something else"),
])  # fmt: skip
def test_other_exponents_are_refused(claim, words):
    with pytest.raises(InputError, match=words):
        symrot.check(claim)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", [
    "e^(iθ) = cos θ + i sin θ", r"e^{i\theta} = \cos\theta + i\sin\theta", "exp(I*x) == cos(x) + I*sin(x)", "e^(iπ) + 1 = 0",
    "(cos x + i sin x)^3 = cos 3x + i sin 3x", "cos x = (e^(i x) + e^(-i x))/2", "|e^(i x)| = 1", "e^(i x) e^(i y) = e^(i (x + y))",
    "1/(cos x + i sin x) = cos x - i sin x", "sin(i x) e^(i y)= i sinh(x) e^(i y)", "e^(a + i b) = e^a (cos b + i sin b)",
])  # fmt: skip
def test_complex_formulas_are_equal_if_their_parts_are(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    assert any("is the imaginary unit" in note for note in verdict.notes)


@pytest.mark.parametrize("claim", [
    "e^(iθ) = sin θ + i cos θ", "e^(iθ) = cos θ - i sin θ", "exp(i*x) == cos(x)", "(cos x + i sin x)^2 = cos 2x + i sin x", "e^(iπ) = 1",
])  # fmt: skip
def test_a_wrong_part_is_false(claim):
    assert symrot.check(claim).verdict == "false"


@pytest.mark.parametrize(("claim", "words"), [
    ("log(e^(i x)) = i x", "real and imaginary parts are known"), ("(e^(i x))^y = e^(i x y)", "a whole number up to"),
])  # fmt: skip
def test_a_function_whose_parts_are_not_known_is_refused(claim, words):
    with pytest.raises(InputError, match=words):
        symrot.check(claim)


def test_a_letter_i_that_is_no_imaginary_unit_stays_a_name():
    assert symrot.check("x_i + i = i + x_i").verdict == "true"
    assert symrot.check("z = r e^(i θ)").verdict == "definition"


def test_a_wrong_power_is_repaired():
    verdict = symrot.check("diff(x**n, x) == (n + 1)*x**(n-1)")
    assert "diff(x**n, x) == n*x**(n - 1)" in [repair.text for repair in verdict.repairs]

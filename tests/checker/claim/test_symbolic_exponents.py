"""Powers of a positive base with an exponent that is not a number; the letter e, and the letters i and j."""

import pytest

import symrot
from symrot.errors import InputError

TRUE = (
    ("a**b*a**c == a**(b+c)", ("a > 0",)), ("a**b*a**(-b) == 1", ("a > 0",)), ("2**n*2 == 2**(n+1)", ()),
    ("4**n == 2**(2*n)", ()), ("(1/2)**n == 2**(-n)", ()), ("x**n*x == x**(n+1)", ("x > 0",)),
    ("diff(x**n, x) == n*x**(n-1)", ("x > 0",)), ("diff(a**x, x) == a**x*log(a)", ("a > 0",)),
    ("a**(2*x) - 1 == (a**x - 1)*(a**x + 1)", ("a > 0",)), ("9**x == 3**x*3**x", ()), ("(a+b)**n == (b+a)**n", ("a + b > 0",)),
    ("2^x * 8^(y/3) = 2^(x + y)", ()), ("a**b == exp(b*log(a))", ("a > 0",)), ("e^(2x) = (e^x)^2", ()), ("e**x == exp(x)", ()),
    ("(1 + x**2)**n*(1 + x**2)**m == (1 + x**2)**(m + n)", ()), ("e^x e = e^(x + 1)", ()), ("e^-kt = exp(-k t)", ()), (r"e^{x} e^{y} = e^{x + y}", ()), (r"2^{n} \cdot 2^{m} = 2^{n + m}", ()),
)  # fmt: skip


@pytest.mark.parametrize(("claim", "conditions"), TRUE)
def test_laws_of_powers_hold_where_the_base_is_positive(claim, conditions):
    """A power of a negative base may have a value too, for a whole exponent: so the claim is conditional."""
    verdict = symrot.check(claim)
    granted = not conditions or "log(a)" in claim
    assert verdict.verdict == ("true" if granted else "conditional")
    assert verdict.conditions == conditions
    assert verdict.requires == (() if granted else conditions)


@pytest.mark.parametrize("claim", [
    "a**b == b**a", "a**b*a**c == a**(b*c)", "a**(b+c) == a**b + a**c", "diff(x**n, x) == n*x**n", "2**n*2 == 2**(n+2)",
    "5**x == 2**x", "e^x = e x", "e^(2x) = 2 e^x", "x**y == 1", "4**n == 2**n",
])  # fmt: skip
def test_wrong_laws_of_powers_have_a_counterexample(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false"
    assert verdict.counterexample is not None


@pytest.mark.parametrize(
    ("claim", "condition"),
    [
        ("(a*b)**n == a**n*b**n", "a > 0 and b > 0"), ("(a**b)**c == a**(b*c)", "a > 0"), ("x**n == abs(x)**n", "x > 0"),
        ("x**log(y) == y**log(x)", ""), ("((x - 2)**3)**k == (x - 2)**(3*k)", "x > 2"), ("(a^2)^b = a^b a^b", "a > 0"),
        ("sin(1)**y/cos(1)**y == tan(1)**y", ""), ("(x/y)**n*y**n == x**n", "x > 0 and y > 0"),
    ],
)  # fmt: skip
def test_laws_with_several_bases_hold_where_all_of_them_are_positive(claim, condition):
    verdict = symrot.check(claim, repair=False)
    assert (verdict.verdict, *verdict.requires) == (("conditional", condition) if condition else ("true",))


def test_equal_sides_are_equal_for_all_bases():
    assert symrot.check("sin(x)**y/cos(x)**y == sin(x)**y/cos(x)**y").verdict == "true"


@pytest.mark.parametrize("claim", ["(-a)**n == a**n", "(a - 1)**b == (1 - a)**b"])
def test_laws_whose_bases_are_never_positive_together_are_not_true(claim):
    try:
        assert symrot.check(claim, repair=False).verdict == "undecided"
    except InputError as refusal:
        assert "nowhere" in str(refusal)


@pytest.mark.parametrize("claim", ["(x**y)**2 == x**y + 1", "(a**b)**c == a**(b**c)", "x**sin(y) == 1", "x**x**x == x"])
def test_wrong_towers_have_a_counterexample(claim):
    assert symrot.check(claim, repair=False).counterexample is not None


@pytest.mark.parametrize(("claim", "words"), [
    ("(-1)**n == 1", "a positive number"), ("0**x == 0", "a positive number"), ("Matrix([[1, x], [0, 1]])**n == eye(2)", "a number as an exponent"),
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

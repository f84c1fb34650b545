"""No verdict follows from a side that is no real number, or from hypotheses that no point satisfies."""

from dataclasses import replace
from random import Random
from time import process_time

import pytest
from sympy import I, Matrix, Rational, acos, asin, cos, exp, log, sin, sqrt, symbols

import symrot
from symrot.errors import InputError
from symrot.exact import is_zero, normal_form
from symrot.exact.decide import decide
from tests.campaigns.checker.real_identities import fault

x, y = symbols("x y", real=True)
THIRD = Rational(1, 3)


def verdict_of(claim, given=()):
    """Return the verdict on a claim, or "refused" if it is refused in one sentence."""
    try:
        return symrot.check(claim, assume=given, repair=False).verdict
    except InputError as reason:
        assert "\n" not in str(reason)
        return "refused"


ROOTS_OF_NEGATIVES = (
    "(-8)**(1/3) == 7", "x + (-2)**(1/5) == x", "(-27)**(2/3) == 1", "(-pi)**(1/3) == 4", "x*(-8)**(1/3) == 5*x",
    "sqrt((-8)**(1/3)) == 8", "(-abs(x))**(1/3) == 8", "(-x**2-1)**(1/3) == 7", "((-8)**(1/3))**3 == -8",
    "abs((-8)**(1/3)) == 2", "(-x**2-1)**(1/3) == (-x**2-1)**(1/3)", "(-exp(x))**(1/3) == 3", "sqrt(-x**2-1) == 7",
    "(-1)**(1/4) == 0", "(-1)**(2/3)*x == x", "(cos(x) - 2)**(1/3) == 7", "(cos(1) - 1)**(1/7) == 0",
    "Matrix([(-8)**(1/3), x]) == Matrix([7, x])", "diff(x*(-8)**(1/3), x) == 5",
)  # fmt: skip

NOWHERE = (
    "sqrt(cos(x)-2) == 7", "sqrt(cos(x)-2) == sqrt(cos(x)-2)", "log(cos(x)-2) == 3", "asin(x**2+2) == 1",
    "asin(2+exp(x)) == asin(2+exp(x))", "0*log(-1) == 0", "0*log(cos(1)-2) == 0", "x - x + sqrt(-1) == 3",
    "log(-abs(x)) == 3", "0*log(sin(x) - 1) + x == x", "exp(log(-x**2)) == 1", "0/(sqrt(5+2*sqrt(6))-sqrt(2)-sqrt(3)) == 0",
    "log(sqrt(5+2*sqrt(6))-sqrt(2)-sqrt(3)) == 1", "atan2(x-x, y-y) == 1", "tan(pi/2) == 1", "0**(-1/2) == 0",
    "Matrix([[1, sqrt(cos(x)-2)], [0, 1]]) == Matrix([[1, sqrt(cos(x)-2)], [0, 1]])",
)  # fmt: skip

EMPTY_TOGETHER = (
    "sqrt(x)*sqrt(-x-1) == sqrt(-x-x**2)", "sqrt(x-1)*sqrt(-x) == sqrt(x-1)*sqrt(-x)", "log(x)*0 + log(-x)*0 == 0",
    "asin(x) + asin(x+3) == asin(x) + asin(x+3)", "sqrt(x)*sqrt(-x-1) == 5", "sqrt(sin(x)-2+cos(y)) == 4",
    "inverse(diag(sqrt(x), sqrt(-x))) == diag(1/sqrt(x), 1/sqrt(-x))", "cos(asin(-x**2 - 1)) == 3",
)  # fmt: skip
"""Each side has values by itself, or at single points only."""

UNDER_NOTHING = (
    ("x == 1", ["x**2 + 1 == 0"]), ("x == 1", ["x > 0", "x == -1"]), ("x == 5", ["log(x) == y", "x == -3"]),
    ("x == 1", ["sqrt(x) == -1"]), ("x == 1", ["cos(x) == 2"]), ("x == 1", ["exp(x) == -1"]), ("x == x", ["cos(y) == 2"]),
    ("x == 1", ["x**(1/3) == -1"]), ("x == x", ["sqrt(x) == -1"]), ("x == y", ["(-8)**(1/3) == 2"]),
    ("sqrt(x) == 7", ["x == -1"]), ("log(x) == 7", ["x == -1"]), ("sqrt(x)*0 == 0", ["x == -1"]),
    ("x**(1/3) == 7", ["x == -8"]), ("asin(x) == asin(x)", ["x == 2"]), ("acos(x) + asin(x) == pi/2", ["x == 2"]),
    ("sqrt(y-2) == sqrt(y-2)", ["y == sin(x)"]), ("Matrix([x, log(y)])*0 == Matrix([0, 0])", ["y == -2"]),
    ("1/x + 1/y == 5", ["x*y == 0"]), ("x == 3", ["x != 0", "x == 0"]), ("x + y == y + x", ["x**2 + y**2 == -1"]),
)  # fmt: skip


@pytest.mark.parametrize("claim", [*ROOTS_OF_NEGATIVES, *NOWHERE])
def test_a_side_that_is_real_nowhere_is_refused(claim):
    assert verdict_of(claim) == "refused"


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", EMPTY_TOGETHER)
def test_sides_without_a_common_point_are_not_equal(claim):
    assert verdict_of(claim) in ("refused", "undecided")


@pytest.mark.parametrize(("claim", "given"), UNDER_NOTHING, ids=str)
def test_nothing_follows_from_hypotheses_that_nothing_obeys(claim, given):
    assert verdict_of(claim, given) in ("refused", "undecided")


@pytest.mark.parametrize(("claim", "given"), [
    ("x == 1", ["asin(x) == 4"]), ("x == 1", ["log(x) == 0"]), ("x == 0", ["asin(x) == 0"]), ("x == y", ["exp(x) == exp(y)"]),
], ids=str)  # fmt: skip
def test_no_counterexample_breaks_a_hypothesis_on_a_function(claim, given):
    """asin(x) was given the value 4, independent of the value of x."""
    assert verdict_of(claim, given) in ("refused", "undecided")


@pytest.mark.parametrize(("claim", "given"), [
    ("x == 4", ["abs(x) == x - 1"]), ("x == 4", ["sqrt(x**2) == x - 1"]), ("y == 2", ["abs(x) == x + y", "y == -1", "x > 0"]),
    ("x == 4", ["sqrt(x + 1) == x - 5", "x == 3"]),
], ids=str)  # fmt: skip
def test_no_counterexample_breaks_a_hypothesis_on_a_root(claim, given):
    """|x| = x - 1 seemed to hold at x = 3/2, since the square of the root was reduced by the hypothesis itself."""
    assert verdict_of(claim, given) in ("refused", "undecided")


@pytest.mark.parametrize(("claim", "given"), [
    ("x + log(z) == y + log(z)", ["x**2 == 2*y"]), ("x + asin(z) == y + asin(z)", ["x + y == 3"]),
    ("x*exp(z) == y*exp(z)", ["x**2 == 2*y"]),
], ids=str)  # fmt: skip
def test_a_point_is_looked_for_although_both_sides_share_a_function(claim, given):
    """The function cancels in the difference; a point with values for the symbols alone then led to a KeyError."""
    assert verdict_of(claim, given) in ("false", "undecided")


DEFINED = (
    "x**(1/3)*x**(2/3) == x", "(x**3)**(1/3) == x", "(x**2)**(1/3) == abs(x)**(2/3)",     "sqrt(1/10000 - (x - 37/10)**2) == sqrt((1/100 - x + 37/10)*(1/100 + x - 37/10))", "log(log(log(x))) == log(log(log(x)))",
    "sqrt(4*x*z - y**2)**2 == 4*x*z - y**2", "acos(x) + asin(x) == pi/2", "8**(1/3) == 2", "(x*y)**(1/3) == (y*x)**(1/3)",
    "sqrt(sqrt(5+2*sqrt(6))-sqrt(2)-sqrt(3)) == 0", "integrate(sqrt(x**2)**2, (x, -1, 1)) == 2/3",
)  # fmt: skip


@pytest.mark.parametrize("claim", DEFINED)
def test_what_holds_where_it_is_defined_is_true(claim):
    assert verdict_of(claim) == "true"


@pytest.mark.parametrize(("claim", "given"), [
    ("sqrt(y) == sqrt(y)", ["y == sin(x)"]), ("2*log(x) == 2*y", ["log(x) == y"]), ("cos(x)**2 == y**2", ["cos(x) == y"]),
    ("acos(x) + asin(x) == pi/2", ["x == 1/2"]), ("x + y == y + x", ["x**5 + y**5 + exp(x) == 3"]),
], ids=str)  # fmt: skip
def test_what_follows_from_hypotheses_on_functions_is_true_of_a_point_in_a_proven_box(claim, given):
    assert verdict_of(claim, given) == "true"


@pytest.mark.parametrize("claim", [
    "integrate(sqrt(x)**2, (x, -1, 1)) == 0", "integrate(x/x, (x, -1, 1)) == 2", "integrate(0*log(x) + x, (x, -1, 1)) == 0",
])  # fmt: skip
def test_an_integrand_has_values_on_the_whole_interval(claim):
    assert verdict_of(claim) == "refused"


def test_a_point_is_shown_without_the_angles_that_are_not_chosen():
    claim = "sqrt(abs(sqrt(x - y) + tanh(x) - tanh(x))) == sqrt(abs(sqrt(-x - y) + 0*log(sin(x) - 1)))"
    assert verdict_of(claim) in ("false", "undecided", "refused")


def test_a_condition_is_given_only_where_it_can_hold():
    assert verdict_of("sqrt(x**2) == x") == "conditional"
    assert verdict_of("sqrt(x**2)*log(-x) == x*log(-x)") == "false"
    assert verdict_of("abs(x)*sqrt(-x-1) == x*sqrt(-x-1)") == "false"


@pytest.mark.parametrize(("claim", "condition"), [
    ("asin(sin(x)) == x", "-pi/2 <= x <= pi/2"), ("acos(cos(x)) == x", "0 <= x <= pi"),
    ("atan(tan(x)) == x", "-pi/2 < x < pi/2"), ("2*asin(sin(x)) + y == 2*x + y", "-pi/2 <= x <= pi/2"),
    ("acos(sin(x)) == pi/2 - x", "-pi/2 <= x <= pi/2"), ("asin(sin(x)) == pi - x", "pi/2 <= x <= 3*pi/2"),
    ("asin(sin(sqrt(x)))*y == sqrt(x)*y", "sqrt(x) <= pi/2"),
])  # fmt: skip
def test_an_inverse_function_undoes_its_function_for_principal_values(claim, condition):
    found = symrot.check(claim, repair=False)
    assert (found.verdict, found.requires) == ("conditional", (condition,))
    assert fault(claim, found, Random(1)) == ""
    wider = replace(found, requires=(condition.replace("pi", "(7*pi/2)"),))
    assert "under its condition" in fault(claim, wider, Random(1))


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("claim", "point"), [
    ("atan2(-y, x) == -atan2(y, x)", {"x": "-1", "y": "0"}), ("atan2(-x, y) + atan2(x, y) == 0", {"x": "0", "y": "-1"}),
    ("atan2(-x**2, -1) == -atan2(x**2, -1)", {"x": "0"}), ("atan2(1 - y, x) == -atan2(y - 1, x)", {"x": "-1", "y": "1"}),
    ("atan2(7 - 3*y, x)*z == -atan2(3*y - 7, x)*z", {"x": "-1/3", "y": "7/3", "z": "-1"}),
    ("Matrix([x, atan2(-y, x)]) == Matrix([x, -atan2(y, x)])", {"x": "-1", "y": "0"}),
    ("a*b*c + atan2(-y, x) == a*b*c - atan2(y, x)", {"a": "1", "b": "1", "c": "1", "x": "-1", "y": "0"}),
    ("atan2(-sin(x), cos(x)) == -atan2(sin(x), cos(x))", {"x": "pi"}),
    ("atan2(2 - x**2, -1) == -atan2(x**2 - 2, -1)", {"x": "-sqrt(2)"}), ("atan2(sqrt(2) - x, -1) == -atan2(x - sqrt(2), -1)", {"x": "sqrt(2)"}),
])  # fmt: skip
def test_a_claim_that_fails_on_the_cut_of_atan2_is_conditional(claim, point):
    """atan2(-0, -1) = pi but -atan2(0, -1) = -pi; only there is the denominator of the proof zero."""
    found = symrot.check(claim)
    assert found.verdict == "conditional" and found.counterexample.values == point
    assert found.diagnosis.code == "principal_value"


@pytest.mark.parametrize(("claim", "given", "condition"), [
    ("atan2(-y, x) == -atan2(y, x)", "x**2 + y**2 == 1", "y != 0 or x > 0"), ("atan2(-y, x) == -atan2(y, x)", "z == 1", "y != 0 or x > 0"),
    ("atan2(-y, -x) == atan2(y, x) + pi", "z == 1", "y <= 0 and (y != 0 or x > 0)"),
    ("atan2(k*y, k*x) == atan2(y, x)", "k > 0", None), ("atan2(-y, x) == -atan2(y, x)", "y > 0", None), ("atan2(-y, x) == -atan2(y, x)", "y != 0", None),
])  # fmt: skip
def test_a_hypothesis_holds_on_the_cut_of_atan2_too(claim, given, condition):
    found = symrot.check(claim, assume=[given], repair=False)
    assert (found.verdict, found.requires) == (("conditional", (condition,)) if condition else ("true", ()))


@pytest.mark.parametrize("claim", [
    "atan2(y, x) == atan2(2*y, 2*x)", "atan2(y, x) == 2*atan(y/(sqrt(x**2+y**2)+x))", "atan2(x*y, x**2) == atan(y/x)",
    "2*atan2(y, x + sqrt(x**2 + y**2)) == atan2(y, x)", "atan2(2*x*y, x**2 - y**2) == 2*atan(y/x)", "cos(atan2(y, x)) == x/sqrt(x**2+y**2)",
])  # fmt: skip
def test_a_claim_with_atan2_that_holds_on_the_cut_stays_true(claim):
    assert verdict_of(claim) == "true"


@pytest.mark.parametrize(("claim", "verdict"), [
    ("asin(sin(x)) == x + 4", "false"), ("acos(cos(x)) == -x - 1", "false"), ("acos(cos(abs(x))) == x", "false"),
    ("atan(tan(atan(x))) == atan(x)", "true"),
    ("asin(sin(x + 2*pi)) == x", "conditional"),
])  # fmt: skip
def test_other_values_are_no_principal_values(claim, verdict):
    found = symrot.check(claim, repair=False)
    assert (found.verdict, fault(claim, found, Random(1))) == (verdict, "")


@pytest.mark.parametrize("claim", [
    "sqrt(x/(-exp(x))) == sqrt(((x*(2/(-exp(x)) - 1/(-exp(x))))**2 - 1)/(x*(2/(-exp(x)) - 1/(-exp(x))) - 1) - 1)",
    "sqrt(x*exp(3*x))*sqrt(x*exp(-x/2)) == x*exp(5*x/4)", "sqrt(-x/exp(-x/3)) == exp(x/6)*sqrt(-x)",
])  # fmt: skip
def test_an_exponential_that_only_a_relation_brings_in_is_read(claim):
    """The ring of sqrt(x exp(-x)) divides by exp(x/2), which does not occur in the text."""
    assert verdict_of(claim) == "true"


PI = "pi*sqrt(2)/(((sqrt(2)**2 - 1)/(sqrt(2) - 1))**2/(1 + sqrt(2)) - 1)"


@pytest.mark.parametrize("claim", [
    "acos(cos(log(exp(-pi)))) == acos(cos(-pi*sqrt(2)/(((-(sqrt(2)**2 - 1)*1/(sqrt(2) - 1))**2 - 1)/((sqrt(2)**2 - 1)/(sqrt(2) - 1) - 1) - 1 - 1)))",
    f"acos(cos({PI})) == pi", f"atan(tan({PI}/2 + x)) == 1", f"asin(sin({PI}/2)) == pi/2", f"x == acos(cos({PI}))",
    f"acos(cos({PI})) + x", f"abs(acos(cos({PI}))) == x",
])  # fmt: skip
def test_numbers_that_sympy_cannot_order_end_in_a_sentence(claim):
    """SymPy compares ``acos(cos(c))`` with pi when it builds it; here c is pi in a form that SymPy does not recognise."""
    assert verdict_of(claim) in ("refused", "undecided", "true", "false", "definition")


LONG = (
    "atan(cosh(log(exp(tan(x**4 - x + 5))))) == atan(cosh(tan((x + asin(-x - 1) - asin(x - log(exp(1*x/x))))**4 - x + 5)))",
    "sqrt(1/2/(abs(y) + 1)) == sqrt(1/2/(abs(y + sqrt((1 + 2 - 5*2)/x) - sqrt(1*1/x*log(y)**(1/3)/log(y)**(1/3))) + 1))",
    "sqrt(x/y/asin(x)) == sqrt(x/y/asin((x**2 - 1)/(x - 1) - 1))",
    "tan((x + asin(y) + asin(z) + 1)**4) == 1",
    "(tan(y)**2)**(1/3) == ((tan(log(exp(y**2 - 1))/(y - 1) - 1)**2)**2)**(1/6)",
)


@pytest.mark.parametrize(
    "claim", [*LONG[2::2], *(pytest.param(claim, marks=pytest.mark.campaign) for claim in (LONG[0], *LONG[1::2]))]
)
def test_an_answer_comes_within_a_few_seconds_of_work(claim):
    """Sums of 16 angles were expanded, polynomials factored over fields of degree 4, and one pair replaced endlessly."""
    start = process_time()
    verdict_of(claim)
    assert process_time() - start < 20


def test_a_root_of_a_product_with_a_square_is_split_only_where_both_parts_are_real():
    """sqrt((x-1)^2 a) = |x-1| sqrt(a) for a >= 0; at x = 1 the left side has a value for a < 0 too."""
    verdict = symrot.check("sqrt(a*x**2 - 2*a*x + a) == abs(x-1)*sqrt(a*b)/sqrt(b)", repair=False)
    assert verdict.verdict == "true"
    assert "a >= 0" in verdict.conditions


@pytest.mark.parametrize(
    "claim", ["log(exp(-(1/2 + 0*log(tanh(x))))) == (-x)**(1/3)", "0*log(tanh(x)) == 1 + sqrt(-x)"]
)
def test_a_counterexample_is_no_point_at_which_a_cancelled_logarithm_has_no_value(claim):
    """log(tanh(x)) needs x > 0 and the root of -x needs x <= 0, so that no point has both."""
    assert verdict_of(claim) == "undecided"


def test_a_divisor_that_is_a_function_of_a_symbol_does_not_vanish_at_a_counterexample():
    verdict = symrot.check("0/sinh(x) == 1 + sqrt(-x)", repair=False)
    assert verdict.verdict == "false"
    assert verdict.counterexample.values["x"] != "0"


@pytest.mark.parametrize("claim", [
    "(-1/(-5 + cos(1)))**(1/3) == 1", "(1/2)**(1/3) == ((cos(1) - 1)/(cos(1) - 5))**(1/3)",
])  # fmt: skip
def test_a_root_of_a_quotient_of_two_negative_numbers_is_real(claim):
    assert verdict_of(claim) == "false"


# -- the exact core ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "formula", [(-8) ** THIRD, (-abs(x)) ** THIRD, x + (-2) ** Rational(1, 5), (-27) ** Rational(2, 3)]
)
def test_the_core_refuses_a_root_that_is_no_real_number(formula):
    for read in (normal_form, is_zero):
        with pytest.raises(InputError, match="is not a real number"):
            read(formula)


@pytest.mark.parametrize(("left", "right"), [
    (sqrt(cos(x) - 2), sqrt(cos(x) - 2)), ((-(x**2) - 1) ** THIRD, (-(x**2) - 1) ** THIRD),
    (asin(exp(x) + 2) + acos(exp(x) + 2), asin(exp(x) + 2) + acos(exp(x) + 2)), (log(-exp(x) - 1), log(-exp(x) - 1)),
])  # fmt: skip
def test_the_core_refuses_sides_that_are_real_nowhere(left, right):
    with pytest.raises(InputError, match="expected sides that are real for some real values of their symbols"):
        decide(left, right)


def test_the_core_says_undecided_where_no_point_of_both_sides_is_known():
    assert decide(sqrt(x) * sqrt(-x - 1), sqrt(-x * (x + 1))).verdict == "undecided"
    assert decide(sqrt(x) * sqrt(x + 1), sqrt(x * (x + 1))).verdict == "true"


def test_complex_numbers_that_are_written_out_stay_readable_in_the_core_and_are_refused_in_claims():
    assert decide((cos(x) + I) * (cos(x) - I), cos(x) ** 2 + 1).verdict == "true"
    with pytest.raises(InputError, match="real"):
        symrot.check((cos(x) + I) * (cos(x) - I), cos(x) ** 2 + 1)


# -- towers and deep nestings -----------------------------------------------------------------------------------------

FUNCTIONS = ("log", "exp", "sqrt", "sin", "asin", "acos", "atan", "cosh", "tanh", "abs", "tan")


@pytest.mark.thinned(4)
@pytest.mark.parametrize("deep", [4, 12, 50])
@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_tower_of_functions_has_an_answer(function, deep):
    tower = f"{function}(" * deep + "x" + ")" * deep
    refused = deep > 16 and function not in ("sqrt", "abs")  # SymPy joins these two
    assert verdict_of(f"{tower} == x") in (("refused",) if refused else ("false", "undecided", "conditional"))


def test_functions_that_are_nested_too_deeply_are_refused_in_one_sentence():
    sixteen = "sin((" * 8 + "x" + ")**(1/3))" * 8
    sentence = "at most 16 functions and roots inside each other"
    assert verdict_of(f"{sixteen} == {sixteen}") != "refused"
    for claim in (f"exp({sixteen}) == 1", f"({sixteen})**(1/2) == 1", f"atan2(1, {sixteen}) == 1"):
        with pytest.raises(InputError, match=sentence):
            symrot.check(claim)
    tower = x
    for _ in range(17):
        tower = sin(tower)
    with pytest.raises(InputError, match=sentence):
        symrot.check(Matrix([0, tower]), Matrix([0, 0]))


@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_tower_over_a_number_has_an_answer(function):
    assert verdict_of(f"{function}(" * 8 + "3" + ")" * 8 + " == 1") in ("false", "undecided", "refused")


def test_the_readings_of_one_decision_are_counted():
    tower = "tan(asin(atan(exp(asin(atan(cosh(abs(sin(atan(x))))))))))"
    other = "tan(asin(atan(exp(pi/2 - acos(atan(cosh(abs(sin(atan(x))))))*2**(1/6)/2**(1/6)))))"
    assert verdict_of(f"{tower} == {other}") == "undecided"


RECURSIVE = (
    "cosh(y**2/tan(-x)) == sqrt(1 + sinh(y**2/tan(-x))**2)", "cosh(y/sin(x)) == sqrt(1 + sinh(y/sin(x))**2)",
    "cosh(1/tan(x)**3) == sqrt(1 + sinh(1/tan(x)**3)**2)", "cosh(sqrt(x)) == sqrt(1 + sinh(sqrt(x))**2)",
)  # fmt: skip


@pytest.mark.parametrize("claim", RECURSIVE)
def test_roots_that_depend_on_each_other_in_a_circle_are_read(claim):
    assert verdict_of(claim) == "true"


@pytest.mark.parametrize("deep", [40, 80])
def test_a_deep_formula_of_sympy_is_refused(deep):
    tower = x
    for _ in range(deep):
        tower = cos(1 + tower**2)
    with pytest.raises(InputError, match=r"at most 16 functions and roots inside each other$"):
        symrot.check(tower, x, repair=False)


def test_a_long_sum_is_read():
    assert verdict_of(" + ".join(["x"] * 2000) + " == 2000*x") == "true"


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "verdict", "condition"), [
    ("atan2(sin(a), cos(a)) == a", "conditional", "-pi < a <= pi"),
    ("atan2(cos(t)*sin(p), cos(t)*cos(p)) == p", "conditional", "cos(t) > 0 and -pi < p <= pi"),
    ("atan2(b*sin(a), b*cos(a)) == a", "conditional", "b > 0 and -pi < a <= pi"),
    ("atan2(sin(a), -cos(a)) == pi - a", "conditional", "0 <= a < 2*pi"),
    ("atan2(sqrt(1 - cos(a)**2), cos(a)) == a", "conditional", "0 <= a <= pi"),
    ("atan2(sqrt(1 - b**2*cos(a)**2), b*cos(a)) == a", "false", None),
    ("atan2(sin(a), cos(a)) == a + 1", "false", None), ("atan2(sin(a), cos(a)) == -a", "false", None),
    ("atan2(-sin(a), -cos(a)) == a", "false", None), ("atan2(cos(a), sin(a)) == a", "false", None),
])  # fmt: skip
def test_atan2_of_the_components_of_a_direction_is_its_angle_on_one_branch(claim, verdict, condition):
    decided = symrot.check(claim, repair=False)
    assert (decided.verdict, *decided.requires) == (verdict, *([condition] if condition else []))
    assert decided.counterexample


@pytest.mark.parametrize(("claim", "where"), [
    ("atan2(sin(a), cos(a)) == a", ()), ("acos(cos(x)) == x", ()), ("asin(sin(x)) == x", ()),
    ("atan2(b*sin(a), b*cos(a)) == a", ()), ("atan2(cos(t)*sin(p), cos(t)*cos(p)) == p", ()),
    ("x/x == 1", ("x != 0",)), ("(x**2 + 1)/(x**2 + 1) == 1", ()), ("sqrt(1 - x**2)**2 == 1 - x**2", ("-1 <= x <= 1",)),
])  # fmt: skip
def test_a_condition_that_holds_everywhere_or_follows_from_another_is_not_printed(claim, where):
    decided = symrot.check(claim, repair=False)
    assert tuple(text for text in decided.conditions if text not in decided.requires) == where

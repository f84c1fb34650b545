"""Equations for a letter are neither true nor false; wrong identities stay false."""

import pytest

import symrot


@pytest.mark.parametrize(("text", "values"), [
    ("x² = 4", "x = -2 and x = 2"), ("x^2 + 5x + 6 = 0", "x = -3 and x = -2"), ("x^3 = 2x - 5", "one real value only"),
    ("sin θ = 3/5", "θ = asin(3/5), for example"), ("1/x = 2", "x = 1/2"), ("|x| = 2", "x = 2, for example"),
    (r"\cos\theta = \frac{1}{2}", r"\theta = \frac{\pi}{3}, for example"), ("1/x^2 = 4", "x = 1/2, for example"),
])  # fmt: skip
def test_an_equation_for_a_letter_says_for_which_values_it_holds(text, values):
    verdict = symrot.check(text)
    assert (verdict.verdict, verdict.counterexample, verdict.repairs) == ("definition", None, ())
    assert verdict.reason.endswith(f"not an identity: it holds for {values}")


def test_two_letters_are_a_condition():
    assert symrot.check("a = b").verdict == "definition"


@pytest.mark.parametrize("text", [
    "2x = 3x", "(x + 1)^2 = x^2 + 1", "3x + 2 = 5x", "x² = -1", "cos θ = 2", "√x = -3", "sin^2 x - cos^2 x = 1", "x**2 == 4",
    "x² == 4",
])  # fmt: skip
def test_a_wrong_identity_and_an_equation_without_a_solution_are_false(text):
    assert symrot.check(text, repair=False).verdict == "false"


def test_a_derivative_that_is_a_hidden_zero_is_no_condition():
    """``diff(x, t) == 0`` states that x is constant, but nobody writes this zero as ``2*y - y - y``."""
    assert symrot.check("diff(sin(x(t)), t) == 0", repair=False).verdict == "definition"
    assert symrot.check("diff(sin(x(t)), t) == 2*y - y - y", repair=False).verdict == "false"


LAWS = (
    "m*a {} k*x", "m*v**2/2 {} m*g*h", "tan(a)*x {} tan(c)*z/(z + y - y)*x", "m*a {} m*g - T",
    "diff(Rz(phi(t)), t) {} skew(0, 0, x)*Rz(phi(t))", "sin(theta(t))*diff(phi(t), t) {} x*y",
)  # fmt: skip
"""Equations whose sides name no quantity, without the equals sign."""


@pytest.mark.parametrize("text", LAWS)
def test_a_double_equals_sign_claims_an_identity_and_a_single_one_relates_quantities(text):
    claimed = symrot.check(text.format("=="), repair=False)
    assert claimed.verdict == "false" and claimed.counterexample
    assert any(note.startswith("== claims that both sides are equal for all values") for note in claimed.notes)
    related = symrot.check(text.format("="), repair=False)
    assert (related.verdict, related.counterexample) == ("definition", None)


def test_the_derivative_of_a_formula_of_constants_is_no_unknown_quantity():
    assert symrot.check("diff(x*cos(phi(t))**2, t) == diff(x, t)", repair=False).verdict == "false"
    assert symrot.check("diff(Rz(phi(t)), t) == diff(Rz(-b), t)", repair=False).verdict == "false"


@pytest.mark.parametrize("text", [
    "m*a == F", "L**2 == m*x*y", "2*E1 == m*a", "cos(theta) == x/y", "diff(x(t), t, 2) == -k*x(t)/m",
    "m*diff(x(t), t, 2) + k*x(t) == 0", "(m + M)*x(t).diff(t, 2) == -k*x(t)", "diff(x(t)**2, t) == 0",
    "Matrix([a_x, a_y]) == Matrix([m*b, m*c])",
])  # fmt: skip
def test_a_side_with_one_quantity_names_it_and_a_rate_makes_an_equation_of_motion_with_both_signs(text):
    assert symrot.check(text, repair=False).verdict == "definition"
    assert symrot.check(text.replace("==", "="), repair=False).verdict == "definition"


def test_a_law_that_symrot_derives_is_recognised_with_both_signs():
    law = "lambda_1*Omega**2*cos(theta) - lambda_3*w_3*Omega + M*g*R {} 0"
    assert [symrot.check(law.format(sign)).verdict for sign in ("=", "==")] == ["recognised", "recognised"]


def test_a_built_in_rotation_is_no_matrix_of_unknown_entries():
    assert not any("any 3 x 3 matrix" in note for note in symrot.check(LAWS[4].format("=="), repair=False).notes)


@pytest.mark.parametrize(("claim", "values"), [
    ("y^2 = pi", "y = -sqrt(pi) and y = sqrt(pi)"), ("x^2 - sqrt(2) x = 0", "x = 0 and x = sqrt(2)"), ("sqrt(2) x + x^2 = -1/2", "x = -sqrt(2)/2"),
])  # fmt: skip
def test_an_equation_with_irrational_coefficients_is_solved(claim, values):
    """The search for solutions ended with an exception of SymPy."""
    verdict = symrot.check(claim)
    assert verdict.verdict == "definition"
    assert all(value in verdict.reason for value in values.split(" and "))


@pytest.mark.parametrize("claim", ["y^2 == pi", "y^2 + pi = 0", "x^3 = pi", "y^2 = exp(x)"])
def test_an_irrational_equation_that_is_not_solved_ends_in_a_verdict(claim):
    assert symrot.check(claim).verdict in ("false", "definition")


@pytest.mark.parametrize("claim", ["det(A - λ I) = 0", "λ^3 - tr(A) λ^2 + (tr(A)^2 - tr(A^2))/2 λ - det A = 0"])
def test_the_characteristic_equation_of_a_matrix_is_no_identity(claim):
    assert symrot.check(claim).verdict == "definition"
    assert symrot.check(f"{claim[:-4]} - ({claim[:-4]}) = 0").verdict == "true"


@pytest.mark.parametrize("claim", ["tr R = 3 q_0^2 - q_1^2 - q_2^2 - q_3^2", "[ω]× = R^T R'"])
def test_a_claim_with_letters_that_depend_on_a_rotation_is_not_denied(claim):
    assert not any("does not hold for all rotations" in note for note in symrot.check(claim).notes)

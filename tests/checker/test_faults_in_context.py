"""Faults that show by what the context says, by the lines beside a formula, or by the whole of a formula."""

from types import SimpleNamespace

import pytest
from sympy import Symbol

import symrot
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import text
from symrot.checker.repair.edits.sums_and_products import bracketed
from tests.campaigns.checker.repair_claims import claims_of_step

CONES = ["theta = angle between axis and H", "gamma = angle between axis and omega", "I_s = moment about the axis",
         "I = transverse moment"]  # fmt: skip
FREE = "free symmetric body with moments I_1, I_1, I_3"
MATRIX = ["A = rotation matrix", "Phi = angle of the rotation"]


@pytest.mark.parametrize(("formula", "context"), [
    ("cos(Phi) = (tr(A) - 1)/2", {"where": MATRIX}),  # the entries of A have the meaning of A
    ("J_O = J_c + m (r^T r I_3 - r r^T)", {"where": ["J_O = inertia matrix", "J_c = inertia matrix"]}),
    ("M = I Omega p", {"where": ["p = spin", "Omega = precession rate"]}),  # either rate may be the spin
    ("lambda = (J_3 - J_1)/J_1 n",
     {"where": ["lambda = rate of precession in the body frame", "n = angular velocity along the axis"]}),
])  # fmt: skip
def test_a_correct_formula_stays_recognised_in_a_context_that_fits(formula, context):
    assert symrot.check(formula, repair=False, **context).verdict in ("true", "recognised")


@pytest.mark.parametrize(("formula", "context", "code", "repair"), [
    ("tan gamma = (I/I_s) tan theta", {"where": CONES}, "wrong_symbol", "tan(gamma) = I_s/I*tan(theta)"),
    ("cos(Phi) = tr(A) - 1", {"where": MATRIX}, "factor", "cos(Phi) = 1/2*(trace(A) - 1)"),
    ("p_psi = I_3 psi'", {"where": ["p_psi = momentum of psi of a symmetric top with Euler angles phi, theta, psi"]},
     "missing_term", "p_psi = I_3*(psi' + cos(theta)*phi')"),
    ("phi' = I_3 omega_3/I_1", {"where": ["phi' = precession rate in space"], "body": FREE}, "factor",
     "phi' = I_3*omega_3/(I_1*cos(theta))"),
    ("sum M_z = I_z omega_z'", {"body": "asymmetric body in general motion, principal axes x, y, z"}, "missing_term",
     "M_z = -I_x*omega_x*omega_y + I_y*omega_x*omega_y + I_z*omega_z'"),
    ("phi' = M g l sin theta/(I_3 omega_3)", {"body": "fast top"}, "factor", "phi' = M*g*l/(I_3*omega_3)"),
])  # fmt: skip
def test_a_fault_that_the_context_shows_is_named_and_repaired(formula, context, code, repair):
    verdict = symrot.check(formula, **context)
    assert (bool(verdict), verdict.diagnosis.code) == (False, code)
    assert [offer.text for offer in verdict.repairs][:1] == [repair]


def test_a_formula_of_a_body_that_is_symmetric_about_another_axis_is_written_for_equal_moments():
    assert symrot.check("T = 1/2 (A p^2 + B (q^2 + r^2))").verdict != "doubtful"
    verdict = symrot.check("L = (I_1 omega_1, I_2 omega_2, I_2 omega_3)")  # or the second I_2 is a misprint
    assert verdict.verdict == "definition"
    assert "symmetric about axis 1" in verdict.reason and "wrong index" in verdict.reason


def test_brackets_may_be_missing_behind_and_in_front_of_a_factor():
    (*terms,) = read_expression("w - a + b*c").args
    assert "w - (a + b)*c" in [text(made) for made in bracketed(terms)]
    verdict = symrot.check("psi' = omega_3 - omega_1 sin psi + omega_2 cos psi cot theta")
    assert verdict.diagnosis.code == "lost_brackets"
    assert symrot.check("cos(x)*cos(y) + sin(x) == cos(x)*(cos(y) + sin(x))").diagnosis.code == "lost_brackets"


def test_inverse_functions_and_the_arguments_of_atan2_are_exchanged():
    matrix = ["R = Rz(psi) Ry(theta) Rx(phi)"]
    assert symrot.check("psi = atan2(R11, R21)", assume=matrix).diagnosis.code == "wrong_symbol"
    assert symrot.check("theta = -acos(R31)", assume=matrix).diagnosis.code == "sin_cos_swap"
    assert symrot.check("θ = acos(q_0)", where=["theta = angle of rotation"]).diagnosis.code == "half_angle"


def test_the_reading_that_the_context_makes_false_counts_before_one_that_nothing_explains():
    verdict = symrot.check("omega_x' = phi' sin psi + theta' cos psi", frame="body", sequence="ZXZ")
    assert (verdict.verdict, verdict.diagnosis.code) == ("false", "factor")


def test_a_component_that_a_product_of_quaternions_lacks_has_the_name_of_its_place():
    verdict = symrot.check("x = a1 b2 + b1 a2 + c1 d2 - d1 b2")
    assert [offer.text for offer in verdict.repairs] == ["x = a1*b2 + b1*a2 + c1*d2 - d1*c2"]


def test_a_step_with_names_that_the_reader_does_not_know_is_left_out_of_the_campaign():
    index, rest = Symbol("a_{k-2}", real=True), Symbol("b", real=True)
    step = SimpleNamespace(left=rest, right=rest + 1, hypotheses=(index - rest,))
    assert claims_of_step(step, "series") == []


@pytest.mark.parametrize("claim", [
    "M_1 = A ω_1' + (C - B) ω_2 ω_3", "A ω_1' = (B - C) ω_2 ω_3", "dL/dt = M - ω × L", "T = 1/2 (A ω_1^2 + B ω_2^2 + C ω_3^2)",
])  # fmt: skip
def test_a_formula_for_principal_axes_is_none_for_the_space_frame(claim):
    assert symrot.check(claim, frame="body").verdict in ("true", "recognised")
    assert symrot.check(claim, frame="space").verdict not in ("true", "recognised")


@pytest.mark.parametrize("axis", [1, 2, 3])
@pytest.mark.parametrize("frame", ["body", "space"])
def test_a_quaternion_and_its_rate_are_not_exchanged(axis, frame):
    """ω = 2 q* q' in the body frame and 2 q' q* in space differ by the sign of a cross product of q and q'."""
    j, k = axis % 3 + 1, (axis + 1) % 3 + 1
    crossed = {"body": f"- q_{j} q_{k}' + q_{k} q_{j}'", "space": f"+ q_{j} q_{k}' - q_{k} q_{j}'"}
    for other, terms in crossed.items():
        claim = f"ω_{axis} = 2(q_0 q_{axis}' - q_{axis} q_0' {terms})"
        verdict = symrot.check(claim, frame=frame, repair=False)
        assert (verdict.verdict in ("true", "recognised")) == (other == frame)
        assert not any("derives" in note for note in verdict.notes)


def test_an_equation_of_vectors_holds_in_both_frames():
    assert symrot.check("M = I ω' + ω × I ω", frame="space").verdict == "true"

"""Claims in a context are decided by the relations between quantities, whatever they are solved for."""

import pytest
from sympy import Matrix, Symbol

import symrot
from symrot.checker.context.angle_orders import orders
from symrot.checker.context.context import NO_CONTEXT
from symrot.checker.context.relations.substitution import Substitution, decided
from symrot.checker.context.statements import read_context
from symrot.checker.decide.equation import Equation
from symrot.conventions import SEQUENCES
from symrot.kinematics.euler import rate_jacobian

ZXZ, ZYX = {"sequence": "ZXZ", "frame": "body"}, {"sequence": "ZYX", "frame": "body"}
TOP, FREE = {"body": "heavy symmetric top"}, "free symmetric body"
PLUS, MINUS = "I_xy, I_xz = ∫ xy dm", "I_xy, I_xz = -∫ xy dm"


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("ψ̇ = ω_z - φ̇ cos θ", "true", ZXZ),
    ("psi' = omega_3 + phi' cos theta", "false", ZXZ),
    ("phi' = (omega_3 - psi')/cos theta", "true", ZXZ),
    ("phi' = (omega_3 - psi')/sin theta", "false", ZXZ),
    ("phi' = p + psi' sin theta", "true", ZYX),
    ("phi' = p - psi' sin theta", "false", ZYX),
    ("omega_1^2 + omega_2^2 = theta'^2 + phi'^2 sin^2 theta", "true", ZXZ),
    ("omega_1^2 + omega_2^2 = theta'^2 - phi'^2 sin^2 theta", "false", ZXZ),
    ("psi' = omega_3 - phi' cos theta", "recognised", {}),
    ("psi' = omega_3 + phi' cos theta", "doubtful", {}),
])  # fmt: skip
def test_rates_and_components_may_be_mixed(text, verdict, context):
    assert symrot.check(text, **context, repair=verdict == "doubtful").verdict == verdict


@pytest.mark.parametrize("sequence", SEQUENCES, ids=str)
def test_each_row_of_the_rate_jacobian_is_a_true_reading_and_a_wrong_sign_is_none(sequence):
    """The exact decision after the substitution, without the search for names."""
    q, dq = [Symbol(f"q_{n}", real=True) for n in (1, 2, 3)], [Symbol(f"dq_{n}", real=True) for n in (1, 2, 3)]
    omega = Matrix(rate_jacobian(sequence, "body", q)) * Matrix(dq)
    component = Symbol("omega_2", real=True)
    values = {component: omega[1]}
    way = Substitution("omega = B dq/dt", "", values)
    assert decided(Equation(component, omega[1]), way).verdict == "true"
    assert decided(Equation(component, omega[1] - 2 * dq[0] * omega[1].diff(dq[0])), way).verdict in (
        ("true",) if not omega[1].diff(dq[0]) else ("false",)
    )


@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("omega_x = alpha' - gamma' sin beta", "false", {**ZYX, "where": ["alpha = yaw"]}),
    ("omega_x = alpha' - gamma' sin beta", "true", {**ZYX, "where": ["alpha = roll"]}),
    ("omega_x = alpha' cos gamma cos beta - beta' sin gamma", "true",
     {"sequence": "ZYX", "frame": "space", "where": ["gamma = yaw"]}),
    ("psi' = (q sin phi + r cos phi)/cos theta", "recognised", {"where": ["psi = yaw", "theta = pitch", "phi = roll"]}),
    ("psi' = (q sin phi + r cos phi)/cos theta", "doubtful", {"where": ["psi = roll", "theta = pitch", "phi = yaw"]}),
])  # fmt: skip
def test_words_about_a_letter_decide_which_angle_it_is(text, verdict, context):
    assert symrot.check(text, **context, repair=verdict == "doubtful").verdict == verdict


def test_yaw_is_the_angle_about_z_in_every_sequence_of_three_axes():
    context = read_context(["alpha = yaw"])
    for sequence in (name for name in SEQUENCES if name[0] != name[-1]):
        places = {order.places["alpha"] for order in orders(context, ["alpha", "beta"], sequence)}
        assert places == {sequence.upper().index("Z")}
    assert not [*orders(NO_CONTEXT, ["alpha", "theta"], "ZXZ")]  # no book uses these together


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("L_x = I_xx omega_x - I_xy omega_y - I_xz omega_z", "true", {"where": [PLUS]}),
    ("L_x = I_xx omega_x + I_xy omega_y + I_xz omega_z", "false", {"where": [PLUS]}),
    ("L_x = I_xx omega_x + I_xy omega_y + I_xz omega_z", "true", {"where": [MINUS]}),
    ("L_x = I_xx omega_x - I_xy omega_y - I_xz omega_z", "false", {"where": [MINUS]}),
    ("L_x = I_xx omega_x - I_xy omega_y - I_xz omega_z", "true",
     {"where": ["I_xy, I_xz = product of inertia ∫ xy dm"]}),
    ("I_xy' = I_xy + m d_x d_y", "recognised", {"where": ["I_xy = ∫ xy dm"]}),
    ("I_xy' = I_xy - m d_x d_y", "doubtful", {"where": ["I_xy = ∫ xy dm"]}),
    (r"I_{xy} = \int x y\, dm", "recognised", {}),
    (r"I_{xy} = -\int x y\, dm", "recognised", {}),
    (r"I_{xy} = \int x y\, dm", "true", {"where": ["I_xy = product of inertia without the minus sign"]}),
    (r"I_{xx} = \int (y^2 + z^2)\, dm", "recognised", {}),
    (r"I_{xx} = \int (y^2 + x^2)\, dm", "definition", {}),
])  # fmt: skip
def test_the_sign_of_products_of_inertia_is_the_stated_one(text, verdict, context):
    assert symrot.check(text, **context, repair=verdict == "doubtful").verdict == verdict


def test_a_product_without_the_minus_sign_is_called_that():
    verdict = symrot.check(r"I_{xy} = \int x y\, dm")
    assert "products of inertia without the minus sign" in verdict.recognised_as[0].name
    verdict = symrot.check("L_x = I_xx omega_x + I_xy omega_y + I_xz omega_z", where=[PLUS])
    assert verdict.repairs[0].text == "L_x = I_xx*omega_x - I_xy*omega_y - I_xz*omega_z"


def test_both_signs_of_products_in_one_context_are_refused():
    with pytest.raises(
        symrot.InputError,
        match=r"expected all products of inertia with the same sign convention, got I_xy as .* and I_xz",
    ):
        symrot.check("L_x = I_xy omega_y + I_xz omega_z", where=["I_xy = ∫ xy dm", "I_xz = -∫ xz dm"])


@pytest.mark.thinned(4)
@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("p_φ = I_1 φ' sin²θ + I_3 ω_3 cos θ", "recognised", {}),
    ("p_φ = I_1 φ' sin²θ + I_3 s cos θ", "recognised", TOP),
    ("p_φ = I_1 φ' sin²θ - I_3 ω_3 cos θ", "definition", {}),
    ("p_ψ = I_3 ω_3", "recognised", {}),
    ("p_ψ = I_1 ω_3", "definition", {}),
    ("V_eff = (L_z - L_3 cos θ)²/(2 I_1 sin²θ) + m g l cos θ", "recognised", {}),
    ("E' = E - L_3²/(2 I_3)", "recognised", {}),
    ("E' = E + L_3²/(2 I_3)", "definition", {}),
    ("ψ' = ω_3 - cos θ (L_z - L_3 cos θ)/(I_1 sin²θ)", "recognised", {}),
    ("φ' = I_3 ω_3/(2 I_1 cos θ) (1 - sqrt(1 - 4 I_1 m g l cos θ/(I_3² ω_3²)))", "recognised", {}),
])  # fmt: skip
def test_spin_momenta_and_energies_of_a_top_may_be_mixed(text, verdict, context):
    assert symrot.check(text, **context).verdict == verdict


@pytest.mark.parametrize(("text", "verdict", "where"), [
    ("tan γ = (I_3/I_1) tan θ", "true", "γ"), ("tan γ = (I_1/I_3) tan θ", "false", "γ"),
    ("tan γ = (I_1/I_3) tan θ", "true", "θ"), ("tan θ = (I_1/I_3) tan γ", "true", "γ"),
])  # fmt: skip
def test_the_angles_of_a_free_body_are_told_apart_by_words(text, verdict, where):
    words = [f"{where} = angle between the axis and the angular velocity"]
    assert symrot.check(text, body=FREE, where=words).verdict == verdict
    assert symrot.check(text).verdict == "recognised"


@pytest.mark.thinned(4)
@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("I = m k²", "recognised", {}), ("I = m k²", "true", {"where": ["k = radius of gyration"]}),
    ("I = m k", "false", {"where": ["k = radius of gyration"]}), ("I_G = m k_G²", "recognised", {}),
    ("I_zz = m (a² + b²)/3", "true", {"body": "box with half sides a, b, c about its centre"}),
    ("I_zz = m (a² + b²)/12", "false", {"body": "box with half sides a, b, c about its centre"}),
    ("I_zz = m (a² + b²)/3", "recognised", {"body": "box about its centre"}),
    ("I_zz = m (a² + b²)/3", "false", {"body": "box of sides a, b, c about its centre"}),
    ("I_x = m b²/4", "true", {"body": "elliptical disk"}),
    ("I_y = m (3 a² + L²)/12", "true", {"body": "elliptic cylinder"}),
    ("I_z = m (a² + b²)/2", "doubtful", {"body": "elliptical disk"}),
    ("I_zz = m (a² + b²)/5", "true", {"body": "ellipsoid with semi-axes a, b, c"}),
    ("I_zz = m (a² + b²)/20", "true", {"body": "ellipsoid of diameters a, b, c"}),
    ("I_zz = m (a² + b²)/20", "recognised", {}), ("I_zz = m (a² + b²)/6", "recognised", {}),
    ("I = m d²/8", "recognised", {"body": "cylinder"}), ("I = m l²/3", "true", {"body": "rod of half-length l about its centre"}),
])  # fmt: skip
def test_moments_may_be_written_with_other_dimensions(text, verdict, context):
    assert symrot.check(text, **context).verdict == verdict


def test_guessed_dimensions_are_named():
    notes = symrot.check("I_zz = m (a² + b²)/20", body="ellipsoid").notes
    assert "guessed, not stated: a, b and c are the whole axes" in notes


def test_the_angles_of_a_top_are_those_of_its_usual_sequences():
    """The formula is right for XYZ, which a top needs only if somebody says so."""
    claim = "omega_3 = psi' + phi'*sin(theta)"
    assert symrot.check(claim, **TOP, repair=False).verdict not in ("true", "recognised")
    assert symrot.check(claim, **TOP, sequence="XYZ", repair=False).verdict == "recognised"
    assert symrot.check("omega_3 = psi' + phi'*cos(theta)", **TOP, repair=False).verdict in ("true", "recognised")

"""Claims that name a formula: recognised, doubtful if one change from a known formula, or a definition."""

import json

import pytest

import symrot
from symrot.checker.recognition.formulas.kinematics import GYROSCOPE, OF_ONE_ENTRY
from symrot.checker.recognition.formulas.points import ANY_VECTORS, GENERAL
from symrot.checker.recognition.known_formulas import SCALAR_PRODUCTS, by_fingerprint
from symrot.cli.main import main
from symrot.errors import InputError

RIGHT = (
    (r"I_{zz} = \frac{m}{12}(a^2+b^2)", "moment of inertia of a box about its centre of mass, z axis"),
    (r"I_{xx} = \frac{1}{12} m (b^2 + c^2)", "moment of inertia of a box about its centre of mass, x axis"),
    (r"I_1 \dot\omega_1 - (I_2 - I_3)\omega_2\omega_3 = M_1",
     "first component of the torque by Euler's equations, principal axes; with I_1 for A, I_2 for B, I_3 for C"),
    (r"\dot\omega_2 = \frac{I_3 - I_1}{I_2}\omega_3\omega_1", "second component of the Euler's equations of a free body"),
    (r"\dot\phi = p + q\sin\phi\tan\theta + r\cos\phi\tan\theta",
     "first component of the angle rates of xyz from omega in the body frame"),
    (r"\dot\theta = q\cos\phi - r\sin\phi", "second component of the angle rates of xyz from omega in the body frame"),
    (r"\dot\psi = (q\sin\phi + r\cos\phi)/\cos\theta", "third component of the angle rates of xyz from omega in the body"),
    (r"\omega_x = \dot\phi - \dot\psi\sin\theta", "first component of the angular velocity of xyz in the body frame"),
    ("omega_x == dphi*sin(theta)*sin(psi) + dtheta*cos(psi)",
     "first component of the angular velocity of ZXZ in the body frame"),
    (r"T = \frac12 (A\omega_1^2 + B\omega_2^2 + C\omega_3^2)", "kinetic energy of rotation, principal axes"),
    (r"\dot{\theta} = \omega_x\cos\phi - \omega_y\sin\phi",  # a sign from ZXZ in the space frame, but exact here
     "second component of the angle rates of zxz from omega in the body frame"),
    ("R == Rz(psi)*Ry(theta)*Rx(phi)", "rotation matrix of extrinsic xyz, body to space"),
    (r"L_x = I_{xx}\omega_x + I_{xy}\omega_y + I_{xz}\omega_z", "first component of the angular momentum I omega"),
    (r"L_y = -I_{xy}\omega_x + I_{yy}\omega_y - I_{yz}\omega_z",
     "second component of the angular momentum I omega, any body axes; for products of inertia without the minus sign"),
    (r"p = \dot\phi - \dot\psi\sin\theta", "first component of the angular velocity of xyz in the body frame"),
    (r"L = I_x \dot p + (I_z - I_y) q r", "first component of the torque by Euler's equations, principal axes"),
    (r"T = \frac{1}{2} I_1 (\dot\theta^2 + \dot\phi^2\sin^2\theta) + \frac12 I_3(\dot\psi+\dot\phi\cos\theta)^2",
     "kinetic energy of a symmetric top; with I_1 for A, I_3 for C"),
    (r"L = \frac12 A (\dot\theta^2 + \dot\phi^2\sin^2\theta) + \frac12 C(\dot\psi+\dot\phi\cos\theta)^2 - m g l\cos\theta",
     "Lagrangian of a heavy top; with l for c_3"),
    (r"p_\psi = I_3(\dot\psi + \dot\phi\cos\theta)", "momentum of spin of a symmetric top"),
    (r"p_\phi = (I_1\sin^2\theta + I_3\cos^2\theta)\dot\phi + I_3\dot\psi\cos\theta", "momentum of precession of a symmetric"),
    (r"\dot\phi = \frac{p_\phi - p_\psi\cos\theta}{I_1\sin^2\theta}", "rate of precession of a symmetric top from its momenta"),
    (r"V_{eff} = \frac{(p_\phi-p_\psi\cos\theta)^2}{2 I_1\sin^2\theta} + \frac{p_\psi^2}{2 I_3} + m g l\cos\theta",
     "effective potential of a heavy top; with I_1 for A, I_3 for C, l for c_3"),
    ("Omega == m*g*l/(C*omega)", "rate of slow precession of a fast top"),
    (r"\Omega = \frac{I_3 - I_1}{I_1}\omega_3", "rate at which the angular velocity of a free symmetric body goes round"),
    (r"\dot\phi = \frac{I_3\omega_3}{I_1\cos\theta}", "rate of precession of a free symmetric body"),
    ("T == J*omega**2/2", "kinetic energy of rotation about one axis; with J for C, omega for omega_3"),
    ("tau == J*alpha", "torque about one axis; with J for C, alpha for domega_3"), ("P == M*omega", "power of a torque"),
    ("T == m*v**2/2 + J*omega**2/2", "kinetic energy of a body that moves and rotates"),
    ("T == 2*pi*sqrt(J/(m*g*d))", "period of a physical pendulum; with J for A"),
    (r"\mathbf q = \cos\frac{\theta}{2} + (u_x \mathbf i + u_y \mathbf j + u_z \mathbf k)\sin\frac{\theta}{2}",
     "quaternion of axis and angle; with theta for alpha, u_x for n1"),
    ("q = cos(θ/2) + sin(θ/2) (n_x i + n_y j + n_z k)", "quaternion of axis and angle; with theta for alpha, n_x for n1"),
    ("T = 2π sqrt(L/g)", "period of a simple pendulum (a point mass); with L for c_3"),
    ("T = 2π/sqrt(g/L)", "period of a simple pendulum (a point mass); with L for c_3"),
    ("T = 2π sqrt(3 R/(2 g))", "period of a disk that hangs from its rim"),
    ("θ'' + (g/L) sin θ = 0", "relation for a simple pendulum (a point mass); with L for c_3"),
    (r"\ddot\theta = -\frac{3g}{2l} \sin\theta", "relation for a rod about an end; with l for L"),
    ("k == sqrt(J/m)", "radius of gyration; with J for C"), ("omega == L/J", "angular velocity about one axis"),
    ("I_n == I_xx*l**2 + I_yy*m**2 + I_zz*n**2 - 2*I_xy*l*m - 2*I_yz*m*n - 2*I_xz*n*l",
     "moment of inertia about an axis of any direction; for products of inertia without the minus sign"),
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "name"), RIGHT)
def test_a_right_formula_is_recognised_in_its_usual_reading_first(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised" and verdict
    assert str(verdict.recognised_as[0]).startswith(name)
    assert all(reading.proven for reading in verdict.recognised_as)
    assert not verdict.repairs and verdict.diagnosis.code == "none" and verdict.counterexample is None


def test_a_negative_root_is_recognised_only_for_a_quantity_with_a_sign():
    assert symrot.check("omega = -sqrt(omega_0^2 + 2*alpha*theta)").verdict == "recognised"
    assert symrot.check("q0 = -sqrt(1 + R_11 + R_22 + R_33)/2").verdict == "recognised"
    for positive in ("k = sqrt((a^2 + b^2)/12)", "T = 2*pi*sqrt(L/g)"):
        verdict = symrot.check(positive.replace("= ", "= -"))
        assert verdict.verdict in ("doubtful", "definition")
        assert symrot.check(positive).verdict == "recognised"


def test_a_sine_or_cosine_of_zero_is_read():
    assert symrot.check("I_zz = m*a^2*cos(0)*cos(b)").verdict == "definition"
    assert symrot.check("T = m*v^2/2*cos(x - x)*sin(b)").verdict == "definition"


WRONG = (
    ("φ̇ = (ω₁ cos ψ + ω₂ cos ψ)/sin θ", "sin_cos_swap", "first component of the angle rates of ZXZ from omega in the body"),
    (r"\omega_x = \dot\phi \sin\theta \sin\psi - \dot\theta \cos\psi", "sign_of_term",
     "first component of the angular velocity of ZXZ in the body frame"),
    ("w2 == dphi*sin(theta)*cos(psi) - dtheta*cos(psi)", "sin_cos_swap",
     "second component of the angular velocity of ZXZ in the body frame"),
    (r"I_x = \frac{1}{12} m (b^2 - c^2)", "sign_of_term", "moment of inertia of a box about its centre"),
    ("I_xx == m*(3*R**2 + h**2)/6", "factor", "moment of inertia of a cylinder about its centre of mass"),
    ("T == (A*w1**2 + B*w2**2 - C*w3**2)/2", "sign_of_term",
     "kinetic energy of rotation, principal axes; with w1 for omega_1, w2 for omega_2, w3 for omega_3"),
    (r"\dot\omega_1 = \frac{(I_2 + I_3)\omega_2\omega_3}{I_1}", "sign_of_term", "first component of the Euler's equations"),
    ("dq0 == -(q1*w1 + q2*w2 - q3*w3)/2", "sign_of_term",
     "scalar component of the quaternion rates from omega in the body frame; with w1 for omega_1, w2 for omega_2,"),
    (r"L_x = I_{xx}\omega_x + I_{xy}\omega_y - I_{xz}\omega_z", "sign_of_term", "first component of the angular momentum"),
    (r"p_\phi = (I_1\sin^2\theta + I_3\cos^2\theta)\dot\phi - I_3\dot\psi\cos\theta", "sign_of_term", "momentum of precession"),
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "code", "name"), WRONG)
def test_a_formula_with_one_fault_is_doubtful_and_repaired(claim, code, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "doubtful" and not verdict
    assert verdict.diagnosis.code == code
    assert str(verdict.recognised_as[0]).startswith(name)
    assert 1 <= len(verdict.repairs) <= 3
    assert all(symrot.check(repair.text).verdict == "recognised" for repair in verdict.repairs)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", [
    "L = I α", "y == p*s + s**3 + exp(u)", "y == sin(2*x)", "M == Matrix([[cos(a), sin(a)], [sin(a), cos(a)]])", "x == 5",
    "Omega == a*g*b/(c*d)", "omega == v/r", "k == J/m", "I_0 == C*omega_3", "x == C*omega_3", "y == m*g/r",
    "K == (p_x*v_x + p_y*v_y + p_z*v_z)/2",
])  # fmt: skip
def test_any_other_formula_may_be_a_definition(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "definition" and not verdict and "it may be a definition" in verdict.reason


@pytest.mark.parametrize(("claim", "code", "strict", "words"), [
    ("I_xx == m*(b**2 + c**2)/12", 0, 0, "recognised\n"), ("I_xx == m*(b**2 - c**2)/12", 1, 1, "instead:"),
    ("x == 5", 0, 1, "definition\n"),
])  # fmt: skip
def test_the_exit_code_tells_a_doubtful_formula_and_with_strict_a_definition(claim, code, strict, words, capsys):
    assert main(["check", claim]) == code
    assert words in capsys.readouterr().out
    assert main(["check", claim, "--strict"]) == strict


@pytest.mark.parametrize(("claim", "name"), [
    ("omega_x == m/12*(a**2 + b**2)", "a moment of inertia is no angular velocity"),
    ("I_zz == (A*omega_1**2 + B*omega_2**2 + C*omega_3**2)/2", "an energy is no moment of inertia"),
    ("T == (phi*omega_1**2 + B*omega_2**2 + C*omega_3**2)/2", "an angle is no moment of inertia"),
])  # fmt: skip
def test_the_name_and_the_letters_count(claim, name):
    assert symrot.check(claim, repair=False).verdict != "recognised", name


def test_a_name_that_something_defines_is_decided():
    assert symrot.check("x*y == x + y").verdict == "false"
    assert symrot.check("x == 2*x").verdict == "false"
    assert symrot.check("phi(t) == diff(phi(t), t)").verdict == "false"
    assert symrot.check("I_zz == m*R**2", assume=["I_zz == m*R**2/2"]).verdict == "false"
    assert symrot.check("I_zz == m*R**2/2", assume=["I_zz == m*R**2/2"]).verdict == "true"


def test_what_cannot_be_read_is_refused_in_a_named_formula_too():
    with pytest.raises(InputError, match="a divisor that is not zero"):
        symrot.check("y == 1/(x - x)")


def test_json_has_the_readings(capsys):
    assert main(["check", "--json", r"I_{zz} = \frac{m}{12}(a^2+b^2)"]) == 0
    (verdict,) = json.loads(capsys.readouterr().out)
    assert verdict["verdict"] == "recognised"
    assert verdict["recognised_as"][0]["name"] == "moment of inertia of a box about its centre of mass, z axis"
    assert verdict["recognised_as"][0]["mapping"] == {}
    assert symrot.check("sin(x)**2 + cos(x)**2 == 1").to_json()["recognised_as"] == []


def test_without_repairs_a_formula_with_a_fault_is_not_searched_for():
    assert symrot.check("I_zz == m/12*(a**2 - b**2)", repair=False).verdict == "definition"


@pytest.mark.parametrize(("claim", "name"), [
    ("k^2 = I/m", "radius of gyration"), ("omega_0^2 = m*g*l/I", "frequency of a physical pendulum"),
    ("2T = I_1 w_1^2 + I_2 w_2^2 + I_3 w_3^2", "kinetic energy of rotation"),
    ("I_1 ω_1' + (I_3 - I_2) ω_2 ω_3 = 0", "first component of the Euler's equations"),
    ("I_1 dω_1/dt = (I_2 - I_3) ω_2 ω_3", "first component of the Euler's equations"),
])  # fmt: skip
def test_a_formula_for_a_square_a_multiple_or_a_rate_is_recognised(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised" and name in verdict.recognised_as[0].name


@pytest.mark.parametrize(("claim", "repaired"), [
    ("2T = I_1 w_1^2 + I_2 w_2^2 - I_3 w_3^2", "2*T = I_1*w_1^2 + I_2*w_2^2 + I_3*w_3^2"),
    ("I_1 ω_1' + (I_3 + I_2) ω_2 ω_3 = 0", "ω_1' = -(I_3 - I_2)"),
])  # fmt: skip
def test_a_fault_in_a_formula_for_a_multiple_or_a_rate_is_named(claim, repaired):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.diagnosis.code) == ("doubtful", "sign_of_term")
    assert verdict.repairs[0].text.startswith(repaired)


@pytest.mark.thinned(2)
@pytest.mark.parametrize("claim", [
    "tan(theta) = a*b/c", "1/2 m v^2 = m g h", "m x'' + k x = F_0",
    "M dt = I dω", "tan(beta) = cos(theta)*tan(alpha)",
])  # fmt: skip
def test_a_relation_of_quantities_is_not_called_false(claim):
    """Whether it holds depends on what its letters mean, and nothing in the claim says what they mean."""
    assert symrot.check(claim).verdict == "definition"


@pytest.mark.parametrize("claim", [
    "d/dt(x^2) = x x'", "diff(x(t)*y(t), t) = diff(x(t), t)*y(t) - x(t)*diff(y(t), t)", "sin(a + b) = sin a cos b + cos a sin c",
    "sin(x)^2 = 2", "(a + b)^2 = a^2 + b^2", "2*x' = 3*x'", "x == y",
])  # fmt: skip
def test_a_wrong_identity_stays_false(claim):
    assert symrot.check(claim).verdict == "false"


@pytest.mark.thinned(2)
@pytest.mark.parametrize("claim", [
    "I_1 ω̇_1 + ω_2 ω_3 (I_2 − I_3) = N_1", r"I_1\dot\omega_1 = \omega_2\omega_3(I_3-I_2)",
    "L_x = I_xx omega_x + I_xy omega_y + I_yz omega_z", r"\omega_3 = \dot\theta_1\sin\theta_2 + \dot\theta_2",
])  # fmt: skip
def test_no_renaming_tears_axes_or_angles_from_their_names(claim):
    """Each claim would be a known formula if only some of its axes were exchanged."""
    assert symrot.check(claim, repair=False).verdict != "recognised"


def test_few_symbols_are_recognised_in_the_letters_of_their_quantities():
    assert symrot.check("H_G = I_G omega").verdict == "recognised"
    assert symrot.check("H_G = I_G omega^2").verdict != "recognised"
    assert symrot.check("v_1 = q v q").verdict == "definition"


def test_lines_for_the_components_of_one_quantity_belong_together():
    body = "ω_x = φ̇ sin θ sin ψ + θ̇ cos ψ\nω_y = φ̇ sin θ cos ψ − θ̇ sin ψ\nω_z = "
    assert symrot.check(body + "φ̇ cos θ + ψ̇").verdict == "recognised"
    mixed = symrot.check(body + "ψ̇ cos θ + φ̇")  # the third component in the other frame
    assert (mixed.verdict, mixed.reason.partition(":")[0]) == (
        "doubtful", "each line is a formula that symrot derives, but no single body, frame or sequence gives all of them"
    )  # fmt: skip


def test_names_that_are_equal_have_the_same_formula():
    assert symrot.check("Ixx = Iyy = m(3r² + h²)/12").verdict == "recognised"
    assert symrot.check("Ixx = Iyy = m(3r² + h²)/6").verdict == "doubtful"


def test_a_constraint_of_quantities_is_not_called_false():
    assert symrot.check("a₀² + b₁² + c₂² = 1").verdict == "definition"
    near = symrot.check("λ_1 Ω² cos θ − λ_3 ω Ω + M g^2 R = 0")  # steady precession has M g R
    assert (near.verdict, near.diagnosis.code) == ("doubtful", "exponent")


@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    "claim",
    [
        "sin(a + asin(k)) == z/z",
        "sin(a + asin(k)) == y + y - y - y",
        "(x + y)*(z - x) == x + y",
        "sin(a)*sin(b)*sin(c) == sin(a)*sin(a)*sin(c)",
        "cos(a + k)*cos(b) == cos(a + k)/4*(sin(a)**2 + cos(a)**2)",
        "x*y == 0",
        "sin(x)^2 + cos(y)^2 = 1",
        "Rx(a)*Ry(b) == Rx(c)*Ry(b)",
        "x*sin(a) + y*cos(b) == x*sin(c) + y*cos(b)",
        "x*cos(asin(k)) + k == (2*k*(sin(a)**2 + cos(a)**2) - k)*z/z",
        "abs(x*cos(a))*abs(y) == abs(z*cos(a))*sqrt(y**2)",
    ],
)
def test_a_wrong_identity_in_letters_of_one_side_stays_false(claim):
    assert symrot.check(claim).verdict == "false"


def test_chains_in_latex_are_decided_link_by_link():
    assert symrot.check(r"\cos 2\theta = \cos^2\theta - \sin^2\theta = 1 - 2\sin^2\theta").verdict == "true"
    wrong = symrot.check(r"\cos 2\theta = \cos^2\theta - \sin^2\theta = 2\cos^2\theta + 1")
    assert (wrong.verdict, wrong.repairs[0].text) == (
        "false",
        r"\cos^2(\theta) - \sin^2(\theta) = 2 \cos^2(\theta) - 1",
    )
    assert symrot.check(r"I_{xx} = I_{yy} = \frac{1}{2} m r^2").verdict == "recognised"
    assert symrot.check(r"I_{xx} = I_{yy} = \frac{1}{12} m (2 r^2 + h^2)").verdict == "doubtful"  # no body has both


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "name"), [
    ("I_G ω₁ + ΣM Δt = I_G ω₂", "relation for impulse and angular momentum about one axis"),
    ("λ_1 Ω² cos θ − λ_3 ω_3 Ω + M g R = 0", "relation for steady precession of a heavy top"),
    ("β₀² + β₁² + β₂² + β₃² = 1", "relation for the unit norm of a quaternion"),
    ("dL/dt + omega x L = Gamma", "torque from the rate of the angular momentum in the body"),
    ("β₀ = cos(Φ/2)", "scalar component of the quaternion of axis and angle"),
    ("σ_1 = β₁/(1 + β₀)", "first component of the modified Rodrigues parameters of a quaternion"),
    ("θ = 2 atan2(√(q₁² + q₂² + q₃²), q₀)", "angle of rotation of a unit quaternion"),
    ("ψ̇ = I p/((I₀ − I) cos θ)", "rate of precession of a free symmetric body from its spin"),
    ("tan γ = (C/A) tan θ", "relation for the angles of momentum and angular velocity to the axis of a free symmetric body"),
    (r"\Omega_1^2 = \frac{(2EI_3-M^2)-I_2(I_3-I_2)\Omega_2^2}{I_1(I_3-I_1)}", "angular velocity of a free body of given energy"),
    (r"\omega_3^2 = \frac{4MglI_1}{I_3^2}", "angular velocity of the least spin of a sleeping top"),
    ("a = (m₁ − m₂) g/(m₁ + m₂ + I/R²)", "acceleration of two masses on a pulley"),
    ("θ = θ₀ + ω₀t + ½αt²", "angle at constant angular acceleration"), ("T = 2π √(I/k)", "period of a torsional pendulum"),
    ("a = a_rel + 2 omega x v_rel + omega x (omega x r) + alpha x r", "acceleration of a point in a rotating frame"),
    ("v_rot = v cos θ + (k × v) sin θ + k (k·v)(1 − cos θ)", "rotated vector, by axis and angle (Rodrigues' formula)"),
    ("ψ = atan2(2(q₀q₃ + q₁q₂), 1 − 2(q₂² + q₃²))", "yaw angle of a unit quaternion"),
    ("theta = acos((r11 + r22 + r33 - 1)/2)", "angle of a rotation matrix"), ("theta = 2 arccos(q_0)", "angle of rotation of a unit"),
    (r"I = \frac{2m}{5}\left(\frac{r_2^5-r_1^5}{r_2^3-r_1^3}\right)", "moment of inertia of a hollow sphere"),
    ("τ = r × F", "torque of a force"), ("τ = dL/dt", "torque from the rate of the angular momentum"), ("K = L²/2I", "kinetic energy"),
    (r"\dot L = M - \omega \times L", "rate of the angular momentum in the body"), ("Ω = τ/L", "rate of steady precession"),
    ("L = m v r", "angular momentum of a point mass"), ("a_c = v²/r", "centripetal acceleration"), ("v = ω r", "speed of a point"),
    ("W = F d cos θ", "work of a force"), ("θ = ½(ω + ω_0)t", "angle at constant angular acceleration"),
    ("k = √(2/5) r", "radius of gyration of a sphere"), ("I_x = Ī_x′ + m(ȳ² + z̄²)", "moment of inertia about a parallel axis"),
])  # fmt: skip
def test_relations_and_formulas_that_books_name_are_recognised(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised"
    assert any(reading.name.startswith(name) for reading in verdict.recognised_as)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("claim", [
    "I_G ω₁ − ΣM Δt = I_G ω₂", "λ_1 Ω² cos θ + λ_3 ω_3 Ω + M g R = 0", r"\omega_3^2 = \frac{2MglI_1}{I_3^2}",
    "a = (m₁ + m₂) g/(m₁ + m₂ + I/R²)", "θ = θ₀ + ω₀t + αt²", "T = 2π √(k/I)", "φ̇ = I₃ω₃/I₁",
    "a = a_rel + omega x v_rel + omega x (omega x r) + alpha x r", "v_rot = v cos θ − (k × v) sin θ + (k·v)(1 − cos θ) v",
    "ψ = atan2(2(q₀q₃ + q₁q₂), 1 − 2(q₁² + q₃²))", "theta = acos((r11 + r22 + r33 + 1)/2)", "theta = arccos(q_0)",
    "K = (r₃₂ − r₂₃, r₃₁ − r₁₃, r₂₁ − r₁₂)/(2 sin θ)", "I_x = Ī_x′ + m(x̄² + z̄²)", "k = √(2/3) r^2", "ω̇₁ − Ω ω₂ = 0",
])  # fmt: skip
def test_wrong_relations_and_formulas_are_not_recognised(claim):
    assert symrot.check(claim, repair=False).verdict != "recognised"


@pytest.mark.thinned(4)
@pytest.mark.parametrize("claim", [
    "e = mc^2", "x = m r^2", "ω₂ = I₁ω₁/I₂", "T = ω·L", "H = I α", "I_G = I_O + m d²", "k_G² = k_O² + d²",
    "R_11 = 1 - 2(q_1² + q_2²)", "φ̇ = (L_3 - L_z cos θ)/(I_1 sin²θ)", r"x^* = \bar x", r"\theta' = \omega",
    "I_1 ω̇_1 = (I_1 - I_3) ω_3 ω_2", "C ω̇_3 = 0",
    "H = p_φ φ̇ + p_θ θ̇ − L", "I = I_cm + M L²/4", "I_end = I_cm + M L²/4", "k² = k_G² + L²/4", "I = 1/2 m L²",
    "T = 2π √((I_G + m d²)/(m g d))", "λ² = (I_2 - I_1)(I_3 - I_2) ω²/(I_1 I_3)", "M = (C - A) ω² sin β cos β", "I_G = I_O - m d²",
])  # fmt: skip
def test_letters_that_say_something_else_are_neither_recognised_nor_accused(claim):
    assert symrot.check(claim).verdict == "definition"


@pytest.mark.parametrize(("claim", "name"), [
    ("R_11 = 1 - 2(q_2² + q_3²)", "entry 11"), ("R_23 = 2(q_2 q_3 + q_0 q_1)", "entry 32"),
    ("φ̇ = (L_z - L_3 cos θ)/(I_1 sin²θ)", "rate of precession"), ("I_O = I_G + m d²", "parallel axis"),
    ("pφ = (I1 sin² θ + I3 cos² θ)φ̇ + I3ψ̇ cos θ", "momentum of precession"), ("I = Icm + Md²", "parallel axis"),
    ("I = Ic + md²", "parallel axis"), ("Veff(θ) = (pφ − pψ cos θ)²/(2I1 sin² θ) + mgl cos θ", "effective potential"),
    ("H = pθ²/(2I1) + (pφ − pψ cos θ)²/(2I1 sin² θ) + pψ²/(2I3) + Mgl cos θ", "energy of a heavy top from its momenta"),
    ("Ω = I_3 ω_3/I_1", "nutation"), ("H_O = r × m v + H_G", "angular momentum about a point"),
    ("v′ = v + 2 r × (r × v + w v)", "rotated vector"), ("v' = q v q*", "rotated vector"),
    (r"M_3 = \begin{pmatrix} \cos\theta & \sin\theta & 0 \\ -\sin\theta & \cos\theta & 0 \\ 0 & 0 & 1 \end{pmatrix}", "z axis"),
])  # fmt: skip
def test_letters_that_say_the_same_are_recognised(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised" and name in verdict.recognised_as[0].name


def test_a_recognised_formula_has_no_repairs():
    verdict = symrot.check("2T = I1ω1² + I2ω2² + I3ω3²")
    assert (verdict.verdict, verdict.repairs, verdict.diagnosis.code) == ("recognised", (), "none")


def test_the_radius_of_a_body_is_no_side_of_a_box():
    assert symrot.check("I_x = 1/12 m(r²+h²)").repairs[0].text == "I_x = m*(3*r^2 + h^2)/12"


@pytest.mark.parametrize(("claim", "note"), [
    ("atan2(R_21, R_11) == psi", "for -pi < psi <= pi: atan2 gives only these angles"),
    (r"\phi = 2\arccos(q_0)", "for 0 <= phi <= 2*pi: acos gives only these angles"),
    (r"\theta = -\arcsin(R_{31})", "for -pi/2 <= theta <= pi/2: asin gives only these angles"),
])  # fmt: skip
def test_an_inverse_function_limits_the_angle(claim, note):
    """The verdict names the range in which the inverse function gives the angle."""
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised" and note in verdict.notes


def test_every_formula_that_only_its_letters_name_is_a_known_formula():
    names = {known.name for formulas in by_fingerprint().values() for known in formulas if known.only_named}
    assert {*SCALAR_PRODUCTS, *ANY_VECTORS, *GENERAL, *OF_ONE_ENTRY, GYROSCOPE} <= names


@pytest.mark.parametrize(
    "formula", ["T = {}2π√(L/g)", "T = {}1/2 I ω^2", "I = {}1/2 m r^2", "I_zz = {}m (a^2 + b^2)/12"]
)
def test_a_positive_quantity_has_no_minus_sign(formula):
    assert symrot.check(formula.format(""), repair=False).verdict == "recognised"
    verdict = symrot.check(formula.format("-"))
    assert verdict.verdict == "doubtful"
    assert symrot.check(verdict.repairs[0].text, repair=False).verdict == "recognised"

"""Formulas that are a single fault away from a known one: which part is at fault, and when nothing is claimed."""

import pytest

import symrot
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import text
from symrot.checker.recognition.single_faults.absent_names import absent_name
from symrot.checker.recognition.single_faults.parts import (
    Letters,
    PointOfLetters,
    Valued,
    is_superfluous,
    multiples,
    parts,
)
from symrot.checker.recognition.single_faults.renamings import renamings
from symrot.checker.recognition.single_faults.variants import LACKING, variants
from tests.campaigns.checker.printed import names_fault, offers

FAULTS = (
    ("T = ½ I ω", "exponent", "T = 1/2*I*ω^2"), ("H_G = I_G omega^2", "exponent", "H_G = I_G*omega"),
    ("ω_p = M g l sin θ/(I₃ω₃)", "factor", "ω_p = M*g*l/(I₃*ω₃)"),
    ("R_12 = q_1 q_2 - q_3 q_4", "factor", "R_12 = 2*(q_1*q_2 - q_3*q_4)"),
    ("ψ̇ = (ω₂ sin φ + ω₁ cos φ)/cos θ", "wrong_symbol", "ψ' = (ω₂*sin(φ) + omega_3*cos(φ))/cos(θ)"),
    ("τ = F × r", "sign_of_term", "τ = cross(r, F)"),
    ("I_zz = m/12 (a^2 + b)", "exponent", "I_zz = m/12*(a^2 + b^2)"),
    ("I_z = m/12 (a^2 - b^2)", "sign_of_term", "I_z = m/12*(a^2 + b^2)"),
    ("I = 2m/5 (R_2^5 - R_1^5)/(R_2^2 - R_1^2)", "exponent", "I = 2*m/5*(R_2^5 - R_1^5)/(R_2^3 - R_1^3)"),
    ("p_phi = (I_1 cos^2 theta + I_3 sin^2 theta) phi' + I_3 psi' cos theta", "sin_cos_swap",
     "p_phi = (I_1*sin(theta)^2 + I_3*cos(theta)^2)*phi' + I_3*psi'*cos(theta)"),
    ("phi' = p + q sin phi + r cos phi tan theta", "lost_brackets", "phi' = p + (q*sin(phi) + r*cos(phi))*tan(theta)"),
    ("T = 1/2 (I_1 w_1^2 + I_2 w_2^2 + I_3 w_2^2)", "wrong_symbol", "T = 1/2*(I_1*w_1^2 + I_2*w_2^2 + I_3*w_3^2)"),
    ("L_x = I_xx w_x + I_xy w_y + I_yz w_z", "wrong_symbol", "L_x = I_xx*w_x + I_xy*w_y + I_xz*w_z"),
    ("e_0 = cos((phi + psi)/2) cos(theta)", "half_angle", "e_0 = cos((phi + psi)/2)*cos(theta/2)"),
    ("w_1' = ((I_2 - I_3) w_2 w_3 + M_1)/I_2", "wrong_symbol", "w_1' = ((I_2 - I_3)*w_2*w_3 + M_1)/I_1"),
    ("T = 2 pi sqrt(m g d/I)", "wrong_symbol", "T = 2*pi*sqrt(I/m/g/d)"),
    ("Omega = M g/(I_3 omega_3)", "factor", "Omega = l*g*M/(I_3*omega_3)"),
    ("theta = asin(q_0 q_2 - q_1 q_3)", "factor", "theta = asin(2*(q_0*q_2 - q_1*q_3))"),
    ("sum M_x = -I_xz w_z' + I_yz w_z", "exponent", "M_x = -I_xz*w_z' + I_yz*w_z^2"),
    ("θ = acos((tr R + 1)/2)", "sign_of_term", "θ = acos((trace(R) - 1)/2)"),
    ("T = π sqrt(L/g)", "factor", "T = 2*π*sqrt(L/g)"),
    ("θ'' = (g/l) sin θ", "sign_of_term", "θ'' = -g/l*sin(θ)"),
    ("V_eff = (p_φ - p_ψ cos θ)²/(I_1 sin²θ) + M g l cos θ", "factor",
     "V_eff = (p_φ - p_ψ*cos(θ))^2/(I_1*sin(θ)^2)/2 + M*g*l*cos(θ)"),
    (r"T = \frac{mg}{1 + mR/I}", "exponent", r"T = m \frac{g}{1 + m \frac{R^2}{I}}"),
    ("θ = ω_0 t + αt²", "factor", "θ = ω_0*t + α*t^2/2"),
    ("M^2 = I_1^2 w_1^2 + I_2 w_2^2 + I_3^2 w_3^2", "exponent", "M^2 = I_1^2*w_1^2 + I_2^2*w_2^2 + I_3^2*w_3^2"),
    # a letter of the right formula that the claim lacks
    ("ω₃ = ψ̇ + φ̇ cos ψ", "wrong_symbol", "ω₃ = ψ' + φ'*cos(theta)"),
    ("omega_pr = m g l/(I_1 omega_3)", "wrong_symbol", "omega_pr = m*g*l/(I_3*omega_3)"),
    ("σ₁ = β₁/(1 + β₁)", "wrong_symbol", "σ₁ = β₁/(1 + beta_0)"),
    ("C₁₃ = 2(q₁q₃ − q₂q₃)", "wrong_symbol", "C₁₃ = 2*(q₁*q₃ - q₂*q_0)"),
    ("R₁₁ = cos φ cos θ cos ψ − sin θ sin ψ", "wrong_symbol", "R₁₁ = cos(φ)*cos(θ)*cos(ψ) - sin(φ)*sin(ψ)"),
    ("beta = atan2(-r_31, sqrt(r_11^2 + r_12^2))", "wrong_symbol", "beta = atan2(-r_31, sqrt(r_11^2 + r_21^2))"),
    # two letters exchanged
    ("tan theta = I_3 w_T/(I_T w_3)", "wrong_symbol", "tan(theta) = I_T*w_T/(I_3*w_3)"),
    ("q_1 = 2 beta_1/beta_0", "factor", "q_1 = beta_1/beta_0"),
    ("epsilon_dot = eta omega + epsilon x omega", "factor", "epsilon_dot = 1/2*(eta*omega + cross(epsilon, omega))"),
    ("I w' + w x (I w - h) = M", "sign_of_term", "M = I*w' + cross(w, I*w + h)"),
    ("k_x = (r_32 + r_23)/(2 sin theta)", "sign_of_term", "k_x = (r_32 - r_23)/(2*sin(theta))"),
    ("dM_1/dt = (1/I_3 + 1/I_2) M_2 M_3", "sign_of_term", "M_1' = (1/I_3 - 1/I_2)*M_2*M_3"),
    ("I_1 w_1' = (I_2 - I_3) w_2 w_3 - h w_1", "wrong_symbol", "I_1*w_1' = (I_2 - I_3)*w_2*w_3 - h*w_2"),
    ("g_dot = 1/2 (I - [g x] - g g^T) omega", "sign_of_term", "g_dot = 1/2*(eye(3) + skew(g) + g*g.T)*omega"),
    ("sigma_1_dot = 1/4 ((1 - sigma^2 + 2 sigma_1^2) omega_1 + 2 (sigma_1 sigma_2 - sigma_3) omega_2"
     " + 2 (sigma_1 sigma_3 + sigma_3) omega_3)", "wrong_symbol",
     "sigma_1_dot = 1/4*((1 - sigma^2 + 2*sigma_1^2)*omega_1 + 2*(sigma_1*sigma_2 - sigma_3)*omega_2"
     " + 2*(sigma_1*sigma_3 + sigma_2)*omega_3)"),
)  # fmt: skip


RIGHT = (
    ("tan theta = I_T w_T/(I_3 w_3)", "angle of the axis of a free symmetric body to its angular momentum"),
    ("phi = atan2(2 q_2 q_3 + 2 q_0 q_1, q_3^2 - q_2^2 - q_1^2 + q_0^2)", "roll angle of a quaternion"),
    ("beta = atan2(-r_31, sqrt(r_11^2 + r_21^2))", "pitch angle of a rotation matrix"),
    ("omega_p = (1 - I_3/I_T) omega_3", "rate of spin of a free symmetric body"),
    (r"\mathbf N = \frac{3\mu}{R^3}\hat{\mathbf r}\times(I\hat{\mathbf r})", "gravity gradient from the tensor of inertia"),
    ("q = (g + h + g × h)/(1 - g · h)", "Rodrigues parameters of two rotations one after the other"),
    (r"\mathbf a = \mathbf a_r + 2\boldsymbol\Omega\times\mathbf v_r + \boldsymbol\Omega\times(\boldsymbol\Omega\times\mathbf r)"
     r" + \dot{\boldsymbol\Omega}\times\mathbf r", "acceleration of a point in a rotating frame"),
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "known"), RIGHT)
def test_formulas_of_references_are_recognised(claim, known):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised"
    assert known in str(verdict.recognised_as[0])


def test_a_wrong_unit_shows_a_fault_of_a_short_formula():
    body = "free symmetric body with moments I_1, I_1, I_3"
    verdict = symrot.check("cos θ = I₃ω₃²/L", where=["L = angular momentum"], body=body)
    assert (verdict.verdict, verdict.diagnosis.code) == ("false", "exponent")
    assert [repair.text for repair in verdict.repairs] == ["cos(θ) = I₃*ω₃/L"]


def test_a_formula_for_another_quantity_is_repaired_if_its_letters_are_stated():
    where = ["I_a = moment about the axis", "I_t = transverse moment", "nu = angular velocity along the axis",
             "Omega = precession rate"]  # fmt: skip
    assert [repair.text for repair in symrot.check("Omega = I_t/I_a nu", where=where).repairs] == ["Omega = I_a/I_t*nu"]


@pytest.mark.thinned(6)
@pytest.mark.parametrize(("claim", "code", "repaired"), FAULTS)
def test_the_part_at_fault_is_named_and_repaired(claim, code, repaired):
    verdict = symrot.check(claim)
    adds_up = verdict.dimension.status != "inconsistent"  # a sum of terms in different units is false
    assert verdict.verdict == "doubtful" or (verdict.verdict == "false" and not adds_up)
    assert verdict.diagnosis.code == code
    assert repaired in [repair.text for repair in verdict.repairs]
    assert symrot.check(repaired).verdict == "recognised"


@pytest.mark.thinned(4)
@pytest.mark.parametrize("claim", [
    "I = 13/20 m r^2", "a = p_psi/I_1", "I_z = 9/16 m R^2", "P = 2 M omega", "Omega = a g b/(c d)", "T = I/k",
    "E = a x^2 + b y^2", "tau = F d cos(theta)", "omega_2^2 = (M^2 - 2EI_1)/I_3", "V = -m g l cos(theta)",
    "I = 1/12 m L^2 + m d^2", "I = m (a^2 + 4 b^2)/12", "I = m (R^2 + 5 a^2/4)",
    "tau = -m g l sin(theta)", "theta = -asin(a)", "E = 1/2 m v^2 + 1/2 k x^2", "F = mu m g cos(theta)",
])  # fmt: skip
def test_a_formula_that_may_mean_something_else_is_not_accused(claim):
    """Few letters, another unit of the same form, or a letter of its own: nothing says that it has a fault."""
    assert symrot.check(claim).verdict == "definition"


@pytest.mark.parametrize(("wrong", "entry"), [
    ("[[1, 0, 0], [0, cos(a), -sin(a)], [0, sin(a), sin(a)]]", "sin_cos_swap"),
    ("[[cos(a), sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]]", "sign_of_term"),
])  # fmt: skip
def test_one_wrong_entry_of_a_matrix_is_repaired(wrong, entry):
    verdict = symrot.check(f"R = {wrong}")
    assert (verdict.verdict, verdict.diagnosis.code) == ("doubtful", entry)


def test_a_wrong_row_of_a_diagonal_matrix_times_a_column_is_repaired():
    """The zeros beside the diagonal of ``diag`` are no parts of the formula, so they cannot be at fault."""
    verdict = symrot.check("L = diag(I_1, I_2, I_3)*(w_1, w_2, 2*w_3)")
    assert verdict.repairs[0].text == "L = diag(I_1, I_2, I_3/2)*[w_1, w_2, 2*w_3]"
    assert symrot.check("L = diag(I_1, I_2, I_3)*(w_1, w_2, w_2)").verdict == "definition"


def test_the_matrix_of_a_quaternion_may_have_any_letters():
    matrix = ("[[1 - 2(y² + z²), 2(x y - z w), 2(x z + y w)], [2(x y + z w), 1 - 2(x² + z²), 2(y z - x w)], "
              "[2(x z - y w), 2(y z + x w), 1 - 2(x² + y²)]]")  # fmt: skip
    assert symrot.check(f"R = {matrix}").verdict == "recognised"


def _letters(**values):
    atoms = {read_expression(name): tuple(v) for name, v in values.items()}
    places = [PointOfLetters({name: v[n] for name, v in values.items()}, {}, {}) for n in range(2)]
    return Letters(atoms, {}, places)


def test_a_part_should_have_the_value_that_makes_the_whole_right():
    letters = _letters(m=(2.0, 3.0), a=(1.5, 0.7), b=(0.4, 1.1))
    tree = read_expression("m*(a**2 - b)/12")
    needed = tuple(m * (a**2 + b**2) / 12 for m, a, b in ((2.0, 1.5, 0.4), (3.0, 0.7, 1.1)))
    values = {text(part.node): part.needed for part in parts(Valued(tree, letters.points), needed)}
    assert values["b"] == pytest.approx((-(0.4**2), -(1.1**2)))
    assert values["a**2"] == pytest.approx((1.5**2 + 0.4**2 + 0.4, 0.7**2 + 1.1**2 + 1.1))


def test_a_multiple_and_an_absent_part_are_seen():
    letters = _letters(a=(1.5, 0.7), b=(0.4, 1.1))
    tree = read_expression("a - b")
    negative = next(part for part in parts(Valued(tree, letters.points), (1.9, 1.8)) if text(part.node) == "b")
    assert not is_superfluous(negative)
    assert [(text(change.made), change.code) for change in multiples(negative)] == [("-b", "sign_of_term")]
    doubled = next(part for part in parts(Valued(tree, letters.points), (0.7, -1.5)) if text(part.node) == "b")
    assert [text(change.made) for change in multiples(doubled)] == ["2*b"]
    (lone,) = [part for part in parts(Valued(tree, letters.points), (1.5, 0.7)) if is_superfluous(part)]
    assert text(lone.node) == "-b"


def test_variants_are_usual_faults_alone():
    letters = _letters(a=(1.5, 0.7), b=(0.4, 1.1))
    made = {text(variant.change.made) for variant in variants(read_expression("a"), "sum", letters)}
    assert {"b", "a**2", "a*b", "a/b"} <= made
    assert text(LACKING) not in made and "a" not in made


def test_a_renaming_leaves_out_at_most_one_symbol_on_each_side():
    known = ("A", "B", "C", "omega_1", "omega_2", "omega_3")
    own = ("I_1", "I_2", "I_3", "Omega_1", "Omega_2")
    first, *_ = renamings(known, own)
    assert first == {"A": "I_1", "B": "I_2", "C": "I_3", "omega_1": "Omega_1", "omega_2": "Omega_2", "omega_3": None}
    assert absent_name("omega_3", first) == ("Omega_3", True)
    assert renamings(known, own[:4]) == []
    assert absent_name("c_3", {"m": "m"}) == ("l", False)
    assert absent_name("C", {"omega_3": "w_3"}, ["I_1"]) == ("I_3", True)
    assert absent_name("theta", {"dphi": "diff(phi(t), t)"}) == ("theta", True)
    assert absent_name("R_21", {"R_11": "r_11"}) == ("r_21", True)


def test_units_and_axes_of_letters_limit_the_renamings():
    assert renamings(("m", "R"), ("phi", "r")) == [{"m": None, "R": "r"}]
    assert renamings(("R", "theta"), ("r", "a"), {"a"})[0] == {"R": "r", "theta": "a"}
    assert all(r["omega_1"] != "I_1" for r in renamings(("A", "omega_1"), ("I_1", "w_1")))


def test_the_campaign_compares_diagnoses_and_repairs_with_the_corpus():
    assert names_fault("missing_square", "exponent") and not names_fault("sign", "factor")
    assert offers(("x^2 >= 4 a b",), "w² ≥ 4 m g") and not offers(("x^2 <= 4 a b",), "x^2 >= 4 a b")
    assert names_fault("other", "factor") and not names_fault("other", "none")
    assert offers(("T = I*omega^2/2",), r"T = \frac12 J\omega^2")
    assert offers(("x = 1", "I_1*w' = M"), "w' = M/I_1")
    assert not offers(("T = I*omega^2",), r"T = \frac12 I\omega^2")
    assert not offers((), "T = 1")


@pytest.mark.thinned(2)
@pytest.mark.parametrize("claim", ["I_zz = π ρ h D^4/32", "I = m(a²+b²)/6", "I = m D²/2", "I = m a²/20"])
def test_a_moment_of_an_unknown_body_is_not_accused(claim):
    """The moments of a cylinder by its diameter, of a triangular plate about its right corner, of a tetrahedron."""
    assert symrot.check(claim).verdict in ("definition", "recognised")


@pytest.mark.parametrize(("claim", "code", "repaired"), [
    ("J w_1 - M Delta_t = J w_2", "sign_of_term", "J*w_1 + M*Delta_t = J*w_2"),
    ("H^2 = A^2 w_1^2 + B^2 w_2^2 + C w_3^2", "exponent", "H^2 = A^2*w_1^2 + B^2*w_2^2 + C^2*w_3^2"),
    ("dw_1/dt + (C - B) w_2 w_3/B = N_1/A", "wrong_symbol", "w_1' + (C - B)*w_2*w_3/A = N_1/A"),
])  # fmt: skip
def test_a_fault_in_an_equation_is_found_from_the_known_relation(claim, code, repaired):
    verdict = symrot.check(claim)
    assert verdict.verdict in ("false", "doubtful")
    assert (verdict.diagnosis.code, verdict.repairs[0].text) == (code, repaired)


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("claim", "verdict"), [
    ("T = 1/2 (A p^2 + B q^2 + C q^2)", "doubtful"),  # a component of omega that occurs twice
    ("J_1 w_1' = w_2 w_3 (J_2 - J_1)", "doubtful"),  # no book writes J_1 for J_3
    ("J_1 w_1' = w_2 w_3 (J_1 - J_3)", "definition"),  # a body with J_1 = J_2
    ("L = (J_1 w_1, J_1 w_2, J_3 w_3)", "recognised"),  # a body with J_1 = J_2; the third axis is usually that of symmetry
    ("I_x = 1/4 m r^2 + 1/9 m h^2", "definition"),  # 1/12 + 1/6^2: about a parallel axis
    ("I_x = 1/4 m r^2 + 1/6 m h^2", "doubtful"),  # 1/6 - 1/12 is no square
    ("p_psi = J_3 psi'", "definition"),  # not the momentum of nutation with another letter
])  # fmt: skip
def test_only_a_special_case_or_another_axis_excuses_a_formula_near_a_known_one(claim, verdict):
    assert symrot.check(claim).verdict == verdict


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "where", "repair"), [
    ("K = 1/2 m v^2 (1 + k/R)", ["k = radius of gyration"], "K = 1/2*m*v^2*(1 + k^2/R^2)"),
    ("U = 1/2 I (omega_2 - omega_1)^2", ["U = work"], "U = 1/2*I*(omega_2^2 - omega_1^2)"),
    ("I_xy = Ibar_xy + m d_x^2", [], "I_xy = Ibar_xy + m*d_x*d_y"),
    ("R_12 = n_x n_y (1 - cos theta) - n_z cos theta", [], "R_12 = n_x*n_y*(1 - cos(theta)) - n_z*sin(theta)"),
    ("theta_1' = omega_1 + (omega_2 sin theta_1 + omega_3 cos theta_1) tan theta_1", [],
     "theta_1' = omega_1 + (omega_2*sin(theta_1) + omega_3*cos(theta_1))*tan(theta_2)"),
    ("omega_3 = theta_1' sin theta_2 + theta_2'", [], "omega_3 = theta_1'*sin(theta_2) + theta_3'"),
    ("k = k_bar + d", [], "k^2 = k_bar^2 + d^2"),
    ("tr R = 1 + cos theta", [], "trace(R) = 1 + 2*cos(theta)"),
    ("Omega_1^2 + Omega_2^2 = phi'^2 sin theta + theta'^2", [], "Omega_1^2 + Omega_2^2 = phi'^2*sin(theta)^2 + theta'^2"),
    ("b_0^2 - b_1^2 - b_2^2 - b_3^2 = 1", ["b = Euler parameters"], "b_0^2 + b_1^2 + b_2^2 + b_3^2 = 1"),
    ("M_1 = 3 n (J_3 - J_2) C_23 C_33", ["n = mean motion"], "M_1 = 3*n^2*(J_3 - J_2)*C_23*C_33"),
])  # fmt: skip
def test_usual_slips_are_found(claim, where, repair):
    """A square lost in a quotient or in all terms, an index, an angle or a rate written twice, a lost 2, lost signs."""
    verdict = symrot.check(claim, where=where)
    assert (verdict.verdict, verdict.repairs[0].text) == ("doubtful", repair)


@pytest.mark.parametrize("claim", ["M_1 = 3 n^2 (J_3 - J_2) C_23 C_33", "G_1 = 3 n^2 (I_3 - I_2) c_2 c_3"])
def test_the_torque_of_the_gravity_gradient_is_known_in_the_letters_of_books(claim):
    assert symrot.check(claim).verdict == "recognised"


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("lines", "repair"), [
    (("I_1 = m/5 (b^2 + c^2)", "I_2 = m/5 (a^2 + b^2)", "I_3 = m/5 (a^2 + b^2)"), "I_2 = m/5*(a^2 + c^2)"),
    (("omega_x = theta' cos phi + psi' sin theta sin phi", "omega_y = theta' sin phi - psi' sin theta cos phi",
      "omega_z = psi' + phi' cos theta"), "omega_z = phi' + psi'*cos(theta)"),
    (("omega_x = theta' cos psi + phi' sin theta sin psi", "omega_y = theta' sin phi - psi' sin theta cos phi",
      "omega_z = psi' + phi' cos theta"), "omega_y = theta'*sin(psi) - phi'*sin(theta)*cos(psi)"),
])  # fmt: skip
def test_of_lines_that_do_not_fit_together_one_is_repaired(lines, repair):
    """Each line alone is known; the letters of the third text mean other angles on its second line than on the first."""
    verdict = symrot.check("\n".join(lines))
    assert (verdict.verdict, verdict.diagnosis.code) == ("doubtful", "wrong_symbol")
    assert [each.text for each in verdict.repairs] == [repair]


@pytest.mark.parametrize(("claim", "body", "repair"), [
    (r"I_x = \bar I_{x'} + m(\bar x^2+\bar z^2)", "", r"I_x = \bar{I}_{x'} + m (\bar{y}^2 + \bar{z}^2)"),
    ("I_z = I_x - I_y", "thin plate in the plane of x and y", "I_z = I_x + I_y"),
])  # fmt: skip
def test_a_wrong_axis_and_a_wrong_sign_of_moments_are_found(claim, body, repair):
    verdict = symrot.check(claim, body=body)
    assert (verdict.verdict, [each.text for each in verdict.repairs]) == ("doubtful", [repair])


def test_a_difference_of_moments_is_open_without_the_plane_of_the_body():
    """In the plane of y and z, I_x is the sum."""
    assert symrot.check("I_z = I_x - I_y").verdict == "definition"


@pytest.mark.parametrize("claim", [
    "R_11 = cos phi cos theta cos psi - sin phi sin psi", "e_1 = (A_23 - A_32)/(2 sin Phi)", "phi = atan2(r_23, r_13)",
    "L_1' = (1/I_3 - 1/I_2) L_2 L_3", "omega = sqrt(kappa/I)",
    "L = (I_1 w_1, I_1 w_2, I_3 w_3)", "a = (m_1 - m_2) g/(m_1 + m_2 + M/2)",
    "θ = -asin(R_31)", r"R = \begin{pmatrix} \cos\theta & -\sin\theta \\ \sin\theta & \cos\theta \end{pmatrix}",
    "T = m g/(1 + m R^2/I)", "I_xy = 1/4 m a b", "M_x = I_t ω̇_x + (I_a − I_t) ω_y ω_z", "I_s² S² ≥ 4 m g l I",
    "M_x = I_0(θ̈ − ψ̇² sin θ cos θ) + I ψ̇(ψ̇ cos θ + φ̇) sin θ", "ω₃ ≥ (2/I₃) √(M g l I₁ cos θ)", "ω² = ω_0² - 2αθ", "θ = ω_0 t - ½αt²", "θ = asin(2(q_0 q_2 + q_1 q_3))",
    "E = L^2/(2 I_1) + 1/2 (1/I_3 - 1/I_1) L_3^2", "I = m/6 (a^2 b^2 + b^2 c^2 + c^2 a^2)/(a^2 + b^2 + c^2)",
])  # fmt: skip
def test_formulas_of_further_books_are_known(claim):
    """Entries of Euler matrices, an axis and an angle from a matrix, symmetric bodies, a torsional pendulum, a box."""
    assert symrot.check(claim).verdict == "recognised"


def test_a_body_that_is_symmetric_about_axis_1_is_not_accused():
    """The second I_2 may also be a misprint of I_3."""
    verdict = symrot.check("L = (J_1 w_1, J_2 w_2, J_2 w_3)")
    assert verdict.verdict == "definition" and "symmetric about axis 1" in verdict.reason


def test_numbered_moments_are_not_those_of_a_symmetric_body():
    """I_1 may stand for I_2."""
    assert symrot.check("N_1 = I_1 omega_1' + omega_2 omega_3 (I_3 - I_1)", repair=False).verdict == "definition"


def test_a_pendulum_with_the_other_sign_stands_upright():
    assert any("upright" in note for note in symrot.check("θ'' = (g/l) sin θ").notes)


def test_the_first_angle_of_a_matrix_is_not_called_as_the_third_one():
    """With the arguments exchanged, it would be the third angle of ZXZ for the transposed matrix."""
    assert symrot.check("phi = atan2(r_13, r_23)").verdict == "definition"
    assert symrot.check("psi = atan2(A_13, A_23)").verdict == "recognised"

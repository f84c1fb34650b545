"""Claims that name a vector, a tensor between vectors, or rates in short forms: recognised, and doubtful with a fault."""

import pytest

import symrot

ZYZ = r"\begin{bmatrix} 0 & -s_\varphi & c_\varphi s_\vartheta \\ 0 & c_\varphi & s_\varphi %s \\ 1 & 0 & c_\vartheta \end{bmatrix}"
CRAIG = (
    "[[ca cb, ca sb sg - sa cg, ca sb cg %s sa sg], [sa cb, sa sb sg + ca cg, sa sb cg - ca sg], [-sb, cb sg, cb cg]]"
)

SINE, COSINE = r"s_\vartheta", r"c_\vartheta"
ROTATED, PRODUCT, RATES = (
    "rotated vector",
    "vector part of the quaternion product",
    "vector part of the quaternion rates",
)
ALONG, MOMENTUM = "angular velocity of", "angular momentum I omega along the principal axes"
AXIS, GYROSCOPE, LEVEL = (
    "moment of inertia about an axis of any",
    "torque on a gyroscope",
    "torque of steady precession",
)

RECOGNISED = (
    ("w = u cos phi + (e x u) sin phi + (1 - cos phi) (e . u) e", ROTATED),
    (r"\mathbf b = \mathbf a\cos\theta + (\mathbf k\times\mathbf a)\sin\theta + \mathbf k(\mathbf k\cdot\mathbf a)(1-\cos\theta)", ROTATED),
    (r"\mathbf L = \mathbf v\cos\theta + (\mathbf n\times\mathbf v)\sin\theta + (1-\cos\theta)(\mathbf n\cdot\mathbf v)\mathbf n", ROTATED),
    ("w = (2 q_0^2 - 1) v + 2 (q . v) q + 2 q_0 (q x v)", ROTATED),
    ("h = (2 q_0^2 - 1) v + 2 (q . v) q + 2 q_0 (q x v)", ROTATED),
    (r"\mathbf r = p_0\mathbf q + q_0\mathbf p + \mathbf p\times\mathbf q", PRODUCT),
    (r"\mathbf r = p_0\mathbf q + q_0\mathbf p - \mathbf q\times\mathbf p", PRODUCT),
    (r"\mathbf v = a_0\mathbf b + b_0\mathbf a + \mathbf a\times\mathbf b", PRODUCT),
    (r"\dot{\mathbf q} = \tfrac12\left(q_4\boldsymbol\omega - \boldsymbol\omega\times\mathbf q\right)", RATES),
    (r"\dot{\boldsymbol\epsilon} = \frac12(\eta\boldsymbol\omega + \boldsymbol\epsilon\times\boldsymbol\omega)", RATES),
    ("q_v' = 1/2 (q_0 omega + q_v x omega)", RATES),
    (r"\boldsymbol\omega = \dot\phi\,\hat{\mathbf z} + \dot\theta\,\mathbf e'_2 + \dot\psi\,\mathbf e_3", ALONG),
    (r"\boldsymbol\omega = \dot\phi\,\mathbf k + \dot\theta\,\mathbf n + \dot\psi\,\mathbf k'", ALONG),
    (r"\vec\omega = \dot\psi\,\vec a_3 + \dot\theta\,\vec b_2 + \dot\phi\,\vec c_1", ALONG),
    (r"\boldsymbol\omega = \dot\alpha\,\hat{\mathbf z} + \dot\beta\,\mathbf y' + \dot\gamma\,\mathbf z''", ALONG),
    (r"\boldsymbol\omega = (-\dot\phi\sin\theta)\mathbf e'_1 + \dot\theta\,\mathbf e'_2 + (\dot\psi+\dot\phi\cos\theta)\mathbf e_3", ALONG + " ZYZ"),
    (r"\boldsymbol\omega = \dot\theta\,\mathbf e_1 + \dot\phi\sin\theta\,\mathbf e_2 + (\dot\psi+\dot\phi\cos\theta)\mathbf e_3", ALONG + " ZXZ"),
    ("H = I_1 omega_1 b_1 + I_2 omega_2 b_2 + I_3 omega_3 b_3", MOMENTUM),
    (r"\mathbf H = I_1\omega_1\mathbf b_1 + I_2\omega_2\mathbf b_2 + I_3\omega_3\mathbf b_3", MOMENTUM),
    ("L = I_x omega_x i + I_y omega_y j + I_z omega_z k", MOMENTUM),
    (r"\mathbf L = A p\,\mathbf i + B q\,\mathbf j + C r\,\mathbf k", "angular momentum I omega, principal axes"),
    (r"I = \mathbf{n}\cdot\mathbf{I}\cdot\mathbf{n}", AXIS), (r"I_n = \mathbf n\cdot\mathbf I\cdot\mathbf n", AXIS),
    (r"I = \mathbf u\cdot\mathbf J\cdot\mathbf u", AXIS), (r"I = \mathbf n^T\mathbf I\mathbf n", AXIS),
    (r"T = \frac12\boldsymbol\omega\cdot\mathbf I\cdot\boldsymbol\omega", "kinetic energy of rotation"),
    (r"\mathbf M = I\,\boldsymbol\Omega\times\mathbf p", GYROSCOPE), ("M = I Omega x p", GYROSCOPE),
    ("ΣM_x = I_z Ω_y ω_z", LEVEL), (r"\sum M_x = I_z\Omega_y\omega_z", LEVEL), ("M_y = I_z Omega_x p", LEVEL),
    (r"\omega_1 = \dot\theta_1 c_2 c_3 + \dot\theta_2 s_3", ALONG + " XYZ"),
    (r"\omega_2 = -\dot\theta_1 c_2 s_3 + \dot\theta_2 c_3", ALONG + " XYZ"),
    (r"\omega_1 = \dot{\theta}_1 c_2 c_3 + \dot{\theta}_2 s_3", ALONG + " XYZ"),
    (r"\omega_1 = \dot\phi_1 c_2 c_3 + \dot\phi_2 s_3", ALONG + " XYZ"),
    ("omega_1 = theta_1' cos theta_2 cos theta_3 + theta_2' sin theta_3", ALONG + " XYZ"),
    (rf"\omega_e = {ZYZ % SINE}\dot\phi_e", "ZYZ space-frame rate Jacobian"),
    (rf"\boldsymbol\omega = {ZYZ % SINE}\dot{{\boldsymbol\phi}}", "ZYZ space-frame rate Jacobian"),
    ("omega = [[1, 0, -sin(theta)], [0, cos(phi), sin(phi) cos(theta)], [0, -sin(phi), cos(phi) cos(theta)]] q'", "xyz body"),
    (r"\dot\phi_e = \begin{bmatrix} 1 & \sin\phi\tan\theta & \cos\phi\tan\theta \\ 0 & \cos\phi & -\sin\phi \\"
     r" 0 & \sin\phi/\cos\theta & \cos\phi/\cos\theta\end{bmatrix}\omega", "inverse of the xyz body-frame rate Jacobian"),
    (f"R = {CRAIG % '+'}", "rotation matrix of"), (f"R_XYZ(gamma, beta, alpha) = {CRAIG % '+'}", "rotation matrix of"),
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "name"), RECOGNISED)
def test_a_right_formula_is_recognised(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised"
    assert any(name in known.name for known in verdict.recognised_as)


@pytest.mark.thinned(5)
@pytest.mark.parametrize("claim", [
    "w = u cos phi + (e x u) sin phi + (1 + cos phi) (e . u) e", "w = u cos phi + (e x u) cos phi + (1 - cos phi) (e . u) e",
    "w = (2 q_0 - 1) v + 2 (q . v) q + 2 q_0 (q x v)", "w = (2 q_0^2 - 1) v + 2 (q . v) q + q_0 (q x v)",
    r"\mathbf r = p_0\mathbf q - q_0\mathbf p + \mathbf p\times\mathbf q",
    r"\dot{\mathbf q} = q_4\boldsymbol\omega - \boldsymbol\omega\times\mathbf q",
    r"\boldsymbol\omega = \dot\theta\,\mathbf e_1 + \dot\phi\sin\theta\,\mathbf e_2 + (\dot\psi+\dot\phi\sin\theta)\mathbf e_3",
    r"\boldsymbol\omega = \dot\phi\,\hat{\mathbf z} + \dot\theta\,\mathbf e'_2 + 2\dot\psi\,\mathbf e_3",
    "H = I_1 omega_1 b_1 + I_2 omega_2 b_2 - I_3 omega_3 b_3", "H = I_1 omega_1 b_1 + I_2 omega_2 b_2 + I_3 omega_3 b_2",
    r"I = 2\mathbf n\cdot\mathbf I\cdot\mathbf n", "M = I p x Omega", "ΣM_x = I_z Ω_y^2 ω_z",
    r"\omega_1 = \dot\theta_1 c_2 s_3 + \dot\theta_2 s_3", rf"\omega_e = {ZYZ % COSINE}\dot\phi_e",
    f"R = {CRAIG % '-'}", r"\dot L = M + \omega\times L",
])  # fmt: skip
def test_a_neighbour_is_doubtful(claim):
    assert symrot.check(claim).verdict == "doubtful"


@pytest.mark.parametrize("claim", [
    "H = m_1 v_1 r_1 + m_2 v_2 r_2 + m_3 v_3 r_3", "ω₁ = θ̇₁ c₂ c₃ + θ̇₂ s₃", r"\omega_3 = \dot\theta_1 s_2 + \dot\theta_3",
    "omega = [[1, 2, 3], [0, 1, 0], [0, 0, 1]] q'",
])  # fmt: skip
def test_a_formula_with_other_letters_is_left_open(claim):
    assert symrot.check(claim).verdict == "definition"


def test_definitions_of_short_forms_agree_with_their_reading():
    claim = r"c\alpha\, s\beta + s\alpha\, c\beta = \sin(\alpha+\beta)"
    stated = [r"c\alpha = \cos\alpha", r"s\alpha = \sin\alpha", r"c\beta = \cos\beta", r"s\beta = \sin(\beta)"]
    assert symrot.check(claim, assume=stated).verdict == "true"
    assert symrot.check(claim.replace("+ s", "- s"), assume=stated).verdict == "false"


def test_a_repair_names_the_angles_of_short_forms():
    (repair, *_) = symrot.check(f"R = {CRAIG % '-'}").repairs
    assert "sin(alpha)*sin(gamma)" in repair.text


@pytest.mark.parametrize(("claim", "verdict"), [
    ("‖a + b‖² = ‖a‖² + 2 a·b + ‖b‖²", "true"), ("‖a+b‖² - ‖a-b‖² = 2 a·b", "false"), (r"\|a+b\|^2 = \|a\|^2 + 2 a\cdot b + \|b\|^2", "true"),
    ("|n̂·v| = |v|", "conditional"), ("(n̂·v) n̂ = v", "false"), (r"(\hat n\cdot v)\hat n = v", "false"), ("(a × b)·c = a·(c × b)", "false"),
])  # fmt: skip
def test_a_dot_between_vectors_is_no_product_of_their_lengths(claim, verdict):
    """With ``a·b`` as |a| |b|, the first claim was conditional and ``(n̂·v) n̂ = v`` true."""
    assert symrot.check(claim, repair=False).verdict == verdict


@pytest.mark.parametrize(("claim", "verdict"), [
    ("v = |v| v̂", "true"), ("v = |v|² v̂", "false"), ("v̂ = v", "false"), ("v̂ = v/|v|", "true"), ("G r̂/r² = G r/r³", "true"), ("r = r r̂", "true"),
    (r"\frac{\hat{\mathbf r}}{r^2} = \frac{\mathbf r}{r^2}", "false"), (r"\frac{\hat r}{r^2} = \frac{\mathbf r}{r^3}", "true"),
    (r"\vec v = v^2\hat v", "false"), (r"\mathbf{\hat n}\cdot\mathbf{\hat n} = 1", "true"), (r"\boldsymbol\omega = \omega\hat n", "conditional"),
])  # fmt: skip
def test_a_name_with_a_hat_is_the_direction_of_the_name_without(claim, verdict):
    """Both were one vector of length 1, so that ``v = |v|² v̂`` was true."""
    assert symrot.check(claim, repair=False).verdict == verdict

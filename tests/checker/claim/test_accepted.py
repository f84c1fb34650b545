"""Formulas as students and engineers type them, with their verdicts: identities, and formulas that name a quantity."""

import pytest

import symrot

IDENTITIES = (
    "sin(2x) = 2 sin x cos x", "cos 2x = cos^2 x - sin^2 x", "cos(a+b) = cos a cos b - sin a sin b", "sin²θ + cos²θ = 1",
    "1 - cos θ = 2 sin²(θ/2)", "tan x = sin x/cos x", "(a + b)^2 = a^2 + 2ab + b^2", "(a-b)(a+b) = a² − b²",
    "a × (b × c) = b (a·c) − c (a·b)", "a × b = −b × a", "a·(b × c) = b·(c × a)", "|a × b|² = (a·a)(b·b) - (a·b)²",
    "3 sin x - 4 sin^3 x = sin 3x", "tan^2 x + 1 = 1/cos^2 x", "1 + tan² x = sec² x", "cos²(θ/2) = ½(1 + cos θ)",
    "x³ − y³ = (x − y)(x² + xy + y²)", "e^(2x) = (e^x)^2", "2 sin A cos B = sin(A+B) + sin(A-B)", "cos 45° = 1/√2",
    "cos 4x = 8 cos^4 x - 8 cos^2 x + 1", "x(y+1) = xy + x", "1/2 m (v + u)^2 = ½ m v² + m u v + ½ m u²",
    "(a + b)² = a² + 2 a b + b² = a (a + 2b) + b²", "x = r cos θ\ny = r sin θ\nx² + y² = r²",
    "R = [cos a, -sin a; sin a, cos a]\nR^T R = [1, 0; 0, 1]", "d/dt (x y) = ẋ y + x ẏ", "1500*2π/60 = 50π",
    "R_z(α) R_z(β) = R_z(α + β)", "R_x(α)ᵀ = R_x(−α)", "tr R_z(φ) = 1 + 2 cos φ", "R_x(π) R_y(π) = R_z(π)",
    r"R_z(\alpha) R_z(\beta) = R_z(\alpha + \beta)", r"\operatorname{tr}\left(R_x(\Phi)\right) = 4\cos^2\tfrac{\Phi}{2} - 1",
    "v = [a, b, c]\nw = [p, q, r]\nv.dot(w) = a p + b q + c r", "Matrix([[a, b], [c, d]]).det() == a*d - b*c",
)  # fmt: skip

NAMED = (
    ("I_xx = 1/12 m (b^2 + c^2)", "moment of inertia of a box about its centre of mass, x axis"),
    ("I_zz = m(a² + b²)/12", "moment of inertia of a box about its centre of mass, z axis"),
    ("I_z = ½ m r²", "moment of inertia of a cylinder about its centre of mass, z axis"),
    ("I = ½ m r²", "moment of inertia of a cylinder"), ("I = mr²/2", "moment of inertia of a cylinder"),
    ("I = 2/5 m r^2", "moment of inertia of a sphere"), ("I = 2mr^2/5", "moment of inertia of a sphere"),
    ("I = 1/12 m L^2", "moment of inertia of a rod about its centre of mass"),
    ("I = 1/3 m l²", "moment of inertia of a rod about an end"),
    ("ωx = φ̇ − ψ̇ sin θ", "first component of the angular velocity of xyz in the body frame"),
    ("ω_x = φ̇ − ψ̇ sin θ", "first component of the angular velocity of xyz in the body frame"),
    ("p = φ' − ψ' sin θ", ""), ("ω_y = θ̇ cos φ + ψ̇ cos θ sin φ", "second component of the angular velocity"),
    ("φ̇ = p + q sin φ tan θ + r cos φ tan θ", "first component of the angle rates of xyz from omega in the body"),
    ("phi' = p + (q sin phi + r cos phi) tan theta", "first component of the angle rates of xyz from omega in the body"),
    ("θ̇ = q cos φ − r sin φ", "second component of the angle rates of xyz from omega in the body"),
    ("ψ̇ = (q sin φ + r cos φ)/cos θ", "third component of the angle rates of xyz from omega in the body"),
    ("ψ̇ = (q sin φ + r cos φ) sec θ", "third component of the angle rates of xyz from omega in the body"),
    ("I₁ω̇₁ − (I₂ − I₃)ω₂ω₃ = M₁", "first component of the torque by Euler's equations"),
    ("I_1 omega_1' - (I_2 - I_3) omega_2 omega_3 = M_1", "first component of the torque by Euler's equations"),
    ("ω̇₁ = (I₂ − I₃)/I₁ ω₂ω₃", "first component of the Euler's equations of a free body"),
    ("dω₁/dt = (I₂ − I₃)ω₂ω₃/I₁", "first component of the Euler's equations of a free body"),
    ("T = ½(I₁ω₁² + I₂ω₂² + I₃ω₃²)", "kinetic energy of rotation"),
    ("T = 1/2 (A p^2 + B q^2 + C r^2)", "kinetic energy of rotation"),
    ("v = w x r", "cross product v x n"), ("v = ω × r", "cross product v x n"),
    ("R = [cos θ, −sin θ, 0; sin θ, cos θ, 0; 0, 0, 1]", "rotation about the z axis, body to space"),
    ("R = [[cos a, -sin a, 0], [sin a, cos a, 0], [0, 0, 1]]", "rotation about the z axis, body to space"),
    ("ω_3 = ψ̇ + φ̇ cos θ", "third component of the angular velocity of ZXZ in the body frame"),
    ("ω₁ = φ̇ sin θ sin ψ + θ̇ cos ψ", "first component of the angular velocity of ZXZ in the body frame"),
    ("L_x = I_xx ω_x + I_xy ω_y + I_xz ω_z", "first component of the angular momentum I omega"),
    ("q̇₀ = −½(q₁ω₁ + q₂ω₂ + q₃ω₃)", "scalar component of the quaternion rates from omega in the body frame"),
    ("q0' = -(q1 w1 + q2 w2 + q3 w3)/2", "scalar component of the quaternion rates from omega in the body frame"),
    ("E = ½ m v² + ½ I ω²", "kinetic energy of a body that moves and rotates"),
    ("T = 1/2 I w^2", "kinetic energy of rotation about one axis"),
    ("I_O = I_c + md^2", "moment of inertia about a parallel axis (parallel-axis theorem)"),
    ("P = M ω", "power of a torque about one axis"),
    ("q0 = cos θ/2", "scalar component of the quaternion of axis and angle"),
    ("θ'' = −(g/l) sin θ", "relation for a simple pendulum"),
    ("φ̇ = (ω₁ sin ψ + ω₂ cos ψ)/sin θ", "first component of the angle rates of ZXZ from omega in the body frame"),
)  # fmt: skip

DEFINITIONS = (
    "F = ma", "V = mgh", "T = p²/2m",
    "f = 1/2π √(k/m)", "α = dω/dt",
)  # fmt: skip


@pytest.mark.parametrize("claim", IDENTITIES)
def test_an_identity_is_true(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "name"), NAMED)
def test_a_formula_of_a_quantity_is_recognised(claim, name):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised"
    assert str(verdict.recognised_as[0]).startswith(name)


@pytest.mark.parametrize("claim", DEFINITIONS)
def test_a_formula_that_symrot_does_not_derive_is_a_definition(claim):
    assert symrot.check(claim).verdict == "definition"


@pytest.mark.parametrize("claim", ["√(x²) = x", "tan^-1(tan x) = x", "sin⁻¹(sin x) = x", "|x| = x"])
def test_an_identity_under_a_condition_is_conditional(claim):
    assert symrot.check(claim).verdict == "conditional"


WRONG = (
    ("sin(2x) = sin x cos x", "false", "sin(2*x) = 2*sin(x)*cos(x)"),
    ("cos 2θ = cos²θ + sin²θ", "false", "cos(2*θ) = cos(θ)^2 - sin(θ)^2"),
    ("(a + b)^2 = a^2 + ab + b^2", "false", "(a + b)^2 = a^2 + 2*a*b + b^2"),
    ("a × b = b × a", "false", None), ("a × (b × c) = (a × b) × c", "false", None),
    ("cos²(θ/2) = ½(1 − cos θ)", "false", "cos(θ/2)^2 = 1/2*(1 + cos(θ))"),
    ("x = r cos θ\ny = r cos θ\nx² + y² = r²", "false", None), ("R = [0, 1; 1, 0]\nR^T R = [1, 0; 0, -1]", "false", None),
    ("I_xx = 1/12 m (b^2 - c^2)", "doubtful", "I_xx = 1/12*m*(b^2 + c^2)"),
    ("ω̇₁ = (I₂ + I₃)ω₂ω₃/I₁", "doubtful", "ω₁' = (I₂ - I₃)*ω₂*ω₃/I₁"),
    ("ω₁ = φ̇ sin θ sin ψ − θ̇ cos ψ", "doubtful", "ω₁ = φ'*sin(θ)*sin(ψ) + θ'*cos(ψ)"),
    ("T = ½(I₁ω₁² + I₂ω₂² − I₃ω₃²)", "doubtful", "T = 1/2*(I₁*ω₁^2 + I₂*ω₂^2 + I₃*ω₃^2)"),
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "outcome", "repair"), WRONG)
def test_a_wrong_formula_is_found_and_repaired_in_the_same_notation(claim, outcome, repair):
    verdict = symrot.check(claim)
    assert verdict.verdict == outcome
    if repair is not None:
        assert repair in [near.text for near in verdict.repairs]
        assert symrot.check(repair).verdict in ("true", "recognised")


def test_a_rotation_of_axes_is_read_where_one_of_vectors_does_not_fit():
    """Some books rotate the axes by the angle a, with the transposed matrix; the verdict says which is meant."""
    of_vectors = symrot.check("R_z(a) = [[cos a, -sin a, 0], [sin a, cos a, 0], [0, 0, 1]]")
    of_axes = symrot.check("R_z(a) = [[cos a, sin a, 0], [-sin a, cos a, 0], [0, 0, 1]]")
    assert of_vectors.verdict == of_axes.verdict == "true"
    assert any("rotate the axes" in note for note in of_axes.notes)
    assert not any("rotate the axes" in note for note in of_vectors.notes)
    assert symrot.check("R_z(a) = [[cos a, sin a, 0], [sin a, cos a, 0], [0, 0, 1]]").verdict == "false"
    assert symrot.check("R_x + R_y = F").verdict == "definition"  # forces

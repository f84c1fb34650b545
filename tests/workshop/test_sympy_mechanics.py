"""SymPy's mechanics: bodies and frames there and back, and its equations of motion against those of symrot."""

from fractions import Fraction

import pytest
from sympy import Float, Matrix, Rational, cos, diff, eye, pi, sin, solve, sqrt, symbols, sympify, zeros
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
    outer,
)  # fmt: skip

import symrot
from symrot import symbols as names
from symrot.conventions import SEQUENCES

N = ReferenceFrame("N")
ANGLES, OMEGA = names.angles, names.omega_b


@pytest.mark.parametrize("name", ["box", "cone", "sphere", "torus", "triangular_plate"])
def test_a_solid_there_and_back_has_the_same_tensor(name):
    solid = symrot.solid(name)
    body = symrot.to_sympy(solid)
    assert symrot.from_sympy(body.central_inertia, body.frame) == solid.inertia
    assert body.mass == solid.mass


def test_the_kinetic_energy_of_sympy_is_that_of_the_tensor():
    solid, rates = symrot.solid("triangular_plate"), Matrix(symbols("p q r"))
    body = symrot.to_sympy(solid)
    body.frame.set_ang_vel(
        N, sum((rate * axis for rate, axis in zip(rates, body.frame, strict=True)), 0 * body.frame.x)
    )
    body.masscenter.set_vel(N, 0 * N.x)
    assert symrot.normal_form(body.kinetic_energy(N) - (rates.T * solid.inertia * rates)[0] / 2) == 0


@pytest.mark.parametrize("name", ["t_handle", "heavy_top_loops", "tumbling_prism"])
def test_a_scene_there_and_back_has_the_same_body_start_and_motion(name):
    scene = symrot.load_scene(name)
    body = symrot.to_sympy(scene, N)
    table = symrot.from_sympy(body)
    about_center = symrot.Scene.build(body=table, initial={"omega": [0, 0, 1]}, span={"t": [0, 1]}).body
    assert about_center.mass == scene.body.mass
    if scene.body.about == "center_of_mass":
        assert about_center.inertia == scene.body.inertia
    else:  # moved to the fixed point again
        offset = Matrix([Rational(x.numerator, x.denominator) for x in scene.body.center_of_mass])
        moved = Matrix(3, 3, [Rational(x.numerator, x.denominator) for row in about_center.inertia for x in row])
        moved += body.mass * (offset.dot(offset) * eye(3) - offset * offset.T)
        assert list(moved) == [Rational(x.numerator, x.denominator) for row in scene.body.inertia for x in row]
    omega = body.frame.ang_vel_in(N).to_matrix(body.frame)
    assert [Fraction(int(x.p), int(x.q)) for x in omega] == list(scene.initial.omega_b)
    q = scene.initial.quaternion
    dcm = symrot.from_sympy(body.frame, N)
    assert abs(float(dcm[2, 2]) - float(1 - 2 * (q[1] ** 2 + q[2] ** 2))) < 1e-15


@pytest.mark.parametrize("sequence", SEQUENCES, ids=str)
def test_frames_and_rates_of_all_sequences_agree(sequence):
    frame = ReferenceFrame("B")
    moving = dynamicsymbols("phi theta psi")
    orient = frame.orient_body_fixed if sequence.isupper() else frame.orient_space_fixed
    orient(N, moving, sequence.upper())
    still = dict(zip(moving, ANGLES, strict=True))
    assert symrot.normal_form(symrot.from_sympy(frame, N).xreplace(still) - symrot.dcm(sequence, ANGLES)) == zeros(3, 3)
    rates = symbols("a b c")
    omega = (
        frame.ang_vel_in(N)
        .to_matrix(frame)
        .xreplace(dict(zip([diff(q, dynamicsymbols._t) for q in moving], rates, strict=True)))
    )
    own = symrot.rate_jacobian(sequence) * Matrix(rates)
    assert symrot.normal_form(omega.xreplace(still) - own) == zeros(3, 1)


def test_kanes_method_gives_eulers_equations():
    a, b, c, m1, m2, m3 = symbols("A B C M_1 M_2 M_3", positive=True)
    q, u = dynamicsymbols("q1:4"), dynamicsymbols("u1:4")
    frame, center = ReferenceFrame("B"), Point("G")
    frame.orient_body_fixed(N, q, "ZXZ")
    center.set_vel(N, 0)
    own = frame.ang_vel_in(N).to_matrix(frame)
    kinematic = solve(list(own - Matrix(u)), [diff(angle, dynamicsymbols._t) for angle in q])
    frame.set_ang_vel(N, u[0] * frame.x + u[1] * frame.y + u[2] * frame.z)
    body = RigidBody("b", center, frame, symbols("m"), (inertia(frame, a, b, c), center))
    torque = m1 * frame.x + m2 * frame.y + m3 * frame.z
    kane = KanesMethod(N, q_ind=q, u_ind=u, kd_eqs=[rate - value for rate, value in kinematic.items()])
    kane.kanes_equations([body], [(frame, torque)])
    theirs = kane.mass_matrix.LUsolve(kane.forcing)
    ours = symrot.euler_equations((a, b, c), (m1, m2, m3))
    assert symrot.normal_form(Matrix(theirs).xreplace(dict(zip(u, OMEGA, strict=True))) - ours) == zeros(3, 1)


def test_lagranges_method_gives_the_heavy_top():
    """The accelerations that symrot's equations imply make Lagrange's equations zero, at 40 digits."""
    a, c, w = Rational(2), Rational(3, 2), Rational(7, 5)
    t = dynamicsymbols._t
    angles = dynamicsymbols("phi theta psi")
    theta = angles[1]
    dphi, dtheta, dpsi = (diff(angle, t) for angle in angles)
    energy = a * (dtheta**2 + dphi**2 * sin(theta) ** 2) / 2 + c * (dpsi + dphi * cos(theta)) ** 2 / 2 - w * cos(theta)
    equations = LagrangesMethod(energy, list(angles)).form_lagranges_equations()
    jacobian = symrot.rate_jacobian("ZXZ")
    down = symrot.dcm("ZXZ", ANGLES).T * Matrix([0, 0, -w])
    torque = Matrix([0, 0, 1]).cross(down)
    alpha = symrot.euler_equations((a, a, c), torque)
    rates = jacobian.inverse * Matrix(OMEGA)
    second = rates.jacobian(ANGLES) * rates + rates.jacobian(OMEGA) * alpha
    for point in ((Rational(1, 3), Rational(4, 5), 2, 1, -2, 3), (2, 1, Rational(1, 7), Rational(1, 2), 5, -1)):
        at = dict(zip((*ANGLES, *OMEGA), point, strict=True))
        values = {diff(angle, t, 2): second[n].evalf(50, subs=at) for n, angle in enumerate(angles)}
        values |= {diff(angle, t): rates[n].evalf(50, subs=at) for n, angle in enumerate(angles)}
        values |= dict(zip(angles, point[:3], strict=True))
        assert all(abs(equation.subs(values).evalf(45)) < Float("1e-40") for equation in equations)


def test_numbers_keep_their_exact_values():
    frame, center = ReferenceFrame("B"), Point("G")
    body = RigidBody("b", center, frame, Float(0.5), (inertia(frame, Rational(1, 3), sqrt(2), 1.5), center))
    table = symrot.from_sympy(body)
    assert (table["mass"], table["inertia"][0][0], table["inertia"][1][1]) == (0.5, Fraction(1, 3), "sqrt(2)")
    scene = symrot.Scene.build(body=table, initial={"omega": [0, 0, 1]}, span={"t": [0, 1]})
    assert scene.body.inertia[0][0] == Fraction(1, 3)
    assert abs(scene.body.inertia[1][1] ** 2 - 2) < Fraction(1, 10**80)


def test_a_scene_takes_matrices_and_expressions_of_sympy():
    """A dcm, a tensor, a column and a control law of SymPy make the scene that their numbers and text make."""
    own = N.orientnew("B", "Axis", (symbols("a"), N.z)).dcm(N).T.subs(symbols("a"), Rational(1, 3))
    k, omega_1, q1 = symbols("k omega_1 q1")
    law = Matrix([-k * omega_1 + Float(1) / 3 * q1**2, 0, 1])
    taken = symrot.Scene.build(
        name="b", body={"inertia": Matrix([[1, 0, 0], [0, 2, 0], [0, 0, Rational(5, 2)]])},
        initial={"omega": Matrix([1, 2, Rational(1, 3)]), "attitude": own}, span={"t": [0, 1]},
        torque=[{"kind": "expression", "torque": law, "parameters": {"k": 2}}],
    )  # fmt: skip
    typed = symrot.Scene.build(
        name="b", body={"principal": [1, 2, "5/2"]},
        initial={"omega": [1, 2, "1/3"], "attitude": {"axis": [0, 0, 1], "angle": "1/3"}}, span={"t": [0, 1]},
        torque=[{"kind": "expression", "torque": [f"-k*omega_1 + {1 / 3!r}*q1**2", 0, 1], "parameters": {"k": 2}}],
    )  # fmt: skip
    assert (taken.body.inertia, taken.initial.omega_b) == (typed.body.inertia, typed.initial.omega_b)
    assert all(abs(a - b) < 1e-15 for a, b in zip(taken.initial.quaternion, typed.initial.quaternion, strict=True))
    assert (symrot.propagate(taken, t=[1.0]).omega == symrot.propagate(typed, t=[1.0]).omega).all()


@pytest.mark.parametrize("omega", [N.x, outer(N.x, N.x), [symbols("a") > 0, 0, 1], [Matrix([1, 2]), 0, 1]], ids=str)
def test_other_values_of_sympy_are_refused_in_a_sentence(omega):
    with pytest.raises(symrot.InputError, match=r"initial\.omega.*: expected"):
        symrot.Scene.build(body={"principal": [1, 2, 2]}, initial={"omega": omega}, span={"t": [0, 1]})


@pytest.mark.parametrize(("value", "frame", "sentence"), [
    (3, None, "a RigidBody, Inertia, Dyadic or ReferenceFrame, got int"),
    (outer(N.x, N.x), None, "the frame of the components, got NoneType"),
    (ReferenceFrame("B"), N, "known orientation relative to each other"),
    (ReferenceFrame("B"), None, "the space frame"),
    (RigidBody("b"), None, "a real number, got b_ixx"),
    (RigidBody("b"), N, "frame: expected none for a RigidBody, which has its own, got N"),
    (RigidBody("b"), Point("O"), "expected none for a RigidBody"),
])  # fmt: skip
def test_what_has_no_meaning_is_refused(value, frame, sentence):
    with pytest.raises(symrot.InputError, match=sentence):
        symrot.from_sympy(value, frame)


def test_the_tensor_of_a_body_is_moved_to_its_centre_and_rotated_to_its_frame():
    frame = N.orientnew("B", "Axis", (pi / 6, N.x))
    origin = Point("O")
    center = origin.locatenew("G", 2 * frame.x + 3 * N.y)
    rows = symrot.from_sympy(RigidBody("b", center, frame, 2, (inertia(N, 50, 60, 70), origin)))["inertia"]
    turn = Matrix([[1, 0, 0], [0, sqrt(3) / 2, Rational(1, 2)], [0, -Rational(1, 2), sqrt(3) / 2]])
    offset = Matrix([2, 3 * sqrt(3) / 2, -Rational(3, 2)])
    tensor = turn * Matrix.diag(50, 60, 70) * turn.T - 2 * (offset.dot(offset) * eye(3) - offset * offset.T)
    assert all(abs(float(sympify(rows[i][j]) - tensor[i, j])) < 1e-13 for i in range(3) for j in range(3))
    loose = RigidBody("b", center, frame, 2, (inertia(ReferenceFrame("C"), 1, 1, 1), center))
    with pytest.raises(symrot.InputError, match="expected a body whose points and frames are connected"):
        symrot.from_sympy(loose)


def test_a_body_without_mass_is_refused():
    with pytest.raises(symrot.InputError, match="mass is unknown"):
        symrot.to_sympy(symrot.load_scene("gyrostat").with_({"body": {"principal": [1, 2, 2]}}))
    with pytest.raises(symrot.InputError, match="a Solid, a Scene or a Body, got str"):
        symrot.to_sympy("t_handle")

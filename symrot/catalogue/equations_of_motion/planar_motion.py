"""Planar motion: a body that rotates about one principal axis keeps rotating about this axis."""

from sympy import Matrix, cos, diag, sin

from symrot import symbols
from symrot.catalogue.tools.motion import rate
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_product, quaternion_to_dcm, unit_relation
from symrot.kinematics.rotations import elementary_rotation
from symrot.proof.derivation import Derivation

AXES = ("first", "second", "third")


def derive() -> Derivation:
    d = Derivation(
        "planar_motion",
        title="Rotation about one principal axis",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 36",
        about=(
            "If angular velocity and torque are along the same principal axis, the angular velocity stays along this "
            r"axis. The motion is then described by one angle with $I \ddot\theta = \tau$, and the attitude is the "
            "initial attitude followed by a rotation by this angle."
        ),
    )
    inertia = diag(*symbols.principal)
    for number, place in enumerate(AXES):
        along = [symbols.omega_b[i] if i == number else 0 for i in range(3)]
        torque = [symbols.torque_b[i] if i == number else 0 for i in range(3)]
        expected = [t / moment for t, moment in zip(torque, symbols.principal, strict=True)]
        d.step(
            f"A rotation about the {place} principal axis stays about this axis: the other two components of the "
            "angular acceleration are zero.",
            angular_acceleration(inertia, Matrix(along), Matrix(torque)),
            Matrix(expected),
            because="angular velocity and angular momentum are parallel, so the gyroscopic term is zero",
            named=r"\dot\omega_b",
        )

    d.section("One angle describes the attitude")
    theta, dtheta, axis = symbols.theta, symbols.dtheta, Matrix([0, 0, 1])
    turn = Matrix([cos(theta / 2), *(sin(theta / 2) * axis)])
    start = Matrix(symbols.quaternion)
    attitude = Matrix(quaternion_product(start, turn))
    d.step(
        r"The initial attitude $q$ followed by a rotation by $\theta$ about axis 3 satisfies the quaternion equation.",
        rate(attitude, {theta: dtheta}),
        Matrix(quaternion_product(attitude, [0, *(dtheta * axis)])) / 2,
        because=r"$\theta$ changes at the rate $\omega_3$",
        named=r"\frac{d}{dt} \left( q\, e^{k \theta/2} \right)",
        display=r"\tfrac12 \left( q\, e^{k \theta/2} \right) (0, 0, 0, \dot\theta)",
    )
    dcm_start, turning = Matrix(quaternion_to_dcm()), elementary_rotation(2, theta)
    d.step(
        "The axis of rotation keeps its direction in space.",
        rate(dcm_start * turning * axis, {theta: dtheta}),
        0,
        because="the body rotates about this axis",
        relations=[unit_relation()],
        named=r"\frac{d}{dt}\,R\,e_3",
    )

    d.section("Torques along the axis")
    vector = Matrix([0, 0, symbols.tau_3])
    d.step(
        "A torque that is constant in space and along the axis is also constant in the body.",
        (dcm_start * turning).T * (dcm_start * vector),
        vector,
        because="the axis of rotation is fixed",
        relations=[unit_relation()],
        named=r"\tau_b",
    )
    level = Matrix([symbols.gamma_1, symbols.gamma_2, 0])
    beside = Matrix([symbols.c_1, symbols.c_2, 0])
    gravity = symbols.W * beside.cross(turning.T * level)
    d.step(
        "If the axis is horizontal and the centre of mass is beside it, gravity has no torque about the other two "
        "axes: the body is a pendulum.",
        gravity[:2, :],
        0,
        because="the arm and the weight lie in the plane of the motion",
        named=r"(\tau_1, \tau_2)",
    )
    spinning = Matrix([0, 0, symbols.omega_3])
    d.step(
        "The angular momentum of a rotor along the axis causes no torque.",
        angular_acceleration(inertia, spinning, Matrix([0, 0, 0]), Matrix([0, 0, symbols.h_3])),
        0,
        because="the angular velocity of the body and the angular momentum of the rotor are parallel",
        named=r"\dot\omega_b",
    )
    d.passage(
        "Each component of a damping torque is a multiple of the same component of the angular velocity, so this "
        "torque is along the axis too."
    )
    return d

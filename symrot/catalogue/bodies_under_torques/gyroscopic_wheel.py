"""Gyroscopic precession of a wheel (Beer & Johnston, Vector Mechanics: Dynamics, chapter 18)."""

from sympy import Matrix, cos, diag, pi, sin

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.proof.derivation import Derivation

PHI, THETA, PSI = symbols.angles
A, C, W, ARM = symbols.A, symbols.C, symbols.W, symbols.c_3
PRECESSION, SPIN = symbols.dphi, symbols.dpsi


def derive() -> Derivation:
    d = Derivation(
        "gyroscopic_wheel",
        title="Gyroscopic precession of a wheel",
        source="Beer, Johnston & Cornwell, *Vector Mechanics for Engineers: Dynamics*, chapter 18",
        about=(
            "A spinning wheel on an axle that is supported at one end does not fall: its axle rotates about the "
            "vertical. The reason is that the angular momentum changes in the direction of the torque, and this "
            "direction is horizontal."
        ),
    )
    momentum, motion = _momentum()
    torque = rate(momentum, motion)
    line = Matrix([cos(PHI), sin(PHI), 0])
    _torque(d, torque, line, momentum)
    _level(d, torque, line)
    _reactions(d)
    return d


def _momentum() -> tuple[Matrix, dict]:  # type: ignore[type-arg]
    """Return the angular momentum of the wheel in space components, and the rates of its Euler angles.

    The nutation angle is constant.
    """
    omega = rate_jacobian("ZXZ") * Matrix([PRECESSION, 0, SPIN])
    return Matrix(dcm("ZXZ")) * diag(A, A, C) * omega, pairs((PHI, PSI), (PRECESSION, SPIN))


def _torque(d: Derivation, torque: Matrix, line: Matrix, momentum: Matrix) -> None:
    d.section("The torque of steady precession")
    d.passage(
        r"The Euler angles have the sequence ZXZ. The nutation and the rates $\dot\phi$ of precession and $\dot\psi$ "
        "of spin are constant. A change of the nutation would tilt the axle about the line of nodes, which has the "
        "direction:",
        ("e", line),
    )
    d.notation({r"\dot L_s": torque, "L_s": momentum, "e_z": Matrix([0, 0, 1]), "A": A, "C": C})
    total = (C * (SPIN + PRECESSION * cos(THETA)) - A * PRECESSION * cos(THETA)) * PRECESSION * sin(THETA)
    d.step(
        r"The rate of the angular momentum is along the line of nodes. A steady precession needs a torque $\dot L_s$.",
        torque,
        total * line,
        because="the angular momentum lies in the plane of the vertical and the axle, and rotates with this plane",
        named=r"\dot L_s",
        display=r"\left( C\,\omega_3 - A\,\dot\phi \cos\theta \right) \dot\phi \sin\theta\;e, \quad \omega_3 = "
        r"\dot\psi + \dot\phi \cos\theta",
    )
    vertical = Matrix([0, 0, 1])
    d.step(
        "The rate of the angular momentum comes from its rotation about the vertical.",
        torque,
        (PRECESSION * vertical).cross(momentum),
        because=r"$L_s$ rotates about the vertical at the rate $\dot\phi$",
        named=r"\dot L_s",
        display=r"\dot\phi\,e_z \times L_s",
    )
    d.step(
        "The torque does no work.",
        torque.dot(Matrix(dcm("ZXZ")) * rate_jacobian("ZXZ") * Matrix([PRECESSION, 0, SPIN])),
        0,
        because="the line of nodes is perpendicular to the vertical and to the axle, and the angular velocity lies in "
        "their plane",
        named=r"\dot L_s \cdot \omega_s",
    )


def _level(d: Derivation, torque: Matrix, line: Matrix) -> None:
    d.section("A horizontal axle")
    level = {THETA: pi / 2}
    axle = Matrix(dcm("ZXZ")).subs(level)[:, 2]
    d.notation({"a": axle, r"\dot L_s": torque.subs(level), "c_3": ARM, "W": W})
    d.step(
        "If the axle is horizontal, the torque that the precession needs does not contain $A$. It is the product of "
        "the axial moment of inertia and the rates of spin and precession.",
        torque.subs(level),
        C * SPIN * PRECESSION * line,
        because=r"$\cos\frac\pi2 = 0$; the result is exact for slow and fast precession",
        named=r"\dot L_s",
        display=r"C\,\dot\psi\,\dot\phi\;e",
    )
    weight = (ARM * axle).cross(Matrix([0, 0, -W]))
    d.step(
        "The weight $W$ of the wheel, at the distance $c_3$ from the support, has a horizontal moment.",
        weight,
        W * ARM * line,
        because="the weight points down, and the arm is horizontal",
        named=r"c_3\,a \times (-W e_z)",
        display=r"W c_3\;e",
    )
    steady = {PRECESSION: W * ARM / (C * SPIN)}
    d.step(
        r"Hence the wheel precesses at $\dot\phi = W c_3 / (C \dot\psi)$. It precesses more slowly the faster it "
        "spins.",
        torque.subs(level).subs(steady),
        weight,
        because="torque is the rate of angular momentum",
        named=r"\left. \dot L_s \right|_{\dot\phi = W c_3 / (C \dot\psi)}",
        display=r"W c_3\;e",
    )
    d.step(
        "The axle moves in the direction of the torque.",
        axle.diff(PHI),
        line,
        because="the axle is horizontal and rotates about the vertical",
        named=r"\frac{\partial a}{\partial \phi}",
        display="e",
    )
    d.step(
        "If the axle is pushed around faster than it precesses, it rises; if it is held back, it sinks. The torque "
        "that tips it, the moment of the weight minus the rate of the angular momentum, acts about the line of nodes.",
        (weight - torque.subs(level)).dot(line),
        W * ARM - C * SPIN * PRECESSION,
        because="the rate of the angular momentum is subtracted from the torque of the weight",
        named=r"\left( \tau_s - \dot L_s \right) \cdot e",
    )


def _reactions(d: Derivation) -> None:
    d.section("A wheel in a rotating frame")
    rotor = C * SPIN * Matrix([0, 0, 1])
    turning = Matrix([symbols.omega_1, symbols.omega_2, 0])
    d.step(
        r"If the frame of a spinning wheel rotates with $\omega$, its bearings must supply a torque perpendicular to "
        r"$\omega$ and to the wheel's axis.",
        turning.cross(rotor),
        C * SPIN * Matrix([symbols.omega_2, -symbols.omega_1, 0]),
        because="the angular momentum of the spin rotates with the frame",
        named=r"\omega \times C\,\dot\psi\,e_3",
    )
    d.step(
        "Two equal wheels that spin in opposite directions need no total torque.",
        turning.cross(rotor) + turning.cross(-rotor),
        0,
        because="the angular momenta of the two wheels cancel",
        named=r"\omega \times \left( C\,\dot\psi\,e_3 - C\,\dot\psi\,e_3 \right)",
    )

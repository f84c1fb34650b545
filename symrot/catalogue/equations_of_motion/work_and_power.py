"""Work and power (Landau & Lifshitz, Mechanics, 3rd ed., section 34; Goldstein, 3rd ed., section 5.5)."""

from sympy import Matrix, Rational, Symbol, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

HALF = Rational(1, 2)
TORQUE, FORCE, V = Matrix(symbols.torque_b), Matrix(symbols.force), Matrix(symbols.velocity)
POINT, OTHER = Matrix(symbols.position), Matrix(symbols.offset)


def derive() -> Derivation:
    d = Derivation(
        "work_and_power",
        title="Work and power",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 34; Beer, Johnston & Cornwell, *Vector Mechanics for "
        "Engineers: Dynamics*, chapter 17",
        about=(
            "The power of forces on a body is the resultant force times the velocity of a reference point, plus the "
            "moment about this point times the angular velocity. This power is the rate of the kinetic energy."
        ),
    )
    _forces(d)
    _energy(d)
    _kinds(d)
    return d


def _forces(d: Derivation) -> None:
    d.section("The power of forces on a body")
    d.notation({"F": FORCE, "v": V, r"\omega": OMEGA, "r": POINT, "d": OTHER, "v_r": V + OMEGA.cross(POINT)})
    d.notation({"v_d": V + OMEGA.cross(OTHER)})
    second = Matrix(symbols.torque_b)
    d.step(
        "The power of a force on a body is the force times the velocity $v$ of a reference point of the body, plus the "
        r"moment of the force about this point times $\omega$. The vector $r$ leads from this point to the force.",
        FORCE.dot(V + OMEGA.cross(POINT)),
        FORCE.dot(V) + POINT.cross(FORCE).dot(OMEGA),
        because="the factors of a triple product may be permuted cyclically",
        named=r"F \cdot (v + \omega \times r)",
        board=(
            ("The scalar product is linear:", r"F \cdot v + F \cdot (\omega \times r)"),
            ("The factors of a triple product may be permuted cyclically:", r"F \cdot v + (r \times F) \cdot \omega"),
        ),
        display=r"F \cdot v + (r \times F) \cdot \omega",
    )
    d.step(
        "The power of a couple, $F$ at $r$ and $-F$ at $d$, does not depend on the reference point.",
        FORCE.dot(V + OMEGA.cross(POINT)) - FORCE.dot(V + OMEGA.cross(OTHER)),
        (POINT - OTHER).cross(FORCE).dot(OMEGA),
        because="the velocity of the reference point cancels",
        named=r"F \cdot v_r - F \cdot v_d",
        board=(
            ("The velocities of both points contain the same $v$:", r"F \cdot (\omega \times (r - d))"),
            (
                "The factors of a triple product may be permuted cyclically:",
                r"\left( (r - d) \times F \right) \cdot \omega",
            ),
        ),
        display=r"\left( (r - d) \times F \right) \cdot \omega",
    )
    d.step(
        "Internal forces between two points of the body, along the line between them, do no work.",
        (Symbol("k", real=True) * (POINT - OTHER)).dot(OMEGA.cross(POINT) - OMEGA.cross(OTHER)),
        0,
        because="the distance between the points does not change",
        named=r"k\,(r - d) \cdot \left( \omega \times r - \omega \times d \right)",
        board=(
            ("The cross product is linear:", r"k\,(r - d) \cdot \left( \omega \times (r - d) \right)"),
            ("A cross product is perpendicular to its factors:", "0"),
        ),
    )
    dcm_sb = Matrix(quaternion_to_dcm())
    d.notation(
        {"R": dcm_sb, r"\tau_b": second, r"\omega_b": OMEGA, r"\tau_s": dcm_sb * second, r"\omega_s": dcm_sb * OMEGA}
    )  # fmt: skip
    d.step(
        "Power is the same in body and space components.",
        (dcm_sb * second).dot(dcm_sb * OMEGA),
        second.dot(OMEGA),
        because="a rotation preserves scalar products",
        relations=[unit_relation()],
        named=r"\tau_s \cdot \omega_s",
        board=(
            (r"$\tau_s = R\,\tau_b$ and $\omega_s = R\,\omega_b$:", r"\tau_b \cdot R^{\mathsf T} R\,\omega_b"),
            (r"$R^{\mathsf T} R = 1$:", r"\tau_b \cdot \omega_b"),
        ),
        display=r"\tau_b \cdot \omega_b",
    )


def _energy(d: Derivation) -> None:
    d.section("Power is the rate of the kinetic energy")
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    motion = pairs(symbols.omega_b, angular_acceleration(TENSOR, OMEGA, TORQUE))
    d.notation({"I": TENSOR, r"\tau": TORQUE}, motion)
    d.step(
        "The rate of the rotational energy is the power of the torque, for any inertia tensor.",
        rate(HALF * OMEGA.dot(TENSOR * OMEGA), motion),
        TORQUE.dot(OMEGA),
        because=r"the gyroscopic term is perpendicular to $\omega$",
        named=r"\frac{d}{dt}\,\tfrac12\,\omega \cdot I\,\omega",
        board=(
            (
                "The tensor is symmetric and constant, so the two terms of the product rule are equal:",
                r"\omega \cdot I\,\dot\omega",
            ),
            ("Euler's equations:", r"\omega \cdot \left( \tau - \omega \times I\,\omega \right)"),
            ("A cross product is perpendicular to its factors:", r"\tau \cdot \omega"),
        ),
        display=r"\tau \cdot \omega",
    )
    falling = pairs(symbols.velocity, FORCE / symbols.m)
    d.notation({"m": symbols.m}, falling)
    d.step(
        "The rate of the translational energy is the power of the force.",
        rate(HALF * symbols.m * squared(V), falling),
        FORCE.dot(V),
        because=r"$m\,\dot v = F$",
        named=r"\frac{d}{dt}\,\tfrac12\,m\,|v|^2",
        display=r"F \cdot v",
        board=(
            ("The square of the speed is differentiated:", r"m\,v \cdot \dot v"),
            (r"Newton's law, $m\,\dot v = F$:", r"F \cdot v"),
        ),
    )
    d.step(
        "For rotation about a fixed axis under a constant torque, the work is the torque times the angle.",
        rate(
            HALF * symbols.C * symbols.omega_3**2 - symbols.tau_3 * symbols.psi,
            {symbols.omega_3: symbols.tau_3 / symbols.C, symbols.psi: symbols.omega_3},
        ),
        0,
        because=r"$C\,\dot\omega_3 = \tau_3$ and $\dot\psi = \omega_3$",
        named=r"\frac{d}{dt} \left( \tfrac12\,C\,\omega_3^2 - \tau_3\,\psi \right)",
    )


def _kinds(d: Derivation) -> None:
    d.section("Torques with and without a loss of energy")
    fixed, arm, dcm_sb = Matrix(symbols.normal), Matrix(symbols.center_of_mass), Matrix(quaternion_to_dcm())
    down = dcm_sb.T * fixed
    d.notation({"c": arm, r"\gamma": down}, attitude_rates())
    d.step(
        "The power of a weight is minus the rate of its potential energy, so the sum of kinetic and potential energy "
        "is constant.",
        rate(-symbols.W * arm.dot(down), attitude_rates()),
        -(symbols.W * arm.cross(down)).dot(OMEGA),
        because=r"the direction of gravity $\gamma$ rotates backwards in the body, $\dot\gamma = \gamma \times \omega$",
        relations=[unit_relation()],
        named=r"\dot V = -\frac{d}{dt}\,W\,c \cdot \gamma",
        board=(
            (
                r"The vector $c$ is constant in the body, and $\dot\gamma = \gamma \times \omega$:",
                r"-W\,c \cdot (\gamma \times \omega)",
            ),
            (
                "The factors of a triple product may be permuted cyclically:",
                r"-\left( W\,c \times \gamma \right) \cdot \omega",
            ),
        ),
        display=r"-\left( W\,c \times \gamma \right) \cdot \omega",
    )
    d.notation({"h": Matrix(symbols.rotor)})
    rotor = Matrix(symbols.rotor)
    d.step(
        "A rotor with a constant speed relative to the body exchanges no energy with the motion of the body: its "
        "torque has no power.",
        (-OMEGA.cross(rotor)).dot(OMEGA),
        0,
        because="the torque of the rotor on the body is perpendicular to the angular velocity",
        named=r"-(\omega \times h) \cdot \omega",
    )
    linear = diag(*symbols.damping)
    d.step(
        "Damping with positive coefficients takes energy from every rotation.",
        (-linear * OMEGA).dot(OMEGA),
        -sum(b * w**2 for b, w in zip(symbols.damping, OMEGA, strict=True)),
        because="the power is minus a sum of squares",
        named=r"\tau \cdot \omega = -b\,\omega \cdot \omega",
    )

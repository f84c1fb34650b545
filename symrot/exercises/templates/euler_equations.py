"""Exercises on Euler's equations: angular acceleration, torque, energy and momentum in body axes."""

from random import Random

from sympy import Expr, Matrix, Rational, diag, solve, sqrt

from symrot.dynamics.equations import euler_equations
from symrot.exercises.problem import Asked, Line, Problem, Quantity, chain, quantity
from symrot.symbols import A, B, C, I_xz, I_yz, I_zz, Omega, omega_1, omega_2, omega_3, tau_1, tau_2, tau_3

OMEGA = Matrix((omega_1, omega_2, omega_3))
MOMENTS = tuple(
    quantity(symbol, numbers, "kg m^2", f"principal moment about axis {axis}")
    for symbol, numbers, axis in ((A, "4 5 6", 1), (B, "5 6 7", 2), (C, "6 7 8", 3))
)
RATES = tuple(quantity(omega, "1 2 3 4 5 6", "rad/s", f"component {n}") for n, omega in enumerate(OMEGA, 1))
TORQUES = tuple(
    quantity(tau, "2 4 6 8 10 12", "N m", f"torque about axis {n}") for n, tau in enumerate((tau_1, tau_2, tau_3), 1)
)
BODY = (
    "A rigid body has the principal moments $A$, $B$, $C$. At a given time its angular velocity in body axes is "
    r"$(\omega_1, \omega_2, \omega_3)$."
)


def _used(formula: Expr) -> tuple[Quantity, ...]:
    return tuple(each for each in (*MOMENTS, *RATES, *TORQUES) if formula.has(each.symbol))


def _balance(row: int, acceleration: Expr) -> Expr:
    """Return the torque about axis ``row`` (0, 1 or 2) that Euler's equation requires for the angular acceleration."""
    inertia = diag(A, B, C)
    return (inertia * Matrix([acceleration if n == row else 0 for n in range(3)]) + OMEGA.cross(inertia * OMEGA))[row]


def free_acceleration(random: Random) -> Problem:
    """Return a problem that asks for the angular acceleration of a free body about one axis."""
    row = random.randrange(3)
    acceleration = euler_equations(torque=None)[row]
    name = rf"\dot\omega_{row + 1}"
    return Problem(
        "The angular acceleration of a free body",
        BODY + " No torque acts on it.",
        r"Euler's equations: $I \dot\omega + \omega \times I \omega = 0$ in principal axes.",
        _used(acceleration),
        (
            Line(
                "Euler's equation for this axis is satisfied.",
                _balance(row, acceleration),
                0,
                rf"{'ABC'[row]}\,\dot\omega_{row + 1} + (\omega \times I\omega)_{row + 1}",
            ),
            Line("The equation is solved for the angular acceleration.", acceleration, acceleration, name),
        ),
        (Asked(name, f"the angular acceleration about axis {row + 1}", acceleration, "rad/s^2"),),
    )


def driven_acceleration(random: Random) -> Problem:
    """Return a problem that asks for the angular acceleration of a body under a torque about one axis."""
    row = random.randrange(3)
    acceleration = euler_equations()[row]
    name = rf"\dot\omega_{row + 1}"
    return Problem(
        "The angular acceleration under a torque",
        BODY + rf" The torque about axis {row + 1} is $\tau_{row + 1}$.",
        r"Euler's equations: $I \dot\omega + \omega \times I \omega = \tau$ in principal axes.",
        _used(acceleration),
        (
            Line(
                "Euler's equation for this axis is satisfied.",
                _balance(row, acceleration),
                (tau_1, tau_2, tau_3)[row],
                rf"{'ABC'[row]}\,\dot\omega_{row + 1} + (\omega \times I\omega)_{row + 1}",
            ),
            Line("The equation is solved for the angular acceleration.", acceleration, acceleration, name),
        ),
        (Asked(name, f"the angular acceleration about axis {row + 1}", acceleration, "rad/s^2"),),
        sketch=(f"τ_{row + 1}",),
    )


def torque_to_keep(random: Random) -> Problem:
    """Return a problem that asks for the torque that keeps the angular velocity fixed in body axes."""
    row = random.randrange(3)
    tau = (tau_1, tau_2, tau_3)[row]
    (needed,) = solve(euler_equations()[row], tau)
    torque = _balance(row, Rational(0))
    name = rf"\tau_{row + 1}"
    return Problem(
        "The torque that keeps a rotation steady",
        BODY + " Motors keep all three components constant.",
        r"With $\dot\omega = 0$ only the gyroscopic part of Euler's equations remains: $\tau = \omega \times I "
        r"\omega$.",
        _used(needed),
        chain(
            name,
            r"A component of $\omega \times I \omega$.",
            needed,
            torque,
            needed.factor(),
            "The common factor is put in front.",
        ),
        (Asked(name, f"the torque about axis {row + 1}", needed.factor(), "N m"),),
        sketch=(f"τ_{row + 1}",),
    )


def kinetic_energy(random: Random) -> Problem:
    """Return a problem that asks for the kinetic energy of rotation in principal axes."""
    energy = (OMEGA.T * diag(A, B, C) * OMEGA)[0] / 2
    written = A * omega_1**2 / 2 + B * omega_2**2 / 2 + C * omega_3**2 / 2
    return Problem(
        "The kinetic energy of rotation",
        BODY,
        r"The energy is $T = \tfrac12\,\omega \cdot I \omega$.",
        _used(energy),
        (Line("In principal axes each component contributes by itself.", energy, written, "T"),),
        (Asked("T", "the kinetic energy of rotation", written, "J"),),
    )


def angular_momentum(random: Random) -> Problem:
    """Return a problem that asks for the magnitude of a body's angular momentum."""
    momentum = diag(A, B, C) * OMEGA
    square = (momentum.T * momentum)[0]
    return Problem(
        "The magnitude of the angular momentum",
        BODY,
        r"The angular momentum is $H = I \omega$; its components in principal axes are $A\omega_1$, $B\omega_2$, "
        r"$C\omega_3$.",
        _used(square),
        (
            Line(
                "The sum of the squares of the components.",
                square,
                A**2 * omega_1**2 + B**2 * omega_2**2 + C**2 * omega_3**2,
                "H^2",
            ),
            Line("The square root is taken.", sqrt(square), sqrt(square), "H"),
        ),
        (Asked("H", "the magnitude of the angular momentum", sqrt(square), "kg m^2/s"),),
        sketch=("H",),
    )


def unbalanced_shaft(random: Random) -> Problem:
    """Return a problem that asks for the bearings' torque on a shaft whose axis is not a principal axis."""
    tensor = Matrix([[A, 0, I_xz], [0, B, I_yz], [I_xz, I_yz, I_zz]])
    rotation = Matrix((0, 0, Omega))
    torque = rotation.cross(tensor * rotation)
    row = random.choice((0, 1))
    product = (I_yz, I_xz)[row]
    name = rf"\tau_{'xy'[row]}"
    return Problem(
        "An unbalanced shaft",
        r"A rotor rotates at the constant rate $\Omega$ about the axis $z$ of its bearings. Its product of inertia "
        rf"$I_{{{'yx'[row]}z}}$ is not zero; products have the minus sign, $I_{{xz}} = -\int x z\,dm$.",
        r"In axes fixed in the rotor $\dot\omega = 0$, so that the bearings supply $\tau = \omega \times I \omega$.",
        (
            quantity(product, "0.01 0.02 0.04 0.05 0.1", "kg m^2", "product of inertia"),
            quantity(Omega, "300 600 900 1200 1500 3000", "rpm", "speed"),
        ),
        (Line(r"The component of $\omega \times I\omega$.", torque[row], torque[row], name),),
        (Asked(name, f"the torque of the bearings about the ${'xy'[row]}$ axis of the rotor", torque[row], "N m"),),
    )


def power_of_torque(random: Random) -> Problem:
    """Return a problem that asks for the power of a torque, that is, for the rate of the kinetic energy."""
    rates = euler_equations()
    energy = (OMEGA.T * diag(A, B, C) * OMEGA)[0] / 2
    power = sum((energy.diff(omega) * rate for omega, rate in zip(OMEGA, rates, strict=True)), Rational(0))
    formula = omega_1 * tau_1 + omega_2 * tau_2 + omega_3 * tau_3
    return Problem(
        "The power of a torque",
        BODY + r" The torque in body axes is $(\tau_1, \tau_2, \tau_3)$.",
        r"The rate of the kinetic energy is the power of the torque, $P = \tau \cdot \omega$.",
        _used(formula),
        (
            Line(
                "The energy is differentiated with Euler's equations; the gyroscopic terms cancel.", power, formula, "P"
            ),
        ),
        (Asked("P", "the power", formula, "W"),),
        sketch=("τ",),
    )

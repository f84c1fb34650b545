"""Lagrange's equations in Euler angles are Euler's equations (Whittaker, Analytical Dynamics, 4th ed., section 69)."""

from sympy import Expr, Matrix, eye, sin

from symrot import symbols
from symrot.catalogue.tools.motion import TENSOR, pairs, rate
from symrot.conventions import INTRINSIC_SEQUENCES
from symrot.kinematics.euler import rate_jacobian
from symrot.proof.derivation import Derivation, Step

EXAMPLE = "ZXZ"
ANGLES, RATES = Matrix(symbols.angles), Matrix(symbols.angle_rates)
MOTION = pairs(symbols.angles, symbols.angle_rates) | pairs(symbols.angle_rates, symbols.angle_accelerations)
TORQUE, MOMENTUM = Matrix(symbols.torque_b), Matrix(symbols.rotor)


def lagrange(energy: Expr) -> Matrix:
    """Return ``d/dt (dT/d(rate)) - dT/d(angle)`` of the energy T for the three Euler angles, shape (3, 1)."""
    return Matrix([rate(energy.diff(dq), MOTION) - energy.diff(q) for q, dq in zip(ANGLES, RATES, strict=True)])


def derive() -> Derivation:
    d = Derivation(
        "lagrange_and_euler",
        title="Lagrange's equations are Euler's equations",
        source="Whittaker, *A Treatise on the Analytical Dynamics of Particles and Rigid Bodies*, 4th ed., section 69; "
        "Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 5.5",
        about=(
            "Lagrange's equations for the kinetic energy in Euler angles are Euler's equations multiplied by "
            r"$B^{\mathsf T}$, where $\omega_b = B \dot q$. The two sets of equations are equivalent wherever $B$ has "
            "an inverse."
        ),
    )
    _transposition(d)
    _equations(d)
    _torques(d)
    _other_sequences(d)
    return d


def _transposition(d: Derivation) -> None:
    d.section("Lagrange's operator on a product with omega")
    d.passage(
        r"Let $\mu$ be any vector with constant body components. Lagrange's operator $E$ is applied to the product "
        r"$\mu \cdot \omega = \mu \cdot B \dot q$:",
        (r"E_k[T]", r"\frac{d}{dt} \frac{\partial T}{\partial \dot q_k} - \frac{\partial T}{\partial q_k}"),
    )
    _one_sequence(
        d, EXAMPLE, rf"For the sequence {EXAMPLE}, Lagrange's operator turns $\mu \cdot \omega$ into "
        r"$\omega \times \mu$, multiplied by the transpose of $B$."
    )  # fmt: skip
    d.passage(
        r"In the kinetic energy $\tfrac12\,\omega \cdot I\,\omega$, the angular momentum $I\,\omega$ takes the place "
        r"of the constant vector $\mu$. It changes with time, which adds the term $B^{\mathsf T} I \dot\omega$ to "
        r"Lagrange's expression. The term above becomes the gyroscopic term $B^{\mathsf T} (\omega \times "
        r"I\,\omega)$."
    )


def _one_sequence(d: Derivation, sequence: str, claim: str) -> Step:
    """Add one step: E[mu . omega] = B^T (omega x mu) for the Euler sequence ``sequence``; ``claim`` is the step's text.

    E is Lagrange's operator ``d/dt d/d(dq) - d/dq``, mu is a constant vector with three symbols as body components, and
    B gives the angular velocity: omega = B dq.
    """
    body = rate_jacobian(sequence)
    omega = body * RATES
    d.notation({"B": body.as_immutable(), r"\omega": omega, r"\mu": MOMENTUM})
    return d.step(
        claim,
        lagrange(MOMENTUM.dot(omega)),
        body.T * omega.cross(MOMENTUM),
        because="the columns of $B$ are the axes of the rotations, which rotate with the later rotations "
        "of the sequence",
        named=r"E[\mu \cdot \omega]",
        display=r"B^{\mathsf T} \left( \omega \times \mu \right)",
    )


def _other_sequences(d: Derivation) -> None:
    d.section("The other sequences")
    others = [sequence for sequence in INTRINSIC_SEQUENCES if sequence != EXAMPLE]
    rows = [((sequence,), [_one_sequence(d, sequence, f"The sequence {sequence}.")]) for sequence in others]
    d.tabulate(
        "For one sequence, Lagrange's equations were proven to be equivalent to Euler's, from the relation "
        r"$E[\mu \cdot \omega] = B^{\mathsf T} (\omega \times \mu)$. Here this relation is proven for each of the "
        "other sequences, with the matrix $B$ of that sequence. So Lagrange's equations are equivalent to Euler's for "
        "every sequence.",
        ("Sequence",),
        rows,
    )


def _equations(d: Derivation) -> None:
    d.section("The complete equation for ZXZ")
    body = rate_jacobian("ZXZ")
    omega = body * RATES
    d.notation({"B": body.as_immutable(), r"\omega": omega, "I": TENSOR}, MOTION)
    d.notation({f"omega_{n + 1}".replace("omega", r"\omega"): omega[n] for n in range(3)})
    d.step(
        "Lagrange's operator is applied to the kinetic energy with the full inertia tensor.",
        lagrange(omega.dot(TENSOR * omega) / 2),
        body.T * (TENSOR * rate(omega, MOTION) + omega.cross(TENSOR * omega)),
        because="both sides are written out in angles, rates and accelerations, and all their terms agree",
        named=r"E \left[ \tfrac12\,\omega \cdot I\,\omega \right]",
        display=r"B^{\mathsf T} \left( I\,\dot\omega + \omega \times I\,\omega \right)",
    )
    principal = Matrix.diag(*symbols.principal)
    d.step(
        "Lagrange's equation for the spin angle is Euler's third equation.",
        lagrange(omega.dot(principal * omega) / 2)[2],
        symbols.C * rate(omega, MOTION)[2] - (symbols.A - symbols.B) * omega[0] * omega[1],
        because=r"the last column of $B$ is $e_3$",
        named=r"E_\psi",
        display=r"C\,\dot\omega_3 - (A - B)\,\omega_1 \omega_2",
    )


def _torques(d: Derivation) -> None:
    d.section("Torques and generalised forces")
    body = rate_jacobian("ZXZ")
    d.notation({r"\tau": TORQUE, r"\dot q": RATES, "Q": body.T * TORQUE, r"\omega": body * RATES})
    d.step(
        "The generalised forces $Q$ are the torques about the axes of the three rotations.",
        TORQUE.dot(body * RATES),
        (body.T * TORQUE).dot(RATES),
        because="the power of the torque is the same in both descriptions",
        named=r"\tau \cdot \omega",
        display=r"\left( B^{\mathsf T} \tau \right) \cdot \dot q = Q \cdot \dot q",
    )
    d.step(
        r"Hence $E = Q$ gives Euler's equations $I\,\dot\omega + \omega \times I\,\omega = \tau$ at every attitude "
        "without gimbal lock.",
        (body.inverse.T * body.T),
        eye(3),
        because=r"$B^{\mathsf T}$ has an inverse where $\sin\theta \neq 0$",
        named=r"B^{-\mathsf T} B^{\mathsf T}",
    )
    height = symbols.W * symbols.c_3 * rate_jacobian("ZXZ")[2, 0]
    d.step(
        r"For a weight on the symmetry axis, at the height $c_3 \cos\theta$ above the fixed point, only the "
        "generalised force of the nutation is not zero.",
        Matrix([-height.diff(angle) for angle in ANGLES]),
        Matrix([0, symbols.W * symbols.c_3 * sin(symbols.theta), 0]),
        because=r"the potential is $W c_3 \cos\theta$",
        named=r"Q = -\frac{\partial V}{\partial q}",
    )

"""Rates of Euler angles for all 24 sequences, from the angular velocity in body and in space components.

For ZXZ: Landau & Lifshitz, Mechanics, 3rd ed., section 35.
"""

from collections.abc import Sequence

from sympy import MatMul, Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate
from symrot.conventions import EXTRINSIC_SEQUENCES, INTRINSIC_SEQUENCES
from symrot.kinematics.euler import EulerRateMatrix, dcm, factors, rate_jacobian
from symrot.kinematics.rotations import elementary_rotation, skew, vee
from symrot.proof.derivation import Derivation, Step
from symrot.proof.notation.printer import formula

RATES = Matrix(symbols.angle_rates)
EXAMPLE = "ZXZ"
"""Sequence of Euler angles whose proof the page of this derivation prints in full; tables state the other sequences."""

THREE_AXES = r"\dot\phi\,e_z + \dot\theta\,R_z(\phi)\,e_x + \dot\psi\,R_z(\phi)\,R_x(\theta)\,e_z"


def derive() -> Derivation:
    d = Derivation(
        "euler_body_rates",
        title="Angular velocity from Euler angle rates, all 24 sequences",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 35, for ZXZ; the other sequences follow in the same "
        "way",
        about=(
            "The direction cosine matrix $R$ maps body components to space components. Its rate defines the angular "
            r"velocity: $\dot R = R\,[\omega_b]_\times = [\omega_s]_\times R$, where $[v]_\times u = v \times u$. An "
            "attitude with Euler angles is three rotations in succession, each about a coordinate axis. Angular "
            "velocities add, so the angular velocity is the sum of three terms: the rate of each angle times the axis "
            r"of its rotation. In matrices, $\omega_b = B_b \dot q$ and $\omega_s = B_s \dot q$, and column $i$ of $B$ "
            "is the axis of rotation $i$ in components of the body (or of space). The page shows this for the "
            "sequence ZXZ; the tables below give the matrices of the other 23 sequences, each proven from the rate "
            "of its own matrix $R$."
        ),
    )
    d.passage(
        r"The angles $q = (\phi, \theta, \psi)$ are in order of application. Sequences in upper case are intrinsic, "
        "about axes of the body; sequences in lower case are extrinsic, about axes of space."
    )
    d.section("The argument, for ZXZ")
    _argument(d)
    d.section("The other intrinsic sequences")
    _tabulate(d, "The table has, for the other sequences about axes of the body, the matrix $B$, its inverse, its "
              "determinant, and the angles of gimbal lock.",
              [sequence for sequence in INTRINSIC_SEQUENCES if sequence != EXAMPLE])  # fmt: skip
    d.section("The extrinsic sequences")
    _tabulate(
        d,
        "The table has, for the sequences about axes of space, the matrices, the determinant and the angles of gimbal "
        "lock. An extrinsic sequence such as xyz equals the intrinsic sequence with the reversed name, ZYX, if the "
        "angles are in reversed order too.",
        EXTRINSIC_SEQUENCES,
    )
    d.section("The direction cosine matrices")
    others = [sequence for sequence in (*INTRINSIC_SEQUENCES, *EXTRINSIC_SEQUENCES) if sequence != EXAMPLE]
    d.tabulate(
        "The matrices $R$, body to space, whose rates prove the tables above. Each is the product of three rotations "
        "about coordinate axes.",
        ("Sequence", "$R$"),
        [((sequence, f"${formula(dcm(sequence))}$"), ()) for sequence in others],
    )
    return d


def _argument(d: Derivation) -> None:
    first, middle, last = factors(EXAMPLE)
    dcm_sb = dcm(EXAMPLE)
    space, body = rate_jacobian(EXAMPLE, "space"), rate_jacobian(EXAMPLE, "body")
    d.passage("The direction cosine matrix is the product of the three rotations:",
              ("R", r"R_z(\phi)\,R_x(\theta)\,R_z(\psi)"), ("", dcm_sb))  # fmt: skip
    d.notation(
        {
            "R": dcm_sb, "B_s": Matrix(space), "e_x": middle.direction, "e_z": first.direction,
            "R_x": lambda angle: elementary_rotation(middle.axis, angle),
            "R_z": lambda angle: elementary_rotation(first.axis, angle),
        }
    )  # fmt: skip
    second, third = first.rotation * middle.direction, first.rotation * middle.rotation * last.direction
    d.step(
        "The angular velocity in space is a sum of three terms: each rotation contributes its rate times its axis, "
        "rotated by the rotations before it.",
        vee(rate(dcm_sb, pairs(symbols.angles, symbols.angle_rates)) * dcm_sb.T),
        Matrix.hstack(first.direction, second, third) * RATES,
        because="angular velocities add, as [the page on the spin tensor](spin_tensor.md) proves",
        named=r"\omega_s",
        display=THREE_AXES,
        board=[
            (
                "The first rotation carries the axes of the second and the third rotation along, and the second "
                "rotation carries the axis of the third along:",
                r"\dot\phi\,e_z + R_z(\phi)\,(\dot\theta\,e_x + R_x(\theta)\,\dot\psi\,e_z)",
            ),
            ("Without brackets:", THREE_AXES),
        ],
    )
    _in_space(d, EXAMPLE)
    _in_body(d, EXAMPLE)
    d.step(
        "The columns of $B_s$ and of $B_b$ are the same three axes, in components of space and of the body.",
        body,
        dcm_sb.T * space,
        because=r"$R^{\mathsf T}$ maps space components to body components",
        named="B_b",
        display=r"R^{\mathsf T} B_s",
    )
    _inverse(d, body)
    _gimbal_lock(d, body)


def _tabulate(d: Derivation, text: str, sequences: Sequence[str]) -> None:
    rows = []
    for sequence in sequences:
        body, space = rate_jacobian(sequence, "body"), rate_jacobian(sequence, "space")
        steps = [_in_body(d, sequence), _in_space(d, sequence), _inverse(d, body), _gimbal_lock(d, body)]
        formulas = body, space, body.inverse, body.determinant
        rows.append(((sequence, *(f"${formula(value)}$" for value in formulas), _points(body)), steps))
    d.tabulate(text, ("Sequence", "$B_b$", "$B_s$", "$B_b^{-1}$", r"$\det B_b$", r"Gimbal lock at $\theta =$"), rows)


def _in_body(d: Derivation, sequence: str) -> Step:
    dcm_sb = dcm(sequence)
    dcm_rate = rate(dcm_sb, pairs(symbols.angles, symbols.angle_rates))
    jacobian = rate_jacobian(sequence, "body")
    return d.step(
        "The angular velocity in the body.",
        vee(dcm_sb.T * dcm_rate),
        jacobian * RATES,
        because=r"$\dot R = R\,[\omega_b]_\times$ holds in all nine entries",
        named=r"\omega_b",
        display=MatMul(jacobian.as_immutable(), RATES),
        via=[("The rate of the matrix, all nine entries:", dcm_rate, dcm_sb * skew(jacobian * RATES))],
    )


def _in_space(d: Derivation, sequence: str) -> Step:
    dcm_sb = dcm(sequence)
    dcm_rate = rate(dcm_sb, pairs(symbols.angles, symbols.angle_rates))
    jacobian = rate_jacobian(sequence, "space")
    return d.step(
        "The angular velocity in space.",
        vee(dcm_rate * dcm_sb.T),
        jacobian * RATES,
        because=r"$\dot R = [\omega_s]_\times R$ holds in all nine entries",
        named=r"\omega_s",
        display=MatMul(jacobian.as_immutable(), RATES),
        via=[("The rate of the matrix, all nine entries:", dcm_rate, skew(jacobian * RATES) * dcm_sb)],
    )


def _inverse(d: Derivation, body: EulerRateMatrix) -> Step:
    return d.step(
        "The angle rates follow from the angular velocity in the body by the inverse matrix.",
        body.inverse * body,
        eye(3),
        because="the product of the inverse matrix and $B_b$ is the unit matrix",
        named=r"\dot q",
        display=MatMul(body.inverse, Matrix(symbols.omega_b)),
    )


def _gimbal_lock(d: Derivation, body: EulerRateMatrix) -> Step:
    variable = formula(body.singular_set.variable)
    return d.step(
        rf"Gimbal lock occurs at ${variable} \in \lbrace {_points(body).strip('$')}\rbrace$ within one revolution.",
        body.det(),
        body.determinant,
        because="at gimbal lock the three axes lie in one plane, and no angle rates give an angular velocity "
        "perpendicular to this plane",
        named=r"\det B_b",
    )


def _points(jacobian: EulerRateMatrix) -> str:
    r"""Return as LaTeX the second Euler angles, from 0 to 2 pi, at gimbal lock, such as ``$0, \pi, 2 \pi$``."""
    return f"${', '.join(formula(point) for point in jacobian.singular_set.points())}$"

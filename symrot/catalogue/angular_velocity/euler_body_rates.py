"""Rates of Euler angles for all 24 sequences, from the angular velocity in body and in space components.

For ZXZ: Landau & Lifshitz, Mechanics, 3rd ed., section 35.
"""

from sympy import MatMul, Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate
from symrot.conventions import SEQUENCES
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.kinematics.rotations import skew, vee
from symrot.proof.derivation import Derivation

RATES = Matrix(symbols.angle_rates)


def derive() -> Derivation:
    d = Derivation(
        "euler_body_rates",
        title="Angular velocity from Euler angle rates, all 24 sequences",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 35, for ZXZ; the other sequences follow in the same "
        "way",
        about=(
            "The direction cosine matrix $R$ maps body components to space components. Its rate defines the angular "
            r"velocity: $\dot R = R\,[\omega_b]_\times = [\omega_s]_\times R$, where $[v]_\times u = v \times u$. For "
            r"each sequence, $R$ is differentiated by the chain rule, and the matrices $B_b$ and $B_s$ of $\omega_b = "
            r"B_b \dot q$ and $\omega_s = B_s \dot q$ are proven from this definition. Column $i$ of $B$ is the axis "
            "of rotation $i$ in components of the body (or of space)."
        ),
    )
    d.passage(
        r"The angles $q = (\phi, \theta, \psi)$ are in order of application. Sequences in upper case are intrinsic, "
        "about axes of the body; sequences in lower case are extrinsic, about axes of space. The proof is the same "
        "for every sequence, so the reasons are printed for the first sequence only; the formulas of the other "
        "sequences follow in the same order."
    )
    for sequence in SEQUENCES:
        _sequence(d, sequence)
    return d


def _sequence(d: Derivation, sequence: str) -> None:
    dcm_sb = dcm(sequence)
    dcm_rate = rate(dcm_sb, pairs(symbols.angles, symbols.angle_rates))
    body, space = rate_jacobian(sequence, "body"), rate_jacobian(sequence, "space")
    d.section(f"{sequence}, {'intrinsic' if sequence.isupper() else 'extrinsic'}")
    d.define("The direction cosine matrix, body to space:", "R", dcm_sb)
    d.step(
        "The angular velocity in the body.",
        vee(dcm_sb.T * dcm_rate),
        body * RATES,
        because=r"$\dot R = R\,[\omega_b]_\times$, all nine entries",
        named=r"\omega_b",
        display=MatMul(body.as_immutable(), RATES),
        via=[("The rate of the matrix, all nine entries:", dcm_rate, dcm_sb * skew(body * RATES))],
    )
    d.step(
        "The angular velocity in space.",
        vee(dcm_rate * dcm_sb.T),
        space * RATES,
        because=r"$\dot R = [\omega_s]_\times R$, all nine entries",
        named=r"\omega_s",
        display=MatMul(space.as_immutable(), RATES),
        via=[("The rate of the matrix, all nine entries:", dcm_rate, skew(space * RATES) * dcm_sb)],
    )
    d.step(
        "The angle rates follow from the angular velocity in the body by the inverse matrix.",
        body.inverse * body,
        eye(3),
        because="the product of the inverse matrix and $B_b$ is the unit matrix",
        named=r"\dot q",
        display=MatMul(body.inverse, Matrix(symbols.omega_b)),
    )
    d.step(
        f"Gimbal lock occurs {_values(body)}.",
        body.det(),
        body.determinant,
        because="at gimbal lock the three axes lie in one plane, and no angle rates give an angular velocity "
        "perpendicular to this plane",
        named=r"\det B_b",
    )


def _latex(expression: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(expression)


def _values(jacobian: object) -> str:
    """Return, as LaTeX, the angles from 0 to 2 pi at which an Euler sequence is singular."""
    singular = jacobian.singular_set  # type: ignore[attr-defined]
    points = ", ".join(_latex(point) for point in singular.points())
    return rf"at ${_latex(singular.variable)} \in \{{{points}\}}$ within one revolution".replace(
        r"\{", r"\lbrace "
    ).replace(r"\}", r"\rbrace")

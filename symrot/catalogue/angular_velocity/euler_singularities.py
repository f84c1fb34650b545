"""Gimbal lock of Euler angles, and how their rates grow near it (Stuelpnagel, SIAM Review 6, 1964, 422-430)."""

from sympy import Matrix, Symbol, eye

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.conventions import INTRINSIC_SEQUENCES, parse_sequence
from symrot.exact import normal_form
from symrot.kinematics.dossier import LockedPoint, singularity_dossier
from symrot.kinematics.euler import dcm, factors, rate_jacobian
from symrot.proof.derivation import Derivation

THETA = symbols.theta
SCALE = Symbol("lambda", real=True)


def derive() -> Derivation:
    d = Derivation(
        "euler_singularities",
        title="Where Euler angles lock, and the limit",
        source="Stuelpnagel, *On the Parametrization of the Three-Dimensional Rotation Group*, SIAM Review 6 (1964), "
        "422-430; for the rates see [all sequences](euler_body_rates.md)",
        about=(
            r"No three numbers describe all attitudes without a singularity. Where $\det B = 0$ in $\omega = B \dot "
            r"q$, "
            "the axes of the first and the last turn are one line: one combination of their angles turns nothing, one "
            "axis is out of reach, and on the way there the rates grow like the inverse of the distance. All twelve "
            "sequences are looked at, at each of their singular angles. The argument is the same for all: the first "
            "one has the reasons, and for the others the formulas follow in the same order."
        ),
    )
    for sequence in INTRINSIC_SEQUENCES:
        _sequence(d, sequence)
    return d


def _sequence(d: Derivation, sequence: str) -> None:
    axes, _ = parse_sequence(sequence)
    proper = axes[0] == axes[2]
    dossier = singularity_dossier(sequence)
    jacobian = rate_jacobian(sequence)
    d.section(f"{sequence}, {'proper Euler' if proper else 'Tait-Bryan'}")
    first, middle, last = factors(sequence)
    angle_cosine = (first.direction.T * middle.rotation * last.direction)[0]
    gram = jacobian.T * jacobian
    d.step(
        f"How badly conditioned: the eigenvalues $\\lambda$ of $B^{{\\mathsf T}} B$ are $1$ and $1 \\pm c$, where $c = "
        f"{_latex(angle_cosine)}$ is the cosine between the first axis and the last.",
        (SCALE * eye(3) - gram).det(method="berkowitz"),
        (SCALE - 1) * (SCALE - 1 - angle_cosine) * (SCALE - 1 + angle_cosine),
        because="the middle axis is at right angles to the other two",
        named=r"\det \left( \lambda - B^{\mathsf T} B \right)",
    )
    adjugate = jacobian.adjugate(method="berkowitz")
    d.step(
        "The determinant times the inverse has no denominator, at any angle.",
        jacobian.determinant * jacobian.inverse,
        adjugate,
        because=r"$B^{-1} \det B$ is the matrix of cofactors of $B$",
        named=r"\det B \; B^{-1}",
        display=r"\mathrm{adj}\,B",
    )
    for point in dossier.locked:
        _locked(d, sequence, adjugate, point)
    if dossier.regular_sequences:
        d.passage(f"Sequences that are regular at all these attitudes: {', '.join(dossier.regular_sequences)}.")


def _locked(d: Derivation, sequence: str, adjugate: Matrix, point: LockedPoint) -> None:
    at = {THETA: point.middle}
    where = rf"\theta = {_latex(point.middle)}"
    jacobian = Matrix(rate_jacobian(sequence)).subs(at)
    silent, lost = Matrix(point.silent_rates), Matrix(point.lost_axis_b)
    attitude = dcm(sequence)
    outer = [attitude.subs(at).diff(angle) for angle in (symbols.phi, symbols.psi)]
    d.step(
        f"At ${where}$ the attitude depends on ${_latex(point.combination)}$ alone.",
        silent[0] * outer[0] + silent[2] * outer[1],
        0,
        because="the first and the last rotation are about the same line",
        named=rf"\left( \partial_\phi {'-' if silent[2] < 0 else '+'} \partial_\psi \right) R",
    )
    d.define("The direction across the axes of the turns there, in the body:", "n", lost)
    d.step(
        "No rates turn the body about it; its length is 1.",
        Matrix([*(jacobian.T * lost), squared(lost)]),
        Matrix([0, 0, 0, 1]),
        because="the direction is perpendicular to all three axes of rotation",
        named=r"\begin{bmatrix} B^{\mathsf T} n \\ n \cdot n \end{bmatrix}",
    )
    strength = normal_form((adjugate.subs(at) * lost).dot(silent) / silent.dot(silent))
    d.step(
        rf"The limit. On the way to ${where}$ the rates grow as $\det B\,\dot q \to {_sign(strength)}"
        rf"s\,(n \cdot \omega)$ along the silent combination $s$, however the attitude is approached.",
        adjugate.subs(at),
        strength * silent * lost.T,
        because="the matrix of cofactors has rank one at gimbal lock",
        named=r"\lim\, \det B\; B^{-1}",
        display=rf"{_sign(strength)}s\,n^{{\mathsf T}},\quad s = {_latex(silent)}",
    )


def _sign(strength: object) -> str:
    """Return a factor as LaTeX, to be printed in front of a product: empty for 1, and a minus sign for -1."""
    return {"1": "", "-1": "-"}.get(_latex(strength), _latex(strength))


def _latex(value: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(value)

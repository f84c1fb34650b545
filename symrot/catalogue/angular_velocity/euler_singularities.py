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
            "q$, the axes of the first and the last rotation coincide. Then one combination of angle rates does not "
            "rotate the body, the body cannot rotate about one direction, and near such an attitude the rates grow "
            "like the inverse of the distance from it. This page treats all twelve sequences at each of their "
            "singular angles. The proof is the same for every sequence, so the reasons are printed for the first "
            "sequence only; the formulas of the other sequences follow in the same order."
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
        rf"The condition number of $B$ follows from the eigenvalues $\lambda$ of $B^{{\mathsf T}} B$: they are $1$ "
        rf"and $1 \pm c$, where $c = {_latex(angle_cosine)}$ is the cosine of the angle between the first and the "
        "last axis.",
        (SCALE * eye(3) - gram).det(method="berkowitz"),
        (SCALE - 1) * (SCALE - 1 - angle_cosine) * (SCALE - 1 + angle_cosine),
        because="the middle axis is perpendicular to the other two axes",
        named=r"\det \left( \lambda - B^{\mathsf T} B \right)",
    )
    adjugate = jacobian.adjugate(method="berkowitz")
    d.step(
        "The product of the determinant of $B$ and its inverse has no denominator, so it is finite at every angle.",
        jacobian.determinant * jacobian.inverse,
        adjugate,
        because=r"$B^{-1} \det B$ is the matrix of cofactors of $B$",
        named=r"\det B \; B^{-1}",
        display=r"\mathrm{adj}\,B",
    )
    for point in dossier.locked:
        _locked(d, sequence, adjugate, point)
    if dossier.regular_sequences:
        d.passage(
            f"Sequences without gimbal lock at any of the attitudes above: {', '.join(dossier.regular_sequences)}."
        )


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
    d.define(
        "At this angle of gimbal lock, all three axes of rotation are perpendicular to one direction, in body "
        "components:",
        "n",
        lost,
    )
    d.step(
        "No angle rates rotate the body about $n$, which has length 1.",
        Matrix([*(jacobian.T * lost), squared(lost)]),
        Matrix([0, 0, 0, 1]),
        because="$n$ is perpendicular to all three axes of rotation",
        named=r"\begin{bmatrix} B^{\mathsf T} n \\ n \cdot n \end{bmatrix}",
    )
    strength = normal_form((adjugate.subs(at) * lost).dot(silent) / silent.dot(silent))
    d.step(
        rf"As $\theta$ approaches gimbal lock at ${where}$, the angle rates grow: $\det B\,\dot q \to "
        rf"{_sign(strength)}s\,(n \cdot \omega)$. Here $s$ are the angle rates that do not rotate the body.",
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

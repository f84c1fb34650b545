"""Gimbal lock of Euler angles, and how their rates grow near it (Stuelpnagel, SIAM Review 6, 1964, 422-430)."""

from sympy import Expr, Matrix, Symbol, eye

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.conventions import INTRINSIC_SEQUENCES, parse_sequence
from symrot.exact import normal_form
from symrot.kinematics.dossier import LockedPoint, singularity_dossier
from symrot.kinematics.euler import dcm, factors, rate_jacobian
from symrot.proof.derivation import Derivation, Step
from symrot.proof.notation.printer import formula

THETA = symbols.theta
SCALE = Symbol("lambda", real=True)
EXAMPLE = "ZYX"
"""The Euler sequence whose proof is printed step by step; tables have the results for the other sequences."""


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
            "like the inverse of the distance from it. The page shows this for the sequence ZYX; the tables below "
            "give the results for the other eleven sequences about axes of the body, at each of their singular angles."
        ),
    )
    d.section("The argument, for ZYX")
    _condition(d, EXAMPLE)
    _cofactors(d, EXAMPLE)
    for point in singularity_dossier(EXAMPLE).locked:
        _locked(d, EXAMPLE, point)
    d.passage(f"Sequences that are regular wherever {EXAMPLE} is in gimbal lock: {_regular(EXAMPLE)}.")
    others = [sequence for sequence in INTRINSIC_SEQUENCES if sequence != EXAMPLE]
    d.section(f"How close to gimbal lock, for the sequences other than {EXAMPLE}")
    d.tabulate(
        "The cosine $c$ of the angle between the first and the last axis determines how close an attitude is to gimbal "
        r"lock: the eigenvalues of $B^{\mathsf T} B$ are $1$ and $1 \pm c$, and $B^{-1} \det B$ is finite at every "
        "angle. The last column of the table lists the sequences that have no gimbal lock wherever the sequence in the "
        "first column has one.",
        ("Sequence", "Kind", "$c$", "Gimbal lock at", "Sequences without gimbal lock there"),
        [
            (
                (sequence, _kind(sequence), f"${formula(_cosine(sequence))}$", _angles(sequence), _regular(sequence)),
                (_condition(d, sequence), _cofactors(d, sequence)),
            )
            for sequence in others
        ],
    )
    d.section(f"What is lost at gimbal lock, for the sequences other than {EXAMPLE}")
    d.tabulate(
        "The table gives for each singular angle: the combination of angles on which the attitude depends; the "
        "direction $n$ (in body components) about which the body cannot rotate; the limit of the product of the "
        r"determinant and the angle rates, $\det B\,\dot q$; and angle rates $s$ at which the body is at rest. The "
        "limit is a multiple of $s$.",
        ("Sequence", r"$\theta$", "Attitude depends on", "$n$", r"$\det B\,\dot q \to$", "$s$"),
        [
            (_cells(sequence, point), _locked(d, sequence, point))
            for sequence in others
            for point in singularity_dossier(sequence).locked
        ],
    )
    return d


def _condition(d: Derivation, sequence: str) -> Step:
    jacobian, cosine = rate_jacobian(sequence), _cosine(sequence)
    return d.step(
        rf"The condition number of $B$ follows from the eigenvalues $\lambda$ of $B^{{\mathsf T}} B$: they are $1$ "
        rf"and $1 \pm c$, where $c = {formula(cosine)}$ is the cosine of the angle between the first and the "
        "last axis.",
        (SCALE * eye(3) - jacobian.T * jacobian).det(method="berkowitz"),
        (SCALE - 1) * (SCALE - 1 - cosine) * (SCALE - 1 + cosine),
        because="the middle axis is perpendicular to the other two axes",
        named=r"\det \left( \lambda - B^{\mathsf T} B \right)",
    )


def _cofactors(d: Derivation, sequence: str) -> Step:
    jacobian = rate_jacobian(sequence)
    return d.step(
        "The inverse of $B$ times the determinant of $B$ has no denominator, so this product is finite at every angle.",
        jacobian.determinant * jacobian.inverse,
        jacobian.adjugate(method="berkowitz"),
        because=r"$B^{-1} \det B$ is the matrix of cofactors of $B$",
        named=r"\det B \; B^{-1}",
        display=r"\mathrm{adj}\,B",
    )


def _locked(d: Derivation, sequence: str, point: LockedPoint) -> tuple[Step, Step, Step]:
    at = {THETA: point.middle}
    where = rf"\theta = {formula(point.middle)}"
    jacobian = Matrix(rate_jacobian(sequence)).subs(at)
    silent, lost = Matrix(point.silent_rates), Matrix(point.lost_axis_b)
    attitude = dcm(sequence)
    outer = [attitude.subs(at).diff(angle) for angle in (symbols.phi, symbols.psi)]
    alone = d.step(
        f"At ${where}$ the attitude depends on ${formula(point.combination)}$ alone.",
        silent[0] * outer[0] + silent[2] * outer[1],
        0,
        because="the first and the last rotation are about the same line",
        named=rf"\left( \partial_\phi {'-' if silent[2] < 0 else '+'} \partial_\psi \right) R",
    )
    d.notation({"n": lost})
    if sequence == EXAMPLE:
        d.define(
            "At this angle of gimbal lock, all three axes of rotation are perpendicular to the following direction $n$ "
            "(body components):",
            "n",
            lost,
        )
    no_rotation = d.step(
        "No rates of the angles give an angular velocity along $n$, which has length 1.",
        Matrix([*(jacobian.T * lost), squared(lost)]),
        Matrix([0, 0, 0, 1]),
        because="$n$ is perpendicular to all three axes of rotation",
        named=r"\begin{bmatrix} B^{\mathsf T} n \\ n \cdot n \end{bmatrix}",
    )
    strength = _strength(sequence, point)
    growth = d.step(
        rf"As $\theta$ approaches gimbal lock at ${where}$, the angle rates grow: $\det B\,\dot q \to "
        f"{_limit(strength)}$. Here $s$ are the angle rates that do not rotate the body.",
        _adjugate(sequence).subs(at),
        strength * silent * lost.T,
        because="the matrix of cofactors has rank one at gimbal lock",
        named=r"\lim\, \det B\; B^{-1}",
        display=rf"{_sign(strength)}s\,n^{{\mathsf T}},\quad s = {formula(silent)}",
    )
    return alone, no_rotation, growth


def _cells(sequence: str, point: LockedPoint) -> tuple[str, ...]:
    values = point.middle, point.combination, Matrix(point.lost_axis_b), _limit(_strength(sequence, point))
    return sequence, *(f"${formula(value)}$" for value in (*values, Matrix(point.silent_rates)))


def _cosine(sequence: str) -> Expr:
    """Return the cosine of the angle between the first and the last axis of the rotations of an Euler sequence.

    It depends on the second angle alone; at gimbal lock it is 1 or -1.
    """
    first, middle, last = factors(sequence)
    return (first.direction.T * middle.rotation * last.direction)[0]


def _adjugate(sequence: str) -> Matrix:
    return rate_jacobian(sequence).adjugate(method="berkowitz")


def _strength(sequence: str, point: LockedPoint) -> Expr:
    """Return the factor k in ``k s n^T``, the limit of ``det B`` times the inverse of B at gimbal lock.

    B maps angle rates to the angular velocity; s are the angle rates that do not rotate the body, and n is the body
    axis about which no angle rates rotate it.
    """
    silent, lost = Matrix(point.silent_rates), Matrix(point.lost_axis_b)
    return normal_form((_adjugate(sequence).subs({THETA: point.middle}) * lost).dot(silent) / silent.dot(silent))


def _kind(sequence: str) -> str:
    axes, _ = parse_sequence(sequence)
    return "proper Euler" if axes[0] == axes[2] else "Tait-Bryan"


def _angles(sequence: str) -> str:
    points = ", ".join(formula(point.middle) for point in singularity_dossier(sequence).locked)
    return rf"$\theta = {points}$"


def _regular(sequence: str) -> str:
    return ", ".join(singularity_dossier(sequence).regular_sequences) or "none"


def _limit(strength: object) -> str:
    return rf"{_sign(strength)}s\,(n \cdot \omega)"


def _sign(strength: object) -> str:
    """Return a factor as LaTeX, to be printed in front of a product: empty for 1, and a minus sign for -1."""
    return {"1": "", "-1": "-"}.get(formula(strength), formula(strength))

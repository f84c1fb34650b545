"""Rodrigues parameters, classical and modified: projections of the unit quaternions from a point onto a hyperplane."""

from dataclasses import dataclass

from sympy import Expr, Matrix, Symbol, eye

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate, squared
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.kinematics.rodrigues import CLASSICAL, MODIFIED, Projection, shadow
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

ONE = eye(3)


@dataclass(frozen=True)
class ProjectionForm:
    """The formulas for classical or for modified Rodrigues parameters, each as an expression and as LaTeX."""

    title: str
    letter: str
    rates: tuple[Symbol, ...]
    dcm: tuple[Matrix, str]
    omega: tuple[Matrix, str]  # B_b; in B_s the skew matrix has the opposite sign
    inverse: tuple[Matrix, str]


def _classical() -> ProjectionForm:
    p = Matrix(symbols.rodrigues)
    k, below = Matrix(skew(p)), 1 + squared(p)
    return ProjectionForm(
        "Classical: axis times the tangent of half the angle",
        "g",
        symbols.rodrigues_rates,
        (ONE + 2 * (k + k**2) / below, r"\mathbf{1} + 2\,\frac{[g]_\times + [g]_\times^2}{1 + |g|^2}"),
        (2 * (ONE - k) / below, r"\frac{2}{1 + |g|^2} \left( \mathbf{1} - [g]_\times \right)"),
        ((ONE + k + p * p.T) / 2, r"\tfrac12 \left( \mathbf{1} + [g]_\times + g\,g^{\mathsf T} \right)"),
    )


def _modified() -> ProjectionForm:
    p = Matrix(symbols.mrp)
    k, square = Matrix(skew(p)), squared(p)
    below, inner = (1 + square) ** 2, (1 - square) * ONE + 2 * p * p.T
    return ProjectionForm(
        "Modified: axis times the tangent of a quarter of the angle",
        "s",
        symbols.mrp_rates,
        (
            ONE + (4 * (1 - square) * k + 8 * k**2) / below,
            r"\mathbf{1} + \frac{4 (1 - |s|^2)\,[s]_\times + 8\,[s]_\times^2}{(1 + |s|^2)^2}",
        ),
        (
            4 * (inner - 2 * k) / below,
            r"\frac{4}{(1 + |s|^2)^2} \left( (1 - |s|^2)\,\mathbf{1} - 2\,[s]_\times + 2\,s\,s^{\mathsf T} \right)",
        ),
        (
            (inner + 2 * k) / 4,
            r"\tfrac14 \left( (1 - |s|^2)\,\mathbf{1} + 2\,[s]_\times + 2\,s\,s^{\mathsf T} \right)",
        ),
    )


def derive() -> Derivation:
    d = Derivation(
        "rodrigues",
        title="Classical and modified Rodrigues parameters",
        source="Schaub & Junkins, *Analytical Mechanics of Space Systems*, chapter 3",
        about=(
            "Three parameters project the sphere of unit quaternions: the classical ones from its centre, "
            r"$g = (q_1, q_2, q_3)/q_0$, the modified ones from the point opposite to 1, "
            r"$s = (q_1, q_2, q_3)/(1 + q_0)$. Everything about them is rational. $[v]_\times$ is the matrix of "
            r"$u \mapsto v \times u$."
        ),
    )
    _projection(d, CLASSICAL, _classical())
    _projection(d, MODIFIED, _modified())
    d.step(
        "The shadow set is the same attitude.",
        MODIFIED.dcm(shadow()),
        MODIFIED.dcm(),
        because="the shadow set is the projection of $-q$",
        named=r"R\left(-s/|s|^2\right)",
        display="R(s)",
    )
    return d


def _projection(d: Derivation, which: Projection, form: ProjectionForm) -> None:
    dcm_sb, rates = which.dcm(), Matrix(form.rates)
    dcm_rate = rate(dcm_sb, pairs(which.parameters, form.rates))
    body, space = which.rate_matrix("body"), which.rate_matrix("space")
    opposite: dict[Expr, Expr] = {p: -p for p in which.parameters}
    d.notation(
        {
            "R": dcm_sb, form.letter: Matrix(which.parameters), "B_b": body.as_immutable(), "B_s": space.as_immutable(),
        },
        pairs(which.parameters, form.rates),
    )  # fmt: skip
    d.section(form.title)
    d.step(
        "The direction cosine matrix is rational.",
        quaternion_to_dcm(which.quaternion()),
        form.dcm[0],
        because="the norm of the quaternion cancels",
        named="R",
        display=form.dcm[1],
    )
    d.step("It is a rotation.", dcm_sb * dcm_sb.T, ONE,
           because="the matrix is the rotation matrix of a unit quaternion",
           named=r"R R^{\mathsf T}")  # fmt: skip
    d.step(
        "The angular velocity in the body, from the rate of the matrix.",
        dcm_rate,
        dcm_sb * skew(body * rates),
        because="the rate of the matrix by the chain rule agrees with its product with the skew matrix",
        named=r"\dot R",
        display=rf"R\,[B_b\,\dot {form.letter}]_\times",
    )
    d.step(
        "The same matrix, collected.",
        body.as_immutable(),
        form.omega[0],
        because="the entries of the matrix are polynomials of degree two at most",
        named="B_b",
        display=form.omega[1],
    )
    d.step(
        "The angular velocity in space.",
        dcm_rate,
        skew(space * rates) * dcm_sb,
        because="the rate of the matrix by the chain rule agrees with its product with the skew matrix",
        named=r"\dot R",
        display=rf"[B_s\,\dot {form.letter}]_\times R",
    )
    d.step(
        "Its matrix is that of the body for the opposite parameters.",
        space.as_immutable(),
        body.as_immutable().xreplace(opposite),
        because="the two matrices differ by the sign of their skew part",
        named=f"B_s({form.letter})",
        display=f"B_b(-{form.letter})",
    )
    d.step("The rates are polynomials in the parameters.", body.inverse * body, ONE,
           because="the two matrices are inverse to each other", named=r"B_b^{-1} B_b")  # fmt: skip
    d.step(
        "They are the angular velocity times a matrix.",
        body.inverse,
        form.inverse[0],
        because="the inverse is a sum of the unit matrix, a skew matrix and the outer product of the parameters",
        named=rf"\dot {form.letter} = B_b^{{-1}} \omega_b, \quad B_b^{{-1}}",
        display=form.inverse[1],
    )

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
            "The three Rodrigues parameters are a projection of the sphere of unit quaternions. The classical "
            "parameters project it from its centre, $g = (q_1, q_2, q_3)/q_0$; the modified parameters project it "
            "from $q = -1$, $s = (q_1, q_2, q_3)/(1 + q_0)$. The rotation matrix and the rates are rational "
            r"functions of the parameters. $[v]_\times$ is the matrix of the map $u \mapsto v \times u$."
        ),
    )
    _projection(d, CLASSICAL, _classical())
    _projection(d, MODIFIED, _modified())
    d.step(
        "The shadow set $-s/|s|^2$ describes the same attitude as $s$.",
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
        "The direction cosine matrix is a rational function of the parameters.",
        quaternion_to_dcm(which.quaternion()),
        form.dcm[0],
        because="the square root in the norm of the quaternion cancels",
        named="R",
        display=form.dcm[1],
    )
    d.step("The direction cosine matrix is a rotation.", dcm_sb * dcm_sb.T, ONE,
           because="the matrix is the rotation matrix of a unit quaternion",
           named=r"R R^{\mathsf T}")  # fmt: skip
    d.step(
        "The angular velocity in the body is linear in the rates of the parameters.",
        dcm_rate,
        dcm_sb * skew(body * rates),
        because="the matrix is differentiated by the chain rule",
        named=r"\dot R",
        display=rf"R\,[B_b\,\dot {form.letter}]_\times",
    )
    d.step(
        "The matrix $B_b$ has a short form in the skew matrix of the parameters.",
        body.as_immutable(),
        form.omega[0],
        because="the numerators of its entries are polynomials of degree two at most",
        named="B_b",
        display=form.omega[1],
    )
    d.step(
        "The angular velocity in space is also linear in the rates of the parameters.",
        dcm_rate,
        skew(space * rates) * dcm_sb,
        because="the matrix is differentiated by the chain rule",
        named=r"\dot R",
        display=rf"[B_s\,\dot {form.letter}]_\times R",
    )
    d.step(
        "The matrix $B_s$ for space is the matrix $B_b$ for the body with the signs of all parameters reversed.",
        space.as_immutable(),
        body.as_immutable().xreplace(opposite),
        because="the two matrices differ by the sign of their skew part",
        named=f"B_s({form.letter})",
        display=f"B_b(-{form.letter})",
    )
    d.step("The inverse of $B_b$ gives the rates of the parameters from the angular "
        "velocity.", body.inverse * body, ONE,
           because="the two matrices are inverse to each other", named=r"B_b^{-1} B_b")  # fmt: skip
    d.step(
        "The entries of the inverse are polynomials in the parameters.",
        body.inverse,
        form.inverse[0],
        because="the inverse is a sum of the unit matrix, a skew matrix and the outer product of the parameters",
        named=rf"\dot {form.letter} = B_b^{{-1}} \omega_b, \quad B_b^{{-1}}",
        display=form.inverse[1],
    )

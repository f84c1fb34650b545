"""Rodrigues' rotation formula, and the axis and angle of a given matrix (Goldstein, 3rd ed., section 4.7)."""

from sympy import Matrix, cos, eye, pi, sin

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.kinematics.rotation_vector import dcm_of_axis_angle
from symrot.kinematics.rotations import skew, vee
from symrot.proof.derivation import Derivation

N, V = Matrix(symbols.axis), Matrix(symbols.position)
ALPHA = symbols.alpha
UNIT = [squared(N) - 1]


def derive() -> Derivation:
    d = Derivation(
        "axis_and_angle",
        title="Rodrigues' formula, axis and angle",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., sections 4.6 and 4.7",
        about=(
            r"A rotation by the angle $\alpha$ about the unit axis $n$ leaves the component of a vector along the "
            "axis unchanged, and rotates the component perpendicular to it. Conversely, every rotation has an axis, "
            r"and axis and angle follow from its matrix. At $\alpha = \pi$, where the usual formula divides by zero, "
            "the axis follows from another formula."
        ),
    )
    _forward(d)
    _back(d)
    _half_turn(d)
    _without_loss(d)
    return d


def _forward(d: Derivation) -> None:
    d.section("From axis and angle to the matrix")
    d.notation({"n": N, "v": V, "R": Matrix(dcm_of_axis_angle())})
    along = N * N.dot(V)
    across = V - along
    d.define("The component of a vector along the axis is", r"v_\parallel", along)
    d.define("The component perpendicular to the axis is", r"v_\perp", across)
    d.step(
        "The two components are perpendicular to each other.",
        across.dot(N),
        0,
        because="$n \\cdot n = 1$",
        relations=UNIT,
        named=r"v_\perp \cdot n",
        board=(
            (r"The definition of $v_\perp$:", r"v \cdot n - (n \cdot v)\,(n \cdot n)"),
            (r"$n \cdot n = 1$:", "0"),
        ),
    )
    d.step(
        r"The product $n \times v$ is perpendicular to $v_\perp$ and has the same length. The vectors $v_\perp$ and $n "
        r"\times v$ span the plane of the rotation.",
        Matrix([squared(N.cross(V)), N.cross(V).dot(across)]),
        Matrix([squared(across), 0]),
        because=r"$|n \times v|^2 = |v|^2 - (n \cdot v)^2$",
        relations=UNIT,
        named=r"\begin{bmatrix} |n \times v|^2 \\ (n \times v) \cdot v_\perp \end{bmatrix}",
        display=r"\begin{bmatrix} |v_\perp|^2 \\ 0 \end{bmatrix}",
    )
    turned = along + cos(ALPHA) * across + sin(ALPHA) * N.cross(V)
    d.step(
        r"In the plane of the rotation, $v_\perp$ rotates by $\alpha$ (Rodrigues' formula).",
        turned,
        dcm_of_axis_angle() * V,
        because=r"a rotation by $\alpha$ maps $v_\perp$ to $\cos\alpha\;v_\perp + \sin\alpha\;n \times v$",
        relations=UNIT,
        named=r"v_\parallel + \cos\alpha\;v_\perp + \sin\alpha\;n \times v",
        display=r"\left( 1 + \sin\alpha\,[n]_\times + (1 - \cos\alpha)\,[n]_\times^2 \right) v = R\,v",
    )
    d.step(
        "The rotation matrix in terms of axis and angle.",
        dcm_of_axis_angle(),
        cos(ALPHA) * eye(3) + (1 - cos(ALPHA)) * N * N.T + sin(ALPHA) * skew(N),
        because=r"$[n]_\times^2 = n n^{\mathsf T} - 1$ for a unit vector",
        relations=UNIT,
        named="R",
        display=r"\cos\alpha\;\mathbf{1} + (1 - \cos\alpha)\,n n^{\mathsf T} + \sin\alpha\,[n]_\times",
    )
    d.step(
        "The matrix is orthogonal.",
        dcm_of_axis_angle().T * dcm_of_axis_angle(),
        eye(3),
        because="the rotation preserves the lengths of both components",
        relations=UNIT,
        named=r"R^{\mathsf T} R",
    )


def _back(d: Derivation) -> None:
    d.section("From the matrix to axis and angle")
    matrix = dcm_of_axis_angle()
    d.notation({"R": Matrix(quaternion_to_dcm())})
    d.step(
        "Every rotation has an axis (Euler): its matrix, written here with a unit quaternion, has the eigenvalue 1.",
        (Matrix(quaternion_to_dcm()) - eye(3)).det(),
        0,
        because=r"$\det (R - 1) = \det R^{\mathsf T} \det (R - 1) = \det (1 - R) = -\det (R - 1)$, in three dimensions",
        relations=[unit_relation()],
        named=r"\det (R - 1)",
    )
    d.notation({"R": Matrix(matrix)})
    d.step(
        "The trace gives the cosine of the angle.",
        (matrix.trace() - 1) / 2,
        cos(ALPHA),
        because=r"$\mathrm{tr}\,[n]_\times = 0$ and $|n| = 1$",
        relations=UNIT,
        named=r"\tfrac12 \left( \mathrm{tr}\,R - 1 \right)",
    )
    sine = vee(matrix - matrix.T) / 2
    d.step(
        "The skew part of the matrix gives the sine of the angle and the axis.",
        sine,
        sin(ALPHA) * N,
        because="only one of the three terms of the matrix is skew",
        relations=UNIT,
        named=r"s = \tfrac12\,\mathrm{vee} \left( R - R^{\mathsf T} \right)",
        display=r"\sin\alpha\;n",
    )
    d.step(
        r"Sine and cosine together give the angle $\alpha = \mathrm{atan2}\left(|s|, \tfrac12 (\mathrm{tr}\,R - "
        r"1)\right)$, accurate to rounding at every angle. The arccosine alone loses digits near $0$ and $\pi$.",
        squared(sine) + (matrix.trace() - 1) ** 2 / 4,
        1,
        because=r"$\sin^2\alpha + \cos^2\alpha = 1$",
        relations=UNIT,
        named=r"|s|^2 + \tfrac14 \left( \mathrm{tr}\,R - 1 \right)^2",
    )


def _half_turn(d: Derivation) -> None:
    d.section("The angle 180 degrees")
    half = dcm_of_axis_angle().subs(ALPHA, pi)
    d.notation({"R": Matrix(half)})
    d.passage(r"At $\alpha = \pi$ the skew part of $R$ is zero, and $n = s / \sin\alpha$ is undefined.")
    d.step(
        "At this angle the matrix $R + 1$ gives the axis.",
        (half + eye(3)) / 2,
        N * N.T,
        because=r"$\cos\pi = -1$",
        relations=UNIT,
        named=r"\tfrac12 \left( R + 1 \right)",
        display=r"n\,n^{\mathsf T}",
    )
    d.step(
        r"The sign of $n$ is arbitrary: $n$ and $-n$ give the same rotation by $\pi$.",
        dcm_of_axis_angle(-N, pi) - half,
        0,
        because=r"rotations by $\pi$ and by $-\pi$ are equal",
        relations=UNIT,
        named=r"R(-n, \pi) - R(n, \pi)",
    )


def _without_loss(d: Derivation) -> None:
    d.section("The axis without loss of digits")
    half = dcm_of_axis_angle().subs(ALPHA, pi)
    d.notation({"R": Matrix(half)})
    d.step(
        r"At the angle $\pi$ every column of $R + 1$ is a multiple of the axis. The longest column has at least "
        r"the length $2/\sqrt 3$.",
        Matrix.hstack(*((half + eye(3)).col(k).cross(N) for k in range(3))),
        0,
        because=r"column $k$ is $2\,n_k\,n$, and the sum of the three squares $n_k^2$ is 1",
        relations=UNIT,
        named=r"(R + 1)\,e_k \times n,\ k = 1, 2, 3",
    )
    matrix = dcm_of_axis_angle()
    d.notation({"R": Matrix(matrix)})
    symmetric = matrix + matrix.T + (1 - matrix.trace()) * eye(3)
    d.step(
        r"The following matrix gives the axis at every angle, without loss of digits near $\pi$.",
        symmetric,
        4 * sin(ALPHA / 2) ** 2 * N * N.T,
        because=r"$1 - \cos\alpha = 2 \sin^2 (\alpha/2)$",
        relations=UNIT,
        named=r"R + R^{\mathsf T} + (1 - \mathrm{tr}\,R)\,\mathbf{1}",
        display=r"4 \sin^2 \tfrac\alpha2\; n\,n^{\mathsf T}",
    )

"""The rotation vector (axis times angle): the exponential map to the rotation matrix, and the rates.

The Jacobians relate the rate of the rotation vector to the angular velocity in body and in space components.
"""

from sympy import Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.kinematics.rotation_vector import dcm, jacobian, length, quaternion_of_rotation_vector
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

V, DV = Matrix(symbols.rotation_vector), Matrix(symbols.rotation_vector_rates)


def derive() -> Derivation:
    d = Derivation(
        "rotation_vector",
        title="The rotation vector and its rate",
        source="Murray, Li & Sastry, *A Mathematical Introduction to Robotic Manipulation*, section 2.2",
        about=(
            "The rotation vector $v$ is the rotation axis times the rotation angle $a = |v|$. Its rotation matrix is "
            r"$R = e^{[v]_\times}$. The formulas contain $a$ both as the length of a vector and inside sines and "
            "cosines; they are proven exactly for every $a$."
        ),
    )
    v, size, dcm_sb = skew(V), length(V), dcm(V)
    body, space = jacobian("body"), jacobian("space")
    d.notation({"R": dcm_sb, "v": V, "B_b": body, "B_s": space}, pairs(symbols.rotation_vector, DV))
    d.define(
        r"The skew matrix $[v]_\times$ has the eigenvalues $0$ and $\pm i a$, where $a$ is the length "
        "of $v$:",
        "a",
        size,
    )
    d.step("The third power of a skew matrix is a multiple of the matrix itself.", v**3, -(size**2) * v,
           because="a matrix satisfies its characteristic equation (Cayley and Hamilton)",
           named=r"[v]_\times^3", display=r"-a^2\,[v]_\times")  # fmt: skip
    d.passage(
        "Therefore the exponential series is a sum of three terms (Rodrigues' formula):",
        ("R", r"1 + \frac{\sin a}{a}[v]_\times + \frac{1 - \cos a}{a^2}[v]_\times^2"),
    )
    d.step(
        "The matrix $R$ is orthogonal.",
        dcm_sb * dcm_sb.T,
        eye(3),
        because=r"$[v]_\times$ is skew",
        named=r"R R^{\mathsf T}",
    )
    d.step(
        "The rotation leaves its axis unchanged.", dcm_sb * V, V, because=r"$v \times v = 0$", named="R v", display="v"
    )
    d.step(
        "The quaternion with half the angle gives the same rotation as the rotation vector.",
        quaternion_to_dcm(quaternion_of_rotation_vector(V)),
        dcm_sb,
        because="the cosine and sine of $a$ follow from those of $a/2$",
        named=r"R\left(\cos\tfrac a2,\ \tfrac{v}{a}\sin\tfrac a2\right)",
        display=r"e^{[v]_\times}",
    )
    d.section("Angular velocity")
    dcm_rate = rate(dcm_sb, pairs(symbols.rotation_vector, DV))
    d.step(
        "The angular velocity in the body is a matrix times the rate of the rotation vector.",
        dcm_rate,
        dcm_sb * skew(body * DV),
        because=r"$\dot R = R\,[\omega_b]_\times$, all nine entries",
        named=r"\omega_b",
        display=r"\left(1 - \frac{1 - \cos a}{a^2}[v]_\times + \frac{a - \sin a}{a^3}[v]_\times^2\right) \dot v",
    )
    d.step(
        "The matrix $B_s$ for the angular velocity in space is $B_b$ with the opposite sign of $v$.",
        dcm_rate,
        skew(space * DV) * dcm_sb,
        because=r"$\dot R = [\omega_s]_\times R$, all nine entries",
        named=r"\omega_s",
        display=r"\left(1 + \frac{1 - \cos a}{a^2}[v]_\times + \frac{a - \sin a}{a^3}[v]_\times^2\right) \dot v",
    )
    d.step("The matrix $B_b$ for the body is the transpose of the matrix $B_s$ for space.", body, space.T,
           because="only the term that is odd in $v$ changes its sign",
           named="B_b", display=r"B_s^{\mathsf T}")  # fmt: skip
    d.step("The inverse of $B_b$ gives the rate of "
        "the rotation vector from the angular velocity.", body * body.inverse, eye(3), because=r"$\mathbf{1}$, "
            r"$[v]_\times$ and $[v]_\times^2$ commute",
           named=r"\left(1 - \frac{1 - \cos a}{a^2}[v]_\times + \frac{a - \sin a}{a^3}[v]_\times^2\right)"
           r"\left(1 + \tfrac12 [v]_\times + \frac{1 - \tfrac a2 \cot \tfrac a2}{a^2}[v]_\times^2\right)")  # fmt: skip
    d.step(r"The matrix $B_b$ is singular at whole revolutions, $a = 2\pi, 4\pi, \ldots$, and nowhere else.",
           body.det(method="berkowitz"), body.determinant,
           because="after a whole revolution every axis gives the same attitude", named=r"\det B_b",
           display=r"\left(\frac{\sin (a/2)}{a/2}\right)^2")  # fmt: skip
    return d

"""Composition of rotations, and why their order matters (Goldstein, 3rd ed., sections 4.8; Altmann, chapter 9)."""

from sympy import Matrix, cos, eye, pi, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.kinematics.quaternion import quaternion_product, quaternion_to_dcm, unit_relation
from symrot.kinematics.rotation_vector import dcm_of_axis_angle, quaternion_of_axis_angle
from symrot.kinematics.rotations import elementary_rotation, skew
from symrot.proof.derivation import Derivation

N, K = Matrix(symbols.axis), Matrix(symbols.normal)
ALPHA, BETA = symbols.alpha, symbols.theta
AXES = [squared(N) - 1, squared(K) - 1]
P, Q = symbols.second_quaternion, symbols.quaternion


def derive() -> Derivation:
    d = Derivation(
        "composition",
        title="One rotation after another",
        source="Altmann, *Rotations, Quaternions, and Double Groups*, chapter 9; Goldstein, Poole & Safko, "
        "*Classical Mechanics*, 3rd ed., section 4.8",
        about=(
            "Two successive rotations are one rotation. The axis of this rotation depends on the order of the two, "
            "its angle does not. For small angles, the products in both orders differ by a rotation about the cross "
            "product of the two axes."
        ),
    )
    _product(d)
    _order(d)
    _small(d)
    _frames(d)
    return d


def _product(d: Derivation) -> None:
    d.section("The product")
    d.notation(
        {
            "p": Matrix(P), "q": Matrix(Q), "n": N, "k": K,
            "R": lambda *of: quaternion_to_dcm(of[0]) if len(of) == 1 else dcm_of_axis_angle(*of),
            "R_z": lambda angle: elementary_rotation("Z", angle), "R_x": lambda angle: elementary_rotation("X", angle),
        }
    )  # fmt: skip
    units = [unit_relation(P), unit_relation(Q)]
    d.step(
        "The product of two unit quaternions has norm 1.",
        squared(Matrix(quaternion_product(P, Q))),
        1,
        because="$|p q| = |p|\\,|q|$, Euler's identity of four squares",
        relations=units,
        named="|p\\,q|^2",
    )
    d.step(
        "The matrix of a product of quaternions is the product of their matrices.",
        quaternion_to_dcm(quaternion_product(P, Q)),
        quaternion_to_dcm(P) * quaternion_to_dcm(Q),
        because=r"$p\,(q\,v\,\bar q)\,\bar p = (p q)\,v\,\overline{(p q)}$",
        relations=units,
        named="R(p\\,q)",
        display="R(p)\\,R(q)",
    )
    product = quaternion_product(quaternion_of_axis_angle(N, ALPHA), quaternion_of_axis_angle(K, BETA))
    cosine = cos(ALPHA / 2) * cos(BETA / 2) - sin(ALPHA / 2) * sin(BETA / 2) * N.dot(K)
    d.passage(
        r"Let the first rotation be by $\theta$ about $k$, the second by $\alpha$ about $n$: $R(n, \alpha)\,R(k, "
        r"\theta)$."
    )
    d.step(
        "The scalar part of the product of the two quaternions gives the angle of the whole rotation (Rodrigues).",
        product[0],
        cosine,
        because="the scalar part of a product of quaternions is the product of the scalar parts minus the "
        "scalar product of the vector parts",
        named=r"\cos \tfrac{\text{angle}}{2}",
        display=r"\cos\tfrac\alpha2 \cos\tfrac\theta2 - \sin\tfrac\alpha2 \sin\tfrac\theta2\; n \cdot k",
    )
    vector = (
        sin(ALPHA / 2) * cos(BETA / 2) * N
        + cos(ALPHA / 2) * sin(BETA / 2) * K
        + sin(ALPHA / 2) * sin(BETA / 2) * N.cross(K)
    )
    d.step(
        "The vector part of the product of the two quaternions gives the axis of the whole rotation.",
        Matrix(product[1:]),
        vector,
        because="the vector part of a product contains each vector times the scalar part of the other factor, and the "
        "cross product of the vectors",
        named=r"\text{axis}\;\sin \tfrac{\text{angle}}{2}",
        display=r"\sin\tfrac\alpha2 \cos\tfrac\theta2\; n + \cos\tfrac\alpha2 \sin\tfrac\theta2\; k"
        r" + \sin\tfrac\alpha2 \sin\tfrac\theta2\; n \times k",
    )


def _order(d: Derivation) -> None:
    d.section("The order matters")
    one = quaternion_product(quaternion_of_axis_angle(N, ALPHA), quaternion_of_axis_angle(K, BETA))
    other = quaternion_product(quaternion_of_axis_angle(K, BETA), quaternion_of_axis_angle(N, ALPHA))
    d.step(
        "In the opposite order, the two rotations give the same angle, and another axis unless the two axes are "
        "parallel.",
        one - other,
        Matrix([0, *(2 * sin(ALPHA / 2) * sin(BETA / 2) * N.cross(K))]),
        because="if the factors are exchanged, only the cross product changes its sign",
        named=r"q_n q_k - q_k q_n",
        display=r"\left( 0,\; 2 \sin\tfrac\alpha2 \sin\tfrac\theta2\; n \times k \right)",
    )
    quarter_x, quarter_z = (elementary_rotation(axis, pi / 2) for axis in "XZ")
    d.step(
        "Quarter rotations about $x$ and about $z$, in the two possible orders, give rotations about different axes.",
        Matrix.hstack(quarter_z * quarter_x, quarter_x * quarter_z),
        Matrix.hstack(*(dcm_of_axis_angle(Matrix([1, s, 1]) / sqrt(3), 2 * pi / 3) for s in (1, -1))),
        because="both products are rotations by 120 degrees, one about $(1, 1, 1)$, the other about $(1, -1, 1)$",
        named=r"\begin{bmatrix} R_z R_x & R_x R_z \end{bmatrix}_{\alpha = \pi/2}",
    )
    d.step(
        "Rotations about the same axis can be exchanged: their angles add.",
        dcm_of_axis_angle(N, ALPHA) * dcm_of_axis_angle(N, BETA),
        dcm_of_axis_angle(N, ALPHA + BETA),
        because=r"$[n]_\times$ commutes with itself",
        relations=AXES[:1],
        named=r"R(n, \alpha)\,R(n, \theta)",
        display=r"R(n, \alpha + \theta)",
    )
    half_n, half_k = dcm_of_axis_angle(N, pi), dcm_of_axis_angle(K, pi)
    d.step(
        r"Two rotations by $\pi$ about perpendicular axes also give the same attitude in either order.",
        half_n * half_k - half_k * half_n,
        0,
        because="the products of the two quaternions differ only in sign, and $q$ and $-q$ describe the same attitude",
        relations=[*AXES, N.dot(K)],
        named=r"R(n, \pi)\,R(k, \pi) - R(k, \pi)\,R(n, \pi)",
    )


def _small(d: Derivation) -> None:
    d.section("Small angles")
    one = dcm_of_axis_angle(N, ALPHA) * dcm_of_axis_angle(K, BETA)
    other = dcm_of_axis_angle(K, BETA) * dcm_of_axis_angle(N, ALPHA)
    still = {ALPHA: 0, BETA: 0}
    d.step(
        "To first order in the angles, the order of the rotations does not matter: small rotations add like vectors.",
        Matrix.hstack(*((one - other).diff(angle).subs(still) for angle in (ALPHA, BETA))),
        0,
        because=r"the two products differ only by terms with the factor $\alpha\theta$",
        named=r"\left. \frac{\partial (R_n R_k - R_k R_n)}{\partial (\alpha, \theta)} \right|_0",
    )
    d.step(
        "To second order, the products in both orders differ by a rotation about the cross product of the axes.",
        (one - other).diff(ALPHA, BETA).subs(still),
        skew(N.cross(K)),
        because=r"the commutator of two skew matrices is the skew matrix of the cross product of their vectors",
        named=r"\left. \frac{\partial^2 (R_n R_k - R_k R_n)}{\partial\alpha\,\partial\theta} \right|_0"
        r" = [n]_\times [k]_\times - [k]_\times [n]_\times",
        display=r"[n \times k]_\times",
    )


def _frames(d: Derivation) -> None:
    d.section("Rotations about axes of space and of the body")
    dcm_sb = Matrix(quaternion_to_dcm())
    carried = dcm_sb * K
    d.passage(r"Let the body have the attitude $R$, and then rotate by $\theta$ about an axis with the "
        "body components $k$ and the space components $R k$.")  # fmt: skip
    d.step(
        "A rotation about an axis of the body multiplies $R$ from the right.",
        dcm_of_axis_angle(carried, BETA) * dcm_sb,
        dcm_sb * dcm_of_axis_angle(K, BETA),
        because=r"$[R k]_\times = R\,[k]_\times R^{\mathsf T}$",
        relations=[unit_relation(), squared(K) - 1],
        named=r"R(R k, \theta)\,R",
        display=r"R\;R(k, \theta)",
    )
    d.step(
        "In other axes a rotation has the same angle, and its axis is transformed like a vector.",
        dcm_sb * dcm_of_axis_angle(K, BETA) * dcm_sb.T,
        dcm_of_axis_angle(carried, BETA),
        because=r"$R^{\mathsf T} R = 1$",
        relations=[unit_relation(), squared(K) - 1],
        named=r"R\;R(k, \theta)\,R^{\mathsf T}",
        display=r"R(R k, \theta)",
    )
    intrinsic = [elementary_rotation("Z", symbols.phi), elementary_rotation("X", symbols.theta)]
    second_axis = intrinsic[0] * Matrix([1, 0, 0])
    d.step(
        "A rotation about $z$ followed by a rotation about the rotated $x$ is the same as a rotation about the fixed "
        "$x$ followed by a rotation about the fixed $z$.",
        dcm_of_axis_angle(second_axis, symbols.theta) * intrinsic[0],
        intrinsic[0] * intrinsic[1],
        because="a rotation about an axis of the body multiplies from the right; so an intrinsic sequence is an "
        "extrinsic sequence in reverse order",
        named=r"R(R_z(\phi)\,e_x, \theta)\,R_z(\phi)",
        display=r"R_z(\phi)\,R_x(\theta)",
    )
    d.notation({"R_z": intrinsic[0], "R_x": intrinsic[1]})
    d.step(
        "The inverse of a product is the product of the inverse rotations in reverse order.",
        (intrinsic[0] * intrinsic[1]) * (intrinsic[1].T * intrinsic[0].T),
        eye(3),
        because="the inner pair of inverse rotations cancels first",
        named=r"R_z R_x \cdot R_x^{\mathsf T} R_z^{\mathsf T}",
        board=(
            (r"$R_x R_x^{\mathsf T} = 1$:", r"R_z R_z^{\mathsf T}"),
            (r"$R_z R_z^{\mathsf T} = 1$:", r"\mathbf{1}"),
        ),
    )

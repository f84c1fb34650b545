"""Rotation matrices: the matrices that preserve lengths (Goldstein, Classical Mechanics, 3rd ed., section 4.2)."""

from itertools import product

from sympy import Expr, Matrix, Symbol, cos, eye, hessian, sin, summation, zeros

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.kinematics.rotations import elementary_rotation, skew
from symrot.proof.derivation import Derivation

MATRIX = Matrix(3, 3, symbols.rotation_entries)
U, V = Matrix(symbols.position), Matrix(symbols.offset)
SIZES = (2, 3, 4, 5)


def skew_dimension(size: int) -> int:
    """Return the dimension of the space of skew matrices (``S + S^T = 0``) with ``size`` rows: 3 for size 3.

    It is ``size^2`` minus the rank of the linear map S -> S + S^T.
    """
    images = []
    for i, j in product(range(size), repeat=2):
        unit = zeros(size)
        unit[i, j] = 1
        images.append(list(unit + unit.T))
    return size**2 - int(Matrix(images).rank())


def derive() -> Derivation:
    d = Derivation(
        "rotation_matrices",
        title="Rotation matrices",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., sections 4.2 and 4.3",
        about=(
            "The distances between the points of a rigid body are constant. It follows that the matrix that maps the "
            "positions of the points from one attitude to another is orthogonal. Such a matrix in $D$ dimensions is "
            "determined by $D (D - 1) / 2$ numbers: by three numbers if $D = 3$."
        ),
    )
    d.passage("Let $R$ be any matrix, with entries $R_{ij}$, and $u$, $v$ any vectors.")
    excess = MATRIX.T * MATRIX - eye(3)
    change = squared(MATRIX * U) - squared(U)
    d.step(
        "The change of a vector's squared length is a quadratic form in the vector.",
        change,
        U.dot(excess * U),
        because="$|R u|^2$ is the product of $R u$ with itself",
        named="|R u|^2 - |u|^2",
        display=r"u^{\mathsf T} \left( R^{\mathsf T} R - 1 \right) u",
    )
    d.step(
        "If the quadratic form $|R u|^2 - |u|^2$ is zero for every vector $u$, its second derivatives are zero too: "
        r"the matrix is orthogonal, $R^{\mathsf T} R = 1$.",
        hessian(change, U) / 2,
        excess,
        because="the symmetric matrix of a quadratic form is half the matrix of its second derivatives",
        named=r"\tfrac12\, \frac{\partial^2}{\partial u\,\partial u} \left( |R u|^2 - |u|^2 \right)",
        display=r"R^{\mathsf T} R - 1",
    )
    d.notation({"R": MATRIX, "u": U, "v": V})
    d.step(
        r"If $R^{\mathsf T} R = 1$, the angles between vectors do not change either.",
        (MATRIX * U).dot(MATRIX * V) - U.dot(V),
        U.dot(excess * V),
        because=r"the same matrix $R^{\mathsf T} R$ occurs in the product of two different vectors",
        named=r"R u \cdot R v - u \cdot v",
        board=(
            (
                r"$R$ moves to the other factor as its transpose, $R u \cdot w = u \cdot R^{\mathsf T} w$:",
                r"u \cdot R^{\mathsf T} R\,v - u \cdot v",
            ),
            ("The vectors are factored out:", r"u \cdot \left( R^{\mathsf T} R - 1 \right) v"),
        ),
        display=r"u^{\mathsf T} \left( R^{\mathsf T} R - 1 \right) v",
    )
    d.step(
        r"The determinant is $1$ or $-1$.",
        (MATRIX.T * MATRIX).det(method="berkowitz"),
        MATRIX.det() ** 2,
        because=r"a matrix and its transpose have the same determinant, and $R^{\mathsf T} R = 1$ has the "
        r"determinant 1",
        named=r"\det \left( R^{\mathsf T} R \right)",
        display=r"\left( \det R \right)^2",
    )
    d.passage(
        "During a motion the determinant of $R$ is continuous, and it is 1 at the start, so it cannot jump to $-1$: "
        "the attitudes of a body have determinant 1. Matrices of this kind are the rotations."
    )
    d.step(
        r"If $R^{\mathsf T} R = 1$ and the determinant is 1, every entry equals its own cofactor: each column is the "
        "cross product of the next two columns.",
        (MATRIX.adjugate() - MATRIX.det() * MATRIX.T) * MATRIX,
        -MATRIX.det() * excess,
        because=r"$\mathrm{adj}(R)\,R = \det R$, for every matrix",
        named=r"\left( \mathrm{adj}(R) - \det R\; R^{\mathsf T} \right) R",
        display=r"\det R \left( 1 - R^{\mathsf T} R \right)",
    )
    _count(d)
    _angle(d)
    return d


def _count(d: Derivation) -> None:
    d.section("How many numbers fix a rotation")
    place = Symbol("k", integer=True, positive=True)
    conditions: Expr = summation(place, (place, 1, symbols.D))
    freedom = symbols.D * (symbols.D - 1) / 2
    d.step(
        "In $D$ dimensions, the number of entries minus the number of conditions is the number of free parameters.",
        symbols.D**2 - conditions,
        freedom,
        because=r"$R^{\mathsf T} R$ is symmetric, so that it has $1 + 2 + \cdots + D$ different entries",
        named=r"D^2 - \sum_{k=1}^{D} k",
    )
    d.step(
        f"The conditions are independent: for $D = {', '.join(map(str, SIZES))}$, the solutions near the unit matrix "
        r"have $D (D - 1) / 2$ dimensions. They are $1 + \epsilon S$ to first order, with a skew matrix $S$.",
        Matrix([skew_dimension(size) for size in SIZES]),
        Matrix([freedom.subs(symbols.D, size) for size in SIZES]),
        because=r"$(1 + \epsilon S)^{\mathsf T} (1 + \epsilon S) = 1 + \epsilon (S + S^{\mathsf T})$ to "
        "first order, and the rank of this map is counted",
        named=r"\dim \left\{ S : S + S^{\mathsf T} = 0 \right\}_D",
    )
    d.positive(
        "A rotation is determined by one number in the plane, by three numbers in space, and by six in four "
        "dimensions.",
        freedom.subs(symbols.D, 3),
        because="$D (D - 1) / 2 = 1, 3, 6$ for $D = 2, 3, 4$",
        named=r"\left. \frac{D (D - 1)}{2} \right|_{D=3}",
    )


def _angle(d: Derivation) -> None:
    d.section("One angle in the plane, three numbers in space")
    alpha = symbols.alpha
    first = Matrix([cos(alpha), sin(alpha)])
    conditions = Matrix([[first[0], first[1]], [-first[1], first[0]]])
    d.passage(
        r"In the plane, let the first column be the unit vector $(\cos\alpha, \sin\alpha)$. The second column $(x, "
        "y)$ is perpendicular to it, and the determinant is 1. These are two linear equations:",
        (conditions * U[:2, :], Matrix([0, 1])),
    )
    d.step(
        "The two equations have exactly one solution.",
        conditions.inv(method="ADJ") * Matrix([0, 1]),
        elementary_rotation(2, alpha)[:2, 1],
        because=r"the determinant of the two equations is $\cos^2\alpha + \sin^2\alpha$",
        named=r"\begin{bmatrix} x \\ y \end{bmatrix}",
    )
    for axis, name in enumerate("xyz"):
        turn = elementary_rotation(axis, alpha)
        d.define(f"The rotation about the axis ${name}$ is", f"R_{name}", turn)
        d.step(
            "This matrix is orthogonal.",
            turn.T * turn,
            eye(3),
            because="one axis is fixed, and the plane perpendicular to it rotates",
            named=rf"R_{name}^{{\mathsf T}} R_{name}",
        )
    cayley = _cayley()
    d.notation({"R": cayley, "g": Matrix(symbols.rodrigues)})
    d.step(
        r"Any three numbers $g$ give a rotation $R = (1 - [g]_\times)^{-1} (1 + [g]_\times)$ (Cayley).",
        cayley.T * cayley,
        eye(3),
        because=r"$1 + [g]_\times$ and $1 - [g]_\times$ commute, and are transposes of each other",
        named=r"R^{\mathsf T} R",
        board=(
            (
                r"The transpose of $[g]_\times$ is $-[g]_\times$:",
                r"\left( \mathbf{1} - [g]_\times \right) \left( \mathbf{1} + [g]_\times \right)^{-1} "
                r"\left( \mathbf{1} - [g]_\times \right)^{-1} \left( \mathbf{1} + [g]_\times \right)",
            ),
            (
                "All four factors commute:",
                r"\left( \mathbf{1} - [g]_\times \right) \left( \mathbf{1} - [g]_\times \right)^{-1} "
                r"\left( \mathbf{1} + [g]_\times \right)^{-1} \left( \mathbf{1} + [g]_\times \right)",
            ),
            ("Each factor meets its inverse:", r"\mathbf{1}"),
        ),
    )
    d.step(
        "The determinant of Cayley's matrix is 1.",
        cayley.det(),
        1,
        because=r"$1 + [g]_\times$ and its transpose $1 - [g]_\times$ have the same determinant",
        named=r"\det R",
    )
    d.step(
        r"Near $g = 0$ the three numbers are independent: to first order $R$ is $1 + 2\,[g]_\times$.",
        Matrix([cayley.diff(g).subs(dict.fromkeys(symbols.rodrigues, 0)) / 2 for g in symbols.rodrigues]),
        Matrix([skew(eye(3).col(axis)) for axis in range(3)]),
        because=r"$(1 - [g]_\times)^{-1} = 1 + [g]_\times$ to first order",
        named=r"\tfrac12 \left. \frac{\partial R}{\partial g_k} \right|_{g = 0},\ k = 1, 2, 3",
    )


def _cayley() -> Matrix:
    g = skew(symbols.rodrigues)
    forward, backward = eye(3) + g, eye(3) - g
    return backward.adjugate() * forward / backward.det()

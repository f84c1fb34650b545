"""The inertia tensor about another point (Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 5.3)."""

from sympy import Matrix, S

from symrot import symbols
from symrot.catalogue.tools.motion import TENSOR
from symrot.inertia.tensor import about_center_of_mass, about_point, inertia_of_point
from symrot.proof.derivation import Derivation

D, R = Matrix(symbols.offset), Matrix(symbols.position)


def derive() -> Derivation:
    d = Derivation(
        "parallel_axis",
        title="Parallel axes, for the full tensor",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 5.3",
        about=(
            "The inertia tensor about a point is the tensor about the centre of mass plus the tensor of the total "
            "mass placed at the centre of mass. The proof treats one point of the body; the body is a sum of points."
        ),
    )
    mass = symbols.m
    here, there = Matrix(inertia_of_point(mass, R)), Matrix(inertia_of_point(mass, R + D))
    d.define("A point of mass $m$ at $r = (x, y, z)$ from the centre of mass has the inertia tensor", "I(r)", here)
    crossed = there - here - Matrix(inertia_of_point(mass, D))
    linear = mass * (2 * D.dot(R) * Matrix.eye(3) - D * R.T - R * D.T)
    d.step(
        "About a reference point at $-d$, the mass has the tensor $I(r)$, plus the tensor $I(d)$, plus a term $F(r)$ "
        "that is linear in $r$.",
        crossed,
        linear,
        because=r"the inertia tensor is quadratic in $r + d$",
        named="I(r + d) - I(r) - I(d)",
        display=r"m \left( 2\,(d \cdot r)\,\mathbf{1} - d\,r^{\mathsf T} - r\,d^{\mathsf T} \right)",
    )
    second = Matrix(symbols.corners[:3])
    d.step(
        "The linear term $F$ is additive: the term of a sum of two positions is the sum of their terms.",
        linear.subs(dict(zip(R, R + second, strict=True)), simultaneous=True),
        linear + linear.subs(dict(zip(R, second, strict=True)), simultaneous=True),
        because="every entry of $F$ is linear in the position",
        named="F(r + r')",
        display="F(r) + F(r')",
    )
    d.step(
        r"Therefore the sum of $F$ over all points of the body is $F$ at the first moment $\sum m\,r$, which is zero. "
        "This proves the theorem of parallel axes.",
        linear.subs(dict.fromkeys(R, S.Zero)),
        0,
        because="the positions are measured from the centre of mass",
        named=r"F\left(\textstyle\sum m\,r\right)",
    )
    d.step(
        "A body of mass $m$ with the tensor $I$ about its centre of mass has the following tensor about a point at the "
        "offset $d$.",
        Matrix(about_point(TENSOR, mass, D)),
        TENSOR + mass * (D.dot(D) * Matrix.eye(3) - D * D.T),
        because="the inertia tensor of a body is the sum over its points",
        named="I_O",
    )
    d.step(
        "Conversely, the tensor about the centre of mass follows from the tensor about another point.",
        Matrix(about_center_of_mass(about_point(TENSOR, mass, D), mass, D)),
        TENSOR,
        because="the term of the parallel axis theorem is subtracted",
        named=r"I_O - m \left( |d|^2\,\mathbf{1} - d\,d^{\mathsf T} \right)",
    )
    d.step(
        "Among all parallel axes, the axis through the centre of mass has the smallest moment.",
        (Matrix(about_point(TENSOR, mass, D)) - TENSOR)[2, 2],
        mass * (symbols.d_x**2 + symbols.d_y**2),
        because="the added term on the diagonal is the mass times the squared distance between the axes",
        named=r"(I_O - I)_{zz}",
    )
    return d

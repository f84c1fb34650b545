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
            "The tensor about a point is the tensor about the centre of mass plus that of the whole mass put at the "
            "centre of mass. One point of the body is enough for the proof; the body is a sum of points."
        ),
    )
    mass = symbols.m
    here, there = Matrix(inertia_of_point(mass, R)), Matrix(inertia_of_point(mass, R + D))
    d.define("A point of mass $m$ at $r = (x, y, z)$ from the centre of mass of the body has the tensor", "I(r)", here)
    crossed = there - here - Matrix(inertia_of_point(mass, D))
    linear = mass * (2 * D.dot(R) * Matrix.eye(3) - D * R.T - R * D.T)
    d.step(
        "Seen from a point at $-d$, it has its own tensor, the tensor of the offset, and a part linear in $r$.",
        crossed,
        linear,
        because=r"the inertia tensor is quadratic in $r + d$",
        named="I(r + d) - I(r) - I(d)",
        display=r"m \left( 2\,(d \cdot r)\,\mathbf{1} - d\,r^{\mathsf T} - r\,d^{\mathsf T} \right)",
    )
    second = Matrix(symbols.corners[:3])
    d.step(
        r"The linear part is additive, so summed over the body it is the linear part at $\sum m\,r = 0$.",
        linear.subs(dict(zip(R, R + second, strict=True)), simultaneous=True),
        linear + linear.subs(dict(zip(R, second, strict=True)), simultaneous=True),
        because="the mixed part is linear in the positions",
        named="F(r + r')",
        display="F(r) + F(r')",
    )
    d.step(
        "There it vanishes: this is the theorem of parallel axes.",
        linear.subs(dict.fromkeys(R, S.Zero)),
        0,
        because="the positions are measured from the centre of mass",
        named=r"F\left(\textstyle\sum m\,r\right)",
    )
    d.step(
        "For a body of mass $m$ with the tensor $I$ about its centre of mass:",
        Matrix(about_point(TENSOR, mass, D)),
        TENSOR + mass * (D.dot(D) * Matrix.eye(3) - D * D.T),
        because="the inertia tensor of a body is the sum over its points",
        named="I_O",
    )
    d.step(
        "The way back.",
        Matrix(about_center_of_mass(about_point(TENSOR, mass, D), mass, D)),
        TENSOR,
        because="the term of the parallel axis theorem is subtracted",
        named=r"I_O - m \left( |d|^2\,\mathbf{1} - d\,d^{\mathsf T} \right)",
    )
    d.step(
        "No axis through the centre of mass has a parallel one with a smaller moment.",
        (Matrix(about_point(TENSOR, mass, D)) - TENSOR)[2, 2],
        mass * (symbols.d_x**2 + symbols.d_y**2),
        because="the term added on the diagonal is the mass times the squared distance of the axes",
        named=r"(I_O - I)_{zz}",
    )
    return d

"""Poinsot's construction and the polhode (Goldstein, 3rd ed., section 5.6; Landau & Lifshitz, 3rd ed., section 37)."""

from sympy import Matrix, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

A, B, C = symbols.principal
INERTIA = diag(A, B, C)
MOMENTUM = INERTIA * OMEGA
TWICE_ENERGY = OMEGA.dot(MOMENTUM)
SQUARE = squared(MOMENTUM)
FREE = pairs(symbols.omega_b, angular_acceleration(INERTIA, OMEGA, 0 * OMEGA))


def derive() -> Derivation:
    d = Derivation(
        "poinsot",
        title="Poinsot's construction and the polhode",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 5.6; Landau & Lifshitz, *Mechanics*, "
        "3rd ed., section 37",
        about=(
            "A free body moves as if its ellipsoid of energy rolled, without slipping, on a plane fixed in space. The "
            "point of contact is the end of the angular velocity: its path in the body is the polhode, on the plane "
            "the "
            "herpolhode."
        ),
    )
    d.passage("Principal axes, moments $A, B, C$. Of a free body energy and the length of angular momentum are kept:",
            ("2 T", TWICE_ENERGY), ("L^2", SQUARE))  # fmt: skip
    _rolling(d)
    _polhode(d)
    _herpolhode(d)
    return d


def _rolling(d: Derivation) -> None:
    d.section("An ellipsoid that rolls on a plane")
    d.notation(
        {"I": INERTIA, "L": MOMENTUM, r"\omega": OMEGA, "T": TWICE_ENERGY / 2, "R": Matrix(quaternion_to_dcm())},
        attitude_rates() | FREE,
    )
    d.notation({"n": Matrix(symbols.axis)})
    d.step(
        r"The normal of the ellipsoid $2 T = \text{constant}$ at the end of $\omega$ is the angular momentum.",
        Matrix([TWICE_ENERGY.diff(w) / 2 for w in OMEGA]),
        MOMENTUM,
        because=r"the gradient of a quadratic form $x \cdot I\,x$ is $2\,I\,x$",
        named=r"\frac{\partial T}{\partial \omega}",
        display=r"I\,\omega = L",
    )
    d.step(
        "So the tangent plane there is across $L$, which is fixed in space.",
        rate(Matrix(quaternion_to_dcm()) * MOMENTUM, attitude_rates() | FREE),
        0,
        because="there is no torque",
        relations=[unit_relation()],
        named=r"\frac{d}{dt} (R\,L)",
    )
    d.step(
        r"Its distance from the centre is $\omega \cdot L / |L| = 2 T / |L|$, a constant: the plane does not move.",
        Matrix([OMEGA.dot(MOMENTUM), rate(TWICE_ENERGY, FREE), rate(SQUARE, FREE)]),
        Matrix([TWICE_ENERGY, 0, 0]),
        because="energy and angular momentum are conserved",
        named=r"\begin{bmatrix} \omega \cdot L \\ d(2 T)/dt \\ d(L^2)/dt \end{bmatrix}",
        display=r"\begin{bmatrix} 2 T \\ 0 \\ 0 \end{bmatrix}",
    )
    d.step(
        "The point of the body that touches the plane is at rest at that moment: the ellipsoid rolls and does not "
        "slip.",
        OMEGA.cross(OMEGA),
        0,
        because="the point of contact is on the axis of rotation",
        named=r"\omega \times \omega",
    )
    axis = Matrix(symbols.axis)
    ray = axis / symbols.p
    d.step(
        "The ellipsoid shows the moment about every axis $n$: its radius along $n$ is $1/\\sqrt{n \\cdot I n}$, for "
        "$2 T = 1$.",
        ray.dot(INERTIA * ray),
        1,
        because=r"for $p^2 = n \cdot I\,n$ the point $n/p$ is on the ellipsoid",
        relations=[symbols.p**2 - axis.dot(INERTIA * axis)],
        named=r"\frac{n}{p} \cdot I\,\frac{n}{p}",
    )


def _polhode(d: Derivation) -> None:
    d.section("The polhode")
    w1, w2, w3 = OMEGA
    d.passage("The polhode is where the ellipsoid of energy meets the ellipsoid of angular momentum.")
    d.step(
        "It lies on a cone.",
        sum(moment * (SQUARE - TWICE_ENERGY * moment) * w**2 for moment, w in zip((A, B, C), OMEGA, strict=True)),
        0,
        because="in $L^2$ times one equation minus $2 T$ times the other the constants cancel",
        named=r"A (L^2 - 2 T A)\,\omega_1^2 + B (L^2 - 2 T B)\,\omega_2^2 + C (L^2 - 2 T C)\,\omega_3^2",
    )
    d.step(
        "Seen along axis 3, of one extreme moment, it is an ellipse.",
        SQUARE - TWICE_ENERGY * C,
        A * (A - C) * w1**2 + B * (B - C) * w2**2,
        because=r"$\omega_3$ is eliminated",
        named=r"L^2 - 2 T C",
    )
    d.step(
        "Seen along axis 1, of the other, likewise.",
        TWICE_ENERGY * A - SQUARE,
        B * (A - B) * w2**2 + C * (A - C) * w3**2,
        because=r"$\omega_1$ is eliminated",
        named=r"2 T A - L^2",
    )
    d.step(
        "Seen along the intermediate axis 2 it is a hyperbola.",
        SQUARE - TWICE_ENERGY * B,
        A * (A - B) * w1**2 - C * (B - C) * w3**2,
        because=r"$\omega_2$ is eliminated; for $A > B > C$ the two terms differ in sign",
        named=r"L^2 - 2 T B",
    )
    one, two = symbols.excess
    ordered = {B: C + one, A: C + one + two}
    d.notation(
        {"A": A.subs(ordered), "B": B.subs(ordered), "T": TWICE_ENERGY.subs(ordered) / 2, "L": MOMENTUM.subs(ordered)}
    )
    d.step(
        r"With $A > B > C$, that is $B = C + \delta_1$ and $A = B + \delta_2$, the first two are sums of squares: "
        r"$2 T C \le L^2 \le 2 T A$.",
        Matrix([SQUARE - TWICE_ENERGY * C, TWICE_ENERGY * A - SQUARE]).subs(ordered),
        Matrix(
            [
                A * (one + two) * w1**2 + B * one * w2**2,
                B * two * w2**2 + C * (one + two) * w3**2,
            ]
        ).subs(ordered),
        because="all coefficients of the expression are positive",
        named=r"\begin{bmatrix} L^2 - 2 T C \\ 2 T A - L^2 \end{bmatrix}",
        display=r"\begin{bmatrix} A (\delta_1 + \delta_2)\,\omega_1^2 + B\,\delta_1 \omega_2^2 \\ "
        r"B\,\delta_2 \omega_2^2 + C (\delta_1 + \delta_2)\,\omega_3^2 \end{bmatrix}",
    )
    d.notation({"A": A, "B": B, "T": TWICE_ENERGY / 2, "L": MOMENTUM})
    d.step(
        r"At $L^2 = 2 T B$ the hyperbola is two planes through axis 2, the separatrices.",
        (SQUARE - TWICE_ENERGY * B).subs(w3, w1 * symbols.epsilon),
        0,
        because=r"$\omega_3 = \epsilon\,\omega_1$ with $\epsilon^2 = \frac{A (A - B)}{C (B - C)}$",
        relations=[symbols.epsilon**2 * C * (B - C) - A * (A - B)],
        named=r"\left. L^2 - 2 T B \right|_{\omega_3 = \epsilon \omega_1}",
    )


def _herpolhode(d: Derivation) -> None:
    d.section("The herpolhode")
    w1, w2, w3 = OMEGA
    d.step(
        "The point of contact moves between two circles: its distance changes where no component is zero.",
        rate(squared(OMEGA), FREE) / 2,
        (A - B) * (B - C) * (A - C) / (A * B * C) * w1 * w2 * w3,
        because=r"each of Euler's equations is multiplied by its component of $\omega$",
        named=r"\tfrac12 \frac{d}{dt}\,|\omega|^2",
    )
    along = OMEGA.dot(MOMENTUM) / SQUARE * MOMENTUM
    d.step(
        "Its distance from the foot of the plane.",
        squared(OMEGA - along),
        squared(OMEGA) - TWICE_ENERGY**2 / SQUARE,
        because=r"the part of $\omega$ along $L$ has the length $2 T / |L|$",
        named=r"\left| \omega - \frac{2 T}{L^2}\,L \right|^2",
        display=r"|\omega|^2 - \frac{(2 T)^2}{L^2}",
    )
    across = OMEGA - along
    d.step(
        "In space only its part across $L$ moves.",
        Matrix([*angular_acceleration(INERTIA, OMEGA, 0 * OMEGA)]).dot(MOMENTUM),
        0,
        because=r"$\omega \cdot L$ is conserved and $L$ is fixed",
        named=r"\dot\omega \cdot L",
    )
    d.step(
        "For two equal moments the distance is constant: polhode and herpolhode are circles.",
        rate(squared(across), FREE).subs(B, A),
        0,
        because=r"the factor $A - B$ is zero",
        named=r"\left. \frac{d}{dt} \left| \omega - \frac{2 T}{L^2} L \right|^2 \right|_{A = B}",
    )

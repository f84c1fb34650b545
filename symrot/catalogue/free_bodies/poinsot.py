"""Poinsot's construction and the polhode (Goldstein, 3rd ed., section 5.6; Landau & Lifshitz, 3rd ed., section 37)."""

from sympy import Matrix, Symbol, diag

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
            "A free body moves as if its energy ellipsoid rolled without slipping on a plane that is fixed in space. "
            "The point of contact is the tip of the angular velocity vector. Its path on the ellipsoid is the "
            "polhode, its path on the plane the herpolhode."
        ),
    )
    d.passage("The components are along principal axes with the moments $A, B, C$. The energy of a free body and the "
        "length of its angular momentum are constant:",
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
        r"The normal of the energy ellipsoid $2 T = \text{constant}$ at the tip of $\omega$ is the angular momentum.",
        Matrix([TWICE_ENERGY.diff(w) / 2 for w in OMEGA]),
        MOMENTUM,
        because=r"the gradient of a quadratic form $x \cdot I\,x$ is $2\,I\,x$",
        named=r"\frac{\partial T}{\partial \omega}",
        display=r"I\,\omega = L",
    )
    d.step(
        r"So the tangent plane at the tip of $\omega$ is perpendicular to $L$, which is fixed in space.",
        rate(Matrix(quaternion_to_dcm()) * MOMENTUM, attitude_rates() | FREE),
        0,
        because="there is no torque",
        relations=[unit_relation()],
        named=r"\frac{d}{dt} (R\,L)",
        board=(
            ("The product rule:", r"\dot R\,L + R\,\dot L"),
            (
                r"$\dot R = R\,[\omega]_\times$, and Euler's equations without torque, $\dot L = L \times \omega$:",
                r"R \left( \omega \times L + L \times \omega \right)",
            ),
            ("A cross product changes its sign if its factors are exchanged:", "0"),
        ),
    )
    d.step(
        r"The distance of the tangent plane from the centre is $\omega \cdot L / |L| = 2 T / |L|$. It is constant, so "
        "the plane does not move.",
        Matrix([OMEGA.dot(MOMENTUM), rate(TWICE_ENERGY, FREE), rate(SQUARE, FREE)]),
        Matrix([TWICE_ENERGY, 0, 0]),
        because="energy and angular momentum are conserved",
        named=r"\begin{bmatrix} \omega \cdot L \\ d(2 T)/dt \\ d(L^2)/dt \end{bmatrix}",
        display=r"\begin{bmatrix} 2 T \\ 0 \\ 0 \end{bmatrix}",
    )
    d.step(
        "The point of the ellipsoid that touches the plane is momentarily at rest: the ellipsoid rolls and does not "
        "slip.",
        OMEGA.cross(OMEGA),
        0,
        because="the point of contact is on the axis of rotation",
        named=r"\omega \times \omega",
    )
    axis = Matrix(symbols.axis)
    root = Symbol("kappa", positive=True)
    ray = axis / root
    d.step(
        "The ellipsoid shows the moment of inertia about every axis $n$: for $2 T = 1$ its radius along $n$ is "
        r"$1/\sqrt{n \cdot I n}$.",
        ray.dot(INERTIA * ray),
        1,
        because=r"for $\kappa^2 = n \cdot I\,n$ the point $n/\kappa$ is on the ellipsoid",
        relations=[root**2 - axis.dot(INERTIA * axis)],
        named=r"\frac{n}{\kappa} \cdot I\,\frac{n}{\kappa}",
    )


def _polhode(d: Derivation) -> None:
    d.section("The polhode")
    w1, w2, w3 = OMEGA
    d.passage("The polhode is the intersection of the energy ellipsoid and the ellipsoid of constant angular momentum.")
    d.step(
        "The polhode lies on a cone.",
        sum(moment * (SQUARE - TWICE_ENERGY * moment) * w**2 for moment, w in zip((A, B, C), OMEGA, strict=True)),
        0,
        because="$L^2$ times the equation of the energy minus $2 T$ times the equation of the angular momentum has no "
        "constant term",
        named=r"A (L^2 - 2 T A)\,\omega_1^2 + B (L^2 - 2 T B)\,\omega_2^2 + C (L^2 - 2 T C)\,\omega_3^2",
    )
    d.step(
        "Projected along axis 3 (the smallest moment), the polhode is part of an ellipse.",
        SQUARE - TWICE_ENERGY * C,
        A * (A - C) * w1**2 + B * (B - C) * w2**2,
        because=r"$\omega_3$ is eliminated",
        named=r"L^2 - 2 T C",
    )
    d.step(
        "Projected along axis 1 (the largest moment), the polhode is part of an ellipse too.",
        TWICE_ENERGY * A - SQUARE,
        B * (A - B) * w2**2 + C * (A - C) * w3**2,
        because=r"$\omega_1$ is eliminated",
        named=r"2 T A - L^2",
    )
    d.step(
        "Projected along axis 2 (the intermediate moment), the polhode is part of a hyperbola.",
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
        r"For $A > B > C$, written as $B = C + \delta_1$ and $A = B + \delta_2$, the left sides of the equations of "
        r"both ellipses are sums of squares. So $2 T C \le L^2 \le 2 T A$.",
        Matrix([SQUARE - TWICE_ENERGY * C, TWICE_ENERGY * A - SQUARE]).subs(ordered),
        Matrix(
            [
                A * (one + two) * w1**2 + B * one * w2**2,
                B * two * w2**2 + C * (one + two) * w3**2,
            ]
        ).subs(ordered),
        because="all coefficients of the squares are positive",
        named=r"\begin{bmatrix} L^2 - 2 T C \\ 2 T A - L^2 \end{bmatrix}",
        display=r"\begin{bmatrix} A (\delta_1 + \delta_2)\,\omega_1^2 + B\,\delta_1 \omega_2^2 \\ "
        r"B\,\delta_2 \omega_2^2 + C (\delta_1 + \delta_2)\,\omega_3^2 \end{bmatrix}",
    )
    d.notation({"A": A, "B": B, "T": TWICE_ENERGY / 2, "L": MOMENTUM})
    d.step(
        "At $L^2 = 2 T B$ the hyperbola degenerates into two planes through axis 2. The polhodes in these planes are "
        "the separatrices.",
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
        r"The length of $\omega$ changes whenever all its components differ from zero. So the point of contact moves "
        "on the plane between two circles.",
        rate(squared(OMEGA), FREE) / 2,
        (A - B) * (B - C) * (A - C) / (A * B * C) * w1 * w2 * w3,
        because=r"each of Euler's equations is multiplied by its component of $\omega$",
        named=r"\tfrac12 \frac{d}{dt}\,|\omega|^2",
    )
    along = OMEGA.dot(MOMENTUM) / SQUARE * MOMENTUM
    d.step(
        "Let $F$ be the foot of the perpendicular from the centre to the plane. The square of the distance between $F$ "
        r"and the point of contact is $|\omega|^2$ minus the constant $(2 T / |L|)^2$.",
        squared(OMEGA - along),
        squared(OMEGA) - TWICE_ENERGY**2 / SQUARE,
        because=r"the component of $\omega$ along $L$ is $2 T / |L|$",
        named=r"\left| \omega - \frac{2 T}{L^2}\,L \right|^2",
        display=r"|\omega|^2 - \frac{(2 T)^2}{L^2}",
    )
    across = OMEGA - along
    d.step(
        r"Only the part of $\omega$ that is perpendicular to $L$ changes.",
        Matrix([*angular_acceleration(INERTIA, OMEGA, 0 * OMEGA)]).dot(MOMENTUM),
        0,
        because=r"$\omega \cdot L$ is conserved and $L$ is fixed",
        named=r"\dot\omega \cdot L",
    )
    d.step(
        "For two equal moments the distance of the point of contact from $F$ is constant: "
        "polhode and herpolhode are circles.",
        rate(squared(across), FREE).subs(B, A),
        0,
        because=r"the factor $A - B$ is zero",
        named=r"\left. \frac{d}{dt} \left| \omega - \frac{2 T}{L^2} L \right|^2 \right|_{A = B}",
    )

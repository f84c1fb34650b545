"""Velocity and acceleration of two points (Beer & Johnston, Vector Mechanics: Dynamics, 12th ed., chapter 15)."""

from sympy import Matrix

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate, squared
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

DOMEGA = Matrix(symbols.omega_rates)
D = Matrix(symbols.offset)
PLACE, V, A = Matrix(symbols.position), Matrix(symbols.velocity), Matrix(symbols.acceleration)
U, W = Matrix(symbols.relative_velocity), Matrix(symbols.relative_acceleration)
UNIT = [unit_relation()]


def derive() -> Derivation:
    d = Derivation(
        "relative_motion",
        title="Velocity and acceleration of two points",
        source="Beer, Johnston & Cornwell, *Vector Mechanics for Engineers: Dynamics*, chapter 15; Goldstein, Poole & "
        "Safko, *Classical Mechanics*, 3rd ed., sections 4.9 and 4.10",
        about=(
            "A body moves in any way. Its point $P$ is at $x$ and has the velocity $v$ and the acceleration $a$. "
            r"Another point $Q$ is at $x + R\,d$. What are the velocity and the acceleration of $Q$ if it is fixed in "
            "the body, and if it moves relative to the body?"
        ),
    )
    dcm_sb = Matrix(quaternion_to_dcm())
    body = attitude_rates() | pairs(symbols.omega_b, DOMEGA) | pairs(symbols.position, V) | pairs(symbols.velocity, A)
    place = PLACE + dcm_sb * D
    _fixed(d, dcm_sb, place, body)
    _moving(d, dcm_sb, place, body)
    _axis(d)
    return d


def _fixed(d: Derivation, dcm_sb: Matrix, place: Matrix, body: dict) -> None:  # type: ignore[type-arg]
    d.section("Two points of one body")
    d.notation({"R": dcm_sb, "x": PLACE, "d": D, "v": V, r"\omega_b": OMEGA, r"\dot\omega_b": DOMEGA}, body)
    velocity = rate(place, body)
    d.notation({"v_P": V, "v_Q": velocity, "a_P": A, "a_Q": rate(velocity, body)})
    d.step(
        "The velocity of $Q$ is the velocity of $P$ plus the cross product of the angular velocity and the offset.",
        velocity,
        V + dcm_sb * OMEGA.cross(D),
        because=r"$d$ is constant, and $\dot R = R\,[\omega_b]_\times$",
        relations=UNIT,
        named=r"\frac{d}{dt} (x + R\,d)",
        board=(
            ("The vector $d$ is constant:", r"v + \dot R\,d"),
            (r"$\dot R = R\,[\omega_b]_\times$:", r"v + R \left( \omega_b \times d \right)"),
        ),
        display=r"v + R \left( \omega_b \times d \right)",
    )
    d.step(
        "Both points have the same velocity component along the line between them: their distance is constant.",
        (velocity - V).dot(dcm_sb * D),
        0,
        because=r"$\omega \times d$ is perpendicular to $d$",
        relations=UNIT,
        named=r"(v_Q - v_P) \cdot R\,d",
        board=(
            ("The velocity of the previous step is inserted:", r"R \left( \omega_b \times d \right) \cdot R\,d"),
            ("A rotation preserves scalar products:", r"(\omega_b \times d) \cdot d"),
            ("A cross product is perpendicular to its factors:", "0"),
        ),
    )
    d.step(
        "The acceleration of $Q$ relative to $P$, in body components, has a term from the angular acceleration and a "
        "centripetal term.",
        dcm_sb.T * (rate(velocity, body) - A),
        DOMEGA.cross(D) + OMEGA.cross(OMEGA.cross(D)),
        because="the velocity is differentiated by the product rule, where the rate of each vector that rotates with "
        r"the body contains its cross product with $\omega$",
        relations=UNIT,
        named=r"R^{\mathsf T} (a_Q - a_P)",
        display=r"\dot\omega_b \times d + \omega_b \times (\omega_b \times d)",
        board=(
            (
                r"The rate of $R \left( \omega_b \times d \right)$, by the product rule:",
                r"R^{\mathsf T} \left( R \left( \dot\omega_b \times d \right) + \dot R \left( \omega_b \times d "
                r"\right) \right)",
            ),
            (
                r"$\dot R = R\,[\omega_b]_\times$ and $R^{\mathsf T} R = 1$:",
                r"\dot\omega_b \times d + \omega_b \times (\omega_b \times d)",
            ),
        ),
    )
    d.step(
        r"The centripetal term of the acceleration points toward the axis through $P$ along $\omega$; its size is "
        r"$|\omega|^2$ times the distance from this axis.",
        OMEGA.cross(OMEGA.cross(D)),
        OMEGA * OMEGA.dot(D) - squared(OMEGA) * D,
        because=r"$a \times (b \times c) = b\,(a \cdot c) - c\,(a \cdot b)$",
        named=r"\omega_b \times (\omega_b \times d)",
        display=r"\omega_b\,(\omega_b \cdot d) - |\omega_b|^2\,d",
    )
    offset = Matrix(symbols.corners[:3])
    d.notation({r"\omega": OMEGA, "v_P": V, "v_Q": V + OMEGA.cross(D), "r": offset})
    d.step(
        "The angular velocity does not depend on the choice of the point $P$ of the body.",
        V + OMEGA.cross(D) + OMEGA.cross(offset - D),
        V + OMEGA.cross(offset),
        because="the cross product is linear in each factor",
        named=r"v_Q + \omega \times (r - d)",
        board=(
            ("The velocity of $Q$ is inserted:", r"v_P + \omega \times d + \omega \times (r - d)"),
            ("The cross product is linear:", r"v_P + \omega \times r"),
        ),
        display=r"v_P + \omega \times r",
    )


def _moving(d: Derivation, dcm_sb: Matrix, place: Matrix, body: dict) -> None:  # type: ignore[type-arg]
    d.section("A point that moves through the body")
    moving = body | pairs(symbols.offset, U) | pairs(symbols.relative_velocity, W)
    velocity = rate(place, moving)
    d.notation({"u": U, "w": W, "v_P": V, "v_Q": velocity, "a_P": A, "a_Q": rate(velocity, moving)}, moving)
    d.passage(
        "Let $Q$ have the velocity $u$ and the acceleration $w$ relative to the body:",
        (r"\dot d", "u"),
        (r"\dot u", "w"),
    )
    d.step(
        "The velocity of $Q$ has the additional term $u$.",
        dcm_sb.T * (velocity - V),
        OMEGA.cross(D) + U,
        because="the velocity of the point is the sum of the velocity of its place in the body and its "
        "velocity relative to the body",
        relations=UNIT,
        named=r"R^{\mathsf T} (v_Q - v_P)",
        board=(
            ("The product rule:", r"R^{\mathsf T} \left( \dot R\,d + R\,u \right)"),
            (r"$\dot R = R\,[\omega_b]_\times$ and $R^{\mathsf T} R = 1$:", r"\omega_b \times d + u"),
        ),
        display=r"\omega_b \times d + u",
    )
    d.step(
        "The acceleration of $Q$ is the sum of three terms: the acceleration of the point of the body where $Q$ is, "
        r"the Coriolis acceleration $2\,\omega \times u$, and the relative acceleration $w$.",
        dcm_sb.T * (rate(velocity, moving) - A),
        DOMEGA.cross(D) + OMEGA.cross(OMEGA.cross(D)) + 2 * OMEGA.cross(U) + W,
        because=r"the rate of $u$ and the rate of the offset $d$ each contribute $\omega \times u$",
        relations=UNIT,
        named=r"R^{\mathsf T} (a_Q - a_P)",
        display=r"\dot\omega_b \times d + \omega_b \times (\omega_b \times d) + 2\,\omega_b \times u + w",
        board=(
            (
                r"The rate of $R \left( \omega_b \times d + u \right)$ in body components is the rate of the vector in "
                r"brackets, plus the cross product of $\omega_b$ and this vector, because "
                r"$\dot R = R\,[\omega_b]_\times$:",
                r"\left( \dot\omega_b \times d + \omega_b \times u + w \right) + \omega_b \times \left( \omega_b "
                r"\times d + u \right)",
            ),
            (
                r"Both terms contain $\omega_b \times u$:",
                r"\dot\omega_b \times d + \omega_b \times (\omega_b \times d) + 2\,\omega_b \times u + w",
            ),
        ),
    )
    d.step(
        "The Coriolis acceleration does no work on the relative motion.",
        (2 * OMEGA.cross(U)).dot(U),
        0,
        because="the Coriolis acceleration is perpendicular to the relative velocity",
        named=r"(2\,\omega_b \times u) \cdot u",
    )


def _axis(d: Derivation) -> None:
    d.section("The axis of the motion")
    center = OMEGA.cross(V) / squared(OMEGA)
    d.notation({r"\omega": OMEGA, "v": V, "d_0": center, "d": D})
    d.passage("From here on all vectors have components in one and the same frame. Consider the point of the body with "
              "the following offset $d_0$ from $P$:",
            ("d_0", r"\frac{\omega \times v}{|\omega|^2}"))  # fmt: skip
    d.step(
        r"The velocity of the point at $d_0$ is along $\omega$, so every motion of a body is, at each instant, a screw "
        "motion (Chasles, Mozzi).",
        V + OMEGA.cross(center),
        OMEGA * OMEGA.dot(V) / squared(OMEGA),
        because=r"$\omega \times (\omega \times v)$ is $-|\omega|^2$ times the component of $v$ perpendicular to "
        r"$\omega$",
        named=r"v + \omega \times d_0",
        board=(
            ("The definition of $d_0$:", r"v + \frac{1}{|\omega|^2}\,\omega \times (\omega \times v)"),
            (
                r"$a \times (b \times c) = b\,(a \cdot c) - c\,(a \cdot b)$:",
                r"v + \frac{1}{|\omega|^2} \left( \omega\,(\omega \cdot v) - |\omega|^2\,v \right)",
            ),
            ("The terms with $v$ alone cancel:", r"\frac{\omega \cdot v}{|\omega|^2}\,\omega"),
        ),
        display=r"\frac{\omega \cdot v}{|\omega|^2}\,\omega",
    )
    plane = {symbols.omega_1: 0, symbols.omega_2: 0, symbols.v_z: 0}
    d.notation({r"\omega": OMEGA.subs(plane), "v": V.subs(plane), "d_0": center.subs(plane)})
    d.step(
        "In plane motion the point at $d_0$ is at rest: it is the instantaneous centre of rotation.",
        (V + OMEGA.cross(center)).subs(plane),
        0,
        because="the velocity is perpendicular to the angular velocity",
        named=r"\left. v + \omega \times d_0 \right|_{\omega \cdot v = 0}",
    )
    d.step(
        "The velocities of all points are the same as in a rotation about a fixed axis through the instantaneous "
        "centre.",
        (V + OMEGA.cross(D)).subs(plane),
        OMEGA.cross(D - center).subs(plane),
        because="the velocity of the instantaneous centre is zero",
        named=r"v + \omega \times d",
        display=r"\omega \times (d - d_0)",
    )

"""Lessons of the chapter on free bodies."""

from sympy import Rational, sqrt

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

# the prism of tumbling_prism_largest has its moments in ascending order; the page wants them in descending order
DESCENDING = {
    s.A: s.C,
    s.C: s.A,
    s.a_1: sqrt((s.H**2 - 2 * s.E * s.A) / (s.C * (s.C - s.A))),
    s.a_3: sqrt((2 * s.E * s.C - s.H**2) / (s.A * (s.C - s.A))),
}

LESSONS = {
    "free_body_invariants": Lesson(
        question="No torque acts on a body. Which quantities stay as they are?",
        before=("euler_equations", "kinetic_energy"),
        mistake=Mistake(
            "The length of the angular momentum is constant, so students take the length of the angular velocity to be "
            "constant too.",
            "omega_1*domega_1 + omega_2*domega_2 + omega_3*domega_3 == 0",
            facts=(
                "domega_1 == (B - C)*omega_2*omega_3/A",
                "domega_2 == (C - A)*omega_3*omega_1/B",
                "domega_3 == (A - B)*omega_1*omega_2/C",
                "A > 0",
                "B > 0",
                "C > 0",
            ),
            lesson="It is constant only if two moments are equal, or the body rotates about a principal axis.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The energy of the handle stays at",
                "E",
                "Along principal axes, in angular velocity",
                "J",
                page="kinetic_energy",
            ),
            Number(
                "and the constant of its polhode seen along axis 3 at",
                "|L|^2 - 2 C E",
                "Along principal axes, a combination",
                "kg^2 m^4/s^2",
            ),
        ),
        kernel="angular_momentum_space",
        topic="free_bodies",
    ),
    "spherical_body": Lesson(
        question="A ball and a cube rotate alike. What is special about three equal moments?",
        before=("euler_equations", "tensor_rotation"),
        mistake=Mistake(
            "For a ball, angular momentum is along the angular velocity. Students expect this of a disk as well.",
            "cross(Matrix([a, b, c]), Matrix([A*a, A*b, C*c])) == Matrix([0, 0, 0])",
            lesson="For a disk the two vectors are parallel only along the axis or across it.",
        ),
        worked="driven_acceleration",
        kernel="euler_equations_spherical",
        topic="euler_equations",
    ),
    "symmetric_spin": Lesson(
        question="Why does a spinning top keep its spin while it wobbles?",
        before=("euler_equations",),
        mistake=Mistake(
            "The spin $\\omega_3$ and the rate $\\dot\\psi$ of the spin angle have similar names. Students set them "
            "equal.",
            "omega_3 == dpsi",
            facts=("omega_3 == dpsi + dphi*cos(theta)",),
            lesson="The precession has a part along the axis too.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "A torque along the axis changes the spin of the satellite at the rate",
                "\\dot\\omega_3",
                "Only the torque about the axis changes the spin.",
                "rad/s^2",
            ),
        ),
        kernel="euler_equations_symmetric",
        topic="free_bodies",
    ),
    "symmetric_top": Lesson(
        question="A plate thrown into the air wobbles. How fast, compared with its spin?",
        before=("symmetric_spin", "euler_body_rates"),
        mistake=Mistake(
            "Feynman told of a plate in the cafeteria of Cornell. A plate has $C = 2 A$, and for a small wobble the "
            "precession is at the rate $C \\omega_3 / A$. His story had the ratio upside down.",
            "dphi == omega_3/2",
            facts=("dphi == C*omega_3/A", "C == 2*A", "A > 0"),
            lesson="The plate wobbles twice as fast as it spins.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "The axis of the satellite goes round the angular momentum at the rate",
                "\\dot\\phi",
                "Precession and spin are constant",
                "rad/s",
                entry=0,
            ),
            Number(
                "The ratio of its spin angle's rate to the part of the precession along the axis is positive, so that "
                "the precession is direct:",
                "\\frac{\\dot\\psi}{\\dot\\phi \\cos\\theta}",
                "Their ratio does not depend on the motion.",
                "1",
            ),
        ),
        kernel="euler_equations_symmetric",
        topic="free_bodies",
    ),
    "intermediate_axis": Lesson(
        question="A spinning wing nut or tennis racket flips over by itself. About which axis, and how fast?",
        before=("euler_equations", "free_body_invariants"),
        mistake=Mistake(
            "The two moments below the line are those of the other two axes. Students put the moment of the spin axis "
            "there, which they have just used.",
            "rate**2 == Omega**2*(A - B)*(B - C)/B**2",
            facts=("rate**2 == Omega**2*(A - B)*(B - C)/(A*C)", "A > 0", "B > 0", "C > 0"),
            lesson="The disturbance is across the axis, so it meets the moments across the axis.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The handle spins about its intermediate axis, its third: its moments in descending order are $B$, "
                "$C$, "
                "$A$. A disturbance grows at the rate",
                "\\lambda",
                "About the intermediate axis it grows.",
                "1/s",
                power=Rational(1, 2),
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
            Number(
                "so that it becomes e times as large in",
                "1/\\lambda",
                "About the intermediate axis it grows.",
                "s",
                power=Rational(-1, 2),
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
        ),
        kernel="euler_equations_principal",
        topic="stability",
    ),
    "poinsot": Lesson(
        question="Can the motion of a free body be seen without solving an equation?",
        before=("free_body_invariants",),
        mistake=Mistake(
            "The distance of the plane is $\\omega \\cdot L / |L|$. Students put the energy for $\\omega \\cdot L$, "
            "which is "
            "twice the energy.",
            "d == T/H",
            facts=("d*H == 2*T", "H > 0", "T > 0"),
            lesson="Kinetic energy has a half, $T = \\frac12\\,\\omega \\cdot L$; the distance has none.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The distance of the plane from the centre:",
                "\\frac{2 T}{|L|}",
                "Its distance from the centre",
                "rad/s",
                entry=0,
                scale=1 / s.H,
            ),
        ),
        kernel="angular_momentum_space",
        topic="free_bodies",
    ),
    "free_asymmetric_body": Lesson(
        question="A body with three different moments tumbles freely. Is there a formula for its motion?",
        before=("poinsot", "intermediate_axis"),
        mistake=Mistake(
            "The function dn looks like a cosine. Students forget its parameter.",
            "dn**2 == 1 - sn**2",
            facts=("dn**2 == 1 - mu*sn**2",),
            lesson="That is the function cn. The two are equal only on the separatrix, at $\\mu = 1$.",
        ),
        scene="tumbling_prism_largest",
        numbers=(
            Number(
                "The moments of the prism in descending order are $C$, $B$, $A$. Its frequency is",
                "p",
                "The frequency.",
                "rad/s",
                power=Rational(1, 2),
                where=DESCENDING,
            ),
            Number(
                "and its parameter is so small that the motion is nearly a sine:",
                "\\mu",
                "The parameter.",
                "1",
                where=DESCENDING,
            ),
        ),
        kernel="rigid_body_principal",
        topic="free_bodies",
    ),
}

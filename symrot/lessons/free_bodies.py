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
        question="No torque acts on a body. Which quantities are constant?",
        before=("euler_equations", "kinetic_energy"),
        mistake=Mistake(
            "The length of the angular momentum is constant, so students think that the length of the angular "
            "velocity is constant too.",
            "omega_1*domega_1 + omega_2*domega_2 + omega_3*domega_3 == 0",
            facts=(
                "domega_1 == (B - C)*omega_2*omega_3/A",
                "domega_2 == (C - A)*omega_3*omega_1/B",
                "domega_3 == (A - B)*omega_1*omega_2/C",
                "A > 0",
                "B > 0",
                "C > 0",
            ),
            lesson="The length of the angular velocity is constant only if two moments are equal, or if the body "
            "rotates about a principal axis.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The kinetic energy of the handle is constant:",
                "E",
                "Along principal axes, the energy is",
                "J",
                page="kinetic_energy",
            ),
            Number(
                "The following constant describes the projection of its polhode along axis 3:",
                "|L|^2 - 2 C E",
                "Along principal axes, a combination",
                "kg^2 m^4/s^2",
            ),
        ),
        kernel="angular_momentum_space",
        topic="free_bodies",
    ),
    "spherical_body": Lesson(
        question="A ball and a cube can rotate in the same way. What follows from three equal moments?",
        before=("euler_equations", "tensor_rotation"),
        mistake=Mistake(
            "For a ball, the angular momentum is parallel to the angular velocity. Students expect this of a disk too.",
            "cross(Matrix([a, b, c]), Matrix([A*a, A*b, C*c])) == Matrix([0, 0, 0])",
            repair=1,
            lesson="For a disk the two vectors are parallel only if the angular velocity is along the symmetry axis "
            "or perpendicular to it.",
        ),
        worked="driven_acceleration",
        kernel="euler_equations_spherical",
        topic="euler_equations",
    ),
    "symmetric_spin": Lesson(
        question="Why is the spin of a top constant while the top wobbles?",
        before=("euler_equations",),
        mistake=Mistake(
            r"The spin $\omega_3$ is not the rate $\dot\psi$ of the spin angle. Students set the two equal because of "
            "their similar names.",
            "omega_3 == dpsi",
            facts=("omega_3 == dpsi + dphi*cos(theta)",),
            lesson="The precession also has a component along the symmetry axis.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "A torque along its symmetry axis changes the spin of the satellite at the rate",
                "\\dot\\omega_3",
                "Only the torque about the axis changes the spin.",
                "rad/s^2",
            ),
        ),
        kernel="euler_equations_symmetric",
        topic="free_bodies",
    ),
    "symmetric_top": Lesson(
        question="A plate that is thrown into the air wobbles. How fast is the wobble compared with the spin?",
        before=("symmetric_spin", "euler_body_rates"),
        mistake=Mistake(
            "Feynman told a story about a plate in the cafeteria of Cornell. A plate has $C = 2 A$, and for a small "
            r"wobble the precession has the rate $C \omega_3 / A$. His story had the inverse ratio, and students "
            "repeat it.",
            "dphi == omega_3/2",
            facts=("dphi == C*omega_3/A", "C == 2*A", "A > 0"),
            lesson="The plate wobbles twice as fast as it spins.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "The symmetry axis of the satellite moves around the angular momentum at the rate",
                "\\dot\\phi",
                "The rates of precession and spin angle",
                "rad/s",
                entry=0,
            ),
            Number(
                "The ratio of the spin angle's rate to the component of the precession along the axis is positive, so "
                "the precession is direct:",
                "\\frac{\\dot\\psi}{\\dot\\phi \\cos\\theta}",
                "The ratio of these two rates does not depend on the motion.",
                "1",
            ),
        ),
        kernel="euler_equations_symmetric",
        topic="free_bodies",
    ),
    "intermediate_axis": Lesson(
        question="A spinning wing nut or tennis racket flips over by itself. About which axis must it spin, and how "
        "fast does it flip?",
        before=("euler_equations", "free_body_invariants"),
        mistake=Mistake(
            "The denominator contains the moments about the other two axes. Students put the moment about the spin "
            "axis there, which they have just used.",
            "rate**2 == Omega**2*(A - B)*(B - C)/B**2",
            facts=("rate**2 == Omega**2*(A - B)*(B - C)/(A*C)", "A > 0", "B > 0", "C > 0"),
            lesson="The disturbance is perpendicular to the spin axis, so the moments about the two other axes matter.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The handle spins about its intermediate axis, axis 3: its moments in descending order are $B$, $C$, "
                "$A$. A disturbance grows at the rate",
                "\\lambda",
                "About the intermediate axis, a disturbance grows",
                "1/s",
                power=Rational(1, 2),
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
            Number(
                "A disturbance becomes e times as large in",
                "1/\\lambda",
                "About the intermediate axis, a disturbance grows",
                "s",
                power=Rational(-1, 2),
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
        ),
        kernel="euler_equations_principal",
        topic="stability",
    ),
    "poinsot": Lesson(
        question="Can the motion of a free body be described by geometry, without solving an equation?",
        before=("free_body_invariants",),
        mistake=Mistake(
            r"The distance of the invariable plane from the centre is $\omega \cdot L / |L|$. Students put the energy "
            r"for $\omega \cdot L$, which is twice the energy.",
            "d == T/H",
            facts=("d*H == 2*T", "H > 0", "T > 0"),
            lesson=r"The kinetic energy has a factor one half, $T = \frac12\,\omega \cdot L$; the distance does not.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The distance of the invariable plane from the centre is",
                "\\frac{2 T}{|L|}",
                "The distance of the tangent plane from the centre",
                "rad/s",
                entry=0,
                scale=1 / s.H,
            ),
        ),
        kernel="angular_momentum_space",
        topic="free_bodies",
    ),
    "free_asymmetric_body": Lesson(
        question="A body with three different moments rotates freely. Is there a formula for its motion?",
        before=("poinsot", "intermediate_axis"),
        mistake=Mistake(
            r"The function dn looks like a cosine. Students forget its parameter $\mu$ in the quadratic relation.",
            "dn**2 == 1 - sn**2",
            facts=("dn**2 == 1 - mu*sn**2",),
            lesson="The student's relation is the relation of cn. The functions dn and cn are equal only on the "
            r"separatrix, at $\mu = 1$.",
        ),
        scene="tumbling_prism_largest",
        numbers=(
            Number(
                "The moments of the prism in descending order are $C$, $B$, $A$. The frequency of its motion is",
                "p",
                "They give the frequency.",
                "rad/s",
                power=Rational(1, 2),
                where=DESCENDING,
            ),
            Number(
                "The parameter is so small that the motion is nearly sinusoidal:",
                "\\mu",
                "They give the parameter.",
                "1",
                where=DESCENDING,
            ),
        ),
        kernel="rigid_body_principal",
        topic="free_bodies",
    ),
}

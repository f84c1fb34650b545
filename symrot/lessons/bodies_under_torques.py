"""Lessons of the chapter on bodies under torques."""

from sympy import Integer

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

RADIUS = dict(zip(s.radius, s.rotation_entries[0:3], strict=True))  # the first axis of space, seen from the body
NORMAL = dict(zip(s.normal, s.rotation_entries[6:9], strict=True))  # the third axis of space, seen from the body

LESSONS = {
    "heavy_top_invariants": Lesson(
        question="Gravity acts on a spinning top. Which quantities are constant nevertheless?",
        before=("free_body_invariants", "work_and_power"),
        mistake=Mistake(
            "The point of support is fixed, so students think that the weight has no moment about it.",
            "cross(Matrix([a, b, c]), Matrix([0, 0, -W])) == Matrix([0, 0, 0])",
            facts=("W > 0",),
            lesson="Only the vertical component of the moment is zero, so only the vertical component of the angular "
            "momentum is constant.",
        ),
        worked="momentum_about_vertical",
        kernel="heavy_top",
        topic="heavy_tops",
    ),
    "heavy_top": Lesson(
        question="Why does a spinning top not fall?",
        before=("heavy_top_invariants", "kinetic_energy", "lagrange_and_euler"),
        mistake=Mistake(
            r"The formula $n = W c / p_\psi$ is exact for a horizontal axis, and nearly right for a fast top. "
            "Students use it for every top.",
            "n == W*c/p",
            facts=("A*n**2*cos(theta) - p*n + W*c == 0", "A > 0", "p > 0", "W > 0", "c > 0"),
            lesson="The condition is quadratic: an inclined top has two rates of steady precession.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "By the formula for a horizontal axis, the slow precession of the top is about",
                "n",
                "With a horizontal axis there is only one rate.",
                "rad/s",
                entry=0,
            ),
            Number(
                "The top could sleep upright, because its spin is above the bound:",
                "p_\\psi^2 - 4 A W c_3",
                r"At the bound $p_\psi^2 = 4 A W c_3$",
                "kg^2 m^4/s^2",
            ),
        ),
        kernel="heavy_top_symmetric",
        topic="heavy_tops",
    ),
    "gyroscopic_wheel": Lesson(
        question="A spinning wheel hangs on one end of its axle and does not drop. What holds it up?",
        before=("angular_momentum", "euler_body_rates"),
        mistake=Mistake(
            "The torque rotates the angular momentum of the spin. Students use the moment of inertia about a "
            "transverse axis instead.",
            "dphi == W*c/(A*dpsi)",
            facts=("C*dphi*dpsi == W*c", "A > 0", "C > 0", "W > 0", "c > 0", "dpsi > 0"),
            lesson="With a horizontal axle, the moment $A$ about a transverse axis does not occur.",
        ),
        scene="precessing_wheel",
        numbers=(
            Number(
                "The moment of the weight about the support is",
                "W c_3",
                "The weight $W$ of the wheel",
                "N m",
                entry=0,
                where={s.phi: Integer(0)},
            ),
            Number(
                "The wheel starts with exactly the precession that this moment maintains, so the difference is zero:",
                "W c_3 - C\\,\\dot\\phi\\,\\dot\\psi",
                "If the axle is pushed around faster than it precesses",
                "N m",
                where={s.dphi: s.omega_z, s.dpsi: s.omega_x},
            ),
        ),
        kernel="torque_gravity",
        topic="gyroscopes",
    ),
    "gyrostat_invariants": Lesson(
        question="A satellite contains a spinning wheel. How does the wheel change the motion of the satellite?",
        before=("euler_equations", "free_body_invariants"),
        mistake=Mistake(
            "The wheel is inside the body, so students omit its angular momentum in the gyroscopic term.",
            "cross(Matrix([a, b, c]), Matrix([A*a, A*b, A*c + h])) == cross(Matrix([a, b, c]), Matrix([A*a, A*b, "
            "A*c]))",
            facts=("A > 0", "h > 0"),
            repair=None,
            lesson="The rotation of the body also rotates the angular momentum of the wheel, and this needs a torque.",
        ),
        worked="reaction_wheel",
        kernel="torque_rotor",
        topic="gyroscopes",
    ),
    "gravity_gradient": Lesson(
        question="Why does a long satellite keep pointing to the Earth without a motor?",
        before=("euler_equations", "angular_momentum"),
        mistake=Mistake(
            r"The torque is proportional to $\sin\theta\cos\theta$. Students use the factor $\sin\theta$ of a "
            "pendulum.",
            "3*n**2*sin(theta)*cos(theta) == 3*n**2*sin(theta)",
            facts=("n > 0",),
            repair=None,
            lesson="The tidal forces pull at both ends, so the torque is zero also at a right angle, unlike the "
            "torque on a pendulum.",
        ),
        scene="gravity_gradient_satellite",
        numbers=(
            Number(
                "At the start the satellite is inclined by 20 degrees. The torque that brings it back, about the "
                "normal of the orbit, is",
                "k \\cdot \\tau",
                "The angular momentum about the normal of the orbit",
                "N m",
                where=RADIUS | NORMAL,
            ),
        ),
        kernel="torque_gravity_gradient",
        topic="pendulums",
    ),
}

"""Lessons of the chapter on bodies under torques."""

from sympy import Integer

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

RADIUS = dict(zip(s.radius, s.rotation_entries[0:3], strict=True))  # the first axis of space, seen from the body
NORMAL = dict(zip(s.normal, s.rotation_entries[6:9], strict=True))  # the third axis of space, seen from the body

LESSONS = {
    "heavy_top_invariants": Lesson(
        question="Gravity acts on a spinning top. What stays constant all the same?",
        before=("free_body_invariants", "work_and_power"),
        mistake=Mistake(
            "The point of support is fixed, so students take the weight to have no moment about it.",
            "cross(Matrix([a, b, c]), Matrix([0, 0, -W])) == Matrix([0, 0, 0])",
            facts=("W > 0",),
            lesson="Only the moment about the vertical is zero, so only that component of angular momentum is "
            "constant.",
        ),
        worked="momentum_about_vertical",
        kernel="heavy_top",
        topic="heavy_tops",
    ),
    "heavy_top": Lesson(
        question="Why does a spinning top not fall?",
        before=("heavy_top_invariants", "kinetic_energy", "lagrange_and_euler"),
        mistake=Mistake(
            "The formula $n = W c / p_\\psi$ is exact for a level axis, and nearly right for a fast top. Students use "
            "it "
            "for every top.",
            "n == W*c/p",
            facts=("A*n**2*cos(theta) - p*n + W*c == 0", "A > 0", "p > 0", "W > 0", "c > 0"),
            lesson="The condition is quadratic: an inclined top has two rates of steady precession.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The slow precession of the top, by the formula for a level axis, is about",
                "n",
                "With a level axis there is one rate.",
                "rad/s",
                entry=0,
            ),
            Number(
                "The top could sleep upright, for its spin is above the bound:",
                "p_\\psi^2 - 4 A W c_3",
                "The same bound makes the two rates",
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
            "The angular momentum that the torque turns is that of the spin. Students use the moment across the axle.",
            "dphi == W*c/(A*dpsi)",
            facts=("C*dphi*dpsi == W*c", "A > 0", "C > 0", "W > 0", "c > 0", "dpsi > 0"),
            lesson="With a level axle the moment $A$ across it does not enter at all.",
        ),
        scene="precessing_wheel",
        numbers=(
            Number(
                "The moment of the weight about the support:",
                "W c_3",
                "The weight $W$ of the wheel",
                "N m",
                entry=0,
                where={s.phi: Integer(0)},
            ),
            Number(
                "The wheel is started with just the precession that this moment keeps going, and nothing is left over:",
                "W c_3 - C\\,\\dot\\phi\\,\\dot\\psi",
                "Pushed round faster than that",
                "N m",
                where={s.dphi: s.omega_z, s.dpsi: s.omega_x},
            ),
        ),
        kernel="torque_gravity",
        topic="gyroscopes",
    ),
    "gyrostat_invariants": Lesson(
        question="A satellite carries a spinning wheel. What does the wheel do to its motion?",
        before=("euler_equations", "free_body_invariants"),
        mistake=Mistake(
            "The wheel is inside, so students leave its angular momentum out of the gyroscopic term.",
            "cross(Matrix([a, b, c]), Matrix([A*a, A*b, A*c + h])) == cross(Matrix([a, b, c]), Matrix([A*a, A*b, "
            "A*c]))",
            facts=("A > 0", "h > 0"),
            repair=None,
            lesson="The body turns the angular momentum of the wheel as well, and that takes a torque.",
        ),
        worked="reaction_wheel",
        kernel="torque_rotor",
        topic="gyroscopes",
    ),
    "gravity_gradient": Lesson(
        question="Why does a long satellite point to the Earth without any motor?",
        before=("euler_equations", "angular_momentum"),
        mistake=Mistake(
            "The torque goes with $\\sin\\theta\\cos\\theta$. Students take a pendulum's $\\sin\\theta$.",
            "3*n**2*sin(theta)*cos(theta) == 3*n**2*sin(theta)",
            facts=("n > 0",),
            repair=None,
            lesson="The tide pulls both ends: at a right angle the torque is zero again, unlike that of a pendulum.",
        ),
        scene="gravity_gradient_satellite",
        numbers=(
            Number(
                "At the start the satellite is inclined by 20 degrees. The torque about the normal of the orbit that "
                "brings it back is",
                "k \\cdot \\tau",
                "What the orbit gives in energy",
                "N m",
                where=RADIUS | NORMAL,
            ),
        ),
        kernel="torque_gravity_gradient",
        topic="pendulums",
    ),
}

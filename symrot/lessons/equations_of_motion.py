"""Lessons of the chapter on equations of motion."""

from sympy import Rational

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "euler_equations": Lesson(
        question="A torque acts on a body. How does its angular velocity change, seen from the body?",
        before=("angular_momentum", "spin_tensor"),
        mistake=Mistake(
            "The gyroscopic terms look alike, and their signs follow the cyclic order of the axes. Students turn one "
            "around.",
            "A*domega_1 == (C - B)*omega_2*omega_3",
            facts=("A*domega_1 == (B - C)*omega_2*omega_3", "A > 0", "B > 0", "C > 0"),
            repair=1,
            lesson="In the equation of axis 1 the difference is $B - C$; the others follow by going round, "
            "$1 \\to 2 \\to 3 \\to 1$.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "No torque acts on the handle, yet at the start its angular velocity about axis 2 grows at the rate",
                "\\dot\\omega_2",
                "Along principal axes, with moments",
                "rad/s^2",
                entry=1,
                where={s.tau_2: 0 * s.A},
            ),
        ),
        kernel="euler_equations_principal",
        topic="euler_equations",
    ),
    "lagrange_and_euler": Lesson(
        question="Lagrange's equations use angles, Euler's use body axes. Do they say the same?",
        before=("euler_equations", "euler_body_rates", "kinetic_energy"),
        mistake=Mistake(
            "The generalised force of the precession is the torque about the vertical. Students take the torque about "
            "the "
            "third axis of the body.",
            "Q_phi == tau_3",
            facts=("Q_phi == tau_1*sin(psi)*sin(theta) + tau_2*cos(psi)*sin(theta) + tau_3*cos(theta)",),
            lesson="Each angle has its own axis, and its force is the torque about that axis.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The weight of the top drives the nutation with the generalised force",
                "Q_\\theta",
                "For a weight on the axis of symmetry",
                "N m",
                entry=1,
            ),
        ),
        kernel="euler_zxz_body_rates",
        topic="euler_equations",
    ),
    "work_and_power": Lesson(
        question="What does a torque do to the energy of a rotating body?",
        before=("kinetic_energy", "euler_equations"),
        mistake=Mistake(
            "The energy is quadratic in the rate. When students differentiate it, the inner derivative keeps the rate "
            "but "
            "they lose it.",
            "diff(I*omega(t)**2/2, t) == I*diff(omega(t), t)",
            lesson="Power is torque times angular velocity.",
        ),
        scene="damped_disk",
        numbers=(
            Number(
                "At the start the drag takes energy from the disk at the rate",
                "P",
                "Damping with positive coefficients",
                "W",
            ),
        ),
        kernel="torque_damping_linear",
        topic="euler_equations",
    ),
    "impulse_and_momentum": Lesson(
        question="A body at rest is struck. How does it move just after the blow?",
        before=("angular_momentum", "kinetic_energy"),
        mistake=Mistake(
            "A blow beside the centre of mass gives the same velocity to the centre as a central one. Students "
            "conclude "
            "that it gives the same energy.",
            "m*v**2/2 + C*omega**2/2 == J**2/(2*m)",
            facts=("v == J/m", "omega == J*h/C", "m > 0", "C > 0", "J > 0", "h > 0"),
            lesson="The place that is struck moves farther, so the blow does more work.",
        ),
        worked="struck_rod",
        kernel="kinetic_energy",
        topic="impulse",
    ),
    "attitude_not_needed": Lesson(
        question="When can the angular velocity be computed without knowing how the body is oriented?",
        before=("euler_equations",),
        mistake=Mistake(
            "A torque that is constant in space has constant components there. Students use the same components in "
            "the body.",
            "transpose(Rx(theta))*Matrix([0, 0, tau]) == Matrix([0, 0, tau])",
            lesson="A vector at rest in space moves in the body, so the attitude is needed.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "The torque of the scene is constant in the body. Were it constant in space, its components would "
                "change by",
                "\\left| \\partial \\tau_b / \\partial q_1 \\right|",
                "Its rate of change with the attitude",
                "N m",
                power=Rational(1, 2),
            ),
        ),
        kernel="torque_constant_space",
        topic="euler_equations",
    ),
    "planar_motion": Lesson(
        question="When is rotation in space as simple as rotation about a fixed axis?",
        before=("euler_equations",),
        mistake=Mistake(
            "Any axis through the centre of mass seems as good as any other. Students leave out what the products of "
            "inertia do.",
            "cross(Matrix([0, 0, w]), Matrix([I_xz*w, I_yz*w, I_zz*w])) == Matrix([0, 0, 0])",
            lesson="Only about a principal axis does a free body rotate steadily; otherwise its bearings must hold it.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "Along its third axis the satellite gains spin at the rate",
                "\\dot\\omega_3",
                "Along the third principal axis",
                "rad/s^2",
                entry=2,
            ),
        ),
        kernel="rigid_body_principal",
        topic="pendulums",
    ),
}

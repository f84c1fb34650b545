"""Lessons of the chapter on equations of motion."""

from sympy import Rational

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "euler_equations": Lesson(
        question="A torque acts on a body. How does its angular velocity change, in body components?",
        before=("angular_momentum", "spin_tensor"),
        mistake=Mistake(
            "The gyroscopic terms differ only in the indices, and their signs follow the cyclic order of the axes. "
            "Students get the sign of one term wrong.",
            "A*domega_1 == (C - B)*omega_2*omega_3",
            facts=("A*domega_1 == (B - C)*omega_2*omega_3", "A > 0", "B > 0", "C > 0"),
            repair=1,
            lesson="In the equation for axis 1 the difference is $B - C$; the other equations follow by the cyclic "
            r"exchange $1 \to 2 \to 3 \to 1$.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "No torque acts on the handle. Nevertheless its angular velocity about axis 2 grows at the start at "
                "the rate",
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
        question="Lagrange's equations use angles, Euler's equations use body axes. Are they equivalent?",
        before=("euler_equations", "euler_body_rates", "kinetic_energy"),
        mistake=Mistake(
            "The generalised force of the precession is the torque about the vertical. Students take the torque about "
            "the "
            "third axis of the body.",
            "Q_phi == tau_3",
            facts=("Q_phi == tau_1*sin(psi)*sin(theta) + tau_2*cos(psi)*sin(theta) + tau_3*cos(theta)",),
            lesson="Each angle has its own axis, and its generalised force is the torque about this axis.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The weight of the top drives the nutation with the generalised force",
                "Q_\\theta",
                "For a weight on the symmetry axis",
                "N m",
                entry=1,
            ),
        ),
        kernel="euler_zxz_body_rates",
        topic="euler_equations",
        library=("The other sequences",),
    ),
    "work_and_power": Lesson(
        question="What does a torque do to the energy of a rotating body?",
        before=("kinetic_energy", "euler_equations"),
        mistake=Mistake(
            "The energy is quadratic in the angular velocity. When students differentiate it, they forget the factor "
            r"$\omega$ from the chain rule.",
            "diff(I*omega(t)**2/2, t) == I*diff(omega(t), t)",
            lesson="The power is the torque times the angular velocity.",
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
            "A blow beside the centre of mass gives the centre the same velocity as a blow through the centre. "
            "Students conclude that both blows give the body the same energy.",
            "m*v**2/2 + C*omega**2/2 == J**2/(2*m)",
            facts=("v == J/m", "omega == J*h/C", "m > 0", "C > 0", "J > 0", "h > 0"),
            lesson="The struck point of the body moves farther during a blow beside the centre, so this blow does "
            "more work.",
        ),
        worked="struck_rod",
        kernel="kinetic_energy",
        topic="impulse",
    ),
    "attitude_not_needed": Lesson(
        question="When can the angular velocity be computed without the attitude of the body?",
        before=("euler_equations",),
        mistake=Mistake(
            "A torque that is constant in space has constant components in space axes. Students use the same "
            "components in body axes.",
            "transpose(Rx(theta))*Matrix([0, 0, tau]) == Matrix([0, 0, tau])",
            lesson="The body components of a vector that is constant in space change as the body rotates, so the "
            "attitude is needed.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "In the scene, the torque is constant in the body. If it were constant in space, the derivative of "
                "its body components with respect to $q_1$ would have this magnitude at the attitude $q = 1$:",
                "\\left| \\partial \\tau_b / \\partial q_1 \\right|",
                "If a torque is constant in space",
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
            "Students think that a free body can rotate about any axis through its centre of mass, and forget the "
            "products of inertia.",
            "cross(Matrix([0, 0, w]), Matrix([I_xz*w, I_yz*w, I_zz*w])) == Matrix([0, 0, 0])",
            lesson="A free body rotates steadily only about a principal axis; about any other axis, bearings must "
            "hold it.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "Under its torque the angular velocity of the satellite about its third axis grows at the rate",
                "\\dot\\omega_3",
                "A rotation about the third principal axis",
                "rad/s^2",
                entry=2,
            ),
        ),
        kernel="rigid_body_principal",
        topic="pendulums",
    ),
}

"""Lessons of the chapter on exact motions."""

from sympy import Integer, Rational

from symrot import symbols as s
from symrot.lessons.free_bodies import DESCENDING
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "elliptic_functions": Lesson(
        question="Which functions replace sine and cosine in motions that are not small oscillations?",
        before=(),
        mistake=Mistake(
            "The derivative of the sine is the cosine. Students expect that the derivative of sn is cn.",
            "dsn == cn",
            facts=("dsn == cn*dn", "dn > 0", "cn > 0"),
            lesson="The factor dn is 1 only at $\\mu = 0$, where sn is the sine.",
        ),
        scene="tumbling_prism_largest",
        numbers=(
            Number(
                "The motion of a free prism is described by these functions. Its moments in descending order are $C$, "
                "$B$, $A$, and the parameter is",
                "\\mu",
                "They give the parameter.",
                "1",
                where=DESCENDING,
                page="free_asymmetric_body",
            ),
        ),
        topic="pendulums",
        library=(
            "Sums of arguments",
            "The zeta function",
            "Theta functions",
            "Imaginary arguments",
        ),
    ),
    "free_body_attitude": Lesson(
        question="The angular velocity of a free body is known at all times. What is its attitude?",
        before=("free_asymmetric_body", "elliptic_functions"),
        mistake=Mistake(
            "The angle about the angular momentum grows at a rate with the constant part $H/C$. Students forget the "
            "variable part.",
            "dpsi == H/C",
            facts=("dpsi == H/C + (2*T - H**2/C)/(H + L_3)", "H > 0", "C > 0", "L_3 > 0", "T > 0"),
            lesson="The variable part is zero if the body rotates about its third axis.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "For a symmetric body the third angle grows at a constant rate. For the satellite of the scene this "
                "rate is",
                "\\dot\\psi",
                "If $B = A$, the third component of $L$",
                "rad/s",
                where={s.L_3: s.C * s.omega_3},
            ),
        ),
        kernel="rigid_body_principal",
        topic="free_bodies",
        library=(
            "The angular momentum in the body",
            "The third angle as an integral of the third kind",
            "The third angle without an integral",
        ),
    ),
    "free_body_separatrix": Lesson(
        question="Can a free body flip over exactly once?",
        before=("intermediate_axis", "poinsot"),
        mistake=Mistake(
            "The identity of hyperbolic functions differs from that of sine and cosine in a sign. Students use the "
            "wrong sign.",
            "tanh(x)**2 - 1/cosh(x)**2 == 1",
            lesson="Divide $\\cosh^2 - \\sinh^2 = 1$ by $\\cosh^2$.",
        ),
        scene="tumbling_prism",
        numbers=(
            Number(
                "The prism starts close to its separatrix. A small disturbance of its rotation grows at the rate",
                "\\lambda",
                "About the intermediate axis, a disturbance grows",
                "1/s",
                power=Rational(1, 2),
                page="intermediate_axis",
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
        ),
        kernel="rigid_body_principal",
        topic="stability",
        library=("The attitude",),
    ),
    "heavy_top_motion": Lesson(
        question="The axis of a top nutates and precesses. Is there a formula for its attitude at any time?",
        before=("heavy_top", "elliptic_functions"),
        mistake=Mistake(
            "The height of the axis is a cosine. Its derivative has a minus sign, which students forget.",
            "diff(cos(theta(t)), t) == sin(theta(t))*diff(theta(t), t)",
            repair=0,
            lesson="When the nutation grows, the axis sinks.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "At the start, the sum of the rates of precession and spin angle of the top is",
                "\\dot\\phi + \\dot\\psi",
                "The sum and the difference of the rates of precession and spin",
                "rad/s",
                entry=0,
            ),
        ),
        kernel="heavy_top_symmetric",
        topic="heavy_tops",
        library=(
            "The attitude",
            "The attitude without an integral",
        ),
    ),
    "pendulum": Lesson(
        question="What is the period of a pendulum with a large amplitude?",
        before=("elliptic_functions",),
        mistake=Mistake(
            "A rod that hangs from its end is not a point mass at its lower end. Students use the formula of the "
            "simple pendulum.",
            "rate**2 == g/L",
            facts=("rate**2 == m*g*(L/2)/I_0", "I_0 == m*L**2/3", "m > 0", "g > 0", "L > 0"),
            lesson="A rod oscillates like a simple pendulum of two thirds of its length.",
        ),
        worked="period_of_rod",
        kernel="torque_gravity",
        topic="pendulums",
        library=("The pendulum as a heavy top",),
    ),
    "sleeping_top": Lesson(
        question="A fast top stands upright as if it slept. At which spin does it begin to fall?",
        before=("heavy_top", "heavy_top_motion"),
        mistake=Mistake(
            r"The bound contains the angular momentum $p_\psi = C \omega_3$. Students lose a factor $C$ when they "
            "compute the spin.",
            "omega_3**2 == 4*A*W*c/C",
            facts=("p**2 == 4*A*W*c", "p == C*omega_3", "A > 0", "C > 0", "W > 0", "c > 0"),
            lesson="Check the units: $A W c / C$ is a torque, not the square of a rate.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                r"The least spin at which this top can sleep, in the limit $u_1 \to 1$, is",
                "\\omega_3",
                "Both momenta are equal. They are below the",
                "rad/s",
                power=Rational(1, 2),
                scale=1 / s.C,
                where={s.u_1: Integer(1)},
            ),
        ),
        kernel="heavy_top_symmetric",
        topic="heavy_tops",
        library=("The acceleration of the height, and the angle of precession",),
    ),
    "symmetric_gyrostat": Lesson(
        question="How does a spinning wheel along the axis of a satellite change its wobble?",
        before=("gyrostat_invariants", "symmetric_top"),
        mistake=Mistake(
            "Students use the rate of the free symmetric body and forget the wheel.",
            "rate == (C - A)*omega_3/A",
            facts=("rate == ((C - A)*omega_3 + h)/A", "A > 0", "C > 0", "h > 0"),
            lesson="The wheel adds its angular momentum to the rate, and can make the rate zero.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "With the wheel at rest, the satellite precesses at the rate",
                "\\frac{H}{A}",
                "The square of the precession rate",
                "rad/s",
                power=Rational(1, 2),
                where={s.h_3: Integer(0)},
            ),
            Number(
                "With a wheel of 10 kg m^2/s, it precesses at the rate",
                "\\frac{H}{A}",
                "The square of the precession rate",
                "rad/s",
                power=Rational(1, 2),
                where={s.h_3: Integer(10)},
            ),
        ),
        kernel="torque_rotor",
        topic="gyroscopes",
    ),
    "driven_rotation": Lesson(
        question="A motor rotates a body against friction. Which angular velocity does the body reach, and what "
        "happens if it also wobbles?",
        before=("planar_motion", "symmetric_top"),
        mistake=Mistake(
            "In the exponent, the damping coefficient $b$ is divided by the moment of inertia. Students forget the "
            "moment.",
            "C*diff(tau/b*(1 - exp(-b*t)), t) == tau - b*(tau/b*(1 - exp(-b*t)))",
            facts=("C > 0", "b > 0", "tau > 0"),
            repair=None,
            lesson="A rotor with a larger moment of inertia takes longer: the time constant is $C/b$.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "After 100 s the spin of the satellite is",
                "\\omega_3(100\\,\\mathrm{s})",
                "The derivative of the angle is the rate.",
                "rad/s",
                where={s.t: Integer(100)},
                section="Constant torque",
            ),
        ),
        kernel="torque_constant_body",
        topic="euler_equations",
        library=(
            "Weak damping",
            "The attitude of this body",
            "The attitude in closed form",
            "Far from resonance",
            "The coefficients far from resonance",
            "Near resonance",
            "A weak torque",
            "Between two times",
        ),
    ),
}

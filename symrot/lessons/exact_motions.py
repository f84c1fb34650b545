"""Lessons of the chapter on exact motions."""

from sympy import Integer, Rational

from symrot import symbols as s
from symrot.lessons.free_bodies import DESCENDING
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "elliptic_functions": Lesson(
        question="Which functions take the place of sine and cosine where a motion is not a small oscillation?",
        before=(),
        mistake=Mistake(
            "The derivative of the sine is the cosine. Students expect the same of sn and cn.",
            "dsn == cn",
            facts=("dsn == cn*dn", "dn > 0", "cn > 0"),
            lesson="The factor dn is 1 only at $\\mu = 0$, where sn is the sine.",
        ),
        scene="tumbling_prism_largest",
        numbers=(
            Number(
                "A free prism moves in these functions. Its moments in descending order are $C$, $B$, $A$; its "
                "parameter is",
                "\\mu",
                "The parameter.",
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
            "On the imaginary axis",
        ),
    ),
    "free_body_attitude": Lesson(
        question="The angular velocity of a free body is known at all times. Which way does the body point?",
        before=("free_asymmetric_body", "elliptic_functions"),
        mistake=Mistake(
            "The body turns about its angular momentum with the constant part $H/C$. Students forget the part that "
            "changes.",
            "dpsi == H/C",
            facts=("dpsi == H/C + (2*T - H**2/C)/(H + L_3)", "H > 0", "C > 0", "L_3 > 0", "T > 0"),
            lesson="The second part is zero only if the body rotates about its third axis alone.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "For a symmetric body the third angle grows evenly. For the satellite its rate is",
                "\\dot\\psi",
                "With $B = A$ the third component is constant",
                "rad/s",
                where={s.L_3: s.C * s.omega_3},
            ),
        ),
        kernel="rigid_body_principal",
        topic="free_bodies",
        library=(
            "The third angle as an integral of the third kind",
            "The third angle without an integral",
        ),
    ),
    "free_body_separatrix": Lesson(
        question="Can a free body flip over exactly once?",
        before=("intermediate_axis", "poinsot"),
        mistake=Mistake(
            "The rule for hyperbolic functions has another sign than that for sine and cosine.",
            "tanh(x)**2 - 1/cosh(x)**2 == 1",
            lesson="Divide $\\cosh^2 - \\sinh^2 = 1$ by $\\cosh^2$.",
        ),
        scene="tumbling_prism",
        numbers=(
            Number(
                "The prism starts close to its separatrix. A disturbance of it grows at the rate",
                "\\lambda",
                "About the intermediate axis it grows.",
                "1/s",
                power=Rational(1, 2),
                page="intermediate_axis",
                where={s.C: s.A, s.delta_1: s.C - s.A, s.delta_2: s.B - s.C, s.Omega: s.omega_3},
            ),
        ),
        kernel="rigid_body_principal",
        topic="stability",
    ),
    "heavy_top_motion": Lesson(
        question="A top nods and precesses. Is there a formula for its attitude at any time?",
        before=("heavy_top", "elliptic_functions"),
        mistake=Mistake(
            "The height of the axis is a cosine. Its rate has a minus sign, which students lose.",
            "diff(cos(theta(t)), t) == sin(theta(t))*diff(theta(t), t)",
            repair=0,
            lesson="Where the nutation grows the axis sinks.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "At the start the precession and the spin angle of the top change together at the rate",
                "\\dot\\phi + \\dot\\psi",
                "Their sum and their difference are simpler",
                "rad/s",
                entry=0,
            ),
        ),
        kernel="heavy_top_symmetric",
        topic="heavy_tops",
        library=(
            "The attitude",
            "No integral",
        ),
    ),
    "pendulum": Lesson(
        question="How long does a pendulum take for a large swing?",
        before=("elliptic_functions",),
        mistake=Mistake(
            "A rod that hangs from its end is not a point at its lower end. Students use the formula of the simple "
            "pendulum.",
            "rate**2 == g/L",
            facts=("rate**2 == m*g*(L/2)/I_0", "I_0 == m*L**2/3", "m > 0", "g > 0", "L > 0"),
            lesson="A rod swings as a simple pendulum of two thirds of its length.",
        ),
        worked="period_of_rod",
        kernel="torque_gravity",
        topic="pendulums",
    ),
    "sleeping_top": Lesson(
        question="A fast top stands upright as if asleep. When does it wake?",
        before=("heavy_top", "heavy_top_motion"),
        mistake=Mistake(
            "The bound is for the angular momentum $p_\\psi = C \\omega_3$. Students lose one factor $C$ on the way "
            "to the "
            "spin.",
            "omega_3**2 == 4*A*W*c/C",
            facts=("p**2 == 4*A*W*c", "p == C*omega_3", "A > 0", "C > 0", "W > 0", "c > 0"),
            lesson="Check the units: $A W c / C$ is a torque, not the square of a rate.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The least spin with which this top sleeps, as $u_1 \\to 1$, is",
                "\\omega_3",
                "Both momenta are equal, and less than the",
                "rad/s",
                power=Rational(1, 2),
                scale=1 / s.C,
                where={s.u_1: Integer(1)},
            ),
        ),
        kernel="heavy_top_symmetric",
        topic="heavy_tops",
    ),
    "symmetric_gyrostat": Lesson(
        question="How does a spinning wheel along its axis change the wobble of a satellite?",
        before=("gyrostat_invariants", "symmetric_top"),
        mistake=Mistake(
            "Students take over the rate of the free symmetric body and forget the wheel.",
            "rate == (C - A)*omega_3/A",
            facts=("rate == ((C - A)*omega_3 + h)/A", "A > 0", "C > 0", "h > 0"),
            lesson="The wheel adds its angular momentum, and can make the rate zero.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "With the wheel at rest, the satellite precesses at the rate",
                "\\frac{H}{A}",
                "The rate of the precession grows with the rotor.",
                "rad/s",
                power=Rational(1, 2),
                where={s.h_3: Integer(0)},
            ),
            Number(
                "With a wheel of 10 kg m^2/s, at",
                "\\frac{H}{A}",
                "The rate of the precession grows with the rotor.",
                "rad/s",
                power=Rational(1, 2),
                where={s.h_3: Integer(10)},
            ),
        ),
        kernel="torque_rotor",
        topic="gyroscopes",
    ),
    "driven_rotation": Lesson(
        question="A motor turns a body against friction. How fast does it become, and what if it wobbles meanwhile?",
        before=("planar_motion", "symmetric_top"),
        mistake=Mistake(
            "The friction $b$ is divided by the moment of inertia in the exponent. Students leave the moment out.",
            "C*diff(tau/b*(1 - exp(-b*t)), t) == tau - b*(tau/b*(1 - exp(-b*t)))",
            facts=("C > 0", "b > 0", "tau > 0"),
            repair=None,
            lesson="A heavy rotor takes longer: the time constant is $C/b$.",
        ),
        scene="spin_up",
        numbers=(
            Number(
                "After 100 s the satellite spins at",
                "\\omega_3(100\\,\\mathrm{s})",
                "It is the rate of the angle.",
                "rad/s",
                where={s.t: Integer(100)},
                section="Constant torque",
            ),
        ),
        kernel="torque_constant_body",
        topic="euler_equations",
        library=(
            "The attitude in closed form",
            "Far from resonance",
            "The coefficients far from resonance",
            "Near resonance",
            "A weak torque",
            "Between two times",
        ),
    ),
}

"""Constant torque and linear damping about one axis, in closed form."""

from sympy import Expr, Matrix, Rational, S, cos, diag, exp, sin

from symrot import symbols
from symrot.catalogue._elliptic import I, imaginary
from symrot.catalogue._motion import pairs, rate
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import qmul, quaternion_rates
from symrot.proof import Derivation

A, _, C = symbols.principal
T, PUSH, DRAG, START = symbols.t, symbols.tau_3, symbols.b_3, symbols.omega_3
AXIS = Matrix([0, 0, 1])
HALF = Rational(1, 2)
STEADY = START + PUSH * T / C
ANGLE = START * T + PUSH * T**2 / (2 * C)


def derive() -> Derivation:
    d = Derivation(
        "driven_rotation",
        title="Constant torque and damping about one axis",
        source="Leimanis, *The General Problem of the Motion of Coupled Rigid Bodies about a Fixed Point*, section "
        "15; for the last section Zener, *Proc. R. Soc. A* 137 (1932) 696",
        about=(
            "A motor and a brake about a principal axis: the rate and the angle are elementary functions of time. In a "
            "symmetric body that also turns across the axis, the transverse angular velocity turns by an angle that "
            "grows with the square of time."
        ),
    )
    _pushed(d)
    _braked(d)
    _across(d)
    _attitude(d)
    return d


def _pushed(d: Derivation) -> None:
    d.section("Constant torque")
    d.given(
        r"The body turns [about one principal axis](planar_motion.md), of moment $C$, under the torque $\tau_3$ along "
        r"it, from $\omega_3$ at $t = 0$.",
        (r"\omega_3(t)", STEADY),
        (r"\theta(t)", ANGLE),
    )
    d.step(
        "The rate obeys the equation of motion.",
        C * STEADY.diff(T),
        PUSH,
        because="it is linear in time",
        named=r"C\,\dot\omega_3(t)",
    )
    d.step(
        "It is the rate of the angle.",
        ANGLE.diff(T),
        STEADY,
        because="a quadratic is differentiated",
        named=r"\dot\theta(t)",
        shown=r"\omega_3(t)",
    )
    q = Matrix(symbols.quaternion)
    d.notation({"q": q, "e_3": AXIS, r"\theta": ANGLE}, {T: S.One})
    turn = Matrix([cos(ANGLE / 2), 0, 0, sin(ANGLE / 2)])
    attitude = Matrix(qmul(q, turn))
    d.step(
        "The attitude: a turn by that angle, from the attitude $q$ at the start.",
        attitude.diff(T),
        quaternion_rates("body", attitude) * (STEADY * AXIS),
        because=r"the axis is fixed in the body, and in space",
        named=r"\frac{d}{dt} \left( q\,(\cos\tfrac\theta2,\ e_3 \sin\tfrac\theta2) \right)",
        shown=r"\tfrac12\,q\,(\cos\tfrac\theta2,\ e_3 \sin\tfrac\theta2)\,(0,\ \omega_3(t)\,e_3)",
    )


def _decay() -> tuple[Expr, Expr, Expr]:
    """Return the rate, the angle, and the decaying factor with damping."""
    decay = exp(-DRAG * T / C)
    final = PUSH / DRAG
    return final + (START - final) * decay, final * T + (START - final) * C / DRAG * (1 - decay), decay


def _braked(d: Derivation) -> None:
    d.section("With linear damping")
    speed, angle, decay = _decay()
    d.given(
        r"A brake adds the torque $-b_3\,\omega_3$. The rate tends to $\tau_3 / b_3$:",
        (r"\omega_3(t)", speed),
        (r"\theta(t)", angle),
    )
    d.step(
        "The rate obeys the equation of motion.",
        C * speed.diff(T),
        PUSH - DRAG * speed,
        because="an exponential is its own derivative",
        named=r"C\,\dot\omega_3(t)",
        shown=r"\tau_3 - b_3\,\omega_3(t)",
    )
    d.step(
        "It is the rate of the angle.",
        angle.diff(T),
        speed,
        because="of the same derivative",
        named=r"\dot\theta(t)",
        shown=r"\omega_3(t)",
    )
    d.step(
        "Both start as they must.",
        Matrix([speed, angle]).subs(T, 0),
        Matrix([START, 0]),
        because="$e^0 = 1$",
        named=r"\begin{bmatrix} \omega_3(0) \\ \theta(0) \end{bmatrix}",
    )
    x = symbols.v
    d.given(
        r"For weak damping these are differences of large numbers. With $x = -b_3 t / C$ and the functions "
        r"$f_1 = (e^x - 1)/x$ and $f_2 = (e^x - 1 - x)/x^2$, which are regular at $x = 0$, they are not:"
    )
    first, second = (
        (exp(-DRAG * T / C) - 1) / (-DRAG * T / C),
        (exp(-DRAG * T / C) - 1 + DRAG * T / C) / (DRAG * T / C) ** 2,
    )
    power = -DRAG * T / C
    d.notation({"x": power, "f_1": (exp(power) - 1) / power, "f_2": (exp(power) - 1 - power) / power**2})
    d.step(
        "The same, in a form that holds without damping too.",
        Matrix([speed, angle]),
        Matrix([START * decay + PUSH / C * T * first, START * T * first + PUSH / C * T**2 * second]),
        because="the fractions are multiplied out",
        named=r"\begin{bmatrix} \omega_3(t) \\ \theta(t) \end{bmatrix}",
        shown=r"\begin{bmatrix} \omega_3\,e^x + \frac{\tau_3}{C}\,t\,f_1 \\ \omega_3\,t\,f_1 + \frac{\tau_3}{C}\,t^2 "
        r"f_2 \end{bmatrix}",
    )
    d.step(
        r"The values at $x = 0$, by the rule of de l'Hospital, $f_1 = 1$ and $f_2 = \tfrac12$, give the motion without "
        "damping.",
        Matrix([(exp(x) - 1).diff(x) / x.diff(x), (exp(x) - 1 - x).diff(x, 2) / (x**2).diff(x, 2)]).subs(x, 0),
        Matrix([1, HALF]),
        because="$e^0 = 1$",
        named=r"\begin{bmatrix} f_1(0) \\ f_2(0) \end{bmatrix}",
    )


def _across(d: Derivation) -> None:
    d.section("A symmetric body that turns across the axis as well")
    first, second = symbols.omega_1, symbols.omega_2
    turn = (C - A) / A * symbols.theta
    d.notation({r"\theta": symbols.theta})
    omega = Matrix([first * cos(turn) - second * sin(turn), first * sin(turn) + second * cos(turn), symbols.Omega])
    d.given(
        r"Moments $A, A, C$; $\Omega$ is the rate $\omega_3(t)$ and $\theta$ its angle, of either section above. From "
        r"$\omega_1, \omega_2$ at the start:",
        (r"\omega(t)", omega),
        (r"\omega_1(t)", omega[0]),
        (r"\omega_2(t)", omega[1]),
    )
    d.step(
        "Across the axis Euler's equations hold, whatever the rate: the torque is along the axis.",
        Matrix(rate(omega, {symbols.theta: symbols.Omega})[:2]),
        Matrix(angular_acceleration(diag(A, A, C), omega, PUSH * AXIS)[:2]),
        because=r"the phase grows at the rate $\frac{C - A}{A}\,\Omega$",
        named=r"\begin{bmatrix} \dot\omega_1(t) \\ \dot\omega_2(t) \end{bmatrix}",
        shown=r"\frac{C - A}{A}\,\Omega \begin{bmatrix} -\omega_2(t) \\ \omega_1(t) \end{bmatrix}",
    )
    d.notation({r"\theta(t)": ANGLE})
    d.step(
        "With a constant torque the phase is quadratic in time: integrals over it are those of Fresnel.",
        ((C - A) / A * ANGLE).diff(T, 2),
        (C - A) / (A * C) * PUSH,
        because="twice the coefficient of $t^2$",
        named=r"\frac{d^2}{dt^2} \left( \frac{C - A}{A}\,\theta(t) \right)",
    )


def _attitude(d: Derivation) -> None:
    d.section("Its attitude")
    across, sweep, growth = symbols.omega_1, symbols.Omega, symbols.domega_3
    d.given(
        r"In axes that turn with the transverse angular velocity, of length $\omega_1$, the angular velocity of the "
        r"body "
        r"is $(\omega_1, 0, \Omega)$ with $\Omega = \frac{C}{A}\,\omega_3(t)$, which is linear in time. The attitude "
        r"of "
        r"these axes as two complex numbers is $\alpha = q_0 + i q_3$ and $\beta = q_1 + i q_2$."
    )
    q0, q1, q2, q3 = symbols.quaternion
    speeds = quaternion_rates("body") * Matrix([across, 0, sweep])
    motion = pairs(symbols.quaternion, speeds) | {sweep: growth}
    first, second = q0 + I * q3, q1 + I * q2
    d.notation({r"\alpha": first, r"\beta": second, "i": I}, motion)
    d.step(
        "They obey the equations of a two-level system that is swept through resonance.",
        rate(Matrix([first, second]), motion),
        HALF * Matrix([I * sweep * first - across * second, across * first - I * sweep * second]),
        because="the quaternion equation, in pairs",
        relations=[imaginary()],
        named=r"\begin{bmatrix} \dot\alpha \\ \dot\beta \end{bmatrix}",
        shown=r"\tfrac12 \begin{bmatrix} i \Omega\,\alpha - \omega_1\,\beta \\ \omega_1\,\alpha - i \Omega\,\beta "
        r"\end{bmatrix}",
    )
    d.step(
        r"One alone obeys Weber's equation, $\dot\Omega$ being constant: parabolic cylinder functions of time. The "
        "numeric code does not offer them; such a motion is stepped.",
        rate(rate(first, motion), motion),
        (I * growth / 2 - (sweep**2 + across**2) / 4) * first,
        because="the second number is eliminated",
        relations=[imaginary()],
        named=r"\ddot\alpha",
        shown=r"\left( \frac{i}{2}\,\dot\Omega - \frac{\Omega^2 + \omega_1^2}{4} \right) \alpha",
    )

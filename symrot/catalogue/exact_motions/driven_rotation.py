"""Rotation about one axis under a constant torque and linear damping, in closed form."""

from sympy import Expr, Matrix, Rational, S, Symbol, cos, diag, exp, sin

from symrot import symbols
from symrot.catalogue.tools import swept_body as _swept_body
from symrot.catalogue.tools.elliptic import I, imaginary
from symrot.catalogue.tools.motion import pairs, rate
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_product, quaternion_rates
from symrot.proof.derivation import Derivation

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
        "15; for the attitude Zener, *Proc. R. Soc. A* 137 (1932) 696",
        about=(
            "Under a motor and a brake about a principal axis, rate and angle of the rotation are elementary "
            "functions of time. If a symmetric body also rotates about a transverse axis, its transverse angular "
            "velocity rotates by an angle that is quadratic in time."
        ),
    )
    _pushed(d)
    _braked(d)
    _across(d)
    _weakly_braked(d)
    _attitude(d)
    _by_kummer(d)
    _far(d)
    _swept_body.far(d)
    _swept_body.near(d)
    _swept_body.weak(d)
    _swept_body.between(d)
    return d


def _pushed(d: Derivation) -> None:
    d.section("Constant torque")
    d.passage(
        "The body rotates [about one principal axis](planar_motion.md) with the moment $C$, under the torque "
        r"$\tau_3$ along this axis. Its rate is $\omega_3$ at $t = 0$.",
        (r"\omega_3(t)", STEADY),
        (r"\theta(t)", ANGLE),
    )
    d.step(
        "The rate satisfies the equation of motion.",
        C * STEADY.diff(T),
        PUSH,
        because="the angular velocity is linear in time",
        named=r"C\,\dot\omega_3(t)",
    )
    d.step(
        "The derivative of the angle is the rate.",
        ANGLE.diff(T),
        STEADY,
        because="the angle, which is quadratic in time, is differentiated",
        named=r"\dot\theta(t)",
        display=r"\omega_3(t)",
    )
    q = Matrix(symbols.quaternion)
    d.notation({"q": q, "e_3": AXIS, r"\theta": ANGLE}, {T: S.One})
    turn = Matrix([cos(ANGLE / 2), 0, 0, sin(ANGLE / 2)])
    attitude = Matrix(quaternion_product(q, turn))
    d.step(
        r"The attitude is the initial attitude $q$ followed by a rotation by the angle $\theta(t)$.",
        attitude.diff(T),
        quaternion_rates("body", attitude) * (STEADY * AXIS),
        because=r"the axis is fixed in the body, and in space",
        named=r"\frac{d}{dt} \left( q\,(\cos\tfrac\theta2,\ e_3 \sin\tfrac\theta2) \right)",
        display=r"\tfrac12\,q\,(\cos\tfrac\theta2,\ e_3 \sin\tfrac\theta2)\,(0,\ \omega_3(t)\,e_3)",
    )


def _decay() -> tuple[Expr, Expr, Expr]:
    """Return angular velocity and angle of a damped rotation, and the exponential factor that occurs in both."""
    decay = exp(-DRAG * T / C)
    final = PUSH / DRAG
    return final + (START - final) * decay, final * T + (START - final) * C / DRAG * (1 - decay), decay


def _braked(d: Derivation) -> None:
    d.section("With linear damping")
    speed, angle, _ = _decay()
    d.passage(
        r"A brake adds the torque $-b_3\,\omega_3$. The rate then approaches $\tau_3 / b_3$:",
        (r"\omega_3(t)", speed),
        (r"\theta(t)", angle),
    )
    d.step(
        r"The rate $\omega_3(t)$ satisfies the equation of motion with damping.",
        C * speed.diff(T),
        PUSH - DRAG * speed,
        because="an exponential is its own derivative",
        named=r"C\,\dot\omega_3(t)",
        display=r"\tau_3 - b_3\,\omega_3(t)",
    )
    d.step(
        "The derivative of the angle is the rate.",
        angle.diff(T),
        speed,
        because="the exponential is differentiated in the same way",
        named=r"\dot\theta(t)",
        display=r"\omega_3(t)",
    )
    d.step(
        "Rate and angle have the right initial values.",
        Matrix([speed, angle]).subs(T, 0),
        Matrix([START, 0]),
        because="$e^0 = 1$",
        named=r"\begin{bmatrix} \omega_3(0) \\ \theta(0) \end{bmatrix}",
    )


def _across(d: Derivation) -> None:
    d.section("A symmetric body that also rotates about a transverse axis")
    first, second = symbols.omega_1, symbols.omega_2
    turn = (C - A) / A * symbols.theta
    d.notation({r"\theta": symbols.theta})
    omega = Matrix([first * cos(turn) - second * sin(turn), first * sin(turn) + second * cos(turn), symbols.Omega])
    d.passage(
        r"The moments are $A, A, C$. $\Omega$ is the rate $\omega_3(t)$ and $\theta$ the angle of the rotation about "
        r"the axis, with or without a brake. With the initial values $\omega_1, \omega_2$:",
        (r"\omega(t)", omega),
    )
    d.notation({rf"\omega_{n + 1}(t)": omega[n] for n in range(2)})
    d.step(
        r"The transverse components satisfy Euler's equations for every rate $\Omega$, because the torque is along "
        "the axis.",
        Matrix(rate(omega, {symbols.theta: symbols.Omega})[:2]),
        Matrix(angular_acceleration(diag(A, A, C), omega, PUSH * AXIS)[:2]),
        because=r"the phase grows at the rate $\frac{C - A}{A}\,\Omega$",
        named=r"\begin{bmatrix} \dot\omega_1(t) \\ \dot\omega_2(t) \end{bmatrix}",
        display=r"\frac{C - A}{A}\,\Omega \begin{bmatrix} -\omega_2(t) \\ \omega_1(t) \end{bmatrix}",
    )
    d.notation({r"\theta(t)": ANGLE})
    d.step(
        "Under a constant torque the phase is quadratic in time. Integrals over the transverse components are "
        "therefore Fresnel integrals.",
        ((C - A) / A * ANGLE).diff(T, 2),
        (C - A) / (A * C) * PUSH,
        because="the angular acceleration of the phase is twice the coefficient of $t^2$",
        named=r"\frac{d^2}{dt^2} \left( \frac{C - A}{A}\,\theta(t) \right)",
    )


def _weakly_braked(d: Derivation) -> None:
    d.section("Weak damping")
    speed, angle, decay = _decay()
    x = symbols.v
    d.notation({r"\omega_3(t)": speed, r"\theta(t)": angle})
    d.passage(
        "For weak damping, the formulas for rate and angle are differences of large numbers, which lose "
        "digits. This is avoided by the functions $f_1 = (e^x - 1)/x$ and $f_2 = (e^x - 1 - x)/x^2$ of $x = -b_3 t / "
        "C$, which are regular at $x = 0$:"
    )
    power = -DRAG * T / C
    first, second = (exp(power) - 1) / power, (exp(power) - 1 - power) / power**2
    d.notation({"x": power, "f_1": first, "f_2": second})
    d.step(
        "The rate and the angle under a torque with damping are written with $f_1 = (e^x - 1)/x$ and "
        r"$f_2 = (e^x - 1 - x)/x^2$. Both formulas also hold without damping, with the limits $f_1 = 1$ and $f_2 = "
        r"\tfrac12$ at $x = 0$.",
        Matrix([speed, angle]),
        Matrix([START * decay + PUSH / C * T * first, START * T * first + PUSH / C * T**2 * second]),
        because="the equation is multiplied by the denominators",
        named=r"\begin{bmatrix} \omega_3(t) \\ \theta(t) \end{bmatrix}",
        display=r"\begin{bmatrix} \omega_3\,e^x + \frac{\tau_3}{C}\,t\,f_1 \\ \omega_3\,t\,f_1 + \frac{\tau_3}{C}\,t^2 "
        r"f_2 \end{bmatrix}",
    )
    d.step(
        r"At $x = 0$ the functions have the limits $f_1 = 1$ and $f_2 = \tfrac12$ (l'Hospital's rule), which give the "
        "motion without damping.",
        Matrix([(exp(x) - 1).diff(x) / x.diff(x), (exp(x) - 1 - x).diff(x, 2) / (x**2).diff(x, 2)]).subs(x, 0),
        Matrix([1, HALF]),
        because="$e^0 = 1$",
        named=r"\begin{bmatrix} f_1(0) \\ f_2(0) \end{bmatrix}",
    )


def _attitude(d: Derivation) -> None:
    d.section("The attitude of this body")
    across, sweep, growth = symbols.omega_1, symbols.Omega, symbols.domega_3
    d.passage(
        r"Consider axes that rotate with the transverse angular velocity, which has the length $\omega_1$. In these "
        r"axes the angular velocity is $(\omega_1, 0, \Omega)$ with $\Omega = \frac{C}{A}\,\omega_3(t)$, which is "
        r"linear in time. Two complex numbers $\alpha = q_0 + i q_3$ and $\beta = q_1 + i q_2$ describe the attitude "
        "of these axes."
    )
    q0, q1, q2, q3 = symbols.quaternion
    speeds = quaternion_rates("body") * Matrix([across, 0, sweep])
    motion = pairs(symbols.quaternion, speeds) | {sweep: growth}
    first, second = q0 + I * q3, q1 + I * q2
    d.notation({r"\alpha": first, r"\beta": second, "i": I}, motion)
    d.step(
        r"The numbers $\alpha$ and $\beta$ satisfy the equations of a two-level system that is swept through "
        "resonance.",
        rate(Matrix([first, second]), motion),
        HALF * Matrix([I * sweep * first - across * second, across * first - I * sweep * second]),
        because="the rates of the quaternion are written as two complex equations",
        relations=[imaginary()],
        named=r"\begin{bmatrix} \dot\alpha \\ \dot\beta \end{bmatrix}",
        display=r"\tfrac12 \begin{bmatrix} i \Omega\,\alpha - \omega_1\,\beta \\ \omega_1\,\alpha - i \Omega\,\beta "
        r"\end{bmatrix}",
    )
    d.step(
        r"Since $\dot\Omega$ is constant, $\alpha$ alone satisfies Weber's equation. Its solutions are parabolic "
        "cylinder functions of time.",
        rate(rate(first, motion), motion),
        (I * growth / 2 - (sweep**2 + across**2) / 4) * first,
        because="the second complex number is eliminated",
        relations=[imaginary()],
        named=r"\ddot\alpha",
        display=r"\left( \frac{i}{2}\,\dot\Omega - \frac{\Omega^2 + \omega_1^2}{4} \right) \alpha",
    )


def _by_kummer(d: Derivation) -> None:
    d.section("The attitude in closed form")
    across, sweep, growth = symbols.omega_1, symbols.Omega, symbols.domega_3
    value, slope, phase = Symbol("M"), Symbol("N"), Symbol("E")
    a = -I * across**2 / (8 * growth)
    z = -I * sweep**2 / (2 * growth)
    motion = {
        sweep: growth,
        phase: I * sweep / 2 * phase,
        value: -I * sweep * slope,
        slope: 2 * growth / sweep * (a * value - (HALF - z) * slope),
    }
    first, second = phase * value, 2 * I * sweep / across * phase * slope
    d.passage(
        r"Kummer's function $M = {}_1F_1(a; \tfrac12; z)$ and its derivative $N = dM/dz$ satisfy $z \frac{dN}{dz} = a "
        r"M - (\tfrac12 - z) N$. Let $a = -\frac{i \omega_1^2}{8 \dot\Omega}$, $z = -\frac{i \Omega^2}{2 \dot\Omega}$ "
        r"with $\dot z = -i \Omega$, and $E = e^{i \Omega^2 / 4 \dot\Omega}$ with $\dot E = \frac{i}{2} \Omega E$. "
        "Define",
        (r"\alpha", first),
        (r"\beta", second),
    )
    d.notation({r"\alpha": first, r"\beta": second, "M": value, "N": slope, "E": phase, "i": I}, motion)
    d.step(
        r"The $\alpha$ and $\beta$ defined with Kummer's function satisfy the equations of the two-level system. They "
        r"describe axes that coincide with the axes of space at $\Omega = 0$, where $\alpha = 1$ and $\beta = 0$. For "
        "any other initial attitude, the quaternion is a constant quaternion times this one.",
        rate(Matrix([first, second]), motion),
        HALF * Matrix([I * sweep * first - across * second, across * first - I * sweep * second]),
        because="Kummer's equation gives $dN/dz$",
        relations=[imaginary()],
        named=r"\begin{bmatrix} \dot\alpha \\ \dot\beta \end{bmatrix}",
        display=r"\tfrac12 \begin{bmatrix} i \Omega\,\alpha - \omega_1\,\beta \\ \omega_1\,\alpha - i \Omega\,\beta "
        r"\end{bmatrix}",
    )
    speed, area = Symbol("S"), Symbol("Z")
    swept = {sweep: growth, speed: sweep * growth / speed, area: growth / speed}
    angle = (sweep * speed + across**2 * area) / (2 * growth)
    d.passage(
        r"Let $S = \sqrt{\Omega^2 + \omega_1^2}$ be the rate of rotation of the axes that follow the transverse "
        r"angular velocity, and let $Z = \operatorname{arsinh} (\Omega/\omega_1)$, with $\dot Z = \dot\Omega / S$."
    )
    d.notation({"S": speed, "Z": area}, swept)
    d.step(
        r"The integral of $S$ over time is elementary. It is called the phase: if $\Omega$ changes slowly, it is the "
        "angle by which the axes rotate about the direction of their angular velocity, which changes slowly too.",
        rate(angle, swept),
        speed,
        because=r"$S^2 = \Omega^2 + \omega_1^2$",
        relations=[speed**2 - sweep**2 - across**2],
        named=r"\frac{d}{dt} \frac{\Omega S + \omega_1^2 Z}{2 \dot\Omega}",
        display="S",
    )


def _far(d: Derivation) -> None:
    d.section("Far from resonance")
    x, r, kappa = Symbol("x"), Symbol("r"), Symbol("kappa")
    a, b, c = Symbol("a"), Symbol("b"), Symbol("c")
    v = 1 / r**2
    moved = -2 * x / r**4
    motion = {
        x: S.One,
        r: x / r,
        a: moved * -(a + c) / (2 * v),
        b: moved * kappa**2 * (b + c) / (2 * (1 - kappa**2 * v)),
        c: moved * ((a - b) / v**2 - 3 * c) / (2 * v),
    }
    n = Matrix([kappa / r * a, kappa / r**3 * c, x / r * b])
    d.passage(
        r"Let the unit of time be $\dot\Omega^{-1/2}$ and $x$ the time, so that the angular velocity is $(\kappa, 0, "
        r"x)$. Let $r^2 = x^2 + \kappa^2$ and $v = 1/r^2$. Let $a, b, c$ be power series in $v$ with $c = -(a + 2 v "
        r"a')$, $b - a = -v^2 (3 c + 2 v c')$ and $2 (1 - \kappa^2 v) b' = \kappa^2 (b + c)$. Starting from $a = b = "
        "1$ at $v = 0$, these equations give each coefficient from the coefficients before it. Define",
        ("n", n),
    )
    d.notation({"n": n, r"\kappa": kappa, "r": r, "x": x}, motion)
    d.step(
        "The vector $n$ is fixed in space. Far from resonance it is close to the axis of rotation, and the body "
        r"rotates about it by the phase $\int S\,dt$, except for a small angle.",
        rate(n, motion),
        n.cross(Matrix([kappa, 0, x])),
        because="in body components, a vector that is fixed in space rotates backwards",
        relations=[r**2 - x**2 - kappa**2],
        named=r"\frac{dn}{dx}",
        display=r"n \times (\kappa, 0, x)",
    )
    first, second, third = (Symbol(f"m_{k}") for k in (1, 2, 3))
    tilt = -kappa / r**2
    turning = {x: S.One, r: x / r, first: r * second - tilt * third, second: -r * first, third: tilt * first}
    squares = first**2 + second**2 + third**2
    spin = r * third + tilt * second + (second * turning[first] - first * turning[second]) / (1 + third)
    d.passage(
        r"Rotate the axes about the second axis until the third axis is along $(\kappa, 0, x)$. In the new axes the "
        r"angular velocity is $(0, \dot\phi, r)$ with $\dot\phi = -\kappa/r^2$, and $n$ becomes a vector $m$ near the "
        "third axis. Then rotate the axes by the smallest angle until the third axis is along $m$. These axes rotate "
        r"about $m$ only, at the rate $m \cdot \omega + (m_2 \dot m_1 - m_1 \dot m_2)/(1 + m_3)$."
    )
    d.notation({"m": Matrix([first, second, third]), "r": r}, turning)
    d.step(
        "This rate is $r$ plus the rate of a small angle.",
        spin,
        r + tilt * second / (1 + third),
        because="$m$ has length 1 and is fixed in space",
        relations=[squares - 1],
        named=r"m \cdot \omega + \frac{m_2 \dot m_1 - m_1 \dot m_2}{1 + m_3}",
        display=r"r + \frac{\dot\phi\,m_2}{1 + m_3}",
    )

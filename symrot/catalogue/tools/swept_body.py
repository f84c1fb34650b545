"""Formulas for a body swept through resonance: recurrences of series, and phases without cancellation.

Such a symmetric body is driven by a constant torque about its axis. The rotating axes rotate with its transverse
angular velocity, whose length W is constant; their third axis is the axis of the body. Their own angular velocity is
``(W, 0, Omega)`` along themselves, where the axial rate Omega grows linearly, at the sweep rate s. Resonance is the
time at which Omega is zero. The phase is the integral of ``sqrt(Omega^2 + W^2)``. Divided by sqrt(s), the angular
velocity is ``(kappa, 0, x)``, and its length is r; x is also the time after resonance in units of 1/sqrt(s).
"""

from sympy import Expr, Matrix, Rational, S, Symbol, sqrt

from symrot.catalogue.tools.elliptic import I, imaginary
from symrot.catalogue.tools.motion import rate
from symrot.catalogue.tools.power_series import coefficient, indexed
from symrot.proof.derivation import Derivation

__all__ = ["between", "far", "near", "weak"]

K = Symbol("k")
V, X, R, KAPPA = Symbol("v"), Symbol("x"), Symbol("r"), Symbol("kappa")


def far(d: Derivation) -> None:
    """Add steps to the derivation ``d``: recurrences for the power series that are used far from resonance.

    Far from resonance, the axial rate Omega is far from zero. The rotating axes then rotate about a vector that is
    fixed in space. Their angle of rotation about this vector is the phase, the integral of ``sqrt(Omega^2 + W^2)``,
    plus a small angle. Some of the series give this vector, the others the small angle.
    """
    d.section("The coefficients far from resonance")
    _vector(d)
    _small_angle(d)


def _vector(d: Derivation) -> None:
    a, b, c = (indexed(name, K) for name in "abc")
    d.passage(
        r"Let $a = \sum a_k v^k$, $b = \sum b_k v^k$ and $c = \sum c_k v^k$; coefficients with a negative index are "
        "zero. In each of the three equations for $a, b, c$ the coefficient of $v^k$ is zero. The following steps "
        "compute these coefficients."
    )
    d.step(
        "The first equation gives $c_k$ from $a_k$.",
        coefficient({"c": {0: S.One}, "a": {0: S.One, 1: 2 * V}}, V, K),
        c + (2 * K + 1) * a,
        because="the series is differentiated term by term",
        named=r"[v^k] \left( c + a + 2 v a' \right)",
    )
    older = indexed("a", K, -2)
    d.step(
        "The second equation for the series $a, b, c$ gives the difference of $b_k$ and $a_k$.",
        coefficient({"b": {0: S.One}, "a": {0: -S.One}, "c": {0: 3 * V**2, 1: 2 * V**3}}, V, K),
        b - a - (2 * K - 1) * (2 * K - 3) * older,
        because="the first equation gives $c_{k-2}$",
        relations=[indexed("c", K, -2) + (2 * K - 3) * older],
        named=r"[v^k] \left( b - a + v^2 (3 c + 2 v c') \right)",
    )
    d.step(
        "The third equation for the series $a, b, c$ gives $b_{k+1}$ from $b_k - a_k$. So the three equations give all "
        "coefficients one after another.",
        coefficient({"b": {1: 2 * (1 - KAPPA**2 * V), 0: -(KAPPA**2)}, "c": {0: -(KAPPA**2)}}, V, K),
        2 * (K + 1) * indexed("b", K, 1) - KAPPA**2 * (2 * K + 1) * (b - a),
        because="the first equation gives $c_k$",
        relations=[c + (2 * K + 1) * a],
        named=r"[v^k] \left( 2 (1 - \kappa^2 v) b' - \kappa^2 (b + c) \right)",
    )
    first, second, third = Symbol("a"), Symbol("b"), Symbol("c")
    slope = Symbol("c'")
    vector = Matrix([KAPPA / R * first, KAPPA / R**3 * third, X / R * second])
    turn = Matrix([[X / R, 0, -KAPPA / R], [0, 1, 0], [KAPPA / R, 0, X / R]])
    d.notation({"m": turn * vector})
    d.step(
        r"In axes whose third axis is along $(\kappa, 0, x)$, the vector $n$ is close to the third axis. Its first "
        r"component is $v^2 g$ times $\kappa x / r^2$, with $g = 3 c + 2 v c'$.",
        turn * vector,
        Matrix(
            [
                KAPPA * X / R**2 * (3 * third + 2 * slope / R**2) / R**4,
                KAPPA / R**3 * third,
                (KAPPA**2 * first + X**2 * second) / R**2,
            ]
        ),
        because="the second equation gives $b - a$",
        relations=[second - first + (3 * third + 2 * slope / R**2) / R**4],
        named="m",
    )
    d.step(
        "The coefficients of $g$ follow from those of $c$.",
        coefficient({"c": {0: S(3), 1: 2 * V}}, V, K),
        (2 * K + 3) * c,
        because="the series is differentiated term by term",
        named=r"g_k = [v^k] \left( 3 c + 2 v c' \right)",
    )


def _small_angle(d: Derivation) -> None:
    e, h, c, third = Symbol("e"), Symbol("h"), Symbol("c"), Symbol("m_3")
    moved, square = -2 * X / R**4, KAPPA**2
    v = 1 / R**2
    slope = square * (e - v * h) / (2 * (1 - square * v))
    motion = {X: S.One, R: X / R, e: moved * slope}
    d.passage(
        r"The small angle by which the rotation about $m$ exceeds the integral of $r$ has the rate $\dot\phi\,m_2/(1 + "
        r"m_3) = \kappa^2 h / r^5$ with $h = -c/(1 + m_3)$. Let $\delta = \frac{x}{r} e(v)$, where $e$ satisfies "
        r"$\kappa^2 e - 2 (1 - \kappa^2 v) e' = \kappa^2 v h$."
    )
    d.step(
        r"The function $\delta = \frac{x}{r} e(v)$ has the same derivative as the small angle by which the rotation "
        "about $m$ exceeds the integral of $r$, so it equals this angle up to a constant.",
        rate(X / R * e, motion).subs(h, -c / (1 + third)),
        -KAPPA / R**2 * (KAPPA / R**3 * c) / (1 + third),
        because=r"$\frac{d}{dx} \frac{x}{r} = \kappa^2 / r^3$, and $\dot v = -2 x v^2$",
        relations=[R**2 - X**2 - square],
        named=r"\frac{d\delta}{dx}",
    )
    d.step(
        "The coefficients of $e$ follow from those of $h$. The recurrence is used with rising $k$ from $e_0 = 0$ "
        "(then the angle is zero at infinity), or with falling $k$ (then it is zero at $x = 0$, since it is an odd "
        "function).",
        coefficient({"e": {0: square, 1: -2 * (1 - square * V)}, "h": {0: -square * V}}, V, K),
        (2 * K + 1) * square * indexed("e", K) - 2 * (K + 1) * indexed("e", K, 1) - square * indexed("h", K, -1),
        because="the series is differentiated term by term",
        named=r"[v^k] \left( \kappa^2 e - 2 (1 - \kappa^2 v) e' - \kappa^2 v h \right)",
    )


def near(d: Derivation) -> None:
    """Add steps to the derivation ``d``: Taylor series of the attitude, used near resonance, and a symmetry in time.

    Resonance is the time x = 0, at which the rate Omega is zero. If the quaternion is 1 at this time, the quaternions
    at times x and -x differ only in the signs of q1 and q2.
    """
    d.section("Near resonance")
    place, step = Symbol("X"), Symbol("u")
    names = r"\alpha", r"\beta"
    first = {names[0]: {1: S(2), 0: -I * (place + step)}, names[1]: {0: KAPPA}}
    second = {names[1]: {1: S(2), 0: I * (place + step)}, names[0]: {0: -KAPPA}}
    (a1, a, a0), (b1, b, b0) = ([indexed(name, K, shift) for shift in (1, 0, -1)] for name in names)
    d.passage(
        r"With $\dot\Omega^{-1/2}$ as the unit of time, the attitude satisfies $2 \alpha' = i x \alpha - \kappa \beta$ "
        r"and $2 \beta' = \kappa \alpha - i x \beta$. Near a time $X$ let $\alpha = \sum \alpha_k u^k$ and $\beta = "
        r"\sum \beta_k u^k$ with $u = x - X$."
    )
    d.step(
        "The coefficient of $u^k$ in both equations is zero. So each coefficient of the series follows from the two "
        "coefficients before it.",
        Matrix([coefficient(equation, step, K) for equation in (first, second)]),
        Matrix(
            [2 * (K + 1) * a1 - I * (place * a + a0) + KAPPA * b, 2 * (K + 1) * b1 + I * (place * b + b0) - KAPPA * a]
        ),
        because="$x = X + u$",
        named=r"[u^k] \begin{bmatrix} 2 \alpha' - i x \alpha + \kappa \beta \\ 2 \beta' - \kappa \alpha + i x \beta "
        r"\end{bmatrix}",
    )
    there, across = Symbol("alpha"), Symbol("beta")
    back = {
        X: S.One,
        there: -Rational(1, 2) * (-I * X * there - KAPPA * across),
        across: -Rational(1, 2) * (KAPPA * there + I * X * across),
    }
    pair = Matrix([there, -across])
    d.step(
        r"Before resonance, $\alpha(-x)$ and $-\beta(-x)$ satisfy the same equations as $\alpha(x)$ and $\beta(x)$. So "
        r"for the initial values $\alpha = 1$, $\beta = 0$ at $x = 0$, the attitudes at $x$ and $-x$ differ only in "
        "the sign of $q_1$ and $q_2$.",
        rate(pair, back),
        Rational(1, 2) * Matrix([I * X * pair[0] - KAPPA * pair[1], KAPPA * pair[0] - I * X * pair[1]]),
        because=r"$x$, $\frac{d}{dx}$ and $\beta$ change sign",
        relations=[imaginary()],
        named=r"\frac{d}{dx} \begin{bmatrix} \alpha(-x) \\ -\beta(-x) \end{bmatrix}",
    )


def weak(d: Derivation) -> None:
    """Add steps to the derivation ``d``: under a weak torque the phase, an angle in rad, is a power series in time.

    The phase is the integral of ``sqrt(Omega^2 + W^2)`` since the start, with the axial rate Omega, which grows
    linearly, and the constant transverse rate W. The torque is weak if it changes Omega by a small part of this root.
    """
    d.section("A weak torque")
    h, c = Symbol("h"), Symbol("c")
    f = sqrt(1 + 2 * c * h + h**2)
    start, speed, across, sweep, time = (Symbol(name) for name in ("Omega_0", "S_0", "W", "s", "t"))
    d.passage(
        r"If the sweep $s = \dot\Omega$ is small, the integral of $S = \sqrt{\Omega^2 + W^2}$ in closed form gives the "
        "phase since the start as a small difference of large numbers. Therefore a series is used. Let $S_0$ and "
        r"$\Omega_0$ be the initial values, $W$ the transverse rate, $c = \Omega_0/S_0$ and $h = s t / S_0$."
    )
    d.step(
        r"The rate of the phase is $S_0 f$ with $f = \sqrt{1 + 2 c h + h^2}$.",
        (speed**2 * f**2).subs({c: start / speed, h: sweep * time / speed}),
        (start + sweep * time) ** 2 + across**2,
        because=r"$\Omega = \Omega_0 + s t$, $S_0^2 = \Omega_0^2 + W^2$",
        relations=[speed**2 - start**2 - across**2],
        named="S_0^2 f^2",
    )
    d.notation({"f": f, "h": h, "c": c})
    d.step(
        "The function $f$ satisfies a linear differential equation of first order.",
        (1 + 2 * c * h + h**2) * f.diff(h),
        (c + h) * f,
        because="the square root is differentiated",
        named=r"(1 + 2 c h + h^2)\,\frac{df}{dh}",
        display="(c + h)\\,f",
    )
    above, now, before = (indexed("a", K, shift) for shift in (1, 0, -1))
    recurrence = (K + 1) * above - (1 - 2 * K) * c * now - (2 - K) * before
    d.step(
        r"Let $f = \sum a_k h^k$. The coefficient of $h^k$ in $(1 + 2 c h + h^2) f' - (c + h) f$ is zero. So with $a_0 "
        "= 1$ and $a_{-1} = 0$, each coefficient follows from the two coefficients before it.",
        coefficient({"f": {1: 1 + 2 * c * h + h**2, 0: -(c + h)}}, h, K).subs(
            {indexed("f", K, shift): indexed("a", K, shift) for shift in (1, 0, -1)}
        ),
        recurrence,
        because="the series is differentiated term by term",
        named=r"[h^k] \left( (1 + 2 c h + h^2) f' - (c + h) f \right)",
    )
    power = Symbol("h^k")
    d.step(
        r"The phase since the start is $S_0\,t \sum a_k h^k / (k + 1)$.",
        rate(time * power / (K + 1), {time: S.One, power: K * power / time}),
        power,
        because="$h$ is proportional to $t$, and the series is integrated term by term",
        named=r"\frac{d}{dt} \frac{t\,h^k}{k + 1}",
    )
    d.passage(
        "The error after a finite number of terms has a bound. Let $P_k$ be Legendre's polynomials of $-c$, with $(k "
        r"+ 1) P_{k+1} = -(2 k + 1) c P_k - k P_{k-1}$. Then $a_k = (P_{k-2} - P_k)/(2 k - 1)$ for $k \ge 2$, and so "
        r"$|a_k| \le 2/(2 k - 1)$, since $|c|$ is at most 1."
    )
    solution = _by_legendre(c)
    d.step(
        "These $a_k$ satisfy the recurrence.",
        recurrence.subs(solution),
        0,
        because="all Legendre polynomials in it follow from two neighbouring ones",
        named=r"(k + 1)\,a_{k+1} - (1 - 2 k)\,c\,a_k - (2 - k)\,a_{k-1}",
    )
    legendre, series = {0: S.One, 1: -c}, {-1: S.Zero, 0: S.One}
    for n in range(3):
        legendre[n + 1] = legendre.get(n + 1, (-(2 * n + 1) * c * legendre[n] - n * legendre.get(n - 1, 0)) / (n + 1))
        series[n + 1] = ((1 - 2 * n) * c * series[n] + (2 - n) * series[n - 1]) / (n + 1)
    d.step(
        "The formula with Legendre's polynomials also gives the coefficients $a_2$ and $a_3$ that follow from the "
        "recurrence.",
        Matrix([(legendre[n - 2] - legendre[n]) / (2 * n - 1) for n in (2, 3)]),
        Matrix([series[2], series[3]]).expand(),
        because="the first four Legendre polynomials of $-c$ are $1$, $-c$, $(3 c^2 - 1)/2$, $(3 c - 5 c^3)/2$",
        named=r"\begin{bmatrix} a_{2} \\ a_{3} \end{bmatrix}",
    )


def _by_legendre(c: Expr) -> dict[Symbol, Expr]:
    """Return formulas for the coefficients a_{k+1}, a_k and a_{k-1} of the power series of ``sqrt(1 + 2 c h + h^2)``.

    The series is in h; the formulas are in the Legendre polynomials P_k(-c) and P_{k-1}(-c).
    """
    # P_k and P_{k-1} at -c
    above, below = Symbol("P_{k}"), Symbol("P_{k-1}")
    p = {0: above, -1: below, 1: (-(2 * K + 1) * c * above - K * below) / (K + 1)}
    for i in (-2, -3):  # the recurrence for the next higher index, solved for the lowest coefficient
        p[i] = (-(2 * (K + i) + 3) * c * p[i + 1] - (K + i + 2) * p[i + 2]) / (K + i + 1)
    return {indexed("a", K, i): (p[i - 2] - p[i]) / (2 * (K + i) - 1) for i in (1, 0, -1)}


def between(d: Derivation) -> None:
    """Add steps to the derivation ``d``: a formula for the integral of ``sqrt(Omega^2 + W^2)`` between two times.

    Omega is the axial rate, which grows linearly, and W the constant transverse rate. The formula is a sum of two
    positive terms, so no digits cancel.
    """
    d.section("Between two times")
    omega, start, speed, there, across = (Symbol(name) for name in ("Omega", "Omega_0", "S", "S_0", "W"))
    together = there * speed + start * omega
    half = sqrt((across**2 + together) / 2)
    z, root = (omega - start) / (2 * half), (speed + there) / (2 * half)
    squares = [speed**2 - omega**2 - across**2, there**2 - start**2 - across**2]
    d.passage(
        r"Between the initial rate $\Omega_0$ and the rate $\Omega = \Omega_0 + s t$, the phase grows by $(\Omega S - "
        r"\Omega_0 S_0 + W^2 (Z - Z_0))/(2 s)$. Let $E = S_0 S + \Omega_0 \Omega$, $D^2 = (W^2 + E)/2$ and $z = s "
        "t/(2 D)$."
    )
    names = {"W": across, "S": speed, "S_0": there, r"\Omega": omega, r"\Omega_0": start}
    d.notation(names | {"E": together, "D": half, "z": z, "w": root})
    d.step(
        "The square root $w$ of $1 + z^2$ is $(S + S_0)/(2 D)$, which is positive.",
        1 + z**2,
        root**2,
        because=r"$S^2 = \Omega^2 + W^2$ and $S_0^2 = \Omega_0^2 + W^2$",
        relations=squares,
        named="1 + z^2",
        display=r"\left( \frac{S + S_0}{2 D} \right)^2",
    )
    d.step(
        r"So $Z - Z_0 = 2 \operatorname{arsinh} z$: both sides have the same hyperbolic sine, $(\Omega S_0 - \Omega_0 "
        "S)/W^2$.",
        2 * across**2 * z * root,
        omega * there - start * speed,
        because=r"$\sinh 2x = 2 \sinh x \cosh x$, and $\Omega / W = \sinh Z$, $S / W = \cosh Z$",
        relations=squares,
        named=r"2\,W^2\,z\,w",
    )
    d.step(
        r"The phase is $\frac{t}{2 D} \left( E\,w + W^2 \operatorname{arsinh}(z)/z \right)$. Both terms are positive, "
        "so no digits cancel.",
        together * z * root,
        (omega * speed - start * there) / 2,
        because="the same two relations are inserted, and $t / (2 D) = z / s$",
        relations=squares,
        named=r"E\,z\,w",
        display=r"\tfrac12 \left( \Omega S - \Omega_0 S_0 \right)",
    )

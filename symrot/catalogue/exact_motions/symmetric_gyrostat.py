"""A symmetric gyrostat: a body with a rotor along its axis (Hughes, Spacecraft Attitude Dynamics, chapter 6)."""

from sympy import Matrix, S, cos, diag, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_product, quaternion_rates, quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

A, _, C = symbols.principal
SPIN, ROTOR, T, H = symbols.omega_3, symbols.h_3, symbols.t, symbols.H
START = Matrix(symbols.quaternion)
AXIS = Matrix([0, 0, 1])
TENSOR = diag(A, A, C)


def derive() -> Derivation:
    d = Derivation(
        "symmetric_gyrostat",
        title="A symmetric body with a rotor along its axis",
        source="Hughes, *Spacecraft Attitude Dynamics*, section 6.2; Landau & Lifshitz, *Mechanics*, 3rd ed., section "
        "33, without the rotor",
        about=(
            "A rotor with a constant speed along the axis of a symmetric body changes only the rates of the regular "
            "precession. The attitude is the product of two steady rotations, one about an axis fixed in space and "
            "one about the symmetry axis. Without the rotor it is the attitude of the [free symmetric "
            "body](symmetric_top.md)."
        ),
    )
    momentum = TENSOR * OMEGA + Matrix([0, 0, ROTOR])
    own = SPIN - momentum[2] / A
    alpha_b = angular_acceleration(TENSOR, OMEGA, 0 * OMEGA, Matrix([0, 0, ROTOR]))
    d.passage(
        "The moments $A, A, C$ include the mass of the rotor. Relative to the body, the rotor has the angular "
        "momentum $h_3$ along axis 3. No torque acts on the body. The total angular momentum is",
        ("L", momentum),
    )
    d.notation({r"\omega": OMEGA, "e_3": AXIS, "R": Matrix(quaternion_to_dcm())})
    d.notation({r"\dot\omega_b": alpha_b})
    _body(d, alpha_b)
    d.section("Two steady rotations")
    d.step(
        r"The angular velocity is the sum of $L/A$ and a rotation about the symmetry axis at a constant rate $\nu$.",
        OMEGA,
        momentum / A + own * AXIS,
        because="the inertia tensor is $A$ times the unit matrix, except along axis 3",
        named=r"\omega",
        display=r"\frac{L}{A} + \nu\,e_3, \quad \nu = \frac{(A - C)\,\omega_3 - h_3}{A}",
    )
    along = attitude_rates() | pairs(symbols.omega_b, alpha_b)
    d.notation({"L": momentum}, along)
    d.step(
        "The angular momentum is fixed in space.",
        rate(Matrix(quaternion_to_dcm()) * momentum, along),
        0,
        because=r"$\dot L = L \times \omega$ in the body",
        relations=[unit_relation()],
        named=r"\frac{d}{dt} (R\,L)",
    )
    _attitude(d)
    _rotor(d, momentum, own)
    return d


def _body(d: Derivation, alpha_b: Matrix) -> None:
    d.section("In the body")
    turning = ((C - A) * SPIN + ROTOR) / A
    d.step(
        r"The spin $\omega_3$ is constant, and the transverse angular velocity rotates at a constant rate.",
        alpha_b,
        turning * Matrix([-symbols.omega_2, symbols.omega_1, 0]),
        because="the two equal moments cancel in the equation of axis 3, and the rotor lies along axis 3",
        named=r"\dot\omega_b",
    )
    rates = symbols.Omega, symbols.p
    angle = rates[1] * T
    first, second = symbols.omega_1, symbols.omega_2
    solution = Matrix([first * cos(angle) - second * sin(angle), first * sin(angle) + second * cos(angle), SPIN])
    acceleration = angular_acceleration(TENSOR, solution, 0 * solution, Matrix([0, 0, A * rates[1] - (C - A) * SPIN]))
    d.notation({"p": rates[1], r"\dot\omega_b": acceleration}, {T: S.One})
    d.step(
        r"With the initial values $\omega_1, \omega_2$ and $p = ((C - A)\,\omega_3 + h_3)/A$, the angular velocity at "
        "any time follows.",
        acceleration,
        solution.diff(T),
        because="the derivative of the sine is the cosine, and that of the cosine minus the sine",
        named=r"\dot\omega_b",
        display=r"\frac{d}{dt} \begin{bmatrix} \omega_1 \cos(p\,t) - \omega_2 \sin(p\,t) \\ \omega_1 \sin(p\,t) + "
        r"\omega_2 "
        r"\cos(p\,t) \\ \omega_3 \end{bmatrix}",
    )


def _attitude(d: Derivation) -> None:
    direction, half_h, half_nu = Matrix(symbols.axis), symbols.p * T, symbols.Omega * T
    about_momentum = Matrix([cos(half_h), *(sin(half_h) * direction)])
    about_axis = Matrix([cos(half_nu), 0, 0, sin(half_nu)])
    relations = [unit_relation(), squared(direction) - 1]
    attitude = Matrix(quaternion_product(about_momentum, START, about_axis))
    turned = Matrix(quaternion_to_dcm(Matrix(quaternion_product(START, about_axis)))).T * direction
    omega = 2 * symbols.p * turned + 2 * symbols.Omega * AXIS
    d.passage(
        "Let $n$ be the direction of the angular momentum in space and $H$ its length, $q$ the initial attitude, $p "
        r"= H/(2 A)$ and $\Omega = \nu/2$. Then the attitude at time $t$ is",
        (r"q(t)", r"(\cos(p\,t),\ n \sin(p\,t))\;q\;(\cos(\Omega t),\ e_3 \sin(\Omega t))"),
    )
    d.notation(
        {
            "q": START, "n": direction, "p": symbols.p, r"\Omega": symbols.Omega,
            "R(t)": Matrix(quaternion_to_dcm(attitude)), "R": quaternion_to_dcm, "n_b": turned, "q(t)": attitude,
        }
    )  # fmt: skip
    d.step(
        r"The attitude $q(t)$ satisfies the quaternion equation with the angular velocity $\frac{H}{A}\,n_b + "
        r"\nu\,e_3$, where $n_b$ is the direction $n$ in body components.",
        attitude.diff(T),
        quaternion_rates("body", attitude) * omega,
        because="a left factor of the quaternion rotates about an axis of space, a right factor about an "
        "axis of the body",
        relations=relations,
        named=r"\dot q(t)",
        display=r"\tfrac12\,q(t)\,(0,\ 2 p\,n_b + 2 \Omega\,e_3)",
    )
    d.step(
        "The rotation about $n$ does not change the body components of $n$.",
        Matrix(quaternion_to_dcm(attitude)).T * direction,
        turned,
        because="a rotation leaves its own axis fixed",
        relations=relations,
        named=r"R(t)^{\mathsf T} n",
        display=r"R\left( q\,(\cos(\Omega t),\ e_3 \sin(\Omega t)) \right)^{\mathsf T} n",
    )


def _rotor(d: Derivation, momentum: Matrix, own: object) -> None:
    d.section("Effect of the rotor")
    d.notation({r"\nu": own, "H": sqrt(squared(momentum))})
    d.step(
        r"If $h_3 = (A - C)\,\omega_3$, the body does not rotate about its axis relative to a frame that precesses "
        "with the axis. A dual-spin satellite uses this.",
        own.subs(ROTOR, (A - C) * SPIN),  # type: ignore[attr-defined]
        0,
        because=r"$\nu$ is substituted",
        named=r"\left. \nu \right|_{h_3 = (A - C)\,\omega_3}",
    )
    d.step(
        "The square of the precession rate is a sum of squares, one of which contains the rotor.",
        squared(momentum) / A**2,
        (A**2 * (symbols.omega_1**2 + symbols.omega_2**2) + (C * SPIN + ROTOR) ** 2) / A**2,
        because="the precession rate is $|L|/A$",
        named=r"\frac{H^2}{A^2}",
    )

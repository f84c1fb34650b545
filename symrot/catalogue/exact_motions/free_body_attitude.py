"""The attitude of a free body at any time (Whittaker, Analytical Dynamics, 4th ed., section 69; Jacobi 1849)."""

from sympy import Expr, Matrix, Rational, Symbol, cos, diag, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, derivatives, squares
from symrot.catalogue.tools.motion import pairs, rate, squared
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

A, B, C = symbols.principal
H, SIGN = symbols.H, symbols.sigma
T = Symbol("T", real=True)
"""Kinetic energy, J."""
MOMENTUM = Matrix(symbols.momentum_b)
L1, L2, L3 = symbols.momentum_b
ONE, TWO, THREE = symbols.momentum_amplitudes
PSI = symbols.psi
TENSOR = diag(A, B, C)
OMEGA = TENSOR.inv() * MOMENTUM
LENGTH = [squared(MOMENTUM) - H**2]
HALF = Rational(1, 2)


def derive() -> Derivation:
    d = Derivation(
        "free_body_attitude",
        title="The attitude of a free body",
        source="Whittaker, *Analytical Dynamics*, 4th ed., section 69; van Zon & Schofield, *J. Comput. Phys.* 225 "
        "(2007) 145",
        about=(
            "The angular momentum of a free body is fixed in space. Therefore two of the three angles of its attitude "
            "follow from its angular velocity. The third angle is a known function of time too: the argument of a "
            "theta function. The formulas hold for every body and for both kinds of polhode, whatever the order of "
            "the moments."
        ),
    )
    _two_rotations(d)
    _special(d)
    turning = _momentum(d)
    _third_kind(d, turning)
    _theta(d)
    return d


def smallest_rotation() -> Matrix:
    """Return the rotation by the smallest angle that takes the angular momentum to axis 3 of space."""
    return Matrix(
        [
            [1 - L1**2 / (H * (H + L3)), -L1 * L2 / (H * (H + L3)), -L1 / H],
            [-L1 * L2 / (H * (H + L3)), 1 - L2**2 / (H * (H + L3)), -L2 / H],
            [L1 / H, L2 / H, L3 / H],
        ]
    )


def rotation_rate() -> Expr:
    """Return the rate of the angle psi of the rotation about the angular momentum, rad/s.

    The attitude of a free body is a product of two rotations: the smallest rotation that takes the angular momentum to
    axis 3 of space (:func:`smallest_rotation`), followed by the rotation by psi about this axis.
    """
    return (2 * T + H * L3 / C) / (H + L3)


def _two_rotations(d: Derivation) -> None:
    d.section("Two rotations")
    d.passage(
        "Let axis 3 of space be along the angular momentum. The angular momentum has the length $H$ and the body "
        r"components $L_1, L_2, L_3$, with $\omega = I^{-1} L$ and moments $A, B, C$ in any order. The attitude is "
        r"the smallest rotation $P$ that takes $L$ to axis 3, followed by a rotation by $\psi$ about axis 3:",
        ("R", r"R_3(\psi)\,P"),
        ("P", smallest_rotation()),
    )
    smallest = smallest_rotation()
    about = Matrix([[cos(PSI), -sin(PSI), 0], [sin(PSI), cos(PSI), 0], [0, 0, 1]])
    along = pairs(symbols.momentum_b, MOMENTUM.cross(OMEGA))
    energy = MOMENTUM.dot(OMEGA) / 2
    speed = rotation_rate().subs(T, energy)
    d.notation(
        {"H": H, "L": MOMENTUM, r"\omega": OMEGA, "e_3": Matrix([0, 0, 1]), "P": smallest, "R": about * smallest}
        | {rf"\omega_{n + 1}": OMEGA[n] for n in range(3)}
        | {r"R_3(\psi)": about},
        along | {PSI: speed},
    )
    d.step(
        "The matrix $P$ is a rotation.",
        smallest * smallest.T,
        Matrix.eye(3),
        because=r"$L_1^2 + L_2^2 + L_3^2 = H^2$",
        relations=LENGTH,
        named=r"P\,P^{\mathsf T}",
    )
    d.step(
        "The rotation $P$ takes the angular momentum to axis 3. It is undefined only if $L$ is along $-e_3$; then "
        "another axis of the body is numbered 3.",
        smallest * MOMENTUM,
        H * Matrix([0, 0, 1]),
        because="the relation of the previous step is substituted",
        relations=LENGTH,
        named=r"P\,L",
        display=r"H\,e_3",
    )
    d.step(
        "In the body, the angular momentum satisfies Euler's equations, which preserve its length and the energy.",
        Matrix([rate(squared(MOMENTUM), along), rate(MOMENTUM.dot(OMEGA), along)]),
        0,
        because=r"$\dot L = L \times \omega$ is perpendicular to both $L$ and $\omega$",
        named=r"\frac{d}{dt} \begin{bmatrix} L \cdot L \\ L \cdot \omega \end{bmatrix}",
    )
    d.notation({"T": energy})
    d.passage(
        r"Let $T$ be the kinetic energy, and let the angle $\psi$ have the rate",
        (r"\dot\psi", r"\frac{2 T + H\,\omega_3}{H + L_3}"),
    )
    d.step(
        r"With $\dot\psi = (2 T + H\,\omega_3)/(H + L_3)$, the matrix $R = R_3(\psi)\,P$ satisfies the equation of the "
        "attitude, in all nine entries.",
        rate(about * smallest, along | {PSI: speed}),
        about * smallest * skew(OMEGA),
        because=r"$\dot L = L \times \omega$ for the components of $P$",
        relations=LENGTH,
        named=r"\frac{d}{dt} \left( R_3(\psi)\,P \right)",
        display=r"R\,[\omega]_\times",
    )
    d.notation({"T": T, r"\dot\psi": rotation_rate()})
    d.step(
        r"The rate of $\psi$ is the sum of a constant and a part that depends only on $L_3$.",
        rotation_rate(),
        H / C + (2 * T - H**2 / C) / (H + L3),
        because=r"$\omega_3 = L_3 / C$, and $\frac{H}{C} (H + L_3)$ is split off from the numerator",
        named=r"\dot\psi",
    )
    d.notation({r"\dot\psi": speed})
    polar = rate(L2, along) * L1 - rate(L1, along) * L2
    precession = H * (L1**2 / A + L2**2 / B) / (L1**2 + L2**2)
    d.step(
        r"The rate of $\psi$ is the rate of precession in the angles [ZXZ](free_asymmetric_body.md) minus the rate at "
        "which $(L_1, L_2)$ rotates in the body. Both of these rates are singular if $L$ is along axis 3; their "
        "difference is regular.",
        speed,
        precession - polar / (L1**2 + L2**2),
        because=r"$\dot L = L \times \omega$",
        relations=LENGTH,
        named=r"\dot\psi",
        display=r"H\,\frac{A\,\omega_1^2 + B\,\omega_2^2}{L_1^2 + L_2^2} - \frac{L_1 \dot L_2 - L_2 \dot L_1}"
        r"{L_1^2 + L_2^2}",
    )


def _momentum(d: Derivation) -> dict[str, Expr]:
    d.section("The angular momentum in the body")
    two = ONE * sqrt(B * (C - A) / (A * (C - B)))
    speed = SIGN * THREE * (C - B) / (B * C) * two / ONE
    parameter = SIGN * ONE * two * (B - A) / (A * B) / (speed * THREE)
    momentum = Matrix([ONE * CN, SIGN * two * SN, THREE * DN])
    d.passage(
        "Let axis 2 have the intermediate moment, and let axis 3 be the axis that the polhode encloses. Its moment "
        r"is either the largest ($\sigma = 1$) or the smallest ($\sigma = -1$). Then $(C - A)(C - B) > 0$ and $(B - "
        r"A)(C - B) \ge 0$. Let $L = (\ell_1, 0, \ell_3)$ at $t = 0$, and define",
        (r"\ell_2", two),
        ("p", r"\sigma\,\frac{C - B}{B C}\,\frac{\ell_2 \ell_3}{\ell_1}"),
        (r"\mu", r"\sigma\,\frac{B - A}{A B}\,\frac{\ell_1 \ell_2}{p\,\ell_3}"),
        ("L", r"\begin{bmatrix} \ell_1\,\mathrm{cn} \\ \sigma \ell_2\,\mathrm{sn} \\ \ell_3\,\mathrm{dn} "
              r"\end{bmatrix}"),
    )  # fmt: skip
    along = derivatives(speed, parameter)
    omega = TENSOR.inv() * momentum
    d.notation({r"\sigma": SIGN, "p": speed, r"\mu": parameter, "L": momentum, r"\omega": omega}, along)
    d.notation({r"\dot L": rate(momentum, along)})
    d.nonzero("The moments of axes 2 and 3 are different,", C - B, "C - B")
    d.nonzero("and so are the moments of axes 1 and 3,", C - A, "C - A")
    d.notation({"H": sqrt(ONE**2 + THREE**2), "T": momentum.dot(omega) / 2})
    d.step(
        r"The angular momentum $L$ with sn, cn and dn satisfies Euler's equations for both values of $\sigma$.",
        rate(momentum, along),
        momentum.cross(omega),
        because="the derivative of each elliptic function is a multiple of the product of the two other functions",
        relations=[SIGN**2 - 1],
        named=r"\dot L",
        display=r"L \times \omega",
    )
    d.step(
        "The length of the angular momentum is constant.",
        squared(momentum),
        ONE**2 + THREE**2,
        because=r"$\ell_2^2 = \ell_1^2 + \mu\,\ell_3^2$",
        relations=[SIGN**2 - 1, *squares(parameter)],
        named=r"H^2",
    )
    d.step(
        "The energy is constant.",
        momentum.dot(omega),
        ONE**2 / A + THREE**2 / C,
        because=r"$\frac{\ell_2^2}{B} = \frac{\ell_1^2}{A} + \mu\,\frac{\ell_3^2}{C}$",
        relations=[SIGN**2 - 1, *squares(parameter)],
        named=r"2 T",
    )
    d.notation({"T": (ONE**2 / A + THREE**2 / C) / 2})
    d.step(
        "The three amplitudes satisfy one relation.",
        two**2,
        ONE**2 + parameter * THREE**2,
        because=r"$\ell_2$, $p$ and $\mu$ are substituted",
        relations=[SIGN**2 - 1],
        named=r"\ell_2^2",
        display=r"\ell_1^2 + \mu\,\ell_3^2",
    )
    d.step(
        r"The parameter $\mu$ is 1 on the separatrix, where $H^2 = 2 T B$, and less than 1 elsewhere.",
        (1 - parameter) * THREE**2 * A * (C - B),
        C * A * (C - B) / C * THREE**2 - C * (B - A) * ONE**2,
        because="both sides of the equation are expanded",
        relations=[SIGN**2 - 1],
        named=r"(1 - \mu)\,A (C - B)\,\ell_3^2",
    )
    d.step(
        r"The numerator of $1 - \mu$ contains energy and angular momentum only.",
        A * (C - B) * THREE**2 - C * (B - A) * ONE**2,
        A * C * ((ONE**2 + THREE**2) - B * (ONE**2 / A + THREE**2 / C)),
        because="both sides of the equation are expanded",
        named=r"A (C - B)\,\ell_3^2 - C (B - A)\,\ell_1^2",
        display=r"A C \left( H^2 - 2 T B \right)",
    )
    return {"two": two, "speed": speed, "parameter": parameter}


def _third_kind(d: Derivation, constants: dict[str, Expr]) -> None:
    d.section("The third angle as an integral of the third kind")
    two, parameter = constants["two"], constants["parameter"]
    d.notation({"H": H, "T": (ONE**2 / A + THREE**2 / C) / 2, r"\ell_2": two})
    d.passage(
        r"The rate of $\psi$ depends on $L_3 = \ell_3\,\mathrm{dn}$ alone. If numerator and denominator are "
        r"multiplied by $H - \ell_3\,\mathrm{dn}$, the rate becomes a rational function of sn and dn."
    )
    d.step(
        "The denominator of the rate becomes:",
        (H - THREE * DN) * (H + THREE * DN),
        ONE**2 + parameter * THREE**2 * SN**2,
        because=r"$H^2 = \ell_1^2 + \ell_3^2$",
        relations=[SIGN**2 - 1, H**2 - ONE**2 - THREE**2, *squares(parameter)],
        named=r"(H - \ell_3\,\mathrm{dn})(H + \ell_3\,\mathrm{dn})",
        display=r"\ell_1^2 + \mu\,\ell_3^2\,\mathrm{sn}^2 = \ell_1^2\,\Delta, \quad \Delta = 1 + \mu\,"
        r"\frac{\ell_3^2}{\ell_1^2}\,\mathrm{sn}^2",
    )
    d.step(
        "The constant factor of the numerator is:",
        ONE**2 / A + THREE**2 / C - H**2 / C,
        SIGN * constants["speed"] * ONE * two / THREE,
        because=r"$p$ is substituted",
        relations=[SIGN**2 - 1, H**2 - ONE**2 - THREE**2],
        named=r"2 T - \frac{H^2}{C}",
        display=r"\sigma\,p\,\frac{\ell_1 \ell_2}{\ell_3}",
    )
    below = 1 + MU * THREE**2 / ONE**2 * SN**2
    d.notation({"p": symbols.p, r"\mu": MU, r"\ell_2": TWO, r"\Delta": below})
    energy = (SIGN * symbols.p * ONE * TWO / THREE + H**2 / C) / 2
    rate_of_turn = rotation_rate().subs({T: energy, L3: THREE * DN})
    d.notation({r"\dot\psi": rate_of_turn})
    d.step(
        r"Hence the rate of $\psi$, expressed with $\ell_2$ and $p$, is:",
        rate_of_turn,
        H / C + SIGN * symbols.p * TWO / (ONE * THREE) * (H - THREE * DN) / below,
        because="the two previous steps are substituted",
        relations=[H**2 - ONE**2 - THREE**2, *squares()],
        named=r"\dot\psi",
        display=r"\frac{H}{C} + \sigma\,p\,\frac{\ell_2}{\ell_1 \ell_3}\,\frac{H - \ell_3\,\mathrm{dn}}{\Delta}",
    )


def _theta(d: Derivation) -> None:
    d.section("The third angle without an integral")
    relations = [H**2 - ONE**2 - THREE**2, TWO**2 - ONE**2 - MU * THREE**2, *squares()]
    imag = -THREE / ONE, H / ONE, TWO / ONE  # sn/i, cn, dn at w
    d.passage(
        r"Let $N$ be the function whose logarithm has the derivative $Y = \tfrac12 Z + \tfrac{i}{2}\,\mathrm{dn}$, "
        "where $Z$ is the [zeta function](elliptic_functions_appendix.md). Up to an exponential factor, it is the "
        r"theta function $\theta_4$ of the squared nome, shifted by half its imaginary period: $N(u) = \theta_4\left( "
        r"\tfrac{\pi}{2 K} (u + i K');\ q^2 \right)$. Let $w$ be a point of the imaginary axis with the following "
        "values."
    )
    s, c, dn = imag
    d.step(
        r"At $w$, let $\mathrm{sn}_w = -i\,\ell_3 / \ell_1$, $\mathrm{cn}_w = H / \ell_1$ and $\mathrm{dn}_w = \ell_2 "
        r"/ \ell_1$. The three functions have these values at a point, since the values satisfy $\mathrm{cn}_w^2 + "
        r"\mathrm{sn}_w^2 = 1$ and $\mathrm{dn}_w^2 + \mu\,\mathrm{sn}_w^2 = 1$.",
        Matrix([c**2 - s**2, dn**2 - MU * s**2]),
        Matrix([1, 1]),
        because=r"$H^2 = \ell_1^2 + \ell_3^2$ and $\ell_2^2 = \ell_1^2 + \mu\,\ell_3^2$",
        relations=relations,
        named=r"\begin{bmatrix} \mathrm{cn}_w^2 + \mathrm{sn}_w^2 \\ \mathrm{dn}_w^2 + \mu\,\mathrm{sn}_w^2 "
        r"\end{bmatrix}",
    )
    # with sn_w = i s: mu sn_w cn_w dn_w sn^2 / below is i times a real term
    below = 1 + MU * s**2 * SN**2
    argument = HALF * (-2 * MU * s * c * dn * SN**2 / below) / 2 + HALF * (2 * DN * dn / below) / 2
    d.passage(
        r"For real $u$ the argument of $N(u + w)$ has the derivative $(Y(u + w) - \overline{Y(u + w)})/2i$ with "
        "respect to $u$. The complex conjugate is obtained by replacing $u + w$ by $u - w$ and $i$ by $-i$. By the "
        "addition theorems of [Z and dn](elliptic_functions_appendix.md), the derivative is the real constant "
        "$Z(w)/2i$ plus a function $f$ of sn and dn."
    )
    d.step(
        r"The function $f$ is a constant minus a constant multiple of the term of $\dot\psi$ that contains $\Delta$.",
        argument,
        H * TWO / (2 * ONE * THREE) - TWO / (2 * ONE * THREE) * (H - THREE * DN) / below,
        because=r"$\mathrm{sn}_w, \mathrm{cn}_w, \mathrm{dn}_w$ are substituted, and the polynomial division "
        r"is carried out",
        relations=relations,
        named=r"\frac{-\mu\,\mathrm{sn}_w \mathrm{cn}_w \mathrm{dn}_w\,\mathrm{sn}^2 / i + \mathrm{dn}\,\mathrm{dn}_w}"
        r"{2 \Delta}",
        display=r"\frac{H \ell_2}{2 \ell_1 \ell_3} - \frac{\ell_2}{2 \ell_1 \ell_3}\,\frac{H - \ell_3\,\mathrm{dn}}"
        r"{\Delta}",
    )
    d.step(
        r"So the rates of $\psi/2$ and $-\sigma \arg N(p\,t + w)$ differ only by a constant $\kappa$: $\psi/2 = "
        r"\kappa\,t - \sigma \arg N(p\,t + w)$. This formula gives the attitude at any time without an integral.",
        HALF * (H / C + SIGN * symbols.p * TWO / (ONE * THREE) * (H - THREE * DN) / below)
        + SIGN * symbols.p * argument,
        H / (2 * C) + SIGN * symbols.p * H * TWO / (2 * ONE * THREE),
        because="the fraction with dn occurs in both terms, with opposite signs",
        relations=relations,
        named=r"\tfrac12\,\dot\psi + \sigma\,p \left( \frac{d}{du} \arg N(u + w) - \frac{Z(w)}{2 i} \right)",
    )
    d.step(
        r"Up to a constant, $Y$ has the derivative $\tfrac12 \left( \mathrm{dn}^2 + i\,\mathrm{dn}' \right)$. The "
        r"product of $\mathrm{dn}^2 + i\,\mathrm{dn}'$ "
        r"and its conjugate $\mathrm{dn}^2 - i\,\mathrm{dn}'$ has degree two "
        "in dn. So at each pole of dn, one factor has a double pole and the other is finite. The zeros of $N$ are "
        "therefore at every second pole of dn along the imaginary axis. This is why the nome is squared.",
        DN**4 + rate(DN, derivatives()) ** 2,
        (2 - MU) * DN**2 - (1 - MU),
        because="the squares of sn and cn are replaced",
        relations=squares(),
        named=r"\left( \mathrm{dn}^2 + i\,\mathrm{dn}' \right) \left( \mathrm{dn}^2 - i\,\mathrm{dn}' \right)",
    )


def _special(d: Derivation) -> None:
    d.section("Equal moments")
    d.notation({"L_3": L3, "H": H})
    energy = MOMENTUM.dot(OMEGA) / 2
    speed = rotation_rate().subs(T, energy)
    d.notation({r"\dot\psi": speed, r"\dot L": MOMENTUM.cross(OMEGA)})
    d.step(
        r"If $B = A$, the third component of $L$ is constant, and $\psi$ grows at a constant rate. This is [regular "
        "precession](symmetric_top.md).",
        speed.subs(B, A),
        H / A + (1 / C - 1 / A) * L3,
        because=r"$L_1^2 + L_2^2 = H^2 - L_3^2$",
        relations=LENGTH,
        named=r"\left. \dot\psi \right|_{B = A}",
        display=r"\frac{H}{A} + \left( \frac{1}{C} - \frac{1}{A} \right) L_3",
    )
    d.step(
        "In the body, the angular momentum moves around axis 3 at a constant rate.",
        MOMENTUM.cross(OMEGA).subs(B, A),
        (1 / A - 1 / C) * L3 * Matrix([-L2, L1, 0]),
        because="the gyroscopic torque about axis 3 contains the difference of two equal moments",
        named=r"\left. \dot L \right|_{B = A}",
    )
    d.step(
        "If all three moments are equal, the angular momentum is fixed in the body, and the body rotates about it at "
        "the rate $H/A$.",
        Matrix([speed, *MOMENTUM.cross(OMEGA)]).subs({B: A, C: A}),
        Matrix([H / A, 0, 0, 0]),
        because="angular velocity and angular momentum are parallel",
        relations=LENGTH,
        named=r"\left. \begin{bmatrix} \dot\psi \\ \dot L \end{bmatrix} \right|_{A = B = C}",
    )
    d.passage(
        "On the separatrix, angular velocity and attitude are elementary functions of time: see [the "
        "separatrix](free_body_separatrix.md)."
    )

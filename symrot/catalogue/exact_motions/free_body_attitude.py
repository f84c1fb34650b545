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
            "Angular momentum is fixed in space. That gives two of the three angles of a free body from its angular "
            "velocity; the third is a known function of time too, the argument of a theta function. Every body, and "
            "both kinds of polhode: the moments need no order here."
        ),
    )
    _two_turns(d)
    turning = _momentum(d)
    _third_kind(d, turning)
    _theta(d)
    _special(d)
    return d


def smallest_turn() -> Matrix:
    """Return the rotation by the smallest angle that takes the angular momentum to axis 3 of space."""
    return Matrix(
        [
            [1 - L1**2 / (H * (H + L3)), -L1 * L2 / (H * (H + L3)), -L1 / H],
            [-L1 * L2 / (H * (H + L3)), 1 - L2**2 / (H * (H + L3)), -L2 / H],
            [L1 / H, L2 / H, L3 / H],
        ]
    )


def turning_rate() -> Expr:
    """Return the rate of rotation about the angular momentum, rad/s."""
    return (2 * T + H * L3 / C) / (H + L3)


def _two_turns(d: Derivation) -> None:
    d.section("Two turns")
    d.passage(
        r"Let axis 3 of space be along the angular momentum, of length $H$, with the components $L_1, L_2, L_3$ in the "
        r"body: $\omega = I^{-1} L$, the moments $A, B, C$ in any order. The attitude is taken apart into the smallest "
        r"turn $P$ that brings $L$ to axis 3, and a turn by $\psi$ about axis 3 after it:",
        ("R", r"R_3(\psi)\,P"),
        ("P", smallest_turn()),
    )
    smallest = smallest_turn()
    about = Matrix([[cos(PSI), -sin(PSI), 0], [sin(PSI), cos(PSI), 0], [0, 0, 1]])
    along = pairs(symbols.momentum_b, MOMENTUM.cross(OMEGA))
    energy = MOMENTUM.dot(OMEGA) / 2
    speed = turning_rate().subs(T, energy)
    d.notation(
        {"H": H, "L": MOMENTUM, r"\omega": OMEGA, "e_3": Matrix([0, 0, 1]), "P": smallest, "R": about * smallest}
        | {rf"\omega_{n + 1}": OMEGA[n] for n in range(3)}
        | {r"R_3(\psi)": about},
        along | {PSI: speed},
    )
    d.step(
        "The smallest turn is a rotation.",
        smallest * smallest.T,
        Matrix.eye(3),
        because=r"$L_1^2 + L_2^2 + L_3^2 = H^2$",
        relations=LENGTH,
        named=r"P\,P^{\mathsf T}",
    )
    d.step(
        "It brings the angular momentum to axis 3. It fails only where $L$ is along $-e_3$; then another axis of the "
        "body is called the third.",
        smallest * MOMENTUM,
        H * Matrix([0, 0, 1]),
        because="the relation of the previous step is substituted",
        relations=LENGTH,
        named=r"P\,L",
        display=r"H\,e_3",
    )
    d.step(
        "In the body the angular momentum moves by Euler's equations, which keep its length and the energy.",
        Matrix([rate(squared(MOMENTUM), along), rate(MOMENTUM.dot(OMEGA), along)]),
        0,
        because=r"$\dot L = L \times \omega$ is at right angles to both",
        named=r"\frac{d}{dt} \begin{bmatrix} L \cdot L \\ L \cdot \omega \end{bmatrix}",
    )
    d.notation({"T": energy})
    d.passage(
        "Let the turn have this rate, $T$ being the energy:",
        (r"\dot\psi", r"\frac{2 T + H\,\omega_3}{H + L_3}"),
    )
    d.step(
        r"Then the attitude obeys its equation, all nine entries.",
        rate(about * smallest, along | {PSI: speed}),
        about * smallest * skew(OMEGA),
        because=r"$\dot L = L \times \omega$ for the components of $P$",
        relations=LENGTH,
        named=r"\frac{d}{dt} \left( R_3(\psi)\,P \right)",
        display=r"R\,[\omega]_\times",
    )
    d.notation({"T": T, r"\dot\psi": turning_rate()})
    d.step(
        "In terms of the third component alone: a constant, and a part that depends on it.",
        turning_rate(),
        H / C + (2 * T - H**2 / C) / (H + L3),
        because=r"$\omega_3 = L_3 / C$, and the part $\frac{H}{C} (H + L_3)$ of the numerator is divided off",
        named=r"\dot\psi",
    )
    d.notation({r"\dot\psi": speed})
    polar = rate(L2, along) * L1 - rate(L1, along) * L2
    precession = H * (L1**2 / A + L2**2 / B) / (L1**2 + L2**2)
    d.step(
        r"It is the precession of [ZXZ](free_asymmetric_body.md) less the rate at which $(L_1, L_2)$ turns in the "
        "body, which is its precession and its spin together: regular where $L$ is along axis 3, as neither alone is.",
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
        r"Call axis 2 that of the intermediate moment and axis 3 the outer axis that the polhode goes round, be its "
        r"moment the largest, $\sigma = 1$, or the smallest, $\sigma = -1$. Then $(C - A)(C - B) > 0$ and "
        r"$(B - A)(C - B) \ge 0$. Time counts from where $L_2 = 0$, with $L = (\ell_1, 0, \ell_3)$. With",
        (r"\ell_2", two),
        ("p", r"\sigma\,\frac{C - B}{B C}\,\frac{\ell_2 \ell_3}{\ell_1}"),
        (r"\mu", r"\sigma\,\frac{B - A}{A B}\,\frac{\ell_1 \ell_2}{p\,\ell_3}"),
        ("L", r"\begin{bmatrix} \ell_1\,\mathrm{cn} \\ \sigma \ell_2\,\mathrm{sn} \\ \ell_3\,\mathrm{dn} "
              r"\end{bmatrix}"),
    )  # fmt: skip
    along = derivatives(speed, parameter)
    omega = TENSOR.inv() * momentum
    d.notation({r"\sigma": SIGN, "p": speed, r"\mu": parameter, "L": momentum, r"\omega": omega}, along)
    d.nonzero("The outer moments differ from the intermediate one,", C - B, "C - B")
    d.nonzero("and from each other,", C - A, "C - A")
    d.notation({"H": sqrt(ONE**2 + THREE**2), "T": momentum.dot(omega) / 2})
    d.step(
        "Euler's equations hold, about either outer axis.",
        rate(momentum, along),
        momentum.cross(omega),
        because="the derivative of each elliptic function is a multiple of the product of the two other functions",
        relations=[SIGN**2 - 1],
        named=r"\dot L",
        display=r"L \times \omega",
    )
    d.step(
        "The length of the angular momentum is kept.",
        squared(momentum),
        ONE**2 + THREE**2,
        because=r"$\ell_2^2 = \ell_1^2 + \mu\,\ell_3^2$",
        relations=[SIGN**2 - 1, *squares(parameter)],
        named=r"H^2",
    )
    d.step(
        "So is the energy.",
        momentum.dot(omega),
        ONE**2 / A + THREE**2 / C,
        because=r"$\frac{\ell_2^2}{B} = \frac{\ell_1^2}{A} + \mu\,\frac{\ell_3^2}{C}$",
        relations=[SIGN**2 - 1, *squares(parameter)],
        named=r"2 T",
    )
    d.notation({"T": (ONE**2 / A + THREE**2 / C) / 2})
    d.step(
        "The relation between the amplitudes.",
        two**2,
        ONE**2 + parameter * THREE**2,
        because=r"$\ell_2$, $p$ and $\mu$ are substituted",
        relations=[SIGN**2 - 1],
        named=r"\ell_2^2",
        display=r"\ell_1^2 + \mu\,\ell_3^2",
    )
    d.step(
        r"The parameter is 1 on the separatrix, where $H^2 = 2 T B$, and less elsewhere.",
        (1 - parameter) * THREE**2 * A * (C - B),
        C * A * (C - B) / C * THREE**2 - C * (B - A) * ONE**2,
        because="both sides of the equation are expanded",
        relations=[SIGN**2 - 1],
        named=r"(1 - \mu)\,A (C - B)\,\ell_3^2",
    )
    d.step(
        "The right side in terms of energy and angular momentum.",
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
        r"The turn $\psi$ grows at a rate that depends on $L_3 = \ell_3\,\mathrm{dn}$ alone. Made free of the sum in "
        "its denominator, it is a rational function of sn and dn."
    )
    d.step(
        "The factor below the line.",
        (H - THREE * DN) * (H + THREE * DN),
        ONE**2 + parameter * THREE**2 * SN**2,
        because=r"$H^2 = \ell_1^2 + \ell_3^2$",
        relations=[SIGN**2 - 1, H**2 - ONE**2 - THREE**2, *squares(parameter)],
        named=r"(H - \ell_3\,\mathrm{dn})(H + \ell_3\,\mathrm{dn})",
        display=r"\ell_1^2 + \mu\,\ell_3^2\,\mathrm{sn}^2 = \ell_1^2\,\Delta, \quad \Delta = 1 + \mu\,"
        r"\frac{\ell_3^2}{\ell_1^2}\,\mathrm{sn}^2",
    )
    d.step(
        "The factor above it.",
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
    rate_of_turn = turning_rate().subs({T: energy, L3: THREE * DN})
    d.notation({r"\dot\psi": rate_of_turn})
    d.step(
        r"Hence the rate, $\ell_2$ and $p$ kept as they are,",
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
        r"with "
        r"the [zeta function](elliptic_functions.md) $Z$; it is the theta function $\theta_4$ of the squared nome, "
        r"shifted by half of its imaginary period, $N(u) = \theta_4\left( \tfrac{\pi}{2 K} (u + i K');\ q^2 "
        r"\right)$ up to an exponential. And let $w$ be a point of the imaginary axis."
    )
    s, c, dn = imag
    d.step(
        r"There $\mathrm{sn}_w = -i\,\ell_3 / \ell_1$, $\mathrm{cn}_w = H / \ell_1$, $\mathrm{dn}_w = \ell_2 / "
        r"\ell_1$. "
        r"There "
        "is one: the three obey the two quadratic relations.",
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
        r"For real $u$ the argument of $N(u + w)$ turns, per unit of $u$, at $(Y(u + w) - \overline{Y(u + w)})/2i$, "
        r"where the conjugate has $u - w$ for $u + w$ and $-i$ for $i$. With the sums of "
        r"[Z and dn](elliptic_functions.md) this is $Z(w)/2i$, a real constant, and a function of sn and dn."
    )
    d.step(
        "That function is a constant less what the third angle asks for.",
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
        r"So $\psi/2$ and $-\sigma \arg N(p\,t + w)$ grow at rates that differ by a constant $\kappa$ only: "
        r"$\psi/2 = \kappa\,t - \sigma \arg N(p\,t + w)$. No integral is left, and the attitude at any time costs as "
        "much as at the next.",
        HALF * (H / C + SIGN * symbols.p * TWO / (ONE * THREE) * (H - THREE * DN) / below)
        + SIGN * symbols.p * argument,
        H / (2 * C) + SIGN * symbols.p * H * TWO / (2 * ONE * THREE),
        because="the fraction with dn occurs in both terms with opposite signs",
        relations=relations,
        named=r"\tfrac12\,\dot\psi + \sigma\,p \left( \frac{d}{du} \arg N(u + w) - \frac{Z(w)}{2 i} \right)",
    )
    d.step(
        r"Why the nome is squared: $Y$ changes at the rate $\tfrac12 \left( \mathrm{dn}^2 + i\,\mathrm{dn}' \right)$, "
        r"less a constant. With its conjugate it has a product of second degree in dn: where one has a double pole, "
        r"the "
        "other is finite. So the zeros of $N$ are at every second pole of dn along the imaginary axis.",
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
    speed = turning_rate().subs(T, energy)
    d.notation({r"\dot\psi": speed, r"\dot L": MOMENTUM.cross(OMEGA)})
    d.step(
        "With $B = A$ the third component is constant, and the third angle grows evenly: "
        "[regular precession](symmetric_top.md).",
        speed.subs(B, A),
        H / A + (1 / C - 1 / A) * L3,
        because=r"$L_1^2 + L_2^2 = H^2 - L_3^2$",
        relations=LENGTH,
        named=r"\left. \dot\psi \right|_{B = A}",
        display=r"\frac{H}{A} + \left( \frac{1}{C} - \frac{1}{A} \right) L_3",
    )
    d.step(
        "The angular momentum goes round the axis of the body at a constant rate.",
        MOMENTUM.cross(OMEGA).subs(B, A),
        (1 / A - 1 / C) * L3 * Matrix([-L2, L1, 0]),
        because="the gyroscopic torque about axis 3 contains the difference of two equal moments",
        named=r"\left. \dot L \right|_{B = A}",
    )
    d.step(
        "With all three equal it rests in the body, and the body turns about it at the rate $H/A$.",
        Matrix([speed, *MOMENTUM.cross(OMEGA)]).subs({B: A, C: A}),
        Matrix([H / A, 0, 0, 0]),
        because="angular velocity and angular momentum are parallel",
        relations=LENGTH,
        named=r"\left. \begin{bmatrix} \dot\psi \\ \dot L \end{bmatrix} \right|_{A = B = C}",
    )
    d.passage("On the separatrix all of this is elementary: see [the separatrix](free_body_separatrix.md).")

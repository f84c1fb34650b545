"""Jacobi's elliptic functions, defined by their derivatives: addition theorems, zeta and theta functions."""

from sympy import Matrix, Symbol, cos, diff, sech, sin, tanh

from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, W_VALUES, I, derivatives, imaginary, shifted, squares
from symrot.catalogue.tools.motion import rate
from symrot.proof.derivation import Derivation

SN_W, CN_W, DN_W = W_VALUES
BELOW = 1 - MU * SN**2 * SN_W**2
BOTH = [*squares(), *squares(fixed=True)]


def derive() -> Derivation:
    d = Derivation(
        "elliptic_functions",
        title="Jacobi's elliptic functions by their derivatives",
        source="Whittaker & Watson, *A Course of Modern Analysis*, 4th ed., chapters 21 and 22",
        about=(
            "What the exact motions of rigid bodies use of the elliptic functions, each from the one before: three "
            "derivatives, the addition theorems, the zeta function, and how the argument of a theta function turns. "
            "The derivatives are taken as the definition; nothing is taken from tables."
        ),
    )
    _definition(d)
    _sums(d)
    _zeta(d)
    _theta(d)
    _imaginary(d)
    _limits(d)
    return d


def _definition(d: Derivation) -> None:
    d.section("Definition")
    d.notation(
        {"u": Symbol("u"), r"\mathrm sn": SN, r"\mathrm cn": CN, r"\mathrm dn": DN, r"\mu": MU}
        | {"time": "u"}
        | {rf"\mathrm {name}_w": value for name, value in zip(("sn", "cn", "dn"), W_VALUES, strict=True)},
        derivatives(),
    )
    d.passage(
        r"The functions $\mathrm{sn}, \mathrm{cn}, \mathrm{dn}$ of $u$, with the parameter $\mu = k^2$, start at "
        "$0, 1, 1$ for $u = 0$, and obey",
        *((rf"\frac{{d}}{{du}}\,\mathrm{{{name}}}", value) for name, value in derivatives().items()),
    )
    d.step(
        "Two sums of squares are constant, hence what they are at the start: 1.",
        Matrix([rate(CN**2 + SN**2, derivatives()), rate(DN**2 + MU * SN**2, derivatives())]),
        0,
        because="the derivative of each function is a multiple of the other two, and the two terms cancel",
        named=r"\frac{d}{du} \begin{bmatrix} \mathrm{cn}^2 + \mathrm{sn}^2 \\ \mathrm{dn}^2 + \mu\,\mathrm{sn}^2 "
        r"\end{bmatrix}",
    )


def _sums(d: Derivation) -> None:
    d.section("Sums of arguments")
    s, c, dn = shifted()
    d.passage(
        r"Let $\mathrm{sn}_w, \mathrm{cn}_w, \mathrm{dn}_w$ be the values at a fixed $w$, real or not, and define",
        (r"S", s),
        (r"\hat C", c),
        (r"\hat D", dn),
    )
    along = derivatives()
    other = shifted(-1)
    for name, here, there in zip(("sn", "cn", "dn"), (s, c, dn), other, strict=True):
        d.notation({rf"\mathrm{{{name}}}(u + w)": here, rf"\mathrm{{{name}}}(u - w)": there, r"\Delta": BELOW})
    for claim, name, left, right, value in (
        ("They obey the same three equations in $u$. The first:", "S", s, c * dn, r"\hat C\,\hat D"),
        ("The second:", r"\hat C", c, -s * dn, r"-S\,\hat D"),
        ("The third:", r"\hat D", dn, -MU * s * c, r"-\mu\,S\,\hat C"),
    ):
        d.step(
            claim,
            rate(left, along),
            right,
            because=r"after the quotient rule, $\mathrm{cn}^2 = 1 - \mathrm{sn}^2$ and "
            r"$\mathrm{dn}^2 = 1 - \mu\,\mathrm{sn}^2$ remove the squares of cn and dn",
            relations=BOTH,
            named=rf"\frac{{d}}{{du}}\,{name}",
            display=value,
        )
    d.step(
        r"And they start at $\mathrm{sn}_w, \mathrm{cn}_w, \mathrm{dn}_w$. A system of differential equations has one "
        r"solution with a given start: $S, \hat C, \hat D$ are sn, cn, dn of $u + w$. These are the addition theorems.",
        Matrix([s, c, dn]).subs({SN: 0, CN: 1, DN: 1}),
        Matrix([SN_W, CN_W, DN_W]),
        because="at $u = 0$ sn is 0, and cn and dn are 1",
        named=r"\begin{bmatrix} S \\ \hat C \\ \hat D \end{bmatrix}_{u = 0}",
    )
    d.step(
        r"Of both signs of $w$ together, with $\Delta = 1 - \mu\,\mathrm{sn}_w^2\,\mathrm{sn}^2$:",
        Matrix([s + shifted(-1)[0], dn + shifted(-1)[2]]),
        Matrix([2 * SN * CN_W * DN_W, 2 * DN * DN_W]) / BELOW,
        because=r"sn is odd, cn and dn are even",
        named=r"\begin{bmatrix} \mathrm{sn}(u + w) + \mathrm{sn}(u - w) \\ \mathrm{dn}(u + w) + \mathrm{dn}(u - w) "
        r"\end{bmatrix}",
        display=r"\frac{2}{\Delta} \begin{bmatrix} \mathrm{sn}\,\mathrm{cn}_w\,\mathrm{dn}_w \\ "
        r"\mathrm{dn}\,\mathrm{dn}_w "
        r"\end{bmatrix}",
    )


def _zeta(d: Derivation) -> None:
    d.section("The zeta function")
    s, _, dn = shifted()
    along = derivatives()
    d.passage(
        r"Let $Z(u)$ be the odd function with $Z' = \mathrm{dn}^2 - e$, where the constant $e$ is the mean of "
        r"$\mathrm{dn}^2$, which makes it periodic; its value does not matter here."
    )
    d.step(
        r"Its addition theorem: the derivative of $Z(u + w) - Z(u)$ is that of $-\mu\,\mathrm{sn}_w\,\mathrm{sn}\,"
        r"\mathrm{sn}(u + w)$, and both are $Z(w)$ and $0$ at $u = 0$, hence $Z(u + w) = Z(u) + Z(w) - \mu\,"
        r"\mathrm{sn}_w\,\mathrm{sn}\,\mathrm{sn}(u + w)$.",
        dn**2 - DN**2,
        rate(-MU * SN_W * SN * s, along),
        because="the addition theorem of dn and the squares of cn and dn are substituted",
        relations=BOTH,
        named=r"\mathrm{dn}^2(u + w) - \mathrm{dn}^2",
        display=r"\frac{d}{du} \left( -\mu\,\mathrm{sn}_w\,\mathrm{sn}\,S \right)",
    )
    d.step(
        r"With both signs of $w$, of which $2 Z(w)$ is the constant part, $Z(u + w) - Z(u - w) - 2 Z(w)$ is this:",
        -MU * SN_W * SN * (s + shifted(-1)[0]),
        -2 * MU * SN_W * CN_W * DN_W * SN**2 / BELOW,
        because="the zeta function $Z$ is odd",
        named=r"-\mu\,\mathrm{sn}_w\,\mathrm{sn} \left( \mathrm{sn}(u + w) + \mathrm{sn}(u - w) \right)",
        display=r"-\frac{2 \mu\,\mathrm{sn}_w\,\mathrm{cn}_w\,\mathrm{dn}_w\,\mathrm{sn}^2}{\Delta}",
    )
    d.passage(
        r"Its integral over $u$ is what is called an integral of the third kind. An angle that grows at such a rate "
        "is the argument of a theta function, as the next section shows: no integral is left."
    )


def _theta(d: Derivation) -> None:
    d.section("Theta functions")
    along = derivatives()
    d.passage(
        r"Jacobi's function $\Theta$ is that whose logarithm has the derivative $Z$: $\Theta' = Z\,\Theta$. It is "
        r"taken "
        r"here by this equation; that it is the series $1 + 2 \sum (-1)^n q^{n^2} \cos(n \pi u / K)$ is Jacobi's "
        r"theorem, "
        "and is used by the numeric code, not by the proofs."
    )
    d.step(
        r"The function $\mathrm{H} = \Theta\,\mathrm{sn}$ has the logarithmic derivative $Z + "
        r"\mathrm{cn}\,\mathrm{dn} / "
        r"\mathrm{sn}$, which changes at the rate of $Z$ shifted by a half period: $\mathrm{ns}^2$ takes the place of "
        r"$\mu\,\mathrm{sn}^2$.",
        DN**2 + rate(CN * DN / SN, along),
        1 - 1 / SN**2,
        because=r"$\mathrm{dn}^2 = 1 - \mu\,\mathrm{sn}^2$",
        relations=squares(),
        named=r"\mathrm{dn}^2 + \frac{d}{du}\,\frac{\mathrm{cn}\,\mathrm{dn}}{\mathrm{sn}}",
    )
    d.passage(
        r"For $w$ on the imaginary axis $\Theta(u - w)$ is the complex conjugate of $\Theta(u + w)$. The argument of "
        r"$\Theta(u + w)$ therefore turns at half of $(Z(u + w) - Z(u - w))/i$ per unit of $u$: a constant, and a "
        "multiple of an integrand of the third kind.",
    )


def _imaginary(d: Derivation) -> None:
    d.section("On the imaginary axis")
    complement = 1 - MU
    along = derivatives(parameter=complement)
    relations = [*squares(complement), imaginary()]
    values = Matrix([I * SN / CN, 1 / CN, DN / CN])
    d.passage(
        r"Let now sn, cn, dn belong to the argument $a$ and to the parameter $1 - \mu$. Jacobi's imaginary "
        r"transformation is that at $i a$, for the parameter $\mu$, the functions are",
        (r"\begin{bmatrix} \mathrm{sn}_w \\ \mathrm{cn}_w \\ \mathrm{dn}_w \end{bmatrix}_{w = i a}", values),
    )
    d.notation({rf"\mathrm{{{name}}}_w": value for name, value in zip(("sn", "cn", "dn"), values, strict=True)})
    d.notation({"i": I, "time": "a"}, along)
    d.step(
        r"They obey the three equations, multiplied by $i$ for $d/da$, and start at $0, 1, 1$.",
        Matrix([rate(value, along) for value in values]),
        I * Matrix([values[1] * values[2], -values[0] * values[2], -MU * values[0] * values[1]]),
        because=r"$\mathrm{dn}^2 - \mathrm{cn}^2 = \mu\,\mathrm{sn}^2$ for the parameter $1 - \mu$",
        relations=relations,
        named=r"\frac{d}{da} \begin{bmatrix} \mathrm{sn}_w \\ \mathrm{cn}_w \\ \mathrm{dn}_w \end{bmatrix}",
        display=r"i \begin{bmatrix} \mathrm{cn}_w\,\mathrm{dn}_w \\ -\mathrm{sn}_w\,\mathrm{dn}_w \\ "
        r"-\mu\,\mathrm{sn}_w\,\mathrm{cn}_w \end{bmatrix}",
    )
    d.passage(r"So $\mathrm{sn}_w$ is imaginary there, $\mathrm{cn}_w$ and $\mathrm{dn}_w$ are real and at least 1.")


def _limits(d: Derivation) -> None:
    d.section("Where they are elementary")
    u = Symbol("u")
    for claim, parameter, functions, why in (
        (
            r"At $\mu = 0$ they are a sine, a cosine and 1.",
            0,
            (sin(u), cos(u), u / u),
            "these start and change as they must",
        ),
        (
            r"At $\mu = 1$ they are $\tanh$, $\mathrm{sech}$ and $\mathrm{sech}$ again: they do not return.",
            1,
            (tanh(u), sech(u), sech(u)),
            r"$\tanh' = 1 - \tanh^2 = \mathrm{sech}^2$",
        ),
    ):
        values = Matrix(functions)
        s, c, dn = values
        d.step(
            claim,
            diff(values, u),
            Matrix([c * dn, -s * dn, -parameter * s * c]),
            because=why,
            relations=[tanh(u) ** 2 + sech(u) ** 2 - 1] if parameter else (),
            named=rf"\frac{{d}}{{du}} {_latex(values)}",
        )


def _latex(value: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(value)

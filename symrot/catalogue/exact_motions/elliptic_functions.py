"""Jacobi's elliptic functions, defined by their derivatives: addition theorems, zeta and theta functions."""

from sympy import Matrix, S, Symbol, cos, diff, sech, sin, tanh

from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, W_VALUES, I, derivatives, imaginary, shifted, squares
from symrot.catalogue.tools.motion import rate
from symrot.proof.derivation import Derivation
from symrot.proof.notation.printer import formula

SN_W, CN_W, DN_W = W_VALUES
BELOW = 1 - MU * SN**2 * SN_W**2
BOTH = [*squares(), *squares(fixed=True)]


def derive() -> Derivation:
    d = Derivation(
        "elliptic_functions",
        title="Jacobi's elliptic functions by their derivatives",
        source="Whittaker & Watson, *A Course of Modern Analysis*, 4th ed., chapters 21 and 22",
        about=(
            "The elliptic functions sn, cn and dn are defined by their derivatives. The exact motions of rigid bodies "
            "need the properties of these functions that are proven here; each property follows from the properties "
            "before it, without tables."
        ),
    )
    _definition(d)
    _limits(d)
    _sums(d)
    _zeta(d)
    _theta(d)
    _imaginary(d)
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
        r"The functions $\mathrm{sn}, \mathrm{cn}, \mathrm{dn}$ of $u$ with the parameter $\mu = k^2$ have the values "
        "$0, 1, 1$ at $u = 0$ and the derivatives",
        *((rf"\frac{{d}}{{du}}\,\mathrm{{{name}}}", value) for name, value in derivatives().items()),
    )
    d.step(
        r"Two sums of squares, $\mathrm{cn}^2 + \mathrm{sn}^2$ and $\mathrm{dn}^2 + \mu\,\mathrm{sn}^2$, are constant. "
        "They keep the value 1 that they have at $u = 0$.",
        Matrix([rate(CN**2 + SN**2, derivatives()), rate(DN**2 + MU * SN**2, derivatives())]),
        0,
        because="the derivative of each function is a multiple of the product of the other two, and the two terms of "
        "each sum cancel",
        named=r"\frac{d}{du} \begin{bmatrix} \mathrm{cn}^2 + \mathrm{sn}^2 \\ \mathrm{dn}^2 + \mu\,\mathrm{sn}^2 "
        r"\end{bmatrix}",
    )


def _sums(d: Derivation) -> None:
    d.section("Sums of arguments")
    s, c, dn = shifted()
    d.passage(
        r"Let $\mathrm{sn}_w, \mathrm{cn}_w, \mathrm{dn}_w$ be the values at a fixed real or complex $w$, and define",
        (r"S", s),
        (r"\hat C", c),
        (r"\hat D", dn),
    )
    along = derivatives()
    other = shifted(-1)
    for name, here, there in zip(("sn", "cn", "dn"), (s, c, dn), other, strict=True):
        d.notation({rf"\mathrm{{{name}}}(u + w)": here, rf"\mathrm{{{name}}}(u - w)": there, r"\Delta": BELOW})
    for claim, name, left, right, value in (
        (
            r"The functions $S$, $\hat C$ and $\hat D$ have the same derivatives with respect to $u$ as sn, cn and "
            "dn. The derivative of $S$ is:",
            "S",
            s,
            c * dn,
            r"\hat C\,\hat D",
        ),
        (r"The derivative of $\hat C$ is:", r"\hat C", c, -s * dn, r"-S\,\hat D"),
        (r"The derivative of $\hat D$ is:", r"\hat D", dn, -MU * s * c, r"-\mu\,S\,\hat C"),
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
        r"At $u = 0$ the three functions have the values $\mathrm{sn}_w, \mathrm{cn}_w, \mathrm{dn}_w$. A system of "
        r"differential equations has only one solution with given initial values, so $S, \hat C, \hat D$ are sn, cn, "
        "dn of $u + w$. These are the addition theorems.",
        Matrix([s, c, dn]).subs({SN: 0, CN: 1, DN: 1}),
        Matrix([SN_W, CN_W, DN_W]),
        because="at $u = 0$ sn is 0, and cn and dn are 1",
        named=r"\begin{bmatrix} S \\ \hat C \\ \hat D \end{bmatrix}_{u = 0}",
    )
    d.step(
        r"The values of sn at $u + w$ and $u - w$ have a simple sum, and the values of dn too, with $\Delta = 1 "
        r"- \mu\,\mathrm{sn}_w^2\,\mathrm{sn}^2$:",
        Matrix([s + shifted(-1)[0], dn + shifted(-1)[2]]),
        Matrix([2 * SN * CN_W * DN_W, 2 * DN * DN_W]) / BELOW,
        because="sn is odd, and cn and dn are even",
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
        r"Let $Z(u)$ be the odd function with $Z' = \mathrm{dn}^2 - e$. The constant $e$ is the mean of "
        r"$\mathrm{dn}^2$, so that $Z$ is periodic; the proofs on this page hold for any constant $e$."
    )
    d.step(
        "The zeta function has the addition theorem $Z(u + w) = Z(u) + Z(w) - "
        r"\mu\,\mathrm{sn}_w\,\mathrm{sn}\,\mathrm{sn}(u + w)$: both sides agree at $u = 0$, and they have the same "
        "derivative.",
        dn**2 - DN**2,
        rate(-MU * SN_W * SN * s, along),
        because="the addition theorem of dn and the squares of cn and dn are substituted",
        relations=BOTH,
        named=r"\mathrm{dn}^2(u + w) - \mathrm{dn}^2",
        display=r"\frac{d}{du} \left( -\mu\,\mathrm{sn}_w\,\mathrm{sn}\,S \right)",
    )
    d.step(
        "For $w$ and $-w$ together, the addition theorem gives $Z(u + w) - Z(u - w) - 2 Z(w)$ as:",
        -MU * SN_W * SN * (s + shifted(-1)[0]),
        -2 * MU * SN_W * CN_W * DN_W * SN**2 / BELOW,
        because=r"the zeta function $Z$ is odd, and the sum of $\mathrm{sn}(u + w)$ and $\mathrm{sn}(u - w)$ is "
        "inserted",
        named=r"-\mu\,\mathrm{sn}_w\,\mathrm{sn} \left( \mathrm{sn}(u + w) + \mathrm{sn}(u - w) \right)",
        display=r"-\frac{2 \mu\,\mathrm{sn}_w\,\mathrm{cn}_w\,\mathrm{dn}_w\,\mathrm{sn}^2}{\Delta}",
    )
    d.passage(
        "The integral of $Z(u + w) - Z(u - w) - 2 Z(w)$ over $u$ is called an elliptic integral of the third kind. The "
        "next section shows that an angle whose rate contains the integrand is the argument of a theta function, so "
        "the integral need not be computed."
    )


def _theta(d: Derivation) -> None:
    d.section("Theta functions")
    along = derivatives()
    d.passage(
        r"Jacobi's function $\Theta$ is defined here by its logarithmic derivative $Z$, that is by $\Theta' = "
        r"Z\,\Theta$. Jacobi's theorem says that it is the series $1 + 2 \sum (-1)^n q^{n^2} \cos(n \pi u / K)$; the "
        "numeric code uses this theorem, the proofs do not."
    )
    d.step(
        r"The function $\mathrm{H} = \Theta\,\mathrm{sn}$ has the logarithmic derivative $Z + "
        r"\mathrm{cn}\,\mathrm{dn} / \mathrm{sn}$. The derivative of this sum is $c - 1/\mathrm{sn}^2$; the "
        r"derivative of $Z$ is $c - \mu\,\mathrm{sn}^2$ with the same constant $c$. A shift of $u$ by half a period, "
        r"$i K'$, turns $\mu\,\mathrm{sn}^2$ into $1/\mathrm{sn}^2$.",
        DN**2 + rate(CN * DN / SN, along),
        1 - 1 / SN**2,
        because=r"$\mathrm{dn}^2 = 1 - \mu\,\mathrm{sn}^2$",
        relations=squares(),
        named=r"\mathrm{dn}^2 + \frac{d}{du}\,\frac{\mathrm{cn}\,\mathrm{dn}}{\mathrm{sn}}",
    )
    d.passage(
        r"For imaginary $w$, $\Theta(u - w)$ is the complex conjugate of $\Theta(u + w)$. The argument of $\Theta(u + "
        "w)$ therefore has the derivative $(Z(u + w) - Z(u - w))/2i$ with respect to $u$: a constant plus a multiple "
        "of the integrand of the third kind.",
    )


def _imaginary(d: Derivation) -> None:
    d.section("Imaginary arguments")
    complement = 1 - MU
    along = derivatives(parameter=complement)
    relations = [*squares(complement), imaginary()]
    values = Matrix([I * SN / CN, 1 / CN, DN / CN])
    d.passage(
        r"From here on, sn, cn, dn have the argument $a$ and the parameter $1 - \mu$. Jacobi's imaginary "
        r"transformation gives the functions with the parameter $\mu$ at the argument $i a$:",
        (r"\begin{bmatrix} \mathrm{sn}_w \\ \mathrm{cn}_w \\ \mathrm{dn}_w \end{bmatrix}_{w = i a}", values),
    )
    d.notation({rf"\mathrm{{{name}}}_w": value for name, value in zip(("sn", "cn", "dn"), values, strict=True)})
    d.notation({"i": I, "time": "a"}, along)
    d.step(
        "At the argument $i a$, the three functions satisfy the defining equations, with the factor $i$ because the "
        "derivative is taken with respect to $a$. At $a = 0$ they have the values $0, 1, 1$.",
        Matrix([rate(value, along) for value in values]),
        I * Matrix([values[1] * values[2], -values[0] * values[2], -MU * values[0] * values[1]]),
        because=r"$\mathrm{dn}^2 - \mathrm{cn}^2 = \mu\,\mathrm{sn}^2$ for the parameter $1 - \mu$",
        relations=relations,
        named=r"\frac{d}{da} \begin{bmatrix} \mathrm{sn}_w \\ \mathrm{cn}_w \\ \mathrm{dn}_w \end{bmatrix}",
        display=r"i \begin{bmatrix} \mathrm{cn}_w\,\mathrm{dn}_w \\ -\mathrm{sn}_w\,\mathrm{dn}_w \\ "
        r"-\mu\,\mathrm{sn}_w\,\mathrm{cn}_w \end{bmatrix}",
    )
    d.passage(
        r"So for imaginary $w$, $\mathrm{sn}_w$ is imaginary, and $\mathrm{cn}_w$ and $\mathrm{dn}_w$ are real "
        "and at least 1 in absolute value."
    )


def _limits(d: Derivation) -> None:
    d.section("Parameters with elementary functions")
    u = Symbol("u")
    d.notation({"u": u}, {u: S.One})
    for claim, parameter, functions, why in (
        (
            r"At $\mu = 0$ the functions sn, cn, dn are sine, cosine and 1.",
            0,
            (sin(u), cos(u), u / u),
            "these functions have the right derivatives and initial values",
        ),
        (
            r"At $\mu = 1$ the functions sn, cn, dn are $\tanh$, $\mathrm{sech}$ and $\mathrm{sech}$, which are not "
            "periodic.",
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
            named=rf"\frac{{d}}{{du}} {formula(values)}",
        )

"""Stability of rotation about the principal axes (Landau & Lifshitz, Mechanics, 3rd ed., section 37)."""

from sympy import diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA
from symrot.dynamics.equations import angular_acceleration
from symrot.proof.derivation import Derivation

NAMES = ("largest", "intermediate", "smallest")


def derive() -> Derivation:
    d = Derivation(
        "intermediate_axis",
        title="The intermediate axis is unstable",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 37",
        about=(
            r"A free body can rotate steadily about any principal axis, at the rate $\Omega$. A small disturbance "
            "stays small if the axis has the largest or the smallest moment, and grows exponentially if it has the "
            "intermediate moment."
        ),
    )
    smallest, (first, second) = symbols.C, symbols.excess
    a, b, c = symbols.principal
    alpha_b = angular_acceleration(diag(a, b, c), OMEGA, 0 * OMEGA)
    ordered = {b: smallest + first, a: smallest + first + second}
    d.passage(
        r"The moments are in the order $A > B > C$, with positive differences $\delta_1$ and $\delta_2$:",
        (b, ordered[b]),
        (a, ordered[a]),
    )
    growth = []
    for number, name in enumerate(NAMES):
        steady = {omega: symbols.Omega if i == number else 0 for i, omega in enumerate(OMEGA)}
        others = [i for i in range(3) if i != number]
        linear = alpha_b.jacobian(OMEGA).subs(steady)[others, others]
        moment, (low, high) = (a, b, c)[number], ((a, b, c)[i] for i in others)
        squared_rate = (moment - low) * (high - moment) / (low * high) * symbols.Omega**2
        growth.append(squared_rate)
        d.step(
            f"For rotation about axis {number + 1} (the {name} moment), a small disturbance perpendicular to the "
            r"axis obeys $\ddot x = \lambda^2 x$.",
            linear**2,
            diag(squared_rate, squared_rate),
            because="to first order the rate of each of the two disturbed components is a constant times the other "
            "component, so the second derivative of each is a constant times the component itself",
            named=r"\left( \partial \dot\omega / \partial \omega \right)^2 = \lambda^2\,\mathbf{1}, \quad \lambda^2",
            display=squared_rate,
        )
    d.section("The sign of the squared rate")
    verdicts = (
        (0, -1, "about the axis of the largest moment, a disturbance oscillates and stays small"),
        (1, 1, "about the intermediate axis, a disturbance grows"),
        (2, -1, "about the axis of the smallest moment, a disturbance oscillates and stays small"),
    )
    for number, sign, sentence in verdicts:
        d.positive(
            f"{sentence[0].upper()}{sentence[1:]}.",
            sign * growth[number].subs(ordered),
            because="the moment is between the other two, so both differences have the same sign"
            if sign > 0
            else "the moment is the largest or the smallest, so the two differences have opposite signs",
            named=r"\lambda^2" if sign > 0 else r"-\lambda^2",
        )
    d.passage(
        r"The growth rate is $\lambda = \Omega \sqrt{(A - B)(B - C) / (A C)}$. A body thrown like a tennis racket "
        r"flips over after a few times $1/\lambda$."
    )
    return d

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
            r"A free body turns steadily about any principal axis, at the rate $\Omega$. A small disturbance "
            r"stays small "
            "about the axes of the largest and the smallest moment, and grows exponentially about the intermediate one."
        ),
    )
    smallest, (first, second) = symbols.C, symbols.excess
    a, b, c = symbols.principal
    alpha_b = angular_acceleration(diag(a, b, c), OMEGA, 0 * OMEGA)
    ordered = {b: smallest + first, a: smallest + first + second}
    d.passage(
        r"Moments in order, $A > B > C$, with positive differences:",
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
            f"Axis {number + 1}, the {name} moment: a small disturbance across the axis obeys "
            r"$\ddot x = \lambda^2 x$.",
            linear**2,
            diag(squared_rate, squared_rate),
            because="to first order each of the two disturbances drives the other, so that the equations, "
            "applied twice, give each of them back, times a constant",
            named=r"\left( \partial \dot\omega / \partial \omega \right)^2 = \lambda^2\,\mathbf{1}, \quad \lambda^2",
            display=squared_rate,
        )
    d.section("Signs")
    verdicts = (
        (0, -1, "about the axis of the largest moment a disturbance swings and stays small"),
        (1, 1, "about the intermediate axis it grows"),
        (2, -1, "about the axis of the smallest moment it swings and stays small"),
    )
    for number, sign, sentence in verdicts:
        d.positive(
            f"{sentence[0].upper()}{sentence[1:]}.",
            sign * growth[number].subs(ordered),
            because="the moment lies between the other two, so that both differences have the same sign"
            if sign > 0
            else "the moment is the largest or the smallest, so that the two differences have opposite signs",
            named=r"\lambda^2" if sign > 0 else r"-\lambda^2",
        )
    d.passage(
        r"The rate of growth is $\lambda = \Omega \sqrt{(A - B)(B - C) / (A C)}$: a body thrown like a "
        r"tennis racket turns "
        r"over after a few times $1/\lambda$."
    )
    return d

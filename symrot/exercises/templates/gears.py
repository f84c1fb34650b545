"""Exercises on gears: rates in planetary gears, and torques."""

from collections.abc import Mapping
from random import Random

from sympy import Expr, Symbol, solve

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.symbols import Z_P, Z_R, Z_S, omega_C, omega_P, omega_R, omega_S, tau_1

SUN = quantity(Z_S, "12 15 18 20 24 30", "", "teeth of the sun")
RING = quantity(Z_R, "48 60 72 80 90", "", "teeth of the ring")
PLANET = quantity(Z_P, "12 15 18 20 24", "", "teeth of the planet")
SPEED = "300 600 900 1200 1500 1800"
TRAIN = (
    r"A planetary train has a sun with $Z_S$ teeth and a ring with $Z_R$ teeth. Their rates are $\omega_S$ and "
    r"$\omega_R$; the carrier has the rate $\omega_C$."
)
LAW = (
    "Relative to the carrier, teeth in contact have equal speeds: "
    r"$Z_S(\omega_S - \omega_C) = -Z_R(\omega_R - \omega_C)$."
)
CONTACT = r"Z_S(\omega_S - \omega_C) + Z_R(\omega_R - \omega_C)"


def _contact() -> Expr:
    """Return an expression in the rates of sun, ring and carrier; it is zero if teeth in contact have equal velocities.

    The rate of the planet is eliminated.
    """
    planet = solve(Z_S * (omega_S - omega_C) + Z_P * (omega_P - omega_C), omega_P)[0]
    return (Z_P * (planet - omega_C) - Z_R * (omega_R - omega_C)).expand()


def _can_be_built(values: Mapping[Symbol, Expr]) -> bool:
    """Return whether planets fit between sun and ring: their number of teeth, (Z_R - Z_S)/2, is whole and positive."""
    teeth = values[Z_R] - values[Z_S]
    return bool(teeth > 0 and teeth % 2 == 0)


def _train(
    fixed: Symbol, driving: Symbol, driven: Symbol, title: str, words: str, asked: str, formula: Expr
) -> Problem:
    contact = _contact().subs(fixed, 0)
    (rate,) = solve(contact, driven)
    name = {omega_C: r"\omega_C", omega_S: r"\omega_S", omega_R: r"\omega_R"}[driven]
    return Problem(
        title,
        TRAIN + " " + words,
        LAW,
        (SUN, RING, quantity(driving, SPEED, "rpm", "speed of the driving member")),
        (
            Line("The teeth in contact have the same speed.", contact.subs(driven, formula), 0, CONTACT),
            Line("The equation is solved for the rate.", rate, formula, name),
        ),
        (Asked(name, asked, formula, "rpm"),),
        _can_be_built,
    )


def ring_fixed(random: Random) -> Problem:
    """Return a problem that asks for the carrier's rate in a planetary gear whose ring is fixed."""
    formula = Z_S * omega_S / (Z_R + Z_S)
    return _train(
        omega_R,
        omega_S,
        omega_C,
        "A planetary gear with a fixed ring",
        "The ring is fixed, the sun drives.",
        "the rate of the carrier",
        formula,
    )


def sun_fixed(random: Random) -> Problem:
    """Return a problem that asks for the carrier's rate in a planetary gear whose sun is fixed."""
    formula = Z_R * omega_R / (Z_R + Z_S)
    return _train(
        omega_S,
        omega_R,
        omega_C,
        "A planetary gear with a fixed sun",
        "The sun is fixed, the ring drives.",
        "the rate of the carrier",
        formula,
    )


def carrier_fixed(random: Random) -> Problem:
    """Return a problem that asks for the ring's rate in a planetary gear whose carrier is fixed."""
    formula = -Z_S * omega_S / Z_R
    return _train(
        omega_C,
        omega_S,
        omega_R,
        "A planetary gear with a fixed carrier",
        "The carrier is fixed, the sun drives.",
        "the rate of the ring",
        formula,
    )


def both_driven(random: Random) -> Problem:
    """Return a problem that asks for the carrier's rate in a planetary gear whose sun and ring are driven."""
    (rate,) = solve(_contact(), omega_C)
    formula = (Z_S * omega_S + Z_R * omega_R) / (Z_R + Z_S)
    return Problem(
        "A planetary gear with two motors",
        TRAIN + " Motors drive the sun and the ring.",
        LAW,
        (
            SUN,
            RING,
            quantity(omega_S, SPEED, "rpm", "speed of the sun"),
            quantity(omega_R, "-300 -200 -100 100 200 300", "rpm", "speed of the ring"),
        ),
        (
            Line("The teeth in contact have the same speed.", _contact().subs(omega_C, formula), 0, CONTACT),
            Line("The equation is solved for the rate.", rate, formula, r"\omega_C"),
        ),
        (Asked(r"\omega_C", "the rate of the carrier", formula, "rpm"),),
        _can_be_built,
    )


def planet_rate(random: Random) -> Problem:
    """Return a problem that asks for the planet's rate in a planetary gear whose ring is fixed."""
    contact = _contact().subs(omega_R, 0)
    carrier = solve(contact, omega_C)[0]
    planet = (
        solve(Z_S * (omega_S - omega_C) + Z_P * (omega_P - omega_C), omega_P)[0]
        .subs(omega_C, carrier)
        .subs(Z_R, Z_S + 2 * Z_P)
    )
    formula = -Z_S * omega_S / (2 * Z_P)
    return Problem(
        "The rate of a planet",
        "A planetary train has a sun with $Z_S$ teeth, planets with $Z_P$ teeth and a fixed ring, which has $Z_S + 2 "
        r"Z_P$ teeth. The sun rotates at $\omega_S$.",
        r"The planet rolls on the fixed ring and on the sun: $Z_S(\omega_S - \omega_C) = -Z_P(\omega_P - \omega_C)$.",
        (SUN, PLANET, quantity(omega_S, SPEED, "rpm", "speed of the sun")),
        (
            Line(
                "The rate of the carrier and the number of teeth of the ring are inserted.",
                planet,
                formula,
                r"\omega_P",
            ),
        ),
        (Asked(r"\omega_P", "the rate of the planets in space", formula, "rpm"),),
    )


def torque_of_carrier(random: Random) -> Problem:
    """Return a problem that asks for the torque that the carrier of a planetary gear with fixed ring delivers."""
    carrier = solve(_contact().subs(omega_R, 0), omega_C)[0]
    torque = tau_1 * omega_S / carrier
    formula = tau_1 * (Z_R + Z_S) / Z_S
    return Problem(
        "The torque of a planetary gear",
        TRAIN + r" The ring is fixed. The sun is driven with the torque $\tau_1$; friction is neglected.",
        r"Without losses the power at the carrier equals the power at the sun, $\tau_1\omega_S$.",
        (SUN, RING, quantity(tau_1, "2 4 5 10 20 50", "N m", "torque at the sun")),
        (Line("The power of the sun, divided by the rate of the carrier.", torque, formula, r"\tau_C"),),
        (Asked(r"\tau_C", "the torque that the carrier delivers", formula, "N m"),),
        _can_be_built,
    )

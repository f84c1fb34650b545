"""Gear trains: Willis' formula (Willis, Principles of Mechanism, 1841; Beer & Johnston, Dynamics, chapter 15)."""

from sympy import Matrix, solve

from symrot import symbols
from symrot.proof.derivation import Derivation

SUN, RING, CARRIER, PLANET = symbols.gear_rates
Z_S, Z_R, Z_P = symbols.teeth
RATES = (SUN, PLANET, RING)


def derive() -> Derivation:
    d = Derivation(
        "gear_trains",
        title="Gear trains and Willis' formula",
        source="Willis, *Principles of Mechanism*, 1841; Beer, Johnston & Cornwell, *Vector Mechanics for Engineers: "
        "Dynamics*, "
        "chapter 15",
        about=(
            "The teeth of two meshing gears have the same velocity at the point of contact. For a planetary gear "
            "train this gives two equations for four rates. Relative to the carrier, the train is an ordinary gear "
            "train; this is Willis' formula."
        ),
    )
    contacts = _contacts(d)
    _willis(d, contacts)
    _torques(d)
    return d


def _contacts(d: Derivation) -> Matrix:
    d.section("Velocities at the points of contact")
    unit = symbols.r  # pitch radius per tooth
    sun, planet = Z_S * unit, Z_P * unit
    axis = Matrix([0, 0, 1])

    def velocity(center: Matrix, speed: object, omega: object, at: Matrix) -> Matrix:
        return Matrix([0, speed, 0]) + (omega * axis).cross(at - center)

    origin, middle = Matrix([0, 0, 0]), Matrix([sun + planet, 0, 0])
    inner, outer = Matrix([sun, 0, 0]), Matrix([sun + 2 * planet, 0, 0])
    carried = CARRIER * (sun + planet)
    d.passage(
        "The sun $S$, the planet $P$, the ring $R$ and the carrier $C$ rotate about parallel axes. The pitch radius "
        "of each gear is its number of teeth $Z$ times a length $r$. The planet's axis is at the distance $(Z_S + "
        r"Z_P)\,r$ from the sun's axis and moves with the carrier."
    )
    d.step(
        "At the contact of sun and planet, the velocities of the two gears differ by:",
        velocity(origin, 0, SUN, inner) - velocity(middle, carried, PLANET, inner),
        Matrix([0, unit * (Z_S * (SUN - CARRIER) + Z_P * (PLANET - CARRIER)), 0]),
        because=r"the velocity of a point of a gear is $v + \omega \times r$",
        named="v_S - v_P",
    )
    d.step(
        "The ring encloses the planet, so its number of teeth is:",
        outer[0] / unit,
        Z_S + 2 * Z_P,
        because="the ring's radius is the sun's radius plus twice the planet's radius",
        named="Z_R",
    )
    d.step(
        "At the contact of planet and ring, the velocities of the two gears differ by:",
        velocity(middle, carried, PLANET, outer) - velocity(origin, 0, RING, outer),
        Matrix([0, unit * (Z_P * (PLANET - CARRIER) - (Z_S + 2 * Z_P) * (RING - CARRIER)), 0]),
        because=r"the velocity of a point of a gear is $v + \omega \times r$",
        named="v_P - v_R",
    )
    return Matrix(
        [
            Z_S * (SUN - CARRIER) + Z_P * (PLANET - CARRIER),
            Z_P * (PLANET - CARRIER) - Z_R * (RING - CARRIER),
        ]
    )


def _willis(d: Derivation, contacts: Matrix) -> None:
    d.section("Willis' formula")
    d.passage(
        "The gears do not slip, so the velocity differences at both contacts are zero:",
        *((entry, "0") for entry in contacts),
    )
    d.step(
        "Relative to the carrier, sun and ring rotate in opposite directions, and their rates are in the inverse "
        "ratio of their numbers of teeth.",
        Z_S * (SUN - CARRIER),
        -Z_R * (RING - CARRIER),
        because="the rate of the planet is eliminated",
        relations=list(contacts),
        named=r"Z_S (\omega_S - \omega_C)",
    )
    willis = Z_S * (SUN - CARRIER) + Z_R * (RING - CARRIER)
    cases = (
        (
            "If the ring is fixed, the carrier rotates more slowly than the sun and in the same direction.",
            {RING: 0},
            SUN,
            CARRIER,
            1 + Z_R / Z_S,
            "S",
            "C",
        ),
        (
            "If the sun is fixed, the carrier rotates more slowly than the ring and in the same direction.",
            {SUN: 0},
            RING,
            CARRIER,
            1 + Z_S / Z_R,
            "R",
            "C",
        ),
        (
            "If the carrier is fixed, the train is ordinary: sun and ring rotate in opposite directions.",
            {CARRIER: 0},
            SUN,
            RING,
            -Z_R / Z_S,
            "S",
            "R",
        ),
    )
    for claim, held, driver, driven, ratio, upper, lower in cases:
        d.step(
            claim,
            solve(willis.subs(held), driver)[0] / driven,
            ratio,
            because="one rate in Willis' formula is zero",
            named=rf"\frac{{\omega_{upper}}}{{\omega_{lower}}}",
        )
    d.step(
        "If nothing is fixed, the rate of the carrier is the mean of the rates of sun and ring, weighted with their "
        "numbers of teeth.",
        solve(willis, CARRIER)[0],
        (Z_S * SUN + Z_R * RING) / (Z_S + Z_R),
        because="Willis' formula is linear in the rates",
        named=r"\omega_C",
    )
    d.step(
        "If sun and ring have the same number of teeth, as in the differential of a car, the rate of the carrier is "
        "half the sum of their rates.",
        solve(willis.subs(Z_R, Z_S), CARRIER)[0],
        (SUN + RING) / 2,
        because="the two weights in Willis' formula are equal",
        named=r"\omega_C",
    )
    d.step(
        "If all parts rotate at the same rate, both contact conditions are satisfied.",
        contacts.subs(dict.fromkeys((*RATES, CARRIER), symbols.Omega), simultaneous=True),
        0,
        because="no gear moves relative to the carrier",
        named=r"\begin{bmatrix} v_S - v_P \\ v_P - v_R \end{bmatrix}",
    )


def _torques(d: Derivation) -> None:
    d.section("Torques")
    sun, ring, carrier = symbols.torque_b
    rates = {CARRIER: (Z_S * SUN + Z_R * RING) / (Z_S + Z_R)}
    power = (sun * SUN + ring * RING + carrier * CARRIER).subs(rates)
    balance = solve([power.diff(SUN), power.diff(RING)], (ring, carrier), dict=True)[0]
    d.passage(
        r"Let the torques be $\tau_1$ on the sun, $\tau_2$ on the ring and $\tau_3$ on the carrier. Without friction "
        "and at constant rates, the sum of their powers is zero for all rates of sun and ring."
    )
    d.step(
        "Hence the three torques are in fixed ratios.",
        Matrix([balance[ring], balance[carrier]]),
        sun / Z_S * Matrix([Z_R, -(Z_S + Z_R)]),
        because="in the sum of the powers, the coefficients of the two free rates are zero",
        named=r"\begin{bmatrix} \tau_2 \\ \tau_3 \end{bmatrix}",
    )
    d.step(
        "The sum of the three torques is zero: the train as a whole is in equilibrium.",
        sun + balance[ring] + balance[carrier],
        0,
        because="the train can rotate as one rigid body",
        named=r"\tau_1 + \tau_2 + \tau_3",
    )

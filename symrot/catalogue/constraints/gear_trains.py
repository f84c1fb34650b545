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
            "Two gears that mesh have one velocity where they touch. For a planetary train that is two equations "
            "between four "
            "rates; seen from the carrier it is an ordinary train, and this is Willis' formula."
        ),
    )
    contacts = _contacts(d)
    _willis(d, contacts)
    _torques(d)
    return d


def _contacts(d: Derivation) -> Matrix:
    d.section("Velocities where the gears touch")
    unit = symbols.r  # pitch radius per tooth
    sun, planet = Z_S * unit, Z_P * unit
    axis = Matrix([0, 0, 1])

    def velocity(center: Matrix, speed: object, omega: object, at: Matrix) -> Matrix:
        return Matrix([0, speed, 0]) + (omega * axis).cross(at - center)

    origin, middle = Matrix([0, 0, 0]), Matrix([sun + planet, 0, 0])
    inner, outer = Matrix([sun, 0, 0]), Matrix([sun + 2 * planet, 0, 0])
    carried = CARRIER * (sun + planet)
    d.passage(
        r"Sun $S$, planet $P$, ring $R$ and carrier $C$ turn about parallel axes. A pitch radius is the number of "
        r"teeth $Z$ times "
        r"one length $r$; the planet's axis is at $(Z_S + Z_P)\,r$ and moves with the carrier."
    )
    d.step(
        "Sun and planet, where they touch:",
        velocity(origin, 0, SUN, inner) - velocity(middle, carried, PLANET, inner),
        Matrix([0, unit * (Z_S * (SUN - CARRIER) + Z_P * (PLANET - CARRIER)), 0]),
        because=r"the velocity $v + \omega \times r$ of the contact point is the same on both gears",
        named="v_S - v_P",
    )
    d.step(
        "The ring touches the planet from outside, which takes so many teeth:",
        outer[0] / unit,
        Z_S + 2 * Z_P,
        because="the ring's radius is the sun's radius plus twice the planet's radius",
        named="Z_R",
    )
    d.step(
        "Planet and ring, where they touch:",
        velocity(middle, carried, PLANET, outer) - velocity(origin, 0, RING, outer),
        Matrix([0, unit * (Z_P * (PLANET - CARRIER) - (Z_S + 2 * Z_P) * (RING - CARRIER)), 0]),
        because=r"the velocity $v + \omega \times r$ of the contact point is the same on both gears",
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
    d.passage("Where the gears do not slip, both differences are zero.", *((entry, "0") for entry in contacts))
    d.step(
        "Seen from the carrier the rates of sun and ring are in the inverse ratio of their teeth, the sense reversed.",
        Z_S * (SUN - CARRIER),
        -Z_R * (RING - CARRIER),
        because="the rate of the planet, which is an idle gear, is eliminated",
        relations=list(contacts),
        named=r"Z_S (\omega_S - \omega_C)",
    )
    willis = Z_S * (SUN - CARRIER) + Z_R * (RING - CARRIER)
    cases = (
        (
            "Ring held: the sun turns the carrier slowly, the same way.",
            {RING: 0},
            SUN,
            CARRIER,
            1 + Z_R / Z_S,
            "S",
            "C",
        ),
        ("Sun held: the ring turns the carrier.", {SUN: 0}, RING, CARRIER, 1 + Z_S / Z_R, "R", "C"),
        ("Carrier held: an ordinary train, reversed.", {CARRIER: 0}, SUN, RING, -Z_R / Z_S, "S", "R"),
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
        "Nothing held: the carrier has the mean of both rates, weighted with the teeth.",
        solve(willis, CARRIER)[0],
        (Z_S * SUN + Z_R * RING) / (Z_S + Z_R),
        because="Willis' formula is linear in the rates",
        named=r"\omega_C",
    )
    d.step(
        "With as many teeth on both sides, as in the differential of a car, half the sum.",
        solve(willis.subs(Z_R, Z_S), CARRIER)[0],
        (SUN + RING) / 2,
        because="the two weights in Willis' formula are equal",
        named=r"\omega_C",
    )
    d.step(
        "All turning as one is a motion of the train.",
        contacts.subs(dict.fromkeys((*RATES, CARRIER), symbols.Omega), simultaneous=True),
        0,
        because="then no gear moves relative to the carrier",
        named=r"\begin{bmatrix} v_S - v_P \\ v_P - v_R \end{bmatrix}",
    )


def _torques(d: Derivation) -> None:
    d.section("Torques")
    sun, ring, carrier = symbols.torque_b
    rates = {CARRIER: (Z_S * SUN + Z_R * RING) / (Z_S + Z_R)}
    power = (sun * SUN + ring * RING + carrier * CARRIER).subs(rates)
    balance = solve([power.diff(SUN), power.diff(RING)], (ring, carrier), dict=True)[0]
    d.passage(
        r"Without friction and at constant rates the powers of the torques $\tau_1$ on the sun, $\tau_2$ on the ring "
        r"and $\tau_3$ on "
        "the carrier add to zero at all rates of sun and ring."
    )
    d.step(
        "Hence they are in fixed ratios.",
        Matrix([balance[ring], balance[carrier]]),
        sun / Z_S * Matrix([Z_R, -(Z_S + Z_R)]),
        because="the coefficient of each of the two free rates is zero",
        named=r"\begin{bmatrix} \tau_2 \\ \tau_3 \end{bmatrix}",
    )
    d.step(
        "Their sum is zero: the train as a whole is in balance.",
        sun + balance[ring] + balance[carrier],
        0,
        because="the rotation of the whole train as one body is a motion of the train",
        named=r"\tau_1 + \tau_2 + \tau_3",
    )

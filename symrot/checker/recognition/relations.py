"""Relations between quantities that books solve for one quantity or another, each derived from the laws of motion.

The condition of steady precession, for example, is solved for the spin, the torque and the moments of inertia.
"""

from collections.abc import Iterator
from math import comb, prod
from typing import Any, NamedTuple

from sympy import (
    Add,
    Expr,
    GeneratorsNeeded,
    Matrix,
    Mul,
    Poly,
    PolynomialError,
    Pow,
    Rational,
    Symbol,
    cancel,
    cos,
    diag,
    expand,
    factor_terms,
    fraction,
    pi,
    sin,
    solve,
    tan,
    together,
    trace,
)

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR
from symrot.checker.recognition.fingerprint import in_lowest_terms
from symrot.dynamics.equations import angular_acceleration
from symrot.inertia.solids import solid
from symrot.kinematics import quaternion, rotation_vector
from symrot.kinematics.euler import rate_jacobian

__all__ = [
    "OTHERS",
    "Relation",
    "new_symbol",
    "primitive",
    "relations",
    "solved",
    "terms_expanded",
    "without_common_powers",
]

PHI, THETA, PSI = symbols.angles
DPHI, DTHETA, DPSI = symbols.angle_rates
DDTHETA = symbols.ddtheta
A, B, C, ARM, MASS, G = symbols.A, symbols.B, symbols.C, symbols.c_3, symbols.m, symbols.g
HALF = Rational(1, 2)
SPIN = symbols.omega_3
HEAVY, FREE, ROLLING, PLANE, WHEEL, PENDULUM, EULER, AXIS = (
    f"derivations/{name}.md"
    for name in ("heavy_top", "symmetric_top", "rolling", "planar_motion", "gyroscopic_wheel", "pendulum",
                 "euler_equations", "axis_and_angle")
)  # fmt: skip


def new_symbol(name: str, unit: str) -> Symbol:
    """Create a symbol that :mod:`symrot.symbols` does not have, record its unit, and return it."""
    symbol = Symbol(name, real=True)
    OTHERS[symbol] = unit
    return symbol


OTHERS: dict[Symbol, str] = {}
"""The symbols of relations that are not in :mod:`symrot.symbols`, with their units."""

ENERGY, STIFFNESS, SPEED = new_symbol("E_k", "J"), new_symbol("k_t", "N m/rad"), new_symbol("v", "m/s")
BEFORE, AFTER = new_symbol("omega_i", "rad/s"), new_symbol("omega_f", "rad/s")
START, END, TIME = new_symbol("theta_i", "rad"), new_symbol("theta_f", "rad"), new_symbol("t", "s")
ALPHA, FALL, SLOPE = new_symbol("alpha_a", "rad/s^2"), new_symbol("a_l", "m/s^2"), new_symbol("beta", "rad")
TORQUE, PERIOD, LENGTH = new_symbol("M", "N m"), new_symbol("T_p", "s"), new_symbol("q_d", "m")
PULLEY = new_symbol("M_p", "kg")
TENSION = new_symbol("T_s", "N, of a string")
GYRATION = new_symbol("k_O", "m, of gyration")
TILT = new_symbol("gamma", "rad")
WHEEL_MOMENTUM = new_symbol("h_w", "kg m^2/s")
WORK = new_symbol("W_k", "J")


class Relation(NamedTuple):
    """A relation of mechanics: the left side minus the right side, and the symbols for which to solve it."""

    title: str
    source: str  # the derivation page
    difference: Expr
    words: dict[Symbol, str]  # {E: "energy of"} names the formula for E "energy of" and the title


def solved(relation: Relation) -> Iterator[tuple[str, str, Any]]:
    """Solve a relation for each symbol in ``relation.words``: yield (name, derivation page, formula for the symbol or
    its square). Skip other powers.
    """
    numerator = fraction(together(relation.difference))[0]
    for symbol, words in relation.words.items():
        coefficients = Poly(numerator, symbol).all_coeffs()
        if len(coefficients) == 2:
            slope, rest = coefficients
            name = f"{words} {relation.title}"
        elif len(coefficients) == 3 and coefficients[1] == 0:
            slope, _, rest = coefficients
            name = f"{words} {relation.title}, squared"
        else:
            continue  # neither linear nor purely quadratic in the symbol
        yield name, relation.source, factor_terms(cancel(-rest / slope))


def terms_expanded(formula: Expr) -> int:
    """Return an upper bound on the number of terms of a formula after multiplying out: 3 for ``(a + b)**2``."""
    if isinstance(formula, Add):
        return sum(map(terms_expanded, formula.args))
    if isinstance(formula, Mul):
        return prod(map(terms_expanded, formula.args))
    if isinstance(formula, Pow) and formula.exp.is_Integer:
        terms, power = terms_expanded(formula.base), abs(int(formula.exp))
        return comb(terms + power - 1, power)
    return 1


def primitive(difference: Expr) -> Expr:
    """Return the numerator of a difference without common factors: a - b for ``2*c*a/d - 2*c*b/d``."""
    # equations that differ by a factor or denominator get the same result, perhaps with another sign
    quotients = [term for term in Add.make_args(difference) if not fraction(term)[1].is_number]
    is_whole = len(quotients) <= 1 and all(map(in_lowest_terms, quotients))
    is_cancelled = not is_whole and difference.count_ops() < LONGEST
    numerator = fraction(cancel(together(difference)) if is_cancelled else together(difference))[0]
    try:
        return Poly(numerator).terms_gcd()[1].primitive()[1].as_expr()
    except (PolynomialError, GeneratorsNeeded):
        return numerator


def without_common_powers(difference: Expr) -> Expr:
    """Return a difference divided by the powers that its terms share: ``a + b`` for ``c*a/d + c*b/d``."""
    # up to a constant factor the same as `primitive`, which is slower because it multiplies out
    common = _common_powers(difference)
    if common is None:
        return primitive(difference)
    return (
        Mul(difference, *(part**-power for part, power in common.items())).expand(deep=False) if common else difference
    )


def _common_powers(formula: Expr) -> dict[Expr, int] | None:
    """Return the powers of symbols that divide all terms of a formula: {a: 1, b: -1} for ``a*c/b + a/b``.

    None if the formula contains a root, or a sum as a divisor.
    """
    if isinstance(formula, Add):
        terms = [_common_powers(term) for term in formula.args]
        if None in terms:
            return None
        powers = [term for term in terms if term is not None]
        least = {part: min(term.get(part, 0) for term in powers) for part in {part for term in powers for part in term}}
        return {part: power for part, power in least.items() if power}
    if isinstance(formula, Mul):
        total: dict[Expr, int] = {}
        for factor in formula.args:
            own = _common_powers(factor)
            if own is None:
                return None
            for part, power in own.items():
                total[part] = total.get(part, 0) + power
        return total
    if isinstance(formula, Pow):
        inner = _common_powers(formula.base)
        if inner is None or not formula.exp.is_Integer or (formula.exp < 0 and formula.base.is_Add):
            return None  # a root, or a sum as a divisor
        return {part: power * int(formula.exp) for part, power in inner.items()}
    return {} if formula.is_number else {formula: 1}


LONGEST = 120
"""The most operations of a difference whose common factors are divided out."""


def relations() -> Iterator[Relation]:
    """Yield all relations in a fixed order."""
    for group in (_one_axis, _rolling, _pendulum, _steady, _heavy, _free, _planar, _aircraft, _wheel, _trace):
        yield from group()


def _one_axis() -> Iterator[Relation]:
    """Yield the relations of rotation about a fixed axis: work, constant acceleration, springs, percussion centres."""
    energy = C * SPIN**2 / 2
    (moment,) = solve(energy.diff(SPIN) - symbols.H, C)
    by_momentum = ENERGY - energy.subs(C, moment)
    yield Relation("rotation about one axis by its angular momentum", PLANE, by_momentum, {ENERGY: "kinetic energy of"})
    (spin,) = solve(energy.diff(SPIN) - symbols.H, SPIN)
    without_spin = ENERGY - energy.subs(SPIN, spin)
    yield Relation(
        "rotation about one axis by its angular momentum", PLANE, without_spin, {ENERGY: "kinetic energy of"}
    )
    gain = energy.subs(SPIN, AFTER) - energy.subs(SPIN, BEFORE)
    yield Relation("work and kinetic energy of rotation", PLANE, WORK - gain, {WORK: "work by"})
    yield Relation("impulse and angular momentum about one axis", PLANE, C * BEFORE + TORQUE * TIME - C * AFTER,
                   {AFTER: "angular velocity by"})  # fmt: skip
    work = TORQUE * (END - START)
    yield Relation("work of a constant torque", PLANE, WORK - work, {WORK: "work by the"})
    from_zero = work.subs({START: 0, END: THETA})
    yield Relation("work of a constant torque", PLANE, WORK - from_zero, {WORK: "work by the"})
    later = BEFORE + ALPHA * TIME
    turned = START + later.integrate((TIME, 0, TIME))
    (time,) = solve(later - AFTER, TIME)
    squared = expand(2 * ALPHA * (turned.subs(TIME, time) - END))
    motion = "constant angular acceleration"
    (constant,) = solve(later - AFTER, ALPHA)
    mean = cancel(turned.subs(ALPHA, constant))
    yield Relation(motion, PLANE, AFTER - later, {AFTER: "angular velocity at", ALPHA: "angular acceleration at"})
    for start in ({}, {START: 0}):
        yield Relation(motion, PLANE, END - turned.subs(start), {END: "angle at"})
        yield Relation(motion, PLANE, squared.subs(start), {AFTER: "angular velocity at"})
        yield Relation(motion, PLANE, END - mean.subs(start), {END: "angle at"})
    twist = (STIFFNESS * THETA).integrate((THETA, 0, THETA))
    yield Relation("a torsional spring", PENDULUM, ENERGY - twist, {ENERGY: "potential energy of"})
    swing, rate = STIFFNESS * PERIOD**2 - (2 * pi) ** 2 * A, symbols.Omega
    yield Relation("a torsional pendulum", PENDULUM, swing, {PERIOD: "period of"})
    by_rate = cancel(swing.subs(PERIOD, 2 * pi / rate) * rate**2 / (2 * pi) ** 2)
    yield Relation("a torsional pendulum", PENDULUM, by_rate, {rate: "frequency of"})
    # the pivot has no reaction to a blow at the distance q_d if the blow moves the centre of mass as the pivot needs
    blow = Symbol("blow", real=True)
    (rate,) = solve(blow * LENGTH - C * SPIN, SPIN)
    (struck,) = solve(blow - MASS * symbols.r * rate, C)
    yield Relation("the centre of percussion", PLANE, struck - C, {LENGTH: "distance of"})
    yield Relation("the centre of percussion", PLANE, struck - MASS * GYRATION**2, {LENGTH: "distance of"})
    bar = solid("rod").inertia_about((0, 0, symbols.L / 2))[0, 0]
    percussion = struck.subs(symbols.r, symbols.L / 2) - bar
    yield Relation("the centre of percussion of a rod about its end", PLANE, percussion, {LENGTH: "distance of"})


ROLLERS = ("cylinder", "disk", "ring", "sphere", "spherical_shell")
"""Solids that roll; their moment about the axis of rolling is a multiple of m R^2."""


def _rolling() -> Iterator[Relation]:
    """Yield the relations of bodies that roll without slipping, and of masses on a pulley."""
    radius, height = symbols.R, symbols.h
    shares: list[tuple[str, Expr]] = [("a body", A)]
    shares.append(("a body of given radius of gyration", MASS * GYRATION**2))
    for name in ROLLERS:
        body = solid(name)
        moment = body.inertia_about(tuple(body.center_of_mass))[2, 2]
        shares.append((f"a {name.replace('_', ' ')}", cancel(moment)))
    seen: set[Expr] = set()
    for title, moment in shares:
        if moment in seen:
            continue
        seen.add(moment)
        energy = MASS * SPEED**2 / 2 + moment * (SPEED / radius) ** 2 / 2
        rolls = f"{title} that rolls"
        yield Relation(rolls, ROLLING, ENERGY - energy, {ENERGY: "kinetic energy of"})
        by_spin = expand(energy.subs(SPEED, radius * SPIN))
        yield Relation(rolls, ROLLING, ENERGY - by_spin, {ENERGY: "kinetic energy of"})
        yield Relation(f"{rolls} from a height", ROLLING, energy - MASS * G * height, {SPEED: "speed of"})
        # along the slope: d(energy)/dt = weight along the slope times speed
        power = energy.diff(SPEED) * FALL - MASS * G * sin(SLOPE) * SPEED
        yield Relation(f"{rolls} down a slope", ROLLING, cancel(power / SPEED), {FALL: "acceleration of"})
    first, second, _ = symbols.particle_masses
    energy = (first + second) * SPEED**2 / 2 + A * (SPEED / radius) ** 2 / 2
    power = energy.diff(SPEED) * FALL - (first - second) * G * SPEED
    falling = cancel(power / SPEED)
    yield Relation("two masses on a pulley", PLANE, falling, {FALL: "acceleration of"})
    for name in ("disk", "ring"):  # pulleys of a mass of their own
        body = solid(name)
        moment = body.inertia_about(tuple(body.center_of_mass))[2, 2].subs(MASS, PULLEY)
        title = f"two masses on a pulley that is a {name}"
        yield Relation(title, PLANE, cancel(falling.subs(A, moment)), {FALL: "acceleration of"})
    alone = falling.subs({first: MASS, second: 0})
    yield Relation("a mass that unwinds a string from a wheel", PLANE, alone, {FALL: "acceleration of"})
    # the string slows the fall: m g - T = m a
    (slowed,) = solve(alone, FALL)
    unrolling = cancel(TENSION - MASS * (G - slowed))
    yield Relation("the string of an unrolling body", PLANE, unrolling, {TENSION: "tension of"})
    (lifted,) = solve(falling.subs(A, 0), FALL)
    light = cancel(TENSION - second * (G + lifted))
    yield Relation("the string of two masses on a light pulley", PLANE, light, {TENSION: "tension of"})


def _pendulum() -> Iterator[Relation]:
    """Yield the Lagrangian, the energy, the equation of motion and the period of pendulums."""
    bodies = [("a physical pendulum", A, ARM), ("a physical pendulum", MASS * GYRATION**2, ARM),
              ("a simple pendulum (a point mass)", MASS * ARM**2, ARM)]  # fmt: skip
    along_x, along_z = Matrix([1, 0, 0]), Matrix([0, 0, 1])
    for title, name, direction, axis, arm in (  # the direction from the centre of mass to the suspension
        ("a rod about an end", "rod", along_z, (1, 1), symbols.L / 2),
        ("a ring that hangs from its rim", "ring", along_x, (2, 2), symbols.R),
        ("a disk that hangs from its rim", "disk", along_x, (2, 2), symbols.R),
    ):
        body = solid(name)
        bodies.append((title, body.inertia_about(body.center_of_mass + arm * direction)[axis], arm))
    for title, moment, arm in bodies:
        potential = -MASS * G * arm * cos(THETA)
        kinetic = moment * DTHETA**2 / 2
        yield Relation(title, PENDULUM, ENERGY - (kinetic - potential), {ENERGY: "Lagrangian of"})
        yield Relation(title, PENDULUM, ENERGY - (kinetic + potential), {ENERGY: "energy of"})
        common = MASS * arm if moment.has(arm) else MASS
        motion = moment * DDTHETA + potential.diff(THETA)
        yield Relation(title, PENDULUM, cancel(motion / common), {DDTHETA: "angular acceleration of"})
        stiffness = potential.diff(THETA, 2).subs(THETA, 0)
        swing = PERIOD**2 * stiffness - (2 * pi) ** 2 * moment
        yield Relation(title, PENDULUM, cancel(swing / common), {PERIOD: "period of"})
        if moment != A:
            beat = symbols.n**2 * moment - stiffness
            yield Relation(title, PENDULUM, cancel(beat / common), {symbols.n: "frequency of"})


def _wheel() -> Iterator[Relation]:
    """Yield Euler's equations of a body that carries a wheel turning about a principal axis of the body."""
    rates = Matrix(symbols.omega_rates)
    inertia = diag(A, B, C)
    for place, word in enumerate(("first", "second", "third")):
        momentum = inertia * OMEGA
        momentum[place] += WHEEL_MOMENTUM
        needed = inertia * rates + OMEGA.cross(momentum)
        for own, rate in zip(needed, symbols.omega_rates, strict=True):
            title = f"a body with a wheel along the {word} axis, by Euler's equations"
            if own.has(WHEEL_MOMENTUM):
                yield Relation(title, WHEEL, expand(own), {rate: "angular acceleration of"})


def _trace() -> Iterator[Relation]:
    """Yield the relation between the trace of a rotation matrix and the angle."""
    matrix = Matrix(rotation_vector.dcm_of_axis_angle())
    n1, n2, n3 = symbols.axis
    total = expand(trace(matrix)).subs(n3**2, 1 - n1**2 - n2**2)
    entries = Matrix(3, 3, symbols.rotation_entries)
    yield Relation("the trace of a rotation matrix", AXIS, trace(entries) - expand(total), {})


def _top() -> tuple[Matrix, Expr]:
    """Return the angular velocity and the kinetic energy of a symmetric top, in Euler angles with spin angle zero."""
    # the spin angle of a symmetric top enters no relation
    omega = (rate_jacobian("ZXZ") * Matrix(symbols.angle_rates)).subs(PSI, 0)
    return omega, HALF * omega.dot(diag(A, A, C) * omega)


def _steady() -> Iterator[Relation]:
    """Yield conditions of steady precession under a weight or torque, with omega_3 or psi'; the least spin, the torque
    of gravity, and fast nutation.
    """
    _, kinetic = _top()
    along = kinetic.diff(THETA).subs(DTHETA, 0)  # A*theta'' at rest in theta, by Lagrange's equation
    for name, load in (("W", symbols.W), ("m g", MASS * G)):
        potential = load * ARM * cos(THETA)
        whole = cancel((along - potential.diff(THETA)) / sin(THETA))
        by_spin = cancel((_by_spin(along) - potential.diff(THETA)) / sin(THETA))
        title = "steady precession of a heavy top"
        for difference in (whole, by_spin):
            yield Relation(title, HEAVY, expand(difference), {SPIN: "angular velocity at", DPSI: "rate of spin at"})
        fast = expand(by_spin).coeff(DPHI, 1) * DPHI + expand(by_spin).coeff(DPHI, 0)
        yield Relation("slow precession of a fast top", HEAVY, fast, {})
        least = expand(by_spin.subs(DPHI, symbols.n))
        linear, square, constant = (expand(least).coeff(symbols.n, k) for k in (1, 2, 0))
        bound = cancel(linear**2 - 4 * square * constant)
        title = "the least spin for steady precession of a heavy top"
        yield Relation(title, HEAVY, bound, {SPIN: "angular velocity of"})
        yield Relation("the least spin of a sleeping top", HEAVY, bound.subs(THETA, 0), {SPIN: "angular velocity of"})
        if name == "W":
            yield Relation("steady precession under a torque", WHEEL, along + TORQUE, {TORQUE: "torque of"})
            yield Relation("steady precession under a torque", WHEEL, _by_spin(along) + TORQUE, {TORQUE: "torque of"})
        gravity = -potential.diff(THETA)
        yield Relation("gravity on a top", HEAVY, TORQUE - gravity, {TORQUE: "torque of"})
    level = C * SPIN * DPHI
    assert cancel(_by_spin(along).subs(THETA, pi / 2) + level) == 0
    title, words = "steady precession with a level axle", {TORQUE: "torque of", DPHI: "rate of"}
    yield Relation(title, WHEEL, TORQUE - level, words)
    words |= {TORQUE: "gyroscopic couple of"}  # T = omega L is no torque, but twice a kinetic energy
    yield Relation(title, WHEEL, TORQUE - level.subs(C, symbols.H / SPIN), words)
    yield Relation("fast nutation of a top", HEAVY, A * symbols.n - C * SPIN, {symbols.n: "frequency of"})


def _by_spin(formula: Expr) -> Expr:
    """Return a formula with the spin omega_3 in place of the rate of the spin angle."""
    return expand(formula.subs(DPSI, SPIN - DPHI * cos(THETA)))


def _heavy() -> Iterator[Relation]:
    """Yield relations of heavy and free tops: energies, nutation, angular momenta, the length of omega."""
    omega, kinetic = _top()
    # the spin in place of the rate of the third Euler angle
    turned = kinetic.subs(DPSI, SPIN - DPHI * cos(THETA))
    yield Relation("a symmetric top", HEAVY, ENERGY - expand(turned), {ENERGY: "kinetic energy of"})
    for load in (symbols.W, MASS * G):
        potential = load * ARM * cos(THETA)
        yield Relation("a heavy top", HEAVY, ENERGY - expand(turned) - potential, {ENERGY: "energy of"})
        nutation = A * DDTHETA - kinetic.diff(THETA) + potential.diff(THETA)
        if load is symbols.W:
            under_torque = A * DDTHETA - kinetic.diff(THETA) - TORQUE
            yield Relation("nutation of a top under a torque", HEAVY, expand(under_torque), {TORQUE: "torque of"})
        yield Relation("nutation of a heavy top", HEAVY, expand(nutation), {DDTHETA: "angular acceleration at"})
        by_spin = A * DDTHETA - _by_spin(kinetic.diff(THETA)) + potential.diff(THETA)
        yield Relation("nutation of a heavy top", HEAVY, by_spin, {DDTHETA: "angular acceleration at"})
    momentum = diag(A, A, C) * omega
    vertical = expand(momentum[2] * cos(THETA) + momentum[1] * sin(THETA))
    assert expand(vertical - kinetic.diff(DPHI)) == 0
    H = symbols.H
    names = {H: "angular momentum of"}
    yield Relation("a symmetric top along the vertical", HEAVY, H - vertical, names)
    yield Relation("a symmetric top along its axis", HEAVY, H - momentum[2], names)
    omega = rate_jacobian("ZXZ") * Matrix(symbols.angle_rates)
    general = HALF * omega.dot(diag(A, B, C) * omega)
    yield Relation("an asymmetric body in the angles of ZXZ", HEAVY, ENERGY - general, {ENERGY: "kinetic energy of"})
    length = symbols.n
    first, second, third = omega
    across = DPHI**2 * sin(THETA) ** 2 + DTHETA**2
    assert expand(first**2 + second**2 - across).subs(sin(PSI) ** 2, 1 - cos(PSI) ** 2).expand() == 0
    title, page = "the angular velocity in the angles of ZXZ", "derivations/euler_body_rates.md"
    square = expand(across + third**2).subs(sin(THETA) ** 2, 1 - cos(THETA) ** 2)
    yield Relation(title, page, length**2 - expand(square), {length: "length of"})
    title = "the angular velocity across the axis in the angles of ZXZ"
    yield Relation(title, page, symbols.omega_1**2 + symbols.omega_2**2 - across, {})


def _free() -> Iterator[Relation]:
    """Yield the relations of a free body: energy and momentum, stability, the angles of a symmetric body, and the unit
    norm of a quaternion.
    """
    momentum = diag(A, B, C) * OMEGA
    H, E = symbols.H, symbols.E
    square, energy = momentum.dot(momentum), OMEGA.dot(momentum) / 2
    yield Relation("a free body", EULER, H**2 - square, {H: "angular momentum of"})
    symmetric = {B: A}
    yield Relation("a free symmetric body", EULER, H**2 - square.subs(symmetric), {H: "angular momentum of"})
    title = "rotation of a symmetric body"
    yield Relation(title, EULER, ENERGY - energy.subs(symmetric), {ENERGY: "kinetic energy of"})
    parts = symbols.momentum_b
    velocities = [part / moment for part, moment in zip(parts, (A, B, C), strict=True)]
    by_momenta = energy.subs(dict(zip(OMEGA, velocities, strict=True)))
    yield Relation("a body by its angular momentum", EULER, ENERGY - by_momenta, {ENERGY: "kinetic energy of"})
    across = {parts[0] ** 2: H**2 - parts[1] ** 2 - parts[2] ** 2}
    along = expand(expand(by_momenta.subs(symmetric)).subs(across))
    yield Relation("a symmetric body by its angular momentum", EULER, ENERGY - along, {ENERGY: "kinetic energy of"})
    first, second, third = OMEGA
    for eliminated, rest in ((third, first), (first, third)):
        (value,) = {solution**2 for solution in solve(2 * energy - 2 * E, eliminated)}
        difference = cancel((square - H**2).subs(eliminated**2, value))
        yield Relation("a free body of given energy and angular momentum", EULER, difference,
                       {rest: "angular velocity of"})  # fmt: skip
    # rotation near the third axis: the rate of omega_1' with omega_3 constant and omega_1, omega_2 small
    alpha = angular_acceleration(diag(A, B, C), OMEGA, Matrix([0, 0, 0]))
    again = alpha[0].subs(second, alpha[1])
    growth = cancel(again / first)
    second_rate = Symbol("ddomega_1", real=True)
    rate = symbols.Omega
    title = "small oscillations about a principal axis"
    yield Relation(title, EULER, second_rate - growth * first, {second_rate: "angular acceleration at"})
    yield Relation(title, EULER, rate**2 + growth, {rate: "frequency of"})
    # a free symmetric body: the momentum H is vertical, theta is the angle between it and the axis
    omega, _ = _top()
    own = diag(A, A, C) * omega
    precession = own[1].subs(DTHETA, 0) - H * sin(THETA)
    along = C * SPIN - H * cos(THETA)
    body = "a free symmetric body"
    yield Relation(body, FREE, along, {SPIN: "angular velocity along the axis of"})
    (by_momentum,) = solve(precession, DPHI)
    spin = along.subs(SPIN, DPSI + by_momentum * cos(THETA))
    yield Relation(body, FREE, fraction(together(spin))[0], {DPSI: "rate of spin of"})
    ratio = cancel((omega[1] / omega[2]) / (own[1] / own[2]))  # of the tangents of the angles of omega and momentum
    yield Relation("the angles of momentum and angular velocity to the axis of a free symmetric body", FREE,
                   tan(TILT) - ratio * tan(THETA), {})  # fmt: skip
    norm = quaternion.unit_relation(symbols.quaternion)
    yield Relation("the unit norm of a quaternion", "derivations/euler_parameters.md", norm, {})
    turning = symbols.Omega
    slow = alpha.subs(B, A)
    along_axis = cancel(-slow[0] / second).subs(SPIN, symbols.n * cos(TILT))  # omega at the angle gamma to the axis
    title = "the angular velocity of a free symmetric body round its axis"
    yield Relation(title, FREE, turning - along_axis, {turning: "rate of precession of"})
    title = "a free symmetric body whose angular velocity precesses"
    for word, rate, change in (("first", symbols.domega_1, -second), ("second", symbols.domega_2, first)):
        words = f"{word} component of the angular acceleration of"
        yield Relation(title, FREE, rate - turning * change, {rate: words})
    assert cancel(slow[0] / second + slow[1] / first) == 0  # the same rate in both


def _planar() -> Iterator[Relation]:
    """Yield the torques that keep the axis fixed, for a body that rotates about z and has products of inertia."""
    about, rate = Matrix([0, 0, symbols.omega_3]), Matrix([0, 0, symbols.domega_3])
    needed = TENSOR * rate + about.cross(TENSOR * about)
    for torque, value in zip(symbols.torque_b, needed, strict=True):
        yield Relation("rotation about the z axis", EULER, torque - value, {torque: "torque of"})


def _aircraft() -> Iterator[Relation]:
    """Yield Euler's equations of a body with the x-z plane as its plane of symmetry."""
    tensor = TENSOR.subs({symbols.I_xy: 0, symbols.I_yz: 0})
    rates = Matrix(symbols.omega_rates)
    needed = tensor * rates + OMEGA.cross(tensor * OMEGA)
    for torque, value in zip(symbols.torque_b, needed, strict=True):
        title = "a body with a plane of symmetry, by Euler's equations"
        yield Relation(title, EULER, torque - expand(value), {torque: "torque of"})

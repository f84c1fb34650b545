"""Relations of rotation about one axis: work, constant acceleration, springs, rolling bodies, pulleys, pendulums."""

from collections.abc import Iterator

from sympy import Expr, Matrix, Symbol, cancel, cos, expand, pi, sin, solve

from symrot import symbols
from symrot.checker.recognition.formulas.new_symbols import (
    AFTER,
    ALPHA,
    BEFORE,
    END,
    ENERGY,
    FALL,
    GYRATION,
    LENGTH,
    PERIOD,
    PULLEY,
    SLOPE,
    SPEED,
    START,
    STIFFNESS,
    TENSION,
    TIME,
    TORQUE,
    WORK,
)
from symrot.checker.recognition.formulas.relation import Relation
from symrot.inertia.solids import solid

__all__ = ["one_axis", "pendulums", "rolling"]

THETA, DTHETA, DDTHETA = symbols.theta, symbols.dtheta, symbols.ddtheta
A, C, ARM, MASS, G, SPIN = symbols.A, symbols.C, symbols.c_3, symbols.m, symbols.g, symbols.omega_3
PLANE, ROLLING, PENDULUM = (f"derivations/{name}.md" for name in ("planar_motion", "rolling", "pendulum"))


def one_axis() -> Iterator[Relation]:
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


def rolling() -> Iterator[Relation]:
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


def pendulums() -> Iterator[Relation]:
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

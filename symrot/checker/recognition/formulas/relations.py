"""Relations between quantities that books solve for one quantity or another, each derived from the laws of motion.

The condition of steady precession, for example, is solved for the spin, the torque and the moments of inertia.
"""

from collections.abc import Iterator

from sympy import (
    Expr,
    Matrix,
    Rational,
    Symbol,
    cancel,
    cos,
    diag,
    expand,
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
from symrot.checker.recognition.formulas.new_symbols import ENERGY, TILT, TORQUE, WHEEL_MOMENTUM
from symrot.checker.recognition.formulas.plane_relations import one_axis, pendulums, rolling
from symrot.checker.recognition.formulas.relation import Relation
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics import quaternion, rotation_vector
from symrot.kinematics.euler import rate_jacobian

__all__ = ["relations"]

PHI, THETA, PSI = symbols.angles
DPHI, DTHETA, DPSI = symbols.angle_rates
DDTHETA = symbols.ddtheta
A, B, C, ARM, MASS, G = symbols.A, symbols.B, symbols.C, symbols.c_3, symbols.m, symbols.g
HALF = Rational(1, 2)
SPIN = symbols.omega_3
HEAVY, FREE, WHEEL, EULER, AXIS = (
    f"derivations/{name}.md"
    for name in ("heavy_top", "symmetric_top", "gyroscopic_wheel", "euler_equations", "axis_and_angle")
)


def relations() -> Iterator[Relation]:
    """Yield the relations of mechanics from this module and from ``plane_relations``, in a fixed order.

    They are about rotation about one axis, rolling, pendulums, tops, free bodies, wheels and aircraft.
    """
    for group in (one_axis, rolling, pendulums, _steady, _heavy, _free, _planar, _aircraft, _wheel, _trace):
        yield from group()


def _wheel() -> Iterator[Relation]:
    """Yield Euler's equations of a body that carries a wheel rotating about a principal axis of the body."""
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
    """Yield the relation between the trace of a rotation matrix and the angle of the rotation."""
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
    """Yield relations for the steady precession of tops and wheels.

    The condition for steady precession, under a weight or under a torque, has two forms: one with the spin omega_3, the
    other with the rate psi' of the spin angle. Further relations state the smallest spin at which a top can precess
    steadily, the smallest spin at which an upright (sleeping) top is stable, the slow precession of a fast top, the
    torque of gravity, the gyroscopic torque of a wheel with a level axle, and the frequency of fast nutation.
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
    yield Relation(
        "an asymmetric body in terms of the ZXZ angles", HEAVY, ENERGY - general, {ENERGY: "kinetic energy of"}
    )
    length = symbols.n
    first, second, third = omega
    across = DPHI**2 * sin(THETA) ** 2 + DTHETA**2
    assert expand(first**2 + second**2 - across).subs(sin(PSI) ** 2, 1 - cos(PSI) ** 2).expand() == 0
    title, page = "the angular velocity in terms of the ZXZ angles", "derivations/euler_body_rates.md"
    square = expand(across + third**2).subs(sin(THETA) ** 2, 1 - cos(THETA) ** 2)
    yield Relation(title, page, length**2 - expand(square), {length: "length of"})
    title = "the transverse angular velocity in terms of the ZXZ angles"
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

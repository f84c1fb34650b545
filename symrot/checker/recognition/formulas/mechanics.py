"""Formulas of mechanics in books: tops, wheels, free symmetric bodies, rotation about one axis.

Formulas of heavy tops occur twice: with the weight W, and with m g.
"""

from collections.abc import Iterator

from sympy import Expr, Matrix, Rational, cancel, cos, diag, expand, factor, limit, oo, pi, sin, solve

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA
from symrot.checker.recognition.formulas.named import Named
from symrot.dynamics.equations import angular_acceleration
from symrot.inertia import tensor
from symrot.kinematics.euler import rate_jacobian

__all__ = ["one_axis", "tops"]

PHI, THETA, PSI = symbols.angles
DPHI, DTHETA, DPSI = symbols.angle_rates
A, C, ARM = symbols.A, symbols.C, symbols.c_3
P_PHI, P_THETA, P_PSI = symbols.momenta
HALF = Rational(1, 2)
WEIGHTS = (symbols.W, symbols.m * symbols.g)
HEAVY, FREE, TURNING, WHEEL = (
    f"derivations/{name}.md" for name in ("heavy_top", "symmetric_top", "planar_motion", "gyroscopic_wheel")
)


def tops() -> Iterator[Named]:
    """Yield energies, momenta and rates of heavy and free symmetric tops in the angles of ZXZ."""
    omega = (rate_jacobian("ZXZ") * Matrix(symbols.angle_rates)).subs(PSI, 0)  # the spin angle changes no energy
    spin = omega[2]
    kinetic = HALF * omega.dot(diag(A, A, C) * omega)
    yield "kinetic energy of a symmetric top", HEAVY, kinetic
    momenta = [kinetic.diff(rate) for rate in symbols.angle_rates]
    for name, momentum in zip(("precession", "nutation", "spin"), momenta, strict=True):
        yield f"momentum of {name} of a symmetric top", HEAVY, momentum
    rates = solve([momenta[0] - P_PHI, momenta[2] - P_PSI], [DPHI, DPSI], dict=True)[0]
    yield "rate of precession of a symmetric top from its momenta", HEAVY, rates[DPHI]
    yield "rate of spin of a symmetric top from its momenta", HEAVY, rates[DPSI]
    reduced = kinetic.subs(rates)
    (nutation,) = solve(momenta[1] - P_THETA, DTHETA)
    by_momenta = reduced.subs(DTHETA, nutation)
    yield "kinetic energy of a symmetric top from its momenta", HEAVY, by_momenta
    for weight in WEIGHTS:
        potential = weight * ARM * cos(THETA)
        yield "potential energy of a heavy top", HEAVY, potential
        yield "Lagrangian of a heavy top", HEAVY, kinetic - potential
        yield "energy of a heavy top", HEAVY, kinetic + potential
        yield "energy of a heavy top from its momenta", HEAVY, by_momenta + potential
        effective = (reduced + potential).subs(DTHETA, 0)
        yield "effective potential of a heavy top", HEAVY, effective
        without_spin = factor(cancel(effective - potential - P_PSI**2 / (2 * C))) + potential
        yield "effective potential of a heavy top without its spin", HEAVY, without_spin
        yield "energy of a heavy top in terms of the nutation angle alone", HEAVY, reduced + potential
        yield from _steady(effective, spin, weight)
    yield from _free(omega)


def _steady(effective: Expr, spin: Expr, weight: Expr) -> Iterator[Named]:
    """Yield the rates of steady precession of a heavy top, and the torque that a given precession needs.

    ``effective`` is the effective potential of the top, ``spin`` is omega_3 as a formula in the rates of the angles,
    and ``weight`` is W or m*g.
    """
    rate = symbols.n
    held = {P_PHI: P_PSI * cos(THETA) + A * rate * sin(THETA) ** 2}
    # steady at the minimum of the effective potential
    condition = expand(effective.diff(THETA).subs(held) / sin(THETA))
    roots = solve(condition, rate)
    by_spin = {P_PSI: C * symbols.omega_3}
    for root in sorted(roots, key=lambda root: root.subs({P_PSI: 5, A: 1, THETA: 1, weight: 1, ARM: 1}).evalf()):
        for values in ({}, by_spin):
            yield "rate of steady precession of a heavy top", HEAVY, root.subs(values)
    slow = limit(condition.subs(rate, symbols.epsilon / P_PSI), P_PSI, oo)
    (first,) = solve(slow, symbols.epsilon)
    for momentum in (P_PSI, C * symbols.omega_3, C * DPSI):
        yield "rate of slow precession of a fast top", HEAVY, first / momentum
    if weight is symbols.W:
        (fast,) = [root for root in solve(condition.subs(weight, 0), rate) if root != 0]
        yield "rate of fast precession of a top, or of a free symmetric body", HEAVY, fast
        yield "rate of precession of a free symmetric body", FREE, fast.subs(by_spin)
        needed = (condition.subs(weight, 0) * sin(THETA)).subs(rate, DPHI)
        torque = needed.subs(P_PSI, C * spin)
        yield "torque of steady precession", WHEEL, torque
        yield "torque of steady precession", WHEEL, needed.subs(by_spin)
        yield "torque of steady precession with a level axle", WHEEL, torque.subs(THETA, pi / 2)


def _free(omega: Matrix) -> Iterator[Named]:
    """Yield the rates of a free symmetric body: precession in the body, precession in space, and spin."""
    inertia = diag(A, A, C)
    alpha = angular_acceleration(inertia, OMEGA, Matrix([0, 0, 0]))
    yield (
        "rate at which the angular velocity of a free symmetric body goes round its axis",
        FREE,
        (-alpha[0] / symbols.omega_2),
    )
    (precession,) = solve((inertia * omega)[1].subs(DTHETA, 0) - symbols.H * sin(THETA), DPHI)
    yield "rate of precession of a free symmetric body", FREE, precession
    balance = A * DPHI * cos(THETA) - C * symbols.omega_3
    (by_spin,) = solve(balance.subs(symbols.omega_3, omega[2]), DPHI)
    yield "rate of precession of a free symmetric body from its spin", FREE, by_spin
    (by_rate,) = solve(balance, DPHI)
    (spin,) = solve((omega[2] - symbols.omega_3).subs(DPHI, by_rate), DPSI)
    yield "rate of spin of a free symmetric body", FREE, spin
    across, _, along = inertia * OMEGA.subs(symbols.omega_2, 0)
    yield "angle of the axis of a free symmetric body to its angular momentum, atan2", FREE, Matrix([across, along])


def one_axis() -> Iterator[Named]:
    """Yield the formulas of rotation about one axis, such as ``C*omega_3`` for the angular momentum."""
    # products of few symbols: only the name of a claim's quantity tells which one is meant
    along, inertia = Matrix([0, 0, symbols.omega_3]), diag(A, symbols.B, C)
    momentum, rate = inertia * along, Matrix([0, 0, symbols.domega_3])
    yield "kinetic energy of rotation about one axis", TURNING, along.dot(momentum) / 2
    yield "angular momentum about one axis", TURNING, momentum[2]
    (velocity,) = solve(momentum[2] - symbols.H, symbols.omega_3)
    yield "angular velocity about one axis", TURNING, velocity
    yield "torque about one axis", TURNING, (inertia * rate + along.cross(momentum))[2]
    acceleration = angular_acceleration(inertia, along, Matrix([0, 0, symbols.tau_3]))[2]
    yield "angular acceleration about one axis", TURNING, acceleration
    yield "power of a torque about one axis", "derivations/work_and_power.md", symbols.tau_3 * symbols.omega_3
    speed = symbols.v_x
    whole = HALF * symbols.m * speed**2 + along.dot(momentum) / 2
    yield "kinetic energy of a body that moves and rotates", "derivations/kinetic_energy.md", whole
    page = "derivations/parallel_axis.md"
    added = Matrix(tensor.inertia_of_point(symbols.m, (symbols.r, 0, 0)))[2, 2]
    yield "moment of inertia about a parallel axis (parallel-axis theorem)", page, C + added
    yield "moment of inertia from the radius of gyration", page, added
    (gyration,) = {root**2 for root in solve(added - C, symbols.r)}
    yield "radius of gyration, squared", page, gyration
    normal = Matrix(symbols.axis)
    (xx, yy, zz), (xy, xz, yz) = symbols.moments, symbols.products
    full = Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    yield "moment of inertia about an axis of any direction", page, expand(normal.dot(full * normal))
    for weight in WEIGHTS:
        restoring = -(-weight * ARM * cos(THETA)).diff(THETA)
        stiffness = -restoring.diff(THETA).subs(THETA, 0)
        pendulum = "derivations/pendulum.md"
        yield "angular acceleration of a physical pendulum", pendulum, restoring / A
        yield "frequency of a physical pendulum, rad/s, squared", pendulum, stiffness / A
        yield "period of a physical pendulum, squared", pendulum, (2 * pi) ** 2 / (stiffness / A)

"""Formulas of first courses, from cross products: torque of a force, angular momentum of a point, speed of a point."""

from collections.abc import Iterator

from sympy import Matrix, Symbol, cos, pi, sin

from symrot import symbols
from symrot.checker.recognition.formulas.named import Named
from symrot.checker.recognition.formulas.new_symbols import (
    DISTANCE,
    MOMENTUM_RATE,
    MOMENTUM_RATES,
    ONE_FORCE,
    ONE_MOMENTUM,
    POINT_MOMENTUM,
    SPEED,
)

__all__ = ["ANY_VECTORS", "GENERAL", "points"]

MOMENTUM, MOTION, POWER = (
    f"derivations/{name}.md" for name in ("angular_momentum", "relative_motion", "work_and_power")
)
ANGLE = symbols.theta

TORQUE, OF_POINT, BY_MOMENTUM = (
    "torque of a force", "angular momentum of a point mass", "angular momentum of a point mass from its momentum",
)  # fmt: skip
WORK = "work of a force"
ANY_VECTORS = (TORQUE, OF_POINT, BY_MOMENTUM, WORK)
"""Names of the formulas that are a product of two vectors, such as r x F.

Every cross or dot product has this form; so a claim means such a formula only with the letters that books use for it.
"""

GENERAL = (
    "torque from the rate of the angular momentum",
    "torque from the rate of the angular momentum about one axis",
)
"""Names of the formulas that are one symbol, or a vector of three symbols.

Any claim whose formula is one letter or vector would match; so a claim is recognised only if it has the letters that
books use.
"""


def points() -> Iterator[Named]:
    """Yield the formulas of forces, momenta and velocities of points, for vectors and for their lengths in a plane."""
    position, velocity, mass = Matrix(symbols.position), Matrix(symbols.velocity), symbols.m
    momentum = position.cross(mass * velocity)
    rate = velocity.cross(mass * velocity) + position.cross(mass * Matrix(symbols.acceleration))
    newton = {a: force / mass for a, force in zip(symbols.acceleration, symbols.force, strict=True)}
    torque = rate.subs(newton)
    by_momentum = momentum.subs({v: p / mass for v, p in zip(symbols.velocity, POINT_MOMENTUM, strict=True)})
    yield TORQUE, MOMENTUM, torque
    yield OF_POINT, MOMENTUM, momentum
    yield BY_MOMENTUM, MOMENTUM, by_momentum
    for name, formula, vector, length in (
        (TORQUE, torque, symbols.force, ONE_FORCE),
        (OF_POINT, momentum, symbols.velocity, SPEED),
        (BY_MOMENTUM, by_momentum, POINT_MOMENTUM, ONE_MOMENTUM),
    ):
        plane = dict(zip(symbols.position, (symbols.r, 0, 0), strict=True))
        plane |= dict(zip(vector, (length * cos(ANGLE), length * sin(ANGLE), 0), strict=True))
        across = formula.subs(plane)[2]
        yield f"{name} at an angle to the position", MOMENTUM, across
        yield f"{name} at a right angle to the position", MOMENTUM, across.subs(ANGLE, pi / 2)
    yield WORK, POWER, Matrix(symbols.force).dot(Matrix(symbols.offset))
    along = Matrix([DISTANCE, 0, 0]).dot(ONE_FORCE * Matrix([cos(ANGLE), sin(ANGLE), 0]))
    yield f"{WORK} at an angle to the displacement", POWER, along
    rates = Matrix(MOMENTUM_RATES)
    space, axis = GENERAL
    yield space, MOMENTUM, rates
    yield axis, MOMENTUM, MOMENTUM_RATE
    turned = Matrix(symbols.omega_b).cross(Matrix(symbols.momentum_b))
    yield "rate of the angular momentum in the body", MOMENTUM, Matrix(symbols.torque_b) - turned
    own = [momentum / moment for momentum, moment in zip(symbols.momentum_b, symbols.principal, strict=True)]
    yield "rate of the angular momentum of a free body", MOMENTUM, -Matrix(own).cross(Matrix(symbols.momentum_b))
    yield from _speeds()


def _speeds() -> Iterator[Named]:
    """Yield the speed and the accelerations of a point at a distance r from a fixed axis."""
    arm, turning = Matrix([symbols.r, 0, 0]), Matrix([0, 0, symbols.omega_3])
    velocity = turning.cross(arm)
    speed, inward = velocity[1], -turning.cross(velocity)[0]
    yield "speed of a point of a rotating body", MOTION, speed
    yield "centripetal acceleration of a point of a rotating body", MOTION, inward
    by_speed = inward.subs(symbols.omega_3, SPEED / (speed / symbols.omega_3))
    yield "centripetal acceleration of a point of a rotating body from its speed", MOTION, by_speed
    along = Matrix([0, 0, Symbol("alpha_a", real=True)]).cross(arm)[1]
    yield "tangential acceleration of a point of a rotating body", MOTION, along

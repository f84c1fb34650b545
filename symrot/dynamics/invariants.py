"""Conserved quantities: candidates that symmetries suggest, such as the energy, and a decision for each candidate.

A candidate F(t, states) is conserved if and only if ``partial F/partial t + grad F . rates`` is zero, which is decided
exactly. One that is not conserved is reported with the torques that change it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from sympy import Expr, Matrix, sqrt

from symrot import symbols
from symrot.dynamics.equations import Equations
from symrot.dynamics.structure import FieldTorque, Pattern, PrincipalInertia, Structure, TorqueStructure
from symrot.dynamics.torques import field_value
from symrot.exact import is_zero
from symrot.exact.ring.ratio import TooLarge
from symrot.kinematics.quaternion import quaternion_to_dcm

__all__ = ["Invariant", "find_invariants", "rate_along"]


TORQUE_PHRASES = {
    "constant_body": "the torque with constant body components",
    "constant_space": "the torque with constant space components",
    "expression": "the torque given by formulas",
    "rotor": "the rotor",
    "spring": "the spring",
}  # kinds of torque in sentences, if the name of the kind does not suit


@dataclass(frozen=True)
class Invariant:
    """A candidate for a conserved quantity, such as the energy, and whether it is conserved."""

    name: str
    unit: str
    value: Expr  # a formula in t, the states and the constants
    holds: bool
    # text for users, such as "changed by damping"; an undecided candidate does not hold, and says so
    reason: str


def rate_along(expression: Expr, equations: Equations) -> Expr:
    """Return the time derivative ``partial F/partial t + grad F . rates`` of the formula F = ``expression`` along the
    motion.
    """
    rates = zip(equations.states, equations.explicit_rates, strict=True)
    return expression.diff(symbols.t) + sum(expression.diff(state) * rate for state, rate in rates)


def _candidates(equations: Equations, structure: Structure) -> Iterable[tuple[str, str, Expr, Expr]]:
    """Yield candidates for conserved quantities, such as energy and angular momentum, as (name, unit, value, tested).

    The formula ``tested`` is constant exactly if the value is constant, and a proof of this is shorter: for a norm it
    is the square of the norm.
    """
    momentum, energy = equations.momentum_b, equations.kinetic_energy + equations.potential
    yield "energy", "J", energy, energy
    if equations.motion.quaternion is None:
        square = momentum.dot(momentum)
        yield "angular momentum", "kg m^2/s", sqrt(square), square
    else:
        momentum_s = quaternion_to_dcm(equations.motion.quaternion) * momentum
        for axis, component in zip("xyz", momentum_s, strict=True):
            yield f"angular momentum {axis}", "kg m^2/s", component, component
        for torque in structure.torques:
            yield from _of_torque(torque, momentum_s, energy)
    for number in range(3):
        others = [equations.motion.inertia[i, i] for i in range(3) if i != number]
        symmetric = others[0] == others[1] and isinstance(structure.inertia, PrincipalInertia)
        if symmetric and structure.planar in (None, number):
            spin = equations.motion.omega_b[number]
            yield f"spin omega_{number + 1}", "rad/s", spin, spin


def _of_torque(torque: TorqueStructure, momentum_s: Matrix, energy: Expr) -> Iterable[tuple[str, str, Expr, Expr]]:
    """Yield the quantities that a torque may conserve, as (name, unit, value, tested).

    Gravity gives the vertical angular momentum, and the gravity gradient the Jacobi integral; other torques give
    nothing. ``tested`` is a formula that is constant exactly if the value is, see :func:`_candidates`; here it is the
    value itself.
    """
    if not isinstance(torque, FieldTorque):
        return
    if torque.kind == "gravity" and (direction := torque.vector("direction")).count(Pattern.ZERO) < 2:
        down = field_value(f"{torque.prefix}direction", direction)
        vertical = -momentum_s.dot(down)
        yield "vertical angular momentum", "kg m^2/s", vertical, vertical
    if torque.kind == "gravity_gradient":
        jacobi = energy - symbols.constant(f"{torque.prefix}mean_motion") * momentum_s[2]
        yield "Jacobi integral", "J", jacobi, jacobi


def _reason(name: str, holds: bool, equations: Equations, kinds: Sequence[str]) -> str:
    if holds and name.startswith("spin"):
        axis = name[-1]
        others = " and ".join(number for number in "123" if number != axis)
        return f"the moments about axes {others} are equal, and no torque acts about axis {axis}"
    if not kinds:
        return "no torque acts"
    acting = _listed(kinds)
    if not holds:
        without = [kind for kind, law in zip(kinds, equations.laws, strict=True) if law.potential is None]
        guilty = (without or kinds) if name == "energy" else kinds
        return f"changed by {_listed(guilty)}"
    if name == "energy":
        return "; ".join(dict.fromkeys(law.keeps for law in equations.laws if law.keeps)) or f"{acting} does no work"
    if name == "Jacobi integral":
        return "the gravity gradient is constant in axes that rotate with the orbit"
    if name == "angular momentum":
        return f"{acting} changes only the direction of the angular momentum in the body"
    axis = "the vertical" if name.startswith("vertical") else f"the space axis {name[-1]}"
    return f"{acting} has no moment about {axis}"


def _listed(kinds: Sequence[str]) -> str:
    """Return kinds of torques as words for a sentence, each kind once, such as "gravity and damping"."""
    return " and ".join(TORQUE_PHRASES.get(kind, kind.replace("_", " ")) for kind in dict.fromkeys(kinds))


def find_invariants(equations: Equations, structure: Structure) -> tuple[Invariant, ...]:
    """Return the conserved quantities of the motion of ``structure``, followed by the candidates that are not
    conserved.
    """
    kinds = [torque.kind for torque in structure.torques]
    candidates = []
    for name, unit, value, tested in _candidates(equations, structure):
        try:
            holds = is_zero(rate_along(tested, equations), equations.relations)
            reason = _reason(name, holds, equations, kinds)
        except TooLarge:
            holds, reason = False, "not decided: the formula of its rate is too large"
        candidates.append(Invariant(name, unit, value, holds, reason))
    return tuple(sorted(candidates, key=lambda item: not item.holds))

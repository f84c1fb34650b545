"""The torques of :mod:`symrot.dynamics.torque_kinds` as formulas: a table with one function for each kind.

The function of a kind returns a torque law: the formula of the torque, the potential energy that the torque contributes
(None if it has none), and the angular momentum that its device, such as a rotor, adds to that of the body.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Any

import sympy
from sympy import (
    Expr,
    ImmutableMatrix,
    Integer,
    Matrix,
    Mul,
    Rational,
    Symbol,
    atan,
    cos,
    exp,
    log,
    sin,
    sqrt,
    tanh,
    zeros,
)

from symrot import symbols
from symrot.dynamics.structure import FieldPattern, FormulaTorque, Pattern, TorqueStructure, component_names
from symrot.dynamics.torque_kinds import EXPRESSION_NAMES, TORQUE_KINDS
from symrot.errors import InputError
from symrot.formula.switches import CHANGING, has_switches
from symrot.formula.tree import FUNCTIONS, Node, children, evaluate, parse, with_children
from symrot.kinematics.quaternion import conjugate, quaternion_product, quaternion_rates, quaternion_to_dcm
from symrot.symbols import constant

__all__ = [
    "LAWS",
    "LEVELLING",
    "Motion",
    "TorqueLaw",
    "collected_cross",
    "field_value",
    "formula",
    "torque_law",
    "torque_of_potential",
]


LEVELLING = (tanh, atan, exp, log)  # sums with these, such as 1 + tanh(-20), may round to their limits, here 0


@dataclass(frozen=True)
class Motion:
    """The quantities on which a torque may depend (angular velocity, attitude, inertia), as formulas in the states."""

    omega_b: Matrix  # rad/s, shape (3, 1)
    quaternion: tuple[Expr, ...] | None  # body to space; None when the attitude is not computed
    inertia: Matrix  # kg m^2, shape (3, 3)

    def to_body(self, vector_s: Matrix) -> Matrix:
        """Return the body components of ``vector_s``, given in space components, as formulas in the quaternion."""
        return quaternion_to_dcm(self.quaternion).T * vector_s


@dataclass(frozen=True)
class TorqueLaw:
    """The formula of one torque in body components, with the potential and the angular momentum that it contributes."""

    torque: Matrix = field(default_factory=lambda: zeros(3, 1))
    potential: Expr | None = None  # J; None if the torque has no potential
    momentum: Matrix = field(default_factory=lambda: zeros(3, 1))  # kg m^2/s, relative to the body
    definitions: tuple[tuple[Symbol, Expr], ...] = ()  # named quantities that the torque uses
    keeps: str = ""  # why the torque conserves energy


def _constant_body(motion: Motion, torque: Matrix) -> TorqueLaw:
    return TorqueLaw(torque)


def _constant_space(motion: Motion, torque: Matrix) -> TorqueLaw:
    return TorqueLaw(motion.to_body(torque))


def _gravity(motion: Motion, weight: Expr, center_of_mass: Matrix, direction: Matrix) -> TorqueLaw:
    down_b = motion.to_body(direction)
    return TorqueLaw(
        weight * center_of_mass.cross(down_b),
        potential=-weight * center_of_mass.dot(down_b),
        keeps="gravity has a potential",
    )


def _gravity_gradient(motion: Motion, mean_motion: Expr) -> TorqueLaw:
    phase = mean_motion * symbols.t
    radius_b = motion.to_body(Matrix([cos(phase), sin(phase), 0]))
    named = Matrix([constant(f"radius_{i}") for i in (1, 2, 3)])
    return TorqueLaw(
        3 * mean_motion**2 * collected_cross(named, motion.inertia * named, named),
        potential=3 * mean_motion**2 * radius_b.dot(motion.inertia * radius_b) / 2,
        keeps="the gravity gradient has a potential",
        definitions=tuple(zip(named, radius_b, strict=True)),
    )


def _damping(motion: Motion, linear: Matrix, quadratic: Expr) -> TorqueLaw:
    omega_b = motion.omega_b
    torque = -linear.multiply_elementwise(omega_b)
    if quadratic != 0:
        torque -= quadratic * sqrt(omega_b.dot(omega_b)) * omega_b
    return TorqueLaw(torque)


def _spring(motion: Motion, stiffness: Expr, attitude: Matrix) -> TorqueLaw:
    error = quaternion_product(conjugate(tuple(attitude)), motion.quaternion)
    return TorqueLaw(
        -2 * stiffness * error[0] * Matrix(error[1:]),
        potential=2 * stiffness * (1 - error[0] ** 2),
        keeps="the spring has a potential",
    )


def _rotor(motion: Motion, angular_momentum: Matrix) -> TorqueLaw:
    return TorqueLaw(potential=Integer(0), momentum=angular_momentum, keeps="the rotor does no work on the body")


def _expression(motion: Motion, torque: Matrix, frame: str) -> TorqueLaw:
    return TorqueLaw(torque if frame == "body" else motion.to_body(torque))


def collected_cross(left: Matrix, right: Matrix, variables: Matrix) -> Matrix:
    """Return ``left x right`` with equal products of ``variables`` collected, as in ``(C - B) r_2 r_3``."""
    # a term is 0 at once if the moments B and C have the same symbol
    return _collected_cross(ImmutableMatrix(left), ImmutableMatrix(right), ImmutableMatrix(variables)).as_mutable()


@lru_cache(maxsize=64)  # cached, since scenes differ more in torques than in tensors
def _collected_cross(left: ImmutableMatrix, right: ImmutableMatrix, variables: ImmutableMatrix) -> ImmutableMatrix:
    pairs = [a * b for a, b in combinations_with_replacement(variables, 2)]
    return ImmutableMatrix(left.cross(right).applyfunc(lambda entry: entry.expand().collect(pairs)))


LAWS: dict[str, Callable[..., TorqueLaw]] = {
    "constant_body": _constant_body,
    "constant_space": _constant_space,
    "gravity": _gravity,
    "gravity_gradient": _gravity_gradient,
    "damping": _damping,
    "spring": _spring,
    "rotor": _rotor,
    "expression": _expression,
}
if LAWS.keys() != TORQUE_KINDS.keys():
    raise AssertionError(f"expected a law for each kind of torque, got none for {LAWS.keys() ^ TORQUE_KINDS.keys()}")


_FUNCTIONS: dict[str, Callable[..., Expr]] = {
    name: sympy.Abs if name == "abs" else getattr(sympy, name) for name in FUNCTIONS
}


def formula(node: Node, values: Mapping[str, Expr]) -> Expr:
    """Return a formula tree as an exact SymPy expression; ``values`` holds the expression of each name except pi."""
    known = {"pi": sympy.pi, **values}
    node = _with_brackets(node, known)
    return evaluate(node, known, _FUNCTIONS, _rational)


def _rational(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


def _with_brackets(node: Node, known: dict[str, Expr]) -> Node:
    """Return a formula in which new names replace products such as ``2*(1 + tanh(u))``, so that they stay factored.

    The product that a name stands for, with its bracket not expanded, is added to the map ``known``.
    """
    parts = [_with_brackets(child, known) for child in children(node)]
    factors = [part for part in parts if part[0] == "number"]
    if len(factors) == 1 and (node[0] == "*" or (node[0] == "/" and parts[1] is factors[0])):
        bracket = evaluate(next(part for part in parts if part[0] != "number"), known, _FUNCTIONS, _rational)
        # SymPy would expand the product and merge its constant with others; a rounding error then remains where the sum
        # tends to zero.
        if bracket.is_Add and bracket.atoms(*LEVELLING):
            number = _rational(factors[0][1])
            name = f"bracket {len(known)}"
            known[name] = Mul(1 / number if node[0] == "/" else number, bracket, evaluate=False)
            return ("symbol", name)
    return with_children(node, parts)


def torque_law(structure: TorqueStructure, motion: Motion) -> TorqueLaw:
    """Return the law of one torque (its formula, potential, ..) in terms of the quantities of ``motion``."""
    if isinstance(structure, FormulaTorque):
        values = formula_values(structure, motion)
        torque = Matrix([_finite_formula(source, values) for source in structure.formulas])
        return _expression(motion, torque, structure.frame)
    arguments = {name: field_value(f"{structure.prefix}{name}", pattern) for name, pattern in structure.fields}
    return LAWS[structure.kind](motion, **arguments)


def formula_values(structure: FormulaTorque, motion: Motion) -> dict[str, Expr]:
    """Return the values, as expressions, of all names that the formulas of an ``expression`` torque may contain."""
    values = dict(zip(EXPRESSION_NAMES[:4], (symbols.t, *motion.omega_b), strict=True))
    values.update(zip(EXPRESSION_NAMES[4:], motion.quaternion or (), strict=False))
    # parameters and modes; a mode is a symbol for the present value of a function that jumps, such as sign
    values.update({name: constant(f"{structure.prefix}{name}") for name in structure.parameters})
    return values


def _finite_formula(source: str, values: Mapping[str, Expr]) -> Expr:
    node = parse(source)
    result = formula(node, values)
    if result.has(sympy.nan, sympy.zoo, sympy.oo, -sympy.oo):
        raise InputError(f"torque: expected a formula with finite values, got {source!r}, which divides by zero")
    if result.has(sympy.I):
        raise InputError(f"torque: expected a formula with real values, got {source!r}, whose values are not real")
    for size in () if has_switches(node) else result.atoms(sympy.Abs):  # made by SymPy, so that no switch is known
        if size.free_symbols & set().union(*(values[name].free_symbols for name in CHANGING & set(values))):
            raise InputError(
                f"torque: expected every absolute value to be written with abs, got {source!r}, which contains the "
                f"absolute value of {size.args[0]} in another form, as sqrt(x^2) is that of x; write "
                f"abs({size.args[0]})"
            )
    return result


def field_value(name: str, pattern: FieldPattern) -> Any:
    """Return the value of a torque's field ``name``: a scalar, vector or quaternion of symbols and exact numbers."""
    if isinstance(pattern, Pattern):
        return constant(name) if pattern is Pattern.FREE else Integer(pattern.value)
    return Matrix(list(map(field_value, component_names(name, pattern), pattern)))


def torque_of_potential(law: TorqueLaw) -> Matrix:
    """Return the torque, body components, that a law's potential exerts.

    It is minus the derivatives of the potential with respect to small rotations about the body axes.
    """
    # compared with the law's own formula, to prove that both agree
    rates = quaternion_rates("body") * Matrix(symbols.omega_b)
    gradient = Matrix([sympy.S.Zero if law.potential is None else law.potential]).jacobian(symbols.quaternion)
    return -ImmutableMatrix((gradient * rates).jacobian(symbols.omega_b).T)

"""Equations of motion of a rigid body: Euler's equations and the quaternion rates, as formulas of states and constants.

In body axes: ``I domega/dt = tau - omega x (I omega + h)`` and ``dq/dt = 1/2 q (0, omega_b)``. A structure says which
constants are zero, equal or free, and which states the equations have. Proof: ``derivations/euler_equations.md``,
``derivations/quaternion_rates.md``.
"""

from dataclasses import dataclass, replace
from functools import reduce
from operator import add
from typing import Any

from sympy import Expr, Integer, Matrix, S, Symbol, cos, diag, eye, sin, zeros

from symrot import symbols
from symrot.dynamics.structure import FormulaTorque, InertiaTensor, Pattern, PrincipalInertia, Structure
from symrot.dynamics.torques import Motion, TorqueLaw, collected_cross, formula, formula_values, torque_law
from symrot.errors import InputError
from symrot.formula.tree import parse
from symrot.kinematics.euler import dcm, quaternion_of_euler, rate_jacobian
from symrot.kinematics.quaternion import quaternion_product, quaternion_rates, unit_relation
from symrot.symbols import constant

__all__ = ["Equations", "angular_acceleration", "equations_of_motion", "euler_equations", "inertia_matrix", "inverse"]

PLANAR_ANGLE = constant("theta")
TENSOR_NAMES = (("I_xx", "I_xy", "I_xz"), ("I_xy", "I_yy", "I_yz"), ("I_xz", "I_yz", "I_zz"))


@dataclass(frozen=True)
class AngleMotion(Motion):
    """The symbols of a motion whose attitude is given by Euler angles (of ``sequence``) instead of a quaternion."""

    sequence: str

    def to_body(self, vector_s: Matrix) -> Matrix:
        """Return the body components of ``vector_s``, given in space components, as formulas in the angles."""
        return dcm(self.sequence).T * vector_s


@dataclass(frozen=True)
class Equations:
    """First-order equations of motion, ``d(states)/dt = rates``, and the quantities from which they were derived."""

    states: tuple[Symbol, ...]
    rates: tuple[Expr, ...]  # d(states)/dt
    definitions: tuple[tuple[Symbol, Expr], ...]  # named quantities that the rates use
    motion: Motion  # omega_b, attitude and inertia as formulas in t and the states
    laws: tuple[TorqueLaw, ...]
    momentum_b: Matrix  # I omega + h, kg m^2/s, body components
    relations: tuple[Expr, ...]  # expressions that are always zero: the squared norms of unit vectors minus 1
    # pairs (symbol, value): the symbol replaces a sign function in a torque while the motion stays on a jump: sliding()
    modes: tuple[tuple[Symbol, Expr], ...] = ()
    attraction: tuple[Expr, ...] = ()  # expressions that are positive while nearby motions return to these jumps

    @property
    def explicit_rates(self) -> tuple[Expr, ...]:
        """The rates as formulas in t, the states and the constants, with named intermediate quantities replaced by
        their formulas.
        """
        rates = self.rates
        for symbol, value in reversed(self.definitions):
            rates = tuple(rate.xreplace({symbol: value}) for rate in rates)
        return rates

    @property
    def kinetic_energy(self) -> Expr:
        """The kinetic energy ``omega . I omega / 2``, J."""
        omega_b = self.motion.omega_b
        return omega_b.dot(self.motion.inertia * omega_b) / 2

    @property
    def potential(self) -> Expr:
        """The sum of the potential energies, J, of all torques that have a potential."""
        return reduce(add, (law.potential for law in self.laws if law.potential is not None), S.Zero)


def inertia_matrix(inertia: PrincipalInertia | InertiaTensor) -> Matrix:
    """Return the inertia tensor, shape (3, 3), as a matrix of symbols: moments ``"AAC"`` give ``diag(A, A, C)``."""
    if isinstance(inertia, PrincipalInertia):
        moments = dict(zip("ABC", symbols.principal, strict=True))
        return diag(*(moments[name] for name in inertia.moments))
    entries = {str(s): s for s in symbols.moments + symbols.products}
    return Matrix(3, 3, [entries[name] if name in inertia.entries else S.Zero for row in TENSOR_NAMES for name in row])


def angular_acceleration(inertia: Matrix, omega_b: Matrix, torque: Matrix, momentum: Matrix | None = None) -> Matrix:
    """Return ``I^-1 (tau - omega x (I omega + h))``, rad/s^2, body components, shape (3, 1).

    Parameters
    ----------
    inertia : Matrix, shape (3, 3)
        Tensor I, kg m^2, about the centre of mass or a fixed point.
    omega_b : Matrix, shape (3, 1)
        Angular velocity, body components, rad/s.
    torque : Matrix, shape (3, 1)
        Torque tau about the same point, body components, N m.
    momentum : Matrix, shape (3, 1), optional
        Angular momentum h of an internal rotor, kg m^2/s.
    """
    rotor = zeros(3, 1) if momentum is None else momentum
    gyroscopic = collected_cross(inertia * omega_b, omega_b, omega_b)  # (B - C) omega_2 omega_3, ...
    return inverse(inertia) * (torque - omega_b.cross(rotor) + gyroscopic)


def euler_equations(inertia: Any = symbols.principal, torque: Any = symbols.torque_b) -> Matrix:
    """Return the angular acceleration of a rigid body: the solution of Euler's equations in body axes.

    Parameters
    ----------
    inertia : 3 principal moments or 3x3 tensor, of Expr
        Inertia, kg m^2, about the centre of mass or a fixed point.
    torque : 3 Expr, optional
        Torque, N m, about the same point, body components; ``None`` for a free body.

    Returns
    -------
    Matrix, shape (3, 1)
        Angular acceleration, rad/s^2, body components, as formulas in omega_1, omega_2, omega_3.

    Raises
    ------
    InputError
        If the inertia is not 3 moments or a symmetric 3x3 tensor, if it has no inverse, or if the torque does not have
        3 components.

    Notes
    -----
    Proof: ``derivations/euler_equations.md``. Source: Landau & Lifshitz, Mechanics, 3rd ed., eq. (36.4).

    Examples
    --------
    >>> euler_equations(torque=None)[0]
    omega_2*omega_3*(B - C)/A
    """
    entries = _read(inertia, "inertia: expected 3 principal moments or a symmetric 3x3 tensor in kg m^2")
    tensor = diag(*entries) if len(entries) == 3 else entries
    if tensor.shape != (3, 3) or not tensor.is_symmetric():
        raise InputError(f"inertia: expected 3 principal moments or a symmetric 3x3 tensor in kg m^2, got {inertia}")
    if tensor.det().expand() == 0:
        raise InputError(f"inertia: expected an invertible tensor, without a principal moment of zero, got {inertia}")
    expected = "torque: expected 3 body components in N m"
    moment = zeros(3, 1) if torque is None else _read(torque, expected)
    if len(moment) != 3:
        raise InputError(f"{expected}, got {torque}")
    return angular_acceleration(tensor, Matrix(symbols.omega_b), moment.reshape(3, 1))


def _read(values: Any, expectation: str) -> Matrix:
    try:
        return Matrix(values)
    except (TypeError, ValueError):
        raise InputError(f"{expectation}, got {values!r}") from None


def inverse(tensor: Matrix) -> Matrix:
    """Return the inverse of a symbolic 3 x 3 matrix, computed from the cross products of its columns."""
    if tensor.is_diagonal():
        return diag(*(1 / entry for entry in tensor.diagonal()))
    first, second, third = (tensor.col(i) for i in range(3))
    # the determinant must not be zero
    rows = [second.cross(third), third.cross(first), first.cross(second)]
    return Matrix.hstack(*rows).T / first.dot(rows[0]).expand()


def _motion(structure: Structure) -> tuple[Motion, tuple[Symbol, ...], list[Expr]]:
    """Return (motion, attitude states, relations) for a structure, which says which constants are zero or equal.

    The motion has the symbols of angular velocity, attitude and inertia. The relations are expressions that are always
    zero: ``|q|^2 - 1`` if there is a quaternion q of symbols.
    """
    inertia, axis = inertia_matrix(structure.inertia), structure.planar
    turning = [
        S.Zero if pattern is Pattern.ZERO else w for w, pattern in zip(symbols.omega_b, structure.constant, strict=True)
    ]
    if axis is None:
        # attitude states: none, three Euler angles, or the quaternion with the relation |q|^2 - 1
        omega_b = Matrix(turning)
        if not structure.attitude:
            return Motion(omega_b, None, inertia), (), []
        if sequence := structure.sequence:
            return AngleMotion(omega_b, tuple(quaternion_of_euler(sequence)), inertia, sequence), symbols.angles, []
        return Motion(omega_b, symbols.quaternion, inertia), symbols.quaternion, [unit_relation(symbols.quaternion)]
    # about one axis: a single angle
    omega_b = Matrix([w if i == axis else 0 for i, w in enumerate(turning)])
    if not structure.attitude:
        return Motion(omega_b, None, inertia), (), []
    start = [
        constant(f"initial_q{i}") if pattern is Pattern.FREE else Integer(pattern.value)
        for i, pattern in enumerate(structure.initial_quaternion or ())
    ]
    relations = [unit_relation(start)] if any(q.is_Symbol for q in start) else []
    if omega_b[axis] == 0:
        return Motion(omega_b, tuple(start), inertia), (), relations
    turn = [cos(PLANAR_ANGLE / 2), *(sin(PLANAR_ANGLE / 2) * eye(3).col(axis))]
    return Motion(omega_b, tuple(quaternion_product(start, turn)), inertia), (PLANAR_ANGLE,), relations


def equations_of_motion(structure: Structure) -> Equations:
    """Return the equations of motion of all scenes that have the same structure.

    A structure says which constants are zero, equal or free, and which torques act.
    """
    motion, attitude, relations = _motion(structure)
    laws = tuple(torque_law(torque, motion) for torque in structure.torques)
    torque = reduce(add, (law.torque for law in laws), zeros(3, 1))
    rotor = reduce(add, (law.momentum for law in laws), zeros(3, 1))
    momentum_b = motion.inertia * motion.omega_b + rotor
    definitions = tuple(item for law in laws for item in law.definitions)
    if motion.inertia.is_diagonal():
        acceleration = angular_acceleration(motion.inertia, motion.omega_b, torque, rotor)
    else:
        named_l, named_m = (Matrix([constant(f"{letter}_{i}") for i in (1, 2, 3)]) for letter in "LM")
        moment = torque - motion.omega_b.cross(named_l)
        definitions += (*zip(named_l, momentum_b, strict=True), *zip(named_m, moment, strict=True))
        acceleration = inverse(motion.inertia) * named_m
    states = [symbols.omega_b[i] for i in structure.moving]
    rates = [acceleration[i] for i in structure.moving]
    if isinstance(motion, AngleMotion):
        rates += list(rate_jacobian(motion.sequence).inverse * motion.omega_b)
    elif structure.planar is None:
        rates += list(quaternion_rates("body") * motion.omega_b) if attitude else []
    elif attitude:
        rates.append(motion.omega_b[structure.planar])
    equations = Equations((*states, *attitude), tuple(rates), definitions, motion, laws, momentum_b, tuple(relations))
    # Guards (formulas at whose zeros a torque jumps) that stay at zero, as for a body held at rest by dry friction.
    held = [(torque, mode) for torque in structure.formula_torques for mode in torque.held]
    return sliding(equations, held) if held else equations


def sliding(equations: Equations, held: list[tuple[FormulaTorque, str]]) -> Equations:
    """Return the equations of a motion along a jump of a torque, such as dry friction that holds a body at rest.

    ``held`` pairs each torque with the symbol (mode) that replaces its sign function.

    Raises
    ------
    InputError
        If the condition that the motion stays on the jump does not determine the modes.
    """
    rates = dict(zip(equations.states, equations.explicit_rates, strict=True))
    names, pace, guards = [], [], []
    for torque, mode in held:
        values = formula_values(torque, equations.motion)
        guard = formula(parse(next(switch.guard for switch in torque.switches if switch.mode == mode)), values)
        names.append(values[mode])
        guards.append(guard)
        pace.append(guard.diff(symbols.t) + reduce(add, (guard.diff(y) * rate for y, rate in rates.items()), S.Zero))
    # The rates are linear in the modes s: dg/dt = a + B s = 0 gives s = -B^-1 a (V. I. Utkin's equivalent control; for
    # one guard, A. F. Filippov's convex combination).
    matrix = Matrix([[entry.diff(name) for name in names] for entry in pace])
    rest = Matrix(pace).subs(dict.fromkeys(names, S.Zero))
    determinant = matrix.det().expand()
    if matrix.free_symbols & set(names) or determinant == 0:
        raise InputError(
            "torque: the equations do not determine the value of the torque while the states stay at its jump: they "
            "have no solution or several; change the torque"
        )
    modes = tuple(zip(names, -(matrix.adjugate() * rest) / determinant, strict=True))
    still = [S.Zero if state in guards else rate for state, rate in zip(equations.states, equations.rates, strict=True)]
    return replace(equations, rates=tuple(still), definitions=(*modes, *equations.definitions), modes=modes,
                   # Nearby motions return to the surfaces while all eigenvalues of B have negative real parts, that is,
                   # while these determinants are positive.
                   attraction=hurwitz_determinants(matrix))  # fmt: skip


def hurwitz_determinants(matrix: Matrix) -> tuple[Expr, ...]:
    """Return expressions that are all positive if and only if all eigenvalues of a matrix have negative real parts.

    Examples
    --------
    >>> from sympy import Matrix
    >>> hurwitz_determinants(Matrix([[-1, 2], [-2, -1]]))
    (2, 10)
    """
    size = matrix.rows
    power, coefficients = matrix, [S.One, -matrix.trace()]
    for k in range(2, size + 1):  # D. K. Faddeev's and U. J. J. Le Verrier's recurrence
        power = matrix * (power + coefficients[-1] * eye(size))
        coefficients.append(-power.trace() / k)

    def entry(i: int, j: int) -> Expr:
        k = 2 * j - i + 1
        return coefficients[k] if 0 <= k <= size else S.Zero

    # Leading principal minors of the Hurwitz matrix of the characteristic polynomial: F. R. Gantmacher, The Theory of
    # Matrices, vol. 2, ch. XV.
    hurwitz = Matrix(size, size, entry)
    return tuple(hurwitz[:k, :k].det() for k in range(1, size + 1))

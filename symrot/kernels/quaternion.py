"""Kernels of unit quaternions: conversion to and from the rotation matrix, product, rotation of a vector, rates."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from sympy import Expr, ImmutableMatrix, Matrix, Symbol, eye, sqrt

from symrot import symbols
from symrot.kernels.definition import Definition, Law, argument, boxed, result
from symrot.kernels.removable import select_ge
from symrot.kinematics.quaternion import (
    conjugate,
    norm_squared,
    quaternion_of_dcm,
    quaternion_product,
    quaternion_to_dcm,
    rotation_relations,
    unit_relation,
)
from symrot.kinematics.rotations import skew

__all__ = ["OMEGA", "QUATERNION", "QUATERNION_BOX", "Named", "dcm_by_halves", "definitions", "halved",
           "quaternion_rate", "turned"]  # fmt: skip

OMEGA = {"body": symbols.omega_b, "space": symbols.omega_s}
QUATERNION = argument("q", "in", symbols.quaternion, "attitude, body to space")
QUATERNION_BOX = boxed(symbols.quaternion, -1, 1)

Named = tuple[tuple[Symbol, Expr], ...]  # symbols that formulas use, each with its definition

_DERIVATION = "derivations/quaternion_rates.md"
_UNIT = "unit quaternions"


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of quaternions: the function derives its arguments and formulas."""
    for name, make in _KINDS.items():
        yield name, partial(make, name)


def dcm_by_halves(scalar: Expr, axis: Sequence[Expr], doubled: Sequence[Expr]) -> tuple[Named, ImmutableMatrix]:
    """Return (definitions, matrix): the rotation matrix of a quaternion q with the parts ``scalar`` and ``axis``.

    ``doubled`` is ``t = 2*axis/|q|^2``; for a unit quaternion it is ``2*axis``. The matrix is ``1 + scalar [t] +
    [t][axis]``, where [v] is the matrix of the cross product with v. It contains new symbols, for the components of t
    and for one sum; the definitions are pairs (symbol, formula).
    """
    twice = tuple(Symbol(f"twice_{i}", real=True) for i in "123")
    square = skew(twice) * skew(axis)
    # [t][axis] is symmetric, so each product is computed once.
    symmetric = ImmutableMatrix(3, 3, lambda i, j: square[min(i, j), max(i, j)])
    matrix = (eye(3) + scalar * skew(twice) + symmetric).as_mutable()
    lost = Symbol("lost_2", real=True)  # 1 - (a + b) has a shorter chain of operations than 1 - a - b
    matrix[1, 1] = 1 - lost
    return (*zip(twice, doubled, strict=True), (lost, -square[1, 1])), ImmutableMatrix(matrix)


def halved(omega: Sequence[Expr]) -> tuple[Named, tuple[Symbol, ...]]:
    """Return (definitions, symbols) of half an angular velocity; definitions are pairs (symbol, component/2)."""
    half = tuple(Symbol(f"half_{i}", real=True) for i in "123")
    return tuple(zip(half, (w / 2 for w in omega), strict=True)), half


def quaternion_rate(q: Sequence[Expr], half: Sequence[Expr], frame: str = "body") -> ImmutableMatrix:
    """Return ``dq/dt`` from ``half``, half the angular velocity in body or space components, as ``frame`` says.

    It is the product ``q (0, half)`` for body components, and ``(0, half) q`` for space components.
    """
    return quaternion_product(q, [0, *half]) if frame == "body" else quaternion_product([0, *half], q)


def _dcm(name: str) -> Definition:
    q0, *axis = symbols.quaternion
    named, matrix = dcm_by_halves(q0, axis, [2 * q for q in axis])

    def laws() -> tuple[Law, ...]:
        entries, q = Matrix(3, 3, symbols.rotation_entries), symbols.quaternion
        turned = Matrix.hstack(
            *(quaternion_product(q, [0, *axis], conjugate(q))[1:, 0] for axis in Matrix.eye(3).tolist())
        )
        return (
            Law("the columns are the rotated axes q e q*", tuple(entries - turned), (unit_relation(),)),
            Law("the matrix is orthogonal", tuple(entries.T * entries - Matrix.eye(3)), (unit_relation(),)),
        )

    return Definition(
        name, "direction cosine matrix dcm_sb of a unit quaternion; v_s = dcm_sb v_b, row by row", (QUATERNION,),
        (result("dcm", matrix, symbols.rotation_entries, "entry of dcm_sb"),),
        _UNIT, "derivations/euler_parameters.md", QUATERNION_BOX, laws, named,
    )  # fmt: skip


def _of_dcm(name: str) -> Definition:
    matrix = Matrix(3, 3, symbols.rotation_entries)
    branches = [_branch(matrix, pivot) for pivot in range(4)]
    first, second = (_larger(a, b) for a, b in (branches[:2], branches[2:]))
    divisor, row = _larger(first, second)
    quotient = 2 * sqrt(divisor)
    formulas = [entry / quotient for entry in row]

    def laws() -> tuple[Law, ...]:
        q = symbols.quaternion
        return (
            Law(
                "the dcm of the quaternion is the given rotation matrix",
                tuple(quaternion_to_dcm(q) - matrix),
                rotation_relations(matrix),
            ),
        )

    return Definition(
        name, "quaternion of a direction cosine matrix dcm_sb, by the branch that divides by its largest component",
        (argument("dcm", "in", symbols.rotation_entries, "entry of dcm_sb, row by row"),),
        (result("q", formulas, symbols.quaternion, "attitude, body to space"),),
        "rotations; q and -q are one attitude", "derivations/euler_parameters.md",
        boxed(symbols.rotation_entries, -1, 1), laws,
    )  # fmt: skip


Branch = tuple[Expr, list[Expr]]  # four times the square of a component, and its products with all components


def _branch(matrix: Matrix, pivot: int) -> Branch:
    """Return ``4 q_k^2`` and the components of ``4 q_k q``, k = ``pivot``, from the rotation matrix of a unit q."""
    q = quaternion_of_dcm(matrix, pivot)
    # Both are linear in the matrix. A large q_k gives q or -q without loss of digits.
    square = 4 * q[pivot] ** 2
    return square, [entry * 2 * sqrt(square) for entry in q]


def _larger(left: Branch, right: Branch) -> Branch:
    """Return the branch with the larger ``4 q_k^2``, as formulas that select it when the kernel runs.

    A branch is a pair: the formula ``4 q_k^2``, for one component k of a unit quaternion q, and the list of the
    formulas ``4 q_k q_0`` to ``4 q_k q_3``. The result is such a pair too: each of its formulas is a conditional, which
    compares ``4 q_k^2`` of ``left`` with that of ``right`` and has the value from the branch where it is larger.
    """
    (a, row_a), (b, row_b) = left, right
    return select_ge(a, b, a, b), [select_ge(a, b, x, y) for x, y in zip(row_a, row_b, strict=True)]


def _rates(frame: str, name: str) -> Definition:
    q, dq, omega = symbols.quaternion, symbols.quaternion_rates, OMEGA[frame]
    named, half = halved(omega)

    def laws() -> tuple[Law, ...]:
        doubled = quaternion_product(conjugate(q), dq) if frame == "body" else quaternion_product(dq, conjugate(q))
        return (
            Law("2 q* dq/dt is (0, omega)" if frame == "body" else "2 dq/dt q* is (0, omega)",
                tuple(2 * doubled - Matrix([0, *omega])), (unit_relation(),)),
            Law("the norm is kept, for any q", (sum(a * b for a, b in zip(q, dq, strict=True)),)),
        )  # fmt: skip

    return Definition(
        name, f"rate of a quaternion from the angular velocity in {frame} axes",
        (QUATERNION, argument("omega", "in", OMEGA[frame], f"angular velocity, {frame} components")),
        (result("dq", quaternion_rate(q, half, frame), dq, "rate of the quaternion"),),
        "all quaternions; the rate keeps the norm", _DERIVATION, QUATERNION_BOX | boxed(omega, -10, 10), laws, named,
    )  # fmt: skip


def _product(name: str) -> Definition:
    left, right, product = symbols.second_quaternion, symbols.quaternion, symbols.product_quaternion

    def laws() -> tuple[Law, ...]:
        matrices = (quaternion_to_dcm(each, "homogeneous") for each in (product, left, right))
        turned, first, second = matrices
        return (
            Law("the dcm of the product is the product of the dcms", tuple(turned - first * second)),
            Law("norms multiply", (norm_squared(product) - norm_squared(left) * norm_squared(right),)),
        )

    return Definition(
        name, "Hamilton product p q of two quaternions: the turn q, then the turn p, in space",
        (argument("left", "in", left, "left factor p"), argument("right", "in", right, "right factor q")),
        (result("product", quaternion_product(left, right), product, "p q"),),
        "all quaternions", "derivations/composition.md", boxed((*left, *right), -1, 1), laws,
    )  # fmt: skip


def _rotate(towards: str, name: str) -> Definition:
    vector, rotated = Matrix(symbols.vector), symbols.turned_vector
    to_space = towards == "space"
    matrix = quaternion_to_dcm() if to_space else quaternion_to_dcm().T
    here, there = ("body", "space") if to_space else ("space", "body")
    named, formulas = turned(symbols.quaternion if to_space else conjugate(symbols.quaternion), vector)

    def laws() -> tuple[Law, ...]:
        return (
            Law(
                "the rotated vector is the dcm times the vector",
                tuple(Matrix(rotated) - matrix * vector),
                (unit_relation(),),
            ),
        )

    return Definition(
        name, f"{there} components of a vector given in {here} axes, by a unit quaternion",
        (QUATERNION, argument("vector", "in", tuple(vector), f"{here} components")),
        (result("turned", formulas, rotated, f"{there} components"),),
        _UNIT, "derivations/euler_parameters.md", QUATERNION_BOX | boxed(tuple(vector), -1, 1), laws, named,
    )  # fmt: skip


def turned(q: Sequence[Expr], vector: Matrix) -> tuple[Named, Matrix]:
    """Return (definitions of symbols, components): the ``vector`` rotated by the unit quaternion ``q``."""
    scalar, axis = q[0], Matrix([*q][1:])
    # v + q0 h + u x h with h = 2 u x v takes fewer operations than the rotation matrix
    half = Matrix([Symbol(f"twice_cross_{i}", real=True) for i in "123"])
    named = tuple(zip(half, 2 * axis.cross(vector), strict=True))
    return named, vector + scalar * half + axis.cross(half)


_KINDS: dict[str, Callable[[str], Definition]] = {
    "quaternion_dcm": _dcm,
    "quaternion_of_dcm": _of_dcm,
    "quaternion_body_rates": partial(_rates, "body"),
    "quaternion_space_rates": partial(_rates, "space"),
    "quaternion_product": _product,
    "quaternion_to_space": partial(_rotate, "space"),
    "quaternion_to_body": partial(_rotate, "body"),
}

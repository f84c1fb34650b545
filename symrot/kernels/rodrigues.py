"""Kernels of classical and modified Rodrigues parameters: rotation matrix, conversion to quaternions, rates."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Expr, Integer, Matrix, Symbol

from symrot import symbols
from symrot.formula.program import Argument
from symrot.kernels.definition import Box, Definition, Law, argument, boxed, result
from symrot.kernels.quaternion import OMEGA, QUATERNION, QUATERNION_BOX, Named, dcm_by_halves, halved, quaternion_rate
from symrot.kernels.removable import select_ge
from symrot.kinematics.quaternion import norm_squared, quaternion_to_dcm, unit_relation
from symrot.kinematics.rodrigues import CLASSICAL, MODIFIED, Projection, shadow

__all__ = ["definitions"]

_DERIVATION = "derivations/rodrigues.md"
_RATES = {"rodrigues": symbols.rodrigues_rates, "mrp": symbols.mrp_rates}
_CALLED = {"rodrigues": "classical Rodrigues parameters", "mrp": "modified Rodrigues parameters"}


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of Rodrigues parameters.

    The function derives the arguments and formulas of the kernel.
    """
    for which in (CLASSICAL, MODIFIED):
        for suffix, make in _KINDS.items():
            name = f"{which.name}_{suffix}"
            yield name, partial(make, which, name)
    yield "mrp_shadow", partial(_shadow, MODIFIED, "mrp_shadow")


def _box(which: Projection) -> Box:
    return boxed(which.parameters, -1, 1)


def _input(which: Projection) -> Argument:
    return argument("parameters", "in", which.parameters, which.about)


_SQUARE = Symbol("square", real=True)  # square of the length of the parameters


def _ray(which: Projection) -> tuple[Named, Expr]:
    """Return (definitions, s): the quaternion (s, p1, p2, p3), of any norm, describes the attitude with parameters p.

    s is 1 for classical Rodrigues parameters, and (1 - p^2)/2 for modified ones, written with a symbol for p^2.
    ``definitions`` are pairs of this symbol and its formula, or empty.
    """
    if not which.centre:
        return (), Integer(1)
    return ((_SQUARE, sum(p**2 for p in which.parameters)),), (1 - _SQUARE) / 2


def _dcm(which: Projection, name: str) -> Definition:
    square, scalar = _ray(which)
    norm, p = Symbol("norm", real=True), which.parameters
    # |(scalar, p)| is half of 1 + p^2 for the modified parameters, and its square 1 + p^2 for the classical ones
    whole, square_of_ray = (1 + _SQUARE, norm**2 / 4) if which.centre else (norm_squared((scalar, *p)), norm)
    doubled, matrix = dcm_by_halves(scalar, p, [2 * each / square_of_ray for each in p])
    named = (*square, (norm, whole))

    def laws() -> tuple[Law, ...]:
        entries = Matrix(3, 3, symbols.rotation_entries)
        return (
            Law("the matrix is the dcm of the quaternion of the parameters",
                tuple(entries - quaternion_to_dcm(which.homogeneous(), "normalised"))),
            Law("the matrix is orthogonal", tuple(entries.T * entries - Matrix.eye(3))),
        )  # fmt: skip

    return Definition(
        name, f"direction cosine matrix dcm_sb of {_CALLED[which.name]}; v_s = dcm_sb v_b, row by row",
        (_input(which),), (result("dcm", matrix, symbols.rotation_entries, "entry of dcm_sb"),),
        "all finite parameters", _DERIVATION, _box(which), laws, (*named, *doubled),
    )  # fmt: skip


def _quaternion(which: Projection, name: str) -> Definition:
    def laws() -> tuple[Law, ...]:
        back = which.of_quaternion(symbols.quaternion) - Matrix(which.parameters)
        return (
            Law("the quaternion has unit norm", (unit_relation(),)),
            Law("the parameters of the quaternion are the given ones", tuple(back)),
        )

    return Definition(
        name, f"quaternion of {_CALLED[which.name]}", (_input(which),),
        (result("q", which.quaternion(), symbols.quaternion, "attitude, body to space"),),
        "all finite parameters", _DERIVATION, _box(which), laws,
    )  # fmt: skip


def _of_quaternion(which: Projection, name: str) -> Definition:
    q0, *vector = symbols.quaternion
    if which.centre:  # q or -q, whichever has the shorter set of parameters
        sign = select_ge(q0, Integer(0), Integer(1), Integer(-1))
        formulas = [sign * entry / (1 + sign * q0) for entry in vector]
    else:
        formulas = list(which.of_quaternion(symbols.quaternion))

    def laws() -> tuple[Law, ...]:
        return (
            Law(
                "the dcm of the parameters is that of the quaternion",
                tuple(which.dcm() - quaternion_to_dcm()),
                (unit_relation(),),
            ),
        )

    domain = "unit quaternions" + ("; the set of length at most 1" if which.centre else " but half turns, q0 = 0")
    box = QUATERNION_BOX if which.centre else QUATERNION_BOX | boxed((q0,), "1/10", 1)
    return Definition(
        name, f"{_CALLED[which.name]} of a unit quaternion", (QUATERNION,),
        (result("parameters", formulas, which.parameters, which.about),), domain, _DERIVATION, box, laws,
    )  # fmt: skip


def _rates(frame: str, which: Projection, name: str) -> Definition:
    omega, rates, p = Matrix(OMEGA[frame]), _RATES[which.name], which.parameters
    square, scalar = _ray(which)
    named, half = halved(OMEGA[frame])
    scalar_rate, *vector_rate = quaternion_rate((scalar, *p), half, frame)  # the part along the ray is subtracted below
    formulas = [rate - p * scalar_rate for rate, p in zip(vector_rate, p, strict=True)]

    def laws() -> tuple[Law, ...]:
        vanishing = Matrix(which.rate_matrix(frame)) * Matrix(rates) - omega
        return (Law("B dp/dt is the given angular velocity", tuple(vanishing)),)

    return Definition(
        name, f"rate of {_CALLED[which.name]} from the angular velocity in {frame} axes",
        (_input(which), argument("omega", "in", OMEGA[frame], f"angular velocity, {frame} components")),
        (result("rates", formulas, rates, "rate of the parameter"),),
        "all finite parameters", _DERIVATION, _box(which) | boxed(OMEGA[frame], -10, 10), laws,
        (*square, *named),
    )  # fmt: skip


def _shadow(which: Projection, name: str) -> Definition:
    square = sum(p**2 for p in which.parameters)
    inside = [select_ge(1, square, p, s) for p, s in zip(which.parameters, shadow(which.parameters), strict=True)]
    turned = symbols.turned_vector

    def laws() -> tuple[Law, ...]:
        return (Law("both sets are one attitude", tuple(which.dcm(turned) - which.dcm())),)

    return Definition(
        name, "modified Rodrigues parameters of the same attitude, of length at most 1: the shadow set beyond it",
        (_input(which),), (result("switched", inside, turned, which.about, "1"),),
        "all finite parameters", _DERIVATION, boxed(which.parameters, -4, 4), laws,
    )  # fmt: skip


_KINDS: dict[str, Callable[[Projection, str], Definition]] = {
    "dcm": _dcm,
    "quaternion": _quaternion,
    "of_quaternion": _of_quaternion,
    "body_rates": partial(_rates, "body"),
    "space_rates": partial(_rates, "space"),
}

"""Kernels of inertia: mass properties of every uniform solid, the parallel axis theorem, rotation of the tensor."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Expr, ImmutableMatrix, Matrix, Symbol, eye, trace

from symrot import symbols
from symrot.formula.program import Argument
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import solid
from symrot.kernels.definition import Definition, Law, argument, boxed, result, scalar
from symrot.kernels.dynamics import ENTRIES, TENSOR, TENSOR_BOX, tensor_argument
from symrot.kernels.quaternion import QUATERNION, QUATERNION_BOX, dcm_by_halves
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation

__all__ = ["definitions"]

_MOVED = tuple(Symbol(f"moved_{name}", real=True) for name in ("xx", "yy", "zz", "xy", "xz", "yz"))
_PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
_MASS = scalar(symbols.m, "mass")
_TENSOR_OUT = "inertia tensor (xx, yy, zz, xy, xz, yz), products with their minus sign"


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of inertia: the function derives the kernel's arguments and formulas."""
    for name, shape in SHAPES.items():
        if shape.position:  # no kernel for separate points, whose number of inputs is not fixed
            yield f"inertia_{name}", partial(_solid, f"inertia_{name}", name)
    yield "inertia_parallel_axis", partial(_parallel_axis, "inertia_parallel_axis")
    yield "inertia_rotated", partial(_rotated, "inertia_rotated")


def _entries(tensor: Matrix) -> list[Expr]:
    return [tensor[place] for place in _PLACES]


def _tensor(entries: tuple[Symbol, ...]) -> ImmutableMatrix:
    held = dict(zip(_PLACES, entries, strict=True))
    return ImmutableMatrix(3, 3, lambda i, j: held[min(i, j), max(i, j)])


def _solid(name: str, shape: str) -> Definition:
    body = solid(shape)
    meanings = {d.symbol: d.meaning for d in SHAPES[shape].dimensions}
    dimensions = tuple(
        (str(symbol), "m", meanings.get(str(symbol), "component of a corner")) for symbol in body.dimensions.values()
    )
    sizes = tuple(body.dimensions.values())

    def laws() -> tuple[Law, ...]:
        c = body.center_of_mass
        shifted = _tensor(ENTRIES) + symbols.m * (c.dot(c) * eye(3) - c * c.T)
        about_origin = body.inertia + symbols.m * (c.dot(c) * eye(3) - c * c.T)
        return (
            Law(
                "about the origin of the shape, the inertia tensor is the integral over the body",
                tuple(shifted - about_origin),
            ),
            Law("the centre of mass is the mean position", tuple(Matrix(symbols.position) - c)),
        )

    return Definition(
        name, f"inertia and centre of mass of a uniform {shape.replace('_', ' ')}: {SHAPES[shape].axes}",
        (_MASS, Argument("dimensions", "in", dimensions)),
        (result("inertia", _entries(body.inertia), ENTRIES, f"{_TENSOR_OUT}, about the centre of mass"),
         result("center_of_mass", body.center_of_mass, symbols.position, "centre of mass, axes of the shape")),
        "dimensions of a body that is there", "derivations/standard_solids.md",
        boxed((symbols.m,), "1/10", 10) | boxed(sizes, "1/10", 10), laws,
    )  # fmt: skip


def _parallel_axis(name: str) -> Definition:
    d = Matrix(symbols.offset)
    weighed = Matrix([Symbol(f"mass_times_{entry}", real=True) for entry in d])
    outer = ImmutableMatrix(3, 3, lambda i, j: weighed[min(i, j)] * d[max(i, j)])
    moved = TENSOR + outer.trace() * eye(3) - outer

    def laws() -> tuple[Law, ...]:
        difference = _tensor(_MOVED) - TENSOR
        return (
            Law("along the offset nothing is added", tuple(difference * d)),
            Law("the trace grows by twice the mass times the offset squared",
                (trace(difference) - 2 * symbols.m * d.dot(d),)),
        )  # fmt: skip

    return Definition(
        name, "inertia about a point at an offset from the centre of mass (parallel axes, full tensor)",
        (tensor_argument(), _MASS, argument("offset", "in", symbols.offset, "from the centre of mass to the point")),
        (result("moved", _entries(moved), _MOVED, f"{_TENSOR_OUT}, about the point", "kg m^2"),),
        "all finite values", "derivations/parallel_axis.md",
        TENSOR_BOX | boxed((symbols.m,), "1/10", 10) | boxed(symbols.offset, -1, 1), laws,
        tuple(zip(weighed, symbols.m * d, strict=True)),
    )  # fmt: skip


def _rotated(name: str) -> Definition:
    turn = Matrix(3, 3, symbols.rotation_entries)
    half = Matrix(3, 3, [Symbol(f"turned_{i}{j}", real=True) for i in "123" for j in "123"])
    scalar, *axis = symbols.quaternion
    doubled, matrix = dcm_by_halves(scalar, axis, [2 * q for q in axis])
    named = (*doubled, *zip(turn, matrix, strict=True), *zip(half, turn * TENSOR, strict=True))

    def laws() -> tuple[Law, ...]:
        matrix = quaternion_to_dcm()
        return (Law("I' R is R I: the tensor turns with the body", tuple(_tensor(_MOVED) * matrix - matrix * TENSOR),
                    (unit_relation(),)),)  # fmt: skip

    return Definition(
        name, "inertia tensor in space axes, R I R^T, of a body turned by a unit quaternion",
        (QUATERNION, tensor_argument()),
        (result("rotated", _entries(half * turn.T), _MOVED, f"{_TENSOR_OUT}, space axes", "kg m^2"),),
        "unit quaternions", "derivations/tensor_rotation.md", QUATERNION_BOX | TENSOR_BOX, laws, named,
    )  # fmt: skip

"""Algebra of 3x3 tensors as nested tuples of Fractions, floats or SymPy expressions. Standard library only.

Exact mass properties of a scene and symbolic bodies use the same functions. Arguments may be sequences, SymPy matrices
or NumPy arrays; results are tuples. Products of inertia have a minus sign, ``I_xy = -integral of x y dm``.
"""

from collections.abc import Callable, Iterable
from typing import Any

__all__ = [
    "IDENTITY", "Tensor", "Vector", "about_center_of_mass", "about_point", "add", "apply", "cross", "determinant",
    "dot", "inertia_of_point", "inertia_of_second_moments", "matrix", "multiply", "rotate", "rotation_of", "scale",
    "subtract", "trace", "transpose", "vector",
]  # fmt: skip

Vector = tuple[Any, Any, Any]
Tensor = tuple[Vector, Vector, Vector]

IDENTITY: Tensor = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def _items(source: Any) -> tuple[Any, ...]:
    items = source.tolist() if hasattr(source, "tolist") else source
    if not isinstance(items, Iterable):
        raise ValueError(f"expected a list of 3, got {items!r}")
    return tuple(items)


def matrix(source: Any) -> Tensor:
    """Return a 3 x 3 tensor, given as a matrix or rows, as nested tuples; raise ``ValueError`` if it is not 3 x 3."""
    rows = tuple(map(vector, _items(source)))
    if len(rows) != 3:
        raise ValueError(f"expected a 3x3 tensor, got {len(rows)} rows")
    return rows


def vector(source: Any) -> Vector:
    """Return three components, given as a list, a row or a column, as a tuple.

    Raise ``ValueError`` if there are not three.
    """
    if type(source) is tuple and len(source) == 3 and not isinstance(source[0], list):
        return source
    components = _items(source)
    if len(components) == 1:
        components = _items(components[0])
    if len(components) == 3 and all(isinstance(item, list) and len(item) == 1 for item in components):
        components = tuple(item for (item,) in components)
    if len(components) != 3:
        raise ValueError(f"expected 3 components, got {len(components)}")
    return components


def _entrywise(operation: Callable[..., Any], *tensors: Any) -> Tensor:
    return matrix([list(map(operation, *rows)) for rows in zip(*map(matrix, tensors), strict=True)])


def add(left: Any, right: Any) -> Tensor:
    """Return the sum of two tensors, each three rows of three numbers of any type."""
    return _entrywise(lambda a, b: a + b, left, right)


def subtract(left: Any, right: Any) -> Tensor:
    """Return the difference left - right of two tensors, each three rows of three numbers of any type."""
    return _entrywise(lambda a, b: a - b, left, right)


def scale(factor: Any, tensor: Any) -> Tensor:
    """Return ``tensor``, three rows of three numbers, times the scalar ``factor``."""
    return _entrywise(lambda a: factor * a, tensor)


def transpose(tensor: Any) -> Tensor:
    """Return the transpose of a tensor, as three rows of three numbers."""
    return matrix(list(zip(*matrix(tensor), strict=True)))


def dot(left: Any, right: Any) -> Any:
    """Return the scalar product of two vectors, each three numbers of any type."""
    (a, b, c), (x, y, z) = vector(left), vector(right)
    return a * x + b * y + c * z


def cross(left: Any, right: Any) -> Vector:
    """Return the vector product left x right."""
    (a, b, c), (x, y, z) = vector(left), vector(right)
    return b * z - c * y, c * x - a * z, a * y - b * x


def apply(tensor: Any, v: Any) -> Vector:
    """Return the product of ``tensor``, 3 x 3, and the vector v, as a tuple of three numbers of any type."""
    first, second, third = matrix(tensor)
    return dot(first, v), dot(second, v), dot(third, v)


def multiply(left: Any, right: Any) -> Tensor:
    """Return the product ``left * right`` of two tensors, as three rows of three numbers."""
    columns = transpose(right)
    return matrix(tuple(tuple(dot(row, column) for column in columns) for row in matrix(left)))


def trace(tensor: Any) -> Any:
    """Return the trace of a tensor, the sum of its diagonal."""
    rows = matrix(tensor)
    return rows[0][0] + rows[1][1] + rows[2][2]


def determinant(tensor: Any) -> Any:
    """Return the determinant of a tensor, three rows of three numbers of any type."""
    first, second, third = matrix(tensor)
    return dot(first, cross(second, third))


def rotate(tensor: Any, dcm: Any) -> Tensor:
    """Return a tensor in other axes, ``dcm * tensor * dcm^T``; ``dcm`` maps old components to new components."""
    return multiply(multiply(dcm, tensor), transpose(dcm))


def rotation_of(quaternion: Any) -> Tensor:
    """Return the matrix ``dcm_sb`` of a quaternion, scalar first, of any norm except zero; exact for Fractions."""
    w, x, y, z = quaternion
    s = 2 / (w * w + x * x + y * y + z * z)
    return (
        (1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)),
        (s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)),
        (s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)),
    )


def inertia_of_second_moments(moments: Any) -> Tensor:
    """Return the inertia tensor ``trace(M) 1 - M`` from the second moments ``M_ij = integral of x_i x_j dm``."""
    total = trace(moments)
    rows = matrix(moments)
    return matrix(tuple(tuple(total - rows[i][i] if i == j else -rows[i][j] for j in range(3)) for i in range(3)))


def inertia_of_point(mass: Any, position: Any) -> Tensor:
    """Return the inertia tensor of a point mass about the origin, ``m (r^2 1 - r r^T)``, kg m^2."""
    r = vector(position)
    return inertia_of_second_moments(tuple(tuple(mass * a * b for b in r) for a in r))


def about_point(inertia: Any, mass: Any, offset: Any) -> Tensor:
    """Return the inertia tensor about a point from the tensor about the centre of mass (parallel-axis theorem).

    Parameters
    ----------
    inertia : 3x3, kg m^2
        The tensor about the centre of mass.
    mass : number, kg
        The mass of the body.
    offset : 3-vector, m
        The vector from the point to the centre of mass, or its negative.

    Notes
    -----
    Source: Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., section 5.3.
    """
    return add(inertia, inertia_of_point(mass, offset))


def about_center_of_mass(inertia: Any, mass: Any, offset: Any) -> Tensor:
    """Return the inertia tensor about the centre of mass from the tensor about a point.

    ``offset``, m, is the vector from the point to the centre of mass, or its negative.
    """
    return subtract(inertia, inertia_of_point(mass, offset))

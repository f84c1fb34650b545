"""Exact integrals of polynomials over shapes such as cylinders, by a map and its Jacobian. Standard library only.

A map gives the position for coordinates such as radius and angle. Integrands are polynomials in coordinates, cosines
and sines, so every integral is exact (powers, and Wallis' recursion): a polynomial in the dimensions and pi.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import combinations, product
from typing import Any, NamedTuple

from symrot.errors import InputError, prefix
from symrot.formula.exact_numbers import PI, show
from symrot.formula.polynomial import (
    Polynomial,
    constant,
    cosine,
    exact_quotient,
    generator,
    reduce_circular,
    sine,
    square_root,
)
from symrot.formula.tree import Node, evaluate, parse
from symrot.inertia.shapes import Coordinate, Shape, scalar_names, scalars

__all__ = [
    "LARGEST_DEGREE", "Domain", "Moments", "density_polynomial", "domain", "exact_moments", "integrate", "moments",
    "moments_per_measure", "require_not_negative", "shape_points",
]  # fmt: skip

LARGEST_DEGREE = 12
"""Highest allowed total degree of a density as a polynomial in x, y, z."""

_PI = {"pi": PI}


class Domain(NamedTuple):
    """A shape as a map from coordinates, such as radius and angle, to positions (m): map, Jacobian and limits."""

    position: tuple[Polynomial, ...]
    # volume (area, length) per unit of the coordinates
    jacobian: Polynomial
    limits: tuple[tuple[Coordinate, Polynomial, Polynomial], ...]


class Moments(NamedTuple):
    """The integrals of 1, x_i and x_i x_j over a shape, weighted by a density: mass, centre and inertia follow."""

    zeroth: Any
    first: tuple[Any, ...]
    second: tuple[tuple[Any, ...], ...]


def _lifted(text: str, values: Mapping[str, Polynomial]) -> Polynomial:
    functions = {"cos": lambda angle: cosine(angle.symbol()), "sin": lambda angle: sine(angle.symbol())}
    polynomial = evaluate(parse(text), values, functions, constant)
    assert isinstance(polynomial, Polynomial)
    return polynomial


def _determinant(rows: list[list[Polynomial]]) -> Polynomial:
    if not rows:
        return constant(1)
    total = constant(0)
    for column, entry in enumerate(rows[0]):
        if entry:
            minor = [row[:column] + row[column + 1 :] for row in rows[1:]]
            total = total + entry * _determinant(minor) * (-1) ** column
    return total


def _jacobian(position: tuple[Polynomial, ...], coordinates: tuple[Coordinate, ...]) -> Polynomial:
    """Return the Jacobian of a map to positions: volume, area or length per unit of the coordinates."""
    columns = [[component.derivative(c.name) for component in position] for c in coordinates]
    angles = [c.name for c in coordinates if c.angle]
    # a solid: the determinant of the derivatives; otherwise the root of the Gram determinant
    if len(columns) == 3:
        return reduce_circular(_determinant(columns), angles)
    gram = [[sum((a * b for a, b in zip(p, q, strict=True)), constant(0)) for q in columns] for p in columns]
    return square_root(reduce_circular(_determinant(gram), angles))


def domain(shape: Shape, known: Mapping[str, Fraction] | None = None) -> Domain:
    """Return a shape's map from coordinates to positions, with its Jacobian and limits, as polynomials.

    The dimensions in ``known``, such as ``{"radius": 2}``, are inserted as numbers; the others stay symbols. Names are
    those of :func:`symrot.inertia.shapes.scalar_names`.
    """
    numbers = known or {}
    values = {n: constant(numbers[n]) if n in numbers else generator(n) for n in scalar_names(shape)}
    values["pi"] = generator("pi")
    limits = tuple((c, _lifted(c.lower, values), _lifted(c.upper, values)) for c in shape.coordinates)
    values |= {c.name: generator(c.name) for c in shape.coordinates}
    position = tuple(_lifted(text, values) for text in shape.position)
    return Domain(position, _jacobian(position, shape.coordinates), limits)


@cache
def _quarter_turn(cosines: int, sines: int) -> tuple[Fraction, int]:
    """Return the integral of cos^m sin^n from 0 to pi/2 as (rational, power of pi): cos^2 gives ``(1/4, 1)``."""
    # Wallis' recursion
    if sines > 1:
        rational, power = _quarter_turn(cosines, sines - 2)
        return rational * Fraction(sines - 1, cosines + sines), power
    if cosines > 1:
        rational, power = _quarter_turn(cosines - 2, sines)
        return rational * Fraction(cosines - 1, cosines + sines), power
    return {(0, 0): (Fraction(1, 2), 1), (1, 1): (Fraction(1, 2), 0)}.get((cosines, sines), (Fraction(1), 0))


def _circular(cosines: int, sines: int, lower: int, upper: int) -> Polynomial:
    """Return the integral of cos^cosines sin^sines from ``lower * pi/2`` to ``upper * pi/2``, in terms of ``pi``."""
    total = constant(0)
    for quadrant in range(lower, upper):
        cosine_sign, sine_sign = ((1, 1), (-1, 1), (-1, -1), (1, -1))[quadrant % 4]
        swapped = (sines, cosines) if quadrant % 2 else (cosines, sines)
        rational, power = _quarter_turn(*swapped)
        total = total + generator("pi") ** power * (rational * cosine_sign**cosines * sine_sign**sines)
    return total


def _quarters(limit: Polynomial) -> int:
    turns = 2 * limit.collect(["pi"]).get((1,), constant(0)).value({})
    if turns.denominator != 1:
        raise ValueError(f"expected whole multiples of pi/2 as limits of an angle, got {turns}*pi/2")
    return int(turns)


def integrate(integrand: Polynomial, limits: tuple[tuple[Coordinate, Polynomial, Polynomial], ...]) -> Polynomial:
    """Return the integral of a polynomial over all coordinates, as a polynomial in the dimensions and ``pi``."""
    for coordinate, lower, upper in limits:
        total = constant(0)
        if coordinate.angle:
            names = f"cos({coordinate.name})", f"sin({coordinate.name})"
            for (cosines, sines), coefficient in integrand.collect(names).items():
                total = total + coefficient * _circular(cosines, sines, _quarters(lower), _quarters(upper))
        else:
            for (power,), coefficient in integrand.collect([coordinate.name]).items():
                total = total + coefficient * (upper ** (power + 1) - lower ** (power + 1)) / (power + 1)
        integrand = total
    return integrand


def _degree(node: Node) -> int:
    """Return an upper bound of a formula's degree in x, y, z; raise ValueError if it calls a function.

    The formula is not expanded, so that a high degree is refused early.
    """
    kind = node[0]
    if kind == "number":
        return 0
    if kind == "symbol":
        return int(node[1] in ("x", "y", "z"))
    if kind == "neg":
        return _degree(node[1])
    if kind == "**":
        return _degree(node[1]) * abs(int(node[2]))
    if kind == "call":
        raise ValueError(f"the formula calls {node[1]}, which is no polynomial")
    left, right = _degree(node[1]), _degree(node[2])
    return left + right if kind in "*/" else max(left, right)


def density_polynomial(density: Node, values: Mapping[str, Polynomial], source: object, where: str = "") -> Polynomial:
    """Return a density, a formula in x, y, z, as a polynomial in the shape's coordinates, such as radius and angle.

    Parameters
    ----------
    density : Node
        A formula in x, y, z (m, axes of the shape) and the dimensions.
    values : mapping of str to Polynomial
        The values of x, y, z and of the dimensions, by name.
    source : object
        The density as the user wrote it.

    Raises
    ------
    InputError
        If the density is no polynomial in x, y, z, has a degree above LARGEST_DEGREE or too many operations, or uses an
        unknown name.
    """
    expected = f"{prefix(where)}expected a density that is a polynomial in x, y, z, got {show(source)}"
    try:
        if _degree(density) > LARGEST_DEGREE:
            raise InputError(f"{expected} (its degree exceeds {LARGEST_DEGREE})")
        polynomial = evaluate(density, values, None, constant)
    except KeyError as unknown:
        names = ", ".join(sorted(values))
        raise InputError(f"{expected} ({unknown.args[0]!r} is not one of {names})") from None
    except (ValueError, ZeroDivisionError) as reason:
        if isinstance(reason, InputError):
            raise
        raise InputError(f"{expected} ({reason})") from None
    except RecursionError:
        raise InputError(f"{expected} (it has too many operations)") from None
    assert isinstance(polynomial, Polynomial)
    return polynomial


def moments(region: Domain, density: Polynomial | None = None) -> Moments:
    """Return the integrals of 1, x_i and x_i x_j over a shape, as polynomials in the dimensions and ``pi``.

    ``density`` is a polynomial in the coordinates over which ``region`` integrates, such as a radius and an angle; if
    it is None, the density is 1.
    """
    weight = region.jacobian if density is None else region.jacobian * density
    first = tuple(integrate(p * weight, region.limits) for p in region.position)
    second = [[constant(0)] * 3 for _ in range(3)]
    for i, j in ((0, 0), (1, 1), (2, 2), *combinations(range(3), 2)):
        second[i][j] = second[j][i] = integrate(region.position[i] * region.position[j] * weight, region.limits)
    return Moments(integrate(weight, region.limits), first, tuple(map(tuple, second)))


def moments_per_measure(region: Domain, density: Polynomial | None = None) -> tuple[Polynomial, Moments]:
    """Return (factor, moments): the moments of a shape are the product of the factor and these moments.

    The factor is the measure of the shape (volume, area or length) if ``region.jacobian`` is divisible by it as a
    polynomial, otherwise 1. Dividing before the integration saves time for a tetrahedron with twelve symbols.
    """
    measure = integrate(region.jacobian, region.limits)
    share = exact_quotient(region.jacobian, measure)
    if share is None:
        return constant(1), moments(region, density)
    return measure, moments(region._replace(jacobian=share), density)


def require_not_negative(density: Node, points: Iterable[Mapping[str, float]], source: object, where: str = "") -> None:
    """Raise InputError if a density at one of some points of a body is negative or exceeds the range of a double.

    A point is a mapping of x, y, z (m) and of other names in the density to numbers; ``source`` is the density as the
    user wrote it, for the message.
    """
    try:
        values = [(float(evaluate(density, {"pi": math.pi, **point}, None, float)), point) for point in points]
    except OverflowError:
        raise InputError(
            f"{prefix(where)}density: expected a density with values within the range of a double, got {show(source)}"
        ) from None
    least, place = min(values, key=lambda each: each[0])
    # a density that is zero at a point may be negative there by rounding errors
    if least < -1e-9 * max(abs(value) for value, _ in values):
        x, y, z = (place[axis] for axis in "xyz")
        raise InputError(
            f"{prefix(where)}density: expected a density that is negative nowhere in the body, got {show(source)} with "
            f"{least:.6g} at x = {x:.6g}, y = {y:.6g}, z = {z:.6g} m"
        )


def shape_points(
    shape: Shape, numbers: Mapping[str, Fraction], shares: Sequence[float] = (0.0, 0.25, 0.5, 0.75, 1.0)
) -> Iterator[dict[str, float]]:
    """Yield points of a shape as mappings of x, y, z (m) and of the names of its dimensions to numbers.

    The coordinates of the points are at the fractions ``shares`` of their ranges, in all combinations.
    """
    known = {"pi": math.pi} | {name: float(value) for name, value in numbers.items()}
    functions = {"cos": math.cos, "sin": math.sin}

    def value(text: str, symbols: Mapping[str, float]) -> float:
        return float(evaluate(parse(text), symbols, functions, float))

    limits = [(value(c.lower, known), value(c.upper, known)) for c in shape.coordinates]
    for chosen in product(shares, repeat=len(limits)):
        own = [low + share * (high - low) for share, (low, high) in zip(chosen, limits, strict=True)]
        symbols = known | {c.name: number for c, number in zip(shape.coordinates, own, strict=True)}
        yield known | {axis: value(text, symbols) for axis, text in zip("xyz", shape.position, strict=True)}


def exact_moments(
    shape: Shape, dimensions: Mapping[str, Any], density: Node, source: object, where: str = ""
) -> Moments:
    """Return the moments of a shape with a polynomial density as numbers, in kg, kg m, kg m^2; pi is exact to 2^-320.

    ``source`` is the density as the user wrote it, for messages. Raise InputError if the corners of a tetrahedron lie
    in one plane, or if the density is no polynomial or is negative at one of the points of :func:`shape_points`.
    """
    numbers = scalars(shape, dimensions)
    region = domain(shape, numbers)
    measure = integrate(region.jacobian, region.limits).value(_PI)
    if not measure:
        raise InputError(f"{prefix(where)}expected a {shape.name} with a positive volume, got corners in one plane")
    if measure < 0:  # corners in the other order
        region = region._replace(jacobian=-region.jacobian)
    values = dict(zip("xyz", region.position, strict=True))
    values |= {name: constant(value) for name, value in numbers.items()}
    integrals = moments(region, density_polynomial(density, values | {"pi": constant(PI)}, source, where))
    if integrals.zeroth.value(_PI) > 0:  # otherwise the caller refuses the mass
        require_not_negative(density, shape_points(shape, numbers), source, where)
    return Moments(
        integrals.zeroth.value(_PI),
        tuple(entry.value(_PI) for entry in integrals.first),
        tuple(tuple(entry.value(_PI) for entry in row) for row in integrals.second),
    )

"""Exact mass properties of a scene's body, composed from its parts. Standard library only."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.errors import InputError, prefix
from symrot.formula.exact_numbers import read, show
from symrot.formula.tree import Node, parse
from symrot.inertia import tensor
from symrot.inertia.bodies import MassProperties, compose, place
from symrot.inertia.closed_forms import uniform
from symrot.inertia.principal import principal_axes, require_admissible
from symrot.inertia.shapes import Shape, check_dimensions, find_shape
from symrot.inertia.tensor import IDENTITY

__all__ = ["MassProperties", "Part", "doubtful_holes", "mass_properties"]

_ORIGIN = (0, 0, 0)
_ROTATION_TOLERANCE = Fraction(1, 10**9)  # rejects a matrix of rounded decimals, accepts a matrix of doubles


class Part(NamedTuple):
    """A part of a body, with its entries as the scene gives them."""

    shape: str
    dimensions: Mapping[str, Any]
    # kg; point masses have theirs among the dimensions
    mass: Any = None
    # instead of a mass: kg per m^3, m^2 or m, a number or the text of a polynomial in x, y, z
    density: Any = None
    # position of the part's origin, m, in the axes of the body
    at: Sequence[Any] = _ORIGIN
    # maps components in the part's axes to components in the body's axes
    rotation: Sequence[Sequence[Any]] = IDENTITY
    subtract: bool = False


def _points(part: Part, dimensions: Mapping[str, Any], where: str) -> MassProperties:
    if part.mass is not None or part.density is not None:
        raise InputError(
            f"{prefix(where)}expected no mass or density of point_masses, got one; give their masses in 'masses' only"
        )
    nothing = tensor.scale(Fraction(0), IDENTITY)
    pairs = zip(dimensions["masses"], dimensions["points"], strict=True)
    return compose([MassProperties(mass, point, nothing) for mass, point in pairs])


def _of_density(shape: Shape, dimensions: Mapping[str, Any], density: Node, part: Part, where: str) -> MassProperties:
    from symrot.inertia.integration import exact_moments  # here, so that a uniform body does not load it

    integrals = exact_moments(shape, dimensions, density, part.density, where)
    if integrals.zeroth <= 0:
        raise InputError(
            f"{prefix(where)}expected a density with a positive mass, got {show(part.density)} with a mass of "
            f"{float(integrals.zeroth):.15g} kg"
        )
    center = tensor.vector([moment / integrals.zeroth for moment in integrals.first])
    about_origin = tensor.inertia_of_second_moments(integrals.second)
    return MassProperties(integrals.zeroth, center, tensor.about_center_of_mass(about_origin, integrals.zeroth, center))


def _positive(value: Any, name: str, where: str) -> Fraction:
    dot = f"{where}.{name}" if where else name
    amount = read(value, dot)
    if amount <= 0:
        raise InputError(f"{dot}: expected a positive number, got {show(value)}")
    return amount


def _density_node(density: Any, where: str) -> Node:
    """Return the formula tree of a part's density, given as a positive number or as text in x, y, z."""
    if isinstance(density, str):
        node = parse(density, f"{where}.density" if where else "density")
        if node[0] != "number":
            return node
    return ("number", _positive(density, "density", where))


def _in_own_axes(part: Part, where: str) -> MassProperties:
    shape = find_shape(part.shape, where)
    dimensions = check_dimensions(shape, part.dimensions, where)
    if shape.kind == "points":
        return _points(part, dimensions, where)
    if (part.mass is None) == (part.density is None):
        arrived = "both" if part.mass is not None else "neither"
        expected = f"either a mass (kg) or a density ({shape.density_unit})"
        raise InputError(f"{prefix(where)}expected {expected} of the {shape.name}, got {arrived}")
    if part.mass is not None:
        return uniform(shape, dimensions, mass=_positive(part.mass, "mass", where), where=where)
    density = _density_node(part.density, where)
    if density[0] == "number":
        return uniform(shape, dimensions, density=density[1], where=where)
    return _of_density(shape, dimensions, density, part, where)


def _placed(part: Part, where: str) -> MassProperties:
    body = _in_own_axes(part, where)
    dot = f"{where}." if where else ""
    try:
        at = tensor.vector([read(value, f"{dot}at") for value in part.at])
        rotation = tensor.matrix([[read(value, f"{dot}rotation") for value in row] for row in part.rotation])
    except (TypeError, ValueError) as reason:
        if isinstance(reason, InputError):
            raise
        raise InputError(f"{prefix(where)}expected at = [x, y, z] and a 3x3 rotation ({reason})") from None
    error = tensor.subtract(tensor.multiply(rotation, tensor.transpose(rotation)), IDENTITY)
    if max(abs(entry) for row in error for entry in row) > _ROTATION_TOLERANCE or tensor.determinant(rotation) < 0:
        raise InputError(f"{dot}rotation: expected a right-handed rotation matrix, got {show(part.rotation)}")
    return place(body, at, rotation)


def mass_properties(parts: Sequence[Part], where: str = "") -> MassProperties:
    """Return the mass properties of a body from its parts, as exact Fractions in the axes of the body.

    Parameters
    ----------
    parts : sequence of Part
        The parts; at least one part must not be subtracted.
    where : str
        Place of the parts in the scene, put in front of every error message. If there are several parts, a message also
        contains the number of the part.

    Returns
    -------
    MassProperties
        The properties are exact for rational dimensions, except for pi (correct to 2^-320) and for the rounding errors
        of rotations given as decimals.

    Raises
    ------
    InputError
        If a part is not a valid body, if the total mass is not positive, or if no body can have the resulting moments
        of inertia, for example because a hole is larger than the part from which it is cut.
    """
    if not parts:
        raise InputError(f"{prefix(where)}expected at least one part, got none")
    places = [where] if len(parts) == 1 else [f"{where or 'part'}[{n}]" for n in range(len(parts))]
    placed = [_placed(part, spot) for part, spot in zip(parts, places, strict=True)]
    added = [body for body, part in zip(placed, parts, strict=True) if not part.subtract]
    subtracted = [body for body, part in zip(placed, parts, strict=True) if part.subtract]
    total = sum(body.mass for body in added) - sum(body.mass for body in subtracted)
    if total <= 0:
        raise InputError(f"{prefix(where)}expected parts with a positive total mass, got {float(total):.15g} kg")
    whole = compose(added, subtracted)
    body = principal_axes(whole.inertia, where)
    for value in (whole.mass, *body.moments):
        read(value, where, "dimensions whose mass and moments of inertia are within the range of a double")
    require_admissible(body, where)
    return whole


def doubtful_holes(parts: Sequence[Part], where: str = "") -> tuple[str, ...]:
    """Return a sentence for each hole (part with ``subtract``) that may reach out of the other parts of a body.

    The arguments are those of :func:`mass_properties`, which must accept them.

    Raises
    ------
    InputError
        If the body has a negative density at a point, because a hole reaches out of the other parts, overlaps another
        hole, or has a larger density than the parts around it.
    """
    if not any(part.subtract for part in parts):
        return ()
    from symrot.inertia import holes  # here, so that a body without holes does not load it

    names = [f"{where or 'part'}[{n}]" for n in range(len(parts))]
    dense: list[holes.DensePart | None] = []
    added: list[holes.PointMass] = []
    subtracted: list[tuple[str, holes.PointMass]] = []
    for part, name in zip(parts, names, strict=True):
        shape = find_shape(part.shape, name)
        dimensions = check_dimensions(shape, part.dimensions, name)
        pose = holes.pose([read(x, name) for x in part.at], [[read(x, name) for x in row] for row in part.rotation])
        if shape.kind == "points":
            for mass, point in zip(dimensions["masses"], dimensions["points"], strict=True):
                x, y, z = map(float, point)
                place = mass, pose.to_body((x, y, z))
                subtracted.append((name, place)) if part.subtract else added.append(place)
            dense.append(None)
            continue
        if part.mass is not None:
            measure = uniform(shape, dimensions, density=Fraction(1)).mass
            density: Fraction | Node = _positive(part.mass, "mass", name) / measure
        else:
            node = _density_node(part.density, name)
            density = node[1] if node[0] == "number" else node
        dense.append(holes.dense_part(shape.name, dimensions, pose, density, part.subtract))
    holes.require_points(added, subtracted)
    return holes.doubtful_holes(dense, names)

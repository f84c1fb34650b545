"""Bodies of scenes: the inertia, the point of rotation, and a check that such a body can exist.

A scene gives the inertia by ``shape``, ``[[body.part]]``, ``mesh`` (a file), ``principal`` moments, or ``inertia``, the
tensor. The result consists of exact numbers (Fractions), in the axes in which the body was given.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.errors import nearest
from symrot.formula import tree as expression
from symrot.formula.exact_numbers import NEGLIGIBLE
from symrot.inertia.composite import MassProperties, Part, doubtful_holes, mass_properties
from symrot.inertia.principal import Principal, principal_axes, require_admissible, why_not_propagable
from symrot.inertia.shapes import SHAPES, Shape, check_dimensions
from symrot.inertia.tensor import about_point
from symrot.scene.attitude import Matrix, Vector, read_attitude
from symrot.scene.folders import Folders
from symrot.scene.mesh_body import Facet, read_mesh_table
from symrot.scene.reader import (
    Entry,
    Reader,
    choice,
    fail,
    flag,
    items,
    number,
    read_table,
    table,
    text,
    unchanged,
    vector,
)

__all__ = ["Body", "read_body"]

ABOUT = ("center_of_mass", "fixed_point")
INERTIA_SOURCES = ("shape", "part", "mesh", "principal", "inertia")
EXPECTED_SOURCE = "exactly one of shape, [[body.part]], mesh, principal, inertia"
ASYMMETRY = Fraction(1, 10**12)
"""Largest difference of I_xy and I_yx, relative to the largest moment, of a tensor that counts as symmetric."""

LARGEST_MOMENT = Fraction(10) ** 120
MOST_PARTS = 1000
LONGEST_DENSITY = 400

_POSITION = {"x", "y", "z"}

_ZERO: Vector = (Fraction(0), Fraction(0), Fraction(0))
_UNTURNED: Matrix = (
    (Fraction(1), Fraction(0), Fraction(0)),
    (Fraction(0), Fraction(1), Fraction(0)),
    (Fraction(0), Fraction(0), Fraction(1)),
)


class Body(NamedTuple):
    """A rigid body: its inertia about the point of rotation, in the axes in which the body was given.

    Attributes
    ----------
    mass : Fraction or None
        Mass, kg; None if it is unknown.
    inertia : 3 x 3 Fraction
        Inertia tensor, kg m^2, about the point of rotation.
    center_of_mass : tuple of 3 Fraction, or None
        Position relative to the point of rotation, m; None if it is unknown.
    about : str
        The point of rotation: ``"center_of_mass"`` or ``"fixed_point"``.
    description : str
        Name of the body in the scene, or a short description such as ``"cuboid"``. For a body given by moments it says
        so in addition: ``"wheel with given principal moments"``.
    principal : Principal
        Symmetry class of the body, principal moments, kg m^2, and principal axes.
    parts : tuple of Part
        The shapes of which the body consists, for pictures; empty for a mesh, or if only the inertia is known.
    origin : tuple of 3 Fraction
        The point of rotation, m, in the axes in which the parts or facets are placed.
    facets : tuple of triangles
        The surface of a body given by a small mesh, for pictures: the corners, m, of each triangle.
    warnings : tuple of str
        Sentences about holes that could not be proven to lie within the body, and about polygons that are not flat.

    Examples
    --------
    >>> import symrot
    >>> scene = symrot.load_scene("tumbling_prism")
    >>> scene.body.principal.moments
    (Fraction(5, 1), Fraction(20, 1), Fraction(17, 1))
    """

    mass: Fraction | None
    inertia: Matrix
    center_of_mass: Vector | None
    about: str
    description: str
    principal: Principal
    parts: tuple[Part, ...] = ()
    origin: Vector = _ZERO
    facets: tuple[Facet, ...] = ()
    warnings: tuple[str, ...] = ()


def read_body(value: Any, where: str, folders: Folders | None = None) -> Body:
    """Return the body that the table ``[body]`` of a scene describes.

    Parameters
    ----------
    value : mapping
        The table.
    where : str
        Its place, for error messages.
    folders : Folders, optional
        Where the file of a mesh may be; default: the current folder.

    Raises
    ------
    InputError
        If the inertia is not given in exactly one way, a shape or key is unknown, a dimension is out of range, no body
        has the inertia, or a principal moment is zero (a needle, a point). The message names file, key and value.
    """
    entries = table(value, where, f"a table with {EXPECTED_SOURCE}")
    sources = [way for way in INERTIA_SOURCES if way in entries]
    if len(sources) != 1:
        if not sources:
            fail(where, EXPECTED_SOURCE, entries, _nearest_source(entries) or "none of them is given")
        fail(where, EXPECTED_SOURCE, entries, f"{' and '.join(sources)} are given")
    body = _READERS[sources[0]](entries, where, folders or Folders())
    _require_propagable(body, entries.get(sources[0]), f"{where}.{sources[0]}")
    return body


def _nearest_source(entries: Mapping[str, Any]) -> str:
    return next((hint for hint in (nearest(key, INERTIA_SOURCES) for key in entries) if hint), "")


def _settled(inertia: Matrix) -> Matrix:
    """Return an inertia tensor in which products of inertia that are only rounding errors are replaced by zero."""
    # A body given by decimals then counts as given along its principal axes if it was meant so.
    limit = max(abs(inertia[i][i]) for i in range(3)) * NEGLIGIBLE
    first, second, third = (tuple(Fraction(0) if abs(x) <= limit else x for x in row) for row in inertia)
    return first, second, third  # type: ignore[return-value]


def _require_propagable(body: Body, value: object, where: str) -> None:
    """Raise InputError unless Euler's equations determine the angular acceleration of ``body``, computed in doubles.

    The moments of inertia must be those of a possible body. They must be positive, since a torque about an axis without
    a moment of inertia determines no acceleration, and between 1e-120 and 1e120 kg m^2, so that no product overflows.
    """
    require_admissible(body.principal, where)
    reason = why_not_propagable(body.principal)
    if reason:
        fail(where, "a body with three positive moments of inertia", value, reason)
    if not 1 / LARGEST_MOMENT <= min(body.principal.moments) <= max(body.principal.moments) <= LARGEST_MOMENT:
        moments = [float(moment) for moment in body.principal.moments]
        fail(where, "moments of inertia between 1e-120 and 1e120 kg m^2", moments)


# --- given moments ----------------------------------------------------------------------------------------------------

_ABOUT = {"about": Entry(choice(*ABOUT), default="center_of_mass")}
_MOMENT_ENTRIES = {
    **_ABOUT,
    "mass": Entry(number("a mass in kg", "positive")),
    "center_of_mass": Entry(vector("m")),
    "name": Entry(text, default=""),
}

_moment = number("a moment of inertia in kg m^2", "nonnegative")
_product = number("a product of inertia in kg m^2 (I_xy = -integral of x y dm)")


_three_moments = items(3, _moment, "three principal moments [A, B, C] in kg m^2")
_entry = number("an entry of an inertia tensor in kg m^2")


def _rows_of_tensor(value: Any, where: str) -> Matrix:
    """Return the inertia tensor whose three rows a scene gives as ``value``, the entry with the name ``where``.

    Entries ij and ji that differ only by rounding become their mean; other differences raise InputError.
    """
    if len(value) != 3 or not all(isinstance(row, list | tuple) and len(row) == 3 for row in value):
        fail(where, "three rows of three numbers in kg m^2, where I_xy = -integral of x y dm", value)
    rows = [[_entry(item, f"{where}[{i}][{j}]") for j, item in enumerate(row)] for i, row in enumerate(value)]
    limit = max(abs(rows[i][i]) for i in range(3)) * ASYMMETRY
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if abs(rows[i][j] - rows[j][i]) > limit:
            pair = [float(rows[i][j]), float(rows[j][i])]
            fail(f"{where}[{i}][{j}]", f"a symmetric tensor, the same number as in [{j}][{i}]", pair)
        rows[i][j] = rows[j][i] = (rows[i][j] + rows[j][i]) / 2
    for i in range(3):
        _moment(value[i][i], f"{where}[{i}][{i}]")
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = rows
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def _tensor(value: Any, where: str) -> Matrix:
    if isinstance(value, list | tuple):
        return _rows_of_tensor(value, where)
    zero = Fraction(0)
    i = read_table(value, where, {
        **{key: Entry(_moment, required=True) for key in ("xx", "yy", "zz")},
        **{key: Entry(_product, default=zero) for key in ("xy", "xz", "yz")},
    }, "an inertia tensor in kg m^2")  # fmt: skip
    return (i["xx"], i["xy"], i["xz"]), (i["xy"], i["yy"], i["yz"]), (i["xz"], i["yz"], i["zz"])


def _body_of_moments(inertia: Matrix, values: Mapping[str, Any], where: str, source: str) -> Body:
    """Return the body with the tensor ``inertia`` about its point of rotation.

    ``values`` has the entries ``"mass"``, ``"center_of_mass"``, ``"name"`` and ``"about"`` of the body's table in the
    scene file. ``source`` says how the inertia was given, for the body's description:
    ``"wheel with given principal moments"``.
    """
    about, center = values["about"], values["center_of_mass"]
    if about == "center_of_mass":
        if center is not None and any(center):
            expected = 'this key only beside about = "fixed_point", since it is measured from the fixed point'
            fail(f"{where}.center_of_mass", expected, center)
        center = _ZERO
    description = f"{values['name'] or 'body'} with {source}"
    return Body(values["mass"], inertia, center, about, description, principal_axes(inertia, where))


def _read_principal(value: Mapping[str, Any], where: str, folders: Folders) -> Body:
    _no_fixed_point(value, where)
    values = read_table(value, where, {"principal": Entry(_three_moments, required=True), **_MOMENT_ENTRIES}, "a body")
    a, b, c = values["principal"]
    zero = Fraction(0)
    return _body_of_moments(
        ((a, zero, zero), (zero, b, zero), (zero, zero, c)), values, where, "given principal moments"
    )


def _read_tensor(value: Mapping[str, Any], where: str, folders: Folders) -> Body:
    _no_fixed_point(value, where)
    values = read_table(value, where, {"inertia": Entry(_tensor, required=True), **_MOMENT_ENTRIES}, "a body")
    return _body_of_moments(values["inertia"], values, where, "a given inertia tensor")


def _no_fixed_point(value: Mapping[str, Any], where: str) -> None:
    if "fixed_point" in value:
        fail(f"{where}.fixed_point", "this key only for a body given by shapes", value["fixed_point"],
                 "given moments of inertia refer to the fixed point already: leave this key out and write "
                 'about = "fixed_point"')  # fmt: skip


# --- shapes -----------------------------------------------------------------------------------------------------------

_PLACED = {**_ABOUT, "fixed_point": Entry(vector("m")), "name": Entry(text, default="")}


def _shape_name(value: Any, where: str) -> Shape:
    if not isinstance(value, str) or value not in SHAPES:
        fail(where, f"one of the shapes {', '.join(SHAPES)}", value, nearest(value, SHAPES))
    return SHAPES[value]


def _amount(shape: Shape) -> dict[str, Entry]:
    """Return the rules by which the keys ``mass`` and ``density`` of a shape's table are read.

    The shape ``point_masses`` has neither key, since each point has its own mass; the result is then empty.
    """
    if shape.kind == "points":
        return {}
    return {
        "mass": Entry(number("a mass in kg", "positive")),
        "density": Entry(_density(shape.density_unit)),
    }


def _density(unit: str) -> Reader:
    """Return a reader for densities in ``unit``: a positive number, or a polynomial in x, y, z.

    The reader returns a number as a Fraction, and a formula in x, y, z as its text. Whether the formula is a polynomial
    is checked later, when the mass is computed.
    """
    uniform = number(f"a density in {unit}", "positive")

    def reader(value: Any, where: str) -> Any:
        if isinstance(value, str) and len(value) <= LONGEST_DENSITY and _POSITION & set(value):
            names = expression.names(expression.parse(value, where))
            if names <= _POSITION:
                return value
            fail(where, f"a density in {unit}, a number or a polynomial in x, y, z", value)
        return uniform(value, where)

    return reader


def _read_shape_table(value: Mapping[str, Any], where: str, others: Mapping[str, Entry]) -> tuple[Part, dict[str, Any]]:
    """Return the shape in a table such as ``{shape = "sphere", radius = 1, mass = 2}``, and all values of the table.

    ``others`` are further keys that the table may have, such as ``name``, with their rules.
    """
    if "shape" not in value:
        fail(f"{where}.shape", f"one of the shapes {', '.join(SHAPES)}; the key is missing")
    shape = _shape_name(value["shape"], f"{where}.shape")
    dimensions = [dimension.name for dimension in shape.dimensions]
    values = read_table(value, where, {
        "shape": Entry(_shape_name, required=True),
        **{name: Entry(unchanged, required=True) for name in dimensions},
        **_amount(shape),
        **others,
    }, f"a {shape.name}")  # fmt: skip
    amounts = [key for key in ("mass", "density") if values.get(key) is not None]
    if shape.kind != "points" and len(amounts) != 1:
        expectation = f"exactly one of mass (kg) and density ({shape.density_unit}) of a {shape.name}"
        amounts_by_name = {key: value[key] for key in amounts}
        fail(f"{where}.mass", expectation if amounts_by_name else f"{expectation}, got neither", amounts_by_name or ...)
    for name in dimensions:
        _bounded(values[name], f"{where}.{name}")
    part = Part(
        shape.name,
        check_dimensions(shape, {name: values[name] for name in dimensions}, where),
        mass=values.get("mass"),
        density=values.get("density"),
        at=values.get("at") or _ZERO,
        rotation=values["rotate"].dcm if values.get("rotate") else _UNTURNED,
        subtract=bool(values.get("subtract")),
    )
    return part, values


_length = number("a number in m")


def _bounded(value: Any, where: str) -> None:
    """Raise InputError if a dimension, or an item of a list of dimensions, is not a number or is out of range.

    The message names the place ``where``, with the number of the item.
    """
    if isinstance(value, list | tuple):
        for index, item in enumerate(value):
            _bounded(item, f"{where}[{index}]")
    else:
        _length(value, where)


def _placed(parts: Sequence[Part], values: Mapping[str, Any], where: str, source: str, of_parts: str) -> Body:
    """Return the body composed of ``parts``.

    ``values`` has the entries ``"about"`` (centre of mass or fixed point), ``"fixed_point"`` and ``"name"`` of the
    body's table in the scene file. ``source`` describes a body without a name; ``where`` and ``of_parts`` name the body
    and its parts in messages.
    """
    body = _about_point(mass_properties(parts, of_parts), values, where, source)
    return body._replace(parts=tuple(parts), warnings=doubtful_holes(parts, of_parts))


def _about_point(properties: MassProperties, values: Mapping[str, Any], where: str, source: str) -> Body:
    """Return the body with the given mass properties; its point of rotation and its name are in ``values``.

    The point of rotation is the centre of mass or the entry ``fixed_point``; ``source`` describes an unnamed body.
    """
    about, point = values["about"], values["fixed_point"]
    if about == "center_of_mass" and point is not None:
        fail(
            f"{where}.fixed_point",
            'about = "fixed_point" in the same table, since a body rotates about a fixed point only then',
            point,
        )
    if about == "fixed_point" and point is None:
        fail(f"{where}.fixed_point", "the point about which the body rotates, three numbers [x, y, z] in m, in the "
                 "axes of the body; the key is missing")  # fmt: skip
    inertia, center, origin = properties.inertia, _ZERO, properties.center_of_mass
    if about == "fixed_point":
        x, y, z = (c - p for c, p in zip(properties.center_of_mass, point, strict=True))
        size = max(map(abs, (*properties.center_of_mass, *point)))
        x, y, z = (Fraction(0) if abs(item) <= size * NEGLIGIBLE else item for item in (x, y, z))
        center, origin = (x, y, z), point
        inertia = about_point(inertia, properties.mass, center)
    inertia = _settled(inertia)
    description = values["name"] or source
    principal = principal_axes(inertia, where)
    return Body(properties.mass, inertia, center, about, description, principal, (), origin)


def _read_mesh(value: Mapping[str, Any], where: str, folders: Folders) -> Body:
    body, values = read_mesh_table(value, where, _PLACED, Entry(_density("kg/m^3")), folders)
    about = _about_point(body.properties, values, where, "mesh")
    return about._replace(facets=body.facets, warnings=body.warnings)


def _read_shape(value: Mapping[str, Any], where: str, folders: Folders) -> Body:
    part, values = _read_shape_table(value, where, _PLACED)
    return _placed([part], values, where, part.shape.replace("_", " "), where)


_PART = {
    "at": Entry(vector("m")),
    "rotate": Entry(read_attitude),
    "subtract": Entry(flag, default=False),
    "name": Entry(text, default=""),
}


def _parts(value: Any, where: str) -> list[Part]:
    if not isinstance(value, list) or not all(isinstance(item, Mapping) for item in value):
        fail(where, "a list of parts, each written as [[body.part]]", value)
    if not 1 <= len(value) <= MOST_PARTS:
        fail(where, f"1 to {MOST_PARTS} parts", len(value))
    return [_read_shape_table(item, f"{where}[{index}]", _PART)[0] for index, item in enumerate(value)]


def _read_parts(value: Mapping[str, Any], where: str, folders: Folders) -> Body:
    values = read_table(value, where, {"part": Entry(_parts, required=True), **_PLACED}, "a body of parts")
    parts: list[Part] = values["part"]
    return _placed(parts, values, where, f"body of {len(parts)} parts", f"{where}.part")


_READERS: dict[str, Callable[[Mapping[str, Any], str, Folders], Body]] = {
    "shape": _read_shape,
    "part": _read_parts,
    "mesh": _read_mesh,
    "principal": _read_principal,
    "inertia": _read_tensor,
}

"""The shapes of symrot as data: dimensions, conditions, axes, and the map of each shape. Standard library only.

A map gives positions, in the axes of the shape, as formulas (texts) in coordinates, with limits in the dimensions. The
limits of an angle are multiples of pi/2. Volume, mass, centre of mass and inertia all follow from the map.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from operator import le, lt
from typing import Any, NamedTuple

from symrot.errors import InputError, prefix
from symrot.formula.exact_numbers import read, show

__all__ = [
    "DENSITY_UNITS", "SHAPES", "Coordinate", "Dimension", "Shape", "check_dimensions", "check_names", "find_shape",
    "scalar_names", "scalars",
]  # fmt: skip

DENSITY_UNITS = {"solid": "kg/m^3", "surface": "kg/m^2", "curve": "kg/m", "points": "1"}
"""Unit of the density for each kind of shape; points have no density, but masses among their dimensions."""


class Dimension(NamedTuple):
    """A dimension of a shape: a length in m, or a list of points (m) or of masses (kg)."""

    name: str
    meaning: str
    symbol: str
    least: str = "positive"  # positive | zero (allowed) | any
    form: str = "length"  # length | points | masses
    # the number of items in a list; None: any number
    size: int | None = None


class Coordinate(NamedTuple):
    """One coordinate of a shape's map to positions, with its limits as formulas in the dimensions."""

    # s, u, v, w: lengths, m; f_1, f_2, f_3: fractions from 0 to 1; theta, phi: angles, rad
    name: str
    lower: str
    upper: str

    @property
    def angle(self) -> bool:
        """Whether the coordinate is an angle: it has pi in its limits, and occurs only inside ``cos`` and ``sin``."""
        return "pi" in self.upper


class Shape(NamedTuple):
    """A shape of the table :data:`SHAPES`: dimensions, conditions such as ``inner < outer``, axes, map to positions."""

    name: str
    kind: str  # a key of DENSITY_UNITS
    dimensions: tuple[Dimension, ...]
    axes: str
    coordinates: tuple[Coordinate, ...] = ()
    # m, in terms of the coordinates; missing for point masses
    position: tuple[str, str, str] | tuple[()] = ()
    conditions: tuple[tuple[str, str, str], ...] = ()  # (dimension, "<" or "<=", dimension)

    @property
    def density_unit(self) -> str:
        """The unit of a density of this shape: kg per m^3, m^2 or m."""
        return DENSITY_UNITS[self.kind]


_RELATIONS: dict[str, Callable[[Any, Any], bool]] = {"<": lt, "<=": le}

_TURN = Coordinate("phi", "0", "2*pi")
_SHARES = tuple(Coordinate(name, "0", "1") for name in ("f_1", "f_2", "f_3"))
_ALONG_A = Coordinate("u", "-a/2", "a/2")
_ALONG_B = Coordinate("v", "-b/2", "b/2")
_ALONG_LENGTH = Coordinate("w", "-length/2", "length/2")
_RADIUS = Dimension("radius", "from the centre or the axis", "R")
_LENGTH = Dimension("length", "length along z", "L")
_HEIGHT = Dimension("height", "height along z", "h")
_INNER = Dimension("inner", "inner radius", "R_1", "zero")
_OUTER = Dimension("outer", "outer radius", "R_2")
_TRIANGLE = (
    Dimension("base", "side along x, from the first corner to the second", "b"),
    Dimension("height", "distance of the third corner from that side, along y", "h"),
    Dimension("apex", "x of the third corner", "e", "any"),
)
_TRIANGLE_MAP = ("base*f_1*(1 - f_2) + apex*f_2", "height*f_2")
_SPHERE_MAP = ("s*sin(theta)*cos(phi)", "s*sin(theta)*sin(phi)", "s*cos(theta)")
_HALF_TURN = Coordinate("theta", "0", "pi")


def _corner(axis: str) -> str:
    """Return the formula for one coordinate (x, y or z) of a point in a tetrahedron with the corners c1 to c4."""
    # c1 + f_1 (P - c1), with P = c2 + f_2 (Q - c2) on the opposite face and Q = c3 + f_3 (c4 - c3) on an edge of it;
    # f_1, f_2, f_3 are fractions from 0 to 1.
    return f"{axis}1 + f_1*({axis}2 - {axis}1 + f_2*({axis}3 - {axis}2 + f_3*({axis}4 - {axis}3)))"


_TABLE = (
    Shape(
        "box", "solid",
        (Dimension("a", "side along x", "a"), Dimension("b", "side along y", "b"), Dimension("c", "side along z", "c")),
        "origin at the centre, axes along the sides",
        (_ALONG_A, _ALONG_B, Coordinate("w", "-c/2", "c/2")), ("u", "v", "w"),
    ),
    Shape(
        "cylinder", "solid", (_RADIUS, _LENGTH), "origin at the centre, z along the axis",
        (Coordinate("s", "0", "radius"), _TURN, _ALONG_LENGTH), ("s*cos(phi)", "s*sin(phi)", "w"),
    ),
    Shape(
        "hollow_cylinder", "solid", (_INNER, _OUTER, _LENGTH), "origin at the centre, z along the axis",
        (Coordinate("s", "inner", "outer"), _TURN, _ALONG_LENGTH), ("s*cos(phi)", "s*sin(phi)", "w"),
        (("inner", "<", "outer"),),
    ),
    Shape(
        "cone", "solid", (Dimension("radius", "radius of the base", "R"), _HEIGHT),
        "origin at the centre of the base, z along the axis toward the apex at z = height",
        (Coordinate("s", "0", "radius"), _TURN, _SHARES[0]),
        ("s*(1 - f_1)*cos(phi)", "s*(1 - f_1)*sin(phi)", "height*f_1"),
    ),
    Shape(
        "frustum", "solid",
        (
            Dimension("bottom", "radius at z = 0", "R_1"), Dimension("top", "radius at z = height", "R_2", "zero"),
            _HEIGHT,
        ),
        "origin at the centre of the bottom, z along the axis toward the top at z = height",
        (_SHARES[0], _TURN, _SHARES[1]),
        ("f_1*(bottom + (top - bottom)*f_2)*cos(phi)", "f_1*(bottom + (top - bottom)*f_2)*sin(phi)", "height*f_2"),
    ),
    Shape(
        "sphere", "solid", (_RADIUS,), "origin at the centre",
        (Coordinate("s", "0", "radius"), _HALF_TURN, _TURN), _SPHERE_MAP,
    ),
    Shape(
        "spherical_shell", "surface", (_RADIUS,), "origin at the centre",
        (_HALF_TURN, _TURN), ("radius*sin(theta)*cos(phi)", "radius*sin(theta)*sin(phi)", "radius*cos(theta)"),
    ),
    Shape(
        "hollow_sphere", "solid", (_INNER, _OUTER), "origin at the centre",
        (Coordinate("s", "inner", "outer"), _HALF_TURN, _TURN), _SPHERE_MAP, (("inner", "<", "outer"),),
    ),
    Shape(
        "hemisphere", "solid", (_RADIUS,), "origin at the centre of the flat face, the dome toward +z",
        (Coordinate("s", "0", "radius"), Coordinate("theta", "0", "pi/2"), _TURN), _SPHERE_MAP,
    ),
    Shape(
        "ellipsoid", "solid",
        (
            Dimension("a", "semi-axis along x", "a"), Dimension("b", "semi-axis along y", "b"),
            Dimension("c", "semi-axis along z", "c"),
        ),
        "origin at the centre, axes along the semi-axes",
        (_SHARES[0], _HALF_TURN, _TURN),
        ("a*f_1*sin(theta)*cos(phi)", "b*f_1*sin(theta)*sin(phi)", "c*f_1*cos(theta)"),
    ),
    Shape(
        "torus", "solid",
        (Dimension("ring", "radius of the centre line", "R"), Dimension("tube", "radius of the tube", "r")),
        "origin at the centre, z along the axis of revolution",
        (Coordinate("s", "0", "tube"), _TURN, Coordinate("theta", "0", "2*pi")),
        ("(ring + s*cos(theta))*cos(phi)", "(ring + s*cos(theta))*sin(phi)", "s*sin(theta)"), (("tube", "<=", "ring"),),
    ),
    Shape("rod", "curve", (_LENGTH,), "origin at the centre, z along the rod", (_ALONG_LENGTH,), ("0", "0", "w")),
    Shape(
        "disk", "surface", (_RADIUS,), "origin at the centre, z along the normal",
        (Coordinate("s", "0", "radius"), _TURN), ("s*cos(phi)", "s*sin(phi)", "0"),
    ),
    Shape(
        "ring", "curve", (_RADIUS,), "origin at the centre, z along the normal",
        (_TURN,), ("radius*cos(phi)", "radius*sin(phi)", "0"),
    ),
    Shape(
        "plate", "surface", (Dimension("a", "side along x", "a"), Dimension("b", "side along y", "b")),
        "origin at the centre, z along the normal", (_ALONG_A, _ALONG_B), ("u", "v", "0"),
    ),
    Shape(
        "triangular_plate", "surface", _TRIANGLE,
        "origin at the first corner, corners (0, 0), (base, 0), (apex, height) in the plane z = 0",
        _SHARES[:2], (*_TRIANGLE_MAP, "0"),
    ),
    Shape(
        "triangular_prism", "solid", (*_TRIANGLE, _LENGTH),
        "corners (0, 0), (base, 0), (apex, height) in x, y; z from -length/2 to length/2",
        (*_SHARES[:2], _ALONG_LENGTH), (*_TRIANGLE_MAP, "w"),
    ),
    Shape(
        "tetrahedron", "solid", (Dimension("vertices", "the four corners [x, y, z]", "P", "any", "points", 4),),
        "origin and axes in which the corners are given",
        _SHARES, (_corner("x"), _corner("y"), _corner("z")),
    ),
    Shape(
        "point_masses", "points",
        (
            Dimension("masses", "the masses", "m", "positive", "masses"),
            Dimension("points", "their positions [x, y, z]", "P", "any", "points"),
        ),
        "origin and axes in which the points are given",
    ),
)  # fmt: skip

SHAPES: dict[str, Shape] = {shape.name: shape for shape in _TABLE}
"""All shapes by name, in the order in which documents list them."""


def find_shape(name: object, where: str = "") -> Shape:
    """Return the shape called ``name``, such as ``"cone"``.

    Any other value raises InputError; the message lists all names.
    """
    if not isinstance(name, str) or name not in SHAPES:
        raise InputError(f"{prefix(where)}expected a shape, one of {', '.join(SHAPES)}; got {show(name)}")
    return SHAPES[name]


def _point(value: object, where: str) -> tuple[Fraction, Fraction, Fraction]:
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != 3:
        raise InputError(f"{prefix(where)}expected a point [x, y, z] in m, got {show(value)}")
    x, y, z = (read(item, f"{where}[{index}]") for index, item in enumerate(value))
    return x, y, z


def _length(value: object, dimension: Dimension, where: str) -> Fraction:
    number = read(value, where)
    if (number < 0 and dimension.least != "any") or (number == 0 and dimension.least == "positive"):
        expected = "a positive number" if dimension.least == "positive" else "a number >= 0"
        unit = "kg" if dimension.form == "masses" else "m"
        raise InputError(f"{prefix(where)}expected {expected} ({dimension.meaning}, {unit}), got {show(value)}")
    return number


def _read_dimension(value: object, dimension: Dimension, where: str) -> Any:
    if dimension.form == "length":
        return _length(value, dimension, where)
    if isinstance(value, str) or not isinstance(value, list | tuple) or len(value) != (dimension.size or len(value)):
        many = f"a list of {dimension.size}" if dimension.size else "a list"
        raise InputError(f"{prefix(where)}expected {many}, {dimension.meaning}; got {show(value)}")
    if not value:
        raise InputError(f"{prefix(where)}expected at least one entry, {dimension.meaning}; got an empty list")
    items = enumerate(value)
    if dimension.form == "points":
        return tuple(_point(item, f"{where}[{index}]") for index, item in items)
    return tuple(_length(item, dimension, f"{where}[{index}]") for index, item in items)


def check_names(shape: Shape, dimensions: Mapping[str, object], where: str = "") -> None:
    """Raise InputError unless the keys of ``dimensions`` are exactly the names of the dimensions of the shape."""
    expected = [dimension.name for dimension in shape.dimensions]
    unknown, missing = sorted(set(dimensions) - set(expected)), [name for name in expected if name not in dimensions]
    if unknown or missing:
        fault = f"'{unknown[0]}' is not one of them" if unknown else f"'{missing[0]}' is missing"
        raise InputError(f"{prefix(where)}expected the dimensions {', '.join(expected)} of the {shape.name}; {fault}")


def check_dimensions(shape: Shape, dimensions: Mapping[str, object], where: str = "") -> dict[str, Any]:
    """Check the dimensions of a shape, and return them as exact numbers.

    Parameters
    ----------
    shape : Shape
        A shape of :data:`SHAPES`.
    dimensions : mapping of str to number, text, or list of these
        Values that :func:`symrot.formula.exact_numbers.read` accepts, in m (masses in kg).
    where : str
        Place of the dimensions in the scene, put in front of every error message.

    Returns
    -------
    dict of str to Fraction, or to a tuple of masses or of points

    Raises
    ------
    InputError
        If a dimension is missing or unknown, has a sign that the table of shapes does not allow, if a condition such as
        ``inner < outer`` is violated, or if lists have different lengths.
    """
    check_names(shape, dimensions, where)
    dot = f"{where}." if where else ""
    checked = {d.name: _read_dimension(dimensions[d.name], d, dot + d.name) for d in shape.dimensions}
    for left, relation, right in shape.conditions:
        if not _RELATIONS[relation](checked[left], checked[right]):
            raise InputError(
                f"{prefix(where)}expected {left} {relation} {right} of the {shape.name}; "
                f"got {left} = {show(dimensions[left])}, {right} = {show(dimensions[right])}"
            )
    lists = [d.name for d in shape.dimensions if d.form != "length" and d.size is None]
    if len({len(checked[name]) for name in lists}) > 1:
        counts = ", ".join(f"{len(checked[name])} {name}" for name in lists)
        raise InputError(f"{prefix(where)}expected as many {' as '.join(lists)}; got {counts}")
    return checked


def scalar_names(shape: Shape) -> tuple[str, ...]:
    """Return the names of a shape's dimensions, with points split into coordinates such as ``x1, y1, z1, x2``.

    The points of ``point_masses``, whose number is not fixed, are left out.
    """
    names: list[str] = []
    for d in shape.dimensions:
        corners = [f"{axis}{n}" for n in range(1, (d.size or 0) + 1) for axis in "xyz"]
        names += corners if d.form == "points" else [d.name]
    return tuple(names)


def scalars(shape: Shape, dimensions: Mapping[str, Any]) -> dict[str, Any]:
    """Return a map from the name of each scalar dimension to its number; points are split into coordinates.

    The points ``((0, 0, 0), (1, 0, 0), ..)`` give ``x1 = 0, y1 = 0, z1 = 0, x2 = 1, ..``. Raise ``ValueError`` for
    ``point_masses``.
    """
    values: list[Any] = []
    for d in shape.dimensions:
        value = dimensions[d.name]
        values += [component for point in value for component in point] if d.form == "points" else [value]
    return dict(zip(scalar_names(shape), values, strict=True))

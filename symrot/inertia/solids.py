"""Mass properties of solids, surfaces and curves, symbolic in their dimensions, derived by exact integration.

A shape is given only by its map (:mod:`symrot.inertia.shapes`). The Jacobian, the volume, the mass, the centre of mass
and the inertia tensor are computed from the map (:mod:`symrot.inertia.integration`) and factored. ``python -m
symrot.inertia.solids`` prints ``closed_forms.toml``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

from sympy import (
    Abs,
    Add,
    Expr,
    ImmutableMatrix,
    Integer,
    Mul,
    Poly,
    Rational,
    Symbol,
    cancel,
    cos,
    expand,
    factor,
    factor_terms,
    nan,
    oo,
    pi,
    sin,
    sqrt,
    sstr,
    sympify,
    tan,
    zoo,
)

import symrot
from symrot import symbols
from symrot.errors import InputError
from symrot.formula.exact_numbers import read, show
from symrot.formula.polynomial import Polynomial, constant, exact_quotient, generator
from symrot.formula.tree import evaluate, parse
from symrot.inertia import tensor
from symrot.inertia.bodies import MassProperties, compose
from symrot.inertia.integration import (
    LARGEST_DEGREE,
    Domain,
    domain,
    moments_per_measure,
    require_not_negative,
    shape_points,
)
from symrot.inertia.shapes import SHAPES, Dimension, Shape, check_names, find_shape, scalar_names

__all__ = ["Integral", "Solid", "closed_forms_text", "solid"]

_CONSTANTS = {"pi": pi}
_NOT_FINITE = (nan, zoo, oo, -oo)
_FUNCTIONS = {"sqrt": sqrt, "sin": sin, "cos": cos, "tan": tan, "abs": Abs}
_DIMENSION_SYMBOLS = {str(symbol): symbol for symbol in (*symbols.dimensions, symbols.e, *symbols.corners)}
_MAP_ANGLES = symbols.theta, symbols.phi
_MAP_SYMBOLS = {str(symbol): symbol for symbol in (*symbols.map_lengths, *symbols.map_shares, *_MAP_ANGLES)}


@dataclass(frozen=True)
class Integral:
    """One integral over a shape, for a derivation page."""

    quantity: str  # what it computes, such as "first moment x"
    integrand: Expr  # with the Jacobian as a factor
    limits: tuple[tuple[Symbol, Expr, Expr], ...]  # (coordinate, lower, upper)
    value: Expr


@dataclass(frozen=True, repr=False)
class Solid:
    """The mass properties of a body of one shape, symbolic, in the axes of the shape.

    Attributes
    ----------
    name : str
        Name of the shape.
    dimensions : mapping of str to Expr
        Lengths in m by name, such as ``"radius"`` and ``"height"`` of a cone; the corners of a tetrahedron are ``"x1"``
        to ``"z4"``. Point masses have the tuples ``"masses"`` (kg) and ``"points"`` instead.
    measure : Expr
        Volume (m^3), area (m^2), length (m), or number of points.
    density : Expr
        The density as a function of x, y, z, in kg per unit of the measure.
    mass : Expr, kg
    center_of_mass : ImmutableMatrix, shape (3, 1), m
    inertia : ImmutableMatrix, shape (3, 3), kg m^2
        The tensor about the centre of mass, with the products of inertia negated.

    Examples
    --------
    >>> import symrot
    >>> symrot.solid("cone").inertia[2, 2]
    3*R**2*m/10
    """

    name: str
    dimensions: Mapping[str, Any]
    measure: Expr
    density: Expr
    mass: Expr
    center_of_mass: ImmutableMatrix
    inertia: ImmutableMatrix

    def __repr__(self) -> str:
        return f"<Solid {self.name}: mass {self.mass}, moments about its centre {list(self.inertia.diagonal())}>"

    def _repr_markdown_(self) -> str:
        return symrot.in_notebook(self)

    @property
    def shape(self) -> Shape:
        """The row of the table of shapes for this body: dimensions, axes, and the map from coordinates to positions."""
        return SHAPES[self.name]

    @property
    def volume(self) -> Expr:
        """The measure of the body: volume of a solid, area of a surface, length of a curve, number of point masses."""
        return self.measure

    @cached_property
    def position(self) -> ImmutableMatrix:
        """The map of the shape: position (m), shape (3, 1), as a function of coordinates; empty for point masses."""
        known = {**_CONSTANTS, **_MAP_SYMBOLS, **self.dimensions}
        return ImmutableMatrix([evaluate(parse(t), known, _FUNCTIONS, _rational) for t in self.shape.position])

    @cached_property
    def jacobian(self) -> Expr:
        """The Jacobian of the map :attr:`position`: volume, area or length per unit of the coordinates."""
        return factor(self._over(_mapped(self.name).jacobian))

    @cached_property
    def limits(self) -> tuple[tuple[Symbol, Expr, Expr], ...]:
        """The coordinates of the map :attr:`position`, each with its lower and upper limit."""
        limits = _mapped(self.name).limits
        return tuple((_MAP_SYMBOLS[c.name], self._over(low), self._over(high)) for c, low, high in limits)

    @cached_property
    def steps(self) -> tuple[Integral, ...]:
        """The integrals that give the result: measure, mass, first and second moments about the origin.

        The tuple is empty for point masses.
        """
        if not self.limits:
            return ()
        weight = self.density.xreplace(dict(zip(symbols.position, self.position, strict=True))) * self.jacobian
        inertia = tensor.matrix(self.inertia_about((0, 0, 0)))
        half_trace = tensor.trace(inertia) / 2
        integrals = [("measure", self.jacobian, self.measure), ("mass", weight, self.mass)]
        for i, axis in enumerate("xyz"):
            integrals.append((f"first moment {axis}", self.position[i] * weight, self.mass * self.center_of_mass[i]))
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            value = half_trace - inertia[i][i] if i == j else -inertia[i][j]
            integrand = self.position[i] * self.position[j] * weight
            integrals.append((f"second moment {'xyz'[i]}{'xyz'[j]}", integrand, value))
        return tuple(Integral(name, integrand, self.limits, factor(value)) for name, integrand, value in integrals)

    def inertia_about(self, point: Any) -> ImmutableMatrix:
        """Return the inertia tensor, kg m^2, about a point (m, axes of the shape), by the parallel axis theorem."""
        offset = [_scalar(p) - c for p, c in zip(tensor.vector(point), self.center_of_mass, strict=True)]
        return _tidied(tensor.about_point(self.inertia, self.mass, offset))

    def with_mass(self, mass: Any) -> "Solid":
        """Return the same body with its density, or its point masses, scaled so that its total mass is ``mass``, kg."""
        total = _dimension(mass, _MASS, self.shape)
        share = total / self.mass
        inertia = _tidied(tensor.scale(share, self.inertia))
        if "masses" in self.dimensions:
            scaled = {**self.dimensions, "masses": tuple(factor(each * share) for each in self.dimensions["masses"])}
            return replace(self, dimensions=scaled, mass=total, inertia=inertia)
        return replace(self, mass=total, density=factor(self.density * share), inertia=inertia)

    def _over(self, polynomial: Polynomial) -> Expr:
        return _expression(polynomial, {**_MAP_SYMBOLS, **self.dimensions})


def _tidy_measure(expression: Expr) -> Expr:
    """Return a volume, area or length with its common factors in front, such as ``pi*L*(R_2**2 - R_1**2)``."""
    return factor_terms(expand(expression))


def _tidied(rows: tensor.Tensor) -> ImmutableMatrix:
    return ImmutableMatrix(3, 3, [factor(sympify(entry)) for row in rows for entry in row])


def _expression(polynomial: Polynomial, values: Mapping[str, Expr]) -> Expr:
    """Return a polynomial as a SymPy expression, with ``values`` in place of its names."""
    known = {**_CONSTANTS, **values}
    # a name without a value is pi, or cos or sin of a coordinate
    used = {name for monomial in polynomial.terms for name, _ in monomial}
    generators = {name: known[name] if name in known else evaluate(parse(name), known, _FUNCTIONS) for name in used}
    terms = [
        Mul(Rational(c.numerator, c.denominator), *(generators[name] ** power for name, power in monomial))
        for monomial, c in polynomial.terms.items()
    ]
    return Add(*terms)


@cache
def _mapped(name: str) -> Domain:
    return domain(SHAPES[name])


@cache
def _default_dimensions(name: str) -> dict[str, Symbol]:
    """Return the default symbol for each dimension of a shape: ``"radius"`` of a cone has the symbol R."""
    shape = SHAPES[name]
    plain = {d.name: d.symbol for d in shape.dimensions if d.form == "length"}
    # a corner of a tetrahedron has three names, such as "x1", "y1" and "z1"
    return {n: _DIMENSION_SYMBOLS[plain.get(n, f"{n[0]}_{n[1:]}")] for n in scalar_names(shape)}


def _properties(
    region: Domain, values: Mapping[str, Expr], density: Polynomial | None = None
) -> tuple[Expr, ImmutableMatrix, ImmutableMatrix]:
    """Return mass, centre of mass, and inertia per mass about this centre, of a shape with the dimensions ``values``.

    ``density`` is a polynomial in the coordinates over which ``region`` integrates, such as a radius and an angle;
    without it, the mass is the measure (volume, area or length) of the shape.
    """
    measure, specific_moments = moments_per_measure(region, density)
    if not specific_moments.zeroth:
        raise InputError("expected a density with a positive mass, got a density with a mass of 0 kg")
    mass = _expression(measure, values) * _expression(specific_moments.zeroth, values)
    center = [_ratio(entry, specific_moments.zeroth, values) for entry in specific_moments.first]
    second = [[_ratio(entry, specific_moments.zeroth, values) for entry in row] for row in specific_moments.second]
    specific = tensor.inertia_of_second_moments(second)
    return mass, ImmutableMatrix(center), _tidied(tensor.about_center_of_mass(specific, Integer(1), center))


def _ratio(numerator: Polynomial, denominator: Polynomial, values: Mapping[str, Expr]) -> Expr:
    """Return ``numerator/denominator`` as an expression in lowest terms, with ``values`` in place of the names."""
    quotient = exact_quotient(numerator, denominator)
    if quotient is not None:
        return _expression(quotient, values)
    return cancel(_expression(numerator, values) / _expression(denominator, values))


@cache
def _uniform(name: str) -> tuple[Expr, ImmutableMatrix, ImmutableMatrix]:
    """Return measure (volume, area or length), centre of mass, and inertia per unit mass of a uniform shape."""
    # in default symbols; solid inserts other values
    measure, center, specific = _properties(_mapped(name), _default_dimensions(name))
    return _tidy_measure(measure), center, specific


def _scalar(value: Any) -> Expr:
    """Return a dimension or mass (expression, number, or text such as ``"2*R"``) as an exact expression."""
    if isinstance(value, Expr):
        return value
    if isinstance(value, str):
        return _formula(value, {**_DIMENSION_SYMBOLS, "m": symbols.m})
    return _rational(read(value))


def _formula(text: str, known: Mapping[str, Expr]) -> Expr:
    """Return the formula ``text`` as an expression, with the values of ``known`` in place of its names.

    Raise InputError if it has another name or too many operations.
    """
    values = {**known, **_CONSTANTS}
    try:
        return sympify(evaluate(parse(text), values, _FUNCTIONS, _rational))
    except KeyError as unknown:
        expected = ", ".join(sorted(values))
        raise InputError(f"expected a formula in {expected}, got {unknown.args[0]!r} in {show(text)}") from None
    except RecursionError:
        raise InputError(f"expected a formula of fewer operations, got {show(text)}") from None


def _rational(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


def _dimension(value: Any, dimension: Dimension, shape: Shape) -> Expr:
    length = _scalar(value)
    refused = {"positive": length.is_nonpositive, "zero": length.is_negative, "any": False}[dimension.least]
    if refused or length is nan or length.is_real is False or length.is_finite is False:
        least = {"positive": "positive", "zero": "zero or positive", "any": "finite"}[dimension.least]
        meant = f"{dimension.name} of the {shape.name} ({dimension.meaning})"
        raise InputError(f"expected a {least} {meant}, got {show(value)}")
    return length


def _dimensions(shape: Shape, dimensions: Mapping[str, Any]) -> dict[str, Expr]:
    """Return an expression for each number among a shape's dimensions: the user's value, or the default symbol."""
    check_names(shape, {d.name: None for d in shape.dimensions} | dict(dimensions))
    numbers: dict[str, Expr] = dict(_default_dimensions(shape.name))
    for d in shape.dimensions:
        if d.name not in dimensions:
            continue
        if d.form == "length":
            numbers[d.name] = _dimension(dimensions[d.name], d, shape)
            continue
        points = _points(dimensions[d.name], d)
        numbers |= {f"{axis}{n}": p[k] for n, p in enumerate(points, 1) for k, axis in enumerate("xyz")}
    for left, relation, right in shape.conditions:
        gap = numbers[right] - numbers[left]
        if gap.is_negative or (relation == "<" and gap.is_zero):
            expected = f"expected {left} {relation} {right} of the {shape.name}"
            raise InputError(f"{expected}, got {numbers[left]}, {numbers[right]}")
    return numbers


def _points(corners: Any, dimension: Dimension) -> list[tuple[Expr, ...]]:
    try:
        points = [tuple(map(_scalar, tensor.vector(point))) for point in corners]
    except (TypeError, ValueError) as reason:
        if isinstance(reason, InputError):
            raise
        raise InputError(f"expected {dimension.meaning} as lists of three coordinates, got {show(corners)}") from None
    if any(coordinate.has(*_NOT_FINITE) for point in points for coordinate in point):
        raise InputError(f"expected {dimension.meaning} with finite coordinates, got {show(corners)}")
    if len(points) != (dimension.size or len(points)):
        raise InputError(f"expected {dimension.size} points, {dimension.meaning}, got {len(points)}")
    return points


def _density(density: Any, dimensions: Mapping[str, Expr]) -> Poly:
    """Return a density as a polynomial in x, y, z, with ``dimensions`` inserted; otherwise raise InputError."""
    axes = {str(axis): axis for axis in symbols.position}
    if isinstance(density, str):
        formula = _formula(density, {**_DIMENSION_SYMBOLS, "rho": symbols.rho, **dimensions, **axes})
    else:
        formula = _scalar(density)
    formula = formula.xreplace({free: axes[free.name] for free in formula.free_symbols if free.name in axes})
    if formula.has(*_NOT_FINITE) or not formula.is_polynomial(*symbols.position):
        raise InputError(f"expected a density that is a polynomial in x, y, z, got {show(density)}")
    polynomial = Poly(formula, *symbols.position)
    if polynomial.total_degree() > LARGEST_DEGREE:
        raise InputError(f"expected a density of degree at most {LARGEST_DEGREE} in x, y, z, got {show(density)}")
    return polynomial


def solid(name: str, *, mass: Any = None, density: Any = None, **dimensions: Any) -> Solid:
    """Return the mass properties of a shape, derived by exact integration.

    Parameters
    ----------
    name : str
        A key of :data:`symrot.inertia.shapes.SHAPES`.
    mass : number, str or Expr, kg, optional
        Mass of a uniform body; the symbol ``m`` if neither mass nor density is given.
    density : number, str or Expr, optional
        The density, instead of the mass, in kg per m^3, m^2 or m: a polynomial in x, y, z (m, axes of the shape). A
        text may use the names of the dimensions, as in ``"1 + z/height"``.
    **dimensions : number, str or Expr, m
        Dimensions by the names in the table of shapes; an omitted dimension is the symbol in that table.

    Returns
    -------
    Solid
        Mass in kg; centre of mass in m and inertia in kg m^2, shape (3, 3), in the axes of the shape.

    Raises
    ------
    InputError
        If a shape or dimension is unknown, a length, mass or constant density is not positive, a density is no
        polynomial of degree up to 12, has no positive integral, or, with numbers for all dimensions, is negative at a
        test point of the shape, or if both a mass and a density are passed.

    Notes
    -----
    Axes and origin are those of the shape. Source of the method: Goldstein, Poole & Safko, section 5.3.

    Examples
    --------
    >>> solid("cylinder").inertia[0, 0]
    m*(L**2 + 3*R**2)/12
    """
    shape = find_shape(name)
    if mass is not None and density is not None:
        raise InputError("expected a mass or a density, got both")
    if shape.kind == "points":
        return _point_masses(shape, mass, density, dimensions)
    values = _dimensions(shape, dimensions)
    measure, center, specific = _uniform(name)
    defaults = _default_dimensions(name)
    chosen = {symbol: values[key] for key, symbol in defaults.items() if values[key] != symbol}
    measure = _tidy_measure(measure.xreplace(chosen)) if chosen else measure
    if measure.is_zero:
        raise InputError(f"expected a {name} with a positive volume, got corners in one plane")
    if measure.is_negative:  # the same tetrahedron with its corners in the opposite order
        if isinstance(density, str):  # "x3" in it is a coordinate of the third corner in the user's order
            density = _density(density, values).as_expr()
        return solid(name, mass=mass, density=density, vertices=[dimensions["vertices"][n] for n in (0, 1, 3, 2)])
    if density is None:
        total = symbols.m if mass is None else _dimension(mass, _MASS, shape)
        uniform = factor(total / measure)
    else:
        profile = _density(density, values)
        uniform = profile.as_expr()
        if profile.total_degree() > 0:
            return _weighted(shape, values, profile, measure)
        total = factor(uniform * measure)
        if total.is_nonpositive:
            raise InputError(f"expected a positive density of the {name}, got {show(density)}")
    if chosen:
        center, specific = center.xreplace(chosen), specific.xreplace(chosen)
    inertia = _tidied(tensor.scale(total, specific))
    return Solid(shape.name, values, measure, uniform, total, center.applyfunc(factor), inertia)


_MASS = Dimension("mass", "kg", "m")


def _weighted(shape: Shape, values: Mapping[str, Expr], profile: Poly, measure: Expr) -> Solid:
    """Return the solid of a shape whose density, ``profile``, is a polynomial in x, y, z.

    ``values`` has the dimensions of the shape by name; ``measure`` is its volume, area or length, m^3, m^2 or m.
    """
    known = {name: Fraction(value.p, value.q) for name, value in values.items() if value.is_Rational}
    region = domain(shape, known)
    density, coefficients = constant(0), {}
    for n, (powers, coefficient) in enumerate(profile.terms()):
        # the integration treats the coefficients as symbols
        coefficients[f"density_{n}"] = coefficient
        term = generator(f"density_{n}")
        for component, power in zip(region.position, powers, strict=True):
            term = term * component**power
        density = density + term
    mass, center, specific = _properties(region, {**values, **coefficients}, density)
    if mass.is_nonpositive:
        raise InputError(f"expected a density with a positive mass, got {profile.as_expr()} with {mass} kg")
    if len(known) == len(values) and not profile.free_symbols_in_domain:
        density_text = str(profile.as_expr())
        require_not_negative(parse(density_text), shape_points(shape, known), density_text)
    inertia = _tidied(tensor.scale(mass, specific))
    return Solid(shape.name, values, measure, profile.as_expr(), factor(mass), center.applyfunc(factor), inertia)


def _point_masses(shape: Shape, mass: Any, density: Any, dimensions: Mapping[str, Any]) -> Solid:
    check_names(shape, dimensions)
    if mass is not None or density is not None:
        raise InputError("expected only 'masses' for point_masses, got a mass or density too; leave it out")
    points = _points(dimensions["points"], shape.dimensions[1])
    if not isinstance(dimensions["masses"], Sequence) or isinstance(dimensions["masses"], str):
        raise InputError(f"expected a list of masses, got {show(dimensions['masses'])}")
    masses = [_dimension(each, shape.dimensions[0], shape) for each in dimensions["masses"]]
    if len(points) != len(masses) or not points:
        raise InputError(f"expected as many masses as points, at least one; got {len(masses)} and {len(points)}")
    nothing = tensor.scale(Integer(0), tensor.IDENTITY)
    body = compose([MassProperties(m, tensor.vector(p), nothing) for m, p in zip(masses, points, strict=True)])
    values = {"masses": tuple(masses), "points": tuple(points)}
    center = ImmutableMatrix(body.center_of_mass).applyfunc(factor)
    return Solid(shape.name, values, Integer(len(points)), Integer(1), body.mass, center, _tidied(body.inertia))


def closed_forms_text() -> str:
    """Return the text of ``closed_forms.toml``: formulas of all uniform shapes, in the dimensions and the mass m.

    :mod:`symrot.inertia.closed_forms` evaluates them without SymPy.
    """
    lines = [
        "# Uniform bodies: measure (m^3, m^2, m), centre of mass (m), inertia about it (kg m^2), axes of the shape.",
        "# m is the mass (kg), lengths in m. Printed by `python -m symrot.inertia.solids`; do not edit.",
    ]
    for shape in SHAPES.values():
        if shape.kind == "points":
            continue
        measure, center, specific = _uniform(shape.name)
        names = {symbol: Symbol(name) for name, symbol in _default_dimensions(shape.name).items()}
        inertia = _tidied(tensor.scale(symbols.m, specific))
        entries = {f"center_{axis}": factor(center[i].xreplace(names)) for i, axis in enumerate("xyz")}
        pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        entries |= {"xyz"[i] + "xyz"[j]: factor(inertia[i, j].xreplace(names)) for i, j in pairs}
        lines += ["", f"# {shape.axes}", f"[{shape.name}]"]
        lines += [f'measure = "{sstr(_tidy_measure(measure.xreplace(names)))}"']
        lines += [f'{key} = "{sstr(value)}"' for key, value in entries.items()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(closed_forms_text(), end="")

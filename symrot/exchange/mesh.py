"""Mass, centre of mass and inertia of the polyhedron that a mesh file describes."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from symrot.errors import InputError
from symrot.exchange.crossing import interior_points, require_boundary
from symrot.exchange.inertial import Inertial
from symrot.exchange.mesh_file import read_surface
from symrot.exchange.surface import Surface, require_closed
from symrot.exchange.volume_moments import Exponents, VolumeMoments, approximate_moments, exact_moments, exponents
from symrot.files.paths import path_of
from symrot.formula.exact_numbers import read, show
from symrot.formula.polynomial import constant, generator
from symrot.formula.tree import parse
from symrot.inertia.integration import density_polynomial, require_not_negative
from symrot.inertia.principal import principal_axes, require_admissible
from symrot.inertia.tensor import inertia_of_second_moments

__all__ = ["MeshBody", "mesh", "polyhedron", "read_mesh"]

MOST_EXACT = 200_000
"""Integrals are computed exactly if the number of triangles times the number of integrals is at most this."""

LARGEST_WORK = 30_000_000
"""Integrals in doubles that are too inaccurate are replaced by exact ones if there are at most this many.

Their number is the number of triangles times the number of integrals over one triangle.
"""

LARGEST_ERROR = Fraction(1, 10**12)
"""Largest relative error of results in doubles; if the bound is larger, the integrals are computed exactly.

If there are more than LARGEST_WORK integrals, InputError is raised instead."""

LARGEST_SHARE = Fraction(1, 10**6)
"""Largest rounding error of second moments in doubles, relative to the smallest principal second moment.

If the error is larger, the integrals are computed exactly: in a thin body, rounding could make this moment negative.
"""

Rows = tuple[tuple[Any, ...], ...]


class MeshBody(NamedTuple):
    """The mass properties of a mesh, its surface in the unit of the file, and the length ``scale`` of this unit, m."""

    inertial: Inertial
    surface: Surface
    scale: Fraction


class _Body(NamedTuple):
    """The zeroth, first and second moments of a density over a polyhedron, about a centre.

    Each moment is a pair of its value and a bound of its error, in kg, kg m and kg m^2.
    """

    mass: tuple[Fraction, Fraction]
    first: tuple[tuple[Fraction, Fraction], ...]
    second: tuple[tuple[tuple[Fraction, Fraction], ...], ...]
    center: tuple[Fraction, ...]
    volume: Fraction


def mesh(path: str | Path, *, mass: Any = None, density: Any = None, scale: Any = 1, flip: bool = False) -> Inertial:
    """Return mass, centre of mass and inertia of the body that a closed mesh bounds.

    The relative error is at most 1e-12; the result is exact for a uniform density and up to 20 000 triangles.

    Parameters
    ----------
    path : str or Path
        A file in the format STL, OBJ, PLY or GLB. All bodies in the file together form one rigid body.
    mass : number, optional
        Mass of the uniform body, kg. Exactly one of mass and density is needed.
    density : number or str, optional
        Density, kg/m^3: a positive number, or a polynomial in x, y, z, which are in m in the axes of the file.
    scale : number
        Length of the unit of the file, m: ``"1/1000"`` for a mesh in mm.
    flip : bool
        Whether to reverse the orientation of all triangles, for a mesh whose normals point inwards.

    Returns
    -------
    Inertial
        In the axes of the file; ``error`` bounds the relative error, ``checks`` says which tests the surface passed and
        whether polygons of the file are not flat.

    Raises
    ------
    InputError
        If an argument is not valid, if trimesh is needed and not installed, if the file is not a mesh, or if the mesh
        has holes, normals that point inwards, no volume, or triangles that cross, as far as the tests detect this.

    Examples
    --------
    >>> import symrot
    >>> part = symrot.mesh("part.stl", density=2700, scale="1/1000")  # doctest: +SKIP
    >>> body = part.table()  # doctest: +SKIP
    """
    return read_mesh(path_of(path, "mesh"), str(path), mass=mass, density=density, scale=scale, flip=flip).inertial


def read_mesh(path: Path, where: str, *, mass: Any, density: Any, scale: Any, flip: bool) -> MeshBody:
    """Return the mass properties and the surface of a mesh file.

    ``where`` names the file in error messages; the other arguments are explained at :func:`mesh`.
    """
    if (mass is None) == (density is None):
        amounts = "both" if mass is not None else "neither"
        raise InputError(f"{where}: expected exactly one of mass (kg) and density (kg/m^3) of a mesh, got {amounts}")
    unit = _positive(scale, f"{where}: scale", "a length in m, that of one unit of the mesh")
    if not Fraction(1, 10**30) <= unit <= 10**30:
        raise InputError(f"{where}: scale: expected a length from 1e-30 to 1e30 m, got {show(scale)}")
    surface = read_surface(path, where)
    surface = surface.flipped() if flip else surface
    return MeshBody(polyhedron(surface, path.stem, where, mass, density, unit), surface, unit)


def polyhedron(surface: Surface, name: str, where: str, mass: Any, density: Any, unit: Fraction) -> Inertial:
    """Return the mass properties of the body that a surface bounds, after all tests of the surface.

    Parameters
    ----------
    surface : Surface
        Triangles; lengths in ``unit`` (m).
    name, where : str
        Name of the result; place for error messages.
    mass, density : number, str or None
        As in :func:`mesh`; exactly one is not None.

    Raises
    ------
    InputError
        If the surface is not the boundary of a body, if the mass or density is not valid, or if the mesh is too large
        for exact integrals and doubles are not accurate enough.
    """
    require_closed(surface, where)
    if mass is not None:
        amount, polynomial = _positive(mass, f"{where}: mass", "a mass in kg"), parse("1")
    else:
        amount, polynomial = None, _density(density, f"{where}: density")
    degree = _degree(polynomial, density, where)
    work = len(surface.triangles) * len(exponents(degree))
    result = None
    if work > MOST_EXACT:
        moments = approximate_moments(surface, degree)
        _require_volume(moments, unit, where)
        body = _integrated(moments, polynomial, density, unit, where)
        result = _result(body, amount, exact=False)
    if result is None:
        if work > LARGEST_WORK:
            raise InputError(
                f"{where}: expected a mesh whose integrals have an error of at most {float(LARGEST_ERROR):g}, got a "
                "larger error, because large terms cancel; reduce the number of triangles from "
                f"{len(surface.triangles)}"
            )
        moments = exact_moments(surface, degree)
        _require_volume(moments, unit, where)
        body = _integrated(moments, polynomial, density, unit, where)
        result = _result(body, amount, exact=True)
    checks = "; ".join(filter(None, (require_boundary(surface, where), surface.note)))
    if body.mass[0] <= 0:
        raise InputError(
            f"{where}: density: expected a density with a positive mass, got {show(density)} with a mass of "
            f"{float(body.mass[0]):.6g} kg"
        )
    if density is not None and polynomial[0] != "number":
        places = np.concatenate([surface.vertices, interior_points(surface)]) * float(unit)
        points = (dict(zip("xyz", place, strict=True)) for place in places.tolist())
        require_not_negative(polynomial, points, density, where)
    assert result is not None
    total, center, tensor, error = result
    require_admissible(principal_axes(tensor, where), where)
    x, y, z = center
    return Inertial(name, total, (x, y, z), tensor, body.volume, float(error), checks)


def _positive(value: Any, where: str, expectation: str) -> Fraction:
    number = read(value, where, expectation.replace("a ", "a positive ", 1))
    if number <= 0:
        raise InputError(f"{where}: expected {expectation.replace('a ', 'a positive ', 1)}, got {show(value)}")
    return number


def _density(density: Any, where: str) -> Any:
    """Parse a density, a number or a polynomial in x, y, z; raise InputError if it cannot be read."""
    if isinstance(density, str):
        node = parse(density, where)
        if node[0] != "number":
            return node
    return ("number", _positive(density, where, "a density in kg/m^3"))


def _degree(node: Any, source: object, where: str) -> int:
    """Return the degree of the density plus 2: the highest degree of the monomials to be integrated for the inertia.

    ``node`` is the density, a number or a polynomial in x, y, z. ``source`` is the density as the user wrote it, and
    ``where`` the name of the mesh, for error messages.
    """
    axes = {name: generator(name) for name in "xyz"}
    powers = density_polynomial(node, axes, source, f"{where}: density").collect(["x", "y", "z"])
    return 2 + max((sum(item) for item in powers), default=0)


def _integrated(moments: VolumeMoments, node: Any, source: object, unit: Fraction, where: str) -> _Body:
    """Return mass, first and second moments (kg, kg m, kg m^2) of a mesh body with the density formula ``node``.

    They follow from ``moments``, the integrals of monomials of the coordinates over the mesh. ``source`` is the density
    as the user wrote it, and ``where`` the name of the mesh, for error messages. ``unit`` is the length, m, of one unit
    of the coordinates in the mesh.
    """
    # local coordinates start from a centre and are in the file's unit of length
    axes = {
        name: (generator(name) + constant(middle)) * unit for name, middle in zip("xyz", moments.center, strict=True)
    }
    polynomial = density_polynomial(node, axes, source, f"{where}: density").collect(["x", "y", "z"])
    terms: Mapping[Exponents, Fraction] = {
        (powers[0], powers[1], powers[2]): factor.value({}) for powers, factor in polynomial.items()
    }

    def integral(*axes: int) -> tuple[Fraction, Fraction]:
        total = bound = Fraction(0)
        factor = unit ** (3 + len(axes))
        for powers, coefficient in terms.items():
            first, second, third = (power + axes.count(axis) for axis, power in enumerate(powers))
            total += coefficient * moments.values[first, second, third]
            bound += abs(coefficient) * moments.errors[first, second, third]
        return total * factor, bound * factor

    return _Body(
        integral(),
        tuple(integral(i) for i in range(3)),
        tuple(tuple(integral(*sorted((i, j))) for j in range(3)) for i in range(3)),
        tuple(middle * unit for middle in moments.center),
        moments.values[0, 0, 0] * unit**3,
    )


def _result(body: _Body, amount: Fraction | None, exact: bool) -> tuple[Fraction, Any, Any, Fraction] | None:
    """Return mass, centre of mass, inertia tensor and relative error of a body from its moments.

    None if the mass is not larger than its error bound, or if the error is too large. ``amount`` is the mass to which
    the body is scaled, or None; ``exact`` says that the moments have no error.
    """
    (mass, mass_error), first = body.mass, body.first
    if mass <= mass_error:
        return None
    offset = [value / mass for value, _ in first]
    second = [[body.second[i][j][0] - first[i][0] * offset[j] for j in range(3)] for i in range(3)]
    factor = Fraction(1) if amount is None else amount / mass
    tensor = inertia_of_second_moments([[entry * factor for entry in row] for row in second])
    center = [middle + shift for middle, shift in zip(body.center, offset, strict=True)]
    error = Fraction(0)
    if not exact:
        shift_errors = [(first[i][1] + abs(offset[i]) * mass_error) / (mass - mass_error) for i in range(3)]
        second_error = max(
            body.second[i][j][1] + abs(first[i][0]) * shift_errors[j] + (abs(offset[j]) + shift_errors[j]) * first[i][1]
            for i in range(3)
            for j in range(3)
        )
        trace = second[0][0] + second[1][1] + second[2][2]
        smallest = Fraction(float(np.linalg.eigvalsh(np.array([[float(x / trace) for x in row] for row in second]))[0]))
        if trace <= 0 or smallest * LARGEST_SHARE * trace <= second_error:
            return None
        radius = Fraction(float(trace / mass) ** 0.5)
        tensor_error = 3 * second_error / trace + mass_error / mass
        error = max(tensor_error, *(shift_error / radius for shift_error in shift_errors))
        if error > LARGEST_ERROR:
            return None
    return amount or mass, center, tensor, error


def _require_volume(moments: VolumeMoments, unit: Fraction, where: str) -> None:
    """Raise InputError if the volume of a mesh is exactly zero, or negative by more than its error bound.

    A negative volume means normals that point inwards.
    """
    volume, error = moments.values[0, 0, 0], moments.errors[0, 0, 0]
    if volume == 0 and error == 0:
        raise InputError(f"{where}: expected a mesh that encloses a volume, got a volume of zero")
    if volume < -error:
        raise InputError(
            f"{where}: expected a mesh whose normals point outwards, got one that is turned inside out, with a volume "
            f"of {float(volume * unit**3):.6g} m^3; write flip = true"
        )

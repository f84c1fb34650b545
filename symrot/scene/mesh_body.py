"""Bodies of scenes that are given by a mesh file."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.inertia.bodies import MassProperties
from symrot.scene.folders import Folders
from symrot.scene.reader import Entry, fail, flag, number, read_table, text

__all__ = ["Facet", "MeshProperties", "read_mesh_table"]

Point = tuple[float, float, float]
Facet = tuple[Point, Point, Point]

MOST_FACETS = 5000
"""Largest number of triangles of a mesh that pictures show; a body with a larger mesh is drawn as a box."""


class MeshProperties(NamedTuple):
    """The mass properties of a mesh, the corners, m, of its triangles, for pictures, and warnings.

    ``facets`` is empty for a mesh of more than MOST_FACETS triangles; ``warnings`` concern polygons that are not flat.
    """

    properties: MassProperties
    facets: tuple[Facet, ...]
    warnings: tuple[str, ...]


def read_mesh_table(
    value: Mapping[str, Any], where: str, others: Mapping[str, Entry], density: Entry, folders: Folders
) -> tuple[MeshProperties, dict[str, Any]]:
    """Return the mass properties of the mesh file given by the key ``mesh`` of a table, and all values of the table.

    Parameters
    ----------
    value : mapping
        The table ``body`` of a scene.
    where : str
        Place of the table, for error messages.
    others : mapping of str to Entry
        Rules for the keys that do not concern the mesh.
    density : Entry
        The rule for the key density.
    folders : Folders
        The folders in which the file of the mesh may be.

    Raises
    ------
    InputError
        If a key is unknown or has a wrong value, the file is outside these folders or cannot be read, or the mesh is
        not the boundary of a body.
    """
    from symrot.exchange.mesh import read_mesh  # with NumPy, which other bodies do not need

    values = read_table(value, where, {
        "mesh": Entry(text, required=True),
        "mass": Entry(number("a mass in kg", "positive")),
        "density": density,
        "scale": Entry(number("a length in m, that of one unit of the mesh", "positive"), default=Fraction(1)),
        "flip": Entry(flag, default=False),
        **others,
    }, "a body given by a mesh")  # fmt: skip
    amounts = [key for key in ("mass", "density") if values[key] is not None]
    if len(amounts) != 1:
        fail(f"{where}.mass", "exactly one of mass (kg) and density (kg/m^3) of a mesh", amounts or "neither")
    path = folders.file(values["mesh"], f"{where}.mesh", "a mesh file")
    body = read_mesh(
        path, f"{where}.mesh: {values['mesh']}",
        mass=values["mass"], density=values["density"], scale=values["scale"], flip=values["flip"],
    )  # fmt: skip
    facets: tuple[Facet, ...] = ()
    if len(body.surface.triangles) <= MOST_FACETS:
        corners = body.surface.vertices[body.surface.triangles] * float(body.scale)
        facets = tuple(tuple(map(tuple, triangle)) for triangle in corners.tolist())  # type: ignore[misc]
    warnings = (f"{where}.mesh: {body.surface.note}",) if body.surface.note else ()
    return MeshProperties(body.inertial.properties, facets, warnings), values

"""Moments of inertia in forms that books use: with a density, radii of gyration, tilted rods, pairs of masses."""

from collections.abc import Iterator

from sympy import Matrix, Symbol, cancel, cos, expand, factor, sin

from symrot import symbols
from symrot.checker.recognition.formulas.named import Named
from symrot.inertia import tensor
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import solid

__all__ = ["bodies"]

SOLIDS, AXES = "derivations/standard_solids.md", "derivations/parallel_axis.md"


def bodies() -> Iterator[Named]:
    """Yield formulas for bodies in books: squared radii of gyration, the parallel- and perpendicular-axis theorems, and
    moments of inertia.

    The moments are for solid bodies of given density instead of mass, and for a box about its space diagonal, a right
    triangle, a tilted rod and a pair of masses.
    """
    for name, shape in SHAPES.items():
        if shape.kind == "points":
            continue
        body, title = solid(name), name.replace("_", " ")
        moments = body.inertia_about(tuple(body.center_of_mass))
        for place, axis in enumerate("xyz"):
            moment = moments[place, place]
            yield f"radius of gyration of a {title}, {axis} axis, squared", SOLIDS, cancel(moment / symbols.m)
            if shape.kind == "solid":
                mass = symbols.rho * body.measure
                dense = factor(moment.subs(symbols.m, mass))
                yield f"moment of inertia of a {title} of given density, {axis} axis", SOLIDS, dense
    box, edges = solid("box"), Matrix([symbols.a, symbols.b, symbols.c])
    along = edges.dot(box.inertia_about(tuple(box.center_of_mass)) * edges) / edges.dot(edges)
    yield "moment of inertia of a box about its space diagonal", SOLIDS, cancel(along)
    yield from _right_triangle()
    yield from _rods_and_masses()
    yield from _theorems()


def _right_triangle() -> Iterator[Named]:
    """Yield the moments of a right triangular plate about its centre of mass and about its right-angled corner."""
    plate = solid("triangular_plate", apex=0)
    for place, point in (
        ("its centre of mass", tuple(plate.center_of_mass)),
        ("the corner of its right angle", (0, 0, 0)),
    ):
        moments = plate.inertia_about(point)
        for n, axis in enumerate("xyz"):
            name = f"moment of inertia of a right triangular plate about {place}, {axis} axis"
            yield name, SOLIDS, factor(moments[n, n])


def _rods_and_masses() -> Iterator[Named]:
    """Yield moments of inertia: of a rod at an angle to an axis through its centre or end, and of two point masses.

    The moment of the two masses is about an axis through their centre of mass, perpendicular to the line between them.
    """
    rod = solid("rod")
    normal = Matrix([0, sin(symbols.theta), cos(symbols.theta)])
    for place, point in (("its centre", tuple(rod.center_of_mass)), ("an end", (0, 0, symbols.L / 2))):
        moment = normal.dot(Matrix(rod.inertia_about(point)) * normal)
        yield f"moment of inertia of a rod at an angle to the axis through {place}", SOLIDS, factor(moment)
    first, second, _ = symbols.particle_masses
    apart = symbols.L
    centre = second * apart / (first + second)
    pair = sum(
        (tensor.inertia_of_point(mass, (x - centre, 0, 0))[2][2] for mass, x in ((first, 0), (second, apart))),
        start=0,
    )
    yield "moment of inertia of two masses about their centre of mass", SOLIDS, factor(cancel(pair))


def _theorems() -> Iterator[Named]:
    """Yield the parallel-axis theorem and the perpendicular-axis theorem.

    The parallel-axis theorem is stated for moments of inertia, for products of inertia and for radii of gyration.
    """
    offset = symbols.offset
    added = Matrix(tensor.inertia_of_point(symbols.m, offset))
    (xx, yy, zz), (xy, xz, yz) = symbols.moments, symbols.products
    full = Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    for place, axis in enumerate("xyz"):
        moment = (full + added)[place, place]
        yield f"moment of inertia about a parallel axis (parallel-axis theorem), {axis} axis", AXES, moment
    for (i, j), names in (((0, 1), "xy"), ((0, 2), "xz"), ((1, 2), "yz")):
        name = f"product of inertia about parallel axes (parallel-axis theorem), {names}"
        yield name, AXES, (full + added)[i, j]
        yield f"{name}, without the minus sign", AXES, full[i, j] - added[i, j]
    central = Symbol("k_G", real=True)
    distance = symbols.r
    inertia = symbols.m * central**2 + Matrix(tensor.inertia_of_point(symbols.m, (distance, 0, 0)))[2, 2]
    yield "radius of gyration about a parallel axis, squared", AXES, expand(cancel(inertia / symbols.m))
    flat = Matrix(tensor.inertia_of_point(symbols.m, (symbols.x, symbols.y, 0)))
    assert expand(flat[2, 2] - flat[0, 0] - flat[1, 1]) == 0  # holds for each point, so for the body
    yield "moment of inertia of a flat body about the axis normal to it", AXES, xx + yy

"""Inertia tensors of the standard solids about special points, and moments of inertia of a few other bodies.

Special points are the centre of mass, a tip, a corner; the other bodies are an annulus, a thin tube, a conical shell,
and an elliptical disk and cylinder, which are stretched circular ones.
"""

from collections.abc import Iterator, Sequence

from sympy import Expr, Integer, Matrix, Symbol, diag

from symrot.checker.context.bodies import with_article
from symrot.checker.recognition.formulas.named import Named
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import Solid, solid

__all__ = ["solids", "thin_bodies"]

PLACES = {
    "cone": (("its tip", ("0", "0", "h")),),
    "rod": (("an end", ("0", "0", "L/2")),),
    "cylinder": (("the centre of an end", ("0", "0", "L/2")),),
    "disk": (("a point of its rim", ("R", "0", "0")),),
    "ring": (("a point of its rim", ("R", "0", "0")),),
    "sphere": (("a point of its surface", ("0", "0", "R")),),
    "box": (("a corner", ("a/2", "b/2", "c/2")),),
    "plate": (("a corner", ("a/2", "b/2", "0")), ("the middle of a side", ("a/2", "0", "0"))),
}
"""Shape -> (name, position) of special points, in the axes and symbols of the shape."""


def solids() -> Iterator[Named]:
    for name, shape in SHAPES.items():
        if shape.kind == "points":
            continue
        body, title = solid(name), with_article(name.replace("_", " "))
        places = [("its centre of mass", tuple(body.center_of_mass))]
        if any(body.center_of_mass):
            origin = shape.axes.partition(",")[0].removeprefix("origin at ")
            places.append(("the corner at (0, 0)" if origin.startswith("corners ") else origin, (0, 0, 0)))
        for where, point in [*places, *PLACES.get(name, ())]:
            matrix = body.inertia_about(point)
            source = f'symrot.solid("{name}").inertia_about(({", ".join(map(str, point))}))'
            yield f"inertia tensor of {title} about {where}", source, matrix
            for place, axis in enumerate("xyz"):
                yield f"moment of inertia of {title} about {where}, {axis} axis", source, matrix[place, place]
            for axes, (i, j) in (("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))):
                if matrix[i, j] != 0:
                    product_name = f"product of inertia of {title} about {where}, {axes}"
                    yield product_name, source, matrix[i, j]
                    yield f"{product_name}, without the minus sign", source, -matrix[i, j]


def _stretched(body: Solid, factors: Sequence[Expr]) -> Matrix:
    """Return the inertia tensor of a body whose coordinates are multiplied by ``factors``, with the same mass."""
    # by S_i = sum of m x_i^2 = tr(I)/2 - I_ii; the axes are principal
    tensor_of = body.inertia_about(tuple(body.center_of_mass))
    sums = [factor**2 * (tensor_of.trace() / 2 - tensor_of[i, i]) for i, factor in enumerate(factors)]
    return diag(*(sum(sums) - own for own in sums)).expand()


def thin_bodies() -> Iterator[Named]:
    """Yield the moments of inertia of an annulus, a thin tube, a conical shell, and an elliptical disk and cylinder.

    The first two are limits of a hollow cylinder, the shell is made of rings, the last two are stretched circular ones.
    """
    inner, outer, length, mass = (Symbol(name, positive=True) for name in ("R_1", "R_2", "L", "m"))
    hollow = solid("hollow_cylinder")
    tensor_of = hollow.inertia_about(tuple(hollow.center_of_mass))
    radius = Symbol("R", positive=True)
    source = 'symrot.solid("hollow_cylinder")'
    flat, tube = tensor_of.subs(length, 0), tensor_of.subs({inner: radius, outer: radius})
    height, part = Symbol("h", positive=True), Symbol("s", positive=True)
    axes = (*(Symbol(name, positive=True) / radius for name in "ab"), Integer(1))
    stretched = {name: _stretched(solid(name), axes) for name in ("disk", "cylinder")}
    ring = diag(radius**2 / 2, radius**2 / 2, radius**2) * part**2 + diag(1, 1, 0) * height**2 * part**2
    cone = (mass * 2 * part * ring).applyfunc(lambda entry: entry.integrate((part, 0, 1)))  # rings of mass 2 m s ds
    for title, origin, matrix in (
        ("annulus about its centre of mass", source, flat),
        ("thin tube about its centre of mass", source, tube),
        ("conical shell about its tip", "rings from the tip, of mass 2 m s ds", cone),
        *(
            (f"elliptical {name} about its centre of mass", f'symrot.solid("{name}"), stretched', matrix)
            for name, matrix in stretched.items()
        ),
    ):
        for place, axis in enumerate("xyz"):
            yield f"moment of inertia of {with_article(title)}, {axis} axis", origin, matrix[place, place]

"""Formulas (closed forms) of uniform solids, read from ``closed_forms.toml`` and evaluated exactly. Standard library.

:mod:`symrot.inertia.solids` derives these formulas and prints the file, so that a scene needs no SymPy.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

from symrot.errors import InputError, prefix
from symrot.formula.exact_numbers import PI
from symrot.formula.tree import Node, evaluate, parse
from symrot.inertia import tensor
from symrot.inertia.bodies import MassProperties
from symrot.inertia.shapes import Shape, scalars

__all__ = ["CLOSED_FORMS", "closed_form", "uniform"]

CLOSED_FORMS = Path(__file__).with_name("closed_forms.toml")


@cache
def _table() -> dict[str, dict[str, str]]:
    import tomllib  # here, so that a body given by its moments does not load it

    return tomllib.loads(CLOSED_FORMS.read_text(encoding="utf-8"))


@cache
def closed_form(shape: str) -> dict[str, Node]:
    """Return the formulas of a uniform shape of mass ``m``, each under its name.

    The shape ``"cone"`` has the formula ``height/4`` under the name ``center_z``.
    """
    # measure (volume, area or length), center_x to center_z, and xx to yz of the inertia tensor about the centre
    return {key: parse(text) for key, text in _table()[shape].items()}


def uniform(
    shape: Shape,
    dimensions: Mapping[str, Any],
    mass: Fraction | None = None,
    density: Fraction | None = None,
    where: str = "",
) -> MassProperties:
    """Return the mass properties of a uniform shape in its own axes, as Fractions.

    Parameters
    ----------
    shape : Shape
        Any shape except ``point_masses``.
    dimensions : mapping
        The dimensions as :func:`symrot.inertia.shapes.check_dimensions` returns them.
    mass, density : Fraction
        Exactly one of the two: the mass in kg, or the density in kg per m^3, m^2 or m.
    where : str
        Place of the shape in the scene, put in front of an error message.

    Raises
    ------
    InputError
        If the corners of a tetrahedron lie in a plane.
    """
    forms = closed_form(shape.name)
    values = scalars(shape, dimensions) | {"pi": PI}
    measure = abs(Fraction(evaluate(forms["measure"], values)))  # the order of the corners determines its sign
    if not measure:
        raise InputError(f"{prefix(where)}expected a {shape.name} with a positive volume, got corners in one plane")
    total = mass if density is None else density * measure
    assert total is not None
    properties = {key: Fraction(evaluate(form, {**values, "m": total})) for key, form in forms.items()}
    inertia = tensor.matrix([[properties["".join(sorted(i + j))] for j in "xyz"] for i in "xyz"])
    return MassProperties(total, tensor.vector([properties[f"center_{axis}"] for axis in "xyz"]), inertia)

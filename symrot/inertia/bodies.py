"""Mass properties of bodies that are moved, rotated, added or subtracted, with any kind of number. Standard library.

The same functions are used for symbolic bodies (:class:`symrot.inertia.solids.Solid`) and for the exact numbers of a
scene.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple, Protocol

from symrot.inertia import tensor
from symrot.inertia.tensor import IDENTITY, Tensor, Vector

__all__ = ["HasInertia", "MassProperties", "compose", "place"]

_ORIGIN = (0, 0, 0)


class HasInertia(Protocol):
    """The type of all objects with mass (kg), centre of mass (m), and inertia tensor about it (kg m^2)."""

    @property
    def mass(self) -> Any: ...
    @property
    def center_of_mass(self) -> Any: ...
    @property
    def inertia(self) -> Any: ...


class MassProperties(NamedTuple):
    """Mass in kg, centre of mass in m, inertia tensor about the centre of mass in kg m^2 (products with minus sign)."""

    mass: Any
    center_of_mass: Vector
    inertia: Tensor

    def inertia_about(self, point: Any) -> Tensor:
        """Return the inertia tensor, kg m^2, of the body about a point (m), by the parallel axis theorem."""
        offset = [p - c for p, c in zip(tensor.vector(point), self.center_of_mass, strict=True)]
        return tensor.about_point(self.inertia, self.mass, offset)


def place(body: HasInertia, at: Any = _ORIGIN, rotation: Any = IDENTITY) -> MassProperties:
    """Return the mass properties of a body that is first rotated about the origin, then displaced by ``at`` (m).

    ``rotation`` is the matrix R of this rotation: the point x of the body comes to ``R x + at``.
    """
    rotated = tensor.apply(rotation, body.center_of_mass)
    center = tuple(a + c for a, c in zip(tensor.vector(at), rotated, strict=True))
    return MassProperties(body.mass, tensor.vector(center), tensor.rotate(body.inertia, rotation))


def compose(added: Iterable[HasInertia], subtracted: Iterable[HasInertia] = ()) -> MassProperties:
    """Return the mass properties of a rigid assembly: added bodies minus subtracted bodies (holes), in the same axes.

    The total mass must not be zero.
    """
    signed = [(1, body) for body in added] + [(-1, body) for body in subtracted]
    mass = sum(sign * body.mass for sign, body in signed)
    centers = [tensor.vector(body.center_of_mass) for _, body in signed]
    first = [sum(sign * body.mass * c[k] for (sign, body), c in zip(signed, centers, strict=True)) for k in range(3)]
    center = tensor.vector([moment / mass for moment in first])
    inertia: Tensor = tensor.scale(0, IDENTITY)
    for (sign, body), c in zip(signed, centers, strict=True):
        offset = [a - b for a, b in zip(c, center, strict=True)]
        inertia = tensor.add(inertia, tensor.scale(sign, tensor.about_point(body.inertia, body.mass, offset)))
    return MassProperties(mass, center, inertia)

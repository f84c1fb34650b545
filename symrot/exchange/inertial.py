"""Mass, centre of mass and inertia of a body that was read from a file. Standard library only."""

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from typing import Any

from symrot.errors import InputError
from symrot.formula.exact_numbers import read, show
from symrot.inertia.bodies import MassProperties
from symrot.inertia.principal import Principal, principal_axes
from symrot.inertia.tensor import Tensor, Vector

__all__ = ["Inertial"]

LONGEST_NUMBER = 24
"""Largest number of characters of a fraction, such as ``1/3``, that :meth:`Inertial.table` leaves exact."""

DIGITS, MORE_DIGITS = 34, 70
"""Digits to which :meth:`Inertial.table` rounds numbers with a longer fraction; MORE_DIGITS for special bodies.

Special are bodies with equal moments and flat bodies, for which a sum of two moments is the third: a scene treats
numbers as equal if they agree to 2^-200, that is, in 61 digits.
"""


@dataclass(frozen=True)
class Inertial:
    """Mass, centre of mass and inertia of a body, in the axes of the file from which it was read.

    Attributes
    ----------
    name : str
        Name of the mesh or link.
    mass : Fraction
        Mass, kg.
    center_of_mass : tuple of 3 Fraction
        Centre of mass, m.
    inertia : 3 x 3 Fraction
        Inertia tensor about the centre of mass, kg m^2; products of inertia have the minus sign.
    volume : Fraction or None
        Volume of a mesh, m^3; None for a link.
    error : float
        Bound of the relative error of mass, centre and tensor that is caused by rounding; 0 if they are computed
        exactly from the numbers of the file.
    checks : str
        A sentence about the tests that the surface of a mesh passed; empty for a link.

    Examples
    --------
    >>> from fractions import Fraction
    >>> cube = Inertial("cube", Fraction(6), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    >>> cube.principal.kind
    'spherical'
    """

    name: str
    mass: Fraction
    center_of_mass: Vector
    inertia: Tensor
    volume: Fraction | None = None
    error: float = 0.0
    checks: str = ""

    @property
    def principal(self) -> Principal:
        """Principal moments, kg m^2, principal axes and the kind of symmetry."""
        return principal_axes(self.inertia)

    @property
    def properties(self) -> MassProperties:
        """Mass, centre of mass and inertia as the functions of :mod:`symrot.inertia.bodies` take them."""
        return MassProperties(self.mass, self.center_of_mass, self.inertia)

    def __repr__(self) -> str:
        center = ", ".join(f"{float(x):.6g}" for x in self.center_of_mass)
        moments = ", ".join(f"{float(x):.6g}" for x in self.principal.moments)
        return f"<Inertial {self.name}: {float(self.mass):.6g} kg at ({center}) m, moments {moments} kg m^2>"

    def table(self, fixed_point: Any = None) -> Mapping[str, Any]:
        """Return the table ``body`` of a scene with this body.

        Parameters
        ----------
        fixed_point : 3 numbers, optional
            The point, m, in the axes of the file, about which the body rotates; default: its centre of mass.

        Returns
        -------
        dict
            For ``Scene.build(body=...)``. Short fractions are exact; other numbers are rounded to 34 digits, or to 70
            digits if moments are equal or the body is flat.

        Raises
        ------
        InputError
            If ``fixed_point`` is not three numbers.

        Examples
        --------
        >>> from fractions import Fraction
        >>> Inertial("ball", Fraction(1), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1))).table()["mass"]
        Fraction(1, 1)
        """

        def numbers(values: Any) -> list[Any]:
            return [_short(value, context) for value in values]

        principal = self.principal
        context = Context(prec=DIGITS if principal.kind == "asymmetric" and not principal.flat else MORE_DIGITS)
        table: dict[str, Any] = {"name": self.name, "mass": _short(self.mass, context)}
        if fixed_point is None:
            return table | {"inertia": [numbers(row) for row in self.inertia]}
        try:
            x, y, z = fixed_point
        except (TypeError, ValueError):
            raise InputError(f"fixed_point: expected three numbers [x, y, z] in m, got {show(fixed_point)}") from None
        point = tuple(read(item, f"fixed_point[{index}]") for index, item in enumerate((x, y, z)))
        offset = numbers(c - p for c, p in zip(self.center_of_mass, point, strict=True))
        tensor = [numbers(row) for row in self.properties.inertia_about(point)]
        return table | {"about": "fixed_point", "center_of_mass": offset, "inertia": tensor}


def _short(value: Any, context: Context) -> Fraction | Decimal:
    number = Fraction(value)
    if len(str(number)) <= LONGEST_NUMBER:
        return number
    return context.divide(Decimal(number.numerator), Decimal(number.denominator))

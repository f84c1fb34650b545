"""Derivatives of the parameters of a motion's equations, such as that of ``weight/A`` with respect to a mass."""

from collections.abc import Mapping, Sequence
from copy import copy
from fractions import Fraction
from typing import Any, Self

from symrot.codegen.duals import Dual
from symrot.dynamics.structure import Structure
from symrot.errors import InputError
from symrot.formula.tree import Node, children, evaluate, names
from symrot.planning.general_structure import constants_of
from symrot.planning.scene_kernel import Parameters
from symrot.propagation.binding import value_of
from symrot.propagation.sensitivities.variables import difference, slopes
from symrot.propagation.sensitivities.variation import Column
from symrot.scene.scene import Scene

__all__ = ["ParameterSlopes", "Rows"]

Rows = Mapping[str, list[float]]
"""Name of a parameter -> its m derivatives with respect to the variables (initial values or constants of the scene)."""


class ParameterSlopes:
    """The derivatives of the parameters of a motion's equations with respect to variables.

    The variables are initial values or constants of the scene.

    ``columns`` has one :class:`Column` for each variable: the dependence of the scene on it.
    """

    def __init__(self, scene: Scene, columns: Sequence[Column], structure: Structure) -> None:
        self.scene, self.columns, self.structure = scene, columns, structure
        self._changes = [self._changes_of(column) for column in self.columns]

    def with_changes(self, changes: Sequence[Mapping[str, Fraction]]) -> Self:
        """Return a copy with more derivatives of constants.

        ``changes[k]`` is a map from the name of a constant to its derivative with respect to variable number k.
        """
        other = copy(self)
        other._changes = [{**own, **more} for own, more in zip(self._changes, changes, strict=True)]
        return other

    def _changes_of(self, column: Column) -> Mapping[str, Fraction]:
        """Return the derivatives of the constants in the equations with respect to the variable of ``column``.

        The result is a map from name to derivative, without the constants that do not depend on the variable.
        """
        if not column.constants:
            return {}
        return difference(self.scene, column.variable, lambda other: constants_of(other, self.structure))

    def depends(self, parameters: Parameters, column: int) -> list[str]:
        """Return the names of those ``parameters`` that depend on the variable number ``column``.

        A parameter is a pair (name, formula).
        """
        return [name for name, formula in parameters if names(formula) & self._changes[column].keys()]

    def slopes_of(self, parameters: Parameters, constants: Mapping[str, Fraction]) -> Rows:
        """Return a map from the name of a parameter to its m derivatives with respect to the variables.

        Parameters that depend on none of the variables are left out.
        """
        rows: dict[str, list[float]] = {}
        rational = {name for name, formula in parameters if not _has_calls(formula)}
        moved = set[str]().union(*self._changes)
        duals: dict[str, Any] = {
            name: Dual(constants[name], {str(k): by[name] for k, by in enumerate(self._changes) if name in by})
            for name in moved & constants.keys()
        }
        for name, formula in parameters:
            if name in rational and names(formula) & moved:
                value = evaluate(formula, {**constants, **duals})
                own = value.slopes if isinstance(value, Dual) else {}
                rows[name] = [float(own.get(str(k), 0)) for k in range(len(self.columns))]
        for k, column in enumerate(self.columns):
            depends, changes = set(self.depends(parameters, k)) - rational, self._changes[k]
            moving = [(name, formula) for name, formula in parameters if name in depends]
            if not moving:
                continue

            def values(change: Fraction, changes: Any = changes, moving: Any = moving) -> dict[str, Fraction]:
                moved = {**constants, **{name: constants[name] + change * slope for name, slope in changes.items()}}
                return {name: value_of(formula, moved) for name, formula in moving}

            for name, slope in slopes(values, column.variable.step, column.variable.name).items():
                rows.setdefault(name, [0.0] * len(self.columns))[k] = float(slope)
        return rows

    def require_constant(
        self, formula: Node, constants: Mapping[str, Fraction], ends: Sequence[int], label: str
    ) -> None:
        """Raise InputError if a function's argument lies at a jump or kink and changes with one of the variables.

        ``formula`` is the argument, without states; the jumps and kinks are at its values ``ends``. ``label`` is the
        function in messages, such as ``"sign(c - 1)"``.
        """
        value = value_of(formula, constants)
        if value not in ends:
            return
        for column, changes in zip(self.columns, self._changes, strict=True):
            for step in (column.variable.step, -column.variable.step):
                moved = {name: constants[name] + step * slope for name, slope in changes.items()}
                if value_of(formula, {**constants, **moved}) != value:
                    raise InputError(
                        f"sensitivities: expected a value of {column.variable.name} at which the equations of motion "
                        f"have a derivative, but {label} has a kink or a jump there; change the value slightly"
                    )


def _has_calls(node: Node) -> bool:
    """Return whether a formula contains a function, such as sqrt or abs, which may have a kink."""
    return node[0] == "call" or any(map(_has_calls, children(node)))

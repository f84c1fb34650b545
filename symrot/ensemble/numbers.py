"""Values of the parameters of a kernel (the compiled equations) for each trajectory of an ensemble.

A parameter, such as ``(B - C)/A``, is a formula in the constants of the scene. Parameters that do not vary are
evaluated once.
"""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from symrot.dynamics.structure import PrincipalInertia
from symrot.ensemble.variation import PRINCIPAL, Variation
from symrot.formula import exact_numbers as number
from symrot.formula.tree import names
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH, Parameters
from symrot.propagation.binding import folded, value_of
from symrot.propagation.steppers.stepping import Floats

__all__ = ["Numbers"]

OMEGA = ("omega_1", "omega_2", "omega_3")


class Numbers:
    """The constants of some trajectories of an ensemble as exact numbers, from which kernel parameters are evaluated.

    Parameters
    ----------
    variation : Variation
        The initial states and constants that vary in the ensemble.
    plan : Plan
        A plan that is valid for all trajectories.
    chosen : whole numbers
        The indices of the trajectories.
    """

    def __init__(self, variation: Variation, plan: Plan, chosen: Sequence[int]) -> None:
        self._variation, self._plan, self._chosen = variation, plan, list(chosen)
        varying = dict(variation.columns) | {name: variation.omega[:, k] for k, name in enumerate(OMEGA)}
        inertia = plan.structure.inertia
        if isinstance(inertia, PrincipalInertia):
            for letter, name in zip(inertia.moments, PRINCIPAL, strict=True):
                if name in varying:
                    varying.setdefault(letter, varying[name])
        self._columns = {name: varying[name][self._chosen] for name in plan.constants if name in varying}

    def constants(self, k: int) -> dict[str, Fraction]:
        """Return all constants of trajectory ``chosen[k]`` as exact fractions, by name, such as ``weight`` or ``A``."""
        return Plan(self._variation.scene_of(self._chosen[k]), self._plan.structure, ()).constants

    def bound(self, parameters: Parameters, epoch: float = 0.0) -> Floats:
        """Return the values of k kernel parameters for each of n trajectories, shape (n, k), exact except for one
        rounding.

        A kernel gets the scene's constants, and formulas in them, as these parameters. A parameter that depends on the
        time at which the kernel's clock shows 0 is evaluated at ``epoch``, s.
        """
        scene = Plan(self._variation.scene, self._plan.structure, ()).constants
        known = {"pi": number.PI, EPOCH: Fraction(epoch), **scene}
        fixed = {name: value for name, value in known.items() if name not in self._columns}
        values = np.empty((len(self._chosen), len(parameters)))
        for k, (_, node) in enumerate(parameters):
            if node[0] == "symbol" and node[1] in self._columns:
                values[:, k] = self._columns[node[1]]
            elif names(node).isdisjoint(self._columns):
                values[:, k] = float(value_of(node, fixed))
            else:
                values[:, k] = self._each(folded(node, fixed), names(node))
        return values

    def _each(self, node: tuple[object, ...], used: set[str]) -> Floats:
        """Return the values of the formula ``node``, one for each trajectory.

        ``used`` are the names in the formula. For trajectories with equal constants it is evaluated only once.
        """
        columns = {name: column for name, column in self._columns.items() if name in used}
        table = np.stack(list(columns.values()), axis=1)
        rows, places = np.unique(table, axis=0, return_inverse=True)
        exact = [dict(zip(columns, map(Fraction, row), strict=True)) for row in rows.tolist()]
        values: Floats = np.array([float(value_of(node, constants)) for constants in exact])[places.ravel()]
        return values

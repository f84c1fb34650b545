"""Values of the parameters of a kernel (the compiled equations) for each trajectory of an ensemble.

A parameter, such as ``(B - C)/A``, is a formula in the constants of the scene. Parameters that do not vary are
evaluated once.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial

import numpy as np

from symrot.dynamics.structure import PrincipalInertia
from symrot.ensemble.enclosed import Enclosed, exact
from symrot.ensemble.variation import PRINCIPAL, Variation
from symrot.formula import exact_numbers as number
from symrot.formula.tree import Node, evaluate, names
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH, Parameters
from symrot.propagation.binding import folded, value_of
from symrot.propagation.sensitivities.variables import STEP, slopes
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
        The equations and states of the scene, chosen so that they hold for all trajectories.
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
        """Return all constants of one trajectory as exact fractions, by name, such as ``weight`` or ``A``.

        ``k`` is the position of the trajectory in ``chosen``, the argument of the class.
        """
        return Plan(self._variation.scene_of(self._chosen[k]), self._plan.structure, ()).constants

    def values_of(self, parameters: Parameters, epoch: float = 0.0) -> Floats:
        """Return the values of k kernel parameters for each trajectory, shape (n, k): exact values, each rounded once.

        ``epoch`` is the scene's time, s, at which the time t of the kernel is 0.
        """
        fixed = self._fixed(epoch)
        values = np.empty((len(self._chosen), len(parameters)))
        for k, (_, node) in enumerate(parameters):
            if node[0] == "symbol" and node[1] in self._columns:
                values[:, k] = self._columns[node[1]]
            elif names(node).isdisjoint(self._columns):
                values[:, k] = float(value_of(node, fixed))
            else:
                values[:, k] = self._formula_values(folded(node, fixed), names(node))
        return values

    def slopes(
        self, parameters: Parameters, constant_slopes: Mapping[str, Fraction], variable: str, epoch: float = 0.0
    ) -> dict[str, Floats]:
        """Return the derivatives of kernel parameters with respect to a variable, as a map from name to array (n,).

        Each array has the derivatives of one parameter for the n trajectories.

        Parameters
        ----------
        parameters : pairs of name and formula
            The parameters; those that do not depend on the variable are left out of the result.
        constant_slopes : mapping
            The derivative of each constant with respect to the variable, such as ``{"weight": 1}``. It is the same for
            all trajectories.
        variable : str
            The name of the variable, for messages.
        epoch : float
            The scene's time, s, at which the time t of the kernel is 0.

        Raises
        ------
        InputError
            If a parameter of a trajectory does not depend smoothly on the variable.
        """
        fixed = self._fixed(epoch)
        result: dict[str, Floats] = {}
        for name, node in parameters:
            used = names(node)
            if used.isdisjoint(constant_slopes):
                continue
            own = [key for key in self._columns if key in used]
            if node[0] == "symbol":
                result[name] = np.full(len(self._chosen), float(constant_slopes[node[1]]))
                continue
            if not own:
                slope = _slope(node, fixed, constant_slopes, variable, {})
                if slope:
                    result[name] = np.full(len(self._chosen), float(slope))
                continue
            slope_of = partial(_slope, node, fixed, constant_slopes, variable)
            result[name] = _in_fractions(slope_of, {key: self._columns[key] for key in own})
        return result

    def _fixed(self, epoch: float) -> dict[str, Fraction]:
        """Return a map from names to the numbers that all trajectories share: pi, the epoch (in s) and constants."""
        scene = Plan(self._variation.scene, self._plan.structure, ()).constants
        known = {"pi": number.PI, EPOCH: Fraction(epoch), **scene}
        return {name: value for name, value in known.items() if name not in self._columns}

    def _formula_values(self, node: Node, used: set[str]) -> Floats:
        """Return the values of the formula ``node`` for each trajectory, shape (n,): exact values, each rounded once.

        ``used`` are the names in the formula.
        """
        columns = {name: column for name, column in self._columns.items() if name in used}
        try:
            with np.errstate(all="ignore"):
                symbols = {name: exact(column) for name, column in columns.items()}
                enclosed: Enclosed = evaluate(node, symbols, None, exact)
                values, certain = enclosed.rounded()
        except KeyError:  # a function, which has no enclosure
            values, certain = np.empty(len(self._chosen)), np.zeros(len(self._chosen), dtype=bool)
        if not certain.all():
            uncertain = {name: column[~certain] for name, column in columns.items()}
            values[~certain] = _in_fractions(partial(value_of, node), uncertain)
        return values


def _in_fractions(function: Callable[[dict[str, Fraction]], Fraction], columns: Mapping[str, Floats]) -> Floats:
    """Return the value of ``function`` for each of n trajectories, rounded to a double, shape (n,).

    ``columns`` has an array, shape (n,), for each constant, by name. The function takes the constants of one trajectory
    as fractions, by name, and returns a fraction.
    """
    table = np.stack(list(columns.values()), axis=1)
    # evaluated once for trajectories with equal constants
    rows, places = np.unique(table, axis=0, return_inverse=True)
    constants = [dict(zip(columns, map(Fraction, row), strict=True)) for row in rows.tolist()]
    values: Floats = np.array([float(function(each)) for each in constants])[places.ravel()]
    return values


def _slope(
    node: Node, fixed: Mapping[str, Fraction], constant_slopes: Mapping[str, Fraction], variable: str,
    varying: Mapping[str, Fraction],
) -> Fraction:  # fmt: skip
    """Return the derivative of the formula ``node`` with respect to a variable, for one trajectory.

    ``fixed`` are the constants that all trajectories share, and ``varying`` the other constants of this trajectory.
    ``constant_slopes`` has the derivatives of constants with respect to the variable: ``A*B`` with A = 2, B = 3 and
    ``constant_slopes = {"A": 1}`` gives 3.
    """
    constants = {**fixed, **varying}
    ratios = [abs(constants[name] / slope) for name, slope in constant_slopes.items() if slope and name in constants]
    size = min((ratio for ratio in ratios if ratio), default=Fraction(1))

    def values(change: Fraction) -> Mapping[str, Fraction]:
        changed = {
            name: constants[name] + change * slope for name, slope in constant_slopes.items() if name in constants
        }
        return {"": value_of(node, {**constants, **changed})}

    return slopes(values, size * STEP, variable).get("", Fraction(0))

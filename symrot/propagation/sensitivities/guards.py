"""Guards and rates of a motion under torques that jump or bend, with their derivatives.

A *guard* is the argument of a switching function (sign, abs, ..); its *mode* is the number that replaces the function
in formulas.
"""

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.codegen.duals import Dual, dual_functions
from symrot.errors import PropagationError
from symrot.formula import exact_numbers as number
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Program
from symrot.formula.switches import STATES, chosen, hold
from symrot.formula.tree import evaluate, names
from symrot.planning.general_structure import constants_of
from symrot.planning.scene_kernel import EPOCH, Parameters
from symrot.propagation.binding import value_of
from symrot.propagation.sensitivities.intervals import Interval
from symrot.propagation.sensitivities.libraries import rates_of
from symrot.propagation.sensitivities.parameter_slopes import ParameterSlopes, Rows
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.system import SwitchedSystem, is_continuous
from symrot.scene.scene import Scene

__all__ = ["ALIKE", "AT_ZERO", "Gradient", "Guards", "alike"]

Floats = NDArray[np.float64]
AT_ZERO = 1e-9  # a guard nearer to zero, in units of the size of its terms, is zero at a switch
ALIKE = 1e-9  # relative difference of two derivatives that count as equal
DUALS = dual_functions(FLOAT_FUNCTIONS)


class Gradient(NamedTuple):
    """The value of a formula, and its partial derivatives with respect to time, the seven states and the m variables.

    The variables are the initial values and constants of the scene for which the user requests sensitivities.
    """

    value: float
    time: float
    states: Floats
    variables: Floats

    def along(self, rates: Floats) -> float:
        """Return the derivative of the formula along a motion with the given rates of the states."""
        return self.time + float(self.states @ rates)

    def size(self, rates: Floats) -> float:
        """Return the sum of the absolute values of the products that :meth:`along` adds, as a scale for its result.

        The products are the derivative with respect to time and, for each state, the derivative with respect to it
        times its rate.
        """
        return abs(self.time) + float(np.abs(self.states) @ np.abs(rates))

    def change(self, slopes_of_states: Floats) -> Floats:
        """Return the m total derivatives of the formula with respect to the variables at a fixed time.

        A variable changes the value of the formula directly and through the states.

        ``slopes_of_states`` has the derivatives of the states with respect to the variables, shape (7, m).
        """
        return np.asarray(self.states @ slopes_of_states + self.variables)


class Guards:
    """The guards (arguments of sign, abs, ..) and rates of a motion between its switches, with their derivatives.

    Parameters
    ----------
    scene : Scene
        The scene with the initial state.
    system : SwitchedSystem
        The switching functions.
    parameter_slopes : ParameterSlopes
        The derivatives of the parameters with respect to the variables.
    side : float
        1.0 for a motion forward in time, -1.0 backward.
    """

    def __init__(self, scene: Scene, system: SwitchedSystem, parameter_slopes: ParameterSlopes, side: float) -> None:
        self.scene, self.system, self.parameter_slopes, self.side = scene, system, parameter_slopes, side
        self._by_name = {switch.mode: switch for switch in system.switches}
        self._rates: dict[int, tuple[Program, Parameters]] = {}
        self._slopes: dict[Any, Rows] = {}
        self._constants = {"pi": number.PI, **constants_of(scene, parameter_slopes.structure)}
        self._require_settled()

    def _require_settled(self) -> None:
        """Raise InputError if a function's argument lies at a jump or kink and changes with one of the variables.

        Only arguments without time and states are examined, such as that of ``sign(c - 1)`` for c = 1: the function
        never switches during the motion, but a change of the constant c changes its value.
        """
        modes = self.system.initial_modes()
        constants = {**self._constants, **{name: Fraction(mode) for name, mode in modes.items()}}
        for switch in self.system.switches:
            if switch.mode not in self.system.settled or not hold(switch.where, modes):
                continue
            ends = [modes[switch.mode]] if switch.kind == "floor" else [0]
            self.parameter_slopes.require_constant(chosen(switch.guard, modes), constants, ends, switch.label)

    # ------------------------------------------------------------------------------------------------- functions

    def name(self, mode: str) -> str:
        """Return a function as the user wrote it, such as ``"sign(omega_3)"``.

        ``mode`` is the name of the number that replaces the function in formulas.
        """
        return self._by_name[mode].label

    def is_floor(self, mode: str) -> bool:
        """Return whether a function is floor(x) or mod(x, y), which is computed from floor(x/y).

        ``mode`` is the name of the number that replaces the function in formulas. A function floor(x) whose present
        value is n switches where x - n is 0 or 1.
        """
        return self._by_name[mode].kind == "floor"

    def is_sign(self, mode: str) -> bool:
        """Return whether a function depends on the sign of its argument, as sign, abs and step do and floor does not.

        ``mode`` is the name of the number that replaces the function in formulas.
        """
        return self._by_name[mode].kind == "sign"

    def is_continuous(self, mode: str) -> bool:
        """Return whether a function has only kinks and no jumps, as abs has.

        ``mode`` is the name of the number that replaces the function in formulas.
        """
        return is_continuous(self._by_name[mode])

    def twins(self, mode: str) -> list[tuple[str, int]]:
        """Return the functions that switch together with a function such as sign(x), as pairs (name, 1 or -1).

        The name is that of the number that replaces the function in formulas; ``mode`` is the name for the given
        function. The list includes a pair for the given function. 1 or -1 is the sign of the argument relative to the
        argument of the function in the first pair.
        """
        return self.system.twins.get(mode, [(mode, 1)])

    def refusal(self, instant: Instant, reason: str) -> PropagationError:
        """Return the error that says why no derivatives exist beyond an instant."""
        return PropagationError(
            f"{self.scene.name}: sensitivities: expected a motion with derivatives, but they do not exist "
            f"{'after' if self.side > 0.0 else 'before'} t = {instant.high!r} s: {reason}"
        )

    # ------------------------------------------------------------------------------------------------- formulas

    def program(self, interval: Interval) -> tuple[Program, Parameters]:
        """Return the rates of the states in an interval of the motion: a program, and formulas of its parameters."""
        key = id(interval.regime)
        if key not in self._rates:
            self._rates[key] = rates_of(interval.regime.plan)
        return self._rates[key]

    def bound(self, parameters: Parameters, interval: Interval, kind: str) -> tuple[dict[str, float], Rows]:
        """Return two dicts for the equations in an interval: the values of ``parameters``, and their derivatives.

        The keys are names of parameters. The second dict has only the parameters that depend on a variable, each with
        its m derivatives with respect to the variables. ``kind`` says to which equations the parameters belong:
        ``"rates"``, ``"guards"`` or ``"quantities"``.
        """
        timed = any(EPOCH in names(formula) for _, formula in parameters)
        key = kind, id(interval.regime), tuple(interval.modes.values()), interval.zero if timed else None
        if key not in self._slopes:
            modes = {name: Fraction(mode) for name, mode in interval.modes.items()}
            constants = {**self._constants, **modes, EPOCH: interval.zero.exact}
            values = {name: [float(value_of(formula, constants))] for name, formula in parameters}
            self._slopes[key] = values
            self._slopes[(*key, "by")] = self.parameter_slopes.slopes_of(parameters, constants)
        return {name: value for name, (value,) in self._slopes[key].items()}, self._slopes[(*key, "by")]

    def _duals(self, parameters: Parameters, interval: Interval, t: float, y: Floats, kind: str) -> dict[str, Any]:
        """Return a map from each name in the equations of an interval to its value at the time t and the states y.

        A value that depends on the time, the states or the variables is a dual number: it contains its derivatives with
        respect to them. ``kind`` says to which equations ``parameters`` belong: ``"rates"``, ``"guards"`` or
        ``"quantities"``.
        """
        values, rows = self.bound(parameters, interval, kind)
        inputs: dict[str, Any] = {name: float(mode) for name, mode in interval.modes.items()}
        for name, value in values.items():
            by = {f"by {k}": slope for k, slope in enumerate(rows.get(name, ())) if slope}
            inputs[name] = Dual(value, by) if by else value
        inputs |= {name: Dual(float(x), {name: 1.0}) for name, x in zip(STATES, y, strict=True)}
        return {**inputs, "t": Dual(t, {"t": 1.0})}

    def _gradient(self, value: Any) -> Gradient:
        dual = value if isinstance(value, Dual) else Dual(float(value), {})
        by = [float(dual.slopes.get(f"by {k}", 0.0)) for k in range(len(self.parameter_slopes.columns))]
        states = np.array([float(dual.slopes.get(name, 0.0)) for name in STATES])
        return Gradient(float(dual.value), float(dual.slopes.get("t", 0.0)), states, np.array(by))

    def guard(self, interval: Interval, mode: str, t: float, y: Floats) -> Gradient:
        """Return the argument of a function (sign, abs, ..), with its derivatives, at the time t and the states y.

        ``mode`` is the name of the number that replaces the function in formulas. For floor(x) the result is x - n,
        where n is the present value of the function.
        """
        inputs = self._duals(interval.regime.parameters, interval, t, y, "guards")
        return self._gradient(evaluate(interval.regime.formulas[mode], inputs, DUALS, float))

    def held_mode(self, interval: Interval, mode: str) -> Gradient:
        """Return the value of a sign(x) whose x is held at zero, at the end of an interval, with its derivatives.

        The value lies between -1 and 1 and keeps x at zero; ``mode`` is its name in formulas.
        """
        quantities, parameters = interval.regime.quantities, interval.regime.quantity_parameters
        inputs = self._duals(parameters, interval, interval.stop, interval.last, "quantities")
        output = f"{mode} of t"
        return self._gradient(quantities.evaluate(inputs, DUALS, float, [output])[output])

    def rates(self, interval: Interval, t: float, y: Floats) -> Floats:
        """Return the time derivatives of the seven states in an interval, t s after its instant ``zero``."""
        program, parameters = self.program(interval)
        values, _ = self.bound(parameters, interval, "rates")
        inputs = {**values, **dict(zip(STATES, y.tolist(), strict=True)), "t": t}
        return np.array(list(program.evaluate(inputs, FLOAT_FUNCTIONS, float).values()), dtype=np.float64)

    def rate_slopes(self, interval: Interval, t: float, y: Floats) -> Floats:
        """Return the rates of the seven states with their derivatives, shape (7, 1 + 7 + m): one row for each state.

        A row has the rate, then its derivatives with respect to the seven states and to the m variables.
        """
        program, parameters = self.program(interval)
        inputs = self._duals(parameters, interval, t, y, "rates")
        rows = [self._gradient(value) for value in program.evaluate(inputs, DUALS, float).values()]
        return np.array([[row.value, *row.states, *row.variables] for row in rows])


def alike(left: Floats, right: Floats) -> NDArray[np.bool_]:
    """Return, for each entry of two arrays of derivatives, whether they differ by at most 1e-9 of their size.

    The size is that of the larger entry or, for matrices, of the largest entry in the column.
    """
    sizes = np.maximum(np.abs(left), np.abs(right))
    return np.abs(left - right) <= ALIKE * (sizes if sizes.ndim == 1 else sizes.max(axis=0))

"""Regimes: the smooth motions between switches of a torque, and the guards whose zeros end them.

A *guard* is the argument of a function such as sign or abs; a *mode* is the number that replaces the function in
formulas, such as the sign of the guard. If a guard is *held* at zero, the motion *slides*. ``zero`` is the instant at
which the clock of the motion shows 0.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from symrot.build import cache as library
from symrot.codegen.taylor.time_shift import moved, moved_formulas
from symrot.formula.exact_functions import exact_value
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Argument, Program
from symrot.formula.switches import Conditions, Switch, hold
from symrot.formula.tree import Node, names, parse, rename, text
from symrot.planning.scene_kernel import Parameters
from symrot.propagation.binding import folded, two_doubles
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.events.event import Event
from symrot.propagation.events.library import guard_library_source
from symrot.propagation.motions.methods import SciPyMotion, SteppedMotion
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.switched.domains import may_lose_value
from symrot.propagation.switched.instant import Instant
from symrot.propagation.time_shift import ShiftedParameters

__all__ = ["Guard", "Modes", "Regime"]

Modes = dict[str, int]


class Guard(NamedTuple):
    """A formula that turns negative where a switching function (sign, floor, ..) changes its value."""

    # name of the number that replaces the function in the equations
    mode: str
    formula: str
    # 0: the mode changes to the opposite sign; 1 or -1: it changes to that sign, or by that number (floor). For a held
    # mode: the value with which it leaves the sliding motion here, or 0 if nearby motions no longer return to it.
    change: int
    # conditions under which the function affects the motion
    where: Conditions


class RegimeParameters(NamedTuple):
    """Parameters of the equations between two switches, in which time is counted from an epoch.

    Each of ``rates``, ``guards`` and ``quantities`` takes an epoch, a time of the scene, s, and returns the values of
    parameters (:class:`ShiftedParameters`): of the rates of the states, of the formulas whose zeros end the motion, and
    of the output quantities. ``invariants`` has the values with which the Taylor stepper computes conserved quantities,
    to keep them constant: again the parameters of the output quantities, but independent of the epoch, and each as two
    doubles whose sum is more exact.
    """

    rates: ShiftedParameters
    guards: ShiftedParameters
    quantities: ShiftedParameters
    invariants: list[float]


class Regime:
    """A smooth motion between two switches: its rates, and the guards (arguments of sign, abs, ..) that end it."""

    def __init__(
        self,
        constants: Mapping[str, Fraction],
        all_switches: Sequence[Switch],
        motion: SteppedMotion | SciPyMotion,
        held: frozenset[str],
        switches: Sequence[Switch],
    ) -> None:
        # the guards of the functions in held stay at zero and do not end the regime: the motion slides
        self.motion, self.plan, self.held = motion, motion.plan, held
        # constants: exact, by name; all_switches: of the scene; switches: those that affect this regime
        self.constants, self.switches = constants, all_switches
        modes = [switch.mode for switch in switches]
        distances = [_distance(switch) for switch in switches]
        # time is counted from the instant at which the motion enters the regime, which becomes a parameter
        formulas, parameters = moved_formulas(distances, {*self.constants, *modes})
        names_of_clock = {name: f"since_{name}" for name, _ in parameters if name not in {*self.constants, *modes}}
        self.parameters = tuple((names_of_clock.get(name, name), formula) for name, formula in parameters)
        self.formulas = {mode: rename(node, names_of_clock) for mode, node in zip(modes, formulas, strict=True)}
        known = {"t", "pi", *(name for name, _ in self.parameters)}
        self.of_time = {mode for mode, formula in self.formulas.items() if names(formula) <= known}
        self.may_lose_value = {mode for mode, formula in self.formulas.items() if may_lose_value(formula)}
        self.guards = [guard for switch in switches for guard in self._guards(switch)]
        mode, always = min(held, default=""), ()
        self.guards += [Guard(mode, f"attraction_{k}_of_t", 0, always) for k in range(len(held))]
        nodes = [parse(guard.formula) for guard in self.guards]
        known = {name for name, _ in self.parameters} | set(modes)
        self.more = sorted(known & set().union(*map(names, nodes)))
        self.events = [Event(guard.formula, terminal=True, direction=-1) for guard in self.guards]
        columns = {name: f"{name} of the scene" for name in self.more}  # kernels use other names for constants
        columns |= {f"{mode}_of_t": f"{mode} of t" for mode in held}
        columns |= {f"attraction_{k}_of_t": f"attraction {k} of t" for k in range(len(held))}
        quantities, self.quantity_parameters = motion.kernel.quantities, motion.kernel.quantity_parameters
        if quantities.uses("t"):  # for example the value of sign(..) that keeps its argument at zero
            quantities, self.quantity_parameters = moved(quantities, self.quantity_parameters)
        self.quantities = quantities
        program = _with_parameters(quantities, [columns[name] for name in self.more])
        source = guard_library_source(
            program, [rename(node, columns) for node in nodes], self.plan.states, *error_blocks(self.plan)
        )
        self.path = library.build(source, "events")
        self._parameters: dict[tuple[int, ...], RegimeParameters] = {}
        self._active: dict[tuple[int, ...], list[bool]] = {}
        self._bound: dict[tuple[tuple[int, ...], Instant | None], tuple[list[float], list[float]]] = {}

    def _guards(self, switch: Switch) -> Iterator[Guard]:
        mode, where = switch.mode, switch.where
        guard = text(self.formulas[mode])
        if mode in self.held:
            yield Guard(mode, f"1 - {mode}_of_t", 1, where)
            yield Guard(mode, f"1 + {mode}_of_t", -1, where)
        elif switch.kind == "sign":
            yield Guard(mode, f"{mode}*({guard})", 0, where)
        else:
            yield Guard(mode, guard, -1, where)
            yield Guard(mode, f"1 - ({guard})", 1, where)

    def _parameters_under(self, modes: Modes) -> RegimeParameters:
        """Return the parameters of the equations, as functions of the epoch, for given values of sign, abs, ..

        ``modes`` has these values; the epoch is the time of the scene from which the equations count time.
        """
        key = tuple(modes.values())
        if key not in self._parameters:
            values = {name: Fraction(value) for name, value in modes.items()}
            taylor = self.motion.choice.method == "taylor"
            invariants = self.motion.kernel.quantity_parameters if taylor else ()
            constants = {**self.constants, **values}
            numbers = [exact_value(node, constants) for _, node in invariants]
            pairs = [
                part
                for exact in numbers
                for part in (two_doubles(*exact.as_integer_ratio()) if exact == exact else (math.nan, math.nan))
            ]
            rates, guards, quantities = (ShiftedParameters(each, values) for each in self._with_constants)
            self._parameters[key] = RegimeParameters(rates, guards, quantities, pairs)
        return self._parameters[key]

    def values(self, modes: Modes, zero: Instant) -> dict[str, float]:
        """Return the values, by name, of the modes and of the parameters in the arguments of sign, abs, ..

        A mode is the number that replaces such a function. The equations count time from the instant ``zero``, on which
        the values of the parameters depend.
        """
        numbers = self._parameters_under(modes).guards.parameters(zero.exact)
        return {name: number for (name, _), number in zip(self.parameters, numbers, strict=True)} | {
            name: float(mode) for name, mode in modes.items()
        }

    def bound(self, modes: Modes, zero: Instant) -> tuple[list[float], list[float]]:
        """Return the values of the equations' parameters: a list for the stepper, and one for the search for switches.

        ``modes`` has the present values of the functions (sign, abs, ..). The equations count time from the instant
        ``zero``, on which the parameters may depend.
        """
        rates, guards, quantities, invariants = self._parameters_under(modes)
        fixed = rates.fixed and guards.fixed and quantities.fixed
        place = tuple(modes.values()), None if fixed else zero
        if place not in self._bound:
            if place[1] is not None:
                self._bound = {key: value for key, value in self._bound.items() if key[1] in (None, zero)}
            numbers, values = [*rates.parameters(zero.exact), *invariants], self.values(modes, zero)
            self._bound[place] = numbers, [*quantities.parameters(zero.exact), *(values[name] for name in self.more)]
        return self._bound[place]

    def zeros(self, modes: Modes, zero: Instant, y: Floats) -> set[str]:
        """Return the names of those states and parameters that are zero now.

        The parameters are those of the program that computes the output quantities from the states.

        ``y`` are the present states, ``modes`` the present values of the functions (sign, abs, ..); ``zero`` is the
        instant from which the equations count time.
        """
        # with these names one decides whether x in sign(x) stays zero by itself, as in a body at rest
        return {name for name, value in self._inputs(modes, zero, y).items() if value == 0.0}

    def attraction(self, modes: Modes, zero: Instant, t: float, y: Floats) -> list[float]:
        """Return one number for each x held at zero in sign(x); all are positive if nearby motions return to x = 0."""
        # t is counted from the instant zero
        names = [f"attraction {k} of t" for k in range(len(self.held))]
        values = {**self._inputs(modes, zero, y), "t": t}
        quantities = self.quantities.evaluate(values, FLOAT_FUNCTIONS, float, names)
        return [float(quantities[name]) for name in names]

    def _inputs(self, modes: Modes, zero: Instant, y: Floats) -> dict[str, float]:
        """Return a map from names to values of the inputs of the output quantities: the states ``y`` and parameters."""
        numbers = self._parameters_under(modes).quantities.parameters(zero.exact)
        values = zip((name for name, _ in self.quantity_parameters), numbers, strict=True)
        return dict((*values, *zip(self.plan.states, y.tolist(), strict=True)))

    def rates_since(self, modes: Modes, zero: Instant) -> Callable[[float], list[float]] | None:
        """Return a function from an epoch to the values of the rates' parameters, or None if no value depends on it.

        The rates are the time derivatives of the states. The function takes the epoch, s after the instant ``zero``.
        With the values that it returns, t in the formulas of the rates is the time since the epoch.

        The values also depend on ``modes``, the values of the switching functions (sign, abs, ..), which stay fixed.
        """
        rates = self._parameters_under(modes).rates
        return None if rates.fixed else lambda since: rates.parameters(zero.exact + Fraction(since))

    @cached_property
    def _with_constants(self) -> tuple[Parameters, Parameters, Parameters]:
        """The parameters of the rates, of the switching functions' arguments and of the output quantities.

        Each parameter is a pair (name, formula); in the formula, the constants of the scene are replaced by their
        values. It then contains only the epoch and the values of the switching functions.
        """
        modes = {switch.mode for switch in self.switches}
        known = {name: value for name, value in self.constants.items() if name not in modes}
        kernel = self.motion.kernel
        rates, guards, quantities = (
            tuple((name, folded(formula, known)) for name, formula in parameters)
            for parameters in (kernel.rate_parameters, self.parameters, self.quantity_parameters)
        )
        return rates, guards, quantities

    def active(self, modes: Modes) -> list[bool]:
        """Return, for each formula (:class:`Guard`) in ``guards``, whether the smooth motion ends where it is zero.

        A formula turns negative where a switching function changes its value. It does not end the motion if this
        function has no effect for the present values ``modes`` of all switching functions, as in an unused branch of
        where(condition, u, v).
        """
        key = tuple(modes.values())
        if key not in self._active:
            self._active[key] = [hold(guard.where, modes, self.held) for guard in self.guards]
        return self._active[key]


def _distance(switch: Switch) -> Node:
    """Return a formula whose value shows when a function switches: x for sign(x), x - n for floor(x) with the value n.

    The sign switches where x is 0, the floor where x - n is 0 or 1.
    """
    # n, the present value of floor(x), is subtracted exactly, before rounding: far from t = 0 the difference has far
    # fewer digits than x. Where it is 0 or 1, x leaves the interval from n to n + 1.
    return switch.guard if switch.kind == "sign" else ("-", switch.guard, ("symbol", switch.mode))


def _with_parameters(program: Program, more: list[str]) -> Program:
    """Return the program that computes the output quantities, with additional parameters.

    A program is a list of formulas, from which C code is printed. The names ``more`` are appended to the components of
    its argument p, the array of the parameters. Only the search for switches uses them.
    """
    arguments = list(program.signature.arguments)
    place = next((k for k, argument in enumerate(arguments) if argument.name == "p"), None)
    extra = tuple((name, "", "") for name in more)
    if place is None:
        arguments.insert(2, Argument("p", "in", extra))
    else:
        arguments[place] = replace(arguments[place], components=(*arguments[place].components, *extra))
    return replace(program, signature=replace(program.signature, arguments=tuple(arguments)))

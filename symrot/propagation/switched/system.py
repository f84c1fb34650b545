"""All switching functions (sign, abs, ..) of the torques of a motion, and the smooth motions (regimes) in between.

A *guard* is the argument of a switching function; its *mode* is the number that replaces the function in the formulas.
While a motion *slides*, guards are *held* at zero.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, reduce
from typing import Any

from symrot.dynamics.structure import FormulaTorque, TorqueStructure, TorqueSwitch
from symrot.errors import InputError
from symrot.formula.exact_numbers import PI
from symrot.formula.float_functions import float_value
from symrot.formula.switches import STATES, Switch, between_sides, chosen, hold, on_line, placed
from symrot.formula.tree import Node, names, parse, rename, text
from symrot.planning.plan import Plan
from symrot.propagation.method import Choice
from symrot.propagation.motions.make import on_own_clock
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.switched.regimes import Modes, Regime

__all__ = ["SwitchedSystem", "is_continuous"]

CONTINUOUS = ("abs(", "max(", "min(", "clip(", "sqrt(")  # first characters of labels of functions that do not jump


class SwitchedSystem:
    """All switching functions (sign, abs, ..) in the torques of a scene, and the smooth motions between switches."""

    def __init__(self, plan: Plan, choice: Choice, tolerance: float) -> None:
        # Numbers replace the functions between switches. While the motion slides, the arguments of some functions stay
        # at zero and their values are unknowns: each set of them, also the empty one, has its own regimes.
        self.plan, self.choice, self.tolerance = plan, choice, tolerance
        self.start = float(plan.scene.span.start)

    @cached_property
    def switches(self) -> list[Switch]:
        """The switching functions (sign, abs, ..) of all torques, each with its argument and the name of its mode."""
        # the mode, a constant of the plan, is the number that replaces the function in the formulas
        return [switch for switches in self._switches_by_torque for switch in switches]

    @cached_property
    def _switches_by_torque(self) -> list[list[Switch]]:
        return [_switches(torque) for torque in self.plan.structure.formula_torques]

    @cached_property
    def twins(self) -> dict[str, list[tuple[str, int]]]:
        """A map from each sign, abs, .. to the functions of the same torque whose arguments are zero together.

        Examples are sign(omega_3) and abs(2*omega_3). A function is identified by the name of its mode, the number
        that replaces the function in formulas. A key is such a name. Its value is a list of pairs (name, 1 or -1), one
        for each of these functions, among them the function of the key. The number is -1 if the argument of the
        function has the opposite sign of the argument of the first function in the list.
        """
        numbers: dict[str, Node] = {name: ("number", value) for name, value in self.constants.items()}
        for mode in self.switches:
            numbers.pop(mode.mode, None)
        twins: dict[str, list[tuple[str, int]]] = {}
        for switches in self._switches_by_torque:
            alike: dict[Any, list[tuple[str, int]]] = {}
            # functions that jump come first
            for switch in sorted(switches, key=_bends):
                if switch.kind == "sign":
                    key, sign = on_line(placed(switch.guard, numbers))
                    alike.setdefault((key, switch.where), []).append((switch.mode, sign))
            for modes in alike.values():
                twins |= {mode: [(twin, other * modes[0][1]) for twin, other in modes] for mode, _ in modes}
        return twins

    def tied(self, held: frozenset[str]) -> dict[str, tuple[str, int]]:
        """Return the functions that switch together with a held function, as abs(2*omega_3) with sign(omega_3).

        The arguments of the functions ``held`` stay at zero. The result is a map from the name of a function to the
        pair (name of the held function, 1 or -1); -1 means that the arguments of these two functions have opposite
        signs. Each held function must be the first in its list in :attr:`twins`.
        """
        return {twin: (mode, sign) for mode in held for twin, sign in self.twins[mode] if twin != mode}

    def matters_at_zero(self, mode: str) -> bool:
        """Return whether the value of sign(0) affects a motion in which the argument x of sign(x) stays zero.

        ``mode`` is the name of the number that replaces the function sign(x) in formulas.
        """
        if next(switch for switch in self.switches if switch.mode == mode).at_zero != 0:
            # functions with the value of one side at zero, such as abs and step, never need it
            return False
        names_of = {twin for twin, _ in self.twins[mode]}
        others = any(switch.mode in names_of - {mode} and not _bends(switch) for switch in self.switches)
        # another function jumps there too, or a torque is nonlinear in sign(x); otherwise the mean of 1 and -1 that
        # keeps x at zero determines the motion
        return others or any(_is_mixed(torque, mode) for torque in self.plan.structure.formula_torques)

    @cached_property
    def settled(self) -> set[str]:
        """The names of the switching functions that never switch, because their arguments are constant."""
        settled = set[str]()
        for switch in self.switches:
            if names(switch.guard) <= self.constants.keys() - ({each.mode for each in self.switches} - settled):
                settled.add(switch.mode)
        return settled

    @cached_property
    def constants(self) -> dict[str, Fraction]:
        return {"pi": PI, **self.plan.constants}

    def initial_modes(self) -> Modes:
        """Return the initial values of all switching functions, by name.

        If the argument of sign or abs depends on the state and is zero at the start, it is treated as positive. The
        motion determines later whether it becomes positive or negative.
        """
        return dict(self._initial_modes[0])

    @property
    def undecided(self) -> set[str]:
        """The names of the functions whose value just after the start does not follow from the initial state alone.

        The argument u of such a function, sign(u) or abs(u) but not floor(u), depends on states and is zero at the
        start: the motion decides whether u becomes positive or negative. The name is that of the number that replaces
        the function in formulas.
        """
        return self._initial_modes[1]

    @cached_property
    def _initial_modes(self) -> tuple[Modes, set[str]]:
        return self._modes_at_start({})

    def beside_start(self, mode: str, sign: int) -> Modes:
        """Return the values of all functions (sign, abs, ..) just after the start, for a given value of one of them.

        ``mode`` is the name of the number that replaces this one function in formulas; ``sign``, 1 or -1, is its value.
        """
        # functions that contain this one, such as floor(sign(x) + y), differ for 1 and -1
        return self._modes_at_start({mode: sign})[0]

    def _modes_at_start(self, chosen_modes: Modes) -> tuple[Modes, set[str]]:
        start, modes, undecided = self.plan.scene.initial, Modes(), set[str]()
        values: dict[str, float] = {name: float(value) for name, value in self.constants.items()}
        values |= {"t": self.start, **{f"omega_{i + 1}": float(value) for i, value in enumerate(start.omega_b)}}
        values |= {f"q{i}": float(value) for i, value in enumerate(start.quaternion)}
        for switch in self.switches:
            if not hold(switch.where, modes):
                modes[switch.mode] = 0 if switch.kind == "floor" else 1
                values[switch.mode] = float(modes[switch.mode])
                continue
            try:
                guard = float_value(chosen(switch.guard, modes), values)
            except (ArithmeticError, ValueError):
                raise IntegrationStopped(self.start, f"{switch.label} has no value there") from None
            modes[switch.mode] = math.floor(guard) if switch.kind == "floor" else -1 if guard < 0.0 else 1
            if guard == 0.0 and switch.mode in self.settled:
                modes[switch.mode] = 0 if switch.kind == "floor" else switch.at_zero
            modes[switch.mode] = chosen_modes.get(switch.mode, modes[switch.mode])
            values[switch.mode] = float(modes[switch.mode])
            if guard == 0.0 and switch.kind == "sign" and not names(switch.guard).isdisjoint(STATES):
                undecided.add(switch.mode)
        return modes, undecided

    def regime(self, held: frozenset[str], modes: Modes) -> Regime:
        """Return the smooth motion in which the arguments of the switching functions ``held`` stay at zero.

        Raise InputError if one of these functions, or one that switches together with it, occurs inside the argument of
        another function: this argument then has no value.
        """
        # the values of the other functions only choose branches of where(condition, u, v)
        key = held, tuple(modes.values()) if self._chooses else ()
        if key not in self._regimes:
            tied = self.tied(held)
            torques = tuple([_chosen(torque, modes, held, tied) for torque in self.plan.structure.torques])
            content = held, torques
            if content not in self._regime_of:
                plan = replace(self.plan, structure=replace(self.plan.structure, torques=torques))
                switches = [
                    switch._replace(guard=chosen(switch.guard, modes, held))
                    for switch in self.switches
                    if switch.mode not in self.settled
                    and switch.mode not in tied
                    and (not self._chooses or hold(switch.where, modes, held))
                ]
                for switch in switches:
                    if names(switch.guard) & (held | tied.keys()):
                        raise InputError(
                            f"torque: the states stay at the jump of a function inside {switch.label}, and at this "
                            f"jump {switch.label} has no value; put no function with a jump inside another one"
                        )
                own = on_own_clock(plan, self.choice, self.tolerance)
                self._regime_of[content] = Regime(self.constants, self.switches, own, held, switches)
            self._regimes[key] = self._regime_of[content]
        return self._regimes[key]

    @cached_property
    def _chooses(self) -> bool:
        """Whether a branch in a torque is not defined everywhere, as in ``where(omega_1 > 0, 1/omega_1, 0)``."""
        return any(torque.has_choices for torque in self.plan.structure.formula_torques)

    @cached_property
    def _regimes(self) -> dict[tuple[frozenset[str], tuple[int, ...]], Regime]:
        return {}

    @cached_property
    def _regime_of(self) -> dict[tuple[frozenset[str], tuple[TorqueStructure, ...]], Regime]:
        return {}


def _switches(torque: FormulaTorque) -> list[Switch]:
    """Return the switching functions (sign, abs, ..) of a torque, each with the name of its mode in the equations.

    The mode is the number that replaces the function in formulas; its name begins with the prefix of the torque, such
    as ``torque2_``.
    """
    own = {name: f"{torque.prefix}{name}" for name in torque.parameters}
    return [
        Switch(
            own[switch.mode],
            switch.kind,
            rename(parse(switch.choices or switch.guard, switching=True), own),
            tuple([(rename(parse(share), own), value) for share, value in switch.where]),
            switch.label,
            switch.at_zero,
        )
        for switch in torque.switches
    ]


def _is_mixed(torque: FormulaTorque, mode: str) -> bool:
    """Return whether a formula of the torque is nonlinear in the number named ``mode``, which replaces sign, abs, .."""
    # the mean of the formula's values at 1 and -1 is then not its value at 0
    own = mode.removeprefix(torque.prefix)
    nodes = [parse(formula, switching=True) for formula in torque.choices or torque.formulas]
    return own in torque.parameters and any(between_sides(node, own) != node for node in nodes)


def is_continuous(switch: Switch) -> bool:
    """Return whether a switching function is continuous where it switches, as abs, max, min and clip are."""
    return switch.label.startswith(CONTINUOUS)


def _bends(switch: Switch | TorqueSwitch) -> bool:
    """Return whether a function has only a kink where it switches, as abs, and no jump, as sign.

    The result is not valid for floor.
    """
    # at the switch, both values of its mode, 1 and -1, then give the right result; floor would give True here
    return switch.at_zero == 1


def _chosen(
    torque: TorqueStructure, modes: Modes, held: frozenset[str], tied: Mapping[str, tuple[str, int]]
) -> TorqueStructure:
    """Return a torque in which the branch that applies replaces each ``where(condition, u, v)``.

    ``modes`` has the values of the switching functions (sign, abs, ..). The arguments of the functions ``held`` stay at
    zero: in the result, an unknown replaces each of these functions, and the formulas are linear in the unknowns.
    ``tied``, a result of :meth:`SwitchedSystem.tied`, has the functions that switch together with a held function. Such
    a function with a jump is replaced by the unknown of the held function, times 1 or -1. Such a function with a kink,
    as abs, keeps its value in ``modes``, since both of its values are right at zero. A torque without formulas is
    returned unchanged.
    """
    if not isinstance(torque, FormulaTorque):
        return torque
    prefix, names = torque.prefix, torque.parameters
    own = tuple(sorted(name for name in names if prefix + name in held))
    torque = torque._replace(held=own)
    jumping = [switch.mode for switch in torque.switches if not _bends(switch)]
    same: dict[str, Node] = {}
    for name in jumping:
        if prefix + name in tied:
            mode, sign = tied[prefix + name]
            symbol: Node = ("symbol", mode.removeprefix(prefix))
            same[name] = symbol if sign > 0 else ("neg", symbol)
    if not own and not same and not torque.has_choices:
        return torque
    values = {name: modes[prefix + name] for name in names if prefix + name in modes}

    def read(formula: str) -> str:
        return text(chosen(placed(parse(formula, switching=True), same), values, own))

    def mixed(formula: str) -> str:
        node = chosen(placed(parse(formula, switching=True), same), values, own)
        return text(reduce(between_sides, own, node))

    return torque._replace(
        formulas=tuple(map(mixed, torque.choices or torque.formulas)),
        choices=(),
        switches=tuple(
            [
                switch._replace(guard=read(switch.choices or switch.guard), choices="")
                for switch in torque.switches
                # a function that has no effect for these values is left out
                if hold([(parse(share), value) for share, value in switch.where], values, own)
            ]
        ),
    )

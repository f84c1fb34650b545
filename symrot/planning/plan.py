"""The plan of a scene: the smallest set of equations that gives the requested output. Does not use SymPy.

The structure of a motion says which constants are zero, equal or free (any other value); scenes of the same structure
share a kernel, the code of their equations. A plan simplifies the most general structure by the rules of
:mod:`symrot.planning.rules`.
"""

from collections.abc import Hashable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import symrot
from symrot.dynamics.structure import Pattern, Structure
from symrot.errors import InputError
from symrot.formula import switches
from symrot.planning.general_structure import constants_of, general_structure, switching_function
from symrot.planning.rules import (
    DIRECTED,
    RULES,
    RULES_UNDER_EXTERNAL_TORQUE,
    RuleOutcome,
    pattern,
    zero_components,
)
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["START_CONSTANTS", "STATES", "Plan", "make_plan", "structure_key"]

ZERO, FREE = Pattern.ZERO, Pattern.FREE  # a global name is looked up faster than a member of an Enum
START_CONSTANTS = frozenset({f"omega_{i}" for i in (1, 2, 3)} | {f"initial_q{i}" for i in range(4)})
"""Names of the constants in equations that are components of the initial state.

All other constants belong to the body or the torques."""
STATES = (*switches.STATES, "theta")


@dataclass(frozen=True, repr=False)
class Plan:
    """The smallest set of equations that gives the output of a scene, and the values of the constants in them.

    Attributes
    ----------
    scene : Scene
        The scene.
    structure : Structure
        Which constants are zero, equal or free; this determines the equations.
    rows : tuple of RuleOutcome
        The results of the rules that simplify the equations (:mod:`symrot.planning.rules`), in the order of
        application. Each says whether its rule applies to the scene, and why.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").states[:3]
    ('omega_1', 'omega_2', 'omega_3')
    """

    scene: Scene
    structure: Structure
    rows: tuple[RuleOutcome, ...]

    def __repr__(self) -> str:
        skipped = sum(row.skipped for row in self.rows)
        rules = f"{skipped} of {len(self.rows)} rules simplify the equations"
        return f"<Plan of {self.scene.name}: {len(self.states)} states, {rules}>"

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    @cached_property
    def constants(self) -> dict[str, Fraction]:
        """The exact values of all constants in the equations and of the initial state: ``{"A": Fraction(1), ..}``.

        Modes, which stand for functions such as sign, are 1; propagation sets them to the values that belong to the
        state.
        """
        return self.scene_constants | self.start_constants

    @cached_property
    def scene_constants(self) -> dict[str, Fraction]:
        """The exact values of the constants of body and torques, such as ``{"A": Fraction(1)}``."""
        return constants_of(self.scene, self.structure)

    @property
    def start_constants(self) -> dict[str, Fraction]:
        """The exact values of the constants that belong to the initial state, such as ``{"omega_3": Fraction(3)}``."""
        initial = self.scene.initial
        parts = initial.omega_b, initial.quaternion
        return {name: parts[part][place] for name, part, place in self._start_places}

    @cached_property
    def _start_places(self) -> tuple[tuple[str, int, int], ...]:
        """For each constant of the initial state: (name, 0 for omega or 1 for the quaternion, index of component)."""
        rates = enumerate(self.structure.constant)
        quaternion = enumerate(self.structure.initial_quaternion or ())
        return (
            *((f"omega_{i + 1}", 0, i) for i, mark in rates if mark is FREE),
            *((f"initial_q{i}", 1, i) for i, mark in quaternion if mark is FREE),
        )

    @property
    def switches(self) -> list[str]:
        """The functions with jumps or kinks in the torques, as the scene writes them, such as ``"sign(omega_3)"``.

        The list is empty if no torque has such a function.
        """
        return [switch.label for torque in self.structure.formula_torques for switch in torque.switches]

    @cached_property
    def states(self) -> tuple[str, ...]:
        """The names of the states in the order of the kernel: ``("omega_1", "omega_2", "q0", "q1", "q2", "q3")``."""
        structure, axis = self.structure, self.structure.planar
        names = [f"omega_{i + 1}" for i in structure.moving]
        if structure.attitude:
            if axis is None:
                names += ["q0", "q1", "q2", "q3"]
            elif structure.constant[axis] is not ZERO:
                # the attitude of a body that rotates about one axis only
                names.append("theta")
        return tuple(names)

    @cached_property
    def initial_state(self) -> tuple[float, ...]:
        """The initial values of :attr:`states`, in the same order.

        ``theta``, the angle of a body that rotates about one axis only, starts at 0.
        """
        start = self.scene.initial
        values = (*start.omega_b, *start.quaternion, 0)
        ratios = [values[place].as_integer_ratio() for place in self._places]
        return tuple([top / bottom for top, bottom in ratios])  # as float(), in half the time

    @cached_property
    def _places(self) -> tuple[int, ...]:
        """For each state of the plan, its index in :data:`STATES`, the list of all possible states."""
        return tuple([STATES.index(name) for name in self.states])

    def from_start(self, initial: Initial) -> "Plan":
        """Return a plan with the same equations for another initial state of the scene.

        To save time, the rules that simplify the equations are not applied again. The state must have the same
        :func:`structure_key`; this is not checked.
        """
        scene, plan = object.__new__(Scene), object.__new__(Plan)
        scene.__dict__.update(self.scene.__dict__, initial=initial)
        plan.__dict__.update(self._shared, scene=scene)
        return plan

    @cached_property
    def _shared(self) -> dict[str, Any]:
        """The attributes that are the same for every initial state, by name; :meth:`from_start` copies them."""
        names = ("structure", "rows", "scene_constants", "states", "_places", "_start_places")
        attributes: dict[str, Any] = {name: getattr(self, name) for name in names}
        attributes["_shared"] = attributes
        return attributes


def make_plan(
    scene: Scene, initial: Initial | None = None, external_torque: bool = False, switched: bool = False
) -> Plan:
    """Return the plan of a scene: the smallest set of equations that gives its output, and the constants in them.

    Parameters
    ----------
    scene : Scene
        The scene.
    initial : Initial, optional
        Initial state; default: the initial state of the scene.
    external_torque : bool
        Whether a torque without a formula acts too: the plan then contains every state that such a torque could change.
    switched : bool
        Whether the plan may have modes: constants that replace functions such as sign, and change their values when the
        motion passes a jump or kink (switch).

    Raises
    ------
    InputError
        If a torque has jumps or kinks (step, sign, min, ..) and ``switched`` is false, because no single set of
        equations describes the whole motion. If the scene has a table of samples and ``external_torque`` is false,
        because a kernel needs formulas.
    """
    if scene.table is not None and not external_torque:
        raise InputError(
            f"{scene.name}: expected torques that are formulas, got a torque of kind table: samples have no equations "
            "to emit, certify, vary or compare; use symrot run or symrot.propagator"
        )
    if initial is not None:
        scene = replace(scene, initial=initial)
    if not switched and (name := switching_function(scene)):
        raise InputError(
            f"{scene.name}: expected torques without switches (jumps or kinks), got the function {name}: the equations "
            "change at a switch; use symrot run, symrot.propagator or symrot.propagate_ensemble"
        )
    structure = general_structure(scene, switched)
    rows = []
    for item, rule in RULES_UNDER_EXTERNAL_TORQUE if external_torque else RULES:
        outcome = rule(scene, structure)
        structure = outcome.structure
        rows.append(outcome._replace(item=item))
    return Plan(scene, structure, tuple(rows))


# --- initial states of equal structure --------------------------------------------------------------------------------


def structure_key(scene: Scene, initial: Initial) -> Hashable:
    """Return a key of an initial state; with equal keys, the equations of a scene differ only in numbers."""
    # A propagator keeps one prepared motion for each key.
    rotates_about = tuple([x.numerator != 0 for x in initial.omega_b])
    if rotates_about.count(True) > 1:
        return rotates_about
    # The body may rotate about a single axis: the rules also examine which components of the quaternion are 0, 1 or -1,
    # and which body components of torques fixed in space are zero.
    attitude = tuple([pattern(q, unit=True) for q in initial.quaternion])
    fixed = [torque for torque in scene.torques if torque.kind in DIRECTED]
    small = tuple([zero_components(torque.vector(DIRECTED[torque.kind]), initial) for torque in fixed])
    return rotates_about, attitude, small

"""The plan of a scene: the smallest set of equations that gives the requested output. Does not use SymPy.

A plan starts from the most general structure (full inertia tensor, every constant free, full attitude) and applies the
table of rules. The structure says which constants are zero, equal or free. It determines the kernel (the compiled
equations): scenes of the same structure share a kernel.
"""

from collections.abc import Hashable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from symrot.dynamics.structure import Pattern, Structure
from symrot.errors import InputError
from symrot.planning.general_structure import constants_of, general_structure, switching_function
from symrot.planning.rules import (
    DIRECTED,
    RULES,
    RULES_UNDER_EXTERNAL_TORQUE,
    RuleOutcome,
    pattern,
    small_components,
)
from symrot.scene.scene import Initial, Scene

__all__ = ["START_CONSTANTS", "STATES", "Plan", "make_plan", "structure_key"]

ZERO, FREE = Pattern.ZERO, Pattern.FREE  # a global name is looked up faster than a member of an Enum
START_CONSTANTS = frozenset({f"omega_{i}" for i in (1, 2, 3)} | {f"initial_q{i}" for i in range(4)})
"""The constants of a structure that are numbers of the initial state; all others belong to body and torques."""
STATES = ("omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3", "theta")


@dataclass(frozen=True)
class Plan:
    """The smallest set of equations that gives the output of a scene, with the values of their constants.

    Attributes
    ----------
    scene : Scene
        The problem.
    structure : Structure
        The constants that are zero, equal or free, which determine the equations.
    rows : tuple of RuleOutcome
        The decision of each rule, with its reason.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").states[:3]
    ('omega_1', 'omega_2', 'omega_3')
    """

    scene: Scene
    structure: Structure
    rows: tuple[RuleOutcome, ...]

    @cached_property
    def constants(self) -> dict[str, Fraction]:
        """The physical constants of the equations by name, exact. Modes (values of sign, abs, ..) have the value 1."""
        return self.scene_constants | self.start_constants

    @cached_property
    def scene_constants(self) -> dict[str, Fraction]:
        """The part of :attr:`constants` that does not depend on the initial state."""
        return constants_of(self.scene, self.structure)

    @property
    def start_constants(self) -> dict[str, Fraction]:
        """The part of :attr:`constants` that belongs to the initial state."""
        initial = self.scene.initial
        return {name: initial[part][place] for name, part, place in self._start_places}

    @cached_property
    def _start_places(self) -> tuple[tuple[str, int, int], ...]:
        """The names of the constants that belong to the initial state, each with its field and index in that state."""
        rates = enumerate(self.structure.constant)
        quaternion = enumerate(self.structure.initial_quaternion or ())
        return (
            *((f"omega_{i + 1}", 0, i) for i, mark in rates if mark is FREE),
            *((f"initial_q{i}", 1, i) for i, mark in quaternion if mark is FREE),
        )

    @property
    def switches(self) -> list[str]:
        """The functions with jumps or kinks in the torques, such as ``"sign(omega_3)"``, as the scene writes them.

        The list is empty if the plan does not follow jumps and kinks.
        """
        return [switch.label for torque in self.structure.formula_torques for switch in torque.switches]

    @cached_property
    def states(self) -> tuple[str, ...]:
        """The names of the states, in the order of the kernel: angular velocity, then attitude."""
        structure, axis = self.structure, self.structure.planar
        names = [f"omega_{i + 1}" for i in structure.moving]
        if structure.attitude:
            if axis is None:
                names += ["q0", "q1", "q2", "q3"]
            elif structure.constant[axis] is not ZERO:
                names.append("theta")
        return tuple(names)

    @cached_property
    def initial_state(self) -> tuple[float, ...]:
        """The initial values of :attr:`states`, in the same order."""
        start = self.scene.initial
        values = (*start.omega_b, *start.quaternion, 0)
        ratios = [values[place].as_integer_ratio() for place in self._places]
        return tuple([top / bottom for top, bottom in ratios])  # as float(), in half the time

    @cached_property
    def _places(self) -> tuple[int, ...]:
        """The index of each state in the list omega_1..3, q0..3, angle of a planar rotation."""
        return tuple([STATES.index(name) for name in self.states])

    def from_start(self, initial: Initial) -> "Plan":
        """Return the plan of the same scene and structure for another initial state, without applying the rules again.

        ``initial`` must have the same :func:`structure_key` as the initial state of this plan.
        """
        scene, plan = object.__new__(Scene), object.__new__(Plan)
        scene.__dict__.update(self.scene.__dict__, initial=initial)
        plan.__dict__.update(self._shared, scene=scene)
        return plan

    @cached_property
    def _shared(self) -> dict[str, Any]:
        """The attributes, by name, that do not change if only the initial state of the plan changes."""
        names = ("structure", "rows", "scene_constants", "states", "_places", "_start_places")
        attributes: dict[str, Any] = {name: getattr(self, name) for name in names}
        attributes["_shared"] = attributes
        return attributes


def make_plan(
    scene: Scene, initial: Initial | None = None, external_torque: bool = False, switched: bool = False
) -> Plan:
    """Return the plan of a scene, or of the scene with another initial state.

    Parameters
    ----------
    scene : Scene
        The problem.
    initial : Initial, optional
        Initial state to use instead of the scene's.
    external_torque : bool
        Whether a torque without a formula acts too: the plan then keeps everything that such a torque could change.
    switched : bool
        Whether the plan may have modes: values of functions such as sign, which change when the motion passes a switch.

    Raises
    ------
    InputError
        If a torque has switches (step, sign, min, ..) and ``switched`` is false, because no single set of equations
        holds throughout. If the scene has a table of samples and ``external_torque`` is false, because a kernel needs
        formulas.
    """
    if scene.table is not None and not external_torque:
        raise InputError(
            f"{scene.name}: expected torques that are formulas, got one of kind table: samples have no equations to "
            "emit, certify, vary or compare; symrot run and symrot.propagator follow them"
        )
    if initial is not None:
        scene = replace(scene, initial=initial)
    if not switched and (name := switching_function(scene)):
        raise InputError(
            f"{scene.name}: expected torques without switches (jumps or kinks), got the function {name}: the equations "
            "change from one mode to the next; symrot run, symrot.propagator and symrot.propagate_ensemble follow them"
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
    """Return a key that is equal for initial states whose plans differ only in numbers.

    The key says which components of omega are zero. If the body may rotate about a single axis, it also says which
    components of the attitude are zero or one, and along which body axes the torques fixed in space lie.
    """
    rotates_about = tuple([x.numerator != 0 for x in initial.omega_b])
    if rotates_about.count(True) > 1:
        return rotates_about
    attitude = tuple([pattern(q, unit=True) for q in initial.quaternion])
    fixed = [torque for torque in scene.torques if torque.kind in DIRECTED]
    small = tuple([small_components(torque.vector(DIRECTED[torque.kind]), initial) for torque in fixed])
    return rotates_about, attitude, small

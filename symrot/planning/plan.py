"""The plan of a scene: the smallest set of equations that gives the requested output. Does not use SymPy.

A plan starts from the most general structure (full inertia tensor, every constant free, full attitude) and applies a
table of rules. Each rule examines exact numbers, simplifies the structure or leaves it unchanged, and names the
derivation that justifies the change. The structure says which constants are zero, equal or free. It determines the
kernel (the compiled equations): scenes of the same structure share a kernel.
"""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from symrot.dynamics.structure import (
    MOVING,
    FieldPattern,
    FieldTorque,
    FormulaTorque,
    InertiaTensor,
    Pattern,
    PrincipalInertia,
    Structure,
    TorqueStructure,
    TorqueSwitch,
    component_names,
)
from symrot.errors import InputError
from symrot.formula import tree as expression
from symrot.formula.exact_numbers import NEGLIGIBLE, equal
from symrot.formula.switches import Switch, blended, has_choices, has_switches, smooth
from symrot.scene.scene import Initial, Scene
from symrot.scene.torque import Torque

__all__ = [
    "ATTITUDE_QUANTITIES", "RULES", "START_CONSTANTS", "STATES", "Plan", "RuleOutcome", "general_structure",
    "make_plan", "structure_key", "switched",
]  # fmt: skip

ZERO, ONE, MINUS_ONE, FREE = Pattern  # a global name is looked up faster than a member of an Enum

ATTITUDE_QUANTITIES = frozenset(
    {"quaternion", "euler", "dcm", "omega_space", "herpolhode", "angular_momentum_space", "axis"}
)
PRODUCTS = {"I_xy": (0, 1), "I_xz": (0, 2), "I_yz": (1, 2)}
MOMENTS = {"I_xx": (0, 0), "I_yy": (1, 1), "I_zz": (2, 2)}
NEVER_NEEDS_ATTITUDE = ("constant_body", "damping", "rotor")
DIRECTED = {"constant_space": "torque", "gravity": "direction"}  # torques fixed in space: the field with the vector
UNIT_FIELDS = ("direction", "attitude")  # fields in which a component equal to one counts as a special value
START_CONSTANTS = frozenset({f"omega_{i}" for i in (1, 2, 3)} | {f"initial_q{i}" for i in range(4)})
"""The constants of a structure that are numbers of the initial state; all others belong to body and torques."""
RESERVED = frozenset(
    {"t", "theta", "pi", *"ABC", *MOMENTS, *PRODUCTS}
    | {f"{name}_{i}" for name in ("omega", "L", "M", "radius", "initial_q") for i in range(4)}
    | {f"q{i}" for i in range(4)} | {f"initial_q{i}" for i in range(4)}
)  # fmt: skip


STATES = ("omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3", "theta")


class RuleOutcome(NamedTuple):
    """The decision of one rule of a plan, printed as one line when a plan is explained.

    Attributes
    ----------
    structure : Structure
        The structure after the rule.
    skipped : bool
        Whether the rule removed something from the equations.
    why : str
        The reason.
    derivation : str
        Name of the derivation that justifies the decision; empty if the requested output alone decides.
    item : str
        The subject of the rule, from the table of rules; empty in the outcome that the rule itself returns.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").rows[0].skipped
    True
    """

    structure: Structure
    skipped: bool
    why: str
    derivation: str = ""
    item: str = ""


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
        return _scene_constants(self.scene, self.structure)

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
    if not switched and (name := _switching_function(scene)):
        raise InputError(
            f"{scene.name}: expected torques without switches (jumps or kinks), got the function {name}: the equations "
            "change from one mode to the next; symrot run, symrot.propagator and symrot.propagate_ensemble follow them"
        )
    structure = general_structure(scene, switched)
    rows = []
    for item, rule in _RULES_UNDER_EXTERNAL_TORQUE if external_torque else RULES:
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
    pattern = tuple([_pattern(q, unit=True) for q in initial.quaternion])
    fixed = [torque for torque in scene.torques if torque.kind in DIRECTED]
    small = tuple([_small_components(torque.vector(DIRECTED[torque.kind]), initial) for torque in fixed])
    return rotates_about, pattern, small


# --- the general structure --------------------------------------------------------------------------------------------


def switched(scene: Scene) -> bool:
    """Return whether a torque of a scene has a jump or a kink, such as ``sign`` or ``abs``, that may be reached."""
    return any(
        has_switches(expression.parse(formula, switching=True))
        for torque in scene.torques
        for formula in torque.formulas
    )


def _switching_function(scene: Scene) -> str:
    """Return the name of a function with a jump or kink in the torques of a scene, or an empty text."""
    calls = {
        name
        for torque in scene.torques
        for formula in torque.formulas
        for name in expression.operations(expression.parse(formula, switching=True))
    }
    return min(calls & set(expression.SWITCHING), default="")


def general_structure(scene: Scene, switched: bool = False) -> Structure:
    """Return the structure before any rule is applied: full tensor, free constants of every torque, full attitude."""
    names: set[str] = set(RESERVED)
    torques = [_general_torque(number, torque, names, switched) for number, torque in enumerate(scene.torques, start=1)]
    return Structure(InertiaTensor(tuple(sorted([*MOMENTS, *PRODUCTS]))), tuple(torques))


def _general_torque(number: int, torque: Torque, known: set[str], switched: bool) -> TorqueStructure:
    """Return the structure of one torque with all constants free; the constants' names are added to ``known``."""
    if torque.formulas:
        general = _formula_torque(torque, switched)
        prefix = _prefix(number, list(general.parameters), known)
        return general._replace(prefix=prefix)
    fields: list[tuple[str, FieldPattern]] = [
        (name, (FREE,) * len(value) if isinstance(value, tuple) else FREE) for name, value in torque.values.items()
    ]
    prefix = _prefix(number, [name for field in fields for name in component_names(*field)], known)
    return FieldTorque(torque.kind, prefix, tuple(fields))


def _formula_torque(torque: Torque, switched: bool) -> FormulaTorque:
    """Return the structure of a torque given by formulas; its constants keep their names in the scene."""
    formulas, parameters, frame = torque.formulas, tuple(torque.values), torque.frame
    if not (switched and any(has_switches(expression.parse(text, switching=True)) for text in formulas)):
        return FormulaTorque("", formulas, parameters, frame)
    form = smooth(formulas)
    choices = any(map(has_choices, (*form.formulas, *(switch.guard for switch in form.switches))))
    return FormulaTorque(
        "",
        tuple([expression.text(blended(node)) for node in form.formulas]),
        (*parameters, *(switch.mode for switch in form.switches)),
        frame,
        tuple(map(_switch, form.switches)),
        tuple(map(expression.text, form.formulas)) if choices else (),
    )


def _switch(switch: Switch) -> TorqueSwitch:
    where = tuple([(expression.text(share), value) for share, value in switch.where])
    guard = expression.text(blended(switch.guard))
    choices = expression.text(switch.guard) if has_choices(switch.guard) else ""
    return TorqueSwitch(switch.mode, switch.kind, guard, where, switch.label, switch.at_zero, choices)


def _prefix(number: int, names: list[str], known: set[str]) -> str:
    """Return a prefix that makes the names of a torque's constants unique; the new names are added to ``known``."""
    prefix = ""
    while known & {f"{prefix}{name}" for name in names}:
        prefix = f"{prefix}_" if prefix else f"torque{number}_"
    known |= {f"{prefix}{name}" for name in names}
    return prefix


def _pattern(value: Fraction, unit: bool) -> Pattern:
    top, bottom = value.as_integer_ratio()
    if not top:
        return ZERO
    if unit and bottom == 1 == abs(top):
        return ONE if top > 0 else MINUS_ONE
    return FREE


def _scene_constants(scene: Scene, structure: Structure) -> dict[str, Fraction]:
    inertia, pattern = scene.body.inertia, structure.inertia
    constants: dict[str, Fraction] = {}
    if isinstance(pattern, PrincipalInertia):
        for i, letter in enumerate(pattern.moments):
            constants.setdefault(letter, inertia[i][i])
    else:
        places = MOMENTS | PRODUCTS
        constants = {name: inertia[places[name][0]][places[name][1]] for name in pattern.entries}
    for torque, scene_torque in zip(structure.torques, scene.torques, strict=True):
        prefix = torque.prefix
        if isinstance(torque, FormulaTorque):
            constants |= {f"{prefix}{name}": scene_torque.number(name) for name in scene_torque.values}
            constants |= {f"{prefix}{switch.mode}": Fraction(1) for switch in torque.switches}
            continue
        for name, field in torque.fields:
            if isinstance(field, Pattern):
                constants |= {f"{prefix}{name}": scene_torque.number(name)} if field is FREE else {}
                continue
            vector = scene_torque.vector(name)
            for component, entry, mark in zip(component_names(name, field), vector, field, strict=True):
                constants |= {f"{prefix}{component}": entry} if mark is FREE else {}
    return constants


# --- the rules --------------------------------------------------------------------------------------------------------


def _products_of_inertia(scene: Scene, structure: Structure) -> RuleOutcome:
    inertia = scene.body.inertia
    nonzero = [name for name, (i, j) in PRODUCTS.items() if inertia[i][j] != 0]
    if nonzero:
        tensor = InertiaTensor(tuple(sorted([*MOMENTS, *nonzero])))
        zero = [name for name in PRODUCTS if name not in nonzero]
        why = f"only {', '.join(zero)} {'is' if len(zero) == 1 else 'are'} zero" if zero else "none of them is zero"
        return RuleOutcome(replace(structure, inertia=tensor), len(nonzero) < 3, why, "euler_equations")
    why = "the axes of the body are principal axes"
    return RuleOutcome(replace(structure, inertia=PrincipalInertia()), True, why, "euler_equations")


def _equal_moments(scene: Scene, structure: Structure) -> RuleOutcome:
    if not isinstance(structure.inertia, PrincipalInertia):
        return RuleOutcome(structure, False, "products of inertia are not zero")
    moments = [scene.body.inertia[i][i] for i in range(3)]
    letters = ""
    for number, moment in enumerate(moments):
        same = next((j for j in range(number) if equal(moments[j], moment)), number)
        letters += letters[same] if same < number else "ABC"[number]
    if letters == "ABC":
        return RuleOutcome(structure, False, "three different principal moments")
    why = "three equal moments" if letters == "AAA" else f"two equal moments: {scene.body.principal.kind} body"
    return RuleOutcome(replace(structure, inertia=PrincipalInertia(letters)), True, why, "symmetric_top")


def _special_constants(scene: Scene, structure: Structure) -> RuleOutcome:
    torques: list[TorqueStructure] = []
    special: dict[Pattern, list[str]] = {ZERO: [], ONE: [], MINUS_ONE: [], FREE: []}
    silent: list[str] = []
    for torque, scene_torque in zip(structure.torques, scene.torques, strict=True):
        if isinstance(torque, FormulaTorque):
            torques.append(torque)
            silent += _silent(torque, scene_torque)
            continue
        fields: list[tuple[str, FieldPattern]] = []
        for name, general in torque.fields:
            value, unit = scene_torque.values[name], name in UNIT_FIELDS
            entries = value if isinstance(value, tuple) else (value,)
            marks = tuple([_pattern(entry, unit) for entry in entries])
            fields.append((name, marks if isinstance(value, tuple) else marks[0]))
            for component, mark in zip(component_names(name, general), marks, strict=True):
                special[mark].append(component)
        torques.append(torque._replace(fields=tuple(fields)))
    if not structure.torques:
        return RuleOutcome(structure, True, "no torque acts: Euler's equations are free", "euler_equations")
    del special[FREE]
    reasons = [f"{', '.join(names)} = {mark.value}" for mark, names in special.items() if names] + silent
    why = "; ".join(reasons) or "no component of a torque is exactly zero"
    return RuleOutcome(replace(structure, torques=tuple(torques)), bool(reasons), why)


def _silent(torque: FormulaTorque, scene_torque: Torque) -> list[str]:
    """Return a list with one sentence that names the axes about which formulas give no torque, or an empty list."""
    axes = [str(i + 1) for i, formula in enumerate(scene_torque.formulas) if _is_zero(formula)]
    if not axes:
        return []
    listed = f"axis {axes[0]}" if len(axes) == 1 else f"axes {', '.join(axes[:-1])} and {axes[-1]}"
    return [f"the formulas give no torque about {torque.frame} {listed}"]


def _is_zero(formula: str) -> bool:
    """Return whether a formula is the number zero."""
    node = expression.parse(formula, switching=True)
    if expression.names(node):
        return False
    try:
        return bool(expression.evaluate(node, {}) == 0)
    except KeyError:  # a function of a number
        return False


def _depends_on_attitude(torque: TorqueStructure) -> bool:
    if isinstance(torque, FormulaTorque):
        sources = [*torque.formulas, *(switch.guard for switch in torque.switches)]
        used = set().union(*(expression.names(expression.parse(source)) for source in sources))
        return torque.frame == "space" or bool(used & {"q0", "q1", "q2", "q3"})
    return torque.kind not in NEVER_NEEDS_ATTITUDE


def _attitude(scene: Scene, structure: Structure) -> RuleOutcome:
    requested = [name for name in scene.output.quantities if name in ATTITUDE_QUANTITIES]
    if requested:
        return RuleOutcome(structure, False, f"the output asks for {', '.join(requested)}", "quaternion_rates")
    kinds = [torque.kind for torque in structure.torques if _depends_on_attitude(torque)]
    if kinds:
        return RuleOutcome(structure, False, f"the torque {', '.join(kinds)} depends on it", "quaternion_rates")
    why = "neither a torque nor the output needs it"
    return RuleOutcome(replace(structure, attitude=False), True, why, "attitude_not_needed")


def _only_along(vector: tuple[Pattern, ...], axis: int) -> bool:
    """Return whether a vector lies along a body axis: its other two components are zero."""
    return all(vector[i] is ZERO for i in range(3) if i != axis)


def _torque_along(torque: TorqueStructure, axis: int, scene: Scene, scene_torque: Torque) -> bool:
    """Return whether a torque always lies along a body axis while the body rotates about that axis alone."""
    if isinstance(torque, FormulaTorque):
        return False
    if torque.kind == "constant_body":
        return _only_along(torque.vector("torque"), axis)
    if torque.kind == "rotor":
        return _only_along(torque.vector("angular_momentum"), axis)
    if torque.kind == "constant_space":
        return _lies_along(scene_torque.vector("torque"), axis, scene)
    if torque.kind == "gravity":  # a pendulum: level axis, centre of mass off the axis
        level = _small_components(scene_torque.vector("direction"), scene.initial)[axis]
        return level and torque.vector("center_of_mass")[axis] is ZERO
    return torque.kind == "damping"


def _in_body(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[Fraction, ...]:
    """Return the body components of a vector, given in space components, at the initial attitude."""
    q0, *q = initial.quaternion
    twice = [2 * sum(a * b for a, b in zip(q, vector_s, strict=True)) * c for c in q]
    turned = (
        q[1] * vector_s[2] - q[2] * vector_s[1], q[2] * vector_s[0] - q[0] * vector_s[2],
        q[0] * vector_s[1] - q[1] * vector_s[0],
    )  # fmt: skip
    scalar = q0 * q0 - sum(a * a for a in q)
    return tuple(scalar * v + t - 2 * q0 * c for v, t, c in zip(vector_s, twice, turned, strict=True))


CLEARLY = 1e-12  # part of a vector: a larger component is certainly not zero when computed in doubles


def _negligible(value: Fraction, vector: tuple[Fraction, ...]) -> bool:
    return abs(value) <= max(map(abs, vector)) * NEGLIGIBLE


def _small_components(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[bool, ...]:
    """Return which body components of a vector are zero, to 2^-200, at the initial attitude.

    The vector is given in space components.
    """
    if _all_large(vector_s, initial):
        return False, False, False
    vector = _in_body(vector_s, initial)
    return tuple([_negligible(component, vector) for component in vector])


def _all_large(vector_s: tuple[Fraction, ...], initial: Initial) -> bool:
    """Return whether double precision suffices to prove that no body component of a vector is zero.

    The test takes a tenth of the time of exact arithmetic.
    """
    ratios = [x.as_integer_ratio() for x in (*initial.quaternion, *vector_s)]
    q0, q1, q2, q3, x, y, z = [top / bottom for top, bottom in ratios]
    along, scalar = 2 * (q1 * x + q2 * y + q3 * z), q0 * q0 - q1 * q1 - q2 * q2 - q3 * q3
    least = CLEARLY * (abs(x) + abs(y) + abs(z))
    return (
        abs(scalar * x + along * q1 - 2 * q0 * (q2 * z - q3 * y)) > least
        and abs(scalar * y + along * q2 - 2 * q0 * (q3 * x - q1 * z)) > least
        and abs(scalar * z + along * q3 - 2 * q0 * (q1 * y - q2 * x)) > least
    )


def _lies_along(vector_s: tuple[Fraction, ...], axis: int, scene: Scene) -> bool:
    small = _small_components(vector_s, scene.initial)
    return all(small[i] for i in range(3) if i != axis)


def _one_axis(scene: Scene, structure: Structure) -> RuleOutcome:
    omega_b = scene.initial.omega_b
    if not isinstance(structure.inertia, PrincipalInertia):
        return RuleOutcome(structure, False, "the axes of the body are not principal axes")
    rotates_about = [i for i in range(3) if omega_b[i] != 0]
    axes = rotates_about if len(rotates_about) == 1 else [] if rotates_about else [0, 1, 2]
    pairs = list(zip(structure.torques, scene.torques, strict=True))
    along = [
        axis for axis in axes if all(_torque_along(torque, axis, scene, scene_torque) for torque, scene_torque in pairs)
    ]
    if not along:
        why = "the body does not rotate about one principal axis only"
        if axes and any(structure.formula_torques):
            why = "a torque given by formulas is assumed to change the axis of rotation"
        return RuleOutcome(structure, False, why)
    axis = along[0]
    start = tuple([_pattern(q, unit=True) for q in scene.initial.quaternion]) if structure.attitude else None
    constant = _constant(scene, axis) if all(torque.kind == "rotor" for torque in structure.torques) else MOVING
    planar = replace(structure, planar=axis, initial_quaternion=start, constant=constant)
    why = f"omega and torque stay along principal axis {axis + 1}: the attitude is one angle"
    return RuleOutcome(planar, True, why, "planar_motion")


def _constant_spin(scene: Scene, structure: Structure) -> RuleOutcome:
    if structure.planar is not None:
        return RuleOutcome(structure, False, "already one axis")
    if not isinstance(structure.inertia, PrincipalInertia):
        return RuleOutcome(structure, False, "the axes of the body are not principal axes")
    letters = structure.inertia.moments
    if letters == "AAA" and not structure.torques:
        why = "a spherical body without torque keeps its angular velocity"
        return RuleOutcome(replace(structure, constant=_constant(scene, 0, 1, 2)), True, why, "spherical_body")
    for axis in range(3):
        others = [letters[i] for i in range(3) if i != axis]
        if others[0] == others[1] and all(_no_moment_about(torque, axis) for torque in structure.torques):
            why = f"equal moments about the other axes and no torque about axis {axis + 1}"
            if scene.initial.omega_b[axis] == 0 and not structure.torques:
                why += ", and no spin: the body rotates steadily about an axis across"
                return RuleOutcome(replace(structure, constant=_constant(scene, 0, 1, 2)), True, why, "symmetric_spin")
            return RuleOutcome(replace(structure, constant=_constant(scene, axis)), True, why, "symmetric_spin")
    return RuleOutcome(structure, False, "no symmetry axis about which no torque acts")


def _constant(scene: Scene, *axes: int) -> tuple[Pattern | None, Pattern | None, Pattern | None]:
    """Return, for each component of omega_b, its pattern (zero or free) if it is constant, otherwise None.

    ``axes`` are the indices of the constant components.
    """
    first, second, third = (
        _pattern(w, unit=False) if axis in axes else None for axis, w in enumerate(scene.initial.omega_b)
    )
    return first, second, third


def _no_moment_about(torque: TorqueStructure, axis: int) -> bool:
    """Return whether a torque has no component along the symmetry axis of the body in any motion."""
    if isinstance(torque, FormulaTorque):
        return torque.frame == "body" and torque.formulas[axis].strip() in ("0", "0.0")
    if torque.kind == "constant_body":
        return torque.vector("torque")[axis] is ZERO
    if torque.kind == "damping":
        return torque.vector("linear")[axis] is ZERO and torque.number("quadratic") is ZERO
    if torque.kind == "gravity":
        return _only_along(torque.vector("center_of_mass"), axis)
    if torque.kind == "rotor":
        return _only_along(torque.vector("angular_momentum"), axis)
    return torque.kind == "gravity_gradient"


RULES: tuple[tuple[str, Callable[[Scene, Structure], RuleOutcome]], ...] = (
    ("products of inertia", _products_of_inertia),
    ("unequal moments", _equal_moments),
    ("torque terms", _special_constants),
    ("attitude", _attitude),
    ("rotation out of one axis", _one_axis),
    ("rate of spin", _constant_spin),
)
"""The rules in the order of their application: (subject, rule)."""


def _whole_motion(scene: Scene, structure: Structure) -> RuleOutcome:
    why = "a torque without a formula may depend on it, and on all components of omega"
    return RuleOutcome(structure, False, why)


def _terms_under_external_torque(scene: Scene, structure: Structure) -> RuleOutcome:
    if not scene.torques:
        return RuleOutcome(structure, False, "the only torque has no formula")
    return _special_constants(scene, structure)


_RULES_UNDER_EXTERNAL_TORQUE: tuple[tuple[str, Callable[[Scene, Structure], RuleOutcome]], ...] = (
    *RULES[:2],
    ("torque terms", _terms_under_external_torque),
    ("attitude", _whole_motion),
)

"""Skip what a scene does not need: from a scene to the least set of equations that answers it. No SymPy.

A plan starts from the most general structure (full tensor, every constant free, full attitude) and applies a table of
rules. Each rule looks at exact numbers, changes the structure or leaves it, and names the derivation that justifies
it. The structure, not the numbers, decides which kernel is needed: a second scene of the same structure has it already.
"""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from symrot.errors import InputError
from symrot.formula import tree as expression
from symrot.formula.exact_numbers import equal
from symrot.formula.switches import Switch, blended, has_choices, has_switches, smooth
from symrot.scene.scene import Initial, Scene

__all__ = [
    "ATTITUDE_QUANTITIES", "RULES", "START_CONSTANTS", "STATES", "Plan", "Row", "general_structure", "make_plan",
    "structure_key", "switched",
]  # fmt: skip

Structure = dict[str, Any]

ATTITUDE_QUANTITIES = frozenset(
    {"quaternion", "euler", "dcm", "omega_space", "herpolhode", "angular_momentum_space", "axis"}
)
PRODUCTS = {"I_xy": (0, 1), "I_xz": (0, 2), "I_yz": (1, 2)}
MOMENTS = {"I_xx": (0, 0), "I_yy": (1, 1), "I_zz": (2, 2)}
NEVER_NEEDS_ATTITUDE = ("constant_body", "damping", "rotor")
DIRECTED = {"constant_space": "torque", "gravity": "direction"}  # fixed in space: the field that says along what
UNIT_FIELDS = ("direction", "attitude")  # fields whose components may be exactly one
START_CONSTANTS = frozenset({f"omega_{i}" for i in (1, 2, 3)} | {f"initial_q{i}" for i in range(4)})
"""The constants of a structure that are numbers of the initial state; all others are the scene's."""
RESERVED = frozenset(
    {"t", "theta", "pi", *"ABC", *MOMENTS, *PRODUCTS}
    | {f"{name}_{i}" for name in ("omega", "L", "M", "radius", "initial_q") for i in range(4)}
    | {f"q{i}" for i in range(4)} | {f"initial_q{i}" for i in range(4)}
)  # fmt: skip


STATES = ("omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3", "theta")


@dataclass(frozen=True)
class Row:
    """One line of an explained plan: what it is about, whether it is skipped, and why."""

    item: str
    skipped: bool
    why: str
    derivation: str  # name of the derivation that justifies it, "" where it is a matter of what was asked
    structure: Structure  # after this rule


@dataclass(frozen=True)
class Plan:
    """The least set of equations for a scene, with the numbers that go into it."""

    scene: Scene
    structure: Structure
    rows: tuple[Row, ...]

    @cached_property
    def constants(self) -> dict[str, Fraction]:
        """The physical constants of the structure by name, exact; modes of switches are 1."""
        return self.scene_constants | self.start_constants

    @cached_property
    def scene_constants(self) -> dict[str, Fraction]:
        """Those of :attr:`constants` that do not depend on the initial state."""
        return _scene_constants(self.scene, self.structure)

    @property
    def start_constants(self) -> dict[str, Fraction]:
        """Those of :attr:`constants` that are numbers of the initial state."""
        initial = self.scene.initial
        return {name: initial[part][place] for name, part, place in self._start_places}

    @cached_property
    def _start_places(self) -> tuple[tuple[str, int, int], ...]:
        """The names of those constants, and where in an initial state each stands."""
        kept, start = self.structure["constant"].items(), enumerate(self.structure["initial_quaternion"] or ())
        found = [(f"omega_{i + 1}", 0, i) for i, mark in kept if mark == "*"]
        return (*found, *((f"initial_q{i}", 1, i) for i, mark in start if mark == "*"))

    @property
    def switches(self) -> list[str]:
        """The functions that switch in the torques of a plan whose modes may change, as they are written."""
        return [switch["label"] for torque in self.structure["torques"] for switch in torque.get("switches", ())]

    @cached_property
    def states(self) -> tuple[str, ...]:
        """The names of the states, in the order of the kernel: angular velocity, then attitude."""
        axis = self.structure["planar"]
        moving = [i for i in range(3) if i not in self.structure["constant"] and axis in (None, i)]
        names = [f"omega_{i + 1}" for i in moving]
        if self.structure["attitude"]:
            turning = [] if self.structure["constant"].get(axis) == "0" else ["theta"]
            names += ["q0", "q1", "q2", "q3"] if axis is None else turning
        return tuple(names)

    @cached_property
    def initial_state(self) -> tuple[float, ...]:
        """The initial values of :attr:`states`."""
        start = self.scene.initial
        values = (*start.omega_b, *start.quaternion, 0)
        ratios = [values[place].as_integer_ratio() for place in self._places]
        return tuple([top / bottom for top, bottom in ratios])  # as float(), at half the price

    @cached_property
    def _places(self) -> tuple[int, ...]:
        """Where each state stands among omega, attitude and the angle of a planar rotation."""
        return tuple([STATES.index(name) for name in self.states])

    def from_start(self, initial: Initial) -> "Plan":
        """Return the plan of the same scene and structure from another initial state.

        ``initial`` must have the :func:`structure_key` of the plan's own: nothing is decided anew.
        """
        scene, plan = object.__new__(Scene), object.__new__(Plan)
        scene.__dict__.update(self.scene.__dict__, initial=initial)
        plan.__dict__.update(self._shared, scene=scene)
        return plan

    @cached_property
    def _shared(self) -> dict[str, Any]:
        """What plans from other starts take over, by name."""
        names = ("structure", "rows", "scene_constants", "states", "_places", "_start_places")
        found: dict[str, Any] = {name: getattr(self, name) for name in names}
        found["_shared"] = found
        return found


def make_plan(scene: Scene, initial: Initial | None = None, driven: bool = False, switched: bool = False) -> Plan:
    """Return the plan of a scene, perhaps with another initial state.

    Parameters
    ----------
    scene : Scene
        The problem.
    initial : Initial, optional
        Instead of the scene's own.
    driven : bool
        Whether a torque acts too that is no formula: nothing is left out that it could change.
    switched : bool
        Whether the plan may have modes, which whoever follows it changes where a switch is passed.

    Raises
    ------
    InputError
        If a torque has switches (step, sign, min, ..) and ``switched`` is false: there are no equations that hold all
        along. If the scene has a table of samples and ``driven`` is false: it is no formula to derive a kernel from.
    """
    if scene.table is not None and not driven:
        raise InputError(
            f"{scene.name}: expected torques that are formulas, got one of kind table: samples have no equations to "
            "emit, certify, vary or compare; symrot run and symrot.propagator follow them"
        )
    if initial is not None:
        scene = replace(scene, initial=initial)
    if not switched and (name := _switching_function(scene)):
        raise InputError(
            f"{scene.name}: expected torques without switches, got the function {name}: the equations change from one "
            "mode to the next; symrot run, symrot.propagator and symrot.propagate_ensemble follow them"
        )
    structure = general_structure(scene, switched)
    rows = []
    for item, rule in _RULES_WHEN_DRIVEN if driven else RULES:
        structure, skipped, why, derivation = rule(scene, structure)
        rows.append(Row(item, skipped, why, derivation, structure))
    return Plan(scene, structure, tuple(rows))


# --- which starts have one structure ----------------------------------------------------------------------------------


def structure_key(scene: Scene, initial: Initial) -> Hashable:
    """Return what the rules look at in an initial state: starts of one key have plans that differ in numbers alone.

    That is which components of omega are zero. A body that may rotate about one axis only is looked at more closely: by
    the components of its attitude that are zero or one, and by the axes along which torques fixed in space lie.
    """
    turning = tuple([x.numerator != 0 for x in initial.omega_b])
    if turning.count(True) > 1:
        return turning
    pattern = tuple([_pattern(q, unit=True) for q in initial.quaternion])
    fixed = [torque for torque in scene.torques if torque.kind in DIRECTED]
    lying = tuple([_small_components(torque.values[DIRECTED[torque.kind]], initial) for torque in fixed])
    return turning, pattern, lying


# --- the general structure --------------------------------------------------------------------------------------------


def switched(scene: Scene) -> bool:
    """Return whether a torque of a scene jumps or bends where what changes passes some value."""
    return any(
        has_switches(expression.parse(formula, switching=True))
        for torque in scene.torques
        if torque.kind == "expression"
        for formula in torque.values["torque"]
    )


def _switching_function(scene: Scene) -> str:
    """Return a function in the torques of a scene that is known to those alone who follow switches, or nothing."""
    calls = {
        name
        for torque in scene.torques
        if torque.kind == "expression"
        for formula in torque.values["torque"]
        for name in expression.operations(expression.parse(formula, switching=True))
    }
    return min(calls & set(expression.SWITCHING), default="")


def general_structure(scene: Scene, switched: bool = False) -> Structure:
    """Return the structure before any rule: full tensor, every constant of every torque free, full attitude."""
    taken: set[str] = set(RESERVED)
    return {
        "inertia": {"form": "tensor", "entries": sorted([*MOMENTS, *PRODUCTS])},
        "torques": [
            _general_torque(number, torque, taken, switched) for number, torque in enumerate(scene.torques, start=1)
        ],
        "attitude": True,
        "planar": None,
        "initial_quaternion": None,
        "constant": {},
    }


def _general_torque(number: int, torque: Any, taken: set[str], switched: bool) -> Structure:
    if torque.kind == "expression":
        names, formulas = list(torque.values["parameters"]), list(torque.values["torque"])
        found: Structure = {"formulas": formulas, "parameters": names, "frame": torque.values["frame"]}
        if switched and any(has_switches(expression.parse(text, switching=True)) for text in formulas):
            form = smooth(tuple(formulas))
            names += [switch.mode for switch in form.switches]
            choices = any(map(has_choices, (*form.formulas, *(switch.guard for switch in form.switches))))
            found |= {
                "formulas": [expression.text(blended(node)) for node in form.formulas],
                "switches": [_switch(switch) for switch in form.switches],
                **({"choices": [expression.text(node) for node in form.formulas]} if choices else {}),
            }
    else:
        fields = {
            name: ["*"] * len(value) if isinstance(value, tuple) else "*"
            for name, value in torque.values.items()
            if value is not None
        }
        names, found = [name for field in fields.items() for name in _component_names(*field)], {"fields": fields}
    prefix = ""
    while taken & {f"{prefix}{name}" for name in names}:
        prefix = f"{prefix}_" if prefix else f"torque{number}_"
    taken |= {f"{prefix}{name}" for name in names}
    return {"kind": torque.kind, "prefix": prefix, **found}


def _switch(switch: Switch) -> Structure:
    where = [[expression.text(share), value] for share, value in switch.where]
    guard = expression.text(blended(switch.guard))
    choices = {"choices": expression.text(switch.guard)} if has_choices(switch.guard) else {}
    return {**switch._asdict(), "guard": guard, "where": where, **choices}


def _component_names(name: str, pattern: str | list[str]) -> list[str]:
    """Return the names of the constants of one field: a vector is numbered from 1, a quaternion from 0."""
    if isinstance(pattern, str):
        return [name]
    return [f"{name}_{index}" for index, _ in enumerate(pattern, start=0 if len(pattern) == 4 else 1)]


def _pattern(value: Fraction, unit: bool) -> str:
    top, bottom = value.as_integer_ratio()
    return "0" if not top else str(value) if unit and bottom == 1 == abs(top) else "*"


def _scene_constants(scene: Scene, structure: Structure) -> dict[str, Fraction]:
    inertia = scene.body.inertia
    found: dict[str, Fraction] = {}
    if structure["inertia"]["form"] == "principal":
        for letter, number in zip(structure["inertia"]["moments"], range(3), strict=True):
            found.setdefault(letter, inertia[number][number])
    else:
        places = MOMENTS | PRODUCTS
        found = {name: inertia[places[name][0]][places[name][1]] for name in structure["inertia"]["entries"]}
    for torque, given in zip(structure["torques"], scene.torques, strict=True):
        prefix = torque["prefix"]
        if given.kind == "expression":
            found |= {f"{prefix}{name}": value for name, value in given.values["parameters"].items()}
            found |= {f"{prefix}{switch['mode']}": Fraction(1) for switch in torque.get("switches", ())}
            continue
        for name, pattern in torque["fields"].items():
            value = given.values[name]
            if isinstance(pattern, str):
                found |= {f"{prefix}{name}": value} if pattern == "*" else {}
                continue
            for component, entry, mark in zip(_component_names(name, pattern), value, pattern, strict=True):
                found |= {f"{prefix}{component}": entry} if mark == "*" else {}
    return found


# --- the rules --------------------------------------------------------------------------------------------------------

Outcome = tuple[Structure, bool, str, str]


def _products_of_inertia(scene: Scene, structure: Structure) -> Outcome:
    inertia = scene.body.inertia
    kept = [name for name, (i, j) in PRODUCTS.items() if inertia[i][j] != 0]
    if kept:
        entries = sorted([*MOMENTS, *kept])
        zero = [name for name in PRODUCTS if name not in kept]
        why = f"only {', '.join(zero)} {'is' if len(zero) == 1 else 'are'} zero" if zero else "none of them is zero"
        return structure | {"inertia": {"form": "tensor", "entries": entries}}, len(kept) < 3, why, "euler_equations"
    why = "the axes of the body are principal axes"
    return structure | {"inertia": {"form": "principal", "moments": "ABC"}}, True, why, "euler_equations"


def _equal_moments(scene: Scene, structure: Structure) -> Outcome:
    if structure["inertia"]["form"] != "principal":
        return structure, False, "products of inertia are not zero", ""
    moments = [scene.body.inertia[i][i] for i in range(3)]
    letters = ""
    for number, moment in enumerate(moments):
        same = next((j for j in range(number) if equal(moments[j], moment)), number)
        letters += letters[same] if same < number else "ABC"[number]
    if letters == "ABC":
        return structure, False, "three different principal moments", ""
    why = "three equal moments" if letters == "AAA" else f"two equal moments: {scene.body.principal.kind} body"
    return structure | {"inertia": {"form": "principal", "moments": letters}}, True, why, "symmetric_top"


def _special_constants(scene: Scene, structure: Structure) -> Outcome:
    torques: list[Structure] = []
    found: dict[str, list[str]] = {"0": [], "1": [], "-1": []}
    silent: list[str] = []
    for torque, given in zip(structure["torques"], scene.torques, strict=True):
        if given.kind == "expression":
            torques.append(torque)
            silent += _silent(torque, given)
            continue
        fields: dict[str, Any] = {}
        for name, pattern in torque["fields"].items():
            value, unit = given.values[name], name in UNIT_FIELDS
            many = isinstance(pattern, list)
            fields[name] = [_pattern(entry, unit) for entry in value] if many else _pattern(value, unit)
            for component, mark in zip(_component_names(name, pattern), fields[name], strict=True):
                found.get(mark, []).append(component)
        torques.append(torque | {"fields": fields})
    if not structure["torques"]:
        return structure, True, "no torque acts: Euler's equations are free", "euler_equations"
    said = [f"{', '.join(names)} = {mark}" for mark, names in found.items() if names] + silent
    why = "; ".join(said) or "no component of a torque is exactly zero"
    return structure | {"torques": torques}, bool(said), why, ""


def _silent(torque: Structure, given: Any) -> list[str]:
    """Return in words the axes about which formulas give no torque."""
    axes = [str(i + 1) for i, formula in enumerate(given.values["torque"]) if _is_zero(formula)]
    if not axes:
        return []
    listed = f"axis {axes[0]}" if len(axes) == 1 else f"axes {', '.join(axes[:-1])} and {axes[-1]}"
    return [f"the formulas give no torque about {torque['frame']} {listed}"]


def _is_zero(formula: str) -> bool:
    """Return whether a formula is a number, and zero."""
    node = expression.parse(formula, switching=True)
    if expression.names(node):
        return False
    try:
        return bool(expression.evaluate(node, {}) == 0)
    except KeyError:  # a function of a number
        return False


def _depends_on_attitude(torque: Structure) -> bool:
    if torque["kind"] == "expression":
        sources = [*torque["formulas"], *(switch["guard"] for switch in torque.get("switches", ()))]
        used = set().union(*(expression.names(expression.parse(source)) for source in sources))
        return torque["frame"] == "space" or bool(used & {"q0", "q1", "q2", "q3"})
    return torque["kind"] not in NEVER_NEEDS_ATTITUDE


def _attitude(scene: Scene, structure: Structure) -> Outcome:
    asked = [name for name in scene.output.quantities if name in ATTITUDE_QUANTITIES]
    if asked:
        return structure, False, f"the output asks for {', '.join(asked)}", "quaternion_rates"
    needed = [torque["kind"] for torque in structure["torques"] if _depends_on_attitude(torque)]
    if needed:
        return structure, False, f"the torque {', '.join(needed)} depends on it", "quaternion_rates"
    why = "neither a torque nor the output needs it"
    return structure | {"attitude": False}, True, why, "attitude_not_needed"


def _torque_along(torque: Structure, axis: int, scene: Scene, given: Any) -> bool:
    """Whether the torque keeps to a body axis while the body turns about that axis only."""
    others = [i for i in range(3) if i != axis]
    fields = torque.get("fields", {})
    if torque["kind"] == "constant_body":
        return all(fields["torque"][i] == "0" for i in others)
    if torque["kind"] == "rotor":
        return all(fields["angular_momentum"][i] == "0" for i in others)
    if torque["kind"] == "constant_space":
        return _lies_along(given.values["torque"], axis, scene)
    if torque["kind"] == "gravity":  # a pendulum: level axis, centre of mass beside it
        level = _small_components(given.values["direction"], scene.initial)[axis]
        return level and fields["center_of_mass"][axis] == "0"
    return bool(torque["kind"] == "damping")


def _in_body(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[Fraction, ...]:
    """Return the body components, at the start, of a vector in space components."""
    q0, *q = initial.quaternion
    twice = [2 * sum(a * b for a, b in zip(q, vector_s, strict=True)) * c for c in q]
    turned = (
        q[1] * vector_s[2] - q[2] * vector_s[1], q[2] * vector_s[0] - q[0] * vector_s[2],
        q[0] * vector_s[1] - q[1] * vector_s[0],
    )  # fmt: skip
    scalar = q0 * q0 - sum(a * a for a in q)
    return tuple(scalar * v + t - 2 * q0 * c for v, t, c in zip(vector_s, twice, turned, strict=True))


CLEARLY = 1e-12  # of a vector: a component that doubles tell from zero


def _negligible(value: Fraction, vector: tuple[Fraction, ...]) -> bool:
    return abs(value) <= max(map(abs, vector)) / 2**200


def _small_components(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[bool, ...]:
    """Return which body components of a vector in space components are zero at the start, to 2^-200."""
    if _all_large(vector_s, initial):
        return False, False, False
    vector = _in_body(vector_s, initial)
    return tuple([_negligible(component, vector) for component in vector])


def _all_large(vector_s: tuple[Fraction, ...], initial: Initial) -> bool:
    """Return whether doubles settle that no body component is zero, in a tenth of the time of exact numbers."""
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


def _one_axis(scene: Scene, structure: Structure) -> Outcome:
    omega_b = scene.initial.omega_b
    if structure["inertia"]["form"] != "principal":
        return structure, False, "the axes of the body are not principal axes", ""
    turning = [i for i in range(3) if omega_b[i] != 0]
    axes = turning if len(turning) == 1 else [] if turning else [0, 1, 2]
    pairs = list(zip(structure["torques"], scene.torques, strict=True))
    along = [axis for axis in axes if all(_torque_along(torque, axis, scene, given) for torque, given in pairs)]
    if not along:
        formulas = any(torque["kind"] == "expression" for torque in structure["torques"])
        why = "the body does not turn about one principal axis only"
        if axes and formulas:
            why = "a torque given by formulas is not taken to keep the rotation about one axis"
        return structure, False, why, ""
    axis = along[0]
    start = [_pattern(q, unit=True) for q in scene.initial.quaternion] if structure["attitude"] else None
    planar = structure | {"planar": axis, "initial_quaternion": start}
    if not structure["torques"] or (all(torque["kind"] == "rotor" for torque in structure["torques"])):
        planar = planar | {"constant": _kept(scene, axis)}
    why = f"omega and torque stay along principal axis {axis + 1}: the attitude is one angle"
    return planar, True, why, "planar_motion"


def _constant_spin(scene: Scene, structure: Structure) -> Outcome:
    if structure["planar"] is not None:
        return structure, False, "already one axis", ""
    if structure["inertia"]["form"] != "principal":
        return structure, False, "the axes of the body are not principal axes", ""
    letters = structure["inertia"]["moments"]
    if letters == "AAA" and not structure["torques"]:
        why = "a spherical body without torque keeps its angular velocity"
        return structure | {"constant": _kept(scene, 0, 1, 2)}, True, why, "spherical_body"
    for axis in range(3):
        others = [letters[i] for i in range(3) if i != axis]
        if others[0] == others[1] and all(_no_moment_about(torque, axis) for torque in structure["torques"]):
            why = f"equal moments about the other axes and no torque about axis {axis + 1}"
            if scene.initial.omega_b[axis] == 0 and not structure["torques"]:
                why += ", and no spin: the body turns steadily about an axis across"
                return structure | {"constant": _kept(scene, 0, 1, 2)}, True, why, "symmetric_spin"
            return structure | {"constant": _kept(scene, axis)}, True, why, "symmetric_spin"
    return structure, False, "no axis of symmetry without torque about it", ""


def _kept(scene: Scene, *axes: int) -> dict[int, str]:
    """Return the components of omega_b that keep their value, with the pattern of each: zero, or a constant."""
    return {axis: _pattern(scene.initial.omega_b[axis], unit=False) for axis in axes}


def _no_moment_about(torque: Structure, axis: int) -> bool:
    """Whether a torque on a body with symmetry about the axis has no component along it, for every motion."""
    others = [i for i in range(3) if i != axis]
    fields = torque.get("fields", {})
    if torque["kind"] == "constant_body":
        return bool(fields["torque"][axis] == "0")
    if torque["kind"] == "damping":
        return bool(fields["linear"][axis] == "0" and fields["quadratic"] == "0")
    if torque["kind"] == "gravity":
        return all(fields["center_of_mass"][i] == "0" for i in others)
    if torque["kind"] == "rotor":
        return all(fields["angular_momentum"][i] == "0" for i in others)
    if torque["kind"] == "expression":
        return torque["frame"] == "body" and torque["formulas"][axis].strip() in ("0", "0.0")
    return bool(torque["kind"] == "gravity_gradient")


RULES: tuple[tuple[str, Callable[[Scene, Structure], Outcome]], ...] = (
    ("products of inertia", _products_of_inertia),
    ("unequal moments", _equal_moments),
    ("torque terms", _special_constants),
    ("attitude", _attitude),
    ("rotation out of one axis", _one_axis),
    ("rate of spin", _constant_spin),
)
"""The rules in their order: (what it is about, rule). A rule returns structure, whether it skips, why, derivation."""


def _whole_motion(scene: Scene, structure: Structure) -> Outcome:
    return structure, False, "a torque that is no formula may depend on it, and on all components of omega", ""


def _terms_when_driven(scene: Scene, structure: Structure) -> Outcome:
    if not scene.torques:
        return structure, False, "the torque that is no formula acts alone", ""
    return _special_constants(scene, structure)


_RULES_WHEN_DRIVEN: tuple[tuple[str, Callable[[Scene, Structure], Outcome]], ...] = (
    *RULES[:2],
    ("torque terms", _terms_when_driven),
    ("attitude", _whole_motion),
)

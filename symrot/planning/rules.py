"""The rules by which a plan simplifies the structure of a scene, each with its reason.

A structure says which constants of body and torques are zero, one, equal or free (any other value), and which states
are computed. A rule examines the exact numbers of the scene, simplifies the structure, and names the derivation that
justifies this.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from symrot.dynamics.structure import (
    MOVING,
    FieldPattern,
    FormulaTorque,
    InertiaTensor,
    Pattern,
    PrincipalInertia,
    Structure,
    TorqueStructure,
    component_names,
)
from symrot.formula import tree as expression
from symrot.formula.exact_numbers import NEGLIGIBLE, equal
from symrot.planning.general_structure import MOMENTS, PRODUCTS
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial
from symrot.scene.torque import Torque

__all__ = [
    "ATTITUDE_QUANTITIES", "DIRECTED", "RULES", "RULES_UNDER_EXTERNAL_TORQUE", "RuleOutcome", "pattern",
    "zero_components",
]  # fmt: skip

ZERO, ONE, MINUS_ONE, FREE = Pattern  # a global name is looked up faster than a member of an Enum

ATTITUDE_QUANTITIES = frozenset(
    {"quaternion", "euler", "dcm", "omega_space", "herpolhode", "angular_momentum_space", "axis"}
)
NEVER_NEEDS_ATTITUDE = ("constant_body", "damping", "rotor")
DIRECTED = {"constant_space": "torque", "gravity": "direction"}  # torques fixed in space: the field with the vector
UNIT_FIELDS = ("direction", "attitude")  # fields in which a component equal to one counts as a special value


class RuleOutcome(NamedTuple):
    """The decision of one rule that may simplify the equations of a scene, with its reason.

    The explanation of a plan contains one line for each decision.

    Attributes
    ----------
    structure : Structure
        The structure of the scene after the rule: which constants of body and torques are zero, one, equal or free, and
        which states are computed.
    skipped : bool
        Whether the rule applies, so that the equations skip something: a term, a state, or a constant that a number
        replaces.
    why : str
        The reason for the decision.
    derivation : str
        Name of the derivation that justifies the decision; empty if no derivation is needed.
    item : str
        The subject of the rule, such as "products of inertia". The functions of the rules leave it empty;
        :func:`symrot.planning.plan.make_plan` adds it from :data:`RULES`.

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


def pattern(value: Fraction, unit: bool) -> Pattern:
    """Return how the equations treat a number: as zero, as 1 or -1 (only if ``unit``), or as free, a parameter."""
    top, bottom = value.as_integer_ratio()
    if not top:
        return ZERO
    # components of unit vectors and quaternions, where 1 and -1 are common
    if unit and bottom == 1 == abs(top):
        return ONE if top > 0 else MINUS_ONE
    return FREE


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
            marks = tuple([pattern(entry, unit) for entry in entries])
            fields.append((name, marks if isinstance(value, tuple) else marks[0]))
            for component, mark in zip(component_names(name, general), marks, strict=True):
                special[mark].append(component)
        torques.append(torque._replace(fields=tuple(fields)))
    if not structure.torques:
        return RuleOutcome(structure, True, "no torque acts", "euler_equations")
    del special[FREE]
    reasons = [f"{', '.join(names)} = {mark.value}" for mark, names in special.items() if names] + silent
    why = "; ".join(reasons) or "no component of a torque is exactly zero"
    return RuleOutcome(replace(structure, torques=tuple(torques)), bool(reasons), why)


def _silent(torque: FormulaTorque, scene_torque: Torque) -> list[str]:
    """Return a list of one sentence that names the axes about which a torque's formulas are zero; empty if none are."""
    axes = [str(i + 1) for i, formula in enumerate(scene_torque.formulas) if _is_zero(formula)]
    if not axes:
        return []
    listed = f"axis {axes[0]}" if len(axes) == 1 else f"axes {', '.join(axes[:-1])} and {axes[-1]}"
    return [f"the formulas give no torque about {torque.frame} {listed}"]


def _is_zero(formula: str) -> bool:
    """Return whether a formula, given as text, is zero, such as ``"0"`` or ``"1 - 1"``.

    False if it contains names or functions.
    """
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
    """Return whether a vector is zero or parallel to body axis ``axis``, 0 to 2."""
    return all(vector[i] is ZERO for i in range(3) if i != axis)


def _torque_along(torque: TorqueStructure, axis: int, scene: Scene, scene_torque: Torque) -> bool:
    """Return whether a torque is parallel to body axis ``axis`` while the body rotates only about this axis.

    Return False also for torques whose direction is not examined: those given by formulas, and a gravity gradient.
    """
    if isinstance(torque, FormulaTorque):
        return False
    if torque.kind == "constant_body":
        return _only_along(torque.vector("torque"), axis)
    if torque.kind == "rotor":
        return _only_along(torque.vector("angular_momentum"), axis)
    if torque.kind == "constant_space":
        return _lies_along(scene_torque.vector("torque"), axis, scene)
    if torque.kind == "gravity":  # a pendulum: level axis, centre of mass off the axis
        level = zero_components(scene_torque.vector("direction"), scene.initial)[axis]
        return level and torque.vector("center_of_mass")[axis] is ZERO
    return torque.kind == "damping"


def _in_body(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[Fraction, ...]:
    """Return the exact body components, at the initial attitude, of a vector in space components."""
    q0, *q = initial.quaternion
    # A quaternion of another norm than 1 multiplies them by the square of its norm.
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


def zero_components(vector_s: tuple[Fraction, ...], initial: Initial) -> tuple[bool, ...]:
    """Return which of the three body components of the space vector ``vector_s`` are zero at the initial attitude."""
    if _all_large(vector_s, initial):
        return False, False, False
    # Zero to 2^-200 of the largest one: the quaternion of most attitudes is irrational and therefore rounded.
    vector = _in_body(vector_s, initial)
    return tuple([_negligible(component, vector) for component in vector])


def _all_large(vector_s: tuple[Fraction, ...], initial: Initial) -> bool:
    """Return whether a computation in doubles proves that no body component of a vector is zero at the start."""
    # a tenth of the time of exact arithmetic, which decides if the result is False
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
    small = zero_components(vector_s, scene.initial)
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
    start = tuple([pattern(q, unit=True) for q in scene.initial.quaternion]) if structure.attitude else None
    constant = _constant(scene, axis) if all(torque.kind == "rotor" for torque in structure.torques) else MOVING
    planar = replace(structure, planar=axis, initial_quaternion=start, constant=constant)
    why = f"omega and torque stay along principal axis {axis + 1}: the attitude is one angle"
    return RuleOutcome(planar, True, why, "planar_motion")


def _constant_spin(scene: Scene, structure: Structure) -> RuleOutcome:
    if structure.planar is not None:
        return RuleOutcome(structure, False, "the body already rotates about one axis only")
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
                why += ", and no spin: the body rotates steadily about an axis perpendicular to it"
                return RuleOutcome(replace(structure, constant=_constant(scene, 0, 1, 2)), True, why, "symmetric_spin")
            return RuleOutcome(replace(structure, constant=_constant(scene, axis)), True, why, "symmetric_spin")
    return RuleOutcome(structure, False, "no symmetry axis about which no torque acts")


def _constant(scene: Scene, *axes: int) -> tuple[Pattern | None, Pattern | None, Pattern | None]:
    """Return, for each component of omega_b, its pattern (zero, or free) if it is constant, or None if it changes.

    ``axes`` lists the numbers, 0 to 2, of the constant components.
    """
    first, second, third = (
        pattern(w, unit=False) if axis in axes else None for axis, w in enumerate(scene.initial.omega_b)
    )
    return first, second, third


def _no_moment_about(torque: TorqueStructure, axis: int) -> bool:
    """Return whether a torque is known to have no component along the symmetry axis ``axis``, 0 to 2, at any time.

    The spin about this axis is then constant. For a torque given by formulas, the result is True only if the formulas
    are body components and the formula along the axis is written as ``0`` or ``0.0``.
    """
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
"""The rules that simplify the equations of a scene, in the order of application, as pairs (subject, function)."""


def _whole_motion(scene: Scene, structure: Structure) -> RuleOutcome:
    why = "a torque without a formula may depend on the attitude and on all components of omega"
    return RuleOutcome(structure, False, why)


def _terms_under_external_torque(scene: Scene, structure: Structure) -> RuleOutcome:
    if not scene.torques:
        return RuleOutcome(structure, False, "the only torque has no formula")
    return _special_constants(scene, structure)


RULES_UNDER_EXTERNAL_TORQUE: tuple[tuple[str, Callable[[Scene, Structure], RuleOutcome]], ...] = (
    *RULES[:2],
    ("torque terms", _terms_under_external_torque),
    ("attitude", _whole_motion),
)
"""The rules that simplify the equations of a scene under a torque without a formula, as pairs (subject, function)."""

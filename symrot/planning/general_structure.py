"""The most general structure of a scene, from which a plan starts, and the exact values of its constants.

A structure says which constants of body and torques are zero, one, equal, or free (a parameter of any value). In the
most general one every constant is free, the inertia is a full tensor, and the full attitude is computed.
"""

from fractions import Fraction

from symrot.dynamics.structure import (
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
from symrot.formula import tree as expression
from symrot.formula.switches import Switch, blended, has_choices, has_switches, smooth
from symrot.scene.scene import Scene
from symrot.scene.torque import Torque

__all__ = ["MOMENTS", "PRODUCTS", "constants_of", "general_structure", "switched", "switching_function"]

FREE = Pattern.FREE  # a global name is looked up faster than a member of an Enum

PRODUCTS = {"I_xy": (0, 1), "I_xz": (0, 2), "I_yz": (1, 2)}
MOMENTS = {"I_xx": (0, 0), "I_yy": (1, 1), "I_zz": (2, 2)}
RESERVED = frozenset(
    {"t", "theta", "pi", *"ABC", *MOMENTS, *PRODUCTS}
    | {f"{name}_{i}" for name in ("omega", "L", "M", "radius", "initial_q") for i in range(4)}
    | {f"q{i}" for i in range(4)} | {f"initial_q{i}" for i in range(4)}
)  # fmt: skip


def switched(scene: Scene) -> bool:
    """Return whether a torque formula of a scene contains a function with a jump or kink: ``sign``, ``abs``, ..

    The equations of such a motion change where the function switches.
    """
    return any(
        has_switches(expression.parse(formula, switching=True))
        for torque in scene.torques
        for formula in torque.formulas
    )


def switching_function(scene: Scene) -> str:
    """Return the name of a function with a jump or kink in a scene's torques, for messages; empty if there is none.

    Of several such functions, it is the alphabetically first.
    """
    calls = {
        name
        for torque in scene.torques
        for formula in torque.formulas
        for name in expression.operations(expression.parse(formula, switching=True))
    }
    return min(calls & set(expression.SWITCHING), default="")


def general_structure(scene: Scene, switched: bool = False) -> Structure:
    """Return the most general structure of a scene: full inertia tensor, constants of any value, full attitude.

    If ``switched``, each function with a jump or kink in a torque formula becomes a constant, its mode, such as 1 for
    ``sign(omega_3)`` while omega_3 > 0.
    """
    names: set[str] = set(RESERVED)
    torques = [_general_torque(number, torque, names, switched) for number, torque in enumerate(scene.torques, start=1)]
    return Structure(InertiaTensor(tuple(sorted([*MOMENTS, *PRODUCTS]))), tuple(torques))


def _general_torque(number: int, torque: Torque, known: set[str], switched: bool) -> TorqueStructure:
    """Return the structure of a torque for the most general equations, in which each constant may have any value.

    ``number`` is the number of the torque in the scene, from 1. The names of its constants are added to ``known``. If
    ``switched``, functions with a jump or kink, such as sign and abs, become further constants
    (:func:`general_structure`).
    """
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
    """Return the structure of a torque given by formulas, in which each constant may have any value.

    The constants have the same names as in the scene. If ``switched``, functions with a jump or kink, such as sign and
    abs, become further constants (modes).
    """
    formulas, parameters, frame = torque.formulas, tuple(torque.values), torque.frame
    if not (switched and any(has_switches(expression.parse(text, switching=True)) for text in formulas)):
        return FormulaTorque("", formulas, parameters, frame)
    # Modes, constants in place of functions such as sign, become further parameters.
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
    """Return a prefix, empty or such as ``"torque2_"``, that makes ``names`` differ from ``known``.

    The names with the prefix are added to ``known``.
    """
    prefix = ""
    while known & {f"{prefix}{name}" for name in names}:
        prefix = f"{prefix}_" if prefix else f"torque{number}_"
    known |= {f"{prefix}{name}" for name in names}
    return prefix


def constants_of(scene: Scene, structure: Structure) -> dict[str, Fraction]:
    """Return the exact values of the free constants of a scene's ``structure``, such as ``{"A": Fraction(1), ..}``.

    The structure says which constants of body and torques are zero, one, equal or free; the equations have a parameter
    for each free one. A mode, the value of a function such as sign that jumps, gets the value 1 for the present.
    """
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
            # A mode changes during the motion; propagation sets it to the value that belongs to the state.
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

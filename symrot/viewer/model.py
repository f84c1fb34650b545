"""The content of a scene's page: kernels as JavaScript, adjustable constants, the body, and reference samples.

The page lets the reader change the constants of the scene. Its kernels are therefore derived without the
simplifications that hold only for the scene's own numbers, such as equal moments.
"""

import json
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import hypot
from shlex import quote
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.codegen.printing.js_source import js_function, js_functions
from symrot.dynamics.structure import PrincipalInertia, component_names
from symrot.dynamics.torque_kinds import TORQUE_KINDS, Field
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import rename
from symrot.inertia.principal import Principal
from symrot.planning.general_structure import general_structure, switched
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import Parameters, SceneKernel
from symrot.propagation.compiled_models import has_formulas, scene_kernel
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import tableau
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene
from symrot.viewer.body_surface import Patch, how_drawn, patches

__all__ = ["PageModel", "page_model", "with_attitude"]

Floats = NDArray[np.float64]

REFERENCES = 41  # times at which the page compares its motion with symrot's
FEWEST_SAMPLES, MOST_SAMPLES = 6000, 16000  # of a motion that the page does not compute itself
FINEST = 0.1  # rad, rotation between two of these samples: the cubic between them is right to a few 1e-6
DIGITS = 5  # of the points of a body, relative to its size
DEFAULT_SEQUENCE = "ZXZ"
SUBSCRIPTS = "\u2081\u2082\u2083"
DIGITS_OF_NAMES = "0123456789"
UNIT_FIELDS = ("direction", "attitude")
MOMENTS = ("A", "B", "C")


class Slider(NamedTuple):
    """A constant or initial value that the reader of a page can change by a slider: name, label, unit, value, range."""

    name: str
    label: str
    unit: str
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class PageModel:
    """The content of a page: JavaScript functions, and numbers and texts as data.

    Attributes
    ----------
    kernel : str
        JavaScript that defines ``kernel``, an object with functions: Euler angles and, if the page computes the motion,
        rates, quantities and parameters.
    data : dict
        Numbers and texts for the page, ready for JSON.
    """

    kernel: str
    data: dict[str, Any]


def page_model(scene: Scene, trajectory: Trajectory | None = None) -> PageModel:
    """Return the content of the page of a scene.

    Parameters
    ----------
    scene : Scene
        The scene.
    trajectory : Trajectory, optional
        A motion under a torque without a formula, to play instead of the scene's own motion.

    Raises
    ------
    InputError, PropagationError
        As for :func:`symrot.propagate`.
    """
    scene = with_attitude(scene)
    reason = _why_played(scene, trajectory)
    data = _facts(scene, trajectory is not None)
    if reason:
        motion = propagator(scene)(_times(scene, FEWEST_SAMPLES)) if trajectory is None else trajectory
        text = _script(_angle_kernels(data["sequence"]))
        return PageModel(text, data | _played(motion, reason) | {"conserved": [], "sliders": []})
    plan = Plan(scene, _free_structure(scene), ())
    kernel = scene_kernel(plan)
    times = _times(scene, REFERENCES)
    reference = propagator(scene)(times)
    names = tuple(plan.constants)
    outputs = {name: place for place, (name, *_) in enumerate(kernel.quantities.signature.argument("out").components)}
    return PageModel(
        _kernel_text(kernel, names, data["sequence"]),
        data
        | {
            "constants": {name: float(value) for name, value in plan.constants.items()},
            "orbit": data["orbit"] and data["orbit"] | {"constant": _orbit_constant(plan)},
            "sliders": [slider._asdict() for slider in _sliders(scene, plan)],
            "outputs": outputs,
            "conserved": [
                {"name": item.name, "unit": item.unit, "output": outputs[item.output], "reason": item.reason}
                for item in kernel.conserved
                if item.holds
            ],
            "tableau": _tableau(),
            "tolerance": 1e-14,
            "reference": _reference(times, np.hstack([reference.omega, reference.quaternion])),
        },
    )


def with_attitude(scene: Scene) -> Scene:
    """Return the scene with the attitude added to its output, so that the motion can be drawn."""
    output = scene.output
    if "quaternion" in output.quantities:
        return scene
    return replace(scene, output=output._replace(quantities=(*output.quantities, "quaternion")))


def _why_played(scene: Scene, trajectory: Trajectory | None) -> str:
    """Return why a page plays a motion that symrot computed beforehand; empty if the page computes the motion."""
    if trajectory is not None:
        return "a torque without a formula acts, so symrot computed this motion beforehand"
    if scene.table is not None:
        return "a torque is given by samples, so symrot computed this motion beforehand"
    if switched(scene):
        return "a torque has jumps or kinks, so symrot computed this motion beforehand"
    if has_formulas(Plan(scene, general_structure(scene), ())):
        return "a torque formula may have short pulses, so symrot computed this motion beforehand"
    return ""


def _free_structure(scene: Scene) -> Any:
    """Return the structure of the equations of motion for the page of a scene, on which the reader changes constants.

    It assumes no constants to be zero or equal, except that products of inertia are zero in principal body axes.
    """
    structure = general_structure(scene)
    # Principal body axes stay principal: no products of inertia.
    if scene.body.principal.given_axes:
        return replace(structure, inertia=PrincipalInertia("ABC"))
    return structure


def _facts(scene: Scene, is_driven: bool) -> dict[str, Any]:
    """Return a map with the data about a scene that every page needs.

    ``is_driven`` says whether a torque without a formula acts.
    """
    body = scene.body
    principal = body.principal
    axis = 2 if principal.symmetry_axis is None else principal.symmetry_axis
    surface = patches(body)
    size = max((hypot(*point) for patch in surface for point in patch.points), default=1.0) or 1.0
    torques = [torque for torque in scene.torques if torque.kind != "rotor"]
    rotors = [torque.vector("angular_momentum") for torque in scene.torques if torque.kind == "rotor"]
    down = next((torque.vector("direction") for torque in scene.torques if torque.kind == "gravity"), None)
    return {
        "name": scene.name,
        "title": scene.title or scene.name,
        "source": scene.source.rstrip("."),
        "command": f"symrot show {quote(scene.name)}",
        "drawn": how_drawn(body),
        "start": float(scene.span.start),
        "stop": float(scene.span.stop),
        "omega": [float(value) for value in scene.initial.omega_b],
        "omegaRest": [_rest(value) for value in scene.initial.omega_b],
        "momentsRest": [_rest(moment) for moment in principal.moments],
        "quaternion": [float(value) for value in scene.initial.quaternion],
        "sequence": scene.output.sequence or DEFAULT_SEQUENCE,
        "inertia": [[float(entry) for entry in row] for row in body.inertia],
        "principal": [float(moment) for moment in principal.moments],
        "axes": [[float(entry) for entry in row] for row in principal.axes],
        "axis": [float(row[axis]) for row in principal.axes],
        "axisName": _axis_name(principal, axis),
        "rotor": [float(sum(column)) for column in zip(*rotors, strict=True)] if rotors else [0.0, 0.0, 0.0],
        "hasTorque": bool(torques) or scene.table is not None or is_driven,
        "symmetric": principal.kind == "symmetric",
        "free": not scene.torques and scene.table is None and not is_driven,
        "fixedPoint": body.about == "fixed_point",
        "center": None if body.center_of_mass is None else [float(value) for value in body.center_of_mass],
        "mass": None if body.mass is None else float(body.mass),
        "orbit": _orbit(scene),
        "down": None if down is None else [float(value) for value in down],
        "size": size,
        "patches": [_patch(patch, size) for patch in surface],
    }


def _axis_name(principal: Principal, axis: int) -> str:
    """Return the words for principal axis number ``axis``, from 0, of a body."""
    if principal.given_axes:
        return f"body axis {axis + 1}"
    return f"principal axis {axis + 1}" if principal.symmetry_axis is None else "symmetry axis"


def _orbit(scene: Scene) -> dict[str, Any] | None:
    """Return a satellite's mean motion, rad/s, and the body axis of its least moment.

    Return None unless the scene has exactly one torque of a gravity gradient.
    """
    torques = [torque for torque in scene.torques if torque.kind == "gravity_gradient"]
    if len(torques) != 1:
        return None
    principal = scene.body.principal
    least = min(range(3), key=lambda k: principal.moments[k])
    return {"rate": float(torques[0].number("mean_motion")), "axis": [float(row[least]) for row in principal.axes]}


def _orbit_constant(plan: Plan) -> str:
    """Return the name of the constant of a plan that is the mean motion of the satellite's orbit."""
    return next(f"{item.prefix}mean_motion" for item in plan.structure.torques if item.kind == "gravity_gradient")


def _rest(value: Fraction) -> float:
    """Return a number minus its nearest double, as a double.

    The page of a scene gets both doubles; their sum has 32 digits.
    """
    return float(value - Fraction(float(value)))


def _patch(patch: Patch, size: float) -> dict[str, Any]:
    """Return a patch of the body's surface as data for JSON; its points are divided by the body's ``size``, m."""
    points = [round(component / size, DIGITS) + 0.0 for point in patch.points for component in point]
    kind = {"mesh": True} if patch.is_mesh else {}
    return {"points": points, "rows": patch.rows, "columns": patch.columns, "hole": patch.is_hole, **kind}


def _times(scene: Scene, count: int) -> Floats:
    return np.linspace(float(scene.span.start), float(scene.span.stop), count)


def _packed(values: Floats) -> str:
    """Return doubles as base64 text of their little-endian bytes."""
    return b64encode(np.ascontiguousarray(values, dtype="<f8").tobytes()).decode("ascii")


def _played(motion: Trajectory, reason: str) -> dict[str, Any]:
    """Return a motion that the page plays, as evenly spaced samples of omega and quaternion, close enough to be drawn.

    ``reason`` says why the page plays the motion. InputError is raised for a trajectory without attitude.
    """
    if not motion.has_attitude:
        raise InputError('show: expected a trajectory with attitude; add "quaternion" to output.quantities')
    start, stop = float(motion.t.min()), float(motion.t.max())
    rotation = float(np.max(np.linalg.norm(motion.omega, axis=1))) * (stop - start)
    # too many rotations for a page: only the beginning is played, and the text says so
    if rotation > FINEST * MOST_SAMPLES:
        whole = stop
        stop = start + (stop - start) * FINEST * MOST_SAMPLES / rotation
        reason += (
            f", and it plays the first {stop - start:.4g} s of {whole - start:.4g} s, which has {rotation:.0f} rad"
        )
    count = max(FEWEST_SAMPLES, min(MOST_SAMPLES, round(rotation / FINEST)))
    times = np.linspace(start, stop, count)
    between = start + (stop - start) * (np.arange(REFERENCES) + 0.5) / REFERENCES
    return {
        "played": reason,
        "start": start,
        "stop": stop,
        "samples": _packed(motion.sol(times).T),
        "reference": _reference(between, motion.sol(between).T),
    }


def _reference(times: Floats, states: Floats) -> dict[str, str]:
    """Return times and states computed by symrot as data; the page compares its results with them."""
    return {"t": _packed(times), "y": _packed(states)}


def _tableau() -> dict[str, Any]:
    return {
        "nodes": tableau.NODES,
        "stages": {str(stage): dict(row) for stage, row in tableau.STAGE_WEIGHTS.items()},
        "weights": tableau.WEIGHTS,
        "weights_3": tableau.WEIGHTS_3,
        "error_5": tableau.ERROR_5,
        "dense": {str(order): dict(row) for order, row in tableau.DENSE.items()},
    }


# --- kernels ----------------------------------------------------------------------------------------------------------


def _angle_kernels(sequence: str) -> dict[str, Program]:
    """Return the kernels that a scene's page uses for Euler angles of ``sequence``, under their names in JavaScript.

    ``angles_of_quaternion`` computes the angles of a quaternion, ``quaternion_of_angles`` the quaternion of angles.
    """
    from symrot.codegen.library_kernels import kernel_program

    angles = f"euler_{'' if sequence.isupper() else 'extrinsic_'}{sequence.lower()}"
    return {
        "angles_of_quaternion": kernel_program(f"{angles}_of_quaternion"),
        "quaternion_of_angles": kernel_program(f"{angles}_quaternion"),
    }


def _kernel_text(kernel: SceneKernel, constants: Sequence[str], sequence: str) -> str:
    """Return the JavaScript of the equations of a scene: rates, output quantities, parameters, Euler angles."""
    # time derivatives of the state, output quantities, and the parameters of both from the constants
    programs = {
        "rates": kernel.rates,
        "quantities": kernel.quantities,
        "rate_parameters": _binding("rate_parameters", kernel.rate_parameters, constants),
        "quantity_parameters": _binding("quantity_parameters", kernel.quantity_parameters, constants),
    }
    sizes = {
        "quantities": _size(kernel.quantities, "out"),
        "rate_parameters": len(kernel.rate_parameters),
        "quantity_parameters": len(kernel.quantity_parameters),
    }
    takes = {name: bool(_size(program, "p")) for name, program in programs.items()}
    facts = {"takesParameters": takes, "sizes": sizes, "names": list(constants)}
    return _script(programs | _angle_kernels(sequence), facts)


def _script(programs: Mapping[str, Program], facts: Mapping[str, Any] = MappingProxyType({})) -> str:
    """Return JavaScript that defines the object ``kernel``, with a function for each program and the entries
    ``facts``.
    """
    lines = js_functions(*programs.values())
    for program in programs.values():
        lines += [*js_function(program), ""]
    pairs = [f"{name}: {program.signature.name}" for name, program in programs.items()]
    pairs += [f"{name}: {json.dumps(value)}" for name, value in facts.items()]
    return "\n".join([*lines, f"const kernel = {{{', '.join(pairs)}}};"]) + "\n"


def _size(program: Program, name: str) -> int:
    return sum(argument.size for argument in program.signature.arguments if argument.name == name)


def _binding(name: str, parameters: Parameters, constants: Iterable[str]) -> Program:
    """Return a program ``name`` that computes parameters, such as (C - B)/A, from the array ``c`` of constants."""
    components = (*((f"c_{constant}", "", "") for constant in constants), ("c_pi", "", ""))
    names = {constant: f"c_{constant}" for constant in (*constants, "pi")}
    results = tuple((f"p_{place}", "", "") for place, _ in enumerate(parameters))
    outputs = tuple((f"p_{place}", rename(node, names)) for place, (_, node) in enumerate(parameters))
    return Program(Signature(name, (Argument("c", "in", components), Argument("p", "out", results))), (), outputs)


# --- sliders ----------------------------------------------------------------------------------------------------------


def _sliders(scene: Scene, plan: Plan) -> list[Slider]:
    """Return the sliders of a page: for initial rates, moments of inertia, and constants of the torques."""
    rates = [float(value) for value in scene.initial.omega_b]
    fastest = max(map(abs, rates)) or 1.0
    sliders = []
    for k, rate in enumerate(rates):
        reach = 2 * max(abs(rate), fastest / 8)
        sliders.append(Slider(f"omega_{k + 1}", "\u03c9" + SUBSCRIPTS[k], "rad/s", rate, -reach, reach))
    values = {name: float(value) for name, value in plan.constants.items()}
    for name in MOMENTS:
        if name in values:
            sliders.append(Slider(name, name, "kg m^2", values[name], values[name] / 4, 4 * values[name]))
    for name, field in _fields(plan):
        family = [
            abs(value)
            for other, value in values.items()
            if other.rstrip(DIGITS_OF_NAMES) == name.rstrip(DIGITS_OF_NAMES)
        ]
        reach = 2 * (abs(values[name]) or max(family) or 1.0)
        low = 0.0 if field.sign in ("positive", "nonnegative") else -reach
        sliders.append(Slider(name, name.replace("_", " "), field.unit, values[name], low, reach))
    return sliders


def _fields(plan: Plan) -> Iterator[tuple[str, Field]]:
    """Yield (name, field) for each constant of a torque that can be changed without changing another constant."""
    for torque in plan.structure.torques:
        fields = {field.name: field for field in TORQUE_KINDS[torque.kind].fields}
        for name, pattern in getattr(torque, "fields", ()):
            # components of a unit vector cannot change one by one
            if name not in UNIT_FIELDS:
                for component in component_names(name, pattern):
                    yield f"{torque.prefix}{component}", fields[name]

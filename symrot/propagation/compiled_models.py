"""Kernels of scenes: loaded from the cache, or derived, printed as C, compiled and stored in the cache.

A kernel is the generated code for the rates (time derivatives) of the states and for the output quantities. It is
derived from a plan, the smallest set of equations that gives the requested output of a scene. Its key in the cache
contains the structure of the plan and the version of symrot's files, but no numbers of the scene.
"""

import json
import os
from collections.abc import Callable, Mapping, Sequence
from functools import cache, lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from symrot.build import cache as library
from symrot.build.sources import PACKAGE
from symrot.dynamics.structure import Structure
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.switches import CHANGING
from symrot.formula.tree import Node, children, parse
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import SceneKernel
from symrot.propagation.steppers import taylor
from symrot.propagation.steppers.dop853 import DENSE_ORDER, translation_unit
from symrot.propagation.steppers.smoothness import non_smooth_torque

if TYPE_CHECKING:
    from symrot.propagation.enclosures.step_limit import Deviations

__all__ = [
    "compiled",
    "enclosure_text",
    "error_blocks",
    "formula_deviations",
    "grows_late",
    "has_formulas",
    "invariant_source",
    "kernel_key",
    "library_source",
    "motion_library",
    "needs_bounds",
    "scene_kernel",
    "taylor_library",
]

FOLDERS = ("codegen", "dynamics", "exact", "formula", "kernels", "kinematics")
FILES = (
    "planning/scene_kernel.py", "symbols.py", "propagation/steppers/taylor.py", "propagation/compiled_models.py",
    *taylor.FILES.values(),
)  # fmt: skip  # the text of these files is cached together with the recurrences
ATTITUDE_SCALE = 1.0  # a quaternion has unit norm; an error of an angle counts in rad
RATE_SCALE = 0.0  # an error of omega counts relative to omega


@cache
def _version() -> str:
    """Return a text with the names, sizes and times of the files that derive kernels."""
    # if a file changes, kernels in the cache are not used any more
    states = [(file, (PACKAGE / file).stat()) for file in FILES]
    folders = [str(PACKAGE / folder) for folder in FOLDERS]
    for folder in folders:  # the loop appends to this list
        with os.scandir(folder) as entries:
            for entry in entries:
                if entry.name.endswith(".py"):
                    states.append((entry.path.removeprefix(str(PACKAGE)), entry.stat()))
                elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                    folders.append(entry.path)
    return "\n".join(sorted(f"{file} {state.st_size} {state.st_mtime_ns}" for file, state in states))


def kernel_key(plan: Plan) -> str:
    """Return the key under which the cache stores the kernel of a plan (generated code for the equations of a scene).

    Plans with equal structures share the key.
    """
    return f"scene kernel\n{_structure_text(plan.structure)}\n{_version()}"


@lru_cache(maxsize=64)
def _structure_text(structure: Structure) -> str:
    return json.dumps(structure.to_json())


def scene_kernel(plan: Plan, on_rates: Callable[[Program, str], object] = lambda rates, source: None) -> SceneKernel:
    """Return the kernel of a plan (generated code for the equations of a scene), from the cache or newly derived.

    ``on_rates(program, c_text)`` is called as soon as the rates are derived, before the conserved quantities are; it is
    not called for a kernel from the cache.
    """
    saved = library.fetch(kernel_key(plan))
    if saved is not None:
        return SceneKernel(json.loads(saved))
    from symrot.codegen.scene_kernels import derive_scene_kernel

    # the compiler can already work on the rates while the conserved quantities are derived
    kernel = derive_scene_kernel(plan.structure, on_rates)
    library.store(kernel_key(plan), json.dumps(kernel.record))
    return kernel


def compiled(plan: Plan) -> tuple[SceneKernel, Path]:
    """Return the kernel of a plan (generated code for the equations of a scene), and the path of its compiled library.

    The library contains the kernel and its stepper, DOP853.

    Raises
    ------
    CompilerError
        If the compiler rejects the source.
    """
    started: list[library.Building] = []

    def start(rates: Program, source: str) -> None:
        started.append(library.Building(_unit(plan, source, _parameter_count(rates), lambda: rates), "motion"))

    try:
        kernel = scene_kernel(plan, start)
    except KeyboardInterrupt:
        library.stop_compilers()
        raise
    finally:
        for building in started:
            building.wait()
    return kernel, started[0].path() if started else motion_library(plan, kernel)


def _parameter_count(rates: Program) -> int:
    return sum(argument.size for argument in rates.signature.arguments if argument.name == "p")


def motion_library(plan: Plan, kernel: SceneKernel) -> Path:
    """Return the path of the library that integrates a scene's motion by DOP853; ``plan`` has the equations.

    The library is compiled unless it is cached.
    """
    return library.build(library_source(plan, kernel), "motion")


def taylor_library(plan: Plan, kernel: SceneKernel, tolerance: float, projected: bool = True) -> Path:
    """Return the path of the library that integrates a scene's motion by Taylor series; ``plan`` has the equations.

    The library is compiled unless it is cached. ``projected`` says whether the states are corrected every few steps, so
    that the conserved quantities stay constant.

    Raises
    ------
    InputError
        If the rates have no Taylor series, for example since they contain the absolute value of a state.
    """
    # the order of the series suits the tolerance
    order = taylor.order_for(tolerance, kernel.rates)
    key = f"taylor {order}{'' if projected else ' not projected'}\n{kernel_key(plan)}"
    source = library.fetch(key)
    if source is None:
        invariants = invariant_source(kernel, plan.states) if projected else ""
        source = taylor.translation_unit(kernel.rates, *error_blocks(plan), order, invariants, needs_bounds(plan))
        library.store(key, source)
    return library.build(source, "taylor", taylor.FLAGS)


def invariant_source(kernel: SceneKernel, states: Sequence[str]) -> str:
    """Return C code that computes the conserved quantities from an array of the states, in the order of ``states``.

    The Taylor stepper keeps these quantities constant.
    """
    from symrot.codegen.taylor.invariant_source import invariant_definitions

    # those that the derivation of the kernel has proved; invariant_definitions adds the norm of the quaternion
    outputs = [item.output for item in kernel.conserved if item.holds]
    return invariant_definitions(kernel.quantities, outputs, states, [name for name, _ in kernel.quantity_parameters])


def error_blocks(plan: Plan) -> tuple[list[int], list[float]]:
    """Return (edges, scales) of the blocks of states whose errors are measured separately.

    Block k has the states from edge k up to edge k + 1. Its error is divided by its scale, or by the norm of the block
    if the scale is 0. For the blocks omega and quaternion: ``([0, 3, 7], [0.0, 1.0])``.
    """
    rates = sum(name.startswith("omega") for name in plan.states)
    count = len(plan.states)
    edges = [0, *([rates] if 0 < rates < count else []), count]
    return edges, [RATE_SCALE] * (rates > 0) + [ATTITUDE_SCALE] * (count > rates)


def library_source(plan: Plan, kernel: SceneKernel) -> str:
    """Return the C text of the library that integrates a scene's motion: the kernel of the plan, and DOP853."""
    return _unit(plan, kernel.source, len(kernel.rate_parameters), lambda: kernel.rates)


def _unit(plan: Plan, source: str, parameters: int, rates: Callable[[], Program]) -> str:
    edges, scales = error_blocks(plan)
    # bounds of the rates limit the steps, which might miss a short pulse of a torque formula
    bounds = (enclosure_text(plan, rates, edges),) if has_formulas(plan) else ()
    return translation_unit(source, "symrot_rates", len(plan.states), parameters, edges, scales, *bounds)


def has_formulas(plan: Plan) -> bool:
    """Return whether a torque of the scene, given by its plan, has formulas."""
    # the steps then need limits, because a long step may miss a short pulse
    return any(plan.structure.formula_torques)


def needs_bounds(plan: Plan) -> bool:
    """Return whether the steps by Taylor series need limits, because a long step may miss a pulse or a corner.

    The limits follow from bounds of the rates (time derivatives of the states) on discs of complex times. A pulse is a
    short change of a torque formula. At a corner, such as ``|omega|`` at omega = 0, a rate is not smooth. Example:
    quadratic damping stops a rotation for an instant; the Taylor series of ``|omega|`` then continues with negative
    values.
    """
    return has_formulas(plan) or bool(non_smooth_torque(plan))


def grows_late(plan: Plan) -> bool:
    """Return whether a torque formula of the scene has degree 3 or more in time and states, such as ``t**3``."""
    # A motion from rest then starts with Taylor coefficients that are zero and hide how large it becomes: an ensemble
    # follows such motions one by one, so that each step can be checked.
    formulas = [text for torque in plan.structure.formula_torques for text in torque.formulas]
    return any(_degree(parse(text)) >= 3 for text in formulas)


def _degree(node: Node) -> int:
    """Return how strongly a formula varies with time and states: its degree as a polynomial, 3 for ``a*t**2*omega_1``.

    ``sin(t)`` counts as degree 1, ``1/t**2`` as degree 2.
    """
    if node[0] == "symbol":
        return int(node[1] in CHANGING)
    degrees = [_degree(child) for child in children(node)]
    if node[0] == "**":
        return degrees[0] * abs(int(node[2]))
    if node[0] == "call":
        return min(1, max(degrees))
    return sum(degrees) if node[0] == "*" else max(degrees, default=0)


def formula_deviations(plan: Plan, kernel: SceneKernel) -> "Callable[[Mapping[str, float]], Deviations] | None":
    """Return a function that makes bounds (:class:`Deviations`) from a map of the rates' parameters, name to value.

    The bounds say how far the rates can change near a time and state; with them SciPy's steps stay so short that none
    misses a short pulse of a torque formula. Return None if no torque can have a short pulse, or if the rates have no
    Taylor series.
    """
    if not has_formulas(plan):
        return None
    from symrot.codegen.enclosure.terms import enclosure
    from symrot.codegen.taylor.recurrences import recurrences
    from symrot.propagation.enclosures.step_limit import Deviations

    try:
        terms = enclosure(recurrences(kernel.rates))
    except InputError:  # no Taylor series, for example of abs
        return None
    return None if terms is None else partial(Deviations, terms)


def enclosure_text(plan: Plan, rates: Callable[[], Program], edges: Sequence[int]) -> str:
    """Return C code that bounds how far the rates (time derivatives of the states) can change in one step.

    The rates are those of the equations in ``plan``. The code comes from the cache; only if it is not there, ``rates``
    is called for the program of the rates, and the code is generated. ``edges`` are the edges of the blocks of states
    whose errors are measured separately.
    """
    key = f"enclosure {DENSE_ORDER}\n{kernel_key(plan)}"
    text = library.fetch(key)
    if text is None:
        from symrot.codegen.enclosure.source import enclosure_source, rounding_source

        # rates() is called only here, as it may have to derive the program
        program = rates()
        text = enclosure_source(program, DENSE_ORDER, edges) + rounding_source(program)
        library.store(key, text)
    return text

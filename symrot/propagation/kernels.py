"""The kernel of a plan: from the cache if it is there, else derived, emitted and compiled, and kept.

The key is the structure of the plan and the version of symrot's own files; numbers are not part of it. While the
compiler works on the rates, the invariants are proven.
"""

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

from symrot.codegen import library
from symrot.planner import Plan
from symrot.propagation.dop853 import translation_unit
from symrot.scene_kernel import SceneKernel

__all__ = [
    "compiled",
    "error_blocks",
    "kernel_key",
    "library_source",
    "missing_compiler",
    "scene_kernel",
    "taylor_library",
]

PACKAGE = Path(__file__).parents[1]
TAYLOR = tuple(
    f"propagation/{name}"
    for name in ("taylor.py", "taylor.h", "series.h", "taylor.c", "pairs.h", "projection.c", "invariants.py")
)  # kept together with the recurrences
MODULES = ("expression.py", "kernel.py", "scene_kernel.py", "symbols.py")
DERIVING = ("codegen", "dynamics", "exact", "kernels", "kinematics", *MODULES, *TAYLOR)
ATTITUDE_SCALE = 1.0  # a quaternion has unit norm; an error of an angle counts in rad
RATE_SCALE = 0.0  # an error of omega counts relative to omega


@cache
def _version() -> str:
    """Return what identifies the code that derives: names, sizes and times of its files."""
    found = []
    for place in DERIVING:
        path = PACKAGE / place
        for file in path.glob("*.py") if path.is_dir() else (path,):
            status = file.stat()
            found.append(f"{place}/{file.name} {status.st_size} {status.st_mtime_ns}")
    return "\n".join(sorted(found))


def kernel_key(plan: Plan) -> str:
    """Return the key of a plan's kernel in the cache."""
    return f"scene kernel\n{json.dumps(plan.structure, sort_keys=True)}\n{_version()}"


def scene_kernel(plan: Plan, on_source: Callable[[str, int], object] = lambda source, parameters: None) -> SceneKernel:
    """Return the kernel of a plan, from the cache or derived.

    ``on_source`` gets the C text of the rates and the number of their parameters as soon as they are known.
    """
    saved = library.fetch(kernel_key(plan))
    if saved is not None:
        kernel = SceneKernel(json.loads(saved))
        on_source(kernel.source, len(kernel.rate_parameters))
        return kernel
    from symrot.codegen.scene_kernels import derive_scene_kernel

    kernel = derive_scene_kernel(plan.structure, on_source)
    library.store(kernel_key(plan), json.dumps(kernel.data))
    return kernel


missing_compiler = library.missing


def compiled(plan: Plan) -> tuple[SceneKernel, Path]:
    """Return the kernel of a plan and the library with kernel and stepper.

    Raises
    ------
    CompilerError
        If the compiler refuses the source.
    """
    started: list[library.Building] = []

    def start(source: str, parameters: int) -> None:
        started.append(library.Building(library_source(plan, source, parameters), "motion"))

    try:
        kernel = scene_kernel(plan, start)
    except KeyboardInterrupt:
        library.stop_compilers()
        raise
    finally:
        for building in started:
            building.wait()
    return kernel, started[0].path()


def taylor_library(plan: Plan, kernel: SceneKernel, tolerance: float) -> Path:
    """Return the library that steps a plan by Taylor series, of the order that suits the tolerance.

    Raises
    ------
    InputError
        If the rates have no Taylor series, as where they hold the absolute value of what changes.
    """
    from symrot.propagation import taylor
    from symrot.propagation.invariants import invariant_source

    order = taylor.order_for(tolerance, kernel.rates)
    key = f"taylor {order}\n{kernel_key(plan)}"
    source = library.fetch(key)
    if source is None:
        invariants = invariant_source(kernel, plan.states)
        source = taylor.translation_unit(kernel.rates, *error_blocks(plan), order, invariants)
        library.store(key, source)
    return library.build(source, "taylor", taylor.FLAGS)


def error_blocks(plan: Plan) -> tuple[list[int], list[float]]:
    """Return the edges and the scales of the blocks of states whose errors are judged apart: omega, attitude."""
    rates = sum(name.startswith("omega") for name in plan.states)
    count = len(plan.states)
    edges = [0, *([rates] if 0 < rates < count else []), count]
    return edges, [RATE_SCALE] * (rates > 0) + [ATTITUDE_SCALE] * (count > rates)


def library_source(plan: Plan, source: str, parameters: int) -> str:
    """Return the C text of a library: kernel and stepper."""
    return translation_unit(source, "symrot_rates", len(plan.states), parameters, *error_blocks(plan))

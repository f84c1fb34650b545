"""The functions that people call and that live in no single room: a plan of a scene, the text of a kernel."""

import re
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError
from symrot.planner import Plan, make_plan
from symrot.scene import Scene, load_scene

__all__ = ["TARGETS", "Emitted", "emit", "kernel_names", "plan"]

TARGETS = ("c", "numpy")


class Emitted(NamedTuple):
    """An emitted kernel: the name of its function, the text, and in C the header (empty otherwise)."""

    name: str
    source: str
    header: str


def _scene(source: Scene | str | Path) -> Scene:
    return source if isinstance(source, Scene) else load_scene(source)


def plan(scene: Scene | str | Path) -> Plan:
    """Return what is computed for a scene, what is skipped and why; ``plan(scene).explain()`` is a table of it.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a shipped one, or the path of a scene file.
    """
    return make_plan(_scene(scene))


def emit(kernel: Scene | str | Path, target: str = "c") -> Emitted:
    """Return the text of a kernel of the library, or of a scene's own kernel; the same bytes on every machine.

    Parameters
    ----------
    kernel : Scene, str or Path
        The name of a kernel (:func:`symrot.kernel_names`), of a shipped scene, a scene, or the path of a scene file.
        The kernel of a scene is its equations of motion ``dy/dt``.
    target : str
        ``"c"`` (C99, valid C++) or ``"numpy"``.

    Raises
    ------
    InputError
        For another target, a name that is neither a kernel nor a scene, a scene that cannot be used, or one whose
        plan leaves nothing to integrate.
    """
    from symrot.codegen.c_source import DOUBLE, FLOAT, c_header, c_source
    from symrot.codegen.numpy_source import numpy_source

    if target not in TARGETS:
        raise InputError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    is_kernel = isinstance(kernel, str) and kernel in kernel_names()
    program, description = (_library_kernel if is_kernel else _scene_kernel)(kernel, target)
    name = program.signature.name
    if target == "numpy":
        return Emitted(name, numpy_source(program, description), "")
    reals = (DOUBLE, FLOAT) if is_kernel else (DOUBLE,)
    return Emitted(name, c_source(program, description, reals, is_kernel), c_header(program, description, reals))


def kernel_names() -> tuple[str, ...]:
    """Return the names of the kernels of the library, for :func:`emit`."""
    from symrot.kernels import library

    return library.kernel_names()


def _library_kernel(name: Any, target: str) -> tuple[Any, Any]:
    from symrot.codegen.library_kernels import kernel_description, kernel_program
    from symrot.kernels.library import definition

    return kernel_program(name), kernel_description(definition(name), target)


def _scene_kernel(scene: Scene | str | Path, target: str) -> tuple[Any, Any]:
    from symrot.codegen.scene_kernels import rates_program, scene_description, with_values
    from symrot.dynamics.equations import equations_of_motion

    found = plan(scene)
    if not found.states:
        raise InputError(
            f"{found.scene.name}: expected a scene with states to integrate; every state of it is constant"
        )
    name = re.sub(r"\W", "_", f"{found.scene.name}_rates", flags=re.ASCII)
    name = name if name[0].isalpha() else f"scene_{name}"
    lowered = rates_program(equations_of_motion(found.structure), name)
    description = scene_description(found.scene.title, found.scene.name, target)
    return with_values(lowered.program, lowered.parameters, found.constants), description

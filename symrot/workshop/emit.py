"""The functions that people call and that live in no single room: a plan of a scene, the text of a kernel."""

import re
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from symrot.errors import InputError
from symrot.planning.plan import Plan, make_plan, switched
from symrot.scene.scene import Scene, load_scene

if TYPE_CHECKING:
    from symrot.certificates.certificate import Subject
    from symrot.certificates.rounding.scenes import SceneInputs

__all__ = [
    "TARGETS",
    "Emitted",
    "emit",
    "explain",
    "kernel_names",
    "plan",
    "scene_inputs",
    "scene_kernel_name",
    "subject",
]

TARGETS = ("c", "numpy")


class _Texts(NamedTuple):
    name: str
    source: str
    header: str


class Emitted(_Texts):
    """An emitted kernel: the name of its function, the text, and in C the header (empty otherwise).

    ``certificate`` is the text of its certificate, proven when it is asked for; for a kernel of the library with the
    bounds of its rounding errors on its own box, for a scene's with those it was emitted with.
    """

    kernel: Any = None
    bounds: Mapping[str, Any] | None = None

    @cached_property
    def certificate(self) -> str:
        """The text of the certificate; raises CertificateError where a proof fails."""
        from symrot.certificates.certificate import certificate_text, with_slots
        from symrot.certificates.rounding.bounds_text import library_section

        text = certificate_text(subject(self.kernel, self.bounds))
        section = library_section(self.name, self.source) if _is_kernel(self.kernel) else self.bounds
        return with_slots(text, {"rounding": section}) if isinstance(section, dict) else text


def _scene(source: Scene | str | Path) -> Scene:
    return source if isinstance(source, Scene) else load_scene(source)


def plan(scene: Scene | str | Path) -> Plan:
    """Return what is computed for a scene, what is skipped and why; :func:`explain` is a table of it.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a shipped one, or the path of a scene file.
    """
    found = _scene(scene)
    return make_plan(found, driven=found.table is not None, switched=switched(found))


def explain(scene: Scene | str | Path) -> str:
    """Return the plan of a scene as a table for people: item, kept or skipped, rule, derivation, operations saved.

    Parameters
    ----------
    scene : Scene, str or Path
        As for :func:`plan`.
    """
    from symrot.report.explain import explanation

    return explanation(plan(scene))


def _formulas(scene: Scene | str | Path) -> Plan:
    """Return the plan of a scene whose torques are formulas, which alone has a kernel to print."""
    return make_plan(_scene(scene))


def emit(kernel: Scene | str | Path, target: str = "c", bounds: Mapping[str, Any] | None = None) -> Emitted:
    """Return the text of a kernel of the library, or of a scene's own kernel; the same bytes on every machine.

    Parameters
    ----------
    kernel : Scene, str or Path
        The name of a kernel (:func:`symrot.kernel_names`), of a shipped scene, a scene, or the path of a scene file.
        The kernel of a scene is its equations of motion ``dy/dt``.
    target : str
        ``"c"`` (C99, valid C++) or ``"numpy"``.
    bounds : mapping, optional
        Bounds of the rounding errors of a scene's kernel on a box of yours, for the head of its C and its certificate
        (:func:`symrot.workshop.bounds.section`); a kernel of the library has its own.

    Raises
    ------
    InputError
        For another target, a name that is neither a kernel nor a scene, a scene that cannot be used, or one whose
        plan leaves nothing to integrate.
    """
    from symrot.codegen.printing.c_source import DOUBLE, FLOAT, c_header, c_source
    from symrot.codegen.printing.numpy_source import numpy_source

    if target not in TARGETS:
        raise InputError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    is_kernel = _is_kernel(kernel)
    program, description = _library_kernel(kernel, target) if is_kernel else _scene_kernel(kernel, target, bounds)
    name = program.signature.name
    if target == "numpy":
        found = Emitted(name, numpy_source(program, description), "")
    else:
        reals = (DOUBLE, FLOAT) if is_kernel else (DOUBLE,)
        source = c_source(program, description, reals, is_kernel)
        if is_kernel:  # the head says the bounds of what is under it
            description = _library_kernel(kernel, target, source)[1]
            source = c_source(program, description, reals, is_kernel)
        found = Emitted(name, source, c_header(program, description, reals))
    found.kernel, found.bounds = kernel, bounds
    return found


def _is_kernel(kernel: Any) -> bool:
    return isinstance(kernel, str) and kernel in kernel_names()


def subject(kernel: Scene | str | Path, bounds: Mapping[str, Any] | None = None) -> "Subject":
    """Return a kernel of the library or a scene's own kernel as something to certify, with the texts emitted of it.

    ``bounds`` are those that a scene's kernel is emitted with (:func:`emit`).
    """
    from symrot.certificates.subjects import library_subject, scene_subject
    from symrot.codegen.printing.c_source import MATH_HEADER
    from symrot.codegen.printing.math_header import math_header
    from symrot.dynamics.equations import equations_of_motion
    from symrot.kernels.library import definition

    c, numpy = emit(kernel, "c", bounds), emit(kernel, "numpy")
    is_kernel = _is_kernel(kernel)
    files = {f"{c.name}.c": c.source, f"{c.name}.h": c.header}
    files |= {MATH_HEADER: math_header()} if f'"{MATH_HEADER}"' in c.source else {}
    files[f"../numpy/{c.name}.py" if is_kernel else f"../../numpy/scenes/{c.name}.py"] = numpy.source
    if is_kernel:
        return library_subject(definition(kernel), _library_kernel(kernel, "c")[1], files)
    found = _formulas(kernel)
    equations = equations_of_motion(found.structure)
    lowered, description = _scene_rates(found, equations, "c")
    return scene_subject(equations, lowered.program, lowered.parameters, description, files)


def kernel_names() -> tuple[str, ...]:
    """Return the names of the kernels of the library, for :func:`emit`."""
    from symrot.kernels import library

    return library.kernel_names()


def _library_kernel(name: Any, target: str, source: str = "") -> tuple[Any, Any]:
    """Return a kernel of the library, and what the emitted file says of it; of rounding errors, if its C is given."""
    from symrot.certificates.rounding.bounds_text import in_words
    from symrot.codegen.library_kernels import kernel_description, kernel_program
    from symrot.kernels.library import definition

    return kernel_program(name), kernel_description(definition(name), target, in_words(name, source) if source else "")


def _scene_kernel(
    scene: Scene | str | Path, target: str, bounds: Mapping[str, Any] | None = None
) -> tuple[Any, Any]:  # fmt: skip
    from symrot.certificates.rounding.scenes import contract
    from symrot.codegen.scene_kernels import with_values
    from symrot.dynamics.equations import equations_of_motion

    found = _formulas(scene)
    said = contract(scene_inputs(scene), bounds) if bounds and target == "c" else ()
    lowered, description = _scene_rates(found, equations_of_motion(found.structure), target, said)
    return with_values(lowered.program, lowered.parameters, found.constants), description


def scene_inputs(scene: Scene | str | Path) -> "SceneInputs":
    """Return what a scene's own kernel takes and gives, its parameters and what they are, its first and last time."""
    from symrot.certificates.rounding.scenes import SceneInputs
    from symrot.dynamics.equations import equations_of_motion
    from symrot.planning.scene_kernel import bind

    found = _formulas(scene)
    lowered, _ = _scene_rates(found, equations_of_motion(found.structure), "c")
    values = tuple(bind(lowered.parameters, found.constants))
    formulas = {f"p[{place}]": parameter for place, parameter in enumerate(lowered.parameters)}
    arguments, constants = lowered.program.signature.arguments, found.constants
    return SceneInputs(arguments, values, found.scene.span[:2], formulas, constants)


def scene_kernel_name(scene: str) -> str:
    """Return the name of a scene's own kernel."""
    name = re.sub(r"\W", "_", f"{scene}_rates", flags=re.ASCII)
    return name if name[0].isalpha() else f"scene_{name}"


def _scene_rates(found: Plan, equations: Any, target: str, said: tuple[Any, ...] = ()) -> tuple[Any, Any]:
    """Return the right-hand side of a plan, and what the emitted file says of it."""
    from symrot.codegen.scene_kernels import rates_program, scene_description

    if not found.states:
        raise InputError(
            f"{found.scene.name}: expected a scene with states to integrate; every state of it is constant"
        )
    return rates_program(equations, scene_kernel_name(found.scene.name)), scene_description(
        found.scene.title, found.scene.name, target, said
    )

"""The public functions that plan a scene, explain its plan, and emit the text of a kernel."""

import re
from collections.abc import Mapping
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from symrot.errors import InputError
from symrot.planning.plan import Plan, make_plan, switched
from symrot.scene.scene import Scene, load_scene

if TYPE_CHECKING:
    from symrot.certificates.certificate import KernelUnderTest
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
    """An emitted kernel: its name, its text, and in C its header (empty for NumPy).

    In NumPy the function has the name of the kernel; in C its name is ``function``, with the prefix ``symrot_``.

    ``certificate`` is the text of the kernel's certificate, which is proven at the first access. The certificate of a
    library kernel contains the bounds of its rounding errors on its own box; the certificate of a scene's kernel
    contains the bounds that were passed to :func:`emit`.

    Attributes
    ----------
    name : str
        Name of the kernel.
    source, header : str
        The text of the kernel and, in C, of its header.

    Examples
    --------
    >>> import symrot
    >>> "double" in symrot.emit("euler_zxz_body_rates").source
    True
    """

    kernel: Any = None
    bounds: Mapping[str, Any] | None = None

    @classmethod
    def of(
        cls, kernel: Any, bounds: Mapping[str, Any] | None, name: str, source: str, header: str = ""
    ) -> "Emitted":  # fmt: skip
        """Return an :class:`Emitted`: the texts of a kernel, with the data from which its certificate is proven."""
        emitted = cls(name, source, header)
        emitted.kernel, emitted.bounds = kernel, bounds
        return emitted

    @property
    def function(self) -> str:
        """The name of the C function for one sample in double precision."""
        return f"symrot_{self.name}"

    @cached_property
    def certificate(self) -> str:
        """The text of the kernel's certificate; raises CertificateError if a proof fails."""
        from symrot.certificates.certificate import certificate_text, with_sections

        text = certificate_text(subject(self.kernel, self.bounds))
        return with_sections(text, {"rounding": self.bounds}) if isinstance(self.bounds, dict) else text


def _scene(source: Scene | str | Path) -> Scene:
    return source if isinstance(source, Scene) else load_scene(source)


def plan(scene: Scene | str | Path) -> Plan:
    """Return the plan of a scene: each item that is computed or skipped, and why; :func:`explain` prints it as a table.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a shipped scene, or the path of a scene file.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        For a scene that cannot be used.

    Notes
    -----
    Source: each row names the derivation that justifies it.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").scene.name
    'tumbling_prism'
    """
    loaded = _scene(scene)
    return make_plan(loaded, external_torque=loaded.table is not None, switched=switched(loaded))


def explain(scene: Scene | str | Path) -> str:
    """Return the plan of a scene as a table of text: item, computed or skipped, rule, derivation, operations saved.

    Parameters
    ----------
    scene : Scene, str or Path
        As for :func:`plan`.

    Returns
    -------
    str

    Raises
    ------
    InputError
        As for :func:`plan`.

    Examples
    --------
    >>> import symrot
    >>> "derivation" in symrot.explain("tumbling_prism")
    True
    """
    from symrot.report.explain import explanation

    return explanation(plan(scene))


def _formulas(scene: Scene | str | Path) -> Plan:
    """Return the plan of a scene whose torques are all formulas, as a kernel requires.

    Raise InputError for a scene with another torque: such a scene has no kernel.
    """
    return make_plan(_scene(scene))


def emit(kernel: Scene | str | Path, target: str = "c", bounds: Mapping[str, Any] | None = None) -> Emitted:
    """Return the text of a kernel of the library, or of a scene's own kernel, the same bytes on every machine.

    Parameters
    ----------
    kernel : Scene, str or Path
        The name of a kernel (:func:`symrot.kernel_names`) or of a shipped scene, a scene, or the path of a scene file.
        The kernel of a scene computes its equations of motion ``dy/dt``.
    target : str
        ``"c"`` (C99, valid C++) or ``"numpy"``.
    bounds : mapping, optional
        Bounds of the rounding errors of a scene's kernel on a box of your choice, for the head comment of its C and for
        its certificate (:func:`symrot.workshop.bounds.section`); a kernel of the library has its own.

    Returns
    -------
    Emitted
        ``.name``, ``.source`` and ``.header``; ``.certificate`` is proven at the first access.

    Raises
    ------
    InputError
        For an unknown target, a name that is neither a kernel nor a scene, an unusable scene, or a scene without a
        state to integrate.

    Notes
    -----
    Convention: the head comment of each kernel states frames, units and domain of its arguments.

    Examples
    --------
    >>> import symrot
    >>> symrot.emit("euler_zxz_body_rates").name
    'euler_zxz_body_rates'
    """
    if target not in TARGETS:
        raise InputError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    return _library_kernel(str(kernel), target) if _is_kernel(kernel) else _scene_kernel(kernel, target, bounds)


def _is_kernel(kernel: Any) -> bool:
    return isinstance(kernel, str) and kernel in kernel_names()


def subject(kernel: Scene | str | Path, bounds: Mapping[str, Any] | None = None) -> "KernelUnderTest":
    """Return a kernel with its emitted texts, as the object that a certificate is made for.

    ``bounds`` are the rounding bounds with which a scene's kernel is emitted (see :func:`emit`).
    """
    from symrot.certificates.kernel_under_test import library_kernel_under_test, scene_kernel_under_test
    from symrot.codegen.library_kernels import kernel_description
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
        return library_kernel_under_test(definition(kernel), kernel_description(definition(kernel), "c"), files)
    scene_plan = _formulas(kernel)
    equations = equations_of_motion(scene_plan.structure)
    lowered, description = _scene_rates(scene_plan, equations, "c")
    return scene_kernel_under_test(equations, lowered.program, lowered.parameters, description, files)


def kernel_names() -> tuple[str, ...]:
    """Return the names of the kernels of the library, for :func:`emit`.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> import symrot
    >>> "euler_zxz_body_rates" in symrot.kernel_names()
    True
    """
    from symrot.kernels import library

    return library.kernel_names()


@cache
def _library_kernel(name: str, target: str) -> Emitted:
    """Return the text of a kernel of the library with its rounding bounds; it is computed once per process.

    The head comment states the bounds of the operations below it, so the operations are printed and bounded first.
    """
    from symrot.certificates.rounding.bounds_text import bounds_sentence, library_section
    from symrot.codegen.library_kernels import kernel_description, kernel_program
    from symrot.codegen.printing.c_source import DOUBLE, FLOAT, c_functions, c_header, with_head
    from symrot.codegen.printing.numpy_source import numpy_source
    from symrot.kernels.library import definition

    program = kernel_program(name)
    if target == "numpy":
        return Emitted.of(name, None, name, numpy_source(program, kernel_description(definition(name), target)))
    reals = (DOUBLE, FLOAT)
    functions = c_functions(program, reals, near=True)
    section = library_section(name, functions)
    bounds = section if isinstance(section, dict) else None
    description = kernel_description(definition(name), target, bounds_sentence(name, functions))
    source, header = with_head(program, description, functions), c_header(program, description, reals)
    return Emitted.of(name, bounds, name, source, header)


def _scene_kernel(scene: Scene | str | Path, target: str, bounds: Mapping[str, Any] | None) -> Emitted:
    from symrot.certificates.rounding.scenes import header_lines
    from symrot.codegen.printing.c_source import c_header, c_source
    from symrot.codegen.printing.numpy_source import numpy_source
    from symrot.codegen.scene_kernels import with_values
    from symrot.dynamics.equations import equations_of_motion

    scene_plan = _formulas(scene)
    contract_lines = header_lines(scene_inputs(scene), bounds) if bounds and target == "c" else ()
    lowered, description = _scene_rates(scene_plan, equations_of_motion(scene_plan.structure), target, contract_lines)
    program = with_values(lowered.program, lowered.parameters, scene_plan.constants)
    name = program.signature.name
    if target == "numpy":
        return Emitted.of(scene, bounds, name, numpy_source(program, description))
    return Emitted.of(scene, bounds, name, c_source(program, description), c_header(program, description))


def scene_inputs(scene: Scene | str | Path) -> "SceneInputs":
    """Return the arguments of a scene's own kernel, values and formulas of its parameters, and its time span."""
    from symrot.certificates.rounding.scenes import SceneInputs
    from symrot.dynamics.equations import equations_of_motion
    from symrot.planning.scene_kernel import bind

    scene_plan = _formulas(scene)
    lowered, _ = _scene_rates(scene_plan, equations_of_motion(scene_plan.structure), "c")
    values = tuple(bind(lowered.parameters, scene_plan.constants))
    formulas = {f"p[{place}]": parameter for place, parameter in enumerate(lowered.parameters)}
    arguments, constants = lowered.program.signature.arguments, scene_plan.constants
    return SceneInputs(arguments, values, scene_plan.scene.span[:2], formulas, constants)


def scene_kernel_name(scene: str) -> str:
    """Return the name of a scene's own kernel."""
    name = re.sub(r"\W", "_", f"{scene}_rates", flags=re.ASCII)
    return name if name[0].isalpha() else f"scene_{name}"


def _scene_rates(
    scene_plan: Plan, equations: Any, target: str, contract_lines: tuple[Any, ...] = ()
) -> tuple[Any, Any]:
    """Return the right-hand side of a plan's equations of motion as a program, and the emitted file's description."""
    from symrot.codegen.scene_kernels import rates_program, scene_description

    if not scene_plan.states:
        raise InputError(
            f"{scene_plan.scene.name}: expected a scene with states to integrate; all its states are constant"
        )
    return rates_program(equations, scene_kernel_name(scene_plan.scene.name)), scene_description(
        scene_plan.scene.title, scene_plan.scene.name, target, contract_lines
    )

"""The texts of one kernel of the library or of one scene: C, NumPy, JavaScript, JAX and its certificate.

The argument ``bounds`` of the methods has the bounds of a scene kernel's rounding errors. Only the kernel's certificate
and the comment at the head of its C files depend on these bounds. Library kernels ignore ``bounds``.
"""

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import Any, ClassVar

from symrot.certificates.certificate import KernelUnderTest, certificate_text, with_sections
from symrot.certificates.kernel_under_test import library_kernel_under_test, scene_kernel_under_test
from symrot.certificates.rounding.bounds_text import bounds_sentence, library_section
from symrot.certificates.rounding.scenes import SceneInputs, header_lines
from symrot.codegen.derivatives import Formulas
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.codegen.lowering.lower import Lowered
from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.c_function import DOUBLE, FLOAT
from symrot.codegen.printing.c_source import MATH_HEADER, c_functions, c_header, with_head
from symrot.codegen.printing.jax_source import jax_source
from symrot.codegen.printing.js_source import js_source
from symrot.codegen.printing.math_header import math_header
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.codegen.scene_kernels import (
    corner_note,
    rate_derivatives,
    rates_jacobian_program,
    rates_program,
    scene_description,
    with_values,
)
from symrot.dynamics.equations import Equations, equations_of_motion
from symrot.errors import InputError, nearest
from symrot.formula.program import Argument, Program
from symrot.kernels.jacobian import jacobian_name
from symrot.kernels.library import definition, is_kernel, kernel_names
from symrot.planning.plan import Plan, make_plan
from symrot.planning.scene_kernel import bind
from symrot.scene.file import shipped_names
from symrot.scene.scene import Scene, SceneSource, load_scene

__all__ = ["PRINTERS", "SUFFIX", "Bounds", "KernelText", "SceneText", "kernel_text", "scene_kernel_name", "scene_text"]

SUFFIX = {"c": ".c", "numpy": ".py", "js": ".js", "jax": "_jax.py"}
"""The ending of a source file in each language that kernels are printed in; NumPy and JAX are both Python."""

PRINTERS: Mapping[str, Callable[[Program, Description], str]] = {
    "numpy": numpy_source, "js": js_source, "jax": jax_source,
}  # fmt: skip
"""Language -> the function that prints a program in it, with a head comment; C is printed otherwise."""

Bounds = Mapping[str, Any]


class KernelText(ABC):
    """The texts of one kernel: its source in each language, and its certificate."""

    name: str
    folders: ClassVar[Mapping[str, str]]  # target -> its folder, relative to the folder of the certificate
    has_certificate: ClassVar[bool] = True

    @property
    def parameter_values(self) -> tuple[float, ...]:
        """The values of the argument ``p``, which a scene sets; empty for a kernel of the library."""
        return ()

    @abstractmethod
    def c(self, bounds: Bounds | None = None) -> tuple[str, str]:
        """Return the pair (C source, header); ``bounds`` are rounding bounds for the comment at the head."""

    @abstractmethod
    def _printed(self, target: str) -> str:
        """Return the source in the language ``target``, a key of :data:`PRINTERS`."""

    @abstractmethod
    def under_test(self, bounds: Bounds | None = None) -> KernelUnderTest:
        """Return the kernel as one object from which its certificate is made: formulas, laws, and texts of the files.

        The laws are equations that are proven from the formulas. ``bounds`` are rounding bounds for the comment at the
        head of the C files.
        """

    def rounding(self, bounds: Bounds | None) -> Bounds | None:
        """Return the section ``rounding`` of the certificate, which states ``bounds``; None if there are no bounds."""
        return bounds

    def certificate(self, bounds: Bounds | None = None) -> str:
        """Return the text of the kernel's certificate, after all its statements are proven.

        CertificateError is raised if a proof fails.
        """
        text, section = certificate_text(self.under_test(bounds)), self.rounding(bounds)
        # without bounds of rounding errors, the section is left out
        return with_sections(text, {"rounding": section}) if isinstance(section, dict) else text

    def c_files(self, bounds: Bounds | None = None) -> dict[str, str]:
        """Return the C files as a map from name to text: the header, the source and the headers that they need."""
        source, header = self.c(bounds)
        shared = {MATH_HEADER: math_header()} if f'"{MATH_HEADER}"' in source else {}
        return {f"{self.name}.h": header, f"{self.name}.c": source} | shared

    def source(self, target: str, bounds: Bounds | None = None) -> str:
        """Return the source in the language ``target``: ``"c"``, ``"numpy"``, ``"js"`` or ``"jax"``."""
        if target == "c":
            return self.c(bounds)[0]
        if target not in self._sources:
            self._sources[target] = self._printed(target)
        return self._sources[target]

    @cached_property
    def _sources(self) -> dict[str, str]:
        """The sources that were printed so far, by language, except C."""
        return {}

    def files(self, target: str, bounds: Bounds | None = None) -> dict[str, str]:
        """Return the files in the language ``target`` as a map from name to text; in C the header comes first."""
        return self.c_files(bounds) if target == "c" else {f"{self.name}{SUFFIX[target]}": self.source(target)}

    def _certified_files(self, bounds: Bounds | None) -> dict[str, str]:
        """Return the files whose hashes a certificate states, as a map from name to text; the C source comes first."""
        files, source = self.c_files(bounds), f"{self.name}.c"
        others = {
            f"{folder}/{file}": text
            for target, folder in self.folders.items()
            for file, text in self.files(target).items()
        }
        return {source: files[source]} | files | others


class LibraryText(KernelText):
    """The source of a kernel of symrot's library in each language, and its certificate.

    The bounds of the kernel's rounding errors hold on the ranges of inputs that the kernel's definition states.
    """

    folders: ClassVar[Mapping[str, str]] = {"numpy": "../numpy", "js": "../js", "jax": "../jax"}

    def __init__(self, name: str) -> None:
        self.name, self._definition = name, definition(name)

    def c(self, bounds: Bounds | None = None) -> tuple[str, str]:
        """Return the pair (C source, header), each with an opening comment that states bounds of rounding errors."""
        # the bounds that come with symrot; only a scene's kernel needs ``bounds``
        return self._c

    @cached_property
    def _functions(self) -> str:
        return c_functions(kernel_program(self.name), (DOUBLE, FLOAT), branch_free=True)

    @cached_property
    def _section(self) -> dict[str, Any] | str:
        return library_section(self.name, self._functions)

    @cached_property
    def _c(self) -> tuple[str, str]:
        """Return the C source and its header file.

        The rounding errors of the operations are bounded first, because the opening comment states the bounds.
        """
        program = kernel_program(self.name)
        description = kernel_description(self._definition, "c", bounds_sentence(self.name, self._section))
        return with_head(program, description, self._functions), c_header(program, description, (DOUBLE, FLOAT))

    def _printed(self, target: str) -> str:
        return PRINTERS[target](kernel_program(self.name), kernel_description(self._definition, target))

    def rounding(self, bounds: Bounds | None) -> Bounds | None:
        """Return the bounds of this kernel's rounding errors that come with symrot; None if there are none.

        The argument ``bounds`` is not used.
        """
        return self._section if isinstance(self._section, dict) else None

    def under_test(self, bounds: Bounds | None = None) -> KernelUnderTest:
        """Return the kernel with its C files, formulas and laws, for proofs that the C files compute the formulas."""
        description = kernel_description(self._definition, "c")
        # the C files' comments state the bounds that come with symrot, not ``bounds``
        return library_kernel_under_test(self._definition, description, self._certified_files(bounds))


class SceneText(KernelText):
    """The texts (C, NumPy, JavaScript, ..) of a kernel that computes the equations of motion of a scene.

    Parameters
    ----------
    scene : Scene
        A scene whose torques are all formulas; InputError is raised for another torque, or if no state is integrated.
    jacobian : sequence of str
        States and constants with respect to which the kernel also differentiates the rates.
    """

    # the equations are derived when the object is made, once for all its texts
    folders: ClassVar[Mapping[str, str]] = {
        "numpy": "../../numpy/scenes", "js": "../../js/scenes", "jax": "../../jax/scenes",
    }  # fmt: skip

    def __init__(self, scene: Scene, jacobian: Sequence[str] = ()) -> None:
        self.plan: Plan = make_plan(scene)
        self.scene, self.jacobian = self.plan.scene, tuple(jacobian)
        self.name = jacobian_name(scene_kernel_name(self.plan.scene.name), self.jacobian)
        if not self.plan.states:
            raise InputError(
                f"{self.scene.name}: expected a scene with states to integrate; all its states are constant"
            )

    @cached_property
    def _equations(self) -> Equations:
        return equations_of_motion(self.plan.structure)

    @cached_property
    def _formulas(self) -> tuple[Formulas, tuple[Argument, ...]]:
        """The pair (formulas, output arrays) of the rates ``dy/dt`` and of their derivatives.

        ``jacobian`` names the states and constants with respect to which the rates are differentiated.
        """
        try:
            return rate_derivatives(self._equations, self.jacobian)
        except InputError as reason:
            raise InputError(f"{self.scene.name}: {reason}") from None

    @cached_property
    def _lowered(self) -> Lowered:
        if not self.jacobian:
            return rates_program(self._equations, self.name)
        return rates_jacobian_program(self._equations, self.name, *self._formulas)

    @cached_property
    def program(self) -> Program:
        """The operations that compute the rates ``dy/dt``."""
        # parameters are described by their formulas in the scene's constants, and by their values
        return with_values(self._lowered.program, self._lowered.parameters, self.plan.constants)

    @cached_property
    def _functions(self) -> str:
        return c_functions(self.program)

    def _description(self, target: str, lines: tuple[tuple[str, str], ...] = ()) -> Description:
        note = corner_note(self._lowered.program, "the derivatives") if self.jacobian else ""
        return scene_description(self.scene.title, self.scene.name, target, lines, self.jacobian, note)

    def c(self, bounds: Bounds | None = None) -> tuple[str, str]:
        """Return the pair (C source, header); the comment at the head of the source states ``bounds``, if any."""
        description = self._description("c", header_lines(self.inputs, bounds) if bounds else ())
        return with_head(self.program, description, self._functions), c_header(self.program, description)

    def _printed(self, target: str) -> str:
        return PRINTERS[target](self.program, self._description(target))

    def under_test(self, bounds: Bounds | None = None) -> KernelUnderTest:
        """Return the kernel with its texts and equations, for proofs that the texts compute the equations."""
        lowered, files, (formulas, _) = self._lowered, self._certified_files(bounds), self._formulas
        # comments in the C files state ``bounds``
        return scene_kernel_under_test(
            self._equations, lowered.program, lowered.parameters, self._description("c"), files,
            dict(formulas.outputs), formulas.named,
        )  # fmt: skip

    @cached_property
    def inputs(self) -> SceneInputs:
        """The inputs of the kernel: its arguments, parameters and constants, and the scene's first and last time."""
        parameters, constants = self._lowered.parameters, self.plan.constants
        formulas = {f"p[{place}]": parameter for place, parameter in enumerate(parameters)}
        arguments, values = self._lowered.program.signature.arguments, tuple(bind(parameters, constants))
        # the bounds of the kernel's rounding errors depend on them
        return SceneInputs(arguments, values, self.scene.span[:2], formulas, constants)

    @property
    def parameter_values(self) -> tuple[float, ...]:
        """The scene's values of the kernel's parameters, which the emitted function takes as the array ``p``."""
        return tuple(self.inputs.parameters)


def kernel_text(kernel: KernelText | SceneSource, jacobian: Sequence[str] = ()) -> KernelText:
    """Return the object that prints all texts of a kernel, of the library or of a scene.

    ``jacobian`` names the inputs with respect to which the kernel also differentiates its outputs.
    """
    if isinstance(kernel, KernelText):
        return kernel
    # name of a library kernel (made once per process) or of a shipped scene, or path of a scene file
    if isinstance(kernel, str):
        if is_kernel(kernel):
            return _library_text(jacobian_name(kernel, jacobian))
        hint = nearest(kernel, [*kernel_names(), *shipped_names()])
        if kernel.isidentifier() and kernel not in shipped_names() and not Path(kernel).exists():
            after = f" ({hint})" if hint else ""
            raise InputError(
                f"expected a kernel of `symrot emit --list`, a scene or a scene file, got {kernel[:60]!r}{after}"
            )
    return scene_text(kernel, jacobian)


@cache
def _library_text(name: str) -> LibraryText:
    return LibraryText(name)


def scene_text(scene: SceneSource, jacobian: Sequence[str] = ()) -> SceneText:
    """Return the texts of a scene's kernel, which computes the rates ``dy/dt`` of its motion.

    It also computes their derivatives with respect to the states and constants that ``jacobian`` names.
    """
    return SceneText(load_scene(scene), jacobian)


def scene_kernel_name(scene: str) -> str:
    """Return the name of a scene's own kernel: ``t_handle`` -> ``t_handle_rates``, ``2-b`` -> ``scene_2_b_rates``."""
    name = re.sub(r"\W", "_", f"{scene}_rates", flags=re.ASCII)
    return name if name[0].isalpha() else f"scene_{name}"

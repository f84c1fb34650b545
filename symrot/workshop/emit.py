"""The public functions that make the plan (the smallest set of equations) of a scene, explain it, and emit kernels."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import symrot
from symrot.errors import InputError
from symrot.planning.general_structure import switched
from symrot.planning.plan import Plan, make_plan
from symrot.scene.scene import SceneSource, load_scene

if TYPE_CHECKING:
    from symrot.workshop.kernel_text import KernelText

__all__ = ["TARGETS", "Emitted", "emit", "explain", "kernel_names", "plan"]

TARGETS = ("c", "numpy", "js", "jax")


class _Texts(NamedTuple):
    name: str
    source: str
    header: str


class Emitted(_Texts):
    """An emitted kernel: its name, its text, and in C its header.

    Its certificate is proven when the property ``certificate`` is first read.

    Attributes
    ----------
    name : str
        Name of the kernel.
    source, header : str
        The text of the kernel and, in C, of its header; in other languages the header is empty.

    Notes
    -----
    In C the function's name is ``symrot_`` and the kernel's name (property ``function``); in other languages it is the
    kernel's name.
    The certificate of a library kernel states error bounds on the standard ranges of its inputs; that of a scene's
    kernel states the bounds that were passed to :func:`emit`.

    Examples
    --------
    >>> import symrot
    >>> "double" in symrot.emit("euler_zxz_body_rates").source
    True
    """

    text: "KernelText"
    bounds: Mapping[str, Any] | None

    @classmethod
    def of(cls, text: "KernelText", target: str, bounds: Mapping[str, Any] | None) -> "Emitted":
        """Return the texts of a kernel in the language ``target``, such as ``"c"``."""
        # ``bounds``: those that were passed to ``emit``, or None
        source, header = text.c(bounds) if target == "c" else (text.source(target), "")
        emitted = cls(text.name, source, header)
        emitted.text, emitted.bounds = text, bounds
        return emitted

    def __repr__(self) -> str:
        return f"<Emitted {self.name}: {self.source.count(chr(10))} lines>"

    def _repr_markdown_(self) -> str:
        return symrot.in_notebook(self)

    @property
    def function(self) -> str:
        """The name of the C function for one sample in double precision: ``symrot_`` and the name of the kernel."""
        return f"symrot_{self.name}"

    @property
    def parameters(self) -> tuple[float, ...]:
        """The values of the argument ``p``, which a scene sets; empty for a kernel of the library."""
        return self.text.parameter_values

    @cached_property
    def certificate(self) -> str:
        """The text of the kernel's certificate, a JSON file of proofs; CertificateError is raised if a proof fails."""
        return self.text.certificate(self.bounds)


def plan(scene: SceneSource) -> Plan:
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
    Source: each item of the plan names the derivation that justifies it.

    Examples
    --------
    >>> import symrot
    >>> symrot.plan("tumbling_prism").scene.name
    'tumbling_prism'
    """
    loaded = load_scene(scene)
    return make_plan(loaded, external_torque=loaded.table is not None, switched=switched(loaded))


def explain(scene: SceneSource) -> str:
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


def emit(
    kernel: SceneSource, target: str = "c", bounds: Mapping[str, Any] | None = None, jacobian: Sequence[str] = (),
    step: str | None = None, order: int | None = None,
) -> Emitted:  # fmt: skip
    """Return the text of a library kernel, or of a scene's own kernel; it is the same on every machine.

    Parameters
    ----------
    kernel : Scene, str or Path
        The name of a kernel (:func:`symrot.kernel_names`) or of a shipped scene, a scene, or the path of a scene file.
        The kernel of a scene computes its equations of motion ``dy/dt``.
    target : str
        ``"c"`` (C99, valid C++), ``"numpy"``, ``"js"`` (a JavaScript module) or ``"jax"`` (a pure function for
        ``jax.jit``, ``jax.vmap`` and ``jax.grad``).
    bounds : mapping, optional
        Bounds of the rounding errors of a scene's kernel on a box of your choice, from
        :func:`symrot.workshop.bounds.section`. They are stated in the head comment of its C text and in its
        certificate. A library kernel needs none: it states the bounds on its own box.
    jacobian : sequence of str
        Inputs with respect to which the kernel also differentiates all outputs, in the order in which the derivatives
        are printed: names of arguments (``"omega"``) or of single components (``"omega_1"``). For a scene: ``"y"``,
        ``"omega"``, ``"q"``, a state, or a physical constant such as ``"A"``. The derivatives of ``dy`` with respect to
        ``omega`` are the output ``dy_by_omega``, row by row: one row for each component of ``dy``.
    step : str, optional
        ``"rk4"``, ``"taylor"``, ``"dop853"`` or ``"exact"``: emit one time step of a scene instead of its rates, the
        function ``next = f(t, x, p, dt)``, with C files for double and float and a test against known values.
    order : int, optional
        Order of the step ``"taylor"``, 1 to 16 (default 8).

    Returns
    -------
    Emitted
        It has ``.name``, ``.source`` and ``.header``; ``.certificate`` is proven when it is first read.

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
    >>> symrot.emit("quaternion_dcm", jacobian=["q"]).name
    'quaternion_dcm_by_q'
    """
    if isinstance(jacobian, str) or not all(isinstance(name, str) for name in jacobian):
        raise InputError(f"jacobian: expected a list of names such as ['omega'], got {jacobian!r}")
    if target not in TARGETS:
        raise InputError(f"target: expected one of {', '.join(TARGETS)}, got {target!r}")
    from symrot.workshop.kernel_text import kernel_text

    if step is not None:
        from symrot.workshop.step_text import step_text

        return Emitted.of(step_text(kernel, step, order, jacobian), target, bounds)
    if order is not None:
        raise InputError(f"order: expected a step as well, such as step='taylor', got only the order {order}")
    return Emitted.of(kernel_text(kernel, jacobian), target, bounds)


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

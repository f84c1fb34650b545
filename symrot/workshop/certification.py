"""The public functions that certify and audit kernels and bound their rounding errors."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from symrot.certificates.step_certificate import is_step
from symrot.errors import InputError
from symrot.formula import exact_numbers
from symrot.scene.scene import SceneSource, load_scene
from symrot.workshop import bounds as rounding
from symrot.workshop import certify as certificates
from symrot.workshop.steps import certify as steps

__all__ = [
    "Audit",
    "Certificate",
    "LargestBox",
    "OutputError",
    "RoundingBounds",
    "audit",
    "bound",
    "certify",
    "largest_box",
]

Ranges = Sequence[str] | Mapping[str, tuple[Any, Any]]
Progress = Callable[[str], object]


def _silent(line: str) -> None:
    """Ignore a line about progress; this is the default for functions that report progress."""


# each function returns a frozen dataclass that ``print`` shows as text
@dataclass(frozen=True)
class Certificate:
    """Proofs about one emitted kernel; ``print`` shows them as `symrot certify` does.

    Attributes
    ----------
    kernel : str
        Name of the C function.
    title : str
        What the kernel computes.
    laws : tuple of str
        The laws that are proven from the kernel's formulas.
    proofs : tuple of str
        The kinds of proof that the certificate contains, among ``"laws"``, ``"Coq"``, ``"C text"``, ``"rounding"``,
        ``"object code"`` and, for a step, ``"truncation"``.
    data : mapping
        The whole certificate, as in the file NAME.cert.json.
    files : tuple of Path
        The files that were written.
    objects_compared : bool
        Whether the call of :func:`certify` that returned this certificate compared object code itself. If not, a
        verdict on object code in the certificate comes from an earlier call.

    Examples
    --------
    >>> import symrot
    >>> symrot.certify("euler_zxz_body_rates", rounding=False).kernel
    'euler_zxz_body_rates'
    """

    kernel: str
    title: str
    laws: tuple[str, ...]
    proofs: tuple[str, ...]
    data: Mapping[str, Any] = field(repr=False)
    files: tuple[Path, ...] = ()
    objects_compared: bool = False

    @property
    def bits_unproven(self) -> bool:
        """Whether :func:`certify` compared object code without proving that it computes the same bits as the C text.

        The proof is about strict code: code compiled with flags that forbid a compiler to change any bit of a result,
        such as ``-ffp-contract=off``. The value is True if strict code differs from the C text, or if object code was
        compared but none of it is strict. It is False if this call of :func:`certify` compared no object code.
        """
        return self.objects_compared and certificates.lacks_proof_of_bits([dict(self.data)])

    def __str__(self) -> str:
        if is_step(self.data):
            return "\n".join(steps.lines(dict(self.data)))
        return "\n".join(certificates.lines(dict(self.data), self.objects_compared))


@dataclass(frozen=True)
class Audit:
    """The result of a successful audit of certificates; ``print`` shows the statements that were checked.

    An audit that fails raises CertificateError instead.

    Attributes
    ----------
    statements : mapping of str to tuple of str
        A map from the path of each certificate to the statements that hold, and to notes on what was not checked.
    flags : tuple of str
        What still holds under the compiler flags passed to the audit; empty if no flags were passed.

    Examples
    --------
    >>> import symrot
    >>> symrot.Audit({"a.cert.json": ("the laws hold",)}).statements["a.cert.json"]
    ('the laws hold',)
    """

    statements: Mapping[str, tuple[str, ...]]
    flags: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join([*(line for lines in self.statements.values() for line in lines), *self.flags])


@dataclass(frozen=True)
class OutputError:
    """A bound of the rounding error of one output of a kernel.

    Attributes
    ----------
    output : str
        The output, such as ``"dq[0]"``.
    bound : float
        No computed value on the box differs by more than this from the exact value; in the unit of the output.
    pointwise : float
        The largest error bound found at a single point of the box; ``bound`` cannot be smaller than this number.
    converged : bool
        Whether ``bound`` is about as small as this method can make it.
    modulo_turns : bool
        Whether the error is measured modulo 2 pi.

    Examples
    --------
    >>> import symrot
    >>> symrot.OutputError("dq[0]", 1e-15, 9e-16, True, False).bound
    1e-15
    """

    output: str
    bound: float
    pointwise: float
    converged: bool
    modulo_turns: bool


@dataclass(frozen=True)
class RoundingBounds:
    """Bounds of the rounding errors of a kernel on a box of inputs; ``print`` shows them as `symrot bound` does.

    Attributes
    ----------
    kernel : str
        Name of the C function.
    precision : str
        ``"double"`` or ``"float"``.
    box : mapping of str to (float, float)
        A map from each input, such as ``"theta"``, ``"omega[0]"`` or ``"y[2]"``, to its range, in the input's unit.
    outputs : tuple of OutputError
        For each output of the kernel, the bound of its rounding error.
    assumptions : tuple of str
        The assumptions under which the bounds hold.
    data : mapping
        The bounds as plain data, as in a certificate.

    Examples
    --------
    >>> import symrot
    >>> bounds = symrot.bound("euler_zxz_body_rates", {"theta": (1, 2)})
    >>> len(bounds.outputs)
    3
    """

    kernel: str
    precision: str
    box: Mapping[str, tuple[float, float]]
    outputs: tuple[OutputError, ...]
    assumptions: tuple[str, ...]
    data: Mapping[str, Any] = field(repr=False)

    @property
    def largest(self) -> float:
        """The largest of the error bounds of all outputs; their units may differ."""
        return max(output.bound for output in self.outputs)

    def __str__(self) -> str:
        return "\n".join(rounding.lines(self.data))


@dataclass(frozen=True)
class LargestBox:
    """The largest box of inputs, of given proportions, on which no rounding error of a kernel exceeds a target.

    Attributes
    ----------
    kernel : str
        Name of the C function.
    target : float
        The largest error that is allowed, in the unit of the outputs.
    size : float
        The factor by which ranges are wider than in the box from which the search started.
    box : mapping of str to (float, float)
        A map from each input, such as ``"theta"``, ``"omega[0]"`` or ``"y[2]"``, to its range, in the input's unit.
    error : float
        The largest error bound of an output on that box.
    data : mapping
        The same results as plain data.

    Examples
    --------
    >>> import symrot
    >>> symrot.LargestBox("euler_zxz_body_rates", 1e-13, 2.8, {"theta": (0.1, 2.9)}, 9.9e-14, {}).box["theta"]
    (0.1, 2.9)
    """

    kernel: str
    target: float
    size: float
    box: Mapping[str, tuple[float, float]]
    error: float
    data: Mapping[str, Any] = field(repr=False)

    def __str__(self) -> str:
        return "\n".join(rounding.target_lines(self.data))


def certify(
    kernel: str | Path,
    box: Ranges = (),
    *,
    directory: str | Path | None = None,
    objects: bool = False,
    rounding: bool = True,
    step: str | None = None,
    order: int | None = None,
    progress: Progress = _silent,
) -> Certificate:
    """Prove that a kernel computes its formulas, and return the certificate.

    Parameters
    ----------
    kernel : str or Path
        A kernel of the library, a scene, or a file NAME.c or NAME.cert.json exactly as symrot emits it.
    box : mapping or sequence of str
        Ranges of inputs for which rounding errors are bounded, as for :func:`bound`. All other inputs have the kernel's
        own ranges. The errors of a scene's kernel, or of a kernel of derivatives, are bounded only if ``box`` is not
        empty.
    directory : str or Path, optional
        Folder for the kernel and its certificate; without it no file is written.
    objects : bool
        Whether to compile the kernel with each installed compiler and compare the object code with the C text.
    rounding : bool
        Whether to compute bounds of rounding errors now; if not, the certificate of a library kernel contains the
        bounds that come with symrot.
    step : str, optional
        ``"rk4"``, ``"taylor"``, ``"dop853"`` or ``"exact"``: certify one time step of a scene instead of its rates, as
        :func:`symrot.emit` prints it. With a ``box`` of the states and of ``dt``, rounding and truncation of one step
        are bounded.
    order : int, optional
        Order of the step ``"taylor"``, 1 to 16 (default 8).
    progress : callable
        Called with a line of text as each part of the work begins.

    Returns
    -------
    Certificate

    Raises
    ------
    InputError
        For an unknown kernel, an edited file or a box that cannot be used, or if ``objects`` is true and there is no
        compiler or no ``objdump``.
    CertificateError
        If a proof fails.
    CompilerError
        If ``objects`` is true and a compiler fails.

    Notes
    -----
    Convention: SI units, angles in rad; a certificate names frames and units of every input.
    Source: ``docs/certificates.md`` explains what each proof covers.

    Examples
    --------
    >>> import symrot
    >>> symrot.certify("euler_zxz_body_rates", rounding=False).laws
    ('B d(angles)/dt is the given angular velocity',)
    """
    folder = None if directory is None else Path(directory)
    if step is not None:
        if objects or not rounding:
            raise InputError(
                "certify: expected neither objects nor rounding=False for a step, because both are options for kernels"
            )
        data, files = steps.certify_step(str(kernel), step, order, _ranges(box), folder, progress)
        return Certificate(data["kernel"], data["title"], (), steps.proofs(data), data, tuple(files))
    if order is not None:
        raise InputError(f"order: expected a step as well, such as step='taylor', got only the order {order}")
    data, files = certificates.certify(str(kernel), _ranges(box), folder, objects, rounding, progress)
    laws = tuple(law["law"] for law in data["laws"])
    return Certificate(data["kernel"], data["title"], laws, certificates.proofs(data), data, tuple(files), objects)


def audit(
    *paths: str | Path,
    object_file: str | Path | None = None,
    flags: str | None = None,
    rerun_bounds: bool = False,
    coq: bool = False,
    scene: SceneSource | None = None,
    progress: Progress = _silent,
) -> Audit:
    """Check that certificates hold for the kernels in their folders: formulas, laws, C text and error bounds.

    Parameters
    ----------
    *paths : str or Path
        Certificates NAME.cert.json, each in the folder with the files that it names.
    object_file : str or Path, optional
        NAME.o as your compiler made it; the audit compares each rounding in its code with the C text.
    flags : str, optional
        Compiler and flags, such as ``"gcc -O3 -mfma"``; the audit fails if these flags void the certificate.
    rerun_bounds : bool
        Whether to compute all bounds of rounding errors again. If not, bounds that symrot has stored are used, and only
        the others are computed.
    coq : bool
        Whether Coq checks the theorem about the kernel; without Coq or a theorem, a statement says so.
    scene : Scene, str, Path or dict, optional
        Your scene; the audit compares its equations and parameters with those of the kernel or step.
    progress : callable
        Called with a line of text as each part of the work begins.

    Returns
    -------
    Audit

    Raises
    ------
    InputError
        If no path is passed, a file cannot be read, or a flag is unknown.
    CertificateError
        If a statement does not hold; the message names the first such statement.
    CompilerError
        If an object file is passed and there is no ``objdump``.

    Notes
    -----
    Source: ``docs/certificates.md`` explains what each proof covers.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     certificate = symrot.certify("euler_zxz_body_rates", rounding=False, directory=folder)
    ...     audit = symrot.audit(*(path for path in certificate.files if path.suffix == ".json"))
    >>> len(audit.statements)
    1
    """
    if not paths:
        raise InputError("audit: expected the path of a certificate, NAME.cert.json, got no path")
    on_flags = () if flags is None else tuple(certificates.flag_lines(flags))
    compiled = None if object_file is None else Path(object_file)
    own = None if scene is None else load_scene(scene)
    reports = certificates.audit_files([Path(path) for path in paths], compiled, rerun_bounds, coq, own, progress)
    return Audit({path: tuple(lines) for path, lines in reports.items()}, on_flags)


def bound(kernel: str | Path, box: Ranges = (), precision: str = "double") -> RoundingBounds:
    """Return bounds of the rounding errors of a kernel, valid for all inputs in a box.

    Parameters
    ----------
    kernel : str or Path
        A kernel of the library, the name of a shipped scene, or the path of a scene file.
    box : mapping or sequence of str
        Ranges of inputs, in their units: ``{"theta": (-1.4, 1.4)}`` or ``["theta=-1.4:1.4"]``. A name is a component
        (``"theta"``), an index (``"angles[1]"``) or a physical constant of a scene (``"A"``). A float stands for its
        exact binary value, a text for its decimal value. Inputs that are not named have the kernel's own ranges; the
        states of a scene have none, except its quaternion.
    precision : str
        ``"double"`` or ``"float"``; the kernel of a scene has ``"double"`` only.

    Returns
    -------
    RoundingBounds

    Raises
    ------
    InputError
        For an unknown kernel or precision, a range that cannot be used, or a box on which an output has no bound.

    Notes
    -----
    Convention: errors are absolute, in the unit of the output; frames and units are those of the kernel's inputs.
    Source: ``docs/certificates.md`` states the assumptions and the method.

    Examples
    --------
    >>> import symrot
    >>> symrot.bound("euler_zxz_body_rates", {"theta": (1, 2)}).largest < 1e-12
    True
    """
    _check_precision(precision)
    data = rounding.facts(str(kernel), _ranges(box), precision)
    part = data["precisions"][0]
    outputs = tuple(
        OutputError(
            each["output"], float.fromhex(each["absolute"]), float.fromhex(each["pointwise"]),
            each["converged"], each["modulo_turns"],
        )
        for each in part["outputs"]
    )  # fmt: skip
    return RoundingBounds(data["kernel"], precision, _float_box(data["box"]), outputs, tuple(data["assumptions"]), data)


def largest_box(
    kernel: str | Path,
    target: float,
    box: Ranges = (),
    precision: str = "double",
    *,
    variables: Sequence[str] = (),
) -> LargestBox:
    """Return the largest box, with the same middle as ``box``, on which no rounding error exceeds a target.

    Parameters
    ----------
    kernel, box, precision
        As for :func:`bound`.
    target : float
        The largest error that is allowed, in the unit of the outputs.
    variables : sequence of str
        Names of the inputs whose ranges are resized; default: all inputs with a range of nonzero finite width, except
        the components of a scene's quaternion.

    Returns
    -------
    LargestBox

    Raises
    ------
    InputError
        In the cases of :func:`bound`, for an unknown variable, and for a target that no box of that shape meets.

    Notes
    -----
    Convention and source: as for :func:`bound`.

    Examples
    --------
    >>> import symrot
    >>> symrot.largest_box("euler_zxz_body_rates", 1e-13, {"theta": (1, 2)}, variables=["theta"]).error <= 1e-13
    True
    """
    _check_precision(precision)
    data = rounding.target_facts(str(kernel), _ranges(box), precision, target, variables)
    error = float.fromhex(data["largest_error"])
    return LargestBox(data["kernel"], target, data["size"], _float_box(data["box"]), error, data)


def _check_precision(precision: str) -> None:
    if precision not in rounding.PRECISIONS:
        raise InputError(f"precision: expected one of {', '.join(rounding.PRECISIONS)}, got {precision!r}")


_BOX = "a mapping such as {'x': (0, 1)}, or a list of strings such as ['x=0:1']"


def _ranges(box: Ranges) -> Sequence[str]:
    """Return ranges as strings ``NAME=LOW:HIGH``; ``box`` is a map from names to ranges, or has the strings."""
    if isinstance(box, str):
        raise InputError(f"box: expected {_BOX}, got the single string {box[:60]!r}")
    if not isinstance(box, Mapping):
        if not isinstance(box, Sequence) or not all(isinstance(text, str) for text in box):
            raise InputError(f"box: expected {_BOX}, got {exact_numbers.show(box)}")
        return box
    texts = []
    for name, ends in box.items():
        if isinstance(ends, str) or not hasattr(ends, "__len__") or len(ends) != 2:
            raise InputError(f"box: expected two ends of the range of {name}, (low, high), got {ends!r}")
        low, high = (exact_numbers.read(end, f"box: {name}") for end in ends)
        # each float is written as an exact fraction
        texts.append(f"{name}={low}:{high}")
    return texts


def _float_box(box: Mapping[str, Sequence[str]]) -> dict[str, tuple[float, float]]:
    return {place: (float.fromhex(low), float.fromhex(high)) for place, (low, high) in box.items()}

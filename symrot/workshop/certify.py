"""The work of `symrot certify` and `symrot audit`: making certificates of kernels, and checking them."""

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache, partial
from importlib.metadata import version
from itertools import repeat
from pathlib import Path

from symrot.build import cache as build_cache
from symrot.build.code_digest import code_without_prose, text_digest
from symrot.build.sources import PACKAGE
from symrot.certificates.audit import LARGEST, audit, operations_of
from symrot.certificates.certificate import Data, proven_statement, with_sections
from symrot.errors import CertificateError, InputError, nearest
from symrot.files.reading import read_input
from symrot.kernels.jacobian import BY
from symrot.kernels.library import is_kernel
from symrot.report.layout import fields
from symrot.scene.file import names_with_kernels
from symrot.scene.scene import SceneSource, load_scene
from symrot.workshop import object_code
from symrot.workshop.certificate_diff import difference, kernel_of
from symrot.workshop.emit import kernel_names
from symrot.workshop.kernel_files import SCENES, certificate_files, stored_bounds, write_files
from symrot.workshop.kernel_text import kernel_text, scene_kernel_name
from symrot.workshop.steps.audit import audit_step, step_data
from symrot.workshop.workers import workers

__all__ = [
    "all_lines",
    "audit_file",
    "audit_files",
    "certify",
    "certify_all",
    "flag_lines",
    "lacks_proof_of_bits",
    "lines",
    "proofs",
]

PROOFS = {  # kinds of proof, from the derivation to the object code; they label the lines of a printed certificate
    "laws": "proven of the formulas", "Coq": "a theorem about the formulas (`symrot prove`)",
    "C text": "proven equal to the formulas", "rounding": "errors bounded on a box",
    "object code": "equal to the C text (--objects)",
}  # fmt: skip
LABEL = max(map(len, PROOFS)) + 2  # characters
MANY = 12  # smallest number of certificates that several processes audit at once


def _proven_statement(data: Data, own: SceneSource | None = None) -> Data | None:
    """Return the statements that symrot proves about the kernel named in the certificate ``data``.

    The result is None for an unknown kernel. With ``own``, the user's scene, CertificateError is raised unless the
    certificate is that of the kernel which symrot emits for this scene.
    """
    if own is not None:
        jacobian = re.search(r" --jacobian ([\w,]+) ", str(data["regenerate"]))
        text = kernel_text(load_scene(own), jacobian[1].split(",") if jacobian else ())
        if text.name != data["kernel"]:
            raise CertificateError(
                f"{data['kernel']}: expected the certificate of {text.name}, which is the kernel that symrot emits for "
                f"the scene {load_scene(own).name}, got that of another kernel"
            )
        return proven_statement(text.under_test(data.get("rounding")))
    name = data["kernel"]
    scene = str(data["regenerate"]).removeprefix("symrot emit ").removesuffix(" --target c")
    if not is_kernel(name):
        if scene not in names_with_kernels() or scene_kernel_name(scene) != name:
            return None
        name = scene
    bounds = data.get("rounding") if name != data["kernel"] else None  # a scene has no box of its own
    key = f"statement about {name} with {json.dumps(bounds)} by {_programs()}"
    # proven once, then stored under the hash of symrot's source files
    stored = build_cache.fetch(key)
    if stored is None:
        stored = json.dumps(proven_statement(kernel_text(name).under_test(bounds)))
        build_cache.store(key, stored)
    statement: Data = json.loads(stored)
    return statement


@cache
def _programs() -> str:
    """Return the SHA-256 of symrot's source files, without docstrings and comments, and of the version of SymPy."""
    # part of keys of the cache: after any change of the programs that prove statements, stored ones are no longer used
    paths = sorted(path for path in PACKAGE.rglob("*") if path.suffix in (".py", ".toml", ".v", ".c"))
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    key = f"code in {text_digest(version('sympy'), *texts.values())}"
    digest = build_cache.fetch(key)  # it takes half a second to compute
    if digest is None:
        code = (code_without_prose(text) if path.suffix == ".py" else text for path, text in texts.items())
        digest = text_digest(version("sympy"), *code)
        build_cache.store(key, digest)
    return digest


def audit_file(
    path: Path, object_file: Path | None = None, rerun: bool = False, coq: bool = False,
    scene: SceneSource | None = None, progress: Callable[[str], object] = lambda text: None,
) -> list[str]:  # fmt: skip
    """Audit a certificate; return one line for each statement that holds, and for each that was not checked.

    Parameters
    ----------
    path : Path
        NAME.cert.json, in the folder with the files that it names.
    object_file : Path, optional
        The compiled NAME.c; each rounding in its code is compared with the C text.
    rerun : bool
        Whether to compute all bounds of rounding errors again. If not, bounds that symrot has stored are used, and only
        the others are computed.
    coq : bool
        Whether Coq checks the theorem about the kernel; without Coq or a theorem, a line says so.
    scene : Scene, str, Path or dict, optional
        The scene whose kernel or step this should be; by default a shipped scene of the name in the certificate.

    Raises
    ------
    CertificateError
        If a statement does not hold; the message names the first such statement.
    """
    progress(f"auditing {path.name} ..")
    if (step := step_data(path)) is not None:
        return _audit_step(path, step, object_file, rerun, coq, scene, progress)
    try:
        data, report = audit(path, partial(_proven_statement, own=scene))
    except CertificateError as reason:
        raise CertificateError(f"{reason}{difference(path)}") from None
    source = path.with_name(f"{data['kernel']}.c")
    text = source.read_text(encoding="utf-8")
    report += _recomputed_bounds(data, text, progress) if rerun else []
    if object_file is not None:
        report += object_code.object_lines(text, object_file, source.name)
    if coq:
        report += _coq(data, progress)
    return report


def _audit_step(
    path: Path, data: Data, object_file: Path | None, rerun: bool, coq: bool, scene: SceneSource | None,
    progress: Callable[[str], object],
) -> list[str]:  # fmt: skip
    if object_file is not None and "scene" in data:
        raise InputError(
            f"--object: expected a step without loops, got {path.name}: a step with elliptic functions has loops, so "
            "that its object code cannot be compared"
        )
    report = audit_step(path, data, rerun, scene, progress)
    if object_file is not None:
        source = path.with_name(f"{data['kernel']}.c")
        report += object_code.object_lines(source.read_text(encoding="utf-8"), object_file, source.name)
    return [*report, "Coq theorems are about kernels only, not about steps"] if coq else report


def audit_files(
    paths: Sequence[Path], object_file: Path | None = None, rerun: bool = False, coq: bool = False,
    scene: SceneSource | None = None, progress: Callable[[str], object] = lambda text: None,
) -> dict[str, list[str]]:  # fmt: skip
    """Audit certificates; return a map from each path to the lines that :func:`audit_file` returns.

    Raises
    ------
    CertificateError
        If a certificate does not hold; the message is about the first such certificate in ``paths``.
    """
    if len(paths) < MANY:
        return {str(path): audit_file(path, object_file, rerun, coq, scene, progress) for path in paths}
    # several processes share the work
    reports = {}
    options = map(repeat, (object_file, rerun, coq, scene))
    with workers() as pool:
        for path, report in zip(paths, pool.map(audit_file, paths, *options, chunksize=8), strict=True):
            progress(f"audited {path.name} ..")
            reports[str(path)] = report
    return reports


def _recomputed_bounds(data: Data, text: str, progress: Callable[[str], object]) -> list[str]:
    if data.get("rounding") is None:
        raise CertificateError(
            f"{data['kernel']}: expected a certificate with bounds of rounding errors, which --rerun-bounds computes "
            "again, got one without bounds; leave out --rerun-bounds"
        )
    from symrot.certificates.rounding.section import check_section

    progress("bounding ..")
    kernels = list(operations_of(data, text).values())
    check_section(data["rounding"], kernels[0], kernels[1] if len(kernels) > 1 else None, rerun=True)
    return ["bounds of rounding errors were computed again and agree"]


def flag_lines(flags: str) -> list[str]:
    """Return one line, in a list: which promises of a certificate hold for code compiled with ``flags``, and why.

    Raises
    ------
    InputError
        For a flag whose effect on rounding is unknown.
    CertificateError
        For flags that void the certificate.
    """
    from symrot.certificates.flags import classify_flags

    effect = classify_flags(flags)
    # neither the bits of the C text nor its error bounds
    if not effect.accepted:
        raise CertificateError(f"{flags}: {effect.sentence()}")
    return [f"{flags}: {effect.sentence()}"]


def _coq(data: Data, progress: Callable[[str], object]) -> list[str]:
    from symrot.certificates.coq.check import check_kernel, coqc

    if data["coq"] is None:
        return ["there is no Coq theorem about this kernel"]
    if coqc() is None:
        return ["Coq is not installed (Debian package coq): the theorem was not checked"]
    progress("checking with Coq ..")
    result = check_kernel(data["kernel"])
    if not result:
        raise CertificateError(f"{data['kernel']}: {result.problems[0]}")
    return [f"Coq {result.version} accepts the theorem {data['coq']['theorem']} of {data['coq']['file']}"]


def certify(
    kernel: str, ranges: Sequence[str] = (), directory: Path | None = None, objects: bool = False,
    bounds: bool = True, progress: Callable[[str], object] = lambda text: None,
) -> tuple[Data, list[Path]]:  # fmt: skip
    """Return the certificate of a kernel, and the paths of the written files; proofs may come from the cache.

    Parameters
    ----------
    kernel : str
        A kernel of the library, a scene, or a file NAME.c or NAME.cert.json exactly as symrot emits it.
    ranges : sequence of str
        ``NAME=LOW:HIGH``, ranges of inputs for which rounding errors are bounded. For a library kernel, each input has
        a standard range that is used if none is passed. For a scene, only parameters, time and quaternion have one:
        ranges of the other states, such as omega_1, must be passed. Without ``ranges``, the errors of a scene's kernel
        are not bounded.
    directory : Path, optional
        Folder for the kernel and its certificate; without it no file is written.
    objects : bool
        Whether to compile the kernel with each installed compiler and compare the object code with the C text.
    bounds : bool
        Whether to bound rounding errors.

    Raises
    ------
    InputError, CertificateError
        For an unknown kernel, an edited file, an impossible box, or a proof that fails.
    """
    from symrot.workshop.bounds import require_known, section

    name = _emitted(kernel) if kernel.endswith((".c", ".cert.json")) else kernel
    require_known(name)
    if objects:
        object_code.require_compiler()
    if ranges and not bounds:
        raise InputError(f"--box: expected --box or --no-bounds, got both ({ranges[0]!r}); leave out one of them")
    printed, rounding = kernel_text(name), None
    if bounds and (ranges or (is_kernel(name) and BY not in name)):  # derivatives are bounded on request
        progress("bounding ..")
        rounding = section(printed, ranges)
    scene_bounds = None if is_kernel(name) else rounding or stored_bounds(printed, directory)
    progress("proving ..")
    texts = printed.c_files(scene_bounds)
    (file, text), = certificate_files(printed, directory or Path(), scene_bounds).items()  # fmt: skip
    slots: Data = {key: value for key, value in json.loads(text).items() if key in ("rounding", "objects")}
    slots |= {"rounding": rounding} if rounding else {}
    if objects:
        progress("comparing object code ..")
        slots["objects"] = object_code.objects_of(texts, f"{json.loads(text)['kernel']}.c", _programs())
    text = with_sections(text, slots)
    return json.loads(text), write_files(directory, texts | {file: text}) if directory else []


def certify_all(
    directory: Path | None = None, objects: bool = False, progress: Callable[[str], object] = lambda text: None,
) -> tuple[dict[str, Data], list[Path]]:  # fmt: skip
    """Return the certificates of all kernels of the library and of shipped scenes, and the paths of the written files.

    Parameters
    ----------
    directory : Path, optional
        Folder for kernels and certificates, with a subfolder ``scenes`` for scenes; without it no file is written.
    objects : bool
        Whether to compile the kernels with each installed compiler and compare the object code with the C text.
    """
    if objects:
        object_code.require_compiler()
    names = (*kernel_names(), *names_with_kernels())
    certificates: dict[str, Data] = {}
    written: list[Path] = []
    # certificates from the same version of symrot come from the cache, unless files are written or code is compared
    with workers() as pool:
        work = pool.map(_certified, names, repeat(directory), repeat(objects), chunksize=4)
        for name, (data, paths) in zip(names, work, strict=True):
            progress(f"certified {name} ..")
            certificates[name] = data
            written += paths
    return certificates, written


def _certified(name: str, directory: Path | None, objects: bool) -> tuple[Data, list[Path]]:
    if directory is not None or objects:
        folder = directory and (directory if is_kernel(name) else directory / SCENES)
        return certify(name, (), folder, objects)
    key = f"certified {name} by {_programs()}"
    stored = build_cache.fetch(key)
    if stored is None:
        stored = json.dumps(certify(name)[0])
        build_cache.store(key, stored)
    return json.loads(stored), []


def all_lines(certificates: Mapping[str, Data]) -> list[str]:
    """Return lines of text: for each kernel the kinds of proof in its certificate, then the count of each kind.

    A table of verdicts on object code follows if certificates have such verdicts.
    """
    by_kernel = {name: proofs(data) for name, data in certificates.items()}
    width = max(map(len, by_kernel))
    text_lines = [
        f"{name:<{width}}  {'  '.join(proof if proof in present else '-' * len(proof) for proof in PROOFS)}"
        for name, present in by_kernel.items()
    ]
    for proof, meaning in PROOFS.items():
        count = sum(proof in present for present in by_kernel.values())
        text_lines.append(f"{proof}, {meaning}: {count} of {len(by_kernel)}")
    return [*text_lines, *object_code.table({name: data.get("objects") for name, data in certificates.items()})]


def lacks_proof_of_bits(certificates: Iterable[Data]) -> bool:
    """Return whether one of the certificates has a section on object code that lacks the proof of equal bits.

    The proof says that strict code computes the same bits as the C text. Strict code is object code compiled with flags
    that forbid a compiler to change any bit of a result. A section lacks the proof if it is about no strict code, or if
    strict code differs from the C text. Certificates without a section on object code do not count.
    """
    return any(data.get("objects") and not object_code.holds(data["objects"]) for data in certificates)


def proofs(data: Data) -> tuple[str, ...]:
    """Return the kinds of proof in a certificate, such as ``("laws", "C text")``, in the order of ``PROOFS``."""
    compared = object_code.holds(data.get("objects"))
    sections = (data["laws"], data["coq"], data["readback"], data.get("rounding"), compared)
    return tuple(proof for proof, section in zip(PROOFS, sections, strict=True) if section)


def _emitted(path: str) -> str:
    """Return the name of the kernel or shipped scene whose C file or certificate is at ``path``.

    InputError or CertificateError is raised for any other file, and for a file that was edited.
    """
    file = Path(path)
    name = file.name.removesuffix(".c").removesuffix(".cert.json")
    kernel = kernel_of(name)
    if kernel is None:
        hint = nearest(name, [*kernel_names(), *map(scene_kernel_name, names_with_kernels())])
        message = f"{path}: expected a file that symrot emits for a kernel of the library or a shipped scene"
        raise InputError(
            f"{message} ({hint})" if hint else f"{message}; `symrot audit` takes the certificate of any kernel"
        )
    try:
        text = read_input(file, LARGEST).decode().replace("\r\n", "\n")
    except (OSError, UnicodeDecodeError) as reason:
        why = reason.strerror if isinstance(reason, OSError) else "bytes that are not UTF-8"
        raise InputError(f"{path}: expected a readable file of at most {LARGEST // 1_000_000} MB, got {why}") from None
    if file.name.endswith(".cert.json"):
        audit_file(file)
    elif text != (printed := kernel_text(kernel)).c(stored_bounds(printed, file.parent))[0]:
        why = difference(file.with_name(f"{name}.cert.json"))
        raise CertificateError(
            f"{path}: expected the text that symrot emits for {kernel}, but the file was edited{why}"
        )
    return kernel


def lines(data: Data, compared: bool = True) -> list[str]:
    """Return the lines that `symrot certify` prints about a certificate.

    ``compared`` says whether object code was compared in this call, and not in an earlier one.
    """
    rows = [("domain", data["domain"]), *(("laws", f"{law['law']}: proven") for law in data["laws"])]
    if data["coq"]:
        rows.append(("Coq", f"theorem {data['coq']['theorem']} of {data['coq']['file']} (`symrot prove` checks it)"))
    for name, function in data["readback"].items():
        series = "".join(
            f"; the series of {s[0]} is truncated by less than {float(Fraction(s[3])):.2g} of its value"
            for s in function["series"]
        )
        count = sum(function["operations"].values())
        rows.append(("C text", f"{name} and its batch function compute the formulas in {count} operations{series}"))
    for part in (data.get("rounding") or {"precisions": []})["precisions"]:
        worst = max(part["outputs"], key=lambda item: float.fromhex(item["absolute"]))
        most = f"{float.fromhex(worst['absolute']):.3g}"
        bound = f"{part['precision']}: error at most {most} for inputs in the certified ranges ({worst['output']})"
        rows.append(("rounding", bound))
    if compared:
        rows += [("object code", line) for line in object_code.lines(data.get("objects"))]
    elif data.get("objects"):
        rows.append(("object code", "compared in an earlier run, not now (--objects compares)"))
    required = ", ".join(data["flags"]["required"])
    rows.append(("flags", f"required {required}; void under {', '.join(data['flags']['void'])}"))
    return [f"{data['kernel']}: {data['title']}", *fields((f"  {label:<{LABEL - 2}}", text) for label, text in rows)]

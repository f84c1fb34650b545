"""Certify kernels and audit certificates, as `symrot certify` and `symrot audit` do."""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from itertools import repeat
from pathlib import Path

import symrot
from symrot.build import cache as library
from symrot.certificates.audit import LARGEST, audit, operations_of
from symrot.certificates.certificate import Data, said_of, with_slots
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.scene.file import names_with_kernels
from symrot.scene.reader import nearest
from symrot.workshop import object_code as compiled
from symrot.workshop.certificate_diff import explained, kernel_of
from symrot.workshop.emit import emit, kernel_names, scene_kernel_name, subject
from symrot.workshop.kernel_files import SCENES, certificate_files, kept_bounds, kernel_files, write_files
from symrot.workshop.workers import workers

__all__ = ["all_lines", "audit_file", "audit_files", "certify", "certify_all", "flag_lines", "lines", "refuted"]

LINKS = {  # of the chain from a derivation to object code
    1: "laws of the formulas proven", 2: "a theorem of Coq about the formulas (`symrot prove`)",
    3: "C text = formulas, proven", 4: "rounding errors bounded on a box", 5: "object code = C text (--objects)",
}  # fmt: skip
MANY = 12  # certificates: fewer are audited in this process


def _said(data: Data) -> Data | None:
    """Return what symrot says of the kernel that a certificate should be about, and proves; None if it knows none.

    It is derived and proven once, and kept in the cache by the programs that do so.
    """
    name = data["kernel"]
    scene = str(data["regenerate"]).removeprefix("symrot emit ").removesuffix(" --target c")
    if name not in kernel_names():
        if scene not in names_with_kernels() or scene_kernel_name(scene) != name:
            return None
        name = scene
    bounds = data.get("rounding") if name != data["kernel"] else None  # a scene has no box of its own
    key = f"said of {name} with {json.dumps(bounds)} by {_programs()}"
    kept = library.fetch(key)
    if kept is None:
        kept = json.dumps(said_of(subject(name, bounds)))
        library.store(key, kept)
    found: Data = json.loads(kept)
    return found


@cache
def _programs() -> str:
    """Return the SHA-256 of all of symrot, and of the SymPy it derives with."""
    root = Path(symrot.__file__).parent
    digest = sha256(version("sympy").encode())
    for path in sorted(each for each in root.rglob("*") if each.suffix in (".py", ".toml", ".v", ".c")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def audit_file(
    path: Path, object_file: Path | None = None, rerun: bool = False, coq: bool = False,
    progress: Callable[[str], object] = lambda text: None,
) -> list[str]:  # fmt: skip
    """Return, line by line, what of a certificate was found to hold.

    Parameters
    ----------
    path : Path
        NAME.cert.json, the files that it names beside it.
    object_file : Path, optional
        What a compiler made of NAME.c: compared with it, rounding for rounding.
    rerun : bool
        Whether bounds of rounding errors are found again; else they are compared with those that symrot knows.
    coq : bool
        Whether Coq checks the theorem about the kernel.

    Raises
    ------
    CertificateError
        With the first thing that does not hold.
    """
    progress(f"auditing {path.name} ..")
    try:
        data, found = audit(path, _said)
    except CertificateError as reason:
        raise CertificateError(f"{reason}{explained(path)}") from None
    source = path.with_name(f"{data['kernel']}.c")
    text = source.read_text(encoding="utf-8")
    found += _bounds_again(data, text, progress) if rerun else []
    if object_file is not None:
        found += compiled.object_lines(text, object_file, source.name)
    if coq:
        found += _coq(data, progress)
    return found


def audit_files(
    paths: Sequence[Path], object_file: Path | None = None, rerun: bool = False, coq: bool = False,
    progress: Callable[[str], object] = lambda text: None,
) -> dict[str, list[str]]:  # fmt: skip
    """Return what :func:`audit_file` finds of each certificate; many are audited by several processes at once.

    Raises
    ------
    CertificateError
        For the first one, in the order given, that does not hold.
    """
    if len(paths) < MANY:
        return {str(path): audit_file(path, object_file, rerun, coq, progress) for path in paths}
    found = {}
    options = map(repeat, (object_file, rerun, coq))
    with workers() as pool:
        for path, said in zip(paths, pool.map(audit_file, paths, *options, chunksize=8), strict=True):
            progress(f"audited {path.name} ..")
            found[str(path)] = said
    return found


def _bounds_again(data: Data, text: str, progress: Callable[[str], object]) -> list[str]:
    if data.get("rounding") is None:
        raise CertificateError(f"{data['kernel']}: expected bounds to find again, and the certificate holds none")
    from symrot.certificates.rounding.bounds import check_section

    progress("bounding ..")
    kernels = list(operations_of(data, text).values())
    check_section(data["rounding"], kernels[0], kernels[1] if len(kernels) > 1 else None, rerun=True)
    return ["bounds of rounding errors were found again, from nothing"]


def flag_lines(flags: str) -> list[str]:
    """Return what holds of any certificate under the flags of a compiler, as a line.

    Raises
    ------
    InputError
        For a flag whose effect on rounding is not known.
    CertificateError
        For flags under which nothing holds.
    """
    from symrot.certificates.flags import judge

    found = judge(flags)
    if not found.accepted:
        raise CertificateError(f"{flags}: {found.sentence()}")
    return [f"{flags}: {found.sentence()}"]


def _coq(data: Data, progress: Callable[[str], object]) -> list[str]:
    from symrot.certificates.coq.check import check_kernel, coqc

    if data["coq"] is None:
        return ["no theorem of Coq is about this kernel"]
    if coqc() is None:
        return ["Coq is not installed (Debian package coq): its theorem was not checked"]
    progress("checking with Coq ..")
    result = check_kernel(data["kernel"])
    if not result:
        raise CertificateError(f"{data['kernel']}: {result.problems[0]}")
    return [f"Coq {result.version} accepts the theorem {data['coq']['theorem']} of {data['coq']['file']}"]


def certify(
    kernel: str, ranges: Sequence[str] = (), directory: Path | None = None, objects: bool = False,
    bounds: bool = True, progress: Callable[[str], object] = lambda text: None,
) -> tuple[Data, list[Path]]:  # fmt: skip
    """Return the certificate of a kernel, everything in it found or fetched now, and the files written.

    Parameters
    ----------
    kernel : str
        A kernel of the library, a scene, or NAME.c or NAME.cert.json: a file that has to be what symrot emits.
    ranges : sequence of str
        ``NAME=LOW:HIGH`` for the box on which rounding errors are bounded; other ranges are the kernel's own. A
        scene has those of its parameters, its time and its quaternion, and is bounded if any range is given.
    directory : Path, optional
        Where the kernel and its certificate are written; nowhere if left out.
    objects : bool
        Whether the kernel is compiled, and the object code compared with it, for the compilers that are there.
    bounds : bool
        Whether rounding errors are bounded.

    Raises
    ------
    InputError, CertificateError
        For a kernel that is none, an edited file, a box that cannot be, a proof that fails.
    """
    from symrot.workshop.bounds import require_known, section

    name = _emitted(kernel) if kernel.endswith((".c", ".cert.json")) else kernel
    require_known(name)
    if objects:
        compiled.require_compiler()
    if ranges and not bounds:
        raise InputError(f"--box: expected no --no-bounds beside it, which leaves bounds out, got {ranges[0]!r} and it")
    found = None
    if bounds and (ranges or name in kernel_names()):
        progress("bounding ..")
        found = section(name, ranges)
    of_scene = None if name in kernel_names() else found or kept_bounds(name, directory)
    progress("proving ..")
    texts = kernel_files(name, "c", of_scene)
    (file, text), = certificate_files(name, directory or Path(), of_scene).items()  # fmt: skip
    slots: Data = {key: value for key, value in json.loads(text).items() if key in ("rounding", "objects")}
    slots |= {"rounding": found} if found else {}
    if objects:
        progress("comparing object code ..")
        slots["objects"] = compiled.objects_of(texts, f"{json.loads(text)['kernel']}.c", _programs())
    text = with_slots(text, slots)
    return json.loads(text), write_files(directory, texts | {file: text}) if directory else []


def certify_all(
    directory: Path | None = None, objects: bool = False, progress: Callable[[str], object] = lambda text: None,
) -> tuple[dict[str, Data], list[Path]]:  # fmt: skip
    """Return the certificates of the library and of the kernels of shipped scenes, and the files written.

    Several processes find them. What was certified by the same programs is fetched from the cache, unless it is to be
    written or compiled.

    Parameters
    ----------
    directory : Path, optional
        Where kernels and certificates are written, those of scenes in ``scenes`` below it; nowhere if left out.
    objects : bool
        Whether the kernels are compiled, and the object code compared with them, for the compilers that are there.
    """
    if objects:
        compiled.require_compiler()
    names = (*kernel_names(), *names_with_kernels())
    found: dict[str, Data] = {}
    written: list[Path] = []
    with workers() as pool:
        work = pool.map(_certified, names, repeat(directory), repeat(objects), chunksize=4)
        for name, (data, paths) in zip(names, work, strict=True):
            progress(f"certified {name} ..")
            found[name] = data
            written += paths
    return found, written


def _certified(name: str, directory: Path | None, objects: bool) -> tuple[Data, list[Path]]:
    if directory is not None or objects:
        room = directory and (directory if name in kernel_names() else directory / SCENES)
        return certify(name, (), room, objects)
    key = f"certified {name} by {_programs()}"
    kept = library.fetch(key)
    if kept is None:
        kept = json.dumps(certify(name)[0])
        library.store(key, kept)
    return json.loads(kept), []


def all_lines(found: Mapping[str, Data]) -> list[str]:
    """Return which links the certificates of kernels hold, a line each, and how many hold which."""
    links = {name: _links(data) for name, data in found.items()}
    width = max(map(len, links))
    said = [f"{name:<{width}}  {' '.join(str(k) if k in held else '-' for k in LINKS)}" for name, held in links.items()]
    count = {k: sum(k in held for held in links.values()) for k in LINKS}
    said += [f"link {k}, {what}: {count[k]} of {len(links)}" for k, what in LINKS.items()]
    return [*said, *compiled.table({name: data.get("objects") for name, data in found.items()})]


def refuted(found: Iterable[Data]) -> bool:
    """Return whether object code was compared and is not the C text under flags by which its bits are to hold."""
    return any(data.get("objects") and not compiled.holds(data["objects"]) for data in found)


def _links(data: Data) -> set[int]:
    compared = compiled.holds(data.get("objects"))
    held = {1: data["laws"], 2: data["coq"], 3: data["readback"], 4: data.get("rounding"), 5: compared}
    return {k for k, what in held.items() if what}


def _emitted(path: str) -> str:
    """Return the kernel or shipped scene that a C file or certificate is of, if the file is as symrot prints it."""
    file = Path(path)
    name = file.name.removesuffix(".c").removesuffix(".cert.json")
    kernel = kernel_of(name)
    if kernel is None:
        hint = nearest(name, [*kernel_names(), *map(scene_kernel_name, names_with_kernels())])
        said = f"{path}: expected a file that symrot emits of a kernel of the library or a shipped scene"
        raise InputError(f"{said} ({hint})" if hint else f"{said}; `symrot audit` takes the certificate of any kernel")
    try:
        text = read_input(file, LARGEST).decode().replace("\r\n", "\n")
    except (OSError, UnicodeDecodeError) as reason:
        why = reason.strerror if isinstance(reason, OSError) else "no UTF-8"
        said = f"a file of at most {LARGEST // 1_000_000} MB that can be read"
        raise InputError(f"{path}: expected {said}, got {why}") from None
    if file.name.endswith(".cert.json"):
        audit_file(file)
    elif text != emit(kernel, "c", kept_bounds(kernel, file.parent)).source:
        why = explained(file.with_name(f"{name}.cert.json"))
        raise CertificateError(f"{path}: expected the text that symrot emits for {kernel}, and it was edited{why}")
    return kernel


def lines(data: Data, compared: bool = True) -> list[str]:
    """Return a certificate in words, line by line; ``compared``: what it says of object code was found just now."""
    said = [f"{data['kernel']}: {data['title']}", f"  domain    {data['domain']}"]
    said += [f"  link 1    {law['law']}: proven" for law in data["laws"]]
    if data["coq"]:
        said.append(f"  link 2    theorem {data['coq']['theorem']} of {data['coq']['file']} (`symrot prove` checks it)")
    for name, each in data["readback"].items():
        series = "".join(f"; series of {s[0]} leaves out less than {_short(s[3])} of it" for s in each["series"])
        said.append(
            f"  link 3    {name} and its batch are the formulas, {sum(each['operations'].values())} operations{series}"
        )
    for part in (data.get("rounding") or {"precisions": []})["precisions"]:
        worst = max(part["outputs"], key=lambda item: float.fromhex(item["absolute"]))
        most = f"{float.fromhex(worst['absolute']):.3g}"
        said.append(f"  link 4    {part['precision']}: error at most {most} on the box ({worst['output']})")
    if compared:
        said += compiled.lines(data.get("objects"))
    elif data.get("objects"):
        said.append("  link 5    compared before, which is kept and not looked at (--objects compares)")
    required = ", ".join(data["flags"]["required"])
    return [*said, f"  flags     required {required}; void under {', '.join(data['flags']['void'])}"]


def _short(text: str) -> str:
    above, _, below = text.partition("/")
    return f"{int(above) / int(below or 1):.2g}"

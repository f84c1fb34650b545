"""Files of emitted kernels: writing one or all, and comparing the files on disk with newly emitted kernels."""

import json
import os
from collections.abc import Callable, Mapping, Sequence
from difflib import unified_diff
from itertools import repeat
from pathlib import Path
from typing import Any

from symrot.certificates import recheck
from symrot.certificates.audit import LARGEST
from symrot.certificates.certificate import certificate_json, with_sections
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.section import check_bounds, check_section
from symrot.certificates.selftest import selftest_files
from symrot.certificates.step_certificate import is_step, with_bounds
from symrot.codegen.printing.build_files import build_files
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.files.writing import write
from symrot.kernels.library import definition, kernel_names
from symrot.report.layout import columns
from symrot.scene.file import names_with_kernels
from symrot.workshop.kernel_text import KernelText, SceneText, kernel_text
from symrot.workshop.step_text import step_text
from symrot.workshop.workers import workers

__all__ = [
    "build_files",
    "certificate_files",
    "chosen_text",
    "kernel_lines",
    "stale",
    "stored_bounds",
    "write_all",
    "write_files",
]

SUFFIXES = {"c": (".c", ".h", ".json", ".txt", ".in", ".cmake"), "numpy": (".py",), "js": (".js",), "jax": (".py",)}
MARK = b"symrot emit"  # in each file of a kernel: part of the command that prints it
RECHECK = "recheck.py"  # the program that checks certificates without symrot
SCENES = "scenes"  # subfolder for the kernels of shipped scenes; library kernels are directly in the target's folder


def kernel_lines() -> list[str]:
    """Return the lines that `symrot emit --list` prints: the name and the title of each kernel of the library."""
    return columns([(name, definition(name).title) for name in kernel_names()])


def chosen_text(kernel: str, jacobian: str | None, step: str | None, order: int | None) -> KernelText:
    """Return the texts of the kernel or time step that the options of `symrot emit` name.

    Parameters
    ----------
    kernel : str
        A kernel of the library, a shipped scene, or a scene file.
    jacobian : str, optional
        Names separated by commas, as for :func:`symrot.emit`.
    step, order
        As for :func:`symrot.emit`.
    """
    variables = jacobian.split(",") if jacobian is not None else ()
    if step is not None:
        return step_text(kernel, step, order, variables)
    if order is not None:
        raise InputError(f"--order: expected '--step taylor' as well, got only the order {order}")
    return kernel_text(kernel, variables)


def certificate_files(
    kernel: KernelText, directory: Path, bounds: Mapping[str, Any] | None = None
) -> dict[str, str]:  # fmt: skip
    """Return the certificate file of a kernel, as a map from file name to text; empty if it has no certificate.

    Verdicts on object code and, for a time step, bounds of errors are copied from the kernel's certificate that is
    already in ``directory``, if it is about the same C text.
    """
    if not kernel.has_certificate:
        return {}
    name, certificate = f"{kernel.name}.cert.json", kernel.certificate(bounds)
    data, present = json.loads(certificate), _slots(directory / name)
    if is_step(data):
        same = "bounds" in present and all(
            present.get(section) == own for section, own in data.items() if section not in ("trusted", "seal")
        )
        return {name: certificate_json(with_bounds(data, present["bounds"])) if same else certificate}
    own = data.get("rounding")
    return {name: with_sections(certificate, present | {"rounding": own})}


def stored_bounds(kernel: KernelText, directory: Path | None) -> Mapping[str, Any] | None:
    """Return the rounding bounds in a scene kernel's certificate in ``directory``, after they were checked.

    The result is None if there are no bounds, if they do not hold for the kernel, or for a library kernel, whose bounds
    come with symrot.
    """
    if directory is None or not isinstance(kernel, SceneText):
        return None
    section = _slots(directory / f"{kernel.name}.cert.json").get("rounding")
    if not isinstance(section, dict):
        return None
    operations = read_kernel(kernel.c()[0], f"symrot_{kernel.name}", f"{kernel.name}.c")
    try:
        check_section(section, operations, None)
        check_bounds(section, operations, None)
    except CertificateError:
        return None
    return section


def _slots(path: Path) -> dict[str, Any]:
    """Return the content of the certificate at ``path``, or an empty dict if it is missing or cannot be read."""
    try:
        certificate = json.loads(read_input(path, LARGEST))
    except (OSError, ValueError, RecursionError):
        return {}
    # its bounds and its verdicts on object code are used again
    return certificate if isinstance(certificate, dict) else {}


def _files_of(name: str, subfolder: str, targets: Sequence[str], directory: Path) -> dict[str, str]:
    """Return all files of the kernel ``name`` in the languages ``targets``, as a map from path to text."""
    kernel, files = kernel_text(name), dict[str, str]()
    # paths are relative to ``directory``; ``subfolder`` is empty or "scenes/"
    for target in targets:
        # bounds in an earlier certificate of the kernel are used again
        bounds = stored_bounds(kernel, directory / target / subfolder) if target == "c" else None
        texts = kernel.files(target, bounds)
        if target == "c":
            texts |= certificate_files(kernel, directory / target / subfolder, bounds)
        files |= {f"{target}/{subfolder}{file}": text for file, text in texts.items()}
    return files


def _all_files(targets: Sequence[str], directory: Path, progress: Callable[[str], object]) -> dict[str, str]:
    """Return all files of the library and of the shipped scenes' kernels, as a map from path to text."""
    work = [
        (name, subfolder)
        for subfolder, names in (("", kernel_names()), (f"{SCENES}/", names_with_kernels()))
        for name in names
    ]
    files: dict[str, str] = {}
    # several processes share the work
    with workers() as pool:
        names, subfolders = zip(*work, strict=True)
        for name, texts in zip(
            names, pool.map(_files_of, names, subfolders, repeat(targets), repeat(directory), chunksize=8), strict=True
        ):
            progress(f"emitting {name} ..")
            files |= texts
    if "c" in targets:
        files |= {f"c/{file}": text for file, text in (build_files() | selftest_files()).items()}
        files[RECHECK] = Path(recheck.__file__).read_text(encoding="utf-8")
    return files


def _printed_before(directory: Path, targets: Sequence[str]) -> list[str]:
    """Return the paths of all kernel files in the folders of ``targets``, even of kernels that symrot no longer has.

    A kernel file has a suffix of its language and contains :data:`MARK`; other files may be the user's.
    """
    return [
        path.relative_to(directory).as_posix()
        for target in targets
        for folder in (directory / target, directory / target / SCENES)
        for path in sorted(folder.glob("*"))
        if path.suffix in SUFFIXES[target] and path.is_file() and MARK in path.read_bytes()
    ]


def write_files(directory: Path, files: Mapping[str, str]) -> list[Path]:
    """Write texts into a folder, which is created if necessary, and return the paths of the files that changed.

    Raises
    ------
    InputError
        If the folder or a file cannot be written.
    """
    changed = []
    for name, text in files.items():  # foreseeable failures are raised before anything is written
        path, content = directory / name, text.encode()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.is_dir() or not os.access(path.parent, os.W_OK):
                raise InputError(f"{str(path)!r} cannot be written: it is a folder, or its folder is write-protected")
            if not path.is_file() or path.read_bytes() != content:
                changed.append((path, content))
        except OSError as reason:
            raise InputError(f"{str(path)!r} cannot be written: {reason.strerror or reason}") from None
    for path, content in changed:
        write(path, lambda stream, content=content: stream.write(content))  # type: ignore[misc]
    return [path for path, _ in changed]


def write_all(directory: Path, targets: Sequence[str], progress: Callable[[str], object]) -> list[Path]:
    """Write the files of all kernels, of the library and of shipped scenes; return the changed paths.

    ``targets`` are the languages of the kernels, such as ``"c"`` and ``"numpy"``; each has a folder of its name in
    ``directory``. Files of kernels that symrot no longer has are deleted; their paths are returned too.
    """
    files = _all_files(targets, directory, progress)
    changed = write_files(directory, files)
    for name in _printed_before(directory, targets):
        if name not in files:
            (directory / name).unlink()
            changed.append(directory / name)
    return changed


def stale(directory: Path, targets: Sequence[str], progress: Callable[[str], object]) -> list[str]:
    """Return a unified diff, as lines, between the kernels in a folder and newly emitted ones; empty if equal.

    ``targets`` are the languages that are compared, such as ``"c"`` and ``"numpy"``.

    Raises
    ------
    InputError
        If the folder does not exist.
    """
    if not directory.is_dir():
        raise InputError(
            f"{str(directory)!r}: expected the folder that `symrot emit --all` writes, but it does not exist"
        )
    files = _all_files(targets, directory, progress)
    lines: list[str] = []
    for name in sorted({*files, *_printed_before(directory, targets)}):
        path = directory / name
        old = path.read_bytes().decode(errors="replace") if path.is_file() else ""
        new = files.get(name, "")
        if old != new:
            before, after = f"{path} (on disk)", f"{path} (emitted)"
            diff = list(unified_diff(old.splitlines(), new.splitlines(), before, after, lineterm=""))
            lines += diff or [f"{path}: line endings differ"]
    return lines

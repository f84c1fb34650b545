"""What is wrong with the files of a kernel, beside that they are not what was certified: which line, which output."""

from pathlib import Path

from symrot.certificates.audit import LARGEST
from symrot.certificates.certificate import Subject
from symrot.certificates.laws.equality import prove_equal
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.scene.file import shipped_names
from symrot.workshop.emit import kernel_names, scene_kernel_name, subject
from symrot.workshop.kernel_files import kept_bounds

__all__ = ["explained", "kernel_of"]

LONGEST = 200  # characters of a reason


def kernel_of(name: str) -> str | None:
    """Return the kernel of the library, or the shipped scene, whose function has a name; None for another."""
    if name in kernel_names():
        return name
    return next((scene for scene in shipped_names() if scene_kernel_name(scene) == name), None)


def explained(certificate: Path) -> str:
    """Return how files beside a certificate differ from what symrot emits, to go on with a sentence; or nothing."""
    name = certificate.name.removesuffix(".cert.json")
    kernel = kernel_of(name)
    if kernel is None:
        return ""
    emitted = subject(kernel, kept_bounds(kernel, certificate.parent))
    for file, wanted in emitted.files.items():
        try:
            text = read_input(certificate.parent / file, LARGEST).decode(errors="replace")
        except OSError:
            continue
        if text != wanted:
            return f": {_first_line(text, wanted)}{_meaning(text, emitted) if file == f'{name}.c' else ''}"
    return ""


def _first_line(text: str, wanted: str) -> str:
    if text.replace("\r\n", "\n") == wanted:
        return "its lines end in another way"
    got, expected = (each.splitlines() for each in (text, wanted))
    place = next(
        (k for k, (a, b) in enumerate(zip(got, expected, strict=False)) if a != b), min(len(got), len(expected))
    )
    have, want = (
        repr(lines[place].strip()[:LONGEST]) if place < len(lines) else "nothing" for lines in (got, expected)
    )
    return f"line {place + 1} is {have}, and {want} was emitted"


def _meaning(text: str, emitted: Subject) -> str:
    """Return what an edited C text computes now: the formulas in other roundings, another output, nothing readable."""
    file = f"{emitted.name}.c"
    symbols = {place: symbol for place, (symbol, _) in emitted.places.items()}
    formulas = {place: formula for place, (_, formula) in emitted.formulas.items()}
    same = True
    try:
        for suffix in emitted.types:
            name = f"{emitted.name}{suffix}"
            now, was = read_kernel(text, name, file), read_kernel(emitted.files[file], name, file)
            prove_equal(now, symbols, formulas, emitted.named, emitted.parameters)
            same = same and now.digest() == was.digest() == read_batch(text, f"{name}_batch", file).digest()
    except (CertificateError, InputError) as reason:
        return f" ({str(reason)[:LONGEST]})"
    return "" if same else " (it computes the formulas, with other operations)"

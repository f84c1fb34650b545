"""Comparison of a kernel's files on disk with the texts that symrot emits for it, to explain a failed hash.

The result names the first changed line, and the first output whose C text no longer computes its formula.
"""

from pathlib import Path

from symrot.certificates.audit import LARGEST
from symrot.certificates.certificate import KernelUnderTest
from symrot.certificates.laws.equality import prove_equal
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.kernels.library import is_kernel
from symrot.scene.file import shipped_names
from symrot.workshop.kernel_files import stored_bounds
from symrot.workshop.kernel_text import kernel_text, scene_kernel_name

__all__ = ["difference", "kernel_of"]

LONGEST = 200  # largest number of characters of a line or reason in a message


def kernel_of(name: str) -> str | None:
    """Return the library kernel or shipped scene that has the C function ``symrot_NAME``, or None."""
    if is_kernel(name):
        return name
    # "t_handle_rates" gives the scene "t_handle"
    return next((scene for scene in shipped_names() if scene_kernel_name(scene) == name), None)


def difference(certificate: Path) -> str:
    """Return ": " and the first difference between a kernel's files and the texts that symrot emits, else ``""``.

    ``certificate`` is the path of NAME.cert.json, in the folder of the files. Files that cannot be read are skipped.
    """
    name = certificate.name.removesuffix(".cert.json")
    kernel = kernel_of(name)
    if kernel is None:
        return ""
    printed = kernel_text(kernel)
    emitted = printed.under_test(stored_bounds(printed, certificate.parent))
    for file, expected in emitted.files.items():
        try:
            text = read_input(certificate.parent / file, LARGEST).decode(errors="replace")
        except OSError:
            continue
        if text != expected:
            return f": {_first_line(text, expected)}{_meaning(text, emitted) if file == f'{name}.c' else ''}"
    return ""


def _first_line(text: str, emitted: str) -> str:
    if text.replace("\r\n", "\n") == emitted:
        return "its line endings differ"
    actual, expected = text.splitlines(), emitted.splitlines()
    place = next(
        (k for k, (a, b) in enumerate(zip(actual, expected, strict=False)) if a != b), min(len(actual), len(expected))
    )
    present = repr(actual[place].strip()[:LONGEST]) if place < len(actual) else "missing"
    original = repr(expected[place].strip()[:LONGEST]) if place < len(expected) else "no such line"
    return f"line {place + 1} is {present}, but symrot emits {original}"


def _meaning(text: str, emitted: KernelUnderTest) -> str:
    """Return a remark on what an edited C text of a kernel computes: other values, or the same by other operations.

    The remark is ``""`` if the text performs the same operations as the text that symrot emits.
    """
    file = f"{emitted.name}.c"
    symbols = {place: symbol for place, (symbol, _) in emitted.places.items()}
    formulas = {place: formula for place, (_, formula) in emitted.formulas.items()}
    same = True
    try:
        for suffix in emitted.types:
            name = f"symrot_{emitted.name}{suffix}"
            now, was = read_kernel(text, name, file), read_kernel(emitted.files[file], name, file)
            prove_equal(now, symbols, formulas, emitted.named, emitted.parameters)
            same = same and now.digest() == was.digest() == read_batch(text, f"{name}_batch", file).digest()
    except (CertificateError, InputError) as reason:
        return f" ({str(reason)[:LONGEST]})"
    return "" if same else " (it computes the formulas, with other operations)"

"""Audit a certificate: whether everything it says still holds, for the files beside it and for what symrot derives.

:mod:`symrot.certificates.exact_check` decides what can be decided from the files alone. Beyond it: the header says
nothing but prototypes, the operations are those that were certified, and what the certificate says of the kernel
(formulas, laws and their proofs, domain, units, assumptions) is what symrot derives for a kernel of that name and
proves exactly, as identities of fractions of polynomials (:mod:`symrot.certificates.laws.laws`,
:mod:`symrot.certificates.laws.equality`), so that no certificate of something else, however well proven, passes for it.
Bounds of rounding errors are those that symrot finds on the box of the certificate.
"""

import json
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from symrot.certificates import exact_check
from symrot.certificates.certificate import Data, printed, shown
from symrot.certificates.readback.header import check_header
from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.certificates.rounding.bounds import check_bounds, check_section
from symrot.certificates.rounding.bounds_text import library_region, library_section
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.kernels.library import kernel_names
from symrot.kernels.removable import REMOVABLE

__all__ = ["audit", "load"]

LARGEST = 16_000_000  # bytes of a certificate
PARTS: dict[str, Any] = {  # what a certificate holds, and of what type
    "schema": str, "kernel": str, "title": str, "regenerate": str, "convention": str, "domain": str, "derivation": str,
    "files": dict, "inputs": list, "spec": dict, "coq": (dict, type(None)), "flags": dict, "trusted": dict,
    "laws": list, "readback": dict, "rounding": (dict, type(None)), "objects": (dict, type(None)), "seal": str,
}  # fmt: skip
OPTIONAL = ("rounding", "objects")


def load(path: Path) -> Data:
    """Return a certificate; InputError where none can be read, CertificateError for another content."""
    if path.suffix in (".c", ".h", ".o"):
        raise CertificateError(f"{path}: expected a certificate, got another file: its own is {path.stem}.cert.json")
    try:
        content = read_input(path, LARGEST)
    except OSError as reason:
        said = f"a certificate of at most {LARGEST // 1_000_000} MB that can be read"
        raise InputError(f"{path}: expected {said}, got {reason.strerror}") from None
    try:
        data = json.loads(content, object_pairs_hook=_unique, parse_constant=_refused)
    except (ValueError, RecursionError) as reason:
        raise CertificateError(f"{path}: expected a certificate as JSON, and it is not ({reason})") from None
    if not isinstance(data, dict):
        raise CertificateError(f"{path}: expected a certificate, a JSON object, got {type(data).__name__}")
    for name, kind in PARTS.items():
        if name not in data and name not in OPTIONAL:
            raise CertificateError(f"{path}: expected {name!r} in a certificate, there is none")
        if name in data and not isinstance(data[name], kind):
            raise CertificateError(f"{path}: expected another kind of {name!r}, got {type(data[name]).__name__}")
    unknown = sorted(set(data) - set(PARTS))
    if unknown:
        raise CertificateError(f"{path}: expected nothing but what a certificate holds, got {unknown[0]!r}")
    return data


def _unique(pairs: list[tuple[str, Any]]) -> Data:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a name is given twice")
    return found


def _refused(text: str) -> Any:
    raise ValueError(f"the number {text}")


def audit(path: Path, said_by: Callable[[Data], Data | None]) -> tuple[Data, list[str]]:
    """Return a certificate that holds, and what was found of it.

    Parameters
    ----------
    path : Path
        NAME.cert.json, the files that it names beside it.
    said_by : callable
        Takes a certificate and returns what symrot says of that kernel now, and proves
        (:func:`symrot.certificates.certificate.said_of`); None if it knows none of that name.

    Raises
    ------
    CertificateError
        Saying what does not hold.
    """
    data = load(path)
    for file in data["files"]:
        if not file.startswith("../") and not (path.parent / file).is_file():
            raise CertificateError(f"{path}: expected {file} beside it, which it is a certificate of, there is none")
    try:
        said = [exact_check.check(path), *_audited(path, data, said_by), *_compared(data)]
        return data, [*said, _bounds(path, data, (path.parent / f"{data['kernel']}.c").read_text(encoding="utf-8"))]
    except CertificateError:
        raise
    except exact_check.REFUSALS as reason:
        raise CertificateError(f"{path}: {exact_check.sentence(reason)}") from None


def _audited(path: Path, data: Data, said_by: Callable[[Data], Data | None]) -> list[str]:
    name = data["kernel"]
    source, header = ((path.parent / f"{name}{end}").read_text(encoding="utf-8") for end in (".c", ".h"))
    check_header(header, source, name)
    _check_readback(data, source)
    if path.read_text(encoding="utf-8") != printed(data):
        raise CertificateError(f"{path}: expected a certificate as symrot prints it, got another layout")
    said = said_by(data)
    if said is None:
        return [f"{name} is no kernel that symrot knows: its formulas and laws are those of the certificate"]
    _compare(path, data, said)
    return ["formulas, laws, domain, units, flags and assumptions are those that symrot derives, and proves exactly"]


def _compared(data: Data) -> list[str]:
    """Return what is to be said of verdicts on object code: they are of the machine that wrote the certificate."""
    return (
        ["what it says of object code was not looked at: --object compares a file of yours"]
        if data.get("objects")
        else []
    )


def _compare(path: Path, data: Mapping[str, Any], wanted: Mapping[str, Any]) -> None:
    for name, value in wanted.items():
        if json.dumps(data[name]) != json.dumps(value):
            raise CertificateError(f"{path}: expected {name!r} as symrot prints it now, and it is not (emit it anew)")


def _bounds(path: Path, data: Data, source: str) -> str:
    """Refuse bounds of rounding errors that are not those of the operations that are read now."""
    section = data.get("rounding")
    own = library_section(data["kernel"], source) if data["kernel"] in kernel_names() else None
    if section is None:
        if isinstance(own, dict):
            raise CertificateError(f"{path}: expected bounds of rounding errors, there are none (emit it anew)")
        return "no bounds of rounding errors" + (f": {own}" if own else "")
    if json.dumps(section) == json.dumps(own):
        return "bounds of rounding errors are those that symrot knows of these operations on the kernel's own box"
    region = library_region(data["kernel"], source) if own is not None else None
    if region is not None and any(json.dumps(section.get(part)) != json.dumps(value) for part, value in region.items()):
        raise CertificateError(f"{path}: expected bounds of rounding errors on the region of the kernel, got others")
    kernels = list(operations_of(data, source).values())
    double, single = kernels[0], kernels[1] if len(kernels) > 1 else None
    check_section(section, double, single)
    check_bounds(section, double, single)
    return "bounds of rounding errors on a box of your own are those that symrot finds there"


def operations_of(data: Data, source: str) -> dict[str, Operations]:
    """Return the one-sample functions of a certificate, read back now, by name."""
    return {name: read_kernel(source, name, f"{data['kernel']}.c") for name in data["readback"]}


def _check_readback(data: Data, source: str) -> None:
    """Refuse what is said of the operations if it is not what is read now, in the order in which it is read."""
    where = f"{data['kernel']}.c"
    for name, said in data["readback"].items():
        one, batch = read_kernel(source, name, where), read_batch(source, f"{name}_batch", where)
        constants = list(dict.fromkeys(str(node[1]) for node in one.nodes if node[0] == "const"))
        listed = [written for written, _ in said["constants"]]
        series = [function for function, *_ in said["series"]]
        end = "f" if said["type"] == "float" else ""
        checks = {
            "keys": list(said) == ["type", "operations", "digest", "constants", "series"],
            "digest": one.digest() == batch.digest() == said["digest"],
            "counts": said["operations"] == one.counts(),
            "constants": listed == [each for each in constants if each in listed]
            and all(
                means == shown(intended_value(Fraction(written), one.precision)) for written, means in said["constants"]
            ),
            "series": series == [each for each in REMOVABLE if f"symrot_{each}{end}(" in source]
            and all(str(Fraction(text)) == text for _, split, _, rest in said["series"] for text in (split, rest)),
        }
        for what, holds in checks.items():
            if not holds:
                raise CertificateError(f"{where}: expected the {what} of the operations of {name}, got others")

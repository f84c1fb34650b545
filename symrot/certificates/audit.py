"""The audit of a certificate: it checks every statement against the certified files and symrot's own derivations.

A certificate is a JSON file of statements about an emitted C kernel, with proofs. After the check from the files alone
(exact_check.py), symrot derives and proves the same statements again, so that a correct certificate of another kernel
is refused. ``data`` is the content of a certificate, ``path`` its path, and ``source`` the C text.
"""

import json
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from symrot.certificates import exact_check
from symrot.certificates.certificate import Data, certificate_json, intended_text, statement_of_name
from symrot.certificates.readback.header import check_header
from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.javascript import compare_javascript
from symrot.certificates.readback.jax_text import compare_jax
from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.certificates.rounding.bounds_text import library_region, library_section
from symrot.certificates.rounding.section import check_bounds, check_section
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input, repeated_name
from symrot.kernels.library import is_kernel
from symrot.kernels.removable import REMOVABLE

__all__ = ["audit", "load_certificate"]

LARGEST = 16_000_000  # bytes of the largest certificate that is read
PARTS: dict[str, type] = {  # section of a certificate -> its type
    "schema": str, "kernel": str, "title": str, "regenerate": str, "convention": str, "domain": str, "derivation": str,
    "files": dict, "inputs": list, "spec": dict, "coq": dict, "flags": dict, "trusted": dict,
    "laws": list, "readback": dict, "rounding": dict, "objects": dict, "seal": str,
}  # fmt: skip
OPTIONAL = ("rounding", "objects")
NULLABLE = ("coq", *OPTIONAL)  # sections that may be null


def load_certificate(path: Path) -> Data:
    """Read a certificate from its JSON file and return it.

    Raises
    ------
    InputError
        If the file cannot be read.
    CertificateError
        If the file is not a certificate.
    """
    if path.suffix in (".c", ".h", ".o"):
        raise CertificateError(
            f"{path}: expected a certificate, got another kind of file; write the path of its "
            f"certificate, {path.stem}.cert.json"
        )
    try:
        content = read_input(path, LARGEST)
    except OSError as reason:
        expected = f"a certificate of at most {LARGEST // 1_000_000} MB that can be read"
        raise InputError(f"{path}: expected {expected}, got {reason.strerror}") from None
    try:
        data = json.loads(content, object_pairs_hook=_unique, parse_constant=_refused)
    except (ValueError, RecursionError) as reason:
        raise CertificateError(f"{path}: expected a certificate as JSON, but the text is not JSON ({reason})") from None
    if not isinstance(data, dict):
        raise CertificateError(f"{path}: expected a certificate, a JSON object, got {type(data).__name__}")
    if str(data.get("schema", "")).startswith("symrot.step/"):
        raise CertificateError(f"{path}: expected the certificate of a kernel, got the certificate of a time step")
    for name, kind in PARTS.items():
        if name not in data and name not in OPTIONAL:
            raise CertificateError(f"{path}: expected the section {name!r} in a certificate, but it is missing")
        if name in data and not (isinstance(data[name], kind) or (data[name] is None and name in NULLABLE)):
            expected = f"{kind.__name__} or null" if name in NULLABLE else kind.__name__
            raise CertificateError(
                f"{path}: expected {name!r} to be of type {expected}, got {type(data[name]).__name__}"
            )
    unknown = sorted(set(data) - set(PARTS))
    if unknown:
        raise CertificateError(
            f"{path}: expected only the sections that symrot writes into a certificate, got {unknown[0]!r}"
        )
    return data


def _unique(pairs: list[tuple[str, Any]]) -> Data:
    twice = repeated_name(pairs)
    if twice is not None:
        raise ValueError(f"expected each name at most once in a JSON object, got {twice!r} twice")
    return dict(pairs)


def _refused(text: str) -> Any:
    raise ValueError(f"JSON has no number {text}")


def audit(path: Path, symrot_statement: Callable[[Data], Data | None]) -> tuple[Data, list[str]]:
    """Check every statement of a certificate, except its verdicts on object code.

    Return the content of the certificate, and a list of sentences that say what was checked and what was not.

    Parameters
    ----------
    path : Path
        NAME.cert.json; the files that it names are in the same folder.
    symrot_statement : callable
        Takes the content of a certificate and returns the statements that symrot proves about the kernel of that name
        (:func:`symrot.certificates.certificate.proven_statement`), or None if there is no such kernel.

    Raises
    ------
    InputError
        If the certificate cannot be read.
    CertificateError
        If the file is not a certificate, or a check fails; the message names the first check that fails.
    """
    data = load_certificate(path)
    try:
        for file in data["files"]:
            if not file.startswith("../") and not (path.parent / file).is_file():
                raise CertificateError(f"{path}: expected its file {file} in the same folder, but it is missing")
        findings = [exact_check.check(path), *_audited(path, data, symrot_statement), *_unchecked_objects(data)]
        return data, [*findings, _bounds(path, data, (path.parent / f"{data['kernel']}.c").read_text(encoding="utf-8"))]
    except CertificateError:
        raise
    except exact_check.REFUSALS as reason:
        raise CertificateError(f"{path}: {exact_check.sentence(reason)}") from None


def _audited(path: Path, data: Data, symrot_statement: Callable[[Data], Data | None]) -> list[str]:
    """Check a certificate, parsed as ``data``, with the kernel's header and C text; return sentences about the checks.

    The statements of the certificate are compared with those that ``symrot_statement`` derives, as in :func:`audit`.
    CertificateError is raised at the first check that fails.
    """
    name = data["kernel"]
    source, header = ((path.parent / f"{name}{end}").read_text(encoding="utf-8") for end in (".c", ".h"))
    check_header(header, source, name)
    _check_readback(data, source)
    findings = _check_others(path, data, source)
    if path.read_text(encoding="utf-8") != certificate_json(data):
        raise CertificateError(
            f"{path}: expected a certificate as symrot prints it, got another layout; emit the kernel again"
        )
    # formulas, laws and their proofs, domain, units and assumptions, proven exactly in laws/
    statement = symrot_statement(data)
    if statement is None:
        _compare(path, data, statement_of_name(name))
        return [
            *findings,
            f"symrot has no kernel {name}, so its formulas, laws, domain, units and comments were not compared with "
            "symrot's own; if it was emitted from a scene, pass that scene with --scene",
        ]
    _compare(path, data, statement)
    return [
        *findings,
        "formulas, laws, domain, units, flags and assumptions equal those that symrot derives and proves exactly",
    ]


_READERS = {".js": compare_javascript, "_jax.py": compare_jax}


def _check_others(path: Path, data: Data, source: str) -> list[str]:
    """Check the JavaScript and JAX files of a kernel against its C text; return a sentence for each file.

    A file that does not exist is left out.
    """
    findings = []
    for ending, compare in _READERS.items():
        for file in data["files"]:
            if file.endswith(ending) and (path.parent / file).is_file():
                compare((path.parent / file).read_text(encoding="utf-8"), data["kernel"], source, file)
                findings.append(f"{file} performs the operations of the C text")
    return findings


def _unchecked_objects(data: Data) -> list[str]:
    """Return a list with the sentence "the certificate's verdicts on object code were not checked; ..".

    The list is empty if the certificate has no verdicts on object code.
    """
    # a verdict holds only for the machine where it was made
    finding = (
        "the certificate's verdicts on object code were not checked; pass your object file by --object to compare its "
        "code with the C text"
    )
    return [finding] if data.get("objects") else []


def _compare(path: Path, data: Mapping[str, Any], statement: Mapping[str, Any]) -> None:
    """Raise CertificateError unless each section that symrot derives now equals that section of the certificate.

    ``data`` is the certificate; ``statement`` maps the names of sections to what symrot derives.
    """
    for name, value in statement.items():
        if json.dumps(data[name]) != json.dumps(value):
            raise CertificateError(
                f"{path}: expected {name!r} as symrot prints it now, got other content; emit the kernel again"
            )


def _bounds(path: Path, data: Data, source: str) -> str:
    """Check a certificate's bounds of rounding errors; return a sentence that says what was checked."""
    section = data.get("rounding")
    own = library_section(data["kernel"], source) if is_kernel(data["kernel"]) else None
    if section is None:
        # symrot has bounds for this kernel
        if isinstance(own, dict):
            raise CertificateError(
                f"{path}: expected bounds of rounding errors, but the certificate has none; "
                f"write it again by `symrot emit {data['kernel']}`"
            )
        return "no bounds of rounding errors" + (f": {own}" if own else "")
    if json.dumps(section) == json.dumps(own):
        return "bounds of rounding errors equal symrot's own for this C text, on the standard ranges of the inputs"
    region = library_region(data["kernel"], source) if own is not None else None
    for part, value in (region or {}).items():
        if json.dumps(section.get(part)) != json.dumps(value):
            raise CertificateError(
                f"{path}: expected {part!r} in the section on rounding errors to be {json.dumps(value)}, which symrot "
                f"assumes for this kernel, got {json.dumps(section.get(part))[:80]}; write the certificate again by "
                f"`symrot emit {data['kernel']}`"
            )
    kernels = list(operations_of(data, source).values())
    double, single = kernels[0], kernels[1] if len(kernels) > 1 else None
    check_section(section, double, single)
    check_bounds(section, double, single)
    return "bounds of rounding errors equal those that symrot computes for this C text, on the certificate's ranges"


def operations_of(data: Data, source: str) -> dict[str, Operations]:
    """Return the operations that each C function for one sample performs, by the function's name."""
    # the certificate names the functions
    return {name: read_kernel(source, name, f"{data['kernel']}.c") for name in data["readback"]}


def _check_readback(data: Data, source: str) -> None:
    """Raise CertificateError if the section ``readback`` does not list the operations that the C text performs."""
    where = f"{data['kernel']}.c"
    for name, stated in data["readback"].items():
        one, batch = read_kernel(source, name, where), read_batch(source, f"{name}_batch", where)
        constants = list(dict.fromkeys(str(node[1]) for node in one.nodes if node[0] == "const"))
        listed = [written for written, _ in stated["constants"]]
        series = [function for function, *_ in stated["series"]]
        end = "f" if stated["type"] == "float" else ""
        # the section states, for each function, the counts and the digest of its operations and its constants
        checks = {
            "type, operations, digest, constants and series": list(stated)
            == ["type", "operations", "digest", "constants", "series"],
            "digest of the operations": one.digest() == batch.digest() == stated["digest"],
            "numbers of operations": stated["operations"] == one.counts(),
            "constants": listed == [each for each in constants if each in listed]
            and all(
                means == intended_text(intended_value(Fraction(written), one.precision))
                for written, means in stated["constants"]
            ),
            "series near zero": series == [each for each in REMOVABLE if f"symrot_{each}{end}(" in source]
            and all(str(Fraction(text)) == text for _, split, _, rest in stated["series"] for text in (split, rest)),
        }
        for what, holds in checks.items():
            if not holds:
                raise CertificateError(
                    f"{where}: expected 'readback' in the certificate to state the {what} of the C function {name}, "
                    "got another statement; certify the kernel again"
                )

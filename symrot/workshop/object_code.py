"""Comparison of object code with a kernel's C text, compiled on this machine or taken from a user's object file."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from symrot.build import cache
from symrot.certificates.certificate import Data
from symrot.certificates.flags import BITS
from symrot.certificates.object_code.build import COMPILERS, compiler_version, objects_section
from symrot.certificates.object_code.comparison import CONTRACTED, IDENTICAL, compare_object
from symrot.certificates.object_code.disassembly import why_no_objdump
from symrot.errors import CertificateError, InputError
from symrot.workshop.kernel_files import write_files

__all__ = ["holds", "lines", "object_lines", "objects_of", "require_compiler", "table"]

HOLDS = {IDENTICAL: "each rounded as there: the bits of results are the same, the error bounds hold",
         CONTRACTED: "some fused to multiply-adds: the error bounds hold, the bits of results may differ"}  # fmt: skip


def require_compiler() -> None:
    """Raise InputError unless a C compiler and a disassembler are installed."""
    if not any(map(compiler_version, COMPILERS)):
        raise InputError(f"--objects: expected {' or '.join(COMPILERS)} on the path to compile with, found neither")
    if why_no_objdump():
        raise InputError(f"--objects: {why_no_objdump()}")


def objects_of(texts: Mapping[str, str], source: str, programs: str) -> Data:
    """Compile a kernel, compare the object code with its C text, and return the certificate's section on object code.

    Parameters
    ----------
    texts : mapping of str to str
        A map from file name to text: the kernel and the headers that it includes.
    source : str
        The name of the C file in ``texts``.
    programs : str
        The hash of symrot's source files. The section comes from the cache if this hash, the texts and the versions of
        the compilers are unchanged.
    """
    versions = [compiler_version(compiler) for compiler in COMPILERS]
    key = f"objects of {json.dumps([source, dict(texts), versions])} by {programs}"
    stored = cache.fetch(key)
    if stored is None:
        with TemporaryDirectory(prefix="symrot-") as directory:
            write_files(Path(directory), texts)
            stored = json.dumps(objects_section(Path(directory) / source))
        cache.store(key, stored)
    section: Data = json.loads(stored)
    return section


def holds(section: Data | None) -> bool:
    """Return whether the object code in a certificate is proven to compute the same bits as the C text.

    ``section`` is the section ``objects`` of the certificate, or None. The proof is about strict code: code compiled
    with flags that forbid a compiler to change any bit of a result, such as ``-ffp-contract=off``. Return False if the
    section is about no strict code.
    """
    strict = [item for item in _objects(section) if item["flags_hold"] == BITS]
    return bool(strict) and all(function["verdict"] == IDENTICAL for item in strict for function in item["functions"])


def lines(section: Data | None) -> list[str]:
    """Return the verdicts on the object code of a kernel, one line for each compiler and its flags.

    ``section`` is the section ``objects`` of the certificate, or None. A line for each missing compiler comes last.
    """
    verdicts = [f"{item['compiler']} {item['flags']}: {_verdict(item)}" for item in _objects(section)]
    absent = (section or {}).get("missing", ())
    return [*verdicts, *(f"{compiler} is not on the path: not compared" for compiler in absent)]


def table(sections: Mapping[str, Data | None]) -> list[str]:
    """Return lines of text: for each compiler with its flags, how many kernels are accepted and which are rejected.

    A kernel is accepted if its object code performs the operations of its C text. ``sections`` maps the name of each
    kernel to the section ``objects`` of its certificate, or to None if its object code was not compared.
    """
    by_flags: dict[str, dict[str, Data]] = {}
    for name, section in sections.items():
        for item in _objects(section):
            by_flags.setdefault(f"{item['compiler']} {item['flags']}", {})[name] = item
    text_lines = []
    for flags, items in by_flags.items():
        text_lines.append(f"  {flags}: {sum(item['accepted'] for item in items.values())} of {len(items)}")
        text_lines += [f"    {name}: {_verdict(item)}" for name, item in items.items() if not item["accepted"]]
    return text_lines


def object_lines(text: str, path: Path, where: str) -> list[str]:
    """Check that an object file performs the operations of its C text; return one line for each function.

    One more line says that loops over samples (``*_batch``) are not compared.

    Parameters
    ----------
    text : str
        The C text.
    path : Path
        The object file.
    where : str
        The name of the C file, for messages.

    Raises
    ------
    CertificateError
        If a function differs; the message names the first such function and the difference.
    """
    verdicts = compare_object(text, path, where=where)
    refused = [verdict for verdict in verdicts if not verdict.accepted]
    if refused:
        raise CertificateError(f"{path}: {refused[0].sentence()}")
    text_lines = [
        f"{path}: {verdict.function} performs the operations of the C text, {HOLDS[verdict.verdict]}"
        for verdict in verdicts
    ]
    return [*text_lines, f"{path}: loops over samples are not compared; the certificate says what flags do to them"]


def _objects(section: Data | None) -> Iterator[Data]:
    yield from (section or {}).get("objects", ())


def _verdict(item: Data) -> str:
    """Return the verdict on one object file: that it performs the operations of the C text, or why it is rejected."""
    verdicts = {function["verdict"] for function in item["functions"]}
    if item["accepted"]:
        return f"performs the operations of the C text, {HOLDS[IDENTICAL if verdicts == {IDENTICAL} else CONTRACTED]}"
    refused = [function for function in item["functions"] if function["verdict"] not in HOLDS]
    if not refused:
        return "not accepted under these flags"
    # the reason for the first rejected function
    first = refused[0]
    where = f", output {first['output']}" if first["output"] else ""
    return (
        f"does not perform the operations of the C text ({first['name']}: {first['verdict']}{where}: {first['reason']})"
    )

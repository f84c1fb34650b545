"""Link 5 in words and numbers: object code compared with the C text, by the compilers here or in a file of yours."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from symrot.build import cache as library
from symrot.certificates.certificate import Data
from symrot.certificates.flags import BITS
from symrot.certificates.object_code.build import COMPILERS, compiler_version, objects_section
from symrot.certificates.object_code.comparison import CONTRACTED, IDENTICAL, compare_object
from symrot.certificates.object_code.disassembly import missing
from symrot.errors import CertificateError, InputError
from symrot.workshop.kernel_files import write_files

__all__ = ["holds", "lines", "object_lines", "objects_of", "require_compiler", "table"]

HOLDS = {IDENTICAL: "rounding for rounding: bits and bounds hold",
         CONTRACTED: "up to fused multiply-adds: bounds hold, bits do not"}  # fmt: skip


def require_compiler() -> None:
    """Refuse to compare object code where nothing compiles, or nothing reads it."""
    if not any(map(compiler_version, COMPILERS)):
        raise InputError(f"--objects: expected {' or '.join(COMPILERS)} on the path to compile with, there is none")
    if missing():
        raise InputError(f"--objects: {missing()}")


def objects_of(texts: Mapping[str, str], source: str, programs: str) -> Data:
    """Return what compilers make of a kernel, compared with it: the objects section of a certificate.

    Parameters
    ----------
    texts : mapping of str to str
        File name -> text: the kernel and the headers that it includes.
    source : str
        The name of the C file among them.
    programs : str
        The digest of the programs that compare: with it, the texts and the compilers unchanged the cache has it.
    """
    versions = [compiler_version(compiler) for compiler in COMPILERS]
    key = f"objects of {json.dumps([source, dict(texts), versions])} by {programs}"
    kept = library.fetch(key)
    if kept is None:
        with TemporaryDirectory(prefix="symrot-") as directory:
            write_files(Path(directory), texts)
            kept = json.dumps(objects_section(Path(directory) / source))
        library.store(key, kept)
    found: Data = json.loads(kept)
    return found


def holds(section: Data | None) -> bool:
    """Return whether object code is the C text for every compiler, under all flags by which bits are to hold."""
    strict = [item for item in _objects(section) if item["flags_hold"] == BITS]
    return bool(strict) and all(each["verdict"] == IDENTICAL for item in strict for each in item["functions"])


def lines(section: Data | None) -> list[str]:
    """Return what was found of a kernel, a line for each compiler and its flags."""
    said = [f"  link 5    {item['compiler']} {item['flags']}: {_verdict(item)}" for item in _objects(section)]
    return [
        *said,
        *(f"  link 5    {each} is not on the path: not compared" for each in (section or {}).get("missing", ())),
    ]


def table(sections: Mapping[str, Data | None]) -> list[str]:
    """Return, for each compiler and its flags, of how many kernels the object code is the C text, and of which not."""
    found: dict[str, dict[str, Data]] = {}
    for name, section in sections.items():
        for item in _objects(section):
            found.setdefault(f"{item['compiler']} {item['flags']}", {})[name] = item
    said = []
    for flags, items in found.items():
        said.append(f"  {flags}: {sum(item['accepted'] for item in items.values())} of {len(items)}")
        said += [f"    {name}: {_verdict(item)}" for name, item in items.items() if not item["accepted"]]
    return said


def object_lines(text: str, path: Path, where: str) -> list[str]:
    """Return what of an object file is the C text, line by line.

    Raises
    ------
    CertificateError
        For the first function that is not, and how.
    """
    verdicts = compare_object(text, path, where=where)
    refused = [verdict for verdict in verdicts if not verdict.accepted]
    if refused:
        raise CertificateError(f"{path}: {refused[0].sentence()}")
    said = [f"{path}: {verdict.function} is the C text, {HOLDS[verdict.verdict]}" for verdict in verdicts]
    return [*said, f"{path}: loops over samples are not compared; what their flags do, the certificate says"]


def _objects(section: Data | None) -> Iterator[Data]:
    yield from (section or {}).get("objects", ())


def _verdict(item: Data) -> str:
    """Return what was found of one object, in words; of a refusal the first reason."""
    verdicts = {each["verdict"] for each in item["functions"]}
    if item["accepted"]:
        return f"the C text, {HOLDS[IDENTICAL if verdicts == {IDENTICAL} else CONTRACTED]}"
    refused = [each for each in item["functions"] if each["verdict"] not in HOLDS]
    if not refused:
        return "not accepted under these flags"
    first = refused[0]
    where = f", output {first['output']}" if first["output"] else ""
    return f"not the C text ({first['name']}: {first['verdict']}{where}: {first['reason']})"

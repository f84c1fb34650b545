"""The theorems of Coq as files and as a table: which were checked, on which axioms they rest, what was refused."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from symrot.certificates.coq.check import CoqResult, check_texts, coqc
from symrot.certificates.coq.library import ASSUMPTIONS, RULES, coq_file, coq_file_names, coq_texts
from symrot.errors import CertificateError
from symrot.report.layout import columns
from symrot.workshop.kernel_files import write_files

__all__ = ["facts", "lines", "prove"]

MISSING = "no coqc was found (Debian package coq)"


def prove(directory: Path, demanded: bool, progress: Callable[[str], object]) -> tuple[list[Path], CoqResult | None]:
    """Write all files of theorems into a folder and have Coq check them; return changed files and what Coq said.

    Without Coq the files are written all the same and the second value is None.

    Raises
    ------
    CertificateError
        Where the check is demanded and there is no Coq; nothing is written then.
    """
    found = coqc()
    if demanded and found is None:
        raise CertificateError(f"--check: expected Coq to check the theorems with, {MISSING}")
    progress("printing theorems ..")
    texts = coq_texts()
    written = write_files(directory, texts)
    return written, check_texts(texts, progress=progress) if found else None


def facts(directory: Path, written: list[Path], result: CoqResult | None) -> dict[str, Any]:
    """Return what :func:`prove` found, as JSON takes it."""
    found: dict[str, Any] = {
        "directory": str(directory),
        "files": [f"{name}.v" for name in (RULES, *coq_file_names(), ASSUMPTIONS)],
        "written": [str(path) for path in written],
        "theorems": [{"file": f"{name}.v", "theorem": theorem.name, "about": theorem.about}
                     for name in coq_file_names() for theorem in coq_file(name).theorems],
        "checked": result is not None,
    }  # fmt: skip
    if result is not None:
        for entry, each in zip(found["theorems"], result.theorems, strict=True):
            entry["outcome"] = each.outcome
        found |= {"axioms": list(result.axioms), "problems": list(result.problems), "coq": result.version,
                  "seconds": result.seconds, "holds": bool(result)}  # fmt: skip
    return found


def lines(directory: Path, result: CoqResult | None) -> list[str]:
    """Return what :func:`prove` found, as text."""
    if result is None:
        count = sum(len(coq_file(name).theorems) for name in coq_file_names())
        return [f"{count} theorems written to {directory}, not checked: {MISSING}"]
    table = columns([(each.outcome, each.name, each.file) for each in result.theorems])
    if result:
        held = f"{len(result.theorems)} theorems hold, checked by Coq {result.version} in {result.seconds:.0f} s; "
        return [*table, "", f"{held}nothing admitted; axioms, those of its real numbers:",
                *(f"  {axiom}" for axiom in result.axioms)]  # fmt: skip
    return [*table, "", *result.problems]

"""Coq files of theorems: writing the files, checking them with Coq, and reporting the result and the axioms used."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from symrot.certificates.coq.check import CoqResult, check_texts, coqc
from symrot.certificates.coq.library import ASSUMPTIONS, RULES, coq_file, coq_file_names, coq_texts
from symrot.errors import CertificateError
from symrot.report.layout import columns
from symrot.workshop.kernel_files import write_files

__all__ = ["facts", "lines", "prove"]

MISSING = "coqc is not on the path (Debian package coq)"


def prove(directory: Path, demanded: bool, progress: Callable[[str], object]) -> tuple[list[Path], CoqResult | None]:
    """Write all Coq files into a folder and check them with Coq; return the changed files and the result.

    The result is None if Coq is not installed.

    Raises
    ------
    CertificateError
        If ``demanded`` is true and Coq is not installed; then nothing is written.
    """
    prover = coqc()
    if demanded and prover is None:
        raise CertificateError(f"--check: expected Coq, which checks the theorems, to be installed; {MISSING}")
    progress("printing theorems ..")
    texts = coq_texts()
    written = write_files(directory, texts)
    return written, check_texts(texts, progress=progress) if prover else None


def facts(directory: Path, written: list[Path], result: CoqResult | None) -> dict[str, Any]:
    """Return the theorems and Coq's result, as :func:`prove` returned it, as data for JSON."""
    # ``result`` is None if Coq is not installed
    report: dict[str, Any] = {
        "directory": str(directory),
        "files": [f"{name}.v" for name in (RULES, *coq_file_names(), ASSUMPTIONS)],
        "written": [str(path) for path in written],
        "theorems": [{"file": f"{name}.v", "theorem": theorem.name, "about": theorem.about}
                     for name in coq_file_names() for theorem in coq_file(name).theorems],
        "checked": result is not None,
    }  # fmt: skip
    if result is not None:
        for entry, theorem in zip(report["theorems"], result.theorems, strict=True):
            entry["outcome"] = theorem.outcome
        report |= {"axioms": list(result.axioms), "problems": list(result.problems), "coq": result.version,
                  "seconds": result.seconds, "holds": bool(result)}  # fmt: skip
    return report


def lines(directory: Path, result: CoqResult | None) -> list[str]:
    """Return lines of text about ``result``, as :func:`prove` returned it; None means that nothing was checked."""
    if result is None:
        count = sum(len(coq_file(name).theorems) for name in coq_file_names())
        return [f"{count} theorems written to {directory}, not checked: {MISSING}"]
    table = columns([(theorem.outcome, theorem.name, theorem.file) for theorem in result.theorems])
    if result:
        outcome = f"{len(result.theorems)} theorems hold, checked by Coq {result.version} in {result.seconds:.0f} s; "
        return [*table, "", f"{outcome}nothing admitted; only the axioms of Coq's real numbers are used:",
                *(f"  {axiom}" for axiom in result.axioms)]  # fmt: skip
    return [*table, "", *result.problems]

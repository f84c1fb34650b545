"""Checks of theorem files with Coq: no proof may be skipped, and only axioms of the real numbers may be used."""

import os
import re
import shutil
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from symrot.certificates.coq.library import ASSUMPTIONS, RULES, STANDARD_AXIOMS, coq_section, coq_texts
from symrot.certificates.tools import run_tool
from symrot.errors import CertificateError, CompilerError

__all__ = ["CoqResult", "TheoremResult", "check_kernel", "check_texts", "coqc", "unproven"]

SECONDS, SECONDS_TO_ANSWER = 300, 20  # limits for checking one file, and for printing the version

_COMMENT = re.compile(r"\(\*.*?\*\)", re.DOTALL)
_UNPROVEN = re.compile(
    r"\b(Admitted|admit|Abort|Axioms?|Parameters?|Conjectures?|Hypothes[ie]s|Variables?|Context|give_up|Unset|"
    r"bypass_check|Extract|Declare|Load|Drop)\b"
)
_THEOREM = re.compile(r"^Theorem (\w+)", re.MULTILINE)
_AXIOM = re.compile(r"^([\w.]+)\s*:|^([\w.]+)$", re.MULTILINE)
_PLACE = re.compile(r'File "[^"]*?([^/"]+)", line (\d+), characters [^:]*:\s*(.*)', re.DOTALL)


@dataclass(frozen=True)
class TheoremResult:
    """The outcome of checking one theorem of a file with Coq."""

    file: str
    name: str
    # "ok", "refused" (Coq stopped at this theorem) or "not reached" (Coq stopped before this theorem, or the file was
    # not checked)
    outcome: str


@dataclass(frozen=True)
class CoqResult:
    """The result of checking files of theorems with Coq; ``bool(result)`` is True if there are no problems.

    Attributes
    ----------
    theorems : tuple of TheoremResult
        The outcome of each theorem.
    axioms : tuple of str
        All axioms on which the theorems rest.
    problems : tuple of str
        One sentence for each refused file or axiom, and for proofs that are skipped; usually with the line number and
        Coq's message.
    seconds : float
        The time that all checks took.
    version : str
        The version of Coq.
    """

    theorems: tuple[TheoremResult, ...]
    axioms: tuple[str, ...]
    problems: tuple[str, ...]
    seconds: float
    version: str

    def __bool__(self) -> bool:
        return not self.problems


def coqc() -> str | None:
    """Return the path of Coq's compiler: ``coqc``, or the program that the environment variable ``COQC`` names.

    The result is None if the program is not found.
    """
    return shutil.which(os.environ.get("COQC") or "coqc")


def coq_version(compiler: str) -> str:
    """Return the version of a Coq compiler, e.g. ``"8.16.1"``."""
    done = run_tool([compiler, "--print-version"], SECONDS_TO_ANSWER)
    return (done.stdout.split() or ["unknown"])[0]


def unproven(text: str) -> tuple[str, ...]:
    """Return the words of a Coq file, outside comments, that are not allowed there, such as ``Admitted``.

    They skip a proof, assume a statement, or change what Coq reads and checks.
    """
    return tuple(match[0] for match in _UNPROVEN.finditer(_COMMENT.sub(" ", text)))


def check_kernel(kernel: str, seconds: float = SECONDS) -> CoqResult:
    """Return the result of checking with Coq the theorem about a kernel, within ``seconds`` for each file.

    Raises
    ------
    CertificateError
        If there is no theorem about the kernel, or Coq is not installed.
    """
    section = coq_section(kernel)
    if section is None:
        raise CertificateError(
            f"{kernel}: expected the name of a kernel about which there is a Coq theorem; `symrot "
            "prove` lists these kernels"
        )
    name = str(section["file"]).removesuffix(".v")
    # with the files that the theorem's file requires
    return check_texts(coq_texts((name,)), seconds=seconds)


def check_texts(
    texts: Mapping[str, str],
    jobs: int | None = None,
    seconds: float = SECONDS,
    progress: Callable[[str], object] = lambda text: None,
) -> CoqResult:
    """Check files of theorems with Coq, several at once; return one result for all.

    Parameters
    ----------
    texts : mapping of str to str
        A map from file name to text, as :func:`symrot.certificates.coq.library.coq_texts` returns it.
    jobs : int, optional
        Number of files to check at once; default: the number of processors.
    seconds : float
        Time limit for one file.
    progress : callable
        Called with a line of text when the check of a file begins.

    Raises
    ------
    CertificateError
        If Coq is not installed, or files require each other in a circle. A file that Coq refuses raises nothing: its
        message is in ``problems`` of the result.
    CompilerError
        If Coq does not print its version.
    """
    compiler = coqc()
    if compiler is None:
        raise CertificateError(
            "expected Coq's compiler coqc, which checks theorems, but it is not installed (Debian package coq)"
        )
    start = perf_counter()
    sources = {name.removesuffix(".v"): text for name, text in texts.items() if name.endswith(".v")}
    problems = [f"{name}.v: expected proofs, got {', '.join(sorted(set(words)))}"
                for name, text in sources.items() if (words := unproven(text))]  # fmt: skip
    with TemporaryDirectory(prefix="symrot-coq-") as folder:
        place = Path(folder)
        for name, text in sources.items():
            (place / f"{name}.v").write_text(text, encoding="utf-8")
        complaints: dict[str, str | None] = {}  # file -> message of Coq, or None
        outputs: dict[str, str] = {}

        def one(name: str) -> None:
            required = _required(sources[name]) & sources.keys()
            if any(complaints.get(each) is not None for each in required):
                complaints[name] = "not checked, since a file that it requires was refused"
                return
            progress(f"checking {name}.v ..")
            complaints[name], outputs[name] = _compile(compiler, place, name, seconds)

        for level in _levels(sources):
            with ThreadPoolExecutor(jobs or os.cpu_count() or 1) as pool:
                list(pool.map(one, level))
    problems += [f"{name}.v: {complaint}" for name, complaint in complaints.items() if complaint]
    axioms = _axioms(outputs.get(ASSUMPTIONS, ""))
    problems += [f"the theorems rest on {axiom}, which is no axiom of the real numbers of Coq's standard library"
                 for axiom in axioms if axiom not in STANDARD_AXIOMS]  # fmt: skip
    if complaints.get(ASSUMPTIONS) is None and not outputs.get(ASSUMPTIONS, "").strip():
        problems.append("Coq did not say on which axioms the theorems rest")
    theorems = [result for name, text in sources.items() for result in _results(name, text, complaints[name])]
    return CoqResult(tuple(theorems), axioms, tuple(problems), perf_counter() - start, coq_version(compiler))


def _required(text: str) -> set[str]:
    return {each for line in re.findall(r"^From symrot Require (?:Import )?(.*)\.$", text, re.MULTILINE)
            for each in line.split()}  # fmt: skip


def _levels(sources: Mapping[str, str]) -> list[list[str]]:
    """Return Coq files in groups, in the order in which Coq must check the groups.

    A file requires only files of earlier groups, so the files of one group can be checked in parallel. ``sources`` maps
    the name of each file to its text. CertificateError is raised if files require each other in a circle.
    """
    levels: list[list[str]] = []
    left, done = dict(sources), set[str]()
    while left:
        ready = [name for name, text in left.items() if _required(text) & sources.keys() <= done]
        if not ready:
            raise CertificateError(
                f"expected Coq files without a cycle of Require commands, got a cycle of {', '.join(left)}"
            )
        levels.append(ready)
        done |= set(ready)
        left = {name: text for name, text in left.items() if name not in done}
    return levels


def _compile(compiler: str, place: Path, name: str, seconds: float) -> tuple[str | None, str]:
    """Compile the file ``NAME.v`` in the folder ``place``, for at most ``seconds``.

    Return Coq's error message (None if there is none) and what Coq prints.
    """
    # Coq writes files of its own into the folder
    command = [compiler, "-q", "-R", ".", "symrot", f"{name}.v"]
    try:
        done = run_tool(command, seconds, place)
    except CompilerError as reason:
        return f"not checked: {reason}", ""
    if done.returncode == 0:
        return None, done.stdout
    place_match = _PLACE.search(done.stderr)
    if place_match is None:
        return f"Coq failed with exit code {done.returncode}: {' '.join(done.stderr.split())[-300:]}", done.stdout
    return f"line {place_match[2]}: {' '.join(place_match[3].split())[:300]}", done.stdout


def _axioms(printed: str) -> tuple[str, ...]:
    """Return the names of the axioms in ``printed``, the output of Coq's command ``Print Assumptions``."""
    return tuple(sorted({match[1] or match[2] for match in _AXIOM.finditer(printed) if match[0] != "Axioms:"}))


def _results(name: str, text: str, complaint: str | None) -> list[TheoremResult]:
    """Return the outcome of each theorem of a Coq file; ``complaint`` is Coq's error message, or None.

    The list is empty for two files that state no theorem about a kernel: ``rotation.v``, with general lemmas about
    rotations, and ``assumptions.v``, which makes Coq print the axioms.
    """
    if name in (RULES, ASSUMPTIONS):
        return []
    theorems = [(text.count("\n", 0, match.start()) + 1, match[1]) for match in _THEOREM.finditer(text)]
    if complaint is None:
        return [TheoremResult(f"{name}.v", theorem, "ok") for _, theorem in theorems]
    # the line number in Coq's message shows which theorem was refused
    line = re.match(r"line (\d+):", complaint)
    refused = max((start for start, _ in theorems if start <= int(line[1])), default=0) if line else 0
    outcomes = [("ok" if start < refused else "refused" if start == refused else "not reached", theorem)
               for start, theorem in theorems]  # fmt: skip
    return [TheoremResult(f"{name}.v", theorem, result) for result, theorem in outcomes]

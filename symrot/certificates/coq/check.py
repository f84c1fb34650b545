"""Run Coq on files of theorems: every file checked, nothing admitted, no axiom but those of the real numbers.

The files are checked in a folder of their own, so that what Coq writes beside them lands nowhere else.
"""

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

SECONDS, SECONDS_TO_ANSWER = 300, 20  # that one file may take, and the version

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
    """What became of a theorem: ``"ok"``, ``"refused"``, or ``"not reached"`` behind a refused one."""

    file: str
    name: str
    outcome: str


@dataclass(frozen=True)
class CoqResult:
    """What Coq said of a set of files.

    Attributes
    ----------
    theorems : tuple of TheoremResult
    axioms : tuple of str
        On which the theorems rest, all together.
    problems : tuple of str
        One sentence each: what was refused, where, and what Coq said.
    seconds : float
    version : str
    """

    theorems: tuple[TheoremResult, ...]
    axioms: tuple[str, ...]
    problems: tuple[str, ...]
    seconds: float
    version: str

    def __bool__(self) -> bool:
        return not self.problems


def coqc() -> str | None:
    """Return the path of Coq's compiler: that of the variable ``COQC``, else the one on the path; None without one."""
    return shutil.which(os.environ.get("COQC") or "coqc")


def coq_version(compiler: str) -> str:
    """Return the version of a compiler, e.g. ``"8.16.1"``."""
    done = run_tool([compiler, "--print-version"], SECONDS_TO_ANSWER)
    return (done.stdout.split() or ["unknown"])[0]


def unproven(text: str) -> tuple[str, ...]:
    """Return the words of a file that assume or skip something instead of proving it; comments do not count."""
    return tuple(match[0] for match in _UNPROVEN.finditer(_COMMENT.sub(" ", text)))


def check_kernel(kernel: str, seconds: float = SECONDS) -> CoqResult:
    """Check the theorem about a kernel, with its file and those it requires, printed now.

    Raises
    ------
    CertificateError
        For a kernel without a theorem, or where there is no Coq.
    """
    section = coq_section(kernel)
    if section is None:
        raise CertificateError(f"{kernel}: expected a kernel that a theorem of Coq is about; `symrot prove` lists them")
    name = str(section["file"]).removesuffix(".v")
    return check_texts(coq_texts((name,)), seconds=seconds)


def check_texts(
    texts: Mapping[str, str],
    jobs: int | None = None,
    seconds: float = SECONDS,
    progress: Callable[[str], object] = lambda text: None,
) -> CoqResult:
    """Check files of theorems, several at once.

    Parameters
    ----------
    texts : mapping of str to str
        As from :func:`symrot.certificates.coq.library.coq_texts`: file name -> text.
    jobs : int, optional
        How many at once; the number of processors when left out.
    seconds : float
        That one file may take.

    Raises
    ------
    CertificateError
        Where there is no Coq.
    """
    compiler = coqc()
    if compiler is None:
        raise CertificateError("expected Coq's compiler coqc to check theorems with, found none (Debian package coq)")
    start = perf_counter()
    sources = {name.removesuffix(".v"): text for name, text in texts.items() if name.endswith(".v")}
    problems = [f"{name}.v: expected proofs, got {', '.join(sorted(set(words)))}"
                for name, text in sources.items() if (words := unproven(text))]  # fmt: skip
    with TemporaryDirectory(prefix="symrot-coq-") as folder:
        place = Path(folder)
        for name, text in sources.items():
            (place / f"{name}.v").write_text(text, encoding="utf-8")
        said: dict[str, str | None] = {}  # file -> complaint
        spoken: dict[str, str] = {}

        def one(name: str) -> None:
            required = _required(sources[name]) & sources.keys()
            if any(said.get(each) is not None for each in required):
                said[name] = "not checked, since a file that it requires was refused"
                return
            progress(f"checking {name}.v ..")
            said[name], spoken[name] = _compile(compiler, place, name, seconds)

        for level in _levels(sources):
            with ThreadPoolExecutor(jobs or os.cpu_count() or 1) as pool:
                list(pool.map(one, level))
    problems += [f"{name}.v: {complaint}" for name, complaint in said.items() if complaint]
    axioms = _axioms(spoken.get(ASSUMPTIONS, ""))
    problems += [f"the theorems rest on {axiom}, which is no axiom of the real numbers of Coq's standard library"
                 for axiom in axioms if axiom not in STANDARD_AXIOMS]  # fmt: skip
    if said.get(ASSUMPTIONS) is None and not spoken.get(ASSUMPTIONS, "").strip():
        problems.append("Coq did not say on which axioms the theorems rest")
    theorems = [result for name, text in sources.items() for result in _results(name, text, said[name])]
    return CoqResult(tuple(theorems), axioms, tuple(problems), perf_counter() - start, coq_version(compiler))


def _required(text: str) -> set[str]:
    return {each for line in re.findall(r"^From symrot Require (?:Import )?(.*)\.$", text, re.MULTILINE)
            for each in line.split()}  # fmt: skip


def _levels(sources: Mapping[str, str]) -> list[list[str]]:
    """Return the files in groups, each after those that its members require."""
    levels: list[list[str]] = []
    left, done = dict(sources), set[str]()
    while left:
        ready = [name for name, text in left.items() if _required(text) & sources.keys() <= done]
        if not ready:
            raise CertificateError(f"expected files that can be put in order, got a circle among {', '.join(left)}")
        levels.append(ready)
        done |= set(ready)
        left = {name: text for name, text in left.items() if name not in done}
    return levels


def _compile(compiler: str, place: Path, name: str, seconds: float) -> tuple[str | None, str]:
    """Return what Coq complains of, or None, and what it printed."""
    command = [compiler, "-q", "-R", ".", "symrot", f"{name}.v"]
    try:
        done = run_tool(command, seconds, place)
    except CompilerError as reason:
        return f"not checked: {reason}", ""
    if done.returncode == 0:
        return None, done.stdout
    found = _PLACE.search(done.stderr)
    if found is None:
        return f"Coq failed with exit code {done.returncode}: {' '.join(done.stderr.split())[-300:]}", done.stdout
    return f"line {found[2]}: {' '.join(found[3].split())[:300]}", done.stdout


def _axioms(printed: str) -> tuple[str, ...]:
    """Return the names in the answer to ``Print Assumptions``."""
    return tuple(sorted({match[1] or match[2] for match in _AXIOM.finditer(printed) if match[0] != "Axioms:"}))


def _results(name: str, text: str, complaint: str | None) -> list[TheoremResult]:
    """Return the outcome of each theorem of a file, from the line that Coq refused, if any."""
    if name in (RULES, ASSUMPTIONS):
        return []
    found = [(text.count("\n", 0, match.start()) + 1, match[1]) for match in _THEOREM.finditer(text)]
    if complaint is None:
        return [TheoremResult(f"{name}.v", theorem, "ok") for _, theorem in found]
    line = re.match(r"line (\d+):", complaint)
    refused = max((start for start, _ in found if start <= int(line[1])), default=0) if line else 0
    outcome = [("ok" if start < refused else "refused" if start == refused else "not reached", theorem)
               for start, theorem in found]  # fmt: skip
    return [TheoremResult(f"{name}.v", theorem, said) for said, theorem in outcome]

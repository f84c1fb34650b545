"""Compile emitted C and compare what comes out with the text: the objects section of a certificate.

The section names compilers and their versions, so that it is true of one machine only. It is written on request, beside
the certificate and outside of what is compared byte for byte.
"""

from collections.abc import Iterable, Sequence
from hashlib import sha256
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any

from symrot.certificates.flags import judge
from symrot.certificates.object_code.comparison import ObjectVerdict, compare_object
from symrot.certificates.tools import run_tool
from symrot.errors import CertificateError, CompilerError

__all__ = ["COMPILERS", "FLAGS", "compile_object", "compiler_version", "objects_section"]

COMPILERS = ("gcc", "clang")
STRICT = ("-ffp-contract=off", "-fno-math-errno")
FLAGS: tuple[tuple[str, ...], ...] = (
    ("-O1", *STRICT), ("-O2", *STRICT), ("-O3", *STRICT), ("-Os", *STRICT), ("-O2", "-ffp-contract=off"),
    ("-O3", "-mavx2", "-mfma", "-fno-tree-slp-vectorize", *STRICT), ("-O3", "-mavx2", "-mfma", *STRICT),
    ("-O2", "-mavx2", "-mfma", "-ffp-contract=fast", "-fno-math-errno"),
)  # fmt: skip
"""Flags of the table: strict code for SSE2 and AVX2; where gcc 12 fuses although it is told not to; contraction."""
SECONDS, SECONDS_TO_ANSWER = 120, 20


def compile_object(compiler: str, flags: Sequence[str], source: Path, target: Path) -> None:
    """Compile one C file into an object file, with the folder of the source in the search path of headers.

    Raises
    ------
    CompilerError
        If the compiler is not there, does not end in time, or refuses: its first complaint is quoted.
    """
    path = which(compiler)
    if path is None:
        raise CompilerError(f"expected a C compiler, {compiler} is not on the path")
    command = [path, *flags, "-I", str(source.parent), "-c", str(source), "-o", str(target)]
    done = run_tool(command, SECONDS)
    if done.returncode:
        complaint = next((line for line in done.stderr.splitlines() if "error" in line), "")
        raise CompilerError(f"{compiler} {' '.join(flags)} refuses {source.name}: {complaint[:200]}")


def compiler_version(compiler: str) -> str:
    """Return the first line that a compiler says of itself; an empty text where it is not there.

    Raises
    ------
    CompilerError
        If it cannot be run, or gives no answer in time.
    """
    path = which(compiler)
    return "" if path is None else run_tool([path, "--version"], SECONDS_TO_ANSWER).stdout.split("\n")[0].strip()


def objects_section(
    source: Path,
    functions: Sequence[str] = (),
    compilers: Iterable[str] = COMPILERS,
    flags: Iterable[Sequence[str]] = FLAGS,
) -> dict[str, Any]:
    """Compile a kernel with each compiler and each set of flags, and compare each object with the text.

    Parameters
    ----------
    source : Path
        A C file as symrot emits it, its header beside it.
    functions : sequence of str
        One-sample functions; default: all that the text defines.
    compilers, flags : iterables
        Names of compilers, of which those that are missing are listed as such, and sets of flags.

    Returns
    -------
    dict
        Plain data, the same for the same text and compilers: ``source`` (name, SHA-256), ``objects`` (compiler,
        version, flags, SHA-256 of the object, functions with verdict, reason, cases, instructions), ``missing``
        (compilers), ``accepted`` (whether all are), ``means`` (what the verdicts say).

    Raises
    ------
    CertificateError
        For a text that is not of the emitted subset.
    CompilerError
        If there is no ``objdump``, or a compiler refuses the text.
    """
    try:
        text = source.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as reason:
        raise CertificateError(f"{source}: expected a C file that can be read ({reason})") from None
    found, missing = [], []
    flag_sets = [tuple(item) for item in flags]
    for compiler in compilers:
        version = compiler_version(compiler)
        if not version:
            missing.append(compiler)
            continue
        for chosen in flag_sets:
            found.append(_object(source, text, functions, compiler, version, chosen))
    return {
        "source": {"name": source.name, "sha256": sha256(text.encode()).hexdigest()},
        "objects": found,
        "missing": missing,
        "accepted": bool(found) and all(item["accepted"] for item in found),
        "means": MEANS,
    }


MEANS = (
    "identical: for all inputs the same bits as the C text, signed zeros and infinities included, NaN for NaN; "
    "identical up to contraction: the same with a*b + c rounded once in places. In rounding to nearest, with the libm "
    "that the certificate assumes, arrays apart, for one-sample functions; loops over samples are not compared"
)


def _object(
    source: Path, text: str, functions: Sequence[str], compiler: str, version: str, flags: tuple[str, ...]
) -> dict[str, Any]:
    with TemporaryDirectory(prefix="symrot-") as directory:
        target = Path(directory) / f"{source.stem}.o"
        compile_object(compiler, flags, source, target)
        verdicts = compare_object(text, target, functions, source.name)
        digest = sha256(target.read_bytes()).hexdigest()
    judgement = judge((compiler, *flags))
    return {
        "compiler": compiler,
        "version": version,
        "flags": " ".join(flags),
        "flags_hold": judgement.holds,
        "sha256": digest,
        "accepted": judgement.accepted and all(item.accepted for item in verdicts),
        "functions": [_plain(item) for item in verdicts],
    }


def _plain(verdict: ObjectVerdict) -> dict[str, Any]:
    return {
        "name": verdict.function, "verdict": verdict.verdict, "output": verdict.output, "reason": verdict.reason,
        "cases": verdict.cases, "instructions": verdict.instructions,
    }  # fmt: skip

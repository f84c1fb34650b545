"""The ``objects`` section of a certificate: whether compiled object code performs the roundings of the C text.

The section names compilers of one machine, so it is written only on request and ignored when certificates are
compared.
"""

from collections.abc import Iterable, Sequence
from hashlib import sha256
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any

from symrot.build.code_digest import text_digest
from symrot.certificates.flags import classify_flags
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
"""The sets of compiler flags to try: strict code for SSE2 and AVX2, and code with contraction.

gcc 12 with ``-O3 -mavx2 -mfma`` fuses some a*b + c in spite of ``-ffp-contract=off``, unless
``-fno-tree-slp-vectorize`` is given. So ``FLAGS`` has these flags both with and without it.
"""
SECONDS, SECONDS_TO_ANSWER = 120, 20


def compile_object(compiler: str, flags: Sequence[str], source: Path, target: Path) -> None:
    """Compile the C file ``source`` into the object file ``target``; headers are searched in the folder of the source.

    Raises
    ------
    CompilerError
        If the compiler is missing, takes too long, or reports an error; the message quotes that error.
    """
    path = which(compiler)
    if path is None:
        raise CompilerError(f"expected a C compiler, but {compiler} is not on the path")
    command = [path, *flags, "-I", str(source.parent), "-c", str(source), "-o", str(target)]
    done = run_tool(command, SECONDS)
    if done.returncode:
        complaint = next((line for line in done.stderr.splitlines() if "error" in line), "")
        raise CompilerError(f"{compiler} {' '.join(flags)} refuses {source.name}: {complaint[:200]}")


def compiler_version(compiler: str) -> str:
    """Return the first line that ``compiler --version`` prints; an empty text if the compiler is not installed.

    Raises
    ------
    CompilerError
        If the compiler cannot be run, or does not answer in time.
    """
    path = which(compiler)
    return "" if path is None else run_tool([path, "--version"], SECONDS_TO_ANSWER).stdout.split("\n")[0].strip()


def objects_section(
    source: Path,
    functions: Sequence[str] = (),
    compilers: Iterable[str] = COMPILERS,
    flags: Iterable[Sequence[str]] = FLAGS,
) -> dict[str, Any]:
    """Compile a kernel with each compiler and each set of flags; return how each object file compares with the C text.

    Parameters
    ----------
    source : Path
        A C file that symrot emitted, with its header in the same folder.
    functions : sequence of str
        The functions to compare, each for one sample; default: all one-sample functions in the file.
    compilers, flags : iterables
        The commands of the compilers, and the sets of flags; a compiler that is not installed is listed as missing.

    Returns
    -------
    dict
        Data for JSON, the same for the same text and compilers: ``source`` (name, SHA-256), ``objects`` (one entry per
        object file: compiler, version, flags, SHA-256, and for each function its verdict, reason, cases and
        instructions), ``missing`` (compilers that are not installed), ``accepted`` (whether there are object
        files, their flags keep the error bounds, and every verdict is "identical" or "identical up to contraction"),
        ``means`` (how to read the verdicts).

    Raises
    ------
    CertificateError
        If the C text cannot be read or is not of the subset that symrot emits, or if the object file is not for x86-64.
    CompilerError
        If there is no ``objdump``, or a compiler cannot be run or rejects the text.
    InputError
        If the effect of a flag is unknown, or a compiler is neither gcc nor clang.
    """
    try:
        text = source.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as reason:
        raise CertificateError(f"{source}: expected a C file that can be read ({reason})") from None
    objects, missing = [], []
    flag_sets = [tuple(item) for item in flags]
    for compiler in compilers:
        version = compiler_version(compiler)
        if not version:
            missing.append(compiler)
            continue
        for chosen in flag_sets:
            objects.append(_object(source, text, functions, compiler, version, chosen))
    return {
        "source": {"name": source.name, "sha256": text_digest(text)},
        "objects": objects,
        "missing": missing,
        "accepted": bool(objects) and all(item["accepted"] for item in objects),
        "means": MEANS,
    }


MEANS = (
    "identical: for all inputs the same bits as the C text, NaN for NaN; identical up to contraction: "
    "the same, except that some a*b + c are rounded once. Assumed: rounding to nearest, the certificate's libm, arrays "
    "that do not overlap. Loops over samples are not compared."
)


def _object(
    source: Path, text: str, functions: Sequence[str], compiler: str, version: str, flags: tuple[str, ...]
) -> dict[str, Any]:
    """Compile a C file with one compiler and its flags, and return the certificate's entry about this object file."""
    # only ``functions`` are compared with the C text
    with TemporaryDirectory(prefix="symrot-") as directory:
        target = Path(directory) / f"{source.stem}.o"
        compile_object(compiler, flags, source, target)
        verdicts = compare_object(text, target, functions, source.name)
        digest = sha256(target.read_bytes()).hexdigest()
    judgement = classify_flags((compiler, *flags))
    return {
        "compiler": compiler,
        "version": version,
        "flags": " ".join(flags),
        "flags_hold": judgement.holds,
        "sha256": digest,
        "accepted": judgement.accepted and all(item.accepted for item in verdicts),
        "functions": [_verdict_to_json(item) for item in verdicts],
    }


def _verdict_to_json(verdict: ObjectVerdict) -> dict[str, Any]:
    return {
        "name": verdict.function, "verdict": verdict.verdict, "output": verdict.output, "reason": verdict.reason,
        "cases": verdict.cases, "instructions": verdict.instructions,
    }  # fmt: skip

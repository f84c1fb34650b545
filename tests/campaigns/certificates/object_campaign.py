"""Measure the comparison of object code with the C text: ``python -m tests.campaigns.certificates.object_campaign``.

It prints a table of kernels x compilers x flags: how many one-sample functions have which verdict, and the time. Then
it corrupts object files (``--mutants N``) and prints how many are refused; a file that still gives the same bits is no
corruption and is not counted.
"""

import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from symrot.certificates.object_code.build import COMPILERS, FLAGS, compile_object, compiler_version
from symrot.certificates.object_code.comparison import CONTRACTED, DIFFERS, IDENTICAL, NOT_UNDERSTOOD, compare_object
from symrot.certificates.object_code.disassembly import read_listing, why_no_objdump
from symrot.errors import CompilerError, SymrotError
from tests.campaigns.certificates.object_code_mutants import Mutant, mutants, same_bits

__all__ = ["campaign", "corrupted", "main"]

VERDICTS = (IDENTICAL, CONTRACTED, DIFFERS, NOT_UNDERSTOOD)
FAST = ("-O2", "-ffast-math")
TEXT = "not compiled: the text itself refuses the flags"
REFUSED, ACCEPTED, SAME = "refused", "accepted", "accepted and no corruption: the same bits"
SPARE = 6  # times as many are drawn at most as are counted


def campaign(sources: Sequence[Path], compiler: str, flags: Sequence[str]) -> tuple[Counter[str], float, list[str]]:
    """Return counts of verdicts, milliseconds per function (without compiling), and a sentence for each function not
    accepted.
    """
    counts, seconds, reports = Counter[str](), 0.0, []
    with TemporaryDirectory(prefix="symrot-") as directory:
        for source in sources:
            target, text = Path(directory) / "kernel.o", source.read_text(encoding="utf-8")
            try:
                compile_object(compiler, flags, source, target)
            except CompilerError as reason:
                counts[TEXT] += 1
                reports.append(str(reason))
                continue
            start = perf_counter()
            for verdict in compare_object(text, target, (), source.name):
                counts[verdict.verdict] += 1
                reports += [] if verdict.accepted else [verdict.sentence()]
            seconds += perf_counter() - start
    return counts, 1000 * seconds / max(counts.total(), 1), reports


def corrupted(
    sources: Sequence[Path], compiler: str, flags: Sequence[str], count: int, seed: int
) -> tuple[Counter[str], list[str]]:
    """Return the outcomes of corrupted files, by kind, and a line for each that was not refused.

    The outcomes are "refused" and "accepted"; "accepted" means that the comparison says identical although the bits of
    outputs differ, a failure of the checker. An accepted file that gives the same bits on many inputs is no corruption,
    nor is a file that only contracts because its flags allow this: such a file is reported, not counted, and another is
    drawn.
    """
    counts, reports = Counter[str](), []
    each = max(1, count // len(sources))
    for source in sources:
        text, total = source.read_text(encoding="utf-8"), counts.total() + each
        with TemporaryDirectory(prefix="symrot-") as directory:
            for mutant in mutants(source, Path(directory), compiler, flags, SPARE * each, seed):
                outcome = _outcome(source, text, Path(directory) / "good.o", mutant)
                if outcome != REFUSED:
                    why = "" if mutant.kind == "flags" else _changed(Path(directory) / "good.o", mutant.path)
                    reports.append(f"{source.stem}, {mutant.kind}: {mutant.what}{why}: {outcome}")
                if outcome in (REFUSED, ACCEPTED):
                    counts[f"{mutant.kind}: {outcome}"] += 1
                if counts.total() == total:
                    break
    return counts, reports


def _outcome(source: Path, text: str, good: Path, mutant: Mutant) -> str:
    """Return the outcome of a corrupted file; flags that allow contraction may change the bits legitimately."""
    try:
        verdicts = {item.verdict for item in compare_object(text, mutant.path, (), source.name)}
    except SymrotError:
        return REFUSED
    if not verdicts <= {IDENTICAL, CONTRACTED}:
        return REFUSED
    if CONTRACTED in verdicts and mutant.kind == "flags":
        return CONTRACTED
    return SAME if same_bits(source, good, mutant.path) else ACCEPTED


def _changed(good: Path, mutant: Path) -> str:
    """Return a text about the first instruction that differs in a corrupted file."""
    before, after = read_listing(good).code, read_listing(mutant).code
    for place, instruction in before.items():
        other = after.get(place)
        if other is None or (other.text, other.relocation) != (instruction.text, instruction.relocation):
            return f", {instruction.text!r} became {other.text if other else 'part of another'!r}"
    return ", no instruction changed"


def main(argv: Sequence[str] | None = None) -> int:
    """Print the table, then the corrupted files; return 1 if a file that computes something else is accepted."""
    parser = ArgumentParser(prog="python -m tests.campaigns.certificates.object_campaign", description=__doc__)
    parser.add_argument("--kernels", type=Path, default=Path("generated/c"), help="folder of kernels")
    parser.add_argument("--every", type=int, default=1, help="take every n-th kernel")
    parser.add_argument("--mutants", type=int, default=200, help="corrupted object files")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(argv)
    sources = [path for path in sorted(options.kernels.glob("*.c")) if path.stem != "symrot_selftest"]
    if why_no_objdump() or not sources:
        print(why_no_objdump() or f"{options.kernels}: expected kernels in C, there are none")
        return 2
    chosen, failed = sources[:: options.every], False
    print(f"{len(chosen)} kernels, one-sample functions of double and float")
    print(f"{'compiler and flags':<66}{'identical':>10}{'contracted':>11}{'differs':>8}{'unknown':>8}{'ms each':>8}")
    for compiler in (name for name in COMPILERS if compiler_version(name)):
        for flags in (*FLAGS, FAST):
            counts, each, reports = campaign(chosen, compiler, flags)
            columns = "".join(f"{counts[v]:>{w}}" for v, w in zip(VERDICTS, (10, 11, 8, 8), strict=True))
            print(f"{' '.join((compiler, *flags)):<66}{columns}{each:>8.1f}", flush=True)
            if counts[TEXT]:
                print(f"  {counts[TEXT]} kernels {TEXT}", flush=True)
            print("".join(f"  {line}\n" for line in reports if flags != FAST), end="", flush=True)
    picked = sources[:: max(1, len(sources) // 20)][:20]
    for compiler in (name for name in COMPILERS if compiler_version(name)):
        counts, reports = corrupted(picked, compiler, FLAGS[1], options.mutants // 2, options.seed)
        print(f"{compiler}: {counts.total()} corrupted files: {dict(sorted(counts.items()))}")
        print("".join(f"  {line}\n" for line in reports), end="", flush=True)
        failed = failed or any(name.endswith(": accepted") for name in counts)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())

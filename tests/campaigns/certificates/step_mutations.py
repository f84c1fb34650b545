"""Corrupt the C files of steps, and count those that the proof accepts although they compute other numbers: none may be.

``python -m tests.campaigns.certificates.step_mutations --c 500`` runs the campaign. A mutant is refused, or compiled and
compared with the original at random states, where both may differ by rounding alone. A mutant that does not compile
is no C, and the proof has to refuse it.
"""

import ctypes
import re
import subprocess
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from random import Random
from tempfile import mkdtemp

import numpy as np

from symrot.certificates.readback.header import check_header, check_source
from symrot.certificates.step_certificate import formula_section
from symrot.errors import CertificateError
from symrot.workshop.step_text import StepText, step_text
from tests.campaigns.certificates.mutations import EDITS

__all__ = ["accepted", "corrupted", "main"]

STEPS = (
    ("tumbling_prism", "rk4", None), ("tumbling_prism", "taylor", 3), ("axisymmetric_satellite", "exact", None),
    ("heavy_top_loops", "rk4", None), ("gravity_gradient_satellite", "taylor", 2),
)  # fmt: skip
TYPES = (("", np.float64, 1e-11), ("f", np.float32, 1e-3))  # suffix, type, difference by rounding
WRAPPED = (
    "(float)({0})", "(int)({0})", "({0}, 0.0)", "dt == 0.0 ? {0} : 0.0", "dt == 0.0 ? 1.0 : sin(dt)/dt", "+({0})", "!({0})",
    "fabs({0})", "sqrt(({0})*({0}))", "({0})*(3/2)", "sinf({0})", "({0}) - 1e-20", "({0})*(49.0*(1.0/49.0))", "~0 + {0}",
)  # fmt: skip
STATEMENTS = (
    ";", "return;", "{ }", "if (dt == 0.5) next[0] = 1.0;", "const double one = 1/2;", "volatile double z = 0;",
    "const double dt = 1.0;", "static double s = 0;", "next[0] = next[0];", "next[0] += 0.0;", "(void)sin(dt);",
    "extern double cos(double);", "double y = 0.0, z;", "goto end; end: ;", 'asm("nop");', "while (0) ;",
)  # fmt: skip


def _wrapped(text: str, random: Random) -> str | None:
    match = random.choice(list(re.finditer(r"(?<= = )[^;?]+(?=;)", text)))
    return text[: match.start()] + random.choice(WRAPPED).format(match[0]) + text[match.end() :]


def _inserted(text: str, random: Random) -> str | None:
    at = random.choice(list(re.finditer(r";\n(?= )", text))).end()
    return f"{text[:at]}    {random.choice(STATEMENTS)}\n{text[at:]}"


def _token(text: str, random: Random) -> str | None:
    """Delete or repeat a token behind the comment at the top, or put another one in its place."""
    tokens = list(re.compile(r"\w+|[^\s\w]").finditer(text, text.index("#include")))
    match, other = random.choice(tokens), random.choice(tokens)
    return text[: match.start()] + random.choice(("", match[0] * 2, other[0])) + text[match.end() :]


KINDS: dict[str, Callable[[str, Random], str | None]] = {
    **EDITS,
    "wrapped": _wrapped,
    "inserted": _inserted,
    "token": _token,
}


def corrupted(text: str, random: Random) -> tuple[str, str]:
    """Return one corruption of a C file: its kind, and the text after it."""
    while True:
        kind = random.choice(list(KINDS))
        mutant = KINDS[kind](text, random)
        if mutant is not None and mutant != text:
            return kind, mutant


def accepted(step: StepText, text: str) -> bool:
    """Return whether the audit would accept a C text with the hash and the proof that a forger gives it."""
    try:
        check_source(text, step.name)
        check_header(step.c()[1], text, step.name)
        formula_section(step.name, step._rates_program, step.method, text)
    except CertificateError:
        return False
    return True


def _results(step: StepText, text: str, folder: Path) -> list[np.ndarray] | None:
    """Return the states after steps from random states, in double and in float; None if the text does not compile."""
    room = Path(mkdtemp(dir=folder))
    for file, content in (step.c_files() | {f"{step.name}.c": text}).items():
        (room / file).write_text(content, encoding="utf-8")
    command = [
        "cc",
        "-std=c99",
        "-O0",
        "-ffp-contract=off",
        "-w",
        "-fPIC",
        "-shared",
        f"{step.name}.c",
        "-lm",
        "-o",
        "s.so",
    ]
    if subprocess.run(command, cwd=room, capture_output=True, check=False).returncode:
        return None
    library, draw, results = ctypes.CDLL(str(room / "s.so")), np.random.default_rng(1), []
    count = step._rates_program.signature.argument("y").size
    for suffix, kind, _ in TYPES:
        function, numbers = getattr(library, f"symrot_{step.name}{suffix}"), np.ctypeslib.ndpointer(kind)
        real, p = np.ctypeslib.as_ctypes_type(kind), np.array(step.rates.inputs.parameters, kind)
        function.restype, function.argtypes = None, [real, numbers, *[numbers] * bool(p.size), real, numbers]
        for dt in (0.1, -0.3, 0.0, 0.5):
            after = np.zeros(count, kind)
            function(0.7, draw.uniform(-2, 2, count).astype(kind), *[p] * bool(p.size), dt, after)
            results.append(after)
    return results


def main(argv: Sequence[str] | None = None) -> int:
    """Run the campaign and print the survivors; exit with 1 if there are any."""
    parser = ArgumentParser(prog="python -m tests.campaigns.certificates.step_mutations", description="Corrupt steps.")
    parser.add_argument("--c", type=int, default=500, metavar="N", help="corrupted C files")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(argv)
    random, folder, survivors = Random(options.seed), Path(mkdtemp(prefix="symrot-")), 0
    steps = [step_text(*each) for each in STEPS]
    tried, same = Counter[str](), Counter[str]()
    for _ in range(options.c):
        step = random.choice(steps)
        assert isinstance(step, StepText)
        kind, text = corrupted(step.c()[0], random)
        tried[kind] += 1
        if not accepted(step, text):
            continue
        before, after = _results(step, step.c()[0], folder), _results(step, text, folder)
        if (
            after is not None
            and before is not None
            and all(
                np.allclose(a, b, rtol=limit, atol=limit, equal_nan=True)
                for (a, b), (_, _, limit) in zip(
                    zip(before, after, strict=True), [t for t in TYPES for _ in range(4)], strict=True
                )
            )
        ):
            same[kind] += 1
            continue
        survivors += 1
        path = folder / f"survivor_{survivors}.c"
        path.write_text(text, encoding="utf-8")
        print(f"ACCEPTED {step.name}, {kind}: {path}", flush=True)
    print(f"{tried.total()} tried, {same.total()} the same but for rounding, {survivors} accepted")
    print("  " + ", ".join(f"{kind} {count}" for kind, count in sorted(tried.items())))
    return 1 if survivors else 0


if __name__ == "__main__":
    raise SystemExit(main())

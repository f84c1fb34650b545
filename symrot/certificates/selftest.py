"""The self-test: check that this machine's C functions and arithmetic are as accurate as the certificates assume.

``symrot selftest`` compiles ``symrot_selftest.c``, which holds values of sine, cosine, arc tangent and square root,
computed by mpmath to 60 digits and rounded once. The test runs inside this process, because a loaded library may have
changed the arithmetic.
"""

import ctypes
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from importlib.resources import files
from random import Random
from textwrap import wrap
from typing import Any

from symrot.errors import CompilerError

__all__ = ["CHECKS", "FLAGS", "SelfTest", "run_selftest", "selftest_files"]

LIBM_ULP = Fraction(1)
"""The error of sin, cos and atan2 that certificates assume, in units in the last place of the exact value."""
CORRECT = Fraction(1, 2) + Fraction(1, 1000)  # error of correct rounding, plus the error of measuring it
FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared")
DIGITS, POINTS, SEED = 60, 40, 5
FORMATS = {"": (53, -1022), "f": (24, -126)}  # suffix of C names -> binary digits, smallest exponent of a normal number
CHECKS: tuple[tuple[str, str], ...] = (
    ("", "the machine computes as the certificates assume"),
    ("ROUNDING", "expected rounding to nearest, ties to even: the rounding mode of this thread is another one"),
    ("FLUSHING", "expected numbers below the smallest normal one to be kept: this thread flushes them to zero, "
     "as a library linked with -ffast-math does"),
    ("CONTRACTION", "expected a*b + c to be rounded twice: compile with -ffp-contract=off for the bits of the C "
     "text, whose error bounds hold"),
)  # fmt: skip
"""The outcomes by number: the name in C and the sentence. Number 0 is success, the others are the checks that failed.

The checks of libm functions have the numbers after these.
"""


@dataclass(frozen=True)
class _CheckedFunction:
    """A function of libm to test: name, allowed error, and a generator of test arguments (y, x).

    Only atan2 uses y, which is 0 for the other functions.
    """

    name: str
    allowed: Fraction  # ulp
    # of a precision in binary digits; functions of one argument use x alone
    arguments: Callable[[Random, int], Iterator[tuple[float, float]]]

    def sentence(self, suffix: str) -> str:
        """Return a sentence that says that this function of libm failed its test.

        ``suffix`` is ``"f"`` for the function for floats, and empty for the function for doubles.
        """
        if self.allowed == CORRECT:
            return f"expected {self.name}{suffix} to be rounded correctly: on this machine it is not"
        return (
            f"expected {self.name}{suffix} to have an error of at most {self.allowed} ulp: on this machine its "
            "error is larger"
        )


def _angles(random: Random, digits: int) -> Iterator[tuple[float, float]]:
    """Yield test arguments for sine and cosine: pairs (0, x) with angles x of ``digits`` binary digits, up to 1e6 rad.

    All test arguments are pairs, like those (y, x) of atan2; sine and cosine use x alone.
    """
    from mpmath import mp, mpf

    # near multiples of pi/2 the reduction of an angle loses digits
    for multiple in (1, 2, 3, 4, 5, 8, 21, 355 // 2, 1000, 102573):
        yield 0.0, _rounded(mpf(multiple) * mp.pi / 2, digits)
    for exponent in (-40, -27, -12, -9, -4):
        yield 0.0, _rounded(mpf(2) ** exponent * (1 + mpf(random.random())), digits)
    # beyond 1e6 rad libraries are less accurate: glibc 2.36's cosine errs by 8 ulp at 6381956970095103*2^797
    for size in (1.0, 3.2, 6.4, 100.0, 1e4, 1e6):
        for _ in range(4):
            yield 0.0, _rounded(mpf(random.uniform(-size, size)), digits)


def _sides(random: Random, digits: int) -> Iterator[tuple[float, float]]:
    """Yield random test arguments (y, x) for atan2, of ``digits`` binary digits; y has many magnitudes."""
    from mpmath import mpf

    for size in (1e-12, 1e-6, 1e-3, 0.3, 1.0, 1.0, 3.0, 1e3, 1e6, 1e12):
        for _ in range(4):
            yield (
                _rounded(mpf(random.uniform(-size, size)), digits),
                _rounded(mpf(random.uniform(-1.0, 1.0)), digits),
            )


def _radicands(random: Random, digits: int) -> Iterator[tuple[float, float]]:
    """Yield test arguments for the square root: pairs (0, x) with random positive x of ``digits`` binary digits.

    All test arguments are pairs, like those (y, x) of atan2; the square root uses x alone.
    """
    from mpmath import mpf

    for _ in range(POINTS):
        yield 0.0, _rounded(mpf(random.uniform(0.5, 2.0)) * mpf(2) ** random.randrange(-60, 60), digits)


FUNCTIONS = (
    _CheckedFunction("sin", LIBM_ULP, _angles),
    _CheckedFunction("cos", LIBM_ULP, _angles),
    _CheckedFunction("atan2", LIBM_ULP, _sides),
    _CheckedFunction("sqrt", CORRECT, _radicands),
)
NAMES = tuple(f"{function.name}{suffix}" for suffix in FORMATS for function in FUNCTIONS)


def _rounded(value: Any, digits: int) -> float:
    """Return a number rounded to ``digits`` binary digits."""
    from mpmath import mp, workprec

    with workprec(digits):
        return float(+mp.mpf(value))


def _point(name: str, suffix: str, y: float, x: float) -> str:
    """Return a row of a C table of test points: y, x, the rounded value, exact minus rounded value in ulp, and the ulp.

    ``name`` is the function, such as ``"sin"``; ``suffix`` is ``"f"`` for floats and ``""`` for doubles.
    """
    from mpmath import floor, log, mp, mpf

    # an ulp is the distance between neighbouring numbers
    digits, smallest = FORMATS[suffix]
    exact = mp.atan2(mpf(y), mpf(x)) if name == "atan2" else getattr(mp, name)(mpf(x))
    ulp = mpf(2) ** (max(int(floor(log(abs(exact), 2))), smallest) - digits + 1)
    value = _rounded(exact, digits)
    rest = float((exact - mpf(value)) / ulp)
    return f"    {{{y!r}, {x!r}, {value!r}, {round(rest, 6)!r}, {float(ulp)!r}}},"


@cache
def selftest_files() -> dict[str, str]:
    """Return a map from the name of each C file of the self-test to its text, which is the same on every machine."""
    from mpmath import workdps

    tables, rows, sentences = [], [], [text for _, text in CHECKS]
    with workdps(DIGITS):
        for suffix, (digits, _) in FORMATS.items():
            for function in FUNCTIONS:
                random, name = Random(SEED), f"{function.name}{suffix}"
                points = [_point(function.name, suffix, y, x) for y, x in function.arguments(random, digits)]
                opening = f"static const struct symrot_point symrot_points_of_{name}[] = {{"
                tables.append("\n".join([opening, *points, "};"]))
                table = f"symrot_points_of_{name}"
                rows.append(
                    f"    {{symrot_{name}, {table}, sizeof {table}/sizeof *{table}, "
                    f"{float(function.allowed)!r}, {len(sentences)}}},"
                )
                sentences.append(function.sentence(suffix))
    template = files("symrot.certificates").joinpath("selftest.c").read_text(encoding="utf-8")
    parts = {
        "@TABLES@": "\n\n".join(tables),
        "@FUNCTIONS@": "\n".join(rows),
        "@SENTENCES@": "\n".join(_string(sentence) for sentence in sentences),
    }
    for mark, text in parts.items():
        template = template.replace(mark, text)
    return {"symrot_selftest.h": _header(), "symrot_selftest.c": template}


def _string(text: str) -> str:
    """Return a text as string literals of C on several lines, for one entry of an array; long lines are broken."""
    return "\n".join(f'        "{line}"' for line in wrap(text, 100, drop_whitespace=False)) + ","


def _header() -> str:
    numbers = [f"#define SYMROT_SELFTEST_{name} {number}" for number, (name, _) in enumerate(CHECKS) if name]
    return "\n".join(
        [
            "/*",
            " * symrot_selftest: does this machine compute as the certificates of the kernels assume?",
            " *",
            " * Printed by `symrot emit --all`; do not edit.",
            " */",
            "#ifndef SYMROT_SELFTEST_H",
            "#define SYMROT_SELFTEST_H",
            "",
            *numbers,
            f"#define SYMROT_SELFTEST_FUNCTIONS {len(NAMES)} /* {', '.join(NAMES)} */",
            "",
            "#ifdef __cplusplus",
            'extern "C" {',
            "#endif",
            "",
            "/*",
            " * Return 0 where all is well, else the number of the first check that failed. bits: nonzero where the",
            " * bits of the C text are wanted, not only its error bounds. ulps: worst errors found in ulp, or null.",
            " */",
            "int symrot_selftest(int bits, double ulps[SYMROT_SELFTEST_FUNCTIONS]);",
            "",
            "/* what was expected, as one sentence */",
            "const char *symrot_selftest_sentence(int failure);",
            "",
            "#ifdef __cplusplus",
            "}",
            "#endif",
            "",
            "#endif",
            "",
        ]
    )


@dataclass(frozen=True)
class SelfTest:
    """The result of the self-test."""

    passed: bool
    # says whether it passed
    sentence: str
    # function -> its worst error, in ulp
    ulps: dict[str, float]
    compiler: str
    flags: tuple[str, ...]

    def lines(self) -> list[str]:
        """Return the result of the self-test, with the worst errors, as lines of text."""
        rows = [f"  {name:<7} {ulp:.3f} ulp" for name, ulp in self.ulps.items()]
        error_lines = ["worst errors found:", *rows] if rows else []
        return [f"{'good' if self.passed else 'refused'}: {self.sentence}", *error_lines]

    def facts(self) -> dict[str, Any]:
        """Return the result of the self-test as data for JSON."""
        return {"passed": self.passed, "sentence": self.sentence, "ulps": self.ulps, "compiler": self.compiler,
                "flags": list(self.flags)}  # fmt: skip


def run_selftest(bits: bool = True, flags: Sequence[str] = FLAGS) -> SelfTest:
    """Compile the self-test with this machine's C compiler, run it in this process and thread, and return the result.

    Parameters
    ----------
    bits : bool
        Whether a*b + c must be rounded twice, so that the bits of the C text hold and not only its error bounds.
    flags : sequence of str
        The compiler flags, which must produce a shared library.

    Raises
    ------
    CompilerError
        If there is no compiler, if it rejects the text, as with -ffast-math, or if the library cannot be loaded.
    """
    from symrot.build.cache import build, compiler

    printed = selftest_files()
    header, text = printed["symrot_selftest.h"], printed["symrot_selftest.c"]
    source = text.replace('#include "symrot_selftest.h"', header, 1)
    path = build(source, "symrot_selftest", tuple(flags))
    try:
        library = ctypes.CDLL(str(path))
    except OSError as reason:
        raise CompilerError(f"the self-test was compiled but cannot be loaded ({reason})") from None
    library.symrot_selftest_sentence.restype = ctypes.c_char_p
    ulps = (ctypes.c_double * len(NAMES))(*[-1.0] * len(NAMES))
    failure = library.symrot_selftest(int(bits), ulps)
    sentence = library.symrot_selftest_sentence(failure).decode()
    worst_errors = {name: float(ulp) for name, ulp in zip(NAMES, ulps, strict=True) if not ulp < 0}
    return SelfTest(failure == 0, sentence, worst_errors, " ".join(compiler().command), tuple(flags))

"""The effect of compiler flags on a certificate: bits and error bounds hold, only the bounds hold, or nothing holds.

A certificate is about the operations of the C text, each rounded once to nearest. A flag that lets the compiler
compute other roundings makes the certificate void. With contraction (a*b + c rounded once) the bits may change and only
the error bounds hold; even a bound may fail if a product is fused into one sum and rounded before another sum.
"""

import re
import shlex
from collections.abc import Sequence
from dataclasses import dataclass

from symrot.errors import InputError

__all__ = [
    "BITS",
    "BOUNDS",
    "NOTHING",
    "REQUIRED",
    "TABLE",
    "FlagEffect",
    "FlagRemark",
    "FlagRule",
    "classify_flags",
    "flags_section",
]

BITS, BOUNDS, NOTHING = "bits", "bounds", "nothing"
REQUIRED = ("-ffp-contract=off",)
VECTORS = (
    "gcc 12 fuses a*b + c in vectors of single statements although -ffp-contract=off is given: "
    "add -fno-tree-slp-vectorize, or compare the object code"
)
CONTRACTION = (
    "contraction rounds a*b + c once, so the bits of results may change; the bounds hold if no product is fused in one "
    "place and rounded in another: compare the object code to see it"
)
UNFIXED = "without it a compiler may round a*b + c once if the processor can, so the bits of results may change"


# Contraction makes even the bounds void if a product is fused in some sums and rounded in others, so that its errors no
# longer cancel. The table follows the compilers' manuals; object_code/comparison.py shows what the flags changed in one
# file.
@dataclass(frozen=True)
class FlagRule:
    """The effect of a compiler flag: properties of the code that it switches on or off, such as contraction."""

    form: str  # regular expression that matches the whole flag
    reason: str
    sets: tuple[str, ...] = ()
    clears: tuple[str, ...] = ()
    takes_next: bool = False  # whether the next word is the flag's argument


# properties of -ffast-math; clang 14 does not take the last one back under -ffp-model=precise and =strict
FAST = ("reassociation", "reciprocals", "no infinities", "no NaN", "unsigned zeros", "approximate functions")
FAST_MATH = (
    "sums in another order, reciprocals, finite numbers only, unsigned zeros; when linking, it also sets flush to zero "
    "for the whole process"
)
FINITE = "comparisons and ranges assume that there are no infinities and no NaN"
FLUSHED = "numbers below 2^-1022 (floats: 2^-126) become zero"
RECIPROCAL = "x/y becomes x*(1/y): one rounding more"
APPROXIMATE = "square roots and functions of libm may be replaced by less accurate ones"
EXCESS = "numbers are kept with more digits than their type and rounded twice (FLT_EVAL_METHOD != 0)"
VOID: dict[str, str] = {  # property that a flag switches on -> why it voids the certificate
    "reassociation": "sums and products are computed in another order: other roundings",
    "reciprocals": RECIPROCAL,
    "reciprocal instructions": RECIPROCAL,
    "no infinities": FINITE,
    "no NaN": FINITE,
    "unsigned zeros": "the sign of a zero may change, which affects atan2, copysign and division",
    "approximate functions": APPROXIMATE,
    "vector functions": APPROXIMATE,
    "flush to zero": FLUSHED,
    "flush to zero at start": FLUSHED,
    "flush to zero of floats": FLUSHED,
    "excess precision": EXCESS,
    "32-bit code": EXCESS,
    "no SSE2": EXCESS,
    "float literals": "literals of double are rounded to float",
}
_WORDS = r"[\w.,+\-=/:@%]*"
TABLE: tuple[FlagRule, ...] = (
    FlagRule(r"-ffp-contract=off", "no contraction: otherwise the bits of results may differ from those of the C text",
             clears=("contraction",)),
    FlagRule(r"-ffp-contract=(fast|on|fast-honor-pragmas)", CONTRACTION, sets=("contraction",)),
    FlagRule(r"-Ofast", FAST_MATH,  # clang flushes small numbers to zero also if -fno-fast-math follows
             sets=(*FAST, "flush to zero", "flush to zero at start", "contraction")),
    FlagRule(r"-ffast-math", FAST_MATH, sets=(*FAST, "flush to zero", "contraction")),
    FlagRule(r"-fno-fast-math", "takes -ffast-math back", clears=(*FAST, "flush to zero")),
    FlagRule(r"-funsafe-math-optimizations", "sums in another order, reciprocals, unsigned zeros; when linking, "
             "it also sets flush to zero",
             sets=("reassociation", "reciprocals", "unsigned zeros", "approximate functions", "flush to zero")),
    FlagRule(r"-fno-unsafe-math-optimizations", "takes -funsafe-math-optimizations back",
             clears=("reassociation", "reciprocals", "unsigned zeros", "approximate functions", "flush to zero")),
    FlagRule(r"-fassociative-math", VOID["reassociation"], sets=("reassociation",)),
    FlagRule(r"-fno-associative-math", "keeps the order of the sums and products in the C text",
             clears=("reassociation",)),
    FlagRule(r"-freciprocal-math", RECIPROCAL, sets=("reciprocals",)),
    FlagRule(r"-fno-reciprocal-math", "keeps divisions", clears=("reciprocals",)),
    FlagRule(r"-mno-recip|-mrecip=none", "keeps divisions", clears=("reciprocal instructions",)),
    FlagRule(r"-mrecip(=.*)?", RECIPROCAL, sets=("reciprocal instructions",)),
    FlagRule(r"-ffinite-math-only", FINITE, sets=("no infinities", "no NaN")),
    FlagRule(r"-fno-finite-math-only", "keeps infinities and NaN", clears=("no infinities", "no NaN")),
    FlagRule(r"-fno-honor-nans", FINITE, sets=("no NaN",)),
    FlagRule(r"-fno-honor-infinities", FINITE, sets=("no infinities",)),
    FlagRule(r"-fhonor-nans", "keeps NaN", clears=("no NaN",)),
    FlagRule(r"-fhonor-infinities", "keeps infinities", clears=("no infinities",)),
    FlagRule(r"-fno-signed-zeros", VOID["unsigned zeros"], sets=("unsigned zeros",)),
    FlagRule(r"-fsigned-zeros", "keeps the sign of zeros", clears=("unsigned zeros",)),
    FlagRule(r"-fapprox-func", APPROXIMATE, sets=("approximate functions",)),
    FlagRule(r"-fveclib=none", "keeps the functions of libm", clears=("vector functions",)),
    FlagRule(r"-fveclib=.*|-mveclibabi=.*", APPROXIMATE, sets=("vector functions",)),
    FlagRule(r"-fno-approx-func", "keeps the functions of libm", clears=("approximate functions",)),
    FlagRule(r"-mdaz-ftz", FLUSHED, sets=("flush to zero at start",)),
    FlagRule(r"-mno-daz-ftz", "keeps small numbers", clears=("flush to zero", "flush to zero at start")),
    FlagRule(r"-fdenormal-fp-math=ieee(,ieee)?", "keeps small numbers", clears=("flush to zero",)),
    FlagRule(r"-fdenormal-fp-math-f32=ieee(,ieee)?", "keeps small floats"),
    FlagRule(r"-fdenormal-fp-math=.*", FLUSHED, sets=("flush to zero",)),
    FlagRule(r"-fdenormal-fp-math-f32=.*", FLUSHED, sets=("flush to zero of floats",)),
    FlagRule(r"-mfpmath=(387|both|sse[+,]387|387[+,]sse)|-mlong-double-64", EXCESS, sets=("excess precision",),
             clears=("SSE arithmetic",)),
    FlagRule(r"-mfpmath=sse", "each operation is rounded to its type, if the processor has SSE2",
             sets=("SSE arithmetic",), clears=("excess precision",)),
    FlagRule(r"-m32|-mx32", EXCESS, sets=("32-bit code",)),
    FlagRule(r"-m64", "64-bit code rounds each operation to its type", clears=("32-bit code",)),
    FlagRule(r"-mno-sse2?", EXCESS, sets=("no SSE2",), clears=("SSE2",)),
    FlagRule(r"-msse2", "the processor, which has SSE2", sets=("SSE2",), clears=("no SSE2",)),
    FlagRule(r"-fexcess-precision=(standard|fast)|-ffloat-store", "of no effect where FLT_EVAL_METHOD is 0"),
    FlagRule(r"-fexcess-precision=16|-fsingle-precision-constant", VOID["float literals"], sets=("float literals",)),
    FlagRule(r"-ffp-model=strict", "no contraction, all roundings kept",
             clears=(*FAST[:-1], "contraction", "flush to zero")),
    FlagRule(r"-ffp-model=precise", CONTRACTION, sets=("contraction",), clears=(*FAST[:-1], "flush to zero")),
    FlagRule(r"-ffp-model=(fast|aggressive)", "as -ffast-math", sets=(*FAST, "flush to zero", "contraction")),
    FlagRule(r"-ffp-exception-behavior=\w+|-f(no-)?trapping-math|-f(no-)?signaling-nans",
             "exceptions are not certified"),
    FlagRule(r"-f(no-)?math-errno", "errno is not certified; square roots are correctly rounded either way"),
    FlagRule(r"-f(no-)?rounding-math", "rounding is to nearest, as the self-test checks when the library is loaded"),
    FlagRule(r"-f(no-)?cx-(limited-range|fortran-rules)|-fcomplex-arithmetic=\w+", "kernels have no complex numbers"),
    FlagRule(r"-O[0123sgz]?", "changes no value; `symrot certify --objects` compares the object code"),
    FlagRule(r"-mfma4?|-march=" + _WORDS, "the processor, which may have fused operations", sets=("fused operations",)),
    FlagRule(r"-mno-fma4?", "a processor without fused operations", clears=("fused operations",)),
    FlagRule(r"-f(tree-)?slp-vectorize", "vectors of single statements", clears=("no vectors",)),
    FlagRule(r"-fno-(tree-)?slp-vectorize", "no vectors of single statements", sets=("no vectors",)),
    FlagRule(r"-m(no-)?(sse\w*|ssse3|avx\w*|fma|fma4|bmi2?|popcnt|lzcnt|f16c|movbe|aes|pclmul|adx|sha|neon\w*|altivec|vsx)(=\d+)?"
             r"|-m(tune|cpu|abi|fpu|float-abi)=" + _WORDS + r"|-mprefer-vector-width=\w+|-mthumb|-marm|-mvzeroupper",
             "the processor: its operations are rounded as IEEE 754 says; the self-test at load checks it"),
    FlagRule(r"-f(no-)?(tree-\w[\w-]*|vectorize|slp-vectorize|inline[\w-]*|unroll-\w+|peel-loops|ipa-[\w-]+|gcse[\w-]*|if-conversion2?"
             r"|schedule-insns2?|split-loops|loop-[\w-]+|reorder-[\w-]+|align-[\w-]+(=\d+)?|rename-registers|web|ivopts|early-inlining"
             r"|code-hoisting|expensive-optimizations|move-loop-invariants|vect-cost-model(=\w+)?|partial-inlining|section-anchors)",
             "order and choice of instructions; roundings stay the same"),
    FlagRule(r"-f(no-)?(PIC|pic|PIE|pie|plt|common|ident|builtin(-\w+)?|strict-aliasing|strict-overflow|wrapv|exceptions|rtti"
             r"|asynchronous-unwind-tables|unwind-tables|omit-frame-pointer|function-sections|data-sections|semantic-interposition"
             r"|short-enums|signed-char|unsigned-char|freestanding|hosted|openmp|openmp-simd|lto|fat-lto-objects|delete-null-pointer-checks"
             r"|stack-clash-protection|zero-initialized-in-bss|merge-constants|integrated-as|addrsig|color-diagnostics)"
             r"|-f(no-)?(stack-protector[\w-]*|stack-check|lto=\w+|cf-protection(=\w+)?|sanitize(-\w+)*=[\w,]+|visibility=\w+"
             r"|diagnostics-[\w=-]+|file-prefix-map=.*|debug-prefix-map=.*|profile-[\w=-]+|max-errors=\d+|hardened)",
             "how code is laid out, checked and linked; roundings stay the same"),
    FlagRule(r"-(std=(c|gnu|iso9899:|c\+\+|gnu\+\+)\w+|ansi|pedantic(-errors)?|pipe|pthread|c|S|s|static|shared|nostdlib|nodefaultlibs"
             r"|g[\w+-]*(=\w+)?|v|w|rdynamic|no-pie|pie|P|MD|MMD|MP)",
             "language, debugging and linking; roundings stay the same"),
    FlagRule(r"-W(?![ap],).*", "warnings, and options for the linker"),
    FlagRule(r"-(o|x|I|L|MF|MT|MQ|isystem|iquote|idirafter|Xlinker)", "names of files", takes_next=True),
    FlagRule(r"-(I|L|l|isystem|iquote).+|-x(c|c\+\+)", "names of files and libraries"),
    FlagRule(r"-[DU](NDEBUG|_(GNU|DEFAULT|POSIX_C|XOPEN|ISOC99|ISOC11|BSD|FORTIFY)_SOURCE|_REENTRANT|_GLIBCXX_\w+"
             r"|(?!SYMROT_|HUGE_|MATH_|FP_|FLT_|DBL_|LDBL_|INT|UINT|SIZE_|M_)[A-Z][A-Z0-9]*_[A-Z0-9_]+)(=.*)?"
             r"|-DSYMROT_(RESTRICT|INDEPENDENT)=?|-DSYMROT_RESTRICT=(__)?restrict(__)?",
             "a macro that kernels do not use"),
)  # fmt: skip
LAUNCHERS = ("ccache", "sccache", "distcc")
_COMPILER = re.compile(r"(?:.*-)?(?:gcc|g\+\+|clang|clang\+\+|cc|c\+\+|c99|c11)(?:-\d+(?:\.\d+)*)?(?:\.exe)?")
_X87 = re.compile(r"(?:i[3-6]86|m68k)-.*")  # targets whose compilers keep more digits by default
_FILE = re.compile(r"[^@].*\.(?:c|cc|cpp|cxx|h|o|a|so|s|S|d|i|ii|obj|exe|lib|dll|dylib)")


@dataclass(frozen=True)
class FlagRemark:
    """A remark about one compiler flag that is set, or missing, in a compiler command."""

    flag: str
    # what is still proven: "bits" (same results as the C text), "bounds" (only the error bounds) or "nothing"
    effect: str
    reason: str


@dataclass(frozen=True)
class FlagEffect:
    """The effect of compiler flags on a certificate.

    Attributes
    ----------
    holds : str
        What stays proven: ``"bits"`` (the results are those of the C text bit for bit, and its error bounds hold),
        ``"bounds"`` (only the error bounds hold) or ``"nothing"``.
    remarks : tuple of FlagRemark
        The reasons, flag by flag.
    """

    holds: str
    remarks: tuple[FlagRemark, ...]

    @property
    def accepted(self) -> bool:
        """Whether the flags, judged alone, keep the proven error bounds: False if ``holds`` is "nothing".

        For flags that allow fused multiply-add, True is not the whole truth: a bound may fail for an output in which
        one product is fused into a sum at one place and rounded at another. Only the comparison of object code finds
        such outputs.
        """
        # if ``holds`` is "bounds", results may differ in bits
        return self.holds != NOTHING

    def sentence(self) -> str:
        """Return one line that says what still holds under the flags, with the reasons."""
        effect = {
            BITS: "the results are those of the C text bit for bit, and its error bounds hold",
            BOUNDS: "the error bounds hold, but the bits of results may differ from those of the C text",
            NOTHING: "the certificate is void",
        }[self.holds]
        why: dict[str, dict[str, None]] = {}  # a flag may set two properties with one reason
        for remark in self.remarks:
            if remark.effect == self.holds:
                why.setdefault(remark.flag, {})[remark.reason] = None
        listed = "; ".join(f"{flag}: {', '.join(reasons)}" for flag, reasons in why.items())
        return f"{effect} ({listed})" if listed else effect


def classify_flags(flags: str | Sequence[str]) -> FlagEffect:
    """Return what still holds of a certificate if its C text is compiled by gcc or clang with these flags.

    Parameters
    ----------
    flags : str or sequence of str
        A compiler command, with or without the compiler's name in front; file names in it are ignored.

    Returns
    -------
    FlagEffect
        Its ``holds`` is "bits" (same bits as the C text), "bounds" (only the error bounds) or "nothing"; its
        ``remarks`` give the reasons, flag by flag.

    Raises
    ------
    InputError
        If a flag is not in the table, the compiler is neither gcc nor clang, or a word is neither a flag nor the name
        of a file.
    """
    try:
        words = shlex.split(flags) if isinstance(flags, str) else list(flags)
    except ValueError as reason:
        raise InputError(f"flags: expected words as a shell reads them, got {flags!r} ({reason})") from None
    if not words:
        raise InputError(
            "flags: expected a compiler command or its flags, such as 'gcc -O2 -ffp-contract=off', got an empty text"
        )
    compiler, place = _compiler(words)
    switched: dict[str, str] = {}  # property that is on -> the flag that switched it on
    if _X87.fullmatch(compiler):
        switched["32-bit code"] = compiler
    is_off = False
    while place < len(words):
        word = words[place]
        place += 1
        if not word.startswith("-"):
            _check_file(word)
            continue
        rule = _rule(word)
        place += rule.takes_next
        # a later flag overrides an earlier flag
        for name in rule.clears:
            switched.pop(name, None)
        switched |= dict.fromkeys(rule.sets, word)
        is_off = (is_off or "contraction" in rule.clears) and "contraction" not in rule.sets
    # 32-bit code rounds each operation to its type only if SSE2 is requested and used
    if {"SSE arithmetic", "SSE2"} <= switched.keys():
        switched.pop("32-bit code", None)
    remarks = [FlagRemark(flag, NOTHING, VOID[name]) for name, flag in switched.items() if name in VOID]
    if "contraction" in switched:
        remarks.append(FlagRemark(switched["contraction"], BOUNDS, CONTRACTION))
    elif not is_off:
        remarks.append(FlagRemark(REQUIRED[0], BOUNDS, UNFIXED))
    elif "fused operations" in switched and "no vectors" not in switched and "clang" not in compiler:
        remarks.append(FlagRemark(switched["fused operations"], BOUNDS, VECTORS))
    effects = {remark.effect for remark in remarks}
    return FlagEffect(NOTHING if NOTHING in effects else BOUNDS if effects else BITS, tuple(remarks))


def _compiler(words: Sequence[str]) -> tuple[str, int]:
    """Return the compiler's name at the start of a command, or ``""``, and the index of the word after it."""
    names = [re.split(r"[/\\]", word)[-1] for word in words[:2]]
    # a launcher such as ccache may come first
    place = 1 if names[0] in LAUNCHERS and len(names) > 1 else 0
    if words[place].startswith("-") or _FILE.fullmatch(words[place]):
        return "", place
    if not _COMPILER.fullmatch(names[place]):
        raise InputError(
            f"flags: expected the compiler in front of the flags to be gcc or clang, got {words[place][:80]!r}"
        )
    return names[place], place + 1


def _check_file(word: str) -> None:
    """Raise InputError if a word of a compiler command is neither a flag nor the name of a file."""
    if not _FILE.fullmatch(word):
        raise InputError(f"flags: expected a flag such as -O2 or a file name such as kernel.c, got {word[:80]!r}")


def _rule(flag: str) -> FlagRule:
    """Return the rule in ``TABLE`` for a compiler flag; raise InputError if no rule matches the flag."""
    for rule in TABLE:
        if re.fullmatch(rule.form, flag):
            return rule
    raise InputError(f"flags: expected flags of gcc or clang whose effect on rounding is known, got {flag[:80]!r}")


def flags_section() -> dict[str, object]:
    """Return the certificate's section ``flags``: the required, allowed and forbidden compiler flags, with reasons."""
    void = ("-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math", "-freciprocal-math",
            "-ffinite-math-only", "-fno-signed-zeros", "-fapprox-func", "-mdaz-ftz", "-mfpmath=387",
            "-fsingle-precision-constant")  # fmt: skip
    allowed = ("-O1", "-O2", "-O3", "-Os", "-fno-math-errno", "-fno-trapping-math", "-frounding-math", "-mavx2")
    return {
        "required": {flag: _rule(flag).reason for flag in REQUIRED},
        "allowed": {flag: _rule(flag).reason for flag in allowed},
        "bounds only": {"-ffp-contract=fast": CONTRACTION, "-ffp-contract=on": CONTRACTION},
        "void": {flag: _rule(flag).reason for flag in void},
    }

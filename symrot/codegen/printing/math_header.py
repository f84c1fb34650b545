"""The file ``symrot_math.h``: sine, cosine and arc tangent without branches, so that compilers vectorise batches.

An argument is reduced, and polynomials approximate the function; their coefficients are computed here, in fractions.
The error is at most 1 unit in the last place, for sine and cosine if ``|x|`` is at most ``FAR``. It is measured by
``python -m symrot.bench.ulps`` and tests/kernels/test_in_c.py (tests/reference/sine_harness.c).
"""

from fractions import Fraction
from functools import cache
from math import cos, factorial, pi

from symrot.codegen.printing.c_function import DOUBLE, FLOAT, Real
from symrot.formula.exact_numbers import PI

__all__ = ["FAR", "math_header", "quarter_turn_parts", "tail_coefficients"]

FAR = {"binary64": 2**17, "binary32": 2**12}  # rad; for larger angles a batch computes its block with the C library
_DIGITS = {"binary64": 53, "binary32": 24}
_PARTS = {"binary64": (36, 36), "binary32": (12, 12, 12)}  # bits of each part of pi/2: exact times a count
_COUNT = {"binary64": (6, 6), "binary32": (4, 4)}  # numbers of coefficients of sine and cosine
_SQUARE = Fraction(617, 1000)  # largest square of the remainder, slightly above (pi/4)^2
_TERMS = 20  # terms of the exact series
_ARC_COUNT = {"binary64": 13, "binary32": 6}  # number of coefficients of the arc tangent
_ARC_SQUARE = Fraction(1, 4)  # largest square of the quotient
_ARC_TERMS = 60  # terms of the exact series
_HALF = {"binary64": 27, "binary32": 12}  # bits of the lower half of a fraction
_RAISED = {"binary64": (900, 200), "binary32": (90, 40)}  # a quotient below 2^-first is computed scaled by 2^second


@cache
def tail_coefficients(first: int, count: int) -> tuple[Fraction, ...]:
    """Return ``count`` coefficients, lowest power first, of a polynomial p that approximates the tail of a series.

    For ``first`` = 3, sin(x) is about x + x^3 p(x^2); for ``first`` = 4, cos(x) is about 1 - x^2/2 + x^4 p(x^2).
    """
    # p approximates the series of sine or cosine from the term x^first/first! on, divided by x^first
    sign = -1 if first == 3 else 1
    return _nearest([Fraction(sign * (-1) ** k, factorial(first + 2 * k)) for k in range(_TERMS)], _SQUARE, count)


@cache
def _arc_coefficients(count: int) -> tuple[Fraction, ...]:
    """Return ``count`` coefficients, lowest power first, of a polynomial p: atan(z) is about z + z^3 p(z^2)."""
    return _nearest([Fraction((-1) ** (k + 1), 2 * k + 3) for k in range(_ARC_TERMS)], _ARC_SQUARE, count)


def _nearest(series: list[Fraction], largest: Fraction, count: int) -> tuple[Fraction, ...]:
    """Return ``count`` coefficients of a polynomial near the power series ``series`` from 0 to ``largest``."""
    # interpolation at Chebyshev points makes the largest |t*(series - polynomial)| about as small as possible
    # zeros of a Chebyshev polynomial whose last zero is moved to t = 0, because the error is weighted with t
    zeros = [Fraction(round(cos(pi * (2 * k + 1) / (2 * count + 2)) * 2**20), 2**20) for k in range(count + 1)]
    points = [largest * (zero - zeros[-1]) / (1 - zeros[-1]) for zero in zeros[:-1]]
    values = [sum((a * t**k for k, a in enumerate(series)), Fraction(0)) for t in points]
    for level in range(1, count):  # Newton's divided differences
        for i in range(count - 1, level - 1, -1):
            values[i] = (values[i] - values[i - 1]) / (points[i] - points[i - level])
    polynomial = [Fraction(0)] * count
    for i in range(count - 1, -1, -1):
        moved = [Fraction(0), *polynomial[:-1]]
        polynomial = [a - points[i] * b for a, b in zip(moved, polynomial, strict=True)]
        polynomial[0] += values[i]
    return tuple(polynomial)


def quarter_turn_parts(precision: str) -> list[Fraction]:
    """Return a few numbers whose sum is pi/2, the largest first; ``precision`` is ``"binary64"`` or ``"binary32"``."""
    # they are subtracted from an angle one after the other
    rest, parts = PI / 2, []
    for bits in _PARTS[precision]:
        # so few bits that the product with the number of quarter turns is exact
        parts.append(_leading(rest, bits))
        rest -= parts[-1]
    return [*parts, rest]


def _leading(value: Fraction, bits: int) -> Fraction:
    """Return a positive number truncated to ``bits`` significant bits: 7 with 2 bits gives 6."""
    shift = bits
    while value * Fraction(2) ** shift >= 2**bits:
        shift -= 1
    while value * Fraction(2) ** shift < 2 ** (bits - 1):
        shift += 1
    return Fraction(int(value * Fraction(2) ** shift)) / Fraction(2) ** shift


def _horner(coefficients: tuple[Fraction, ...], real: Real) -> str:
    *rest, last = [real.literal(each) for each in coefficients]
    text = last
    for literal in reversed(rest):
        text = f"{literal} + t*({text})" if text != last else f"{literal} + t*{text}"
    return text


def _wrapped(head: str, formula: str) -> list[str]:
    """Return the lines of the C statement ``const head = formula;``, broken after plus signs if it is long."""
    pieces = formula.split(" + ")
    lines, line = [], f"    const {head} = {pieces[0]}"
    for piece in pieces[1:]:
        if len(line) + len(piece) > 105:
            lines.append(f"{line} +")
            line = f"        {piece}"
        else:
            line += f" + {piece}"
    return [*lines, f"{line};"]


def _reduction(real: Real) -> list[str]:
    """Return the C statements that reduce an angle x: they subtract the nearest multiple of pi/2."""
    # Cody and Waite, Software Manual for the Elementary Functions, 1980: the products with all numbers but the last are
    # exact, with and without fused operations. The remainder is high + low, its square t; the last bits of quarter
    # select the quadrant.
    parts = [real.literal(part) for part in quarter_turn_parts(real.precision)]
    digits = _DIGITS[real.precision]
    lines = [
        f"    const {real.type} shifted = x*{real.literal(2 / PI)} + {real.literal(Fraction(3 * 2 ** (digits - 2)))};",
        f"    const {real.type} turns = shifted - {real.literal(Fraction(3 * 2 ** (digits - 2)))};",
        f"    const {{bits}} quarter = symrot_bits{real.suffix}(shifted);",
    ]
    rest = "x"
    for index, part in enumerate(parts[:-2]):
        lines.append(f"    const {real.type} rest_{index} = {rest} - turns*{part};")
        rest = f"rest_{index}"
    return [
        *lines,
        f"    const {real.type} near = {rest} - turns*{parts[-2]};",
        f"    const {real.type} missed = ({rest} - near) - turns*{parts[-2]} - turns*{parts[-1]};",
        f"    const {real.type} high = near + missed;",
        f"    const {real.type} low = (near - high) + missed;",
        f"    const {real.type} t = high*high;",
    ]


def _functions(real: Real) -> list[str]:
    kind, s = real.type, real.suffix
    bits, top = ("uint64_t", 62) if kind == "double" else ("uint32_t", 30)
    one, half = real.literal(Fraction(1)), real.literal(Fraction(1, 2))
    sine, cosine = (tail_coefficients(*each) for each in zip((3, 4), _COUNT[real.precision], strict=True))
    lines = [
        f"SYMROT_INLINE {bits} symrot_bits{s}({kind} x) {{ {bits} u; memcpy(&u, &x, sizeof u); return u; }}",
        f"SYMROT_INLINE {kind} symrot_of_bits{s}({bits} u) {{ {kind} x; memcpy(&x, &u, sizeof x); return x; }}",
        "",
        f"SYMROT_INLINE {kind} symrot_chosen{s}({bits} condition, {kind} x, {kind} y)",
        "{",
        f"    const {bits} mask = ({bits})0 - condition;",
        f"    return symrot_of_bits{s}((symrot_bits{s}(x) & mask) | (symrot_bits{s}(y) & ~mask));",
        "}",
        "",
    ]
    for name, relation, numbers, comparison in (
        ("less", "<", "finite numbers, a not -0.0", f"symrot_bits{s}(a - b) >> {top + 1}"),
        ("same", "==", "finite numbers", f"(symrot_bits{s}(fabs{s}(a - b)) - 1) >> {top + 1}"),
    ):
        lines += [
            f"/* 1 where a {relation} b, else 0; for {numbers}: by bits, since not all vectors compare */",
            f"SYMROT_INLINE {bits} symrot_{name}{s}({kind} a, {kind} b) {{ return {comparison}; }}",
            "",
        ]
    # -0.0 - 0.0 is -0.0, whose sign bit is that of a negative number; -0.0 + 0.0 is 0.0
    less = f"less{s}(a + {real.literal(Fraction(0))}, b)"
    for name, relation, chosen in (
        ("select_lt", "<", f"{less}, x, y"), ("select_eq", "==", f"same{s}(a, b), x, y"),
        ("choose_ge", ">=", f"{less}, y, x"),
    ):  # fmt: skip
        lines += [
            f"/* a {relation} b ? x : y, without a branch */",
            f"SYMROT_INLINE {kind} symrot_{name}{s}({kind} a, {kind} b, {kind} x, {kind} y)",
            "{",
            f"    return symrot_chosen{s}(symrot_{chosen});",
            "}",
            "",
        ]
    lines += [
        "/* 1 where |x| is beyond the range of symrot_sin and symrot_cos, else 0 */",
        f"SYMROT_INLINE {bits} symrot_far{s}({kind} x)",
        "{",
        f"    return symrot_less{s}({real.literal(Fraction(FAR[real.precision]))}, fabs{s}(x));",
        "}",
        "",
        f"SYMROT_INLINE {kind} symrot_sine_of_rest{s}({kind} high, {kind} low, {kind} t)",
        "{",
        *_wrapped(f"{kind} p", _horner(sine, real)),
        "    return high + (high*t*p + low);",
        "}",
        "",
        f"SYMROT_INLINE {kind} symrot_cosine_of_rest{s}({kind} high, {kind} low, {kind} t)",
        "{",
        *_wrapped(f"{kind} p", _horner(cosine, real)),
        f"    const {kind} half = {half}*t;",
        f"    const {kind} near = {one} - half;",
        f"    return near + ((({one} - near) - half) + (t*t*p - high*low));",
        "}",
        "",
    ]
    for name, chosen, turned in (("sin", "cosine, sine", "quarter"), ("cos", "sine, cosine", "(quarter + 1)")):
        lines += [
            f"SYMROT_INLINE {kind} symrot_{name}{s}({kind} x)",
            "{",
            *(line.format(bits=bits) for line in _reduction(real)),
            f"    const {kind} sine = symrot_sine_of_rest{s}(high, low, t);",
            f"    const {kind} cosine = symrot_cosine_of_rest{s}(high, low, t);",
            f"    const {kind} size = symrot_chosen{s}(quarter & 1, {chosen});",
            f"    return symrot_of_bits{s}(symrot_bits{s}(size) ^ (({turned} & 2) << {top}));",
            "}",
            "",
        ]
    return [*lines, *_arc(real)]


def _arc(real: Real) -> list[str]:
    """Return the C text of the function atan2, the angle of the point (x, y) in all four quadrants."""
    kind, s = real.type, real.suffix
    bits, sign, fraction, bias = ("uint64_t", 63, 52, 1023) if kind == "double" else ("uint32_t", 31, 23, 127)
    tiny, up = _RAISED[real.precision]
    least = real.literal(Fraction(1, 2**60))

    def number(value: int | Fraction) -> str:
        return real.literal(Fraction(value))

    # the quotient z is at most 1/2: smaller by larger coordinate, or their difference by their sum; its rounding error
    # is computed exactly from factors of half length and added
    eighth = _leading(PI / 4, _DIGITS[real.precision] - 3)
    return [
        "/* the angle of (x, y): atan2(y, x) */",
        f"SYMROT_INLINE {kind} symrot_atan2{s}({kind} y, {kind} x)",
        "{",
        f"    const {bits} sign = ({bits})1 << {sign};",
        f"    const {bits} steep = symrot_less{s}(fabs{s}(x), fabs{s}(y));",
        f"    const {kind} larger = symrot_chosen{s}(steep, fabs{s}(y), fabs{s}(x));",
        f"    const {kind} smaller = symrot_chosen{s}(steep, fabs{s}(x), fabs{s}(y));",
        f"    const {bits} opposite = {2 * bias} - (symrot_bits{s}(larger) >> {fraction});",
        f"    const {kind} scale = symrot_of_bits{s}((opposite | ((opposite - 1) >> {sign})) << {fraction});",
        f"    const {bits} flat = symrot_less{s}(smaller, larger*{number(Fraction(1, 2**tiny))});",
        f"    const {kind} up = symrot_chosen{s}(flat, {number(2**up)}, {number(1)});",
        f"    const {kind} down = symrot_chosen{s}(flat, {number(Fraction(1, 2**up))}, {number(1)});",
        f"    const {kind} scaled = larger*scale; /* from 1 to 4; less if subnormal */",
        f"    const {kind} d = symrot_chosen{s}(symrot_less{s}(scaled, {least}), {number(1)}, scaled); /* not 0 */",
        f"    const {kind} n = smaller*up*scale;",
        f"    const {bits} wide = symrot_less{s}(d, n + n);",
        f"    const {kind} sum = d + n;",
        f"    const {kind} over = symrot_chosen{s}(wide, n - d, n);",
        f"    const {kind} under = symrot_chosen{s}(wide, sum, d);",
        f"    const {kind} lost = symrot_chosen{s}(wide, (d - sum) + n, {number(0)});",
        f"    const {kind} inverse = {number(1)}/under;",
        f"    const {kind} z = over*inverse;",
        f"    const {bits} upper = ~((({bits})1 << {_HALF[real.precision]}) - 1);",
        f"    const {kind} z_1 = symrot_of_bits{s}(symrot_bits{s}(z) & upper);",
        f"    const {kind} under_1 = symrot_of_bits{s}(symrot_bits{s}(under) & upper);",
        f"    const {kind} z_2 = z - z_1;",
        f"    const {kind} under_2 = under - under_1;",
        f"    const {kind} missed = ((((over - z_1*under_1) - z_1*under_2) - z_2*under_1) - z_2*under_2) - z*lost;",
        f"    const {kind} t = z*z;",
        *_wrapped(f"{kind} p", _horner(_arc_coefficients(_ARC_COUNT[real.precision]), real)),
        f"    const {kind} low = missed*inverse + z*t*p;",
        f"    const {kind} reflected = symrot_chosen{s}(steep, -{number(0)}, {number(0)});",
        f"    const {bits} turned = symrot_bits{s}(reflected) ^ (symrot_bits{s}(x) & sign);",
        f"    const {kind} rest = symrot_of_bits{s}(symrot_bits{s}(z*down) ^ turned);",
        f"    const {kind} rest_low = symrot_of_bits{s}(symrot_bits{s}(low*down) ^ turned);",
        f"    const {kind} first = symrot_chosen{s}(wide, {number(1)}, {number(0)});",
        f"    const {kind} second = symrot_chosen{s}(steep, {number(2)} - first, first);",
        f"    const {kind} eighths = symrot_chosen{s}(symrot_bits{s}(x) >> {sign}, {number(4)} - second, second);",
        f"    const {kind} base = eighths*{real.literal(eighth)};",
        f"    const {kind} high = base + rest;",
        f"    const {kind} tail = eighths*{real.literal(PI / 4 - eighth)} + rest_low;",
        f"    const {kind} angle = high + (((base - high) + rest) + tail);",
        f"    return symrot_of_bits{s}(symrot_bits{s}(angle) | (symrot_bits{s}(y) & sign));",
        "}",
        "",
    ]


def math_header() -> str:
    """Return the text of ``symrot_math.h``, which is the same on every machine."""
    far = ", ".join(f"{FAR[real.precision]} rad in {real.type}" for real in (DOUBLE, FLOAT))
    return "\n".join([
        "/*",
        " * symrot_math.h: sine, cosine, arc tangent for batches, without branches, so that compilers vectorise them.",
        " *",
        " * symrot_sin, symrot_cos, symrot_atan2 (double), symrot_sinf, symrot_cosf, symrot_atan2f (float)",
        f" * Domain: sine and cosine |x| up to {far}; beyond, batches compute their block of",
        " *         samples again with the C library (symrot_far tells). Arc tangent: finite numbers, zeros of",
        " *         either sign as atan2. NaN of NaN and of infinities.",
        " * Error: at most 1 unit in the last place, with and without fused multiply-add; 0.0 of -0.0.",
        " * Needs: rounding to nearest, evaluation in the type itself, IEEE 754 binary formats; not -ffast-math.",
        " * Generated by `symrot emit --all`; do not edit.",
        " */",
        "#ifndef SYMROT_MATH_H", "#define SYMROT_MATH_H", "",
        "#include <float.h>", "#include <math.h>", "#include <stdint.h>", "#include <string.h>", "",
        "#ifdef __FAST_MATH__", '#error "symrot_math.h relies on IEEE 754 arithmetic: compile without -ffast-math"',
        "#endif",
        "#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16",
        '#error "symrot_math.h relies on evaluation in the type itself: use SSE2 in the place of x87"',
        "#endif", "",
        "#define SYMROT_BLOCK 512 /* samples that are computed again together */", "",
        "#if defined(__GNUC__)", "#define SYMROT_INLINE static inline __attribute__((always_inline, unused))",
        "#else", "#define SYMROT_INLINE static inline", "#endif", "",
        *_functions(DOUBLE), *_functions(FLOAT),
        "#endif",
    ]) + "\n"  # fmt: skip

"""C functions of SIMD vectors for ensembles: phases ``a t + b`` as sums of two doubles, and their sine and cosine.

They use the argument reduction and the polynomials of :mod:`symrot.codegen.printing.math_header`. For a trajectory
whose angle is too large for the polynomials, the C library is called, so that its result does not depend on the other
angles in the vector.
"""

from fractions import Fraction
from functools import cache

from symrot.codegen.printing.c_function import DOUBLE
from symrot.codegen.printing.math_header import FAR, quarter_turn_parts, tail_coefficients
from symrot.formula.exact_numbers import PI

__all__ = ["lane_functions"]

TEMPLATE = """
/* Return a + b as it is rounded; *low gains what the rounding took from it (Knuth's sum). */
static inline symrot_v symrot_plus(symrot_v a, symrot_v b, symrot_v *low)
{
    const symrot_v sum = V_ADD(a, b), rise = V_SUB(sum, a);
    *low = V_ADD(*low, V_ADD(V_SUB(a, V_SUB(sum, rise)), V_SUB(b, rise)));
    return sum;
}

/*
 * Return a t + b at the time t + t_low as it is rounded; what the rounding took from it goes to *low, to 2^-79 of it.
 * The product is that of upper halves, which is exact, and the rest: nothing changes where sums and products are fused.
 */
static inline symrot_v symrot_turn(symrot_v a, symrot_v b, symrot_v t, symrot_v t_low, symrot_v *low)
{
    const symrot_v a_high = V_FROM_BITS(V_TO_BITS(a) & ~(int64_t)0x7ffffff), a_low = V_SUB(a, a_high);
    const symrot_v t_high = V_FROM_BITS(V_TO_BITS(t) & ~(int64_t)0x7ffffff), t_rest = V_SUB(t, t_high);
    const symrot_v rest = V_FMA(a_low, t_rest, V_FMA(a_high, t_rest, V_MUL(a_low, t_high)));
    *low = V_MUL(a, t_low);
    return symrot_plus(symrot_plus(V_MUL(a_high, t_high), b, low), rest, low);
}

/* Sine and cosine of high + low, |low| below half a unit in the last place of high; see symrot_math.h. */
static inline void symrot_circle(symrot_v high, symrot_v low, symrot_v *sine, symrot_v *cosine)
{
    const symrot_v magic = V_ALL(@magic@), shifted = V_FMA(high, V_ALL(@per_turn@), magic);
    const symrot_v turns = V_SUB(shifted, magic), start = V_FNMA(turns, V_ALL(@first@), high);
    const symrot_v near = V_FNMA(turns, V_ALL(@second@), start);
    const symrot_v gone = V_FNMA(turns, V_ALL(@second@), V_SUB(start, near));
    const symrot_v missed = V_ADD(V_FNMA(turns, V_ALL(@third@), gone), low);
    const symrot_v x = V_ADD(near, missed), rest = V_ADD(V_SUB(near, x), missed), square = V_MUL(x, x);
    symrot_v p = V_ALL(@sine_last@), q = V_ALL(@cosine_last@);
@sine@
@cosine@
    const symrot_v s = V_ADD(x, V_FMA(V_MUL(x, square), p, rest));
    const symrot_v half = V_MUL(V_ALL(0.5), square), most = V_SUB(V_ALL(1.0), half);
    const symrot_v tail = V_FNMA(x, rest, V_MUL(V_MUL(square, square), q));
    const symrot_v c = V_ADD(most, V_ADD(V_SUB(V_SUB(V_ALL(1.0), most), half), tail));
    const symrot_bits quarter = V_TO_BITS(shifted), odd = V_HAS(quarter, 1);
    const symrot_v upright = V_SELECT(odd, c, s), across = V_SELECT(odd, s, c);
    *sine = V_SELECT(V_HAS(quarter, 2), V_SUB(V_ALL(0.0), upright), upright);
    *cosine = V_SELECT(V_HAS(quarter + 1, 2), V_SUB(V_ALL(0.0), across), across);
    const symrot_bits far = V_LESS(V_ALL(@far@), symrot_size_of(high));
    if (V_ANY(far)) EACH_LANE(l) if (V_LANE(far, l)) {
        const double up = sin(V_LANE(high, l)), along = cos(V_LANE(high, l));
        const double s_low = sin(V_LANE(low, l)), c_low = cos(V_LANE(low, l));
        V_LANE(*sine, l) = up*c_low + along*s_low;
        V_LANE(*cosine, l) = along*c_low - up*s_low;
    }
}
"""


def _horner(name: str, coefficients: tuple[Fraction, ...]) -> str:
    """Return the C statements that set ``name`` to a polynomial in the variable ``square``, by Horner's rule."""
    # at the start, the C variable name contains the last coefficient; at the end, the result
    return "\n".join(
        f"    {name} = V_FMA(square, {name}, V_ALL({DOUBLE.literal(each)}));" for each in coefficients[-2::-1]
    )


@cache
def lane_functions() -> str:
    """Return the C functions ``symrot_turn`` (a phase a t + b) and ``symrot_circle`` (its sine and cosine)."""
    sine, cosine = tail_coefficients(3, 6), tail_coefficients(4, 6)
    first, second, third = map(DOUBLE.literal, quarter_turn_parts(DOUBLE.precision))
    numbers = {
        "magic": DOUBLE.literal(Fraction(3 * 2**51)), "per_turn": DOUBLE.literal(2 / PI), "first": first,
        "second": second, "third": third, "sine_last": DOUBLE.literal(sine[-1]), "sine": _horner("p", sine),
        "cosine_last": DOUBLE.literal(cosine[-1]), "cosine": _horner("q", cosine),
        "far": DOUBLE.literal(Fraction(FAR[DOUBLE.precision])),
    }  # fmt: skip
    text = TEMPLATE
    for name, value in numbers.items():
        text = text.replace(f"@{name}@", value)
    return text

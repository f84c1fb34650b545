/*
 * Operations on pairs of doubles for invariants and phases, based on the error-free sums of error_free.h. Errors are a
 * few units of 2^-104 of the operands.
 *
 * Products call fma explicitly: steppers are compiled with -ffp-contract=fast, so that a compiler without FP_FAST_FMA
 * may fuse the product inside two_product with a later sum.
 * Source: T. J. Dekker, Numerische Mathematik 18 (1971) 224-242; D. E. Knuth, The Art of Computer Programming, 4.2.2.
 */
static inline dd symrot_pair_subtract(dd a, dd b) { return dd_add_fast(a, dd_negative(b)); }

static inline dd symrot_pair_multiply(dd a, dd b)
{
    const double product = a.hi*b.hi, rest = fma(a.hi, b.hi, -product);
    return quick_two_sum(product, rest + (a.hi*b.lo + a.lo*b.hi));
}

/* a t + b at the time t + t_low: the rounded value and its rounding error */
static inline dd symrot_pair_turn(double a, double b, double t, double t_low)
{
    const double product = a*t;
    const dd sum = two_sum(product, b);
    return dd_pair(sum.hi, sum.lo + (fma(a, t, -product) + a*t_low));
}

static inline dd symrot_pair_divide(dd a, dd b)
{
    const double first = a.hi/b.hi;
    const dd rest = symrot_pair_subtract(a, symrot_pair_multiply(dd_pair(first, 0.0), b));
    return quick_two_sum(first, rest.hi/b.hi);
}

static inline dd symrot_pair_root(dd a)
{
    const double first = sqrt(a.hi);
    const dd half = dd_pair(first, 0.0);
    return quick_two_sum(first, symrot_pair_subtract(a, symrot_pair_multiply(half, half)).hi/(2.0*first));
}

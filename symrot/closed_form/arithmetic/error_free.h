/*
 * Sums and products together with their rounding errors (Dekker 1971; Ogita, Rump & Oishi 2005).
 *
 * They are exact only if the compiler rounds every operation separately: never compile with -ffast-math, and products
 * only with -ffp-contract=off. Sums are exact with -ffp-contract=fast too, because they contain no product that could
 * be fused.
 */
#ifndef SYMROT_ERROR_FREE_H
#define SYMROT_ERROR_FREE_H

#include <math.h>

#if defined(__FAST_MATH__)
#error "error-free arithmetic is compiled without -ffast-math"
#endif

/* For operations in loops over samples, which become SIMD code only if everything is inlined. */
#if defined(__GNUC__)
#define ALWAYS_INLINE static inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE static inline
#endif

/* An unevaluated sum, |lo| <= ulp(hi)/2. */
typedef struct {
    double hi, lo;
} dd;

ALWAYS_INLINE dd dd_pair(double hi, double lo)
{
    const dd r = {hi, lo};
    return r;
}

/* a + b, exactly. */
ALWAYS_INLINE dd two_sum(double a, double b)
{
    const double s = a + b;
    const double t = s - a;
    return dd_pair(s, (a - (s - t)) + (b - t));
}

/* a + b, exactly, for |a| >= |b| or a = 0. */
ALWAYS_INLINE dd quick_two_sum(double a, double b)
{
    const double s = a + b;
    return dd_pair(s, b - (s - a));
}

/* The rounding error of p = a*b. Without a fused instruction the factors are split into halves of 26 bits. */
ALWAYS_INLINE double product_error(double a, double b, double p)
{
#ifdef FP_FAST_FMA
    return fma(a, b, -p);
#else
    const double wide_a = 134217729.0*a, wide_b = 134217729.0*b; /* 2^27 + 1 */
    const double high_a = wide_a - (wide_a - a), high_b = wide_b - (wide_b - b);
    const double low_a = a - high_a, low_b = b - high_b;
    return ((high_a*high_b - p) + high_a*low_b + low_a*high_b) + low_a*low_b;
#endif
}

ALWAYS_INLINE dd two_product(double a, double b)
{
    const double p = a*b;
    return dd_pair(p, product_error(a, b, p));
}

ALWAYS_INLINE dd dd_negative(dd a)
{
    return dd_pair(-a.hi, -a.lo);
}

/* a + b with an error of 2^-104 of the larger of the two, in half the operations of dd_add. */
ALWAYS_INLINE dd dd_add_fast(dd a, dd b)
{
    const dd s = two_sum(a.hi, b.hi);
    return quick_two_sum(s.hi, s.lo + (a.lo + b.lo));
}

#endif

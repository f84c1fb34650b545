/*
 * symrot_selftest: does this machine compute as the certificates of the kernels assume?
 *
 * Compile this file as the kernels are compiled, link it with the same libm, and call symrot_selftest once at load, on
 * the thread that will call them. It checks by computing: rounding to nearest, numbers below the smallest normal one
 * kept, a*b + c rounded twice (only where the bits of the C text are wanted), square roots rounded correctly, and the
 * error of the functions of libm at points where the right values are known.
 *
 * Printed by `symrot emit --all`; do not edit.
 */
#include "symrot_selftest.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "symrot: expected FLT_EVAL_METHOD 0: each operation rounded to its own type (on x86: -mfpmath=sse)"
#endif
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "symrot: expected no -ffast-math, -Ofast or -ffinite-math-only: they void the certificates"
#endif

/* x (and y, as in atan2(y, x)), the correctly rounded value, the exact value minus it and one ulp, in that unit */
struct symrot_point {
    double y, x, value, rest, ulp;
};

typedef double (*symrot_function)(double y, double x);

static double symrot_sin(double y, double x)
{
    (void)y;
    return sin(x);
}

static double symrot_cos(double y, double x)
{
    (void)y;
    return cos(x);
}

static double symrot_atan2(double y, double x)
{
    return atan2(y, x);
}

static double symrot_sqrt(double y, double x)
{
    (void)y;
    return sqrt(x);
}

static double symrot_sinf(double y, double x)
{
    (void)y;
    return (double)sinf((float)x);
}

static double symrot_cosf(double y, double x)
{
    (void)y;
    return (double)cosf((float)x);
}

static double symrot_atan2f(double y, double x)
{
    return (double)atan2f((float)y, (float)x);
}

static double symrot_sqrtf(double y, double x)
{
    (void)y;
    return (double)sqrtf((float)x);
}

@TABLES@

struct symrot_checked {
    symrot_function function;
    const struct symrot_point *points;
    size_t count;
    double allowed; /* ulp */
    int failure;
};

static const struct symrot_checked symrot_functions[] = {
@FUNCTIONS@
};

/* nonzero where 1 + 3/4 of half a step is not rounded to nearest, ties to even, on both sides of zero */
static int symrot_rounds_otherwise(void)
{
    volatile double one = 1.0, tie = DBL_EPSILON/2, above = DBL_EPSILON*0.75, below = DBL_EPSILON*0.25;
    volatile float onef = 1.0f, tief = FLT_EPSILON/2, abovef = FLT_EPSILON*0.75f, belowf = FLT_EPSILON*0.25f;
    volatile double a = one + tie, b = one + above, c = -one - above, d = one + below, e = -one - below;
    volatile float af = onef + tief, bf = onef + abovef, cf = -onef - abovef, df = onef + belowf, ef = -onef - belowf;
    volatile double up = 1.0 + DBL_EPSILON;
    volatile float upf = 1.0f + FLT_EPSILON;
    return !(a == one && b == up && c == -up && d == one && e == -one)
        || !(af == onef && bf == upf && cf == -upf && df == onef && ef == -onef);
}

static int symrot_flushes(void)
{
    volatile double smallest = DBL_MIN, half = 0.5, big = 1.0/DBL_EPSILON;
    volatile float smallestf = FLT_MIN, halff = 0.5f, bigf = 1.0f/FLT_EPSILON;
    volatile double below = smallest*half, back = below*big;
    volatile float belowf = smallestf*halff, backf = belowf*bigf;
#if defined(__SSE2__)
    if (_mm_getcsr() & 0x8040u) { /* flush to zero, denormals are zero */
        return 1;
    }
#endif
    return !(below > 0.0 && back == DBL_MIN*0.5/DBL_EPSILON && belowf > 0.0f && backf == FLT_MIN*0.5f/FLT_EPSILON);
}

static double symrot_product_sum(double a, double b, double c)
{
    return a*b + c;
}

static float symrot_product_sumf(float a, float b, float c)
{
    return a*b + c;
}

/* (1 + s)^2 - (1 + 2 s) is s^2 rounded once, and 0 rounded twice, where s^2 is below half a step of 1 */
static int symrot_contracts(void)
{
    volatile double a = 1.0 + 0x1p-28, c = -(1.0 + 0x1p-27);
    volatile float af = 1.0f + 0x1p-13f, cf = -(1.0f + 0x1p-12f);
    volatile double rest = symrot_product_sum(a, a, c);
    volatile float restf = symrot_product_sumf(af, af, cf);
    return rest != 0.0 || restf != 0.0f;
}

static double symrot_worst(symrot_function function, const struct symrot_point *points, size_t count)
{
    double worst = 0.0;
    for (size_t i = 0; i < count; ++i) {
        volatile double y = points[i].y, x = points[i].x;
        const double error = fabs((function(y, x) - points[i].value)/points[i].ulp - points[i].rest);
        if (!(error <= worst)) { /* NaN too */
            worst = error;
        }
    }
    return worst;
}

int symrot_selftest(int bits, double ulps[SYMROT_SELFTEST_FUNCTIONS])
{
    int failure = 0;
    if (symrot_rounds_otherwise()) {
        return SYMROT_SELFTEST_ROUNDING;
    }
    if (symrot_flushes()) {
        return SYMROT_SELFTEST_FLUSHING;
    }
    if (bits && symrot_contracts()) {
        return SYMROT_SELFTEST_CONTRACTION;
    }
    for (size_t i = 0; i < SYMROT_SELFTEST_FUNCTIONS; ++i) {
        const struct symrot_checked *const checked = &symrot_functions[i];
        const double worst = symrot_worst(checked->function, checked->points, checked->count);
        if (ulps) {
            ulps[i] = worst;
        }
        if (!failure && !(worst <= checked->allowed)) {
            failure = checked->failure;
        }
    }
    return failure;
}

const char *symrot_selftest_sentence(int failure)
{
    static const char *const sentences[] = {
@SENTENCES@
    };
    const int count = (int)(sizeof sentences/sizeof sentences[0]);
    return failure >= 0 && failure < count ? sentences[failure] : "no check of the self-test has this number";
}

/* Largest error of symrot_sin and symrot_cos in units in the last place: tests/kernels/test_in_c.py compiles this. */
#include "symrot_math.h"

static double error_of(double x)
{
    const double found[2] = {symrot_sin(x), symrot_cos(x)};
    const long double exact[2] = {sinl((long double)x), cosl((long double)x)};
    double worst = 0.0;
    for (int i = 0; i < 2; ++i) {
        int exponent;
        frexpl(exact[i], &exponent);
        const int last = exponent - 53 < -1074 ? -1074 : exponent - 53;
        const double error = (double)fabsl(((long double)found[i] - exact[i])/ldexpl(1.0L, last));
        if (!(error <= worst))
            worst = error;
    }
    return worst;
}

/* the five doubles nearest to each of the first multiples of pi/2 */
double symrot_worst_at_multiples(unsigned long long multiples)
{
    double worst = 0.0;
    for (unsigned long long n = 1; n <= multiples; ++n) {
        double x = (double)((long double)n*1.57079632679489661923132169163975144L);
        x = nextafter(nextafter(x, 0.0), 0.0);
        for (int i = 0; i < 5; ++i) {
            const double error = error_of(x);
            if (!(error <= worst))
                worst = error;
            x = nextafter(x, 1e300);
        }
    }
    return worst;
}

/* samples in [-reach, reach], seeded: every other one near a multiple of pi/2 */
double symrot_worst_double(unsigned long long samples, double reach, unsigned long long seed)
{
    double worst = 0.0;
    for (unsigned long long k = 0; k < samples; ++k) {
        seed = seed*6364136223846793005ULL + 1442695040888963407ULL;
        const double share = (double)(seed >> 11)/9007199254740992.0;
        double x = (2.0*share - 1.0)*reach;
        if (k % 2)
            x = (double)(rint(x/1.5707963267948966)*1.57079632679489661923L) + ldexp(share - 0.5, -(int)(k % 60));
        if (k % 16 == 0)
            x = ldexp(x, -(int)(k % 1000));
        if (fabs(x) > reach)
            continue;
        const double error = error_of(x);
        if (!(error <= worst))
            worst = error;
    }
    return worst;
}

/* every float whose bits, without the sign, are in [from, to) */
double symrot_worst_float(uint32_t from, uint32_t to)
{
    double worst = 0.0;
    for (uint32_t bits = from; bits < to; ++bits) {
        const float x = symrot_of_bitsf(bits);
        const float found[2] = {symrot_sinf(x), symrot_cosf(x)};
        const double exact[2] = {sin((double)x), cos((double)x)};
        for (int i = 0; i < 2; ++i) {
            int exponent;
            frexp(exact[i], &exponent);
            const int last = exponent - 24 < -149 ? -149 : exponent - 24;
            const double error = fabs(((double)found[i] - exact[i])*ldexp(1.0, -last));
            if (!(error <= worst))
                worst = error;
        }
        if (symrot_bitsf(symrot_sinf(-x)) != (symrot_bitsf(-found[0])) && x != 0.0f)
            return HUGE_VAL; /* the sine is odd */
    }
    return worst;
}

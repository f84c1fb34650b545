/*
 * Phases in revolutions and functions of a phase, for loops over samples that a compiler converts to SIMD code: no
 * calls (rint is one instruction from SSE4.1 on), no branches, no tables. Functions are Taylor series of the phase,
 * with errors below 1e-17 on their range.
 */
#ifndef SYMROT_CIRCULAR_H
#define SYMROT_CIRCULAR_H

/* At -O2 gcc compiles in half the time of -O3. This is the only option of -O3 that the loops over samples need. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("tree-loop-vectorize", "vect-cost-model=dynamic")
#endif

#include <stdint.h>

#include "error_free.h"

/* a*b + c, rounded once if the processor has such an instruction; for series, in which either result is accurate. */
#ifdef FP_FAST_FMA
#define MUL_ADD(a, b, c) fma((a), (b), (c))
#else
#define MUL_ADD(a, b, c) ((a)*(b) + (c))
#endif

/* A phase that is linear in time, in revolutions, to 31 digits: its rate and its value at the start, each as hi, lo. */
typedef struct {
    double rate[2], start[2];
} phase;

ALWAYS_INLINE phase phase_of(const double v[4])
{
    const phase p = {{v[0], v[1]}, {v[2], v[3]}};
    return p;
}

/* Rates of 31 digits give the phase of a motion to 1e-13 revolutions within this number of revolutions, 7e16. */
#define MOST_REVOLUTIONS 0x1p+56

/*
 * Return start + rate*t + more modulo 1/`parts` of a revolution, between -1/2 and 1/2 part. `taken` receives the number
 * of parts subtracted, -7 to 7 if `parts` is 4. The error is one rounding of the result, and of rate*t at 31 digits.
 * The result is NaN beyond MOST_REVOLUTIONS. |start| <= 1/2, |more| <= 1/8.
 */
ALWAYS_INLINE double phase_rest(const phase *p, double t, double parts, double more, double *taken)
{
    const double turns = t*p->rate[0];
    double small = product_error(t, p->rate[0], turns) + t*p->rate[1];
    small = (small - rint(small)) + p->start[1] + more;
    const dd sum = two_sum(turns - rint(turns), p->start[0]);
    *taken = rint(parts*(sum.hi + small));
    const double rest = (sum.hi - *taken*(1.0/parts)) + (sum.lo + small);
    return fabs(turns) <= MOST_REVOLUTIONS ? rest : NAN;
}

/* start + rate*t, rounded once, for a phase that is not periodic. */
ALWAYS_INLINE double phase_whole(const phase *p, double t)
{
    const double turns = t*p->rate[0];
    const dd sum = two_sum(turns, p->start[0]);
    return sum.hi + (sum.lo + (product_error(t, p->rate[0], turns) + t*p->rate[1] + p->start[1]));
}

/* Sine and cosine of rest + taken/4 revolutions, |rest| <= 1/8. */
ALWAYS_INLINE void sincos_quarters(double rest, double taken, double *sine, double *cosine)
{
    const double x = rest*rest;
    double s = 0x1.aaec32af93359p-4, c = -0x1.2a0c591af8314p-5;
    c = MUL_ADD(c, x, 0x1.20c62c2f2d7f5p-2);
    s = MUL_ADD(s, x, -0x1.6fadb9f155744p-1);
    c = MUL_ADD(c, x, -0x1.b6e24f44b128fp+0);
    s = MUL_ADD(s, x, 0x1.e8f434d018d63p+1);
    c = MUL_ADD(c, x, 0x1.f9d38a3763cc3p+2);
    s = MUL_ADD(s, x, -0x1.e3074fde8871fp+3);
    c = MUL_ADD(c, x, -0x1.a6d1f2a204a8cp+4);
    s = MUL_ADD(s, x, 0x1.50783487ee782p+5);
    c = MUL_ADD(c, x, 0x1.e1f506891babbp+5);
    s = MUL_ADD(s, x, -0x1.32d2cce62bd86p+6);
    c = MUL_ADD(c, x, -0x1.55d3c7e3cbffap+6);
    s = MUL_ADD(s, x, 0x1.466bc6775aae2p+6);
    c = MUL_ADD(c, x, 0x1.03c1f081b5ac4p+6);
    s = MUL_ADD(s, x, -0x1.4abbce625be53p+5);
    c = MUL_ADD(c, x, -0x1.3bd3cc9be45dep+4);
    s = MUL_ADD(s, x, 0x1.921fb54442d18p+2);
    c = MUL_ADD(c, x, 0x1.0000000000000p+0);
    s *= rest;
    const double half = rint(0.5*taken), fourth = half - 2.0*rint(0.5*half);
    const double odd = taken - 2.0*half;                             /* 1 or -1: a quarter forward or back */
    const double even = (1.0 - odd*odd)*(1.0 - 2.0*fourth*fourth);   /* 1 or -1: no or half a revolution */
    *sine = even*s + odd*c;
    *cosine = even*c - odd*s;
}

/* exp(x) for |x| <= 700. */
ALWAYS_INLINE double exp_moderate(double x)
{
    const double k = rint(x*0x1.71547652b82fep+0); /* 1/ln 2 */
    const double rest = MUL_ADD(-k, 0x1.abc9e3b39803fp-56, MUL_ADD(-k, 0x1.62e42fefa39efp-1, x));
    double sum = 0x1.6124613a86d09p-33;
    sum = MUL_ADD(sum, rest, 0x1.1eed8eff8d898p-29); /* 1/12! */
    sum = MUL_ADD(sum, rest, 0x1.ae64567f544e4p-26); /* 1/11! */
    sum = MUL_ADD(sum, rest, 0x1.27e4fb7789f5cp-22); /* 1/10! */
    sum = MUL_ADD(sum, rest, 0x1.71de3a556c734p-19); /* 1/9! */
    sum = MUL_ADD(sum, rest, 0x1.a01a01a01a01ap-16); /* 1/8! */
    sum = MUL_ADD(sum, rest, 0x1.a01a01a01a01ap-13); /* 1/7! */
    sum = MUL_ADD(sum, rest, 0x1.6c16c16c16c17p-10); /* 1/6! */
    sum = MUL_ADD(sum, rest, 0x1.1111111111111p-7); /* 1/5! */
    sum = MUL_ADD(sum, rest, 0x1.5555555555555p-5); /* 1/4! */
    sum = MUL_ADD(sum, rest, 0x1.5555555555555p-3); /* 1/3! */
    sum = MUL_ADD(sum, rest, 0x1.0000000000000p-1); /* 1/2! */
    sum = MUL_ADD(sum, rest, 0x1.0000000000000p+0); /* 1/1! */
    sum = MUL_ADD(sum, rest, 0x1.0000000000000p+0); /* 1/0! */
    union {
        double number;
        uint64_t bits;
    } power;
    power.number = k + (0x1.8p+52 + 1023.0); /* the exponent of 2^k in the lowest bits */
    power.bits <<= 52;
    return sum*power.number;
}

#endif

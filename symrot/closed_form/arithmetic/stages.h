/*
 * Loops over samples in blocks that fit into the first-level cache. Each stage is a loop that computes one array from
 * the previous ones.
 *
 * One long loop from times to results would be compiled for each regime and each requested quantity, and would need
 * more registers than a processor has. Stages are compiled once and shared. They process whole groups of samples, so
 * that SIMD code needs no loop for the remainder; arrays are padded to whole groups.
 */
#ifndef SYMROT_STAGES_H
#define SYMROT_STAGES_H

#include <stddef.h>
#include <string.h>

#include "circular.h"
#include "regimes.h"

enum { BLOCK = 64, GROUP = 8 };

/* Not inlined, because compilation would take several times as long. */
#if defined(__GNUC__)
#define STAGE static __attribute__((noinline, unused)) void
#else
#define STAGE static void
#endif

/* A loop over the samples of whole groups. */
#define EACH(i, count) for (ptrdiff_t i = 0, whole_##i = (count) & ~(ptrdiff_t)(GROUP - 1); i < whole_##i; ++i)

ALWAYS_INLINE double polynomial(const double c[SERIES], double x)
{
    return MUL_ADD(MUL_ADD(MUL_ADD(MUL_ADD(c[4], x, c[3]), x, c[2]), x, c[1]), x, c[0]);
}

ALWAYS_INLINE double cubic(const double c[SERIES], double x)
{
    return MUL_ADD(MUL_ADD(MUL_ADD(c[3], x, c[2]), x, c[1]), x, c[0]);
}

ALWAYS_INLINE double clamped(double x, double limit)
{
    x = x > limit ? limit : x;
    return x < -limit ? -limit : x;
}

/* Times in the unit of a motion, padded to whole groups; returns their number. */
static inline ptrdiff_t take_times(const double *times, ptrdiff_t count, double scale, double *t)
{
    for (ptrdiff_t i = 0; i < count; ++i)
        t[i] = times[i]*scale;
    ptrdiff_t padded = count;
    for (; padded & (GROUP - 1); ++padded)
        t[padded] = 0.0;
    return padded;
}

/* Sine and cosine of a phase plus slope*whole revolutions. */
STAGE turn(const double v[4], double slope, ptrdiff_t n, const double *restrict t, const double *restrict whole,
    double *restrict sine, double *restrict cosine)
{
    const phase p = phase_of(v);
    EACH (i, n) {
        double taken;
        const double rest = phase_rest(&p, t[i], 4.0, slope*whole[i], &taken);
        sincos_quarters(rest, taken, &sine[i], &cosine[i]);
    }
}

/*
 * The argument of hyperbolic functions with the period 2K, from a phase in units of 4K: `whole` in units of 2K, reduced
 * to -1/2 .. 1/2, and a sign that changes with every 2K.
 */
STAGE argument(const double v[4], double stretch, ptrdiff_t n, const double *restrict t, double *restrict whole,
    double *restrict flip, double *restrict value)
{
    const phase p = phase_of(v);
    EACH (i, n) {
        double taken;
        whole[i] = 2.0*phase_rest(&p, t[i], 2.0, 0.0, &taken);
        const double odd = taken - 2.0*rint(0.5*taken);
        flip[i] = 1.0 - 2.0*odd*odd;
        value[i] = clamped(stretch*whole[i], 80.0);
    }
}

/* The same on a separatrix, where the motion is not periodic. */
STAGE argument_once(const double v[4], ptrdiff_t n, const double *restrict t, double *restrict whole,
    double *restrict flip, double *restrict value)
{
    const phase p = phase_of(v);
    EACH (i, n) {
        whole[i] = 0.0;
        flip[i] = 1.0;
        value[i] = clamped(phase_whole(&p, t[i]), 80.0);
    }
}

/* omega = map*(x, y, z). */
STAGE put_omega(const double map[3][3], ptrdiff_t n, const double *restrict x, const double *restrict y,
    const double *restrict z, double *restrict omega)
{
    EACH (i, n) {
        omega[3*i] = MUL_ADD(map[0][0], x[i], MUL_ADD(map[0][1], y[i], map[0][2]*z[i]));
        omega[3*i + 1] = MUL_ADD(map[1][0], x[i], MUL_ADD(map[1][1], y[i], map[1][2]*z[i]));
        omega[3*i + 2] = MUL_ADD(map[2][0], x[i], MUL_ADD(map[2][1], y[i], map[2][2]*z[i]));
    }
}

/* q = map*x, one sample at a time: its four components fill a SIMD register without interleaving. */
STAGE put_quaternion(const double map[4][4], ptrdiff_t n, const double *restrict x0, const double *restrict x1,
    const double *restrict x2, const double *restrict x3, double *restrict q)
{
    double column[4][4];
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            column[j][k] = map[k][j];
    for (ptrdiff_t i = 0; i < n; ++i) {
        for (int k = 0; k < 4; ++k) {
            const double half = MUL_ADD(column[2][k], x2[i], column[3][k]*x3[i]);
            q[4*i + k] = MUL_ADD(column[0][k], x0[i], MUL_ADD(column[1][k], x1[i], half));
        }
    }
}

/*
 * Compute the requested quantities at all times, block by block, by calling `stages`, whose arrays hold whole groups.
 * `block` contains an array t.
 */
#define IN_BLOCKS(block, stages) \
    for (ptrdiff_t start = 0; start < count; start += BLOCK) { \
        const ptrdiff_t left = count - start, some = left < BLOCK ? left : BLOCK; \
        const ptrdiff_t n = take_times(times + start, some, f->time_scale, (block).t); \
        double omega_room[3*BLOCK], q_room[4*BLOCK]; \
        double *const w = omega == NULL ? NULL : n == some ? omega + 3*start : omega_room; \
        double *const q = quaternion == NULL ? NULL : n == some ? quaternion + 4*start : q_room; \
        stages(f, n, &(block), w, q); \
        if (w == omega_room) \
            memcpy(omega + 3*start, w, (size_t)some*3*sizeof *w); \
        if (q == q_room) \
            memcpy(quaternion + 4*start, q, (size_t)some*4*sizeof *q); \
    }

#endif

/*
 * Functions for the constants of all exact motions: phases, theta series as polynomials, quaternions to 31 digits.
 */
#ifndef SYMROT_SERIES_H
#define SYMROT_SERIES_H

#include "double_double.h"
#include "regimes.h"

static const int QUATERNION_OTHER[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
static const double QUATERNION_SIGN[4][4] = {{1, -1, -1, -1}, {1, 1, -1, 1}, {1, 1, 1, -1}, {1, -1, 1, 1}};

/* c = a b; zero components of b, which are common in changes of axes, are skipped. */
ONE_COPY void quaternion_product(const dd a[4], const dd b[4], dd c[4])
{
    for (int i = 0; i < 4; ++i) {
        c[i] = dd_mul(a[i], b[0]);
        for (int j = 1; j < 4; ++j)
            if (b[j].hi != 0.0)
                c[i] = dd_add(c[i], dd_scale(dd_mul(a[QUATERNION_OTHER[i][j]], b[j]), QUATERNION_SIGN[i][j]));
    }
}

/* c = a e, where e is the quaternion unit 1, i, j or k, numbered 0 to 3. */
static inline void quaternion_times_unit(const dd a[4], int unit, dd c[4])
{
    for (int i = 0; i < 4; ++i)
        c[i] = dd_scale(a[QUATERNION_OTHER[i][unit]], QUATERNION_SIGN[i][unit]);
}

static inline void quaternion_conjugate(const dd a[4], dd c[4])
{
    for (int i = 0; i < 4; ++i)
        c[i] = i ? dd_negative(a[i]) : a[i];
}

/* Divide by the norm, unless it is exactly 1. */
ONE_COPY void normalise(dd q[4])
{
    dd square = dd_of(0.0);
    for (int i = 0; i < 4; ++i)
        square = dd_add(square, dd_square(q[i]));
    const dd norm = dd_sqrt(square);
    for (int i = 0; i < 4; ++i)
        q[i] = dd_div(q[i], norm);
}

/* The rotation from the principal axes to the axes of omega and the attitude: v_given = matrix*v_principal. */
typedef struct {
    dd matrix[3][3], quaternion[4];
} body_axes;

/* Read the matrix, row by row, and the quaternion, each number as hi, lo; NULL for the principal axes themselves. */
ONE_COPY void take_axes(const double *given, body_axes *axes)
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            axes->matrix[i][k] = given ? dd_pair(given[6*i + 2*k], given[6*i + 2*k + 1]) : dd_of(i == k);
    }
    for (int i = 0; i < 4; ++i)
        axes->quaternion[i] = given ? dd_pair(given[18 + 2*i], given[19 + 2*i]) : dd_of(i == 0);
}

static inline void store(dd x, double to[2])
{
    to[0] = x.hi;
    to[1] = x.lo;
}

/* A phase from its rate and start, in revolutions; the start is reduced to -1/2 .. 1/2. */
static inline void store_phase(dd rate, dd start, double to[4])
{
    start = dd_sub(start, dd_of(rint(start.hi)));
    store(rate, to);
    store(start, to + 2);
}

/* sum of c[n] T_n(x) as a polynomial in x, for n < SERIES, with Chebyshev's T_n: cos n z = T_n(cos z). */
ONE_COPY void even_series(const dd c[SERIES], double to[SERIES])
{
    to[0] = dd_add(dd_sub(c[0], c[2]), c[4]).hi;
    to[1] = dd_sub(c[1], dd_add(dd_scale(c[3], 2.0), c[3])).hi;
    to[2] = dd_sub(dd_scale(c[2], 2.0), dd_scale(c[4], 8.0)).hi;
    to[3] = 4.0*c[3].hi;
    to[4] = 8.0*c[4].hi;
}

/*
 * sum of c[n] cos((2n+1)z)/cos z as a polynomial in x = cos 2z, n < SERIES; with sin instead of cos if sign is -1:
 * cos((2n+1)z)/cos z = 2 cos 2nz - cos((2n-1)z)/cos z, sin((2n+1)z)/sin z = 2 cos 2nz + sin((2n-1)z)/sin z.
 */
ONE_COPY void odd_series(const dd c[SERIES], double sign, double to[SERIES])
{
    dd even[SERIES], rest = dd_of(0.0);
    for (int n = SERIES - 1; n >= 0; --n) {
        rest = dd_sub(c[n], dd_scale(rest, sign));
        even[n] = dd_scale(rest, n ? 2.0 : 1.0);
    }
    even_series(even, to);
}

/* A power of two near the largest of some pairs hi, lo; 1 if all are zero. */
static inline double near_power(const double *values, int count)
{
    int exponent = 0;
    double largest = 0.0;
    for (int i = 0; i < count; ++i)
        largest = fmax(largest, fabs(values[2*i]));
    if (!(largest > 0.0))
        return 1.0;
    (void)frexp(largest, &exponent);
    exponent = exponent > 1000 ? 1000 : exponent < -1000 ? -1000 : exponent;
    return ldexp(1.0, exponent);
}

#endif

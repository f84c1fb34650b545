/*
 * Rotation about one axis under a constant torque and linear damping, dw/dt = a - k w, at any time, without stepping.
 *
 * With x = -k t, E2 = (exp(x) - 1 - x)/x^2, g = a - k w(0) the acceleration at the start, v = a/k the final rate:
 *     the angle  w(0) t + g t^2 E2          where |x| <= ln(2)/2, or there is no damping,
 *                v t + (g/k^2)(exp(x) - 1)  elsewhere,
 *     the rate   w(0) + g t (exp(x) - 1)/x, or v + (w(0) - v) exp(x).
 * Angles are in revolutions. Steady parts of an angle grow without bound, with the square of time if there is no
 * damping. Their rates are sums of so many doubles that whole revolutions can be subtracted exactly, up to
 * AXIAL_EVENLY. The transient part is a pair of doubles, up to AXIAL_TURNS. Beyond these limits a sample is NaN, and
 * the return value says so. A symmetric body that also rotates across the axis has a second angle, `lag`, by which its
 * transverse angular velocity rotates in the body.
 *
 * Proof: derivations/driven_rotation.md. Elementary constants are computed in integers (axial/compiled.py).
 * No allocation, no globals, no input or output. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_AXIAL_H
#define SYMROT_AXIAL_H

#include <stddef.h>

#define AXIAL_TURNS 0x1p+34   /* of the transient, whose functions have errors of 2^-91 */
#define AXIAL_EVENLY 0x1p+100 /* of the steady part */

enum { UNDAMPED, DAMPED };

/* An angle in revolutions. All fields are doubles, so that other languages see one array. */
typedef struct {
    double rate[3];  /* w(0) */
    double final[3]; /* v; not used without damping */
    double gain[4];  /* g; without damping g/2 */
    double rest[2];  /* g/k^2 */
    double less[2];  /* -g/k^2 without whole revolutions */
} turning;

typedef struct {
    double regime;            /* UNDAMPED, DAMPED */
    double time_scale;        /* 1 */
    double across;            /* 1 if the body also rotates across the axis: then no attitude */
    double first;             /* time, s, before which an exponential exceeds the range of doubles */
    double slowing[2];        /* -k, 1/s */
    double slowing_across[2]; /* the same for the transverse angular velocity */
    double axial[4];          /* w(0), g, v, w(0) - v, rad/s and rad/s^2 */
    turning half, lag;        /* half the angle about the axis; the angle that the transverse angular velocity lags */
    double omega[3][3];       /* maps damped cosine and sine of lag, and w, to omega */
    double attitude[4][4];    /* maps cosine and sine of half to q */
} axial;

#endif

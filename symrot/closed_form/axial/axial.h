/*
 * Rotation about one axis under a constant torque and linear damping, dw/dt = a - k w, at any time, without stepping.
 *
 * With x = -k t, E2 = (exp(x) - 1 - x)/x^2, g = a - k w(0) the acceleration at the start, v = a/k the last rate:
 *     the angle  w(0) t + g t^2 E2          where |x| <= ln(2)/2, or there is no damping,
 *                v t + (g/k^2)(exp(x) - 1)  elsewhere,
 *     the rate   w(0) + g t (exp(x) - 1)/x, or v + (w(0) - v) exp(x).
 * Angles are carried in turns. Even parts grow without bound, with the square of time where nothing damps: their rates
 * have as many parts as it takes to leave whole turns out to the last bit, up to AXIAL_EVENLY. The transient takes pairs
 * of doubles, up to AXIAL_TURNS. Beyond, a sample is NaN, and the caller is told. A symmetric body that turns across the
 * axis too has a second angle, `lag`, through which its transverse angular velocity has turned.
 *
 * Proof: derivations/driven_rotation.md. The constants are found in integers (axial_compiled.py): they are elementary.
 * No allocation, no globals, no input or output. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_AXIAL_H
#define SYMROT_AXIAL_H

#include <stddef.h>

#define AXIAL_TURNS 0x1p+34   /* of the transient: what it takes is known to 2^-91 */
#define AXIAL_EVENLY 0x1p+100 /* of the even part */

enum { UNDAMPED, DAMPED };

/* An angle in turns. Everything is a double, so that other languages see one array. */
typedef struct {
    double rate[3];  /* w(0) */
    double final[3]; /* v; not used without damping */
    double gain[4];  /* g; without damping g/2 */
    double rest[2];  /* g/k^2 */
    double less[2];  /* -g/k^2, whole turns left out */
} turning;

typedef struct {
    double regime;            /* UNDAMPED, DAMPED */
    double time_scale;        /* 1 */
    double across;            /* 1 where the body turns across the axis too: no attitude then */
    double first;             /* s, before which an exponential leaves the doubles */
    double slowing[2];        /* -k, 1/s */
    double slowing_across[2]; /* the same of the transverse angular velocity */
    double axial[4];          /* w(0), g, v, w(0) - v, rad/s and rad/s^2 */
    turning half, lag;        /* half the angle about the axis; the angle that the transverse angular velocity lags */
    double omega[3][3];       /* from cosine and sine of lag, shrunk, and w to omega */
    double attitude[4][4];    /* from cosine and sine of half to q */
} axial;

#endif

/*
 * A symmetric body under a constant torque about its axis, at any time: what its constants and its samples agree on.
 *
 * In axes e1, e2, e3 of the body, e3 along the axis so that the torque about it is positive, e1 along the transverse
 * angular velocity at time 0, of length W:
 *     omega = W (e1 cos chi + e2 sin chi) + w3 e3,  w3 linear in time,  chi = (C - A)/A times the integral of w3.
 * In axes that turn with the transverse part the body turns at (W, 0, Omega), Omega = (C/A) w3, which sweeps at a rate
 * of s = M/A. With a = q0 + i q3, b = q1 + i q2 for their attitude: 2 a' = i Omega a - W b, 2 b' = W a - i Omega b.
 * Far from Omega = 0, |Omega| >= 10 sqrt(s), or everywhere if W >= 9 sqrt(s), with S = sqrt(Omega^2 + W^2):
 *     attitude = exp(e3 (P + delta)/2) (turn that takes e3 to m)^-1 exp(-e2 theta/2),  tan theta = W/Omega,
 *     P = integral of S = (Omega S + W^2 asinh(Omega/W))/(2 s),  m and delta as polynomials in y = Y/S^2.
 * A torque so weak that P loses digits at the start, S^2 > 1e15 s, has P from there on as a series in h = s t/S(0):
 * |h| < 1/90 for the 1e13 rad that pairs of doubles count.
 * Elsewhere Taylor's polynomials of (a, b) about even places in x = Omega/sqrt(s).
 * Proof, of the recurrences too: derivations/driven_rotation.md.
 *
 * symrot_spin_up_prepare (spin_up.c) finds the constants, once; symrot_spin_up_at (spin_up_at.c) takes the samples.
 * No allocation, no globals, no input or output. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_SPIN_UP_H
#define SYMROT_SPIN_UP_H

#include <stddef.h>

enum { SPIN_UP_SERIES = 13, SPIN_UP_TAYLOR = 20, SPIN_UP_PIECES = 4, SPIN_UP_TERMS = 16 };

/* Where a sample is: far before resonance, near it, far beyond. */
enum { SPIN_UP_BEFORE, SPIN_UP_NEAR, SPIN_UP_BEYOND };

/* What samples lack: Taylor's polynomials; digits, for more turns than pairs of doubles count. */
enum { SPIN_UP_LACKING = 1, SPIN_UP_LOST = 2 };

/* How P is found: by its formula, with more digits of the logarithm, or by the series. */
enum { SPIN_UP_PLAIN, SPIN_UP_FINE, SPIN_UP_WEAK };

/* P/(4 pi), half of P in turns. */
typedef struct {
    double way;                  /* under a weak torque a sample is never near */
    double product[2], share[2]; /* 1/(8 pi s), W^2/(8 pi s); of the series s/S(0), S(0)/(4 pi) */
    double logarithm[2];         /* log W */
    double series[SPIN_UP_TERMS][2];
} spin_up_phase;

/* Everything is a double, so that other languages see one array. */
typedef struct {
    double time_scale; /* a power of two; times are multiplied by it, rates divided */
    double longest;    /* the scaled time from which a phase may have more rad than pairs of doubles count */
    double edge;       /* |Omega| from which a sample is far */
    double whole;      /* 1: all are, and share one attitude, that of SPIN_UP_BEYOND */
    double start;      /* where the start is; without Taylor's polynomials no attitude is known elsewhere */
    double sweep[4];   /* Omega at time 0, s */
    double across[2];  /* W */
    double turn[4];    /* chi/2 in turns: of the time, and of its square */
    double inverse[2]; /* 1/sqrt(s) */
    double unit;       /* Y */
    double g[SPIN_UP_SERIES], c[SPIN_UP_SERIES], e[SPIN_UP_SERIES];
    spin_up_phase phase;
    double rates[3][2];       /* from cos chi, sin chi to omega, rad/s */
    double axial[3];          /* from w3 to omega: which axis of the body it is about */
    double spin[4];           /* w3 at time 0, and its growth */
    double attitude[3][4][4]; /* from q0, q1, q2, q3 of each place to those of the body */
} spin_up;

#endif

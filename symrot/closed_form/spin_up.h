/*
 * A symmetric body under a constant torque about its axis, at any time: what its constants and its samples agree on.
 *
 * In axes e1, e2, e3 of the body, e3 along the axis so that the torque about it is positive, e1 along the transverse
 * angular velocity at time 0, of length W:
 *     omega = W (e1 cos chi + e2 sin chi) + w3 e3,  w3 linear in time,  chi = (C - A)/A times the integral of w3.
 * In axes that turn with the transverse part the body turns at (W, 0, Omega), Omega = (C/A) w3, which sweeps at the rate
 * s = M/A. With a = q0 + i q3, b = q1 + i q2 for their attitude: 2 a' = i Omega a - W b, 2 b' = W a - i Omega b.
 * Far from Omega = 0, |Omega| >= 10 sqrt(s), or everywhere if W >= 9 sqrt(s):
 *     attitude = exp(e3 (P + delta)/2) (turn that takes e3 to m)^-1 exp(-e2 theta/2),  tan theta = W/Omega,
 *     P = integral of sqrt(Omega^2 + W^2),  m and delta as polynomials in y = Y/(Omega^2 + W^2).
 * Elsewhere Taylor's polynomials of (a, b) about even places in x = Omega/sqrt(s).
 * Compile with -ffp-contract=off.
 */
#ifndef SYMROT_SPIN_UP_H
#define SYMROT_SPIN_UP_H

#include <stddef.h>

enum { SPIN_UP_SERIES = 13, SPIN_UP_TAYLOR = 20, SPIN_UP_PIECES = 4, SPIN_UP_COUNT = 10*SPIN_UP_PIECES };

/* One side of resonance: counted from the start of the motion or from where it leaves the neighbourhood of resonance. */
typedef struct {
    double time[2], sweep[2]; /* there: the time, and Omega, each as hi, lo */
    double delta;             /* there, rad */
    double attitude[4][4];    /* from q0, q1, q2, q3 of the formula to those of the body */
} spin_up_side;

typedef struct {
    double time_scale; /* a power of two; times are multiplied by it, rates divided */
    double edge;       /* |Omega| from which a sample is far */
    double wide;       /* 1: all are, and the first side holds for both */
    double turn[4];    /* chi/2 in turns: of the time, and of its square */
    double sweep[4];   /* Omega at time 0, s */
    double across[2];  /* W */
    double inverse[2]; /* 1/sqrt(s) */
    double unit;       /* Y */
    double g[SPIN_UP_SERIES], c[SPIN_UP_SERIES], e[SPIN_UP_SERIES];
    double rates[3][2]; /* from cos chi, sin chi to omega, rad/s */
    double axial[3];    /* from w3 to omega: which axis of the body it is about */
    double spin[4];     /* w3 at time 0, and its growth */
    spin_up_side side[2];
    double near_attitude[4][4];
} spin_up;

#endif

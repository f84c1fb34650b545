/*
 * A symmetric body under a constant torque about its axis, at any time: formulas and record of constants.
 *
 * In axes e1, e2, e3 of the body, e3 along the axis so that the torque about it is positive, e1 along the transverse
 * angular velocity at time 0, of length W:
 *     omega = W (e1 cos chi + e2 sin chi) + w3 e3,  w3 linear in time,  chi = (C - A)/A times the integral of w3.
 * Axes that rotate with the transverse part have the angular velocity (W, 0, Omega). Omega = (C/A) w3 grows at the
 * rate s = M/A. With a = q0 + i q3, b = q1 + i q2 for their attitude: 2 a' = i Omega a - W b, 2 b' = W a - i Omega b.
 * Far from Omega = 0, |Omega| >= 10 sqrt(s), or everywhere if W >= 9 sqrt(s), with S = sqrt(Omega^2 + W^2):
 *     attitude = exp(e3 (P + delta)/2) (rotation that takes e3 to m)^-1 exp(-e2 theta/2),  tan theta = W/Omega,
 *     P = integral of S = (Omega S + W^2 asinh(Omega/W))/(2 s),  m and delta as polynomials in y = Y/S^2.
 * For a torque so weak that P loses digits at the start, S^2 > 1e15 s, P is a series in h = s t/S(0) from the start on:
 * |h| < 1/90 up to 1e13 rad, the limit of pairs of doubles.
 * Near resonance: Taylor polynomials of (a, b) about evenly spaced points of x = Omega/sqrt(s).
 * Proof, of the recurrences too: derivations/driven_rotation.md.
 *
 * symrot_spin_up_prepare (spin_up.c) computes the constants once; symrot_spin_up_at (spin_up_at.c) computes samples.
 * No allocation, no globals, no input or output. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_SPIN_UP_H
#define SYMROT_SPIN_UP_H

#include <stddef.h>

enum { SPIN_UP_SERIES = 13, SPIN_UP_TAYLOR = 20, SPIN_UP_PIECES = 4, SPIN_UP_TERMS = 16 };

/* The side of a sample: far before resonance, near it, far beyond it. */
enum { SPIN_UP_BEFORE, SPIN_UP_NEAR, SPIN_UP_BEYOND };

/* Reasons why samples are missing: no Taylor polynomials; too many revolutions for pairs of doubles. */
enum { SPIN_UP_LACKING = 1, SPIN_UP_LOST = 2 };

/* The formula for P: with a logarithm, with more digits of the logarithm, or by the series. */
enum { SPIN_UP_PLAIN, SPIN_UP_FINE, SPIN_UP_WEAK };

/* P/(4 pi): half of P in revolutions. */
typedef struct {
    double way;                  /* under a weak torque a sample is never near */
    double product[2], share[2]; /* 1/(8 pi s), W^2/(8 pi s); for the series s/S(0), S(0)/(4 pi) */
    double logarithm[2];         /* log W */
    double series[SPIN_UP_TERMS][2];
} spin_up_phase;

/* All fields are doubles, so that other languages see one array. */
typedef struct {
    double time_scale; /* a power of two; times are multiplied by it, rates divided */
    double longest;    /* scaled time after which a phase may be too large for pairs of doubles */
    double edge;       /* smallest |Omega| of a sample far from resonance */
    double whole;      /* 1: all samples are far, and use the attitude map of SPIN_UP_BEYOND */
    double start;      /* side of the start; without Taylor polynomials only its attitudes are known */
    double sweep[4];   /* Omega at time 0, s */
    double across[2];  /* W */
    double turn[4];    /* chi/2 in revolutions: coefficients of t and of t^2 */
    double inverse[2]; /* 1/sqrt(s) */
    double unit;       /* Y */
    double g[SPIN_UP_SERIES], c[SPIN_UP_SERIES], e[SPIN_UP_SERIES];
    spin_up_phase phase;
    double rates[3][2];       /* maps cos chi, sin chi to omega, rad/s */
    double axial[3];          /* maps w3 to omega: the body axis of the torque */
    double spin[4];           /* w3 at time 0, and its rate of change */
    double attitude[3][4][4]; /* for each side, maps q0, q1, q2, q3 to the attitude of the body */
} spin_up;

#endif

/*
 * The free rigid body at any time, without stepping: theta functions of a phase that grows evenly with time.
 *
 * symrot_free_body_prepare (free_body.c) finds the constants of a motion in double-double arithmetic, once;
 * symrot_free_body_at (free_body_at.c) gives angular velocity and attitude at any number of times, in any order, each for
 * itself. No allocation, no globals, no input or output; a constants record may be used by several threads at once.
 *
 * Frames. The body's principal axes are renamed and turned so that e3 is the axis L circles about (that of the largest
 * or of the smallest moment), L3 >= 0, L1 >= 0, e2 = e3 x e1. With s = sign(I3 - I2):
 *     L = (A1 cn u, s A2 sn u, A3 dn u),  u = lambda t + u0,  modulus m,
 *     q = q_L * X * q_C,  X = exp(k psi/2) P,  P = (1 + m3, m2, -m1, 0)/sqrt(2 (1 + m3)),  (m1, m2, m3) = L/|L|,
 *     exp(i psi/2) = exp(i kappa t) N/|N|,  N = theta4(pi u/2K - i s zeta, nome q^2).
 * P is the least turn that takes L to the third axis, q_C the renaming, q_L what the initial attitude leaves.
 * Jacobi's imaginary transformation takes the place of the series where m >= 0.7; it holds to m = 1.
 *
 * Sources: Whittaker, Analytical Dynamics, 4th ed., section 69; van Zon & Schofield, J. Comput. Phys. 225 (2007) 145;
 * Carlson, Numer. Algorithms 10 (1995) 13 for R_F. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_FREE_BODY_H
#define SYMROT_FREE_BODY_H

#include "regimes.h"

/* Everything is a double, so that other languages see one array. */
typedef struct {
    double regime;
    double time_scale;        /* a power of two; times are multiplied by it */
    double axial[4];          /* the phase of u: turns of 4K; on the separatrix of v itself */
    double turning[4];        /* the phase of psi/2 */
    double slope;             /* turns of psi/2 per 2K of u in the imaginary transformation, the even part left out */
    double stretch;           /* v per 2K of u */
    double series[6][SERIES]; /* numerators of cn, sn, dn; their denominator; N: real, imaginary part */
    double momentum[3];       /* A/|L| */
    double omega[3][3];       /* from cn, sn, dn to omega in the given axes, rad/s */
    double attitude[4][4];    /* from X to q */
} free_body;

#endif

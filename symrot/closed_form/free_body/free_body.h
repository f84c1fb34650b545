/*
 * The free rigid body at any time, without stepping: theta functions of a phase that is linear in time.
 *
 * symrot_free_body_prepare (free_body.c) computes the constants of a motion once, in double-double arithmetic;
 * symrot_free_body_at (free_body_at.c) computes angular velocity and attitude at any times, in any order, each
 * independently. No allocation, no globals, no input or output; several threads may use one record of constants.
 *
 * Frames. The body's principal axes are renamed and reversed so that e3 is the axis around which L moves (the axis of
 * the largest or the smallest moment), L3 >= 0, L1 >= 0, e2 = e3 x e1. With s = sign(I3 - I2):
 *     L = (A1 cn u, s A2 sn u, A3 dn u),  u = lambda t + u0,  modulus m,
 *     q = q_L * X * q_C,  X = exp(k psi/2) P,  P = (1 + m3, m2, -m1, 0)/sqrt(2 (1 + m3)),  (m1, m2, m3) = L/|L|,
 *     exp(i psi/2) = exp(i kappa t) N/|N|,  N = theta4(pi u/2K - i s zeta, nome q^2).
 * P is the smallest rotation that takes L to the third axis, q_C the change to the axes e1, e2, e3, and q_L follows
 * from the initial attitude. For m >= 0.7 Jacobi's imaginary transforms replace the series; they are valid up to m = 1.
 *
 * Sources: Whittaker, Analytical Dynamics, 4th ed., section 69; van Zon & Schofield, J. Comput. Phys. 225 (2007) 145;
 * Carlson, Numer. Algorithms 10 (1995) 13 for R_F. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_FREE_BODY_H
#define SYMROT_FREE_BODY_H

#include "regimes.h"

/* All fields are doubles, so that other languages see one array. */
typedef struct {
    double regime;
    double time_scale;        /* a power of two; times are multiplied by it */
    double axial[4];          /* the phase u/4K; on the separatrix v itself */
    double turning[4];        /* the phase of psi/2 */
    double slope;             /* revolutions of psi/2 per 2K of u, without linear part, in imaginary transforms */
    double stretch;           /* v per 2K of u */
    double series[6][SERIES]; /* numerators of cn, sn, dn; their denominator; N: real, imaginary part */
    double momentum[3];       /* A/|L| */
    double omega[3][3];       /* maps cn, sn, dn to omega in the given axes, rad/s */
    double attitude[4][4];    /* maps X to q */
} free_body;

#endif

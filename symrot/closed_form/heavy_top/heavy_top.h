/*
 * The symmetric heavy top (Lagrange's) at any time, without stepping; spherical and physical pendulums are special
 * cases.
 *
 * A body with moments A, A, C and its centre of mass on its axis e3, held at a point of that axis: V = M cos theta, M > 0,
 * theta from the upward vertical to e3. Divided by A below, so A = 1. With s = 1 - cos theta, l = C omega_3,
 *     (ds/dt)^2 = 2 (E - M + M s) s (2 - s) - (D + l s)^2,  D = L_z - l,
 * has roots S3 <= 0 <= S2 <= s <= S1 <= 2, and s = S1 - (S1 - S2) sn^2 u, u = lambda t + u0. The Cayley-Klein parameters
 *     alpha = q0 + i q3 = cos(theta/2) exp(i (phi + psi)/2) = Ca exp(i ka t) theta1(z + i sa ya)/theta4(z),
 *     beta = q1 + i q2 = sin(theta/2) exp(i (phi - psi)/2) = Cb exp(i kb t) theta2(z + i sb yb)/theta4(z),  z = pi u/2K,
 * have no singularity at the vertical, and omega_1 + i omega_2 = 2 (conj(alpha) beta' - beta conj(alpha')). Numbers
 * that vanish with the distance from the vertical are computed as products of other small numbers, never as
 * differences. For m >= 0.7 Jacobi's imaginary transforms replace the series; they are valid up to m = 1.
 *
 * Sources: Klein & Sommerfeld, Theory of the Top, vol. 2, chapter 6; Whittaker, Analytical Dynamics, section 72.
 * Compile with -ffp-contract=off.
 */
#ifndef SYMROT_HEAVY_TOP_H
#define SYMROT_HEAVY_TOP_H

#include "regimes.h"

/* All fields are doubles, so that other languages see one array. */
typedef struct {
    double regime;
    double time_scale;               /* a power of two; times are multiplied by it */
    double axial[4];                 /* the phase u/4K; on the separatrix v itself */
    double turning[2][4];            /* the phases of ka t and kb t */
    double between[4];               /* the phase of their difference, (kb - ka) t */
    double slope[2];                 /* revolutions per 2K of u in the imaginary transforms */
    double stretch;                  /* v per 2K of u */
    double value[2][2][SERIES];      /* alpha, beta up to a common factor: real, imaginary part */
    double derivative[2][2][SERIES]; /* their rates, with that factor constant */
    double omega[3][3];              /* maps omega_1, omega_2 in rotating axes, and 1, to omega, rad/s */
    double attitude[4][4];           /* maps the parts of alpha, beta to q */
} heavy_top;

#endif

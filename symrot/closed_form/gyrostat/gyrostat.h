/*
 * A symmetric body with a rotor of constant angular momentum h along its axis, free: two steady rotations.
 *
 * With L = (A w1, A w2, C w3 + h), of constant length, omega = L/A + e3 (w3 - (C w3 + h)/A), so
 *     q(t) = exp(n |L| t/2A) q(0) exp(e3 sigma t/2),  n = L in space/|L|,  sigma = w3 - (C w3 + h)/A,
 * and the transverse part of omega rotates at -sigma in the body. Landau & Lifshitz, Mechanics, 3rd ed., section 33,
 * for h = 0. Compile with -ffp-contract=off.
 */
#ifndef SYMROT_GYROSTAT_H
#define SYMROT_GYROSTAT_H

#include "regimes.h"

typedef struct {
    double regime;         /* 0 */
    double time_scale;     /* a power of two; times are multiplied by it */
    double precession[4];  /* the phase |L| t/2A */
    double spin[4];        /* the phase sigma t/2 */
    double omega[3][3];    /* maps cos sigma t, sin sigma t, 1 to omega, rad/s */
    double attitude[4][4]; /* maps the products of cosines and sines of both phases to q */
} gyrostat;

#endif

/*
 * The asymptotic series that spin_up/series.py explains: m and delta as polynomials in y = Y/S^2.
 */
#ifndef SYMROT_SPIN_UP_SERIES_H
#define SYMROT_SPIN_UP_SERIES_H

#include "double_double.h"
#include "spin_up.h"

enum {
    NODES = SPIN_UP_SERIES,
    ORDERS = 14, /* powers of v^2 */
    POWERS = 3*ORDERS + 1,
    FROM_INFINITY = 32 /* terms, powers of kappa^2 v <= 0.2 */
};

/* The nodes: 1/2 - cos(pi (i + 1/2)/NODES)/2. */
static const double PLACES[NODES] = {
    0x1.ddd4cb4cc4b80p-9, 0x1.0a2c6886ff5c8p-5, 0x1.6a876f56cf0b8p-4, 0x1.58f65fb67a0f6p-3,
    0x1.120fcdecc1dc2p-2, 0x1.85786ad0edc8ep-2, 0x1.0000000000001p-1, 0x1.3d43ca97891b7p-1,
    0x1.76f819099f11fp-1, 0x1.a9c26812617c1p-1, 0x1.d2af1215261e9p-1, 0x1.ef5d3977900a3p-1,
    0x1.fe222b34b33b4p-1,
};

/* The polynomial through values at the nodes: divided differences, then powers (Bjorck & Pereyra 1970). */
static void through(const double y[NODES], double values[NODES])
{
    for (int k = 0; k < NODES - 1; ++k)
        for (int i = NODES - 1; i > k; --i)
            values[i] = (values[i] - values[i - 1])/(y[i] - y[i - k - 1]);
    for (int k = NODES - 2; k >= 0; --k)
        for (int i = k; i < NODES - 1; ++i)
            values[i] -= values[i + 1]*y[k];
}

/* A polynomial at all nodes at once; these computations are independent. */
static void polynomial_at(const double *c, int count, const double y[NODES], double values[NODES])
{
    for (int i = 0; i < NODES; ++i)
        values[i] = 0.0;
    for (int n = count - 1; n >= 0; --n)
        for (int i = 0; i < NODES; ++i)
            values[i] = values[i]*y[i] + c[n];
}

/* The coefficients of a by the power of y; share is kappa^2/radius^2 and v is 1/radius^2, for the radius at y = 1. */
static void first_series(double share, double v, double a[POWERS])
{
    double order[POWERS + 1] = {1.0}, next[POWERS + 1];
    for (int j = 0; j < POWERS; ++j)
        a[j] = j == 0;
    for (int n = 0; n < ORDERS; ++n) {
        for (int j = 0; j <= POWERS; ++j)
            next[j] = 0.0;
        for (int j = 2*n + 2; j <= 3*n + 2; ++j) {
            const double gap = (2*j - 1)*(2*j - 3)*v*v*order[j - 2]; /* b_j - a_j */
            next[j] -= gap;
            next[j + 1] += share*(2*j + 1)*gap/(2*j + 2);
        }
        for (int j = 0; j < POWERS; ++j) {
            order[j] = next[j];
            a[j] += next[j];
        }
    }
}

/* delta from the coefficients of h, delta' = kappa^2 v^(5/2) h, at the nodes: from x = 0, or from infinity. */
static void angles(double share, double v, const double h[NODES], const double y[NODES], double values[NODES])
{
    double e[FROM_INFINITY + 1] = {0.0};
    int count = FROM_INFINITY;
    if (share >= 0.2) {
        count = NODES + 2;
        for (int j = NODES; j >= 0; --j)
            e[j] = ((j ? v*h[j - 1] : 0.0) + 2*(j + 1)*e[j + 1]/share)/(1 + 2*j);
    } else
        for (int j = 0; j < FROM_INFINITY - 1; ++j)
            e[j + 1] = share*((1 + 2*j)*e[j] - (j > 0 && j <= NODES ? v*h[j - 1] : 0.0))/(2*j + 2);
    polynomial_at(e, count, y, values);
}

static void asymptotic(double share, double v, spin_up *f)
{
    double a[POWERS], g[POWERS], c[POWERS], h[NODES];
    const double *y = PLACES;
    first_series(share, v, a);
    for (int j = 0; j < POWERS; ++j) {
        c[j] = -(2*j + 1)*a[j];
        g[j] = (2*j + 3)*c[j];
    }
    polynomial_at(g, POWERS, y, f->g);
    polynomial_at(c, POWERS, y, f->c);
    for (int i = 0; i < NODES; ++i) {
        const double square = v*y[i]*v*y[i], part = share*y[i];
        const double first2 = part*(1.0 - part)*square*square*f->g[i]*f->g[i], second2 = part*square*f->c[i]*f->c[i];
        h[i] = -f->c[i]/(1.0 + sqrt(1.0 - first2 - second2));
        f->g[i] *= v*v;
        f->c[i] *= v;
    }
    through(y, h);
    angles(share, v, h, y, f->e);
    through(y, f->g);
    through(y, f->c);
    through(y, f->e);
}

#endif

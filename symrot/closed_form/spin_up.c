/* The attitude near resonance in double-double arithmetic, once for a motion. The formulas: spin_up.h. */
#include "spin_up.h"
#include "double_double.h"

enum { TERMS = 34 }; /* of a series: (r/2)^34/34!/8^34 < 1e-41 for r < 13.5 */

/* The series of q0, q1, q2, q3 about a place from its first terms. */
static void grow(dd kappa, double place, dd q[TERMS][4])
{
    static const dd zero;
    for (int n = 1; n < TERMS; ++n) {
        dd swept[4];
        for (int k = 0; k < 4; ++k)
            swept[k] = dd_add(dd_mul(q[n - 1][k], dd_of(place)), n > 1 ? q[n - 2][k] : zero);
        const dd inverse = dd_div(dd_of(0.5), dd_of(n));
        q[n][0] = dd_mul(inverse, dd_negative(dd_add(swept[3], dd_mul(kappa, q[n - 1][1]))));
        q[n][3] = dd_mul(inverse, dd_sub(swept[0], dd_mul(kappa, q[n - 1][2])));
        q[n][1] = dd_mul(inverse, dd_add(swept[2], dd_mul(kappa, q[n - 1][0])));
        q[n][2] = dd_mul(inverse, dd_sub(dd_mul(kappa, q[n - 1][3]), swept[1]));
    }
}

static void sum(dd q[TERMS][4], dd x, dd total[4])
{
    for (int k = 0; k < 4; ++k) {
        total[k] = q[TERMS - 1][k];
        for (int n = TERMS - 2; n >= 0; --n)
            total[k] = dd_add(dd_mul(total[k], x), q[n][k]);
    }
}

/*
 * Taylor's polynomials of the attitude that is 1 at x = 0, about the middles of pieces from x = 0 on.
 *
 * in   kappa[2]  1  hi, lo
 * in   pieces       how many
 * out  table        20 times 4 numbers of each: by the power of the distance, q0, q1, q2, q3
 * out  middles      8 numbers of each: q0, q1, q2, q3 there, each as hi, lo
 */
void symrot_spin_up_near(const double kappa[2], ptrdiff_t pieces, double *table, double *middles)
{
    const dd k = dd_pair(kappa[0], kappa[1]);
    const double half = 0.5/SPIN_UP_PIECES;
    dd q[TERMS][4] = {{{1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}}, next[4];
    grow(k, 0.0, q);
    sum(q, dd_of(half), next);
    for (ptrdiff_t piece = 0; piece < pieces; ++piece) {
        for (int i = 0; i < 4; ++i)
            q[0][i] = next[i];
        grow(k, (double)(2*piece + 1)*half, q);
        for (int i = 0; i < 4; ++i) {
            middles[8*piece + 2*i] = q[0][i].hi;
            middles[8*piece + 2*i + 1] = q[0][i].lo;
            for (int n = 0; n < SPIN_UP_TAYLOR; ++n)
                table[4*(SPIN_UP_TAYLOR*piece + n) + i] = q[n][i].hi;
        }
        sum(q, dd_of(2.0*half), next);
    }
}

/* The attitude at a distance, hi and lo, from a place where it is known: q0, q1, q2, q3, each as hi, lo, in and out. */
void symrot_spin_up_from(const double kappa[2], double place, const double distance[2], double attitude[8])
{
    dd q[TERMS][4], found[4];
    for (int i = 0; i < 4; ++i)
        q[0][i] = dd_pair(attitude[2*i], attitude[2*i + 1]);
    grow(dd_pair(kappa[0], kappa[1]), place, q);
    sum(q, dd_pair(distance[0], distance[1]), found);
    for (int i = 0; i < 4; ++i) {
        attitude[2*i] = found[i].hi;
        attitude[2*i + 1] = found[i].lo;
    }
}

/* Whether the compiler keeps every rounding. */
int symrot_spin_up_sound(void)
{
    return dd_sound();
}

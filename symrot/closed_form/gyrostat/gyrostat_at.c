/* A gyrostat at any time, from its constants. The formulas are in gyrostat.h. */
#include "gyrostat.h"
#include "stages.h"

typedef struct {
    double t[BLOCK], sine[BLOCK], cosine[BLOCK], precession_sine[BLOCK], precession_cosine[BLOCK];
    double across[3][BLOCK]; /* cosine and sine of the whole angle of spin, 1 */
    double turned[4][BLOCK]; /* products of cosines and sines of both phases */
} block;

STAGE double_angle(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double s = b->sine[i], c = b->cosine[i];
        b->across[0][i] = (c - s)*(c + s);
        b->across[1][i] = 2.0*s*c;
        b->across[2][i] = 1.0;
    }
}

STAGE products(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double s = b->sine[i], c = b->cosine[i], sine = b->precession_sine[i], cosine = b->precession_cosine[i];
        b->turned[0][i] = cosine*c;
        b->turned[1][i] = cosine*s;
        b->turned[2][i] = sine*c;
        b->turned[3][i] = sine*s;
    }
}

static void stages(const gyrostat *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    turn(f->spin, 0.0, n, b->t, b->t, b->sine, b->cosine);
    if (omega != NULL) {
        double_angle(n, b);
        put_omega(f->omega, n, b->across[0], b->across[1], b->across[2], omega);
    }
    if (q != NULL) {
        turn(f->precession, 0.0, n, b->t, b->t, b->precession_sine, b->precession_cosine);
        products(n, b);
        put_quaternion(f->attitude, n, b->turned[0], b->turned[1], b->turned[2], b->turned[3], q);
    }
}

/* The motion at times counted from the initial state; arguments as for symrot_free_body_at. */
void symrot_gyrostat_at(const gyrostat *f, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    block b;
    IN_BLOCKS(b, stages)
}

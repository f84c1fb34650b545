/* A symmetric heavy top at any time, from its constants. The formulas are in heavy_top.h. */
#include "heavy_top.h"
#include "stages.h"

/*
 * alpha = even[0]*P(x) + i odd[0]*Q(x), beta = even[1]*R(x) + i odd[1]*S(x) up to a common factor, with the polynomials
 * of the motion. Arrays of two belong to alpha and to beta.
 */
typedef struct {
    double t[BLOCK], whole[BLOCK], sine[2][BLOCK], cosine[2][BLOCK], between_sine[BLOCK], between_cosine[BLOCK];
    double x[BLOCK], even[2][BLOCK], odd[2][BLOCK];
    double re[2][BLOCK], im[2][BLOCK], inverse_square[BLOCK];
    double across[3][BLOCK]; /* omega_1, omega_2 in rotating axes, 1 */
    double turned[4][BLOCK]; /* alpha, beta */
} block;

/* From sine and cosine of z. */
STAGE circular(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double s = b->sine[0][i], c = b->cosine[0][i];
        b->x[i] = (c - s)*(c + s); /* cos 2z */
        b->even[0][i] = b->odd[1][i] = s;
        b->odd[0][i] = b->even[1][i] = c;
    }
}

/* From v in `x`, and the sign of alpha and beta in even[1]. */
STAGE hyperbolic(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double flip = b->even[1][i], up = exp_moderate(b->x[i]), down = 1.0/up;
        const double c = 0.5*(up + down), s = 0.5*(up - down);
        b->even[0][i] = flip*c;
        b->odd[0][i] = flip*s;
        b->odd[1][i] = flip*(2.0*s*c);    /* sinh 2v */
        b->x[i] = MUL_ADD(s, 2.0*s, 1.0); /* cosh 2v */
    }
}

STAGE values(const heavy_top *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double x = b->x[i];
        const double a0 = b->even[0][i]*cubic(f->value[0][0], x), a1 = b->odd[0][i]*cubic(f->value[0][1], x);
        const double b0 = b->even[1][i]*cubic(f->value[1][0], x), b1 = b->odd[1][i]*cubic(f->value[1][1], x);
        b->re[0][i] = a0;
        b->im[0][i] = a1;
        b->re[1][i] = b0;
        b->im[1][i] = b1;
        b->inverse_square[i] = 1.0/(MUL_ADD(a0, a0, a1*a1) + MUL_ADD(b0, b0, b1*b1));
    }
}

/* Sine and cosine of the angle from one phase to the other. */
STAGE difference(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        b->between_cosine[i] = MUL_ADD(b->cosine[0][i], b->cosine[1][i], b->sine[0][i]*b->sine[1][i]);
        b->between_sine[i] = MUL_ADD(b->cosine[0][i], b->sine[1][i], -b->sine[0][i]*b->cosine[1][i]);
    }
}

/* omega_1 + i omega_2 = 2 (conj(alpha) beta' - beta conj(alpha')), in axes that rotate with the phases. */
STAGE rates(const heavy_top *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double x = b->x[i], a0 = b->re[0][i], a1 = b->im[0][i], b0 = b->re[1][i], b1 = b->im[1][i];
        const double da0 = b->odd[0][i]*cubic(f->derivative[0][0], x), da1 = b->even[0][i]*cubic(f->derivative[0][1], x);
        const double db0 = b->odd[1][i]*cubic(f->derivative[1][0], x), db1 = b->even[1][i]*cubic(f->derivative[1][1], x);
        const double re = MUL_ADD(a0, db0, a1*db1) - MUL_ADD(b0, da0, b1*da1);
        const double im = MUL_ADD(a0, db1, -a1*db0) - MUL_ADD(b1, da0, -b0*da1);
        const double size = 2.0*b->inverse_square[i], c = b->between_cosine[i]*size, s = b->between_sine[i]*size;
        b->across[0][i] = MUL_ADD(re, c, -im*s);
        b->across[1][i] = MUL_ADD(re, s, im*c);
        b->across[2][i] = 1.0;
    }
}

/* alpha and beta, normalised: |alpha|^2 + |beta|^2 = 1. */
STAGE parameters(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double unit = sqrt(b->inverse_square[i]);
        const double a0 = b->re[0][i]*unit, a1 = b->im[0][i]*unit, b0 = b->re[1][i]*unit, b1 = b->im[1][i]*unit;
        b->turned[0][i] = MUL_ADD(a0, b->cosine[0][i], -a1*b->sine[0][i]);
        b->turned[1][i] = MUL_ADD(a0, b->sine[0][i], a1*b->cosine[0][i]);
        b->turned[2][i] = MUL_ADD(b0, b->cosine[1][i], -b1*b->sine[1][i]);
        b->turned[3][i] = MUL_ADD(b0, b->sine[1][i], b1*b->cosine[1][i]);
    }
}

/* Upright or hanging: even[] is 1, and odd[] is any number, since its polynomials are zero. */
STAGE steady(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        b->x[i] = b->odd[0][i] = b->odd[1][i] = 0.0;
        b->even[0][i] = b->even[1][i] = 1.0;
    }
}

static void stages(const heavy_top *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    const double *whole = b->t; /* any array if slopes are zero */
    switch ((int)f->regime) {
    case STEADY:
        steady(n, b);
        break;
    case CIRCULAR:
        turn(f->axial, 0.0, n, b->t, whole, b->sine[0], b->cosine[0]);
        circular(n, b);
        break;
    case HYPERBOLIC:
        argument(f->axial, f->stretch, n, b->t, b->whole, b->even[1], b->x);
        whole = b->whole;
        hyperbolic(n, b);
        break;
    default:
        argument_once(f->axial, n, b->t, b->whole, b->even[1], b->x);
        whole = b->whole;
        hyperbolic(n, b);
    }
    values(f, n, b);
    if (q != NULL) {
        for (int k = 0; k < 2; ++k)
            turn(f->turning[k], f->slope[k], n, b->t, whole, b->sine[k], b->cosine[k]);
        parameters(n, b);
        put_quaternion(f->attitude, n, b->turned[0], b->turned[1], b->turned[2], b->turned[3], q);
    }
    if (omega != NULL) {
        if (q != NULL)
            difference(n, b);
        else
            turn(f->between, f->slope[1] - f->slope[0], n, b->t, whole, b->between_sine, b->between_cosine);
        rates(f, n, b);
        put_omega(f->omega, n, b->across[0], b->across[1], b->across[2], omega);
    }
}

/* The motion at times counted from the initial state; arguments as for symrot_free_body_at. */
void symrot_heavy_top_at(const heavy_top *f, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    block b;
    IN_BLOCKS(b, stages)
}

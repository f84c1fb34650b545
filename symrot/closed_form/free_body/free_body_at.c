/* A free body at any time, from its constants. The formulas are in free_body.h. */
#include "free_body.h"
#include "stages.h"

/* N = even*P(x) + i odd*Q(x), with the polynomials P, Q of the motion. */
typedef struct {
    double t[BLOCK], whole[BLOCK], sine[BLOCK], cosine[BLOCK];
    double cn[BLOCK], sn[BLOCK], dn[BLOCK], x[BLOCK], even[BLOCK], odd[BLOCK], turned[4][BLOCK];
} block;

/* From sine and cosine of z. */
STAGE circular(const free_body *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double s = b->sine[i], c = b->cosine[i], x = (c - s)*(c + s); /* cos 2z */
        const double scale = 1.0/cubic(f->series[3], x);
        b->cn[i] = c*cubic(f->series[0], x)*scale;
        b->sn[i] = s*cubic(f->series[1], x)*scale;
        b->dn[i] = cubic(f->series[2], x)*scale;
        b->x[i] = x;
        b->even[i] = 1.0;
        b->odd[i] = 2.0*s*c;
    }
}

/* From v in `odd`, and the sign of cn and sn in `even`. */
STAGE hyperbolic(const free_body *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double flip = b->even[i], up = exp_moderate(0.5*b->odd[i]), down = 1.0/up;
        const double c = 0.5*(up + down), s = 0.5*(up - down);         /* of v/2 */
        const double x = MUL_ADD(s, 2.0*s, 1.0), s2 = 2.0*s*c;         /* of v */
        const double y = MUL_ADD(s2, 2.0*s2, 1.0);                     /* cosh 2v */
        const double scale = 1.0/(x*cubic(f->series[3], y));
        b->cn[i] = flip*cubic(f->series[0], y)*scale;
        b->sn[i] = flip*s2*cubic(f->series[1], y)*scale;
        b->dn[i] = cubic(f->series[2], y)*scale;
        b->x[i] = x;
        b->even[i] = c;
        b->odd[i] = s;
    }
}

/* X = exp(k psi/2) P, from N and from sine and cosine of the linear part of psi/2. */
STAGE turned(const free_body *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double re = b->even[i]*polynomial(f->series[4], b->x[i]), im = b->odd[i]*polynomial(f->series[5], b->x[i]);
        const double p0 = 1.0 + f->momentum[2]*b->dn[i], p1 = f->momentum[1]*b->sn[i], p2 = -f->momentum[0]*b->cn[i];
        const double size = 1.0/sqrt(2.0*p0*MUL_ADD(re, re, im*im));
        const double c = MUL_ADD(re, b->cosine[i], -im*b->sine[i])*size;
        const double s = MUL_ADD(re, b->sine[i], im*b->cosine[i])*size;
        b->turned[0][i] = c*p0;
        b->turned[1][i] = MUL_ADD(c, p1, -s*p2);
        b->turned[2][i] = MUL_ADD(c, p2, s*p1);
        b->turned[3][i] = s*p0;
    }
}

STAGE steady_omega(const free_body *restrict f, ptrdiff_t n, double *restrict omega)
{
    EACH (i, n) {
        omega[3*i] = f->omega[0][0];
        omega[3*i + 1] = f->omega[1][0];
        omega[3*i + 2] = f->omega[2][0];
    }
}

/* X of a steady rotation, of which the map uses two components. */
STAGE steady_turned(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        b->turned[0][i] = b->cosine[i];
        b->turned[1][i] = b->sine[i];
        b->turned[2][i] = b->turned[3][i] = 0.0;
    }
}

static void put_attitude(const free_body *f, ptrdiff_t n, const block *b, double *q)
{
    put_quaternion(f->attitude, n, b->turned[0], b->turned[1], b->turned[2], b->turned[3], q);
}

static void elliptic(const free_body *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    const double *whole = b->whole;
    if (f->regime == CIRCULAR) {
        whole = b->t; /* any array, since the slope is zero */
        turn(f->axial, 0.0, n, b->t, whole, b->sine, b->cosine);
        circular(f, n, b);
    } else {
        if (f->regime == HYPERBOLIC)
            argument(f->axial, f->stretch, n, b->t, b->whole, b->even, b->odd);
        else
            argument_once(f->axial, n, b->t, b->whole, b->even, b->odd);
        hyperbolic(f, n, b);
    }
    if (omega != NULL)
        put_omega(f->omega, n, b->cn, b->sn, b->dn, omega);
    if (q != NULL) {
        turn(f->turning, f->slope, n, b->t, whole, b->sine, b->cosine);
        turned(f, n, b);
        put_attitude(f, n, b, q);
    }
}

static void steady(const free_body *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    if (omega != NULL)
        steady_omega(f, n, omega);
    if (q != NULL) {
        turn(f->turning, 0.0, n, b->t, b->t, b->sine, b->cosine);
        steady_turned(n, b);
        put_attitude(f, n, b, q);
    }
}

/*
 * The motion at times counted from the initial state, in any order; they may be negative.
 *
 * in   times[count]        s
 * out  omega[3 count]      rad/s, along the principal axes; NULL if not requested
 * out  quaternion[4 count] body to space, scalar first, of unit norm and continuous in time; NULL if not requested
 */
void symrot_free_body_at(
    const free_body *f, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    block b;
    if (f->regime == STEADY) {
        IN_BLOCKS(b, steady)
    } else {
        IN_BLOCKS(b, elliptic)
    }
}

/* The nutation of a symmetric heavy top, from the roots of its cubic, to 31 digits. The formulas are in heavy_top.h. */
#ifndef SYMROT_NUTATION_H
#define SYMROT_NUTATION_H

#include "double_double.h"

/* The nutation to 31 digits. Gaps are differences of roots; `low` = 2 - S1, `below` = -S3. */
typedef struct {
    dd s, c, pull, spin, axial_rate, d, sigma, speed; /* s0, 2 - s0, M, l, omega_3, D, D + 2 l, ds/dt */
    dd s1, s2, below, low;                            /* S1, S2, -S3, 2 - S1 */
    dd gap12, gap23, gap13, modulus, complement, rate, u;
    dd ya, yb; /* zeros of theta1 and theta2 */
    double doubt; /* estimate of the relative error of S2 - S3, where it is a difference of larger numbers */
} nutation;

/* Relative error of a sum or product of a few numbers. */
#define ROUNDING 0x1p-103

static double outer_root(double b, double c, double d, double x)
{
    for (int n = 0; n < 200; ++n) {
        const double slope = (3.0*x + 2.0*b)*x + c;
        if (slope == 0.0)
            break;
        const double next = x - (((x + b)*x + c)*x + d)/slope;
        if (fabs(next - x) <= 1e-15*fabs(next))
            return next;
        x = next;
    }
    return x;
}

/* A simple root near x of x^3 + b x^2 + c x + d. */
static dd polished(dd b, dd c, dd d, double x)
{
    dd root = dd_of(x);
    for (int n = 0; n < 4; ++n) {
        const dd value = dd_add(dd_mul(dd_add(dd_mul(dd_add(root, b), root), c), root), d);
        const dd slope = dd_add(dd_mul(dd_add(dd_add(dd_scale(root, 2.0), root), dd_scale(b, 2.0)), root), c);
        if (slope.hi == 0.0)
            break;
        const dd change = dd_div(value, slope);
        root = dd_sub(root, change);
        if (fabs(change.hi) <= 0x1p-80*fabs(root.hi)) /* the next change would be about the square of this one */
            break;
    }
    return root;
}

static dd ratio(dd a, dd b)
{
    return b.hi != 0.0 ? dd_div(a, b) : dd_of(0.0);
}

/* From s0, its rate and omega to the roots. w2 = omega_1^2 + omega_2^2, y = D + l s0. */
static void find_roots(nutation *n, dd w2, dd y)
{
    const dd m2 = dd_scale(n->pull, 2.0), one_less = dd_scale(dd_sub(n->c, n->s), 0.5);
    /* x^3 + b x^2 + c x + d for x = s - s0; d <= 0 */
    const dd b = dd_div(dd_sub(dd_add(w2, dd_square(n->spin)), dd_mul(dd_scale(m2, 2.0), one_less)), m2);
    const dd fallen = dd_mul(m2, dd_mul(n->s, n->c)), turning = dd_scale(dd_mul(w2, one_less), 2.0);
    const dd carried = dd_scale(dd_mul(n->spin, y), 2.0);
    const dd c = dd_div(dd_sub(carried, dd_add(fallen, turning)), m2);
    /* sums of the absolute values of the summands of b and c, to which rounding errors are proportional */
    const double b_size = (w2.hi + n->spin.hi*n->spin.hi)/m2.hi + 2.0*fabs(one_less.hi);
    const double c_size = (fallen.hi + fabs(turning.hi) + fabs(carried.hi))/m2.hi;
    const dd size = dd_div(dd_square(n->speed), m2), d = dd_negative(size);
    const double far = fmax(fabs(b.hi), fmax(sqrt(fabs(c.hi)), cbrt(fabs(d.hi))));
    double first = d.hi == 0.0 && c.hi >= 0.0 ? 0.0 : outer_root(b.hi, c.hi, d.hi, n->c.hi*1.0000001 + 1e-300);
    double last = outer_root(b.hi, c.hi, d.hi, -2.0*far);
    first = first < 0.0 ? 0.0 : first;
    const double between = -b.hi - first - last;
    dd x1, x2, x3;
    n->doubt = 0.0;
    if (first - between >= between - last) {
        x1 = first > 0.0 ? polished(b, c, d, first) : dd_of(0.0);
        n->s1 = dd_add(n->s, x1);
        const dd p = dd_div(dd_square(n->d), dd_mul(m2, n->s1)); /* -S2 S3 */
        const dd em2 = dd_sub(w2, dd_mul(m2, n->s));             /* 2 (E - M) */
        const dd sum = dd_div(dd_add(dd_div(dd_sub(dd_mul(n->d, n->spin), em2), n->pull), p), n->s1); /* S2 + S3 */
        const dd square23 = dd_add(dd_square(sum), dd_scale(p, 4.0));
        n->gap23 = dd_sqrt(square23);
        if (square23.hi > 0.0) {
            const double momentum = sqrt(w2.hi*n->s.hi*n->c.hi) + fabs(n->spin.hi)*n->s.hi, slip = ROUNDING*momentum;
            const double p_error = (2.0*fabs(n->d.hi)*slip + slip*slip)/(m2.hi*n->s1.hi) + ROUNDING*p.hi;
            const double e_error = ROUNDING*(w2.hi + m2.hi*n->s.hi) + fabs(n->spin.hi)*slip;
            const double sum_error = (e_error/n->pull.hi + p_error)/n->s1.hi;
            n->doubt = (2.0*fabs(sum.hi)*sum_error + sum_error*sum_error + 4.0*p_error)/square23.hi;
        }
        const dd larger = dd_scale(dd_add(n->gap23, dd_abs(sum)), 0.5);
        n->s2 = sum.hi >= 0.0 ? larger : ratio(p, larger);
        n->below = sum.hi >= 0.0 ? ratio(p, larger) : larger;
        x3 = dd_negative(dd_add(n->below, n->s));
        x2 = dd_sub(n->s2, n->s);
        if (x1.hi > -x2.hi)
            x2 = ratio(size, dd_mul(x1, x3));
        n->gap12 = dd_sub(x1, x2);
    } else {
        x3 = polished(b, c, d, last);
        const dd product = dd_div(size, x3); /* x1 x2 <= 0 */
        /* x1 + x2; b and x3 would cancel under a weak pull, and where both roots are close to s0, as near the vertical */
        const int from_c = c_size + fabs(product.hi) < (b_size - x3.hi)*-x3.hi;
        const dd sum = from_c ? dd_div(dd_sub(c, product), x3) : dd_negative(dd_add(b, x3));
        n->gap12 = dd_sqrt(dd_sub(dd_square(sum), dd_scale(product, 4.0)));
        const dd larger = dd_scale(dd_add(n->gap12, dd_abs(sum)), 0.5);
        x1 = sum.hi >= 0.0 ? larger : dd_negative(ratio(product, larger));
        x2 = sum.hi >= 0.0 ? ratio(product, larger) : dd_negative(larger);
        n->s1 = dd_add(n->s, x1);
        n->s2 = dd_add(n->s, x2);
        n->below = dd_negative(dd_add(n->s, x3));
        const dd p = dd_div(dd_square(n->d), dd_mul(m2, n->s1));
        if (dd_less(n->below, n->s2))
            n->below = dd_div(p, n->s2);
        else
            n->s2 = dd_div(p, n->below);
        n->gap23 = dd_sub(x2, x3);
    }
    n->gap13 = dd_sub(x1, x3);
    n->modulus = dd_div(n->gap12, n->gap13);
    n->complement = dd_div(n->gap23, n->gap13);
    n->rate = dd_sqrt(dd_scale(dd_mul(n->pull, n->gap13), 0.5));
    const dd high = dd_sub(n->c, x2), higher = dd_sub(n->c, x3); /* 2 - S2, 2 - S3 */
    n->low = dd_div(dd_square(n->sigma), dd_mul(m2, dd_mul(high, higher)));
    n->u = n->ya = n->yb = dd_of(0.0);
    if (n->gap12.hi == 0.0)
        return;
    const dd one = dd_of(1.0);
    const dd sine = dd_sqrt(dd_div(x1, n->gap12)), delta = dd_negative(dd_div(x3, n->gap13));
    n->u = dd_mul(sine, dd_rf(dd_negative(dd_div(x2, n->gap12)), delta, one));
    if (n->speed.hi > 0.0)
        n->u = dd_negative(n->u);
    const dd sine_a = dd_div(n->low, high), cosine_a = dd_div(n->gap12, high);
    n->ya = dd_mul(dd_sqrt(sine_a), dd_rf(cosine_a, dd_add(cosine_a, dd_mul(n->modulus, sine_a)), one));
    if (n->gap23.hi > 0.0) {
        const dd base = dd_mul(n->s1, n->gap23);
        const dd sine_b = dd_div(dd_mul(n->s2, n->gap13), base), cosine_b = dd_div(dd_mul(n->below, n->gap12), base);
        n->yb = dd_mul(dd_sqrt(sine_b), dd_rf(cosine_b, dd_div(n->gap12, n->s1), one));
    }
}

#endif

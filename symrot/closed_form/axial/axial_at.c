/* Rotation about one axis at any time, from its constants. The formulas are in axial.h. */
#include "axial.h"
#include "double_double.h"
#include "stages.h"

/* exp(x) = power (1 + small), power = 2^n, small from r = x - n ln 2 as hi, lo, |r| <= ln(2)/2; near if n = 0. */
typedef struct {
    double t[BLOCK], power[BLOCK], r[BLOCK], r_low[BLOCK], second[BLOCK], second_low[BLOCK];
    double sine[BLOCK], cosine[BLOCK], rate[BLOCK], none[BLOCK], known[BLOCK];
    int64_t lost; /* not 0 if a sample cannot be computed */
} block;

/* With an error of 2^-102; hi and lo overlap by a few bits, which the functions below allow. */
ALWAYS_INLINE dd multiplied(dd a, dd b)
{
    const double p = a.hi*b.hi;
    return dd_pair(p, MUL_ADD(a.hi, b.lo, MUL_ADD(a.lo, b.hi, product_error(a.hi, b.hi, p))));
}

/* Split x = slowing*t into a multiple of ln 2 and a rest. exp(x) is zero if it is below the smallest double. */
STAGE reduced(const double slowing[2], ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double t = b->t[i], product = t*slowing[0];
        const double error = product_error(t, slowing[0], product) + t*slowing[1];
        const double x = product < -708.0 ? -708.0 : product, low = product < -708.0 ? 0.0 : error;
        const double octaves = rint(x*0x1.71547652b82fep+0);
        const double first = x - octaves*0x1.62e42fefa38p-1; /* exact: ln 2 is split into parts of 42 bits */
        const dd rest = two_sum(first, -octaves*0x1.ef35793c76p-45);
        const dd r = quick_two_sum(rest.hi, rest.lo + (low - octaves*0x1.cc01f97b57a08p-87));
        union {
            double number;
            uint64_t bits;
        } power;
        power.number = octaves + (0x1.8p+52 + 1023.0); /* the exponent of 2^n in the lowest bits */
        power.bits <<= 52;
        b->power[i] = product < -708.0 ? 0.0 : power.number;
        b->r[i] = r.hi;
        b->r_low[i] = r.lo;
    }
}

/* The terms of (exp(r) - 1 - r)/r^2 from the 9th on, divided by r^9: below 2^-38 of the sum. */
ALWAYS_INLINE double last_terms(double r)
{
    double sum = DD_INVERSE_FACTORIALS[22].hi;
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[21].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[20].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[19].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[18].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[17].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[16].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[15].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[14].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[13].hi);
    sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[12].hi);
    return MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[11].hi);
}

/* sum*r + 1/n!, where the coefficient is the larger summand. */
ALWAYS_INLINE dd next_term(dd sum, dd r, int n)
{
    const dd c = DD_INVERSE_FACTORIALS[n];
    const double product = sum.hi*r.hi;
    const double lost = MUL_ADD(sum.hi, r.lo, MUL_ADD(sum.lo, r.hi, product_error(sum.hi, r.hi, product) + c.lo));
    const double total = c.hi + product;
    return dd_pair(total, lost + (product - (total - c.hi)));
}

/* E2(r), with an error of 2^-91. */
STAGE second(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const dd r = dd_pair(b->r[i], b->r_low[i]);
        dd sum = dd_pair(last_terms(r.hi), 0.0);
        sum = next_term(sum, r, 10);
        sum = next_term(sum, r, 9);
        sum = next_term(sum, r, 8);
        sum = next_term(sum, r, 7);
        sum = next_term(sum, r, 6);
        sum = next_term(sum, r, 5);
        sum = next_term(sum, r, 4);
        sum = next_term(sum, r, 3);
        sum = next_term(sum, r, 2);
        b->second[i] = sum.hi;
        b->second_low[i] = sum.lo;
    }
}

/* E2(r) in doubles. */
STAGE second_in_doubles(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double r = b->r[i];
        double sum = DD_INVERSE_FACTORIALS[14].hi;
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[13].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[12].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[11].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[10].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[9].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[8].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[7].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[6].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[5].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[4].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[3].hi);
        sum = MUL_ADD(sum, r, DD_INVERSE_FACTORIALS[2].hi);
        b->second[i] = sum;
    }
}

/* exp(x) from E2(r). */
ALWAYS_INLINE double exponential(const block *b, ptrdiff_t i)
{
    const double r = b->r[i], small = r + MUL_ADD(r*r, b->second[i], b->r_low[i]);
    return MUL_ADD(b->power[i], small, b->power[i]);
}

/* Near the start, the change of the rate is smaller than the final rate and the distance from it: use the change. */
STAGE damped_rate(const double axial[4], ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double r = b->r[i], power = b->power[i], small = r + MUL_ADD(r*r, b->second[i], b->r_low[i]);
        const double mean = MUL_ADD(r, b->second[i], 1.0); /* (exp(x) - 1)/x where x is r */
        const double near = MUL_ADD(axial[1]*b->t[i], mean, axial[0]);
        const double middle = MUL_ADD(axial[3], MUL_ADD(power, small, power - 1.0), axial[0]);
        const double far = MUL_ADD(axial[3], MUL_ADD(power, small, power), axial[2]);
        const double moved = fabs(MUL_ADD(power, -4.0, 5.0)) <= 3.0 ? middle : far; /* power 1/2, 1, 2 */
        b->rate[i] = power == 1.0 ? near : moved;
    }
}

STAGE plain_rate(const double axial[4], ptrdiff_t n, block *restrict b)
{
    EACH (i, n)
        b->rate[i] = MUL_ADD(axial[1], b->t[i], axial[0]);
}

/* x without whole revolutions. */
ALWAYS_INLINE double part(double x)
{
    return x - rint(x);
}

/* 1 if |x| <= limit, else 0, also for NaN. */
ALWAYS_INLINE double within(double x, double limit)
{
    return fabs(x) <= limit ? 1.0 : 0.0;
}

/* Sine and cosine of a sum of parts of a revolution and a small angle; NaN if the angle is not known. */
ALWAYS_INLINE void put_circle(double sum, double small, double known, double *sine, double *cosine)
{
    const double turns = part(sum), quarters = rint(4.0*(turns + small));
    const double rest = (turns - 0.25*quarters) + small;
    sincos_quarters(known == 1.0 ? rest : NAN, quarters, sine, cosine);
}

/* The angle under damping. */
STAGE damped_angle(const turning *restrict a, ptrdiff_t n, block *restrict b)
{
    const double rate[3] = {a->rate[0], a->rate[1], a->rate[2]}, final[3] = {a->final[0], a->final[1], a->final[2]};
    const dd gain = dd_pair(a->gain[0], a->gain[1]), rest = dd_pair(a->rest[0], a->rest[1]);
    const double left_out = a->less[0], left_out_low = a->less[1];
    EACH (i, n) {
        const double t = b->t[i], power = b->power[i];
        const int near = power == 1.0;
        const dd r = dd_pair(b->r[i], b->r_low[i]), e2 = dd_pair(b->second[i], b->second_low[i]);
        const dd square = multiplied(multiplied(r, r), e2);
        const dd grown = quick_two_sum(1.0, r.hi), all = quick_two_sum(grown.hi, square.hi); /* exp(r) */
        const double low = (grown.lo + all.lo) + (r.lo + square.lo);
        const dd pushed = multiplied(gain, two_product(t, t));
        const dd factor = dd_pair(near ? pushed.hi : rest.hi, near ? pushed.lo : rest.lo);
        const dd left = multiplied(factor, dd_pair(near ? e2.hi : power*all.hi, near ? e2.lo : power*low));
        const double less = near ? 0.0 : left_out, less_low = near ? 0.0 : left_out_low;
        const double v0 = near ? rate[0] : final[0], v1 = near ? rate[1] : final[1], v2 = near ? rate[2] : final[2];
        const double even = t*v0, finer = t*v1;
        const dd first = two_sum(part(even), part(left.hi));
        const dd next = two_sum(part(product_error(t, v0, even)), part(finer));
        const dd last = two_sum(next.hi, less), sum = two_sum(first.hi, last.hi);
        const double rounded = (first.lo + next.lo) + (last.lo + sum.lo);
        const double more = rounded + (left.lo + (less_low + (product_error(t, v1, finer) + t*v2)));
        const double known = within(left.hi, AXIAL_TURNS)*within(even, AXIAL_EVENLY);
        b->known[i] = known;
        put_circle(sum.hi, more, known, &b->sine[i], &b->cosine[i]);
    }
}

/* The angle without damping, rate*t + gain*t^2; the square of time is exactly a pair of doubles. */
STAGE plain_angle(const turning *restrict a, ptrdiff_t n, block *restrict b)
{
    const double v0 = a->rate[0], v1 = a->rate[1], v2 = a->rate[2];
    const double g0 = a->gain[0], g1 = a->gain[1], g2 = a->gain[2], g3 = a->gain[3];
    EACH (i, n) {
        const double t = b->t[i];
        const dd square = two_product(t, t);
        const double even = t*v0, finer = t*v1;
        const double p0 = square.hi*g0, p1 = square.hi*g1, p2 = square.hi*g2, s0 = square.lo*g0, s1 = square.lo*g1;
        const double e0 = product_error(square.hi, g0, p0), e1 = product_error(square.hi, g1, p1);
        const double f0 = product_error(square.lo, g0, s0);
        const dd a0 = two_sum(part(even), part(p0)), a1 = two_sum(part(product_error(t, v0, even)), part(finer));
        const dd a2 = two_sum(part(e0), part(p1)), a3 = two_sum(part(s0), part(e1)), a4 = two_sum(part(f0), part(p2));
        const dd c0 = two_sum(a0.hi, a1.hi), c1 = two_sum(a2.hi, a3.hi), c2 = two_sum(a4.hi, part(s1));
        const dd d0 = two_sum(c0.hi, c1.hi), sum = two_sum(d0.hi, c2.hi);
        const double rounded = ((a0.lo + a1.lo) + (a2.lo + a3.lo)) + (a4.lo + ((c0.lo + c1.lo) + (c2.lo + d0.lo)));
        const double tails = (product_error(t, v1, finer) + t*v2) + (product_error(square.hi, g2, p2)
            + (product_error(square.lo, g1, s1) + MUL_ADD(square.hi, g3, square.lo*g2)));
        const double known = within(even, AXIAL_EVENLY)*within(p0, AXIAL_EVENLY);
        b->known[i] = known;
        put_circle(sum.hi, sum.lo + (rounded + tails), known, &b->sine[i], &b->cosine[i]);
    }
}

/* Whether a sample could not be computed. */
STAGE take_loss(ptrdiff_t n, block *restrict b)
{
    int64_t any = 0;
    EACH (i, n)
        any |= b->known[i] == 1.0 ? (int64_t)0 : (int64_t)1;
    b->lost |= any;
}

/* The damped transverse angular velocity times sine and cosine of its lag. */
STAGE shrunk(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double left = exponential(b, i);
        b->sine[i] *= left;
        b->cosine[i] *= left;
    }
}

STAGE nothing(ptrdiff_t n, block *restrict b)
{
    EACH (i, n)
        b->none[i] = 0.0;
}

static void stages(const axial *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    const int damped = f->regime == DAMPED, across = f->across != 0.0;
    nothing(n, b);
    if (damped) {
        reduced(f->slowing, n, b);
        (q != NULL || across ? second : second_in_doubles)(n, b);
    }
    if (q != NULL) {
        (damped ? damped_angle : plain_angle)(&f->half, n, b);
        take_loss(n, b);
        put_quaternion(f->attitude, n, b->cosine, b->sine, b->none, b->none, q);
    }
    if (omega == NULL)
        return;
    (damped ? damped_rate : plain_rate)(f->axial, n, b);
    if (across) {
        (damped ? damped_angle : plain_angle)(&f->lag, n, b);
        take_loss(n, b);
        reduced(f->slowing_across, n, b);
        second_in_doubles(n, b);
        shrunk(n, b);
        put_omega(f->omega, n, b->cosine, b->sine, b->rate, omega);
    } else
        put_omega(f->omega, n, b->none, b->none, b->rate, omega);
}

/*
 * The motion at times counted from the initial state; arguments as for symrot_free_body_at.
 *
 * Returns 0; 1 if some samples have too many revolutions for pairs of doubles, and are NaN; 2, with nothing written, if
 * a time lies before `first`.
 */
int symrot_axial_at(const axial *f, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    block b;
    int64_t early = 0;
    for (ptrdiff_t i = 0; i < count; ++i)
        early |= times[i] < f->first ? 1 : 0;
    if (early)
        return 2;
    b.lost = 0;
    IN_BLOCKS(b, stages)
    return (int)b.lost;
}

/* Whether the compiled code rounds every operation separately. */
int symrot_axial_sound(void)
{
    return dd_sound();
}

/* The length of the constants in doubles. */
ptrdiff_t symrot_axial_length(void)
{
    return (ptrdiff_t)(sizeof(axial)/sizeof(double));
}

/*
 * Arithmetic to about 31 digits: a number is the unevaluated sum of two doubles, |lo| <= ulp(hi)/2.
 *
 * Every operation rests on error-free transformations (Dekker 1971; Ogita, Rump & Oishi 2005). They hold only if the
 * compiler rounds every operation separately: compile with -ffp-contract=off, never with -ffast-math. `dd_sound` tests
 * the compiled code for it. Relative errors, in u^2 = 2^-106 = 1.2e-32: + - below 3.1, * below 5.1, / below 13, sqrt
 * below 3.2 (Joldes, Muller & Popescu, ACM Trans. Math. Softw. 44 (2017) 15; Muller & Rideau, 48 (2022) 9; Lefevre,
 * Louvet, Muller, Picot & Rideau, 49 (2023) 1); as measured, exp(a) below 8 + 2 |a|, the mean and R_F below 16, sine
 * and cosine below 8 of the largest value. Every processor returns the same bits, with or without a fused instruction.
 * No overflow or underflow is handled: scale by powers of two first.
 */
#ifndef SYMROT_DOUBLE_DOUBLE_H
#define SYMROT_DOUBLE_DOUBLE_H

#include "error_free.h"

/* Long functions that the constants use often: not inlined, because compilation would take several times as long. */
#if defined(__GNUC__)
#define ONE_COPY static __attribute__((noinline, unused))
#else
#define ONE_COPY static
#endif

#define DD_PI {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53}
#define DD_LN2 {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56}

static inline dd dd_of(double x)
{
    const dd r = {x, 0.0};
    return r;
}

static inline dd dd_add(dd a, dd b)
{
    dd s = two_sum(a.hi, b.hi);
    const dd t = two_sum(a.lo, b.lo);
    s = quick_two_sum(s.hi, s.lo + t.hi);
    return quick_two_sum(s.hi, s.lo + t.lo);
}

static inline dd dd_sub(dd a, dd b)
{
    return dd_add(a, dd_negative(b));
}

static inline dd dd_mul(dd a, dd b)
{
    const dd p = two_product(a.hi, b.hi);
    return quick_two_sum(p.hi, p.lo + (a.hi*b.lo + a.lo*b.hi));
}

static inline dd dd_square(dd a)
{
    return dd_mul(a, a);
}

/* a times a power of two. */
static inline dd dd_scale(dd a, double power)
{
    return dd_pair(a.hi*power, a.lo*power);
}

ONE_COPY dd dd_div(dd a, dd b)
{
    const double first = a.hi/b.hi;
    const dd back = two_product(first, b.hi);
    const double rest = ((a.hi - back.hi) - back.lo) + (a.lo - first*b.lo); /* the first two differences are exact */
    return quick_two_sum(first, rest/b.hi);
}

/* The square root of a positive number. */
ALWAYS_INLINE dd dd_root(dd a)
{
    const double root = sqrt(a.hi);
    const dd square = two_product(root, root);
    const double rest = ((a.hi - square.hi) - square.lo) + a.lo; /* the first two differences are exact */
    return quick_two_sum(root, rest/(2.0*root));
}

/* The square root; zero for arguments that are not positive. */
ONE_COPY dd dd_sqrt(dd a)
{
    return a.hi > 0.0 ? dd_root(a) : dd_of(0.0);
}

static inline dd dd_abs(dd a)
{
    return a.hi < 0.0 ? dd_negative(a) : a;
}

static inline int dd_less(dd a, dd b)
{
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}

static const dd DD_INVERSE_FACTORIALS[] = {
    {0x1.0000000000000p+0, 0x0.0p+0}, /* 1/0! */
    {0x1.0000000000000p+0, 0x0.0p+0}, /* 1/1! */
    {0x1.0000000000000p-1, 0x0.0p+0}, /* 1/2! */
    {0x1.5555555555555p-3, 0x1.5555555555555p-57}, /* 1/3! */
    {0x1.5555555555555p-5, 0x1.5555555555555p-59}, /* 1/4! */
    {0x1.1111111111111p-7, 0x1.1111111111111p-63}, /* 1/5! */
    {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65}, /* 1/6! */
    {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73}, /* 1/7! */
    {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76}, /* 1/8! */
    {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73}, /* 1/9! */
    {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76}, /* 1/10! */
    {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80}, /* 1/11! */
    {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83}, /* 1/12! */
    {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87}, /* 1/13! */
    {0x1.93974a8c07c9dp-37, 0x1.05d6f8a2efd1fp-92}, /* 1/14! */
    {0x1.ae7f3e733b81fp-41, 0x1.1d8656b0ee8cbp-97}, /* 1/15! */
    {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101}, /* 1/16! */
    {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103}, /* 1/17! */
    {0x1.6827863b97d97p-53, 0x1.eec01221a8b0bp-107}, /* 1/18! */
    {0x1.2f49b46814157p-57, 0x1.2650f61dbdcb4p-112}, /* 1/19! */
    {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120}, /* 1/20! */
    {0x1.71b8ef6dcf572p-66, -0x1.d043ae40c4647p-120}, /* 1/21! */
    {0x1.0ce396db7f853p-70, -0x1.aebcdbd20331cp-124}, /* 1/22! */
    {0x1.761b41316381ap-75, -0x1.3423c7d91404fp-130}, /* 1/23! */
    {0x1.f2cf01972f578p-80, -0x1.9ada5fcc1ab14p-135}, /* 1/24! */
    {0x1.3f3ccdd165fa9p-84, -0x1.58ddadf344487p-139}, /* 1/25! */
    {0x1.88e85fc6a4e5ap-89, -0x1.71c37ebd16540p-143}, /* 1/26! */
    {0x1.d1ab1c2dccea3p-94, 0x1.054d0c78aea14p-149}, /* 1/27! */
};

/* exp(a) as 2^k times the 64th power of exp(rest), rest = (a - k ln 2)/64; 0 below the smallest double. */
ONE_COPY dd dd_exp(dd a)
{
    static const dd ln2 = DD_LN2;
    if (a.hi < -745.0)
        return dd_of(0.0);
    const double k = rint(a.hi/ln2.hi);
    const dd rest = dd_scale(dd_sub(a, dd_mul(dd_of(k), ln2)), 0x1p-6); /* at most 0.0055 */
    double tail = DD_INVERSE_FACTORIALS[12].hi; /* below 1e-17 of the sum: one double each */
    for (int n = 11; n >= 7; --n)
        tail = tail*rest.hi + DD_INVERSE_FACTORIALS[n].hi;
    dd sum = dd_of(tail);
    for (int n = 6; n >= 1; --n)
        sum = dd_add(dd_mul(sum, rest), DD_INVERSE_FACTORIALS[n]);
    sum = dd_mul(sum, rest); /* exp(rest) - 1, then repeatedly squared without cancellation */
    for (int n = 0; n < 6; ++n)
        sum = dd_add(dd_scale(sum, 2.0), dd_square(sum));
    sum = dd_add(sum, dd_of(1.0));
    return dd_pair(ldexp(sum.hi, (int)k), ldexp(sum.lo, (int)k));
}

/* Sine and cosine of an angle in revolutions. */
ONE_COPY void dd_sincos_turns(dd turns, dd *sine, dd *cosine)
{
    static const dd pi = DD_PI;
    dd rest = dd_sub(turns, dd_of(rint(turns.hi)));
    const double quarter = rint(4.0*rest.hi);
    rest = dd_scale(dd_mul(dd_sub(rest, dd_of(0.25*quarter)), pi), 2.0); /* at most pi/4 */
    const dd square = dd_square(rest);
    double s_tail = DD_INVERSE_FACTORIALS[27].hi, c_tail = DD_INVERSE_FACTORIALS[26].hi;
    for (int n = 25; n >= 19; n -= 2) { /* from 17! and 18! on below 1e-16 of the sums: one double each */
        s_tail = DD_INVERSE_FACTORIALS[n].hi - s_tail*square.hi;
        c_tail = DD_INVERSE_FACTORIALS[n - 1].hi - c_tail*square.hi;
    }
    s_tail = DD_INVERSE_FACTORIALS[17].hi - s_tail*square.hi;
    dd s = dd_of(s_tail), c = dd_sub(DD_INVERSE_FACTORIALS[16], dd_mul(dd_of(c_tail), square));
    for (int n = 15; n >= 1; n -= 2) {
        s = dd_sub(DD_INVERSE_FACTORIALS[n], dd_mul(s, square));
        c = dd_sub(DD_INVERSE_FACTORIALS[n - 1], dd_mul(c, square));
    }
    s = dd_mul(s, rest);
    switch ((int)quarter & 3) {
    case 0: *sine = s; *cosine = c; break;
    case 1: *sine = c; *cosine = dd_negative(s); break;
    case 2: *sine = dd_negative(s); *cosine = dd_negative(c); break;
    default: *sine = dd_negative(c); *cosine = s; break;
    }
}

/*
 * The arithmetic-geometric mean of 1 and a, 0 < a <= 1: steps until the two agree to 1e-4, then, with h = gap/(2 mean),
 * mean/F(1/2, 1/2; 1; h^2) = mean (1 - h^2/4 - 5 h^4/64 - 11 h^6/256 - ...); omitted terms are below 1e-35.
 */
ONE_COPY dd dd_agm(dd a)
{
    dd arithmetic = dd_of(1.0), geometric = a;
    for (int n = 0; n < 64; ++n) {
        const dd gap = dd_sub(arithmetic, geometric);
        const dd mean = dd_scale(dd_add(arithmetic, geometric), 0.5);
        if (fabs(gap.hi) <= 1e-4*mean.hi) {
            const double h = 0.5*gap.hi/mean.hi, h2 = h*h;
            const dd square = dd_scale(dd_div(dd_square(gap), mean), 0.0625);
            return dd_sub(mean, dd_add(square, dd_of(mean.hi*h2*h2*(5.0/64.0 + 11.0/256.0*h2))));
        }
        geometric = dd_sqrt(dd_mul(arithmetic, geometric));
        arithmetic = mean;
    }
    return arithmetic;
}

/*
 * Carlson's R_F(x, y, z) for arguments >= 0, at most one of them zero: duplication until they agree to 1/400, then the
 * series to the eleventh order; omitted terms are below 1e-33 (Carlson 1995; DLMF 19.19.7, 19.36.1).
 */
ONE_COPY dd dd_rf(dd x, dd y, dd z)
{
    for (int n = 0; n < 200; ++n) {
        const double near = (x.hi + y.hi + z.hi)/3.0, limit = near/400.0;
        if (fabs(x.hi - near) <= limit && fabs(y.hi - near) <= limit && fabs(z.hi - near) <= limit) {
            const dd mean = dd_div(dd_add(dd_add(x, y), z), dd_of(3.0));
            const dd dx = dd_div(dd_sub(mean, x), mean), dy = dd_div(dd_sub(mean, y), mean);
            const dd dz = dd_negative(dd_add(dx, dy));
            const dd e2 = dd_sub(dd_mul(dx, dy), dd_square(dz)), e3 = dd_mul(dd_mul(dx, dy), dz);
            const double p = e2.hi, q = e3.hi; /* from the sixth order on below 1e-17: one double each */
            const double pure = p*(-5.0/208.0 + p*(35.0/2176.0 - p*(3.0/256.0)));
            const double once = q*(1.0/16.0 + p*(-35.0/608.0 + p*(315.0/5888.0)));
            const double twice = 3.0/104.0 + p*(-15.0/272.0 + p*(5.0/64.0)) + q*(5.0/304.0 - p*(35.0/736.0));
            dd sum = dd_sub(dd_div(e2, dd_of(24.0)), dd_div(dd_add(e3, dd_scale(e3, 2.0)), dd_of(44.0)));
            sum = dd_mul(e2, dd_sub(sum, dd_div(dd_of(1.0), dd_of(10.0))));
            sum = dd_add(dd_add(sum, dd_div(e3, dd_of(14.0))), dd_of(p*p*(pure + once) + q*q*twice));
            return dd_div(dd_add(sum, dd_of(1.0)), dd_sqrt(mean));
        }
        const dd sx = dd_sqrt(x), sy = dd_sqrt(y), sz = dd_sqrt(z);
        const dd shift = dd_add(dd_mul(sx, dd_add(sy, sz)), dd_mul(sy, sz));
        x = dd_scale(dd_add(x, shift), 0.25);
        y = dd_scale(dd_add(y, shift), 0.25);
        z = dd_scale(dd_add(z, shift), 0.25);
    }
    return dd_of(NAN);
}

/* Whether every operation is rounded separately: tests an error-free sum and product, and a quotient. */
static inline int dd_sound(void)
{
    volatile double large = 1.0, small = 0x1p-60, factor = 1.0 + 0x1p-30; /* volatile: not computed by the compiler */
    const dd sum = two_sum(large, small), product = two_product(factor, factor);
    const dd third = dd_div(dd_of(large), dd_of(3.0*large));
    const dd back = dd_sub(dd_mul(third, dd_of(3.0)), dd_of(1.0));
    return sum.hi == 1.0 && sum.lo == 0x1p-60 && product.lo == 0x1p-60 && fabs(back.hi) < 1e-31;
}

#endif

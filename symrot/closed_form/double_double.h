/*
 * Arithmetic to about 31 digits: a number is the unevaluated sum of two doubles, |lo| <= ulp(hi)/2.
 *
 * Every operation rests on error-free transformations (Dekker 1971; Ogita, Rump & Oishi 2005). They hold only where the
 * compiler keeps each rounding as written: compile with -ffp-contract=off, never with -ffast-math. `dd_sound` tells
 * whether it did. Relative errors: + - * below 4e-32, / and sqrt below 2e-31, exp, sine and cosine below 1e-31 of the
 * largest value. No overflow or underflow is handled: scale by powers of two first.
 */
#ifndef SYMROT_DOUBLE_DOUBLE_H
#define SYMROT_DOUBLE_DOUBLE_H

#include "error_free.h"

/* What is long and used often while constants are found: one copy each, or compiling takes several times as long. */
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

static inline dd dd_negative(dd a)
{
    return dd_pair(-a.hi, -a.lo);
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
    dd rest = dd_sub(a, dd_mul(dd_of(first), b));
    const double second = rest.hi/b.hi;
    rest = dd_sub(rest, dd_mul(dd_of(second), b));
    const dd sum = quick_two_sum(first, second);
    return dd_add(sum, dd_of(rest.hi/b.hi));
}

/* The square root; of what is not positive, zero. */
ONE_COPY dd dd_sqrt(dd a)
{
    if (!(a.hi > 0.0))
        return dd_of(0.0);
    const double root = sqrt(a.hi);
    const dd square = two_product(root, root);
    const double rest = ((a.hi - square.hi) - square.lo) + a.lo;
    const dd once = quick_two_sum(root, rest/(2.0*root));
    const dd left = dd_sub(a, dd_square(once)); /* a second step, for the last bits */
    return dd_add(once, dd_of(left.hi/(2.0*root)));
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
#define DD_TERMS ((int)(sizeof DD_INVERSE_FACTORIALS/sizeof DD_INVERSE_FACTORIALS[0]))

/* exp(a): 2^k times the 64th power of exp of what is left; 0 below the smallest double. */
ONE_COPY dd dd_exp(dd a)
{
    static const dd ln2 = DD_LN2;
    if (a.hi < -745.0)
        return dd_of(0.0);
    const double k = rint(a.hi/ln2.hi);
    const dd rest = dd_scale(dd_sub(a, dd_mul(dd_of(k), ln2)), 0x1p-6); /* at most 0.0055 */
    dd sum = DD_INVERSE_FACTORIALS[12];
    for (int n = 11; n >= 1; --n)
        sum = dd_add(dd_mul(sum, rest), DD_INVERSE_FACTORIALS[n]);
    sum = dd_mul(sum, rest); /* exp(rest) - 1, squared up without loss */
    for (int n = 0; n < 6; ++n)
        sum = dd_add(dd_scale(sum, 2.0), dd_square(sum));
    sum = dd_add(sum, dd_of(1.0));
    return dd_pair(ldexp(sum.hi, (int)k), ldexp(sum.lo, (int)k));
}

/* Sine and cosine of an angle given in turns. */
ONE_COPY void dd_sincos_turns(dd turns, dd *sine, dd *cosine)
{
    static const dd pi = DD_PI;
    dd rest = dd_sub(turns, dd_of(rint(turns.hi)));
    const double quarter = rint(4.0*rest.hi);
    rest = dd_scale(dd_mul(dd_sub(rest, dd_of(0.25*quarter)), pi), 2.0); /* at most pi/4 */
    const dd square = dd_square(rest);
    dd s = DD_INVERSE_FACTORIALS[27], c = DD_INVERSE_FACTORIALS[26];
    for (int n = 25; n >= 1; n -= 2) {
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

/* The arithmetic-geometric mean of 1 and a, 0 < a <= 1. */
ONE_COPY dd dd_agm(dd a)
{
    dd arithmetic = dd_of(1.0), geometric = a;
    for (int n = 0; n < 64; ++n) {
        const dd gap = dd_sub(arithmetic, geometric);
        const dd next = dd_scale(dd_add(arithmetic, geometric), 0.5);
        if (fabs(gap.hi) <= 1e-16*arithmetic.hi) /* the next gap would be its square over 8 */
            return next;
        geometric = dd_sqrt(dd_mul(arithmetic, geometric));
        arithmetic = next;
    }
    return arithmetic;
}

/*
 * Carlson's R_F(x, y, z), not negative, at most one of them zero: duplication until the arguments agree to 1e-4, then the
 * series to the seventh order (Carlson 1995; DLMF 19.36.1).
 */
ONE_COPY dd dd_rf(dd x, dd y, dd z)
{
    const dd third = dd_div(dd_of(1.0), dd_of(3.0));
    for (int n = 0; n < 200; ++n) {
        const dd mean = dd_mul(dd_add(dd_add(x, y), z), third);
        const double spread = fmax(fabs(x.hi - mean.hi), fmax(fabs(y.hi - mean.hi), fabs(z.hi - mean.hi)));
        if (spread <= 1e-4*mean.hi) {
            const dd dx = dd_div(dd_sub(mean, x), mean), dy = dd_div(dd_sub(mean, y), mean);
            const dd dz = dd_negative(dd_add(dx, dy));
            const dd e2 = dd_sub(dd_mul(dx, dy), dd_square(dz)), e3 = dd_mul(dd_mul(dx, dy), dz);
            dd sum = dd_div(dd_mul(e2, e2), dd_of(24.0));
            sum = dd_add(sum, dd_div(e3, dd_of(14.0)));
            sum = dd_sub(sum, dd_div(e2, dd_of(10.0)));
            sum = dd_sub(sum, dd_div(dd_mul(dd_add(e2, dd_scale(e2, 2.0)), e3), dd_of(44.0)));
            const double small = e3.hi*e3.hi*3.0/104.0 - e2.hi*e2.hi*e2.hi*5.0/208.0 + e2.hi*e2.hi*e3.hi/16.0;
            sum = dd_add(dd_add(sum, dd_of(small)), dd_of(1.0));
            return dd_div(sum, dd_sqrt(mean));
        }
        const dd sx = dd_sqrt(x), sy = dd_sqrt(y), sz = dd_sqrt(z);
        const dd shift = dd_add(dd_mul(sx, dd_add(sy, sz)), dd_mul(sy, sz));
        x = dd_scale(dd_add(x, shift), 0.25);
        y = dd_scale(dd_add(y, shift), 0.25);
        z = dd_scale(dd_add(z, shift), 0.25);
    }
    return dd_of(NAN);
}

/* Whether the compiler kept every rounding: an error-free sum and product, and one quotient to the last bits. */
static inline int dd_sound(void)
{
    volatile double large = 1.0, small = 0x1p-60, factor = 1.0 + 0x1p-30; /* volatile: found when run, not when compiled */
    const dd sum = two_sum(large, small), product = two_product(factor, factor);
    const dd third = dd_div(dd_of(large), dd_of(3.0*large));
    const dd back = dd_sub(dd_mul(third, dd_of(3.0)), dd_of(1.0));
    return sum.hi == 1.0 && sum.lo == 0x1p-60 && product.lo == 0x1p-60 && fabs(back.hi) < 1e-31;
}

#endif

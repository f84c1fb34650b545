/* The phase of a body far from resonance, for its constants and for its samples. The formulas are in spin_up.h. */
#ifndef SYMROT_SPIN_UP_PHASE_H
#define SYMROT_SPIN_UP_PHASE_H

#include "circular.h"
#include "double_double.h"
#include "spin_up.h"

/* log(1 + (i + 1/2)/32) for i from 0 to 31, as high and low. */
static const double LOG_HIGH[] = {
    0x1.fc0a8b0fc03e4p-7, 0x1.77458f632dcfcp-5, 0x1.341d7961bd1d1p-4, 0x1.a926d3a4ad563p-4,
    0x1.0d77e7cd08e59p-3, 0x1.44d2b6ccb7d1ep-3, 0x1.7ab890210d909p-3, 0x1.af3c94e80bff3p-3,
    0x1.e27076e2af2e6p-3, 0x1.0a324e27390e3p-2, 0x1.22941fbcf7966p-2, 0x1.3a64c556945eap-2,
    0x1.51aad872df82dp-2, 0x1.686c81e9b14afp-2, 0x1.7eaf83b82afc3p-2, 0x1.947941c2116fbp-2,
    0x1.a9cec9a9a084ap-2, 0x1.beb4d9da71b7cp-2, 0x1.d32fe7e00ebd5p-2, 0x1.e744261d68788p-2,
    0x1.faf588f78f31fp-2, 0x1.0723e5c1cdf40p-1, 0x1.109f39e2d4c97p-1, 0x1.19ee6b467c96fp-1,
    0x1.23130d7bebf43p-1, 0x1.2c0e9ed448e8cp-1, 0x1.34e289d9ce1d3p-1, 0x1.3d9026a7156fbp-1,
    0x1.4618bc21c5ec2p-1, 0x1.4e7d811b75bb1p-1, 0x1.56bf9d5b3f399p-1, 0x1.5ee02a9241675p-1,
};
static const double LOG_LOW[] = {
    -0x1.83092c59642a1p-62, 0x1.18d3ca87b9296p-59, -0x1.b599f227becbbp-58, 0x1.942f48aa70ea9p-58,
    0x1.9a5dc5e9030acp-57, 0x1.9f4f6543e1f88p-57, 0x1.be36b2d6a0608p-59, -0x1.398cff3641985p-58,
    -0x1.61578001e0162p-59, 0x1.7dcfde8061c03p-56, -0x1.76f5eb09628afp-56, -0x1.c68651945f97cp-57,
    0x1.3927ac19f55e3p-59, -0x1.ddea0f7f58e3dp-57, 0x1.92ce979ed2950p-56, -0x1.16cc8bae0bbe4p-56,
    -0x1.cadec02b436afp-56, -0x1.0f3c590a887cap-59, 0x1.877b232fafa37p-56, -0x1.c825c90c344b9p-58,
    -0x1.328260d8abca0p-57, 0x1.395e58e2445bbp-55, -0x1.0e09b27a4373ap-60, -0x1.9d1a11443f10cp-56,
    -0x1.f48725e374d6ep-55, -0x1.1a158f3917586p-55, 0x1.6eb92d885ce4fp-57, -0x1.6fef670bd4b62p-55,
    0x1.f42decdeccf1dp-55, -0x1.8d3d9ea6e9ea9p-55, 0x1.0471885cd8ff3p-55, 0x1.c358257f49082p-55,
};

/* 1/3, 1/5, 1/7 */
static const dd THIRD = {0x1.5555555555555p-2, 0x1.5555555555555p-56},
    FIFTH = {0x1.999999999999ap-3, -0x1.999999999999ap-57}, SEVENTH = {0x1.2492492492492p-3, 0x1.2492492492492p-57};

/* 1/(4 pi) */
static const dd SPIN_UP_QUARTER = {0x1.45f306dc9c883p-4, -0x1.6b01ec5417056p-58};

/* a + b with the error of dd_add_fast, for |a| >= |b|. */
ALWAYS_INLINE dd added_less(dd a, dd b)
{
    const dd s = quick_two_sum(a.hi, b.hi);
    return quick_two_sum(s.hi, s.lo + (a.lo + b.lo));
}

/* a + b t */
ALWAYS_INLINE dd linear(dd a, dd b, double t)
{
    const double p = b.hi*t;
    return dd_add_fast(a, dd_pair(p, MUL_ADD(b.lo, t, product_error(b.hi, t, p))));
}

/* atanh(r) - r for |r| <= 1/128, with an error of 2^-74 of r, or of 2^-102 if `fine`. */
ALWAYS_INLINE dd atanh_rest(dd r, int fine)
{
    const dd square = dd_square(r);
    double tail = 1.0/15.0;
    tail = MUL_ADD(tail, square.hi, 1.0/13.0);
    tail = MUL_ADD(tail, square.hi, 1.0/11.0);
    tail = MUL_ADD(tail, square.hi, 1.0/9.0);
    if (!fine) {
        tail = MUL_ADD(tail, square.hi, SEVENTH.hi);
        tail = MUL_ADD(tail, square.hi, FIFTH.hi);
        tail = MUL_ADD(tail, square.hi, THIRD.hi);
        return dd_pair(tail*square.hi*r.hi, 0.0);
    }
    dd sum = added_less(SEVENTH, dd_pair(tail*square.hi, 0.0));
    sum = added_less(FIFTH, dd_mul(sum, square));
    sum = added_less(THIRD, dd_mul(sum, square));
    return dd_mul(dd_mul(sum, square), r);
}

/* log(a) = log(2^n c) + 2 atanh(r) of a normal number, with an error of 2^-74, or of 2^-102 max(1, log) if `fine`. */
ALWAYS_INLINE dd logarithm(dd a, int fine)
{
    static const dd ln2 = DD_LN2;
    union {
        double number;
        uint64_t bits;
    } size, part, down;
    size.number = a.hi;
    const uint64_t exponent = size.bits >> 52, i = size.bits >> 47 & 31;
    part.bits = (size.bits & 0xfffffffffffffu) | (uint64_t)1023 << 52;
    down.bits = (2046 - exponent) << 52;
    size.bits = exponent | (uint64_t)1075 << 52;
    const double n = size.number - (0x1p+52 + 1023.0), low = a.lo*down.number;
    size.bits = (part.bits & ~(((uint64_t)1 << 47) - 1)) | (uint64_t)1 << 46;
    const double c = size.number;
    /* r = (f - c)/(f + c): the difference is exact */
    const double above = part.number - c, below = part.number + c, below_low = (c - (below - part.number)) + low;
    const double inverse = 1.0/below, first = above*inverse, product = first*below;
    const double rest = ((above - product) - product_error(first, below, product)) + MUL_ADD(-first, below_low, low);
    const dd r = quick_two_sum(first, rest*inverse);
    const dd atanh2 = dd_scale(added_less(r, atanh_rest(r, fine)), 2.0);
    const double octaves = n*ln2.hi, lost = MUL_ADD(n, ln2.lo, product_error(n, ln2.hi, octaves));
    const dd known = two_sum(octaves, LOG_HIGH[i]);
    if (!fine)
        return dd_add_fast(dd_pair(known.hi, known.lo + (lost + LOG_LOW[i])), atanh2);
    return dd_add_fast(dd_add_fast(known, two_sum(lost, LOG_LOW[i])), atanh2);
}

/* log(|Omega| + S), with more digits if kappa is large. */
ALWAYS_INLINE dd swept_logarithm(dd omega, dd speed, int fine)
{
    return logarithm(dd_add_fast(dd_scale(omega, omega.hi < 0.0 ? -1.0 : 1.0), speed), fine);
}

/* P/(4 pi) from Omega, S and that logarithm, up to a constant. */
ALWAYS_INLINE dd swept_turns(const spin_up_phase *p, dd omega, dd speed, dd log)
{
    const double sign = omega.hi < 0.0 ? -1.0 : 1.0;
    const dd asinh = dd_add_fast(log, dd_pair(-p->logarithm[0], -p->logarithm[1]));
    const dd even = dd_mul(dd_mul(omega, speed), dd_pair(p->product[0], p->product[1]));
    return dd_add_fast(even, dd_mul(asinh, dd_pair(sign*p->share[0], sign*p->share[1])));
}

/* c[0] + c[1] x + .. + c[12] x^12, with even and odd powers apart, which a processor computes in parallel. */
ALWAYS_INLINE double series_of(const double c[SPIN_UP_SERIES], double x)
{
    const double square = x*x;
    double even = c[12], odd = c[11];
    even = MUL_ADD(even, square, c[10]);
    odd = MUL_ADD(odd, square, c[9]);
    even = MUL_ADD(even, square, c[8]);
    odd = MUL_ADD(odd, square, c[7]);
    even = MUL_ADD(even, square, c[6]);
    odd = MUL_ADD(odd, square, c[5]);
    even = MUL_ADD(even, square, c[4]);
    odd = MUL_ADD(odd, square, c[3]);
    even = MUL_ADD(even, square, c[2]);
    odd = MUL_ADD(odd, square, c[1]);
    even = MUL_ADD(even, square, c[0]);
    return MUL_ADD(odd, x, even);
}

#endif

/*
 * Numbers between -128 and 128 as integers of 256 bits, in units of 2^-248: for numbers that need more than 31 digits,
 * because they must be rounded to the same pairs of doubles as exact fractions.
 *
 * Sums are exact. The error of a product is less than one unit, of a reciprocal or root a few units for arguments near
 * 1.
 */
#ifndef SYMROT_FIXED_POINT_H
#define SYMROT_FIXED_POINT_H

#include <stdint.h>

#include "error_free.h"

enum { LIMBS = 4, FRACTION = 248 };

/* In two's complement, the lowest 64 bits first. */
typedef struct {
    uint64_t limb[LIMBS];
} fixed;

static const fixed FIXED_ZERO = {{0, 0, 0, 0}};
static const fixed FIXED_ONE = {{0, 0, 0, (uint64_t)1 << 56}};

/* The lower half of a*b + c + *carry; the upper half becomes the carry. */
#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide;

ALWAYS_INLINE uint64_t multiply_add(uint64_t a, uint64_t b, uint64_t c, uint64_t *carry)
{
    const wide sum = (wide)a*b + c + *carry;
    *carry = (uint64_t)(sum >> 64);
    return (uint64_t)sum;
}
#else
ALWAYS_INLINE uint64_t multiply_add(uint64_t a, uint64_t b, uint64_t c, uint64_t *carry)
{
    const uint64_t low = 0xffffffff, a0 = a & low, a1 = a >> 32, b0 = b & low, b1 = b >> 32;
    const uint64_t p00 = a0*b0, p01 = a0*b1, p10 = a1*b0;
    const uint64_t middle = (p00 >> 32) + (p01 & low) + (p10 & low);
    uint64_t high = a1*b1 + (p01 >> 32) + (p10 >> 32) + (middle >> 32), sum = (middle << 32) | (p00 & low);
    sum += c;
    high += sum < c;
    sum += *carry;
    high += sum < *carry;
    *carry = high;
    return sum;
}
#endif

ALWAYS_INLINE int fixed_sign(fixed a)
{
    if (a.limb[3] >> 63)
        return -1;
    return (a.limb[0] | a.limb[1] | a.limb[2] | a.limb[3]) != 0;
}

#ifdef __SIZEOF_INT128__
ALWAYS_INLINE wide lower_half(fixed a)
{
    return (wide)a.limb[1] << 64 | a.limb[0];
}

ALWAYS_INLINE wide upper_half(fixed a)
{
    return (wide)a.limb[3] << 64 | a.limb[2];
}

ALWAYS_INLINE fixed of_halves(wide low, wide high)
{
    const fixed r = {{(uint64_t)low, (uint64_t)(low >> 64), (uint64_t)high, (uint64_t)(high >> 64)}};
    return r;
}

ALWAYS_INLINE fixed fixed_add(fixed a, fixed b)
{
    const wide low = lower_half(a) + lower_half(b);
    return of_halves(low, upper_half(a) + upper_half(b) + (low < lower_half(a)));
}

ALWAYS_INLINE fixed fixed_sub(fixed a, fixed b)
{
    const wide low = lower_half(a) - lower_half(b);
    return of_halves(low, upper_half(a) - upper_half(b) - (lower_half(a) < lower_half(b)));
}
#else
ALWAYS_INLINE fixed fixed_add(fixed a, fixed b)
{
    fixed r;
    uint64_t carry = 0;
    for (int k = 0; k < LIMBS; ++k) {
        const uint64_t sum = a.limb[k] + b.limb[k], all = sum + carry;
        carry = (sum < a.limb[k]) | (all < sum);
        r.limb[k] = all;
    }
    return r;
}

ALWAYS_INLINE fixed fixed_sub(fixed a, fixed b)
{
    fixed r;
    uint64_t borrow = 0;
    for (int k = 0; k < LIMBS; ++k) {
        const uint64_t rest = a.limb[k] - b.limb[k], all = rest - borrow;
        borrow = (a.limb[k] < b.limb[k]) | (rest < borrow);
        r.limb[k] = all;
    }
    return r;
}
#endif

ALWAYS_INLINE fixed fixed_negative(fixed a)
{
    return fixed_sub(FIXED_ZERO, a);
}

ALWAYS_INLINE fixed fixed_abs(fixed a)
{
    return a.limb[3] >> 63 ? fixed_negative(a) : a;
}

ALWAYS_INLINE int fixed_less(fixed a, fixed b)
{
    return fixed_sign(fixed_sub(a, b)) < 0;
}

#define UNROLLED _Pragma("GCC unroll 8")

/*
 * Multiply as unsigned numbers, then subtract the excess for negative factors. The lowest products, which are below the
 * last digit, are omitted.
 */
static fixed fixed_mul(fixed a, fixed b)
{
    uint64_t product[2*LIMBS] = {0};
    UNROLLED for (int i = 0; i < LIMBS; ++i) {
        uint64_t carry = 0;
        UNROLLED for (int j = i < 2 ? 2 - i : 0; j < LIMBS; ++j)
            product[i + j] = multiply_add(a.limb[i], b.limb[j], product[i + j], &carry);
        product[i + LIMBS] = carry;
    }
    const uint64_t a_negative = 0 - (a.limb[3] >> 63), b_negative = 0 - (b.limb[3] >> 63);
    fixed high, less_a, less_b, r;
    UNROLLED for (int k = 0; k < LIMBS; ++k) {
        high.limb[k] = product[k + LIMBS];
        less_a.limb[k] = b.limb[k] & a_negative;
        less_b.limb[k] = a.limb[k] & b_negative;
    }
    high = fixed_sub(high, fixed_add(less_a, less_b));
    r.limb[0] = (product[3] >> 56) | (high.limb[0] << 8);
    UNROLLED for (int k = 1; k < LIMBS; ++k)
        r.limb[k] = (high.limb[k - 1] >> 56) | (high.limb[k] << 8);
    return r;
}

ALWAYS_INLINE fixed fixed_half(fixed a)
{
    for (int k = 0; k < LIMBS - 1; ++k)
        a.limb[k] = (a.limb[k] >> 1) | (a.limb[k + 1] << 63);
    a.limb[3] = (a.limb[3] >> 1) | (a.limb[3] & (uint64_t)1 << 63);
    return a;
}

/* A power of two, of any exponent that a double can have. */
ALWAYS_INLINE double power_of_two(int exponent)
{
    if (exponent < -1022 || exponent > 1023)
        return ldexp(1.0, exponent);
    union {
        uint64_t bits;
        double value;
    } power = {(uint64_t)(exponent + 1023) << 52};
    return power.value;
}

/* A double, |x| < 128, truncated to a multiple of 2^-248. */
static fixed fixed_of(double x)
{
    int exponent;
    const double mantissa = frexp(fabs(x), &exponent);
    const uint64_t bits = (uint64_t)(mantissa*0x1p53);
    const int shift = exponent - 53 + FRACTION;
    fixed r = FIXED_ZERO;
    if (shift <= -64 || bits == 0)
        return r;
    if (shift < 0)
        r.limb[0] = bits >> -shift;
    else {
        const int k = shift >> 6, rest = shift & 63;
        r.limb[k] = bits << rest;
        if (rest > 11)
            r.limb[k + 1] = bits >> (64 - rest);
    }
    return x < 0.0 ? fixed_negative(r) : r;
}

/* Whether that conversion is exact. */
static inline int fixed_holds(double x)
{
    return x == 0.0 || (fabs(x) >= 0x1p-190 && fabs(x) < 0x1p6);
}

static inline int leading_zeros(uint64_t x)
{
#if defined(__GNUC__)
    return __builtin_clzll(x);
#else
    int count = 0;
    for (; !(x >> 63); x <<= 1)
        ++count;
    return count;
#endif
}

/* The nearest double; the even one if two are equally near. */
static double fixed_value(fixed a)
{
    const fixed x = fixed_abs(a);
    int k = LIMBS - 1;
    while (k > 0 && x.limb[k] == 0)
        --k;
    if (x.limb[k] == 0)
        return 0.0;
    const int zeros = leading_zeros(x.limb[k]);
    uint64_t top = x.limb[k] << zeros, below = 0;
    if (k > 0) {
        if (zeros)
            top |= x.limb[k - 1] >> (64 - zeros);
        below = x.limb[k - 1] << zeros;
    }
    for (int i = 0; i < k - 1; ++i)
        below |= x.limb[i];
    const uint64_t rest = top & 0x7ff;
    uint64_t kept = top >> 11;
    if (rest > 0x400 || (rest == 0x400 && (below || (kept & 1))))
        ++kept;
    const double value = (double)kept*power_of_two(64*k - zeros + 11 - FRACTION);
    return a.limb[3] >> 63 ? -value : value;
}

ALWAYS_INLINE dd rounded_pair(fixed a)
{
    const double high = fixed_value(a);
    return dd_pair(high, fixed_value(fixed_sub(a, fixed_of(high))));
}

/*
 * Write a number with an error of at most `error`, times a power of two, as the pair of doubles of its exact value.
 * Return 0 if the error leaves that pair in doubt. Rounding is monotonic: if both ends of an interval are rounded to
 * the same pair, every number in it is.
 */
static int fixed_pair(fixed a, fixed error, double scale, double *pair)
{
    const dd high = rounded_pair(fixed_add(a, error));
    pair[0] = high.hi*scale;
    pair[1] = high.lo*scale;
    if (fixed_sign(error) == 0)
        return 1;
    const dd low = rounded_pair(fixed_sub(a, error));
    return high.hi == low.hi && high.lo == low.lo;
}

/* 1/a for a between 1/64 and 64, by Newton's method from a double. */
static fixed fixed_inverse(fixed a)
{
    fixed r = fixed_of(1.0/fixed_value(a));
    for (int n = 0; n < 3; ++n)
        r = fixed_add(r, fixed_mul(r, fixed_sub(FIXED_ONE, fixed_mul(a, r))));
    return r;
}

/* 1/sqrt(a) for a between 1/64 and 64. */
static fixed fixed_inverse_root(fixed a)
{
    fixed r = fixed_of(1.0/sqrt(fixed_value(a)));
    for (int n = 0; n < 3; ++n)
        r = fixed_add(r, fixed_mul(fixed_half(r), fixed_sub(FIXED_ONE, fixed_mul(a, fixed_mul(r, r)))));
    return r;
}

#endif

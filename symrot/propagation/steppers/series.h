/*
 * The sum of a Taylor series and the compensated step along it, for vectors of any number of lanes.
 *
 * Included after the system, which defines SYMROT_ORDER, and after taylor.h or lanes.h, which define
 *     symrot_v              numbers at once, one in each lane
 *     V_ALL, V_ADD, V_SUB, V_MUL, V_FMA   operations on them
 * A series is an array of its coefficients from 0 on; s is the time since its start in the unit of its coefficients.
 */

/*
 * 1/3 exceeds its double by 2^-54 of its size. Nearly all terms of a series from the third on have this error, of the
 * same sign in every step: over 1e5 revolutions it adds up to 1e-13 rad. The carry therefore receives this correction.
 */
static const double SYMROT_THIRD = 1.0/18014398509481984.0;

/* Return coefficients from 1 on, summed at s units, and divided by s: four sums, each of every fourth power. */
static inline symrot_v symrot_sum(const symrot_v *x, symrot_v s)
{
    const symrot_v second = V_MUL(s, s), fourth = V_MUL(second, second);
    symrot_v a = x[SYMROT_ORDER - 3], b = x[SYMROT_ORDER - 2], c = x[SYMROT_ORDER - 1], d = x[SYMROT_ORDER];
    for (int n = SYMROT_ORDER - 7; n > 0; n -= 4) {
        a = V_FMA(a, fourth, x[n]);
        b = V_FMA(b, fourth, x[n + 1]);
        c = V_FMA(c, fourth, x[n + 2]);
        d = V_FMA(d, fourth, x[n + 3]);
    }
    const symrot_v sum = V_FMA(V_FMA(d, s, c), second, V_FMA(b, s, a));
    return SYMROT_ORDER%4 ? V_FMA(sum, second, V_FMA(x[2], s, x[1])) : sum;  /* two terms remain for an order 4 k + 2 */
}

/* Return the states inside a step, s units after its start. */
static inline symrot_v symrot_inside(const symrot_v *x, symrot_v s, symrot_v carry)
{
    return V_ADD(x[0], V_FMA(symrot_sum(x, s), s, carry));
}

/* Return the states at the end of a step of s units; rounding errors are added to the carry (Knuth's sum). */
static inline symrot_v symrot_end(const symrot_v *x, symrot_v s, symrot_v *carry)
{
    const symrot_v sum = symrot_sum(x, s), after = V_SUB(sum, V_FMA(x[2], s, x[1]));
    const symrot_v lack = V_MUL(after, V_MUL(s, V_ALL(SYMROT_THIRD)));
    const symrot_v y = x[0], d = V_FMA(sum, s, V_ADD(*carry, lack)), end = V_ADD(y, d), rise = V_SUB(end, y);
    *carry = V_ADD(V_SUB(y, V_SUB(end, rise)), V_SUB(d, rise));
    return end;
}

/*
 * Pairs of doubles: numbers of about 32 digits as unevaluated sums. Errors are a few units of 2^-104 of the operands.
 *
 * Source: T. J. Dekker, Numerische Mathematik 18 (1971) 224-242; D. E. Knuth, The Art of Computer Programming, 4.2.2.
 */
typedef struct { double high, low; } symrot_pair;

static inline symrot_pair symrot_pair_of(double high, double low)
{
    symrot_pair pair;
    pair.high = high;
    pair.low = low;
    return pair;
}

/* a + b, exactly */
static inline symrot_pair symrot_pair_sum(double a, double b)
{
    const double sum = a + b, rise = sum - a;
    return symrot_pair_of(sum, (a - (sum - rise)) + (b - rise));
}

/* a + b, exactly, for |a| >= |b| */
static inline symrot_pair symrot_pair_short_sum(double a, double b)
{
    const double sum = a + b;
    return symrot_pair_of(sum, b - (sum - a));
}

static inline symrot_pair symrot_pair_negate(symrot_pair a) { return symrot_pair_of(-a.high, -a.low); }

static inline symrot_pair symrot_pair_add(symrot_pair a, symrot_pair b)
{
    const symrot_pair sum = symrot_pair_sum(a.high, b.high);
    return symrot_pair_short_sum(sum.high, sum.low + (a.low + b.low));
}

static inline symrot_pair symrot_pair_subtract(symrot_pair a, symrot_pair b)
{
    return symrot_pair_add(a, symrot_pair_negate(b));
}

static inline symrot_pair symrot_pair_multiply(symrot_pair a, symrot_pair b)
{
    const double product = a.high*b.high, rest = fma(a.high, b.high, -product);
    return symrot_pair_short_sum(product, rest + (a.high*b.low + a.low*b.high));
}

/* a t + b at the time t + t_low: as it is rounded, and what the rounding took from it */
static inline symrot_pair symrot_pair_turn(double a, double b, double t, double t_low)
{
    const double product = a*t;
    const symrot_pair sum = symrot_pair_sum(product, b);
    return symrot_pair_of(sum.high, sum.low + (fma(a, t, -product) + a*t_low));
}

static inline symrot_pair symrot_pair_divide(symrot_pair a, symrot_pair b)
{
    const double first = a.high/b.high;
    const symrot_pair rest = symrot_pair_subtract(a, symrot_pair_multiply(symrot_pair_of(first, 0.0), b));
    return symrot_pair_short_sum(first, rest.high/b.high);
}

static inline symrot_pair symrot_pair_root(symrot_pair a)
{
    const double first = sqrt(a.high);
    const symrot_pair half = symrot_pair_of(first, 0.0);
    return symrot_pair_short_sum(first, symrot_pair_subtract(a, symrot_pair_multiply(half, half)).high/(2.0*first));
}

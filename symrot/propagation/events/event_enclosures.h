/*
 * Enclosures of formulas: by real intervals, and by complex discs with real centres.
 *
 * Included before emitted functions symrot_event_range and symrot_event_disc, see symrot.codegen.printing.event_source.
 *
 * An interval contains all values of a formula for real arguments in their intervals; NaN ends mean that the formula
 * has no value there, infinite ends that nothing is known. A disc contains all values for complex arguments in their
 * discs, if the formula is analytic there; an infinite radius means that nothing is known.
 *
 * Ends and radii are widened by more than their own rounding errors. C99 that is also valid C++.
 *
 * Source: R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis, chapters 2 to 5; M. S. Petkovic,
 * L. D. Petkovic, Complex Interval Arithmetic and Its Applications, chapter 1.
 */
typedef struct { double lo, hi; } symrot_range;
typedef struct { double c, r; } symrot_disc;

static const double SYMROT_WIDER = 8.0*DBL_EPSILON, SYMROT_TINY = 1e-322;
static const double SYMROT_LEAST = 1e-305, SYMROT_LOG_LEAST = -702.2;  /* of exp */

/* ---------------------------------------------------------------------------------------------- intervals */

static inline symrot_range symrot_outward(double lo, double hi)
{
    symrot_range x;
    x.lo = fmin(lo - SYMROT_WIDER*fabs(lo) - SYMROT_TINY, DBL_MAX);
    x.hi = fmax(hi + SYMROT_WIDER*fabs(hi) + SYMROT_TINY, -DBL_MAX);
    if (lo != lo || hi != hi) x.lo = x.hi = NAN;
    return x;
}

static inline symrot_range symrot_nowhere(void)
{
    symrot_range x;
    x.lo = x.hi = NAN;
    return x;
}

static inline int symrot_empty(symrot_range x) { return x.lo != x.lo; }

static inline symrot_range symrot_range_point(double x) { return symrot_outward(x, x); }

static inline symrot_range symrot_range_around(double c, double r)
{
    return r < INFINITY ? symrot_outward(c - r, c + r) : symrot_outward(-INFINITY, INFINITY);
}

static inline symrot_range symrot_range_neg(symrot_range a)
{
    symrot_range x;
    x.lo = -a.hi;
    x.hi = -a.lo;
    return x;
}

static inline symrot_range symrot_range_add(symrot_range a, symrot_range b)
{
    return symrot_outward(a.lo + b.lo, a.hi + b.hi);
}

static inline symrot_range symrot_range_sub(symrot_range a, symrot_range b)
{
    return symrot_outward(a.lo - b.hi, a.hi - b.lo);
}

static inline double symrot_times(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a*b; }  /* 0*inf is 0 */

static inline symrot_range symrot_range_mul(symrot_range a, symrot_range b)
{
    if (symrot_empty(a) || symrot_empty(b)) return symrot_nowhere();
    const double p = symrot_times(a.lo, b.lo), q = symrot_times(a.lo, b.hi);
    const double r = symrot_times(a.hi, b.lo), s = symrot_times(a.hi, b.hi);
    return symrot_outward(fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s)));
}

static inline symrot_range symrot_range_abs(symrot_range a)
{
    symrot_range x;
    if (a.lo >= 0.0 || symrot_empty(a)) return a;
    if (a.hi <= 0.0) return symrot_range_neg(a);
    x.lo = 0.0;
    x.hi = fmax(-a.lo, a.hi);
    return x;
}

static inline symrot_range symrot_range_square(symrot_range a)
{
    const symrot_range size = symrot_range_abs(a);
    symrot_range x = symrot_range_mul(size, size);
    if (x.lo < 0.0) x.lo = 0.0;
    return x;
}

static inline symrot_range symrot_range_div(symrot_range a, symrot_range b)
{
    symrot_range inverse;
    if (symrot_empty(b) || (b.lo == 0.0 && b.hi == 0.0)) return symrot_nowhere();
    if (b.lo < 0.0 && b.hi > 0.0) return symrot_range_mul(a, symrot_outward(-INFINITY, INFINITY));
    inverse.lo = b.hi == 0.0 ? -INFINITY : 1.0/b.hi;
    inverse.hi = b.lo == 0.0 ? INFINITY : 1.0/b.lo;
    return symrot_range_mul(a, symrot_outward(inverse.lo, inverse.hi));
}

static inline symrot_range symrot_range_sqrt(symrot_range a)
{
    if (!(a.hi >= 0.0)) return symrot_nowhere();
    symrot_range x = symrot_outward(a.lo > 0.0 ? sqrt(a.lo) : 0.0, sqrt(a.hi));
    if (x.lo < 0.0) x.lo = 0.0;
    return x;
}

/* Return exp without underflow to zero, since exp is positive. */
static inline double symrot_exp(double x)
{
    const double value = exp(x);
    return value < SYMROT_LEAST ? SYMROT_LEAST : value;
}

static inline symrot_range symrot_range_exp(symrot_range a) { return symrot_outward(symrot_exp(a.lo), symrot_exp(a.hi)); }

static inline symrot_range symrot_range_log(symrot_range a)
{
    if (!(a.hi > 0.0)) return symrot_nowhere();
    return symrot_outward(a.lo > 0.0 ? log(a.lo) : -INFINITY, log(a.hi));
}

/* Return the range of a function with values and slopes between -1 and 1, from its value at the middle. */
static inline symrot_range symrot_range_wave(symrot_range a, double (*wave)(double))
{
    if (symrot_empty(a)) return a;
    const double c = 0.5*a.lo + 0.5*a.hi, r = 0.5*(a.hi - a.lo);
    if (!(r < 4.0)) return symrot_outward(-1.0, 1.0);
    const double value = wave(c);
    return symrot_outward(fmax(value - r, -1.0), fmin(value + r, 1.0));
}

static inline symrot_range symrot_range_sin(symrot_range a) { return symrot_range_wave(a, sin); }
static inline symrot_range symrot_range_cos(symrot_range a) { return symrot_range_wave(a, cos); }

static inline symrot_range symrot_range_tan(symrot_range a)
{
    if (symrot_empty(a)) return a;
    const double turn = 3.14159265358979323846;
    const int one_branch = a.hi - a.lo < 0.9*turn && fabs(a.lo) < 1e15
        && floor(a.lo/turn + 0.5) == floor(a.hi/turn + 0.5) && tan(a.lo) <= tan(a.hi) && cos(a.lo)*cos(a.hi) > 1e-14;
    return one_branch ? symrot_outward(tan(a.lo), tan(a.hi)) : symrot_outward(-INFINITY, INFINITY);
}

static inline symrot_range symrot_range_sinh(symrot_range a) { return symrot_outward(sinh(a.lo), sinh(a.hi)); }

static inline symrot_range symrot_range_cosh(symrot_range a)
{
    const symrot_range size = symrot_range_abs(a);
    return symrot_outward(cosh(size.lo), cosh(size.hi));
}

static inline symrot_range symrot_range_tanh(symrot_range a) { return symrot_outward(tanh(a.lo), tanh(a.hi)); }
static inline symrot_range symrot_range_atan(symrot_range a) { return symrot_outward(atan(a.lo), atan(a.hi)); }

static inline symrot_range symrot_range_asin(symrot_range a)
{
    if (!(a.lo <= 1.0 && a.hi >= -1.0)) return symrot_nowhere();
    return symrot_outward(asin(fmax(a.lo, -1.0)), asin(fmin(a.hi, 1.0)));
}

static inline symrot_range symrot_range_acos(symrot_range a)
{
    if (!(a.lo <= 1.0 && a.hi >= -1.0)) return symrot_nowhere();
    return symrot_outward(acos(fmin(a.hi, 1.0)), acos(fmax(a.lo, -1.0)));
}

/* The angle of points in a box without the origin is extreme at corners, unless the box crosses the branch cut. */
static inline symrot_range symrot_range_atan2(symrot_range y, symrot_range x)
{
    if (symrot_empty(y) || symrot_empty(x)) return symrot_nowhere();
    const int bounded = y.hi - y.lo < INFINITY && x.hi - x.lo < INFINITY;
    if (!bounded || (y.lo <= 0.0 && y.hi >= 0.0 && x.lo <= 0.0))
        return symrot_outward(-3.14159265358979324, 3.14159265358979324);
    const double p = atan2(y.lo, x.lo), q = atan2(y.lo, x.hi), r = atan2(y.hi, x.lo), s = atan2(y.hi, x.hi);
    return symrot_outward(fmin(fmin(p, q), fmin(r, s)), fmax(fmax(p, q), fmax(r, s)));
}

/* Return whether an operation may jump, from the ranges of what it is applied to: a quotient, a tangent, an angle. */
static inline int symrot_jumps_div(symrot_range b) { return !(b.lo > 0.0 || b.hi < 0.0); }
static inline int symrot_jumps_tan(symrot_range a) { return !(symrot_range_tan(a).hi <= DBL_MAX); }
static inline int symrot_jumps_atan2(symrot_range y, symrot_range x)
{
    return !(y.lo > 0.0 || y.hi < 0.0 || x.lo > 0.0);
}

/* ---------------------------------------------------------------------------------------------- discs */

static inline symrot_disc symrot_disc_of(double c, double r)
{
    symrot_disc x;
    x.c = c;
    x.r = r*(1.0 + 64.0*DBL_EPSILON) + SYMROT_WIDER*fabs(c) + SYMROT_TINY;
    return x;
}

static inline symrot_disc symrot_disc_unknown(void) { return symrot_disc_of(0.0, INFINITY); }

static inline symrot_disc symrot_disc_point(double x) { return symrot_disc_of(x, 0.0); }

static inline symrot_disc symrot_disc_neg(symrot_disc a)
{
    a.c = -a.c;
    return a;
}

static inline symrot_disc symrot_disc_add(symrot_disc a, symrot_disc b) { return symrot_disc_of(a.c + b.c, a.r + b.r); }
static inline symrot_disc symrot_disc_sub(symrot_disc a, symrot_disc b) { return symrot_disc_of(a.c - b.c, a.r + b.r); }

static inline symrot_disc symrot_disc_mul(symrot_disc a, symrot_disc b)
{
    return symrot_disc_of(a.c*b.c, fabs(a.c)*b.r + fabs(b.c)*a.r + a.r*b.r);
}

static inline symrot_disc symrot_disc_square(symrot_disc a) { return symrot_disc_mul(a, a); }

static inline symrot_disc symrot_disc_div(symrot_disc a, symrot_disc b)
{
    if (!(fabs(b.c) > b.r)) return symrot_disc_unknown();
    const double size = (fabs(b.c) - b.r)*(fabs(b.c) + b.r);
    return symrot_disc_mul(a, symrot_disc_of(b.c/size, b.r/size));
}

static inline symrot_disc symrot_disc_abs(symrot_disc a)
{
    if (!(fabs(a.c) > a.r)) return symrot_disc_unknown();
    return a.c < 0.0 ? symrot_disc_neg(a) : a;
}

static inline symrot_disc symrot_disc_sqrt(symrot_disc a)
{
    if (!(a.c > a.r)) return symrot_disc_unknown();
    return symrot_disc_of(sqrt(a.c), a.r/(sqrt(a.c) + sqrt(a.c - a.r)));
}

static inline symrot_disc symrot_disc_exp(symrot_disc a)
{
    if (a.c + a.r < SYMROT_LOG_LEAST) return symrot_disc_point(SYMROT_LEAST);
    const double value = symrot_exp(a.c);
    return symrot_disc_of(value, value*expm1(a.r) + SYMROT_LEAST);
}

static inline symrot_disc symrot_disc_log(symrot_disc a)
{
    if (!(a.c > a.r)) return symrot_disc_unknown();
    return symrot_disc_of(log(a.c), -log1p(-a.r/a.c));
}

/* Return the disc of sin, cos, sinh or cosh: radius |g| sinh r + |f| (cosh r - 1), with value f and derivative +-g. */
static inline symrot_disc symrot_disc_wave(double f, double g, double r)
{
    const double e = expm1(r), back = e/(1.0 + e);
    return e < INFINITY ? symrot_disc_of(f, 0.5*(fabs(g)*(e + back) + fabs(f)*e*back)) : symrot_disc_unknown();
}

static inline symrot_disc symrot_disc_sin(symrot_disc a) { return symrot_disc_wave(sin(a.c), cos(a.c), a.r); }
static inline symrot_disc symrot_disc_cos(symrot_disc a) { return symrot_disc_wave(cos(a.c), sin(a.c), a.r); }
static inline symrot_disc symrot_disc_sinh(symrot_disc a) { return symrot_disc_wave(sinh(a.c), cosh(a.c), a.r); }
static inline symrot_disc symrot_disc_cosh(symrot_disc a) { return symrot_disc_wave(cosh(a.c), sinh(a.c), a.r); }

/* Return the disc of tan or tanh from value and slope at the centre, by the addition theorem of tangents. */
static inline symrot_disc symrot_disc_tangent(double value, double slope, double r)
{
    if (!(r < 1.57)) return symrot_disc_unknown();
    const double step = tan(r), rest = 1.0 - fabs(value)*step;
    return rest > 0.0 ? symrot_disc_of(value, slope*step/rest) : symrot_disc_unknown();
}

static inline symrot_disc symrot_disc_tan(symrot_disc a)
{
    const double value = tan(a.c);
    return symrot_disc_tangent(value, 1.0 + value*value, a.r);
}

static inline symrot_disc symrot_disc_tanh(symrot_disc a)
{
    const double value = tanh(a.c), narrow = 1.0/cosh(a.c);
    symrot_disc x = symrot_disc_tangent(value, narrow*narrow, a.r);
    if (fabs(a.c) > a.r) {
        const double e = exp(-2.0*(fabs(a.c) - a.r)), r = 2.0*e/(1.0 - e);
        if (!(x.r < r)) x = symrot_disc_of(a.c < 0.0 ? -1.0 : 1.0, r);
    }
    return x;
}

static inline symrot_disc symrot_disc_asin(symrot_disc a)
{
    const double far = fabs(a.c) + a.r;
    if (!(far < 1.0)) return symrot_disc_unknown();
    return symrot_disc_of(asin(a.c), asin(far) - asin(fabs(a.c)) + SYMROT_WIDER);
}

static inline symrot_disc symrot_disc_acos(symrot_disc a)
{
    const symrot_disc x = symrot_disc_asin(a);
    return symrot_disc_of(1.57079632679489661923 - x.c, x.r);
}

static inline symrot_disc symrot_disc_atan(symrot_disc a)
{
    const double rest = 1.0 + a.c*a.c - fabs(a.c)*a.r;
    return rest > a.r ? symrot_disc_of(atan(a.c), atanh(a.r/rest)) : symrot_disc_unknown();
}

static inline symrot_disc symrot_disc_atan2(symrot_disc y, symrot_disc x)
{
    const double r = x.r + y.r, far = hypot(x.c, y.c);
    if (!(r < far) || (!(x.c > x.r) && !(fabs(y.c) > y.r))) return symrot_disc_unknown();
    return symrot_disc_of(atan2(y.c, x.c), -log1p(-r/far));
}

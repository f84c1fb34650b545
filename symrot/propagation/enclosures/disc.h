/*
 * Discs with a real centre in the complex plane: the range of a formula whose variables lie in such discs.
 *
 * A formula that is analytic on the disc |s| <= rho around a time and deviates there from a constant by at most D has
 * Taylor coefficients |f_n| <= D/rho^n (Cauchy). One evaluation over discs therefore bounds features that no
 * coefficient shows: a pulse ahead, a switch, a pole. The result of each rule contains the image of the disc; with a
 * pole or a branch point in the disc the radius is infinite. Rounding errors, 1e-16 of the radius, are not included.
 */
#include <math.h>

/* |z - c| <= r. If these numbers over- or underflow, log|z| <= g is the better bound; otherwise g is NAN. */
typedef struct { double c, r, g; } symrot_disc;

static inline symrot_disc symrot_disc_of(double c, double r)
{
    symrot_disc d;
    d.c = c;
    d.r = r;
    d.g = NAN;
    return d;
}

static inline symrot_disc symrot_disc_up_to(double c, double r, double g)
{
    symrot_disc d = symrot_disc_of(c, r);
    d.g = g;
    return d;
}

/* A number that underflowed to zero need not be zero. */
static inline double symrot_disc_log(symrot_disc a)
{
    const double size = fabs(a.c) + a.r;
    return a.g == a.g ? a.g : size == 0.0 ? -745.0 : log(size);
}

/* The disc of a computed value, with the error of its last operation and of a sum of numbers of the given size. */
static inline symrot_disc symrot_disc_rounded(symrot_disc a, double size)
{
    a.r += 0.5*DBL_EPSILON*(fabs(a.c) + size);
    return a;
}

/* More than the error of a number that underflows: exp(-746) is 0 as a double, and 1e-324 in truth. */
static const double SYMROT_UNDERFLOW_UNIT = 1e-323;

/* The logarithms bound the product of a pulse that underflows and a wave whose bound overflows. */
static inline symrot_disc symrot_disc_product(symrot_disc a, symrot_disc b)
{
    symrot_disc d = symrot_disc_of(a.c*b.c, fabs(a.c)*b.r + fabs(b.c)*a.r + a.r*b.r);
    if (a.g == a.g || b.g == b.g) {
        d.g = symrot_disc_log(a) + symrot_disc_log(b);
        if (!(d.r < INFINITY) || d.c == 0.0)
            d = symrot_disc_up_to(0.0, fmin(d.r, exp(d.g)) + SYMROT_UNDERFLOW_UNIT, d.g);
    }
    return d;
}

static inline symrot_disc symrot_disc_square(symrot_disc a) { return symrot_disc_product(a, a); }

/* The image of a disc under 1/z is a disc again. */
static inline symrot_disc symrot_disc_inverse(symrot_disc a)
{
    const double inner = 1.0/(fabs(a.c) - a.r), outer = 1.0/(fabs(a.c) + a.r); /* their product may underflow */
    return fabs(a.c) > a.r ? symrot_disc_of(a.c*inner*outer, a.r*inner*outer) : symrot_disc_of(0.0, INFINITY);
}

/*
 * If a disc contains the branch point, the root has a corner there: a Taylor series does not continue past it, and
 * Cauchy's bound does not hold. A step h past it misses at most h times the size of the root. The radius is therefore
 * that size times `whole`, one over the share of a deviation that a step misses.
 */
static inline symrot_disc symrot_disc_sqrt(symrot_disc a, double whole)
{
    const double root = sqrt(a.c > 0.0 ? a.c : 0.0);
#if defined(SYMROT_ROUGH)
    const double corner = whole*(root + sqrt(fabs(a.c) + a.r));
#else
    (void)whole;
    const double corner = INFINITY;
#endif
    return symrot_disc_of(root, a.c > a.r ? a.r/(root + sqrt(a.c - a.r)) : corner);
}

static inline symrot_disc symrot_disc_exp(symrot_disc a)
{
    const double value = exp(a.c);
    const double radius = a.r < 1.0 ? value*expm1(a.r) : exp(a.c + a.r) - value;
    return symrot_disc_up_to(value, radius + SYMROT_UNDERFLOW_UNIT, a.c + a.r);
}

static inline symrot_disc symrot_disc_ln(symrot_disc a)
{
    return a.c > a.r ? symrot_disc_of(log(a.c), -log1p(-a.r/a.c)) : symrot_disc_of(0.0, INFINITY);
}

/* sin(c + z) - sin(c) = cos(c) sin(z) + sin(c) (cos(z) - 1), |sin(z)| <= sinh(r), |cos(z) - 1| <= cosh(r) - 1. */
static inline symrot_disc symrot_disc_wave(double value, double slope, double r, double g)
{
    const double half = sinh(0.5*r);
    return symrot_disc_up_to(value, fabs(slope)*sinh(r) + 2.0*fabs(value)*half*half, g);
}

static inline symrot_disc symrot_disc_sin(symrot_disc a) { return symrot_disc_wave(sin(a.c), cos(a.c), a.r, a.r); }
static inline symrot_disc symrot_disc_cos(symrot_disc a) { return symrot_disc_wave(cos(a.c), sin(a.c), a.r, a.r); }

static inline symrot_disc symrot_disc_sinh(symrot_disc a)
{
    return symrot_disc_wave(sinh(a.c), cosh(a.c), a.r, fabs(a.c) + a.r);
}

static inline symrot_disc symrot_disc_cosh(symrot_disc a)
{
    return symrot_disc_wave(cosh(a.c), sinh(a.c), a.r, fabs(a.c) + a.r);
}

/* Far from zero |sech(z)| <= 2 e/(1 - e^2) with e = exp(-(|c| - r)); near it, one over the hyperbolic cosine. */
static inline symrot_disc symrot_disc_sech(symrot_disc a)
{
    const double far = exp(a.r - fabs(a.c));
    const symrot_disc near = fabs(a.c) < 350.0 ? symrot_disc_inverse(symrot_disc_cosh(a)) : symrot_disc_of(0.0, INFINITY);
    const double bound = far < 1.0 ? 2.0*far/(1.0 - far*far) : INFINITY;
    if (near.r <= bound) return near;
    return far < 1.0 ? symrot_disc_up_to(0.0, bound, a.r - fabs(a.c) + log(2.0/(1.0 - far*far))) : near;
}

/* tan(c + z) - tan(c) = sec(c)^2 tan(z)/(1 - tan(c) tan(z)), |tan(z)| <= tan(r). */
static inline symrot_disc symrot_disc_tan(symrot_disc a)
{
    const double value = tan(a.c), most = a.r < 1.5 ? tan(a.r) : INFINITY, rest = 1.0 - fabs(value)*most;
    return symrot_disc_of(value, rest > 0.0 ? (1.0 + value*value)*most/rest : INFINITY);
}

/* As for the tangent, but far from zero |tanh(z) - 1| = |2 e/(1 + e)| with |e| <= exp(-2 (c - r)). */
static inline symrot_disc symrot_disc_tanh(symrot_disc a)
{
    const double value = tanh(a.c), tail = exp(-2.0*fabs(a.c)), slope = 4.0*tail/((1.0 + tail)*(1.0 + tail));
    const double most = a.r < 1.5 ? tan(a.r) : INFINITY, rest = 1.0 - fabs(value)*most;
    const double near = rest > 0.0 ? slope*most/rest : INFINITY;
    const double beyond = exp(-2.0*(fabs(a.c) - a.r));
    const double far = beyond < 1.0 ? 2.0*beyond/(1.0 - beyond) : INFINITY;
    if (near <= far) return symrot_disc_of(value, near);
    return symrot_disc_of(a.c > 0.0 ? 1.0 : -1.0, far);
}

/* The coefficients of the arc sine at |c| are all positive, so that it grows most along the real axis. */
static inline double symrot_disc_arc(symrot_disc a)
{
    const double low = fabs(a.c), high = low + a.r;
    return high < 1.0 ? asin(high) - asin(low) : INFINITY;
}

static inline symrot_disc symrot_disc_asin(symrot_disc a) { return symrot_disc_of(asin(a.c), symrot_disc_arc(a)); }
static inline symrot_disc symrot_disc_acos(symrot_disc a) { return symrot_disc_of(acos(a.c), symrot_disc_arc(a)); }

/* atan(c + z) - atan(c) = atan(z/(1 + c (c + z))), |atan(w)| <= artanh|w|. */
static inline symrot_disc symrot_disc_atan(symrot_disc a)
{
    const double rest = 1.0 + a.c*a.c - fabs(a.c)*a.r;
    return symrot_disc_of(atan(a.c), a.r < rest ? atanh(a.r/rest) : INFINITY);
}

/* atan2(y, x) = (log(x + i y) - log(x - i y))/(2 i), continued across its branch cut. */
static inline symrot_disc symrot_disc_atan2(symrot_disc y, symrot_disc x)
{
    const double size = hypot(x.c, y.c), off = x.r + y.r;
    return symrot_disc_of(atan2(y.c, x.c), off < size ? -log1p(-off/size) : INFINITY);
}

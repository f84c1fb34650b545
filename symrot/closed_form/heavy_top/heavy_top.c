/* The constants of a symmetric heavy top's motion, in double-double arithmetic. The formulas are in heavy_top.h. */
#include "heavy_top.h"
#include "complex_dd.h"
#include "nutation.h"
#include "series.h"

/* Nearer to the unstable upright position, inputs of 31 digits do not determine when the top falls. */
#define NEAR 1e-29

/* Largest relative error of S2 - S3, which vanishes on the separatrix: the time of the fall has half this error. */
#define DOUBT 1e-16

/* The nome is at most 0.075 (where m = 0.7): nome^(n^2) is below 1e-40 from n = 6 on. */
enum { TERMS = 6 };

/*
 * One of the two numerators as series. Real part: sum re[n] * even function, imaginary part: sum im[n] * odd function,
 * or the reverse. The derivative of each term is multiplied by `order`.
 */
typedef struct {
    dd re[TERMS], im[TERMS];
    int odd, sine_first; /* odd or even multiples; whether re belongs to sines */
} numerator;

/* A value and its derivative with respect to z or v, from cos and sin (or cosh and sinh) of the argument. */
static void value_at(const numerator *f, double sign, const dd c[TERMS], const dd s[TERMS], complex_dd *value, complex_dd *slope)
{
    *value = *slope = complex_of(dd_of(0.0), dd_of(0.0));
    for (int n = 0; n < TERMS; ++n) {
        const dd order = dd_of(f->odd ? 2.0*n + 1.0 : 2.0*n), back = dd_scale(order, sign); /* cos' = sign sin */
        const dd re = f->re[n], im = f->im[n];
        value->re = dd_add(value->re, dd_mul(re, f->sine_first ? s[n] : c[n]));
        value->im = dd_add(value->im, dd_mul(im, f->sine_first ? c[n] : s[n]));
        slope->re = dd_add(slope->re, dd_mul(dd_mul(re, f->sine_first ? order : back), f->sine_first ? c[n] : s[n]));
        slope->im = dd_add(slope->im, dd_mul(dd_mul(im, f->sine_first ? back : order), f->sine_first ? s[n] : c[n]));
    }
}

/* Terms in sines or cosines as a polynomial: of odd multiples, or of even ones (sin 2nz = sin 2z U_(n-1)(cos 2z)). */
static void polynomial_of(const dd terms[TERMS], int odd, int sine, double to[SERIES])
{
    if (odd) {
        odd_series(terms, sine ? -1.0 : 1.0, to);
    } else if (!sine) {
        even_series(terms, to);
    } else {
        to[0] = dd_sub(terms[1], terms[3]).hi;
        to[1] = dd_sub(dd_scale(terms[2], 2.0), dd_scale(terms[4], 4.0)).hi;
        to[2] = 4.0*terms[3].hi;
        to[3] = 8.0*terms[4].hi;
        to[4] = 0.0;
    }
}

/* The polynomials of a numerator N and of i kappa N + dN/dt, all times `size`. */
static void store_numerator(const numerator *f, double sign, dd kappa, dd rate, dd size, int which, heavy_top *t)
{
    dd re[TERMS], im[TERMS], re_rate[TERMS], im_rate[TERMS];
    for (int n = 0; n < TERMS; ++n) {
        const dd order = dd_mul(dd_of(f->odd ? 2.0*n + 1.0 : 2.0*n), rate), back = dd_scale(order, sign);
        re[n] = dd_mul(f->re[n], size);
        im[n] = dd_mul(f->im[n], size);
        re_rate[n] = dd_sub(dd_mul(re[n], f->sine_first ? order : back), dd_mul(kappa, im[n]));
        im_rate[n] = dd_add(dd_mul(im[n], f->sine_first ? back : order), dd_mul(kappa, re[n]));
    }
    polynomial_of(re, f->odd, f->sine_first, t->value[which][0]);
    polynomial_of(im, f->odd, !f->sine_first, t->value[which][1]);
    polynomial_of(re_rate, f->odd, !f->sine_first, t->derivative[which][0]);
    polynomial_of(im_rate, f->odd, f->sine_first, t->derivative[which][1]);
}

/* m < 0.7: theta1(z + i sign y) (alternating) or theta2(z + i sign y), times 2 exp(-pi y/2K). */
static void circular_terms(dd per, dd k_prime, dd nome, dd y, double sign, int alternating, numerator *f, dd *drift)
{
    dd plus = dd_of(1.0), minus = dd_of(0.0), close = dd_of(0.0), shrink = dd_of(0.0);
    if (nome.hi > 0.0) {
        minus = shrink = dd_exp(dd_negative(dd_mul(per, y)));
        close = dd_exp(dd_negative(dd_mul(per, dd_sub(k_prime, y))));
    }
    dd odd_power = nome, square = dd_square(nome), even_power = square; /* nome^(2n+1), nome^(2n+2) */
    dd slope = dd_of(0.0), level = dd_of(0.0);
    f->odd = 1;
    f->sine_first = alternating;
    for (int n = 0; n < TERMS; ++n) {
        const dd cosh2 = dd_add(plus, minus), sinh2 = dd_scale(dd_sub(plus, minus), sign);
        const double flip = alternating && n%2 ? -1.0 : 1.0;
        f->re[n] = dd_scale(cosh2, flip);
        f->im[n] = dd_scale(sinh2, alternating ? flip : -flip);
        level = dd_add(level, cosh2);
        slope = dd_add(slope, dd_mul(sinh2, dd_of(2.0*n + 1.0)));
        plus = dd_mul(plus, dd_mul(odd_power, close));
        minus = dd_mul(minus, dd_mul(even_power, shrink));
        odd_power = dd_mul(odd_power, square);
        even_power = dd_mul(even_power, square);
    }
    *drift = dd_negative(dd_div(slope, level)); /* d arg/dz of theta1 at z = pi/2, of theta2 at 0 */
}

/* m >= 0.7, nome q', v = pi u/2K': the images of theta1(z + i sign y) and of theta2(z + i sign y); chi in turns. */
static void hyperbolic_terms(dd nome, dd chi, double sign, int first, numerator *f, dd *drift)
{
    dd product = dd_of(1.0), step = nome, power = dd_of(1.0), square = dd_square(nome);
    complex_dd value = complex_of(dd_of(0.0), dd_of(0.0)), slope = value, turn, angle; /* 2 chi; chi or 0, and on */
    dd_sincos_turns(chi, &angle.im, &angle.re);
    turn = times(angle, angle);
    if (!first)
        angle = complex_of(dd_of(1.0), dd_of(0.0));
    f->odd = first;
    f->sine_first = 0;
    for (int n = 0; n < TERMS; ++n) {
        const double flip = n%2 ? -1.0 : 1.0, order = first ? 2.0*n + 1.0 : 2.0*n;
        const dd sine = angle.im, cosine = angle.re;
        if (first) { /* product = nome^(n^2), power = nome^n */
            const dd weight = dd_scale(dd_mul(product, power), flip);
            f->re[n] = dd_scale(dd_mul(weight, sine), sign);
            f->im[n] = dd_negative(dd_mul(weight, cosine));
            /* at u = K, times 2 sqrt(nome): cosh, sinh -> nome^(n^2) +- nome^((n+1)^2) */
            const dd next = dd_mul(product, step), even = dd_add(product, next), odd = dd_sub(product, next);
            const dd up = dd_scale(sine, sign*flip), across = dd_scale(cosine, -flip);
            value.re = dd_add(value.re, dd_mul(up, even));
            value.im = dd_add(value.im, dd_mul(across, odd));
            slope.re = dd_add(slope.re, dd_mul(dd_mul(up, odd), dd_of(order)));
            slope.im = dd_add(slope.im, dd_mul(dd_mul(across, even), dd_of(order)));
        } else {
            const dd weight = dd_scale(product, n ? 2.0*flip : 1.0);
            f->re[n] = dd_mul(weight, cosine);
            f->im[n] = dd_scale(dd_mul(weight, sine), sign);
            value.re = dd_add(value.re, f->re[n]);
            slope.im = dd_add(slope.im, dd_mul(f->im[n], dd_of(order)));
        }
        product = dd_mul(product, step);
        step = dd_mul(step, square);
        power = dd_mul(power, nome);
        angle = times(angle, turn);
    }
    *drift = quotient(slope, value).im; /* d arg/dv of theta1 at u = K, of theta2 at u = 0 */
}

/* cos, sin (or cosh, sinh) of the multiples of an angle in a numerator, from cos, sin of the angle. */
static void multiples(int odd, double sign, dd c1, dd s1, dd c[TERMS], dd s[TERMS])
{
    const dd c2 = dd_add(dd_square(c1), dd_scale(dd_square(s1), sign)), s2 = dd_scale(dd_mul(c1, s1), 2.0);
    c[0] = odd ? c1 : dd_of(1.0);
    s[0] = odd ? s1 : dd_of(0.0);
    for (int n = 1; n < TERMS; ++n) {
        c[n] = dd_add(dd_mul(c[n - 1], c2), dd_scale(dd_mul(s[n - 1], s2), sign));
        s[n] = dd_add(dd_mul(s[n - 1], c2), dd_mul(c[n - 1], s2));
        if (sign > 0.0 && c[n].hi > 1e60) { /* its weight is negligible, and powers would overflow */
            for (; n < TERMS; ++n)
                c[n] = s[n] = dd_of(0.0);
        }
    }
}

/* Column j of the map to q: space*x*conj(axes). */
static void store_column(const dd space[4], const dd x[4], const body_axes *axes, int j, heavy_top *t)
{
    dd back[4], first[4], column[4];
    quaternion_conjugate(axes->quaternion, back);
    quaternion_product(space, x, first);
    quaternion_product(first, back, column);
    for (int i = 0; i < 4; ++i)
        t->attitude[i][j] = column[i].hi;
}

/* The maps from alpha, beta without their unit factors a, b to q, and from rotated omega_1, omega_2 to omega. */
static void store_maps(
    complex_dd a, complex_dd b, dd axial_rate, const dd space[4], const body_axes *axes, double scale, heavy_top *t)
{
    const dd zero = dd_of(0.0);
    const dd columns[4][4] = {
        {a.re, zero, zero, a.im}, {dd_negative(a.im), zero, zero, a.re},
        {zero, b.re, b.im, zero}, {zero, dd_negative(b.im), b.re, zero},
    };
    for (int j = 0; j < 4; ++j)
        store_column(space, columns[j], axes, j, t);
    const complex_dd turn = times(b, complex_of(a.re, dd_negative(a.im)));
    for (int i = 0; i < 3; ++i) {
        const dd *m = axes->matrix[i];
        t->omega[i][0] = dd_add(dd_mul(m[0], turn.re), dd_mul(m[1], turn.im)).hi*scale;
        t->omega[i][1] = dd_sub(dd_mul(m[1], turn.re), dd_mul(m[0], turn.im)).hi*scale;
        t->omega[i][2] = dd_mul(m[2], axial_rate).hi*scale;
    }
}

/* The phase of beta relative to alpha, from the phases of both, which start at zero. */
static void store_between(heavy_top *t)
{
    const dd a = dd_pair(t->turning[0][0], t->turning[0][1]), b = dd_pair(t->turning[1][0], t->turning[1][1]);
    store_phase(dd_sub(b, a), dd_of(0.0), t->between);
}

static dd in_turns(dd rate)
{
    static const dd pi = DD_PI;
    return dd_scale(dd_div(rate, pi), 0.5);
}

/*
 * Compute the constants of a motion.
 *
 * in   moments[4]     kg m^2  A, C about the fixed point, each as hi, lo; C may be zero with omega_3 zero
 * in   pull[2]        N m     weight times the distance of the centre of mass from the fixed point, positive
 * in   omega[6]       rad/s   along e1, e2, e3 at time 0; e3 points from the fixed point to the centre of mass
 * in   quaternion[8]  1       attitude of e1, e2, e3 at time 0, relative to axes whose third points up
 * in   space[8]       1       unit quaternion from those axes to the space axes in which the motion is returned
 * in   axes[26]       1       NULL, or the matrix, row by row, and the unit quaternion from e1, e2, e3 to body axes
 * out  t                      the constants
 * Domain: a start at the unstable upright position, or at least NEAR away from it: hypot(|beta|, |w1 + i w2|/scale).
 * Returns 0; 1 if the numbers are outside this domain; 2 if the compiler has broken error-free arithmetic; 3 if the
 * motion is so near to the separatrix that numbers of 31 digits do not determine it.
 */
int symrot_heavy_top_prepare(
    const double moments[4], const double pull[2], const double omega[6], const double quaternion[8],
    const double space[8], const double *axes, heavy_top *t)
{
    static const dd pi = DD_PI;
    static const heavy_top blank;
    *t = blank;
    if (!dd_sound())
        return 2;
    for (int i = 0; i < 6; ++i)
        if (!(fabs(omega[i]) <= 1e150))
            return 1;
    if (!(moments[0] > 0.0 && moments[2] >= 0.0 && pull[0] > 0.0 && moments[0] <= 1e150 && pull[0] <= 1e150))
        return 1;
    body_axes frame;
    take_axes(axes, &frame);
    const dd a_moment = dd_pair(moments[0], moments[1]);
    const dd shape = dd_div(dd_pair(moments[2], moments[3]), a_moment), force = dd_div(dd_pair(pull[0], pull[1]), a_moment);
    const double fall[2] = {sqrt(force.hi), 0.0};
    const double scale = fmax(near_power(omega, 3), near_power(fall, 1));
    if (!(scale > 1e-140 && scale < 1e140))
        return 1;
    dd w[3], q[4], up[4];
    for (int i = 0; i < 3; ++i)
        w[i] = dd_pair(omega[2*i]/scale, omega[2*i + 1]/scale);
    const double quaternion_scale = near_power(quaternion, 4);
    for (int i = 0; i < 4; ++i) {
        q[i] = dd_pair(quaternion[2*i]/quaternion_scale, quaternion[2*i + 1]/quaternion_scale);
        up[i] = dd_pair(space[2*i], space[2*i + 1]);
    }
    normalise(q);
    if (!(fabs(q[0].hi) <= 2.0))
        return 1;
    t->time_scale = scale;

    complex_dd alpha = complex_of(q[0], q[3]), beta = complex_of(q[1], q[2]);
    const complex_dd across = complex_of(w[0], w[1]);
    const dd w2 = square_of(across), weight = dd_scale(dd_scale(force, 1.0/scale), 1.0/scale), spin = dd_mul(shape, w[2]);
    const double away = square_of(beta).hi + w2.hi; /* from the upright position at rest */
    const int tilted = q[1].hi != 0.0 || q[2].hi != 0.0 || w[0].hi != 0.0 || w[1].hi != 0.0;
    if (tilted && away < NEAR*NEAR && dd_less(dd_square(spin), dd_scale(weight, 4.0)))
        return 1;
    if (square_of(alpha).hi < 1e-62)
        alpha = complex_of(dd_of(0.0), dd_of(0.0));
    if (square_of(beta).hi < 1e-62)
        beta = complex_of(dd_of(0.0), dd_of(0.0));
    const complex_dd lever = times(complex_of(alpha.re, dd_negative(alpha.im)), beta); /* sin theta exp(-i psi)/2 */
    const complex_dd motion = times(across, complex_of(dd_scale(lever.re, 2.0), dd_scale(lever.im, -2.0)));
    nutation n;
    n.s = dd_scale(square_of(beta), 2.0);
    n.c = dd_scale(square_of(alpha), 2.0);
    n.pull = weight;
    n.axial_rate = w[2];
    n.spin = spin;
    n.speed = motion.re;
    n.d = dd_sub(motion.im, dd_mul(n.spin, n.s));
    n.sigma = dd_add(motion.im, dd_mul(n.spin, n.c));
    const complex_dd unit = complex_of(dd_of(1.0), dd_of(0.0));
    if (w2.hi == 0.0 && (n.s.hi == 0.0 || n.c.hi == 0.0)) { /* upright or hanging, with or without spin */
        const dd half = dd_scale(w[2], 0.5);
        const int upright = n.s.hi == 0.0;
        t->regime = STEADY;
        store_phase(in_turns(half), dd_of(0.0), t->turning[0]);
        store_phase(dd_negative(in_turns(half)), dd_of(0.0), t->turning[1]);
        store_between(t);
        t->value[0][0][0] = upright ? 1.0 : 0.0;
        t->value[1][0][0] = upright ? 0.0 : 1.0;
        store_maps(upright ? alpha : unit, upright ? unit : beta, w[2], up, &frame, scale, t);
        return 0;
    }
    find_roots(&n, w2, motion.im);
    if (n.doubt > DOUBT)
        return 3;
    const dd zero = dd_of(0.0), half_pi = dd_scale(pi, 0.5);
    const dd k = n.complement.hi > 0.0 ? dd_div(half_pi, dd_agm(dd_sqrt(n.complement))) : zero;
    const dd k_prime = n.modulus.hi > 0.0 ? dd_div(half_pi, dd_agm(dd_sqrt(n.modulus))) : zero;
    const double signs[2] = {n.sigma.hi > 0.0 ? -1.0 : 1.0, n.d.hi > 0.0 ? -1.0 : 1.0};
    const dd ys[2] = {n.ya, n.yb};
    /* d arg alpha/dt where s = S2, d arg beta/dt where s = S1; theta - omega_3/2 etc. as in the text above */
    const dd rates[2] = {
        dd_scale(dd_add(dd_sub(n.axial_rate, n.spin), ratio(n.sigma, dd_add(n.low, n.gap12))), 0.5),
        dd_scale(dd_add(dd_sub(n.spin, n.axial_rate), ratio(n.d, n.s1)), 0.5),
    };
    numerator numerators[2];
    dd kappas[2], drifts[2], leads[2] = {zero, zero}, rate, c1, s1, denominator, denominator_rate;
    double sign;
    if (n.modulus.hi < 0.7) {
        const dd per = dd_div(pi, k);
        const dd nome = n.modulus.hi > 0.0 ? dd_exp(dd_negative(dd_mul(per, k_prime))) : zero;
        t->regime = CIRCULAR;
        sign = -1.0;
        rate = dd_scale(dd_mul(per, n.rate), 0.5); /* dz/dt */
        for (int i = 0; i < 2; ++i) {
            circular_terms(per, k_prime, nome, ys[i], signs[i], i == 0, &numerators[i], &drifts[i]);
            kappas[i] = dd_sub(rates[i], dd_mul(rate, drifts[i]));
            store_phase(in_turns(kappas[i]), zero, t->turning[i]);
        }
        const dd start = dd_scale(dd_div(n.u, k), 0.25);
        store_phase(dd_scale(dd_div(n.rate, k), 0.25), start, t->axial);
        dd_sincos_turns(start, &s1, &c1);
        dd even = dd_of(1.0), power = nome, step = dd_mul(nome, dd_square(nome)), c[TERMS], s[TERMS];
        multiples(0, sign, c1, s1, c, s);
        denominator = dd_of(1.0);
        denominator_rate = zero;
        for (int j = 1; j < TERMS; ++j) { /* theta4 */
            even = dd_scale(power, j%2 ? -2.0 : 2.0);
            denominator = dd_add(denominator, dd_mul(even, c[j]));
            denominator_rate = dd_sub(denominator_rate, dd_mul(dd_mul(even, dd_of(2.0*j)), s[j]));
            power = dd_mul(power, step);
            step = dd_mul(step, dd_square(nome));
        }
    } else {
        const int endless = !(n.complement.hi > 0.0);
        const dd per = dd_div(pi, k_prime);
        const dd nome = endless ? zero : dd_exp(dd_negative(dd_mul(per, k)));
        t->regime = endless ? SEPARATRIX : HYPERBOLIC;
        sign = 1.0;
        rate = dd_scale(dd_mul(per, n.rate), 0.5); /* dv/dt */
        for (int i = 0; i < 2; ++i) {
            hyperbolic_terms(nome, dd_scale(dd_div(ys[i], k_prime), 0.25), signs[i], i == 0, &numerators[i], &drifts[i]);
            kappas[i] = dd_sub(rates[i], dd_mul(rate, drifts[i]));
            dd steady = kappas[i];
            if (!endless) {
                const dd slope = dd_scale(dd_div(ys[i], k_prime), -0.5*signs[i]);
                steady = dd_sub(steady, dd_mul(dd_div(dd_mul(slope, pi), k), n.rate));
                leads[i] = dd_scale(dd_mul(dd_div(n.u, k), dd_of(slope.hi)), 0.5);
                t->slope[i] = slope.hi;
            }
            store_phase(in_turns(steady), zero, t->turning[i]);
        }
        const dd v = dd_scale(dd_mul(per, n.u), 0.5), grown = dd_exp(v), shrunk = dd_exp(dd_negative(v));
        c1 = dd_scale(dd_add(grown, shrunk), 0.5);
        s1 = dd_scale(dd_sub(grown, shrunk), 0.5);
        if (endless) {
            store(rate, t->axial);
            store(v, t->axial + 2);
        } else {
            t->stretch = dd_mul(per, k).hi;
            store_phase(dd_scale(dd_div(n.rate, k), 0.25), dd_scale(dd_div(n.u, k), 0.25), t->axial);
        }
        dd weight = dd_of(1.0), step = dd_square(nome), c[TERMS], s[TERMS];
        multiples(1, sign, c1, s1, c, s);
        denominator = denominator_rate = zero;
        for (int j = 0; j < TERMS; ++j) { /* theta2(i v) */
            denominator = dd_add(denominator, dd_mul(weight, c[j]));
            denominator_rate = dd_add(denominator_rate, dd_mul(dd_mul(weight, dd_of(2.0*j + 1.0)), s[j]));
            weight = dd_mul(weight, step);
            step = dd_mul(step, dd_square(nome));
        }
    }

    /* The factors of the series: from the initial values or, if these are small, from their rates. */
    const complex_dd back = complex_of(across.re, dd_negative(across.im));
    const complex_dd fall_a = times(beta, back), climb_b = times(alpha, across);
    const dd half_spin = dd_scale(w[2], 0.5);
    const complex_dd start[2] = {alpha, beta};
    const complex_dd start_rate[2] = {
        complex_of(dd_sub(dd_scale(fall_a.re, -0.5), dd_mul(half_spin, alpha.im)),
                   dd_sub(dd_mul(half_spin, alpha.re), dd_scale(fall_a.im, 0.5))),
        complex_of(dd_add(dd_scale(climb_b.re, 0.5), dd_mul(half_spin, beta.im)),
                   dd_sub(dd_scale(climb_b.im, 0.5), dd_mul(half_spin, beta.re))),
    };
    complex_dd constants[2];
    dd sizes[2];
    const dd inner = dd_div(dd_mul(rate, denominator_rate), denominator);
    for (int i = 0; i < 2; ++i) {
        dd c[TERMS], s[TERMS];
        complex_dd value, slope;
        multiples(numerators[i].odd, sign, c1, s1, c, s);
        value_at(&numerators[i], sign, c, s, &value, &slope);
        complex_dd moving = complex_of(
            dd_sub(dd_mul(slope.re, rate), dd_mul(kappas[i], value.im)),
            dd_add(dd_mul(slope.im, rate), dd_mul(kappas[i], value.re)));
        moving.re = dd_sub(moving.re, dd_mul(inner, value.re));
        moving.im = dd_sub(moving.im, dd_mul(inner, value.im));
        const int by_rate = square_of(value).hi < 1e-6*square_of(moving).hi;
        constants[i] = turned(by_rate ? quotient(start_rate[i], moving) : quotient(start[i], value), dd_negative(leads[i]));
        sizes[i] = dd_sqrt(square_of(constants[i]));
        constants[i] = sizes[i].hi > 0.0
            ? complex_of(dd_div(constants[i].re, sizes[i]), dd_div(constants[i].im, sizes[i])) : unit;
    }
    const dd total = dd_sqrt(dd_add(dd_square(sizes[0]), dd_square(sizes[1])));
    for (int i = 0; i < 2; ++i)
        store_numerator(&numerators[i], sign, kappas[i], rate, dd_div(sizes[i], total), i, t);
    store_between(t);
    store_maps(constants[0], constants[1], w[2], up, &frame, scale, t);
    return 0;
}

/* The length of the constants in doubles, for callers that allocate them. */
ptrdiff_t symrot_heavy_top_length(void)
{
    return (ptrdiff_t)(sizeof(heavy_top)/sizeof(double));
}

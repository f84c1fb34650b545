/* The constants of a free body's motion, in double-double arithmetic. The formulas are in free_body.h. */
#include "expansion.h"
#include "free_body.h"
#include "series.h"

/* Terms of a series are omitted if they are below this part of the first term: 2^-110. */
#define NEGLIGIBLE 0x1p-110

/* The body in the axes e1, e2, e3 of the formulas, to 31 digits. */
typedef struct {
    int axis[3];        /* the principal axis that is e1, e2, e3 */
    double direction[3]; /* along it (1) or against it (-1) */
    double s;
    dd moments[3], momenta[3], amplitudes[3], total, twice_energy; /* I, L, A, |L|, 2T */
    dd modulus, complement, rate, u, eta;                         /* m, 1 - m, lambda, u0, eta */
} canonical_motion;

/* The quaternion of the change from the given axes to e1, e2, e3, by its largest component (Shepperd). */
static void renaming(const canonical_motion *c, dd q[4])
{
    double r[3][3] = {{0.0}};
    for (int k = 0; k < 3; ++k)
        r[k][c->axis[k]] = c->direction[k];
    const double squares[4] = {
        1.0 + r[0][0] + r[1][1] + r[2][2], 1.0 + r[0][0] - r[1][1] - r[2][2],
        1.0 - r[0][0] + r[1][1] - r[2][2], 1.0 - r[0][0] - r[1][1] + r[2][2],
    };
    const double row[4][4] = {
        {squares[0], r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]},
        {r[2][1] - r[1][2], squares[1], r[0][1] + r[1][0], r[2][0] + r[0][2]},
        {r[0][2] - r[2][0], r[0][1] + r[1][0], squares[2], r[1][2] + r[2][1]},
        {r[1][0] - r[0][1], r[2][0] + r[0][2], r[1][2] + r[2][1], squares[3]},
    };
    int best = 0;
    for (int i = 1; i < 4; ++i)
        if (squares[i] > squares[best])
            best = i;
    for (int i = 0; i < 4; ++i)
        q[i] = dd_of(row[best][i]);
    normalise(q);
}

/* f->attitude, column j = left*right. */
static void store_column(const dd left[4], const dd right[4], int j, free_body *f)
{
    dd column[4];
    quaternion_product(left, right, column);
    for (int k = 0; k < 4; ++k)
        f->attitude[k][j] = column[k].hi;
}

/* f->omega from the column n of a matrix that belongs to axis e_n of the canonical frame. */
static void store_omega(const body_axes *axes, int axis, dd amplitude, double scale, int n, free_body *f)
{
    for (int i = 0; i < 3; ++i)
        f->omega[i][n] = dd_mul(axes->matrix[i][axis], amplitude).hi*scale;
}

/* Steady rotation about n: X = (cos, n sin) of half the angle; the map is applied to (cos, sin, 0, 0). */
static void prepare_steady(const dd omega[3], const dd q0[4], const body_axes *axes, double scale, free_body *f)
{
    static const dd pi = DD_PI;
    const dd speed = dd_sqrt(dd_add(dd_add(dd_square(omega[0]), dd_square(omega[1])), dd_square(omega[2])));
    dd unit[4] = {{0.0, 0.0}}, turned[4], back[4];
    for (int i = 0; i < 3; ++i) {
        dd given = dd_of(0.0);
        for (int k = 0; k < 3; ++k)
            given = dd_add(given, dd_mul(axes->matrix[i][k], omega[k]));
        f->omega[i][0] = given.hi*scale;
        unit[i + 1] = speed.hi > 0.0 ? dd_div(omega[i], speed) : dd_of(0.0);
    }
    quaternion_product(q0, unit, turned);
    quaternion_conjugate(axes->quaternion, back);
    store_column(q0, back, 0, f);
    store_column(turned, back, 1, f);
    f->regime = STEADY;
    store_phase(dd_scale(dd_div(speed, pi), 0.25), dd_of(0.0), f->turning);
}

/*
 * Describe the body in the axes e1, e2, e3 of its motion. `differences[i]` is I_j - I_k for (i, j, k) cyclic; `defect`
 * is |L|^2 - 2 T I_mid.
 */
static void canonical(const dd inertia[3], const dd omega[3], const dd differences[3], dd defect, canonical_motion *c)
{
    int outer[2] = {0, 0}, middle; /* axes of the largest and the smallest moment; remaining axis */
    const int above[3] = {differences[2].hi >= 0.0, differences[0].hi >= 0.0, differences[1].hi >= 0.0};
    /* above[i]: I_i >= I_(i+1) */
    if (above[0] && !above[2])
        outer[0] = 0;
    else
        outer[0] = above[1] ? 1 : 2;
    const int a = (outer[0] + 1)%3, b = (outer[0] + 2)%3;
    outer[1] = above[a] ? b : a; /* b = a + 1 */
    middle = 3 - outer[0] - outer[1];
    const int third = defect.hi >= 0.0 ? 0 : 1;
    c->axis[0] = outer[1 - third];
    c->axis[1] = middle;
    c->axis[2] = outer[third];
    for (int k = 0; k < 3; ++k)
        c->direction[k] = omega[c->axis[k]].hi < 0.0 ? -1.0 : 1.0;
    const double cyclic = (c->axis[1] + 1)%3 == c->axis[2] ? 1.0 : -1.0; /* e2 = e3 x e1 */
    c->direction[1] = c->direction[0]*c->direction[2]*cyclic;

    dd w[3];
    for (int k = 0; k < 3; ++k) {
        c->moments[k] = inertia[c->axis[k]];
        w[k] = dd_scale(omega[c->axis[k]], c->direction[k]);
        c->momenta[k] = dd_mul(c->moments[k], w[k]);
    }
    const dd *I = c->moments, *L = c->momenta;
    const dd i32 = dd_abs(differences[c->axis[0]]), i31 = dd_abs(differences[c->axis[1]]);
    const dd i21 = dd_abs(differences[c->axis[2]]);
    c->s = third == 0 ? 1.0 : -1.0;

    const dd square1 = dd_square(L[0]), square2 = dd_square(L[1]), square3 = dd_square(L[2]);
    const dd across = dd_div(square2, dd_mul(I[1], i31));
    const dd a1 = dd_add(square1, dd_mul(across, dd_mul(I[0], i32)));
    const dd a2 = dd_add(square2, dd_div(dd_mul(dd_mul(square1, I[1]), i31), dd_mul(I[0], i32)));
    const dd a3 = dd_add(square3, dd_mul(across, dd_mul(I[2], i21)));
    const dd g = dd_add(dd_add(square1, square2), square3);
    c->amplitudes[0] = dd_sqrt(a1);
    c->amplitudes[1] = dd_sqrt(a2);
    c->amplitudes[2] = dd_sqrt(a3);
    c->total = dd_sqrt(g);
    c->twice_energy = dd_add(dd_add(dd_mul(L[0], w[0]), dd_mul(L[1], w[1])), dd_mul(L[2], w[2]));
    const dd share = dd_div(I[2], dd_mul(i32, a3));
    c->modulus = dd_div(dd_mul(dd_mul(i21, a1), share), I[0]);
    c->complement = dd_mul(dd_abs(defect), share);
    c->rate = dd_mul(dd_div(c->amplitudes[2], I[2]), dd_sqrt(dd_div(dd_mul(i32, i31), dd_mul(I[0], I[1]))));
    const dd sine = dd_scale(dd_div(L[1], c->amplitudes[1]), c->s);
    c->u = dd_mul(sine, dd_rf(dd_div(square1, a1), dd_div(square3, a3), dd_of(1.0)));
    c->eta = dd_mul(c->amplitudes[2], dd_rf(a1, dd_add(a1, dd_mul(c->modulus, a3)), g));
}

/* d psi/dt / 2 at u = 0, where L = (A1, 0, A3). */
static dd half_turning(const canonical_motion *c)
{
    const dd spin = dd_div(c->amplitudes[2], c->moments[2]);
    const dd above = dd_add(c->twice_energy, dd_mul(c->total, spin));
    return dd_scale(dd_div(above, dd_add(c->total, c->amplitudes[2])), 0.5);
}

/* The nome is at most 0.075 (where m = 0.7): nome^(n^2) is below 1e-40 from n = 6 on. */
enum { TERMS = 6 };

/* nome^(n(n+1)) and nome^(n^2), the latter doubled for n > 0; the sums at 0, with theta2 divided by 2 nome^(1/4). */
typedef struct {
    dd odd[TERMS], even[TERMS], theta2, theta3, theta4;
} theta_terms;

static void theta_terms_of(dd nome, theta_terms *t)
{
    dd product = dd_of(1.0), power = dd_of(1.0), sums[2] = {{0.0, 0.0}, {0.0, 0.0}}; /* nome^(n^2), nome^n */
    t->theta2 = dd_of(0.0);
    for (int n = 0; n < TERMS; ++n) {
        if (product.hi < NEGLIGIBLE) {
            t->even[n] = t->odd[n] = dd_of(0.0);
            continue;
        }
        t->even[n] = dd_scale(product, n ? 2.0 : 1.0);
        t->odd[n] = dd_mul(product, power);
        t->theta2 = dd_add(t->theta2, t->odd[n]);
        sums[n & 1] = dd_add(sums[n & 1], t->even[n]);
        power = dd_mul(power, nome);
        product = dd_mul(t->odd[n], power);
    }
    t->theta3 = dd_add(sums[0], sums[1]);
    t->theta4 = dd_sub(sums[0], sums[1]);
}

/* to = factor*from, with alternating signs if `sign` is -1. */
static void scaled(const dd from[TERMS], dd factor, double sign, dd to[SERIES])
{
    for (int n = 0; n < SERIES; ++n, factor = dd_scale(factor, sign))
        to[n] = dd_mul(from[n], factor);
}

/*
 * m < 0.7. In z = pi u/2K: cn ~ theta2/theta4, sn ~ theta1/theta4, dn ~ theta3/theta4; N real and imaginary from
 * c_n, s_n = q^(2n^2-n) e^(-n pi eta/K) +- q^(2n^2+n) e^(n pi eta/K). Returns kappa; N at the start in `real`, `imag`.
 */
static dd prepare_circular(const canonical_motion *c, dd k, dd k_prime, free_body *f, dd *real, dd *imag)
{
    static const dd pi = DD_PI;
    const int round = !(c->modulus.hi > 0.0);
    const dd per = dd_div(pi, k);
    /* q = shift*close; q e^(eta pi/K) = exp(-(K' - eta) pi/K) avoids the product of a huge and a tiny number */
    const dd shift = dd_exp(dd_negative(dd_mul(per, c->eta)));
    const dd close = round ? dd_of(0.0) : dd_exp(dd_negative(dd_mul(per, dd_sub(k_prime, c->eta))));
    const dd nome = dd_mul(shift, close);
    theta_terms t;
    theta_terms_of(nome, &t);
    dd work[SERIES];
    /* theta4 scaled so that it is about 1, the numerators so that cn(0) = sn(K) = dn(0) = 1 */
    scaled(t.even, dd_of(1.0), -1.0, work);
    even_series(work, f->series[3]);
    scaled(t.odd, dd_div(t.theta4, t.theta2), 1.0, work);
    odd_series(work, 1.0, f->series[0]);
    scaled(t.odd, dd_div(t.theta3, t.theta2), -1.0, work); /* theta1, theta4 at pi/2 are theta2, theta3 at 0 */
    odd_series(work, -1.0, f->series[1]);
    scaled(t.even, dd_div(t.theta4, t.theta3), 1.0, work);
    even_series(work, f->series[2]);

    dd cosines[SERIES] = {{1.0, 0.0}}, sines[SERIES] = {{0.0, 0.0}};
    dd growing = dd_of(1.0), shrinking = dd_of(1.0); /* q^(2n^2+n) e^(n pi eta/K), q^(2n^2-n) e^(-n pi eta/K) */
    dd bare = dd_of(1.0);                            /* nome^(4n) below */
    const dd square = dd_square(nome), fourth = dd_square(square), both = dd_mul(nome, shift), last = dd_mul(square, close);
    int terms = 1; /* at most SERIES: for n = 5 already q^(2n^2-n) is below 1e-50 */
    for (; terms < SERIES && shrinking.hi > NEGLIGIBLE; ++terms) {
        /* from n-1 to n: 2n^2-n grows by 4n-3, 2n^2+n by 4n-1 */
        shrinking = dd_mul(shrinking, dd_mul(bare, both));
        growing = dd_mul(growing, dd_mul(bare, last));
        bare = dd_mul(bare, fourth);
        const double sign = terms%2 ? -1.0 : 1.0;
        cosines[terms] = dd_scale(dd_add(shrinking, growing), sign);
        sines[terms] = dd_scale(dd_sub(shrinking, growing), sign*c->s);
    }
    even_series(cosines, f->series[4]);
    /* sin 2nz = sin 2z U_(n-1)(cos 2z): U0 = 1, U1 = 2x, U2 = 4x^2 - 1, U3 = 8x^3 - 4x */
    f->series[5][0] = dd_sub(sines[1], sines[3]).hi;
    f->series[5][1] = dd_sub(dd_scale(sines[2], 2.0), dd_scale(sines[4], 4.0)).hi;
    f->series[5][2] = 4.0*sines[3].hi;
    f->series[5][3] = 8.0*sines[4].hi;
    f->series[5][4] = 0.0;

    const dd start = dd_scale(dd_div(c->u, k), 0.25);
    dd drift = dd_of(0.0), level = dd_of(0.0);
    *real = dd_of(1.0);
    *imag = dd_of(0.0);
    dd s1, c1, sn = dd_of(0.0), cn = dd_of(1.0);
    dd_sincos_turns(dd_scale(start, 2.0), &s1, &c1); /* of 2z */
    for (int n = 1; n < terms; ++n) {
        const dd next = dd_sub(dd_mul(cn, c1), dd_mul(sn, s1));
        sn = dd_add(dd_mul(sn, c1), dd_mul(cn, s1));
        cn = next;
        *real = dd_add(*real, dd_mul(cosines[n], cn));
        *imag = dd_add(*imag, dd_mul(sines[n], sn));
        drift = dd_add(drift, dd_mul(sines[n], dd_of(2.0*n)));
        level = dd_add(level, cosines[n]);
    }
    level = dd_add(level, dd_of(1.0));
    store_phase(dd_scale(dd_div(c->rate, k), 0.25), start, f->axial);
    f->regime = CIRCULAR;
    return dd_sub(half_turning(c), dd_div(dd_mul(dd_scale(dd_mul(c->rate, per), 0.5), drift), level));
}

/*
 * m >= 0.7, nome q' = exp(-pi K/K'), v = pi u/2K' with u reduced to -K .. K:
 * N = sum q'^(n(n+1)/2) [cos((2n+1)x) cosh((2n+1)v/2) - i sin((2n+1)x) sinh((2n+1)v/2)], x = s pi (K' - eta)/4K',
 * and a part of psi linear in u that is added to kappa. On the separatrix K is infinite and q' = 0.
 */
static dd prepare_hyperbolic(const canonical_motion *c, dd k, dd k_prime, free_body *f, dd *real, dd *imag)
{
    static const dd pi = DD_PI;
    const int endless = !(c->complement.hi > 0.0);
    const dd per = dd_div(pi, k_prime);
    const dd nome = endless ? dd_of(0.0) : dd_exp(dd_negative(dd_mul(per, k)));
    theta_terms t;
    theta_terms_of(nome, &t);
    dd work[SERIES];
    scaled(t.odd, dd_of(1.0), 1.0, work);
    odd_series(work, 1.0, f->series[3]);
    scaled(t.even, dd_div(t.theta2, t.theta4), -1.0, work);
    even_series(work, f->series[0]);
    scaled(t.odd, dd_div(t.theta3, t.theta4), -1.0, work);
    odd_series(work, -1.0, f->series[1]);
    scaled(t.even, dd_div(t.theta2, t.theta3), 1.0, work);
    even_series(work, f->series[2]);

    const dd turns = dd_scale(dd_div(dd_sub(k_prime, c->eta), k_prime), 0.125*c->s); /* x/(2 pi) */
    const dd v = dd_scale(dd_mul(per, c->u), 0.5);
    const dd up = dd_exp(dd_scale(v, 0.5)), down = dd_div(dd_of(1.0), up);
    const dd up2 = dd_square(up), down2 = dd_square(down);
    dd plus = up, minus = down, sine, cosine, product = dd_of(1.0), step = nome;
    dd real_terms[TERMS], imag_terms[TERMS], drift = dd_of(0.0), level = dd_of(0.0);
    dd_sincos_turns(turns, &sine, &cosine);
    const dd c2 = dd_sub(dd_square(cosine), dd_square(sine)), s2 = dd_scale(dd_mul(sine, cosine), 2.0);
    *real = *imag = dd_of(0.0);
    const double decay = 0.5*dd_mul(per, k).hi; /* term n is at most exp(-decay n^2) of the first, n = 6 below 1e-29 */
    for (int n = 0; n < TERMS; ++n) {
        real_terms[n] = imag_terms[n] = dd_of(0.0);
        if (n > 0 && (endless || decay*n*n > 80.0))
            continue;
        real_terms[n] = dd_mul(product, cosine);
        imag_terms[n] = dd_negative(dd_mul(product, sine));
        *real = dd_add(*real, dd_scale(dd_mul(real_terms[n], dd_add(plus, minus)), 0.5));
        *imag = dd_add(*imag, dd_scale(dd_mul(imag_terms[n], dd_sub(plus, minus)), 0.5));
        drift = dd_add(drift, dd_mul(imag_terms[n], dd_of(n + 0.5)));
        level = dd_add(level, real_terms[n]);
        product = dd_mul(product, step);
        step = dd_mul(step, nome);
        plus = dd_mul(plus, up2);
        minus = dd_mul(minus, down2);
        const dd next = dd_sub(dd_mul(cosine, c2), dd_mul(sine, s2));
        sine = dd_add(dd_mul(sine, c2), dd_mul(cosine, s2));
        cosine = next;
    }
    odd_series(real_terms, 1.0, f->series[4]);
    odd_series(imag_terms, -1.0, f->series[5]);
    const dd v_rate = dd_scale(dd_mul(per, c->rate), 0.5);
    dd kappa = dd_sub(half_turning(c), dd_div(dd_mul(v_rate, drift), level));
    if (endless) {
        f->regime = SEPARATRIX;
        store(v_rate, f->axial);
        store(v, f->axial + 2);
        return kappa;
    }
    const dd slope = dd_scale(turns, 2.0); /* s (K' - eta)/4K' revolutions per 2K */
    f->regime = HYPERBOLIC;
    f->slope = slope.hi;
    f->stretch = dd_mul(per, k).hi;
    store_phase(dd_scale(dd_div(c->rate, k), 0.25), dd_scale(dd_div(c->u, k), 0.25), f->axial);
    const dd even = dd_mul(dd_div(dd_mul(slope, pi), k), c->rate); /* slope * 2 pi * lambda/2K, rad */
    /* at the start the phase belongs to u0, which lies between -K and K */
    return dd_sub(kappa, even);
}

static void prepare_attitude(const canonical_motion *c, dd real, dd imag, dd lead, const dd q0[4], const body_axes *axes,
    free_body *f)
{
    dd x[4], spun[4], back[4], left[4], turn[4], right[4], column[4];
    dd sine = dd_of(0.0), cosine = dd_of(1.0);
    if (lead.hi != 0.0)
        dd_sincos_turns(lead, &sine, &cosine);
    const dd re = dd_sub(dd_mul(real, cosine), dd_mul(imag, sine));
    const dd im = dd_add(dd_mul(real, sine), dd_mul(imag, cosine));
    const dd p[3] = {dd_add(c->total, c->momenta[2]), c->momenta[1], dd_negative(c->momenta[0])};
    x[0] = dd_mul(re, p[0]);
    x[1] = dd_sub(dd_mul(re, p[1]), dd_mul(im, p[2]));
    x[2] = dd_add(dd_mul(re, p[2]), dd_mul(im, p[1]));
    x[3] = dd_mul(im, p[0]);
    normalise(x);
    renaming(c, turn);
    quaternion_product(x, turn, spun);
    quaternion_conjugate(spun, back);
    quaternion_product(q0, back, left);
    quaternion_conjugate(axes->quaternion, back);
    quaternion_product(turn, back, right);
    for (int j = 0; j < 4; ++j) {
        quaternion_times_unit(left, j, column);
        store_column(column, right, j, f);
    }
}

/*
 * Compute the constants of a motion.
 *
 * in   inertia[6]     kg m^2  principal moments, each as hi, lo
 * in   omega[6]       rad/s   angular velocity along the principal axes at time 0, each as hi, lo
 * in   quaternion[8]  1       attitude at time 0, body to space, scalar first, each as hi, lo; any norm but zero
 * in   exact[8]               NULL if pairs of doubles represent all inputs exactly; otherwise, each as hi, lo:
 *                             I2 - I3, I3 - I1, I1 - I2 and |L|^2 - 2 T I_mid, the latter divided by the square of the
 *                             largest moment times the largest |omega_i|
 * in   axes[26]       1       NULL if the axes of the body are principal; otherwise, each as hi, lo, the matrix, row by
 *                             row, and the unit quaternion that convert principal components to components in the axes
 *                             of the body: quaternion[] is then the attitude of the axes of the body, omega[] is still
 *                             along the principal axes, and the motion is returned in the axes of the body
 * out  f                      the constants
 *
 * Domain: moments positive and finite, |omega| finite. Components of omega below 1e-150 of the largest count as zero,
 * except about the middle axis, where rotation is unstable: there they are outside the domain.
 * Returns 0; 1 if the numbers are outside this domain; 2 if the compiler has broken error-free arithmetic.
 */
int symrot_free_body_prepare(
    const double inertia[6], const double omega[6], const double quaternion[8], const double *exact,
    const double *axes, free_body *f)
{
    static const dd pi = DD_PI;
    static const free_body blank;
    *f = blank;
    if (!dd_sound())
        return 2;
    for (int i = 0; i < 6; ++i)
        if (!(fabs(inertia[i]) <= 1e308 && fabs(omega[i]) <= 1e308))
            return 1;
    const double moment_scale = near_power(inertia, 3), omega_scale = near_power(omega, 3);
    dd moments[3], w[3], given[4], q0[4], differences[3], defect;
    body_axes frame;
    for (int i = 0; i < 3; ++i) {
        moments[i] = dd_pair(inertia[2*i]/moment_scale, inertia[2*i + 1]/moment_scale);
        w[i] = dd_pair(omega[2*i]/omega_scale, omega[2*i + 1]/omega_scale);
        if (fabs(w[i].hi) < 1e-150)
            w[i] = dd_of(0.0);
        if (!(moments[i].hi > 0.0))
            return 1;
    }
    const double quaternion_scale = near_power(quaternion, 4);
    for (int i = 0; i < 4; ++i)
        given[i] = dd_pair(quaternion[2*i]/quaternion_scale, quaternion[2*i + 1]/quaternion_scale);
    normalise(given);
    take_axes(axes, &frame);
    quaternion_product(given, frame.quaternion, q0);
    if (!(fabs(q0[0].hi) <= 2.0))
        return 1;
    f->time_scale = omega_scale;
    if (exact != NULL) {
        for (int i = 0; i < 3; ++i)
            differences[i] = dd_pair(exact[2*i]/moment_scale, exact[2*i + 1]/moment_scale);
        dd largest[2] = {{0.0, 0.0}, {0.0, 0.0}};
        for (int i = 0; i < 3; ++i) {
            largest[0] = dd_less(largest[0], moments[i]) ? moments[i] : largest[0];
            largest[1] = dd_less(largest[1], dd_abs(w[i])) ? dd_abs(w[i]) : largest[1];
        }
        defect = dd_mul(dd_pair(exact[6], exact[7]), dd_square(dd_mul(largest[0], largest[1])));
    } else {
        for (int i = 0; i < 3; ++i)
            differences[i] = dd_sub(moments[(i + 1)%3], moments[(i + 2)%3]);
        defect = exact_defect(moments, w);
    }
    int steady = 1;
    for (int i = 0; i < 3; ++i)
        steady = steady && !(differences[i].hi != 0.0 && w[(i + 1)%3].hi != 0.0 && w[(i + 2)%3].hi != 0.0);
    if (steady) {
        for (int i = 0; i < 3; ++i) {
            const int middle = differences[(i + 1)%3].hi*differences[(i + 2)%3].hi > 0.0;
            if (middle && w[i].hi != 0.0 && (omega[2*((i + 1)%3)] != 0.0 || omega[2*((i + 2)%3)] != 0.0))
                return 1;
        }
        prepare_steady(w, q0, &frame, omega_scale, f);
        return 0;
    }
    canonical_motion c;
    canonical(moments, w, differences, defect, &c);
    const dd endless = dd_of(0.0);
    const dd half_pi = dd_scale(pi, 0.5);
    const dd k = c.complement.hi > 0.0 ? dd_div(half_pi, dd_agm(dd_sqrt(c.complement))) : endless;
    const dd k_prime = c.modulus.hi > 0.0 ? dd_div(half_pi, dd_agm(dd_sqrt(c.modulus))) : endless;
    dd real, imag, kappa, lead = dd_of(0.0);
    if (c.modulus.hi < 0.7)
        kappa = prepare_circular(&c, k, k_prime, f, &real, &imag);
    else
        kappa = prepare_hyperbolic(&c, k, k_prime, f, &real, &imag);
    if (f->regime == HYPERBOLIC)
        lead = dd_scale(dd_mul(dd_div(c.u, k), dd_of(f->slope)), 0.5); /* the sawtooth of psi/2 at the start */
    store_phase(dd_scale(dd_div(kappa, pi), 0.5), dd_of(0.0), f->turning);
    prepare_attitude(&c, real, imag, lead, q0, &frame, f);
    const double signs[3] = {1.0, c.s, 1.0};
    for (int n = 0; n < 3; ++n) {
        const dd amplitude = dd_scale(dd_div(c.amplitudes[n], c.moments[n]), signs[n]*c.direction[n]);
        f->momentum[n] = signs[n]*dd_div(c.amplitudes[n], c.total).hi;
        store_omega(&frame, c.axis[n], amplitude, omega_scale, n, f);
    }
    return 0;
}

/* The length of the constants in doubles, for callers that allocate them. */
ptrdiff_t symrot_free_body_length(void)
{
    return (ptrdiff_t)(sizeof(free_body)/sizeof(double));
}

/*
 * A symmetric body with a rotor of constant angular momentum h along its axis, free: two steady rotations.
 *
 * With L = (A w1, A w2, C w3 + h), of constant length, omega = L/A + e3 (w3 - (C w3 + h)/A), so
 *     q(t) = exp(n |L| t/2A) q(0) exp(e3 sigma t/2),  n = L in space/|L|,  sigma = w3 - (C w3 + h)/A,
 * and the transverse part of omega turns at -sigma in the body. Landau & Lifshitz, Mechanics, 3rd ed., section 33, for
 * h = 0. Compile with -ffp-contract=off.
 */
#include "series.h"

typedef struct {
    double regime;         /* 0 */
    double time_scale;     /* a power of two; times are multiplied by it */
    double precession[4];  /* the phase |L| t/2A */
    double spin[4];        /* the phase sigma t/2 */
    double omega[3][3];    /* from cos sigma t, sin sigma t, 1 to omega, rad/s */
    double attitude[4][4]; /* from the products of cosines and sines of both phases to q */
} gyrostat;

/*
 * Find the constants of a motion.
 *
 * in   moments[4]     kg m^2    A > 0, C, each as hi, lo
 * in   rotor[2]       kg m^2/s  h, along e3
 * in   omega[6]       rad/s     along e1, e2, e3 at time 0, each as hi, lo
 * in   quaternion[8]  1         attitude of e1, e2, e3 at time 0, scalar first
 * in   axis           1         3 numbers: which axes of the body e1, e2, e3 are
 * out  g                        the constants
 * Returns 0; 1 where the numbers are not of this domain; 2 where the compiler has broken error-free arithmetic.
 */
int symrot_gyrostat_prepare(
    const double moments[4], const double rotor[2], const double omega[6], const double quaternion[8],
    const double axis[4], gyrostat *g)
{
    static const dd pi = DD_PI;
    static const gyrostat blank;
    *g = blank;
    if (!dd_sound())
        return 2;
    if (!(moments[0] > 0.0 && moments[0] <= 1e150 && fabs(moments[2]) <= 1e150 && fabs(rotor[0]) <= 1e150))
        return 1;
    for (int i = 0; i < 6; ++i)
        if (!(fabs(omega[i]) <= 1e150))
            return 1;
    const dd a = dd_pair(moments[0], moments[1]);
    const dd shape = dd_div(dd_pair(moments[2], moments[3]), a), extra = dd_div(dd_pair(rotor[0], rotor[1]), a);
    const double fastest[2] = {extra.hi, 0.0};
    const double scale = fmax(near_power(omega, 3), near_power(fastest, 1));
    if (!(scale > 1e-140 && scale < 1e140))
        return 1;
    g->time_scale = scale;
    dd w[3], q0[4], back[4];
    for (int i = 0; i < 3; ++i)
        w[i] = dd_pair(omega[2*i]/scale, omega[2*i + 1]/scale);
    const double quaternion_scale = near_power(quaternion, 4);
    for (int i = 0; i < 4; ++i)
        q0[i] = dd_pair(quaternion[2*i]/quaternion_scale, quaternion[2*i + 1]/quaternion_scale);
    normalise(q0);
    if (!(fabs(q0[0].hi) <= 2.0))
        return 1;
    const dd along = dd_add(dd_mul(shape, w[2]), dd_scale(extra, 1.0/scale)); /* L3/A */
    const dd sigma = dd_sub(w[2], along);
    const dd speed = dd_sqrt(dd_add(dd_add(dd_square(w[0]), dd_square(w[1])), dd_square(along)));
    store_phase(dd_scale(dd_div(speed, pi), 0.25), dd_of(0.0), g->precession);
    store_phase(dd_scale(dd_div(sigma, pi), 0.25), dd_of(0.0), g->spin);

    int name[3];
    double rows[3][3] = {{0.0}};
    for (int k = 0; k < 3; ++k) {
        name[k] = (int)axis[k];
        rows[k][name[k]] = 1.0;
    }
    g->omega[name[0]][0] = w[0].hi*scale;
    g->omega[name[0]][1] = w[1].hi*scale;
    g->omega[name[1]][0] = w[1].hi*scale;
    g->omega[name[1]][1] = -w[0].hi*scale;
    g->omega[name[2]][2] = w[2].hi*scale;

    /* the cyclic renaming of the axes, as a quaternion: e_k = axis name[k] */
    dd renaming[4];
    const double trace = rows[0][0] + rows[1][1] + rows[2][2];
    renaming[0] = dd_of(1.0 + trace);
    renaming[1] = dd_of(rows[2][1] - rows[1][2]);
    renaming[2] = dd_of(rows[0][2] - rows[2][0]);
    renaming[3] = dd_of(rows[1][0] - rows[0][1]);
    normalise(renaming);
    for (int i = 0; i < 4; ++i)
        back[i] = i ? dd_negative(renaming[i]) : renaming[i];
    dd start[4], n_body[4] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}, axial[4] = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};
    quaternion_product(q0, back, start); /* attitude of e1, e2, e3 */
    const dd direction[3] = {w[0], w[1], along};
    for (int i = 0; i < 3; ++i)
        n_body[i + 1] = speed.hi > 0.0 ? dd_div(direction[i], speed) : dd_of(0.0);
    /* n in space times q0 is q0 times n in the body */
    dd columns[4][4], turned[4], plain[4];
    quaternion_product(start, n_body, turned);
    for (int i = 0; i < 4; ++i)
        plain[i] = start[i];
    quaternion_product(plain, renaming, columns[0]);
    quaternion_product(plain, axial, columns[1]);
    quaternion_product(turned, renaming, columns[2]);
    quaternion_product(turned, axial, columns[3]);
    for (int j = 1; j < 4; j += 2) {
        dd named[4];
        quaternion_product(columns[j], renaming, named);
        for (int i = 0; i < 4; ++i)
            columns[j][i] = named[i];
    }
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
            g->attitude[i][j] = columns[j][i].hi;
    return 0;
}

ALWAYS_INLINE void at_both(
    const gyrostat *restrict f, ptrdiff_t count, const double *restrict times, double *restrict omega,
    double *restrict q, int want_omega, int want_q)
{
    const gyrostat g = *f;
    const phase precession = phase_of(g.precession), spin = phase_of(g.spin);
    for (ptrdiff_t i = 0; i < count; ++i) {
        const double t = times[i]*g.time_scale;
        double taken, s, c;
        const double rest = phase_rest(&spin, t, 4.0, 0.0, &taken);
        sincos_quarters(rest, taken, &s, &c);
        if (want_omega) {
            const double c2 = (c - s)*(c + s), s2 = 2.0*s*c;
            omega[3*i] = MUL_ADD(g.omega[0][0], c2, MUL_ADD(g.omega[0][1], s2, g.omega[0][2]));
            omega[3*i + 1] = MUL_ADD(g.omega[1][0], c2, MUL_ADD(g.omega[1][1], s2, g.omega[1][2]));
            omega[3*i + 2] = MUL_ADD(g.omega[2][0], c2, MUL_ADD(g.omega[2][1], s2, g.omega[2][2]));
        }
        if (want_q) {
            double sine, cosine;
            const double turn = phase_rest(&precession, t, 4.0, 0.0, &taken);
            sincos_quarters(turn, taken, &sine, &cosine);
            const double x0 = cosine*c, x1 = cosine*s, x2 = sine*c, x3 = sine*s;
            const double (*map)[4] = g.attitude;
            q[4*i] = MUL_ADD(map[0][0], x0, MUL_ADD(map[0][1], x1, MUL_ADD(map[0][2], x2, map[0][3]*x3)));
            q[4*i + 1] = MUL_ADD(map[1][0], x0, MUL_ADD(map[1][1], x1, MUL_ADD(map[1][2], x2, map[1][3]*x3)));
            q[4*i + 2] = MUL_ADD(map[2][0], x0, MUL_ADD(map[2][1], x1, MUL_ADD(map[2][2], x2, map[2][3]*x3)));
            q[4*i + 3] = MUL_ADD(map[3][0], x0, MUL_ADD(map[3][1], x1, MUL_ADD(map[3][2], x2, map[3][3]*x3)));
        }
    }
}

/* The motion at times counted from that of the initial state; arguments as symrot_free_body_at. */
void symrot_gyrostat_at(const gyrostat *g, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    if (omega != NULL && quaternion != NULL)
        at_both(g, count, times, omega, quaternion, 1, 1);
    else if (quaternion != NULL)
        at_both(g, count, times, omega, quaternion, 0, 1);
    else if (omega != NULL)
        at_both(g, count, times, omega, quaternion, 1, 0);
}

/* The length of the constants in doubles, for callers that lay them out themselves. */
ptrdiff_t symrot_gyrostat_length(void)
{
    return (ptrdiff_t)(sizeof(gyrostat)/sizeof(double));
}

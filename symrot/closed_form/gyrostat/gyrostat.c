/* The constants of a gyrostat's motion, in double-double arithmetic. The formulas are in gyrostat.h. */
#include "gyrostat.h"
#include "series.h"

/*
 * Compute the constants of a motion.
 *
 * in   moments[4]     kg m^2    A > 0, C, each as hi, lo
 * in   rotor[2]       kg m^2/s  h, along e3
 * in   omega[6]       rad/s     along e1, e2, e3 at time 0, each as hi, lo
 * in   quaternion[8]  1         attitude of e1, e2, e3 at time 0, scalar first
 * in   axis           1         the numbers of the body axes that are e1, e2, e3
 * out  g                        the constants
 * Returns 0; 1 if the numbers are outside this domain; 2 if the compiler has broken error-free arithmetic.
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

    /* the cyclic permutation of the axes, as a quaternion: e_k = axis name[k] */
    dd renaming[4];
    const double trace = rows[0][0] + rows[1][1] + rows[2][2];
    renaming[0] = dd_of(1.0 + trace);
    renaming[1] = dd_of(rows[2][1] - rows[1][2]);
    renaming[2] = dd_of(rows[0][2] - rows[2][0]);
    renaming[3] = dd_of(rows[1][0] - rows[0][1]);
    normalise(renaming);
    quaternion_conjugate(renaming, back);
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

/* The length of the constants in doubles, for callers that allocate them. */
ptrdiff_t symrot_gyrostat_length(void)
{
    return (ptrdiff_t)(sizeof(gyrostat)/sizeof(double));
}

/* A symmetric body under a constant torque about its axis at any time, from its constants. The formulas: spin_up.h. */
#include "spin_up.h"
#include "circular.h"
#include "double_double.h"

/* log((i + 1/2)/32) for i from 16 to 31. */
static const dd LOGARITHMS[] = {
    {-0x1.5322e26867857p-1, -0x1.988ba4aea614dp-56},
    {-0x1.35028ad9d8c86p-1, 0x1.f01ab6065515cp-56},
    {-0x1.188ee40f23ca6p-1, -0x1.89df1568ca0b0p-55},
    {-0x1.fb358af7a4884p-2, -0x1.7e8f05924d259p-57},
    {-0x1.c7ff9c74554c9p-2, -0x1.223eadb651b4ap-57},
    {-0x1.973a3431356aep-2, 0x1.89d2816cf838fp-57},
    {-0x1.68ac83e9c6a14p-2, -0x1.a64eadd740178p-58},
    {-0x1.3c25277333184p-2, 0x1.2ad27e50a8ec6p-56},
    {-0x1.1178e8227e47cp-2, 0x1.0e63a5f01c691p-57},
    {-0x1.d1037f2655e7bp-3, -0x1.60629242471a2p-57},
    {-0x1.823c16551a3c2p-3, 0x1.1232ce70be781p-57},
    {-0x1.365fcb0159016p-3, -0x1.7d411a5b944adp-58},
    {-0x1.da727638446a2p-4, -0x1.401fa71733019p-58},
    {-0x1.4d3115d207eacp-4, -0x1.769f42c7842ccp-58},
    {-0x1.894aa149fb343p-5, -0x1.a8be97660a23dp-60},
    {-0x1.0205658935847p-6, -0x1.27c8e8416e71fp-60},
};

static const dd THIRD = {0x1.5555555555555p-2, 0x1.5555555555555p-56},
    FIFTH = {0x1.999999999999ap-3, -0x1.999999999999ap-57},
    SEVENTH = {0x1.2492492492492p-3, 0x1.2492492492492p-57},
    NINTH = {0x1.c71c71c71c71cp-4, 0x1.c71c71c71c71cp-58}; /* 1/3 .. 1/9 */

/* atanh(x)/x for |x| <= 1/60. */
ALWAYS_INLINE dd atanh_small(dd x)
{
    const dd square = dd_square(x);
    double tail = 1.0/19.0;
    tail = tail*square.hi + 1.0/17.0;
    tail = tail*square.hi + 1.0/15.0;
    tail = tail*square.hi + 1.0/13.0;
    tail = tail*square.hi + 1.0/11.0;
    dd sum = dd_add(dd_mul(square, dd_of(tail)), NINTH);
    sum = dd_add(dd_mul(sum, square), SEVENTH);
    sum = dd_add(dd_mul(sum, square), FIFTH);
    sum = dd_add(dd_mul(sum, square), THIRD);
    return dd_add(dd_mul(sum, square), dd_of(1.0));
}

/* asinh(z)/z from z and root = sqrt(1 + z^2). */
ALWAYS_INLINE dd asinh_ratio(dd z, dd root)
{
    static const dd ln2 = DD_LN2;
    const dd above = dd_add(root, dd_of(1.0));
    if (fabs(z.hi) <= 0x1p-5) {
        const dd tau = dd_div(z, above);
        return dd_div(dd_scale(atanh_small(tau), 2.0), above);
    }
    const dd size = dd_abs(z), w = dd_add(size, root);
    int octave;
    const double part = frexp(w.hi, &octave);
    const dd f = dd_scale(w, ldexp(1.0, -octave));
    const int i = part < 1.0 ? (int)(32.0*part) : 16; /* what left the doubles is written by integers, from Python */
    const dd middle = dd_of((i + 0.5)/32.0);
    const dd r = dd_div(dd_sub(f, middle), dd_add(f, middle));
    const dd log = dd_add(dd_mul(dd_of(octave), ln2), LOGARITHMS[i - 16]);
    return dd_div(dd_add(log, dd_scale(dd_mul(atanh_small(r), r), 2.0)), size);
}

/* A phase in turns, less whole ones: its sine and cosine. */
ALWAYS_INLINE void circle(dd turns, double *sine, double *cosine)
{
    const double whole = turns.hi - rint(turns.hi), small = turns.lo - rint(turns.lo);
    const double quarters = rint(4.0*(whole + small));
    sincos_quarters((whole - 0.25*quarters) + small, quarters, sine, cosine);
}

ALWAYS_INLINE double series_of(const double *c, int count, double x)
{
    double sum = c[count - 1];
    for (int n = count - 2; n >= 0; --n)
        sum = MUL_ADD(sum, x, c[n]);
    return sum;
}

/* Far from resonance: the attitude of the turning axes, from where the side is counted. */
static void far(const spin_up *f, const spin_up_side *side, dd from_speed, dd t, dd omega, double a[2], double b[2])
{
    static const dd quarter = {0x1.45f306dc9c883p-4, -0x1.6b01ec5417056p-58}; /* 1/(4 pi) */
    const dd s = dd_pair(f->sweep[2], f->sweep[3]), w = dd_pair(f->across[0], f->across[1]), w2 = dd_square(w);
    const dd from = dd_pair(side->sweep[0], side->sweep[1]);
    const dd here2 = dd_add(dd_square(omega), w2);
    const dd speed = dd_sqrt(here2), product = dd_mul(omega, from);
    const dd speeds = dd_mul(speed, from_speed);
    const dd sum = product.hi >= 0.0
        ? dd_add(speeds, product)
        : dd_div(dd_mul(w2, dd_add(here2, dd_square(from))), dd_sub(speeds, product));
    const dd middle = dd_sqrt(dd_scale(dd_add(w2, sum), 0.5));
    const dd time = dd_sub(t, dd_pair(side->time[0], side->time[1]));
    const dd half = dd_scale(dd_div(time, middle), 0.5), z = dd_mul(s, half);
    const dd root = dd_sqrt(dd_add(dd_of(1.0), dd_square(z)));
    const dd angle = dd_mul(half, dd_add(dd_mul(root, sum), dd_mul(w2, asinh_ratio(z, root))));

    const double r = 1.0/speed.hi, sine = w.hi*r, cosine = omega.hi*r, y = f->unit*r*r;
    const double m1 = sine*cosine*(y*y)*series_of(f->g, SPIN_UP_SERIES, y);
    const double m2 = sine*y*series_of(f->c, SPIN_UP_SERIES, y);
    const double delta = cosine*series_of(f->e, SPIN_UP_SERIES, y) - side->delta;
    double turned, along;
    circle(dd_add(dd_mul(angle, quarter), dd_of(delta*quarter.hi)), &turned, &along);
    const double across2 = m1*m1 + m2*m2, m3 = 1.0 + sqrt(1.0 - across2), norm = 1.0/sqrt(m3*m3 + across2);
    const double n0 = m3*norm, n1 = m1*norm, n2 = m2*norm;
    const double larger = sqrt(0.5 + 0.5*fabs(cosine)), smaller = 0.5*sine/larger;
    const double c = cosine >= 0.0 ? larger : smaller, d = cosine >= 0.0 ? smaller : larger;
    const double a0 = n0*c - n1*d, a1 = -n2*d, b0 = n2*c, b1 = -(n0*d + n1*c);
    a[0] = along*a0 - turned*a1;
    a[1] = along*a1 + turned*a0;
    b[0] = along*b0 - turned*b1;
    b[1] = along*b1 + turned*b0;
}

/* Near resonance: the same from x = 0, by Taylor's polynomials. */
static void near(const spin_up *f, const double *table, dd omega, double a[2], double b[2])
{
    const double sign = omega.hi < 0.0 ? -1.0 : 1.0;
    const dd x = dd_scale(dd_mul(omega, dd_pair(f->inverse[0], f->inverse[1])), sign);
    const double piece = fmin(floor(x.hi*SPIN_UP_PIECES), SPIN_UP_COUNT - 1); /* the edge itself is in the last one */
    const double rest = (x.hi - (piece + 0.5)/SPIN_UP_PIECES) + x.lo;
    const double *at = table + 4*SPIN_UP_TAYLOR*(ptrdiff_t)piece;
    double q[4];
    for (int k = 0; k < 4; ++k)
        q[k] = at[4*(SPIN_UP_TAYLOR - 1) + k];
    for (int n = SPIN_UP_TAYLOR - 2; n >= 0; --n)
        for (int k = 0; k < 4; ++k)
            q[k] = MUL_ADD(q[k], rest, at[4*n + k]);
    a[0] = q[0];
    a[1] = q[3];
    b[0] = sign*q[1];
    b[1] = sign*q[2];
}

/*
 * The motion at times counted from that of the initial state.
 *
 * in   f           the constants
 * in   table       Taylor's polynomials, 40 times 20 times 4 numbers; not read unless a sample is near resonance
 * in   times       s
 * out  omega       rad/s, 3 of each sample, or NULL
 * out  quaternion  1, 4 of each sample, or NULL
 */
void symrot_spin_up_at(
    const spin_up *f, const double *table, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    const dd first = dd_pair(f->turn[0], f->turn[1]), second = dd_pair(f->turn[2], f->turn[3]);
    const dd start = dd_pair(f->sweep[0], f->sweep[1]), s = dd_pair(f->sweep[2], f->sweep[3]);
    dd speeds[2];
    for (int k = 0; k < 2; ++k) {
        const dd w = dd_pair(f->across[0], f->across[1]), from = dd_pair(f->side[k].sweep[0], f->side[k].sweep[1]);
        speeds[k] = dd_sqrt(dd_add(dd_square(from), dd_square(w)));
    }
    for (ptrdiff_t i = 0; i < count; ++i) {
        const dd t = dd_of(times[i]*f->time_scale);
        double sine, cosine;
        circle(dd_mul(t, dd_add(first, dd_mul(t, second))), &sine, &cosine);
        if (omega != NULL) {
            const double c = (cosine - sine)*(cosine + sine), d = 2.0*sine*cosine;
            const dd w3 = dd_add(dd_pair(f->spin[0], f->spin[1]), dd_mul(t, dd_pair(f->spin[2], f->spin[3])));
            for (int k = 0; k < 3; ++k)
                omega[3*i + k] = MUL_ADD(f->rates[k][0], c, MUL_ADD(f->rates[k][1], d, f->axial[k]*w3.hi));
        }
        if (quaternion == NULL)
            continue;
        const dd here = dd_add(start, dd_mul(s, t));
        const double(*map)[4] = f->near_attitude;
        double a[2], b[2];
        if (f->wide != 0.0 || !(fabs(here.hi) < f->edge)) {
            const int k = f->wide == 0.0 && here.hi > 0.0;
            const spin_up_side *side = &f->side[k];
            far(f, side, speeds[k], t, here, a, b);
            map = side->attitude;
        } else
            near(f, table, here, a, b);
        const double q0 = a[0]*cosine + a[1]*sine, q3 = a[1]*cosine - a[0]*sine;
        const double q1 = b[0]*cosine - b[1]*sine, q2 = b[1]*cosine + b[0]*sine;
        for (int k = 0; k < 4; ++k)
            quaternion[4*i + k] =
                MUL_ADD(map[k][0], q0, map[k][1]*q1) + MUL_ADD(map[k][2], q2, map[k][3]*q3);
    }
}

/* The length of the constants in doubles, for callers that lay them out themselves. */
ptrdiff_t symrot_spin_up_length(void)
{
    return (ptrdiff_t)(sizeof(spin_up)/sizeof(double));
}

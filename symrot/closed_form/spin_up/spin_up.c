/* The constants of a symmetric body's motion under a constant torque about its axis, once. The formulas: spin_up.h. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O2") /* the table takes most of the time */
#endif

#include "spin_up_phase.h"
#include "spin_up_series.h"
#include "series.h"

enum {
    TERMS = 26, /* of a series near resonance, for a step of 1/4: (r/8)^26/26! < 1e-20 for r < 13.5 */
    FINE = 10,  /* of them in double-double arithmetic: the 10th is below 1e-4 */
    LARGEST = 900
};

/* The body in e1, e2, e3, scaled. */
typedef struct {
    dd ratio, start, s, across, root; /* C/A, Omega at time 0, s, W, sqrt(s) */
    dd axes[4], given[4];             /* the turn from e1, e2, e3 to the body's axes; their attitude at time 0 */
} body;

static int exponent_of(double x)
{
    int e = -3*LARGEST;
    if (x != 0.0)
        (void)frexp(x, &e);
    return e;
}

static int larger_of(int a, int b)
{
    return a > b ? a : b;
}

static dd shifted(dd x, int e)
{
    return dd_pair(ldexp(x.hi, e), ldexp(x.lo, e));
}

static void conjugated(const dd q[4], dd to[4])
{
    for (int i = 0; i < 4; ++i)
        to[i] = i ? dd_negative(q[i]) : q[i];
}

/* The turn from e1, e2, e3 to the body's axes, e1 along (first, second): Shepperd's choice of the largest component. */
static void body_axes_of(int axis, double sign, dd first, dd second, dd q[4])
{
    static const dd zero;
    const int a = (axis + 1)%3, b = (axis + 2)%3;
    dd r[3][3] = {{{0.0, 0.0}}};
    r[a][0] = first;
    r[b][0] = second;
    r[a][1] = dd_scale(second, -sign);
    r[b][1] = dd_scale(first, sign);
    r[axis][2] = dd_of(sign);
    dd largest = zero;
    for (int k = -1; k < 3; ++k) {
        dd square = dd_of(1.0);
        for (int i = 0; i < 3; ++i)
            square = dd_add(square, dd_scale(r[i][i], k < 0 || k == i ? 1.0 : -1.0));
        if (square.hi <= largest.hi)
            continue;
        largest = square;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1)%3, l = (i + 2)%3;
            const dd twist = dd_sub(r[l][j], r[j][l]);
            if (k < 0)
                q[i + 1] = twist;
            else if (k == i) {
                q[0] = twist;
                q[i + 1] = square;
            } else
                q[i + 1] = dd_add(r[i][k], r[k][i]);
        }
        if (k < 0)
            q[0] = square;
    }
    normalise(q);
}

/* Far from resonance: q0, q1, q2, q3 of the turning axes, spin_up.h, but for the phase P/(4 pi) given. */
static void far_attitude(const spin_up *f, dd omega, dd turns, dd q[4])
{
    const dd w = dd_pair(f->across[0], f->across[1]), speed = dd_sqrt(dd_add(dd_square(omega), dd_square(w)));
    const dd sine = dd_div(w, speed), cosine = dd_div(omega, speed);
    const double y = f->unit/(speed.hi*speed.hi);
    const dd m1 = dd_of(sine.hi*cosine.hi*(y*y)*series_of(f->g, y)), m2 = dd_of(sine.hi*y*series_of(f->c, y));
    const dd m3 = dd_add(dd_of(1.0), dd_sqrt(dd_sub(dd_of(1.0), dd_add(dd_square(m1), dd_square(m2)))));
    dd n[4] = {m3, m1, m2, {0.0, 0.0}}, plus, even;
    normalise(n);
    const dd larger = dd_sqrt(dd_scale(dd_add(dd_of(1.0), dd_abs(cosine)), 0.5));
    const dd smaller = dd_div(sine, dd_scale(larger, 2.0));
    const dd c = cosine.hi >= 0.0 ? larger : smaller, d = cosine.hi >= 0.0 ? smaller : larger;
    const dd a0 = dd_sub(dd_mul(n[0], c), dd_mul(n[1], d)), a1 = dd_negative(dd_mul(n[2], d)), b0 = dd_mul(n[2], c);
    const dd b1 = dd_negative(dd_add(dd_mul(n[0], d), dd_mul(n[1], c)));
    const dd delta = dd_mul(dd_of(cosine.hi*series_of(f->e, y)), SPIN_UP_QUARTER);
    dd_sincos_turns(dd_add(dd_sub(turns, dd_of(rint(turns.hi))), delta), &plus, &even);
    q[0] = dd_sub(dd_mul(even, a0), dd_mul(plus, a1));
    q[3] = dd_add(dd_mul(even, a1), dd_mul(plus, a0));
    q[1] = dd_sub(dd_mul(even, b0), dd_mul(plus, b1));
    q[2] = dd_add(dd_mul(even, b1), dd_mul(plus, b0));
}

/* The same with its phase. */
static void swept_attitude(const spin_up *f, dd omega, dd q[4])
{
    const dd w = dd_pair(f->across[0], f->across[1]), speed = dd_sqrt(dd_add(dd_square(omega), dd_square(w)));
    const dd turns = swept_turns(&f->phase, omega, speed, swept_logarithm(omega, speed, 1));
    far_attitude(f, omega, f->phase.way == SPIN_UP_WEAK ? dd_of(0.0) : turns, q);
}

/* The series of q0, q1, q2, q3 about a place from its first terms, the last in doubles; halves: 1/(2 n). */
static void grow(dd kappa, double place, const dd halves[FINE], dd q[TERMS][4])
{
    static const int opposite[4] = {3, 2, 1, 0}, beside[4] = {1, 0, 3, 2};
    static const double swept_sign[4] = {-1.0, 1.0, -1.0, 1.0}, turned_sign[4] = {-1.0, 1.0, 1.0, -1.0};
    static const dd none[4];
    for (int n = 1; n < FINE; ++n) {
        const dd *one = q[n - 1], *two = n > 1 ? q[n - 2] : none, inverse = halves[n];
        for (int k = 0; k < 4; ++k) {
            const dd swept = linear(two[opposite[k]], one[opposite[k]], place), turned = dd_mul(kappa, one[beside[k]]);
            q[n][k] = dd_mul(inverse, added(dd_scale(swept, swept_sign[k]), dd_scale(turned, turned_sign[k])));
        }
    }
    for (int n = FINE; n < TERMS; ++n) {
        const dd *one = q[n - 1], *two = q[n - 2];
        for (int k = 0; k < 4; ++k) {
            const double swept = place*one[opposite[k]].hi + two[opposite[k]].hi;
            q[n][k] = dd_of(0.5/n*(swept_sign[k]*swept + turned_sign[k]*kappa.hi*one[beside[k]].hi));
        }
    }
}

static void sum(dd q[TERMS][4], dd x, dd total[4])
{
    for (int k = 0; k < 4; ++k) {
        double tail = q[TERMS - 1][k].hi;
        for (int n = TERMS - 2; n >= FINE; --n)
            tail = tail*x.hi + q[n][k].hi;
        total[k] = dd_of(tail);
        for (int n = FINE - 1; n >= 0; --n)
            total[k] = added(q[n][k], dd_mul(total[k], x));
    }
}

/* The attitude at -x from that at x, which begins from 1 at x = 0. */
static void mirrored(double sign, dd q[4])
{
    for (int k = 1; k < 3; ++k)
        q[k] = dd_scale(q[k], sign);
}

/*
 * Taylor's polynomials of the attitude that is 1 at x = 0, about the middles of pieces from x = 0 on; that at the last
 * place, and at `there`, the distance of the start, if it is among them.
 */
static void near_table(dd kappa, int pieces, dd there, double *table, dd last[4], dd start[4])
{
    const double half = 0.5/SPIN_UP_PIECES;
    dd q[TERMS][4] = {{{1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}}, halves[FINE];
    for (int n = 1; n < FINE; ++n)
        halves[n] = dd_div(dd_of(0.5), dd_of(n));
    grow(kappa, 0.0, halves, q);
    sum(q, dd_of(half), last);
    for (int piece = 0; piece < pieces; ++piece) {
        const double middle = (2*piece + 1)*half;
        for (int i = 0; i < 4; ++i)
            q[0][i] = last[i];
        grow(kappa, middle, halves, q);
        for (int n = 0; n < SPIN_UP_TAYLOR; ++n)
            for (int i = 0; i < 4; ++i)
                table[4*(SPIN_UP_TAYLOR*piece + n) + i] = q[n][i].hi;
        const dd distance = dd_sub(there, dd_of(middle));
        if (fabs(distance.hi) <= half)
            sum(q, distance, start);
        sum(q, dd_of(piece + 1 < pieces ? 2.0*half : half), last);
    }
}

/* f->attitude of one place: q -> given conj(here) q conj(axes). */
static void store_attitude(const body *own, const dd given[4], const dd here[4], double to[4][4])
{
    dd inverse[4], back[4], left[4], unit[4], once[4], column[4];
    conjugated(here, inverse);
    conjugated(own->axes, back);
    quaternion_product(given, inverse, left);
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k)
            unit[k] = dd_of(k == j);
        quaternion_product(unit, back, once);
        quaternion_product(left, once, column);
        for (int k = 0; k < 4; ++k)
            to[k][j] = column[k].hi;
    }
}

/* given conj(from) to, where `from` and `to` are the same attitude in two places' own terms. */
static void handed_on(const dd given[4], const dd from[4], const dd to[4], dd found[4])
{
    dd inverse[4], left[4];
    conjugated(from, inverse);
    quaternion_product(given, inverse, left);
    quaternion_product(left, to, found);
}

/*
 * P/(4 pi) = t S(0)/(4 pi) sum h^n a_n/(n + 1), sqrt(1 + 2 c h + h^2) = sum a_n h^n, c = Omega(0)/S(0):
 * (n + 1) a_(n+1) = (1 - 2 n) c a_n + (2 - n) a_(n-1).
 */
static void prepare_weak(const body *own, dd speed, spin_up_phase *p)
{
    const dd c = dd_div(own->start, speed);
    dd before = dd_of(0.0), now = dd_of(1.0);
    for (int n = 0; n < SPIN_UP_TERMS; ++n) {
        store(dd_div(now, dd_of(n + 1.0)), p->series[n]);
        const dd next = dd_add(dd_mul(dd_mul(c, now), dd_of(1.0 - 2.0*n)), dd_mul(before, dd_of(2.0 - n)));
        before = now;
        now = dd_div(next, dd_of(n + 1.0));
    }
    p->way = SPIN_UP_WEAK;
    store(dd_div(own->s, speed), p->product);
    store(dd_mul(speed, SPIN_UP_QUARTER), p->share);
}

static void prepare_phase(const body *own, spin_up_phase *p)
{
    const dd square = dd_square(own->across), speed = dd_sqrt(dd_add(dd_square(own->start), square));
    if (!(speed.hi*speed.hi <= 1e15*own->s.hi)) {
        prepare_weak(own, speed, p);
        return;
    }
    const dd product = dd_div(dd_scale(SPIN_UP_QUARTER, 0.5), own->s);
    p->way = own->across.hi*own->across.hi <= 1e5*own->s.hi ? SPIN_UP_PLAIN : SPIN_UP_FINE;
    store(product, p->product);
    store(dd_mul(product, square), p->share);
    store(own->across.hi > 0x1p-1000 ? logarithm(own->across, 1) : dd_of(0.0), p->logarithm);
}

static void prepare_body(int axis, const double numbers[20], body *own, spin_up *f)
{
    dd given[10];
    for (int i = 0; i < 10; ++i)
        given[i] = dd_pair(numbers[2*i], numbers[2*i + 1]);
    const dd across = given[0], moment = given[1], torque = given[2], *w = given + 3;
    const double sign = torque.hi < 0.0 ? -1.0 : 1.0;
    const int a = exponent_of(across.hi), c = exponent_of(moment.hi), m = exponent_of(torque.hi);
    const int size = larger_of(exponent_of(w[0].hi), exponent_of(w[1].hi));
    int scale = larger_of(larger_of(exponent_of(w[2].hi) + c - a, size), torque.hi != 0.0 ? (m - a)/2 : size);
    scale = scale > LARGEST ? LARGEST : scale < -LARGEST ? -LARGEST : scale;
    f->time_scale = ldexp(1.0, scale);
    own->ratio = shifted(dd_div(shifted(moment, -c), shifted(across, -a)), c - a);
    const dd spin = shifted(w[2], -scale), first = shifted(w[0], -size), second = shifted(w[1], -size);
    own->start = dd_scale(dd_mul(spin, own->ratio), sign);
    own->s = shifted(dd_div(dd_abs(shifted(torque, -m)), shifted(across, -a)), m - a - 2*scale);
    own->root = dd_sqrt(own->s);
    const dd width = dd_sqrt(dd_add(dd_square(first), dd_square(second)));
    own->across = shifted(width, size - scale);
    body_axes_of(axis, sign, dd_div(first, width), dd_div(second, width), own->axes);
    const double norm = near_power(numbers + 12, 4);
    dd q[4];
    for (int i = 0; i < 4; ++i)
        q[i] = dd_scale(given[6 + i], 1.0/norm);
    normalise(q);
    quaternion_product(q, own->axes, own->given);

    const dd lag = dd_sub(own->ratio, dd_of(1.0)), growth = dd_scale(dd_div(own->s, own->ratio), 0.5);
    store(dd_scale(dd_mul(dd_mul(lag, spin), SPIN_UP_QUARTER), sign), f->turn);
    store(dd_mul(dd_mul(lag, growth), SPIN_UP_QUARTER), f->turn + 2);
    store(own->start, f->sweep);
    store(own->s, f->sweep + 2);
    store(own->across, f->across);
    store(own->s.hi > 0.0 ? dd_div(dd_of(1.0), own->root) : dd_of(0.0), f->inverse);
    const int one = (axis + 1)%3, two = (axis + 2)%3;
    for (int i = 0; i < 3; ++i) {
        f->rates[i][0] = i == one ? w[0].hi : i == two ? w[1].hi : 0.0;
        f->rates[i][1] = i == one ? -sign*w[1].hi : i == two ? sign*w[0].hi : 0.0;
        f->axial[i] = i == axis;
    }
    store(w[2], f->spin);
    store(dd_scale(shifted(dd_scale(growth, 2.0), scale), sign), f->spin + 2);
}

/* Until when neither phase can have so many rad. */
static double longest_of(const spin_up *f, double most)
{
    const double rad = 1.0/SPIN_UP_QUARTER.hi;
    const double even = fabs(f->sweep[0]) + f->across[0] + fabs(f->turn[0])*rad;
    const double growing = f->sweep[2] + fabs(f->turn[2])*rad;
    return 2.0*most/(even + sqrt(even*even + 4.0*growing*most));
}

/*
 * Find the constants of a motion.
 *
 * in   axis        0, 1, 2   of symmetry; the torque is about it
 * in   numbers[20]           each as hi, lo: moments across the axis and about it, kg m^2, the torque, N m, angular
 *                            velocity at time 0 along the axes axis + 1, axis + 2 (modulo 3) and axis, rad/s, not
 *                            both of the first zero, and the attitude at time 0, body to space, scalar first, of any
 *                            norm
 * in   limits[3]             |x| from which the series hold, kappa from which they hold everywhere, and the rad that
 *                            pairs of doubles count
 * out  table[]               4*limits[0] times 20 times 4 numbers: Taylor's polynomials; NULL where no sample is near
 *                            resonance or beyond it
 * out  f                     the constants
 *
 * Returns 0, or 2 where the compiler has broken error-free arithmetic.
 */
int symrot_spin_up_prepare(int axis, const double numbers[20], const double limits[3], double *table, spin_up *f)
{
    static const spin_up blank;
    body own;
    *f = blank;
    if (!dd_sound())
        return 2;
    prepare_body(axis, numbers, &own, f);
    const double square = own.across.hi*own.across.hi, huge = 1e300;
    const double kappa2 = own.s.hi > 0.0 ? fmin(square/own.s.hi, huge) : huge;
    const double inverse = square > 0.0 ? fmin(own.s.hi/square, huge) : huge;
    const int wide = kappa2 >= limits[1]*limits[1];
    const double radius2 = limits[0]*limits[0] + kappa2;
    const dd edge = dd_mul(own.root, dd_of(limits[0]));
    asymptotic(wide ? 1.0 : kappa2/radius2, wide ? inverse : 1.0/radius2, f);
    f->unit = square + (wide ? 0.0 : limits[0]*limits[0]*own.s.hi);
    prepare_phase(&own, &f->phase);
    f->whole = wide || f->phase.way == SPIN_UP_WEAK;
    f->edge = f->whole != 0.0 ? 0.0 : edge.hi;
    f->longest = longest_of(f, limits[2]);
    dd here[4];
    const int side = f->whole != 0.0 || own.start.hi >= f->edge ? SPIN_UP_BEYOND
        : own.start.hi <= -f->edge ? SPIN_UP_BEFORE : SPIN_UP_NEAR;
    f->start = side;
    if (side != SPIN_UP_NEAR) {
        swept_attitude(f, own.start, here);
        store_attitude(&own, own.given, here, f->attitude[side]);
    }
    if (table == NULL || f->whole != 0.0)
        return 0;
    const dd kappa = dd_div(own.across, own.root), x = dd_div(own.start, own.root);
    dd last[4], start[4], middle[4], far[4];
    near_table(kappa, (int)(limits[0]*SPIN_UP_PIECES), dd_abs(x), table, last, start);
    const double way[3] = {-1.0, 0.0, 1.0};
    if (side == SPIN_UP_NEAR) {
        mirrored(x.hi < 0.0 ? -1.0 : 1.0, start);
        conjugated(start, far);
        quaternion_product(own.given, far, middle);
    } else {
        dd left[4], from[4];
        for (int i = 0; i < 4; ++i)
            from[i] = last[i];
        mirrored(way[side], from);
        swept_attitude(f, dd_scale(edge, way[side]), far);
        handed_on(own.given, here, far, left);
        conjugated(from, far);
        quaternion_product(left, far, middle);
    }
    static const dd one[4] = {{1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
    store_attitude(&own, middle, one, f->attitude[SPIN_UP_NEAR]);
    for (int to = SPIN_UP_BEFORE; to <= SPIN_UP_BEYOND; to += SPIN_UP_BEYOND - SPIN_UP_BEFORE) {
        if (to == side)
            continue;
        dd left[4], leaving[4];
        for (int i = 0; i < 4; ++i)
            leaving[i] = last[i];
        mirrored(way[to], leaving);
        quaternion_product(middle, leaving, left);
        swept_attitude(f, dd_scale(edge, way[to]), far);
        store_attitude(&own, left, far, f->attitude[to]);
    }
    return 0;
}

/* The length of the constants in doubles, for callers that lay them out themselves. */
ptrdiff_t symrot_spin_up_length(void)
{
    return (ptrdiff_t)(sizeof(spin_up)/sizeof(double));
}

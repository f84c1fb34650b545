/* The constants of a symmetric body's motion under a constant torque about its axis. The formulas are in spin_up.h. */
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3") /* the table takes most of the time */
#endif

#include "spin_up_phase.h"
#include "spin_up_series.h"
#include "series.h"
#include <string.h>

enum {
    TERMS = 26, /* of a series near resonance, for a step of 1/4: (r/8)^26/26! < 1e-20 for r < 13.5 */
    FINE = 10,  /* terms in double-double arithmetic: the 10th is below 1e-4 */
    LARGEST = 900
};

/* The body in e1, e2, e3, scaled. */
typedef struct {
    dd ratio, start, s, across, root; /* C/A, Omega at time 0, s, W, sqrt(s) */
    dd axes[4], given[4];             /* rotation from e1, e2, e3 to the body's axes; their attitude at time 0 */
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

/* The rotation from e1, e2, e3 to the body's axes, e1 along (first, second), by the largest component (Shepperd). */
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

/* Far from resonance: q0, q1, q2, q3 of the rotating axes (spin_up.h), for a given phase P/(4 pi). */
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

/* The same, with its phase computed. */
static void swept_attitude(const spin_up *f, dd omega, dd q[4])
{
    const dd w = dd_pair(f->across[0], f->across[1]), speed = dd_sqrt(dd_add(dd_square(omega), dd_square(w)));
    const dd turns = swept_turns(&f->phase, omega, speed, swept_logarithm(omega, speed, 1));
    far_attitude(f, omega, f->phase.way == SPIN_UP_WEAK ? dd_of(0.0) : turns, q);
}

enum { LANES = 8 }; /* motions at once, in SIMD code, since each step depends on the previous one */

/* Quaternions of `lanes` motions in pairs of doubles: the first component of all motions, then the second, .. */
typedef struct {
    double hi[4*LANES], lo[4*LANES];
} quaternions;

/* A number of each motion, over each component. */
typedef quaternions numbers_of_lanes;

/* Components 3, 2, 1, 0. */
ALWAYS_INLINE void opposite(int lanes, const double *from, double *to)
{
    for (int k = 0; k < 4; ++k)
        memcpy(to + k*lanes, from + (3 - k)*lanes, (size_t)lanes*sizeof *to);
}

/* Components 1, 0, 3, 2. */
ALWAYS_INLINE void beside(int lanes, const double *from, double *to)
{
    for (int k = 0; k < 4; ++k)
        memcpy(to + k*lanes, from + (k^1)*lanes, (size_t)lanes*sizeof *to);
}

/* The series of q0, q1, q2, q3 about a point from its first terms, with the last terms in doubles; halves: 1/(2 n). */
ALWAYS_INLINE void grow(
    int lanes, const numbers_of_lanes *kappa, const quaternions signs[2], double place, const dd halves[FINE],
    quaternions q[TERMS])
{
    static const quaternions none;
    for (int n = 1; n < FINE; ++n) {
        const quaternions *two = n > 1 ? q + n - 2 : &none, *one = q + n - 1;
        const dd inverse = halves[n];
        quaternions a, b, c;
        opposite(lanes, two->hi, a.hi);
        opposite(lanes, two->lo, a.lo);
        opposite(lanes, one->hi, b.hi);
        opposite(lanes, one->lo, b.lo);
        beside(lanes, one->hi, c.hi);
        beside(lanes, one->lo, c.lo);
        for (int i = 0; i < 4*lanes; ++i) {
            const dd swept = linear(dd_pair(a.hi[i], a.lo[i]), dd_pair(b.hi[i], b.lo[i]), place);
            const dd turned = dd_mul(dd_pair(kappa->hi[i], kappa->lo[i]), dd_pair(c.hi[i], c.lo[i]));
            const dd both = dd_add_fast(dd_scale(swept, signs[0].hi[i]), dd_scale(turned, signs[1].hi[i]));
            const dd next = dd_mul(inverse, both);
            q[n].hi[i] = next.hi;
            q[n].lo[i] = next.lo;
        }
    }
    for (int n = FINE; n < TERMS; ++n) {
        const double half = 0.5/n;
        quaternions a, b;
        opposite(lanes, q[n - 2].hi, a.hi);
        opposite(lanes, q[n - 1].hi, b.hi);
        beside(lanes, q[n - 1].hi, b.lo);
        for (int i = 0; i < 4*lanes; ++i)
            q[n].hi[i] = half*(signs[0].hi[i]*(place*b.hi[i] + a.hi[i]) + signs[1].hi[i]*kappa->hi[i]*b.lo[i]);
    }
}

/* The sum of a series at a power of two, by which products are exact. */
ALWAYS_INLINE void sum_at_power(int lanes, const quaternions q[TERMS], double x, quaternions *total)
{
    quaternions sum;
    for (int i = 0; i < 4*lanes; ++i)
        sum.hi[i] = q[TERMS - 1].hi[i];
    for (int n = TERMS - 2; n >= FINE; --n)
        for (int i = 0; i < 4*lanes; ++i)
            sum.hi[i] = sum.hi[i]*x + q[n].hi[i];
    for (int i = 0; i < 4*lanes; ++i)
        sum.lo[i] = 0.0;
    for (int n = FINE - 1; n >= 0; --n)
        for (int i = 0; i < 4*lanes; ++i) {
            const dd next = dd_add_fast(dd_pair(q[n].hi[i], q[n].lo[i]), dd_scale(dd_pair(sum.hi[i], sum.lo[i]), x));
            sum.hi[i] = next.hi;
            sum.lo[i] = next.lo;
        }
    *total = sum;
}

/* The same for one motion at any point. */
static void sum_at(int lanes, int lane, const quaternions q[TERMS], dd x, dd total[4])
{
    for (int k = 0; k < 4; ++k) {
        const int i = k*lanes + lane;
        double tail = q[TERMS - 1].hi[i];
        for (int n = TERMS - 2; n >= FINE; --n)
            tail = tail*x.hi + q[n].hi[i];
        total[k] = dd_of(tail);
        for (int n = FINE - 1; n >= 0; --n)
            total[k] = dd_add_fast(dd_pair(q[n].hi[i], q[n].lo[i]), dd_mul(total[k], x));
    }
}

/* The attitude at -x from the attitude at x, if it is 1 at x = 0. */
static void mirrored(double sign, dd q[4])
{
    for (int k = 1; k < 3; ++k)
        q[k] = dd_scale(q[k], sign);
}

/* Input and results of the Taylor polynomials of a motion. */
typedef struct {
    dd kappa, there;      /* the distance of the start from resonance, in x */
    double *table;
    dd last[4], start[4]; /* the attitude at the last point, and at `there` if it is in the range */
} near_motion;

/* Taylor polynomials, about the middles of intervals from x = 0 on, of attitudes that are 1 at x = 0. */
ALWAYS_INLINE void near_tables(int lanes, int pieces, near_motion *motions)
{
    static const double swept_sign[4] = {-1.0, 1.0, -1.0, 1.0}, turned_sign[4] = {-1.0, 1.0, 1.0, -1.0};
    const double half = 0.5/SPIN_UP_PIECES;
    quaternions q[TERMS], here, signs[2];
    numbers_of_lanes kappa;
    dd halves[FINE];
    for (int n = 1; n < FINE; ++n)
        halves[n] = dd_div(dd_of(0.5), dd_of(n));
    for (int i = 0; i < 4*lanes; ++i) {
        q[0].hi[i] = i < lanes ? 1.0 : 0.0;
        q[0].lo[i] = 0.0;
        kappa.hi[i] = motions[i%lanes].kappa.hi;
        kappa.lo[i] = motions[i%lanes].kappa.lo;
        signs[0].hi[i] = swept_sign[i/lanes];
        signs[1].hi[i] = turned_sign[i/lanes];
    }
    grow(lanes, &kappa, signs, 0.0, halves, q);
    sum_at_power(lanes, q, half, &here);
    for (int piece = 0; piece < pieces; ++piece) {
        const double middle = (2*piece + 1)*half;
        q[0] = here;
        grow(lanes, &kappa, signs, middle, halves, q);
        for (int lane = 0; lane < lanes; ++lane) {
            near_motion *own = motions + lane;
            for (int n = 0; n < SPIN_UP_TAYLOR; ++n)
                for (int k = 0; k < 4; ++k)
                    own->table[4*(SPIN_UP_TAYLOR*piece + n) + k] = q[n].hi[k*lanes + lane];
            const dd distance = dd_sub(own->there, dd_of(middle));
            if (fabs(distance.hi) <= half)
                sum_at(lanes, lane, q, distance, own->start);
        }
        sum_at_power(lanes, q, piece + 1 < pieces ? 2.0*half : half, &here);
    }
    for (int i = 0; i < 4*lanes; ++i)
        motions[i%lanes].last[i/lanes] = dd_pair(here.hi[i], here.lo[i]);
}

static void near_table(int pieces, near_motion *motion)
{
    near_tables(1, pieces, motion);
}

/* f->attitude before, near or after resonance: q -> given conj(here) q conj(axes). */
static void store_attitude(const body *own, const dd given[4], const dd here[4], double to[4][4])
{
    /* unit j times q: component k is component [j][k] of q, with a sign */
    static const double signs[4][4] = {
        {1.0, 1.0, 1.0, 1.0}, {-1.0, 1.0, -1.0, 1.0}, {-1.0, 1.0, 1.0, -1.0}, {-1.0, -1.0, 1.0, 1.0}
    };
    dd inverse[4], back[4], left[4], once[4], column[4];
    conjugated(here, inverse);
    conjugated(own->axes, back);
    quaternion_product(given, inverse, left);
    for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k)
            once[k] = dd_scale(back[j^k], signs[j][k]);
        quaternion_product(left, once, column);
        for (int k = 0; k < 4; ++k)
            to[k][j] = column[k].hi;
    }
}

/* given conj(from) to, where `from` and `to` are the same attitude by the formulas of two sides. */
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

/* The time until which neither phase can have so many rad. */
static double longest_of(const spin_up *f, double most)
{
    const double rad = 1.0/SPIN_UP_QUARTER.hi;
    const double even = fabs(f->sweep[0]) + f->across[0] + fabs(f->turn[0])*rad;
    const double growing = f->sweep[2] + fabs(f->turn[2])*rad;
    return 2.0*most/(even + sqrt(even*even + 4.0*growing*most));
}

/* Intermediate results for the constants that need Taylor polynomials. */
typedef struct {
    body own;
    dd edge, here[4]; /* the attitude at the start, by the formulas there */
    int side;
} half_way;

/* Compute the constants that need no Taylor polynomials; return whether polynomials are needed. */
static int prepare_first(int axis, const double numbers[20], const double limits[3], half_way *h, spin_up *f)
{
    static const spin_up blank;
    *f = blank;
    body *own = &h->own;
    prepare_body(axis, numbers, own, f);
    const double square = own->across.hi*own->across.hi, huge = 1e300;
    const double kappa2 = own->s.hi > 0.0 ? fmin(square/own->s.hi, huge) : huge;
    const double inverse = square > 0.0 ? fmin(own->s.hi/square, huge) : huge;
    const int wide = kappa2 >= limits[1]*limits[1];
    const double radius2 = limits[0]*limits[0] + kappa2;
    h->edge = dd_mul(own->root, dd_of(limits[0]));
    asymptotic(wide ? 1.0 : kappa2/radius2, wide ? inverse : 1.0/radius2, f);
    f->unit = square + (wide ? 0.0 : limits[0]*limits[0]*own->s.hi);
    prepare_phase(own, &f->phase);
    f->whole = wide || f->phase.way == SPIN_UP_WEAK;
    f->edge = f->whole != 0.0 ? 0.0 : h->edge.hi;
    f->longest = longest_of(f, limits[2]);
    h->side = f->whole != 0.0 || own->start.hi >= f->edge ? SPIN_UP_BEYOND
        : own->start.hi <= -f->edge ? SPIN_UP_BEFORE : SPIN_UP_NEAR;
    f->start = h->side;
    if (h->side != SPIN_UP_NEAR) {
        swept_attitude(f, own->start, h->here);
        store_attitude(own, own->given, h->here, f->attitude[h->side]);
    }
    return f->whole == 0.0;
}

static near_motion near_motion_of(const half_way *h, double *table)
{
    near_motion motion;
    motion.kappa = dd_div(h->own.across, h->own.root);
    motion.there = dd_abs(dd_div(h->own.start, h->own.root));
    motion.table = table;
    return motion;
}

/* Compute the constants that need Taylor polynomials. */
static void prepare_rest(const half_way *h, near_motion *near, spin_up *f)
{
    const body *own = &h->own;
    const int side = h->side;
    const dd x = dd_div(own->start, own->root), *last = near->last;
    dd middle[4], far[4];
    const double way[3] = {-1.0, 0.0, 1.0};
    if (side == SPIN_UP_NEAR) {
        mirrored(x.hi < 0.0 ? -1.0 : 1.0, near->start);
        conjugated(near->start, far);
        quaternion_product(own->given, far, middle);
    } else {
        dd left[4], from[4];
        for (int i = 0; i < 4; ++i)
            from[i] = last[i];
        mirrored(way[side], from);
        swept_attitude(f, dd_scale(h->edge, way[side]), far);
        handed_on(own->given, h->here, far, left);
        conjugated(from, far);
        quaternion_product(left, far, middle);
    }
    static const dd one[4] = {{1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
    store_attitude(own, middle, one, f->attitude[SPIN_UP_NEAR]);
    for (int to = SPIN_UP_BEFORE; to <= SPIN_UP_BEYOND; to += SPIN_UP_BEYOND - SPIN_UP_BEFORE) {
        if (to == side)
            continue;
        dd left[4], leaving[4];
        for (int i = 0; i < 4; ++i)
            leaving[i] = last[i];
        mirrored(way[to], leaving);
        quaternion_product(middle, leaving, left);
        swept_attitude(f, dd_scale(h->edge, way[to]), far);
        store_attitude(own, left, far, f->attitude[to]);
    }
}

/*
 * Compute the constants of a motion.
 *
 * in   axis        0, 1, 2   of symmetry; the torque is about it
 * in   numbers[20]           each as hi, lo: moments across the axis and about it, kg m^2, the torque, N m, angular
 *                            velocity at time 0 along the axes axis + 1, axis + 2 (modulo 3) and axis, rad/s, not
 *                            both of the first zero, and the attitude at time 0, body to space, scalar first, of any
 *                            norm
 * in   limits[3]             smallest |x| for which the series are valid, smallest kappa for which they are valid
 *                            everywhere, and largest phase, rad, for pairs of doubles
 * out  table[]               4*limits[0] times 20 times 4 numbers: Taylor polynomials; NULL if no sample is near
 *                            resonance or beyond it
 * out  f                     the constants
 *
 * Returns 0, or 2 if the compiler has broken error-free arithmetic.
 */
int symrot_spin_up_prepare(int axis, const double numbers[20], const double limits[3], double *table, spin_up *f)
{
    half_way h;
    if (!dd_sound())
        return 2;
    if (prepare_first(axis, numbers, limits, &h, f) && table != NULL) {
        near_motion near = near_motion_of(&h, table);
        near_table((int)(limits[0]*SPIN_UP_PIECES), &near);
        prepare_rest(&h, &near, f);
    }
    return 0;
}

/* The length of the constants in doubles, for callers that allocate them. */
ptrdiff_t symrot_spin_up_length(void)
{
    return (ptrdiff_t)(sizeof(spin_up)/sizeof(double));
}

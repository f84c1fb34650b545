/* A symmetric body under a constant torque about its axis at any time. The formulas are in spin_up.h. */
#include "spin_up.h"
#include "spin_up_phase.h"
#include "stages.h"

typedef struct {
    const double *table;
    int lacking;  /* whether a needed table is missing */
    int found[3]; /* which sides have samples */
    int64_t lost; /* not 0 if a time is too long */
    double t[BLOCK], sine[BLOCK], cosine[BLOCK];  /* of chi/2 */
    double omega[BLOCK], omega_low[BLOCK], speed[BLOCK], speed_low[BLOCK];
    double turns[BLOCK], turns_low[BLOCK], delta[BLOCK], slow[4][BLOCK]; /* half the phase, in revolutions */
    double far[4][BLOCK], near[4][BLOCK];
} block;

/* Sine and cosine of a phase in revolutions plus a small angle; whole revolutions are subtracted first. */
ALWAYS_INLINE void circle(dd turns, double more, double *sine, double *cosine)
{
    const double whole = turns.hi - rint(turns.hi), small = (turns.lo - rint(turns.lo)) + more;
    const double quarters = rint(4.0*(whole + small));
    sincos_quarters((whole - 0.25*quarters) + small, quarters, sine, cosine);
}

/* chi/2 */
STAGE transverse(const spin_up *restrict f, ptrdiff_t n, block *restrict b)
{
    const dd first = dd_pair(f->turn[0], f->turn[1]), second = dd_pair(f->turn[2], f->turn[3]);
    const double longest = f->longest;
    int64_t lost = 0;
    EACH (i, n) {
        const double t = b->t[i];
        lost |= fabs(t) <= longest ? 0 : 1;
        const dd mean = linear(first, second, t);
        const double p = mean.hi*t;
        circle(dd_pair(p, MUL_ADD(mean.lo, t, product_error(mean.hi, t, p))), 0.0, &b->sine[i], &b->cosine[i]);
    }
    b->lost |= lost;
}

STAGE rates(const spin_up *restrict f, ptrdiff_t n, const block *restrict b, double *restrict omega)
{
    const dd spin = dd_pair(f->spin[0], f->spin[1]), growth = dd_pair(f->spin[2], f->spin[3]);
    EACH (i, n) {
        const double s = b->sine[i], c = b->cosine[i], x = (c - s)*(c + s), y = 2.0*s*c;
        const double w = linear(spin, growth, b->t[i]).hi;
        omega[3*i] = MUL_ADD(f->rates[0][0], x, MUL_ADD(f->rates[0][1], y, f->axial[0]*w));
        omega[3*i + 1] = MUL_ADD(f->rates[1][0], x, MUL_ADD(f->rates[1][1], y, f->axial[1]*w));
        omega[3*i + 2] = MUL_ADD(f->rates[2][0], x, MUL_ADD(f->rates[2][1], y, f->axial[2]*w));
    }
}

/* Omega in double-double arithmetic, and the sides on which there are samples. */
STAGE places(const spin_up *restrict f, ptrdiff_t n, block *restrict b)
{
    const dd start = dd_pair(f->sweep[0], f->sweep[1]), s = dd_pair(f->sweep[2], f->sweep[3]);
    const double edge = f->edge, whole = f->whole;
    int64_t before = 0, near = 0, beyond = 0;
    EACH (i, n) {
        const dd omega = linear(start, s, b->t[i]);
        b->omega[i] = omega.hi;
        b->omega_low[i] = omega.lo;
        beyond |= omega.hi >= edge ? 1 : 0;
        before |= omega.hi <= -edge ? 1 : 0;
        near |= fabs(omega.hi) < edge ? 1 : 0;
    }
    b->found[SPIN_UP_BEFORE] = before != 0 && whole == 0.0;
    b->found[SPIN_UP_NEAR] = near != 0;
    b->found[SPIN_UP_BEYOND] = beyond != 0 || whole != 0.0;
}

/* S */
STAGE speeds(const double across[2], ptrdiff_t n, block *restrict b)
{
    const dd square = dd_square(dd_pair(across[0], across[1]));
    EACH (i, n) {
        const dd speed = dd_root(dd_add_fast(dd_square(dd_pair(b->omega[i], b->omega_low[i])), square));
        b->speed[i] = speed.hi;
        b->speed_low[i] = speed.lo;
    }
}

/* log(|Omega| + S) */
ALWAYS_INLINE void logarithms_by(int fine, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const dd omega = dd_pair(b->omega[i], b->omega_low[i]), speed = dd_pair(b->speed[i], b->speed_low[i]);
        const dd log = swept_logarithm(omega, speed, fine);
        b->turns[i] = log.hi;
        b->turns_low[i] = log.lo;
    }
}

STAGE logarithms(ptrdiff_t n, block *restrict b)
{
    logarithms_by(0, n, b);
}

STAGE fine_logarithms(ptrdiff_t n, block *restrict b)
{
    logarithms_by(1, n, b);
}

/* P/(4 pi) from that. */
STAGE swept(const spin_up_phase *restrict p, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const dd omega = dd_pair(b->omega[i], b->omega_low[i]), speed = dd_pair(b->speed[i], b->speed_low[i]);
        const dd turns = swept_turns(p, omega, speed, dd_pair(b->turns[i], b->turns_low[i]));
        b->turns[i] = turns.hi;
        b->turns_low[i] = turns.lo;
    }
}

/* The same, counted from the start, under a weak torque. */
STAGE weakly_swept(const spin_up_phase *restrict p, ptrdiff_t n, block *restrict b)
{
    const dd zero = dd_of(0.0), relative = dd_pair(p->product[0], p->product[1]);
    const dd rate = dd_pair(p->share[0], p->share[1]);
    EACH (i, n) {
        const double t = b->t[i];
        const dd h = linear(zero, relative, t);
        double tail = p->series[15][0];
        tail = MUL_ADD(tail, h.hi, p->series[14][0]);
        tail = MUL_ADD(tail, h.hi, p->series[13][0]);
        tail = MUL_ADD(tail, h.hi, p->series[12][0]);
        tail = MUL_ADD(tail, h.hi, p->series[11][0]);
        tail = MUL_ADD(tail, h.hi, p->series[10][0]);
        tail = MUL_ADD(tail, h.hi, p->series[9][0]);
        dd sum = dd_add_fast(dd_pair(p->series[8][0], p->series[8][1]), dd_pair(tail*h.hi, 0.0));
        sum = dd_add_fast(dd_pair(p->series[7][0], p->series[7][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[6][0], p->series[6][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[5][0], p->series[5][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[4][0], p->series[4][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[3][0], p->series[3][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[2][0], p->series[2][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[1][0], p->series[1][1]), dd_mul(sum, h));
        sum = dd_add_fast(dd_pair(p->series[0][0], p->series[0][1]), dd_mul(sum, h));
        const dd turns = dd_mul(dd_mul(sum, rate), dd_of(t));
        b->turns[i] = turns.hi;
        b->turns_low[i] = turns.lo;
    }
}

/* Far from resonance: the slow part of the attitude in the rotating axes, and half of delta in revolutions. */
STAGE followed(const spin_up *restrict f, ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        const double r = 1.0/b->speed[i], sine = f->across[0]*r, cosine = b->omega[i]*r, y = f->unit*r*r;
        const double m1 = sine*cosine*(y*y)*series_of(f->g, y), m2 = sine*y*series_of(f->c, y);
        /* 1 + sqrt(1 - x), x < 1/81^2; m3^2 + x = 2 m3, (1 + |cos|)^2 + sin^2 = 2 (1 + |cos|) */
        const double x = MUL_ADD(m1, m1, m2*m2), m3 = 2.0 - x*MUL_ADD(x, MUL_ADD(x, 0.0625, 0.125), 0.5);
        const double larger = 1.0 + fabs(cosine), norm = 0.5/sqrt(m3*larger);
        const double c = (cosine >= 0.0 ? larger : sine)*norm, d = (cosine >= 0.0 ? sine : larger)*norm;
        b->delta[i] = cosine*series_of(f->e, y)*SPIN_UP_QUARTER.hi;
        b->slow[0][i] = MUL_ADD(m3, c, -m1*d);
        b->slow[1][i] = m2*c;
        b->slow[2][i] = -MUL_ADD(m3, d, m1*c);
        b->slow[3][i] = -m2*d;
    }
}

/* The attitude of e1, e2, e3: a rotates by (P + delta)/2 - chi/2, b by (P + delta)/2 + chi/2. */
STAGE turned(ptrdiff_t n, block *restrict b)
{
    EACH (i, n) {
        double s, c;
        circle(dd_pair(b->turns[i], b->turns_low[i]), b->delta[i], &s, &c);
        const double a0 = b->slow[0][i], a1 = b->slow[3][i], b0 = b->slow[1][i], b1 = b->slow[2][i];
        const double plus = b->sine[i], even = b->cosine[i];
        const double less0 = MUL_ADD(c, even, s*plus), less1 = MUL_ADD(s, even, -c*plus);
        const double more0 = MUL_ADD(c, even, -s*plus), more1 = MUL_ADD(s, even, c*plus);
        b->far[0][i] = MUL_ADD(less0, a0, -less1*a1);
        b->far[3][i] = MUL_ADD(less0, a1, less1*a0);
        b->far[1][i] = MUL_ADD(more0, b0, -more1*b1);
        b->far[2][i] = MUL_ADD(more0, b1, more1*b0);
    }
}

/* Four components in one register, or two: vectors of GNU C, which every compiler with these flags has. */
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));

/* Near resonance: the same from x = 0, by Taylor polynomials with even and odd powers apart, sample by sample. */
STAGE near(const spin_up *restrict f, ptrdiff_t n, block *restrict b)
{
    const dd inverse = dd_pair(f->inverse[0], f->inverse[1]);
    const double last = f->inverse[0]*f->edge*SPIN_UP_PIECES - 0.5; /* the middle of the last interval */
    double rests[BLOCK], pieces[BLOCK];
    EACH (i, n) {
        const double sign = b->omega[i] < 0.0 ? -1.0 : 1.0;
        const dd x = dd_scale(dd_mul(dd_pair(b->omega[i], b->omega_low[i]), inverse), sign);
        const double place = x.hi*SPIN_UP_PIECES;
        pieces[i] = floor(place < last ? place : last);
        rests[i] = (x.hi - (pieces[i] + 0.5)/SPIN_UP_PIECES) + x.lo;
    }
    for (ptrdiff_t i = 0; i < n; ++i) {
        const four *at = (const four *)(b->table + 4*SPIN_UP_TAYLOR*(ptrdiff_t)pieces[i]);
        const double rest = rests[i], square = rest*rest;
        four even = at[SPIN_UP_TAYLOR - 2], odd = at[SPIN_UP_TAYLOR - 1];
        for (int m = SPIN_UP_TAYLOR - 4; m >= 0; m -= 2) {
            even = even*square + at[m];
            odd = odd*square + at[m + 1];
        }
        const four q = even + odd*rest;
        for (int k = 0; k < 4; ++k)
            b->near[k][i] = q[k];
    }
    EACH (i, n) {
        const double sign = b->omega[i] < 0.0 ? -1.0 : 1.0, s = b->sine[i], c = b->cosine[i];
        const double q0 = b->near[0][i], q1 = sign*b->near[1][i], q2 = sign*b->near[2][i], q3 = b->near[3][i];
        b->near[0][i] = MUL_ADD(q0, c, q3*s);
        b->near[3][i] = MUL_ADD(q3, c, -q0*s);
        b->near[1][i] = MUL_ADD(q1, c, -q2*s);
        b->near[2][i] = MUL_ADD(q2, c, q1*s);
    }
}

static void far(const spin_up *f, ptrdiff_t n, block *b)
{
    speeds(f->across, n, b);
    if (f->phase.way == SPIN_UP_WEAK)
        weakly_swept(&f->phase, n, b);
    else {
        if (f->phase.way == SPIN_UP_FINE)
            fine_logarithms(n, b);
        else
            logarithms(n, b);
        swept(&f->phase, n, b);
    }
    followed(f, n, b);
    turned(n, b);
}

static int place_of(const spin_up *f, const block *b, ptrdiff_t i)
{
    if (f->whole != 0.0 || b->omega[i] >= f->edge)
        return SPIN_UP_BEYOND;
    return b->omega[i] <= -f->edge ? SPIN_UP_BEFORE : SPIN_UP_NEAR;
}

/* Apply the attitude map of each side to consecutive samples on that side. */
static void attitudes(const spin_up *f, ptrdiff_t n, block *b, double *q)
{
    const int *found = b->found, places = found[SPIN_UP_BEFORE] + found[SPIN_UP_NEAR] + found[SPIN_UP_BEYOND];
    if (b->table == NULL && (places > 1 || found[SPIN_UP_NEAR] || !found[(int)f->start])) {
        b->lacking = 1;
        return;
    }
    if (found[SPIN_UP_BEFORE] || found[SPIN_UP_BEYOND])
        far(f, n, b);
    if (found[SPIN_UP_NEAR])
        near(f, n, b);
    for (ptrdiff_t i = 0, next; i < n; i = next) {
        const int place = place_of(f, b, i);
        for (next = places > 1 ? i + 1 : n; next < n && place_of(f, b, next) == place;)
            ++next;
        double(*x)[BLOCK] = place == SPIN_UP_NEAR ? b->near : b->far;
        put_quaternion(f->attitude[place], next - i, x[0] + i, x[1] + i, x[2] + i, x[3] + i, q + 4*i);
    }
}

static void motion(const spin_up *f, ptrdiff_t n, block *b, double *omega, double *q)
{
    transverse(f, n, b);
    if (omega != NULL)
        rates(f, n, b, omega);
    if (q != NULL) {
        places(f, n, b);
        attitudes(f, n, b, q);
    }
}

/*
 * The motion at times counted from the initial state.
 *
 * in   f           the constants
 * in   table       Taylor polynomials, 40 times 20 times 4 numbers; NULL if all samples are far from resonance on the
 *                  side of the start
 * in   times       s
 * out  omega       rad/s, 3 of each sample, or NULL
 * out  quaternion  1, 4 of each sample, or NULL
 *
 * Returns 0, or SPIN_UP_LACKING if the table is needed and NULL, plus SPIN_UP_LOST if some samples have too many
 * revolutions: these samples are not valid.
 */
int symrot_spin_up_at(
    const spin_up *f, const double *table, ptrdiff_t count, const double *times, double *omega, double *quaternion)
{
    block b;
    b.table = table;
    b.lacking = 0;
    b.lost = 0;
    IN_BLOCKS(b, motion)
    return (b.lacking ? SPIN_UP_LACKING : 0) + (b.lost != 0 ? SPIN_UP_LOST : 0);
}

/*
 * Many motions by Taylor series, one in each SIMD lane, each with its own step; a lane whose motion ends takes the
 * next.
 *
 * Included after library.h, lanes.h, an emitted system and series.h, in one translation unit. The system defines
 *     SYMROT_STATES, SYMROT_PARAMETERS   numbers of states N and parameters
 *     SYMROT_ORDER                       order of the series, even
 *     SYMROT_ROOTS                       number of square roots, such as |omega|, whose series follow those of the states
 *     SYMROT_BLOCKS, SYMROT_EDGES, SYMROT_SCALES   blocks of states with separate error norms, as in taylor.c
 *     SYMROT_CONSTANTS, symrot_constants, symrot_jet           constants from parameters; coefficients of the states
 * C99; no malloc, no globals, no input or output, reentrant.
 *
 * The method is the same as in taylor.c: coefficients in units of time near the last step, the step from the last two
 * terms, compensated states, time as a sum of two doubles. No operation mixes lanes, so that the bits of a motion do
 * not depend on its lane or the other motions, and a motion that stops early does not affect the others.
 */
#ifdef __cplusplus
extern "C" {
#endif

#define L SYMROT_LANES
#define N SYMROT_STATES
enum { SYMROT_SERIES = SYMROT_STATES + SYMROT_ROOTS };

/* The task of a thread: `legs` parts of motions, each from t0 to one side of it. */
typedef struct {
    int64_t legs;
    double t0, tail, pace;       /* as in taylor.c; pace is a fraction of the span */
    double max_steps, patience;  /* limits of the steps of a leg, and of its steps between two checks of its pace */
    double hopeless;             /* a leg that would exceed max_steps this many times at its pace is given up */
    const int64_t *motion;       /* of each leg: row of y and p */
    const int64_t *first, *count;/* of each leg: first sample time, and number >= 1, sorted by distance from t0 */
    const int64_t *row;          /* of each leg: row of its first sample in states */
    const double *y, *p, *times; /* rows of N and SYMROT_PARAMETERS numbers; times */
    double *states;              /* rows of N */
    double *reached, *steps, *jets; /* of each leg: last time, steps, jets */
    double *covered;             /* of each leg: time covered by the last `patience` steps, if it is given up */
    int64_t *status;             /* of each leg: one of the above */
    int64_t next;                /* leg that the next free lane takes */
} symrot_job;

/* The state of all lanes. */
typedef struct {
    int64_t leg[L], at[L];  /* leg or -1; samples written */
    double t[L], low[L], unit[L], stop[L], side[L], pace[L], due[L], steps[L], jets[L], halvings[L];
    double full[L], mark[L];  /* number of steps at the next check of the pace, time at the last one */
    double y[N][L], carry[N][L], c[SYMROT_CONSTANTS][L];
} symrot_lanes;

static const int symrot_edges[] = SYMROT_EDGES;
static const double symrot_scales[] = SYMROT_SCALES;
enum { SYMROT_LEAST_CHECKED = SYMROT_ORDER - 8 > SYMROT_ORDER/2 ? SYMROT_ORDER - 8 : SYMROT_ORDER/2 };
static const double SYMROT_GAP_SLACK = 1e4;     /* see taylor.c */
static const double SYMROT_LEAST_TAIL = 1e-18;  /* below round-off a smaller tail gains nothing */
static const double SYMROT_RATE_FLOOR = 1e-3;   /* rad: errors of rates are relative to at least this per step */

#if defined(__GNUC__)
#define SYMROT_UNROLLED _Pragma("GCC unroll 8")
#else
#define SYMROT_UNROLLED
#endif
#define EACH_STATE(i) SYMROT_UNROLLED for (int i = 0; i < N; ++i)

static inline symrot_v symrot_load(const double *from)
{
    symrot_v v;
    memcpy(&v, from, sizeof v);
    return v;
}

static inline void symrot_keep(double *to, symrot_v v) { memcpy(to, &v, sizeof v); }

static inline symrot_bits symrot_mask(const int *chosen)
{
    symrot_bits mask = V_NO_BITS;
    EACH_LANE(l) V_LANE(mask, l) = -(int64_t)(chosen[l] != 0);
    return mask;
}

static inline symrot_v symrot_larger(symrot_v a, symrot_v b) { return V_SELECT(V_LESS(a, b), b, a); }
static inline symrot_v symrot_smaller(symrot_v a, symrot_v b) { return V_SELECT(V_LESS(b, a), b, a); }

/* Return log2(a/b) to 0.09, for a, b >= 0: the upper bits of a number are nearly its logarithm. */
static inline symrot_v symrot_log2(symrot_v a, symrot_v b)
{
    const symrot_bits big = V_TO_BITS(V_ALL(4503599627370496.0));  /* 2^52: whole numbers are its last bits */
    const symrot_v upper = V_FROM_BITS((symrot_bits)(V_TO_BITS(a) >> 32) | big);
    const symrot_v lower = V_FROM_BITS((symrot_bits)(V_TO_BITS(b) >> 32) | big);
    return V_MUL(V_SUB(upper, lower), V_ALL(1.0/1048576));
}

/* Return 2^x to 1e-4, for |x| < 1000. */
static inline symrot_v symrot_exp2(symrot_v x)
{
    const symrot_v magic = V_ALL(6755399441055744.0), shifted = V_ADD(x, magic), f = V_SUB(x, V_SUB(shifted, magic));
    const symrot_v power = V_FROM_BITS((V_TO_BITS(shifted) + 1023) << 52);
    symrot_v series = V_FMA(f, V_ALL(0.0096), V_ALL(0.0555));
    series = V_FMA(f, series, V_ALL(0.240227));
    series = V_FMA(f, series, V_ALL(0.693147));
    return V_MUL(power, V_FMA(f, series, V_ALL(1.0)));
}

/* Return the size of a block's coefficient n: the sum of its components' sizes. */
static inline symrot_v symrot_block(symrot_v (*x)[SYMROT_ORDER + 1], int n, int block)
{
    symrot_v size = V_ALL(0.0);
    EACH_STATE(i) if (i >= symrot_edges[block] && i < symrot_edges[block + 1])
        size = V_ADD(size, symrot_size_of(x[i][n]));
    return size;
}

/* Return log2 of the shortest step, in units, at which a last term reaches the accepted tail of its block. */
static inline symrot_v symrot_step_log(symrot_v (*x)[SYMROT_ORDER + 1], symrot_v tail, symrot_v unit)
{
    symrot_v shortest = V_ALL(60.0);  /* the series of a motion that is a polynomial in time ends early */
    const symrot_v share = V_MUL(symrot_log2(tail, V_ALL(1.0)), V_ALL(1.0/SYMROT_ORDER));
    SYMROT_UNROLLED for (int b = 0; b < SYMROT_BLOCKS; ++b) {
        symrot_v size = V_ALL(symrot_scales[b]);
        if (symrot_scales[b] == 0.0) {
            const symrot_v now = symrot_larger(symrot_block(x, 0, b), symrot_block(x, 1, b));
            size = symrot_larger(now, V_DIV(V_ALL(SYMROT_RATE_FLOOR), unit));
        }
        const symrot_v whole = V_MUL(size, V_ALL(SYMROT_GAP_SLACK));
        size = V_MUL(size, tail);
        const symrot_v last = symrot_log2(size, symrot_block(x, SYMROT_ORDER, b));
        const symrot_v before = symrot_log2(size, symrot_block(x, SYMROT_ORDER - 1, b));
        shortest = symrot_smaller(shortest, V_MUL(last, V_ALL(1.0/SYMROT_ORDER)));
        shortest = symrot_smaller(shortest, V_MUL(before, V_ALL(1.0/(SYMROT_ORDER - 1))));
        for (int n = SYMROT_ORDER - 2; n >= SYMROT_LEAST_CHECKED; --n) {  /* as in taylor.c */
            const symrot_v early = V_MUL(symrot_log2(whole, symrot_block(x, n, b)), V_ALL(1.0/n));
            shortest = symrot_smaller(shortest, V_ADD(early, share));
        }
    }
    return symrot_larger(shortest, V_ALL(-60.0));
}

#if SYMROT_ROOTS
/*
 * Return a step of at most s units, shortened in the `chosen` lanes so that no square root falls below a sixteenth of
 * its value at the start. A root that reaches zero has no series there: where |omega| is zero for an instant, its series
 * goes on to negative values.
 */
static SYMROT_APART symrot_v symrot_before_roots(symrot_v (*x)[SYMROT_ORDER + 1], symrot_v s, symrot_bits chosen)
{
    for (int tries = 0; tries < 200; ++tries) {
        symrot_bits near = V_NO_BITS;
        for (int i = N; i < SYMROT_SERIES; ++i) {
            symrot_v least = V_ALL(0.0);  /* only the terms that are negative, for s > 0 */
            for (int n = SYMROT_ORDER - 1; n > 0; --n)
                least = V_MUL(V_ADD(least, symrot_smaller(x[i][n], V_ALL(0.0))), s);
            near |= chosen & V_LESS(V_FMA(x[i][0], V_ALL(0.9375), least), V_ALL(0.0));
        }
        if (!V_ANY(near)) break;
        s = V_SELECT(near, V_MUL(s, V_ALL(0.75)), s);
    }
    return s;
}
#endif

/* Return the tail allowed to a step of about one unit; see taylor.c. */
static inline symrot_v symrot_allowed(double tail, symrot_v pace, symrot_v unit)
{
    const symrot_v share = symrot_smaller(V_DIV(symrot_size_of(unit), pace), V_ALL(1.0));
    const symrot_v power = V_MUL(share, V_CALL(sqrt, V_MUL(share, V_CALL(sqrt, share))));
    return symrot_larger(V_MUL(V_ALL(tail), power), V_ALL(SYMROT_LEAST_TAIL));
}

/* Return a mask of the lanes whose last two coefficients are finite: only a finite number times zero is zero. */
static inline symrot_bits symrot_finite(symrot_v (*x)[SYMROT_ORDER + 1], int order)
{
    symrot_v sum = V_ALL(0.0);
    EACH_STATE(i) sum = V_ADD(sum, V_MUL(V_ADD(x[i][order], x[i][order - 1]), V_ALL(0.0)));
    return V_EQUAL(sum, V_ALL(0.0));
}

/* Return the time of a lane's next sample, or infinity if there is no further sample. */
static inline double symrot_due(const symrot_job *job, const symrot_lanes *lanes, int l)
{
    const int64_t leg = lanes->leg[l], k = lanes->at[l];
    return k < job->count[leg] ? job->times[job->first[leg] + k] : lanes->side[l]*HUGE_VAL;
}

/* Write a lane of the states as its next sample. */
static inline void symrot_sample(const symrot_job *job, symrot_lanes *lanes, int l, const symrot_v *y)
{
    double *out = job->states + (job->row[lanes->leg[l]] + lanes->at[l])*N;
    EACH_STATE(i) out[i] = V_LANE(y[i], l);
    ++lanes->at[l];
    lanes->due[l] = symrot_due(job, lanes, l);
}

static void symrot_leave(const symrot_job *job, symrot_lanes *lanes, int l, int status)
{
    const int64_t leg = lanes->leg[l];
    job->reached[leg] = lanes->t[l];
    job->steps[leg] = lanes->steps[l];
    job->jets[leg] = lanes->jets[l];
    job->status[leg] = status;
    lanes->leg[l] = -1;
}

/*
 * Check the pace of a lane that has made its number of steps between two checks.
 *
 * Returns SYMROT_TOO_MANY at the limit of steps, SYMROT_HOPELESS if the rest would exceed it by far; otherwise sets the
 * next check and returns SYMROT_PAUSED. The number of a lane's own steps decides, so that it does not depend on others.
 */
static int symrot_judge(const symrot_job *job, symrot_lanes *lanes, int l)
{
    const double covered = fabs(lanes->t[l] - lanes->mark[l]), left = fabs(lanes->stop[l] - lanes->t[l]);
    if (lanes->steps[l] >= job->max_steps) return SYMROT_TOO_MANY;
    if (job->patience*left > job->hopeless*job->max_steps*covered) {
        job->covered[lanes->leg[l]] = covered;
        return SYMROT_HOPELESS;
    }
    lanes->mark[l] = lanes->t[l];
    lanes->full[l] = fmin(job->max_steps, lanes->full[l] + job->patience);
    return SYMROT_PAUSED;
}

/* Put the next legs into free lanes, as long as there are some; mark those that need a first unit of time. */
static int symrot_enter(symrot_job *job, symrot_lanes *lanes, int *entered)
{
    int any = 0;
    EACH_LANE(l) {
        entered[l] = 0;
        while (lanes->leg[l] < 0 && job->next < job->legs) {
            const int64_t leg = job->next++, motion = job->motion[leg];
            const double *times = job->times + job->first[leg];
            double c[SYMROT_CONSTANTS];
            lanes->leg[l] = leg;
            lanes->at[l] = 0;
            lanes->t[l] = job->t0;
            lanes->stop[l] = times[job->count[leg] - 1];
            lanes->side[l] = lanes->stop[l] < job->t0 ? -1.0 : 1.0;
            lanes->pace[l] = fabs(lanes->stop[l] - job->t0)*job->pace;
            lanes->full[l] = fmin(job->max_steps, job->patience);
            lanes->mark[l] = job->t0;
            lanes->low[l] = lanes->unit[l] = lanes->steps[l] = lanes->jets[l] = lanes->halvings[l] = 0.0;
            for (int i = 0; i < N; ++i) {
                lanes->y[i][l] = job->y[motion*N + i];
                lanes->carry[i][l] = 0.0;
            }
            symrot_constants(job->p + motion*SYMROT_PARAMETERS, c);
            for (int i = 0; i < SYMROT_CONSTANTS; ++i) lanes->c[i][l] = c[i];
            for (; lanes->at[l] < job->count[leg] && times[lanes->at[l]] == job->t0; ++lanes->at[l])
                memcpy(job->states + (job->row[leg] + lanes->at[l])*N, job->y + motion*N, N*sizeof(double));
            lanes->due[l] = symrot_due(job, lanes, l);
            if (lanes->at[l] == job->count[leg]) symrot_leave(job, lanes, l, SYMROT_DONE);
            else any = entered[l] = 1;
        }
    }
    return any;
}

/* Set a first unit of time from the size of coefficients 1 and 2; end motions in which they are finite in no unit. */
static SYMROT_APART void symrot_first_units(symrot_job *job, symrot_lanes *lanes, const int *entered,
    symrot_v (*x)[SYMROT_ORDER + 1])
{
    symrot_v c[SYMROT_CONSTANTS], unit = V_ALL(1.0), fastest = V_ALL(0.0);
    const symrot_bits fresh = symrot_mask(entered);
    symrot_bits broken = fresh;
    for (int i = 0; i < SYMROT_CONSTANTS; ++i) c[i] = symrot_load(lanes->c[i]);
    EACH_STATE(i) x[i][0] = symrot_load(lanes->y[i]);
    for (int tries = 0; tries < 64; ++tries) {
        symrot_jet(c, symrot_load(lanes->t), V_ALL(0.0), unit, 2, x);
        broken = fresh & ~symrot_finite(x, 2);
        if (!V_ANY(broken)) break;
        unit = V_SELECT(broken, V_MUL(unit, V_ALL(1.0/65536)), unit);
    }
    SYMROT_UNROLLED for (int b = 0; b < SYMROT_BLOCKS; ++b) {
        const symrot_v zero = V_ALL(0.0), first = symrot_block(x, 1, b), second = symrot_block(x, 2, b);
        const symrot_v size = symrot_scales[b] > 0.0 ? V_ALL(symrot_scales[b]) : symrot_block(x, 0, b);
        const symrot_v rest = V_CALL(sqrt, V_DIV(first, unit));
        const symrot_v turn = V_DIV(V_DIV(first, size), unit), swing = V_DIV(V_CALL(sqrt, V_DIV(second, size)), unit);
        const symrot_v rate = V_SELECT(V_LESS(zero, size), symrot_larger(turn, swing), rest);
        fastest = symrot_larger(fastest, rate);
    }
    EACH_LANE(l) {
        if (!entered[l]) continue;
        if (V_LANE(broken, l)) {
            symrot_leave(job, lanes, l, SYMROT_NOT_FINITE);
            continue;
        }
        const double span = fabs(lanes->stop[l] - lanes->t[l]), rate = V_LANE(fastest, l);
        int exponent;
        frexp(rate*span > 1.0 ? 1.0/rate : span, &exponent);
        lanes->unit[l] = lanes->side[l]*ldexp(1.0, exponent);
    }
}

/* Return the sizes for which this library was built: states, parameters, order, lanes, bytes of their state. */
SYMROT_EXPORT void symrot_lanes_sizes(int64_t sizes[5])
{
    sizes[0] = SYMROT_STATES;
    sizes[1] = SYMROT_PARAMETERS;
    sizes[2] = SYMROT_ORDER;
    sizes[3] = SYMROT_LANES;
    sizes[4] = (int64_t)sizeof(symrot_lanes);
}

/* Return the rounding error of a + b, as computed in steps: b for a large a, unless the compiler removed it. */
SYMROT_EXPORT double symrot_lanes_carry(double a, double b)
{
    const symrot_v y = V_ALL(a), d = V_ALL(b), y1 = V_ADD(y, d), rise = V_SUB(y1, y);
    const symrot_v low = V_ADD(V_SUB(y, V_SUB(y1, rise)), V_SUB(d, rise));
    return V_LANE(low, 0);
}

/* Write the coefficients 0 to `order` (even) of the states of one motion, in units of time: row n holds coefficient n. */
SYMROT_EXPORT void symrot_lanes_jet(double t, const double *y, const double *p, double unit, int64_t order, double *out)
{
    double values[SYMROT_CONSTANTS];
    symrot_v c[SYMROT_CONSTANTS], x[SYMROT_SERIES][SYMROT_ORDER + 1];
    symrot_constants(p, values);
    for (int i = 0; i < SYMROT_CONSTANTS; ++i) c[i] = V_ALL(values[i]);
    EACH_STATE(i) x[i][0] = V_ALL(y[i]);
    symrot_jet(c, V_ALL(t), V_ALL(0.0), V_ALL(unit), order, x);
    for (int64_t n = 0; n <= order; ++n)
        EACH_STATE(i) out[n*N + i] = V_LANE(x[i][n], 0);
}

/* Make all lanes free. */
SYMROT_EXPORT void symrot_lanes_clear(symrot_lanes *lanes)
{
    memset(lanes, 0, sizeof *lanes);
    EACH_LANE(l) lanes->leg[l] = -1;
}

/*
 * Step the lanes, at most `attempts` times, all of them at once.
 *
 * Returns SYMROT_DONE when every leg has its status; SYMROT_PAUSED otherwise: call again to continue. Samples that a
 * leg does not reach are not written.
 */
SYMROT_EXPORT int symrot_lanes_run(symrot_lanes *lanes, symrot_job *job, int64_t attempts)
{
    symrot_v c[SYMROT_CONSTANTS], x[SYMROT_SERIES][SYMROT_ORDER + 1], carry[N], y1[N];
    symrot_v t = V_ALL(0.0), low = t, unit, stop, side, allowed, steps, jets, halvings, tiny;
    symrot_bits active;
    int changed = 1, entered[L], busy[L];

    while (attempts-- > 0) {
        if (changed) {  /* motions have begun or ended: the lanes are in memory */
            while (symrot_enter(job, lanes, entered)) symrot_first_units(job, lanes, entered, x);
            int any = 0;
            EACH_LANE(l) any |= busy[l] = lanes->leg[l] >= 0;
            if (!any) return SYMROT_DONE;
            active = symrot_mask(busy);
            t = symrot_load(lanes->t);
            low = symrot_load(lanes->low);
            unit = symrot_load(lanes->unit);
            stop = symrot_load(lanes->stop);
            side = symrot_load(lanes->side);
            steps = symrot_load(lanes->steps);
            jets = symrot_load(lanes->jets);
            halvings = symrot_load(lanes->halvings);
            for (int i = 0; i < SYMROT_CONSTANTS; ++i) c[i] = symrot_load(lanes->c[i]);
            EACH_STATE(i) {
                x[i][0] = symrot_load(lanes->y[i]);
                carry[i] = symrot_load(lanes->carry[i]);
            }
            allowed = symrot_allowed(job->tail, symrot_load(lanes->pace), unit);
            tiny = V_FMA(V_ALL(1e-30), symrot_size_of(V_SUB(stop, V_ALL(job->t0))), V_ALL(1e-300));
            changed = 0;
        }
        symrot_jet(c, t, low, unit, SYMROT_ORDER, x);
        jets = V_ADD(jets, V_ALL(1.0));

        const symrot_bits finite = symrot_finite(x, SYMROT_ORDER);
        symrot_v logarithm = symrot_step_log(x, allowed, symrot_size_of(unit));
        const symrot_v left = V_SUB(V_SUB(stop, t), low);
        symrot_v s = symrot_exp2(logarithm), h = V_MUL(s, unit);
        symrot_bits at_stop = ~V_LESS(V_MUL(V_SUB(V_MUL(V_ALL(1.01), h), left), side), V_ALL(0.0));
        h = V_SELECT(at_stop, left, h);
        s = V_SELECT(at_stop, V_DIV(h, unit), s);
#if SYMROT_ROOTS
        const symrot_v held = symrot_before_roots(x, s, active & finite);
        const symrot_bits shorter = V_LESS(held, s);
        at_stop &= ~shorter;
        s = held;
        h = V_SELECT(shorter, V_MUL(s, unit), h);
        logarithm = V_SELECT(shorter, symrot_log2(s, V_ALL(1.0)), logarithm);
#endif
        const symrot_v least = V_ADD(tiny, V_MUL(V_ALL(4.0*DBL_EPSILON), symrot_size_of(t)));
        const symrot_bits stuck = ~(at_stop | V_LESS(least, symrot_size_of(h)));
        const symrot_bits stepping = active & finite & ~stuck;

        symrot_v t1 = V_ADD(t, h), rise = V_SUB(t1, t);
        symrot_v low1 = V_ADD(V_ADD(V_SUB(t, V_SUB(t1, rise)), V_SUB(h, rise)), low);
        const symrot_v sum = V_ADD(t1, low1);
        low1 = V_SELECT(at_stop, V_ALL(0.0), V_ADD(V_SUB(t1, sum), low1));
        t1 = V_SELECT(at_stop, stop, sum);

        for (;;) {  /* samples inside the step, one per lane at a time */
            const symrot_v due = symrot_load(lanes->due);
            const symrot_bits inside = stepping & V_LESS(V_MUL(V_SUB(due, t1), side), V_ALL(0.0));
            if (!V_ANY(inside)) break;
            const symrot_v at = V_DIV(V_SUB(V_SUB(due, t), low), unit);
            EACH_STATE(i) y1[i] = symrot_inside(x[i], at, carry[i]);
            EACH_LANE(l) if (V_LANE(inside, l)) symrot_sample(job, lanes, l, y1);
        }
        EACH_STATE(i) {
            symrot_v lost = carry[i];
            const symrot_v end = symrot_end(x[i], s, &lost);
            carry[i] = V_SELECT(stepping, lost, carry[i]);
            x[i][0] = V_SELECT(stepping, end, x[i][0]);
        }
        t = V_SELECT(stepping, t1, t);
        low = V_SELECT(stepping, low1, low);
        steps = V_ADD(steps, V_SELECT(stepping, V_ALL(1.0), V_ALL(0.0)));
        symrot_bits ended = stepping & V_EQUAL(symrot_load(lanes->due), t);
        while (V_ANY(ended)) {  /* samples at the end of the step */
            EACH_STATE(i) y1[i] = x[i][0];
            EACH_LANE(l) if (V_LANE(ended, l)) symrot_sample(job, lanes, l, y1);
            ended = stepping & V_EQUAL(symrot_load(lanes->due), t);
        }

        const symrot_bits far = stepping & V_LESS(V_ALL(0.6), symrot_size_of(logarithm));
        const symrot_bits broken = active & ~finite;
        if (V_ANY(far | broken)) {
            const symrot_v magic = V_ALL(6755399441055744.0);  /* added and subtracted again, it rounds to an integer */
            const symrot_v nearest = symrot_exp2(V_SUB(V_ADD(logarithm, magic), magic));
            unit = V_SELECT(far, V_MUL(unit, nearest), unit);
            unit = V_SELECT(broken, V_MUL(unit, V_ALL(1.0/256)), unit);
            allowed = symrot_allowed(job->tail, symrot_load(lanes->pace), unit);
        }
        halvings = V_SELECT(broken, V_ADD(halvings, V_ALL(1.0)), V_ALL(0.0));
        const symrot_bits lost = broken & V_LESS(V_ALL(60.0), halvings);
        const symrot_bits full = stepping & ~at_stop & ~V_LESS(steps, symrot_load(lanes->full));
        const symrot_bits over = (stepping & at_stop) | lost | (active & finite & stuck) | full;
        if (V_ANY(over) || attempts == 0) {
            symrot_keep(lanes->t, t);
            symrot_keep(lanes->low, low);
            symrot_keep(lanes->unit, unit);
            symrot_keep(lanes->steps, steps);
            symrot_keep(lanes->jets, jets);
            symrot_keep(lanes->halvings, halvings);
            EACH_STATE(i) {
                symrot_keep(lanes->y[i], x[i][0]);
                symrot_keep(lanes->carry[i], carry[i]);
            }
            EACH_LANE(l) if (V_LANE(over, l)) {
                const int status = V_LANE(lost, l) ? SYMROT_NOT_FINITE : V_LANE(full, l) ? symrot_judge(job, lanes, l)
                    : V_LANE(at_stop, l) ? SYMROT_DONE : SYMROT_UNDERFLOW;
                if (status != SYMROT_PAUSED) symrot_leave(job, lanes, l, status);
            }
            changed = 1;
        }
    }
    return SYMROT_PAUSED;
}

#ifdef __cplusplus
}
#endif

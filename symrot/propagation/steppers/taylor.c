/*
 * Taylor series of high order with dense output: the whole loop of steps around one emitted jet.
 *
 * Included after library.h, taylor.h, an emitted system and series.h, in one translation unit. The system defines
 *     SYMROT_STATES, SYMROT_PARAMETERS   numbers of states N and parameters
 *     SYMROT_ORDER                       order of the series, even
 *     SYMROT_ROWS                        rows of four lanes that hold the states,
 *     SYMROT_ROW_STARTS, SYMROT_ROW_SIZES, SYMROT_ROW_BLOCKS   the first state, the states and the block of each
 *     SYMROT_SCALES                      per block: with 0, errors are relative to the block's own size (a rate),
 *                                        otherwise to this number (an attitude of unit norm: 1)
 *     SYMROT_CONSTANTS, symrot_constants, symrot_jet           constants from parameters; coefficients of the states
 *     SYMROT_INVARIANTS                  number of invariants; if not 0, their C text precedes, see projection.c,
 *     SYMROT_INVARIANT_PARAMETERS        and the numbers of their parameters, which follow those of the system
 *     SYMROT_ENCLOSED                    whether some terms may hide a feature: then enclosure.h is inserted here
 *     SYMROT_ROUNDS                      whether rounding errors of the rates are bounded, by symrot_roundings
 * C99 that is also valid C++; no malloc, no globals, no input or output, reentrant.
 *
 * Coefficients belong to the series in time/unit, where the unit is a power of two near the last step. No number over-
 * or underflows for any unit of time of the problem, and no bit depends on it.
 *
 * The step is the longest at which the last two terms of the series are below the accepted tail of each block. If terms
 * are enclosed (bounded on discs), it is shortened until the enclosure proves that the omitted terms are small too.
 * No jet is computed twice. Source: A. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99-117, with the order fixed.
 */
#ifdef __cplusplus
extern "C" {
#endif

enum { SYMROT_ROW = 4 + (SYMROT_ORDER + 1)*SYMROT_STATES };  /* one recorded step: t, h, low part of t, unit, terms */

typedef struct {
    double t, t_low;     /* time reached so far, as their sum */
    double unit;         /* of time, a power of two near the next step; 0 before the first one */
    double stop;         /* end of the span, on either side of t */
    double tail;         /* relative, of one step of length `pace` or more; a shorter step is allowed less */
    double pace;
    double max_step;     /* positive */
    double proven;       /* the last step, if the enclosure held it back, or 0 */
    double rounded;      /* sum of the squares of the first block's rounding errors, from formulas of time */
    double rounded_from; /* time from which their bound may exceed the tolerance; NAN: nowhere so far */
    double largest;      /* largest size of that block so far */
    double longest;      /* longest step so far */
    int64_t next;        /* first sample not yet written */
    int64_t accepted, jets, recorded;
    int64_t reach;       /* number of the disc with the best bound in the last step */
    int64_t every, since, projected;  /* steps between projections, or 0; steps since the last; count */
    double y[SYMROT_STATES], carry[SYMROT_STATES];
    double kept[2*SYMROT_INVARIANTS + 1];  /* the invariants, in pairs, and whether they are known */
} symrot_run;

static const int symrot_starts[] = SYMROT_ROW_STARTS, symrot_sizes[] = SYMROT_ROW_SIZES;
static const int symrot_blocks[] = SYMROT_ROW_BLOCKS;
static const double symrot_scales[] = SYMROT_SCALES;
enum { SYMROT_BLOCK_COUNT = (int)(sizeof(symrot_scales)/sizeof(symrot_scales[0])) };

#if defined(__GNUC__)
#define SYMROT_UNROLLED _Pragma("GCC unroll 8")
#else
#define SYMROT_UNROLLED
#endif
#define EACH_ROW(r) SYMROT_UNROLLED for (int r = 0; r < SYMROT_ROWS; ++r)
#define EACH_BLOCK(b) SYMROT_UNROLLED for (int b = 0; b < SYMROT_BLOCK_COUNT; ++b)

enum { SYMROT_LEAST_CHECKED = SYMROT_ORDER - 8 > SYMROT_ORDER/2 ? SYMROT_ORDER - 8 : SYMROT_ORDER/2 };
static const double SYMROT_GAP_SLACK = 1e4;      /* smooth motions exceed the geometric series by less */
static const double SYMROT_RISE = 0.4;           /* log2 of step over last step above which earlier terms count */
static const double SYMROT_LEAP = 3.0;           /* log2 of the ratio to the last step above which a step is checked */
static const double SYMROT_DEFECT = 1e4;         /* limit of the defect of a first step, in tails */
static const double SYMROT_LEAST_TAIL = 1e-18;   /* below round-off a smaller tail gains nothing */
#if SYMROT_ENCLOSED
static const double SYMROT_SLACK = 30.0;        /* enclosures exceed errors by this or less: see docs/step_control.md */
static const double SYMROT_GROWTH = 1.5;         /* largest growth of a step after an enclosure shortened one */
#endif
#if SYMROT_ROUNDS
static const double SYMROT_ROUNDED_LIMIT = 100.0;  /* tolerances: true errors are about a fifth of the bound or less */
static const double SYMROT_ROUNDED_WARNED = 1.0;   /* tolerances: from here on the error may exceed the tolerance */
enum { SYMROT_FIRST_STEPS = 8 };                 /* steps from rest, too short to show how large the rates become */
enum { SYMROT_SEVERAL = 8 };                     /* long steps per bound of the rounding errors, which saves time */
#endif
static const double SYMROT_RATE_FLOOR = 1e-3;    /* rad: errors of rates are relative to at least this per step */

/* Return log2(a/b) to 0.09, for a, b >= 0: the bits of a number are nearly its logarithm; units cancel. */
static inline double symrot_log2(double a, double b)
{
    int64_t upper, lower;
    memcpy(&upper, &a, sizeof upper);
    memcpy(&lower, &b, sizeof lower);
    return (double)(upper - lower)*(1.0/4503599627370496.0);  /* 2^-52 */
}

/* Return 2^x to 1e-4, for |x| < 1000. */
static inline double symrot_exp2(double x)
{
    const double shifted = x + 6755399441055744.0, fraction = x - (shifted - 6755399441055744.0);  /* |fraction| <= 1/2 */
    int64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    bits = (int64_t)((uint64_t)(bits + 1023) << 52);
    double power;
    memcpy(&power, &bits, sizeof power);
    return power*(1.0 + fraction*(0.693147 + fraction*(0.240227 + fraction*(0.0555 + fraction*0.0096))));
}

static inline double symrot_larger(double a, double b) { return a < b ? b : a; }

/* Return the largest lane of a block's coefficient n, in size. */
static inline double symrot_size(symrot_v4 (*x)[SYMROT_ORDER + 1], int n, int block)
{
    double size = 0.0;
    EACH_ROW(r) if (symrot_blocks[r] == block)
        SYMROT_UNROLLED for (int i = 0; i < symrot_sizes[r]; ++i) {
            const double value = fabs(V_LANE(x[r][n], i));
            size = size < value ? value : size;
        }
    return size;
}

/* Return the size to which errors of a block are relative; for a rate, its size in this step with a lower limit. */
static inline double symrot_reference(symrot_v4 (*x)[SYMROT_ORDER + 1], double unit, int block)
{
    const double fixed = symrot_scales[block];
    if (fixed > 0.0) return fixed;
    const double now = symrot_larger(symrot_size(x, 0, block), symrot_size(x, 1, block));
    return symrot_larger(now, SYMROT_RATE_FLOOR/unit);
}

/*
 * Return log2 of the shortest step, in units, at which a last term reaches the accepted tail of its block.
 */
static inline double symrot_step_log(symrot_v4 (*x)[SYMROT_ORDER + 1], double tail, double unit)
{
    double shortest = 60.0;  /* the series of a motion that is a polynomial in time ends early */
    EACH_BLOCK(b) {
        const double size = tail*symrot_reference(x, unit, b);
        const double last = symrot_log2(size, symrot_size(x, SYMROT_ORDER, b))*(1.0/SYMROT_ORDER);
        const double before = symrot_log2(size, symrot_size(x, SYMROT_ORDER - 1, b))*(1.0/(SYMROT_ORDER - 1));
        shortest = last < shortest ? last : shortest;
        shortest = before < shortest ? before : shortest;
    }
    return shortest > -60.0 ? shortest : -60.0;
}

#if SYMROT_ENCLOSED
typedef symrot_v4 (*symrot_path)[SYMROT_ORDER + 1];

static void symrot_radii(symrot_path x, double part, double *radius)
{
    EACH_ROW(r) for (int i = 0; i < symrot_sizes[r]; ++i) {
        double sum = 0.0;
        if (symrot_encloses[symrot_starts[r] + i])
            for (int n = SYMROT_ORDER; n > 0; --n) sum = (sum + fabs(V_LANE(x[r][n], i)))*part;
        radius[symrot_starts[r] + i] = sum;
    }
}

/* ENCLOSURE */
#endif

static inline void symrot_set_unit(double unit, double *step)
{
    step[0] = 0.0;
    for (int n = 1; n <= SYMROT_ORDER; ++n) step[n] = unit*symrot_inverse[n];
}

/*
 * Return the tail allowed to a step of about one unit. Errors of single steps add up about as (number of steps)^(7/4),
 * because an error of the rates causes a growing error of the attitude; the tail of a step is its share to that power.
 */
static inline double symrot_allowed(const symrot_run *run, double unit)
{
    const double share = fabs(unit)/run->pace, tail = run->tail*(share < 1.0 ? share*sqrt(share*sqrt(share)) : 1.0);
    return tail > SYMROT_LEAST_TAIL ? tail : SYMROT_LEAST_TAIL;
}

#if SYMROT_ROUNDS
/*
 * Return a bound of the rounding errors of the first block, from formulas of time, in tolerances, up to the end of a step
 * of s units, which stands for that many `steps`. Rounded, a formula such as t^2 - 25 moves a narrow pulse by another
 * amount in each step.
 */
static SYMROT_APART double symrot_rounding(symrot_run *run, symrot_v4 (*x)[SYMROT_ORDER + 1], double s, double unit,
    double t, double t_low, double steps, const double *y, const double *p)
{
    double error[SYMROT_STATES], worst = 0.0, size = 0.0;
    symrot_roundings(t, t_low, y, p, error);
    for (int i = symrot_borders[0]; i < symrot_borders[1]; ++i)
        if (!(error[i] <= worst)) worst = error[i] == error[i] ? error[i] : INFINITY;
    worst *= s*unit;
    run->rounded += steps*worst*worst;  /* errors of different steps are independent */
    const double fixed = symrot_scales[0], own = symrot_larger(symrot_size(x, 0, 0), SYMROT_RATE_FLOOR/run->pace);
    const double bound = sqrt(run->rounded)/run->tail;
    run->largest = fixed > 0.0 ? fixed : symrot_larger(run->largest, own);
    if (fixed > 0.0 || bound <= SYMROT_ROUNDED_WARNED*run->largest) return bound/run->largest;
    for (int n = SYMROT_ORDER; n >= 0; --n) size = size*fabs(s) + symrot_size(x, n, 0);  /* in this step */
    run->largest = symrot_larger(run->largest, size);
    return bound/run->largest;
}
#endif

/* Return whether the last two coefficients are all finite: only a finite number times zero is zero. */
static inline int symrot_finite(symrot_v4 (*x)[SYMROT_ORDER + 1], int order)
{
    symrot_v4 sum = V_ALL(0.0);
    EACH_ROW(r) sum = V_ADD(sum, V_MUL(V_ADD(x[r][order], x[r][order - 1]), V_ALL(0.0)));
    return V_LANE(sum, 0) + V_LANE(sum, 1) + V_LANE(sum, 2) + V_LANE(sum, 3) == 0.0;
}

/*
 * Return log2 of a step that is longer than the last one, shortened if its last terms happen to be zero. Example: a
 * torque t moves a body from rest, and only every third coefficient of the attitude is not zero. Earlier terms
 * therefore count too, if they are far above a geometric series from 1 to the tail.
 */
static SYMROT_APART double symrot_without_gap(symrot_v4 (*x)[SYMROT_ORDER + 1], double tail, double unit, double longest)
{
    const double share = symrot_log2(tail, 1.0)*(1.0/SYMROT_ORDER);
    EACH_BLOCK(b) {
        const double whole = SYMROT_GAP_SLACK*symrot_reference(x, unit, b);
        for (int n = SYMROT_ORDER - 2; n >= SYMROT_LEAST_CHECKED; --n) {
            const double early = symrot_log2(whole, symrot_size(x, n, b))*(1.0/n) + share;
            longest = early < longest ? early : longest;
        }
    }
    return longest > -60.0 ? longest : -60.0;
}

/* Return a first unit of time from the size of coefficients 1 and 2, or 0 if they are not finite in any unit. */
static SYMROT_APART double symrot_first_unit(const symrot_v4 *c, double t, double span,
    symrot_v4 (*x)[SYMROT_ORDER + 1])
{
    double step[SYMROT_ORDER + 1], unit = 1.0, fastest = 0.0;
    int tries = 0, exponent;
    for (; tries < 64; ++tries, unit *= 1.0/65536) {
        symrot_set_unit(unit, step);
        symrot_jet(c, t, 0.0, step, 2, x);
        if (symrot_finite(x, 2)) break;
    }
    if (tries == 64) return 0.0;
    EACH_BLOCK(b) {
        const double fixed = symrot_scales[b], rest = sqrt(symrot_size(x, 1, b)/unit);  /* as from rest */
        const double size = fixed > 0.0 ? fixed : symrot_larger(symrot_size(x, 0, b), rest);
        if (size > 0.0) {
            fastest = symrot_larger(fastest, symrot_size(x, 1, b)/size/unit);
            fastest = symrot_larger(fastest, sqrt(symrot_size(x, 2, b)/size)/unit);
        }
    }
    const double first = fastest*span > 1.0 ? 1.0/fastest : span;
    frexp(first, &exponent);
    return ldexp(1.0, exponent);
}

/*
 * Return the longest part of a step of s units at whose end and middle the series satisfies the equations.
 *
 * The coefficients do not show powers beyond the last one, for example if omega_2 grows as t^43 from rest.
 */
static SYMROT_APART double symrot_checked(const symrot_v4 *c, symrot_v4 (*x)[SYMROT_ORDER + 1], const symrot_v4 *carry,
    double t, double s, const double *step, double tail, double unit)
{
    symrot_v4 y[SYMROT_ROWS][SYMROT_ORDER + 1];
    for (int tries = 0; tries < 200; ++tries, s *= 0.5) {
        double worst = 0.0;
        for (int half = 1; half <= 2; ++half) {
            const double at = s/half;
            EACH_ROW(r) y[r][0] = symrot_inside(x[r], V_ALL(at), carry[r]);
            symrot_jet(c, t + at*step[1], 0.0, step, 2, y);
            EACH_ROW(r) for (int i = 0; i < symrot_sizes[r]; ++i) {
                double slope = 0.0, size = 0.0;
                for (int n = SYMROT_ORDER; n > 0; --n) {
                    slope = slope*at + n*V_LANE(x[r][n], i);
                    size = size*fabs(at) + n*fabs(V_LANE(x[r][n], i));
                }
                const double off = fabs((slope - V_LANE(y[r][1], i))*at), rounding = 1e-13*size*fabs(at);
                const double reference = symrot_reference(x, unit, symrot_blocks[r]);
                const double own = off > rounding ? off/(SYMROT_DEFECT*tail*reference + 1e-13*reference) : 0.0;
                if (!(own <= worst)) worst = own == own ? own : INFINITY;
            }
        }
        if (worst <= 1.0) break;
    }
    return s;
}

/* Write the lanes of all rows as one vector of states. The next row overwrites the surplus lanes of a row. */
static inline void symrot_write(const symrot_v4 *rows, double *out)
{
    EACH_ROW(r) {
        const int whole = r + 1 < SYMROT_ROWS && symrot_starts[r] + 4 <= SYMROT_STATES;
        memcpy(out + symrot_starts[r], &rows[r], (size_t)(whole ? 4 : symrot_sizes[r])*sizeof(double));
    }
}

/* Return the numbers of states and parameters, the order, and the length of run->kept. */
SYMROT_EXPORT void symrot_taylor_sizes(int64_t sizes[4])
{
    sizes[0] = SYMROT_STATES;
    sizes[1] = SYMROT_PARAMETERS + SYMROT_INVARIANT_PARAMETERS;
    sizes[2] = SYMROT_ORDER;
    sizes[3] = 2*SYMROT_INVARIANTS + 1;
}

/* Return the rounding error of a + b, as computed in steps: b for a large a, unless the compiler removed it. */
SYMROT_EXPORT double symrot_taylor_carry(double a, double b)
{
    const symrot_v4 y = V_ALL(a), d = V_ALL(b), y1 = V_ADD(y, d), rise = V_SUB(y1, y);
    return V_LANE(V_ADD(V_SUB(y, V_SUB(y1, rise)), V_SUB(d, rise)), 0);
}

/* Write the coefficients 0 to `order` (even) of the states at t, in units of time: row n holds coefficient n. */
SYMROT_EXPORT void symrot_taylor_jet(double t, const double *y, const double *p, double unit, int64_t order, double *out)
{
    symrot_v4 c[SYMROT_CONSTANTS], x[SYMROT_ROWS][SYMROT_ORDER + 1];
    double step[SYMROT_ORDER + 1];
    symrot_constants(p, c);
    symrot_set_unit(unit, step);
    EACH_ROW(r) {
        x[r][0] = V_ALL(0.0);
        memcpy(&x[r][0], y + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
    symrot_jet(c, t, 0.0, step, (int)order, x);
    for (int n = 0; n <= (int)order; ++n)
        EACH_ROW(r) memcpy(out + n*SYMROT_STATES + symrot_starts[r], &x[r][n], (size_t)symrot_sizes[r]*sizeof(double));
}

/* Evaluate a record of `steps` rows, all in one direction, at `count` times in any order; extrapolate at the ends. */
SYMROT_EXPORT void symrot_taylor_dense(const double *record, int64_t steps, const double *times, int64_t count,
    double *states)
{
    const double side = record[1] < 0.0 ? -1.0 : 1.0;
    for (int64_t k = 0; k < count; ++k) {
        const double *row = symrot_row_at(record, SYMROT_ROW, steps, side, times[k]), *x = row + 4;
        const double s = ((times[k] - row[0]) - row[2])/row[3];
        for (int i = 0; i < SYMROT_STATES; ++i) {
            double value = x[SYMROT_ORDER*SYMROT_STATES + i];
            for (int n = SYMROT_ORDER - 1; n >= 0; --n) value = value*s + x[n*SYMROT_STATES + i];
            states[k*SYMROT_STATES + i] = value;
        }
    }
}

/* PROJECTION */

static SYMROT_APART void symrot_record(double *row, double t, double h, double t_low, double unit,
    symrot_v4 (*x)[SYMROT_ORDER + 1])
{
    row[0] = t;
    row[1] = h;
    row[2] = t_low;
    row[3] = unit;
    for (int n = 0; n <= SYMROT_ORDER; ++n)
        EACH_ROW(r) memcpy(row + 4 + n*SYMROT_STATES + symrot_starts[r], &x[r][n],
            (size_t)symrot_sizes[r]*sizeof(double));
}

/*
 * Step from run->t towards run->stop.
 *
 * in    p          parameters of the system
 * in    times      count sample times, sorted from run->t towards run->stop
 * out   states     count rows of N states
 * out   record     room rows of SYMROT_ROW numbers, one per step, or room = 0
 * in    attempts   most steps to take in this call
 *
 * Returns SYMROT_DONE; SYMROT_PAUSED after `attempts` steps or SYMROT_FULL when the record has no room (call again to
 * continue); SYMROT_NOT_FINITE, SYMROT_UNDERFLOW or SYMROT_ROUNDED when the motion cannot be followed
 * further.
 */
SYMROT_EXPORT int symrot_taylor(symrot_run *run, const double *p, const double *times, int64_t count, double *states,
    double *record, int64_t room, int64_t attempts)
{
    symrot_v4 c[SYMROT_CONSTANTS], x[SYMROT_ROWS][SYMROT_ORDER + 1], carry[SYMROT_ROWS], y1[SYMROT_ROWS];
    double step[SYMROT_ORDER + 1];
    const double stop = run->stop, side = stop < run->t ? -1.0 : 1.0, tiny = 1e-300 + 1e-30*fabs(stop - run->t);
    double t = run->t, t_low = run->t_low, unit = run->unit;
    int64_t next = run->next, accepted = 0, jets = 0, recorded = 0;
    int status = SYMROT_PAUSED, halvings = 0, fresh = unit == 0.0;

#if SYMROT_INVARIANTS
    if (run->every > 0 && run->kept[2*SYMROT_INVARIANTS] == 0.0) {
        symrot_remember(run, p + SYMROT_PARAMETERS);
        run->kept[2*SYMROT_INVARIANTS] = 1.0;
    }
#endif
    symrot_constants(p, c);
    EACH_ROW(r) {
        x[r][0] = carry[r] = V_ALL(0.0);
        memcpy(&x[r][0], run->y + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(&carry[r], run->carry + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
    for (; next < count && times[next] == t && t_low == 0.0; ++next)
        memcpy(states + next*SYMROT_STATES, run->y, sizeof run->y);
    if (t == stop) status = SYMROT_DONE;
    else if (unit == 0.0) {
        unit = side*symrot_first_unit(c, t, fabs(stop - t), x);
        if (unit == 0.0) status = SYMROT_NOT_FINITE;
    }
    symrot_set_unit(unit, step);
    double allowed = symrot_allowed(run, unit);

    while (status == SYMROT_PAUSED && accepted < attempts) {
        if (room > 0 && recorded == room) { status = SYMROT_FULL; break; }
        symrot_jet(c, t, t_low, step, SYMROT_ORDER, x);
        ++jets;
        if (!symrot_finite(x, SYMROT_ORDER)) {
            if (++halvings > 60) { status = SYMROT_NOT_FINITE; break; }
            unit *= 1.0/256;
            symrot_set_unit(unit, step);
            allowed = symrot_allowed(run, unit);
            continue;
        }
        double logarithm = symrot_step_log(x, allowed, fabs(unit));
        if (fresh || logarithm > SYMROT_RISE) logarithm = symrot_without_gap(x, allowed, fabs(unit), logarithm);
        double s = symrot_exp2(logarithm), h = s*unit;
        if (fabs(h) > run->max_step) {
            h = side*run->max_step;
            s = h/unit;
        }
        const double left = (stop - t) - t_low;
        int at_stop = (1.01*h - left)*side >= 0.0;
        if (at_stop) {
            h = left;
            s = h/unit;
        }
#if SYMROT_ENCLOSED
        const double most = SYMROT_GROWTH*run->proven;  /* after an enclosure shortened a step */
        const int longer = most > 0.0 && fabs(h) > most;
        h = longer ? side*most : h;
        double y[SYMROT_STATES], bars[SYMROT_BLOCK_COUNT];
        EACH_BLOCK(b) bars[b] = SYMROT_SLACK*allowed*symrot_reference(x, fabs(unit), b);
        EACH_ROW(r) for (int i = 0; i < symrot_sizes[r]; ++i) y[symrot_starts[r] + i] = V_LANE(x[r][0], i);
        const double followed = symrot_followed(x, t, unit, h, y, bars, p, &run->reach);
        run->proven = longer || followed != h ? fabs(followed) : 0.0;
        if (run->proven > 0.0) {
            at_stop = 0;
            h = followed;
            s = h/unit;
            logarithm = symrot_log2(s, 1.0);
        }
#endif
        if (fresh || logarithm > SYMROT_LEAP) {  /* many coefficients may be zero at a start and far beyond the last step */
            const double held = symrot_checked(c, x, carry, t, s, step, allowed, fabs(unit));
            if (held != s) {
                s = held;
                h = s*unit;
                at_stop = 0;
                logarithm = symrot_log2(s, 1.0);
            }
        }
        fresh = 0;
        if (!at_stop && fabs(h) <= tiny + 4.0*DBL_EPSILON*fabs(t)) {
            status = SYMROT_UNDERFLOW;
            break;
        }
#if SYMROT_ROUNDS
        const int64_t before = run->accepted + accepted;
        run->longest = symrot_larger(run->longest, fabs(h));
        const int alone = at_stop || run->proven > 0.0 || fabs(h) < 0.25*run->longest;
        if (alone || before%SYMROT_SEVERAL == 0) {
            const double bound = symrot_rounding(run, x, s, unit, t, t_low, alone ? 1.0 : SYMROT_SEVERAL, y, p);
            if (at_stop || before >= SYMROT_FIRST_STEPS) {
                if (bound > SYMROT_ROUNDED_WARNED && run->rounded_from != run->rounded_from) run->rounded_from = t;
                if (bound > SYMROT_ROUNDED_LIMIT) {
                    status = SYMROT_ROUNDED;
                    break;
                }
            }
        }
#endif
        double t1 = t + h, low1 = (h - (t1 - t)) + t_low;  /* a fast sum, for |t| > |h|, else exact enough: see below */
        if (fabs(h) > fabs(t)) low1 = (t - (t1 - h)) + t_low;
        const double sum = t1 + low1;
        low1 = at_stop ? 0.0 : (t1 - sum) + low1;
        t1 = at_stop ? stop : sum;

        if (room > 0) symrot_record(record + recorded++*SYMROT_ROW, t, h, t_low, unit, x);
        const double per_unit = 1.0/unit;  /* exact: units are powers of two */
        for (; next < count && (times[next] - t1)*side < 0.0; ++next) {
            const double at = ((times[next] - t) - t_low)*per_unit;
            EACH_ROW(r) y1[r] = symrot_inside(x[r], V_ALL(at), carry[r]);
            symrot_write(y1, states + next*SYMROT_STATES);
        }
        EACH_ROW(r) x[r][0] = y1[r] = symrot_end(x[r], V_ALL(s), &carry[r]);
        t = t1;
        t_low = low1;
#if SYMROT_INVARIANTS
        if (run->every > 0 && (++run->since >= run->every || at_stop)) {
            symrot_keep(run, p + SYMROT_PARAMETERS, t, t_low, x, carry);
            EACH_ROW(r) y1[r] = x[r][0];
        }
#endif
        for (; next < count && times[next] == t && t_low == 0.0; ++next) symrot_write(y1, states + next*SYMROT_STATES);
        ++accepted;
        halvings = 0;
        if (at_stop) status = SYMROT_DONE;
        if (logarithm > 0.6 || logarithm < -0.6) {
            unit *= symrot_exp2((double)(int)(logarithm + (logarithm > 0.0 ? 0.5 : -0.5)));
            symrot_set_unit(unit, step);
            allowed = symrot_allowed(run, unit);
        }
    }

    run->t = t;
    run->t_low = t_low;
    run->unit = unit;
    run->next = next;
    run->accepted += accepted;
    run->jets += jets;
    run->recorded = recorded;
    EACH_ROW(r) {
        memcpy(run->y + symrot_starts[r], &x[r][0], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(run->carry + symrot_starts[r], &carry[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
    return status;
}

#ifdef __cplusplus
}
#endif

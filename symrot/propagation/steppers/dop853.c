/*
 * Dormand-Prince 8(5,3) with dense output of order 7: the whole loop of steps around one inlined right-hand side.
 *
 * Included after library.h and an emitted kernel, in one translation unit that has defined
 *     SYMROT_STATES       number of states N
 *     SYMROT_PARAMETERS   number of parameters
 *     SYMROT_RHS          the kernel: void name(double t, const double y[N], const double p[], double dy[N])
 *     SYMROT_BLOCKS       edges of the blocks of states with separate error norms, e.g. {0, 3, 7}
 *     SYMROT_SCALES       per block: with 0, errors are relative to the block's own size (a rate),
 *                         otherwise to this number (an attitude of unit norm: 1)
 *     SYMROT_DEFECT       if defined, limit of the defect of the dense output inside a step, in allowed errors
 *     SYMROT_ENCLOSED     whether some terms of the rates may hide a feature: then enclosure.h is inserted here
 *     SYMROT_ROUNDS       whether rounding errors of the rates are bounded, by symrot_roundings
 * and included dop853_tableau.h. C99 that is also valid C++; no malloc, no globals, no input or output, reentrant.
 *
 * States are padded to a multiple of 4 so that every sum over stages is a few full vectors. The sum for a stage has two
 * parts: first all earlier stages, while the kernel is still running, then the newest stage, element by element,
 * because a vector load of numbers that were just stored one by one would wait for the stores.
 *
 * Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., sections II.4 to 6.
 */
#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SYMROT_APART __attribute__((noinline))  /* rarely called: not inlined into the loop of steps */
#define SYMROT_ALIGNED __attribute__((aligned(32)))
#else
#define SYMROT_APART
#define SYMROT_ALIGNED
#endif

enum {
    SYMROT_WIDTH = (SYMROT_STATES + 3)/4*4,
    SYMROT_STAGES = 16,
    SYMROT_TERMS = 8,                                 /* coefficients of the dense output */
    SYMROT_ROW = 2 + SYMROT_TERMS*SYMROT_STATES       /* one recorded step: t, h, coefficients */
};

typedef struct {
    double t;            /* time reached so far */
    double h;            /* next step, signed; 0 before the first one */
    double growth;       /* largest growth of the step after the next: 1 after a rejected step */
    double stop;         /* end of the span, on either side of t */
    double first, last;  /* times passed to the kernel at the two ends: just inside the span at a switching time */
    double tolerance;    /* of one step of length `pace` or more; a shorter step is allowed its share */
    double pace;
    double max_step;     /* positive */
    double proven;       /* the last step, if the enclosure held it back, or 0 */
    double variation;    /* sum of the changes of all steps, relative to the sizes of the blocks */
    double epoch;        /* time from which the kernel counts its time */
    double far;          /* pause if the epoch is so many steps away, so that it can be moved; 0: never */
    double rounded;      /* sum of the squares of the first block's errors from rounded times and formulas of time */
    double rounded_from; /* time from which these errors exceed the tolerance; NAN: nowhere so far */
    double turned;       /* error of the attitude from them, rad */
    double largest;      /* largest size of the first block so far */
    int64_t reach;       /* number of the disc with the best bound in the last step */
    int64_t next;        /* first sample not yet written */
    int64_t accepted, rejected, evaluations, recorded;
    double y[SYMROT_STATES], carry[SYMROT_STATES], dy[SYMROT_STATES];
} symrot_run;

#if defined(SYMROT_DEFECT) || SYMROT_DEPENDS
#define SYMROT_KNOWN 1  /* the dense output of a step is computed before its acceptance */
#else
#define SYMROT_KNOWN 0
#endif

#define EACH(i) for (int i = 0; i < SYMROT_WIDTH; ++i)
#define EACH_STATE(i) for (int i = 0; i < SYMROT_STATES; ++i)

/* ONE_BY_ONE(X): X(0) X(1) ... without a loop, so that numbers stay in registers between kernel and sum. */
#define ONE_BY_ONE_1(X) X(0)
#define ONE_BY_ONE_2(X) ONE_BY_ONE_1(X) X(1)
#define ONE_BY_ONE_3(X) ONE_BY_ONE_2(X) X(2)
#define ONE_BY_ONE_4(X) ONE_BY_ONE_3(X) X(3)
#define ONE_BY_ONE_5(X) ONE_BY_ONE_4(X) X(4)
#define ONE_BY_ONE_6(X) ONE_BY_ONE_5(X) X(5)
#define ONE_BY_ONE_7(X) ONE_BY_ONE_6(X) X(6)
#define ONE_BY_ONE_8(X) ONE_BY_ONE_7(X) X(7)
#define ONE_BY_ONE_9(X) ONE_BY_ONE_8(X) X(8)
#define ONE_BY_ONE_10(X) ONE_BY_ONE_9(X) X(9)
#define JOIN(a, b) a##b
#define COUNTED(n) JOIN(ONE_BY_ONE_, n)
#if SYMROT_STATES <= 10
#define ONE_BY_ONE(X) COUNTED(SYMROT_STATES)(X)
#else
#define ONE_BY_ONE(X) for (int i_ = 0; i_ < SYMROT_STATES; ++i_) { X(i_) }
#endif

/* The kernel under a name that no variable here hides. */
static inline void symrot_rate(double t, const double *y, const double *p, double *dy) { SYMROT_RHS(t, y, p, dy); }

static const int symrot_edges[] = SYMROT_BLOCKS;
static const double symrot_scales[] = SYMROT_SCALES;
enum { SYMROT_COUNT = (int)(sizeof(symrot_scales)/sizeof(symrot_scales[0])) };

static const double SYMROT_SAFETY = 0.9, SYMROT_GROWTH = 6.0;           /* factors on the step when it is accepted, */
static const double SYMROT_SHRINK = 1.0/3.0, SYMROT_COLLAPSE = 0.1;      /* rejected, not finite; after dop853.f */
#if SYMROT_ENCLOSED
static const double SYMROT_SLACK = 1e4;   /* enclosures exceed errors by this or less: see docs/step_control.md */
static const double SYMROT_REGAIN = 1.5;  /* largest growth of a step after an enclosure shortened one */
#endif
static const double SYMROT_LARGE = 1e80;  /* limit of squares of errors: products of two are finite */
static const double SYMROT_ROUND_OFF = 2.0*DBL_EPSILON;  /* smallest error that a step can have */
static const double SYMROT_RATE_FLOOR = 1e-3;  /* rad: errors of rates are relative to at least this per long step */
#if defined(SYMROT_DEFECT)
/* Return 2.2 units in the last place of the later one of two times. */
static inline double symrot_unit(double t, double t1)
{
    const double far = fmax(fabs(t), fabs(t1));
    return 2.2*(nextafter(far, INFINITY) - far);
}
#endif

/* Return x^(-1/16) to 4 %, which is enough for a step size: the bits of a number are nearly its logarithm. */
static inline double symrot_inverse_root_16(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = UINT64_C(0x43EE600000000000) - bits/16;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline double symrot_square_sum(const double *v, int block)
{
    double sum = 0.0;
    for (int i = symrot_edges[block]; i < symrot_edges[block + 1]; ++i) sum += v[i]*v[i];
    return sum;
}

/* Return the length of a block of v, whose squares may be too large or too small for a double. */
static inline double symrot_length(const double *v, int block)
{
    double largest = 0.0, sum = 0.0;
    for (int i = symrot_edges[block]; i < symrot_edges[block + 1]; ++i) largest = fmax(largest, fabs(v[i]));
    if (!(largest > 0.0 && largest <= DBL_MAX)) return largest;
    for (int i = symrot_edges[block]; i < symrot_edges[block + 1]; ++i) sum += v[i]/largest*(v[i]/largest);
    return largest*sqrt(sum);
}

/* Return the square of the size that the error of a block is compared with in a step of length h. In a pulse, where
 * steps are short, errors of rates are not relative to a larger rate: they remain after the pulse. */
static inline double symrot_scale_squared(const double *y, const double *y1, double h, double pace, int block)
{
    const double fixed = symrot_scales[block];
    if (fixed > 0.0) return fixed*fixed;
    const double before = symrot_square_sum(y, block), after = symrot_square_sum(y1, block);
    const double larger = before > after ? before : after, least = SYMROT_RATE_FLOOR/fmax(fabs(h), pace);
    const double size = larger > least*least ? larger : least*least;
    return size < DBL_MAX ? size : DBL_MAX;  /* finite even for the shortest step */
}

#if SYMROT_ENCLOSED
/* Return about how much a block changes in a step with the stages k, relative to its size. */
static SYMROT_APART double symrot_change(double (*k)[SYMROT_WIDTH], double h, double size, int block)
{
    const double rate = symrot_length(k[1], block) + symrot_length(k[8], block) + symrot_length(k[12], block);
    return fmin(fabs(h)*rate/(3.0*size), 1.0);
}
#endif

/* Return the size of a block at the start; of a rate from rest, at least its size once the body has rotated. */
static inline double symrot_first_size(const symrot_run *run, int block)
{
    const double fixed = symrot_scales[block];
    return fixed > 0.0 ? fixed : fmax(symrot_length(run->y, block), sqrt(symrot_length(run->dy, block)));
}

/* Choose a first step from the rates |y'|/|y| and sqrt(|y''|/|y|) of the fastest block. */
static SYMROT_APART double symrot_first_step(const symrot_run *run, const double *p)
{
    double y1[SYMROT_STATES], dy1[SYMROT_STATES], rate = 0.0, bend = 0.0;
    const double span = fabs(run->stop - run->t), side = run->stop < run->t ? -1.0 : 1.0;

    for (int b = 0; b < SYMROT_COUNT; ++b) {
        const double size = symrot_first_size(run, b);
        const double block = symrot_length(run->dy, b)/size;
        if (size > 0.0 && block > rate) rate = block;
    }
    const double probe = side*fmin(fmin(0.01/rate, 1e-3*span), run->max_step);
    EACH_STATE(i) y1[i] = run->y[i] + probe*run->dy[i];
    symrot_rate(run->first - run->epoch + probe, y1, p, dy1);
    EACH_STATE(i) dy1[i] = (dy1[i] - run->dy[i])/probe;
    for (int b = 0; b < SYMROT_COUNT; ++b) {
        const double size = symrot_first_size(run, b);
        const double block = sqrt(symrot_length(dy1, b)/size);
        if (size > 0.0 && block > bend) bend = block;
    }
    const double fastest = rate > bend ? rate : bend;
    const double least = 64.0*DBL_EPSILON*fabs(run->t);  /* rates near zero would require less than the rounding of t */
    const double h = fmax(pow(run->tolerance, 0.125)/fastest, least);
    return side*fmin(fmin(h, run->max_step), span);  /* fmin ignores the NaN or infinity of a motion at rest */
}

/* Compute the coefficients of the dense output of the step from y to y1, which begins at the kernel's time `at`; k has
 * stages 1 to 13 and receives 14 to 16. */
static SYMROT_APART void symrot_dense_coefficients(double at, double h, const double *y, const double *step,
    const double *p, double (*k)[SYMROT_WIDTH], double (*term)[SYMROT_WIDTH])
{
    double z[SYMROT_WIDTH] SYMROT_ALIGNED;
#define K(s) k[s][i]
    EACH(i) z[i] = y[i] + h*DOP853_SUM_14(K);
    symrot_rate(at + DOP853_NODE_14*h, z, p, k[14]);
    EACH(i) z[i] = y[i] + h*DOP853_SUM_15(K);
    symrot_rate(at + DOP853_NODE_15*h, z, p, k[15]);
    EACH(i) z[i] = y[i] + h*DOP853_SUM_16(K);
    symrot_rate(at + DOP853_NODE_16*h, z, p, k[16]);
    EACH(i) {
        const double rise = step[i], bend = h*k[1][i] - rise;
        term[0][i] = y[i];
        term[1][i] = rise;
        term[2][i] = bend;
        term[3][i] = rise - h*k[13][i] - bend;
        term[4][i] = h*DOP853_DENSE_5(K);
        term[5][i] = h*DOP853_DENSE_6(K);
        term[6][i] = h*DOP853_DENSE_7(K);
        term[7][i] = h*DOP853_DENSE_8(K);
    }
#undef K
}

/* Evaluate the dense output at the fraction s of its step; term has the given stride between coefficients. */
static inline void symrot_dense_value(const double *term, int stride, double s, double *out)
{
    const double r = 1.0 - s;
    EACH_STATE(i) {
        const double *c = term + i;
        out[i] = c[0] + s*(c[stride] + r*(c[2*stride] + s*(c[3*stride] + r*(c[4*stride] + s*(c[5*stride]
            + r*(c[6*stride] + s*c[7*stride]))))));
    }
}

#if SYMROT_ENCLOSED
typedef double (*symrot_path)[SYMROT_WIDTH];  /* coefficients of the dense output */

static void symrot_radii(symrot_path term, double part, double *radius)
{
    const double s = part, r = 1.0 + part;  /* bounds of the two factors of the dense output */
    EACH_STATE(i) radius[i] = !symrot_encloses[i] ? 0.0 : s*(fabs(term[1][i]) + r*(fabs(term[2][i])
        + s*(fabs(term[3][i]) + r*(fabs(term[4][i]) + s*(fabs(term[5][i]) + r*(fabs(term[6][i])
        + s*fabs(term[7][i])))))));
}

/* ENCLOSURE */
#endif

#if SYMROT_ROUNDS
/* Bound the rounding errors of formulas of time so far, and note the time from which they may exceed the tolerance. */
static SYMROT_APART void symrot_add_formulas(symrot_run *run, double t, double h, double size, const double *y,
    const double *p)
{
    const double at = t - run->epoch, tolerance = run->tolerance/SYMROT_STEP_SHARE;
    double error[SYMROT_STATES], worst = 0.0;
    symrot_roundings(at, 0.5*DBL_EPSILON*fabs(at), y, p, error);
    for (int i = symrot_edges[0]; i < symrot_edges[1]; ++i) worst = fmax(worst, error[i]);
    run->largest = fmax(run->largest, size);
    run->rounded += h*worst*h*worst;  /* errors of different steps are independent */
    const int exceeds = !(sqrt(run->rounded) <= tolerance*run->largest);
    if (run->rounded_from != run->rounded_from && exceeds) run->rounded_from = t;
}
#endif

#if defined(SYMROT_DEFECT)
/*
 * Return the likely error of the first block in a step because the times of its stages are rounded by up to half a unit
 * in the last place: the derivative of the rates by time, from two times at one state, times 2.2 units. That is the root
 * of the sum of the squared weights of the stages over root 12.
 */
static SYMROT_APART double symrot_rounding(const symrot_run *run, double t, double h, const double *y, const double *dy,
    const double *p)
{
    double later[SYMROT_STATES];
    symrot_rate(t + h - run->epoch, y, p, later);
    EACH_STATE(i) later[i] -= dy[i];
    return symrot_unit(t, t + h)*symrot_length(later, 0);
}

/*
 * Estimate the errors from rounded times in the steps so far, and note the time from which they exceed the tolerance:
 * errors of different steps are independent, and they rotate the body further. Return the number of evaluations.
 */
static SYMROT_APART int symrot_add_rounding(symrot_run *run, double t, double h, double size, const double *y,
    const double *dy, const double *p)
{
    const double unit = symrot_unit(t, t + h), tolerance = run->tolerance/SYMROT_STEP_SHARE;
    run->largest = fmax(run->largest, size);
    run->turned += fabs(h)*sqrt(run->rounded);
    if (unit < 0.01*tolerance*fabs(h)) return 0;  /* a step changes the rates by about size */
    const double error = symrot_rounding(run, t, h, y, dy, p);
    run->rounded += error*error;
    const int exceeds = sqrt(run->rounded) > tolerance*run->largest || run->turned > tolerance;
    if (run->rounded_from != run->rounded_from && exceeds) run->rounded_from = t;
    return 1;
}

/* Return the defect of the dense output inside a step: its error in the equations, per step and relative to blocks. */
static SYMROT_APART double symrot_defect(double at, double h, double pace, const double *y, const double *y1,
    const double *p, double (*term)[SYMROT_WIDTH])
{
    static const double places[] = {0.2718, 0.6180};
    double worst = 0.0;
    for (int n = 0; n < 2; ++n) {
        const double s = places[n], r = 1.0 - s;
        double here[SYMROT_STATES], slope[SYMROT_STATES], rate[SYMROT_STATES];
        EACH_STATE(i) {  /* value and slope of the dense output, from the innermost bracket outwards */
            double value = term[7][i], rise = 0.0;
            for (int k = 6; k >= 0; --k) {
                rise = k%2 ? r*rise - value : s*rise + value;
                value = term[k][i] + (k%2 ? r : s)*value;
            }
            here[i] = value;
            slope[i] = rise;
        }
        symrot_rate(at + s*h, here, p, rate);
        EACH_STATE(i) slope[i] -= h*rate[i];
        for (int b = 0; b < SYMROT_COUNT; ++b) {
            const double defect = sqrt(symrot_square_sum(slope, b)/symrot_scale_squared(y, y1, h, pace, b));
            if (worst == worst && !(defect <= worst)) worst = defect;  /* NaN remains NaN */
        }
    }
    return worst;
}
#endif

/* Return the numbers of states and parameters for which this library was built. */
SYMROT_EXPORT void symrot_dop853_sizes(int64_t sizes[2])
{
    sizes[0] = SYMROT_STATES;
    sizes[1] = SYMROT_PARAMETERS;
}

/* Evaluate a record of `steps` rows, all in one direction, at `count` times in any order; extrapolate at the ends. */
SYMROT_EXPORT void symrot_dop853_dense(const double *record, int64_t steps, const double *times, int64_t count,
    double *states)
{
    const double side = record[1] < 0.0 ? -1.0 : 1.0;
    for (int64_t n = 0; n < count; ++n) {
        const double *row = symrot_row_at(record, SYMROT_ROW, steps, side, times[n]);
        symrot_dense_value(row + 2, SYMROT_STATES, (times[n] - row[0])/row[1], states + n*SYMROT_STATES);
    }
}

/*
 * Step from run->t towards run->stop.
 *
 * in    p          parameters of the kernel
 * in    times      count sample times, sorted from run->t towards run->stop
 * out   states     count rows of N states
 * out   record     room rows of SYMROT_ROW numbers, one per step, or room = 0
 * in    attempts   most steps to try in this call
 *
 * Returns SYMROT_DONE; SYMROT_PAUSED after `attempts` steps or SYMROT_FULL when the record has no room (call again to
 * continue); SYMROT_NOT_FINITE or SYMROT_UNDERFLOW when the motion cannot be followed further.
 */
SYMROT_EXPORT int symrot_dop853(symrot_run *run, const double *p, const double *times, int64_t count, double *states,
    double *record, int64_t room, int64_t attempts)
{
    double k[SYMROT_STAGES + 1][SYMROT_WIDTH] SYMROT_ALIGNED, term[SYMROT_TERMS][SYMROT_WIDTH] SYMROT_ALIGNED;
    double y[SYMROT_WIDTH] SYMROT_ALIGNED, y1[SYMROT_WIDTH] SYMROT_ALIGNED, z[SYMROT_WIDTH] SYMROT_ALIGNED;
    double step[SYMROT_WIDTH] SYMROT_ALIGNED, carry[SYMROT_WIDTH] SYMROT_ALIGNED;
    double error5[SYMROT_WIDTH] SYMROT_ALIGNED, error3[SYMROT_WIDTH] SYMROT_ALIGNED;
    const double stop = run->stop, side = stop < run->t ? -1.0 : 1.0;
    const double epoch = run->epoch, pace = run->pace, tiny = 1e-30*fabs(stop - run->t);
    double t = run->t, h = run->h, growth = run->growth;
    int64_t next = run->next, accepted = 0, rejected = 0, proofs = 0, dense = 0, defects = 0, recorded = 0;
    int status = SYMROT_PAUSED, broken = 0;

    memset(k, 0, sizeof k);
    memset(y, 0, sizeof y);
    memset(z, 0, sizeof z);
    memset(carry, 0, sizeof carry);
    if (h == 0.0) {
        symrot_rate(run->first - run->epoch, run->y, p, run->dy);
        h = run->h = stop == t ? 0.0 : symrot_first_step(run, p);
        growth = SYMROT_GROWTH;
        run->evaluations += 2;
        for (; next < count && times[next] == t; ++next) EACH_STATE(i) states[next*SYMROT_STATES + i] = run->y[i];
    }
    EACH_STATE(i) y[i] = run->y[i];
    EACH_STATE(i) { carry[i] = run->carry[i]; k[1][i] = run->dy[i]; }
    if (t == stop) status = SYMROT_DONE;

    while (status == SYMROT_PAUSED && accepted + rejected < attempts) {
        double t1 = t + h;
        if ((t1 + 0.01*h - stop)*side >= 0.0) t1 = stop;
        h = t1 - t;
        if (t1 == t || (fabs(h) <= tiny + 4.0*DBL_EPSILON*fabs(t) && t1 != stop)) {
            status = broken ? SYMROT_NOT_FINITE : SYMROT_UNDERFLOW;
            break;
        }
        if (room > 0 && recorded == room) { status = SYMROT_FULL; break; }
        if (run->far > 0.0 && fabs(t - epoch) > run->far*fabs(h)) break;
        const double at = t - epoch, last = (t1 == stop ? run->last : t1) - epoch;  /* for the kernel */

#define K(s) k[s][i]
#define ADD_NEWEST(i) z[i] += newest*latest[i];
#define STAGE(s, previous, time) \
        EACH(i) z[i] = y[i] + h*(DOP853_OLD_##s(K)); \
        { \
            const double newest = h*DOP853_NEW_##s, *const latest = k[previous]; \
            ONE_BY_ONE(ADD_NEWEST) \
        } \
        symrot_rate(time, z, p, k[s]);

        STAGE(2, 1, at + DOP853_NODE_2*h)
        STAGE(3, 2, at + DOP853_NODE_3*h)
        STAGE(4, 3, at + DOP853_NODE_4*h)
        STAGE(5, 4, at + DOP853_NODE_5*h)
        STAGE(6, 5, at + DOP853_NODE_6*h)
        STAGE(7, 6, at + DOP853_NODE_7*h)
        STAGE(8, 7, at + DOP853_NODE_8*h)
        STAGE(9, 8, at + DOP853_NODE_9*h)
        STAGE(10, 9, at + DOP853_NODE_10*h)
        STAGE(11, 10, at + DOP853_NODE_11*h)
        STAGE(12, 11, last)

        EACH(i) {
            const double sum = DOP853_WEIGHTS(K);
            step[i] = h*sum + carry[i];
            y1[i] = y[i] + step[i];
            error3[i] = h*(sum - DOP853_WEIGHTS_3(K));
            error5[i] = h*DOP853_ERROR_5(K);
        }
        const double share = run->tolerance*(fabs(h) < pace ? fabs(h)/pace : 1.0);
        double allowed = share > SYMROT_ROUND_OFF ? share : SYMROT_ROUND_OFF, worst = 0.0;
#if SYMROT_ENCLOSED
        /* In a pulse, the rounding of its phase looks like an error in proportion to the change. A step is allowed such
         * an error, less and less, so that all of them together remain near the tolerance. */
        double change = 0.0;
        for (int b = 0; b < SYMROT_COUNT; ++b)
            change = fmax(change, symrot_change(k, h, sqrt(symrot_scale_squared(y, y1, h, pace, b)), b));
        allowed = fmax(allowed, run->tolerance*change/(1.0 + run->variation));
#endif
        const double weight = 1.0/(allowed*allowed);
        for (int b = 0; b < SYMROT_COUNT; ++b) {
            double e5 = symrot_square_sum(error5, b), e3 = symrot_square_sum(error3, b);
            double size = symrot_scale_squared(y, y1, h, pace, b);
            if (size > SYMROT_LARGE || (size > 0.0 && size < 1.0/SYMROT_LARGE)) {
                e5 /= size;
                e3 /= size;
                size = 1.0;
            }
            const double error = e5*e5/((e5 + 0.01*e3)*size + DBL_MIN)*weight;
            if (worst == worst && !(error <= worst)) worst = error;  /* NaN remains NaN for any other block */
        }
#if defined(SYMROT_DEFECT)
        if (worst > 1.0) {  /* far from t = 0, rounded times look like an error that a shorter step does not reduce */
            const double own = symrot_rounding(run, t, h, y, k[1], p);
            const double noise = own/sqrt(symrot_scale_squared(y, y1, h, pace, 0));
            ++proofs;
            if (noise > allowed) {
                worst *= allowed/noise*(allowed/noise);
                allowed = noise;
            }
        }
#endif
        const double factor = SYMROT_SAFETY*symrot_inverse_root_16(worst);

#if SYMROT_ENCLOSED
        if (worst <= 1.0) {
            double bars[SYMROT_COUNT];
            for (int b = 0; b < SYMROT_COUNT; ++b)
                bars[b] = SYMROT_SLACK*allowed*sqrt(symrot_scale_squared(y, y1, h, pace, b));
            if (SYMROT_DEPENDS) {  /* enclosures that depend on the states need their path */
                symrot_rate(last, y1, p, k[13]);
                symrot_dense_coefficients(at, h, y, step, p, k, term);
                ++dense;
            }
            const double followed = symrot_followed(term, at, h, h, y, bars, p, &run->reach);
            if (followed != h) {
                ++rejected;
                proofs += SYMROT_DEPENDS;
                h = followed;
                growth = 1.0;
                run->proven = fabs(h);
                continue;
            }
            run->proven = run->proven > 0.0 && fabs(h) <= SYMROT_REGAIN*run->proven ? fabs(h) : 0.0;
        }
#endif
#if defined(SYMROT_DEFECT)
        if (worst <= 1.0) {
            symrot_rate(last, y1, p, k[13]);
            symrot_dense_coefficients(at, h, y, step, p, k, term);
            ++dense;
            defects += 2;
            const double defect = symrot_defect(at, h, pace, y, y1, p, term);
            if (!(defect <= SYMROT_DEFECT*allowed)) {
                ++rejected;
                ++proofs;
                h *= 0.5;
                growth = 1.0;
                continue;
            }
        }
#endif
        if (!(worst <= 1.0)) {
            ++rejected;
            broken = !(worst < INFINITY);
            h *= broken ? SYMROT_COLLAPSE : factor > SYMROT_SHRINK ? factor : SYMROT_SHRINK;
            growth = 1.0;
            continue;
        }
#if SYMROT_ROUNDS
        symrot_add_formulas(run, t, h, sqrt(symrot_scale_squared(y, y1, h, pace, 0)), y, p);
#endif
#if defined(SYMROT_DEFECT)
        proofs += symrot_add_rounding(run, t, h, sqrt(symrot_scale_squared(y, y1, h, pace, 0)), y, k[1], p);
#endif
        ++accepted;
#if SYMROT_ENCLOSED
        run->variation += change;
#endif
        if (!SYMROT_KNOWN) symrot_rate(last, y1, p, k[13]);

        const int sampled = next < count && (times[next] - t1)*side <= 0.0;
        if (!SYMROT_KNOWN && (room > 0 || (sampled && times[next] != t1))) {
            symrot_dense_coefficients(at, h, y, step, p, k, term);
            ++dense;
        }
        if (room > 0) {
            double *row = record + recorded*SYMROT_ROW;
            row[0] = t;
            row[1] = h;
            for (int j = 0; j < SYMROT_TERMS; ++j) EACH_STATE(i) row[2 + j*SYMROT_STATES + i] = term[j][i];
            ++recorded;
        }
        if (sampled)
            for (; next < count && (times[next] - t1)*side <= 0.0; ++next) {
                double *out = states + next*SYMROT_STATES;
                if (times[next] == t1) EACH_STATE(i) out[i] = y1[i];
                else symrot_dense_value(term[0], SYMROT_WIDTH, (times[next] - t)/h, out);
            }

        EACH(i) {
            const double rise = y1[i] - y[i];  /* Knuth's sum: the rounding error of y1 is added in the next step */
            carry[i] = (y[i] - (y1[i] - rise)) + (step[i] - rise);
            y[i] = y1[i];
            k[1][i] = k[13][i];
        }
        t = t1;
        if (t == stop) status = SYMROT_DONE;
        h *= factor < growth ? (factor > SYMROT_SHRINK ? factor : SYMROT_SHRINK) : growth;
        if (fabs(h) > run->max_step) h = side*run->max_step;
        growth = SYMROT_GROWTH;
#if SYMROT_ENCLOSED
        if (run->proven > 0.0 && fabs(h) > SYMROT_REGAIN*run->proven) h = side*SYMROT_REGAIN*run->proven;
#endif
    }

    run->t = t;
    run->h = h;
    run->growth = growth;
    run->next = next;
    run->accepted += accepted;
    run->rejected += rejected;
    run->evaluations += 12*accepted + 11*rejected + proofs + 3*dense + defects;
    run->recorded = recorded;
    EACH_STATE(i) { run->y[i] = y[i]; run->carry[i] = carry[i]; run->dy[i] = k[1][i]; }
    return status;
}

#ifdef __cplusplus
}
#endif

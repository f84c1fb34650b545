/*
 * Zeros of functions along a motion that is known at any time: all of them, each to the last bits.
 *
 * Included after an emitted function symrot_event, see symrot.codegen.event_source. The motion comes in pieces (the
 * steps of a stepper) and a function that gives its states at any time (the dense output of that stepper).
 *
 * On an interval the function is sampled at Chebyshev points, which gives it and its derivatives as Chebyshev series.
 * Where the constant term outweighs all others
 *     of the series,               there is no zero;
 *     of the first derivative,     there is at most one: the signs at the ends tell;
 *     of the second derivative,    there is one extremum, which is found: it parts the zeros, or touches zero itself.
 * Otherwise the interval is cut in two. A value is compared with the bound of its own rounding errors, nothing else, so
 * no tolerance decides what a touch is. Zeros are closed in until no double is left between the ends.
 *
 * C99 that is also valid C++; no malloc, no globals, no input or output, reentrant.
 *
 * Source: L. N. Trefethen, Approximation Theory and Approximation Practice, extended ed., chapters 3, 18 and 21;
 * T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149.
 */
#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define SYMROT_EXPORT __declspec(dllexport)
#else
#define SYMROT_EXPORT
#endif

enum { SYMROT_POINTS = 21, SYMROT_DEGREE = SYMROT_POINTS - 1, SYMROT_DEPTH = 128, SYMROT_FOUND = 5 };

typedef void (*symrot_dense)(const double *record, int64_t steps, const double *times, int64_t count, double *states);

typedef struct {
    symrot_dense dense;
    const double *record;
    int64_t steps;
    const double *p;
    double *found;       /* rows of SYMROT_FOUND numbers: event, from, to, sign before, sign after; 0 for unknown */
    int64_t count, room;
    double cosine[2*SYMROT_DEGREE];  /* of multiples of pi/SYMROT_DEGREE */
} symrot_search;

static double symrot_value(const symrot_search *search, int event, double t, double *noise)
{
    double y[SYMROT_STATES];
    search->dense(search->record, search->steps, &t, 1, y);
    return symrot_event(event, t, y, search->p, noise);
}

static int symrot_sign(double value, double noise) { return value > noise ? 1 : value < -noise ? -1 : 0; }

static void symrot_add(symrot_search *search, int event, double from, double to, int before, int after)
{
    if (search->count < search->room) {
        double *row = search->found + search->count*SYMROT_FOUND;
        row[0] = event;
        row[1] = from;
        row[2] = to;
        row[3] = before;
        row[4] = after;
    }
    ++search->count;
}

/* Close in on a change of sign between a and b, until they are neighbours; return the end with the smaller value. */
static double symrot_close_in(const symrot_search *search, int event, double a, double fa, double b, double fb)
{
    double c = a, fc = fa, share = 0.5, noise;  /* a is the latest end, b the other side, c the end before */
    for (int tries = 0; tries < 200; ++tries) {
        const double middle = a + share*(b - a);
        double t = middle;
        if (t == a || t == b) t = a + 0.5*(b - a);
        if (t == a || t == b || fa == 0.0) break;
        const double ft = symrot_value(search, event, t, &noise);
        if ((ft > 0.0) == (fa > 0.0)) {
            c = a;
            fc = fa;
        } else {
            c = b;
            b = a;
            fc = fb;
            fb = fa;
        }
        a = t;
        fa = ft;
        const double xi = (a - b)/(c - b), phi = (fa - fb)/(fc - fb);
        share = 0.5;
        if (phi*phi < xi && (1.0 - phi)*(1.0 - phi) < 1.0 - xi)  /* inverse quadratic interpolation is safe */
            share = fa/(fb - fa)*fc/(fb - fc) + (c - a)/(b - a)*fa/(fc - fa)*fb/(fc - fb);
        const double least = DBL_EPSILON*fmax(fabs(a), fabs(b))/fabs(b - a);
        if (!(share >= least)) share = least;
        if (share > 1.0 - least) share = 1.0 - least;
    }
    return fabs(fa) <= fabs(fb) ? a : b;
}

/* Report the zero of a piece without extremum from its ends. */
static void symrot_at_most_one(symrot_search *search, int event, double a, double fa, double na, double b, double fb,
    double nb)
{
    const int from = symrot_sign(fa, na), to = symrot_sign(fb, nb);
    if (from*to < 0) {
        const double t = symrot_close_in(search, event, a, fa, b, fb);
        symrot_add(search, event, t, t, from, to);
    } else if (from == 0 && to != 0) symrot_add(search, event, a, a, 0, to);
    else if (to == 0 && from != 0) symrot_add(search, event, b, b, from, 0);
}

static double symrot_clenshaw(const double *c, int terms, double x)
{
    double u = 0.0, v = 0.0;
    for (int k = terms - 1; k > 0; --k) {
        const double w = 2.0*x*u - v + c[k];
        v = u;
        u = w;
    }
    return x*u - v + c[0];
}

/* Fill d with the series of the derivative of c, both with halves already taken in the constant term. */
static void symrot_derivative(const double *c, double *d)
{
    double before = 0.0, last = 0.0;  /* d[k + 2] and d[k + 1] */
    for (int k = SYMROT_DEGREE; k >= 0; --k) {
        const double here = k < SYMROT_DEGREE ? before + 2.0*(k + 1)*c[k + 1] : 0.0;
        before = last;
        last = here;
        d[k] = here;
    }
    d[0] *= 0.5;
}

/* Return whether the constant term outweighs the rest and what may be missing. */
static int symrot_one_sign(const double *c, double missing)
{
    double rest = missing;
    for (int k = 1; k <= SYMROT_DEGREE; ++k) rest += fabs(c[k]);
    return fabs(c[0]) > rest;
}

/* Find the zeros in one interval, or return 0 if it must be cut. */
static int symrot_settle(symrot_search *search, int event, double a, double b, int smallest)
{
    double times[SYMROT_POINTS], y[SYMROT_POINTS*SYMROT_STATES], f[SYMROT_POINTS];
    double c[SYMROT_POINTS], d[SYMROT_POINTS], e[SYMROT_POINTS], noise = 0.0, largest = 0.0, n0 = 0.0, n1 = 0.0, own;
    int finite = 0;
    for (int i = 0; i < SYMROT_POINTS; ++i) times[i] = 0.5*(a + b) - 0.5*(b - a)*search->cosine[i];
    times[0] = a;
    times[SYMROT_DEGREE] = b;
    search->dense(search->record, search->steps, times, SYMROT_POINTS, y);
    for (int i = 0; i < SYMROT_POINTS; ++i) {
        f[i] = symrot_event(event, times[i], y + i*SYMROT_STATES, search->p, &own);
        if (!(fabs(f[i]) < INFINITY)) continue;
        ++finite;
        if (i == 0) n0 = own;
        if (i == SYMROT_DEGREE) n1 = own;
        noise = fmax(noise, own);
        largest = fmax(largest, fabs(f[i]));
    }
    if (finite < SYMROT_POINTS) return smallest || finite == 0;  /* no value there: zeros beside it are found by cutting */
    if (largest <= noise) {
        symrot_add(search, event, a, b, 0, 0);
        return 1;
    }
    if (smallest) {
        symrot_at_most_one(search, event, a, f[0], n0, b, f[SYMROT_DEGREE], n1);
        return 1;
    }
    for (int k = 0; k <= SYMROT_DEGREE; ++k) {  /* x = -cos(i pi/n) rises with i */
        double sum = 0.5*(f[SYMROT_DEGREE] + (k%2 ? -f[0] : f[0]));
        for (int i = 1; i < SYMROT_DEGREE; ++i)
            sum += f[SYMROT_DEGREE - i]*search->cosine[i*k%(2*SYMROT_DEGREE)];
        c[k] = sum*(2.0/SYMROT_DEGREE);
    }
    c[0] *= 0.5;
    c[SYMROT_DEGREE] *= 0.5;
    const double last = fabs(c[SYMROT_DEGREE]) + fabs(c[SYMROT_DEGREE - 1]) + fabs(c[SYMROT_DEGREE - 2]);
    const double missing = 4.0*last + 2.0*noise, squared = (double)SYMROT_DEGREE*SYMROT_DEGREE;
    if (symrot_one_sign(c, missing)) return 1;
    symrot_derivative(c, d);
    if (symrot_one_sign(d, missing*squared)) {
        symrot_at_most_one(search, event, a, f[0], n0, b, f[SYMROT_DEGREE], n1);
        return 1;
    }
    symrot_derivative(d, e);
    if (!symrot_one_sign(e, missing*squared*(squared - 1.0)*(1.0/3.0))) return 0;
    double low = -1.0, high = 1.0;  /* the slope, which is monotonous, changes its sign between */
    const double turn = e[0] > 0.0 ? 1.0 : -1.0;
    if (symrot_clenshaw(d, SYMROT_POINTS, -1.0)*turn >= 0.0) high = -1.0;
    else if (symrot_clenshaw(d, SYMROT_POINTS, 1.0)*turn <= 0.0) low = 1.0;
    else
        while (high - low > 4e-16) {
            const double slope_low = symrot_clenshaw(d, SYMROT_POINTS, low);
            const double slope_high = symrot_clenshaw(d, SYMROT_POINTS, high);
            double x = low - slope_low*(high - low)/(slope_high - slope_low);
            const double middle = 0.5*(low + high), slope_x = symrot_clenshaw(d, SYMROT_POINTS, x)*turn;
            if (x > low && x < high) {
                if (slope_x < 0.0) low = x;
                else high = x;
            }
            if (middle > low && middle < high) {
                if (symrot_clenshaw(d, SYMROT_POINTS, middle)*turn < 0.0) low = middle;
                else high = middle;
            }
            if (!(0.5*(low + high) > low && 0.5*(low + high) < high)) break;
        }
    const double x = high == -1.0 ? -1.0 : low == 1.0 ? 1.0 : 0.5*(low + high), t = 0.5*(a + b) + 0.5*(b - a)*x;
    if (x == -1.0 || x == 1.0) {
        symrot_at_most_one(search, event, a, f[0], n0, b, f[SYMROT_DEGREE], n1);
        return 1;
    }
    const double value = symrot_value(search, event, t, &own);
    const double off = missing*squared/fabs(e[0]);  /* how far the extremum may lie from x: that changes its value */
    const int sign = symrot_sign(value, own + fabs(e[0])*off*off);
    if (sign == 0) symrot_add(search, event, t, t, (int)turn, (int)turn);
    else {
        symrot_at_most_one(search, event, a, f[0], n0, t, value, 0.0);
        symrot_at_most_one(search, event, t, value, 0.0, b, f[SYMROT_DEGREE], n1);
    }
    return 1;
}

/* Tell the caller the numbers of states and of events. */
SYMROT_EXPORT void symrot_events_sizes(int64_t sizes[2])
{
    sizes[0] = SYMROT_STATES;
    sizes[1] = SYMROT_EVENTS;
}

/* Return the sign of an event at a time, 0 within its rounding errors. */
SYMROT_EXPORT int symrot_events_sign(int event, double t, symrot_dense dense, const double *record, int64_t steps,
    const double *p)
{
    double y[SYMROT_STATES], noise;
    dense(record, steps, &t, 1, y);
    const double value = symrot_event(event, t, y, p, &noise);
    return symrot_sign(value, noise);
}

/*
 * Find the zeros of all events along a motion.
 *
 * in    edges      pieces + 1 times, in the order of the motion, rising or falling
 * in    dense      gives the states at times inside record, as symrot_taylor_dense does
 * out   found      room rows: event, from, to, sign before, sign after, as the motion goes; from = to but where the
 *                  event keeps within its rounding errors of zero; a sign is 0 where the zero lies on an edge
 *
 * Returns the number of rows, which may be more than there was room for: then call again with that room.
 */
SYMROT_EXPORT int64_t symrot_events(const double *edges, int64_t pieces, symrot_dense dense, const double *record,
    int64_t steps, const double *p, double *found, int64_t room)
{
    symrot_search search;
    double from[SYMROT_DEPTH], to[SYMROT_DEPTH];
    search.dense = dense;
    search.record = record;
    search.steps = steps;
    search.p = p;
    search.found = found;
    search.count = 0;
    search.room = room;
    for (int i = 0; i < 2*SYMROT_DEGREE; ++i) search.cosine[i] = cos(i*(3.14159265358979323846/SYMROT_DEGREE));
    for (int event = 0; event < SYMROT_EVENTS; ++event) {
        int before = 0;
        for (int64_t piece = 0; piece < pieces; ++piece) {
            int depth = 1;
            from[0] = edges[piece];
            to[0] = edges[piece + 1];
            const int here = symrot_events_sign(event, nextafter(from[0], to[0]), dense, record, steps, p);
            if (before*here < 0) symrot_add(&search, event, from[0], from[0], before, here);  /* between two pieces */
            before = symrot_events_sign(event, to[0], dense, record, steps, p);
            while (depth > 0) {
                const double a = from[--depth], b = to[depth], middle = a + 0.4871*(b - a);  /* seldom a zero itself */
                const int smallest = depth + 2 > SYMROT_DEPTH || fabs(b - a) <= 64.0*DBL_EPSILON*fmax(fabs(a), fabs(b));
                if (a == b || symrot_settle(&search, event, a, b, smallest)) continue;
                from[depth] = middle;
                to[depth++] = b;
                from[depth] = a;
                to[depth++] = middle;
            }
        }
    }
    return search.count;
}

#ifdef __cplusplus
}
#endif

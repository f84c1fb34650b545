/*
 * All zeros of functions along a motion given as polynomials in time, each located to the last bits.
 *
 * Included after library.h, event_enclosures.h and the emitted functions symrot_event, symrot_event_range and
 * symrot_event_disc, see symrot.codegen.printing.event_source. The motion comes in rows, one polynomial per state each,
 * in the layout of the steps of taylor.c:
 *     t, h, low part of t, unit, then coefficient 0 of all states, coefficient 1, ...; powers of (time - t)/unit
 *
 * No zero is missed between samples: the search uses enclosures (bounds) of the function on whole intervals.
 *
 * An interval whose enclosure does not contain zero has no zero. On other intervals the function is sampled at
 * Chebyshev points, which gives it and its derivatives as Chebyshev series. The error of the series is bounded by an
 * enclosure on a disc around the interval, with Cauchy's estimate on the largest ellipse inside. If the constant term
 * exceeds the sum of all others
 *     of the series,               there is no zero;
 *     of the first derivative,     there is at most one: the signs at the ends decide;
 *     of the second derivative,    there is one extremum, which is located: it separates two zeros or touches zero.
 * Otherwise the interval is halved. A value is compared only with the bound of its own rounding errors, and at an
 * extremum also with its change over the rounding of the time: no tolerance decides what a touch is. The ends around a
 * zero approach each other until no double lies between them.
 *
 * A change of sign is a zero if the function is continuous there, or decreases in size towards it from both sides: poles
 * and jumps past zero are not zeros. If SYMROT_JUMPS is 1, every change of sign counts.
 *
 * C99 that is also valid C++; no malloc, no globals, no input or output, reentrant.
 *
 * Source: L. N. Trefethen, Approximation Theory and Approximation Practice, extended ed., chapters 3, 8, 18 and 21;
 * T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149.
 */
#ifdef __cplusplus
extern "C" {
#endif

enum { SYMROT_POINTS = 21, SYMROT_DEGREE = SYMROT_POINTS - 1, SYMROT_DEPTH = 128, SYMROT_FOUND = 6, SYMROT_DISCS = 2 };
static const double SYMROT_TOUCHING = 4.0;  /* rounding errors: a nearer extremum touches zero */
enum { SYMROT_TOUCHES = 129 };  /* samples of an interval of 64 units in the last place: all numbers in it */

static const double SYMROT_DISC_SIZE[SYMROT_DISCS] = {4.0, 2.0};  /* radii of discs, in halves of the interval */
static const double SYMROT_LEBESGUE = 3.0;  /* factor by which errors of samples grow in the polynomial */
static const double SYMROT_SERIES = 16.0;   /* rounding errors of the series itself: the samples of t have none */

typedef struct {
    const double *rows, *edges, *p;  /* edges: pieces + 1 times, in the order of the motion */
    int64_t pieces, terms;           /* terms: of each polynomial */
    double *found;                   /* rows of SYMROT_FOUND numbers: event, from, to, sign before, sign after, doubt */
    int64_t count, room;
    int64_t piece, event, depth;     /* position of the search */
    double work, most;               /* operations so far, and limit of one call */
    double doubt;                    /* error of the motion, in rounding errors of its states */
    const double *row;               /* of this piece */
    double cosine[2*SYMROT_DEGREE];  /* of multiples of pi/SYMROT_DEGREE */
    double missing[SYMROT_DISCS][3]; /* errors of the series and two derivatives, per bound on a disc */
    double from[SYMROT_DEPTH + 2], to[SYMROT_DEPTH + 2];
    int before[SYMROT_EVENTS + 1];   /* signs at the end of the previous piece */
    double earlier[SYMROT_EVENTS + 1]; /* values shortly before it, 0 at the start */
} symrot_search;

static void symrot_states(const symrot_search *search, int event, double t, double *y)
{
    const double *row = search->row, *x = row + 4, s = ((t - row[0]) - row[2])/row[3];
    const int first = symrot_spans[event][0], end = symrot_spans[event][1];
    for (int i = first; i < end; ++i) y[i] = x[(search->terms - 1)*SYMROT_STATES + i];
    for (int64_t n = search->terms - 2; n >= 0; --n)
        for (int i = first; i < end; ++i) y[i] = y[i]*s + x[n*SYMROT_STATES + i];
}

/* Compute the states at a time, and their largest change at real or complex times within a distance h of it. */
static void symrot_path(const symrot_search *search, int event, double t, double h, double *y, double *r)
{
    const double *row = search->row, *x = row + 4, s = ((t - row[0]) - row[2])/row[3];
    const double step = fabs(h/row[3])*(1.0 + 1e-13), far = fabs(s) + step;
    const int first = symrot_spans[event][0], end = symrot_spans[event][1];
    for (int i = first; i < end; ++i) {
        y[i] = x[(search->terms - 1)*SYMROT_STATES + i];
        r[i] = (double)(search->terms - 1)*fabs(y[i]);
    }
    for (int64_t n = search->terms - 2; n > 0; --n)
        for (int i = first; i < end; ++i) {
            const double term = x[n*SYMROT_STATES + i];
            y[i] = y[i]*s + term;
            r[i] = r[i]*far + (double)n*fabs(term);
        }
    for (int i = first; i < end; ++i) {
        if (search->terms > 1) y[i] = y[i]*s + x[i];
        r[i] *= step*(1.0 + 1e-13);
    }
}

static double symrot_value(const symrot_search *search, int event, double t, double *noise)
{
    double y[SYMROT_STATES] = {0.0};
    symrot_states(search, event, t, y);
    return symrot_event(event, t, y, search->p, noise);
}

static symrot_range symrot_range_near(const symrot_search *search, int event, double t, double h)
{
    double y[SYMROT_STATES] = {0.0}, r[SYMROT_STATES] = {0.0};
    symrot_path(search, event, t, h, y, r);
    return symrot_event_range(event, t, h, y, r, search->p);
}

static int symrot_jumps_near(const symrot_search *search, int event, double t, double h)
{
    double y[SYMROT_STATES] = {0.0}, r[SYMROT_STATES] = {0.0};
    symrot_path(search, event, t, h, y, r);
    return symrot_event_jumps(event, t, h, y, r, search->p);
}

static int symrot_sign(double value, double noise) { return value > noise ? 1 : value < -noise ? -1 : 0; }

static int symrot_bounded(symrot_range x) { return x.lo >= -DBL_MAX && x.hi <= DBL_MAX; }

/* Add some evaluations of an event to the count of operations. */
static void symrot_spend(symrot_search *search, int evaluations)
{
    const int *span = symrot_spans[search->event];
    search->work += evaluations*(double)(SYMROT_COST + 2*search->terms*(span[1] - span[0]));
}

static void symrot_append(symrot_search *search, int event, double from, double to, int before, int after, int doubt)
{
    if (search->count < search->room) {
        double *row = search->found + search->count*SYMROT_FOUND;
        row[0] = event;
        row[1] = from;
        row[2] = to;
        row[3] = before;
        row[4] = after;
        row[5] = doubt;
    }
    ++search->count;
}

static void symrot_add(symrot_search *search, int event, double from, double to, int before, int after)
{
    symrot_append(search, event, from, to, before, after, 0);
}

/* Report an extremum, not zero, that the error of the motion may have moved past zero. */
static void symrot_add_doubt(symrot_search *search, int event, double t, double value, double noise)
{
    const int *span = symrot_spans[event], sign = value > 0.0 ? 1 : -1;
    if (span[1] > span[0] && fabs(value) <= search->doubt*noise) symrot_append(search, event, t, t, sign, sign, 1);
}

/* Locate a change of sign between a and b, to neighbouring doubles; return the end with the smaller value. */
static double symrot_close_in(const symrot_search *search, int event, double a, double fa, double b, double fb)
{
    double c = a, fc = fa, share = 0.5, noise;  /* a is the latest end, b the other side, c the previous end */
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

/* Compute d, the series of the derivative of c; in both the constant term is already halved. */
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

/* Return a bound of the sum of all terms but the constant one. */
static double symrot_rest(const double *c)
{
    double rest = 0.0;
    for (int k = 1; k <= SYMROT_DEGREE; ++k) rest += fabs(c[k]);
    return rest;
}

/*
 * Return whether a function that may have a pole or a jump decreases in size towards an interval from both sides: it is
 * much smaller at the ends than farther away. At a pole it increases, at a jump it does not change.
 */
static int symrot_falls(const symrot_search *search, int event, double a, double fa, double b, double fb)
{
    double noise;
    const double far = 1024.0*(b - a);
    const double before = symrot_value(search, event, a - far, &noise), after = symrot_value(search, event, b + far, &noise);
    return fabs(fa) <= 0.5*fabs(before) && fabs(fb) <= 0.5*fabs(after);
}

/*
 * Return whether a value, the smallest around a time, is zero within rounding. The time of a touch is seldom a double, so
 * that the value may change by as much as the formula does within the rounding of the time. Of the changes on both sides
 * the smaller one counts: the larger one may be a jump.
 */
static int symrot_touches(symrot_search *search, int event, double t, double value, double noise)
{
    double own;
    const double unit = SYMROT_TOUCHING*DBL_EPSILON*(fabs(t) + fabs(search->row[0]));
    const double before = fabs(symrot_value(search, event, t - unit, &own) - value);
    const double after = fabs(symrot_value(search, event, t + unit, &own) - value);
    symrot_spend(search, 2);
    const double change = before <= DBL_MAX && after <= DBL_MAX ? fmin(before, after) : 0.0;
    return fabs(value) <= SYMROT_TOUCHING*noise + change;
}

/* Find the zeros in an interval too short to be halved. */
static void symrot_shortest(symrot_search *search, int event, double a, double b, symrot_range all)
{
    double na, nb, least = INFINITY, place = a, lowest = 0.0, noise = 0.0, own;
    const double fa = symrot_value(search, event, a, &na), fb = symrot_value(search, event, b, &nb);
    const int from = symrot_sign(fa, na), to = symrot_sign(fb, nb);
    symrot_spend(search, 2);
    if (SYMROT_JUMPS) {  /* infinite values and values with infinite errors, next to a pole, have their own signs */
        const int left = na <= DBL_MAX ? from : symrot_sign(fa, 0.0), right = nb <= DBL_MAX ? to : symrot_sign(fb, 0.0);
        if (left*right < 0) {
            const double t = symrot_close_in(search, event, a, fa, b, fb);
            symrot_add(search, event, t, t, left, right);
            return;
        }
    }
    if (!(fabs(fa) <= DBL_MAX && fabs(fb) <= DBL_MAX)) return;  /* no value at an end */
    if ((fa != 0.0 && !(na <= DBL_MAX)) || (fb != 0.0 && !(nb <= DBL_MAX))) return;  /* or infinite rounding errors */
    if (from == 0 && to == 0) {
        symrot_add(search, event, a, b, 0, 0);
        return;
    }
    const double half = 0.5*fabs(b - a)*(1.0 + 1e-13) + DBL_EPSILON*fabs(a);
    const int jump = from*to < 0 && symrot_jumps_near(search, event, a + 0.5*(b - a), half);
    if ((jump || !symrot_bounded(all)) && !symrot_falls(search, event, a, fa, b, fb)) return;
    if (from*to <= 0) {
        symrot_at_most_one(search, event, a, fa, na, b, fb, nb);
        return;
    }
    symrot_spend(search, SYMROT_TOUCHES);
    for (int i = 0; i < SYMROT_TOUCHES; ++i) {  /* a kink that touches zero */
        const double t = a + (b - a)*((double)i/(SYMROT_TOUCHES - 1)), value = symrot_value(search, event, t, &own);
        const double above = value == 0.0 ? 0.0 : fabs(value) - SYMROT_TOUCHING*own;
        if (above < least) {
            least = above;
            place = t;
            lowest = value;
            noise = own;
        }
    }
    if (least <= 0.0 || symrot_touches(search, event, place, lowest, noise))
        symrot_add(search, event, place, place, 0, 0);  /* or a rounded zero next to the interval */
    else if (fabs(symrot_value(search, event, place - (b - a), &own)) >= fabs(lowest)
        && fabs(symrot_value(search, event, place + (b - a), &own)) >= fabs(lowest))
        symrot_add_doubt(search, event, place, lowest, noise);  /* smallest beyond this interval, too */
}

/* Return the time of an extremum within a distance of t, by parabolas through closer and closer values. */
static double symrot_extremum(symrot_search *search, int event, double t, double distance)
{
    double noise;
    symrot_spend(search, 24);
    for (int tries = 0; tries < 8 && t + distance != t && t - distance != t; ++tries, distance *= 0.125) {
        const double low = symrot_value(search, event, t - distance, &noise);
        const double high = symrot_value(search, event, t + distance, &noise);
        const double bend = low - 2.0*symrot_value(search, event, t, &noise) + high;
        const double move = 0.5*distance*(low - high)/bend;
        if (fabs(move) <= distance) t += move;
    }
    return t;
}

/* Find the zeros in one interval, or return 0 if it must be halved. */
static int symrot_settle(symrot_search *search, int event, double a, double b, int smallest)
{
    double times[SYMROT_POINTS], y[SYMROT_STATES] = {0.0}, r[SYMROT_STATES] = {0.0}, f[SYMROT_POINTS];
    double c[SYMROT_POINTS], d[SYMROT_POINTS], e[SYMROT_POINTS], noise = 0.0, largest = 0.0, n0 = 0.0, n1 = 0.0, own;
    const double centre = a + 0.5*(b - a), half = 0.5*fabs(b - a)*(1.0 + 1e-13) + DBL_EPSILON*fabs(centre);
    symrot_path(search, event, centre, half, y, r);
    const symrot_range all = symrot_event_range(event, centre, half, y, r, search->p);
    symrot_spend(search, 3);
    if (symrot_empty(all) || all.lo > 0.0 || all.hi < 0.0) return 1;
    const double middle = fabs(symrot_event(event, centre, y, search->p, &own));
    if (middle <= own && own <= DBL_MAX && all.hi - all.lo <= 16.0*own + DBL_MIN) {
        symrot_add(search, event, a, b, 0, 0);
        return 1;
    }
    if (smallest) {
        symrot_shortest(search, event, a, b, all);
        return 1;
    }
    if (SYMROT_JUMPS && !symrot_bounded(all) && !(middle > own)) {  /* so near a pole that no sign is known */
        symrot_spend(search, 2);
        const double left = fabs(symrot_value(search, event, a, &n0)), right = fabs(symrot_value(search, event, b, &n1));
        if (!(left > n0) && !(right > n1)) {
            symrot_add(search, event, a, b, 0, 0);
            return 1;
        }
    }
    double bound = INFINITY;
    int disc = -1;
    while (!(bound <= DBL_MAX) && ++disc < SYMROT_DISCS) {
        const double size = half*SYMROT_DISC_SIZE[disc];
        symrot_path(search, event, centre, size, y, r);
        bound = symrot_event_disc(event, centre, size, y, r, search->p).r;
        symrot_spend(search, 3);
    }
    if (disc == SYMROT_DISCS) return 0;
    const double *missing = search->missing[disc];
    if (bound*missing[0] > all.hi - all.lo) return 0;  /* samples would decide nothing */
    symrot_spend(search, SYMROT_POINTS);
    for (int i = 0; i < SYMROT_POINTS; ++i) {
        times[i] = i == 0 ? a : i == SYMROT_DEGREE ? b : 0.5*(a + b) - 0.5*(b - a)*search->cosine[i];
        f[i] = symrot_value(search, event, times[i], &own);
        if (!(fabs(f[i]) <= DBL_MAX)) return 0;
        if (i == 0) n0 = own;
        if (i == SYMROT_DEGREE) n1 = own;
        noise = fmax(noise, own);
        largest = fmax(largest, fabs(f[i]));
    }
    for (int k = 0; k <= SYMROT_DEGREE; ++k) {  /* x = -cos(i pi/n) increases with i */
        double sum = 0.5*(f[SYMROT_DEGREE] + (k%2 ? -f[0] : f[0]));
        for (int i = 1; i < SYMROT_DEGREE; ++i)
            sum += f[SYMROT_DEGREE - i]*search->cosine[i*k%(2*SYMROT_DEGREE)];
        c[k] = sum*(2.0/SYMROT_DEGREE);
    }
    c[0] *= 0.5;
    c[SYMROT_DEGREE] *= 0.5;
    /* Markov: derivatives of the rounding errors in the polynomial */
    const double squared = (double)SYMROT_DEGREE*SYMROT_DEGREE;
    const double rounding = SYMROT_LEBESGUE*noise + SYMROT_SERIES*DBL_EPSILON*largest;
    const double miss0 = bound*missing[0] + rounding, miss1 = bound*missing[1] + rounding*squared;
    const double miss2 = bound*missing[2] + rounding*squared*(squared - 1.0)*(1.0/3.0);
    const double rest0 = symrot_rest(c) + miss0;
    if (fabs(c[0]) > rest0) return 1;
    if (fabs(c[0]) + rest0 <= 8.0*noise) {
        symrot_add(search, event, a, b, 0, 0);
        return 1;
    }
    symrot_derivative(c, d);
    if (fabs(d[0]) > symrot_rest(d) + miss1) {
        symrot_at_most_one(search, event, a, f[0], n0, b, f[SYMROT_DEGREE], n1);
        return 1;
    }
    symrot_derivative(d, e);
    const double rest2 = symrot_rest(e) + miss2;
    if (!(fabs(e[0]) > rest2)) return 0;
    double low = -1.0, high = 1.0;  /* the slope, which is monotonic, changes its sign between */
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
    const double x = high == -1.0 ? -1.0 : low == 1.0 ? 1.0 : 0.5*(low + high);
    const double off = miss1/(fabs(e[0]) - rest2);  /* largest distance of the extremum from x: changes its value */
    const double slack = (fabs(e[0]) + rest2)*off*off;
    if (1.0 - fabs(x) <= off) {  /* at or beyond an end */
        if (slack > noise) return 0;
        const double end = x < 0.0 ? a : b, place = symrot_extremum(search, event, end, 0.5*fabs(b - a)*off);
        const double extreme = symrot_value(search, event, place, &own);
        if (extreme*turn >= 0.0 && symrot_touches(search, event, place, extreme, own)) {
            symrot_add(search, event, end, end, (int)turn, (int)turn);
            return 1;
        }
        symrot_add_doubt(search, event, end, extreme, own);
        symrot_at_most_one(search, event, a, f[0], n0, b, f[SYMROT_DEGREE], n1);
        return 1;
    }
    double t = 0.5*(a + b) + 0.5*(b - a)*x, value = symrot_value(search, event, t, &own);
    int sign = symrot_sign(value, own + slack);
    if (sign == 0 && slack > own) {  /* values may resolve an extremum that rounding hides in the series */
        if (slack > noise) return 0;
        t = symrot_extremum(search, event, t, fmin(0.5*fabs(b - a)*off, fmin(fabs(t - a), fabs(b - t))));
        value = symrot_value(search, event, t, &own);
        sign = symrot_sign(value, SYMROT_TOUCHING*own);
    }
    if (sign == 0 || (sign*turn > 0.0 && symrot_touches(search, event, t, value, own)))
        symrot_add(search, event, t, t, (int)turn, (int)turn);
    else {
        symrot_add_doubt(search, event, t, value, own);
        symrot_at_most_one(search, event, a, f[0], n0, t, value, 0.0);
        symrot_at_most_one(search, event, t, value, 0.0, b, f[SYMROT_DEGREE], n1);
    }
    return 1;
}

/* Start a piece for one event: set its interval, and report a change of sign since the previous piece. */
static void symrot_enter(symrot_search *search)
{
    const int event = (int)search->event;
    const double from = search->edges[search->piece], to = search->edges[search->piece + 1], after = nextafter(from, to);
    double noise, own_noise;
    search->row = search->rows + search->piece*(4 + search->terms*SYMROT_STATES);
    const double value = symrot_value(search, event, after, &noise);
    const int here = symrot_sign(value, noise);
    if (search->before[event]*here < 0) {
        const double near = 64.0*DBL_EPSILON*fabs(from);
        const int smooth = symrot_bounded(symrot_range_near(search, event, from, near))
            && !symrot_jumps_near(search, event, from, near);
        if (SYMROT_JUMPS || smooth)
            symrot_add(search, event, from, from, search->before[event], here);
    }
    /* a kink where two pieces meet that the error of the motion may have moved past zero */
    const double part = 1e-3*(to - from), own = symrot_value(search, event, from, &noise);
    const double earlier = search->earlier[event], later = symrot_value(search, event, from + part, &own_noise);
    if (earlier*later > 0.0 && own*earlier < fmin(earlier*earlier, later*earlier))
        symrot_add_doubt(search, event, from, own, fmax(noise, own_noise));
    search->earlier[event] = symrot_value(search, event, to - part, &own_noise);
    const double last = symrot_value(search, event, to, &noise);
    search->before[event] = symrot_sign(last, noise);
    search->from[0] = from;
    search->to[0] = to;
    search->depth = 1;
    symrot_spend(search, 7);
}

/* Return the numbers of states and of events, and the bytes of a search. */
SYMROT_EXPORT void symrot_events_sizes(int64_t sizes[3])
{
    sizes[0] = SYMROT_STATES;
    sizes[1] = SYMROT_EVENTS;
    sizes[2] = (int64_t)sizeof(symrot_search);
}

/* Return the sign of an event at a time inside a row; 0 if the value is within its rounding error, 2 if it has none. */
SYMROT_EXPORT int symrot_events_sign(int event, double t, const double *row, int64_t terms, const double *p)
{
    symrot_search search;
    double noise;
    search.row = row;
    search.terms = terms;
    search.p = p;
    const double value = symrot_value(&search, event, t, &noise);
    return value == value ? symrot_sign(value, noise) : 2;
}

/*
 * Start a search along `pieces` rows; `again` if it continues from the previous rows.
 *
 * in    rows, terms   polynomials, see above
 * in    edges         pieces + 1 times, in the order of the motion, forward or backward: row i is valid from edge i to i + 1
 * in    doubt         error of the motion, in multiples of the rounding errors of its states; 0 for no doubts
 */
SYMROT_EXPORT void symrot_events_begin(symrot_search *search, const double *rows, int64_t terms, const double *edges,
    int64_t pieces, const double *p, double doubt, int again)
{
    search->rows = rows;
    search->terms = terms;
    search->edges = edges;
    search->pieces = pieces;
    search->p = p;
    search->doubt = doubt;
    search->piece = search->event = search->depth = 0;
    if (again) return;
    for (int event = 0; event <= SYMROT_EVENTS; ++event) search->before[event] = 0, search->earlier[event] = 0.0;
    for (int i = 0; i < 2*SYMROT_DEGREE; ++i) search->cosine[i] = cos(i*(3.14159265358979323846/SYMROT_DEGREE));
    for (int disc = 0; disc < SYMROT_DISCS; ++disc) {
        /* coefficient k is below 2/rho^k on the ellipse with semi-axis SIZE; it is missing, and aliased to another */
        const double size = SYMROT_DISC_SIZE[disc], rho = size + sqrt(size*size - 1.0);
        double *missing = search->missing[disc], power = 4.0*pow(rho, -SYMROT_POINTS);
        missing[0] = missing[1] = missing[2] = 0.0;
        for (double k = SYMROT_POINTS; k < 200.0; ++k, power /= rho) {
            missing[0] += power*1.01;
            missing[1] += power*k*k*1.01;
            missing[2] += power*k*k*(k*k - 1.0)*(1.01/3.0);
        }
    }
}

/*
 * Continue a search until all rows are searched, `found` is full, or about `most` operations are used.
 *
 * out   found      `room` rows: event, from, to, sign before, sign after, doubt, in the order of the motion; from = to
 *                  unless the event stays within its rounding errors of zero; a sign is 0 if the zero lies on an edge;
 *                  doubt is 1 for an extremum that is not zero, but nearer to it than the error of the motion
 * out   state[3]   rows written; whether the search is complete; the number of the present piece
 *
 * Returns the number of operations. There must be room for at least 4 rows.
 */
SYMROT_EXPORT double symrot_events_next(symrot_search *search, double *found, int64_t room, double most,
    int64_t state[3])
{
    search->found = found;
    search->room = room;
    search->count = 0;
    search->work = 0.0;
    while (search->piece < search->pieces && search->work < most && search->count + 4 <= room) {
        if (search->event >= SYMROT_EVENTS) {
            search->event = 0;
            ++search->piece;
            continue;
        }
        const int event = (int)search->event;
        if (search->depth == 0) symrot_enter(search);
        while (search->depth > 0 && search->work < most && search->count + 4 <= room) {
            const int depth = (int)--search->depth;
            const double a = search->from[depth], b = search->to[depth];
            const double middle = a + 0.4871*(b - a);  /* rarely itself a zero */
            const int smallest = depth + 3 > SYMROT_DEPTH
                || fabs(b - a) <= 64.0*DBL_EPSILON*fmax(fabs(a), fabs(b));
            if (a == b || symrot_settle(search, event, a, b, smallest)) continue;
            search->from[depth] = middle;
            search->to[depth] = b;
            search->from[depth + 1] = a;
            search->to[depth + 1] = middle;
            search->depth = depth + 2;
        }
        if (search->depth == 0) ++search->event;
    }
    state[0] = search->count;
    state[1] = search->piece >= search->pieces;
    state[2] = search->piece;
    return search->work;
}

#ifdef __cplusplus
}
#endif

/*
 * Projection of the states onto the conserved quantities: included by taylor.c when the system has invariants.
 *
 * The states are y + carry, with about 32 digits. Every few steps, and at the end of a span, the invariants are
 * computed in pairs of doubles. The smallest change of the states that restores them is added to the carry, and the
 * part of the carry that y can represent is added to y. In a conservative motion, errors that change the invariants
 * grow: the motion then runs ahead or behind at an increasing rate. If they are corrected at once, only their direct
 * part remains.
 *
 * The size of a change is measured in units of the likely error of each block: see symrot_weigh. In units of the size
 * of the block, a body in nearly steady rotation, whose rates hardly change, would receive wrong rates that compensate
 * for the rounding of its attitude.
 *
 * The projection cannot do harm: nothing is changed if the change would exceed SYMROT_FAR of the size of a state (then
 * the states are no longer accurate), or if it would increase the residual. After such a refusal the projection is
 * tried half as often. If the gradient of an invariant depends on the gradients of others to SYMROT_INDEPENDENT, as for
 * energy and momentum in steady rotation, this invariant is ignored, because the rest of its gradient is rounding
 * error.
 *
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., section IV.4 (projection).
 */

static const double SYMROT_FAR = 0.1;
static const double SYMROT_LOOSE = 1e-11;
static const double SYMROT_UNIT_NORM = 1e-12;  /* a norm this close to 1 is taken as 1 */
static const double SYMROT_INDEPENDENT = 1e-12;  /* least squared sine of the angle to earlier gradients */
static const double SYMROT_LEAST_SHARE = 1e-3;  /* of the fastest block's likely errors: sums of cancelling terms */

/*
 * Write the size of each state, which is the size of its block, and a weight: its likely error relative to other
 * states. Rounding and the tail of the series are parts of the change in a step, so that a block that hardly moves has
 * a small error.
 */
static inline void symrot_weigh(symrot_v4 (*x)[SYMROT_ORDER + 1], double *size, double *weight)
{
    double fastest = 0.0, sizes[SYMROT_BLOCK_COUNT], rates[SYMROT_BLOCK_COUNT];
    EACH_BLOCK(b) {
        sizes[b] = symrot_scales[b] > 0.0 ? symrot_scales[b] : symrot_size(x, 0, b);
        rates[b] = symrot_larger(symrot_size(x, 1, b), symrot_size(x, 2, b));
        if (sizes[b] > 0.0) fastest = symrot_larger(fastest, rates[b]/sizes[b]);
    }
    EACH_ROW(r) {
        const int b = symrot_blocks[r];
        const double share = fastest > 0.0 && sizes[b] > 0.0 ? rates[b]/sizes[b]/fastest : 1.0;
        for (int i = 0; i < symrot_sizes[r]; ++i) {
            size[symrot_starts[r] + i] = sizes[b];
            weight[symrot_starts[r] + i] = sizes[b]*symrot_larger(share, SYMROT_LEAST_SHARE);
        }
    }
}

/*
 * Replace r by the coefficients c with J J^T c = r for the independent rows of J, which have unit length; 0 for the
 * rest. Cholesky's factors with the largest pivot first.
 */
static void symrot_solve(double (*j)[SYMROT_STATES], double *r)
{
    double a[SYMROT_INVARIANTS][SYMROT_INVARIANTS], c[SYMROT_INVARIANTS];
    int order[SYMROT_INVARIANTS], count = 0, used[SYMROT_INVARIANTS];
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) {
        used[m] = 0;
        for (int n = 0; n <= m; ++n) {
            double sum = 0.0;
            for (int i = 0; i < SYMROT_STATES; ++i) sum += j[m][i]*j[n][i];
            a[m][n] = a[n][m] = sum;
        }
    }
    for (; count < SYMROT_INVARIANTS; ++count) {  /* a becomes the rest of J J^T, with the factors below it */
        int next = -1;
        for (int m = 0; m < SYMROT_INVARIANTS; ++m)
            if (!used[m] && a[m][m] > SYMROT_INDEPENDENT && (next < 0 || a[m][m] > a[next][next])) next = m;
        if (next < 0) break;
        used[next] = 1;
        order[count] = next;
        for (int m = 0; m < SYMROT_INVARIANTS; ++m) {
            if (used[m]) continue;
            const double factor = a[m][next]/a[next][next];
            for (int n = 0; n < SYMROT_INVARIANTS; ++n) if (!used[n]) a[m][n] -= factor*a[next][n];
            r[m] -= factor*r[next];
        }
    }
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) c[m] = 0.0;
    for (int k = count - 1; k >= 0; --k) {
        double sum = r[order[k]];
        for (int l = k + 1; l < count; ++l) sum -= a[order[k]][order[l]]*c[order[l]];
        c[order[k]] = sum/a[order[k]][order[k]];
    }
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) r[m] = c[m];
}

/* Return the residuals in units of the gradients, which become rows of unit length, and the sum of their squares. */
static double symrot_residuals(const symrot_run *run, const double *p, dd t, const double *y,
    const double *carry, const double *size, double (*j)[SYMROT_STATES], double *r)
{
    dd state[SYMROT_STATES], value[SYMROT_INVARIANTS];
    double total = 0.0;
    for (int i = 0; i < SYMROT_STATES; ++i) state[i] = two_sum(y[i], carry[i]);
    symrot_invariants(t, state, p, value, j);
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) {
        double length = 0.0;
        for (int i = 0; i < SYMROT_STATES; ++i) {
            j[m][i] *= size[i];
            length += j[m][i]*j[m][i];
        }
        length = sqrt(length);
        const double inverse = length > 0.0 ? 1.0/length : 0.0;
        for (int i = 0; i < SYMROT_STATES; ++i) j[m][i] *= inverse;
        const dd kept = dd_pair(run->kept[2*m], run->kept[2*m + 1]);
        r[m] = symrot_pair_subtract(kept, value[m]).hi*inverse;
        total += r[m]*r[m];
    }
    return total;
}

/*
 * Store the values of the invariants at the first state; the norm of a unit quaternion is set to 1 in the carry too. If
 * that norm is the only invariant, a motion with a large tolerance is not projected: the length of the quaternion does
 * not count as error.
 */
static SYMROT_APART void symrot_remember(symrot_run *run, const double *p)
{
    dd state[SYMROT_STATES], value[SYMROT_INVARIANTS];
    double gradient[SYMROT_INVARIANTS][SYMROT_STATES];
    if (SYMROT_INVARIANTS == 1 && SYMROT_QUATERNION >= 0 && run->tail > SYMROT_LOOSE) run->every = 0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = 0; i < SYMROT_STATES; ++i) state[i] = two_sum(run->y[i], run->carry[i]);
        symrot_invariants(dd_pair(run->t, run->t_low), state, p, value, gradient);
        if (SYMROT_QUATERNION >= 0 && pass == 0) {
            const double excess = symrot_pair_subtract(value[SYMROT_INVARIANTS - 1], dd_pair(1.0, 0.0)).hi;
            if (fabs(excess) < SYMROT_UNIT_NORM)
                for (int i = SYMROT_QUATERNION; i < SYMROT_QUATERNION + 4; ++i)
                    run->carry[i] -= 0.5*excess*(run->y[i] + run->carry[i]);
        }
    }
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) {
        run->kept[2*m] = value[m].hi;
        run->kept[2*m + 1] = value[m].lo;
    }
}

/* Restore the invariants by a change of the carry; return whether it was applied. */
static SYMROT_APART int symrot_project(const symrot_run *run, const double *p, dd t, const double *y,
    double *carry, const double *size, const double *weight)
{
    double j[SYMROT_INVARIANTS][SYMROT_STATES], r[SYMROT_INVARIANTS], better[SYMROT_STATES];
    const double before = symrot_residuals(run, p, t, y, carry, weight, j, r);
    symrot_solve(j, r);
    for (int i = 0; i < SYMROT_STATES; ++i) {
        double change = 0.0;
        for (int m = 0; m < SYMROT_INVARIANTS; ++m) change += r[m]*j[m][i];
        if (!(fabs(change)*weight[i] <= SYMROT_FAR*size[i])) return 0;
        better[i] = carry[i] + change*weight[i];
    }
    if (!(symrot_residuals(run, p, t, y, better, weight, j, r) <= before)) return 0;
    memcpy(carry, better, sizeof better);
    return 1;
}

/* Project after a step, with states and carry in rows; less often after each refusal. */
static SYMROT_APART void symrot_keep(symrot_run *run, const double *p, double t, double t_low,
    symrot_v4 (*x)[SYMROT_ORDER + 1], symrot_v4 *carry)
{
    double y[SYMROT_STATES], low[SYMROT_STATES], size[SYMROT_STATES], weight[SYMROT_STATES];
    symrot_weigh(x, size, weight);
    EACH_ROW(r) {
        memcpy(y + symrot_starts[r], &x[r][0], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(low + symrot_starts[r], &carry[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
    run->since = 0;
    if (symrot_project(run, p, dd_pair(t, t_low), y, low, size, weight)) ++run->projected;
    else run->every *= 2;
    for (int i = 0; i < SYMROT_STATES; ++i) {  /* the series uses y alone: keep the carry as small as possible */
        const dd sum = two_sum(y[i], low[i]);
        y[i] = sum.hi;
        low[i] = sum.lo;
    }
    EACH_ROW(r) {
        memcpy(&x[r][0], y + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(&carry[r], low + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
}

/*
 * Projection of the carry onto what a motion keeps: included by taylor.c when the system has invariants.
 *
 * The states are known as y + carry, to about 32 digits. Every few steps, and at the end of a span, the invariants
 * are computed there in pairs of doubles, and the smallest change of the states that restores them goes into the
 * carry, which hands on to y what y can hold. Of the errors of a conservative motion those that leave its invariants
 * are the ones that grow: it then runs ahead or behind ever faster. Given back at once, tail or rounding, they leave
 * only their direct part.
 *
 * The smallest change is measured in units of what each block is likely to be off by: see symrot_weigh. In units of
 * its size a body about to rotate steadily, whose rates hardly change, would be given rates that make up for the
 * rounding of its attitude, and follow them.
 *
 * It can only help: nothing is changed where the change would be longer than SYMROT_FAR of a state's size (nothing is
 * known of the motion any more), or where it leaves a larger residual than it found; after a refusal it is tried half
 * as often. An invariant whose gradient depends on those of the others to SYMROT_INDEPENDENT, as those of energy and
 * momentum do in steady rotation, is left alone there: what is left of its gradient is rounding.
 *
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., section IV.4 (projection).
 */

static const double SYMROT_FAR = 0.1;
static const double SYMROT_LOOSE = 1e-11;
static const double SYMROT_UNIT_NORM = 1e-12;  /* a norm within this of one is meant to be one */
static const double SYMROT_INDEPENDENT = 1e-12;  /* least square of the sine between a gradient and those before it */
static const double SYMROT_LEAST_SHARE = 1e-3;  /* of the fastest block's likely errors: sums of cancelling terms */

/*
 * Write what the size of a state is measured with, that of its block, and how far its errors may reach in comparison
 * with those of the others: rounding and the tail take their share of what a step adds, so that a block that hardly
 * moves is hardly wrong.
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
    for (; count < SYMROT_INVARIANTS; ++count) {  /* a becomes the rest of J J^T, and below it the factors */
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
 * Remember what the motion keeps, from its first state; a quaternion of unit norm gets it in the carry too. Where that
 * norm is all, a loose motion is not projected: what its attitude loses in length is no part of its error.
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

/* Give back to the carry what the invariants have lost; return whether it was done. */
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

/* Project after a step, whose states and carry stand in rows; ever more seldom where it was refused. */
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
    for (int i = 0; i < SYMROT_STATES; ++i) {  /* the series sees y alone: leave no more in the carry than it must */
        const dd sum = two_sum(y[i], low[i]);
        y[i] = sum.hi;
        low[i] = sum.lo;
    }
    EACH_ROW(r) {
        memcpy(&x[r][0], y + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(&carry[r], low + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
}

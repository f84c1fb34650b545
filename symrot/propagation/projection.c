/*
 * Projection of the carry onto what a motion keeps: included by taylor.c when the system has invariants.
 *
 * The states are known as y + carry, to about 32 digits. Every few steps the invariants are computed there in pairs of
 * doubles, and the smallest change of the states that restores them, in units of each block, goes into the carry, which
 * hands on to y what y can hold: what rounding and the tail of the series took from the invariants is given back before
 * it is as large as a bit of y.
 *
 * It can only help: nothing is changed where the invariants are off by more than SYMROT_FAR of their size (the tail is
 * then so loose that the motion is no better known), where the change would be longer than that, or where it leaves a
 * larger residual than it found; after a refusal it is tried half as often. An invariant whose gradient nearly depends
 * on those of the others, as energy and momentum do in steady rotation, is left alone there: restoring it would move
 * the states much further than they are off.
 *
 * Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., section IV.4 (projection).
 */

static const double SYMROT_FAR = 1e-12;
static const double SYMROT_INDEPENDENT = 1e-2;  /* least square of the sine between a gradient and those before it */

/* Return what the errors of a state are measured with: that of its block. */
static inline void symrot_units(const double *y, double *size)
{
    EACH_ROW(r) {
        double unit = symrot_scales[symrot_blocks[r]];
        if (unit == 0.0)
            for (int s = 0; s < SYMROT_ROWS; ++s)
                if (symrot_blocks[s] == symrot_blocks[r])
                    for (int i = 0; i < symrot_sizes[s]; ++i) unit = fmax(unit, fabs(y[symrot_starts[s] + i]));
        for (int i = 0; i < symrot_sizes[r]; ++i) size[symrot_starts[r] + i] = unit;
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
static double symrot_residuals(const symrot_run *run, const double *p, symrot_pair t, const double *y,
    const double *carry, const double *size, double (*j)[SYMROT_STATES], double *r)
{
    symrot_pair state[SYMROT_STATES], value[SYMROT_INVARIANTS];
    double total = 0.0;
    for (int i = 0; i < SYMROT_STATES; ++i) state[i] = symrot_pair_sum(y[i], carry[i]);
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
        const symrot_pair kept = symrot_pair_of(run->kept[2*m], run->kept[2*m + 1]);
        r[m] = symrot_pair_subtract(kept, value[m]).high*inverse;
        total += r[m]*r[m];
    }
    return total;
}

/* Remember what the motion keeps, from its first state; a quaternion of unit norm gets it in the carry too. */
static SYMROT_APART void symrot_remember(symrot_run *run, const double *p)
{
    symrot_pair state[SYMROT_STATES], value[SYMROT_INVARIANTS];
    double gradient[SYMROT_INVARIANTS][SYMROT_STATES];
    for (int pass = 0; pass < 2; ++pass) {
        for (int i = 0; i < SYMROT_STATES; ++i) state[i] = symrot_pair_sum(run->y[i], run->carry[i]);
        symrot_invariants(symrot_pair_of(run->t, run->t_low), state, p, value, gradient);
        if (SYMROT_QUATERNION >= 0 && pass == 0) {
            const double excess = symrot_pair_subtract(value[SYMROT_INVARIANTS - 1], symrot_pair_of(1.0, 0.0)).high;
            if (fabs(excess) < SYMROT_FAR)
                for (int i = SYMROT_QUATERNION; i < SYMROT_QUATERNION + 4; ++i)
                    run->carry[i] -= 0.5*excess*(run->y[i] + run->carry[i]);
        }
    }
    for (int m = 0; m < SYMROT_INVARIANTS; ++m) {
        run->kept[2*m] = value[m].high;
        run->kept[2*m + 1] = value[m].low;
    }
}

/* Give back to the carry what the invariants have lost; return whether it was done. */
static SYMROT_APART int symrot_project(const symrot_run *run, const double *p, symrot_pair t, const double *y,
    double *carry)
{
    double j[SYMROT_INVARIANTS][SYMROT_STATES], r[SYMROT_INVARIANTS], better[SYMROT_STATES], size[SYMROT_STATES];
    symrot_units(y, size);
    const double before = symrot_residuals(run, p, t, y, carry, size, j, r);
    if (!(before < SYMROT_FAR*SYMROT_FAR)) return 0;
    symrot_solve(j, r);
    for (int i = 0; i < SYMROT_STATES; ++i) {
        double change = 0.0;
        for (int m = 0; m < SYMROT_INVARIANTS; ++m) change += r[m]*j[m][i];
        if (!(fabs(change) < SYMROT_FAR)) return 0;
        better[i] = carry[i] + change*size[i];
    }
    if (!(symrot_residuals(run, p, t, y, better, size, j, r) <= before)) return 0;
    memcpy(carry, better, sizeof better);
    return 1;
}

/* Project after a step, whose states and carry stand in rows; ever more seldom where it was refused. */
static SYMROT_APART void symrot_keep(symrot_run *run, const double *p, double t, double t_low,
    symrot_v4 (*x)[SYMROT_ORDER + 1], symrot_v4 *carry)
{
    double y[SYMROT_STATES], low[SYMROT_STATES];
    EACH_ROW(r) {
        memcpy(y + symrot_starts[r], &x[r][0], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(low + symrot_starts[r], &carry[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
    run->since = 0;
    if (symrot_project(run, p, symrot_pair_of(t, t_low), y, low)) ++run->projected;
    else run->every *= 2;
    for (int i = 0; i < SYMROT_STATES; ++i) {  /* the series sees y alone: leave no more in the carry than y cannot hold */
        const symrot_pair sum = symrot_pair_sum(y[i], low[i]);
        y[i] = sum.high;
        low[i] = sum.low;
    }
    EACH_ROW(r) {
        memcpy(&x[r][0], y + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
        memcpy(&carry[r], low + symrot_starts[r], (size_t)symrot_sizes[r]*sizeof(double));
    }
}

/*
 * Numbers from which the constants of many free bodies are computed: principal moments and axes, angular velocity along
 * them, and the defect |L|^2 - 2 T I_mid, in which all digits may cancel. Each number is rounded to the same pair of
 * doubles as by exact fractions. If 248 bits leave that in doubt, the body is marked, and the caller uses fractions.
 *
 * Principal axes: Jacobi's rotations (Golub & Van Loan, Matrix Computations, section 8.5). The tangent of half of each
 * angle is a double, so that the rotation is a quotient of exact numbers. Its angle has an error of 2^-50, which the
 * next rotation corrects.
 */
#include <stddef.h>

#include "fixed_point.h"

enum { SWEEPS = 60 };

/* Errors as bits after the point: of moments, of axes if moments differ by 1, of rates, of the defect. */
enum { OF_MOMENTS = 238, OF_AXES = 234, OF_RATES = 242, OF_DEFECT = 234 };

#define OFF_DIAGONAL 0x1p-242 /* smaller products of inertia need no further rotation */
#define TIE 1e-9              /* smallest difference by which a choice is certain */
#define NEAREST 0x1p-80       /* closer moments are marked for fractions */

static fixed power(int bits)
{
    fixed r = FIXED_ZERO;
    const int place = FRACTION - bits;
    r.limb[place >> 6] = (uint64_t)1 << (place & 63);
    return r;
}

/* The power of two that scales the largest of three numbers to [1/2, 1); 0 if that is far from 1, as at rest. */
static double scale_of(const double x[3])
{
    double largest = 0.0;
    int exponent;
    for (int k = 0; k < 3; ++k)
        largest = fabs(x[k]) > largest ? fabs(x[k]) : largest;
    if (!(largest >= 0x1p-690 && largest <= 0x1p690))
        return 0.0;
    frexp(largest, &exponent);
    return power_of_two(-exponent);
}

/*
 * Write the defect, divided by the square of the largest moment times the largest rate, as a pair; return 0 if it is in
 * doubt. The units of moments and rates make the largest of each 1/2 to 2. The defect has `bits` correct bits after the
 * point.
 */
static int defect_of(const fixed moments[3], const fixed rates[3], int bits, double pair[2])
{
    int order[3] = {0, 1, 2}, exact = 1;
    for (int pass = 0; pass < 3; ++pass) {
        const int k = pass & 1;
        if (fixed_less(moments[order[k + 1]], moments[order[k]])) {
            const int other = order[k];
            order[k] = order[k + 1];
            order[k + 1] = other;
        }
    }
    const fixed middle = moments[order[1]];
    fixed sum = FIXED_ZERO, fastest = FIXED_ZERO;
    for (int k = 0; k < 3; ++k) {
        const fixed size = fixed_abs(rates[k]), gap = fixed_sub(moments[k], middle);
        fastest = fixed_less(fastest, size) ? size : fastest;
        if (fixed_sign(gap) == 0 || fixed_sign(rates[k]) == 0)
            continue;
        exact = 0;
        sum = fixed_add(sum, fixed_mul(fixed_mul(moments[k], gap), fixed_mul(rates[k], rates[k])));
    }
    pair[0] = pair[1] = 0.0;
    if (exact)
        return 1;
    const fixed unit = fixed_mul(moments[order[2]], fastest);
    return fixed_pair(fixed_mul(sum, fixed_inverse(fixed_mul(unit, unit))), power(bits), 1.0, pair);
}

static int is_one(fixed a)
{
    return fixed_sign(fixed_sub(fixed_abs(a), FIXED_ONE)) == 0;
}

/* Rates along principal axes, the columns of a matrix with the error `error`, as pairs; 0 if one is in doubt. */
static int turned_rates(fixed axes[3][3], fixed error, const double omega[3], fixed rates[3], double pairs[6])
{
    const double scale = scale_of(omega);
    fixed given[3];
    if (scale == 0.0)
        return 0;
    for (int i = 0; i < 3; ++i) {
        if (!fixed_holds(omega[i]*scale))
            return 0;
        given[i] = fixed_of(omega[i]*scale);
    }
    for (int k = 0; k < 3; ++k) {
        int known = 1; /* without an error */
        rates[k] = FIXED_ZERO;
        for (int i = 0; i < 3; ++i)
            if (fixed_sign(axes[i][k]) != 0 && omega[i] != 0.0) {
                rates[k] = fixed_add(rates[k], fixed_mul(axes[i][k], given[i]));
                known = known && is_one(axes[i][k]);
            }
        if (!fixed_pair(rates[k], known ? FIXED_ZERO : error, 1.0/scale, pairs + 2*k))
            return 0;
    }
    return 1;
}

static int at_rest(const double omega[3])
{
    return omega[0] == 0.0 && omega[1] == 0.0 && omega[2] == 0.0;
}

/*
 * Many motions of one body: rates[6 n] along its principal axes, and the defect in exact[8 n], from the sixth number of
 * each motion on; doubtful[n] is 1 if their rounding is in doubt. `body` holds three moments, the largest 1/2 to 1, and
 * the matrix of the axes, row by row.
 */
void symrot_rates_of_body(ptrdiff_t n, const fixed body[12], const double *omega, double *rates, double *exact,
    unsigned char *doubtful)
{
    fixed axes[3][3], own[3];
    for (int k = 0; k < 9; ++k)
        axes[k/3][k%3] = body[3 + k];
    for (ptrdiff_t i = 0; i < n; ++i) {
        double *pairs = rates + 6*i;
        for (int k = 0; k < 6; ++k)
            pairs[k] = 0.0;
        exact[8*i + 6] = exact[8*i + 7] = 0.0;
        doubtful[i] = !at_rest(omega + 3*i)
            && !(turned_rates(axes, power(OF_RATES), omega + 3*i, own, pairs)
                && defect_of(body, own, OF_DEFECT, exact + 8*i + 6));
    }
}

/* The defects of bodies with principal moments[3 n], as above. */
void symrot_defects(ptrdiff_t n, const double *moments, const double *omega, double *exact, unsigned char *doubtful)
{
    for (ptrdiff_t i = 0; i < n; ++i) {
        const double *given = moments + 3*i, *rates = omega + 3*i;
        const double heavy = scale_of(given), fast = scale_of(rates);
        fixed own[3], along[3];
        int held = heavy != 0.0 && fast != 0.0;
        for (int k = 0; k < 3 && held; ++k) {
            held = fixed_holds(given[k]*heavy) && fixed_holds(rates[k]*fast);
            own[k] = fixed_of(given[k]*heavy);
            along[k] = fixed_of(rates[k]*fast);
        }
        exact[8*i + 6] = exact[8*i + 7] = 0.0;
        doubtful[i] = !at_rest(rates) && !(held && defect_of(own, along, OF_DEFECT, exact + 8*i + 6));
    }
}

/* Rotate the axes p and q of a tensor so that their product of inertia becomes small; update the matrix of all axes. */
static void rotate(fixed a[3][3], int p, int q, fixed turn[4])
{
    const int r = 3 - p - q;
    const double cotangent = fixed_value(fixed_sub(a[q][q], a[p][p]))/(2.0*fixed_value(a[p][q])); /* of twice the angle */
    double tangent = 1.0/(fabs(cotangent) + sqrt(cotangent*cotangent + 1.0));
    tangent = cotangent < 0.0 ? -tangent : tangent;
    const fixed half = fixed_of(tangent/(1.0 + sqrt(tangent*tangent + 1.0))); /* the tangent of half of it */
    const fixed square = fixed_mul(half, half), share = fixed_inverse(fixed_add(FIXED_ONE, square));
    const fixed cosine = fixed_mul(fixed_sub(FIXED_ONE, square), share);
    const fixed sine = fixed_mul(fixed_add(half, half), share);
    const fixed x = fixed_sub(fixed_mul(cosine, a[p][p]), fixed_mul(sine, a[p][q]));
    const fixed y = fixed_sub(fixed_mul(cosine, a[p][q]), fixed_mul(sine, a[q][q]));
    const fixed both = fixed_add(a[p][p], a[q][q]);
    a[p][p] = fixed_sub(fixed_mul(cosine, x), fixed_mul(sine, y));
    a[q][q] = fixed_sub(both, a[p][p]);
    a[p][q] = a[q][p] = fixed_add(fixed_mul(sine, x), fixed_mul(cosine, y));
    const fixed to_p = a[r][p], to_q = a[r][q];
    a[r][p] = a[p][r] = fixed_sub(fixed_mul(cosine, to_p), fixed_mul(sine, to_q));
    a[r][q] = a[q][r] = fixed_add(fixed_mul(sine, to_p), fixed_mul(cosine, to_q));
    /* the axes rotate about axis r, from q to p if r, p, q are cyclic: multiply by (1, -half r) */
    const fixed by = (r + 1)%3 == p ? fixed_negative(half) : half;
    const int i = r + 1, j = (r + 1)%3 + 1, k = (r + 2)%3 + 1;
    const fixed w = turn[0], u = turn[i], v = turn[j], z = turn[k];
    turn[0] = fixed_sub(w, fixed_mul(by, u));
    turn[i] = fixed_add(u, fixed_mul(by, w));
    turn[j] = fixed_add(v, fixed_mul(by, z));
    turn[k] = fixed_sub(z, fixed_mul(by, v));
}

/* The rotation matrix of a quaternion whose norm is near 1. */
static void matrix_of(const fixed q[4], fixed m[3][3])
{
    fixed squares[4], sum = FIXED_ZERO;
    for (int k = 0; k < 4; ++k) {
        squares[k] = fixed_mul(q[k], q[k]);
        sum = fixed_add(sum, squares[k]);
    }
    const fixed share = fixed_inverse(sum), twice = fixed_add(share, share);
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1)%3, j = (k + 2)%3;
        const fixed product = fixed_mul(q[i + 1], q[j + 1]), along = fixed_mul(q[0], q[k + 1]);
        const fixed across = fixed_add(squares[i + 1], squares[j + 1]);
        m[k][k] = fixed_sub(FIXED_ONE, fixed_mul(twice, across));
        m[i][j] = fixed_mul(twice, fixed_sub(product, along));
        m[j][i] = fixed_mul(twice, fixed_add(product, along));
    }
}

/* Assign the columns of a matrix to the body axes to which they are closest, all three together; 0 if in doubt. */
static int closest(fixed m[3][3], int order[3])
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    double best = -1.0, next = -1.0;
    for (int n = 0; n < 6; ++n) {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
            sum += fabs(fixed_value(m[k][orders[n][k]]));
        if (sum > best) {
            next = best;
            best = sum;
            for (int k = 0; k < 3; ++k)
                order[k] = orders[n][k];
        } else
            next = sum > next ? sum : next;
    }
    return best - next > TIE;
}

/* Order and orient the principal axes as principal.py does: `m` becomes their matrix. Returns 0 if in doubt. */
static int directed(fixed m[3][3], fixed moments[3], int known[3])
{
    int order[3], exact[3], clear = closest(m, order), loosest = 0, odd = 0;
    fixed columns[3][3], own[3];
    double along[3];
    for (int k = 0; k < 3; ++k) {
        own[k] = moments[order[k]];
        exact[k] = known[order[k]];
        along[k] = fixed_value(m[k][order[k]]);
        odd ^= along[k] < 0.0;
        for (int i = 0; i < 3; ++i)
            columns[k][i] = along[k] < 0.0 ? fixed_negative(m[i][order[k]]) : m[i][order[k]];
        along[k] = fabs(along[k]);
        clear = clear && along[k] > TIE;
        loosest = along[k] < along[loosest] ? k : loosest;
    }
    odd ^= (order[1] + 3 - order[0])%3 != 1; /* the matrix was right-handed */
    for (int k = 0; k < 3; ++k) {
        clear = clear && !(odd && k != loosest && along[k] - along[loosest] <= TIE);
        moments[k] = own[k];
        known[k] = exact[k];
        for (int i = 0; i < 3; ++i)
            m[i][k] = odd && k == loosest ? fixed_negative(columns[k][i]) : columns[k][i];
    }
    return clear;
}

/* The unit quaternion of a rotation matrix, its largest component positive (Shepperd); 0 if in doubt. */
static int quaternion_of(fixed m[3][3], fixed q[4])
{
    fixed square[4]; /* of each component, four times */
    const fixed trace = fixed_add(fixed_add(m[0][0], m[1][1]), m[2][2]);
    square[0] = fixed_add(FIXED_ONE, trace);
    int best = 0, clear = 1;
    for (int k = 0; k < 3; ++k) {
        square[k + 1] = fixed_sub(fixed_add(FIXED_ONE, fixed_add(m[k][k], m[k][k])), trace);
        best = fixed_less(square[best], square[k + 1]) ? k + 1 : best;
    }
    for (int k = 0; k < 4; ++k)
        clear = clear && (k == best || fixed_value(fixed_sub(square[best], square[k])) > TIE);
    const fixed share = fixed_half(fixed_inverse_root(square[best]));
    if (best == 0) {
        q[0] = square[0];
        for (int k = 0; k < 3; ++k)
            q[k + 1] = fixed_sub(m[(k + 2)%3][(k + 1)%3], m[(k + 1)%3][(k + 2)%3]);
    } else {
        const int k = best - 1, i = best%3, j = (best + 1)%3;
        q[0] = fixed_sub(m[j][i], m[i][j]);
        q[best] = square[best];
        q[i + 1] = fixed_add(m[k][i], m[i][k]);
        q[j + 1] = fixed_add(m[k][j], m[j][k]);
    }
    for (int k = 0; k < 4; ++k)
        q[k] = fixed_mul(q[k], share);
    return clear;
}

/* The entries xx, yy, zz, xy, xz, yz of tensors, kg m^2: one double per body, or one sum of `terms` for all bodies. */
typedef struct {
    const double *entries[6];
    ptrdiff_t strides[6], terms;
    int32_t exact[6]; /* whether a sum is the number itself */
} tensors;

/* The principal moments and axes of one body; 0 if they are in doubt. `known` marks moments without an error. */
static int principal(const tensors *t, ptrdiff_t n, fixed moments[3], int known[3], fixed axes[3][3], double *scale)
{
    static const int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
    double first[3];
    for (int k = 0; k < 3; ++k)
        first[k] = t->entries[k][n*t->strides[k]];
    *scale = scale_of(first);
    if (*scale == 0.0)
        return 0;
    fixed a[3][3];
    for (int k = 0; k < 6; ++k) {
        const double *x = t->entries[k] + n*t->strides[k];
        fixed sum = FIXED_ZERO;
        int held = t->exact[k];
        for (ptrdiff_t m = 0; m < (t->strides[k] ? 1 : t->terms); ++m) {
            if (!(fabs(x[m]**scale) <= 1.0))
                return 0; /* no body has such a product */
            held = held && fixed_holds(x[m]**scale);
            sum = fixed_add(sum, fixed_of(x[m]**scale));
        }
        a[rows[k]][columns[k]] = a[columns[k]][rows[k]] = sum;
        if (k < 3)
            known[k] = held;
        else if (!held && fixed_sign(sum) == 0)
            return 0; /* a product of inertia too small for these bits */
    }
    for (int k = 0; k < 3; ++k)
        known[k] = known[k] && fixed_sign(a[k][(k + 1)%3]) == 0 && fixed_sign(a[k][(k + 2)%3]) == 0;
    if (known[0] + known[1] + known[2] > 1)
        return 0; /* principal axes are given */
    fixed turn[4] = {FIXED_ONE, FIXED_ZERO, FIXED_ZERO, FIXED_ZERO};
    for (int sweep = 0, left = 1; left; ++sweep) {
        left = 0;
        if (sweep == SWEEPS)
            return 0;
        for (int k = 3; k < 6; ++k)
            if (fabs(fixed_value(a[rows[k]][columns[k]])) > OFF_DIAGONAL) {
                rotate(a, rows[k], columns[k], turn);
                left = 1;
            }
    }
    matrix_of(turn, axes);
    for (int k = 0; k < 3; ++k)
        moments[k] = a[k][k];
    return directed(axes, moments, known);
}

/*
 * The arguments of symrot_free_body_prepare for many bodies, from their tensors and from omega[3 n], rad/s, in the
 * given axes: inertia[6 n], rates[6 n], exact[8 n] and axes[26 n], each number as hi, lo. doubtful[n] is 1 if the
 * rounding of some number is in doubt.
 */
void symrot_principal_bodies(ptrdiff_t n, const tensors *t, const double *omega, double *inertia, double *rates,
    double *exact, double *axes, unsigned char *doubtful)
{
    for (ptrdiff_t i = 0; i < n; ++i) {
        fixed moments[3], m[3][3], q[4], along[3];
        int known[3];
        double scale, nearest = 2.0, *const all = axes + 26*i;
        for (int k = 0; k < 6; ++k)
            inertia[6*i + k] = rates[6*i + k] = 0.0;
        for (int k = 0; k < 8; ++k)
            exact[8*i + k] = 0.0;
        for (int k = 0; k < 26; ++k)
            all[k] = 0.0;
        doubtful[i] = 1;
        if (!principal(t, i, moments, known, m, &scale))
            continue;
        int clear = quaternion_of(m, q);
        for (int k = 0; k < 3; ++k) {
            const fixed gap = fixed_sub(moments[(k + 1)%3], moments[(k + 2)%3]);
            const double size = fabs(fixed_value(gap));
            nearest = size < nearest ? size : nearest;
            clear = clear && fixed_pair(gap, power(OF_MOMENTS - 1), 1.0/scale, exact + 8*i + 2*k)
                && fixed_pair(moments[k], known[k] ? FIXED_ZERO : power(OF_MOMENTS), 1.0/scale, inertia + 6*i + 2*k);
        }
        if (!clear || nearest < NEAREST)
            continue;
        int lost = 0; /* bits that the axes lose if moments are close */
        frexp(1.0/nearest, &lost);
        lost = lost > 0 ? lost : 0;
        const fixed error = power(OF_AXES - lost);
        const int alone = known[0] ? 0 : known[1] ? 1 : known[2] ? 2 : -1; /* an exactly principal axis */
        for (int k = 0; k < 9 && clear; ++k) {
            const int exactly = alone >= 0 && (k/3 == alone || k%3 == alone);
            clear = fixed_pair(m[k/3][k%3], exactly ? FIXED_ZERO : error, 1.0, all + 2*k);
        }
        for (int k = 0; k < 4 && clear; ++k)
            clear = fixed_pair(q[k], alone >= 0 && k > 0 && k - 1 != alone ? FIXED_ZERO : error, 1.0, all + 18 + 2*k);
        if (!clear)
            continue;
        const fixed wide = fixed_add(error, fixed_add(error, error));
        doubtful[i] = !at_rest(omega + 3*i)
            && !(turned_rates(m, wide, omega + 3*i, along, rates + 6*i)
                && defect_of(moments, along, OF_AXES - 12 - lost, exact + 8*i + 6));
    }
}

/*
 * Many spin-ups, one after the other: constants and samples of each, with the same bits as for a single motion.
 *
 * The polynomials near resonance take most of the time, because each step depends on the previous one. The polynomials
 * of eight motions are therefore computed together, in SIMD code.
 */
#include "spin_up.c"
#include "many.h"

static void near_tables_of_lanes(int pieces, near_motion motions[LANES])
{
    near_tables(LANES, pieces, motions);
}

typedef int (*samples_of)(const void *, const double *, ptrdiff_t, const double *, double *, double *);

enum { TABLE = 4*SPIN_UP_TAYLOR };

static const double *times_of(const symrot_many_motions *m, ptrdiff_t i)
{
    return m->times + i*m->times_stride;
}

/* Write the samples of a motion; return why some are missing. A motion with too many revolutions gets NaN. */
static int sampled(const symrot_many_motions *m, ptrdiff_t i, const spin_up *f, const double *table)
{
    double *omega = m->omega + 3*i*m->samples;
    double *quaternion = m->quaternion == NULL ? NULL : m->quaternion + 4*i*m->samples;
    const int status = ((samples_of)m->at)(f, table, m->samples, times_of(m, i), omega, quaternion);
    if (status & SPIN_UP_LOST) {
        omega[0] = NAN;
        if (quaternion != NULL)
            quaternion[0] = NAN;
    }
    return status & SPIN_UP_LOST ? 0 : status;
}

/* Whether some samples are certainly near resonance or beyond it, as seen from the start. */
static int passes(const spin_up *f, double first, double last)
{
    if (f->whole != 0.0)
        return 0;
    const double one = f->sweep[0] + f->sweep[2]*(first*f->time_scale);
    const double other = f->sweep[0] + f->sweep[2]*(last*f->time_scale);
    return f->start == SPIN_UP_NEAR || (f->start == SPIN_UP_BEYOND ? one < f->edge : other > -f->edge);
}

/* Compute the polynomials of up to eight motions, the rest of their constants, and their samples. */
static void follow_together(const symrot_many_motions *m, int count, const ptrdiff_t which[LANES], const half_way h[LANES],
    spin_up records[LANES])
{
    const int pieces = (int)(m->constants[1][1]*SPIN_UP_PIECES);
    near_motion near[LANES];
    for (int lane = 0; lane < LANES; ++lane)
        near[lane] = near_motion_of(h + (lane < count ? lane : 0), m->table + lane*pieces*TABLE);
    if (count > 2)
        near_tables_of_lanes(pieces, near);
    else
        for (int lane = 0; lane < count; ++lane)
            near_table(pieces, near + lane);
    for (int lane = 0; lane < count; ++lane) {
        prepare_rest(h + lane, near + lane, records + lane);
        sampled(m, which[lane], records + lane, near[lane].table);
    }
}

/*
 * Write the samples of the motions first to last - 1. The arguments of symrot_spin_up_prepare are given: the numbers of
 * each motion, and the common axis and limits. Returns the first motion if the compiler has broken error-free
 * arithmetic, else last.
 */
ptrdiff_t symrot_many_spin_ups(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    if (!dd_sound())
        return first;
    spin_up *records = m->record;
    half_way h[LANES];
    ptrdiff_t waiting[LANES];
    int count = 0; /* of the motions in `which` */
    double earliest = 0.0, latest = 0.0;
    for (ptrdiff_t i = first; i < last; ++i) {
        if (m->quaternion != NULL && (i == first || m->times_stride))
            for (ptrdiff_t k = 0; k < m->samples; ++k) {
                const double t = times_of(m, i)[k];
                earliest = k == 0 || t < earliest ? t : earliest;
                latest = k == 0 || t > latest ? t : latest;
            }
        spin_up *own = records + count;
        prepare_first((int)m->constants[1][0], m->constants[0] + i*m->strides[0], m->constants[1] + 1, h + count, own);
        if ((m->quaternion == NULL || !passes(own, earliest, latest)) && !sampled(m, i, own, NULL))
            continue;
        waiting[count++] = i;
        if (count == LANES) {
            follow_together(m, count, waiting, h, records);
            count = 0;
        }
    }
    if (count)
        follow_together(m, count, waiting, h, records);
    return last;
}

/* The number of records and tables for which the caller provides memory. */
ptrdiff_t symrot_many_spin_ups_at_once(void)
{
    return LANES;
}

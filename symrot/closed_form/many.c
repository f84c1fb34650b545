/*
 * Many motions of one closed form, one after the other: constants and samples of each in one call.
 *
 * The functions are those of name.c and name_at.c, by their addresses: every motion comes out as it does alone.
 */
#include <stddef.h>

typedef const double *numbers;
typedef int (*of_five)(numbers, numbers, numbers, numbers, numbers, void *);
typedef int (*of_six)(numbers, numbers, numbers, numbers, numbers, numbers, void *);
typedef void (*samples_of)(const void *, ptrdiff_t, const double *, double *, double *);
typedef int (*axial_samples_of)(const void *, ptrdiff_t, const double *, double *, double *);
typedef int (*of_spin_up)(int, numbers, numbers, double *, void *);
typedef int (*spin_up_samples_of)(const void *, numbers, ptrdiff_t, const double *, double *, double *);

/* Everything as others lay it out; a stride is a number of doubles from one motion to the next, 0 for what all share. */
typedef struct {
    void *prepare, *at;
    void *record;          /* room for the constants of one motion */
    double *table;         /* room for the polynomials of a spin-up */
    ptrdiff_t arguments;   /* of prepare, before the record: 5 or 6 */
    const double *given[6];
    ptrdiff_t strides[6];
    const double *times;   /* s, from the start */
    ptrdiff_t times_stride, samples;
    double *omega;         /* (n, samples, 3) */
    double *quaternion;    /* (n, samples, 4), or NULL */
} symrot_many_motions;

/* Write the samples of the motions first to last - 1; return the first that prepare refuses, or last. */
ptrdiff_t symrot_many(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    for (ptrdiff_t i = first; i < last; ++i) {
        const double *g[6] = {NULL};
        for (ptrdiff_t k = 0; k < m->arguments; ++k)
            g[k] = m->given[k] == NULL ? NULL : m->given[k] + i*m->strides[k];
        const int status = m->arguments == 5
            ? ((of_five)m->prepare)(g[0], g[1], g[2], g[3], g[4], m->record)
            : ((of_six)m->prepare)(g[0], g[1], g[2], g[3], g[4], g[5], m->record);
        if (status)
            return i;
        ((samples_of)m->at)(
            m->record, m->samples, m->times + i*m->times_stride, m->omega + 3*i*m->samples,
            m->quaternion == NULL ? NULL : m->quaternion + 4*i*m->samples);
    }
    return last;
}

/* The same of rotations about one axis, whose constants are given: the first whose samples lack something, or last. */
ptrdiff_t symrot_many_axial(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    for (ptrdiff_t i = first; i < last; ++i)
        if (((axial_samples_of)m->at)(
                m->given[0] + i*m->strides[0], m->samples, m->times + i*m->times_stride, m->omega + 3*i*m->samples,
                m->quaternion == NULL ? NULL : m->quaternion + 4*i*m->samples))
            return i;
    return last;
}

/*
 * The same of spin-ups: the first that is refused, or has too many turns, or last. Given are numbers and, of all, the
 * axis and limits. A motion takes polynomials if its samples ask for them, or those of the motion before did: they
 * change no other sample.
 */
ptrdiff_t symrot_many_spin_up(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    enum { LACKING = 1 }; /* of spin_up.h */
    const of_spin_up prepare = (of_spin_up)m->prepare;
    const spin_up_samples_of at = (spin_up_samples_of)m->at;
    const int axis = (int)m->given[1][0];
    double *table = NULL;
    for (ptrdiff_t i = first; i < last; ++i) {
        const double *g = m->given[0] + i*m->strides[0], *times = m->times + i*m->times_stride;
        double *omega = m->omega + 3*i*m->samples;
        double *quaternion = m->quaternion == NULL ? NULL : m->quaternion + 4*i*m->samples;
        if (prepare(axis, g, m->given[1] + 1, table, m->record))
            return i;
        int status = at(m->record, table, m->samples, times, omega, quaternion);
        if (status & LACKING) {
            table = m->table;
            if (prepare(axis, g, m->given[1] + 1, table, m->record))
                return i;
            status = at(m->record, table, m->samples, times, omega, quaternion);
        }
        if (status)
            return i;
    }
    return last;
}

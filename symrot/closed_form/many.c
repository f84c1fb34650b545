/*
 * Many motions of one closed form, one after the other: constants and samples of each in one call.
 *
 * The functions of name.c and name_at.c are called by their addresses: every motion is computed as a single motion is.
 */
#include "many.h"

typedef const double *numbers;
typedef int (*of_five)(numbers, numbers, numbers, numbers, numbers, void *);
typedef int (*of_six)(numbers, numbers, numbers, numbers, numbers, numbers, void *);
typedef void (*samples_of)(const void *, ptrdiff_t, const double *, double *, double *);
typedef int (*axial_samples_of)(const void *, ptrdiff_t, const double *, double *, double *);

/* Write the samples of the motions first to last - 1; return the first motion that prepare rejects, or last. */
ptrdiff_t symrot_many(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    for (ptrdiff_t i = first; i < last; ++i) {
        const double *g[6] = {NULL};
        for (ptrdiff_t k = 0; k < m->arguments; ++k)
            g[k] = m->constants[k] == NULL ? NULL : m->constants[k] + i*m->strides[k];
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

/* The same for rotations about one axis with given constants: return the first with invalid samples, or last. */
ptrdiff_t symrot_many_axial(const symrot_many_motions *m, ptrdiff_t first, ptrdiff_t last)
{
    for (ptrdiff_t i = first; i < last; ++i)
        if (((axial_samples_of)m->at)(
                m->constants[0] + i*m->strides[0], m->samples, m->times + i*m->times_stride, m->omega + 3*i*m->samples,
                m->quaternion == NULL ? NULL : m->quaternion + 4*i*m->samples))
            return i;
    return last;
}

/* Many motions of one closed form: where their numbers are, and where their samples go. */
#ifndef SYMROT_MANY_H
#define SYMROT_MANY_H

#include <stddef.h>

/* Everything as others lay it out; a stride is a number of doubles from one motion to the next, 0 for what all share. */
typedef struct {
    void *prepare, *at;
    void *record;          /* room for the constants of one motion */
    double *table;         /* room for the polynomials of a spin-up */
    ptrdiff_t arguments;   /* of prepare, before the record: 5 or 6 */
    const double *constants[6];
    ptrdiff_t strides[6];
    const double *times;   /* s, from the start */
    ptrdiff_t times_stride, samples;
    double *omega;         /* (n, samples, 3) */
    double *quaternion;    /* (n, samples, 4), or NULL */
} symrot_many_motions;

#endif

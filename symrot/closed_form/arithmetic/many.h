/* Many motions of one closed form: the addresses of their arguments and of their samples. */
#ifndef SYMROT_MANY_H
#define SYMROT_MANY_H

#include <stddef.h>

/* The fields are as in many.py. A stride is the number of doubles from one motion to the next, 0 for shared numbers. */
typedef struct {
    void *prepare, *at;
    void *record;          /* room for the constants of one motion */
    double *table;         /* room for the polynomials of a spin-up */
    ptrdiff_t arguments;   /* number of arguments of prepare before the record: 5 or 6 */
    const double *constants[6];
    ptrdiff_t strides[6];
    const double *times;   /* s, from the start */
    ptrdiff_t times_stride, samples;
    double *omega;         /* (n, samples, 3) */
    double *quaternion;    /* (n, samples, 4), or NULL */
} symrot_many_motions;

#endif

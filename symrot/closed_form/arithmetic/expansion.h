/*
 * Exact sums of doubles (Shewchuk, Discrete Comput. Geom. 18 (1997) 305), for the defect |L|^2 - 2 T I_mid of a free
 * body: near the separatrix all its digits may cancel, so that it must not be rounded before the end.
 */
#ifndef SYMROT_EXPANSION_H
#define SYMROT_EXPANSION_H

#include "double_double.h"

enum { EXPANSION_LENGTH = 512 };

/* A sum of doubles that do not overlap, smallest first, without zeros. */
typedef struct {
    int length;
    double part[EXPANSION_LENGTH];
} expansion;

static inline void expansion_add(expansion *e, double x)
{
    int kept = 0;
    for (int i = 0; i < e->length; ++i) {
        const dd sum = two_sum(x, e->part[i]);
        x = sum.hi;
        if (sum.lo != 0.0)
            e->part[kept++] = sum.lo;
    }
    if (x != 0.0)
        e->part[kept++] = x;
    e->length = kept;
}

/* to = from*x, for x as a sum of two doubles. */
static inline void expansion_times(const expansion *from, dd x, expansion *to)
{
    to->length = 0;
    for (int i = 0; i < from->length; ++i) {
        const dd high = two_product(from->part[i], x.hi);
        expansion_add(to, high.lo);
        expansion_add(to, high.hi);
        if (x.lo != 0.0) {
            const dd low = two_product(from->part[i], x.lo);
            expansion_add(to, low.lo);
            expansion_add(to, low.hi);
        }
    }
}

/* Add I w^2 (I - other) to `to`, exactly. */
static inline void add_share(dd moment, dd omega, dd other, expansion *to)
{
    expansion first, second;
    first.length = 1; /* numbers beyond the length are not initialised: 4 kB */
    first.part[0] = 1.0;
    expansion_times(&first, moment, &second);
    expansion_times(&second, omega, &first);
    expansion_times(&first, omega, &second);
    expansion_times(&second, moment, &first);
    for (int i = 0; i < first.length; ++i)
        expansion_add(to, first.part[i]);
    expansion_times(&second, dd_negative(other), &first);
    for (int i = 0; i < first.length; ++i)
        expansion_add(to, first.part[i]);
}

/* sum of I (I - I_mid) w^2 over the outer axes: |L|^2 - 2 T I_mid, rounded once. */
static inline dd exact_defect(const dd moments[3], const dd omega[3])
{
    int middle = 0;
    for (int i = 0; i < 3; ++i) {
        const dd a = moments[(i + 1)%3], b = moments[(i + 2)%3];
        if ((!dd_less(moments[i], a) && !dd_less(b, moments[i])) || (!dd_less(moments[i], b) && !dd_less(a, moments[i])))
            middle = i;
    }
    expansion sum;
    sum.length = 0;
    add_share(moments[(middle + 1)%3], omega[(middle + 1)%3], moments[middle], &sum);
    add_share(moments[(middle + 2)%3], omega[(middle + 2)%3], moments[middle], &sum);
    dd rounded = {0.0, 0.0};
    for (int i = sum.length - 1, taken = 0; i >= 0 && taken < 4; --i, ++taken)
        rounded = dd_add(rounded, dd_of(sum.part[i]));
    return rounded;
}

#endif

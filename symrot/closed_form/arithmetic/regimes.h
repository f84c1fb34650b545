/* What a motion's constants and the loops over its samples agree on. */
#ifndef SYMROT_REGIMES_H
#define SYMROT_REGIMES_H

#include <stddef.h>

enum { SERIES = 5 }; /* coefficients of a polynomial */

/* Which series a motion takes: none; the elliptic functions' own; their imaginary transforms; those without a period. */
enum { STEADY, CIRCULAR, HYPERBOLIC, SEPARATRIX };

#endif

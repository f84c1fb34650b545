/* Definitions that the constants of a motion and the loops over its samples share. */
#ifndef SYMROT_REGIMES_H
#define SYMROT_REGIMES_H

#include <stddef.h>

enum { SERIES = 5 }; /* coefficients of a polynomial */

/* The series of a motion: none; theta series; their imaginary transforms; hyperbolic functions of a separatrix. */
enum { STEADY, CIRCULAR, HYPERBOLIC, SEPARATRIX };

#endif

/*
 * symrot_selftest: does this machine compute as the certificates of the kernels assume?
 *
 * Printed by `symrot emit --all`; do not edit.
 */
#ifndef SYMROT_SELFTEST_H
#define SYMROT_SELFTEST_H

#define SYMROT_SELFTEST_ROUNDING 1
#define SYMROT_SELFTEST_FLUSHING 2
#define SYMROT_SELFTEST_CONTRACTION 3
#define SYMROT_SELFTEST_FUNCTIONS 8 /* sin, cos, atan2, sqrt, sinf, cosf, atan2f, sqrtf */

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Return 0 where all is well, else the number of the first check that failed. bits: nonzero where the
 * bits of the C text are wanted, not only its error bounds. ulps: worst errors found in ulp, or null.
 */
int symrot_selftest(int bits, double ulps[SYMROT_SELFTEST_FUNCTIONS]);

/* what was expected, as one sentence */
const char *symrot_selftest_sentence(int failure);

#ifdef __cplusplus
}
#endif

#endif

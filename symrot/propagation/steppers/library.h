/* What the libraries of steppers and of events share; included first. C99 that is also valid C++. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(_WIN32)
#define SYMROT_EXPORT __declspec(dllexport)
#else
#define SYMROT_EXPORT
#endif

#if defined(__cplusplus)
#define SYMROT_RESTRICT __restrict
#else
#define SYMROT_RESTRICT restrict
#endif

/* What a call for some steps returns. */
enum {
    SYMROT_DONE = 0, SYMROT_PAUSED = 1, SYMROT_FULL = 2, SYMROT_NOT_FINITE = 3, SYMROT_UNDERFLOW = 4,
    SYMROT_TOO_MANY = 5, SYMROT_ROUNDED = 6, SYMROT_HOPELESS = 7
};

/* The last row of a record that starts before a time; rows have `width` numbers and follow in the direction `side`. */
static inline const double *symrot_row_at(const double *record, int64_t width, int64_t steps, double side, double time)
{
    int64_t low = 0, high = steps;
    while (high - low > 1) {
        const int64_t middle = (low + high)/2;
        if ((record[middle*width] - time)*side < 0.0) low = middle;
        else high = middle;
    }
    return record + low*width;
}

/* Complex numbers whose real and imaginary parts are double-double numbers. */
#ifndef SYMROT_COMPLEX_DD_H
#define SYMROT_COMPLEX_DD_H

#include "double_double.h"

typedef struct {
    dd re, im;
} complex_dd;

static complex_dd complex_of(dd re, dd im)
{
    const complex_dd z = {re, im};
    return z;
}

static complex_dd times(complex_dd a, complex_dd b)
{
    return complex_of(dd_sub(dd_mul(a.re, b.re), dd_mul(a.im, b.im)), dd_add(dd_mul(a.re, b.im), dd_mul(a.im, b.re)));
}

static dd square_of(complex_dd a)
{
    return dd_add(dd_square(a.re), dd_square(a.im));
}

static complex_dd quotient(complex_dd a, complex_dd b)
{
    const dd size = square_of(b);
    const complex_dd c = times(a, complex_of(b.re, dd_negative(b.im)));
    return complex_of(dd_div(c.re, size), dd_div(c.im, size));
}

static complex_dd turned(complex_dd a, dd turns)
{
    dd sine, cosine;
    dd_sincos_turns(turns, &sine, &cosine);
    return times(a, complex_of(cosine, sine));
}

#endif

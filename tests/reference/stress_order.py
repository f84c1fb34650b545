"""Stress test S25: the order of convergence of the emitted recurrences, with fixed steps.

From order 12 on, doubles are too short for a slope: where steps are small enough for the leading term to be the whole
error, the error is below 1e-13; where it is larger, later terms bend the slope. So the same emitted text is compiled
with quadruple precision in place of double, and its slope is the one of the last halving of the step with errors above
1e-29. In doubles, while errors are above 1e-13 and rounding does not matter, the slope has to be that of quadruple
precision at the same steps.
"""

import ctypes
from fractions import Fraction

import numpy as np
from mpmath import mp

from symrot.build import cache as library
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.codegen.taylor.source import taylor_definitions
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.steppers import taylor
from tests.reference.figures import Figure
from tests.reference.stress_stepping import Stepped, asymmetric_top

ORDERS, HIGHEST = (8, 12, 16, 20), 32
ROUNDED = 1e-13  # below this error rounding hides the slope
WIDE_ROUNDED = 1e-29  # quadruple precision is good to a few 1e-33

QUADRUPLE = """
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
typedef double plain;
#if defined(__SIZEOF_FLOAT128__)
typedef __float128 quadruple;
#else
typedef long double quadruple;  /* of 113 bits, where there is no __float128 */
#endif
#define SYMROT_PLAIN
#define double quadruple
"""
STEPS = """
/* Follow `count` steps of order `order` over a unit of time; states as sums of two doubles, high then low. */
SYMROT_EXPORT void symrot_steps(const plain *p, const plain *start, int64_t order, int64_t count, plain *states)
{
    symrot_v4 c[SYMROT_CONSTANTS], x[SYMROT_ROWS][SYMROT_ORDER + 1];
    double step[SYMROT_ORDER + 1], wide[SYMROT_PARAMETERS + 1];
    for (int i = 0; i < SYMROT_PARAMETERS; ++i) wide[i] = p[i];
    symrot_constants(wide, c);
    for (int n = 1; n <= SYMROT_ORDER; ++n) step[n] = (double)1/(count*n);
    EACH_ROW(r) {
        x[r][0] = V_ALL(0.0);
        for (int i = 0; i < symrot_sizes[r]; ++i) x[r][0].lane[i] = start[symrot_starts[r] + i];
    }
    for (int64_t k = 0; k < count; ++k) {
        symrot_jet(c, (double)k/count, 0, step, order, x);
        EACH_ROW(r) for (int64_t n = order; n > 0; --n)
            x[r][n - 1] = V_ADD(x[r][n - 1], x[r][n]);
    }
    EACH_ROW(r) for (int i = 0; i < symrot_sizes[r]; ++i) {
        const double value = x[r][0].lane[i];
        const plain high = (plain)value;
        states[2*(symrot_starts[r] + i)] = high;
        states[2*(symrot_starts[r] + i) + 1] = (plain)(value - high);
    }
}
"""


class Quadruple:
    """The emitted recurrences of a scene in quadruple precision, in steps of 1/count to t = 1."""

    def __init__(self, stepped):
        rates, blocks = stepped.kernel.rates, error_blocks(stepped.plan)
        source = taylor.translation_unit(rates, *blocks, HIGHEST)
        assert taylor_definitions(rates, *blocks, HIGHEST) in source  # word for word what users get
        path = library.build(QUADRUPLE + source.replace("/* PROJECTION */\n", "") + STEPS, "quadruple")
        self.steps = ctypes.CDLL(str(path)).symrot_steps
        self.p, self.start = np.array(stepped.p), np.array(stepped.start)

    def rates_at_end(self, order, count):
        """Return omega, rad/s, in mpmath's numbers."""
        found, integer = np.empty(2 * len(self.start)), ctypes.c_int64
        addresses = [ctypes.c_void_p(each.ctypes.data) for each in (self.p, self.start)]
        self.steps(*addresses, integer(order), integer(count), ctypes.c_void_p(found.ctypes.data))
        return [mp.mpf(found[2 * i]) + mp.mpf(found[2 * i + 1]) for i in range(3)]


def exact_steps(stepped, order, step, count):
    """Return the state after fixed steps in mpmath's precision, by the recurrences from which the text is emitted."""
    system, state = recurrences(stepped.kernel.rates), [mp.mpf(x) for x in stepped.start]
    values = {name: mp.mpf(x) for name, x in zip(system.parameters, stepped.p, strict=False)} | {"t": mp.mpf(0)}
    for _ in range(count):
        values |= dict(zip(system.states, state, strict=True))
        rows = coefficients(system, order, values, {}, lambda x: mp.mpf(x.numerator) / x.denominator)
        state = [mp.polyval(row[::-1], mp.mpf(step.numerator) / step.denominator) for row in rows]
    return state


def _apart(a, b):
    return max(abs(x - y) for x, y in zip(a, b, strict=True))


def _last_halving(errors, least):
    """Return the last two numbers of steps whose errors are above ``least``, and the slope between them."""
    pair = [count for count, error in errors.items() if error > least][-2:]
    return pair, float(mp.log(errors[pair[0]] / errors[pair[1]], 2))


def s25(long):
    found, counts = [], [2**k for k in range(8)]
    with mp.workdps(50):
        scene = asymmetric_top()
        quadruple = Quadruple(Stepped(scene))
        close = quadruple.rates_at_end(HIGHEST, 256)
        for order in ORDERS:
            exact = exact_steps(Stepped(scene), order, Fraction(1, 4), 4)[:3]
            wide = {count: _apart(quadruple.rates_at_end(order, count), close) for count in counts}
            pair, slope = _last_halving(wide, WIDE_ROUNDED)
            title = f"p = {order}: slope {slope:.2f}, error to {float(wide[pair[1]]):.0e}, off by"
            found.append(Figure("taylor, quadruple", title, 0.3, abs(slope - order)))
            title = f"p = {order}: off the recurrences in 50 digits, 4 steps"
            found.append(
                Figure("taylor, quadruple", title, 1e-30, float(_apart(quadruple.rates_at_end(order, 4), exact)))
            )
            stepped = Stepped(scene, order)
            ends = {count: stepped.with_tail(1.0, 0.9, max_step=1 / count)[0][0, :3].tolist() for count in counts[:6]}
            pair, slope = _last_halving(
                {count: _apart(map(mp.mpf, end), close) for count, end in ends.items()}, ROUNDED
            )
            title = f"p = {order}: slope {slope:.2f} above 1e-13, off quadruple's by"
            found.append(
                Figure("taylor, doubles", title, 0.01, abs(slope - float(mp.log(wide[pair[0]] / wide[pair[1]], 2))))
            )
    return found

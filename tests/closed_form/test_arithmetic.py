"""Pairs of doubles in C, compared with fifty digits; they have the same bits with and without fused instructions."""

import ctypes
import random
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp, mpf

from symrot.build.cache import NATIVE, build
from symrot.closed_form import build as library
from symrot.closed_form.arithmetic import double_double as dd

U2 = 2.0**-106
Q0 = (0.1, 0.7, -0.5, 0.5)
NATIVE_FLAGS = library.PARTS[""]
PLAIN_FLAGS = tuple(flag for flag in NATIVE_FLAGS if flag != NATIVE)
HEADERS = [Path(library.__file__).parent / "arithmetic" / name for name in ("error_free.h", "double_double.h")]
CALLS = """
void symrot_each(int which, const double *v, double *to)
{
    const dd a = {v[0], v[1]}, b = {v[2], v[3]}, c = {v[4], v[5]};
    dd first = {0.0, 0.0}, second = {0.0, 0.0};
    switch (which) {
    case 0: first = dd_add(a, b); break;
    case 1: first = dd_mul(a, b); break;
    case 2: first = dd_div(a, b); break;
    case 3: first = dd_sqrt(a); break;
    case 4: first = dd_exp(a); break;
    case 5: dd_sincos_turns(a, &first, &second); break;
    case 6: first = dd_agm(a); break;
    case 7: first = dd_rf(a, b, c); break;
    default: first = dd_add_fast(a, b); break;
    }
    to[0] = first.hi; to[1] = first.lo; to[2] = second.hi; to[3] = second.lo;
}
"""


def decades(source, low, high):
    return 10 ** source.uniform(low, high)


def signed(source):
    return source.choice((-1, 1)) * decades(source, -8, 8)


def near_turns(source):
    """Return angles in full rotations; an eighth of them are close to an eighth of a rotation."""
    return source.choice(
        (source.uniform(-3, 3), source.randint(-24, 24) / 8 + source.choice((-1, 1)) * decades(source, -18, -2))
    )


BOUNDS = {  # over u^2: of the value, of 1 for sines and cosines
    "sum": lambda a, b: 3.1,
    "product": lambda a, b: 5.1,
    "quotient": lambda a, b: 13,
    "root": lambda a: 3.2,
    "exp": lambda a: 8 + 2 * abs(a),
    "sine, cosine": lambda a: 8,
    "mean": lambda a: 16,
    "R_F": lambda a, b, c: 16,
    "fast sum": lambda a, b: 3.1,
}
OPERATIONS = {
    "sum": ((signed, signed), lambda a, b: [a + b]),
    "product": ((signed, signed), lambda a, b: [a * b]),
    "quotient": ((signed, signed), lambda a, b: [a / b]),
    "root": ((lambda s: decades(s, -12, 12),), lambda a: [mp.sqrt(a)]),
    "exp": ((lambda s: s.uniform(-600, 5),), lambda a: [mp.exp(a)]),
    "sine, cosine": ((near_turns,), lambda a: [mp.sin(2 * mp.pi * a), mp.cos(2 * mp.pi * a)]),
    "mean": ((lambda s: decades(s, -30, 0),), lambda a: [mp.agm(1, a)]),
    "R_F": ((lambda s: decades(s, -40, 3),) * 3, lambda a, b, c: [mp.elliprf(a, b, c)]),
    "fast sum": ((lambda s: decades(s, -8, 8),) * 2, lambda a, b: [a + b]),  # of positive numbers: nothing cancels
}


def pair(source, high):
    """Return a number as (hi, lo) with |lo| at most half a unit in the last place of hi."""
    low = high * source.uniform(-1, 1) * 2.0**-54
    return high + low, (high - (high + low)) + low


def draws(name, count, seed):
    """Return arguments of an operation, each a list of (hi, lo), and the pairs that it returns with and without FMA."""
    text = "\n".join(path.read_text().replace('#include "error_free.h"', "") for path in HEADERS) + CALLS
    calls = [
        ctypes.CDLL(str(build(text, "pairs_of_doubles", flags))).symrot_each for flags in (NATIVE_FLAGS, PLAIN_FLAGS)
    ]
    source, which = random.Random(seed), list(OPERATIONS).index(name)
    for _ in range(count):
        given = [x for draw in OPERATIONS[name][0] for x in pair(source, draw(source))]
        found = []
        for call in calls:
            to = (ctypes.c_double * 4)()
            call(which, (ctypes.c_double * 6)(*given), to)
            found.append(list(to))
        yield given, found


def error(name, given, found):
    """Return the largest error of the results, divided by its bound."""
    with mp.workdps(60):
        exact = [mpf(high) + mpf(low) for high, low in zip(given[::2], given[1::2], strict=True)]
        expected = OPERATIONS[name][1](*exact)
        worst = 0.0
        for high, low, value in zip(found[::2], found[1::2], expected, strict=False):
            apart = abs(mpf(high) + mpf(low) - value) / (1 if name == "sine, cosine" else abs(value))
            worst = max(worst, float(apart / (U2 * BOUNDS[name](*exact))))
        return worst


@pytest.mark.parametrize("name", OPERATIONS)
def test_errors_are_within_the_bounds_of_the_header(name):
    assert max(error(name, given, found[0]) for given, found in draws(name, 300, 7)) <= 1


@pytest.mark.parametrize("name", OPERATIONS)
def test_every_processor_returns_the_same_bits(name):
    assert all(native == plain for _, (native, plain) in draws(name, 2000, 8))


@pytest.mark.parametrize("name", OPERATIONS)
def test_a_double_alone_does_not_pass(name):
    rounded = [[high, 0.0, other, 0.0] for _, ((high, _, other, _), _) in draws(name, 20, 9)]
    given = [each for each, _ in draws(name, 20, 9)]
    assert max(error(name, *each) for each in zip(given, rounded, strict=True)) > 1e6


ON_ARRAYS = {
    "sum": dd.add,
    "difference": dd.subtract,
    "product": dd.multiply,
    "quotient": dd.divide,
    "root": dd.square_root,
}
EXACTLY = {name: exactly for name, (_, exactly) in OPERATIONS.items()} | {"difference": lambda a, b: [a - b]}


def worst_on_arrays(name, operation):
    """Return the largest error of an operation of the Python module in units of 2^-104 of the value (of the larger term
    in sums).
    """
    source = random.Random(10)
    terms = [
        [pair(source, abs(signed(source)) if name == "root" else signed(source)) for _ in range(500)] for _ in "ab"
    ]
    terms = terms[: 1 if name == "root" else 2]
    high, low = operation(*[tuple(np.array(column) for column in zip(*numbers, strict=True)) for numbers in terms])
    with mp.workdps(60):
        worst = 0
        for *numbers, up, down in zip(*terms, high, low, strict=True):
            exact = [mpf(first) + mpf(second) for first, second in numbers]
            value = EXACTLY[name](*exact)[0]
            scale = max(map(abs, exact)) if name in ("sum", "difference") else abs(value)
            worst = max(worst, abs(mpf(float(up)) + mpf(float(down)) - value) / (scale * mpf(2) ** -104))
        return float(worst)


@pytest.mark.parametrize("name", ON_ARRAYS)
def test_pairs_in_arrays_have_104_bits(name):
    assert worst_on_arrays(name, ON_ARRAYS[name]) <= 1
    assert worst_on_arrays(name, lambda *pairs: (ON_ARRAYS[name](*pairs)[0], np.zeros(500))) > 1e6


def test_a_normalized_pair_has_the_same_sum():
    high, low = dd.normalized(np.array([1.0, -3.0]), np.array([1.0, 2.0**-60]))
    assert high.tolist() == [2.0, -3.0] and low.tolist() == [0.0, 2.0**-60]


@pytest.mark.parametrize(
    "moments, omega",
    [((1, 2, 3), (0.3, 1, 0.5)), ((1, 2, 3), (0.01, 1, 0.01)), ((3, 4, 6), (2, 1.5, 1)), ((1, 1, 2), (0.3, 1, 0.5))],
)
def test_the_constants_of_a_free_body_are_the_same_bits(moments, omega):
    """The circular, hyperbolic, separatrix and symmetric motions are tested, with and without FMA."""
    records = []
    for flags in (NATIVE_FLAGS, PLAIN_FLAGS):
        constants = ctypes.CDLL(str(build(library.source("free_body"), "free_body_bits", flags)))
        record = (ctypes.c_double * constants.symrot_free_body_length())()
        given = [(ctypes.c_double * (2 * len(v)))(*(y for x in v for y in (x, 0.0))) for v in (moments, omega, Q0)]
        assert constants.symrot_free_body_prepare(*given, None, None, record) == 0
        records.append(bytes(record))
    assert records[0] == records[1]

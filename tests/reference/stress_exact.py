"""Stress tests S1 to S16 and S18 to S23: exact motions agree with elliptic integrals and Taylor series in 50 digits."""

import math
import random
from fractions import Fraction as F
from itertools import permutations, product

import numpy as np

from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.heavy_top import motion as heavy_top
from tests.closed_form import test_free_body as free
from tests.closed_form import test_heavy_top as top
from tests.reference import free_body as reference
from tests.reference.figures import Figure, body, largest, propagated

METHOD, BAR = "exact", 1e-15
BODY, RATES = (1, 2, 3), (0.3, 1.0, 0.5)
PERIODS = (10.3, 1000.3, 1e6 + 0.3, -1e6 + 0.1)


def _free(what, cases, bar=BAR):
    """Return the figure of the largest error of omega and q over cases; a case holds the arguments of the comparison."""
    return Figure(METHOD, what, bar, max(max(free.errors(*case, **more)) for *case, more in cases))


def s1(long):
    return [_free("t = 7", [(BODY, RATES, [7.0], {})], 5e-16)]


def s2(long):
    rates = (RATES, (1.0, 0.4, 0.2), (0.2, 0.3, 1.1))
    orders = list(permutations((1.0, 2.0, 3.0)))
    cases = [
        (moments, [s * w for s, w in zip(signs, omega, strict=True)], [7.3], {"digits": 50})
        for moments, signs, omega in product(orders, product((1, -1), repeat=3), rates)
    ]
    return [_free(f"{len(cases)} orders and signs", cases)]


def s3(long):
    cases = [(BODY, omega, PERIODS, {"in_periods": True}) for omega in (RATES, (0.3, 1.0, 1.5), (1.0, 0.4, 0.2))]
    return [_free("10, 1e3, 1e6 periods", cases)]


def s4(long):
    return [_free("t = 1e9, 1e12, 1e15", [(BODY, w, [1e9, 1e12, 1e15, -1e15], {}) for w in (RATES, (0.3, 1.0, 1.5))])]


def s5(long):
    count, source = 1000 if long else 20, random.Random(55)
    cases = []
    for _ in range(count):
        moments, omega, q0 = free.random_body(source)
        times = [source.uniform(-10, 10), source.uniform(-1e6, 1e6)]
        cases.append((moments, omega, times, q0, {"in_periods": True, "digits": 70}))
    return [_free(f"{count} bodies", cases)]


def s6(long):
    sizes = (1e-3, 1e-5, 1e-8, 1e-12)
    short = [(BODY, (e, 1.0, e), [0.13, 0.5, 3.7, 1e3], {}) for e in sizes]
    return [_free("t to 1e3", short), _free("1e6 periods", [
        (BODY, (e, 1.0, e), [1e6 + 0.26], {"in_periods": True}) for e in sizes])]  # fmt: skip


def s7(long):
    sizes = (1e-8, -1e-8, 1e-14, -1e-14, 1e-15, -1e-15)
    return [_free("t to 1e6", [(BODY, (1, 1, (1 + d) / math.sqrt(3)), [0.13, 3.7, 1e3, 1e6], {}) for d in sizes])]


def s8(long):
    omegas = [[F(x) for x in w] for w in ((2, "3/2", 1), (2, "-3/2", 1), (2, "3/2", -1))]
    final = [abs(free_body.motion((3, 4, 6), w, free.Q0).evaluate([1e6])[0][0][1]) for w in omegas]
    middle = math.sqrt(6 * 6 + 6 * 6 + 6 * 6) / 4
    return [_free("t to 1e6", [((3, 4, 6), w, [0.3, -3.0, 30.0, 1e3, -1e6], {}) for w in omegas]),
            Figure(METHOD, "tends to the middle axis", BAR, largest(final, middle) / middle)]  # fmt: skip


def s9(long):
    omega = (1e-8, 1.0, 1e-8)
    half = reference.motion(BODY, omega, free.Q0).period / 2
    times = [float(half * k) for k in (1, 2, 3)]
    rates, _ = free_body.motion(BODY, omega, free.Q0).evaluate(times, quaternion=False)
    return [Figure(METHOD, "omega_2 after half periods, ulp", 1, np.abs(rates[:, 1] - [-1, 1, -1]).max() * 2.0**52),
            _free("there", [(BODY, omega, times, {})])]  # fmt: skip


def s10(long):
    moments = ((1, 1, 2), (3, 1, 1), (2, 2, 2), (1, 1 + 1e-9, 2), (1, 1 + 4e-16, 2), (2, 1, 1 + 4e-16))
    ends = [free_body.motion((1.0, 1.0 + d, 2.0), RATES, free.Q0).evaluate([2.7])[1] for d in (4e-16, 0, -4e-16)]
    # bodies that differ by 4e-16 differ by 4e-16 times t = 2.7 and by what two roundings take
    return [_free("t to 3e5", [(each, RATES, free.SPREAD, {}) for each in moments]),
            Figure(METHOD, "jump across equality", 3e-15, max(largest(ends[1], each) for each in ends))]  # fmt: skip


def s11(long):
    cases = [((3, 1, 1), (0, 0.2, 0.5)), (BODY, (0, 0, 0)), *((BODY, w) for w in ((2, 0, 0), (0, -2, 0), (0, 0, 2)))]
    changed = sum(
        int((free_body.motion(m, w, free.Q0).evaluate(free.SPREAD, quaternion=False)[0] != w).sum()) for m, w in cases
    )
    return [_free("t to 3e5", [(m, w, free.SPREAD, {}) for m, w in cases]),
            Figure(METHOD, "rates that changed at all", 0, changed)]  # fmt: skip


def s12(long):
    omegas = ((1e-9, 1e-9, 1.0), (1.0, 1e-9, 1e-9), (1e-150, 1e-150, 1.0), (0.0, 1e-12, 1.0))
    found = propagated(body(BODY, ("1e-9", "1e-9", 1)), "taylor", 1e-15, [1e3])
    return [_free("t to 3e5", [(BODY, w, free.SPREAD, {}) for w in omegas]),
            Figure("taylor", "projected, t = 1e3: not finite", 0, int((~np.isfinite(found.y)).sum()))]  # fmt: skip


def s13(long):
    moments = (1, 1 + 1e-10, 1 + 3e-10)
    return [_free("t to 3e5, 1e6 periods", [
        (moments, RATES, free.SPREAD, {}), (moments, RATES, [1e6 + 0.3], {"in_periods": True})])]  # fmt: skip


def s14(long):
    moments = ((1e-6, 1, 1 + 1e-7), BODY, (0.3, 0.4, 0.7), (1e-12, 1, 1), (1e-9, 1, 1 + 1e-9))
    return [_free("t to 3e5", [(m, w, free.SPREAD, {}) for m, w in product(moments, (RATES, (0.5, 0.3, -1.0)))])]


def s15(long):
    times, changed = np.array(free.SPREAD[:-2]), 0
    rates, attitudes = free_body.motion((1.0, 2.0, 3.0), RATES, free.Q0).evaluate(times)
    for power in (-530, -61, 300):
        scale, heavy = 2.0**power, [math.ldexp(x, 400) for x in (1.0, 2.0, 3.0)]
        slow = free_body.motion(heavy, [w * scale for w in RATES], free.Q0).evaluate(times / scale)
        changed += int((slow[1] != attitudes).sum() + (slow[0] != rates * scale).sum())
    return [Figure(METHOD, "numbers that changed a bit", 0, changed)]


def s16(long):
    cases = ((BODY, (3e8, 1e8, 2e8)), ((1e200, 2e200, 3e200), RATES), (BODY, (3e-160, 1e-160, 2e-160)))
    return [_free("t = 7 and 1e5 turns", [(m, w, [7.3 / max(w), 1e5 / max(w)], {}) for m, w in cases])]


# ------------------------------------------------------------------------------------------------ heavy tops


def _top(what, cases, bar=BAR):
    return Figure(METHOD, what, bar, max(max(top.errors(*case, **more)) for *case, more in cases))


def _long_top(what, cases, bar=BAR):
    return Figure(METHOD, what, bar, max(max(top.long_errors(*case, **more)) for *case, more in cases))


def s18(long):
    tilt = top.tilted(F(1, 2))
    found = [_top("t to 6, Taylor series", [(w, tilt, {}) for w in top.S18.values()]), _long_top(
        "1e3 nutations", [(w, tilt, [F(503, 50), F(10003, 10), F(-9999, 10)], {}) for w in top.S18.values()])]  # fmt: skip
    if long:
        times = [10**5 + F(1, 3), 10**6 + F(1, 3)]
        found.append(_long_top("1e6 nutations", [(w, tilt, times, {}) for w in top.S18.values()]))
    return found


def s19(long):
    starts = (((F(3, 10), F(4, 5), 0), top.tilted(F(3, 2))), ((F(1, 2), 0, 0), top.tilted(2)),
              ((3, 0, 0), top.tilted(2)), ((F(1, 100), 0, 0), top.UPRIGHT), ((F(1, 10), F(1, 10), 0), top.HANGING))  # fmt: skip
    return [_top("spherical, libration, rotation, through 0 and pi", [(*start, {}) for start in starts])]


def s20(long):
    omegas = ((F(5, 2), 0, 1), (F(9, 2), 1, -1), (F(1, 1000), 0, 3), (F(-1, 10), F(1, 10), 10))
    return [_top("start upright or hanging", [(w, q, {}) for w in omegas for q in (top.UPRIGHT, top.HANGING)])]


def s21(long):
    spins, tilts = (F(9, 2), F(401, 100), F(4), F(39, 10), F(3)), (F(1, 10**3), F(1, 10**5), F(1, 10**7))
    hanging = [(w, top.tilted(F(31415, 10000)), {}) for w in ((0, 0, 1), (0, 0, 0), (F(1, 10**6), 0, 2))]
    falls = [((0, 0, w), top.tilted(e), [F(1, 3), F(51, 10), F(10003, 10)], {})
             for w, e in ((F(3), F(1, 10**3)), (F(3), F(1, 10**5)), (F(39, 10), F(1, 10**3)), (F(39, 10), F(1, 10**6)))]  # fmt: skip
    still = [((2, 0, 0), top.HANGING, {}), ((0, 0, F(4)), top.UPRIGHT, {}), ((F(1, 100), 0, F(4)), top.UPRIGHT, {})]
    return [
        _top("sleeping, t to 6", [((0, 0, w), top.tilted(e), {}) for w in spins for e in tilts]),
        _top("hanging", hanging), _top("on the separatrix", still), _long_top("1e3 falls", falls),
    ]  # fmt: skip


def s22(long):
    ends = []
    for factor in (1, 1 + 1e-15, 1 - 1e-15):
        q0 = [F(factor) * x for x in top.tilted(F(1, 2))]
        ends.append(heavy_top.motion((1, 1, F(1, 2)), 1, (0, 0, 1), top.S18["loops"], q0).evaluate([1e3])[1])
    gravity = [{"kind": "gravity", "weight": 1, "center_of_mass": [0, 0, 1]}]
    stepped = []
    for factor in (F(1), 1 + F(1, 10**15), 1 - F(1, 10**15)):
        q = {"quaternion": [str(factor * x) for x in top.tilted(F(1, 2))]}
        scene = body((1, 1, "1/2"), ("3/10", "-9/5", 4), gravity, q)
        stepped.append(propagated(scene, "taylor", 1e-15, [1e3]).quaternion)
    return [Figure(METHOD, "change of q at t = 1e3", 0, max(largest(ends[0], each) for each in ends)),
            Figure("taylor", "change of q at t = 1e3", BAR, max(largest(stepped[0], e) for e in stepped))]  # fmt: skip


def s23(long):
    gravity = [{"kind": "gravity", "weight": 1, "center_of_mass": [0, 0, 1]}]
    found = [_long_top("spin 50 and 500, t = 200", [
        ((0, 0, w), top.tilted(F(1)), [F(1, 3), 200], {"in_periods": False}) for w in (50, 500)])]  # fmt: skip
    for spin in (50, 500):
        scene = body((1, 1, "1/2"), (0, 0, spin), gravity, {"quaternion": [str(x) for x in top.tilted(F(1))]})
        pair = [propagated(scene, method, 1e-15, [200.0]) for method in ("taylor", "exact")]
        error = max(largest(pair[0].quaternion, pair[1].quaternion, sign=True),
                    largest(pair[0].omega, pair[1].omega) / spin)  # fmt: skip
        found.append(Figure("taylor", f"spin {spin}, t = 200", 1e-13, error))
    return found

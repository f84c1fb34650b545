"""Stress tests F1 to F8: cases in which a stepper was or could be wrong, by every method that applies."""

import math

import numpy as np

from symrot.ensemble.ensemble import propagate_ensemble
from symrot.propagation.propagate import propagator
from tests.reference.figures import Figure, apart, body, largest, propagated
from tests.reference.stress_stepping import Stepped

FREE, RATES, TIMES = (1, 2, 3), ("3/10", "1", "1/2"), np.array([0.5, 3.0, 20.0])
ARM = [{"kind": "gravity", "weight": 1, "center_of_mass": ["1/10", "1/5", "9/10"]}]
UPRIGHT, HANGING = {"quaternion": [1, 0, 0, 0]}, {"quaternion": [0, 1, 0, 0]}
STEPPERS, METHODS = ("taylor", "dop853"), ("exact", "taylor", "dop853")


def f1(long):
    """Near steady rotation, energy and momentum hardly differ: a projection that drops one may put noise into the
    rates.
    """
    found, times = [], np.array([1e3, 1e4])
    for tilt in ("1/10", "1/1000", "1/100000"):
        scene = body((1, "3/2", "1.5000001"), (tilt, 0, 1))
        stepped, exact = Stepped(scene), propagated(scene, "exact", 1e-15, times)
        errors = [largest(stepped.at(times, every=every)[0][:, :3], exact.omega) for every in (16, 0)]
        title = f"omega, w = ({tilt}, 0, 1), over that without, 1e-13 at least"
        found.append(Figure("taylor, projected", title, 1, errors[0] / max(errors[1], 1e-13)))
    return found


def f2(long):
    """Units of time and mass, to the limits of scenes."""
    found, reference = [], propagator(body((2, 3, 4), RATES), "exact")(TIMES)
    for method in METHODS:
        worst = 0.0
        for moment, rate in (("1", "1e-99"), ("1", "1e99"), ("1e-99", "1"), ("2e99", "1e99"), ("1e-99", "1e-90")):
            scene = body([float(moment) * m for m in (2, 3, 4)], [float(rate) * w for w in (0.3, 1.0, 0.5)])
            other = propagator(scene, method, 1e-12)(TIMES / float(rate))
            worst = max(worst, largest(other.quaternion, reference.quaternion, sign=True),
                        largest(other.omega / float(rate), reference.omega))  # fmt: skip
        found.append(Figure(method, "rates 1e-99 to 1e99, moments 2e-99 to 8e99", 1e-11, worst))
    return found


def f3(long):
    """Motions from rest, or nearly, by a torque: the rates at the start give no hint of the step."""
    found, scene, t = [], body(FREE, (0, 0, 0), ARM), [5.0]
    still = propagator(scene, "taylor", 1e-14)(t)
    for method in STEPPERS:
        stepper, worst = propagator(scene, method, 1e-12), 0.0
        for size in (0.0, 1e-300, 1e-40, 1e-20):
            starts = [[size, 0, 0], [0, -size, size]]
            alone = [stepper(t, omega=start) for start in starts]
            crowd = propagate_ensemble(scene, omega=starts, t=t, method=method, tolerance=1e-12)
            for each, rates in zip(alone, crowd.omega, strict=True):
                worst = max(worst, largest(each.omega, still.omega), largest(rates, still.omega))
        found.append(Figure(method, "omega from 0 and 1e-300 to 1e-20, alone and in ensembles", 1e-11, worst))
    return found


def f4(long):
    """Times before and after the start, repeated, unsorted, or next to it give the results of sorted times; no times
    give none.
    """
    found = []
    times = np.array([3, -1, 3, 0, 0, 9, math.nextafter(3, 4), -1, 5e-324, -5e-324, 1e-310, 3])
    order = np.argsort(times, kind="stable")
    for method in METHODS:
        stepper = propagator(body(FREE, RATES), method, 1e-12)
        mixed, sorted_ = stepper(times), stepper(times[order])
        found.append(
            Figure(method, "numbers that depend on the order of times", 0, int((mixed.y[:, order] != sorted_.y).sum()))
        )
        start = stepper([0.0]).y
        near = max(float(np.abs(stepper([each]).y - start).max()) for each in (5e-324, -1e-310, 2.0**-60))
        found.append(Figure(method, "change over 5e-324 to 2^-60 s", 4 * 2.0**-53, near))
        found.append(Figure(method, "rows for no times", 0, len(stepper([]).omega)))
    return found


def f5(long):
    """Needles, a million million times longer than thick."""
    found, t = [], np.array([0.1, 1.0, 5.0])
    for moments in (("1e-12", 1, 1), (1, 1, "1e-12"), ("1e-12", 1, "1.0000000000005")):
        scene = body(moments, RATES)
        exact = propagated(scene, "exact", 1e-15, t)
        for method in STEPPERS:
            found.append(Figure(method, f"moments {moments}, tolerance 1e-10", 1e-9,
                                apart(propagated(scene, method, 1e-10, t), exact)))  # fmt: skip
    return found


def f6(long):
    """Motions that start exactly at equilibria, the unstable ones too, must stay there."""
    found = []
    for method in STEPPERS:
        pushed = 0.0
        for attitude in (UPRIGHT, HANGING):
            for moments, spin in (((1, 1, "1/2"), 0), ((1, 1, "1/2"), 3), ((1, "3/2", "7/10"), 3)):
                torque = [{"kind": "gravity", "weight": 1, "center_of_mass": [0, 0, 1]}]
                y = propagated(body(moments, (0, 0, spin), torque, attitude), method, 1e-10, [1.0, 100.0])
                tilted = y.quaternion[:, [1, 2] if attitude is UPRIGHT else [0, 3]]
                pushed = max(pushed, float(np.abs(tilted).max()), largest(y.omega, [[0, 0, spin]] * 2))
        found.append(Figure(method, "tilt and rates gained, t = 100", 0, pushed))
    return found


def f7(long):
    """Euler angles as states, from attitudes in exact gimbal lock."""
    found, t = [], np.array([0.0, 0.1, 1.0, 5.0])
    for method in STEPPERS:
        worst = 0.0
        for nutation in (0, "pi", "1/100000000"):
            for torque in ((), ARM):
                attitude = {"sequence": "ZXZ", "angles": ["1/5", nutation, "3/10"]}
                scene = body(FREE, ("1/5", "2/5", 1), torque, attitude)
                angles = propagated(scene, method, 1e-10, t, state="ZXZ")
                worst = max(worst, apart(angles, propagated(scene, "taylor", 1e-14, t)))
        found.append(Figure(method, "ZXZ as state, started locked, tolerance 1e-10", 1e-9, worst))
    return found


def f8(long):
    """A torque that switches exactly at a sample time, declared once, twice, at the start or outside the span."""
    scene, worst = body((1, 1, 1), (0, 0, 0), attitude=UPRIGHT), 0.0
    t = np.array([0, 0.5, 1.0, math.nextafter(1, 2), math.nextafter(1, 0), 2.0, 3.0, -0.5])

    def torque(now, omega, quaternion):
        return (0.0, 0.0, 1.0 if now < 1.0 else -1.0)

    for switches in ([1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 1.0], [-1.0, 1.0, 5.0]):
        trajectory = propagator(scene, tolerance=1e-12, torque=torque, switching_times=switches)(t)
        worst = max(worst, largest(trajectory.omega[:, 2], np.where(t <= 1.0, t, 2.0 - t)))
    return [Figure("dop853", "omega, five ways of declaring the switch", 1e-12, worst)]

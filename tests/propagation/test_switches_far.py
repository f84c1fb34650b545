"""Switches far from t = 0, where doubles lie far apart, are located to twice the digits of a double, and motions go on
from there.
"""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import symrot
from symrot.propagation.switched.instant import Instant
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853", "scipy:DOP853"]
THIRD = Fraction(3, 10)


def scene(torque, start, stop, tolerance=1e-12, omega="1/10"):
    content = {
        "schema": 1, "body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 0, omega]},
        "span": {"t": [start, stop]}, "torque": [{"kind": "expression", "torque": ["0", "0", torque]}],
        "accuracy": {"tolerance": tolerance},
    }  # fmt: skip
    return symrot.Scene.from_dict(content)


def ramp(t, start):
    """Return the impulse of step(t - start - 3/10)."""
    return max(t - start - THIRD, Fraction(0))


def saw(t, start):
    """Return the impulse of mod(t, 3/10), up to a constant."""
    whole = t // THIRD
    return whole * THIRD**2 / 2 + (t - whole * THIRD) ** 2 / 2


def waves(t, start):
    """Return the impulse of sign(sin(t)): in each half wave it rises or falls by turns."""
    with mpmath.workdps(50):
        time = mpmath.mpf(t.numerator) / t.denominator
        half = mpmath.floor(time / mpmath.pi)
        rest = time - half * mpmath.pi
        return Fraction(str(rest if half % 2 == 0 else mpmath.pi - rest))


@pytest.mark.thinned(4)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("torque", "impulse"), [("step(t-{}-3/10)", ramp), ("mod(t, 3/10)", saw), ("sign(sin(t))", waves)],
    ids=["step", "mod", "sign"],
)  # fmt: skip
@pytest.mark.parametrize("start", [10**6, 10**9, 10**12])
def test_the_momentum_is_the_impulse_however_late_it_is(method, torque, impulse, start):
    motion = symrot.propagator(scene(torque.format(start), start, start + 4), method)
    times = np.concatenate([start + np.linspace(0, 4, 9), start + np.array([0.123, 0.31, 1.777, 2.9])])
    trajectory = motion(times)
    for rates, when in ((trajectory.omega[:, 2], times), (trajectory.sol(times)[2], times)):
        for rate, t in zip(rates, when, strict=True):
            true = Fraction(1, 10) + (impulse(Fraction(t), start) - impulse(Fraction(start), start)) / 3
            assert abs(Fraction(rate) - true) <= 20 * Fraction(1e-12) * max(abs(true), Fraction(1, 10)), t


@needs_compiler
@pytest.mark.parametrize(("torque", "impulse"), [
    ("sign(1/(t-2)-1)", -8), ("sign(exp(1/(t-2))-2)", 2 / math.log(2) - 10), ("sign(1/(t-1))", 8),
    ("sign(1/(1+exp(1/(t-2)))-1/2)", -6), ("step(atan((t-1)/(t-2)))", 9),
])  # fmt: skip
def test_a_sign_changes_at_a_pole_and_at_a_jump_of_its_argument(torque, impulse):
    """A pole and a zero in one step cancelled: the torque kept its sign, without a word."""
    trajectory = symrot.propagate(scene(torque, 0, 10, omega=0))
    assert trajectory.omega[-1, 2] == pytest.approx(impulse / 3, rel=1e-10)


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_a_short_pulse_after_a_long_rest_has_its_impulse(method):
    """A millisecond after 1e6 s, where doubles lie 1e-10 s apart; the ends of the pulse are known better than that."""
    pulse = "step(t-1000000-1/3) - step(t-1000000-1/3-1/1000)"
    motion = symrot.propagator(scene(pulse, 0, 1_000_001, omega=0), method)
    assert motion([1_000_001]).omega[-1, 2] == pytest.approx(1e-3 / 3, rel=2e-11)


@needs_compiler
def test_a_sample_at_the_double_next_to_a_switch_is_on_its_own_side():
    """The switch lies between two doubles: samples at both are right, and dense output around them is too."""
    start = 10**9
    trajectory = symrot.propagator(scene(f"1000*step(t-{start}-3/10)", start, start + 1), "taylor")
    near = float(start) + 0.3
    times = np.array([np.nextafter(near, 0), near, np.nextafter(near, 2 * near)])
    true = [0.1 + float(1000 * ramp(Fraction(t), start) / 3) for t in times]
    assert trajectory(times).omega[:, 2] == pytest.approx(true, rel=2e-11)
    assert trajectory([start + 1]).sol(times)[2] == pytest.approx(true, rel=2e-11)
    assert trajectory(times[::-1]).omega[:, 2] == pytest.approx(true[::-1], rel=2e-11)


@needs_compiler
def test_events_between_switches_far_from_zero_are_found():
    """omega_3 = 1/10 + (t - t0)^2/6 on the first tooth of the saw; later teeth follow."""
    start = 3 * 10**8
    trajectory = symrot.propagate(
        scene("mod(t, 3/10)", start, start + 1), method="taylor", events=["omega_3 - 0.11", "t - 300000000.5"]
    )
    assert trajectory.t_events[0] - start == pytest.approx([(6 * 0.01) ** 0.5], abs=1e-7)
    assert trajectory.y_events[0][0][2] == pytest.approx(0.11, abs=1e-8)
    assert list(trajectory.t_events[1]) == [300000000.5]


def test_an_instant_keeps_twice_the_digits():
    instant = Instant(1e9).after(0.1).after(1e-12, -0.1)
    assert abs(instant.exact - (10**9 + Fraction(1e-12))) < Fraction(1, 10**22)
    assert instant.since(np.array([1e9, 1e9 + 1])) == pytest.approx([-1e-12, 1 - 1e-12], rel=1e-9)


@pytest.mark.parametrize(("low", "side", "count"), [(1e-9, 1.0, 2), (0.0, 1.0, 2), (-1e-9, 1.0, 1), (1e-9, -1.0, 1)])
def test_times_that_an_instant_has_reached(low, side, count):
    times = np.array([1e8 - 1, 1e8, 1e8 + 1])[:: int(side)]
    assert Instant(1e8, low).reached(times, side) == count

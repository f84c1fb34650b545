"""Exact motions without a C compiler: constants by mpmath and samples by NumPy, compared with C, which shares no code."""

import sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symrot.closed_form import build as library
from symrot.closed_form.axial import motion as axial
from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.gyrostat import motion as gyrostat
from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.errors import InputError
from symrot.formula.exact_functions import EXACT_FUNCTIONS
from symrot.inertia.principal import principal_axes
from symrot.propagation.propagate import propagator

Q0 = (0.1, 0.7, -0.5, 0.5)
BAR = 1e-15  # of q; of omega relative to the largest: each side is within 5e-16 of the motion
TENSOR = [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 4]]
TOP, ABOVE = (1.0, 1.0, 0.5), (0.0, 0.0, 1.0)
CASES = {
    "axes renamed": lambda: free_body.motion((3, 1, 2), (-0.3, 1, 0.5), Q0),
    "outer axis": lambda: free_body.motion((1.0, 2.0, 3.0), (0.3, 1.0, 1.5), Q0),
    "flips": lambda: free_body.motion((1.0, 2.0, 3.0), (0.01, 1.0, 0.01), Q0),
    "near the separatrix": lambda: free_body.motion((1.0, 2.0, 3.0), (1e-9, 1.0, 1e-9), Q0),
    "on the separatrix": lambda: free_body.motion((3.0, 4.0, 6.0), (2.0, -1.5, 1.0), Q0),
    "symmetric": lambda: free_body.motion((1.0, 1.0, 2.0), (0.3, 1.0, 0.5), Q0),
    "steady": lambda: free_body.motion((3.0, 1.0, 1.0), (0.0, 0.2, 0.5), Q0),
    "at rest": lambda: free_body.motion((3.0, 1.0, 2.0), (0.0, 0.0, 0.0), Q0),
    "nearly spherical": lambda: free_body.motion((1.0, 1 + 1e-10, 1 + 3e-10), (0.3, 1.0, 0.5), Q0),
    "exact numbers": lambda: free_body.motion((Fraction(1, 3), Fraction(2, 3), 1), (Fraction(1, 7), 1, 2), Q0),
    "full tensor": lambda: free_body.FreeRigidBody(principal_axes(TENSOR)).motion((0.3, 1, 0.5), Q0),
    "nutation": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.3, -1.8, 4.0), (0.9, 0.3, 0.0, 0.1)),
    "nearly upright": lambda: heavy_top.motion((1, 1, 0.3), 2.5, ABOVE, (0, 0.7, 1), (1, -8e-5, 8e-4, 0.3)),
    "very nearly upright": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (1e-25, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
    "weak pull": lambda: heavy_top.motion(TOP, 1e-60, ABOVE, (0.3, -1.8, 0.4), (0.9, 0.3, 0.0, 0.1)),
    "pendulum": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 1.0, 0.0), (0.9, 0.1, 0.3, 0.0)),
    "plane separatrix": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (2.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)),
    "through the vertical": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (2.5, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0)),
    "sleeping": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 4.5), (1.0, 1e-5, 0.0, 0.0)),
    "waking": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 3.9), (1.0, 1e-5, 0.0, 0.0)),
    "hanging": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 2.0), (1e-4, 1.0, 0.0, 0.0)),
    "upright": lambda: heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 5.0), (1.0, 0.0, 0.0, 0.0)),
    "another axis": lambda: heavy_top.motion((0.5, 1, 1), 1, (1, 0, 0), (4, 0.3, 0.8), Q0, (0, 1, -2)),
    "gyrostat": lambda: gyrostat.motion((2, 1, 1), (-1, 0, 0), (0.3, 1, 0.5), Q0),
}
TIMES = np.concatenate([np.linspace(-20.0, 50.0, 141), [0.0, 1e3, 1e6]])


@pytest.mark.parametrize("compiler", ["cc", "no such compiler"])
def test_a_start_too_near_to_an_unstable_one_is_refused(compiler, monkeypatch):
    """A tilt of 1e-30 rad grows to 1e-3 rad in 60 s; it was taken for zero, so that the top never fell."""
    monkeypatch.setenv("CC", compiler)
    monkeypatch.setattr(library, "_loaded", {})
    upright = (1.0, 0.0, 0.0, 0.0)
    for rate in (1e-30, 1e-33, 1e-300):
        with pytest.raises(InputError, match="1e-29 rad of the unstable upright position"):
            heavy_top.motion(TOP, 1.0, ABOVE, (rate, 0.0, 0.0), upright)
        with pytest.raises(InputError, match="1e-29 rad of the unstable upright position"):
            heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 3.0), (1.0, 0.0, rate, 0.0))
        fast = heavy_top.motion(TOP, 1.0, ABOVE, (rate, 0.0, 5.0), upright)  # stable
        assert np.abs(fast.evaluate([100.0])[1][0, 1:3]).max() < 1e-29
    assert heavy_top.motion(TOP, 1.0, ABOVE, (0.0, 0.0, 3.0), upright).regime == "steady"
    for omega in [(1e-160, 1.0, 0.0), (1e-160, 1.0, -1e-170)]:
        with pytest.raises(InputError, match="the middle axis exactly"):
            free_body.motion((1.0, 2.0, 3.0), omega, upright)
    for omega in [(0.0, 1.0, 0.0), (1e-160, 0.0, 1.0), (1.0, 0.0, 1e-160)]:
        assert free_body.motion((1.0, 2.0, 3.0), omega, upright).regime == "steady"


@pytest.mark.parametrize(
    ("rate", "times"), [(1e-20, (10, 40, 50, 80)), (1e-25, (10, 60, 90)), (2e-29, (10, 60, 70, 80))]
)
def test_a_top_falls_from_near_the_vertical_when_the_pendulum_does(rate, times):
    """sin(theta/2) = cn(K - t/k) with k^2 = 1/(1 + (rate/2)^2), for pull and moment 1, started upright."""
    with mpmath.workdps(120):
        across = mpmath.mpf(rate) / 2
        m = 1 / (1 + across**2)
        start = mpmath.ellipk(m)
        expected = [float(mpmath.ellipfun("cn", start - t * mpmath.sqrt(1 + across**2), m=m)) for t in times]
    motion = heavy_top.motion((1.0, 1.0, 0.5), 1.0, ABOVE, (rate, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    found = motion.evaluate(np.array(times, dtype=float))[1][:, 1]
    assert np.abs(found - expected).max() < 1e-14


@pytest.mark.parametrize("compiler", ["cc", "no such compiler"])
@pytest.mark.parametrize("digits", [12, 20, 30, 45, None])
@pytest.mark.parametrize("rate", [1, -1])
def test_a_pendulum_passes_the_top_or_stays_there(rate, digits, compiler, monkeypatch):
    """cos(theta/2) = -sn(u), and -tanh(u) for the pull 5/4, on the separatrix (digits None).

    At 2 arctan(1/2) from the top, the rate 1 is enough to reach it for this pull. Numbers of 31 digits gave a body that
    fell after 40 s.
    """
    monkeypatch.setenv("CC", compiler)
    monkeypatch.setattr(library, "_loaded", {})
    pull = Fraction(5, 4) - (Fraction(1, 10**digits) if digits else 0)
    motion = heavy_top.motion((1, 1, Fraction(1, 2)), pull, ABOVE, (rate, 0, 0), (2, 1, 0, 0))
    times = [0.0, 10.0, 40.0, 80.0, 200.0]
    with mpmath.workdps(120):
        weight, energy = mpmath.mpf(pull.numerator) / pull.denominator, mpmath.mpf(1) / 2
        energy += weight * 3 / 5
        speed, m, start = mpmath.sqrt((energy + weight) / 2), 2 * weight / (energy + weight), -2 / mpmath.sqrt(5)
        first = mpmath.ellipf(mpmath.asin(start), m) if digits else mpmath.atanh(start)
        turned = [first + rate * speed * t for t in times]
        expected = [float(-(mpmath.ellipfun("sn", u, m=m) if digits else mpmath.tanh(u))) for u in turned]
    assert motion.evaluate(times)[1][:, 0] == pytest.approx(expected, abs=1e-15)


@pytest.fixture
def no_compiler(monkeypatch):
    """Imitate a machine without a C compiler and without loaded libraries."""
    monkeypatch.setenv("CC", "no such compiler")
    monkeypatch.setattr(library, "_loaded", {})


@pytest.mark.parametrize("name", CASES)
def test_numpy_returns_what_c_returns(name, monkeypatch):
    compiled = CASES[name]()
    monkeypatch.setenv("CC", "no such compiler")
    monkeypatch.setattr(library, "_loaded", {})
    portable = CASES[name]()
    assert type(portable) is not type(compiled) and portable.regime == compiled.regime
    (w, q), (rates, attitudes) = compiled.evaluate(TIMES), portable.evaluate(TIMES)
    assert np.abs(w - rates).max() <= BAR * max(np.abs(w).max(), 1e-300)
    assert np.abs(q - attitudes).max() <= BAR
    alone = portable.evaluate(TIMES, quaternion=False), portable.evaluate(TIMES, omega=False)
    assert alone[0][1] is None and np.array_equal(alone[0][0], rates)
    assert alone[1][0] is None and np.array_equal(alone[1][1], attitudes)


def test_motions_in_several_threads_are_those_of_one(no_compiler):
    """Each thread changes the precision of mpmath; one that ended took the digits of the others."""

    def attitudes(k):
        top = heavy_top.motion(TOP, 1.0, ABOVE, (10.0**-k, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0))
        body = free_body.motion((1.0, 2.0, 3.0), (10.0**-k, 1.0, 10.0**-k), Q0)
        turned = axial.motion((1, 2, 3), 2, Fraction(k), (0, 0, 1))
        value = EXACT_FUNCTIONS["exp"](Fraction(k))
        return *(motion.evaluate([40.0, 1e12])[1].tolist() for motion in (top, body, turned)), value

    digits, interval, cases = mpmath.mp.dps, sys.getswitchinterval(), range(1, 21)
    expected = [attitudes(k) for k in cases]
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(4) as pool:
            assert list(pool.map(attitudes, cases)) == expected
    finally:
        sys.setswitchinterval(interval)
    assert mpmath.mp.dps == digits


def test_huge_times(no_compiler):
    """Phases have 31 digits, so at 1e15 s the attitude is as accurate as at the start."""
    found = free_body.motion((1, 1, 2), (0.3, 1.0, 0.5), Q0).evaluate([1e9, 1e15])[1]
    expected = gyrostat.motion((1, 1, 2), (0, 0, 0), (0.3, 1.0, 0.5), Q0).evaluate([1e9, 1e15])[1]
    assert np.abs(np.abs((found * expected).sum(axis=1)) - 1).max() < BAR


def test_auto_stays_exact_without_a_compiler(no_compiler):
    for name in ("tumbling_prism", "heavy_top_loops"):
        made = propagator(name)
        assert made.method == "exact"
        assert max(item.drift for item in made().invariants) < 1e-14
    assert propagator("gravity_gradient_satellite").method == "scipy"


@pytest.mark.parametrize("make", [
    lambda: free_body.motion((1, -1, 2), (0, 0, 1)), lambda: heavy_top.motion((-1, -1, 1), 1, (0, 0, 1), (0, 0, 1)),
    lambda: free_body.motion((1, 1, 2), (0, 0, 1), (0, 0, 0, 0)), lambda: gyrostat.motion((-1, -1, 1), (0, 0, 1), (0, 0, 1)),
])  # fmt: skip
def test_bad_input_is_refused_in_the_same_words(make, no_compiler):
    with pytest.raises(InputError, match="positive"):
        make()


def test_rotation_about_one_axis_needs_no_compiler(no_compiler):
    assert axial.motion((1, 2, 3), 2, 1, (0, 0, 1)).evaluate([2.0])[0][0, 2] == pytest.approx(1 + 2 / 3)

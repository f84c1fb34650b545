"""The stepper DOP853 keeps its promises: order, accuracy, sampling, direction, limits.

Kernels are written by hand here; references are closed forms and a Taylor series in 50 digits that shares nothing with
the code under test.
"""

import math
import re
import shutil
import signal
import subprocess
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from symrot.build import cache as library
from symrot.errors import CompilerError, InputError, PropagationError
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import dop853
from symrot.scene.scene import Scene
from tests.reference.tops import MOTIONS, RIGID_BODY, TIMES, error, parameters, state, taylor, wave

pytestmark = pytest.mark.usefixtures("quick_compiler")


@cache
def built(kernel, name, states, parameters, blocks, scales):
    return library.build(dop853.translation_unit(kernel, name, states, parameters, blocks, scales), name)


def body():
    return built(RIGID_BODY, "rigid_body", 7, 6, (0, 3, 7), (0.0, 1.0))


def small(text, states, parameters=1, scale=1.0):
    """Return a library for a kernel of a few states in one block, given as C statements."""
    signature = "static inline void rate(double t, const double *y, const double *p, double *dy)"
    kernel = f"#include <math.h>\n{signature} {{ (void)t; (void)y; (void)p; {text} }}\n"
    return built(kernel, "rate", states, parameters, (0, states), (scale,))


# ------------------------------------------------------------------------------------------------ accuracy


@pytest.mark.thinned(8)
@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_error_of_the_trajectory_stays_near_the_tolerance(name, tolerance):
    """Here it is at most 5 times the tolerance; the bound 8 leaves room for the rounding of other processors."""
    states, _ = dop853.integration(body(), parameters(name), MOTIONS[name][2], 0.0, tolerance).sample(TIMES)
    assert error(states, taylor(name)) < 8 * tolerance


@pytest.mark.parametrize("tolerance", [1e-3, 1e-7, 1e-11])
def test_a_symmetric_body_follows_its_closed_form(tolerance):
    """omega turns about the axis at (C - A)/A w3; the attitude is a turn about L times a turn about the axis."""
    a, c, w1, w3 = 0.6375, 0.075, 1.0, 1.0
    t = np.linspace(0.0, 20.0, 101)
    states, _ = dop853.integration(body(), (a, a, c, 0, 0, 0), state((w1, 0, w3)), 0.0, tolerance).sample(t)
    rate = (c - a) / a * w3
    size = math.hypot(a * w1, c * w3)
    about_l = np.array([np.cos(size / a * t / 2), *(np.sin(size / a * t / 2) * x / size for x in (a * w1, 0, c * w3))])
    about_axis = np.array([np.cos(rate * t / 2), 0 * t, 0 * t, -np.sin(rate * t / 2)])
    (p0, p1, p2, p3), (r0, _, _, r3) = about_l, about_axis
    q = np.array([p0 * r0 - p3 * r3, p1 * r0 + p2 * r3, p2 * r0 - p1 * r3, p3 * r0 + p0 * r3])
    exact = np.array([w1 * np.cos(rate * t), w1 * np.sin(rate * t), w3 + 0 * t, *q]).T
    assert error(states, exact) < 5 * tolerance


@pytest.mark.parametrize("speed", [1.0, 1e3, 1e6])
def test_a_fast_spin_does_not_hide_the_error_of_the_attitude(speed):
    """S17: one norm for omega and attitude would let the attitude err by the speed times the tolerance."""
    moments, start = (1.0, 1.5, 2.0, 0, 0, 0), state((1e-3, 1e-3, speed))
    times = np.linspace(0.0, 1000.0 / speed, 21)
    states, _ = dop853.integration(body(), moments, start, 0.0, 1e-9).sample(times)
    exact, _ = dop853.integration(body(), moments, start, 0.0, 1e-13).sample(times)
    assert error(states, exact) < 5e-9
    assert abs(np.linalg.norm(states[:, 3:], axis=1) - 1).max() < 1e-8


def test_the_unit_of_time_does_not_matter():
    """The same motion a thousand times slower takes the same steps: the stepper contains no fixed number of seconds."""
    costs, attitudes = set(), []
    for speed in (1e-5, 1.0, 1e5):
        start = state((0.3 * speed, 1.0 * speed, 0.5 * speed))
        states, stats = dop853.integration(body(), (1, 2, 3, 0, 0, 0), start, 0.0, 1e-9).sample([20.0 / speed])
        costs.add(stats.accepted)
        attitudes.append(states[0, 3:])
    assert max(costs) - min(costs) <= 1
    assert np.ptp(attitudes, axis=0).max() < 1e-12


def test_a_pendulum_swings_through_rest():
    """omega vanishes at every turning point; judged by its current size alone, steps would become tiny there."""
    moments, arm = (1.0, 1.0, 0.1), (0, 0, -5.0)
    states, stats = dop853.integration(body(), (*moments, *arm), state((0, 0, 0), 1.0), 0.0, 1e-9).sample([40.0])
    w, q = states[0, :3], states[0, 3:]
    energy = 0.5 * w[0] ** 2 - 5.0 * (1 - 2 * (q[1] ** 2 + q[2] ** 2) / (q @ q))
    assert abs(energy + 5.0 * math.cos(1.0)) < 1e-7
    assert stats.accepted < 1000


def test_a_body_at_rest_stays_at_rest_in_a_few_steps():
    states, stats = dop853.integration(body(), (1, 2, 3, 0, 0, 0), state((0, 0, 0)), 0.0, 1e-12).sample([1.0, 1e6])
    assert np.array_equal(states, [state((0, 0, 0))] * 2)
    assert stats.accepted < 20


@pytest.mark.parametrize("stop", [3.0, -3.0])
def test_the_order_of_the_step_is_8(stop):
    """S25: a step half as long makes 2^-8 of the error."""
    name = "asymmetric top"
    start, errors = MOTIONS[name][2], []
    exact, _ = dop853.integration(body(), parameters(name), start, 0.0, 1e-13).sample([stop])
    for count in (10, 20, 40):
        found, stats = dop853.integration(
            body(), parameters(name), start, 0.0, 0.99, max_step=abs(stop) / count
        ).sample([stop])
        assert stats.rejected == 0
        assert count <= stats.accepted <= count + 2
        errors.append(abs(found - exact).max())
    for coarse, fine in pairwise(errors):
        assert 7.5 < math.log2(coarse / fine) < 8.7


def test_the_dense_output_is_as_good_as_the_steps():
    """S39: between the ends of steps the error is at most twice that at the ends; its order is 7, as in theory."""
    name = "asymmetric top"
    start = MOTIONS[name][2]
    for tolerance in (1e-5, 1e-9):
        solution = dop853.integration(body(), parameters(name), start, 0.0, tolerance).record((0.0, 20.0))
        times = np.linspace(0.0, 20.0, 5001)
        exact, _ = dop853.integration(body(), parameters(name), start, 0.0, 1e-13).sample(times)
        assert error(solution(times), exact) < 5 * tolerance
    middles = []
    for count in (5, 10, 20):
        h = 2.0 / count
        times = np.linspace(0.0, 2.0, 16 * count + 1)
        exact, _ = dop853.integration(body(), parameters(name), start, 0.0, 1e-13).sample(times)
        found, _ = dop853.integration(body(), parameters(name), start, 0.0, 0.99, max_step=h).sample(times)
        middles.append(abs(found - exact).max())
    for coarse, fine in pairwise(middles):
        assert math.log2(coarse / fine) > 7.0


@pytest.mark.shipped_flags
def test_rounding_does_not_pile_up():
    """S28: a million additions of 1e-4 end within 3e-14 of 100; -ffast-math would break this and is not used."""
    path = small("dy[0] = p[0];", 1)
    states, stats = dop853.integration(path, [0.1], [0.0], 0.0, 1e-6, max_step=1e-3).sample([1000.0])
    assert stats.accepted >= 1_000_000
    assert abs(states[0, 0] - 100.0) < 3e-14
    assert not any("fast-math" in flag or "unsafe" in flag for flag in library.FLAGS)


# ------------------------------------------------------------------------------------------------ sampling and
# direction


OSCILLATOR = "dy[0] = y[1]; dy[1] = -y[0];"


@pytest.mark.parametrize("t0", [0.0, 2.5, -7.0])
def test_samples_lie_anywhere_in_any_order(t0):
    path = small(OSCILLATOR, 2)
    times = np.array([3.0, -2.0, t0, 3.0, 0.1, 11.0, t0, -9.5, 1e-9])
    states, _ = dop853.integration(path, [0.0], wave(np.array([t0]))[0], t0, 1e-11).sample(times)
    assert states.shape == (9, 2)
    assert states.flags["C_CONTIGUOUS"]
    assert abs(states - wave(times)).max() < 1e-10
    assert np.array_equal(states[2], wave(np.array([t0]))[0])
    assert np.array_equal(states[2], states[6])
    assert np.array_equal(states[0], states[3])


def test_the_steps_do_not_depend_on_the_samples():
    path = small(OSCILLATOR, 2)
    few, one = dop853.integration(path, [0.0], [1.0, 0.0], 0.0, 1e-9).sample([50.0])
    many, other = dop853.integration(path, [0.0], [1.0, 0.0], 0.0, 1e-9).sample(np.linspace(0.0, 50.0, 3001))
    assert (one.accepted, one.rejected) == (other.accepted, other.rejected)
    assert np.array_equal(few[-1], many[-1])
    assert other.evaluations == one.evaluations + 3 * one.accepted


def test_no_samples_and_a_span_of_no_length():
    path = small(OSCILLATOR, 2)
    states, stats = dop853.integration(path, [0.0], [1.0, 0.0], 0.0, 1e-9).sample([])
    assert states.shape == (0, 2)
    assert stats.evaluations == 0
    states, stats = dop853.integration(path, [0.0], [1.0, 0.0], 4.0, 1e-9).sample([4.0, 4.0])
    assert np.array_equal(states, [[1.0, 0.0]] * 2)
    assert stats.accepted == 0
    states, _ = dop853.integration(path, [0.0], [1.0, 0.0], 1.0, 1e-9).sample([math.nextafter(1.0, 2.0)])
    assert np.allclose(states, [[1.0, 0.0]], atol=1e-15)


def test_backward_returns_to_the_start():
    name = "asymmetric"
    there, _ = dop853.integration(body(), parameters(name), MOTIONS[name][2], 0.0, 1e-11).sample([20.0])
    back, _ = dop853.integration(body(), parameters(name), there[0], 20.0, 1e-11).sample([0.0])
    assert abs(back[0] - MOTIONS[name][2]).max() < 1e-10


def test_pauses_change_nothing(monkeypatch):
    """A call of the C function returns after a set number of steps; the next call goes on from there bit for bit."""
    arguments, times = (
        (body(), parameters("asymmetric"), MOTIONS["asymmetric"][2], 0.0, 1e-9),
        np.linspace(0.0, 30.0, 77),
    )
    whole, stats = dop853.integration(*arguments).sample(times)
    monkeypatch.setattr(dop853._Stepper, "steps_per_call", 3)
    parts, others = dop853.integration(*arguments).sample(times)
    assert np.array_equal(whole, parts)
    assert stats[:3] == others[:3]


def test_a_recording_is_the_motion_itself(monkeypatch):
    name, times = "asymmetric top", np.linspace(-5.0, 12.0, 301)
    arguments = (body(), parameters(name), MOTIONS[name][2], 0.0, 1e-9)
    solution = dop853.integration(*arguments).record((-5.0, 12.0))
    sampled, _ = dop853.integration(*arguments).sample(times)
    assert abs(solution(times) - sampled).max() < 1e-14
    assert np.array_equal(solution(0.0), MOTIONS[name][2])
    assert solution(3.0).shape == (7,)
    assert solution(times[::-1].reshape(7, 43)).shape == (7, 43, 7)
    assert np.array_equal(solution(times[::-1])[::-1], solution(times))
    monkeypatch.setattr(dop853._Stepper, "rows_per_call", 2)
    assert np.array_equal(dop853.integration(*arguments).record((-5.0, 12.0))(times), solution(times))
    with pytest.raises(InputError, match=r"expected times from -5.0 to 12.0 s, where the motion is known, got 12.5 s"):
        solution([1.0, 12.5])


@pytest.mark.parametrize("stop", [3.0, -3.0])
def test_a_switching_time_costs_no_order(stop):
    """S42: the rate jumps inside a step; the stepper restarts there and meets the exact solution on both sides."""
    side = math.copysign(1.0, stop)
    path = small("dy[0] = t*p[0] >= 1.0 ? 2.0*y[0] : -y[0];", 1)
    exact = math.exp(-1.0 + 2.0 * 2.0) if side > 0 else math.exp(1.0 - 2.0 * 2.0)
    before = math.exp(-side * 0.5)
    times = [0.0, 0.5 * side, 1.0 * side, stop]
    rate = [side]
    y = 1.0
    states, _ = dop853.integration(path, rate, [y], 0.0, 1e-12, breaks=[1.0 * side, 77.0]).sample(times)
    assert states[:, 0] == pytest.approx([1.0, before, math.exp(-side), exact], rel=2e-12)
    solution = dop853.integration(path, rate, [y], 0.0, 1e-12, breaks=[1.0 * side]).record((0.0, stop))
    assert solution(stop)[0] == pytest.approx(exact, rel=2e-12)
    _, blind = dop853.integration(path, rate, [y], 0.0, 1e-10).sample(times)
    _, restarted = dop853.integration(path, rate, [y], 0.0, 1e-10, breaks=[1.0 * side]).sample(times)
    assert 2 * restarted.evaluations < blind.evaluations


# ------------------------------------------------------------------------------------------------ limits


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "text, start, stop, reason",
    [
        ("dy[0] = sqrt(1.0 - t);", 0.0, 2.0, r"not finite"),
        ("dy[0] = 0.0/(y[0] - y[0]);", 1.0, 2.0, r"beyond t = 0.0 s on the way to 2.0 s: .* not finite"),
        ("dy[0] = y[0]*y[0];", 1.0, 2.0, r"beyond t = (0.99|1.0)"),
        ("dy[0] = y[0] > 0.5 ? -1.0 : 1.0;", 1.0, 2.0, r"beyond t = 0.[45].*(step shrank|not enough)"),
    ],
    ids=["leaves the domain", "nothing from the start", "pole", "sliding on a jump"],
)
def test_a_motion_that_ends_says_where_and_why(text, start, stop, reason):
    with pytest.raises(PropagationError, match=reason) as caught:
        dop853.integration(small(text, 1), [0.0], [start], 0.0, 1e-9, max_steps=100_000).sample([stop])
    assert str(caught.value).count("\n") == 0


def test_too_many_steps_are_refused():
    with pytest.raises(PropagationError, match=r"beyond t = .* on the way to 1000.0 s: 50 steps were not enough"):
        dop853.integration(small(OSCILLATOR, 2), [0.0], [1.0, 0.0], 0.0, 1e-9, max_steps=50).sample([1000.0])


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no interval timer")
def test_an_interrupt_is_heard():
    """Ctrl-C works during a long motion: the C function returns to Python every few milliseconds."""

    def interrupt(number, frame):
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            dop853.integration(small(OSCILLATOR, 2), [0.0], [1.0, 0.0], 0.0, 1e-9, max_steps=10**15).sample([1e12])
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)


GOOD = {"p": [0.0], "y0": [1.0, 0.0], "t0": 0.0, "times": [1.0], "tolerance": 1e-6}


def sampled(library, times, **arguments):
    return dop853.integration(library, **arguments).sample(times)


@pytest.mark.parametrize(
    "change, sentence",
    [
        ({"p": []}, r"parameters: expected an array of shape \(1,\) .* got shape \(0,\)"),
        ({"y0": [1.0]}, r"states: expected an array of shape \(2,\)"),
        ({"y0": [1.0, math.nan]}, r"states: expected finite numbers"),
        ({"p": [math.inf]}, r"parameters: expected finite numbers"),
        ({"t0": math.inf}, r"initial time"),
        ({"times": [math.nan]}, r"expected finite sample times"),
        ({"times": [1.0, math.inf]}, r"expected finite sample times"),
        ({"times": [0.0, math.nan, 1.0]}, r"expected finite sample times"),
        ({"times": [[1.0]]}, r"shape \(1, 1\)"),
        ({"times": 1.0}, r"shape"),
        ({"tolerance": 0.0}, r"between 0 and 1, got 0.0"),
        ({"tolerance": math.nan}, r"between 0 and 1"),
        ({"max_step": 0.0}, r"max_step: expected"),
        ({"max_step": math.nan}, r"max_step: expected"),
    ],
)
def test_input_that_cannot_be_used_is_named(change, sentence):
    arguments = {"library": small(OSCILLATOR, 2), **GOOD}
    sampled(**arguments)
    with pytest.raises(InputError, match=sentence):
        sampled(**{**arguments, **change})


@pytest.mark.parametrize(
    "blocks, scales", [((0, 3), (0.0,)), ((0, 3, 3, 7), (0, 0, 0)), ((0, 7), (0.0, 1.0)), ((), ())]
)
def test_blocks_cover_the_states_once(blocks, scales):
    with pytest.raises(InputError, match=r"expected block edges that increase from 0 to 7 \(the number of states\)"):
        dop853.translation_unit(RIGID_BODY, "rigid_body", 7, 6, blocks, scales)


def test_a_file_that_is_no_stepper_is_refused(tmp_path):
    (tmp_path / "text.so").write_text("hello")
    for path in (tmp_path / "text.so", tmp_path / "none.so", library.build("int nothing;", "nothing")):
        with pytest.raises(CompilerError, match="cannot be loaded"):
            sampled(library=path, **GOOD)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("states", [1, 2, 3, 4, 5, 8, 11, 13])
def test_any_number_of_states_can_be_stepped(states):
    """States decay at rates 1..N, each in its own block; N below, at and above the widths of unrolled loops."""
    kernel = f"""static inline void decay(double t, const double *y, const double *p, double *dy)
    {{ (void)t; for (int i = 0; i < {states}; ++i) dy[i] = -p[0]*(i + 1)*y[i]; }}\n"""
    path = built(kernel, "decay", states, 1, tuple(range(states + 1)), (0.0,) * states)
    found, _ = dop853.integration(path, [0.1], [1.0] * states, 0.0, 1e-10).sample([1.0, 4.0])
    exact = np.exp(-0.1 * np.outer([1.0, 4.0], np.arange(1, states + 1)))
    assert abs(found / exact - 1).max() < 1e-9


@pytest.mark.skipif(shutil.which("gcc") is None or shutil.which("g++") is None, reason="no GNU compilers")
@pytest.mark.parametrize(
    "command", [["gcc", "-std=c99", "-x", "c"], ["g++", "-std=c++11", "-x", "c++"]], ids=["c", "c++"]
)
def test_the_source_is_clean_c99_and_valid_cpp(command):
    source = dop853.translation_unit(RIGID_BODY, "rigid_body", 7, 6)
    options = ["-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-fsyntax-only", "-"]
    done = subprocess.run([*command, *options], input=source, text=True, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    code = re.sub(r"/\*.*?\*/", "", source, flags=re.DOTALL)
    assert not re.search(r"malloc|printf|alloca|^static (?!inline|const|void|SYMROT_APART)", code, flags=re.MULTILINE)


# ------------------------------------------------------------------------------------------------ the benchmark


def test_the_benchmark_compares_like_with_like(capsys):
    """All contestants solve the same problem; of the printed numbers only the times depend on the machine."""
    from symrot.bench import stepper

    stepper.main(["--tolerance", "1e-8", "--stop", "20", "--rounds", "1"])
    rows = {row[:14].strip(): row[14:].split() for row in capsys.readouterr().out.splitlines()[2:6]}
    assert list(rows) == ["symrot", "by hand, -O2", "by hand, -O3", "solve_ivp"]
    for evaluations, *_, missed, _ in rows.values():
        assert int(evaluations) > 100
        assert float(missed) < 1e-6
    assert float(rows["symrot"][-2]) < 5e-8


@pytest.mark.parametrize("rate", [1e-99, 1e-45, 1e45, 1e99])
def test_steps_do_not_depend_on_the_unit_of_time(rate):
    """For large rates the fourth power of an error overflows; the stepper once took millions of steps there."""

    def motion(unit):
        made = Scene.from_dict({
            "schema": 1, "body": {"principal": [2, 3, 4]}, "initial": {"omega": [0.3 * unit, unit, 0.5 * unit]},
            "span": {"t": [0, 6 / unit]},
        })  # fmt: skip
        return propagator(made, "dop853", 1e-10)(np.linspace(0, 6, 4) / unit)

    found, plain = motion(rate), motion(1.0)
    assert found.stats.accepted == pytest.approx(plain.stats.accepted, abs=2)
    assert np.abs(found.omega / rate - plain.omega).max() < 1e-9

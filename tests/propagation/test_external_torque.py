"""Torques that are no formulas: functions in Python and C, tables, switching times; their errors reach the user."""

import ctypes
import math
import re
import subprocess
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import symrot
from symrot.build import cache as library
from symrot.errors import InputError, PropagationError
from symrot.propagation import external_torque as driven
from symrot.scene.scene import Scene

pytestmark = pytest.mark.usefixtures("quick_compiler")


def scene(omega=(0, 0, 0), moments=(1, 1, 1), stop=3, **more):
    form = {
        "schema": 1, "title": "body", "body": {"principal": list(moments)}, "initial": {"omega": list(omega)},
        "span": {"t": [0, stop], "samples": 7}, "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(form | more, "body")


def square_wave(t, omega, quaternion):
    return (0, 0, 1.0 if t < 1.25 else -0.5)


def test_a_square_wave_restarted_at_its_jumps_is_exact():
    """S42: constant pieces give parabolas; a declared jump rejects no step and costs no accuracy."""
    propagator = symrot.propagator(scene(), torque=square_wave, switching_times=[1.25], tolerance=1e-12)
    t = np.array([0.3, 1.25, 2.0, 3.0])
    trajectory = propagator(t)
    late = np.maximum(t - 1.25, 0)
    assert abs(trajectory.omega[:, 2] - (np.minimum(t, 1.25) - late / 2)).max() < 1e-15  # a few bits of 1.25
    angle = np.minimum(t, 1.25) ** 2 / 2 + 1.25 * late - late**2 / 4
    assert abs(trajectory.quaternion[:, 3] - np.sin(angle / 2)).max() < 1e-12
    assert trajectory.stats.rejected == 0 and trajectory.method == "dop853"
    blind = symrot.propagator(scene(), torque=square_wave, tolerance=1e-12)(t)
    assert blind.stats.rejected > 10


def test_a_function_acts_as_the_same_formula_does():
    """A driven and damped heavy top: the formula in the scene acts like the same function in Python."""
    gravity = {"kind": "gravity", "weight": 1, "center_of_mass": ["1/10", "1/5", "9/10"]}
    formulas = ["sin(3*t)/4 - omega_1/10", "q0*q1", "cos(t) - q3"]
    body = {"principal": [1, "3/2", "7/10"], "about": "fixed_point"}
    more = {"kind": "expression", "torque": formulas}
    start = {"omega": ["1/2", "3/10", 4]}
    known = symrot.propagate(scene(body=body, initial=start, torque=[gravity, more]), "taylor", 1e-13)

    def torque(t, w, q):
        return [math.sin(3 * t) / 4 - w[0] / 10, q[0] * q[1], math.cos(t) - q[3]]

    found = symrot.propagator(scene(body=body, initial=start, torque=[gravity]), torque=torque, tolerance=1e-12)()
    assert abs(found.omega - known.omega).max() < 2e-11 and abs(found.quaternion - known.quaternion).max() < 2e-11
    assert [item.name for item in found.invariants] == ["quaternion norm"]


def test_general_axes_and_components_in_space():
    """A tensor with products; a torque of fixed direction in space, as formula and as function in either frame."""
    body = {"inertia": {"xx": 3, "yy": 4, "zz": 5, "xy": "-1/2", "xz": "1/4", "yz": "-1/3"}}
    start = {"omega": ["1/2", 1, "-1/4"], "attitude": {"axis": [1, 2, 3], "angle": 1}}
    push = [{"kind": "constant_space", "torque": ["1/2", 0, "-1/4"]}]
    known = symrot.propagate(scene(body=body, initial=start, torque=push), "taylor", 1e-13)
    free = scene(body=body, initial=start)
    in_space = symrot.propagator(free, torque=lambda t, w, q: (0.5, 0, -0.25), torque_frame="space", tolerance=1e-12)()
    assert abs(in_space.omega - known.omega).max() < 1e-11

    def in_body(t, w, q):
        from symrot.kinematics.conversions import quaternion_to_dcm

        return quaternion_to_dcm(q / np.linalg.norm(q)).T @ (0.5, 0, -0.25)

    assert abs(symrot.propagator(free, torque=in_body, tolerance=1e-12)().omega - known.omega).max() < 1e-11


def test_a_table_is_interpolated_and_may_jump():
    t = np.linspace(0, 3, 61)
    smooth = np.stack([np.cos(t), 0 * t, np.sin(t)], axis=1)
    trajectory = symrot.propagator(scene(), torque=(t, smooth), tolerance=1e-10)()
    assert abs(trajectory.omega[:, 0] - np.sin(trajectory.t)).max() < 2e-7  # the spline's own error, (h^4)
    jump = (np.array([0, 1, 1.25, 1.25, 3]), [[0, 0, 1]] * 3 + [[0, 0, -0.5]] * 2)
    stepped = symrot.propagator(scene(), torque=jump, switching_times=[1.25])()
    assert stepped.omega[-1, 2] == pytest.approx(1.25 - 1.75 / 2, abs=1e-15)
    assert stepped.stats.rejected == 0


@pytest.mark.parametrize(("start", "times"), [(0, (0, 20)), (1e6, (1e6, 1e6 + 20)), (-1e6, (-1e6 - 20, -1e6))])
def test_a_function_far_from_zero_carries_a_warning(start, times):
    """omega_3 = cos(start) - cos(t). Doubles at 1e6 s lie 1e-10 s apart: the motion was off by 225 tolerances.

    A torque that does not depend on time is not affected.
    """
    made = scene(span={"t": [start, start + 20]})
    waves = symrot.propagator(made, torque=lambda t, w, q: (0, 0, math.sin(t)), tolerance=1e-12, max_step=1)
    moved = waves(np.linspace(*times, 9))
    off = abs(moved.omega[:, 2] - (math.cos(start) - np.cos(moved.t))).max() / 2e-12
    warnings = [
        text for text in moved.warnings if re.search(r"beyond t = -?1\d+\.\d* s the rounding of the times", text)
    ]
    assert len(warnings) == (start != 0) and (off > 1) == (start != 0)
    assert moved.at(times[1]).warnings == moved.warnings == waves(np.array(times), events=["omega_3 - 9"]).warnings
    damped = symrot.propagator(made, torque=lambda t, w, q: (0, 0, 1 - w[2] / 10), tolerance=1e-12, max_step=1)
    moved = damped(np.linspace(*times, 9))
    exact = -10 * np.expm1((start - moved.t) / 10)
    assert moved.warnings == () and abs(moved.omega[:, 2] - exact).max() < 1e-12 * abs(exact).max()


@pytest.mark.parametrize("formulas", [["3/10", "1/10", "-1/5"], ["3/10 - t/10", "t/5", "0"]], ids=["constant", "line"])
def test_samples_of_one_line_take_no_steps_of_their_own(formulas):
    """Over constant or linear pieces one step passes eight samples; at a bend between two lines a step ends."""
    free = {"omega": (0.1, 1, 0.3), "moments": (1, 2, 3)}
    known = symrot.propagate(scene(**free, torque=[{"kind": "expression", "torque": formulas}]), tolerance=1e-14)
    times = np.linspace(0, 3, 1001)
    slopes, starts = ([-0.1, 0.2, 0], [0.3, 0, 0]) if "t" in formulas[1] else ([0, 0, 0], [0.3, 0.1, -0.2])
    samples = np.outer(times, slopes) + starts
    smooth = symrot.propagator(scene(**free), torque=(times, samples), tolerance=1e-12)()
    assert smooth.stats.accepted < 1.1 * 1000 / driven.SAMPLES_PER_STEP and abs(smooth.y - known.y).max() < 1e-12
    waves = symrot.propagator(scene(**free), torque=(times, samples + np.sin(times)[:, None]), tolerance=1e-12)()
    assert waves.stats.accepted > 900


def test_a_spline_far_from_its_samples_is_refused():
    """Samples of a jump one bit apart make the spline reach 1e30 N m; if the jump is declared, it is a jump."""
    samples = np.array([[0, 0, 0], [0.1, 0, 0], [-0.1, 1, 0], [0, 0, 0.1]])
    with pytest.raises(
        InputError, match=r"expected samples that a cubic spline can follow, .* between 1\.0000000000000002 and 3\.0 s"
    ):
        symrot.propagator(scene(), torque=([0, 1, math.nextafter(1, 2), 3], samples))
    assert symrot.propagator(scene(), torque=([0, 1, 1, 3], samples), switching_times=[1])().success
    ramps = [[0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 0, 0]]  # one sample of 100 apart: odd, not refused
    assert symrot.propagator(scene(), torque=([0, 1, 1.01, 3], ramps))().success


def test_a_table_of_a_torque_that_grows_from_nothing_moves_a_body_at_rest():
    """The first step of a body at rest without a torque depends on what the torque grows to."""
    times = np.arange(-1.0, 4.0)
    for first in (0, 1):
        moved = symrot.propagator(scene(), torque=(times[first:], np.outer(times, [0, 1, 0])[first:]))()
        assert abs(moved.omega[:, 1] - moved.t**2 / 2).max() < 1e-15 and moved.stats.accepted < 100


def test_a_table_that_spins_too_fast_ends_in_a_sentence(monkeypatch):
    """1e10 N m for 3 s make 1e10 turns."""
    table = [0, 1, 3], [[1e10, 0, 0], [0, 1e10, 0], [0, 0, 1e10]]
    monkeypatch.setattr(driven._Table, "most_steps", 100_000)
    with pytest.raises(PropagationError, match=r"beyond t = .* s: 100000 steps were not enough; the next would be"):
        symrot.propagator(scene(omega=(1, 2, 3), moments=(1, 2, 2.5)), torque=table)()


def test_a_c_function_through_ctypes(tmp_path):
    text = "int push(double t, const double *w, const double *q, double *torque, void *user)"
    text += "{ (void)q; (void)user; torque[0] = -w[0]; torque[1] = t; torque[2] = 2.0; return 0; }"
    (tmp_path / "push.c").write_text(text)
    tool = library.compiler()
    made = tmp_path / "push.so"
    subprocess.run([*tool.command, "-shared", "-fPIC", "-o", str(made), str(tmp_path / "push.c")], check=True)
    push = ctypes.CDLL(str(made)).push
    found = symrot.propagator(scene((1, 0, 0), (2, 2, 2)), torque=push, tolerance=1e-12)()
    t = found.t
    exact = np.stack([np.exp(-t / 2), t**2 / 4, t], axis=1)
    assert abs(found.omega - exact).max() < 1e-11


def test_events_and_dense_output_of_a_driven_motion():
    propagator = symrot.propagator(scene(), torque=square_wave, switching_times=[1.25], tolerance=1e-12)
    trajectory = propagator(events=["omega_3 - 1", "omega_3 - 1.25", symrot.Event("t == 2", terminal=True)])
    assert trajectory.t_events[0] == pytest.approx([1.0, 1.75], abs=1e-14) and trajectory.status == 1
    assert trajectory.t_events[1] == pytest.approx([1.25], abs=1e-14)
    assert propagator().sol(2.0)[2] == pytest.approx(0.875, abs=1e-14)


def test_what_the_function_raises_comes_out():
    def broken(t, omega, quaternion):
        if t > 1:
            raise KeyError("no thrust")
        return (0, 0, 0)

    with pytest.raises(
        InputError, match=r"torque: the function raised KeyError: 'no thrust', at t = 1\.\d* s"
    ) as caught:
        symrot.propagator(scene(), torque=broken)()
    assert isinstance(caught.value.__cause__, KeyError)
    propagator = symrot.propagator(scene(), torque=broken)
    with pytest.raises(InputError, match="no thrust"):
        propagator()
    assert len(propagator([0.5])) == 1  # the failure of one call is not that of the next

    def interrupted(t, omega, quaternion):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        symrot.propagator(scene(), torque=interrupted)()


def failing(after, error):
    """Return a torque function that raises an error from a time on."""

    def torque(t, omega, quaternion):
        if t > after:
            raise error
        return (0, 0, 0.25)

    return torque


@pytest.mark.parametrize(
    ("error", "raised", "words"),
    [(KeyError("no thrust"), InputError, "the function raised KeyError: 'no thrust', at t = "),
     (KeyboardInterrupt(), KeyboardInterrupt, "^$")],
)  # fmt: skip
def test_what_the_function_raises_comes_out_of_a_search_for_events(error, raised, words):
    """The search ended with "its rate of change is not finite there", also for Ctrl-C."""
    propagator = symrot.propagator(scene(), torque=failing(1, error))
    for _ in range(2):
        with pytest.raises(raised, match=words):
            propagator(events=["omega_3 - 2"])
    assert propagator([0.5], events=["omega_3 - 1/16"]).t_events[0] == pytest.approx([0.25], abs=1e-12)


def test_a_table_ends_also_for_a_search_of_events():
    """The last cubic was continued beyond the last sample in silence."""
    table = ([0, 1, 2], [[0, 0, 1], [0, 0, 2], [0, 0, 3]])
    with pytest.raises(InputError, match=r"expected times from 0.0 to 2.0 s, the span of the table, got 3.0 s"):
        symrot.propagate(scene(), torque=table, events=["omega_3 - 10"])
    with pytest.raises(InputError, match=r"got -1.0 s"):
        symrot.propagate(scene(), torque=table, t=[-1, 1], events=["omega_3 - 10"])
    found = symrot.propagate(scene(), torque=table, t=[0, 2], events=["omega_3 - 3/2"])
    assert found.t_events[0] == pytest.approx([1])


def test_each_motion_has_its_own_error():
    """An error of a motion within the function, or in another thread, ended motions in which the function works."""
    within, refused = [False], []

    def torque(t, omega, quaternion):
        if within[0]:
            raise ValueError("not here")
        if t > 1 and not refused:
            within[0] = True
            try:
                propagator([0.5])
            except InputError as error:
                refused.append(str(error))
            within[0] = False
        return (0, 0, 0.25)

    propagator = symrot.propagator(scene(), torque=torque, tolerance=1e-12)
    assert abs(propagator([2]).omega[0, 2] - 0.5) < 1e-13
    assert refused == ["torque: the function raised ValueError: not here, at t = 0.0 s"]

    meeting, own = threading.Barrier(2), threading.local()

    def shared(t, omega, quaternion):
        if not hasattr(own, "met"):
            own.met = meeting.wait(60)
        if own.fails and t > 0.5:
            raise ValueError("in this thread")
        return (0, 0, 0.25)

    together = symrot.propagator(scene(), torque=shared, tolerance=1e-12)

    def follow(fails):
        own.fails = fails
        try:
            return together([2]).omega[0, 2]
        except InputError as error:
            return str(error)

    with ThreadPoolExecutor(2) as pool:
        ended, followed = pool.map(follow, (True, False))
    assert "in this thread" in ended and abs(followed - 0.5) < 1e-13


def test_a_function_in_python_without_a_result_has_no_torque(monkeypatch):
    """ctypes drops an exception outside of the function's try block, and then returns any number; zero says success."""
    monkeypatch.setattr(driven._Function, "_call", lambda *_: 0)
    with pytest.raises(PropagationError, match="its rate of change is not finite there"):
        symrot.propagate(scene(), torque=square_wave, t=[0, 2])


@pytest.mark.parametrize(
    "torque, words",
    [
        (lambda t, w, q: [1, 2], r"three finite numbers in N m, got \[1.0, 2.0\] at t = 0.0 s"),
        (lambda t, w, q: [1, 2, math.nan], "three finite numbers in N m"),
        (lambda t, w, q: None, "three finite numbers in N m"),
        (lambda t, w, q: "push", "three finite numbers in N m, got an array of type <U4"),
        (lambda t, w, q: ["1", "2", "3"], "three finite numbers in N m, got an array of type <U1"),
        (lambda t, w, q: np.array([0, 1j, 0]), "three finite numbers in N m, got an array of type complex128"),
        (lambda t, w, q: [10**400, 0, 0], "three finite numbers in N m, got .* at t = 0.0 s"),
        (driven.CALLBACK(), "a C function, got a null pointer"),
        (ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(float), "declares to take 1 argument and to return c_double"),
        (3, "expected a function of"),
        (([0, 1], [[1, 2, 3]]), r"samples in N m of shape \(n, 3\)"),
        (([0, 1], [[1, 2, 3], [1, 2, math.inf]]), "finite numbers"),
        (([0, 2, 1, 3], [[1, 2, 3]] * 4), "increasing times"),
        (([0, 1, 1, 3], [[1, 2, 3]] * 4), "only a switching time may occur twice"),
        (([0, 1], [[1, 2, 3]] * 2), r"expected times from 0.0 to 1.0 s, the span of the table, got 3.0 s"),
    ],
)  # fmt: skip
def test_a_torque_that_cannot_be_used_is_refused(torque, words):
    with pytest.raises(InputError, match=words):
        symrot.propagator(scene(), torque=torque)()


@pytest.mark.parametrize(
    "more, words",
    [
        ({"method": "taylor"}, "expected 'auto' or 'dop853' for a torque without a formula, got 'taylor'"),
        ({"switching_times": [math.inf]}, "switching_times: expected finite times"),
        ({"switching_times": "soon"}, "switching_times: expected finite times"),
        ({"torque_frame": "orbit"}, "torque_frame: expected 'body' or 'space', got 'orbit'"),
        ({"max_step": [1, 2]}, r"max_step: expected a positive number of seconds, got \[1, 2\]"),
    ],
)
def test_options_that_cannot_be_used_are_refused(more, words):
    with pytest.raises(InputError, match=words):
        symrot.propagator(scene(), torque=square_wave, **more)


@pytest.mark.parametrize("name", ["t_handle", "thruster_pulse"])
def test_switching_times_without_a_torque_of_their_own_are_refused(name):
    """They were ignored: no torque jumps there, or the scene's table has its own."""
    with pytest.raises(InputError, match="switching_times: leave it out unless torque is a function or a table"):
        symrot.propagator(name, switching_times=[1.0])


@pytest.mark.parametrize("name", ["t_handle", "thruster_pulse"])
@pytest.mark.parametrize("option", [{"torque_frame": "space"}, {"torque_frame": "orbit"}, {"switching": False}])
def test_options_without_an_effect_are_refused(name, option):
    with pytest.raises(InputError, match=r"(torque_frame|switching): leave it out unless (torque|state) is "):
        symrot.propagator(name, **option)


def test_a_method_that_cannot_be_named_is_not_proposed():
    with pytest.raises(InputError, match=r"got 'constant'$"):
        symrot.propagator("t_handle", "constant")

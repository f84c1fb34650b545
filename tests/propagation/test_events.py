"""Events agree with closed forms: zeros to the last bits, touches distinguished from crossings, close pairs, ends of
motions.
"""

import math

import mpmath
import numpy as np
import pytest

import symrot
from symrot.errors import InputError, PropagationError
from symrot.propagation.events import search
from symrot.propagation.events.event import read_events
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853", "exact"]
ULP = 2.0**-52


def scene(omega=("3/8", 1, "1/2"), stop=30, **more):
    form = {
        "schema": 1, "title": "body", "body": {"principal": [1, 2, 3]}, "initial": {"omega": list(omega)},
        "span": {"t": [0, stop], "samples": 4}, "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(form | more, "body")


def pendulum(rate, stop=20):
    """Return a scene of a pendulum that swings about axis 1 from straight down: I theta'' = -m g l sin theta, all
    constants 1.
    """
    return scene(
        (rate, 0, 0), stop, body={"principal": [1, 1, "1/2"], "about": "fixed_point"},
        torque=[{"kind": "gravity", "weight": 1, "center_of_mass": [0, 0, -1]}],
    )  # fmt: skip


SPIN = {"body": {"principal": [1, 1, 1]}}  # steady rotation: components of the quaternion are cosines


def run(found, events, method="taylor", tolerance=1e-15, **more):
    return symrot.propagator(found, method=method, tolerance=tolerance)(events=events, **more)


# ------------------------------------------------------------------------------------------------ closed forms


def zeros_of_sn():
    """Return the times at which the free body's omega_2 is zero: u0 + lambda t = 2 k K (moments 1, 2, 3; omega_2 rises
    first).
    """
    with mpmath.workdps(40):
        w = [mpmath.mpf("0.375"), mpmath.mpf(1), mpmath.mpf("0.5")]
        # omega_2' = -(A - C)/B omega_1 omega_3 with omega_1^2, omega_3^2 linear in omega_2^2: sn with these constants
        a1 = w[0] ** 2 + w[1] ** 2 * 2 * (3 - 2) / mpmath.mpf(1 * (3 - 1))
        a3 = w[2] ** 2 + w[1] ** 2 * 2 * (2 - 1) / mpmath.mpf(3 * (3 - 1))
        b1, b3 = mpmath.mpf(2 * (3 - 2)) / (1 * (3 - 1)), mpmath.mpf(2 * (2 - 1)) / (3 * (3 - 1))
        rate = mpmath.mpf(3 - 1) / 2
        # w2' = -rate sqrt(a1 - b1 w2^2) sqrt(a3 - b3 w2^2); with w2 = r sin(am): the smaller of a/b is r^2
        first, second = (a1, b1), (a3, b3)
        if a3 / b3 < a1 / b1:
            first, second = second, first
        r = mpmath.sqrt(first[0] / first[1])
        speed = rate * mpmath.sqrt(first[1] * second[0])
        m = second[1] * first[0] / (first[1] * second[0])
        ahead = mpmath.ellipf(mpmath.asin(w[1] / r), m) / speed
        half = 2 * mpmath.ellipk(m) / speed
        return [float(k * half - ahead) for k in range(1, 7)]


@pytest.mark.parametrize("method, ulps", [("taylor", 12), ("dop853", 60), ("exact", 4)])
def test_zeros_of_sn(method, ulps):
    """The free body's omega_2 vanishes every half period of sn; it rises at the start, so it falls at the first zero."""
    trajectory = run(scene(), ["omega_2"], method)
    exact = [t for t in zeros_of_sn() if t < 30]
    assert abs(trajectory.t_events[0] - exact).max() < ulps * ULP * 30
    assert trajectory.event_kinds[0] == ["falling", "rising"] * (len(exact) // 2) + ["falling"] * (len(exact) % 2)
    assert abs(trajectory.y_events[0][:, 1]).max() < 30 * ULP * 0.5  # the rate there is below one half
    assert trajectory.status == 0 and len(trajectory) == 4


@pytest.mark.parametrize("method", ["taylor", "exact"])
def test_turning_points_of_a_pendulum(method):
    """omega_1 = 0 at odd multiples of K(m), m = (omega/2)^2; the lowest point is at even multiples."""
    quarter = float(mpmath.ellipk(mpmath.mpf("0.5625")))  # omega = 3/2
    trajectory = run(pendulum("3/2"), ["omega_1", "q1"], method)
    count = int(20 / quarter)
    turning = [quarter * k for k in range(1, count + 1, 2)]
    lowest = [quarter * k for k in range(0, count + 1, 2)]
    assert abs(trajectory.t_events[0] - turning).max() < 4 * ULP * 20
    assert trajectory.t_events[1][0] == 0.0
    assert abs(trajectory.t_events[1] - lowest).max() < 4 * ULP * 20
    assert trajectory.event_kinds[1][0] == "rising"


# ------------------------------------------------------------------------------------------------ kinds of zeros


@pytest.mark.parametrize("method", METHODS)
def test_touches_are_told_from_crossings_and_from_near_misses(method):
    """q0 = cos(t/2): q0^2 touches zero at odd multiples of pi; shifted by more than rounding, it does not."""
    motion = scene((1, 0, 0), 20, **SPIN)
    events = ["q0*q0", "q0*q0 + 1e-14", "q0*q0 - 1e-14", "q0 == 1", "q0**3"]
    trajectory = run(motion, events, method)
    odd = math.pi * np.array([1, 3, 5])
    square, above, below, top, cube = trajectory.t_events
    assert abs(square - odd).max() < 1e-12 and trajectory.event_kinds[0] == ["touching"] * 3
    assert len(above) == 0
    assert len(below) == 6 and abs(below - np.repeat(odd, 2) - 2e-7 * np.tile([-1, 1], 3)).max() < 1e-8
    assert trajectory.event_kinds[2] == ["falling", "rising"] * 3
    assert abs(top - [0, 4 * math.pi]).max() < 3e-7 and set(trajectory.event_kinds[3]) <= {"touching", "falling"}
    assert abs(cube - odd).max() < 1e-5 and trajectory.event_kinds[4] == ["falling", "rising", "falling"]


TOUCHES = [  # formula of t, and its zeros in [0, 20] s
    ("sin(t)**2", math.pi * np.arange(7)), ("1 - cos(t)", 2 * math.pi * np.arange(4)), ("abs(sin(t))", math.pi * np.arange(7)),
    ("cos(t)**2/(1 + t)", math.pi * (np.arange(6) + 0.5)), ("sqrt(abs(sin(t)))", math.pi * np.arange(7)),
    ("(t - 10/3)**2", [10 / 3]), ("abs(t - 10/3)", [10 / 3]), ("t**4 - 4*t**2 + 4", [math.sqrt(2)]),
    ("sin(t)**2 + 1e-20", []), ("abs(sin(t)) + 1e-13", []), ("3/2 + (t - 5)/abs(t - 5)", []),
    ("4 + atan2(sin(t), cos(t))", []),
]  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("formula", "zeros"), TOUCHES)
def test_a_touch_between_two_doubles_is_found(formula, zeros):
    """No double is a multiple of pi, so g there is zero only up to the rounding of the time. A jump is no touch."""
    found = run(scene(stop=20, **SPIN), [formula]).t_events[0]
    assert len(found) == len(zeros) and np.allclose(found, zeros, rtol=0, atol=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_squares_and_sizes_of_what_crosses_zero_touch_it(method):
    """At each zero of g, g^2, abs(g) and (2 + cos t) g^2 touch zero, also between two doubles."""
    for g in ("omega_2", "omega_1 - 1/3", "q1*q3", "q0*q2 - sin(3*t)/10"):
        events = [g, f"({g})**2", f"abs({g})", f"(2 + cos(t))*({g})**2"]
        crossings, *touches = run(scene(), events, method, 1e-13).t_events
        assert len(crossings) >= 5
        for found in touches:
            assert len(found) == len(crossings) and np.allclose(found, crossings, rtol=0, atol=1e-12)


def test_what_a_body_that_friction_holds_keeps_at_zero_is_one_event():
    """omega_3 reaches zero at 6 s and stays zero until 13 s."""
    events = ["omega_3", "abs(omega_3)", "omega_3**2"]
    trajectory = symrot.propagate("friction_wheel", events=events)
    assert [t.tolist() for t in trajectory.t_events] == [[6.0]] * 3 and not trajectory.warnings
    stopped = symrot.propagate("friction_wheel", events=[symrot.Event("abs(omega_3)", terminal=True)])
    assert stopped.status == 1 and stopped.t[-1] == 6.0


def test_a_touch_within_the_error_of_the_motion_is_reported():
    """1 - q0^2 touches zero every 2 pi, though the motion is known only to its tolerance."""
    motion = scene((0, 0, 1), 20, torque=[{"kind": "expression", "torque": ["0", "0", "1e-30*sin(t)"]}], **SPIN)
    for method in ("taylor", "dop853"):
        trajectory = run(motion, ["1 - q0**2", "q3**2", "1 - q0**2 + 1e-6"], method, 1e-12)
        assert len(trajectory.t_events[0]) != 4 and len(trajectory.t_events[1]) == 4
        (sentence,) = trajectory.warnings
        assert "'1 - q0**2' differs from zero at t = 6.28318530" in sentence


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9])
def test_close_pairs(gap):
    """Two zeros, however close, in formulas of t and of the motion; and ten zeros in one step."""
    trajectory = run(scene(), [f"(omega_2 - {gap!r})*omega_2", f"(t - 7)*(t - 7 - {gap!r})"])
    first, second = trajectory.t_events
    assert len(first) == 2 * len([t for t in zeros_of_sn() if t < 30]) and (np.diff(first) > 0).all()
    assert second[0] == pytest.approx(7, abs=1e-14) and second[1] == pytest.approx(7 + gap, abs=1e-14)
    assert trajectory.event_kinds[1] == ["falling", "rising"]


def test_many_zeros_in_one_step():
    trajectory = run(scene(), ["sin(40*t)"])
    exact = math.pi / 40 * np.arange(int(30 * 40 / math.pi) + 1)
    assert len(trajectory.t_events[0]) == len(exact) and abs(trajectory.t_events[0] - exact).max() < 4 * ULP * 30


def test_what_is_zero_all_along_or_never_is_no_event():
    trajectory = run(scene((0, 0, 1)), ["omega_1", "omega_3 - 2", "q0*q0 + q3*q3 - 1"])
    assert [len(t) for t in trajectory.t_events] == [0, 0, 0]
    assert trajectory.warnings == tuple(
        f"events: {formula!r} is zero within rounding from t = 0.0 to 30.0 s: no event is listed there"
        for formula in ("omega_1", "q0*q0 + q3*q3 - 1")
    )


def test_formulas_without_a_value_somewhere():
    """The root of a negative number is neither event nor error; the zero beside it is found."""
    trajectory = run(scene(), ["sqrt(t - 5) - 1", "log(t - 40)", "abs(omega_2) - 0.2"])
    assert trajectory.t_events[0] == pytest.approx([6], abs=1e-14)
    assert len(trajectory.t_events[1]) == 0 and len(trajectory.t_events[2]) >= 10


# ------------------------------------------------------------------------------------------------ terminal, direction


@pytest.mark.parametrize("method", METHODS)
def test_a_terminal_event_ends_the_motion(method):
    event = symrot.Event("omega_2", terminal=2, direction=0)
    trajectory = run(scene(), [event, "omega_1"], method, t=np.linspace(0, 30, 301))
    assert trajectory.status == 1 and len(trajectory.t_events[0]) == 2
    assert trajectory.t[-1] == trajectory.t_events[0][-1] and (np.diff(trajectory.t) > 0).all()
    assert trajectory.t[-2] > trajectory.t[-1] - 0.1 and (trajectory.y[:, -1] == trajectory.y_events[0][-1]).all()
    assert (trajectory.t_events[1] <= trajectory.t_events[0][-1]).all()
    whole = run(scene(), ["omega_1"], method, t=trajectory.t)
    assert abs(whole.omega - trajectory.omega).max() < 1e-14 and whole.status == 0


def test_directions_and_backward_motion():
    """Directions follow the motion: run backward, it rises where the function falls in time."""
    both, up, down = run(
        scene(), ["omega_2", symrot.Event("omega_2", direction=1), {"formula": "omega_2", "direction": -1}]
    ).t_events
    assert sorted([*up, *down]) == list(both) and len(up) and len(down)
    t = np.linspace(-30, 30, 7)
    two_sided = run(scene(), ["omega_2", "t", symrot.Event("omega_2", terminal=True)], t=t)
    assert (np.diff(two_sided.t_events[0]) > 0).all()
    assert list(two_sided.t_events[1]) == [0.0]
    assert len(two_sided.t_events[2]) == 2 and two_sided.t_events[2][0] < 0 < two_sided.t_events[2][1]
    assert list(two_sided.t) == [two_sided.t_events[2][0], 0.0, two_sided.t_events[2][1]]
    reverse = run(scene(), [symrot.Event("omega_2", terminal=True)], t=t[::-1])
    assert list(reverse.t) == list(two_sided.t[::-1]) and (reverse.y == two_sided.y[:, ::-1]).all()


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_a_kink_at_a_switch_within_the_error_of_the_motion_is_reported(method):
    """Where a triangular wave touches zero, rounding decides what is listed; nothing was said."""
    torque = [{"kind": "expression", "torque": ["0", "0", "where(mod(t, 1) < 1/2, 1, -1)"]}]
    wave = scene((0, 0, 0), 5, body={"principal": [1, 1, 1]}, torque=torque)
    near, far = run(wave, ["omega_3"], method, 1e-12), run(wave, ["omega_3 - 1/4", "omega_3 + 1/1000"], method, 1e-12)
    listed = set(near.t_events[0][np.array(near.event_kinds[0]) == "touching"].round(9))
    doubt = " differs from zero at t = "
    assert listed >= {1.0, 2.0, 3.0, 4.0} or (len(near.warnings) == 1 and doubt in near.warnings[0])
    assert far.warnings == () and [len(t) for t in far.t_events] == [10, 0]


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_events_of_a_motion_under_switches_that_runs_backward_only(method):
    """The part after the start, which has no length, ended in a traceback."""
    torque = [{"kind": "expression", "torque": ["0", "0", "where(mod(t, 1) < 1/2, 1, -1)"]}]
    motion = symrot.propagate(
        scene((0, 0, 0), body={"principal": [1, 1, 1]}, torque=torque), t=[0, -5], method=method,
        events=["omega_3 - 1/4", "t"],
    )  # fmt: skip
    assert motion.t_events[0] == pytest.approx(np.arange(-4.75, 0, 0.5)) and list(motion.t_events[1]) == [0.0]


@pytest.mark.parametrize("method", METHODS)
def test_a_pendulum_that_starts_from_rest_turns_at_the_start(method):
    """Polynomials fitted to the closed form gave it a velocity of 1e-17 rad/s at the start, and no event there."""
    start = {"omega": [0, 0, 0], "attitude": {"axis": [1, 0, 0], "angle": 1}}
    trajectory = run(pendulum(0, 10).with_(initial=start), ["omega_1"], method, 1e-12)
    quarter = 3.3499878296
    assert trajectory.t_events[0] == pytest.approx(quarter * np.arange(3), abs=1e-8)
    assert trajectory.event_kinds[0] == ["falling", "rising", "falling"]


def test_an_event_at_the_start_is_listed_and_ends_nothing():
    trajectory = run(pendulum(1), [symrot.Event("q1", terminal=True, direction=1)])
    assert trajectory.t_events[0][0] == 0.0 and len(trajectory.t_events[0]) == 2
    assert trajectory.t_events[0][1] == pytest.approx(4 * float(mpmath.ellipk(0.25)) * 1.0, abs=1e-13)


@pytest.mark.parametrize("formula", ["t", "-t"])
def test_a_formula_without_rounding_errors_is_zero_at_the_start(formula):
    motion = run(scene((0, 0, 2), 10, body={"principal": [1, 2, "5/2"]}), [formula], "exact")
    assert motion.t_events[0].tolist() == [0.0]


def test_a_singularity_beyond_a_terminal_event_does_no_harm():
    torque = [{"kind": "expression", "torque": ["omega_1*omega_1", 0, 0]}]
    motion = scene((1, 0, 0), 3, torque=torque, body={"principal": [1, 1, 1]})
    assert run(motion, [symrot.Event("omega_1 == 8", terminal=True)]).t_events[0] == pytest.approx([7 / 8], abs=1e-14)
    with pytest.raises(PropagationError, match="cannot be followed beyond t = "):
        run(motion, ["omega_1 == 8"])


def test_scipy_finds_the_same():
    found = run(scene(stop=8), ["omega_2"], "scipy", 1e-12).t_events[0]
    assert abs(found - [t for t in zeros_of_sn() if t < 8]).max() < 1e-11


@pytest.mark.parametrize("method", ["taylor", "dop853", "exact", "scipy", "scipy:LSODA"])
def test_a_level_that_is_reached_exactly_at_the_end_is_listed(method):
    """SciPy's steps, fitted by polynomials, ended one rounding error before the level."""
    for stop in (8, 2.7, -3.1):
        times = [0.0, stop]
        levels = run(scene(), [], method, 1e-9, t=times).y[:3, -1]
        events = [f"omega_{i + 1} == {level!r}" for i, level in enumerate(levels.tolist())]
        found = run(scene(), events, method, 1e-9, t=times)
        assert [times[0 if stop < 0 else -1] for times in found.t_events] == pytest.approx([stop] * 3, abs=1e-14)
        assert len(run(scene(), ["t == 7", *events], method, 1e-9, t=times).t_events[0]) == (stop == 8)


# ------------------------------------------------------------------------------------------------ refusals


@pytest.mark.parametrize(
    "events, words",
    [
        (["omega_4"], r"events\[0\]: expected names among t, omega_1..3, q0..q3 and pi, got omega_4"),
        (["__import__('os')"], r"events\[0\]: expected"),
        ([3], r"events\[0\]: expected a formula as text"),
        (abs, r"events: expected formulas as text, such as \[\"omega_3\", \"t - 1\"\], got <built-in"),
        (["q0", {"formula": "q1", "stop": 1}], r"events\[1\]: expected a formula as text"),
        ([symrot.Event("q0", terminal=-1)], "terminal: expected true, false or a count, got -1"),
        ([symrot.Event("q0", direction=2)], "direction: expected -1, 0 or 1, got 2"),
        ([symrot.Event("q0", direction=np.ones(2))], "direction: expected -1, 0 or 1, got array"),
        (["q0 == "], r"events\[0\]: expected a number, a name or"),
    ],
)
def test_what_is_no_event_is_refused(events, words):
    with pytest.raises(InputError, match=words):
        read_events(events)


def test_an_event_of_an_attitude_that_is_left_out_is_refused():
    motion = scene(output={"quantities": ["omega"]})
    assert len(run(motion, ["omega_2"]).t_events[0])
    with pytest.raises(InputError, match=r'add "quaternion" to output\.quantities'):
        run(motion, ["q0"])


# ------------------------------------------------------------------------------------------------ nothing hides

EVERY_METHOD = [*METHODS, "scipy"]


@pytest.mark.parametrize("method", EVERY_METHOD)
def test_poles_and_jumps_are_no_events(method):
    events = ["tan(t)", "1/q0", "1/(t - 5)", "(t - 5)/abs(t - 5)", "1/(t - 2)**3", "1/(t - 2)**2", "sin(t)/(t - 5)"]
    tangent, *others, sine = run(scene(stop=10), events, method, 1e-10).t_events
    assert abs(tangent - math.pi * np.arange(4)).max() < 1e-14
    assert [len(t) for t in others] == [0] * 5 and len(sine) == 4


@pytest.mark.parametrize("method", METHODS)
def test_an_angle_that_jumps_by_a_turn_is_no_event(method):
    """The branch cut of atan2 was listed as a zero, and ended motions there."""
    spin = scene((0, 0, 1), 20, **SPIN)
    yaw = "atan2(2*(q0*q3 + q1*q2), q0*q0 + q1*q1 - q2*q2 - q3*q3) == 0.1"
    events = [yaw, "sin(atan2(q3, q0)/2) == 0.1", "atan(tan(t))", "atan2(t - 5, -1)", "cos(atan2(q3, q0)/2)"]
    angle, half, tangent, jump, touch = run(spin, events, method, 1e-12).t_events
    assert angle == pytest.approx(0.1 + 2 * math.pi * np.arange(4), abs=1e-9)
    assert half == pytest.approx(4 * math.asin(0.1) + np.array([0, 4 * math.pi]), abs=1e-9)
    assert tangent == pytest.approx(math.pi * np.arange(7), abs=1e-14) and len(jump) == 0
    assert touch == pytest.approx([2 * math.pi, 6 * math.pi], abs=1e-6)


def test_zeros_at_the_edge_of_a_domain_are_no_events_but_touches_by_a_kink_are():
    edge, kink, root, slow = run(
        scene(), ["sqrt(t - 5)", "abs(t - 7.25)*(1 + t)", "sqrt(abs(t - 5))", "tanh(1000*(t - 5)) - 1"]
    ).t_events
    assert len(edge) == 0 and len(slow) == 0
    assert list(kink) == [7.25] and list(root) == [5.0]


@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", EVERY_METHOD)
@pytest.mark.parametrize("width", [1e-1, 1e-3, 1e-5])
def test_no_pulse_is_so_narrow_that_it_is_missed(method, width):
    """Crossings 1.7 widths apart: of a pulse at t = 100 s, and of a pulse in an angle, q3 = sin(t/2)."""
    half = width * math.sqrt(math.log(2))
    for t in ([0.0, 200.0], [0.0, -200.0]):
        place = math.copysign(100.0, t[1])
        events = [f"exp(-((t - {place!r})/{width!r})**2) - 1/2", f"exp(-((q3 - 0.6)/{width!r})**2) - 1/2"]
        trajectory = run(scene((0, 0, 1), 200, **SPIN), events, method, 1e-9, t=t)
        assert abs(trajectory.t_events[0] - [place - half, place + half]).max() < 1e-12
        first = sorted(trajectory.t_events[1], key=abs)[:2] if t[1] > 0 else []
        expected = [2 * math.asin(0.6 - half), 2 * math.asin(0.6 + half)] if t[1] > 0 else []
        assert len(trajectory.t_events[1]) >= 60 and np.allclose(first, expected, rtol=0, atol=1e-6)


def test_a_pole_at_the_middle_of_the_shortest_interval():
    found = run(scene(stop=22), ["(t - 5.341641)/(t - 6.447)"], "dop853", 1e-13, t=[2.0, 22.0]).t_events[0]
    assert list(found) == [5.341641]


def test_dense_zeros_of_exact_motions_are_counted():
    for rate in (1000, 100_000):
        found = run(scene(stop=1), [f"sin({rate}*t)"], "exact").t_events[0]
        exact = math.pi / rate * np.arange(int(rate / math.pi) + 1)
        assert len(found) == len(exact) and abs(found - exact).max() < 2 * ULP


@pytest.mark.thinned(3)
@pytest.mark.shipped_flags
@pytest.mark.parametrize("formula", ["sin(1/(t - 5))", "asin(sin(t)) - t", "sin(1e8*t)"])
def test_zeros_that_cannot_be_told_apart_end_in_a_sentence(formula, monkeypatch):
    """The samples and events before that time are kept."""
    monkeypatch.setattr(search, "MOST_ENTRIES", search.MOST_ENTRIES // 20)  # the search gives up as soon
    motion, sentence = scene(), r"events: expected formulas whose zeros can be separated, but beyond t"
    with pytest.raises(PropagationError, match=sentence) as stopped:
        run(motion, [formula, "t - 1e-3"], "exact", t=[0.0, 1e-3, 30.0])
    trajectory = stopped.value.trajectory
    assert trajectory.status == -1 and not trajectory.success and trajectory.message == str(stopped.value)
    if formula.endswith("- 5))"):
        assert trajectory.t.tolist() == [0.0, 1e-3] and trajectory.t_events[1].tolist() == [1e-3]


def test_coinciding_events_are_all_listed():
    trajectory = run(scene(), ["t - 5", "(t - 5)**3", "sin(t - 5)", "exp(t - 5) - 1", symrot.Event("t == 6", True)])
    for times in trajectory.t_events[:1] + trajectory.t_events[2:4]:
        assert 5.0 in times
    assert abs(trajectory.t_events[1] - 5).max() < 1e-12 and trajectory.t[-1] == 6.0


def test_events_at_the_ends_and_at_samples():
    t = np.linspace(0, 10, 11)
    whole = run(scene(), ["sin(pi*t)", "t*(t - 10)", symrot.Event("t == 10", terminal=True)], t=t)
    assert whole.t_events[0] == pytest.approx(t, abs=1e-14) and list(whole.t_events[1]) == [0.0, 10.0]
    assert list(whole.t) == list(t) and whole.status == 1


@pytest.mark.parametrize("count", [16, pytest.param(400, marks=pytest.mark.campaign)])
def test_random_products_of_known_zeros(count):
    """Seeded products of factors with known zeros: crossings, touches, poles, pulses, pairs, both directions."""
    random = np.random.default_rng(20)
    for number in range(count):
        a, b = round(random.uniform(1, 9), 3), round(random.uniform(10, 19), 3)
        gap, width = 10 ** random.uniform(-10, -3), 10 ** random.uniform(-5, -1)
        half = width * math.sqrt(math.log(4))
        factors = {
            f"(t - {a!r})": [a], f"(t - {a!r})*(t - {a + gap!r})": [a, a + gap], f"tanh((t - {a!r})/{width!r})": [a],
            f"(exp(-((t - {a!r})/{width!r})**2) - 1/4)": [a - half, a + half], f"abs(t - {a!r})": [a],
            f"(t - {a!r})**2": [a], f"1/(t - {a!r})**3": [], f"(exp(t - {a!r}) - 1)": [a],
        }  # fmt: skip
        text = list(factors)[number % len(factors)]
        side = random.choice([1, -1])
        formula = f"{text}*(t - {b!r})".replace("(t ", f"({side}*t ")
        found = run(scene(stop=20), [formula], random.choice(METHODS), 1e-10, t=[0.0, side * 20.0]).t_events[0]
        expected = sorted(side * t for t in [*factors[text], b])
        assert len(found) == len(expected) and abs(found - expected).max() < 1e-6, formula

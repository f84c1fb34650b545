"""Many motions in one call: each has the bits of its motion alone, whatever the other lanes compute."""

import math
import os
import re
import signal
import subprocess
import sys
import time
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest

import symrot
from symrot.bench import taylor as bench
from symrot.build import cache as library
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.ensemble_source import lane_definitions, multiplications
from symrot.codegen.taylor.recurrences import recurrences
from symrot.dynamics.structure import PrincipalInertia
from symrot.ensemble import lanes
from symrot.ensemble.reading import read_variation
from symrot.errors import InputError
from symrot.formula.tree import FUNCTIONS
from symrot.propagation.compiled_models import error_blocks, scene_kernel
from symrot.scene.scene import Scene
from tests.codegen.test_recurrences import FUNCTION_SYSTEMS, START, SYSTEMS, program

pytestmark = pytest.mark.usefixtures("quick_compiler")
MATH = {name: getattr(math, name) for name in FUNCTIONS if name != "abs"}
WIDTHS = (1, 2, 4, 8)
RANDOM = np.random.default_rng(20)


def small(rates, order=20, width=None):
    """Return a library for a few states in one block, with one parameter k."""
    return library.build(
        lanes.translation_unit(program(rates), (0, len(rates)), (1.0,), order, width), "small", lanes.FLAGS
    )


def follow(path, y, times, tolerance=1e-12, p=None, **options):
    y = np.array(y, dtype=float)
    return lanes.follow(
        path, np.zeros((len(y), 1)) if p is None else p, y, 0.0, np.array(times, float), tolerance, **options
    )


# ------------------------------------------------------------------------------------------------ coefficients


def compare(rates, width):
    start = {name: float(START.get(name, Fraction(1, 2))) for name in (*rates, "k", "t")}
    expected = np.array(coefficients(recurrences(program(rates)), 20, start, MATH, float)).T
    found = lanes.Lanes(str(small(rates, width=width))).jet(
        start["t"], [start[name] for name in rates], [start["k"]], 0.5
    )
    growth = 4.0 ** np.arange(21)[:, None]  # rounding errors grow with the order as the terms do
    found = found * 2.0 ** np.arange(21)[:, None]  # from half units: no bit is lost
    assert (abs(found - expected) <= 1e-15 * growth * abs(expected).max() + 1e-12 * abs(expected)).all()


@pytest.mark.parametrize("width", [1, None], ids=["plain C", "vectors"])
def test_compiled_coefficients_are_those_of_the_recurrences(width):
    """All functions are tested, a few states per library."""
    formulas = [f for rates in FUNCTION_SYSTEMS.values() for f in rates]
    groups = [formulas[i : i + 14] for i in range(0, len(formulas), 14)]
    for group in groups[:: 2 if width else 1][: None if width is None else 1]:
        compare(dict(zip(["x", "y", *(f"s{i}" for i in range(len(group) - 2))], group, strict=True)), width)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", SYSTEMS)
def test_compiled_polynomial_systems(name):
    compare(SYSTEMS[name], None)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("t", [0.0, 0.7, -1e5, 1e6 / 7, 1e9 / 3, 1e15 / 3])
def test_phases_of_torques_of_time_are_as_exact_as_the_time(width, t):
    """sin(k t + 1/3), cos(k t + 1/3), exp(k t 1e-15) at any t: k t has a relative error of 2^-78, not the 2^-53 of a
    double.
    """
    rates = {"x": "sin(k*t + 1/3)", "y": "cos(k*t + 1/3)", "z": "exp(1e-15*k*t)", "w": "sin(-k*t)*cos(2*k*t)"}
    k, third = 1.0 / 7, 1.0 / 3
    found = lanes.Lanes(str(small(rates, width=width))).jet(t, [0.0] * 4, [k])[1]
    with mpmath.workdps(60):
        phase, rest = mpmath.mpf(k) * mpmath.mpf(t), mpmath.mpf(third)
        exact = [
            mpmath.sin(phase + rest), mpmath.cos(phase + rest), mpmath.exp(mpmath.mpf(float(1e-15 * k)) * t),
            mpmath.sin(-phase) * mpmath.cos(2 * phase),
        ]  # fmt: skip
        bound = 4e-16 + abs(k * t) * 2.0**-78
        assert max(abs(value - one) for value, one in zip(found, exact, strict=True)) < bound


@pytest.mark.parametrize("width", WIDTHS)
def test_sine_and_cosine_of_states(width):
    """Arguments are inside and outside the range of the vector functions; outside, single lanes call the C library."""
    path = small({"x": "sin(x) + 0*y", "y": "cos(y)"}, width=width)
    for x in [*np.linspace(-20, 20, 41), 1e5, 131072.0, 131073.0, -1e9, 1e300]:
        found = lanes.Lanes(str(path)).jet(0.0, [x, x], [0.0])[1]
        assert abs(found[0] - float(mpmath.sin(x))) < 2.3e-16 and abs(found[1] - float(mpmath.cos(x))) < 2.3e-16


@pytest.mark.parametrize(("name", "sums", "products"), [("free asymmetric", 7, 15), ("heavy symmetric", 6, 12)])
def test_products_of_one_weight_share_an_accumulator(name, sums, products):
    """The quaternion rates are sums of products with one weight: fifteen products, seven sums."""
    rates = problem(name).kernel.rates
    text = lane_definitions(rates, problem(name).blocks, (0.0, 1.0), 20)
    assert f"a{sums - 1} = V_" in text and f"a{sums} = V_" not in text
    assert multiplications(rates, 20) == products * 20 * 21 // 2
    assert text == lane_definitions(rates, problem(name).blocks, (0.0, 1.0), 20)


def test_a_square_takes_half():
    assert multiplications(program({"x": "x**2"}), 20) == 105


# ------------------------------------------------------------------------------------------------ each as if alone


@cache
def problem(name):
    return bench.SteppedProblem(name, 1.0)


@cache
def body_library():
    own = problem("heavy asymmetric")
    return library.build(lanes.translation_unit(own.kernel.rates, own.blocks, own.scales, 16), "body")


def many(n):
    """Return initial states and parameters of n different bodies."""
    own = problem("heavy asymmetric")
    y = np.array([own.y0] * n)
    y[:, :3] *= 1 + RANDOM.standard_normal((n, 3))
    p = np.array([own.p] * n) * (1 + 0.1 * RANDOM.standard_normal((n, len(own.p))))
    return y, p


def test_a_motion_is_bitwise_the_same_in_any_order_lane_company_and_number_of_threads():
    y, p = many(13)
    times = np.linspace(0, 9, 7)
    whole = follow(body_library(), y, times, p=p)
    assert whole.messages == ("",) * 13
    assert len(set(whole.steps.tolist())) > 3  # each with a step of its own, so lanes are refilled at different times
    for workers in (2, 5):
        assert (follow(body_library(), y, times, p=p, workers=workers).states == whole.states).all()
    order = RANDOM.permutation(13)
    assert (follow(body_library(), y[order], times, p=p[order]).states == whole.states[order]).all()
    for i in (0, 5, 12):
        alone = follow(body_library(), y[i : i + 1], times, p=p[i : i + 1])
        assert (alone.states[0] == whole.states[i]).all() and alone.steps[0] == whole.steps[i]


@pytest.mark.shipped_flags
def test_the_number_of_lanes_changes_no_bit():
    paths = [small({"x": "y*z", "y": "-x*z + sin(x)", "z": "k*x*y - z/2"}, 10, width) for width in WIDTHS]
    assert [lanes.lanes(str(path)).width for path in paths] == list(WIDTHS)
    starts, p = np.random.default_rng(1).standard_normal((9, 3)), np.linspace(-1, 1, 9)[:, None]
    found = [follow(path, starts, [1.0, 5.0], p=p) for path in paths]
    assert all((other.states == found[0].states).all() for other in found[1:])


@pytest.mark.shipped_flags  # its digits need the fused operations of the flags that ship
def test_no_turn_is_lost_to_the_rounding_of_a_third():
    """After a steady rotation by 1e5 rad the phase agrees with 40 digits; a series with the double 1/3 is wrong by
    7e-13 rad.
    """
    own = problem("free asymmetric")
    path = library.build(lanes.translation_unit(own.kernel.rates, own.blocks, own.scales, 20), "free")
    rates, stop = np.random.default_rng(1).uniform(0.5, 2, 16), 1e5
    y, p = np.array([[0, 0, rate, 1, 0, 0, 0] for rate in rates]), np.array([own.p] * len(rates))
    found = follow(path, y, [stop], 1e-15, p=p).states[:, 0]
    with mpmath.workdps(40):
        angles = [mpmath.mpf(rate) * mpmath.mpf(stop) / 2 for rate in rates]
        lost = [float(mpmath.cos(a) * mpmath.mpf(q[6]) - mpmath.sin(a) * mpmath.mpf(q[3]))
                for a, q in zip(angles, found.tolist(), strict=True)]  # fmt: skip
    assert np.median(np.abs(lost)) <= 1e-13  # 3e-14 measured; 3.3e-13 without what the double lacks


@pytest.mark.parametrize("power", [-400, -60, 3, 500])
def test_no_unit_of_time_changes_a_bit(power):
    """omega 2^k and times 2^-k give the same attitudes, bit by bit."""
    own = problem("free asymmetric")
    path = library.build(lanes.translation_unit(own.kernel.rates, own.blocks, own.scales, 14), "free")
    y, p, times = np.array([own.y0] * 3), np.array([own.p] * 3), np.array([-3.0, 0.0, 1.0, 7.0])
    y[:, :3] *= [[1.0], [-2.3], [0.7]]
    plain = lanes.follow(path, p, y, 0.0, times, 1e-11).states
    y[:, :3] *= 2.0**power
    scaled = lanes.follow(path, p, y, 0.0, times * 2.0**-power, 1e-11).states
    assert (scaled[..., 3:] == plain[..., 3:]).all() and (scaled[..., :3] == plain[..., :3] * 2.0**power).all()


def test_what_does_not_move_and_what_lies_at_the_ends_of_doubles():
    path = small({"x": "y", "y": "-k*x"}, 16)
    y = [[0.0, 0.0], [1e-300, 0.0], [1e3, 1e3], [1.0, 1.0], [math.inf, 0.0], [1.0, 0.0]]
    found = follow(path, y, [5e-324, 1.0], p=np.array([[1.0], [1.0], [1.0], [0.0], [1.0], [1e-320]]))
    assert [bool(message) for message in found.messages] == [False] * 4 + [True, False]
    assert (found.states[0] == 0).all() and found.states[3, 1].tolist() == [2.0, 1.0]
    assert found.states[1, 1, 0] == pytest.approx(1e-300 * math.cos(1), rel=1e-12)
    assert found.states[2, 1, 0] == pytest.approx(1e3 * (math.cos(1) + math.sin(1)), rel=1e-12)


def test_a_motion_that_breaks_off_leaves_the_others_alone():
    """x' = x^2 ends at t = 1/x0; its samples before that time are right, those after it are NaN."""
    path = small({"x": "x**2", "y": "-x*y"})
    starts = [[-1.0, 1.0], [1.0, 1.0], [-2.0, 1.0], [0.25, 3.0], [math.nan, 1.0], [1e200, 1.0], [-3.0, 1.0]]
    times = [0.0, 0.5, 2.0]
    found = follow(path, starts, times)
    good = [0, 2, 3, 6]
    assert [i for i, message in enumerate(found.messages) if not message] == good
    exact = [[x / (1 - x * t) for t in times] for x, _ in starts]
    for i in good:
        assert abs(found.states[i, :, 0] - exact[i]).max() < 1e-12 * max(map(abs, exact[i]))
    assert found.states[1, 1, 0] == pytest.approx(2.0, abs=1e-11) and np.isnan(found.states[1, 2]).all()
    said = re.search(r"beyond t = (\S+) s on the way to 2.0 s: the step shrank", found.messages[1])
    assert said is not None and abs(float(said[1]) - 1) < 1e-12
    alone = follow(path, [starts[i] for i in good], times)
    assert (alone.states == found.states[good]).all()


def test_steps_are_counted_and_limited():
    path = small({"x": "y", "y": "-x"})
    found = follow(path, [[1.0, 0.0], [0.0, 0.0]], [1000.0], max_steps=10)
    assert found.steps[0] == 10 and "10 steps were not enough" in found.messages[0]
    assert found.messages[1] == "" and (found.states[1] == 0).all()


def test_a_hopeless_motion_is_given_up_and_leaves_the_others_alone():
    """A motion that would take far more steps than the limit went on for minutes."""
    path = small({"x": "k*y", "y": "-k*x"})
    found = follow(path, [[1.0, 0.0], [1.0, 0.0]], [1.0], p=[[1e12], [3.0]], max_steps=10**7)
    assert re.search(
        r"would need \de\+\d+ steps, far more than the largest allowed number of 10000000", found.messages[0]
    )
    assert found.messages[1] == "" and found.steps[0] == 200_000
    alone = follow(path, [[1.0, 0.0]], [1.0], p=[[3.0]])
    assert (alone.states[0] == found.states[1]).all()
    again = follow(path, [[1.0, 0.0]], [-1.0], p=[[1e12]], max_steps=10**7)
    assert "would need" in again.messages[0]
    long = follow(path, [[1.0, 0.0]], [1.0], p=[[1e6]])  # more steps than between two checks, and fewer than the limit
    assert long.messages == ("",) and long.steps[0] > 200_000


# ------------------------------------------------------------------------------------------------ times


def test_times_in_any_order_on_both_sides_of_the_start():
    path = small({"x": "y", "y": "-x"}, 16)
    times = np.array([3.0, -2.0, 0.0, 3.0, 7.5, -0.25, 0.0])
    found = follow(path, [[0.0, 1.0]] * 3, times, 1e-13)
    assert abs(found.states[:, :, 0] - np.sin(times)).max() < 1e-13
    assert (found.states[:, 2] == [0.0, 1.0]).all() and (found.states[:, 0] == found.states[:, 3]).all()
    own = np.array([times, times[::-1], np.linspace(-1, 1, 7)])
    each = follow(path, [[0.0, 1.0]] * 3, own, 1e-13)
    assert abs(each.states[:, :, 0] - np.sin(own)).max() < 1e-13
    assert (each.states[0] == found.states[0]).all() and (each.states[1] == found.states[0, ::-1]).all()
    assert follow(path, [[0.0, 1.0]], np.empty(0)).states.shape == (1, 0, 2)


def test_a_start_that_is_not_zero():
    plain = symrot.propagate_ensemble("tumbling_prism", omega=[[0.3, 1, 0.2]], t=[0, 5.0], method="taylor")
    scene = Scene.from_dict({**SCENE, "span": {"t": [10, 20], "samples": 3}})
    later = symrot.propagate_ensemble(scene, omega=[[0.3, 1, 0.2]], method="taylor")
    assert later.t.tolist() == [10.0, 15.0, 20.0] and (later.omega[0, 0] == [0.3, 1, 0.2]).all()
    assert plain.omega.shape == (1, 2, 3)


# ------------------------------------------------------------------------------------------------ accuracy


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", bench.MOTIONS)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8, 1e-12])
def test_errors_are_those_promised(name, tolerance):
    """Against final states in 40 digits, errors are below 5 tolerances, as for a single trajectory."""
    own = problem(name)
    order = lanes.order_for(tolerance)
    path = library.build(lanes.translation_unit(own.kernel.rates, own.blocks, own.scales, order), "accuracy")
    found = lanes.follow(path, np.array([own.p] * 5), np.array([own.y0] * 5), 0.0, np.array([own.stop]), tolerance)
    assert own.largest_error(found.states[0, 0], bench.reference(name)) < 5 * tolerance
    assert (found.states == found.states[0]).all()


SCENE = {
    "schema": 1, "title": "a body", "body": {"principal": [1, 2, "5/2"]}, "initial": {"omega": [1, 2, 3]},
    "span": {"t": [0, 20], "samples": 11}, "output": {"quantities": ["omega", "quaternion"]},
}  # fmt: skip
TOP = {
    **SCENE, "body": {"principal": [2, 2, 1], "about": "fixed_point"},
    "torque": [{"kind": "gravity", "weight": 3, "center_of_mass": [0, 0, "1/2"]}],
}  # fmt: skip


def scene(content=SCENE, **changes):
    return Scene.from_dict({**content, **changes}, "test")


def states(n, seed=3):
    random = np.random.default_rng(seed)
    return {"omega": random.standard_normal((n, 3)), "quaternion": random.standard_normal((n, 4))}


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("content", "parameters"),
    [
        (SCENE, {}), (SCENE, {"principal": [[1, 2, 2.5], [2, 2, 1], [3, 1, 2.5], [1, 1, 1], [5, 4, 3]]}),
        (TOP, {}), (TOP, {"weight": [1, 2, 3, 4, 0.5], "center_of_mass_3": [1, -1, 2, 0.1, 0.3]}),
    ],
    ids=["free", "free, other bodies", "top", "top, other weights"],
)  # fmt: skip
def test_lanes_agree_with_the_closed_forms(content, parameters):
    """Motions that `auto` would compute in closed form are integrated on request, and agree."""
    exact = symrot.propagate_ensemble(scene(content), parameters=parameters, **states(5))
    stepped = symrot.propagate_ensemble(scene(content), parameters=parameters, method="taylor", **states(5))
    assert exact.methods == ("exact",) * 5 and not exact.stats.steps.any()
    assert stepped.methods == ("taylor",) * 5 and stepped.success
    assert abs(exact.omega - stepped.omega).max() < 1e-11
    assert abs(exact.quaternion - stepped.quaternion).max() < 1e-11


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("torque", "parameters"),
    [
        ({"kind": "gravity_gradient", "mean_motion": "1/2"}, {"mean_motion": [0.5, 1.0, 0.1]}),
        ({"kind": "damping", "linear": ["1/10", 0, "1/5"], "quadratic": "1/100"}, {"linear": [[0, 0, 0], [0.1, 0.2, 0.3], [1, 0, 0]]}),
        ({"kind": "expression", "torque": ["a*cos(b*t)", "-a*omega_2", "q1*q2"], "parameters": {"a": 1, "b": 2}}, {"a": [0, 0.5, 2], "b": [1, 2, 3]}),
        ({"kind": "spring", "stiffness": 1, "attitude": {"quaternion": [1, 0, 0, 0]}}, {"stiffness": [1, 2, 3]}),
    ],
    ids=["gravity gradient", "damping", "expression", "spring"],
)  # fmt: skip
def test_every_trajectory_is_that_of_its_own_scene(torque, parameters):
    """The reference is DOP853 on a scene that contains the values of the trajectory."""
    start = states(3)
    found = symrot.propagate_ensemble(scene(torque=[torque]), parameters=parameters, **start)
    assert found.methods == ("taylor",) * 3
    variation = read_variation(scene(torque=[torque]), start["omega"], start["quaternion"], parameters)
    for i in (0, 2):
        alone = symrot.propagator(variation.scene_of(i), "dop853", 1e-12)()
        assert abs(alone.omega - found.omega[i]).max() < 1e-10
        assert abs(alone.quaternion - found.quaternion[i]).max() < 1e-10


def test_only_what_has_no_closed_form_is_stepped():
    torque = [{"kind": "constant_body", "torque": [0, 0, "1/10"]}]
    rates = [[0, 0, 1.0], [0.1, 0, 1.0], [0, 0, -2.0]]
    found = symrot.propagate_ensemble(scene(torque=torque), omega=rates, t=[0, 2, 40.0])
    assert found.methods == ("exact", "taylor", "exact")
    assert abs(found.omega[0, :, 2] - (1 + 0.1 * found.t / 2.5)).max() < 1e-14
    assert repr(found) == "<Ensemble of test: 3 trajectories, 3 samples, exact/taylor>"


# ------------------------------------------------------------------------------------------------ other methods


def test_torques_that_are_not_smooth_are_followed_by_dop853():
    """A root is integrated by dop853; an absolute value, whose switches are located, by Taylor series, as in a single
    motion.
    """
    for formula, method in (("-sqrt(omega_1**2 + omega_2**2)/10", "dop853"), ("-abs(omega_1)/10", "taylor")):
        made = scene(torque=[{"kind": "expression", "torque": [formula, "0", "0"]}])
        found = symrot.propagate_ensemble(made, **states(2), t=[0, 1.0], tolerance=1e-9)
        assert found.methods == (method,) * 2 and found.success


@pytest.mark.parametrize(
    "axis", [(0, 0, 1), (2 / 3, -1 / 3, 2 / 3)], ids=["about an axis of the body", "about another axis"]
)
def test_a_rotation_that_quadratic_damping_and_a_torque_reverse(axis):
    """A sphere with ``w' = -1 - |w| w`` has ``w = tan(atan(w0) - t)`` until it is at rest, and then ``-tanh(t - t0)``.

    At rest |omega| has no Taylor series; where w passes zero, the series before goes on with the wrong sign.
    """
    starts, times, axis = np.array([2.0, 0.5, 0.0, -0.25]), np.linspace(0, 3, 13), np.array(axis)
    stop = np.arctan(np.maximum(starts, 0.0))[:, None] - times
    rest = np.arctanh(np.maximum(-starts, 0.0))[:, None]
    speeds = np.where(stop > 0.0, np.tan(np.maximum(stop, 0.0)), -np.tanh(rest - np.minimum(stop, 0.0)))
    torque = [{"kind": "damping", "quadratic": 1}, {"kind": "constant_body", "torque": (-axis).tolist()}]
    made = scene(body={"principal": [1, 1, 1]}, torque=torque)
    found = symrot.propagate_ensemble(made, omega=starts[:, None] * axis, t=times)
    assert found.success and found.methods == ("dop853", "dop853", "dop853", "taylor")
    assert abs(found.omega - speeds[..., None] * axis).max() < 1e-11
    series = symrot.propagate_ensemble(made, omega=starts[:, None] * axis, t=times, method="taylor")
    assert series.status.tolist() == [-1, -1, -1, 0]
    reached = ~np.isnan(series.omega)
    assert abs(series.omega - speeds[..., None] * axis)[reached].max() < 1e-11


def test_a_rotation_that_quadratic_damping_nearly_stops():
    """A rotation that passes rest at a small distance is followed by Taylor series as closely as by DOP853."""
    torque = [{"kind": "damping", "quadratic": 1}, {"kind": "constant_body", "torque": [-1, 0, "1/1000000000"]}]
    rates = [[1, 0, 0], [0.5, 1e-7, 0], [0.3, 0, -1e-12]]
    series, steps = (symrot.propagate_ensemble(scene(torque=torque), omega=rates, t=np.linspace(0, 3, 13), method=method)
                     for method in ("auto", "dop853"))  # fmt: skip
    assert series.success and abs(series.omega - steps.omega).max() < 1e-11


def test_without_a_compiler_scipy_steps(monkeypatch):
    torque = [{"kind": "damping", "linear": "1/10"}]
    start = states(2)
    expected = symrot.propagate_ensemble(scene(torque=torque), **start, t=[0, 1.0], tolerance=1e-8)
    monkeypatch.setenv("CC", "/nowhere/cc")
    found = symrot.propagate_ensemble(scene(torque=torque), **start, t=[0, 1.0], tolerance=1e-8)
    assert found.methods == ("scipy",) * 2
    assert abs(found.omega - expected.omega).max() < 1e-7
    assert abs(found.quaternion - expected.quaternion).max() < 1e-7


def test_a_failed_trajectory_says_so():
    torque = [{"kind": "expression", "torque": ["0", "0", "5/2*omega_3**2"]}]
    rates = [[0, 0, 1.0], [0, 0, -1.0], [0.1, 0.2, -0.5]]
    for method in ("auto", "dop853"):
        found = symrot.propagate_ensemble(scene(torque=torque), omega=rates, t=[0, 0.5, 3.0], method=method)
        assert found.status.tolist() == [-1, 0, 0] and not found.success
        assert "cannot be followed beyond" in found.messages[0] and found.messages[1:] == ("", "")
        assert np.isnan(found.omega[0, 2]).all() and not np.isnan(found.omega[1:]).any()
        assert "1 stopped early" in repr(found)


@pytest.mark.parametrize(
    ("method", "switch"),
    [("taylor", ""), ("dop853", ""), ("scipy:DOP853", ""), ("taylor", " + step(t)/1000 - step(t)/1000")],
)
def test_a_motion_carries_the_warnings_of_its_trajectory(method, switch):
    """sin(t^2) is rounded by more than the tolerance late in the motion, of which ensembles said nothing."""
    torque = [{"kind": "expression", "torque": ["0", "0", f"k*sin(t**2){switch}"], "parameters": {"k": "1"}}]
    made, t = scene(body={"principal": [1, 1, 1]}, initial={"omega": [0, 0, 0]}, torque=torque), np.linspace(0, 9, 10)
    every = symrot.propagate_ensemble(made, parameters={"k": [1.0, 0.5]}, t=t, method=method, tolerance=1e-15)
    assert every[0].warnings == every.warnings[0] == symrot.propagator(made, method, 1e-15)(t).warnings
    stepped = "rounding errors, in the steps of SciPy or in a formula that contains the time"
    cause = stepped if method.startswith("scipy") else "the rounding of the torque, a formula that contains the time"
    assert cause in every.warnings[1][0]
    assert repr(every).endswith(", 2 with warnings>")
    rough = symrot.propagate_ensemble(made, parameters={"k": [1.0, 0.5]}, t=t, method=method, tolerance=1e-12)
    assert rough.warnings == ((), ()) and "warnings" not in repr(rough)


def test_the_samples_before_a_stop_stay():
    """Motions computed one by one had NaN at all times if they stopped early."""
    torque = [{"kind": "expression", "torque": ["0", "0", "5/2*omega_3**2"]}]
    for method in ("taylor", "dop853", "scipy:DOP853"):
        found = symrot.propagate_ensemble(scene(torque=torque), omega=[[0, 0, 1.0]], t=[0, 0.1, 3.0], method=method)
        assert found.status.tolist() == [-1] and found.stats.steps[0] > 0
        assert not np.isnan(found.omega[0, :2]).any() and np.isnan(found.omega[0, 2]).all()


def test_a_propagator_gives_scene_and_tolerance():
    own = symrot.propagator(scene(), tolerance=1e-5)
    found = symrot.propagate_ensemble(own, **states(2), method="taylor")
    tight = symrot.propagate_ensemble(own, **states(2), method="taylor", tolerance=1e-13)
    assert (found.stats.steps < tight.stats.steps).all() and found.t.shape == (11,)


def test_the_attitude_is_left_out_where_nobody_asks_for_it():
    found = symrot.propagate_ensemble(scene(output={"quantities": ["omega"]}), **states(2), method="taylor")
    assert found.omega.shape == (2, 11, 3)
    with pytest.raises(InputError, match="attitude was not computed"):
        _ = found.quaternion


# ------------------------------------------------------------------------------------------------ structure


@pytest.mark.parametrize(
    ("moments", "letters"),
    [([[1, 2, 3], [2, 3, 4]], "ABC"), ([[1, 1, 1.5], [2, 2, 3]], "AAC"), ([[1, 1, 1.5], [2, 3, 3]], "ABC"),
     ([[3, 2, 2], [1, 1, 1]], "ABB"), ([[2, 2, 2], [1, 1, 1]], "AAA")],
)  # fmt: skip
def test_the_plan_covers_all_bodies_and_no_more(moments, letters):
    variation = read_variation(scene(), None, None, {"principal": moments})
    assert variation.plan().structure.inertia == PrincipalInertia(letters)


def test_the_plan_does_not_trust_the_start_of_the_scene():
    """The scene rotates about one axis, but the trajectories need not."""
    flat = scene(initial={"omega": [0, 0, 1]})
    assert read_variation(flat, [[1, 2, 3]], None, None).plan().structure.planar is None
    found = symrot.propagate_ensemble(flat, omega=[[1, 2, 3.0], [0, 0, 1]], method="taylor", t=[1.0])
    exact = symrot.propagate_ensemble(flat, omega=[[1, 2, 3.0], [0, 0, 1]], t=[1.0])
    assert abs(found.omega - exact.omega).max() < 1e-12


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"omega": [1, 2, 3]}, r"omega: expected an array of shape \(n, 3\) in rad/s, got shape \(3,\)"),
        ({"omega": [[1, 2, math.nan]]}, "omega: expected finite numbers in rad/s, got nan in trajectory 0"),
        ({"omega": "fast"}, "omega: expected an array"),
        ({"quaternion": [[1, 0, 0, 0], [0, 0, 0, 0]]}, "quaternion: .* got zero in trajectory 1"),
        ({"omega": [[1, 2, 3]], "quaternion": [[1, 0, 0, 0]] * 2}, "same number of trajectories .* 1 of omega, 2 of"),
        ({"omega": np.empty((0, 3))}, "at least one trajectory"),
        ({"parameters": {"wieght": [1]}}, "parameters: expected names among .* weight.* got 'wieght'"),
        ({"parameters": {1: [1]}}, "parameters: expected names among"),
        ({"parameters": [1, 2]}, "parameters: expected a dict"),
        ({"parameters": {"weight": [1, -2]}}, "weight: expected positive values in N, got -2.0 in trajectory 1"),
        ({"parameters": {"weight": [[1]]}}, r"weight: expected an array of shape \(n,\) in N, got shape \(1, 1\)"),
        ({"parameters": {"center_of_mass": [[0, 0, 0]]}}, "center_of_mass: expected nonzero values"),
        ({"parameters": {"direction": [[0, 0, 1]]}}, "direction is the same for all trajectories"),
        ({"parameters": {"principal": [[1, 1, 3]]}}, "trajectory 0.* exceeds the sum of the other two"),
        ({"parameters": {"principal": [[1, 1, 0]]}}, "trajectory 0.*needle"),
        ({"parameters": {"principal": [[1, 1, 1]], "I_xx": [1]}}, "each constant once, got I_xx"),
        ({"t": [0, math.inf]}, "t: expected finite times"),
        ({"t": [[0, 1], [0, 1]]}, r"t: expected times in s, shape \(m,\) for all trajectories or \(1, m\)"),
        ({"t": "now"}, "t: expected times"),
        ({"workers": 0}, "workers: expected a whole number"),
        ({"method": "magic"}, "method: expected one of"),
        ({"method": "constant"}, "method: expected one of"),
        ({"tolerance": 0.0101}, "tolerance: expected a number from 1e-15 to 0.01, got 0.0101"),
        ({"omega": [[1, 2, 3]], "parameters": {"center_of_mass_1": [0.5]}, "method": "exact"}, "closed form .* has none"),
    ],
)  # fmt: skip
def test_bad_input_is_one_sentence(changes, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        symrot.propagate_ensemble(scene(TOP), **changes)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("tolerance", [1e-15, 0.01])
def test_the_ends_of_the_range_are_tolerances_for_one_motion_and_for_many(tolerance):
    """The double 0.01 is above 1/100."""
    assert symrot.propagator("t_handle", tolerance=tolerance)([0, 1]).omega.shape == (2, 3)
    assert symrot.propagate_ensemble("t_handle", t=[0, 1], tolerance=tolerance).omega.shape == (1, 2, 3)


# ------------------------------------------------------------------------------------------------ as a good citizen


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs timers")
@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_is_heard(workers):
    path = small({"x": "y", "y": "-x"})

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    began = time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            follow(path, [[1.0, 0.0]] * 8, [1e9], workers=workers)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.perf_counter() - began < 60  # the motion itself takes hours


def test_a_cached_ensemble_imports_neither_sympy_nor_scipy():
    code = (
        "import sys, symrot; e = symrot.propagate_ensemble('gravity_gradient_satellite', t=[0, 1.0]); "
        "print(e.methods, [m for m in ('sympy', 'scipy') if m in sys.modules])"
    )
    symrot.propagate_ensemble("gravity_gradient_satellite", t=[0, 1.0])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=dict(os.environ))
    assert done.stdout.strip() == "('taylor',) []", done.stderr


def test_no_error_blocks_are_assumed():
    """A plan without attitude has a single block of states, of which the lanes judge the error."""
    plan = read_variation(scene(output={"quantities": ["omega"]}), None, None, None).plan()
    assert error_blocks(plan) == ([0, 3], [0.0])
    assert "#define SYMROT_BLOCKS 1" in lane_definitions(scene_kernel(plan).rates, *error_blocks(plan), 12)
    for order, edges in ((5, (0, 3)), (2, (0, 3)), (8, (0, 2)), (8, (0, 1, 3))):
        with pytest.raises(InputError):
            lane_definitions(scene_kernel(plan).rates, edges, (0.0,), order)


@pytest.mark.parametrize("matrix", [2 * np.eye(3), -np.eye(3), np.eye(3) + 1e-6, np.full((3, 3), np.nan)])
def test_matrices_that_are_no_rotations_are_refused(matrix):
    with pytest.raises(symrot.InputError, match=r"attitude: expected rotation matrices .* in trajectory 1"):
        symrot.propagate_ensemble("t_handle", attitude=[np.eye(3), matrix], t=[0, 1])

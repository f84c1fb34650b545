"""Motions do not depend on how far from t = 0 they start: 40-digit references, starts that are doubles."""

import math
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symrot.codegen.taylor.time_shift import moved
from symrot.ensemble.ensemble import propagate_ensemble
from symrot.errors import PropagationError
from symrot.formula.exact_numbers import PI
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import evaluate, parse
from symrot.planning.scene_kernel import EXACT_FUNCTIONS, bind
from symrot.propagation import time_shift as epoch
from symrot.propagation.motions.methods import SteppedMotion
from symrot.propagation.motions.motion import on_clock
from symrot.propagation.motions.setup import SteppedSetup
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import dop853
from symrot.propagation.steppers.stepping import MAX_STEPS
from symrot.propagation.time_shift import starts_far
from symrot.scene.scene import Scene

STARTS = (0, 10**6, 10**9, 10**12, -(10**9))
TAU = (0.0, 0.5, 1.25, 2.0)
BELOW = 1e-12  # the tolerance; at t0 = 0 errors are at most 1e-13
AXIS = {"body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 0, "1/2"]}}
GENERAL = {"body": {"principal": [1, 2, 3]}, "initial": {"omega": ["3/10", 1, "1/2"]}}


def listed(kind, torque, t0):
    common = {"schema": 1, "title": "far", "span": {"t": [t0, t0 + 2], "samples": 2}, "output": {"quantities": ["omega",
              "quaternion"]}, "torque": [{"kind": "expression", "torque": torque}], "accuracy": {"tolerance": 1e-12}}  # fmt: skip
    return common | kind


def scene(*given):
    return Scene.from_dict(listed(*given), "far")


def extrapolated(rate, y, end, size):
    """Return the state at the end, by the midpoint rule extrapolated to order 20, in steps of about ``size``."""
    count = int(mpmath.ceil(end / size))
    big, now = end / count if count else end, mpmath.mpf(0)
    for _ in range(count):
        table = []
        for n in range(2, 22, 2):
            h, before, here = big / n, y, y + big / n * rate(now, y)
            for k in range(1, n):
                before, here = here, before + 2 * h * rate(now + k * h, here)
            row = [(before + here + h * rate(now + big, here)) / 2]
            for j, other in enumerate(table[-1] if table else [], start=1):
                row.append(row[-1] + (row[-1] - other) / (mpmath.mpf(n) ** 2 / (n - 2 * j) ** 2 - 1))
            table.append(row)
        y, now = table[-1][-1], now + big
    return y


def general_torque(t, y):
    return (mpmath.sin(3 * t / 2) / 4, mpmath.cos(t / 10 + 1) * y[0] / 7, mpmath.sin(t / 3) * mpmath.cos(11 * t / 10))


GENERAL_TORQUE = ["sin(3*t/2)/4", "cos(t/10 + 1)*omega_1/7", "sin(t/3)*cos(1.1*t)"]


def general_reference(t0):
    def rate(tau, y):
        torque = general_torque(mpmath.mpf(t0) + tau, y)
        w, q = y[:3], y[3:]
        return np.array([
            (-w[1]*w[2] + torque[0]), (2*w[2]*w[0] + torque[1])/2, (-w[0]*w[1] + torque[2])/3,
            (-q[1]*w[0] - q[2]*w[1] - q[3]*w[2])/2, (q[0]*w[0] + q[2]*w[2] - q[3]*w[1])/2,
            (q[0]*w[1] + q[3]*w[0] - q[1]*w[2])/2, (q[0]*w[2] + q[1]*w[1] - q[2]*w[0])/2,
        ])  # fmt: skip

    y, rows = np.array([mpmath.mpf(x) / 10 for x in (3, 10, 5, 10, 0, 0, 0)]), []
    for start, stop in zip((0.0, *TAU), TAU, strict=False):
        y = extrapolated(lambda s, y, start=start: rate(start + s, y), y, mpmath.mpf(stop - start), 0.5)
        rows.append([float(x) for x in y])
    return np.array(rows)


def axis_reference(t0, taus=TAU):
    """Return omega = 1/2 + (cos(3 t0/2) - cos(3 t/2))/(3/2 C), and its integral."""
    a, rows = mpmath.mpf(3) / 2, []
    for tau in taus:
        t = mpmath.mpf(t0) + tau
        rate = mpmath.mpf(1) / 2 + (mpmath.cos(a * t0) - mpmath.cos(a * t)) / (3 * a)
        turned = (mpmath.mpf(1) / 2 + mpmath.cos(a * t0) / (3 * a)) * tau
        turned -= (mpmath.sin(a * t) - mpmath.sin(a * t0)) / (3 * a * a)
        rows.append([0, 0, float(rate), float(mpmath.cos(turned / 2)), 0, 0, float(mpmath.sin(turned / 2))])
    return np.array(rows)


CASES = {
    "axis": (AXIS, ["0", "0", "sin(3*t/2)"], axis_reference),
    "general": (GENERAL, GENERAL_TORQUE, general_reference),
}


def error(omega, quaternion, reference):
    return np.abs(np.concatenate([omega, quaternion], axis=-1) - reference).max()


@pytest.mark.thinned(3)
@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("t0", STARTS)
def test_a_start_far_away_costs_no_digit(case, t0):
    kind, torque, reference = CASES[case]
    with mpmath.workdps(40):
        expected = reference(t0)
    times = t0 + np.array(TAU)
    for method in ("taylor", "dop853", "scipy"):
        found = propagator(scene(kind, torque, t0), method)(times)
        assert error(found.omega, found.quaternion, expected) < BELOW, method
    lanes = propagate_ensemble(scene(kind, torque, t0), omega=[[float(x) for x in expected[0][:3]]], t=times,
                               method="taylor")  # fmt: skip
    assert error(lanes.omega[0], lanes.quaternion[0], expected) < BELOW


@pytest.mark.usefixtures("quick_compiler")
def test_the_clock_of_the_scene_would_cost_them():
    """Without the shift of time, phases that are rounded to 1e-7 rad look like a torque that varies in every step."""
    found = propagator(scene(AXIS, CASES["axis"][1], 10**9), "dop853")
    motion = found._motion
    shared = SteppedSetup(replace(motion.setup, allows_time_shift=False), motion.library)
    found._motion = SteppedMotion(shared, motion.plan)
    with pytest.raises(PropagationError, match="the step shrank to nothing"):
        found(10**9 + np.array(TAU))


def test_taylor_steps_keep_phases_over_a_long_span():
    """``1.5 t`` is computed from a time in two parts: with one double, omega was off by 3e-10 after 1e5 s."""
    with mpmath.workdps(40):
        expected = axis_reference(0, (100_000,))
    found = propagator(scene(AXIS, CASES["axis"][1], 0), "taylor")([100_000])
    assert abs(found.omega[0, 2] - expected[0][2]) < 2e-14


@pytest.mark.thinned(4)
@pytest.mark.parametrize("t0, end", [(0, 10_000), (0, -10_000), (-400, 9_000), (10_000, 20_000)])
def test_dormand_prince_steps_keep_phases_over_a_long_span(t0, end):
    """Samples, dense output and events keep the tolerance, with the scene's clock and with a shifted one."""
    middle, promised = (t0 + end) / 2, 5 * BELOW
    with mpmath.workdps(40):
        halfway, last = (float(row[2]) for row in axis_reference(t0, (middle - t0, end - t0)))
    found = propagator(scene(AXIS, CASES["axis"][1], t0), "dop853")
    trajectory = found([middle, end])
    assert np.abs(trajectory.omega[:, 2] - [halfway, last]).max() < promised
    eventful = found([t0, end], events=[f"omega_3 == {halfway!r}"])
    assert abs(eventful.sol(middle)[2] - halfway) < promised
    assert np.abs(eventful.t_events[0] - middle).min() < 20 * promised  # omega changes at some 0.1 rad/s^2
    assert abs(eventful.omega[-1, 2] - last) < promised
    many = propagate_ensemble(scene(AXIS, CASES["axis"][1], t0), omega=[[0, 0, 0.5]] * 2, t=[end], method="dop853")
    assert np.abs(many.omega[:, 0, 2] - last).max() < promised


def test_one_time_for_all_steps_would_lose_phases(monkeypatch):
    """With ``1.5 t`` rounded, at 1e5 s omega was off by 3e-8, and before 1e6 s steps shrank to nothing."""
    with mpmath.workdps(40):
        expected = float(axis_reference(0, (10_000,))[0][2])
    monkeypatch.setattr(dop853, "WINDOW", MAX_STEPS)
    monkeypatch.setattr(dop853, "FAR", math.inf)
    found = propagator(scene(AXIS, CASES["axis"][1], 0), "dop853")([10_000])
    assert abs(found.omega[0, 2] - expected) > 20 * BELOW


@pytest.mark.usefixtures("quick_compiler")
def test_parameters_follow_the_epoch_exactly():
    """Parameters updated for a new epoch are equal to those computed anew for it."""
    found = propagator(scene(GENERAL, GENERAL_TORQUE, 10**6), "dop853")._motion
    plan, kernel = epoch.time_shifted(found.plan, found.kernel)
    following = epoch.ShiftedParameters(kernel.rate_parameters, plan.constants, 0.1)
    for since in (0.0, 1 / 3, -(10**9)):
        values = {**plan.constants, "epoch": Fraction(0.1) + Fraction(since)}
        assert following.parameters(since) == bind(kernel.rate_parameters, values)


@pytest.mark.usefixtures("quick_compiler")
def test_the_motion_between_samples_starts_far_away_too():
    t0 = 10**15  # numbers lie 1/8 s apart
    trajectory = propagator(scene(AXIS, CASES["axis"][1], t0), "taylor")([t0, t0 + 2.0])
    with mpmath.workdps(40):
        expected = axis_reference(t0)
    omega_and_attitude = trajectory.sol(t0 + np.array(TAU)).T
    assert np.abs(omega_and_attitude - expected).max() < BELOW


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy"])
def test_events_far_away_are_found_on_the_same_clock(method):
    """omega = 1/2 + 2 (cos(3 t0/2) - cos(3 t/2))/9 takes its value of t0 + 1/2 there, and elsewhere by symmetry."""
    t0 = 10**9
    with mpmath.workdps(40):
        level = float(axis_reference(t0)[1][2])
    found = propagator(scene(AXIS, CASES["axis"][1], t0), method)([t0, t0 + 2.0], events=[f"omega_3 == {level!r}"])
    apart = np.abs(np.array(found.t_events[0]) - (t0 + 0.5)).min()
    assert apart <= 2 * np.spacing(float(t0))
    assert np.abs(found.y_events[0][:, 2] - level).max() < BELOW


# --- the moved right-hand side ----------------------------------------------------------------------------------------

FORMULAS = (
    "k*t**3/7 - 2*t + y", "sin(k*t + 1)*exp(-t/10**9)*y", "cos((t - 5)*(k + t)/3)/(1 + t**2)", "tan(t)*t*y + a*y",
    "sqrt(2*k)*t - atan(t/k) + abs(k)", "y**2*t + sin(y + t)", "(t - 10**9)**5 + a**2", "k*y",
)  # fmt: skip


def program(formula):
    numbers = (("y", "", ""),)
    arguments = (
        Argument("t", "in", (("t", "", ""),), is_scalar=True), Argument("y", "in", numbers),
        Argument("p", "in", (("k", "", ""),)), Argument("dy", "out", (("dy", "", ""),)),
    )  # fmt: skip
    return Program(Signature("f", arguments), (("a", parse("k*t + 3")),), (("dy", parse(formula)),))


MPMATH = {name: getattr(mpmath, name) for name in ("sin", "cos", "tan", "exp", "sqrt", "atan")} | {"abs": abs}


@pytest.mark.parametrize("formula", FORMULAS)
def test_moved_rates_are_the_rates_at_a_later_time(formula):
    """f(epoch + tau, y) agrees in 60 digits; parameters are kept as exactly as they are computed."""
    constants, epoch, tau = {"constant": Fraction(7, 11)}, Fraction(10**9) + Fraction(3, 8), Fraction(5, 13)
    here, parameters = program(formula), (("k", ("symbol", "constant")),)
    there, formulas = moved(here, parameters)
    values = {**constants, "epoch": epoch}
    exact = {name: evaluate(node, values, EXACT_FUNCTIONS) for name, node in formulas}
    with mpmath.workdps(60):

        def number(value):
            return mpmath.mpf(Fraction(value).numerator) / Fraction(value).denominator

        state = {"y": number(Fraction(2, 3))}
        one = here.evaluate({**state, "t": number(epoch + tau), "k": number(exact["k"])}, MPMATH, number)
        p = {name: number(value) for name, value in exact.items()}
        two = there.evaluate({**state, **p, "t": number(tau)}, MPMATH, number)
        assert abs(one["dy"] - two["dy"]) <= abs(one["dy"]) * mpmath.mpf(10) ** -25


def test_large_coefficients_become_parameters():
    """Doubles then hold no phase beyond a turn and no difference of large numbers."""
    _, formulas = moved(program("sin(3*t/2) + (t - 10**9)**2"), (("k", ("symbol", "constant")),))
    values = bind(formulas, {"constant": Fraction(1), "epoch": Fraction(10**9)})
    named = {name: value for (name, _), value in zip(formulas, values, strict=True)}
    assert all(abs(value) <= float(PI) for name, value in named.items() if name != "k")


def test_the_time_is_found_where_it_is_needed():
    assert not program("k*y").uses("t", ("dy",)) and program("a*y").uses("t", ("dy",)) and program("k*y").uses("k")


@pytest.mark.parametrize("start", [1e9 + 0.3, -7.1, 1e15, 3e-300])
def test_the_clock_is_moved_where_no_time_is_rounded(start):
    times = start * np.random.default_rng(4).uniform(0.5, 2.0, 200)
    assert starts_far(start, times.min(), times.max())
    assert all(Fraction(t) - Fraction(start) == Fraction(t - start) for t in times.tolist())
    assert not starts_far(start, min(-start, start), abs(start)) and not starts_far(0.0, 0.0, 1.0)


@pytest.mark.usefixtures("quick_compiler")
def test_without_time_in_the_torque_nothing_is_compiled_anew():
    found = propagator(scene(GENERAL, ["omega_1/9", "0", "q1/7"], 10**9), "taylor")._motion
    far_away = on_clock(found, np.array([1e9, 1e9 + 2]))
    assert far_away is not found and far_away.library == found.library


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("method", ["scipy", "taylor"])
def test_a_motion_with_events_that_breaks_off_names_the_time_of_the_scene(method):
    """The root loses its value at 5 s of the shifted clock; the message gives the scene's time instead."""
    broken = propagator(scene(GENERAL, ["sqrt(1000000005 - t)", "0", "0"], 10**9), method)
    with pytest.raises(PropagationError, match=r"beyond t = 100000000[45]\.\d+ s"):
        broken(10**9 + np.array([0.0, 9.0]), events=["omega_1 == 1e9"])


@pytest.mark.usefixtures("quick_compiler")
def test_a_motion_that_was_derived_before_needs_no_sympy_far_away():
    given = (AXIS, CASES["axis"][1], 10**9)
    propagator(scene(*given))()
    code = (
        "import sys; from symrot.scene.scene import Scene; from symrot.propagation.propagate import propagator;"
        f"propagator(Scene.from_dict({listed(*given)!r}, 'far'))(); assert not {{'sympy', 'scipy'}} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


# --- sentences --------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("quick_compiler")
def test_a_clock_that_is_too_coarse_is_said_to_be():
    """A torque function is called with the scene's times, so its motion cannot use a shifted clock."""
    driven = propagator(scene(GENERAL, ["0", "0", "omega_1/9"], 10**15), torque=lambda t, w, q: (0.0, 0.1, 0.0))
    with pytest.raises(PropagationError, match=r"doubles, which lie 0\.125 s apart"):
        driven(10**15 + np.array([0.0, 5.0]))


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_a_singularity_far_away_is_one_and_has_its_time(method):
    """omega_3' = omega_3^2 from omega_3 = 2 ends after 1/2 s."""
    body = {"body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 2]}}
    with pytest.raises(PropagationError, match=r"beyond t = 1000000000\.[45]\d* s .*: (?!the clock)"):
        propagator(scene(body, ["0", "0", "omega_3**2 + 0*t"], 10**9), method)([10**9, 10**9 + 2])

"""Tests of the campaign of random torques: two ways to the same truth agree, and wrong trajectories are found wrong."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import asinh, erf, exp, pi, sinh, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.campaigns.torques import arcs
from tests.campaigns.torques import campaign as torques
from tests.campaigns.torques.checks import contradiction
from tests.campaigns.torques.collocation import Feature, follow
from tests.campaigns.torques.pool import run_all
from tests.campaigns.torques.references import Problem, Truth, attitude_apart, reference
from tests.campaigns.torques.rehearsal import rehearse
from tests.campaigns.torques.verdict import Answer, Result, measure

PULSE = Problem(
    (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), 0.0, 0.0, 4.0, ("0", "0", "m*exp(-((t-c)/w)**2)"),
    {"m": 300.0, "c": 1.3, "w": 0.01}, [Feature(1.3, 0.01)], speed=2.0,
)  # fmt: skip
TUMBLING = replace(PULSE, omega=(0.4, 2.0, -0.3), texts=("0", "m*exp(-((t-c)/w)**2)", "-m*exp(-((t-c)/w)**2)/3"))
BUMP = replace(
    PULSE, omega=(0.0, 0.0, 2.0), high=1.4, texts=("0", "0", "m*exp(-((2*atan2(q3, q0)-c)/w)**2)"),
    features=[Feature(1.3, 0.01, lambda y: 2 * np.arctan2(y[..., 6], y[..., 3]), lambda y: y[..., 2], 200.0)],
    parameters={"m": 120.0, "c": 1.3, "w": 0.01},
)  # fmt: skip


PROBLEMS = {"pulse": PULSE, "tumbling": TUMBLING, "bump": BUMP}


@cache
def truth_of(name):
    """Return the reference of a problem, computed once for all tests."""
    return reference(PROBLEMS[name])


# --- two ways to the same truth ---------------------------------------------------------------------------------------


def test_the_reference_gives_the_error_function():
    times = np.array([0.1, 1.29, 1.3, 1.304, 2.0, 4.0])
    true = [sqrt(pi) / 2 * (erf((t - 1.3) / 0.01) + 1) for t in times]
    assert np.abs(truth_of("pulse").motion(times)[:, 2] - true).max() < 2e-15


def test_a_tumbling_body_agrees_with_scipy_in_small_steps():
    def rates(t, y):
        w, q = y[:3], y[3:]
        pulse = 300 * np.exp(-(((t - 1.3) / 0.01) ** 2))
        turn = (np.array([0, pulse, -pulse / 3]) + np.cross(np.array([1, 2, 3]) * w, w)) / np.array([1, 2, 3])
        return [*turn, -(q[1:] @ w) / 2, *((q[0] * w + np.cross(q[1:], w)) / 2)]

    y, edges = np.array([0.4, 2.0, -0.3, 1, 0, 0, 0]), [0, 1.2, 1.4, 4.0]
    for low, high in pairwise(edges):
        step = 1e-3 if low == 1.2 else 0.05
        y = solve_ivp(rates, (low, high), y, method="DOP853", rtol=1e-13, atol=1e-14, max_step=step).y[:, -1]
    found = truth_of("tumbling").motion([4.0])[0]
    assert np.abs(found[:3] - y[:3]).max() < 1e-10 * np.abs(y[:3]).max()
    assert attitude_apart(found[3:], y[3:]) < 1e-10


def test_momentum_and_work_agree_with_the_reference():
    for name, problem in PROBLEMS.items():
        assert contradiction(problem, truth_of(name), again=True) == ""
    sphere = replace(TUMBLING, principal=(2.0, 2.0, 2.0))
    assert contradiction(sphere, reference(sphere), again=True) == ""


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_a_reference_that_steps_over_a_feature_contradicts_the_law(problem):
    """The mutant takes the torque for zero, like a reference that is not told of the feature."""
    blind = reference(replace(problem, texts=("0", "0", "0"), features=[]))
    assert contradiction(problem, blind, again=True)


def test_backwards_is_the_way_back():
    """From the final state, the reference returns to the start."""
    there = truth_of("tumbling").motion([4.0])[0]
    w, q = [float(x) for x in there[:3]], [float(x) for x in there[3:]]
    back = replace(TUMBLING, omega=tuple(w), quaternion=tuple(q), t0=4.0)
    start = reference(back).motion([0.0])[0]
    assert np.abs(start[:3] - np.array(TUMBLING.omega)).max() < 1e-12
    assert attitude_apart(start[3:], np.array(TUMBLING.quaternion)) < 1e-12


def test_jumps_are_told_as_times():
    step = replace(
        PULSE, texts=("0", "0", "where(t < c, 0, m)"), parameters={"m": 3.0, "c": 1.3}, features=[], breaks=[1.3]
    )
    times = np.array([1.0, 1.3, 1.5, 4.0])
    assert np.abs(reference(step).motion(times)[:, 2] - np.maximum(times - 1.3, 0)).max() < 1e-15


def test_collocation_refuses_what_it_cannot_follow(monkeypatch):
    monkeypatch.setattr("tests.campaigns.torques.collocation.MOST_STEPS", 1000)  # it gives up as soon, in whatever time

    def pole(t, y):  # t has no axis of states
        return 1 / (t[..., None] - 0.5) ** 3 + 0 * y

    with pytest.raises(ArithmeticError, match="the reference came to t"):
        follow(pole, np.zeros((1, 1)), 0.0, 1.0, [])


def obeys(motion, acceleration, low, high):
    """Return whether omega is the rate of the angle, and ``acceleration`` the rate of omega, away from jumps."""
    t = np.sort(np.random.default_rng(4).uniform(low, high, 400)).astype(np.longdouble)
    h = np.longdouble(1e-5) * (high - low)
    (w, x), (w1, x1), (w0, x0) = motion(t), motion(t + h), motion(t - h)
    a = acceleration(t, w, x)
    smooth = (acceleration(t + h, w1, x1) - acceleration(t - h, w0, x0)).astype(float)
    away = np.abs(smooth) < 1e-3 * np.abs(a).max()
    assert away.mean() > 0.9
    bend = 1e-6 * np.abs(a).max() + np.abs(smooth)  # of a corner within h
    assert (np.abs((w1 - w0) / 2 / h - a) < bend)[away].all()
    assert np.abs((x1 - x0) / 2 / h - w).max() < 1e-4 * np.abs(w).max()
    assert np.abs(np.diff(motion(np.linspace(low, high, 20001))[1])).max() < 2e-4 * (high - low) * np.abs(w).max()


@pytest.mark.parametrize("omega", [0.0, 1.0, -2.0])
def test_dry_friction_obeys_its_equation(omega):
    drive = arcs.sine_drive(1.5, 2.0)

    def acceleration(t, w, x):
        push = 1.5 * np.sin(2 * t)
        held = (np.abs(w) < 1e-12) & (np.abs(push) <= 0.7)
        return np.where(held, 0, push - 0.7 * np.where(np.abs(w) < 1e-12, np.sign(push), np.sign(w))) / 3

    obeys(arcs.dry_friction(3.0, 0.7, drive, 0.0, omega, 12.0), acceleration, 0.01, 11.9)


def test_dry_friction_alone_stops_when_the_formula_says():
    rate, angle = arcs.dry_friction(3.0, 1.0, arcs.constant_drive(0.0), 0.0, 1.0, 10.0)([1.5, 3.0, 9.0])
    assert rate.tolist() == [0.5, 0, 0] and angle.tolist() == [1.125, 1.5, 1.5]


def test_bang_bang_control_obeys_its_equation_and_slides():
    motion = arcs.bang_bang(2.0, 1.0, 0.4, 1.0, 0.0, 0.3, 30.0)
    first = next(t for t in np.linspace(0, 30, 3001) if abs(motion([t])[1][0] - 1 + 0.4 * motion([t])[0][0]) < 1e-12)

    def acceleration(t, w, x):
        side = x - 1 + 0.4 * w
        return np.where(np.abs(side) < 1e-12, -w / 0.4, -np.sign(side) / 2)

    obeys(motion, acceleration, 0.01, 29.9)
    assert 0 < first < 29  # it came to slide
    assert abs(motion([30.0])[1][0] - 1) < 1e-6


def test_a_wall_gives_back_the_rate():
    motion = arcs.stepped(lambda i, j: (0.0, -5.0)[i], (0.5,), (), 0.0, 1.0, 5.0)
    rate, angle = motion(np.array([0.4, 0.5 + 0.2, 1.0]))
    assert np.abs(rate - [1, 0, -1]).max() < 1e-15 and np.abs(angle - [0.4, 0.6, 0.4]).max() < 1e-15


def test_a_rate_between_two_pushes_is_held():
    motion = arcs.stepped(lambda i, j: (1.0, -1.0)[j], (), (2.0,), 0.0, 1.0, 5.0)
    assert motion(np.array([0.5, 1.0, 4.0]))[0].tolist() == [1.5, 2, 2]


@pytest.mark.campaign
def test_soft_friction_is_an_inverse_hyperbolic_sine():
    motion = arcs.soft_friction(3.0, 2.0, 0.5, 0.0, 4.0)
    rate, angle = motion(np.array([0.0, 1.0, 10.0]))
    assert np.abs(rate - [0.5 * asinh(sinh(8.0) * exp(-2 * t / 1.5)) for t in (0, 1, 10)]).max() < 1e-15
    obeys(motion, lambda t, w, x: -2 * np.tanh(w / 0.5) / 3, 0.01, 8.0)
    assert abs(angle[0]) < 1e-15


# --- a wrong trajectory is seen as wrong ------------------------------------------------------------------------------


def answer(truth, tolerance, rate=0.0, turn=0.0, sentence="", sign=1):
    """Return the truth with an error of so many tolerances in omega and in attitude at one dense time."""
    times = np.linspace(0.5, 4.0, 30)
    states = truth.motion(times)
    states[17, 2] += rate * tolerance * truth.omega_scale
    q0, q3 = states[17, 3].copy(), states[17, 6].copy()
    half = turn * tolerance / 2
    states[17, 3], states[17, 6] = q0 * np.cos(half) - q3 * np.sin(half), q0 * np.sin(half) + q3 * np.cos(half)
    states[:, 3:] *= sign
    return Answer(times, states.astype(float), sentence, False)


@pytest.fixture(scope="module")
def truth():
    return truth_of("pulse")


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
@pytest.mark.parametrize(
    ("errors", "outcome"),
    [
        ({"rate": 15}, "right"),
        ({"turn": 15}, "right"),
        ({"sign": -1}, "right"),
        ({"rate": 30}, "wrong"),  # a torque of time alone: a change of omega does not grow
        ({"turn": 1e5}, "wrong"),
        ({"rate": 15, "sentence": "it stopped at t = 4 s"}, "sentence"),
        ({"rate": 30, "sentence": "it stopped at t = 4 s"}, "wrong"),
    ],
)
def test_an_error_is_judged_by_its_size(truth, tolerance, errors, outcome):
    assert measure(answer(truth, tolerance, **errors), truth, tolerance)[0] == outcome


def test_growth_excuses_no_more_than_itself(truth):
    grown = Truth(truth.motion, truth.omega_scale, truth.rounding, (10.0, 10.0), truth.turned)
    assert measure(answer(truth, 1e-8, rate=150), grown, 1e-8)[0] == "growth"
    assert measure(answer(truth, 1e-8, rate=250), grown, 1e-8)[0] == "wrong"


def test_a_missed_pulse_is_wrong(truth):
    """A method that steps over the pulse answers that the body stays at rest."""
    times = np.linspace(0.5, 4.0, 30)
    states = np.zeros((30, 7))
    states[:, 3] = 1
    assert measure(Answer(times, states, "", False), truth, 1e-6)[0] == "wrong"


def test_states_that_are_no_numbers_are_wrong_and_silence_too(truth):
    states = np.full((3, 7), np.nan)
    assert measure(Answer(np.array([1.0, 2, 3]), states, "", False), truth, 1e-6)[0] == "wrong"
    assert measure(Answer(np.empty(0), np.empty((0, 7)), "", False), truth, 1e-6)[0] == "wrong"


def test_the_rounding_of_a_narrow_pulse_is_small_beside_the_tolerance(truth):
    """The limits of doubles excuse little: 1e-13 of omega here, for a pulse of 1/400 of the span."""
    assert truth.rounding[0] < 1e-13 * truth.omega_scale * 30


# --- the campaign itself ----------------------------------------------------------------------------------------------


@pytest.mark.thinned(4)
@pytest.mark.parametrize("family", torques.FAMILIES)
def test_each_family_makes_the_same_case_again_with_a_truth(family):
    one, two = (torques.case_of(family, 3, 11) for _ in range(2))
    assert (one.problem.texts, one.problem.parameters, one.method) == (
        two.problem.texts,
        two.problem.parameters,
        two.method,
    )
    assert one.samples.tolist() == two.samples.tolist() and one.dense.tolist() == two.dense.tolist()
    found = reference(one.problem)
    assert contradiction(one.problem, found) == ""
    reached = one.dense[one.dense <= one.problem.reach]
    states = found.motion(reached)
    assert np.isfinite(states).all()
    assert np.abs((states[:, 3:] ** 2).sum(axis=1) - 1).max(initial=0) < 1e-12


def test_all_cases_are_dealt_out():
    jobs = torques.jobs_of(500, list(torques.FAMILIES), 1)
    assert len(jobs) == len(set(jobs)) == 500
    assert {family for family, _ in jobs} == set(torques.FAMILIES)


def test_a_case_that_hangs_or_dies_is_counted_and_the_others_go_on(monkeypatch):
    monkeypatch.setattr("tests.campaigns.torques.pool.STARTING", 0.0)
    ended = run_all(rehearse, ["a", "hang", "b", "die", "c"], 2, 1.0, lambda job, why: f"{why}: {job}")
    assert sorted(ended) == ["done a", "done b", "done c", "no end: hang", "traceback: die"]


def test_the_report_lists_every_wrong_one():
    def made(index, outcome):
        return Result(f"angle:{index}", "angle", "taylor", "bump", outcome, "omega off by 1 rad/s", 1e6, 1.0, 0.1)

    text = "\n".join(torques.report([made(1, "right"), made(2, "wrong"), made(3, "no end")], 5, 10))
    assert "--seed 5 --case angle:2" in text and "--case angle:3" in text and "--case angle:1" not in text


def test_an_interrupted_campaign_goes_on_where_it_stopped(tmp_path):
    """Results of the same seed count again; results of another seed or in a cut line do not."""
    path = tmp_path / "results"
    result = Result("angle:1", "angle", "taylor", "bump", "wrong", "omega off by 1 rad/s", 1e6, 1.0, 0.1)
    torques.Record(str(path), 5, ("taylor",)).add(result)
    torques.Record(str(path), 6, ("taylor",)).add(result._replace(key="angle:2"))
    with path.open("a") as file:
        file.write('{"seed": 5, "meth')
    assert torques.Record(str(path), 5, ("taylor",)).results() == [result]
    assert torques.Record(str(path), 5, ()).results() == []

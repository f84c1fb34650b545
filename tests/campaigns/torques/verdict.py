"""Run symrot on a case and judge the result by the truth."""

import math
import re
import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tests.campaigns.torques.cases import Case, scene_of
from tests.campaigns.torques.checks import contradiction
from tests.campaigns.torques.formulas import torque_function
from tests.campaigns.torques.references import Truth, attitude_apart, reference

__all__ = ["ALLOWED", "OUTCOMES", "Answer", "Result", "judge", "measure", "run"]

ALLOWED = 20.0  # tolerances
CHECKED_AGAIN = 8  # every so many-th case that no law decides is followed twice
LARGEST_ERROR = 0.1  # where growth allows more than this share of the motion, nothing is asked any more

OUTCOMES = {
    "right": "within 20 tolerances",
    "growth": "within 20 tolerances times the growth of a change of the start",
    "sentence": "ended in a sentence, and right as far as it came",
    "warned": "beyond 20 tolerances, with a warning; torques without a formula alone",
    "no formula": "the same without a warning, while trajectories have no place for one",
    "wrong": "beyond what growth explains, without a word",
    "traceback": "an exception that is no sentence",
    "no end": "beyond the time limit",
    "doubt": "the reference could not follow the motion, or contradicts itself",
}
WRONG = ("wrong", "traceback", "no end")


class Answer(NamedTuple):
    """The result of symrot: states (omega, quaternion) at times, the reason if it stopped early, and whether it warned."""

    times: Any
    states: Any  # (n, 7); only rows that it vouches for
    sentence: str
    warned: bool


class Result(NamedTuple):
    """The outcome of a case: one of :data:`OUTCOMES`, with its largest error in tolerances and the growth allowed."""

    key: str
    family: str
    method: str
    shape: str
    outcome: str
    detail: str
    tolerances: float
    growth: float
    seconds: float  # of symrot


def run(case: Case) -> list[Answer]:
    """Return symrot's answers: one, or one for each motion of an ensemble."""
    import symrot

    method, _, way = case.method.partition(" ")
    no_formula = method in ("function", "table")
    try:
        scene = symrot.Scene.from_dict(scene_of(case.problem, case.tolerance, torque=not no_formula))
    except symrot.InputError as error:  # a number beyond those that scenes may have
        return [Answer(np.empty(0), np.empty((0, 7)), str(error), False) for _ in range(1 + len(case.others))]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        if way == "ensemble":
            return _ensemble(symrot, case, scene, method)
        try:
            options: dict[str, Any] = {"state": way} if way else {}
            if no_formula:
                options, method = {"torque": _without_formula(case)}, "auto"
            follow = symrot.propagator(scene, method, case.tolerance, **options)
            trajectory = follow(case.samples)
        except (symrot.PropagationError, symrot.InputError) as error:
            partial = getattr(error, "trajectory", None) or getattr(error, "partial", None)
            if partial is None:
                return [Answer(np.empty(0), np.empty((0, 7)), str(error), False)]
            return [Answer(partial.t, np.hstack([partial.omega, partial.quaternion]), str(error), False)]
        times, states = [trajectory.t], [np.hstack([trajectory.omega, trajectory.quaternion])]
        sentence = "" if trajectory.success and trajectory.status >= 0 else str(trajectory.message)
        dense = case.dense if not sentence else case.dense[case.dense <= trajectory.t.max(initial=-math.inf)]
        if len(dense):
            try:
                times.append(dense)
                states.append(trajectory.sol(dense).T)
            except (symrot.PropagationError, symrot.InputError) as error:
                times.pop()
                sentence = sentence or str(error)
    marked = [getattr(trajectory, name, None) for name in ("warnings", "warning")]
    warned = bool(caught) or any(map(bool, marked))
    return [Answer(np.concatenate(times), np.concatenate(states), sentence, warned)]


def _ensemble(symrot: Any, case: Case, scene: Any, method: str) -> list[Answer]:
    starts = [case.problem.omega, *case.others]
    try:
        found = symrot.propagate_ensemble(
            scene, omega=starts, t=case.samples, method=method, tolerance=case.tolerance, workers=1
        )
    except (symrot.PropagationError, symrot.InputError) as error:
        return [Answer(np.empty(0), np.empty((0, 7)), str(error), False) for _ in starts]
    answers = []
    for i in range(len(starts)):
        states = np.hstack([found.omega[i], found.quaternion[i]])
        good = np.isfinite(states).all(axis=1) if found.status[i] else np.ones(len(states), dtype=bool)
        answers.append(Answer(case.samples[good], states[good], found.messages[i], False))
    return answers


def _without_formula(case: Case) -> Any:
    torque = torque_function(case.problem.texts, case.problem.parameters, np.float64)
    if case.method == "function":
        return lambda t, omega, quaternion: torque(t, np.concatenate([omega, quaternion]))
    assert case.table is not None
    times = case.table[0]
    return times, torque(times, np.zeros((len(times), 7)))


def measure(answer: Answer, truth: Truth, tolerance: float) -> tuple[str, float, float, str]:
    """Return an answer's outcome, its largest error in tolerances, the growth allowed, and a text with details.

    Errors of omega are relative to the largest omega on the way; the part that rounding of the torque's formula
    explains is subtracted first.
    """
    growth = max(1.0, *truth.growth)
    if not len(answer.times):
        return ("sentence" if answer.sentence else "wrong"), 0.0, growth, answer.sentence or "no state and no sentence"
    if not np.isfinite(answer.states).all():
        return "wrong", np.inf, growth, "states that are not finite"
    true = truth.motion(answer.times)
    rates = np.sqrt(((answer.states[:, :3] - true[:, :3]) ** 2).sum(axis=1)).astype(float)
    turns = attitude_apart(answer.states[:, 3:], true[:, 3:]).astype(float)
    scale, (lost, turned) = truth.omega_scale, truth.rounding
    excess = [np.maximum(rates - lost, 0) / scale, np.maximum(turns - turned, 0)]
    errors = [float(e.max()) / tolerance for e in excess]
    grown = [max(1.0, g) for g in truth.growth]
    worst = max(errors)
    outcome = "sentence" if answer.sentence else "right"
    if worst > ALLOWED:
        limits = [ALLOWED * g for g in grown]
        fair = [e <= limit or limit * tolerance > LARGEST_ERROR for e, limit in zip(errors, limits, strict=True)]
        outcome = ("sentence" if answer.sentence else "growth") if all(fair) else "wrong"
    which = int(np.argmax(errors))
    at = int(np.argmax(excess[which]))
    name, size, unit = (("omega", rates, "rad/s"), ("attitude", turns, "rad"))[which]
    detail = (
        f"{name} off by {size[at]:.3g} {unit} at t = {float(answer.times[at])!r} s (largest omega {scale:.3g} rad/s)"
    )
    return outcome, worst, growth, answer.sentence if outcome == "sentence" else detail


def judge(case: Case, started: Callable[[], None] = lambda: None) -> Result:
    """Return the outcome of a case; ``started`` is called when the truth is known and symrot's run begins."""

    def result(outcome: str, detail: str, worst: float = 0.0, growth: float = 1.0, seconds: float = 0.0) -> Result:
        return Result(case.key, case.family, case.method, case.shape, outcome, detail, worst, growth, seconds)

    try:
        truths = [reference(case.problem)]
        if reason := contradiction(case.problem, truths[0], again=case.index % CHECKED_AGAIN == 0):
            return result("doubt", reason)
        for omega in case.others:
            truths.append(reference(replace(case.problem, omega=omega)))
    except ArithmeticError as reason:
        return result("doubt", str(reason))
    started()
    began = time.perf_counter()
    try:
        answers = run(case)
    except Exception:
        last = traceback.format_exc().strip().splitlines()
        return result("traceback", " | ".join(line.strip() for line in last[-3:]), seconds=time.perf_counter() - began)
    seconds = time.perf_counter() - began
    found = []
    for answer, truth in zip(answers, truths, strict=True):
        outcome, worst, growth, detail = measure(_within(answer, case), truth, case.tolerance)
        passed = [pole for pole in case.problem.poles if len(answer.times) and answer.times.max() > pole]
        if passed and not answer.sentence:
            outcome, detail = "wrong", f"went on behind the pole at t = {passed[0]!r} s"
        if outcome == "wrong" and case.method in ("function", "table"):
            outcome = "warned" if answer.warned else "wrong" if _warnings_exist() else "no formula"
        found.append((list(OUTCOMES).index(outcome), outcome, detail, worst, growth))
    _, outcome, detail, worst, growth = max(found)
    return result(outcome, detail, worst, growth, seconds)


def _warnings_exist() -> bool:
    from symrot import Trajectory

    return any("warning" in name for name in dir(Trajectory))


def _within(answer: Answer, case: Case) -> Answer:
    """Return the part of an answer that the reference covers."""
    part = answer.times <= case.problem.reach
    if part.all():
        return answer
    return answer._replace(times=answer.times[part], states=answer.states[part], sentence=answer.sentence or "beyond")


def grouped(sentence: str) -> str:
    """Return a sentence without its numbers, so that equal failures are counted together."""
    return re.sub(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", "#", sentence)[:160]

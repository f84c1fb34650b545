"""Reference states of a scene's motion, computed by several independent methods, and their differences.

The methods are the rows of :data:`REFERENCES`. The first available reference is used, and the others are compared with
it; if there are others and none of them agrees, an error is raised. All start from the exact numbers of the scene, and
none steps over a narrow pulse of a torque.
"""

import ctypes
import json
import math
import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from time import perf_counter, process_time
from typing import Any, NamedTuple

import mpmath
import numpy as np

from symrot.bench.by_hand import BY_HAND
from symrot.bench.comparison.exact_path import (
    DIGITS,
    FUNCTIONS,
    ORDER,
    TAIL,
    ExactPath,
    as_mpf,
    exact_parameters,
    exact_start,
)
from symrot.bench.comparison.problem import Problem, State
from symrot.build import cache
from symrot.closed_form.registry import exact_form
from symrot.errors import SymrotError
from symrot.planning.general_structure import general_structure
from symrot.planning.plan import Plan
from symrot.propagation.compiled_models import formula_deviations
from symrot.propagation.method import Choice
from symrot.propagation.motions.make import stepped_motion
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.propagation.steppers.tableau import HEADER

__all__ = ["DIGITS", "Reference", "reference"]

Progress = Callable[[str], object]

MOST_SECONDS = 150.0  # limit for the series; it is abandoned after this time, or if its estimate is twice as long
MOST_LONG_SECONDS = 20.0  # limit for fixed steps in long double
MOST_STEPS = 2_000_000  # largest number of fixed steps
FEWEST_STEPS = 64
GRID_TOLERANCE = 1e-8  # tolerance of the motion whose steps show where fixed steps must be short
CONTRADICTION = 1e-6  # a larger difference between references means that one of them is wrong
CONVERGED = 4e-19  # smallest error that long double can reach, per radian of rotation
ROUNDED = 1e-15  # per radian: smaller changes may be rounding errors, larger changes come from kinks in the torque
LONG_DOUBLE_BITS = 63  # smallest number of bits of the fraction that makes long double better than double
LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)(?![\w.])")
CALLS = re.compile(r"\b(sqrt|sin|cos|tan|exp|log|fabs|sinh|cosh|tanh|asin|acos|atan|atan2|pow)\(")


class Reference(NamedTuple):
    """Reference states of a motion, the method that computed them, and their differences from other methods."""

    states: tuple[State, ...]
    name: str
    others: tuple[tuple[str, float], ...]  # (another method, difference of its states, measured like an error)
    seconds: float
    skipped: tuple[str, ...]  # reasons why a reference was not available

    @property
    def doubt(self) -> float:
        """The smallest difference between this reference and another one; smaller errors of methods mean nothing.

        It is nan if there is no other reference.
        """
        return min((difference for _, difference in self.others), default=math.nan)

    def to_json(self) -> dict[str, Any]:
        return {
            "name": self.name, "others": [{"name": name, "difference": difference} for name, difference in self.others],
            "seconds": self.seconds, "skipped": list(self.skipped),
            "states": [[*state.omega.tolist(), *([] if state.quaternion is None else state.quaternion.tolist())]
                       for state in self.states],
        }  # fmt: skip


class _Unavailable(Exception):
    """Raised if a reference is not available for this motion or on this machine; its text is the reason."""


def reference(problem: Problem, say: Progress = lambda text: None, seconds: float = MOST_SECONDS) -> Reference:
    """Compute the reference states of a scene's motion by several methods, and compare them.

    A Taylor series that takes more than ``seconds`` of processor time is left out; methods with fixed steps stop
    shortening the steps within this time.

    Raises
    ------
    SymrotError
        If no reference is available (the motion ends early, or there is neither a Taylor series nor a compiler), or if
        no other reference agrees with the first.
    """
    began = perf_counter()
    paths: list[tuple[str, list[State]]] = []
    skipped = []
    for name, compute in REFERENCES:
        # needed only if fewer than two references are available, as for torques without a Taylor series
        if compute is _extrapolated and len(paths) > 1:
            continue
        say(f"reference: {name} ..")
        try:
            paths.append((name, compute(problem, say, seconds)))
        except _Unavailable as reason:
            skipped.append(f"{name}: {reason}")
    if not paths:
        raise SymrotError(
            f"{problem.scene.name}: expected a motion for which a reference can be computed; {'; '.join(skipped)}"
        )
    (name, states), *more = paths
    others = tuple((other, problem.worst(theirs, states)) for other, theirs in more)
    result = Reference(tuple(states), name, others, perf_counter() - began, tuple(skipped))
    if others and not result.doubt <= CONTRADICTION:
        apart = "; ".join(f"{other} by {difference:.1e}" for other, difference in others)
        raise SymrotError(
            f"{problem.scene.name}: expected references that agree within {CONTRADICTION:g}, but the following "
            f"differ from {name}: {apart}; one of the references is wrong, or the motion is too unstable over this span"
        )
    return result


# ------------------------------------------------------------------------------------------------ Taylor, 40 digits


def _taylor(problem: Problem, say: Progress, seconds: float) -> list[State]:
    """Return the reference states by Taylor series in 40 digits, computed now or loaded from the cache."""
    rough = non_smooth_torque(problem.plan)
    if rough:
        raise _Unavailable(rough)
    kernel, plan = problem.kernel, problem.plan
    exact_numbers = exact_parameters(kernel.rate_parameters, plan), exact_start(plan)
    where = f"{problem.start} {problem.ends}"
    key = f"held reference {DIGITS} {ORDER} {TAIL}\n{json.dumps(kernel.record['rates'])}\n{exact_numbers}\n{where}"
    stored = cache.fetch(key)
    with mpmath.workdps(DIGITS):
        if stored is None:
            # Enclosures of the torque limit the steps, so that no step misses a narrow pulse.
            path = _series(problem, say, seconds)
            stored = json.dumps([[mpmath.nstr(value, DIGITS) for value in state] for state in path])
            cache.store(key, stored)
        read = [[mpmath.mpf(value) for value in state] for state in json.loads(stored)]
        return [_state(problem, state, end) for state, end in zip(read, problem.ends, strict=True)]


def _series(problem: Problem, say: Progress, seconds: float) -> list[list[Any]]:
    """Return the integrated states at the times of comparison by Taylor series, one row for each time."""
    path, clock = ExactPath(problem.plan, problem.kernel), process_time()

    def watch(now: Any) -> None:
        spent = process_time() - clock
        whole = spent * max(1.0, float((problem.stop - problem.start) / (now - problem.start)))
        if whole > 2.0 * seconds or spent > seconds:
            raise _Unavailable(f"about {whole:.0f} s of work, more than the {seconds:.0f} s allowed")
        say(f"reference: Taylor series in {DIGITS} digits, {spent:.0f} of about {whole:.0f} s")

    try:
        return [path.state(end, watch) for end in problem.ends]
    except SymrotError as reason:
        raise _Unavailable(str(reason)) from None


def _sizes(problem: Problem) -> list[float]:
    """Return for each integrated state the scale of its error: the initial |omega|, or 1 for the attitude."""
    spin = float(np.linalg.norm([float(value) for value in problem.scene.initial.omega_b])) or 1.0
    return [spin if name.startswith("omega") else 1.0 for name in problem.plan.states]


def _state(problem: Problem, last: list[Any], end: float) -> State:
    """Return omega and quaternion of the body at time ``end`` from the integrated states ``last``, in mpmath."""
    kernel, plan = problem.kernel, problem.plan
    values: dict[str, Any] = dict(zip(plan.states, last, strict=True))
    exact = exact_parameters(kernel.quantity_parameters, plan)
    values |= {name: as_mpf(value) for name, value in exact.items()} | {"t": mpmath.mpf(end)}
    quantities = kernel.quantities.evaluate(values, FUNCTIONS, as_mpf, problem.names)
    ordered = [quantities[name] for name in problem.names]
    norm = mpmath.sqrt(sum(q * q for q in ordered[3:])) if len(ordered) > 3 else 1
    rates, attitude = ([float(value) for value in part] for part in (ordered[:3], [q / norm for q in ordered[3:]]))
    return State(np.array(rates), np.array(attitude) if attitude else None)


# ------------------------------------------------------------------------------------------------ long double


def longer(source: str) -> str:
    """Return the C code ``source`` with long double in place of double, in types, literals and library functions."""
    text = CALLS.sub(r"\1l(", LITERAL.sub(r"\1L", source))
    return re.sub(r"\bdouble\b", "long double", text)


def _long_double(problem: Problem, say: Progress, seconds: float) -> list[State]:
    """Return the reference states by DOP853 in long double with fixed steps, from the most general equations."""
    general = Problem(problem.scene, Plan(problem.scene, general_structure(problem.scene), ()))
    return _converged(general, "dop853", (HEADER, BY_HAND / "fixed_step.c"), seconds)


def _extrapolated(problem: Problem, say: Progress, seconds: float) -> list[State]:
    """Return the reference states by extrapolated midpoint rules with fixed steps, from the scene's own equations."""
    return _converged(problem, "extrapolation", (BY_HAND / "extrapolation.c",), seconds)


def _converged(general: Problem, name: str, files: Sequence[Path], seconds: float) -> list[State]:
    """Return the reference states by fixed steps in long double, shortened until the result stops changing.

    The steps are not shortened further at the limit of time or of the number of steps. ``files`` are the C files with
    the method ``name``.
    """
    if cache.missing():
        raise _Unavailable("no C compiler")
    if np.finfo(np.longdouble).nmant < LONG_DOUBLE_BITS or ctypes.sizeof(ctypes.c_longdouble) == 8:
        raise _Unavailable("long double has no more digits than double on this machine")
    sizes = np.array(_sizes(general))
    turned = max(1.0, (general.stop - general.start) * max(sizes))
    steps, before, finest = max(FEWEST_STEPS, int(turned)), None, None
    follow = _fixed_steps(general, name, files, steps, _grid(general))
    change, clock = np.inf, process_time()
    # a run takes about half as long as all runs before it together
    while steps <= MOST_STEPS and process_time() - clock < min(seconds, MOST_LONG_SECONDS) / 3.0:
        path = follow(steps)
        if np.isfinite(path.astype(float)).all():
            now = change if before is None else float(np.max(np.abs(path - before) / sizes))
            if before is not None and now >= change and change <= ROUNDED * turned:  # rounding errors dominate
                break
            if before is not None:
                finest, change = path, min(now, change)
            if now <= CONVERGED * turned:
                break
            before = path
        steps = int(steps * 1.5)
    if finest is None:
        raise _Unavailable(f"{MOST_STEPS} fixed steps, or the time allowed, are not enough; choose a shorter span")
    return [_long_state(general, state, end) for state, end in zip(finest, general.ends, strict=True)]


def _grid(problem: Problem) -> list[float]:
    """Return times that integration with fixed steps must not step across, so that no step misses a narrow pulse.

    The list is empty if no torque can have such a pulse.
    """
    # The steps of symrot's dop853 are so short that bounds of the torque exclude a missed pulse. Otherwise a step and
    # its half could both miss a pulse, and agree on a wrong result.
    motion = stepped_motion(problem.plan, Choice("dop853", ""), GRID_TOLERANCE)
    if formula_deviations(problem.plan, problem.kernel) is None:
        return []
    task, grid = motion.stepping.restarted(), []
    try:
        for run in task.runs(problem.stop):
            while run.t != run.stop:
                rows = np.empty((task.stepper.rows_per_call, task.stepper.row))
                task.advance(run, None, 0, None, rows.ctypes.data, len(rows))
                grid += rows[: run.recorded, 0].tolist()
    except IntegrationStopped as reason:
        raise _Unavailable(f"{reason}") from None
    return grid


def _fixed_steps(
    general: Problem, name: str, files: Sequence[Path], fewest: int, grid: Sequence[float]
) -> Callable[[int], Any]:
    """Return a function from a number of steps (at least ``fewest``) to the integrated states at the times
    ``general.ends``.

    The method ``name`` is compiled from ``files``. A step ends at each time of ``grid``.
    """
    parts = [
        general.kernel.source,
        f"#define N {len(general.y0)}",
        *(file.read_text(encoding="utf-8") for file in files),
    ]
    function = getattr(ctypes.CDLL(str(cache.build(longer("\n".join(parts)), "long_double"))), f"symrot_{name}")
    real = ctypes.c_longdouble
    function.argtypes, function.restype = (real, real, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p), None
    p = _long(exact_parameters(general.kernel.rate_parameters, general.plan).values())
    start = _long(exact_start(general.plan))
    whole = general.stop - general.start

    def follow(steps: int) -> Any:
        y, began, path = start.copy(), general.start, []
        # Each interval gets at least one step if ``steps`` is ``fewest``, and more whenever the caller raises
        # ``steps``.
        least = math.ceil(steps / fewest) if grid else 1
        for end in sorted({*grid, *general.ends} - {general.start}):
            share = max(least, round(steps * (end - began) / whole))
            function(began, end, share, y.ctypes.data, p.ctypes.data)
            if end in general.ends:
                path.append(y.copy())
            began = end
        return np.array(path)

    return follow


def _long_state(general: Problem, y: Any, end: float) -> State:
    """Return omega and quaternion of the body at time ``end`` from the integrated states ``y``, in long double."""
    exact = exact_parameters(general.kernel.quantity_parameters, general.plan)
    values: dict[str, Any] = dict(zip(general.plan.states, y, strict=True)) | {"t": np.longdouble(end)}
    values |= {name: _long_number(value) for name, value in exact.items()}
    functions = {"sqrt": np.sqrt, "sin": np.sin, "cos": np.cos}
    quantities = general.kernel.quantities.evaluate(values, functions, _long_number, general.names)
    ordered = np.array([quantities[name] for name in general.names])
    rates, attitude = ordered[:3].astype(float), ordered[3:]
    if not len(attitude):
        return State(rates, None)
    return State(rates, (attitude / np.sqrt((attitude * attitude).sum())).astype(float))


def _long_number(value: Fraction) -> Any:
    """Return a fraction as long double, correct to the last bit: the nearest double plus the rounding error of this
    double.
    """
    first = float(value)
    return np.longdouble(first) + np.longdouble(float(value - Fraction(first)))


def _long(values: Iterable[Fraction]) -> Any:
    return np.array([_long_number(value) for value in values] or [np.longdouble(0)], dtype=np.longdouble)


# ------------------------------------------------------------------------------------------------ closed form


def _closed_form(problem: Problem, say: Progress, seconds: float) -> list[State]:
    if exact_form(problem.scene) is None:
        raise _Unavailable("symrot has no closed form of this motion")
    trajectory = propagator(problem.scene, method="exact")(problem.ends)
    attitude = trajectory.quaternion if problem.plan.structure.attitude else [None] * len(problem.ends)
    return list(map(State, trajectory.omega, attitude))


REFERENCES: tuple[tuple[str, Callable[[Problem, Progress, float], list[State]]], ...] = (
    (f"Taylor series in {DIGITS} digits", _taylor),
    ("DOP853 in long double, general equations", _long_double),
    ("closed form", _closed_form),
    ("extrapolated midpoints in long double", _extrapolated),
)
"""Pairs (name, function) of the methods that compute reference solutions of a motion, the preferred method first.

A function returns the states at the end times of its first argument, or raises ``_Unavailable``. The other arguments
are a function for lines about progress, and the longest time in s.
"""

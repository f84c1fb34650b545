"""The motions of an ensemble, each by the fastest method: in closed form, in SIMD lanes, or as a single motion."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from symrot.build import cache as library
from symrot.ensemble import lanes
from symrot.ensemble.exact import Solved, choose, follow_exact
from symrot.ensemble.numbers import Numbers
from symrot.ensemble.variation import Variation
from symrot.errors import InputError, PropagationError
from symrot.formula.tree import names
from symrot.planning.plan import STATES, Plan
from symrot.planning.scene_kernel import SceneKernel
from symrot.propagation import time_shift as epoch
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.compiled_models import (
    compiled,
    error_blocks,
    formula_deviations,
    grows_late,
    has_formulas,
    kernel_key,
    motion_library,
    scene_kernel,
    taylor_library,
)
from symrot.propagation.method import METHODS, choose_method
from symrot.propagation.motions.setup import python_rates
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.propagation.steppers.stats import Stats, rounding_warning
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Floats
from symrot.propagation.trajectory import Trajectory

Integers = lanes.Integers

__all__ = ["Followed", "follow", "lane_library"]

OMEGA = tuple(f"omega_{i} of t" for i in (1, 2, 3))
QUATERNION = tuple(f"q{i} of t" for i in range(4))


class Followed(NamedTuple):
    """The samples of n motions at m times each, and the method and cost of each motion."""

    omega: Floats  # (n, m, 3); NaN at times that a motion did not reach
    quaternion: Floats | None  # (n, m, 4)
    methods: tuple[str, ...]
    messages: tuple[str, ...]  # reason why a motion stopped early, or empty
    warnings: tuple[tuple[str, ...], ...]  # sentences about the accuracy of each motion
    steps: Integers
    evaluations: Integers


class Problem(NamedTuple):
    """What to compute for an ensemble: trajectories, equations (the plan), times, tolerance and number of threads."""

    variation: Variation
    plan: Plan
    t0: float
    times: Floats  # (m,) or (n, m)
    tolerance: float
    workers: int

    def of(self, rows: Integers) -> "Problem":
        """Return the problem of computing only the motions with the indices ``rows``.

        It has a plan (a choice of equations and states) of its own, which may be simpler: a constant may be zero in
        these motions only.
        """
        variation = self.variation.of(rows)
        times = self.times if self.times.ndim == 1 else self.times[rows]
        return self._replace(variation=variation, plan=variation.plan(), times=times)

    def times_of(self, i: int) -> Floats:
        """Return the sample times of motion i, s, shape (m,), whether all motions share them or not."""
        times: Floats = self.times if self.times.ndim == 1 else self.times[i]
        return times


def follow(problem: Problem, method: str) -> Followed:
    """Return the samples of all motions of a problem, by the named method or, for ``auto``, by the fastest one.

    Parameters
    ----------
    method : str
        ``auto`` (closed form, see :func:`symrot.ensemble.exact.choose`; for the other motions Taylor series in SIMD
        lanes where that is possible), ``exact``, ``taylor``, ``dop853`` or ``scipy:NAME``.
    """
    name, colon, _ = method.partition(":") if isinstance(method, str) else ("", "", "")
    if method != "auto" and (name not in METHODS or name == "constant" or (colon and name != "scipy")):
        choose_method(problem.plan, method)  # raises an error that lists the methods
    groups = problem.variation.patterns()
    if len(groups) == 1:
        return _follow(problem, method, groups[0])
    return _together([_follow(problem.of(rows), method, rows) for rows in groups], groups)


def _together(parts: Sequence[Followed], groups: Sequence[Integers]) -> Followed:
    """Return the results of all motions in the order of the ensemble; ``parts[k]`` are results for ``groups[k]``.

    ``groups[k]`` are indices of motions.
    """
    order = np.argsort(np.concatenate(groups), kind="stable")

    def joined(arrays: Sequence[Any]) -> Any:
        return np.concatenate(arrays)[order]

    def in_order(rows: Sequence[tuple[Any, ...]]) -> tuple[Any, ...]:
        flat = [each for row in rows for each in row]
        return tuple(flat[place] for place in order.tolist())

    quaternions = [part.quaternion for part in parts]  # a torque needs the attitude or not, whatever its constants
    return Followed(
        joined([part.omega for part in parts]),
        None if any(each is None for each in quaternions) else joined(quaternions),
        in_order([part.methods for part in parts]),
        in_order([part.messages for part in parts]),
        in_order([part.warnings for part in parts]),
        joined([part.steps for part in parts]),
        joined([part.evaluations for part in parts]),
    )


def _follow(problem: Problem, method: str, rows: Integers) -> Followed:
    """Return the samples of motions that are computed from the same equations and states (one plan).

    The motions are computed in closed form, in SIMD lanes, or one by one.
    """
    count = len(problem.variation)
    solved = _solved(problem, method)
    by_steps = np.ones(count, dtype=bool)
    for each in solved:
        by_steps[each.rows] = False
    stepped = np.flatnonzero(by_steps).tolist()
    if method == "exact" and stepped:
        # rows: the indices of these motions in the ensemble
        first = int(rows[stepped[0]])
        raise InputError(
            f"method: expected motions with a closed form for 'exact', but trajectory {first} of the scene "
            f"{problem.variation.scene.name!r} has none; use 'auto'"
        )
    samples = problem.times.shape[-1]
    attitude = problem.plan.structure.attitude
    omega = np.empty((count, samples, 3))
    quaternion = np.empty((count, samples, 4)) if attitude else None
    methods, messages = ["exact"] * count, [""] * count
    warnings: list[tuple[str, ...]] = [()] * count
    steps, evaluations = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for each in solved:
        follow_exact(problem.variation, each, problem.times, problem.t0, omega, quaternion, problem.workers)
    if stepped and problem.plan.switches:
        alone = _switched(problem, method, stepped, omega, quaternion)
        methods, messages, warnings = list(alone.methods), list(alone.messages), list(alone.warnings)
        steps, evaluations = alone.steps, alone.evaluations
    elif stepped:
        chosen = method if method != "auto" else _stepping_method(problem)
        stepper = _Stepped(problem, stepped)
        outcome, again = STEPPERS[chosen.partition(":")[0]](stepper, chosen), list[int]()
        if method == "auto" and chosen == "taylor" and non_smooth_torque(problem.plan):
            again = [place for place, message in enumerate(outcome.messages) if message]
        if again:
            outcome = _replaced(outcome, again, _dop853(_Stepped(problem, [stepped[place] for place in again]), ""))
        stepper.read(outcome.states, omega, quaternion)
        for place, i in enumerate(stepped):
            methods[i], messages[i], warnings[i] = chosen, outcome.messages[place], outcome.warnings[place]
        for place in again:
            methods[stepped[place]] = "dop853"
        steps[stepped], evaluations[stepped] = outcome.steps, outcome.evaluations
    return Followed(omega, quaternion, tuple(methods), tuple(messages), tuple(warnings), steps, evaluations)


def _replaced(outcome: lanes.Outcome, places: Sequence[int], other: lanes.Outcome) -> lanes.Outcome:
    """Return an outcome in which the results of the motions ``places`` are those of ``other``, in the same order."""
    messages, warnings = list(outcome.messages), list(outcome.warnings)
    for k, place in enumerate(places):
        messages[place], warnings[place] = other.messages[k], other.warnings[k]
        outcome.states[place] = other.states[k]
        outcome.steps[place], outcome.evaluations[place] = other.steps[k], other.evaluations[k]
    return outcome._replace(messages=tuple(messages), warnings=tuple(warnings))


def _switched(
    problem: Problem, method: str, stepped: Sequence[int], omega: Floats, quaternion: Floats | None
) -> Followed:
    """Compute motions under torques with jumps or kinks one by one, and return methods, messages, warnings and costs.

    The samples are written into ``omega`` and ``quaternion``.
    """
    from symrot.propagation.propagate import propagator

    count, messages, methods, warnings = len(stepped), list[str](), list[str](), list[tuple[str, ...]]()
    of_scene = len(problem.variation.scene.warnings)
    steps, evaluations = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for k, i in enumerate(stepped):
        times, alone = problem.times_of(i), propagator(problem.variation.scene_of(i), method, problem.tolerance)
        omega[i] = np.nan
        if quaternion is not None:
            quaternion[i] = np.nan
        trajectory: Trajectory | None
        try:
            trajectory, message = alone(times), ""
        except PropagationError as error:
            trajectory, message = getattr(error, "trajectory", None), str(error)
        if trajectory is not None:
            rows = slice(None) if not message else np.isin(times, trajectory.t)
            omega[i][rows] = trajectory.omega
            if quaternion is not None:
                quaternion[i][rows] = trajectory.quaternion
            steps[k], evaluations[k] = trajectory.stats.accepted, trajectory.stats.evaluations
        messages.append(message)
        methods.append(alone.method)
        warnings.append(() if trajectory is None else trajectory.warnings[of_scene:])
    return Followed(omega, quaternion, tuple(methods), tuple(messages), tuple(warnings), steps, evaluations)


def _solved(problem: Problem, method: str) -> list[Solved]:
    """Return the trajectories that ``method`` computes in closed form; none if the method takes steps."""
    if method in ("exact", "auto"):
        return choose(problem.variation, problem.times, problem.t0, faster=method == "auto")
    return []


def _stepping_method(problem: Problem) -> str:
    """Return the method that ``auto`` uses for motions without a closed form."""
    if not problem.plan.states:
        return "constant"  # nothing changes
    if library.missing():
        return "scipy"
    # lanes can step drag, which has a kink at rest; the motions that reach it are stepped again by dop853
    rough = has_formulas(problem.plan) and non_smooth_torque(problem.plan)
    return "dop853" if rough or taylor.refusal(scene_kernel(problem.plan).rates) else "taylor"


def lane_library(plan: Plan, kernel: SceneKernel, tolerance: float) -> Any:
    """Return the compiled library that integrates the equations of a plan, one motion in each SIMD lane.

    The plan chooses the equations and states of a scene. ``tolerance`` determines the order of the Taylor series.
    """
    order = lanes.order_for(tolerance)
    key = f"lanes {order}\n{kernel_key(plan)}"
    system = library.fetch(key)
    if system is None:
        from symrot.codegen.taylor.ensemble_source import lane_definitions

        system = lane_definitions(kernel.rates, *error_blocks(plan), order)
        library.store(key, system)
    return library.build(lanes.wrap_translation_unit(system), "lanes", lanes.FLAGS)


class _Stepped:
    """The trajectories of an ensemble that are integrated step by step, with their parameters and initial states."""

    def __init__(self, problem: Problem, chosen: Sequence[int]) -> None:
        self.problem, self.plan, self.chosen = problem, problem.plan, chosen
        self.kernel = scene_kernel(self.plan)
        places, states = [STATES.index(name) for name in self.plan.states], problem.variation.initial_states
        self.y = np.column_stack([states, np.zeros(len(states))])[np.ix_(chosen, places)]
        self.numbers = Numbers(problem.variation, self.plan, chosen)
        times = problem.times
        self.times = times if times.ndim == 1 else np.ascontiguousarray(times[list(chosen)])
        self.epoch, self.t0, self.moved = 0.0, problem.t0, (self.plan, self.kernel)
        if self.times.size and epoch.starts_far(problem.t0, float(self.times.min()), float(self.times.max())):
            self.epoch, self.t0, self.moved = problem.t0, 0.0, epoch.time_shifted(self.plan, self.kernel)
        try:
            self.p = self.numbers.values_of(self.moved[1].rate_parameters, self.epoch)
        except OverflowError:
            raise IntegrationStopped(self.epoch, NOT_FINITE_SENTENCE) from None

    def on_clock(self, times: Floats) -> Floats:
        """Convert times of the scene, s, to times since the epoch (a reference time), from which the steppers count."""
        return times - self.epoch if self.epoch else times

    def clock(self, k: int, make: Callable[[Plan, SceneKernel], Any] = motion_library) -> Any:
        """Return a function that makes the right-hand side of motion k for times counted from any epoch.

        In a long motion, a stepper counts its time again and again from a new epoch, so that times stay small and keep
        their digits. At each new epoch it calls the function, which returns a pair: the code that computes the rates
        (time derivatives of the states) from the time since the epoch, and the values of its parameters. ``make``
        makes the code, a compiled library or a Python function. Return None if the rates do not depend on time.
        """
        # see symrot.propagation.time_shift.clock
        if not self.kernel.rates.uses("t"):
            return None

        def moving() -> tuple[Plan, SceneKernel]:
            return self.moved if self.epoch else epoch.time_shifted(self.plan, self.kernel)

        return epoch.clock(moving, self.numbers.constants(k), self.epoch, make)

    def read(self, states: Floats, omega: Floats, quaternion: Floats | None) -> None:
        """Compute the samples of ``omega`` and ``quaternion`` from the integrated states, and write them there.

        ``states`` has the shape (n, m, N), for n motions, m times and the N states of the plan.
        """
        chosen = np.asarray(self.chosen)
        whole = len(chosen) == len(omega) and bool((chosen == np.arange(len(omega))).all())
        rows = slice(None) if whole else chosen  # a slice needs no copies
        # N may be less than 7 (omega and q): the only state may be an angle
        values: dict[str, Any] = dict(zip(self.plan.states, np.moveaxis(states, -1, 0), strict=True))
        values["t"] = self.times
        outputs = OMEGA + (QUATERNION if quaternion is not None else ())
        parameters = self._parameters_of(outputs)
        columns = self.numbers.values_of(parameters).T
        values |= dict(zip([name for name, _ in parameters], columns[:, :, None], strict=True))
        values_of = self.kernel.quantities.evaluate(values, ARRAY_FUNCTIONS, float, outputs)
        for k, name in enumerate(OMEGA):
            omega[rows, :, k] = values_of[name]
        if quaternion is not None:
            components = quaternion if whole else np.empty((len(chosen), *quaternion.shape[1:]))
            squares: Any = 0.0
            for k, name in enumerate(QUATERNION):
                components[..., k] = values_of[name]
                squares = squares + components[..., k] ** 2
            components /= np.sqrt(squares)[..., None]
            if not whole:
                quaternion[rows] = components

    def _parameters_of(self, outputs: Sequence[str]) -> Any:
        """Return the parameters (constants of the kernel) that the named outputs need, as pairs (name, formula)."""
        program, parameters = self.kernel.quantities, self.kernel.quantity_parameters
        needed = set().union(*(names(node) for name, node in program.outputs if name in outputs))
        for name, node in reversed(program.temporaries):
            needed |= names(node) if name in needed else set()
        return tuple([(name, node) for name, node in parameters if name in needed])

    def one_by_one(self, method: str, integrate: Callable[[int, Floats], tuple[Floats, Stats]]) -> lanes.Outcome:
        """Integrate all trajectories one after the other; ``integrate(k, times)`` returns states and cost of one.

        ``method`` is the name of the method, for warnings.
        """
        samples = self.times.shape[-1]
        states = np.full((len(self.chosen), samples, len(self.plan.states)), np.nan)
        steps, evaluations = (np.zeros(len(self.chosen), dtype=np.int64) for _ in range(2))
        messages, warnings = list[str](), list[tuple[str, ...]]()
        for k, i in enumerate(self.chosen):
            times, message, stats = self.on_clock(self.problem.times_of(i)), "", None
            try:
                states[k], stats = integrate(k, times)
            except IntegrationStopped as error:
                message = str(error.later(self.epoch))
                if error.samples is not None:
                    states[k][error.samples.numbers], stats = error.samples.states, error.samples.stats
            except PropagationError as error:
                message = str(error)
            messages.append(message)
            warnings.append(())
            if stats is not None:
                steps[k], evaluations[k] = stats.accepted, stats.evaluations
                beyond = stats.later(self.epoch).rounded_beyond
                warnings[k] = tuple([rounding_warning(t, method) for t in beyond])
        return lanes.Outcome(states, steps, evaluations, tuple(messages), tuple(warnings))


def _taylor(stepped: _Stepped, method: str) -> lanes.Outcome:
    problem = stepped.problem
    # not in lanes: bounds of formulas limit each step, and motions that may grow as t^3 from rest need checks
    if grows_late(stepped.plan) or formula_deviations(*stepped.moved) is not None:
        return _one_by_one(stepped)
    path = lane_library(*stepped.moved, problem.tolerance)
    return lanes.follow(
        path, stepped.p, stepped.y, stepped.t0, stepped.on_clock(stepped.times), problem.tolerance,
        workers=problem.workers, epoch=stepped.epoch,
    )  # fmt: skip


def _one_by_one(stepped: _Stepped) -> lanes.Outcome:
    """Integrate the trajectories ``stepped`` one after the other by Taylor series."""
    problem, (plan, kernel) = stepped.problem, stepped.moved
    path = taylor_library(plan, kernel, problem.tolerance, projected=False)

    def integrate(k: int, times: Floats) -> tuple[Floats, Any]:
        return taylor.integration(path, stepped.p[k], stepped.y[k], stepped.t0, problem.tolerance).sample(times)

    return stepped.one_by_one("taylor", integrate)


def _dop853(stepped: _Stepped, method: str) -> lanes.Outcome:
    problem, plan = stepped.problem, stepped.plan
    path = compiled(plan)[1] if stepped.moved[0] is plan else motion_library(*stepped.moved)

    def integrate(k: int, times: Floats) -> tuple[Floats, Any]:
        arguments = path, stepped.p[k], stepped.y[k], stepped.t0, problem.tolerance
        return dop853.integration(*arguments, clock=stepped.clock(k)).sample(times)

    return stepped.one_by_one("dop853", integrate)


def _scipy(stepped: _Stepped, method: str) -> lanes.Outcome:
    from symrot.propagation.steppers import fallback

    problem, rates = stepped.problem, python_rates(*stepped.moved)
    blocks, scales = error_blocks(stepped.plan)
    bounds = formula_deviations(*stepped.moved)
    names = [name for name, _ in stepped.moved[1].rate_parameters]

    def integrate(k: int, times: Floats) -> tuple[Floats, Any]:
        start = rates, stepped.p[k], stepped.y[k], stepped.t0
        deviations = bounds and bounds(dict(zip(names, stepped.p[k].tolist(), strict=True)))
        clock = stepped.clock(k, python_rates)
        options = fallback.Options(method, blocks, scales, deviations=deviations, clock=clock)
        return fallback.integrate(*start, times, problem.tolerance, options)

    return stepped.one_by_one(method, integrate)


def _constant(stepped: _Stepped, method: str) -> lanes.Outcome:
    count = len(stepped.chosen)
    nothing = np.zeros(count, dtype=np.int64)
    return lanes.Outcome(np.empty((count, stepped.times.shape[-1], 0)), nothing, nothing, ("",) * count, ((),) * count)


STEPPERS: dict[str, Callable[[_Stepped, str], lanes.Outcome]] = {
    "taylor": _taylor,
    "dop853": _dop853,
    "scipy": _scipy,
    "constant": _constant,
}
"""For each method, the function that computes motions without a closed form."""

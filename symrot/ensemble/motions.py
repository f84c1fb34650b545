"""The motions of an ensemble, each by the method that suits it: in closed form, in lanes, or one after the other."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from symrot.closed_form.choose import exact_form
from symrot.codegen import library
from symrot.ensemble import lanes
from symrot.ensemble.variation import Variation
from symrot.errors import InputError, PropagationError
from symrot.planner import Plan
from symrot.propagation import dop853, epoch, taylor
from symrot.propagation.kernels import compiled, error_blocks, kernel_key, missing_compiler, scene_kernel
from symrot.propagation.method import METHODS, choose_method
from symrot.propagation.stepping import CutOff, Floats
from symrot.propagation.trajectory import ARRAY_FUNCTIONS
from symrot.scene_kernel import SceneKernel, bind

Integers = lanes.Integers

__all__ = ["Followed", "follow", "lane_library"]

OMEGA = tuple(f"omega_{i} of t" for i in (1, 2, 3))
QUATERNION = tuple(f"q{i} of t" for i in range(4))


class Followed(NamedTuple):
    """n motions at m times each; not-a-number where one was not followed so far."""

    omega: Floats  # (n, m, 3)
    quaternion: Floats | None  # (n, m, 4)
    methods: tuple[str, ...]
    messages: tuple[str, ...]  # why a motion broke off, or empty
    steps: Integers
    evaluations: Integers


class Problem(NamedTuple):
    """What is to be followed, and how well."""

    variation: Variation
    plan: Plan
    t0: float
    times: Floats  # (m,) or (n, m)
    tolerance: float
    workers: int

    def times_of(self, i: int) -> Floats:
        """Return the times of motion i, s, shape (m,)."""
        found: Floats = self.times if self.times.ndim == 1 else self.times[i]
        return found


def follow(problem: Problem, method: str) -> Followed:
    """Follow the motions.

    Parameters
    ----------
    method : str
        ``auto`` (closed form for each that has one, lanes for the others), ``exact``, ``taylor``, ``dop853`` or
        ``scipy:NAME``.
    """
    scenes, count = problem.variation.scenes, len(problem.variation)
    name = method.partition(":")[0]
    if method != "auto" and (name not in METHODS or name == "constant" or (":" in method and name != "scipy")):
        choose_method(problem.plan, method)  # says what there is
    forms = [exact_form(scene) if method in ("auto", "exact") else None for scene in scenes]
    if method == "auto" and missing_compiler():
        forms = [None] * count
    solved = [i for i, form in enumerate(forms) if form is not None]
    if method == "exact" and len(solved) < count:
        first = forms.index(None)
        raise InputError(
            f"method: expected motions with a closed form for 'exact', got none for trajectory {first} of the scene "
            f"{problem.variation.scene.name!r}"
        )
    stepped = sorted(set(range(count)) - set(solved))
    samples = problem.times.shape[-1]
    attitude = bool(problem.plan.structure["attitude"])
    omega = np.full((count, samples, 3), np.nan)
    quaternion = np.full((count, samples, 4), np.nan) if attitude else None
    methods, messages = ["exact"] * count, [""] * count
    steps, evaluations = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for i in solved:
        form = forms[i]
        assert form is not None
        rates, attitudes = form.motion(scenes[i]).evaluate(problem.times_of(i) - problem.t0, quaternion=attitude)
        omega[i] = rates
        if quaternion is not None:
            quaternion[i] = attitudes
    if stepped:
        chosen = method if method != "auto" else _stepping_method(problem)
        stepper = _Stepped(problem, stepped)
        outcome = STEPPERS[chosen.partition(":")[0]](stepper, chosen)
        stepper.read(outcome.states, omega, quaternion)
        for place, i in enumerate(stepped):
            methods[i], messages[i] = chosen, outcome.messages[place]
        steps[stepped], evaluations[stepped] = outcome.steps, outcome.evaluations
    return Followed(omega, quaternion, tuple(methods), tuple(messages), steps, evaluations)


def _stepping_method(problem: Problem) -> str:
    """Return how motions without a closed form are followed."""
    if not problem.plan.states:
        return "constant"
    if missing_compiler():
        return "scipy"
    return "dop853" if taylor.refusal(scene_kernel(problem.plan).rates) else "taylor"


def lane_library(plan: Plan, kernel: SceneKernel, tolerance: float) -> Any:
    """Return the library that steps a plan in lanes, of the order that suits the tolerance."""
    order = lanes.order_for(tolerance)
    key = f"lanes {order}\n{kernel_key(plan)}"
    system = library.fetch(key)
    if system is None:
        from symrot.codegen.ensemble_source import lane_definitions

        system = lane_definitions(kernel.rates, *error_blocks(plan), order)
        library.store(key, system)
    return library.build(lanes.around(system), "lanes", lanes.FLAGS)


class _Stepped:
    """The trajectories that are stepped, bound to numbers."""

    def __init__(self, problem: Problem, chosen: Sequence[int]) -> None:
        self.problem, self.plan, self.chosen = problem, problem.plan, chosen
        self.kernel = scene_kernel(self.plan)
        scenes = [problem.variation.scenes[i] for i in chosen]
        self.plans = [Plan(scene, self.plan.structure, ()) for scene in scenes]
        self.y = np.array([plan.initial_state for plan in self.plans]).reshape(len(chosen), -1)
        times = problem.times
        self.times = times if times.ndim == 1 else np.ascontiguousarray(times[list(chosen)])
        self.epoch, self.t0, self.moved = 0.0, problem.t0, (self.plan, self.kernel)
        if self.times.size and epoch.far(problem.t0, float(self.times.min()), float(self.times.max())):
            self.epoch, self.t0, self.moved = problem.t0, 0.0, epoch.moved(self.plan, self.kernel)
        rows = [epoch.moved_parameters(self.moved[1], plan.constants, self.epoch) for plan in self.plans]
        self.p = np.array(rows, dtype=np.float64).reshape(len(rows), len(self.moved[1].rate_parameters))

    def on_clock(self, times: Floats) -> Floats:
        """Return times on the clock of the steppers, which shows 0 at the epoch."""
        return times - self.epoch if self.epoch else times

    def clock(self, k: int) -> dop853.Clock | None:
        """Return the clock of the rates of one motion, see :mod:`symrot.propagation.dop853`."""
        if not self.kernel.rates.uses("t"):
            return None

        def moving() -> tuple[Plan, SceneKernel]:
            return self.moved if self.epoch else epoch.moved(self.plan, self.kernel)

        return epoch.clock(moving, self.plans[k].constants, self.epoch)

    def _bound(self, parameters: Any) -> Floats:
        rows = [bind(parameters, plan.constants) for plan in self.plans]
        return np.array(rows, dtype=np.float64).reshape(len(rows), len(parameters))

    def read(self, states: Floats, omega: Floats, quaternion: Floats | None) -> None:
        """Write angular velocity and attitude of the states into their places."""
        chosen = list(self.chosen)
        values: dict[str, Any] = dict(zip(self.plan.states, np.moveaxis(states, -1, 0), strict=True))
        values["t"] = self.times
        columns = self._bound(self.kernel.quantity_parameters).T
        names = [name for name, _ in self.kernel.quantity_parameters]
        values |= dict(zip(names, columns[:, :, None], strict=True))
        wanted = OMEGA + (QUATERNION if quaternion is not None else ())
        found = self.kernel.quantities.evaluate(values, ARRAY_FUNCTIONS, float, wanted)
        for k, name in enumerate(OMEGA):
            omega[chosen, :, k] = found[name]
        if quaternion is not None:
            for k, name in enumerate(QUATERNION):
                quaternion[chosen, :, k] = found[name]
            size = np.sqrt((quaternion[chosen] ** 2).sum(axis=-1, keepdims=True))
            quaternion[chosen] /= size

    def one_by_one(self, integrate: Callable[[int, Floats], tuple[Floats, Any]]) -> lanes.Outcome:
        """Follow each with a stepper of one motion."""
        samples = self.times.shape[-1]
        states = np.full((len(self.plans), samples, len(self.plan.states)), np.nan)
        steps, evaluations = (np.zeros(len(self.plans), dtype=np.int64) for _ in range(2))
        messages = []
        for k, i in enumerate(self.chosen):
            try:
                states[k], stats = integrate(k, self.on_clock(self.problem.times_of(i)))
                steps[k], evaluations[k] = stats.accepted, stats.evaluations
                messages.append("")
            except CutOff as error:
                messages.append(str(error.later(self.epoch)))
            except PropagationError as error:
                messages.append(str(error))
        return lanes.Outcome(states, steps, evaluations, tuple(messages))


def _taylor(stepped: _Stepped, method: str) -> lanes.Outcome:
    problem = stepped.problem
    path = lane_library(*stepped.moved, problem.tolerance)
    return lanes.follow(
        path, stepped.p, stepped.y, stepped.t0, stepped.on_clock(stepped.times), problem.tolerance,
        workers=problem.workers, epoch=stepped.epoch,
    )  # fmt: skip


def _dop853(stepped: _Stepped, method: str) -> lanes.Outcome:
    problem, plan = stepped.problem, stepped.plan
    path = compiled(plan)[1] if stepped.moved[0] is plan else epoch.compiled(*stepped.moved)

    def integrate(k: int, times: Floats) -> tuple[Floats, Any]:
        given = path, stepped.p[k], stepped.y[k], stepped.t0, problem.tolerance
        return dop853.task(*given, clock=stepped.clock(k)).sample(times)

    return stepped.one_by_one(integrate)


def _scipy(stepped: _Stepped, method: str) -> lanes.Outcome:
    from symrot.codegen.numpy_kernel import load_numpy_kernel
    from symrot.propagation import fallback

    problem, function = stepped.problem, load_numpy_kernel(stepped.moved[1].rates)
    blocks, scales = error_blocks(stepped.plan)
    solver = method.partition(":")[2]
    options: dict[str, Any] = {"blocks": blocks, "scales": scales, **({"method": solver} if solver else {})}

    def integrate(k: int, times: Floats) -> tuple[Floats, Any]:
        rates = function if stepped.p.shape[1] else lambda t, y, p: function(t, y)
        return fallback.integrate(rates, stepped.p[k], stepped.y[k], stepped.t0, times, problem.tolerance, **options)

    return stepped.one_by_one(integrate)


def _constant(stepped: _Stepped, method: str) -> lanes.Outcome:
    count = len(stepped.plans)
    nothing = np.zeros(count, dtype=np.int64)
    return lanes.Outcome(np.empty((count, stepped.times.shape[-1], 0)), nothing, nothing, ("",) * count)


STEPPERS: dict[str, Callable[[_Stepped, str], lanes.Outcome]] = {
    "taylor": _taylor,
    "dop853": _dop853,
    "scipy": _scipy,
    "constant": _constant,
}
"""How motions without a closed form are followed, by method."""

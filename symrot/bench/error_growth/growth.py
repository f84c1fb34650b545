"""Growth of the error of each method along one motion, and drift of its conserved quantities.

The reference is :class:`symrot.bench.comparison.exact_path.ExactPath`, far more accurate than doubles. Methods with a
tolerance run near their highest accuracy: symrot's Taylor series at 1e-15 and its DOP853 at 1e-14, SciPy's at an rtol
of 3e-14. Textbook RK4 makes 200 steps per revolution.
"""

import ctypes
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.bench.by_hand import text_by_hand
from symrot.bench.comparison.exact_path import ExactPath
from symrot.build import cache
from symrot.closed_form.registry import exact_form
from symrot.planning.plan import make_plan
from symrot.propagation.motions.methods import SteppedMotion
from symrot.propagation.motions.motion import Motion
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.propagation.steppers.stats import Stats
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene

__all__ = ["FROM", "METHODS", "Curve", "Track", "exponent", "growth"]

Floats = NDArray[np.float64]

TIGHTEST, SCIPY_RTOL, SCIPY_ATOL = 1e-15, 3e-14, 1e-15
STEPS_PER_TURN = 200  # steps of RK4 per revolution
FROM = 30.0  # number of revolutions after which the power of growth is fitted


class Curve(NamedTuple):
    """Errors of one method at several times of one motion; nan after the time at which the method stopped."""

    method: str
    attitude: Floats  # rad, shape (n,)
    rates: Floats  # relative to the largest rate
    invariants: dict[str, Floats]  # relative drift of each conserved quantity, by name


class Track:
    """A motion and the times at which methods are compared.

    Parameters
    ----------
    scene : Scene
        The scene of the motion; the attitude is computed even if the scene does not list it among its outputs.
    times : array, shape (n,)
        Increasing times, none of them before the start.
    periodic : bool
        Whether the body is free; if so, the reference is computed for one period and continued through all periods.
    """

    def __init__(self, scene: Scene, times: Floats, periodic: bool) -> None:
        if "quaternion" not in scene.output.quantities:
            output = scene.output._replace(quantities=(*scene.output.quantities, "quaternion"))
            scene = replace(scene, output=output)
        make_plan(scene)  # rejects switched torques, because the reference series would continue past the switch
        self.scene, self.times = scene, times
        self.motion = propagator(scene, "dop853" if self.rough(scene) else "taylor", TIGHTEST)._motion
        self.speed = max(float(np.linalg.norm([float(w) for w in scene.initial.omega_b])), 1e-300)
        self.periodic, self.path = periodic, ExactPath(self.motion.plan, self.motion.kernel)
        exact = self.path.states_of_free_body(times) if periodic else self.path.states(times)
        self.truth = self.trajectory(exact)

    @cached_property
    def reference_error(self) -> float:
        """The error of the reference at the last time, see :meth:`ExactPath.error`."""
        return self.path.error(float(self.times[-1]), self.periodic)

    @staticmethod
    def rough(scene: Scene) -> str:
        """Return why a motion has no Taylor series, such as a torque that jumps, or an empty text if it has one."""
        return non_smooth_torque(propagator(scene, "scipy").plan)

    def trajectory(self, states: Floats, motion: Motion | None = None) -> Trajectory:
        """Return the trajectory of ``motion`` (default: the scene's) that consists of ``states``.

        The states belong to the first ``len(states)`` times of this track.
        """
        # There are fewer states than times if a method stopped early.
        return Trajectory(motion or self.motion, self.times[: len(states)], states, "", Stats(0, 0, 0, 0.0), "")

    def curve(self, method: str, trajectory: Trajectory) -> Curve:
        """Return the errors of ``trajectory`` along the motion, as a curve with the name ``method``."""
        count, blank = len(trajectory), np.full(len(self.times), np.nan)
        q, r = trajectory.quaternion, self.truth.quaternion[:count]
        chord = np.minimum(*(np.linalg.norm(q - sign * r, axis=1) for sign in (1, -1)))
        attitude, rates = blank.copy(), blank.copy()
        attitude[:count] = 4.0 * np.arcsin(np.minimum(chord, math.sqrt(2.0)) / 2.0)
        size = float(np.linalg.norm(self.truth.omega, axis=1).max())
        rates[:count] = np.linalg.norm(trajectory.omega - self.truth.omega[:count], axis=1) / size
        invariants = {}
        for item in trajectory.invariants:
            start = trajectory._motion.initial_quantity(item.name)
            invariants[item.name] = np.abs(item.values - start) / (item.scale or 1.0)
        return Curve(method, attitude, rates, invariants)

    def turns(self, t: float) -> float:
        """Return how many revolutions the body would make in the time ``t``, s, at its initial angular speed:
        ``speed*t/(2 pi)``.
        """
        return self.speed * t / (2.0 * math.pi)


# ------------------------------------------------------------------------------------------------ methods


def _exact(track: Track, times: Floats) -> Trajectory | None:
    if exact_form(track.scene) is None:
        return None
    return propagator(track.scene, "exact")(times)


def _taylor(project: bool) -> Callable[[Track, Floats], Trajectory | None]:
    def run(track: Track, times: Floats) -> Trajectory | None:
        if not isinstance(track.motion, SteppedMotion) or track.motion.choice.method != "taylor":
            return None
        task = track.motion.stepping.restarted()
        if not project:
            task.fields = {**task.fields, "every": 0}
        return track.trajectory(task.sample(times)[0])

    return run


def _dop853(track: Track, times: Floats) -> Trajectory | None:
    return propagator(track.scene, "dop853", 1e-14)(times)


def _scipy(track: Track, times: Floats) -> Trajectory | None:
    from scipy.integrate import solve_ivp

    motion = track.motion
    p, rates = motion.rate_parameters, motion.rates
    span = (motion.start, float(times[-1]))
    solution = solve_ivp(
        lambda t, y: rates(t, y, p), span, motion.plan.initial_state, "DOP853", times, rtol=SCIPY_RTOL, atol=SCIPY_ATOL
    )
    return track.trajectory(np.ascontiguousarray(solution.y.T))


def _rk4(normalised: bool) -> Callable[[Track, Floats], Trajectory | None]:
    def run(track: Track, times: Floats) -> Trajectory | None:
        motion = track.motion
        if "q0" not in motion.plan.states:
            return None
        text = text_by_hand("by_hand.c")
        source = f"{motion.kernel.source}\n#define N {len(motion.plan.states)}\n{text}"
        function = ctypes.CDLL(str(cache.build(source, "by_hand"))).symrot_rk4
        real, pointer = ctypes.c_double, ctypes.c_void_p
        function.argtypes, function.restype = (real, real, ctypes.c_long, ctypes.c_int, pointer, pointer), None
        y, p = np.array(motion.plan.initial_state), np.array(motion.rate_parameters or [0.0])
        now, rows = motion.start, []
        for t in times.tolist():
            steps = math.ceil(track.turns(t - now) * STEPS_PER_TURN)
            if steps:
                function(now, t, steps, int(normalised), y.ctypes.data, p.ctypes.data)
            now = t
            rows.append(y.copy())
        return track.trajectory(np.array(rows))

    return run


class Method(NamedTuple):
    """A method for computing a motion, and up to how many revolutions it is run: by default, and with ``--long``."""

    name: str
    about: str
    # by default
    most: float
    # with --long
    most_long: float
    run: Callable[[Track, Floats], Trajectory | None]


METHODS = (
    Method("exact", "closed form", math.inf, math.inf, _exact),
    Method("taylor", "Taylor series, last digits corrected to keep the invariants", math.inf, math.inf, _taylor(True)),
    Method("taylor, plain", "the same without this correction", math.inf, math.inf, _taylor(False)),
    Method("dop853", "Dormand-Prince 8(5,3) in C", math.inf, math.inf, _dop853),
    Method("SciPy DOP853", "solve_ivp at its least rtol", 1e3, 1e4, _scipy),
    Method("RK4, normalised", "200 steps per revolution, q renormalised after each step", 1e5, 1e6, _rk4(True)),
    Method("RK4", "200 steps per revolution, handwritten in C", 1e5, 1e6, _rk4(False)),
)


def growth(track: Track, long: bool = False, say: Callable[[str], object] = lambda text: None) -> list[Curve]:
    """Return the error curves of all methods that can compute the motion of ``track``.

    With ``long``, the methods run for more revolutions; ``say`` receives a line of progress for each method.
    """
    curves = []
    for method in METHODS:
        say(f"{track.scene.name}: {method.name} ..")
        turns = track.speed * (track.times - track.motion.start) / (2.0 * math.pi)
        inside = track.times[turns <= (method.most_long if long else method.most) * 1.001]
        trajectory = method.run(track, inside)
        if trajectory is not None:
            curves.append(track.curve(method.name, trajectory))
    return curves


def exponent(revolutions: Floats, errors: Floats) -> float:
    """Return the exponent k if errors grow as t^k, fitted to the positive errors below 0.5 after ``FROM`` revolutions.

    The result is nan if there are fewer than four such errors.
    """
    # A motion with a larger error has nothing in common with the exact one.
    chosen = (revolutions >= FROM) & np.isfinite(errors) & (errors > 0.0) & (errors < 0.5)
    if int(chosen.sum()) < 4:
        return math.nan
    return float(np.polyfit(np.log(revolutions[chosen]), np.log(errors[chosen]), 1)[0])


def median_curve(curves: list[Any], name: str) -> Floats:
    """Return the median of one kind of error over several motions, at each time.

    ``curves`` are Curves with the same times; ``name`` is ``"attitude"`` or ``"rates"``.
    """
    medians: Floats = np.exp(np.median(np.log(np.array([getattr(c, name) for c in curves]) + 1e-18), axis=0))
    return medians

"""Contestants of a work-precision study: symrot's methods, SciPy's methods, and heyoka with several settings.

For one tolerance, a contestant prepares a function that computes the motion up to a given time and returns the last
state and the number of steps. The preparation (deriving, compiling) is not timed. All functions are called from Python.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np

from symrot.bench.comparison.peers import heyoka_integrator, scalar_kernel
from symrot.bench.comparison.problem import Floats, Problem, State
from symrot.bench.comparison.race import EndState
from symrot.build import cache
from symrot.closed_form.registry import exact_form
from symrot.errors import InputError, with_hint
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers.smoothness import non_smooth_torque

__all__ = ["CONTESTANTS", "Contestant", "Run", "chosen", "tolerances_from"]

Run = Callable[[float], EndState]  # end time, s -> (integrated states then, or a State; number of steps)


def _half_decades(first: int, last: int) -> tuple[float, ...]:
    return tuple(float(f"{10.0 ** (-k / 2):.2g}") for k in range(2 * first, 2 * last + 1))


OURS, THEIRS = _half_decades(2, 14), _half_decades(2, 16)
ADAPTIVE = tuple(float(Fraction(1, 10**k)) for k in range(2, 14))  # SciPy takes no rtol below 2.2e-14


class Contestant(NamedTuple):
    """A method with its settings; in a work-precision study each contestant has one curve of time against error."""

    name: str
    # the name that selects the contestant in --methods
    group: str
    about: str
    tolerances: tuple[float, ...]
    # returns why the contestant cannot take part, or an empty text
    missing: Callable[[Problem], str]
    # returns the timed function for a tolerance
    prepare: Callable[[Problem, float], Run]
    quick: bool = True  # whether the contestant is part of a quick study

    def at(self, tolerances: Sequence[float]) -> "Contestant":
        """Return the contestant with those ``tolerances`` that are not below its smallest tolerance.

        A closed form, which has no tolerance, is returned unchanged.
        """
        least = self.tolerances[-1]
        return self._replace(tolerances=tuple(t for t in tolerances if t >= least)) if least else self


# ------------------------------------------------------------------------------------------------ symrot


def _exact(problem: Problem, tolerance: float) -> Run:
    """Return the function whose run time is measured for the closed form.

    It takes an end time, s, and returns (state, 0): a closed form takes no steps and ignores ``tolerance``.
    """
    form, attitude = exact_form(problem.scene), len(problem.names) > 3
    assert form is not None

    def run(stop: float) -> EndState:
        at = np.array([stop - problem.start])
        # The constants of the closed form are computed from the initial state in each call.
        omega, quaternion = form.motion(problem.scene).evaluate(at, quaternion=attitude)
        return State(omega[0], None if quaternion is None else quaternion[0]), 0  # type: ignore[index]

    return run


def _no_form(problem: Problem) -> str:
    return "" if exact_form(problem.scene) else "the motion has no closed form here"


def _symrot(method: str) -> Callable[[Problem, float], Run]:
    """Return a function (problem, tolerance) -> run for one of symrot's methods, such as ``"taylor"``.

    The function ``run``, which is timed, computes the motion up to an end time, s; it returns the state there and the
    number of steps.
    """

    def prepare(problem: Problem, tolerance: float) -> Run:
        # not timed
        propagate = propagator(problem.scene, method, tolerance)

        def run(stop: float) -> EndState:
            trajectory = propagate(np.array([stop]))
            return _last(trajectory), trajectory.stats.accepted

        return run

    return prepare


def _last(trajectory: Any) -> Any:
    """Return the integrated states at a trajectory's only sample, or the body's state if a closed form computed it."""
    if trajectory.method != "exact":
        return trajectory.y[:, 0]
    y = trajectory.y[:, 0]
    return State(y[:3], y[3:] if len(y) > 3 else None)


def _no_compiler(problem: Problem) -> str:
    return cache.missing()


def _no_series(problem: Problem) -> str:
    return non_smooth_torque(problem.plan) or cache.missing()


# ------------------------------------------------------------------------------------------------ peers


def _scipy(method: str) -> Callable[[Problem, float], Run]:
    def prepare(problem: Problem, tolerance: float) -> Run:
        import scipy.integrate

        solve: Any = scipy.integrate.solve_ivp
        kernel, p = scalar_kernel(problem.kernel.rates), problem.p

        def with_parameters(t: float, y: Floats) -> Any:
            return kernel(t, y.tolist(), p)

        def without(t: float, y: Floats) -> Any:
            return kernel(t, y.tolist())

        right_hand_side, start = with_parameters if p else without, np.array(problem.y0)

        def run(stop: float) -> EndState:
            solution = solve(
                right_hand_side, (problem.start, stop), start, method=method, rtol=tolerance, atol=tolerance
            )
            return solution.y[:, -1] if solution.success else np.full(len(start), np.nan), len(solution.t) - 1

        return run

    return prepare


def _no_heyoka(problem: Problem) -> str:
    return non_smooth_torque(problem.plan) if find_spec("heyoka") else "not installed: pip install 'symrot[bench]'"


def _heyoka(**settings: bool) -> Callable[[Problem, float], Run]:
    def prepare(problem: Problem, tolerance: float) -> Run:
        run = heyoka_integrator(
            problem.kernel.rates, problem.parameters, problem.y0, tolerance, settings, problem.start
        )
        assert run is not None
        return run

    return prepare


def _nothing(problem: Problem) -> str:
    return ""


CONTESTANTS: tuple[Contestant, ...] = (
    Contestant(
        "exact", "exact", "closed form, without the time to compute its constants", (0.0,), _no_form,
        lambda problem, tolerance: _symrot("exact")(problem, 1e-12),
    ),
    Contestant(
        "exact with set-up", "exact", "closed form, including the time to compute its constants", (0.0,), _no_form,
        _exact,
    ),
    Contestant("taylor", "taylor", "Taylor series in C", OURS, _no_series, _symrot("taylor")),
    Contestant("dop853", "dop853", "Dormand-Prince 8(5,3) in C", OURS[:-4], _no_compiler, _symrot("dop853")),
    Contestant(
        "symrot scipy", "scipy", "SciPy's DOP853 as symrot's fallback", ADAPTIVE[1:-1:2], _nothing, _symrot("scipy"),
    ),
    Contestant("heyoka", "heyoka", "heyoka, default settings", THEIRS, _no_heyoka, _heyoka()),
    Contestant(
        "heyoka fast math", "heyoka", "heyoka, fast_math", THEIRS[::2], _no_heyoka, _heyoka(fast_math=True), False
    ),
    Contestant(
        "heyoka high accuracy", "heyoka", "heyoka, high_accuracy", THEIRS[::2], _no_heyoka,
        _heyoka(high_accuracy=True), False,
    ),
    Contestant(
        "heyoka compact", "heyoka", "heyoka, compact_mode", THEIRS[::2], _no_heyoka, _heyoka(compact_mode=True), False
    ),
    *(
        Contestant(f"SciPy {method}", method, f"solve_ivp, {method}", ADAPTIVE, _nothing, _scipy(method))
        for method in ("DOP853", "RK45", "LSODA", "Radau")
    ),
)  # fmt: skip
"""The methods of symrot and of other programs that a work-precision study can compare, symrot's own first."""

GROUPS = tuple(dict.fromkeys(contestant.group for contestant in CONTESTANTS))


def chosen(methods: str | None, quick: bool) -> Sequence[Contestant]:
    """Return the contestants of ``methods``, a comma-separated list of groups (:data:`GROUPS`); None means all.

    With ``quick``, heyoka runs in its default setting only.

    Raises
    ------
    InputError
        For an unknown group.
    """
    names = [name.strip() for name in methods.split(",")] if methods is not None else list(GROUPS)
    for name in names:
        if name not in GROUPS:
            message = f"--methods: expected a comma-separated list of {', '.join(GROUPS)}, got {name!r}"
            raise InputError(with_hint(message, name, GROUPS))
    return [one for one in CONTESTANTS if one.group in names and (one.quick or not quick)]


def tolerances_from(text: str) -> tuple[float, ...]:
    """Return the tolerances in a comma-separated list of numbers such as ``1e-6,1e-9``.

    Raises
    ------
    InputError
        Unless the text is a comma-separated list of decreasing numbers between 0 and 1.
    """
    try:
        tolerances = tuple(float(part) for part in text.split(","))
    except ValueError:
        tolerances = ()
    falling = list(tolerances) == sorted(set(tolerances), reverse=True)
    if not tolerances or not falling or not all(0.0 < value < 1.0 for value in tolerances):
        raise InputError(
            f"--tolerances: expected decreasing numbers between 0 and 1, separated by commas, such as 1e-3,1e-6,1e-9, "
            f"got {text!r}"
        )
    return tolerances

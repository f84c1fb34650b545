"""Reference motions by Taylor series with 40 digits, errors near 1e-28; for free bodies, over any number of periods.

Every period P of a free body adds the same rotation: ``q(t + n P) = R^n q(t)`` with ``R = q(P) q(0)^-1``. So the series
of one period suffice for a million periods. The tested closed form shares no code.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import InputError, SymrotError
from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import EXACT_FUNCTIONS
from symrot.formula.tree import evaluate
from symrot.kinematics.hamilton import conjugate, hamilton
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import Parameters, SceneKernel
from symrot.propagation.compiled_models import error_blocks, formula_deviations
from symrot.propagation.enclosures.step_limit import longest_followed

__all__ = ["DIGITS", "FUNCTIONS", "ORDER", "TAIL", "ExactPath", "as_mpf", "exact_parameters", "exact_start"]

Floats = NDArray[np.float64]

DIGITS, ORDER, TAIL = 40, 32, 1e-28  # digits of all numbers; order of a Taylor series; size of its last terms
MOST_STEPS = 2000
FINER = 1e-4  # factor by which the last terms are smaller in the series that checks a reference
SLOWEST = 1e-8  # fraction of the largest initial rate (or of 1 rad/s): errors of slower rates are relative to it


_NAMES = ("sqrt", "sin", "cos", "tan", "exp", "log", "sinh", "cosh", "tanh", "asin", "acos", "atan", "atan2")
FUNCTIONS: dict[str, Callable[..., Any]] = {name: getattr(mpmath, name) for name in _NAMES} | {"abs": abs}


def as_mpf(value: Any) -> Any:
    """Return a Fraction or a double as a number of mpmath, with mpmath's current number of digits."""
    return mpmath.mpf(value.numerator) / value.denominator if isinstance(value, Fraction) else mpmath.mpf(value)


def exact_parameters(parameters: Parameters, plan: Plan) -> dict[str, Fraction]:
    """Return a map from the name of each parameter of a kernel to its exact value, for the exact constants of ``plan``.

    A parameter stands for a formula of constants, such as ``(C - B)/A``.
    """
    values = {"pi": number.PI, **plan.constants}
    return {name: Fraction(evaluate(node, values, EXACT_FUNCTIONS)) for name, node in parameters}


def exact_start(plan: Plan) -> list[Fraction]:
    """Return the exact initial values of the integrated states: omega, and the quaternion or angle if needed."""
    start = plan.scene.initial
    values = {f"omega_{i + 1}": value for i, value in enumerate(start.omega_b)} | {"theta": Fraction(0)}
    values |= {f"q{i}": value for i, value in enumerate(start.quaternion)}
    return [Fraction(values[name]) for name in plan.states]


class ExactPath:
    """The reference solution of one motion: its integrated states in 40 digits.

    Parameters
    ----------
    plan, kernel
        The plan of the motion, and its kernel, which contains the rates.
    rounded : pair of sequences, optional
        The parameters of the rates and the initial states as doubles; default: the exact numbers of the scene.
    tail : float
        The size of the last terms of the series, which determines the steps.
    """

    def __init__(
        self, plan: Plan, kernel: SceneKernel, rounded: tuple[Sequence[float], Sequence[float]] | None = None,
        tail: float = TAIL,
    ) -> None:  # fmt: skip
        self.plan, self.system, self.tail = plan, recurrences(kernel.rates), tail
        self._again: Callable[[], ExactPath] = lambda: ExactPath(plan, kernel, rounded, tail * FINER)
        parameters, start = rounded or (exact_parameters(kernel.rate_parameters, plan).values(), exact_start(plan))
        names = [name for name, _ in kernel.rate_parameters]
        with mpmath.workdps(DIGITS):
            self.parameters = dict(zip(names, map(as_mpf, parameters), strict=True))
            self.start = [as_mpf(value) for value in start]
            self.t0 = as_mpf(Fraction(plan.scene.span.start))
        self.rates = sum(name.startswith("omega") for name in plan.states)
        bounds = formula_deviations(plan, kernel)
        self.deviations = bounds and bounds({name: float(value) for name, value in self.parameters.items()})
        self.edges = error_blocks(plan)[0]
        self.span = abs(as_mpf(Fraction(plan.scene.span.stop) - Fraction(plan.scene.span.start)))
        self.slowest = SLOWEST * (max([abs(x) for x in self.start[: self.rates]], default=0) or 1)
        self.pieces: list[tuple[Any, Any, list[Any]]] = []  # start and end of the step, coefficients of each state
        self._end: tuple[Any, list[Any]] = (self.t0, self.start)
        self._period: Any = None

    def _advance(self) -> None:
        """Add one step of the Taylor series at the end of the path computed so far."""
        now, state = self._end
        known = self.parameters | {"t": now} | dict(zip(self.system.states, state, strict=True))
        series = coefficients(self.system, ORDER, known, FUNCTIONS, as_mpf)
        size = max([abs(x) for x in state[: self.rates]] + [self.slowest])
        last = max(
            abs(one[ORDER - k]) / (size if i < self.rates else 1) for i, one in enumerate(series) for k in (0, 1)
        )
        step = (self.tail / last) ** (mpmath.mpf(1) / ORDER) if last else mpmath.mpf(1)
        if self.deviations:  # the step must end before a pulse of the torque that its coefficients do not show
            step = min(step, self.span)
            terms = [[float(abs(one[n] * step**n)) for n in range(1, ORDER + 1)] for one in series]
            allowed = [self.tail * float(size if first < self.rates else 1) for first in self.edges[:-1]]
            place = [float(x) for x in state]
            proven = longest_followed(
                self.deviations, float(now), place, terms, float(step), allowed, self.edges, ORDER
            )
            step = min(step, mpmath.mpf(proven))
            if step < 1e-15 * max(1, abs(now)):
                raise SymrotError(
                    f"{self.plan.scene.name}: the motion cannot be computed to {DIGITS} digits beyond t = "
                    f"{float(now)!r} s: the steps of the integration become too short, as happens before a singularity"
                )
        self.pieces.append((now, now + step, series))
        self._end = (now + step, self._sum(series, step))

    @staticmethod
    def _sum(series: list[Any], step: Any) -> list[Any]:
        return [mpmath.polyval(one[::-1], step) for one in series]

    def state(self, t: Any, on_step: Callable[[Any], object] = lambda now: None) -> list[Any]:
        """Return the integrated states at the time ``t``, not before the start; mpmath must be set to 40 digits."""
        while self._end[0] < t:
            self._advance()
            # An exception that on_step raises ends the computation.
            on_step(self._end[0])
        low, high = 0, len(self.pieces)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.pieces[middle][0] <= t else (low, middle)
        if not self.pieces:
            return self.start
        return self._sum(self.pieces[low][2], t - self.pieces[low][0])

    def states(self, times: Floats) -> Floats:
        """Return the integrated states at ``times``, none before the start, as doubles, one row for each time."""
        with mpmath.workdps(DIGITS):
            return np.array([[float(x) for x in self.state(mpmath.mpf(float(t)))] for t in times])

    def period(self) -> Any:
        """Return a period of the angular velocity of a free body, or a multiple of it, to about 29 digits.

        Raises
        ------
        InputError
            If the angular velocity does not return to its initial value within :data:`MOST_STEPS` steps.
        """
        start, left = np.array([float(x) for x in self.start[: self.rates]]), False
        size = float(np.linalg.norm(start))
        with mpmath.workdps(DIGITS):
            for _ in range(MOST_STEPS):
                self._advance()
                first, last, series = self.pieces[-1]
                rates = np.array([[float(x) for x in one] for one in series[: self.rates]])
                for k in range(8):  # doubles are accurate enough for the start of Newton's method
                    t = first + (last - first) * k / 8
                    now = np.array([np.polyval(one[::-1], float(t - first)) for one in rates])
                    apart = float(np.linalg.norm(now - start))
                    left |= apart > size / 4
                    if left and apart < size / 8:
                        root = self._newton(t)
                        if root is not None and root > self.t0:
                            return root - self.t0
        raise InputError(
            "expected a free body that is not on its separatrix, got a body whose angular velocity does "
            "not return to its start"
        )

    def _newton(self, t: Any) -> Any:
        """Return the time near ``t`` at which omega has its initial value; None if Newton's method diverges."""
        start = self.start[: self.rates]
        self.state(self.t0)
        speeds = [one[1] for one in self.pieces[0][2][: self.rates]]
        steepest = max(range(self.rates), key=lambda i: abs(speeds[i]))
        for _ in range(60):
            value = self.state(t)[steepest]
            change = (value - start[steepest]) / self._slope(t, steepest)
            t -= change
            if abs(change) < mpmath.mpf(10) ** (5 - DIGITS) * abs(t):
                break
        apart = max(abs(x - y) for x, y in zip(self.state(t)[: self.rates], start, strict=True))
        return t if apart < mpmath.mpf(10) ** (12 - DIGITS) else None

    def _slope(self, t: Any, index: int) -> Any:
        state = self.state(t)
        known = self.parameters | {"t": t} | dict(zip(self.system.states, state, strict=True))
        return coefficients(self.system, 1, known, FUNCTIONS, as_mpf)[index][1]

    def states_of_free_body(self, times: Floats) -> Floats:
        """Return omega and quaternion of a free body at ``times``, none of them before the start, shape (n, 7)."""
        with mpmath.workdps(DIGITS):
            return np.array([[float(x) for x in row] for row in self._rows_of_free_body(times)])

    def _rows_of_free_body(self, times: Sequence[float] | Floats) -> list[list[Any]]:
        """Return omega and quaternion of a free body at ``times`` in 40 digits."""
        period = self._period = self._period or self.period()
        first, last = self.start[self.rates :], self.state(self.t0 + period)[self.rates :]
        turn = hamilton(last, conjugate(first))
        length = mpmath.sqrt(sum(x * x for x in turn[1:]))
        half, axis = mpmath.atan2(length, turn[0]), [x / length for x in turn[1:]]
        rows = []
        for time in times:
            t = mpmath.mpf(float(time)) - self.t0
            count = mpmath.floor(t / period)
            state = self.state(self.t0 + (t - count * period))
            whole = [mpmath.cos(count * half), *(mpmath.sin(count * half) * x for x in axis)]
            rows.append([*state[: self.rates], *hamilton(whole, state[self.rates :])])
        return rows

    def error(self, t: float, periodic: bool) -> float:
        """Return the estimated error of the states at the time ``t``: the difference from a path with shorter steps.

        The error of rates is relative to the largest initial rate (to :data:`SLOWEST` rad/s if the body starts at
        rest). With ``periodic``, the body is free, and each path is computed for one period and repeated.
        """
        with mpmath.workdps(DIGITS):
            rows = [
                path._rows_of_free_body([t])[0] if periodic else path.state(mpmath.mpf(t))
                for path in (self, self._again())
            ]
            size = max([abs(x) for x in self.start[: self.rates]] + [self.slowest])
            pairs = zip(*rows, strict=True)
            return float(max(abs(x - y) / (size if i < self.rates else 1) for i, (x, y) in enumerate(pairs)))

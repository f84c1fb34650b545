"""The reference: Gauss-Legendre collocation of order 32 in extended precision, which is told where the features are.

Step control alone decides nothing: the caller names every feature of time or of a state. No step is longer than half
the width of a feature near it, or than a third of the distance to a feature further away; the pieces end exactly at the
times of jumps, and the nodes lie inside them. Within this limit a step is accepted if the last Legendre coefficients of
its derivative are at rounding level.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from time import process_time
from typing import Any, NamedTuple

import mpmath
import numpy as np

from tests.campaigns.torques.formulas import EXTENDED

__all__ = ["Dense", "Feature", "follow", "matrices", "time_mesh"]

NODES = 16
MOST_ITERATIONS = 60
MOST_STEPS = 60_000
MOST_SECONDS = 25.0
COARSER = float(np.finfo(EXTENDED).eps / np.finfo(np.float64).eps)
NEAR, FAR = 0.5, 1 / 3  # of the width of a feature, of the distance to it


class Feature(NamedTuple):
    """A place where a torque changes: ``value(y)`` passes ``center`` and the torque bends over ``width``.

    ``rate(y)`` and ``curvature`` bound the first and second time derivative of the value; for the time itself both are
    None.
    """

    center: float
    width: float
    value: Callable[[Any], Any] | None = None
    rate: Callable[[Any], Any] | None = None
    curvature: float = 0.0
    period: float = 0.0
    local: bool = False

    def distance(self, value: Any) -> Any:
        """Return the distance of a value from the center."""
        if not self.period:
            return np.abs(value - self.center)
        turned = np.mod(value - self.center, self.period)
        return np.minimum(turned, self.period - turned)


class Basis(NamedTuple):
    """Nodes on [0, 1], weights, integrals from 0 to the nodes, and the matrix from values at the nodes to Legendre
    coefficients.
    """

    nodes: Any
    weights: Any
    integral: Any  # (NODES, NODES): values at nodes -> integral from 0 to each node
    analysis: Any  # (NODES, NODES): values at nodes -> Legendre coefficients


@cache
def matrices() -> Basis:
    """Return the basis, computed in 40 digits."""
    with mpmath.workdps(40):
        roots = _roots()
        weights = [2 / ((1 - x**2) * mpmath.diff(lambda s: mpmath.legendre(NODES, s), x) ** 2) for x in roots]
        analysis = [[(2 * k + 1) / mpmath.mpf(2) * w * mpmath.legendre(k, x) for x, w in zip(roots, weights, strict=True)]
                    for k in range(NODES)]  # fmt: skip

        def integral_of(k: int, x: Any) -> Any:  # of P_k from -1 to x
            return x + 1 if k == 0 else (mpmath.legendre(k + 1, x) - mpmath.legendre(k - 1, x)) / (2 * k + 1)

        integrals = [
            [sum(integral_of(k, x) * analysis[k][j] for k in range(NODES)) / 2 for j in range(NODES)] for x in roots
        ]
        return Basis(
            _extended([(x + 1) / 2 for x in roots]), _extended([w / 2 for w in weights]),
            _extended(integrals), _extended(analysis),
        )  # fmt: skip


def _roots() -> list[Any]:
    guesses = np.polynomial.legendre.leggauss(NODES)[0]
    return [mpmath.findroot(lambda s: mpmath.legendre(NODES, s), mpmath.mpf(x)) for x in guesses]


def _extended(values: Any) -> Any:
    return np.array(
        [_extended(v) if isinstance(v, list) else EXTENDED(mpmath.nstr(v, 30)) for v in values], dtype=EXTENDED
    )


class Dense:
    """The motion as pieces: edges in order of time, the state at the start of each piece and the coefficients of its
    rates.
    """

    def __init__(self) -> None:
        self.starts: list[Any] = []
        self.lengths: list[Any] = []
        self.states: list[Any] = []
        self.coefficients: list[Any] = []

    def add(self, t: Any, h: Any, y: Any, coefficients: Any) -> None:
        """Store one step: from (t, y) over h, with Legendre coefficients (NODES, batch, N) of dy/dt."""
        self.starts.append(t)
        self.lengths.append(h)
        self.states.append(y)
        self.coefficients.append(coefficients)

    def __call__(self, times: Any) -> Any:
        """Return the states at times within the pieces, shape (n, batch, N)."""
        times = np.asarray(times, dtype=EXTENDED)
        starts, lengths = np.array(self.starts), np.array(self.lengths)
        sign = 1 if lengths[0] > 0 else -1
        index = np.clip(np.searchsorted(sign * starts, sign * times, side="right") - 1, 0, len(starts) - 1)
        x = 2 * (times - starts[index]) / lengths[index] - 1
        polynomials = [np.ones_like(x), x]
        for k in range(1, NODES + 1):
            polynomials.append(((2 * k + 1) * x * polynomials[k] - k * polynomials[k - 1]) / (k + 1))
        integrals = [x + 1] + [(polynomials[k + 1] - polynomials[k - 1]) / (2 * k + 1) for k in range(1, NODES)]
        out = np.array([self.states[i] for i in index])
        for k in range(NODES):
            rows = np.array([self.coefficients[i][k] for i in index])
            out += rows * (integrals[k] * lengths[index] / 2)[:, None, None]
        return out


def time_mesh(start: float, stop: float, features: Sequence[Feature], breaks: Sequence[float], longest: float) -> Any:
    """Return edges from start to stop that contain every break and are close enough to see every feature of time."""
    sign = 1.0 if stop >= start else -1.0
    low, high = min(start, stop), max(start, stop)
    inner = sorted({float(b) for b in breaks if low < b < high})
    edges = [EXTENDED(low)]
    for end in [*inner, high]:
        while edges[-1] < end:
            limit = longest
            for feature in features:
                limit = min(limit, _allowed(float(feature.distance(float(edges[-1]))), feature.width))
            step = EXTENDED(limit)
            left = end - edges[-1]
            edges.append(EXTENDED(end) if left <= 1.2 * step else edges[-1] + step)
            if len(edges) > 400_000:
                raise ArithmeticError("the mesh of a reference needs more than 400 000 pieces")
    found = np.array(edges)
    return found if sign > 0 else found[::-1]


def _allowed(distance: float, width: float) -> float:
    return max(NEAR * width, FAR * distance / (1 + FAR))


def follow(
    rates: Callable[[Any, Any], Any], y0: Any, start: float, stop: float, features: Sequence[Feature],
    breaks: Sequence[float] = (), longest: float = np.inf, scales: Any = 1.0, accuracy: float = 1e-18, observe: Any = None,
    doubles: Any = None,
) -> Dense:  # fmt: skip
    """Follow a batch of states, shape (batch, N), from start to stop (before or after).

    Errors of a step are judged against ``scales``, shape (N,). ``observe(times, states, weights)`` receives the nodes of
    every step that was accepted, and their weights in an integral over time. ``doubles`` are the same rates computed in
    doubles: they show what rounding does to a formula.

    Raises
    ------
    ArithmeticError
        If the steps shrink to nothing or become too many: the case is none for this reference.
    """
    basis, dense, deadline = matrices(), Dense(), process_time() + MOST_SECONDS
    y = np.asarray(y0, dtype=EXTENDED)
    in_time = [f for f in features if f.value is None]
    in_state = [f for f in features if f.value is not None]
    mesh = time_mesh(start, stop, in_time, breaks, min(longest, abs(stop - start)))
    h, steps = abs(mesh[1] - mesh[0]), 0
    for t, end in pairwise(mesh):
        sign = 1 if end > t else -1
        while t != end:
            h = min(h, *(_state_limit(f, y) for f in in_state), np.inf) if in_state else h
            left = abs(end - t)
            now = left if left <= 1.1 * h else h
            step = _step(rates, doubles, basis, t, sign * now, y, scales, accuracy)
            steps += 1
            if steps > MOST_STEPS or process_time() > deadline or now < 1e-17 * max(1.0, abs(float(t))):
                raise ArithmeticError(f"the reference came to t = {float(t)!r} s in {steps} steps")
            if step is None:
                h = now / 2
                continue
            values, coefficients, easy = step
            if observe is not None:
                states = y + sign * now * np.tensordot(basis.integral, values, axes=(1, 0))
                observe(t + sign * now * basis.nodes, states, now * basis.weights)
            dense.add(t, sign * now, y, coefficients)
            y = y + sign * now * np.tensordot(basis.weights, values, axes=(0, 0))
            t = end if now == left else t + sign * now
            if easy:
                h = max(h, now * EXTENDED(1.6)) if in_state else max(h, now * 2)
    dense.add(end, dense.lengths[-1], y, 0 * dense.coefficients[-1])
    return dense


def _state_limit(feature: Feature, y: Any) -> Any:
    """Return the longest step before the value of a state feature can come nearer than the width allows."""
    distance = float(np.min(feature.distance(feature.value(y))))
    room = _allowed(distance, feature.width)
    speed = float(np.max(np.abs(feature.rate(y))))
    bend = feature.curvature
    if feature.local and distance > room:
        bend *= min(1.0, 2 * (feature.width / (distance - room)) ** 2)
    if bend == 0:
        return EXTENDED(room / speed) if speed else EXTENDED(np.inf)
    return EXTENDED(2 * room / (speed + np.sqrt(speed * speed + 2 * bend * room)))


def _step(rates: Any, doubles: Any, basis: Basis, t: Any, h: Any, y: Any, scales: Any, accuracy: float) -> Any:
    """Return (rates at the nodes, coefficients, whether the step was easy), or None if the step is too long."""
    times = (t + h * basis.nodes)[:, None]
    values = np.broadcast_to(rates(times[:1], y[None]), (NODES, *y.shape))
    size = np.asarray(scales, dtype=EXTENDED) / abs(h)
    last, stalled, noise = np.inf, 0, 0.0
    for iteration in range(MOST_ITERATIONS):
        states = y + h * np.tensordot(basis.integral, values, axes=(1, 0))
        found = rates(times, states)
        if not np.isfinite(found).all():
            return None
        change = float(np.max(np.abs(found - values) / size))
        values = found
        if change <= max(accuracy / 4, noise):
            break
        stalled += change > 0.7 * last
        if stalled and not noise:
            noise = _noise(rates, doubles, times, states, values, size)
        if iteration > 3 and (change > 1e3 or stalled > 4):
            return None
        last = change
    else:
        return None
    coefficients = np.tensordot(basis.analysis, values, axes=(1, 0))
    tail = float(np.max(np.abs(coefficients[-2:]) / size))
    if tail > 20 * accuracy and tail > (noise or _noise(rates, doubles, times, states, values, size)):
        return None
    easy = float(np.max(np.abs(coefficients[-6:]) / size)) < accuracy and iteration < 20
    return values, coefficients, easy


def _noise(rates: Any, doubles: Any, times: Any, states: Any, values: Any, size: Any) -> float:
    """Return how much rounding changes the rates: nothing below that can be resolved.

    The rates in doubles, whose rounding is coarser by a known factor, or the last bits of times show it.
    """
    if doubles is not None:
        return 4 * COARSER * float(np.max(np.abs(doubles(times, states) - values) / size))
    ulps = 1 + 2 * np.finfo(EXTENDED).eps
    moved = max(np.max(np.abs(rates(times * t, states * y) - values) / size) for t, y in ((ulps, 1), (1, ulps)))
    return 4 * float(moved)

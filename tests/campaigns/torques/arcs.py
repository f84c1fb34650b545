"""Motions about axis 3 with jumping torques, in closed form: dry friction, bang-bang control, steps in angle and rate.

Each function returns ``motion(times) -> (omega_3, angle)`` in extended precision; the angle is 0 at the start.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tests.campaigns.torques.formulas import EXTENDED

__all__ = ["Drive", "bang_bang", "constant_drive", "dry_friction", "sine_drive", "soft_friction", "stepped"]

Motion = Callable[[Any], tuple[Any, Any]]
MOST_ARCS = 20_000
PER_SWING = 128


class Drive(NamedTuple):
    """A torque of time with its first and second antiderivative, and a time shorter than half of each of its swings."""

    torque: Callable[[Any], Any]
    once: Callable[[Any], Any]
    twice: Callable[[Any], Any]
    swing: float


def constant_drive(m: float) -> Drive:
    """Return a constant torque, N m."""
    a = EXTENDED(m)
    return Drive(lambda t: a + 0 * t, lambda t: a * t, lambda t: a * t * t / 2, np.inf)


def sine_drive(m: float, b: float) -> Drive:
    """Return the torque m*sin(b*t)."""
    a, b_ = EXTENDED(m), EXTENDED(b)
    return Drive(
        lambda t: a * np.sin(b_ * t), lambda t: -a / b_ * np.cos(b_ * t), lambda t: -a / b_**2 * np.sin(b_ * t), 1 / b
    )


class _Arcs:
    """Arcs (pieces of a motion) in order of time; each is a function of time that returns omega_3 and the angle."""

    def __init__(self) -> None:
        self.starts: list[Any] = []
        self.arcs: list[Motion] = []

    def add(self, start: Any, arc: Motion) -> None:
        self.starts.append(start)
        self.arcs.append(arc)
        if len(self.arcs) > MOST_ARCS:
            raise ArithmeticError(f"more than {MOST_ARCS} arcs")

    def __call__(self, times: Any) -> tuple[Any, Any]:
        times = np.asarray(times, dtype=EXTENDED)
        index = np.clip(np.searchsorted(np.array(self.starts), times, side="right") - 1, 0, None)
        rate, angle = np.empty_like(times), np.empty_like(times)
        for i in np.unique(index):
            part = index == i
            rate[part], angle[part] = self.arcs[i](times[part])
        return rate, angle


def _root(function: Callable[[Any], Any], before: bool, low: Any, high: Any) -> Any:
    """Return the time between low and high at which a function changes from its sign at low, bisected to the last bit."""
    for _ in range(200):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        if bool(function(middle) > 0) == before:
            low = middle
        else:
            high = middle
    return high


def _first_change(function: Callable[[Any], Any], before: bool, low: Any, high: Any, swing: float) -> Any:
    """Return the first time after low at which a function changes sign, or high.

    ``before`` says whether the function is positive just after low, where it may be zero. It is evaluated
    :data:`PER_SWING` times in each swing of the drive.
    """
    cells = int(min(np.ceil(float(high - low) / swing * PER_SWING), 400_000))
    grid = low + (high - low) * np.linspace(0, 1, max(cells, 64) + 1).astype(EXTENDED)
    positive = function(grid) > 0
    positive[0] = before
    change = np.nonzero(positive[:-1] != positive[1:])[0]
    if not len(change):
        return high
    return _root(function, before, grid[change[0]], grid[change[0] + 1])


def dry_friction(inertia: float, k: float, drive: Drive, t0: float, omega: float, stop: float) -> Motion:
    """Return the motion under ``drive(t) - k*sign(omega_3)``: it slips, sticks where the drive is weaker, breaks away."""
    found, c, force = _Arcs(), EXTENDED(inertia), EXTENDED(k)
    t, w, angle, end = EXTENDED(t0), EXTENDED(omega), EXTENDED(0), EXTENDED(stop)
    while t < end:
        if w == 0 and abs(drive.torque(t)) <= force * (1 + EXTENDED(1e-17)):
            found.add(t, lambda at, angle=angle: (0 * at, 0 * at + angle))
            t = _breakaway(drive, force, t, end)
            if t < end:  # just behind it the drive is the stronger
                w = EXTENDED(0)
                t, w, angle = _slip(found, c, force, drive, t, w, angle, end, np.sign(drive.torque(t)))
            continue
        side = np.sign(w) if w != 0 else np.sign(drive.torque(t))
        t, w, angle = _slip(found, c, force, drive, t, w, angle, end, side)
    return found


def _breakaway(drive: Drive, force: Any, t: Any, end: Any) -> Any:
    return _first_change(lambda at: np.abs(drive.torque(at)) - force, False, t, end, drive.swing)


def _slip(
    found: _Arcs, c: Any, force: Any, drive: Drive, t: Any, w: Any, angle: Any, end: Any, side: Any
) -> tuple[Any, Any, Any]:
    """Add the arc of one slip and return where it ends: at rest, or at the end of the span."""

    def arc(at: Any) -> tuple[Any, Any]:
        s = at - t
        rate = w + (drive.once(at) - drive.once(t) - side * force * s) / c
        turn = angle + w * s + (drive.twice(at) - drive.twice(t) - drive.once(t) * s - side * force * s * s / 2) / c
        return rate, turn

    found.add(t, arc)
    if np.isfinite(drive.swing):
        stop = _first_change(lambda at: side * arc(at)[0], True, t, end, drive.swing)
    else:
        slowing = (drive.torque(t) - side * force) / c * side
        stop = min(t + side * w / -slowing, end) if slowing < 0 else end
    return stop, (EXTENDED(0) if stop < end else arc(stop)[0]), arc(stop)[1]


def bang_bang(inertia: float, k: float, kappa: float, target: float, t0: float, omega: float, stop: float) -> Motion:
    """Return the motion under ``-k*sign(angle - target + kappa*omega_3)``: parabolas, then sliding along the line."""
    found, a, b = _Arcs(), EXTENDED(k) / EXTENDED(inertia), EXTENDED(kappa)
    t, w, x, end = EXTENDED(t0), EXTENDED(omega), EXTENDED(-target), EXTENDED(stop)
    goal = EXTENDED(target)
    side = np.sign(x + b * w)
    while t < end:
        if side == 0 or (len(found.arcs) and abs(w) <= a * b):
            found.add(t, lambda at, t=t, x=x: (-x / b * np.exp(-(at - t) / b), goal + x * np.exp(-(at - t) / b)))
            break
        u = -side * a
        found.add(t, lambda at, t=t, x=x, w=w, u=u: (w + u * (at - t), goal + x + (w + u * (at - t) / 2) * (at - t)))
        # x + w s + u s^2/2 + b (w + u s) = 0 for the first s > 0
        p, q, r = u / 2, w + b * u, x + b * w if len(found.arcs) == 1 else EXTENDED(0)
        if r == 0:
            s = -q / p
        else:
            root = np.sqrt(q * q - 4 * p * r)
            s = min((z for z in ((-q + root) / (2 * p), (-q - root) / (2 * p)) if z > 0), default=EXTENDED(np.inf))
        if t + s >= end:
            break
        t, x, w = t + s, x + (w + u * s / 2) * s, w + u * s
        x = -b * w  # on the line
        side = -side
    return found


def stepped(
    acceleration: Callable[[int, int], float], angles: tuple[float, ...], rates: tuple[float, ...], t0: float,
    omega: float, stop: float,
) -> Motion:  # fmt: skip
    """Return the motion with a constant acceleration in each cell between given angles and given rates.

    ``acceleration(i, j)`` is that of the cell with i of the ``angles`` below the angle and j of the ``rates`` below
    the rate. A rate whose both sides push towards it is held.
    """
    found, end = _Arcs(), EXTENDED(stop)
    t, x, w = EXTENDED(t0), EXTENDED(0), EXTENDED(omega)
    i, j = sum(x > c for c in angles), sum(w > v for v in rates)
    while t < end:
        held = next((n for n in range(len(rates)) if w == rates[n] and n in (j, j - 1)
                     and acceleration(i, n) > 0 > acceleration(i, n + 1)), None)  # fmt: skip
        a = EXTENDED(0 if held is not None else acceleration(i, j))
        found.add(t, lambda at, t=t, x=x, w=w, a=a: (w + a * (at - t), x + (w + a * (at - t) / 2) * (at - t)))
        events = []  # (time, kind, edge)
        for n, v in enumerate(rates):
            up = n == j and a > 0
            if held is None and (up or (n == j - 1 and a < 0)):
                events.append(((v - w) / a, 1, n))
        for n, c in enumerate(angles):
            if n in (i, i - 1):
                events += [(s, 0, n) for s in _quadratic(a / 2, w, x - c) if s > 0 and _crosses(w + a * s, n, i)]
        s, kind, edge = min(events, default=(EXTENDED(np.inf), 0, 0))
        if t + s >= end:
            break
        t, x, w = t + s, x + (w + a * s / 2) * s, w + a * s
        if kind == 1:
            w = EXTENDED(rates[edge])
            other = edge + 1 if edge == j else edge
            back = acceleration(i, other) * (1 if edge == j else -1) < 0
            j = j if back else other
        else:
            x, i = EXTENDED(angles[edge]), (edge + 1 if edge == i else edge)
    return found


def _crosses(rate: Any, edge: int, cell: int) -> bool:
    return bool(rate > 0) if edge == cell else bool(rate < 0)


def _quadratic(a: Any, b: Any, c: Any) -> list[Any]:
    if a == 0:
        return [] if b == 0 else [-c / b]
    inside = b * b - 4 * a * c
    if inside < 0:
        return []
    half = -(b + (np.sqrt(inside) if b >= 0 else -np.sqrt(inside))) / 2
    return [half / a] + ([c / half] if half != 0 else [])


def soft_friction(inertia: float, k: float, width: float, t0: float, omega: float) -> Motion:
    """Return the motion under ``-k*tanh(omega_3/width)``: sinh(omega/width) decays exponentially."""
    decay = EXTENDED(k) / (EXTENDED(inertia) * EXTENDED(width))
    w0 = EXTENDED(omega) / EXTENDED(width)
    nodes, weights = (x.astype(EXTENDED) for x in np.polynomial.legendre.leggauss(24))

    def log_sinh(x: Any) -> Any:
        x = np.abs(x)
        return np.where(x > 1, x + np.log1p(-np.exp(-2 * x)), np.log(np.sinh(np.minimum(x, 2)))) - np.where(
            x > 1, np.log(EXTENDED(2)), 0
        )

    def rate_of(t: Any) -> Any:
        with np.errstate(all="ignore"):
            level = log_sinh(w0) - decay * (t - EXTENDED(t0))
            large = level + np.log1p(np.sqrt(1 + np.exp(-2 * np.maximum(level, -5))))
            small = np.arcsinh(np.exp(np.minimum(level, 5)))
        return np.where(level > 0, large, small) * np.sign(w0)

    def motion(times: Any) -> tuple[Any, Any]:
        times = np.asarray(times, dtype=EXTENDED)
        scaled = rate_of(times)
        angle = np.array([_work(w0, z) for z in scaled]) * EXTENDED(width) / decay
        return scaled * EXTENDED(width), angle

    def _work(high: Any, low: Any) -> Any:  # integral of x*coth(x) from low to high
        sign, high, low = np.sign(high), abs(high), abs(low)
        edges = [low]
        while edges[-1] < high:
            edges.append(min(high, edges[-1] + EXTENDED(0.75)) if edges[-1] < 40 else high)
        total = EXTENDED(0)
        for a, b in pairwise(edges):
            x = (a + b) / 2 + (b - a) / 2 * nodes
            total += ((b - a) / 2 * weights * np.where(x < 1e-12, 1, x / np.tanh(x))).sum()
        return sign * total

    return motion

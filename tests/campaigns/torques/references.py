"""The true motion of a case: from collocation that is told the features, or from arcs in closed form."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.campaigns.torques.collocation import Feature, follow
from tests.campaigns.torques.formulas import EXTENDED, torque_function

__all__ = ["Problem", "Truth", "arcs_truth", "attitude_apart", "reference", "unseen_rate"]

PERTURBATION = 1e-9  # of the start, relative; for the condition of the motion
UNSEEN = 1e-3  # rad over the whole span
ROUNDED = 4.0  # times the change of the torque when its formula is evaluated once in doubles
TURNED = 8 * 2.0**-52  # rad of attitude per rad turned


@dataclass
class Problem:
    """A body, its start and a torque as texts, with the features for the reference.

    ``low`` and ``high`` are the first and last time of the span, on both sides of ``t0``; ``speed`` is a size of omega
    that the motion reaches, for the reference's own error control.
    """

    principal: tuple[float, float, float]
    omega: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]
    t0: float
    low: float
    high: float
    texts: tuple[str, str, str]
    parameters: dict[str, float]
    features: list[Feature] = field(default_factory=list)
    breaks: list[float] = field(default_factory=list)
    longest: float = np.inf
    speed: float = 1.0
    poles: list[float] = field(default_factory=list)  # times that no motion passes
    reach: float = np.inf  # the reference goes no further: up to a pole
    arcs: Callable[["Problem", float], "Callable[[Any], tuple[Any, Any]]"] | None = None
    """In closed form about axis 3: from the problem and another initial omega_3, omega_3(t) and angle(t)."""


@dataclass
class Truth:
    """The true motion, and how far a right answer may be from it.

    ``omega_scale`` is the largest length of omega on the way, at least :func:`unseen_rate`; the roundings are what the
    formula of the torque changes the motion by when it is evaluated in doubles, in rad/s and rad; ``growth`` is by how
    much a relative change of the start grows, in omega and in attitude.
    """

    motion: Callable[[Any], Any]  # times -> (n, 7)
    omega_scale: float
    rounding: tuple[float, float]
    growth: tuple[float, float]
    turned: float


def unseen_rate(span: float) -> float:
    """Return the rate below which omega need not be resolved, rad/s.

    A body that turns by less than 1e-3 rad over the whole span is at rest as far as the attitude shows; relative errors
    of such a slow motion would measure nothing.
    """
    return UNSEEN / span


def attitude_apart(p: Any, q: Any) -> Any:
    """Return the angles between attitudes, rad, whatever the signs and lengths of the quaternions."""
    p, q = (np.asarray(x, dtype=EXTENDED) for x in (p, q))
    p, q = (x / np.sqrt((x * x).sum(axis=-1, keepdims=True)) for x in (p, q))
    half = np.minimum(*(np.sqrt(((p - s * q) ** 2).sum(axis=-1)) for s in (1, -1))) / 2
    return 4 * np.arcsin(np.minimum(half, 1))


def _cross(u: Any, v: Any) -> Any:
    """Return the vector products of arrays (..., 3), faster than ``np.cross`` for these shapes."""
    out = np.empty(u.shape, dtype=EXTENDED)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i] = u[..., j] * v[..., k] - u[..., k] * v[..., j]
    return out


def _rates(problem: Problem, kind: Any = EXTENDED) -> Callable[[Any, Any], Any]:
    torque = torque_function(problem.texts, problem.parameters, kind)
    moments = np.array(problem.principal, dtype=EXTENDED)

    def rates(t: Any, y: Any) -> Any:
        w, q = y[..., :3], y[..., 3:]
        out = np.empty(y.shape, dtype=EXTENDED)
        out[..., :3] = (torque(t, y) + _cross(moments * w, w)) / moments
        q0, v = q[..., :1], q[..., 1:]
        out[..., 3] = -(v[..., 0] * w[..., 0] + v[..., 1] * w[..., 1] + v[..., 2] * w[..., 2]) / 2
        out[..., 4:] = (q0 * w + _cross(v, w)) / 2
        return out

    return rates


def _perturbed(problem: Problem, scale: float) -> Any:
    """Return the start and three changed starts, shape (4, 7): omega changed along and across itself, and the attitude."""
    random = np.random.default_rng(7)
    start = np.array([*problem.omega, *problem.quaternion], dtype=EXTENDED)
    start[3:] /= np.sqrt((start[3:] ** 2).sum())
    batch = np.repeat(start[None], 4, axis=0)
    moving = [i for i in range(3) if problem.omega[i] or problem.texts[i] != "0"]
    one_axis = len(moving) == 1  # which must not be tried with rates across it: nothing makes such
    axis = np.eye(3)[moving[0] if one_axis else 2]
    for row in (1, 2):
        along = axis * (3 - 2 * row) if one_axis else random.normal(size=3)
        batch[row, :3] += EXTENDED(PERTURBATION * scale) * along / np.linalg.norm(along)
    turn = axis if one_axis else random.normal(size=3)
    turn = EXTENDED(PERTURBATION / 2) * turn / np.linalg.norm(turn)
    q0, v = start[3], start[4:]
    batch[3, 3] -= (v * turn).sum()
    batch[3, 4:] += q0 * turn + np.cross(v, turn)
    return batch


def _growth(states: Any, scale: float) -> tuple[float, float]:
    """Return how much the changes have grown in omega and in attitude, from states (n, 4, 7)."""
    rates = np.sqrt(((states[:, 1:, :3] - states[:, :1, :3]) ** 2).sum(axis=-1)).max() / scale
    turns = attitude_apart(states[:, 1:, 3:], np.repeat(states[:, :1, 3:], 3, axis=1)).max()
    return float(rates / PERTURBATION), float(turns / PERTURBATION)


def reference(problem: Problem) -> Truth:
    """Return the truth by collocation, in both directions from the start, or by the problem's arcs.

    Raises
    ------
    ArithmeticError
        If the reference cannot follow the motion.
    """
    if problem.arcs is not None:
        return arcs_truth(problem)
    high = min(problem.high, problem.reach)
    span = high - problem.low
    size = max(float(np.linalg.norm(problem.omega)), problem.speed, unseen_rate(span))
    rates, doubles = _rates(problem), torque_function(problem.texts, problem.parameters, np.float64)
    extended, moments = torque_function(problem.texts, problem.parameters), np.array(problem.principal)
    start = _perturbed(problem, size)
    lost, turned, peak = [0.0], [0.0], [float(np.linalg.norm(problem.omega))]

    def observe(times: Any, states: Any, weights: Any) -> None:
        base = states[:, 0]
        change = np.abs(doubles(times, base) - extended(times, base)) / moments
        lost[0] += float((weights[:, None] * change).sum())
        speed = np.sqrt((base[:, :3] ** 2).sum(axis=1))
        turned[0] += float((weights * speed).sum())
        peak[0] = max(peak[0], float(speed.max()))

    scales = np.array([size] * 3 + [1.0] * 4)
    options = {"longest": problem.longest, "scales": scales, "observe": observe, "doubles": _rates(problem, np.float64)}
    sides = {
        sign: follow(rates, start, problem.t0, end, problem.features, problem.breaks, **options)
        for sign, end in ((1, high), (-1, problem.low))
        if sign * (end - problem.t0) > 0
    }

    def motion(times: Any) -> Any:
        times = np.asarray(times, dtype=EXTENDED)
        out = np.empty((len(times), *start.shape), dtype=EXTENDED)
        out[:] = start
        for sign, dense in sides.items():
            part = sign * (times - problem.t0) > 0
            if part.any():
                out[part] = dense(times[part])
        return out

    scale = max(peak[0], unseen_rate(span))
    edges = np.concatenate([np.array(dense.starts) for dense in sides.values()])
    return Truth(
        lambda times: motion(times)[:, 0], scale,
        (ROUNDED * lost[0], ROUNDED * lost[0] * span + TURNED * turned[0]), _growth(motion(edges), size), turned[0],
    )  # fmt: skip


def arcs_truth(problem: Problem) -> Truth:
    """Return the truth of a rotation about axis 3 in closed form."""
    assert problem.arcs is not None
    span = problem.high - problem.low
    base = problem.arcs(problem, problem.omega[2])
    times = np.linspace(problem.low, problem.high, 2001).astype(EXTENDED)
    rate, angle = base(times)
    scale = max(float(np.abs(rate).max()), unseen_rate(span))
    other, turn = problem.arcs(problem, problem.omega[2] + PERTURBATION * scale)(times)
    growth = float(np.abs(other - rate).max() / scale / PERTURBATION), float(np.abs(turn - angle).max() / PERTURBATION)
    turned = float(np.abs(np.diff(angle)).sum())
    torque = torque_function(problem.texts, problem.parameters)
    steepest = float(np.abs(torque(times, _about_axis_3(problem, rate, angle))).max()) / problem.principal[2]
    clock = 2.0**-52 * max(abs(problem.low), abs(problem.high))
    lost = ROUNDED * steepest * clock
    return Truth(
        lambda at: _about_axis_3(problem, *base(np.asarray(at, dtype=EXTENDED))), scale,
        (lost, lost * span + TURNED * turned), growth, turned,
    )  # fmt: skip


def _about_axis_3(problem: Problem, rate: Any, angle: Any) -> Any:
    q0, q1, q2, q3 = (EXTENDED(x) for x in problem.quaternion)
    cos, sin = np.cos(angle / 2), np.sin(angle / 2)
    zero = np.zeros_like(rate)
    return np.stack(
        [zero, zero, rate, q0 * cos - q3 * sin, q1 * cos + q2 * sin, q2 * cos - q1 * sin, q0 * sin + q3 * cos], axis=-1
    )

"""Random cases by family: a body, its start, a torque, a method, sample times and times of dense output.

A case depends only on seed, family and index, so one line of the table suffices to make it again.
"""

import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.campaigns.torques.formulas import SWITCHES, names_of
from tests.campaigns.torques.references import Problem
from tests.campaigns.torques.shapes import IN_TIME, SWITCHES_IN_TIME, Random, Shape, impulse, product

__all__ = ["Case", "Draw", "fitted", "log_uniform", "scene_of", "toml_of"]

TOLERANCES = (1e-12, 1e-6)
WIDTHS = (1e-6, 1.0)  # of the span
SPANS = (1e-2, 1e3)  # s
PAIRS = 48  # structures of products, of each family
METHODS = {
    "auto": 0.32, "taylor": 0.22, "dop853": 0.2, "scipy:DOP853": 0.06, "scipy:LSODA": 0.07, "scipy:RK45": 0.03,
    "scipy:Radau": 0.02, "auto ZXZ": 0.02, "taylor ZXZ": 0.015, "dop853 ZXZ": 0.015, "auto ensemble": 0.03,
    "taylor ensemble": 0.02, "dop853 ensemble": 0.02,
}  # fmt: skip
"""Method, and how often it is drawn; ``ZXZ`` steps Euler angles, ``ensemble`` three motions at once."""

COARSE = {"scipy:RK45": 1e-8, "scipy:Radau": 1e-7}
"""The smallest tolerance at which a method of low order is asked."""


@dataclass
class Case:
    """One run and its truth; ``method`` is a key of :data:`METHODS`, or ``function`` or ``table``."""

    family: str
    index: int
    seed: int
    shape: str
    problem: Problem
    method: str
    tolerance: float
    samples: Any  # times, shape (n,)
    dense: Any
    table: tuple[Any, Any] | None = None
    others: list[tuple[float, float, float]] = field(default_factory=list)
    """Initial rates of the other motions of an ensemble."""

    @property
    def key(self) -> str:
        """Return the argument of ``--case`` for this case."""
        return f"{self.family}:{self.index}"


def log_uniform(random: Random, low: float, high: float) -> float:
    """Return a number whose logarithm is uniform."""
    return float(10 ** random.uniform(np.log10(low), np.log10(high)))


@dataclass
class Draw:
    """The random choices that all families share: a span, a width, and the body's angular speed."""

    random: Random
    t0: float
    low: float
    high: float
    width: float
    turn: float  # rad, of the size that the torque makes the body turn
    spin: float  # rad that the body would turn freely

    @classmethod
    def new(cls, family: str, index: int, seed: int) -> "Draw":
        """Return the choices of one case."""
        random = np.random.default_rng([seed, zlib.crc32(family.encode()), index])
        span = log_uniform(random, *SPANS)
        t0 = float(random.choice([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e3, -5.0]))
        low = t0 - 0.3 * span if random.random() < 0.12 else t0
        width = span * log_uniform(random, *WIDTHS)
        kind = random.random()
        spin = 0.0 if kind < 0.35 else log_uniform(random, 0.03, 1) if kind < 0.55 else log_uniform(random, 1, 200)
        return cls(random, t0, low, t0 + span, width, log_uniform(random, 0.05, 30), spin)

    @property
    def span(self) -> float:
        """Return the length of the span, s."""
        return self.high - self.low

    def sign(self) -> float:
        """Return 1 or -1."""
        return float(self.random.choice([-1.0, 1.0]))

    def moments(self, kind: str) -> tuple[float, float, float]:
        """Return principal moments of a body, of a ``sphere`` if asked."""
        size = log_uniform(self.random, 1e-2, 1e2)
        if kind == "sphere":
            return size, size, size
        a, b = self.random.uniform(0.4, 1.6, size=2)
        c = self.random.uniform(abs(a - b) + 0.05, a + b - 0.05)
        return float(size * a), float(size * b), float(size * c)

    def attitude(self) -> tuple[float, float, float, float]:
        """Return the identity in most cases, otherwise a random unit quaternion."""
        if self.random.random() < 0.6:
            return 1.0, 0.0, 0.0, 0.0
        q = self.random.normal(size=4)
        q /= np.linalg.norm(q)
        return float(q[0]), float(q[1]), float(q[2]), float(q[3])

    def time_shape(self, switches: bool = False, name: str = "") -> Shape:
        """Return a random shape of time, or the one with the given name."""
        makers = SWITCHES_IN_TIME if switches else IN_TIME
        name = name or str(self.random.choice(sorted(makers)))
        return makers[name](self.random, self.low, self.high, self.width)

    def structure(self, family: str, switches: bool = False) -> tuple[Random, str, str]:
        """Return two names of shapes, out of :data:`PAIRS` for a family, and the random choices that belong to them.

        The numbers of a formula vary from case to case, its structure less, since each structure must be compiled once.
        """
        pair = np.random.default_rng([zlib.crc32(family.encode()), int(self.random.integers(PAIRS))])
        first, second = (str(pair.choice(sorted(SWITCHES_IN_TIME if switches else IN_TIME))) for _ in range(2))
        return pair, first, second

    def method(self) -> str:
        """Return a random method."""
        weights = np.array(list(METHODS.values()))
        return str(self.random.choice(list(METHODS), p=weights / weights.sum()))


def fitted(draw: Draw, shape: Shape, inertia: float) -> tuple[Shape, float]:
    """Return a shape of time times a moment m that turns the body as drawn, and the rate that results."""
    total, peak = impulse(shape, draw.low, draw.high)
    rate = draw.turn / draw.span
    m = inertia * rate / total if total > 1e-9 * peak * draw.span and peak > 1e-200 else inertia * rate / draw.span
    m *= draw.sign()
    return shape._replace(text=f"m*({shape.text})", parameters={**shape.parameters, "m": float(m)}), rate


def finish(
    draw: Draw, family: str, index: int, seed: int, shape: str, problem: Problem, tolerance: float | None = None,
    method: str | None = None,
) -> Case:  # fmt: skip
    """Return the case of a problem, with random method, sample times and dense times."""
    random, method = draw.random, method or draw.method()
    aim = tolerance or log_uniform(random, *TOLERANCES)
    aim = max(aim, COARSE.get(method, 0.0))
    count = int(random.choice([1, 2, 3, 10, 30]))
    samples = np.sort(random.uniform(problem.low, problem.high, size=count))
    samples[-1] = problem.high
    if problem.low < problem.t0:
        samples = np.concatenate([[problem.low], samples])
    low, high = float(samples.min()), float(samples.max())
    low = min(low, problem.t0)
    dense = [random.uniform(low, high, size=12)]
    in_time = [f for f in problem.features if f.value is None][:8]
    for feature in in_time:
        dense.append(feature.center + feature.width * random.uniform(-6, 6, size=4))
    for edge in problem.breaks[:6]:
        dense.append(np.array([edge, np.nextafter(edge, -np.inf), edge + draw.width * random.uniform(0, 1)]))
    times = np.concatenate(dense)
    times = np.sort(times[(times >= low) & (times <= high)])
    others = []
    if method.endswith("ensemble"):
        fast = problem.speed * random.uniform(-0.3, 0.3, size=2)
        if any(
            "atan2" in text for text in problem.texts
        ):  # slower ones: faster ones reach the cut, which no break tells
            fast = -abs(fast) / 3
        moving = [i for i in range(3) if problem.omega[i] or problem.texts[i] != "0"]
        for extra in fast:
            changed = list(problem.omega)
            for i in moving:
                changed[i] += float(extra)
            others.append((changed[0], changed[1], changed[2]))
    return Case(family, index, seed, shape, problem, method, aim, samples, times, None, others)


# --- families of time -------------------------------------------------------------------------------------------------


def _axis(draw: Draw, shape: Shape) -> Problem:
    axis, moments = int(draw.random.integers(3)), draw.moments("body")
    shape, rate = fitted(draw, shape, moments[axis])
    texts, omega = ["0", "0", "0"], [0.0, 0.0, 0.0]
    texts[axis], omega[axis] = shape.text, draw.sign() * draw.spin / draw.span
    return _problem(draw, moments, omega, texts, shape, rate)


def _problem(
    draw: Draw, moments: tuple[float, float, float], omega: Any, texts: Any, shape: Shape, rate: float
) -> Problem:
    w1, w2, w3 = (float(x) for x in omega)
    return Problem(
        moments, (w1, w2, w3), draw.attitude(), draw.t0, draw.low, draw.high, (texts[0], texts[1], texts[2]),
        shape.parameters, shape.features, shape.breaks, shape.longest, rate + draw.spin / draw.span,
    )  # fmt: skip


def _three(draw: Draw, kind: str, switches: bool = False) -> tuple[Problem, str]:
    """Return a torque with up to three components, for a body that may tumble."""
    moments, random = draw.moments(kind), draw.random
    structure, *names = draw.structure(f"{kind} {switches}", switches)
    shapes = [draw.time_shape(switches, name) for name in names]
    fits = [fitted(draw, shape, min(moments)) for shape in shapes]
    (first, rate), (second, _) = fits
    pair = product(first, second)  # for its parameters: those of the second renamed
    left, right = _factors(pair.text)
    places = structure.permutation(3)
    texts = ["0", "0", "0"]
    texts[places[0]], texts[places[1]] = left, right
    if structure.random() < 0.4:
        texts[places[2]] = f"{left}/2-{right}/3"
    omega = random.normal(size=3) * draw.spin / draw.span / 2
    if kind != "sphere" and random.random() < 0.5:
        omega = np.array([0.01, 1.0, 0.02])[places] * draw.spin / draw.span
    return _problem(draw, moments, omega, texts, pair, 2 * rate), f"{first.name}+{second.name}"


def _factors(text: str) -> tuple[str, str]:
    """Return the two bracketed factors of a product."""
    depth = 0
    for i, mark in enumerate(text):
        depth += (mark == "(") - (mark == ")")
        if depth == 0:
            return text[: i + 1], text[i + 2 :]
    raise ValueError(text)


def time_axis(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Torques of time about the principal axis of rotation."""
    shape = draw.time_shape()
    return finish(draw, family, index, seed, shape.name, _axis(draw, shape))


def time_product(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Products of two shapes of time."""
    _, *names = draw.structure(family)
    first, second = (draw.time_shape(name=name) for name in names)
    if draw.random.random() < 0.6:  # where the other is not zero
        names = ("c", "d", "e")
        place = first.parameters["c"] + first.parameters.get("w", draw.width) * draw.random.uniform(-1, 1)
        moved = place - second.parameters["c"]
        parameters = {k: v + moved if k in names else v for k, v in second.parameters.items()}
        features = [f._replace(center=f.center + moved) for f in second.features]
        second = second._replace(parameters=parameters, features=features)
        if "a" in parameters:  # a chirp about another place may be much faster at the ends
            second = second._replace(longest=second.longest / 3)
    shape = product(first, second)
    return finish(draw, family, index, seed, shape.name, _axis(draw, shape))


def time_sphere(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Torques of time on a body with three equal moments: the momentum in the body is an integral of the torque."""
    problem, name = _three(draw, "sphere")
    return finish(draw, family, index, seed, name, problem)


def time_tumbling(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Torques of time on an asymmetric body."""
    problem, name = _three(draw, "body")
    return finish(draw, family, index, seed, name, problem)


def switch_time(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Switches in time, about one axis."""
    shape = draw.time_shape(switches=True)
    if draw.random.random() < 0.25:
        structure, *_ = draw.structure(family)
        shape = product(shape, draw.time_shape(name=str(structure.choice(sorted(IN_TIME)))))
    return finish(draw, family, index, seed, shape.name, _axis(draw, shape))


def switch_tumbling(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Switches in time, on a body that may tumble."""
    problem, name = _three(draw, "body", switches=True)
    return finish(draw, family, index, seed, name, problem)


def thruster(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A thruster with many short pulses."""
    count = int(draw.random.choice([10, 100, 1000]))
    on = 2.0 ** -int(draw.random.choice([7, 3, 13]))  # the edges of the truth are doubles, and exact
    c = log_uniform(draw.random, 1e-2, 1e2)
    m = c * draw.turn / count / (count * on)
    edges = [float(k) + d for k in range(count + 1) for d in (0.0, on)]
    text = str(draw.random.choice(["where(mod(t, 1) < d, m, 0)", "m*step(d-mod(t, 1))", "where(t-floor(t) < d, m, 0)"]))
    spin = draw.spin / count
    problem = Problem(
        (c, c * 1.1, c * 1.3), (0.0, 0.0, spin), (1.0, 0.0, 0.0, 0.0), 0.0, 0.0, float(count), ("0", "0", text),
        {"d": on, "m": m}, [], edges, np.inf, spin + draw.turn / count,
    )  # fmt: skip
    return finish(draw, family, index, seed, f"thruster{count}", problem)


# --- torques without a formula ----------------------------------------------------------------------------------------


def function(draw: Draw, family: str, index: int, seed: int) -> Case:
    """The torque of a smooth shape of time as a Python function."""
    shape = draw.time_shape()
    return finish(draw, family, index, seed, shape.name, _axis(draw, shape), method="function")


def table(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A pulse as a table whose samples are dense at the pulse."""
    names = ["gauss", "sech2", "tanh", "doublet", "lorentz"]
    draw.width = max(draw.width, 1e-4 * draw.span)
    shape = IN_TIME[str(draw.random.choice(names))](draw.random, draw.low, draw.high, draw.width)
    problem = _axis(draw, shape)
    c, w = shape.parameters["c"], shape.parameters["w"]
    grid = c + w * np.sinh(np.linspace(-14, 14, 6001)) / 3
    grid = np.unique(np.concatenate([[draw.low, draw.high], grid[(grid > draw.low) & (grid < draw.high)]]))
    case = finish(draw, family, index, seed, shape.name, problem, tolerance=1e-6, method="table")
    case.table = (grid, None)
    return case


# --- scenes -----------------------------------------------------------------------------------------------------------


def scene_of(problem: Problem, tolerance: float, torque: bool = True) -> dict[str, Any]:
    """Return the scene as a dict."""
    content: dict[str, Any] = {
        "schema": 1,
        "body": {"principal": list(problem.principal)},
        "initial": {"omega": list(problem.omega), "attitude": {"quaternion": list(problem.quaternion)}},
        "span": {"t": [problem.t0, problem.high]},
        "accuracy": {"tolerance": tolerance},
    }
    if torque:
        used = set().union(*map(names_of, problem.texts))
        known = {name: float(value) for name, value in problem.parameters.items() if name in used}
        content["torque"] = [{"kind": "expression", "torque": list(problem.texts), "parameters": known}]
    return content


def toml_of(problem: Problem, tolerance: float) -> str:
    """Return the scene as the text of a file that shows the case."""
    scene = scene_of(problem, tolerance)
    torque = scene["torque"][0]
    known = ", ".join(f"{name} = {value!r}" for name, value in torque["parameters"].items())
    return "\n".join([
        "schema = 1", f"body = {{ principal = {scene['body']['principal']} }}",
        f"initial = {{ omega = {scene['initial']['omega']}, attitude = {{ quaternion = {list(problem.quaternion)} }} }}",
        f"span = {{ t = {scene['span']['t']} }}", f"accuracy = {{ tolerance = {tolerance!r} }}",
        "[[torque]]", 'kind = "expression"', "torque = [" + ", ".join(f'"{x}"' for x in problem.texts) + "]",
        f"parameters = {{ {known} }}",
    ])  # fmt: skip


def uses_switches(problem: Problem) -> bool:
    """Return whether a torque contains a function that jumps or bends."""
    return bool(set().union(*map(names_of, problem.texts)) & set(SWITCHES))


Family = Callable[[Draw, str, int, int], Case]
OF_TIME: dict[str, tuple[Family, float]] = {
    "time_axis": (time_axis, 0.2), "time_product": (time_product, 0.08), "time_sphere": (time_sphere, 0.08),
    "time_tumbling": (time_tumbling, 0.12), "switch_time": (switch_time, 0.07),
    "switch_tumbling": (switch_tumbling, 0.04), "thruster": (thruster, 0.01), "function": (function, 0.02),
    "table": (table, 0.015),
}  # fmt: skip
"""Families whose torque depends on time alone, and how often each is drawn."""

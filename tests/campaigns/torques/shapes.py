"""Shapes: torques of time or of a state as text, with the features that a reference is told."""

import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tests.campaigns.torques.collocation import Feature, matrices, time_mesh
from tests.campaigns.torques.formulas import compiled, names_of

__all__ = ["IN_TIME", "SWITCHES_IN_TIME", "Shape", "centers", "impulse", "in_value", "product"]

Random = np.random.Generator


class Shape(NamedTuple):
    """A factor of a torque: text, parameters, features, times of jumps, and the longest step that resolves it."""

    name: str
    text: str
    parameters: dict[str, float]
    features: list[Feature]
    breaks: list[float]
    longest: float = np.inf


def _log(random: Random, low: float, high: float) -> float:
    return float(10 ** random.uniform(np.log10(low), np.log10(high)))


def centers(random: Random, low: float, high: float, width: float) -> float:
    """Return the place of a feature: mostly inside the span, or at an end, just outside, or at a round number."""
    kind, span = random.random(), high - low
    if kind < 0.1:
        return float(low + random.uniform(-3, 3) * width)
    if kind < 0.2:
        return float(high - random.uniform(-3, 3) * width)
    if kind < 0.24:
        return float(high + random.uniform(2, 6) * width)
    if kind < 0.32:
        return float(low + span * random.integers(1, 8) / 8)
    return float(random.uniform(low + 0.02 * span, high - 0.02 * span))


# --- smooth, in time: one center c, one width w -----------------------------------------------------------------------

_SINGLE = {
    "tanh": "(1+tanh((t-c)/w))/2",
    "gauss": "exp(-((t-c)/w)**2)",
    "sech": "1/cosh((t-c)/w)",
    "sech2": "1/cosh((t-c)/w)**2",
    "lorentz": "1/(1+((t-c)/w)**2)",
    "doublet": "(t-c)/w*exp(-((t-c)/w)**2)",
    "two_tanh": "(2+tanh((t-c)/w)+tanh(3*(t-c)/w))/4",
    "tanh_cubed": "tanh((t-c)/w+((t-c)/w)**3/5)",
    "gumbel": "exp(-exp(-(t-c)/w))",
    "atan": "1/2+atan((t-c)/w)/pi",
    "algebraic": "(t-c)/sqrt(w**2+(t-c)**2)",
    "gauss4": "exp(-((t-c)/w)**4)",
    "odd_step": "1/(1+exp(-(t-c)/w))",
    "ricker": "(1-2*((t-c)/w)**2)*exp(-((t-c)/w)**2)",
}


def _single(name: str) -> Callable[[Random, float, float, float], Shape]:
    def make(random: Random, low: float, high: float, width: float) -> Shape:
        c = centers(random, low, high, width)
        near = width / (3 if name in ("two_tanh", "gauss4", "tanh_cubed") else 1)
        return Shape(name, _SINGLE[name], {"c": c, "w": width}, [Feature(c, near)], [])

    return make


def _window(random: Random, low: float, high: float, width: float) -> Shape:
    c, d = sorted((centers(random, low, high, width), centers(random, low, high, width)))
    features = [Feature(c, width), Feature(d, width)]
    return Shape("window", "(tanh((t-c)/w)-tanh((t-d)/w))/2", {"c": c, "d": d, "w": width}, features, [])


def _pulses(random: Random, low: float, high: float, width: float) -> Shape:
    places = {name: centers(random, low, high, width) for name in ("c", "d", "e")}
    text = "exp(-((t-c)/w)**2)-2*exp(-((t-d)/w)**2)+1/cosh((t-e)/w)**2"
    return Shape("pulses", text, {**places, "w": width}, [Feature(x, width) for x in places.values()], [])


def _period(random: Random, low: float, high: float, width: float, widest: float) -> float:
    return max((high - low) / _log(random, 1, 60), width * widest)


def _train(random: Random, low: float, high: float, width: float) -> Shape:
    period = max(_period(random, low, high, width, 3), (high - low) / 200)
    c = float(random.uniform(low, low + period))
    b = 2 * np.pi / period
    parameters = {"k": 2 / (b * width) ** 2, "b": b, "c": c}
    return Shape("train", "exp(k*(cos(b*(t-c))-1))", parameters, [Feature(c, width, period=period)], [])


def _powers(random: Random, low: float, high: float, width: float) -> Shape:
    power = int(random.choice([1, 4, 16, 64]))
    half = _period(random, low, high, width, 1)
    b, c = np.pi / half, float(random.uniform(low, low + half))
    text = "cos(b*(t-c))**64" if power == 1 else f"(cos(b*(t-c))**64)**{power}"
    return Shape(f"powers{power}", text, {"b": b, "c": c}, [Feature(c, np.sqrt(2 / (64 * power)) / b, period=half)], [])


def _square_wave(random: Random, low: float, high: float, width: float) -> Shape:
    half = _period(random, low, high, width, 3)
    b, c = np.pi / half, float(random.uniform(low, low + half))
    text, parameters = "(1+tanh(sin(b*(t-c))/v))/2", {"b": b, "c": c, "v": b * width}
    return Shape("square_wave", text, parameters, [Feature(c, width, period=half)], [], half / 8)


def _chirp(random: Random, low: float, high: float, width: float) -> Shape:
    c = float(low if random.random() < 0.5 else centers(random, low, high, width))
    far = max(abs(high - c), abs(low - c))
    a = _log(random, 3, 3000) / far**2
    return Shape("chirp", "sin(a*(t-c)**2)", {"a": a, "c": c}, [Feature(c, 1 / np.sqrt(a))], [], 1.5 / (a * far))


def _gauss_chirp(random: Random, low: float, high: float, width: float) -> Shape:
    c = centers(random, low, high, width)
    a = _log(random, 0.3, 30) / width**2
    text = "exp(-((t-c)/w)**2)*sin(a*(t-c)**2)"
    near = min(width, 1 / (6 * a * width))
    features = [Feature(c + k * width, near) for k in np.linspace(-6, 6, 25)]
    return Shape("gauss_chirp", text, {"a": a, "c": c, "w": width}, features, [])


def _hidden(random: Random, low: float, high: float, width: float) -> Shape:
    """A pulse on top of a smooth torque that sets a comfortable step."""
    c = centers(random, low, high, width)
    b = float(random.uniform(0.3, 3) * 2 * np.pi / (high - low))
    height = _log(random, 1, 1 + (high - low) / width)
    text = "cos(b*t)/2+h*exp(-((t-c)/w)**2)"
    return Shape("hidden", text, {"b": b, "h": height, "c": c, "w": width}, [Feature(c, width)], [], 1 / b)


IN_TIME: dict[str, Callable[[Random, float, float, float], Shape]] = {
    **{name: _single(name) for name in _SINGLE},
    "window": _window, "pulses": _pulses, "train": _train, "powers": _powers, "square_wave": _square_wave,
    "chirp": _chirp, "gauss_chirp": _gauss_chirp, "hidden": _hidden,
}  # fmt: skip

# --- jumping and bending, in time -------------------------------------------------------------------------------------

_SWITCHES = {  # text and the times where it jumps or bends
    "step": ("step(t-c)", "c"),
    "sign": ("sign(t-c)", "c"),
    "ratio": ("(1+(t-c)/abs(t-c))/2", "c"),
    "abs": ("abs(t-c)/w-abs(t-d)/w", "cd"),
    "where": ("where(t<c, 1, -1/2)", "c"),
    "where_le": ("where(t<=c, cos(t), 1/3)", "c"),
    "where_nested": ("where(t<c, 0, where(t>=d, 0, 1))", "cd"),
    "window": ("step(t-c)-step(t-d)", "cd"),
    "window_product": ("step(t-c)*step(d-t)", "cd"),
    "min": ("min(max((t-c)/w, 0), 1)", "cv"),
    "clip": ("clip((t-c)/w, -1, 1)", "uv"),
    "triangle": ("max(1-abs(t-c)/w, 0)", "ucv"),
    "smooth_inside": ("where(t>c, exp(-(t-c)/w), 0)", "c"),
}


def _switch(name: str) -> Callable[[Random, float, float, float], Shape]:
    text, marks = _SWITCHES[name]

    def make(random: Random, low: float, high: float, width: float) -> Shape:
        c = centers(random, low, high, width)
        d = c + width
        known = {"c": c, "d": d, "u": c - width, "v": c + width}
        parameters = {key: {**known, "w": width}[key] for key in "cdw" if key in names_of(text)}
        features = [Feature(known[mark], width) for mark in marks]
        return Shape(f"switch:{name}", text, parameters, features, [known[mark] for mark in marks])

    return make


def _periodic(random: Random, low: float, high: float, width: float) -> Shape:
    span = high - low
    period = span / float(random.integers(2, 120))
    on = period * float(random.choice([0.01, 0.1, 0.5]))
    first = int(np.floor(low / period)) - 1
    kind = random.random()
    edges = [k * period for k in range(first, int(high / period) + 2)]
    if kind < 0.4:
        text, parameters = "where(mod(t, p) < d, 1, 0)", {"p": period, "d": on}
        breaks = [x for e in edges for x in (e, e + on)]
    elif kind < 0.7:
        text, parameters, breaks = "mod(t, p)/p", {"p": period}, edges
    else:
        text, parameters, breaks = "(floor(t/p)-2*floor(t/(2*p)))", {"p": period}, edges
    return Shape("switch:periodic", text, parameters, [], breaks)


def _sign_of_sine(random: Random, low: float, high: float, width: float) -> Shape:
    half = (high - low) / float(random.integers(2, 40))
    b, c = np.pi / half, float(random.uniform(low, low + half))
    k = np.arange(np.floor((low - c) / half), np.ceil((high - c) / half) + 1)
    return Shape("switch:sign_of_sine", "sign(sin(b*(t-c)))", {"b": b, "c": c}, [], [float(c + i * half) for i in k])


SWITCHES_IN_TIME: dict[str, Callable[[Random, float, float, float], Shape]] = {
    **{name: _switch(name) for name in _SWITCHES}, "periodic": _periodic, "sign_of_sine": _sign_of_sine,
}  # fmt: skip

# --- in the value of a state ------------------------------------------------------------------------------------------

_IN_VALUE = {
    "bump": "exp(-(({x}-c)/w)**2)",
    "soft_step": "(1+tanh(({x}-c)/w))/2",
    "sech2": "1/cosh(({x}-c)/w)**2",
    "lorentz": "1/(1+(({x}-c)/w)**2)",
    "doublet": "({x}-c)/w*exp(-(({x}-c)/w)**2)",
    "two_bumps": "exp(-(({x}-c)/w)**2)-exp(-(({x}-d)/w)**2)/2",
}


def in_value(name: str, variable: str, center: float, width: float, other: float = 0.0) -> Shape:
    """Return a shape of a state, without its features: only the caller knows how fast the state changes."""
    text = _IN_VALUE[name].replace("{x}", variable)
    parameters = {"c": center, "w": width} | ({"d": other} if name == "two_bumps" else {})
    return Shape(name, text, parameters, [], [])


def product(first: Shape, second: Shape) -> Shape:
    """Return the product of two shapes; the parameters of the second are renamed."""
    renamed = {name: f"{name}2" for name in second.parameters}
    text = re.sub(r"(?<![\w.])[A-Za-z_]\w*", lambda match: renamed.get(match[0], match[0]), second.text)
    return Shape(
        f"{first.name}*{second.name}", f"({first.text})*({text})",
        {**first.parameters, **{renamed[k]: v for k, v in second.parameters.items()}},
        [*first.features, *second.features], [*first.breaks, *second.breaks], min(first.longest, second.longest),
    )  # fmt: skip


def impulse(shape: Shape, low: float, high: float) -> tuple[float, float]:
    """Return the integral of the absolute value of a shape of time over a span, and its largest value, both
    approximate.
    """
    mesh = time_mesh(low, high, shape.features, shape.breaks, min(shape.longest, (high - low) / 20)).astype(float)
    nodes, weights = matrices().nodes.astype(float), matrices().weights.astype(float)
    h = np.diff(mesh)
    t = mesh[:-1, None] + h[:, None] * nodes
    values = np.abs(np.broadcast_to(compiled(shape.text, shape.parameters, np.float64)({"t": t}), t.shape))
    return float((h[:, None] * weights * values).sum()), float(np.max(values, initial=0.0))

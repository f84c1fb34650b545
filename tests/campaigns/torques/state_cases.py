"""Random cases whose torque depends on the angle, the rate or the attitude; poles, overflow and dry friction."""

from typing import Any

import numpy as np

from tests.campaigns.torques import arcs
from tests.campaigns.torques.cases import Case, Draw, Family, finish, log_uniform
from tests.campaigns.torques.collocation import Feature
from tests.campaigns.torques.references import Problem
from tests.campaigns.torques.shapes import IN_TIME, Shape, in_value, product

__all__ = ["OF_STATES"]

ANGLE = "2*atan2(q3, q0)"
FULL = 4 * np.pi  # after which atan2 of the half angle comes round
START = (1.0, 0.0, 0.0, 0.0)


def _angle(y: Any) -> Any:
    return 2 * np.arctan2(y[..., 6], y[..., 3])


def _rate(y: Any) -> Any:
    return y[..., 2]


def _about_3(
    draw: Draw, c: float, omega: float, text: str, shape: Shape, speed: float, features: list[Feature], **more: Any
) -> Problem:
    return Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, omega), START, draw.t0, draw.low, draw.high, ("0", "0", text),
        shape.parameters, features, speed=speed, **more,
    )  # fmt: skip


def angle(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Bumps, soft steps and stops of the angle about axis 3, met by a body that turns less than a full turn."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    width = log_uniform(random, 1e-5, 1)
    turn = random.uniform(1, 5.5)
    omega = turn / draw.span
    center = random.uniform(0.1, min(turn, 5.0)) * 0.8
    name = str(random.choice(["bump", "soft_step", "sech2", "lorentz", "doublet", "two_bumps"]))
    second = center + random.uniform(-1, 1)
    shape = in_value(name, ANGLE, center, width, second)
    work = random.choice([0.3, 0.8, -0.3, -0.7, -3.0, -10.0]) * c * omega**2 / 2  # the last two reflect
    reach = turn - center if name == "soft_step" else width * 1.8
    m = float(work / max(reach, width))
    if name == "soft_step" and work > 0:
        m = min(m, c * omega**2)
    speed = omega * 3
    bend = 2 * abs(m) / c
    features = [
        Feature(x, width, _angle, _rate, bend, FULL, name != "soft_step")
        for x in ((center, second) if name == "two_bumps" else (center,))
    ]
    shape = shape._replace(parameters={**shape.parameters, "m": m})
    problem = _about_3(draw, c, float(omega), f"m*({shape.text})", shape, speed, features)
    return finish(draw, family, index, seed, name, problem)


def angle_turns(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A bump of the angle, passed on every second turn: the formula's angle jumps by two turns at the cut of atan2."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    width = log_uniform(random, 1e-3, 0.3)
    omega = random.uniform(6.5, 40) / draw.span
    center = random.uniform(-4.0, 4.0)
    m = float(random.choice([0.3, -0.2]) * c * omega**2 / 2 / (width * 1.8) / 3)
    shape = in_value("bump", ANGLE, center, width)
    shape = shape._replace(parameters={**shape.parameters, "m": m})
    feature = Feature(center, width, _angle, _rate, 2 * abs(m) / c, FULL, True)
    problem = _about_3(draw, c, draw.sign() * omega, f"m*({shape.text})", shape, 2 * omega, [feature])
    return finish(draw, family, index, seed, "bump", problem)


def angle_time(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A bump of the angle times a pulse or switch of time that acts as the body passes."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    omega, width = random.uniform(1, 5) / draw.span, log_uniform(random, 1e-4, 1)
    at = random.uniform(0.15, 0.85)
    center = omega * draw.span * at
    first = in_value(str(random.choice(["bump", "sech2", "soft_step"])), ANGLE, center, width)
    second = IN_TIME[str(random.choice(["gauss", "tanh", "sech", "lorentz"]))](random, draw.low, draw.high, draw.width)
    place = draw.low + draw.span * at + draw.width * random.uniform(-1, 1)
    second = second._replace(parameters={"c": place, "w": draw.width}, features=[Feature(place, draw.width)])
    shape = product(first, second)
    lasting = draw.span if first.name == "soft_step" else min(width / omega, draw.width)
    m = float((-1 if first.name == "soft_step" else draw.sign()) * 0.3 * c * omega / lasting)  # keep below a full turn
    shape = shape._replace(parameters={**shape.parameters, "m": m})
    features = [*shape.features, Feature(center, width, _angle, _rate, abs(m) / c, FULL)]
    problem = _about_3(draw, c, omega, f"m*({shape.text})", shape, 2 * omega, features)
    return finish(draw, family, index, seed, shape.name, problem)


def rate(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A bump or soft step of the rate, met by a body that a steady torque accelerates."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    gain = random.uniform(1, 30) / draw.span  # of rate, over the span
    start = draw.spin / draw.span
    steady = c * gain / draw.span
    center = start + gain * random.uniform(0.1, 0.8)
    width = gain * log_uniform(random, 1e-6, 1)
    name = str(random.choice(["bump", "soft_step", "sech2", "lorentz"]))
    height = float(random.choice([-0.9, -0.5, 2.0, 30.0]))
    if name == "soft_step":
        height = min(height, 2.0)
    shape = in_value(name, "omega_3", center, width)
    shape = shape._replace(parameters={**shape.parameters, "g": steady, "h": height})
    bound = steady * (1 + max(height, 0)) / c
    feature = Feature(center, width, _rate, lambda y, bound=bound: bound * np.ones(y.shape[:-1]))
    problem = _about_3(draw, c, start, f"g*(1+h*{shape.text})", shape, start + 3 * gain, [feature])
    return finish(draw, family, index, seed, name, problem)


def soft_friction(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Friction -k*tanh(omega_3/w): smooth over a width w of the rate."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    omega = draw.sign() * max(draw.spin, 0.5) / draw.span
    width, k = abs(omega) * log_uniform(random, 1e-4, 1), c * abs(omega) / draw.span * random.uniform(0.5, 3)
    parameters = {"k": float(k), "w": float(width)}
    problem = Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, omega), START, draw.t0, draw.low, draw.high, ("0", "0", "-k*tanh(omega_3/w)"),
        parameters, arcs=lambda p, w: arcs.soft_friction(c, k, width, p.t0, w),
    )  # fmt: skip
    return finish(draw, family, index, seed, "soft_friction", problem)


def attitude(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A bump of one component of the quaternion, on a body that tumbles."""
    random, moments = draw.random, draw.moments("body")
    draw.low = draw.t0
    speed = random.uniform(2, 12) / draw.span
    omega = random.normal(size=3)
    omega *= speed / np.linalg.norm(omega)
    which, width = int(random.integers(4)), log_uniform(random, 1e-4, 0.5)
    center = random.uniform(-0.8, 0.8)
    name = str(random.choice(["bump", "sech2", "soft_step"]))
    shape = in_value(name, f"q{which}", center, width)
    m = float(draw.sign() * 0.1 * min(moments) * speed**2)
    if name != "soft_step":  # which lasts, and need not be strong
        m /= max(width, 1e-3) ** random.uniform(0.3, 1)
    shape = shape._replace(parameters={**shape.parameters, "m": m})
    texts = ["0", "0", "0"]
    texts[int(random.integers(3))] = f"m*({shape.text})"
    bend = abs(m) / min(moments) + 20 * speed**2

    def passing(y: Any) -> Any:
        return np.sqrt((y[..., :3] ** 2).sum(axis=-1)) / 2

    feature = Feature(center, width, lambda y: y[..., 3 + which], passing, bend)
    start = random.normal(size=4)
    start /= np.linalg.norm(start)
    problem = Problem(
        moments, (float(omega[0]), float(omega[1]), float(omega[2])), tuple(map(float, start)),  # type: ignore[arg-type]
        draw.t0, draw.low, draw.high, (texts[0], texts[1], texts[2]), shape.parameters, [feature], speed=2 * speed,
    )  # fmt: skip
    return finish(draw, family, index, seed, f"{name} of q{which}", problem)


# --- switches in states, in closed form -------------------------------------------------------------------------------


def dry_friction(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Friction -k*sign(omega_3), alone, with a steady torque or with a*sin(b*t): slip, stick and breakaway."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    omega = draw.sign() * draw.spin / draw.span
    k = c * max(draw.spin, 0.5) / draw.span**2 * random.uniform(0.5, 5)
    kind = str(random.choice(["alone", "steady", "sine", "sine"]))
    parameters = {"k": float(k)}
    text, drive = "-k*sign(omega_3)", arcs.constant_drive(0.0)
    if kind == "steady":
        parameters["g"] = float(k * random.uniform(-1.5, 1.5))
        text, drive = "g-k*sign(omega_3)", arcs.constant_drive(parameters["g"])
    if kind == "sine":
        parameters |= {"a": float(k * random.uniform(0.5, 4)), "b": float(random.uniform(1, 40) / draw.span)}
        text, drive = "a*sin(b*t)-k*sign(omega_3)", arcs.sine_drive(parameters["a"], parameters["b"])
    problem = Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, omega), START, draw.t0, draw.low, draw.high, ("0", "0", text), parameters,
        arcs=lambda p, w: arcs.dry_friction(c, k, drive, p.t0, w, p.high), speed=abs(omega),
    )  # fmt: skip
    return finish(draw, family, index, seed, f"friction {kind}", problem)


def bang_bang(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Bang-bang control -k*sign(angle - target + kappa*omega_3): parabolas, then sliding along the line."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    target, a = random.uniform(0.3, 1.5), random.uniform(1, 60) / draw.span**2
    kappa = random.uniform(0.02, 0.5) / np.sqrt(a)
    omega = random.uniform(-1, 1) * np.sqrt(a)
    k = float(c * a)
    parameters = {"k": k, "p": float(kappa), "g": float(target)}
    problem = Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, float(omega)), START, draw.t0, draw.low, draw.high,
        ("0", "0", f"-k*sign({ANGLE}-g+p*omega_3)"), parameters,
        arcs=lambda q, w: arcs.bang_bang(c, k, float(kappa), float(target), q.t0, w, q.high), speed=abs(float(omega)),
    )  # fmt: skip
    return finish(draw, family, index, seed, "bang_bang", problem)


def switch_state(draw: Draw, family: str, index: int, seed: int) -> Case:
    """A torque that jumps at an angle or at a rate: driven, braked, turned back, or held at the rate."""
    random, c = draw.random, log_uniform(draw.random, 1e-2, 1e2)
    draw.low = draw.t0
    omega = random.uniform(1, 4) / draw.span
    kind = str(random.choice(["drive", "brake", "stop", "rate_up", "rate_hold"]))
    of_angle = kind in ("drive", "brake", "stop")
    if of_angle:
        edge = random.uniform(0.2, 0.8)
        # a drive stays below a full rotation, where the angle of the formula jumps by 4 pi: 4 + 16/8 rad
        after = {"drive": 0.25, "brake": -0.1, "stop": -random.uniform(2, 300)}[kind] * c * omega**2
        before, variable = 0.0, ANGLE
    else:
        edge = omega * 1.5
        before = c * omega / draw.span * random.uniform(0.8, 3)
        after, variable = before * (0.2 if kind == "rate_up" else -0.5), "omega_3"
    style = int(random.integers(3))
    text = (f"where({variable} < c, m, n)", f"m+(n-m)*step({variable}-c)", f"where({variable} >= c, n, m)")[style]
    values = (float(before) / c, float(after) / c)
    parameters = {"c": float(edge), "m": float(before), "n": float(after)}
    angles, rates = ((float(edge),), ()) if of_angle else ((), (float(edge),))

    def motion(p: Problem, w: float) -> arcs.Motion:
        return arcs.stepped(lambda i, j: values[i + j], angles, rates, p.t0, w, p.high)

    problem = Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, float(omega)), START, draw.t0, draw.low, draw.high, ("0", "0", text),
        parameters, arcs=motion, speed=2 * omega,
    )  # fmt: skip
    return finish(draw, family, index, seed, kind, problem)


# --- poles and overflow -----------------------------------------------------------------------------------------------


def poles(draw: Draw, family: str, index: int, seed: int) -> Case:
    """Torques with a pole inside the span or with overflow: a message or the truth, and never an endless run."""
    random = draw.random
    c = log_uniform(random, 1e-1, 1e1)
    kind = str(
        random.choice(["cube", "square", "simple", "tan", "log", "sqrt", "exp_cube", "exp_exp", "cosh", "mild_exp"])
    )
    at = random.uniform(0.1, 0.9)
    table: dict[str, tuple[str, float, float]] = {  # text, end of the span, pole
        "cube": ("m/(t-c)**3", 1.0, at), "square": ("m/(t-c)**2", 1.0, at), "simple": ("m/(t-c)", 1.0, at),
        "tan": ("m*tan(t)", 4.0, np.pi / 2), "log": ("m*log(c-t)", 1.0, at), "sqrt": ("m*sqrt(c-t)", 1.0, at),
        "exp_cube": ("m*exp(t**3)", 20.0, 8.9), "exp_exp": ("m*exp(exp(t))", 20.0, 6.56),
        "cosh": ("m*cosh(100*t)", 20.0, 7.1), "mild_exp": ("m*exp(t**3)", random.uniform(0.5, 2.0), np.inf),
    }  # fmt: skip
    text, high, pole = table[kind]
    m = float(c * random.uniform(0.01, 1))
    omega = float(random.choice([0.0, 0.3, 5.0]))
    parameters = {"m": m} | ({"c": float(at)} if "c" in text.replace("cosh", "") else {})
    stop = min(high, pole)
    reach = stop * (1 - 1e-2) if kind in ("cube", "square", "simple", "tan", "log", "sqrt") and pole < high else stop
    if kind.startswith("exp_") or kind == "cosh":
        reach = {"exp_cube": 2.0, "exp_exp": 2.0, "cosh": 0.1}[kind]
    problem = Problem(
        (c * 0.8, c * 0.9, c), (0.0, 0.0, omega), START, 0.0, 0.0, float(high), ("0", "0", text), parameters,
        [Feature(float(pole), 1e-3 * stop)] if np.isfinite(pole) else [], poles=[float(pole)] if pole < high else [],
        speed=max(omega, 1.0),
    )  # fmt: skip
    problem.reach = float(reach)
    return finish(draw, family, index, seed, kind, problem)


OF_STATES: dict[str, tuple[Family, float]] = {
    "angle": (angle, 0.12), "angle_turns": (angle_turns, 0.03), "angle_time": (angle_time, 0.05), "rate": (rate, 0.05),
    "soft_friction": (soft_friction, 0.02), "attitude": (attitude, 0.05), "dry_friction": (dry_friction, 0.03),
    "bang_bang": (bang_bang, 0.02), "switch_state": (switch_state, 0.03), "poles": (poles, 0.03),
}  # fmt: skip
"""Families whose torque depends on the states, or has poles, and how often each is drawn."""

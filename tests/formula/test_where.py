"""Only the branch of a ``where`` whose condition holds is evaluated and enclosed; the other branch has no effect."""

import math

import numpy as np
import pytest
from scipy.special import sici

import symrot
from symrot.errors import PropagationError
from symrot.formula.switches import blended, chosen, has_choices, hold, smooth
from symrot.formula.tree import evaluate, parse
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853", *(f"scipy:{name}" for name in ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA"))]


def scene(torque, omega=0, stop=2.0):
    content = {
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, omega]}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": ["0", "0", torque]}],
    }  # fmt: skip
    return symrot.Scene.from_dict(content)


def root(u):
    """Return the integral of sqrt from 0."""
    return 2 / 3 * np.maximum(u, 0) ** 1.5


MOTIONS = {  # torque -> omega_3 from rest, for a moment of inertia of 1; the first by every method
    "where(t < 1, 1/(3/2 - t), 0)": lambda t: np.log(1.5 / (1.5 - np.minimum(t, 1))),
    "where(t < 1, sqrt(1 - t), 0)": lambda t: root(1) - root(1 - t),
    "where(t > 1, sqrt(t - 1), 0)": lambda t: root(t - 1),
    "where(t > 1, (t-1)**5, 0)": lambda t: np.maximum(t - 1, 0) ** 6 / 6,
    "where(t > 0, sin(t)/t, 1)": lambda t: sici(t)[0],
    "where(abs(t - 1) > 0, sin(t - 1)/(t - 1), 1)": lambda t: sici(t - 1)[0] + sici(1)[0],
    "where(t < 1, 1, where(sqrt(t-1) > 1/2, 1, 2))": lambda t: t + np.clip(t - 1, 0, 0.25),
    "where(t > 1, sign(sqrt(t-1) - 1/2), 0)": lambda t: np.abs(np.maximum(t, 1) - 1.25) - 0.25,
    "where(t > 1, 1/sqrt(t-1), 0)": lambda t: 2 * np.sqrt(np.maximum(t - 1, 0)),
    "where(mod(t, 1) < 1/2, sqrt(1/2 - mod(t, 1)), 0)": (
        lambda t: root(0.5) * (np.floor(t) + 1) - root(0.5 - t + np.floor(t))
    ),
    "where(abs(omega_3) > 1/1000, 1/omega_3, 1000)": (
        lambda t: np.where(t < 1e-6, 1000 * t, np.sqrt(np.maximum(2 * t - 1e-6, 0)))
    ),
}


@pytest.mark.thinned(16)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("torque", MOTIONS)
def test_the_other_part_does_not_matter(method, torque):
    tolerance = 1e-6 if method == "scipy:RK23" else 1e-9  # of third order: it gives up beside singular parts
    times = np.linspace(0, 2, 21)
    trajectory = symrot.propagator(scene(torque), method, tolerance)(times)
    omega = MOTIONS[torque](times)
    assert abs(trajectory.omega[:, 2] - omega).max() < 20 * tolerance * omega.max()
    between = times[:-1] + 0.037
    assert abs(trajectory.sol(between)[2] - MOTIONS[torque](between)).max() < 20 * tolerance * omega.max()


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize("torque", ["where(t < 1, 1/(1 - t), 0)", "where(t > 1, 1/(t - 1), 0)"])
def test_no_hop_passes_over_a_pole(method, torque):
    with pytest.raises(PropagationError, match=r"beyond t = (0\.99999|1\.0)"):
        symrot.propagator(scene(torque), method, 1e-9)([2.0])


@needs_compiler
def test_an_event_inside_a_hop_is_found():
    """The event is at the switch itself, to whose last bits the steps before do not extend."""
    trajectory = symrot.propagate(scene("where(t < 1, sqrt(1 - t), 0)"), method="taylor", events=["t - 1"])
    assert trajectory.t_events[0].tolist() == pytest.approx([1.0], abs=1e-15)


@needs_compiler
def test_a_guard_begins_to_matter_with_its_own_mode():
    """Only the condition switches at 1 s: the sign inside has its value from the start, and no switch is reported."""
    trajectory = symrot.propagator(scene("where(t > 1, sign(sqrt(t-1) - 1/2), 0)"), "taylor")([2.0])
    listed = [(round(each.t, 12), each.function) for each in trajectory.stats.switchings]
    assert listed == [(1.0, "1 < t"), (1.25, "sign(sqrt(t - 1) - 1/2)")]


PARTS = [
    "where(t > 0, sqrt(t), 7)", "where(t < 0 or omega_3 < 0, 2, 1/(t*omega_3))", "1 + abs(where(t > 0, log(t), -t))",
    "where(t > 0, where(omega_3 > 0, log(t*omega_3), sqrt(t)), exp(t))", "where(not t > 0, 1, sign(log(t))*exp(t))",
]  # fmt: skip
REFERENCE = {"sqrt": math.sqrt, "log": math.log, "exp": math.exp, "abs": abs, "sign": lambda u: math.copysign(1, u)} | {
    "less": lambda a, b: a < b, "and": lambda a, b: a and b, "or": lambda a, b: a or b, "not": lambda a: not a,
}  # fmt: skip


def value(node, values):
    """Return the value of a formula by Python's functions; of ``where``, only the branch whose condition holds."""
    if node[:2] == ("call", "where"):
        return value(node[2][1 if value(node[2][0], values) else 2], values)
    if node[0] == "call":
        return REFERENCE[node[1]](*(value(part, values) for part in node[2]))
    if node[0] in ("number", "symbol"):
        return evaluate(node, values, {}, float)
    parts = {f"part_{k}": value(part, values) for k, part in enumerate(node[1:])}
    return evaluate((node[0], *(("symbol", name) for name in parts)), parts, {}, float)


@pytest.mark.parametrize("formula", PARTS)
def test_the_chosen_formula_is_the_formula_where_it_has_a_value(formula):
    """At 200 random points; guards in the other branch are ignored, whatever their modes are."""
    form, random = smooth((formula,)), np.random.default_rng(3)
    assert any(map(has_choices, (*form.formulas, *(switch.guard for switch in form.switches))))
    for _ in range(200):
        values = {"t": random.uniform(-2, 2), "omega_3": random.uniform(-2, 2)}
        modes = {}
        for switch in form.switches:
            modes[switch.mode] = 1
            if hold(switch.where, modes):
                guard = evaluate(chosen(switch.guard, modes), values | modes, REFERENCE, float)
                modes[switch.mode] = 1 if guard > 0 else -1
        found = evaluate(chosen(form.formulas[0], modes), values | modes, REFERENCE, float)
        assert found == pytest.approx(value(parse(formula, switching=True), values), rel=1e-14)


def test_a_held_condition_shares_both_parts():
    form = smooth(("where(omega_3 < 0, exp(t), sin(omega_3))",))
    held = chosen(form.formulas[0], {}, {form.switches[0].mode})
    assert held == blended(form.formulas[0])
    for mode, omega in ((1, -0.5), (-1, 0.5), (0, 0.0)):
        values = {"t": 0.3, "omega_3": omega, form.switches[0].mode: mode}
        share = (1 + mode) / 2
        expected = share * math.exp(0.3) + (1 - share) * math.sin(omega)
        assert evaluate(held, values, {"exp": math.exp, "sin": math.sin}, float) == pytest.approx(expected, rel=1e-15)

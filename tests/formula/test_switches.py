"""Torques with jumps or kinks: the smooth formula of each state is exact, switches are located exactly, and the motion
slides where it must.
"""

import math

import numpy as np
import pytest

import symrot
from symrot.errors import InputError, PropagationError
from symrot.formula.switches import condition_error, has_switches, smooth
from symrot.formula.tree import evaluate, parse
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853", "scipy:DOP853"]
RANDOM = np.random.default_rng(5)


def where(condition, yes, no):
    return yes if condition else no


REFERENCE = {  # Python's own functions
    "step": lambda u: float(u > 0), "sign": lambda u: math.copysign(1, u), "abs": abs, "min": min, "max": max,
    "clip": lambda u, low, high: max(low, min(u, high)), "floor": math.floor, "mod": lambda a, b: a - b * math.floor(a / b),
    "where": where, "less": lambda a, b: a < b, "and": lambda a, b: a and b, "or": lambda a, b: a or b,
    "not": lambda a: not a, "sin": math.sin, "exp": math.exp, "atan2": math.atan2, "cos": math.cos,
}  # fmt: skip
FORMULAS = [
    "sign(omega_3)", "-step(t - 1/3)*omega_1", "abs(omega_1 - t)*2", "min(t, omega_1, omega_2)", "max(sin(t), omega_1)",
    "clip(t, -1/2, omega_2)", "floor(3*t) - mod(t, 2/7)", "where(t < 1 and not (omega_1 > 0 or q0 >= q1), t, -omega_1)",
    "where(mod(t, 1) < 1/4, abs(omega_2), min(t, 0))", "atan2(q3, q0)", "sign(abs(t) - 1/2)", "exp(-abs(mod(t, 1) - 1/2))",
    "cos(atan2(omega_1, omega_2))", "where(abs(t) <= 1, 1, 2) + where(t >= omega_1, t, 0)",
]  # fmt: skip


@pytest.mark.parametrize("formula", FORMULAS)
def test_the_smooth_formula_with_the_modes_of_a_state_is_the_formula(formula):
    """At 300 random states, with the signs and integer parts of the guards as modes."""
    form = smooth((formula,))
    names = ["t", "omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3"]
    for _ in range(300):
        values = dict(zip(names, RANDOM.uniform(-2, 2, 8).tolist(), strict=True)) | {"pi": math.pi}
        expected = evaluate(parse(formula, switching=True), values, REFERENCE, float)
        for switch in form.switches:
            guard = evaluate(switch.guard, values, REFERENCE, float)
            assert switch.at_zero in (-1, 0, 1)
            values[switch.mode] = math.floor(guard) if switch.kind == "floor" else math.copysign(1, guard)
        assert evaluate(form.formulas[0], values, REFERENCE, float) == pytest.approx(expected, abs=1e-13)
        assert not has_switches(form.formulas[0]) or "atan2" in formula


@pytest.mark.parametrize(
    ("formula", "wrong"),
    [
        ("where(t, 1, 2)", "a comparison"), ("1 + (t < 2)", "comparisons only"), ("t < 1", "comparisons only"),
        ("where(t < 1 + (t < 2), 1, 2)", "comparisons only"), ("where(not t, 1, 2)", "a comparison"),
        ("abs(t < 1)", "comparisons only"), ("where(t < 1 and t, 1, 0)", "a comparison"),
    ],
)  # fmt: skip
def test_conditions_stand_in_where_alone(formula, wrong):
    assert wrong in condition_error(parse(formula, switching=True))
    with pytest.raises(InputError, match=wrong):
        scene([formula, "0", "0"])


@pytest.mark.parametrize("formula", ["step(1, 2)", "where(t < 1, 2)", "min(t)", "t <", "< t", "and", "sign()", "not"])
def test_what_is_no_formula_gets_one_sentence(formula):
    with pytest.raises(InputError, match="expected"):
        scene([formula, "0", "0"])


def test_conditions_are_errors_where_switches_are_not_followed():
    for text in ("sign(omega_3)", "t < 1", "where(t < 1, 2, 3)"):
        with pytest.raises(InputError):
            parse(text)


def scene(torque, omega=(0, 0, 0), stop=10.0, principal=(1, 2, 3), more=(), **parameters):
    torque = torque if isinstance(torque, list) else ["0", "0", torque]
    content = {
        "schema": 1, "body": {"principal": list(principal)}, "initial": {"omega": list(omega)},
        "torque": [{"kind": "expression", "torque": torque, "parameters": parameters}, *more],
        "span": {"t": [0, stop]}, "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(content)


@pytest.mark.thinned(2)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_friction_sticks_until_the_drive_breaks_it_loose(method, tolerance):
    """While it slips, C omega' = a sin t - k, from sin t = k/a on; before that the body is exactly at rest."""
    a, k = 2.0, 1.0
    loose, times = math.asin(k / a), np.linspace(0, 1.5, 16)
    motion = symrot.propagator(scene("a*sin(t) - k*sign(omega_3)", stop=1.5, a=a, k=k), method, tolerance)(times)
    slip = np.maximum(times, loose)
    expected = (a * (math.cos(loose) - np.cos(slip)) - k * (slip - loose)) / 3
    assert abs(motion.omega[:, 2] - expected).max() < 20 * tolerance
    assert (motion.omega[times < loose, 2] == 0).all()
    assert motion.stats.switching_times[-1] == pytest.approx(loose, abs=1e-12)


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", METHODS)
def test_friction_about_three_axes_stops_each_in_its_time(method):
    """In a spherical body, I omega_i' = -k_i sign(omega_i), each component is at rest from omega_i I/k_i on."""
    torque = ["-sign(omega_1)", "-2*sign(omega_2)", "-3*sign(omega_3)"]
    times = np.linspace(0, 3, 13)
    motion = symrot.propagator(scene(torque, (1, -1, 2), principal=(1, 1, 1)), method, 1e-10)(times)
    expected = np.maximum(1 - np.outer(times, [1, 2, 1.5]), 0) * [1, -1, 2]
    assert abs(motion.omega - expected).max() < 20e-10 * 2
    assert motion.stats.switches == 3


@needs_compiler
def test_friction_holds_a_tumbling_body_together():
    """Energy decreases by the work of friction alone, in a body without symmetry: dE/dt = -k sum |omega_i|."""
    torque = ["-k*sign(omega_1)", "-k*sign(omega_2)", "-k*sign(omega_3)"]
    made = symrot.propagator(scene(torque, (0.3, 1, 0.5), k=0.05), "taylor", 1e-11)
    times = np.linspace(0, 10, 20001)
    motion = made(times)
    size = np.abs(motion.omega).sum(axis=1)
    work = 0.05 * ((size[1:] + size[:-1]) / 2 * np.diff(times)).sum()
    energy = 0.5 * (motion.omega**2 * [1, 2, 3]).sum(axis=1)
    assert energy[0] - energy[-1] == pytest.approx(work, rel=1e-6)


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_a_relay_slides_along_its_line(method):
    """Under -sign(angle + omega), omega = -angle on the line, so both decay as exp(-t) while |omega| < 1/C."""
    motion = symrot.propagator(scene("-sign(2*atan2(q3, q0) + omega_3)", (0, 0, 1)), method, 1e-10)
    times = np.linspace(0, 10, 21)
    moved = motion(times)
    omega, slides = moved.omega[:, 2], moved.stats.switching_times[-1]
    later = times > slides
    at = motion([slides]).omega[0, 2]
    assert abs(omega[later] - at * np.exp(slides - times[later])).max() < 1e-8
    angle = 2 * np.arctan2(moved.quaternion[:, 3], moved.quaternion[:, 0])
    assert abs(angle + omega)[later].max() < 1e-8


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_bang_bang_control_swings_in_parabolas(method):
    """Under -sign(angle), a start at angle 0 with rate 1 gives the period 4 C omega/k, in arcs of constant torque."""
    times = np.linspace(0, 24, 49)
    omega = symrot.propagator(scene("-sign(2*atan2(q3, q0))", (0, 0, 1), 24.0), method, 1e-10)(times).omega[:, 2]
    phase = np.mod(times, 12.0)
    expected = np.where(phase < 6, 1 - phase / 3, -1 + (phase - 6) / 3)
    assert abs(omega - expected).max() < 20e-10


@needs_compiler
def test_endless_switching_ends_in_a_sentence_with_its_time():
    """The body returns with half its speed each time, with infinitely many switches before t = 12.93 s."""
    made = symrot.propagator(scene("-sign(2*atan2(q3, q0)) - 0.5*sign(omega_3)", (0, 0, 1), 40.0), "taylor", 1e-10)
    with pytest.raises(PropagationError, match=r"beyond t = 12\.928.*(slide|endlessly)") as caught:
        made(np.linspace(0, 40, 401))
    assert caught.value.trajectory.t[-1] == pytest.approx(12.9)


@needs_compiler
def test_backward_through_a_switch_and_not_through_rest():
    made = symrot.propagator(scene("step(t + 1)", (0, 0, 1)), "taylor", 1e-10)
    assert made([-2.0, 0.0]).omega[:, 2] == pytest.approx([2 / 3, 1.0], abs=1e-9)
    resting = symrot.propagator(scene("-sign(omega_3)"), "taylor", 1e-10)
    with pytest.raises(PropagationError, match="more than one past"):
        resting([-1.0])


@needs_compiler
def test_a_start_between_two_futures_is_refused():
    """sign(omega_3) drives a resting body in either direction."""
    with pytest.raises(PropagationError, match=r"t = 0\.0 .*more than one future"):
        symrot.propagator(scene("sign(omega_3)"), "taylor", 1e-10)([1.0])
    assert symrot.propagator(scene("sign(omega_3)", (0, 0, 1e-9)), "taylor")([3.0]).omega[0, 2] == pytest.approx(1.0)


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_dense_output_and_events_see_the_switches(method):
    made = symrot.propagator(scene("-sign(omega_3)", (0, 0, 1)), method, 1e-10)
    motion = made(np.linspace(0, 10, 11))
    times = RANDOM.uniform(0, 10, 300)
    assert abs(motion.sol(times)[2] - np.maximum(1 - times / 3, 0)).max() < 20e-10
    found = made(events=["omega_3 - 1/2", {"formula": "omega_3 - 1/10", "terminal": True}])
    assert found.t_events[0] == pytest.approx([1.5], abs=1e-9) and found.t[-1] == pytest.approx(2.7, abs=1e-9)


@needs_compiler
def test_an_ensemble_is_its_motions():
    made = scene("m*where(mod(t, 1) < w, 1, 0) - k*sign(omega_3)", stop=5.0, m=1, w=0.25, k=0.1)
    omega, k = np.array([[0, 0, 1], [0, 0, 0.5], [0, 0, 0.1]]), np.array([0.1, 0.2, 0.5])
    many = symrot.propagate_ensemble(made, omega=omega, parameters={"k": k}, t=np.linspace(0, 5, 11))
    for i in range(3):
        alone = scene(
            "m*where(mod(t, 1) < w, 1, 0) - k*sign(omega_3)", omega[i].tolist(), 5.0, m=1, w=0.25, k=float(k[i])
        )
        assert (many.omega[i] == symrot.propagator(alone)(np.linspace(0, 5, 11)).omega).all()


@needs_compiler
def test_parameters_of_any_name_stand_in_guards():
    """Kernels name their own constants p0, p1 and so on, which may be names in the scene."""
    for name in ("p0", "p1", "p2", "x0"):
        motion = symrot.propagator(scene(f"floor(t/{name}) - 2*floor(t/(2*{name}))", stop=2.0, **{name: 0.25}))
        assert motion([2.0]).omega[0, 2] == pytest.approx(1 / 3, abs=1e-10), name


@pytest.mark.thinned(8)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("torque", "expected"),
    [
        ("where(q1 > 0, 1, 0)", 0), ("step(q1)", 0), ("sign(q2)", 0), ("where(q1 >= 0, 1, 0)", 3), ("step(-q1)", 0),
        ("where(not q1 > 0, 1, 0)", 3), ("sign(max(t - 2, 0))", 1), ("-sign(min(t - 2, 0))", 2),
        ("step(max(1 - t, 0))", 1), ("abs(q1) + max(q1, 1)", 3),
    ],
)  # fmt: skip
def test_guards_that_stay_at_zero_have_the_value_at_zero(method, torque, expected):
    """In rotation about axis 3, q1 and q2 stay zero; a maximum is zero for a part of the span. The impulse after 3 s is
    tested.
    """
    motion = symrot.propagator(scene(torque, (0, 0, 0.1), 3.0), method, 1e-10)([3.0])
    assert motion.omega[0, 2] == pytest.approx(0.1 + expected / 3, abs=1e-9)


@pytest.mark.thinned(6)
@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853"])
@pytest.mark.parametrize(
    ("torque", "stop", "impulse"),
    [
        ("mod(floor(t), 2)", 4, 2), ("where(mod(floor(t), 2) > 0, 1, 0)", 4, 2),
        ("where(floor(t) >= 1 and floor(t) <= 1, 1, 0)", 4, 1), ("step(floor(t))", 4, 3), ("sign(step(t - 1))", 4, 3),
        ("floor(2*step(t - 1))", 3, 4), ("floor(min(t, 1))", 4, 3), ("where(clip(t - 1, 0, 1) > 0, 1, 0)", 3, 2),
        ("where(clip(t - 1, 0, 1) < 1 and clip(t - 1, 0, 1) > 0, 1, 0)", 4, 1), ("step(0*t)", 4, 0),
        ("min(t, t) + max(t**2, t*t)", 3, 13.5), ("sign(omega_1) + 1", 3, 3), ("where(omega_1 > 0, 1, 2)", 3, 6),
    ],
)  # fmt: skip
def test_guards_of_steps_jump_as_they_are_written(method, torque, stop, impulse):
    """If a guard is an integer, or zero for a while, the torque has the formula's value there, not a neighbouring
    value.
    """
    motion = symrot.propagator(scene(torque, stop=float(stop)), method, 1e-10)([float(stop)])
    assert motion.omega[0, 2] == pytest.approx(impulse / 3, abs=1e-9)


@needs_compiler
def test_friction_above_a_speed_ends_there():
    """-sign(max(omega_3 - 1, 0)) slows the body to 1 rad/s and then has no effect."""
    motion = symrot.propagator(scene("-sign(max(omega_3 - 1, 0))", (0, 0, 2), 10.0), "taylor", 1e-10)([1.5, 3, 10])
    assert motion.omega[:, 2] == pytest.approx([1.5, 1.0, 1.0], abs=1e-9)


@needs_compiler
def test_another_start_has_its_own_modes():
    made = symrot.propagator(scene("-sign(omega_3)", (0, 0, 1)))
    assert made([3.0], omega=[0, 0, -2]).omega[0, 2] == pytest.approx(-1.0, abs=1e-10)


@pytest.mark.parametrize(
    "use",
    [
        lambda made: symrot.emit(made, "c"), lambda made: symrot.propagator(made, state="ZXZ"),
        lambda made: symrot.propagator(made, torque=lambda t, omega, quaternion: omega),
    ],
    ids=["emit", "angles", "another torque"],
)  # fmt: skip
def test_who_cannot_follow_switches_says_so(use):
    with pytest.raises(InputError, match=r"expected .*(switches|jumps? or (bends?|a kink))"):
        use(scene("-sign(omega_3)"))


@needs_compiler
def test_products_of_inertia_slide_too():
    """Friction along omega_1 + omega_2 keeps this guard at zero, also with a full tensor."""
    content = {
        "schema": 1, "body": {"inertia": {"xx": 2, "yy": 3, "zz": 4, "xy": 0.3, "xz": 0.1, "yz": -0.2}},
        "initial": {"omega": [0.2, 0.1, 0.4]}, "span": {"t": [0, 5]},
        "torque": [{"kind": "expression", "torque": ["-sign(omega_1 + omega_2)", "-sign(omega_1 + omega_2)", "0"]}],
    }  # fmt: skip
    motion = symrot.propagator(Scene.from_dict(content), "taylor", 1e-10)(np.linspace(0, 5, 26))
    assert motion.stats.switches == 1
    later = motion.t > motion.stats.switching_times[0]
    assert later.any() and abs(motion.omega[later, :2].sum(axis=1)).max() < 1e-10


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_the_event_at_which_friction_stops_a_wheel_is_reported(method):
    """omega_3 falls to zero at 15 s and stays zero."""
    motion = symrot.propagator(scene("-sign(omega_3)", (0, 0, 5), 40.0), method)(events=["omega_3"])
    assert motion.t_events[0] == pytest.approx([15.0], abs=1e-9) and motion.event_kinds[0] == ["falling"]


@needs_compiler
def test_a_guard_without_a_value_ends_in_a_sentence():
    with pytest.raises(PropagationError, match=r"mod\(t, 0\) has no value"):
        symrot.propagator(scene("mod(t, 0)"))([1.0])


@pytest.mark.thinned(8)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("torque", "omega"),
    [
        ("sign(sign(step(-3/5)))", 0), ("abs(sign(abs(0)))", 0), ("where(-2 < -2, t, 3)", 12), ("where(k <= 2, t, 3)", 8),
        ("floor(k)*step(k - 2) + floor(k)", 8), ("sign(mod(2 - 9/5*t, 11/15))", 4), ("abs(mod(2 - t, 2))", 4),
        ("sign(floor(t))", 3), ("abs(floor(t - 3/2))", 4), ("step(t - 1)*sign(t - 1) + sign(step(1 - t))", 4),
    ],
)  # fmt: skip
def test_switches_in_switches_switch_together(torque, omega, method):
    """Guards jump to zero and away again, as mod does, or never change, at zero or elsewhere."""
    made = symrot.propagator(
        scene(torque, stop=4.0, principal=(1, 1, 1), **({"k": 2} if "k" in torque else {})), method
    )
    assert made([4.0]).omega[0, 2] == pytest.approx(omega, abs=1e-10)


@needs_compiler
def test_a_start_on_a_switch_inside_a_switch_has_more_than_one_future():
    with pytest.raises(PropagationError, match="more than one future"):
        symrot.propagator(scene("sign(sign(omega_3))"), "taylor")([1.0])


FRICTIONS = {  # torque -> omega_3 from 1 rad/s, for a moment of inertia of 1
    "-sign(omega_3) - step(omega_3)": lambda t: np.maximum(1 - 2 * t, 0),
    "-where(omega_3 > 0, 1, -1) - sign(omega_3)": lambda t: np.maximum(1 - 2 * t, 0),
    "-abs(omega_3)*sign(omega_3) - sign(omega_3)/4": lambda t: np.maximum(1.25 * np.exp(-t) - 0.25, 0),
    "-max(omega_3, 0) - sign(omega_3)/4": lambda t: np.maximum(1.25 * np.exp(-t) - 0.25, 0),
    # exp(omega) + 1 falls as exp(-t) times what it was, for u = exp(omega): du/dt = -(1 + 1/u) u
    "-(1 + exp(-abs(omega_3)))*sign(omega_3)": lambda t: np.log(np.maximum((math.e + 1) * np.exp(-t) - 1, 1)),
}


@pytest.mark.thinned(8)
@needs_compiler
@pytest.mark.parametrize("method", [*METHODS, "scipy:Radau", "scipy:BDF", "scipy:LSODA"])
@pytest.mark.parametrize("torque", FRICTIONS)
def test_friction_of_several_parts_stops_and_holds_the_body(torque, method):
    """The parts have equal guards, so they switch together, and one of them holds the body for all."""
    times = np.linspace(0, 3, 31)
    omega = symrot.propagator(scene(torque, (0, 0, 1), 3.0, (1, 1, 1)), method, 1e-9)(times).omega[:, 2]
    assert abs(omega - FRICTIONS[torque](times)).max() < 20e-9
    assert not omega[-5:].any()

"""Sliding along switches: the rates mix the rates of both sides (Filippov), or one sentence says why they cannot.

``omega_1' = 0.2 - 0.5 sign(omega_1)`` holds omega_1 at zero: the sides +1 and -1 have the shares 0.7 and 0.3. Any other
formula of the same switch then takes the mean of its values on both sides, with these shares.
"""

import re
from math import pi, sqrt

import numpy as np
import pytest
from sympy import Matrix

import symrot
from symrot.dynamics.equations import hurwitz_determinants
from symrot.errors import PropagationError
from symrot.planning.plan import make_plan
from symrot.propagation.method import choose_method
from symrot.propagation.switched.motion import SwitchedMotion
from tests.needs import needs_compiler

pytestmark = [needs_compiler, pytest.mark.usefixtures("quick_compiler")]
HOLDING = "1/5 - sign(omega_1)/2"
ABOVE, BELOW = 0.7, 0.3


def scene(*torque, omega=(0, 0, 0), stop=5, frame="body"):
    return symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": list(omega)}, "span": {"t": [0, stop]},
        "torque": [{
            "kind": "expression", "frame": frame, "torque": [*torque, *("0",) * (3 - len(torque))],
            "parameters": {"k": "3/2"},
        }],
    })  # fmt: skip


FOLLOWING = [  # torque about the second axis, and its values on the sides omega_1 > 0 and omega_1 < 0
    ("sign(omega_1)**2", 1, 1), ("abs(sign(omega_1))", 1, 1), ("sqrt(2 + sign(omega_1))", sqrt(3), 1),
    ("1/(2 + sign(omega_1))", 1 / 3, 1), ("sign(2*omega_1)", 1, -1), ("sign(-k*omega_1)", -1, 1),
    ("step(3*omega_1)", 1, 0), ("where(omega_1/2 > 0, 2, 1)", 2, 1), ("sign(omega_1)*step(-omega_1)", 0, -1),
    ("sign(omega_1)", 1, -1),
]  # fmt: skip


@pytest.mark.thinned(8)
@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize(("torque", "above", "below"), FOLLOWING)
def test_formulas_of_the_switch_have_the_mean_of_both_sides(torque, above, below, method):
    """From omega_1 = 0.3 the body reaches the switch after 1 s."""
    omega = symrot.propagator(scene(HOLDING, torque, omega=("3/10", 0, 0)), method, 1e-10)([0, 5]).omega[-1]
    assert abs(omega[0]) < 1e-9
    assert abs(omega[1] - (above + 4 * (ABOVE * above + BELOW * below))) < 20 * 1e-10


def test_a_switch_that_brakes_by_its_square_slides():
    """0.2 - 0.5 s - 0.1 s^2 is -0.4 for s = 1 and 0.6 for s = -1: shares 0.6 and 0.4, mean of s 0.2."""
    made = scene("1/5 - sign(omega_1)/2 - sign(omega_1)**2/10", "sign(omega_1)")
    assert abs(symrot.propagator(made, "auto", 1e-10)([0, 5]).omega[-1][1] - 1.0) < 20 * 1e-10


@pytest.mark.parametrize("stop", [0.6, 1.0, 2.0, 5.0])
@pytest.mark.parametrize("method", ["auto", "dop853"])
def test_a_switch_that_is_released_and_crossed_at_once_is_noticed(method, stop):
    """At 0.5524 s the rates lead around the place where two switches meet: the body stays there, on both switches.

    The switch that was left first was crossed again at this time, after the other one had switched. Rounding decided
    whether this was noticed: if not, omega was off by up to 0.01 in silence.
    """
    disc, line = "omega_3**2 + omega_1**2 - 981/1000", "omega_3*omega_2 + 127/500"
    third = "omega_3 - 917/1000*sin(2519/1000*t)"
    made = scene(
        f"-178/1000*omega_2 + 948/1000*sin(2696/1000*t + 254/1000) - 2086/1000*sign({disc})",
        f"702/1000 + 107/1000*sign({third})",
        f"-3/10*omega_3 - 1635/1000*sign({disc}) - 1324/1000*sign({line}) - 860/1000*sign({third})",
        omega=("875/1000", "122/1000", 0),
    )  # fmt: skip
    try:
        omega = symrot.propagator(made, method, 1e-9)([0.56, 0.58, stop]).omega[:2]
    except PropagationError as stopped:
        assert "beyond t = 0.55238568" in str(stopped)
    else:
        assert abs(omega[:, 2] ** 2 + omega[:, 0] ** 2 - 0.981).max() < 1e-6
        assert abs(omega[:, 2] * omega[:, 1] + 0.254).max() < 1e-6


@pytest.mark.thinned(2)
@pytest.mark.parametrize("torque", [
    "floor(omega_1)", "sign(omega_1**3)", "step(min(2 - t, 2*omega_1))", "sin(floor(step(omega_1)))",
    "sign(omega_1*(2 + q1))", "clip(t - sign(omega_1), -1/4, 1/4)",
])  # fmt: skip
def test_what_has_no_single_value_while_sliding_ends_in_a_sentence(torque):
    with pytest.raises(
        symrot.PropagationError,
        match=r"slide along the jumps? of sign\(omega_1\).* cannot compute: .*(do not determine|has no value)",
    ):
        symrot.propagator(scene(HOLDING, torque), "auto", 1e-9)([0, 5])


def test_friction_written_in_two_torques_ends_in_a_sentence():
    made = {
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 5]},
        "torque": [{"kind": "expression", "torque": ["0", "0", f"-{k}*sign(omega_3)"]} for k in (1, 2)],
    }  # fmt: skip
    with pytest.raises(symrot.PropagationError, match=r"do not determine the value of sign\(omega_3\)") as stopped:
        symrot.propagator(symrot.Scene.from_dict(made), "auto", 1e-9)([0, 0.25, 5])
    assert stopped.value.trajectory.t.tolist() == [0, 0.25]


def test_a_motion_that_would_slide_backward_ends_where_it_meets_the_jump():
    """omega_1 = 1/2 + t is zero at t = -1/2; before, the body can have been at rest in an unstable way for any time."""
    torque = scene("sign(omega_1)", "0", omega=("1/2", 0, 0))
    assert symrot.propagator(torque, "auto", 1e-9)([5]).omega[0, 0] == pytest.approx(5.5, abs=1e-8)
    with pytest.raises(
        symrot.PropagationError, match=r"t = -0\.5 .* slide along the jump of sign\(omega_1\) .* forward in time"
    ):
        symrot.propagator(torque, "auto", 1e-9)([-3])


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "other", ["sign(omega_2)", "where(sin(t*t) < sin(t*t/2), 1, 0)", "sign(omega_1 - 2)", "step(t - 2)"]
)
def test_switches_elsewhere_do_not_disturb_a_slide(other):
    omega = symrot.propagator(scene(HOLDING, "0", other, omega=("3/10", 0, 0)), "auto", 1e-9)([0, 5]).omega[-1]
    assert abs(omega[0]) < 1e-9


RESTING = [  # torque about the second axis, and its value where omega_1 = 0
    ("where(omega_1 < 0, 3, 1)", 1), ("where(not (omega_1 < 0), 1, 3)", 1), ("sign(omega_1)**2", 0), ("step(-omega_1)", 0),
    ("sqrt(1 + sign(omega_1))", 1), ("step(omega_1)", 0),
]  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", ["auto", "scipy:DOP853"])
@pytest.mark.parametrize(("torque", "value"), RESTING)
def test_a_body_at_rest_has_the_values_at_zero(torque, value, method):
    """Without a torque sign(0) = 0 holds: the sides are not mixed."""
    omega = symrot.propagator(scene("-sign(omega_1)/10", torque), method, 1e-10)([0, 5]).omega[-1]
    assert omega[0] == 0.0 and abs(omega[1] - 5 * value) < 20 * 1e-10


@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
def test_rest_ends_where_a_torque_begins_to_pull(method):
    """The body rests without torque until 3 s, is held until 5 s while s goes from 0 to 1, then moves freely."""
    made = scene("-sign(omega_1)/10 + max(0, t - 3)/20", "sign(omega_1)**2 + step(omega_1)", stop=10)
    omega = symrot.propagator(made, method, 1e-10)([0, 10]).omega[-1]
    assert abs(omega[1] - (2 * (1 + 3 / 4) + 5 * 2)) < 20 * 1e-10
    assert abs(omega[0] - ((49 - 4) / 40 - 5 / 10)) < 20 * 1e-10


@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
def test_a_torque_too_small_for_a_double_is_no_rest(method):
    """The pulse is never zero, though exp(-250000) underflows: both sides are mixed throughout."""
    made = scene("-sign(omega_1)/10 + exp(-((t - 5)/0.01)**2)/20", "sign(omega_1)**2", stop=10)
    assert abs(symrot.propagator(made, method, 1e-9)([0, 10]).omega[-1][1] - 10) < 20 * 1e-8


SEVERAL_AT_ONCE = [  # torques of functions that are all at their switches at the start, and the same without them
    ("space", ["abs(omega_2) - 1", "-sign(where(t > 10, q3, 0))", "0"], ["abs(omega_2) - 1", "0", "0"], (-1.47, 0, 1)),
    (
        "body", ["-omega_1/2 - step(t - 7/10)", "0", "mod(where(omega_1 < 0, 2.22, 0), 1) - 2*sign(omega_3) - 2/3"],
        ["-omega_1/2 - step(t - 7/10)", "0", "0"], (0, 0, 0),
    ),
    (
        "body", ["where(omega_3 > q2, abs(omega_2), 0)", "-2*abs(omega_3) - q2*sign(q0)", "-sign(omega_3) - q3*sign(q0)/2"],
        ["0", "0", "0"], (-1.56, 0, 0),
    ),
    (
        "body", ["min(2*omega_2 + q1, omega_1) - 2*sign(omega_1) + 1", "-sign(omega_2)/2 - max(q3, omega_2)", "-1"],
        ["0", "0", "-1"], (0, 0, 0),
    ),
]  # fmt: skip


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", ["auto", "scipy:DOP853"])
@pytest.mark.parametrize(("frame", "torque", "simpler", "omega"), SEVERAL_AT_ONCE)
def test_functions_that_switch_together_settle_in_any_order(frame, torque, simpler, omega, method):
    """While some functions have not switched yet, others may switch and switch back; this is no sliding."""
    ends = [
        symrot.propagator(scene(*each, omega=omega, frame=frame), method, 1e-10)([0, 2]).omega[-1]
        for each in (torque, simpler)
    ]
    assert abs(ends[0] - ends[1]).max() < 20 * 1e-10


AWAY = [  # torque, angular velocity at the start, and when motions beside the switch begin to lead away from it
    (("-sign(omega_1)*where(t < 5, 1, -1)",), "body", (1, 0, 0), 5.0),
    (("1/2 - sign(omega_1)*where(t < 5, 1, -1)",), "body", (1, 0, 0), 5.0),
    (("-sign(omega_1)", "0", "-sign(omega_3)"), "space", (0, 1, 0), pi / 2),  # by axes fixed in space, after 90 degrees
    (("-sign(omega_1)", "1/5"), "space", (0, 0, 0), sqrt(5 * pi)),
]


@pytest.mark.thinned(6)
@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize(("torque", "frame", "omega", "end"), AWAY)
def test_a_motion_does_not_slide_where_others_lead_away(torque, frame, omega, end, method):
    """Where motions on both sides lead away, the smallest error decides to which side the body goes."""
    with pytest.raises(PropagationError, match=r"lead away|as it does before a singularity") as ended:
        symrot.propagator(scene(*torque, omega=omega, frame=frame, stop=10), method, 1e-9)([0, 10])
    at = float(re.search(r"beyond t = ([0-9.]+) s", str(ended.value))[1])
    assert abs(at - end) < 1e-6


RELEASED = [  # torque, and omega_1 at 4 s; another switch ends the sliding of omega_1 = 0 at 2 s
    ("where(t < 2, 1/5 - sign(omega_1)/2, 1)", 2.0),
    ("where(t < 2, 1/5 - sign(omega_1)/2, 0)", 0.0),
    ("(1/5 - sign(omega_1)/2)*step(2 - t)", 0.0),
    ("-sign(omega_1)*step(2 - t) - step(t - 2)", -2.0),
    ("-sign(omega_1)*where(t < 2, 1, -1) + 2*step(t - 2)", 6.0),  # on both sides it now moves to omega_1 > 0
    ("-sign(omega_1)*where(t < 2, 1, -1) - 2*step(t - 2)", -6.0),
]


@pytest.mark.thinned(3)
@pytest.mark.parametrize("method", ["auto", "dop853", "scipy:DOP853"])
@pytest.mark.parametrize(("torque", "omega"), RELEASED)
def test_another_switch_may_end_a_slide(torque, omega, method):
    """Taylor steps were refused for another reason; DOP853 and SciPy kept omega_1 at zero, in silence."""
    trajectory = symrot.propagator(scene(torque, stop=4), method, 1e-10)([0, 2, 4])
    assert trajectory.omega[:, 0] == pytest.approx([0, 0, omega], abs=1e-9)


def test_hurwitz_determinants_tell_whether_all_eigenvalues_are_left():
    chance = np.random.default_rng(5)
    verdicts = set()
    for size in (1, 2, 3, 4):
        for _ in range(40):
            entries = chance.integers(-5, 3, (size, size))
            last = np.linalg.eigvals(entries.astype(float)).real.max()
            if abs(last) > 1e-9:
                left = all(number > 0 for number in hurwitz_determinants(Matrix(entries.tolist())))
                assert left == (last < 0), entries
                verdicts.add((size, left))
    assert len(verdicts) == 8


@pytest.mark.parametrize(("start", "omega", "end"), [(0, 1, 3), (2, -1, -1)])
def test_a_motion_that_stops_early_has_no_states_beyond_its_end(start, omega, end):
    """omega_1 = 1/(1 - t) up to the pole at t = 1, from t = 0 forward and from t = 2 backward."""
    made = symrot.Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [omega, 0, 0]}, "span": {"t": [start, 3]},
        "torque": [{"kind": "expression", "torque": ["step(omega_2 + 1)/(1 - t)**2", "0", "0"]}],
    })  # fmt: skip
    plan, broken = make_plan(made, switched=True), []
    _, states = SwitchedMotion(plan, choose_method(plan, "taylor"), 1e-10).parts(end, broken)
    assert len(broken) == 1 and abs(broken[0].t - 1.0) < 1e-3
    near, beyond = start + (1 - start) * np.array([0.25, 0.75]), start + (1 - start) * np.array([1.5, 2.0])
    assert np.abs(states(near)[:, 0] * (1.0 - near) - 1.0).max() < 20 * 1e-10
    assert np.isnan(states(beyond)).all()

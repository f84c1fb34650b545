"""Derivatives of motions through the switches of torques, against closed forms and where they do not exist."""

import json
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import InputError, PropagationError
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")


def scene(torque, parameters, omega, stop=4, principal=(2, 2, 3)):
    return {
        "schema": 1, "body": {"principal": list(principal)}, "initial": {"omega": list(omega)},
        "span": {"t": [0, stop], "samples": 3},
        "torque": [{"kind": "expression", "parameters": parameters, "torque": torque}],
    }  # fmt: skip


def column(motion, name, sample=-1):
    return motion.sensitivities[name].omega[sample, 2], motion.sensitivities[name].rotation[sample, 2]


@needs_compiler
def test_derivatives_by_the_times_of_a_thruster_pulse():
    """A torque k from a to b: omega_3 = 1 + k (b - a)/C, and the angle is 4 + k/C (b - a)(4 - (a + b)/2)."""
    a, b, k, c = 0.5, 1.5, 2.0, 3.0
    content = scene(["0", "0", "where(t > a and t < b, k, 0)"], {"a": "1/2", "b": "3/2", "k": 2}, (0, 0, 1))
    motion = symrot.propagate(content, t=[0, b, 4], sensitivities=["a", "b", "k", "I_zz"])
    expected = {
        "a": (-k / c, -k / c * (4 - a)),
        "b": (k / c, k / c * (4 - b)),
        "k": ((b - a) / c, (b - a) / c * (4 - (a + b) / 2)),
        "I_zz": (-k * (b - a) / c**2, -k / c**2 * (b - a) * (4 - (a + b) / 2)),
    }
    for name, values in expected.items():
        assert np.allclose(column(motion, name), values, rtol=1e-14, atol=0)
    # exactly at the switch the derivative with respect to its time jumps, and has no value
    assert np.isnan(column(motion, "b", 1)).all() and np.isfinite(column(motion, "k", 1)).all()
    ended = symrot.propagate(content, t=[0, b], sensitivities=["a", "b", "k", "I_zz"])
    assert np.array_equal(ended.sensitivities.omega[-1], motion.sensitivities.omega[1], equal_nan=True)
    assert [each.slopes.tolist() for each in motion.sensitivities.switchings] == [[1, 0, 0, 0], [0, 1, 0, 0]]


@needs_compiler
def test_derivatives_by_dry_friction_on_one_axis():
    """The wheel stops at t = C omega_0/k and slips again at t = 8 + 20 k, when a growing torque exceeds k."""
    motion = symrot.propagate(
        "friction_wheel", t=[3, 7, 16], sensitivities=["omega_3", "k", "I_zz"], events=["omega_3 == 20"]
    )
    omega = np.array([motion.sensitivities[name].omega[:, 2] for name in ("omega_3", "k", "I_zz")])
    assert np.allclose(omega, [[1, 0, 0], [-60, 0, -60], [300, 0, -90]], rtol=1e-13, atol=1e-13)
    stops, kink, slips = (each.slopes for each in motion.sensitivities.switchings)
    assert np.allclose([stops, kink, slips], [[0.2, -24, 120], [0, 0, 0], [0, 20, 0]], rtol=1e-13, atol=0)
    assert np.allclose(motion.sensitivities.t_events[0], [[0.2, -8, 40]], rtol=1e-13, atol=0)
    assert np.allclose(motion.transition(3, 7)[2], 0.0, atol=1e-13)
    # backward, the wheel comes to rest without friction that would tell when
    with pytest.raises(PropagationError, match="touches zero"):
        motion.transition(16, 7)


@needs_compiler
def test_a_report_says_where_the_last_sample_has_no_derivative(capsys):
    arguments = ["run", "friction_wheel", "--sensitivities", "k", "--set", "span.t=[0,6]"]
    assert main(arguments) == 0 and "no derivative: a torque switches" in capsys.readouterr().out
    assert main([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out, parse_constant=float)["final"]["sensitivities"]["k"]["omega"] is None


@needs_compiler
def test_derivatives_of_a_body_that_friction_holds_at_rest_from_the_start():
    """Friction stops each small rotation about axes 1 and 2 at once, so their derivatives vanish."""
    content = scene([f"-c*sign(omega_{i})" for i in (1, 2, 3)], {"c": 1}, (0, 0, 1), stop=2)
    motion = symrot.propagate(content, sensitivities=["omega"])
    assert np.array_equal(motion.sensitivities.omega[-1], np.diag([0.0, 0.0, 1.0]))


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    ("torque", "parameters", "names", "message"),
    [
        ("sign((t - 1)**2 - p)", {"p": 0}, ["p"], "touches zero"),
        ("where(t > a, 1, 0)*where(t > b, 1, 2)", {"a": 1, "b": 1}, ["a"], "a < t and b < t switch at the same time"),
        ("-sign(omega_3 - a) - sign(omega_3 - b)", {"a": 0, "b": 0}, ["a"], "switch at the same time"),
        ("where(t >= a, 1, 0)", {"a": 0}, ["a"], "starts where t < a switches"),
        ("floor(omega_3) - 3", {}, ["omega_3"], "starts where floor"),
        ("abs(omega_1)", {}, ["omega_1"], "stays at zero"),
    ],
)
def test_where_derivatives_do_not_exist_a_sentence_says_so(torque, parameters, names, message):
    with pytest.raises((PropagationError, InputError), match=message):
        symrot.propagate(scene(["0", "0", torque], parameters, (0, 0, 1)), sensitivities=names)


@needs_compiler
def test_derivatives_by_the_limit_of_a_torque():
    """The torque t is cut off at b = 1: omega_3 at 3 s is 1 + (b^2/2 + b (3 - b))/C."""
    motion = symrot.propagate(scene(["0", "0", "clip(t, -b, b)"], {"b": 1}, (0, 0, 1)), t=[3], sensitivities=["b"])
    assert np.isclose(motion.sensitivities.omega[0, 2, 0], 2 / 3, rtol=1e-14)
    assert [each.slopes.tolist() for each in motion.sensitivities.switchings] == [[1.0]]


@needs_compiler
def test_functions_that_switch_at_once_without_effect_on_each_other_have_derivatives():
    content = scene(["0", "0", "where(t > a, 1, 0) - where(t > b, 3, 0)"], {"a": 1, "b": 1}, (0, 0, 1))
    motion = symrot.propagate(content, t=[3], sensitivities=["a", "b"])
    assert np.allclose(motion.sensitivities.omega[0, 2], [-1 / 3, 1], rtol=1e-14, atol=0)


@needs_compiler
def test_a_variable_that_leaves_an_argument_at_zero_has_derivatives_there():
    content = scene(["0", "0", "k*t + abs(omega_1)"], {"k": 1}, (0, 0, 1))
    assert np.isclose(column(symrot.propagate(content, t=[3], sensitivities=["k"]), "k")[0], 1.5, rtol=1e-14)


@needs_compiler
def test_a_kink_at_rest_has_derivatives_if_both_sides_agree():
    """The square of omega_1 times its sign has the derivative zero at omega_1 = 0."""
    content = scene(["-abs(omega_1)*omega_1", "0", "0"], {}, (0, 0, 1))
    motion = symrot.propagate(content, sensitivities=["omega_3", "omega_1"])
    assert np.isfinite(motion.sensitivities.omega).all()
    assert np.isclose(np.linalg.norm(motion.sensitivities["omega_1"].omega[-1]), 1.0)


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    ("formula", "value", "label"),
    [
        ("sign(c)", 0, "sign(c)"),
        ("min(c, 1)*omega_3", 1, "min(c, 1)"),
        ("floor(c)", 2, "floor(c)"),
        ("where(c > 0, 1, 2)", 0, "0 < c"),
        ("abs(c)*abs(omega_3)", 0, "their constant"),
        ("abs(c*omega_3)", 0, "abs(c*omega_3)"),
    ],
)
def test_a_variable_at_the_jump_or_kink_of_a_function_of_constants_is_refused(formula, value, label):
    """Each of these had the derivative 0 or 1, that of one side or the mean of both."""
    with pytest.raises((InputError, PropagationError)) as error:
        symrot.propagate(scene([formula, "0", "0"], {"c": value}, (0, 0, 1)), sensitivities=["c"])
    assert label in str(error.value)


@needs_compiler
def test_a_square_wave_can_be_differentiated_by_its_frequency():
    """At each switch b*t is a multiple of pi; the jump of the whole turns in it was refused as a jump of a constant."""
    motion = symrot.propagate(scene(["0", "0", "sign(sin(b*t))"], {"b": 2}, (0, 0, 1)), t=[2], sensitivities=["b"])
    # 3 (omega_3 - 1) is pi/b - (2 - pi/b)
    assert abs(motion.sensitivities["b"].omega[0, 2] + 2 * np.pi / 4 / 3) < 1e-14


@needs_compiler
def test_dry_friction_and_quadratic_damping_stop_a_wheel():
    """C w' = -(k + c w^2) stops at ``t = C/sqrt(k c) atan(w_0 sqrt(c/k))``, where |omega| has no derivative."""
    content = scene(["0", "0", "-k*sign(omega_3)"], {"k": 1}, (0, 0, 1), principal=(2, 3, 4))
    content["torque"].append({"kind": "damping", "quadratic": 2})
    motion = symrot.propagate(content, t=[4], sensitivities=["omega_3", "k"])
    (stop,) = motion.sensitivities.switchings
    time = 4 / np.sqrt(2) * np.arctan(np.sqrt(2))
    assert abs(stop.t / time - 1) < 1e-13
    # the derivative with respect to k: that of C/sqrt(k c), then that of the arc tangent
    by_k = -time / 2 - 4 / (2 * 3)
    assert np.allclose(stop.slopes, [4 / 3, by_k], rtol=1e-12, atol=0)
    assert not motion.sensitivities.omega[0, 2].any()


@needs_compiler
def test_a_torque_with_an_infinite_slope_after_a_switch_is_refused():
    content = scene(["0", "0", "where(t > c, sqrt(t - c), 0)"], {"c": 1}, (0, 0, 1))
    with pytest.raises(PropagationError, match=r"after t = 1.0 s: the slope of the torque is not finite there"):
        symrot.propagate(content, t=[2], sensitivities=["c"])
    assert symrot.propagate(content, t=[2], sensitivities=["omega_3"]).sensitivities.omega[0, 2, 0] == 1.0


EARLIER = "1999999999999/2000000000000"  # 1 - 5e-13: earlier than 1 s by less than the rounding errors of a switch


@needs_compiler
@pytest.mark.parametrize("earlier", ["where(t > c, 4, 0)", "where(omega_3 > c, 4, 0)"])
def test_two_switches_at_once_just_after_a_third_have_a_derivative_each(earlier):
    """A sphere with unit moments: omega_1 is 3 - a + 2 (3 - b), and omega_2 is 4 (3 - c) for omega_3 = t."""
    torque = ["where(t > a, 1, 0) + where(t > b, 2, 0)", earlier, "1"]
    content = scene(torque, {"a": 1, "b": 1, "c": EARLIER}, (0, 0, 0), principal=(1, 1, 1))
    motion = symrot.propagate(content, t=[3], sensitivities=["a", "b", "c"])
    assert np.allclose(motion.sensitivities.omega[0], [[-1, -2, 0], [0, 0, -4], [0, 0, 0]], rtol=0, atol=1e-12)


@needs_compiler
@pytest.mark.parametrize("between", ["", " + where(t > d, 1, 0)"])
def test_a_switch_in_between_does_not_separate_two_switches_that_depend_on_each_other(between):
    torque = ["0", "0", "where(t > a, 1, 0)*where(t > b, 1, 2)" + between]
    values = {"a": "999999999997/1000000000000", "b": 1} | ({"d": "999999999999/1000000000000"} if between else {})
    with pytest.raises(PropagationError, match="switch at the same time"):
        symrot.propagate(scene(torque, values, (0, 0, 1)), sensitivities=["a", "b", *(["d"] if between else [])])


@needs_compiler
@pytest.mark.parametrize("time", ["1", "2/7"])
def test_the_derivatives_of_a_switching_time_are_those_of_the_function_that_switches(time):
    """The functions switch at the times a, b and c, of which c is earlier by less than a located time is exact."""
    torque = ["where(t > a, 1, 0) + where(t > b, 2, 0)", "where(omega_3 > c, 4, 0)", "1"]
    earlier = str(Fraction(time) * (1 - Fraction(4, 10**13)))
    content = scene(torque, {"a": time, "b": time, "c": earlier}, (0, 0, 0), principal=(1, 1, 1))
    motion = symrot.propagate(content, t=[3], sensitivities=["a", "b", "c"])
    expected = {"a < t": [1, 0, 0], "b < t": [0, 1, 0], "c < omega_3": [0, 0, 1]}
    # a function that switches and switches back at one instant has no derivatives there
    slopes = [
        (each.function, each.slopes) for each in motion.sensitivities.switchings if np.isfinite(each.slopes).all()
    ]
    assert {function for function, _ in slopes} == expected.keys()
    assert all(np.allclose(own, expected[function], rtol=0, atol=1e-9) for function, own in slopes)

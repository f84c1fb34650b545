"""Derivatives of motions with respect to initial values and constants: against motions of 50 digits, and in results."""

import pickle
from fractions import Fraction
from math import inf
from operator import mul

import mpmath
import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import InputError
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")

TOP = {
    "schema": 1,
    "body": {"principal": [2, 3, 4], "about": "fixed_point"},
    "initial": {"omega": ["1/2", "1/3", 2], "attitude": {"quaternion": [3, 1, 2, 1]}},
    "span": {"t": [0, 2], "samples": 3},
    "torque": [
        {"kind": "gravity", "weight": 3, "center_of_mass": [0, "1/5", 1]},
        {"kind": "damping", "linear": ["1/10", 0, "1/7"]},
    ],
}
NAMES = ["omega_2", "weight", "I_yy", "linear_2"]
SYMMETRIC = {
    "schema": 1,
    "body": {"principal": [2, 2, 1], "about": "fixed_point"},
    "initial": {"omega": [0, "1/2", 3], "attitude": {"quaternion": [3, 1, 0, 0]}},
    "span": {"t": [0, 5], "samples": 3},
    "torque": [{"kind": "gravity", "weight": 3, "center_of_mass": [0, 0, 1]}],
}


SWITCHED = {
    **TOP,
    "torque": [
        *TOP["torque"],
        {"kind": "expression", "parameters": {"k": "1/4"}, "torque": ["-k*sign(omega_1)", "0", "0"]},
    ],
}


UNIT = 1 << 190  # numbers of the reference are integers, in units of 2^-190: 57 digits
CHANGE = UNIT >> 60  # of a variable: central differences then have errors near 1e-36


def fixed(number):
    number = Fraction(number)
    return number.numerator * UNIT // number.denominator


def times(a, b):
    return a * b // UNIT


def product(a, b):
    return [
        times(a[0], b[0]) - times(a[1], b[1]) - times(a[2], b[2]) - times(a[3], b[3]),
        times(a[0], b[1]) + times(a[1], b[0]) + times(a[2], b[3]) - times(a[3], b[2]),
        times(a[0], b[2]) - times(a[1], b[3]) + times(a[2], b[0]) + times(a[3], b[1]),
        times(a[0], b[3]) + times(a[1], b[2]) - times(a[2], b[1]) + times(a[3], b[0]),
    ]


def convolved(f, g):
    """Return the last coefficient of the product of two series of equal length."""
    return sum(map(mul, f, reversed(g))) // UNIT


def value(series, time):
    total = 0
    for coefficient in reversed(series):
        total = coefficient + times(total, time)
    return total


def root(series, time):
    """Return the zero of a series between 0 and ``time``, at which its sign differs from that just after 0."""
    low, high, after = 0, time, value(series, time) > 0
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if (value(series, middle) > 0) == after else (middle, high)
    return high


def motion(omega, q, moments, weight, center, damping, duration, dry=0):
    """Return omega and q after a time, from Taylor series of 57 digits of Euler's equations, written out here.

    The torque ``-dry*sign(omega_1)`` may act too; a step ends where omega_1 changes its sign.
    """
    state, sign, rest = [*omega, *q], 1 if omega[0] > 0 else -1, duration * UNIT
    while rest:
        x = [[value] for value in state]
        for n in range(48):
            w1, w2, w3, p0, p1, p2, p3 = x
            down = [  # the unit vector down, body components
                2 * (convolved(p0, p2) - convolved(p1, p3)),
                -2 * (convolved(p2, p3) + convolved(p0, p1)),
                convolved(p1, p1) + convolved(p2, p2) - convolved(p0, p0) - convolved(p3, p3),
            ]
            across = (convolved(w2, w3), convolved(w3, w1), convolved(w1, w2))
            rates = []
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                arm = times(center[j], down[k]) - times(center[k], down[j])
                torque = times(moments[j] - moments[k], across[i]) - times(damping[i], x[i][n]) + times(weight, arm)
                torque -= sign * dry * (i == 0 and n == 0)
                rates.append(torque * UNIT // moments[i])
            rates += [
                -(convolved(p1, w1) + convolved(p2, w2) + convolved(p3, w3)) // 2,
                (convolved(p0, w1) + convolved(p2, w3) - convolved(p3, w2)) // 2,
                (convolved(p0, w2) + convolved(p3, w1) - convolved(p1, w3)) // 2,
                (convolved(p0, w3) + convolved(p1, w2) - convolved(p2, w1)) // 2,
            ]
            for series, rate in zip(x, rates, strict=True):
                series.append(rate // (n + 1))
        step = min(UNIT // 8, rest)
        if dry and value(x[0], step) * sign < 0:
            step, sign = root(x[0], step), -sign
        state, rest = [value(series, step) for series in x], rest - step
    return state


def reference(scene, change, duration):
    """Return the derivatives of omega, quaternion and small rotation with respect to what ``change`` changes."""
    heavy, *damped = scene.torques
    dry = fixed(damped[1].number("k")) if len(damped) > 1 else 0
    ends = []
    for sign in (-1, 0, 1):
        values = {
            "omega": [*map(fixed, scene.initial.omega_b)], "q": [*map(fixed, scene.initial.quaternion)],
            "moments": [fixed(scene.body.inertia[i][i]) for i in range(3)], "weight": fixed(heavy.number("weight")),
            "center": [*map(fixed, heavy.vector("center_of_mass"))],
            "damping": [*map(fixed, damped[0].vector("linear"))] if damped else [0, 0, 0],
            "dry": dry,
        }  # fmt: skip
        change(values, sign * CHANGE)
        ends.append(motion(**values, duration=duration))
    slope = [(high - low) * UNIT // (2 * CHANGE) for low, high in zip(ends[0], ends[2], strict=True)]
    q = ends[1][3:]
    rotation = [2 * x for x in product([q[0], -q[1], -q[2], -q[3]], slope[3:])[1:]]
    return [np.array([float(Fraction(x, UNIT)) for x in part]) for part in (slope[:3], slope[3:], rotation)]


def of(name, place=None):
    def change(values, size):
        if place is None:
            values[name] += size
        else:
            values[name][place] += size

    return change


def rotated(values, size):
    values["q"] = product(values["q"], [UNIT - times(size, size) // 8, 0, size // 2, 0])


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    ("content", "duration", "changes"),
    [
        (SWITCHED, 2, {"omega_2": of("omega", 1), "weight": of("weight"), "I_yy": of("moments", 1), "k": of("dry")}),
        (TOP, 2, {"omega_2": of("omega", 1), "weight": of("weight"), "I_yy": of("moments", 1),
                  "linear_2": of("damping", 1)}),
        (SYMMETRIC, 5, {"I_xx": of("moments", 0), "omega_1": of("omega", 0)}),
    ],
    ids=["switched", "damped", "exact"],
)  # fmt: skip
def test_sensitivities_agree_with_motions_of_fifty_digits(content, duration, changes):
    """The first torque switches; the last motion has a closed form, which a change of I_xx or omega_1 leaves."""
    scene = symrot.Scene.from_dict(content)
    trajectory = symrot.propagate(scene, t=[0, duration], sensitivities=list(changes))
    assert len(trajectory.sensitivities.switchings) == (content is SWITCHED)
    for name, change in changes.items():
        expected, computed = reference(scene, change, duration), trajectory.sensitivities[name]
        for part, own in zip(expected, (computed.omega, computed.quaternion, computed.rotation), strict=True):
            assert np.abs(own[-1] - part).max() <= 1e-12 * np.abs(part).max()


@needs_compiler
def test_the_transition_matrix_is_the_derivative_of_the_state():
    """A step there and back is the identity; columns agree with motions of 50 digits."""
    scene = symrot.Scene.from_dict(TOP)
    trajectory = symrot.propagate(scene)
    matrix = trajectory.transition(0, 2)
    for column, change in ((1, of("omega", 1)), (4, rotated)):
        omega, _, rotation = reference(scene, change, 2)
        expected = np.concatenate([omega, rotation])
        assert np.abs(matrix[:, column] - expected).max() <= 1e-12 * np.abs(expected).max()
    middle = trajectory.transition(0.75, 2) @ trajectory.transition(0, 0.75)
    assert np.abs(middle - matrix).max() <= 1e-12 * np.abs(matrix).max()
    assert np.abs(trajectory.transition(2, 0) @ matrix - np.eye(6)).max() <= 1e-11


@needs_compiler
def test_sensitivities_have_names_and_units_in_tables():
    pytest.importorskip("xarray")
    trajectory = symrot.propagate(symrot.Scene.from_dict(TOP), sensitivities=NAMES)
    data = trajectory.to_xarray()
    assert data.omega_by_weight.dims == ("time", "body_axis") and data.omega_by_weight.units == "(rad/s)/(N)"
    assert data.quaternion_by_omega_2.dims == ("time", "component")
    by_weight = trajectory.sensitivities["weight"]
    assert np.array_equal(trajectory.to_dataframe()["rotation_2_by_weight"], by_weight.rotation[:, 1])


@needs_compiler
def test_sensitivities_travel_with_labels(tmp_path):
    """They return from files and pickles unchanged."""
    trajectory = symrot.propagate(symrot.Scene.from_dict(TOP), sensitivities=NAMES)
    own = trajectory.sensitivities
    assert own.variables == tuple(NAMES) and not own["weight"].omega[0].any()
    trajectory.save(tmp_path / "motion.npz")
    for other in (
        symrot.load(tmp_path / "motion.npz").sensitivities,
        pickle.loads(pickle.dumps(trajectory)).sensitivities,
    ):
        assert other.groups == own.groups and other.units == own.units and np.array_equal(other.omega, own.omega)
    assert np.abs(trajectory.at(2.0).sensitivities.omega[0] - own.omega[-1]).max() < 1e-14


@needs_compiler
def test_the_times_of_events_have_derivatives():
    """They agree with difference quotients; a zero that the formula only touches has none; the motion is the same."""
    events = ["omega_1*q0 + t - 1", {"formula": "q2/4 + t - 3/2 == omega_1/16", "terminal": True}, "(t - 1/2)**2"]
    options = {"t": [0, 1, 2], "tolerance": 1e-14}
    motion = symrot.propagate(symrot.Scene.from_dict(TOP), sensitivities=NAMES, events=events, **options)
    slopes = motion.sensitivities.t_events
    assert [len(times) for times in motion.t_events] == [len(each) for each in slopes] == [1, 1, 1]
    assert np.isnan(slopes[2]).all() and len(motion.sensitivities.omega) == len(motion.t)
    column, step = NAMES.index("weight"), 1 / 256
    for place in (0, 1):
        ends = [
            symrot.propagate(TOP, parameters={"weight": 3 + k * step}, events=[events[place]], **options).t_events[0][0]
            for k in (-2, -1, 1, 2)
        ]
        quotient = (8 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / (12 * step)
        assert abs(slopes[place][0, column] - quotient) < 1e-9
        assert abs(quotient) > 1e-3


@needs_compiler
def test_derivatives_of_times_travel_in_files_and_tables(tmp_path):
    pytest.importorskip("pandas")
    motion = symrot.propagate(TOP, sensitivities=["weight"], events=["omega_1*q0 + t - 1", "(t - 1/2)**2"], t=[0, 2])
    motion.save(tmp_path / "motion.npz")
    saved, slopes = symrot.load(tmp_path / "motion.npz"), motion.sensitivities.t_events
    assert all(map(np.array_equal, saved.sensitivities.t_events, slopes, [True, True]))
    for each in (motion, saved):
        frame = each.at_events[0].to_dataframe()
        assert frame["t_by_weight"].tolist() == slopes[0][:, 0].tolist()
        assert frame.attrs["units"]["t_by_weight"] == "(s)/(N)"


@needs_compiler
def test_numbers_of_the_scene_file_are_variables():
    """By the radius of a solid sphere m = 4/3 pi rho r^3, C = 2/5 m r^2; a friction k slows it as exp(-k t/C)."""
    ball = {
        "schema": 1, "body": {"part": [{"shape": "sphere", "radius": "1/2", "density": 3}]},
        "initial": {"omega": [0, 0, 2], "attitude": {"sequence": "ZXZ", "angles": [0, 30, 0], "degrees": True}},
        "span": {"t": [0, 2], "samples": 2}, "torque": [{"kind": "damping", "linear": ["1/3", "1/3", "1/3"]}],
    }  # fmt: skip
    names = ["body.part[0].radius", "body.part[0].density", "torque[0].linear[2]", "initial.attitude.angles[1]"]
    own = symrot.propagate(ball, sensitivities=names).sensitivities
    inertia = 8 / 15 * np.pi * 3 / 2**5
    power = 2 / 3 / inertia
    scale = 2 * np.exp(-power) * power
    expected = [scale * 5 / (1 / 2), scale / 3, -scale * 3, 0]
    assert np.allclose(own.omega[-1, 2], expected, rtol=1e-13, atol=0)
    assert own.units == ("m", "kg/m^3", "N m s", "deg")
    # a rotation of the start by 1 deg about axis 1, then by the angle of the motion about axis 3
    assert np.isclose(np.linalg.norm(own[names[3]].rotation[-1]), np.pi / 180, rtol=1e-14)


@needs_compiler
def test_sensitivities_leave_the_motion_as_it_is():
    scene = symrot.Scene.from_dict(TOP)
    with_them, without = symrot.propagate(scene, sensitivities=["omega", "attitude"]), symrot.propagate(scene)
    assert np.array_equal(with_them.y, without.y) and without.sensitivities is None
    assert with_them.sensitivities["omega"].rotation.shape == (3, 3, 3)
    assert np.array_equal(with_them.sensitivities["omega"].omega[0], np.eye(3))


@needs_compiler
def test_sensitivities_of_a_motion_that_starts_far_from_zero():
    """The phase of the torque is counted from the start; without this the steps shrink to nothing."""
    start = 10**9
    driven = {
        "schema": 1, "body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 0, 1]},
        "span": {"t": [start, start + 2], "samples": 2},
        "torque": [{"kind": "expression", "parameters": {"k": 1}, "torque": ["0", "0", "k*sin(100*t)"]}],
    }  # fmt: skip
    ensemble = symrot.propagate_ensemble(driven, omega=[[0, 0, 1]], sensitivities=["k"])
    exact = float((mpmath.cos(100 * mpmath.mpf(start)) - mpmath.cos(100 * mpmath.mpf(start + 2))) / 300)
    for motion in (symrot.propagate(driven, sensitivities=["k"]), ensemble[0]):
        assert abs(motion.sensitivities["k"].omega[-1, 2] - exact) < 1e-13 * abs(exact)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": 3}, "expected the name of a method"),
        ({"sensitivities": "omega"}, "expected a list of names"),
        ({"sensitivities": []}, "at least one name"),
        ({"sensitivities": ["wieght"]}, "did you mean 'weight'"),
        ({"sensitivities": ["omega", "omega_2"]}, "omega_2 twice"),
        ({"sensitivities": ["quaternion"]}, "expected 'attitude'"),
        ({"sensitivities": ["tolerance"]}, "an initial value or a constant"),
        ({"sensitivities": ["span.t"]}, "an initial value or a constant"),
        ({"sensitivities": ["body.about"]}, "expected a number or a vector"),
        ({"sensitivities": ["omega"], "state": "ZXZ"}, "expected state='quaternion'"),
        ({"sensitivities": ["omega"], "torque": lambda t, w, q: (0, 0, 0)}, "expected torques of the scene"),
        ({"sensitivities": ["omega"], "events": ["abs(omega_3) == 1"]}, "expected formulas without abs"),
    ],
)
def test_what_has_no_sensitivities_is_refused_in_a_sentence(options, message):
    with pytest.raises(InputError, match=message):
        symrot.propagate(symrot.Scene.from_dict(TOP), **options)


def test_a_transition_needs_torques_of_the_scene_and_finite_times():
    with pytest.raises(InputError, match="expected a motion under torques of the scene"):
        symrot.propagate(TOP, t=[1], torque=lambda t, omega, q: (0, 0, 0), max_step=0.1).transition(0, 1)
    with pytest.raises(InputError, match="finite times"):
        symrot.propagate("t_handle").transition(0, inf)
    with pytest.raises(InputError, match="t0, t1: expected finite times"):
        symrot.propagate("t_handle").transition([0], 1)


def test_the_command_line_refuses_an_unknown_variable(capsys):
    assert main(["run", "t_handle", "--sensitivities", "wieght"]) == 2
    assert "sensitivities: wieght" in capsys.readouterr().err


def at_zero(formula, variable="c", **more):
    content = {
        "schema": 1, "body": {"principal": [2, 3, 4]}, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]},
        "torque": [{"kind": "expression", "parameters": {"c": 0, **more}, "torque": [formula, "0", "0"]}],
    }  # fmt: skip
    return symrot.propagate(content, t=[1], sensitivities=[variable]).sensitivities[variable].omega[-1, 0]


@needs_compiler
@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "formula", ["abs(c)", "sqrt(c**2)*(1 + t)", "sqrt(1 - cos(c))", "sqrt(c**2 + d**2*omega_3**2)"]
)
def test_a_constant_with_a_kink_at_the_value_of_a_variable_is_refused(formula):
    """The central difference of abs(c) at zero is zero, whatever the step."""
    with pytest.raises(symrot.SymrotError):
        at_zero(formula, d=0)


@needs_compiler
def test_a_constant_that_vanishes_to_a_higher_order_has_the_derivative_zero():
    assert at_zero("c*abs(c) + c**3*(1 + t)") == 0.0


def damped(omega, *torques, stop=2):
    content = {"schema": 1, "body": {"principal": [2, 3, 4]}, "initial": {"omega": omega}, "span": {"t": [0, stop]}}
    return {**content, "torque": [{"kind": "damping", "quadratic": 1}, *torques]}


@needs_compiler
def test_derivatives_through_a_reversal_under_quadratic_damping():
    """A wheel with 4 w' = 2 - |w| w passes zero, where |omega| has no derivative; ``w = tan`` before, tanh after."""
    with mpmath.workdps(40):
        rate, root = mpmath.sqrt(2) / 4, mpmath.sqrt(2)

        def later(start):
            return root * mpmath.tanh(rate * (3 + mpmath.atan(start / root) / rate))

        slope = float(mpmath.diff(later, -1))
    content = damped([0, 0, -1], {"kind": "constant_body", "torque": [0, 0, 2]}, stop=3)
    motion = symrot.propagate(content, t=[3], sensitivities=["omega_3"])
    assert abs(motion.sensitivities.omega[0, 2, 0] / slope - 1) < 1e-12
    both = symrot.propagate_ensemble(content, omega=[[0, 0, -1], [0, 0, 1]], t=[3], sensitivities=["omega_3"])
    assert abs(both.sensitivities.omega[0, 0, 2, 0] / slope - 1) < 1e-12


@needs_compiler
def test_derivatives_from_rest_under_quadratic_damping():
    """Spun up from rest, 2 w' = 1 - |w| w: ``w = tanh(t/2)``, and a faster start by dw has ``dw/cosh(t/2)^2``."""
    at_rest = symrot.propagate(damped([0, 0, 0]), t=[2], sensitivities=["omega"])
    assert np.array_equal(at_rest.sensitivities.omega[0], np.eye(3))
    content = damped([0, 0, 0], {"kind": "constant_body", "torque": [1, 0, 0]})
    motion = symrot.propagate(content, t=[2], sensitivities=["omega_1"])
    assert abs(motion.sensitivities.omega[0, 0, 0] - 1 / np.cosh(1) ** 2) < 1e-13


@needs_compiler
@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    "formula", ["-sqrt(omega_1**2 + omega_2**2)", "-sqrt(omega_1*omega_2)*omega_1", "-sqrt(q1**2 + q2**2)"]
)
def test_a_motion_that_stays_at_a_corner_of_its_torque_has_no_derivatives(formula):
    content = damped([0, 0, 1], {"kind": "expression", "torque": [formula, "0", "0"]}, stop=1)
    with pytest.raises(symrot.PropagationError, match="stays at zero"):
        symrot.propagate(content, t=[1], sensitivities=["omega"])


@needs_compiler
def test_an_event_whose_formula_has_no_derivative_at_its_zero_has_none():
    """A root at zero divided by zero here."""
    content = {**damped([0, 0, 1]), "torque": [{"kind": "constant_body", "torque": [1, 0, 0]}]}
    motion = symrot.propagate(content, t=[1], sensitivities=["omega_1"], events=["sqrt(omega_1**2 + omega_2**2)"])
    assert len(motion.t_events[0]) == 1 and np.isnan(motion.sensitivities.t_events[0]).all()

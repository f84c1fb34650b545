"""Euler angles as states give the same motion as the quaternion; they pass gimbal lock only by switching sequences."""

import math

import numpy as np
import pytest

import symrot
from symrot.cli import main as cli
from symrot.conventions import SEQUENCES
from symrot.errors import InputError, PropagationError
from symrot.kinematics import conversions
from symrot.kinematics.euler import sequences_at_lock
from symrot.propagation.euler_state import SWITCH, partner, regularity

pytestmark = pytest.mark.usefixtures("quick_compiler")
T = np.linspace(-3, 8, 111)


def scene(theta, omega=(0, "2/5", 1), moments=(1, "6/5", 2), torque=(), sequence="ZXZ"):
    """Return a scene of a body whose middle angle is ``theta`` at t = 0."""
    return symrot.Scene.from_dict(
        {
            "schema": 1, "title": "pass by the lock", "body": {"principal": list(moments), "about": "fixed_point"},
            "initial": {"omega": list(omega), "attitude": {"sequence": sequence, "angles": ["1/5", theta, "3/10"]}},
            "torque": list(torque), "span": {"t": [0, 8], "samples": 2},
            "output": {"quantities": ["omega", "quaternion"]},
        },
        "lock",
    )  # fmt: skip


def apart(first, second):
    """Return the largest difference between attitudes (up to sign) and between rates."""
    q = [np.abs(first.quaternion - sign * second.quaternion).max() for sign in (1, -1)]
    return max(min(q), np.abs(first.omega - second.omega).max())


GRAVITY = {"kind": "gravity", "weight": 1, "center_of_mass": ["1/10", "1/5", "9/10"]}
SPRING = {"kind": "spring", "stiffness": 2, "attitude": {"quaternion": [1, 0, 0, 0]}}


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "sequence, torque", [("ZXZ", (GRAVITY,)), ("ZYX", (SPRING,)), ("xyz", ()), ("yxy", (GRAVITY,))]
)
def test_angles_and_quaternion_follow_one_motion(sequence, torque):
    """Before and after the start, with torques that use the attitude as a matrix and as a quaternion."""
    body = scene("4/5", torque=torque)
    expected = symrot.propagator(body, method="taylor", tolerance=1e-13)(T)
    found = symrot.propagator(body, tolerance=1e-13, state=sequence)(T)
    assert apart(found, expected) < 1e-11
    assert np.abs(found.euler("ZXZ") - expected.euler("ZXZ")).max() < 1e-10
    assert found.method == "taylor" and np.abs(np.linalg.norm(found.quaternion, axis=1) - 1).max() < 1e-15
    assert np.abs(np.diff(found.quaternion, axis=0)).max() < 0.3  # the sign of the quaternion never jumps


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_partners_are_regular_where_a_sequence_locks(sequence):
    """Derived: where a sequence is singular, its partner is not, and the other way round."""
    assert partner(partner(sequence)) == sequence
    assert sequences_at_lock(sequence)[partner(sequence)].is_empty


def test_one_of_two_partners_is_always_regular():
    q = np.random.default_rng(7).normal(size=(2000, 4))
    for sequence in ("ZXZ", "ZYX", "xyz", "yxy"):
        least = [regularity(s, conversions.quaternion_to_euler(q, s)[0]) for s in (sequence, partner(sequence))]
        assert np.max(least, axis=0).min() >= math.sqrt(0.5) - 1e-12
        assert (least[1][least[0] < SWITCH] >= math.sqrt(1 - SWITCH**2) - 1e-12).all()


@pytest.mark.thinned(8)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_torques_odd_in_q_see_one_sign_of_it_in_every_sequence(sequence):
    """A torque that is odd in q depends on its sign: a change of sequence keeps the sign, and so does a start at -q."""
    body = scene(
        "4/5", ("1/2", 1, "7/10"), (1, 2, "5/2"), ({"kind": "expression", "torque": ["q1/5", "q0/5", "q3*q1*q2/3"]},)
    )
    times = np.linspace(-10, 20, 31)
    for start in ([1, 0, 0, 0], [-1, 0, 0, 0], [-0.1, 0.7, -0.1, 0.7]):
        expected = symrot.propagator(body, method="taylor", tolerance=1e-13)(times, quaternion=start)
        motion = symrot.propagator(body, "taylor", 1e-13, state=sequence)(times, quaternion=start)
        assert np.abs(motion.omega - expected.omega).max() < 1e-11
        assert np.abs(motion.quaternion - expected.quaternion).max() < 1e-11


@pytest.mark.parametrize("theta", ["1/10", "1/100000", "1/10000000000", 0])
def test_s34_switching_keeps_error_and_steps_through_the_lock(theta):
    """Near gimbal lock and through it, the error stays the same, and the steps almost."""
    body = scene(theta)
    expected = symrot.propagator(body, method="exact")(T)
    found = symrot.propagator(body, method="taylor", tolerance=1e-13, state="ZXZ")(T)
    assert apart(found, expected) < 1e-12
    assert found.stats.switches >= 1 and found.stats.accepted < 120


@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_without_switching_steps_multiply_near_the_lock(method):
    counts = []
    for theta in ("4/5", "1/1000", "1/100000000"):
        followed = symrot.propagator(scene(theta), method, 1e-10, state="ZXZ", switching=False)([1.0, 2.0])
        counts.append(followed.stats.evaluations)
        assert followed.stats.switches == 0
    assert counts[0] < counts[1] < counts[2] and counts[2] > 4 * counts[0]


def test_without_switching_the_lock_itself_ends_the_motion():
    with pytest.raises(PropagationError, match=r"beyond t = 0.0 s .*Euler angles ZXZ, .*switching=True avoids"):
        symrot.propagator(scene(0), state="ZXZ", switching=False)([1.0])


def test_dense_output_and_another_start():
    propagator = symrot.propagator(scene("1/1000"), method="taylor", tolerance=1e-12, state="ZXZ")
    trajectory = propagator(T)
    assert np.abs(trajectory.sol(T).T[:, 3:] - trajectory.quaternion).max() < 1e-12
    other = propagator(T, omega=[1, 0, 0.5])
    assert apart(other, symrot.propagator(scene("1/1000"), tolerance=1e-12)(T, omega=[1, 0, 0.5])) < 1e-10
    assert {item.name for item in trajectory.invariants} >= {"energy", "quaternion norm"}
    assert max(item.drift for item in trajectory.invariants) < 1e-12
    assert trajectory.states[-4:] == ("q0", "q1", "q2", "q3")


def test_motions_about_one_axis_and_spheres_have_angles_too():
    for omega, moments in (((0, 2, 0), (1, 2, 3)), ((1, 2, 3), (2, 2, 2)), ((0, 1, 3), (1, 1, 2))):
        body = scene("2/5", omega, moments)
        assert apart(symrot.propagator(body, tolerance=1e-13, state="ZXZ")(T), symrot.propagator(body)(T)) < 1e-11


@pytest.mark.parametrize(
    "options, words",
    [
        ({"state": "ZXX"}, "state: expected 'quaternion' or an Euler sequence"),
        ({"state": "ZXZ", "method": "exact"}, "expected one of auto, taylor, dop853 for Euler angles"),
        ({"state": "ZXZ", "torque": lambda t, w, q: (0, 0, 0)}, "state: expected 'quaternion' for a torque"),
    ],
)
def test_bad_input_is_refused(options, words):
    with pytest.raises(InputError, match=words):
        symrot.propagator(scene("1/2"), **options)
    with pytest.raises(InputError, match="events are not located"):
        symrot.propagator(scene("1/2"), state="ZXZ")([1.0], events="omega_1")
    named = {"kind": "expression", "torque": ["phi*omega_1", "0", "0"], "parameters": {"phi": 1}}
    with pytest.raises(InputError, match="the name of an angle"):
        symrot.propagator(scene("1/2", torque=(named,)), state="ZXZ")


def test_from_the_command_line(capsys):
    assert cli.main(["run", "tumbling_prism", "--state", "ZXZ", "--json"]) == 0
    assert '"the state is the Euler angles ZXZ, ZXY near its gimbal lock"' in capsys.readouterr().out
    assert cli.main(["run", "tumbling_prism", "--state", "ZXX"]) == 2
    assert capsys.readouterr().err.count("\n") == 1

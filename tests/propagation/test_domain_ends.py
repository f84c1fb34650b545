"""Torques whose formula loses its value: no method gives results after that time, and results before it are right."""

import numpy as np
import pytest

import symrot
from symrot.errors import PropagationError
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853", *(f"scipy:{name}" for name in ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA"))]


def scene(torque, stop=2.0):
    content = {
        "schema": 1, "body": {"principal": [1, 1, 1]}, "initial": {"omega": [0, 0, 0]}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": ["0", "0", torque]}],
        "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return symrot.Scene.from_dict(content)


@pytest.mark.thinned(6)
@needs_compiler
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("stop", [1.00000004, 1.2])
def test_a_motion_ends_where_its_torque_has_no_value(method, stop):
    """The root of 1 - t has no value after 1 s; in a step that ends there, only the rate shows it."""
    with pytest.raises(PropagationError, match="cannot be followed beyond") as caught:
        symrot.propagator(scene("sqrt(1 - t)", stop), method, 1e-9)([0.25, 0.5, stop])
    reached = caught.value.trajectory
    assert set(reached.t) <= {0.25, 0.5}
    assert reached.omega[:, 2] == pytest.approx(2 / 3 * (1 - (1 - reached.t) ** 1.5), abs=2e-8)
    assert np.isfinite(reached.quaternion).all()


@needs_compiler
@pytest.mark.parametrize("method", ["taylor", "dop853", "scipy:RK45"])
@pytest.mark.parametrize("torque", ["sqrt(1 - t)", "sqrt(1 - t) + step(t - 1/2)"])
@pytest.mark.parametrize("times", [[0.25, 0.75, 1.2], [0.25, -0.5, 1.2]])
def test_a_motion_that_is_cut_off_says_what_it_cost(torque, method, times):
    with pytest.raises(PropagationError) as caught:
        symrot.propagator(scene(torque), method, 1e-9)(times)
    stats = caught.value.trajectory.stats
    assert stats.accepted > 3 and stats.evaluations > 3 and stats.seconds > 0
    assert f"{stats.accepted} steps" in repr(caught.value.trajectory)


@needs_compiler
@pytest.mark.parametrize(
    ("torque", "end"),
    [
        ("1 + step(asin(omega_3) + 9)", 0.5), ("1 + step(acos(1 - omega_3) + 9)", 1.0),
        ("where(sqrt(1 - t) > -1, 1, 0)", 1.0), ("where(asin(1.01*sin(t)) < 9, 1, 0)", np.arcsin(1 / 1.01)),
    ],
)  # fmt: skip
def test_a_motion_ends_where_the_argument_of_a_switch_has_no_value(torque, end):
    """The mode of the switch stays 1, but the torque has no value: the motion went on with it in silence."""
    with pytest.raises(PropagationError, match="has no value there") as caught:
        symrot.propagate(scene(torque))
    reached = caught.value.trajectory
    assert reached.t[-1] == pytest.approx(end, abs=2.1e-3) and reached.t[-1] <= end + 1e-9


@needs_compiler
@pytest.mark.parametrize(
    ("torque", "omega"),
    [
        ("where(t < 1 and sqrt(1 - t) > 1/2, 1, 0)", 0.75), ("where(t > 1 and sqrt(t - 1) > 1/2, 1, 0)", 0.75),
        ("where(t > 1 or sqrt(1 - t) < 1/2, 1, 0)", 1.25),
        ("where(acos(q0) < 1/2, 1, 1)", 2.0),  # the error of the motion takes q0 beyond 1
    ],
)  # fmt: skip
def test_a_condition_needs_a_value_only_where_it_decides(torque, omega):
    assert symrot.propagate(scene(torque)).omega[-1, 2] == pytest.approx(omega, abs=1e-12)


@needs_compiler
def test_a_motion_of_any_number_of_steps_goes_on_where_the_argument_of_a_switch_has_a_value():
    """Eight steps at once gave as many samples as a search for the end of the domain: the motion ended without one."""
    content = scene("0", 20.0).to_dict() | {"body": {"principal": [1, 2, 3]}, "initial": {"omega": [0.3, 0.2, 1.0]}}
    motions = []
    for torque in ("0.1*sign(sqrt(omega_1**2 + 4) - 1)", "0.1"):
        content["torque"] = [{"kind": "expression", "torque": [torque, "0", "0"]}]
        motions.append(symrot.propagate(content).omega)
    assert motions[0] == pytest.approx(motions[1], abs=1e-8)

"""Which states and equations a plan keeps, which it skips and why, scene by scene."""

import pytest

from symrot.dynamics.structure import PrincipalInertia
from symrot.errors import InputError
from symrot.planning.plan import make_plan
from symrot.planning.rules import RULES
from symrot.scene.file import names_with_kernels
from symrot.scene.scene import Scene, load_scene

pytestmark = pytest.mark.usefixtures("quick_compiler")

FREE = {"principal": [1, 2, 3]}
TOP = {"principal": [2, 2, 1], "about": "fixed_point"}


def plan_of(body, omega, *torques, attitude=None, quantities=("omega", "quaternion")):
    initial = {"omega": omega} | ({"attitude": attitude} if attitude else {})
    return make_plan(Scene.from_dict({
        "schema": 1, "title": "test", "body": body, "initial": initial, "span": {"t": [0, 1]}, "torque": list(torques),
        "output": {"quantities": list(quantities)},
    }))  # fmt: skip


def weight(*arm):
    return {"kind": "gravity", "weight": 2, "center_of_mass": list(arm)}


ATTITUDE = ("q0", "q1", "q2", "q3")
CASES = {
    "free": (plan_of(FREE, [1, 1, 1]), ("omega_1", "omega_2", "omega_3", *ATTITUDE)),
    "no attitude asked": (plan_of(FREE, [1, 1, 1], quantities=["omega", "energy"]), ("omega_1", "omega_2", "omega_3")),
    "attitude needed by a torque": (
        plan_of(FREE, [1, 1, 1], {"kind": "constant_space", "torque": [1, 0, 0]}, quantities=["omega"]),
        ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "symmetric": (plan_of({"principal": [2, 2, 1]}, [1, 0, 1]), ("omega_1", "omega_2", *ATTITUDE)),
    "symmetric about 1": (plan_of({"principal": [1, 2, 2]}, [1, 0, 1]), ("omega_2", "omega_3", *ATTITUDE)),
    "symmetric without spin": (plan_of({"principal": [2, 2, 1]}, [1, 2, 0]), ATTITUDE),
    "spherical": (plan_of({"principal": [2, 2, 2]}, [1, 0, 1]), ATTITUDE),
    "heavy symmetric top": (plan_of(TOP, [1, 0, 9], weight(0, 0, 1)), ("omega_1", "omega_2", *ATTITUDE)),
    "weight off the axis": (plan_of(TOP, [1, 0, 9], weight(1, 0, 1)), ("omega_1", "omega_2", "omega_3", *ATTITUDE)),
    "steady spin": (plan_of(FREE, [0, 0, 1]), ("theta",)),
    "steady spin, rates only": (plan_of(FREE, [0, 0, 1], quantities=["omega"]), ()),
    "at rest": (plan_of(FREE, [0, 0, 0]), ()),
    "damped spin": (plan_of(FREE, [0, 2, 0], {"kind": "damping", "linear": 1}), ("omega_2", "theta")),
    "axial motor": (plan_of(FREE, [0, 0, 0], {"kind": "constant_body", "torque": [0, 0, 1]}), ("omega_3", "theta")),
    "motor about space axis that is a body axis": (
        plan_of(FREE, [0, 0, 1], {"kind": "constant_space", "torque": [0, 0, 1]}), ("omega_3", "theta"),
    ),
    "motor about another space axis": (
        plan_of(FREE, [0, 0, 1], {"kind": "constant_space", "torque": [0, 1, 1]}), ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "pendulum": (
        plan_of({"principal": [1, 2, 3], "about": "fixed_point"}, [0, 0, 0], weight(0, 0, 1), attitude={"axis": [1, 0, 0], "angle": 1}),
        ("omega_1", "theta"),
    ),
    "pendulum with a turned axis": (
        plan_of({"principal": [1, 2, 3], "about": "fixed_point"}, [0, 0, 0], weight(0, 0, 1), attitude={"axis": [1, 1, 0], "angle": 1}),
        ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "pendulum with the weight on its axis": (
        plan_of({"principal": [1, 2, 3], "about": "fixed_point"}, [1, 0, 0], weight(1, 0, 1), attitude={"axis": [1, 0, 0], "angle": 1}),
        ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "products of inertia": (
        plan_of({"inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": "1/10"}}, [0, 0, 1]), ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "gyrostat along its only spin": (plan_of(FREE, [0, 0, 1], {"kind": "rotor", "angular_momentum": [0, 0, 1]}), ("theta",)),
    "gyrostat across": (
        plan_of(FREE, [0, 0, 1], {"kind": "rotor", "angular_momentum": [0, 1, 0]}), ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
    "motor in the body of a symmetric body": (
        plan_of({"principal": [2, 2, 1]}, [1, 0, 1], {"kind": "constant_body", "torque": [0, 0, 1]}),
        ("omega_1", "omega_2", "omega_3", *ATTITUDE),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_the_states_that_are_left(name):
    plan, states = CASES[name]
    assert plan.states == states
    assert len(plan.initial_state) == len(states)


def test_moments_that_differ_in_the_last_digit_are_different():
    nearly = plan_of({"principal": [2, "2.0000000000000000000000001", 1]}, [1, 0, 1])
    assert "omega_3" in nearly.states


def test_a_body_that_is_symmetric_by_irrational_numbers_is_symmetric():
    """Three rods at 60 degrees to each other have equal moments only because sqrt(3)^2 = 3."""
    parts = [
        {
            "shape": "rod",
            "length": 1,
            "mass": 1,
            "rotate": {"sequence": "ZYX", "angles": [angle, 90, 0], "degrees": True},
        }
        for angle in (0, 60, 120)
    ]
    plan = plan_of({"part": parts}, [1, 0, 1])
    assert isinstance(plan.structure.inertia, PrincipalInertia)
    assert len(set(plan.structure.inertia.moments)) == 2


@pytest.mark.parametrize("name", names_with_kernels())
def test_every_rule_says_what_it_did(name):
    plan = make_plan(load_scene(name))
    assert [row.item for row in plan.rows] == [item for item, _ in RULES]
    assert all(row.why for row in plan.rows)
    assert plan.rows[-1].structure == plan.structure


def test_numbers_are_not_part_of_the_structure():
    assert plan_of(FREE, [1, 1, 1]).structure == plan_of({"principal": [4, 5, 6]}, [3, 2, 1]).structure
    assert plan_of(FREE, [1, 1, 1]).constants == {"A": 1, "B": 2, "C": 3}


def test_repeated_torques_and_parameters_with_taken_names_keep_apart():
    push = {"kind": "constant_body", "torque": [1, 0, 0]}
    named = {"kind": "expression", "torque": ["A*omega_1", "0", "t"], "parameters": {"A": 7}}
    plan = plan_of(FREE, [1, 1, 1], push, push, named)
    assert plan.constants == {"A": 1, "B": 2, "C": 3, "torque_1": 1, "torque2_torque_1": 1, "torque3_A": 7}


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "name", ["torque_1", "linear_1", "torque2_linear_1", "direction_2", "omega_3", "theta", "L_1", "p0", "x0"]
)
def test_a_parameter_may_have_any_name(name):
    """A parameter named like a component of another torque stays itself: the motion does not depend on its name."""
    from symrot.propagation.propagate import propagate

    def motion(parameter):
        body = {"principal": [1, 2, 3], "about": "fixed_point"}
        torques = [
            {"kind": "constant_body", "torque": [0.1, 0.2, -0.3]}, {"kind": "damping", "linear": [0.1, 0.2, 0.3]},
            {"kind": "damping", "linear": [0.3, 0.2, 0.1]}, {**weight(0.1, 0.2, 0.3), "direction": [1, 2, 2]},
            {"kind": "expression", "torque": [f"{parameter}*sin(t)", "0", f"-{parameter}"], "parameters": {parameter: "0.17"}},
        ]  # fmt: skip
        return propagate(plan_of(body, [1, 1, 1], *torques).scene).omega[-1]

    if name in ("omega_3",):
        with pytest.raises(InputError, match="omega_3"):
            motion(name)
    else:
        assert abs(motion(name) - motion("kk")).max() < 1e-12


def test_the_constants_of_any_torques_have_names_of_their_own():
    four = [
        {"kind": "expression", "torque": [f"{k}*t", "0", "0"], "parameters": {k: n}}
        for n, k in enumerate(("k", "k", "torque2_k", "torque1_k"), 1)
    ]
    constants = plan_of(FREE, [1, 1, 1], *four).constants
    assert sorted(constants.values()) == [1, 1, 2, 2, 3, 3, 4]

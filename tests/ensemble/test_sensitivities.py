"""Derivatives of the motions of an ensemble: those of single motions, for each motion alone, refused in a sentence."""

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")

TOP = {
    "schema": 1,
    "body": {"principal": [2, 3, 4], "about": "fixed_point"},
    "initial": {"omega": ["1/2", "1/3", 2], "attitude": {"quaternion": [3, 1, 2, 1]}},
    "span": {"t": [0, 2], "samples": 3},
    "torque": [{"kind": "gravity", "weight": 3, "center_of_mass": [0, "1/5", 1]}],
}
DRIVEN = TOP | {
    "torque": [{"kind": "expression", "parameters": {"k": 2}, "torque": ["k*exp(-400*(t - 1)**2)", "0", "-omega_3/7"]}]
}
OMEGA = np.array([[0.5, 0.25, 2.0], [1.0, -0.5, 0.125], [0.0, 0.0, 3.0]])
PARTS = ("omega", "quaternion", "rotation")


def agree(one, other):
    """Each column agrees with the single motion's to some units in the last place of its largest value."""
    assert all(getattr(one, part).shape == getattr(other, part).shape for part in PARTS)
    own, single = (np.concatenate([getattr(each, part) for part in PARTS], axis=1) for each in (one, other))
    assert (np.abs(own - single).max(axis=(0, 1)) <= 1e-13 * np.abs(single).max(axis=(0, 1))).all()


WEIGHTS = [3.0, 1.5, 2.0]
KEYS = ["omega_2", "weight"]
ATTITUDES = np.array([[1.0, 2, 0, 0], [1, 0, 0, 0], [3, 1, 2, 1]])


@pytest.fixture(scope="module")
def tops():
    """Three tops of different weights, differentiated with respect to a rate and the weight."""
    return symrot.propagate_ensemble(
        TOP, omega=OMEGA, quaternion=ATTITUDES, parameters={"weight": WEIGHTS}, sensitivities=KEYS
    )


@needs_compiler
def test_derivatives_are_those_of_single_motions(tops):
    assert tops.success and tops.sensitivities.rotation.shape == (3, 3, 3, 2)
    single = symrot.propagate(
        TOP, omega=OMEGA[1], quaternion=ATTITUDES[1], parameters={"weight": 1.5}, sensitivities=KEYS
    )
    agree(tops[1].sensitivities, single.sensitivities)


@needs_compiler
@pytest.mark.campaign
@pytest.mark.parametrize("key", ["I_xy", "attitude"])
@pytest.mark.parametrize("k", range(3))
def test_derivatives_of_full_tensors_are_those_of_single_motions(k, key):
    """The product of inertia is zero in one motion; the equations are those of a full tensor in each."""
    products = [0.0, 0.25, 0.125]
    ensemble = symrot.propagate_ensemble(TOP, omega=OMEGA, parameters={"I_xy": products}, sensitivities=[key])
    single = symrot.propagate(TOP, omega=OMEGA[k], parameters={"I_xy": products[k]}, sensitivities=[key])
    agree(ensemble[k].sensitivities, single.sensitivities)


@needs_compiler
@pytest.mark.shipped_flags  # like the module's fixture, whose bits it compares
def test_derivatives_do_not_depend_on_the_other_motions(tops):
    alone = symrot.propagate_ensemble(
        TOP, omega=OMEGA[1:], quaternion=ATTITUDES[1:], parameters={"weight": WEIGHTS[1:]}, workers=2,
        sensitivities=KEYS,
    )  # fmt: skip
    for part in PARTS:
        assert np.array_equal(getattr(tops[1].sensitivities, part), getattr(alone[0].sensitivities, part))


@needs_compiler
def test_derivatives_under_a_short_pulse_are_those_of_single_motions():
    """The pulse lasts 0.1 s; a step that misses it leaves all derivatives with respect to k zero."""
    ensemble = symrot.propagate_ensemble(DRIVEN, omega=OMEGA[:2], sensitivities=["k"])
    single = symrot.propagate(DRIVEN, omega=OMEGA[1], sensitivities=["k"])
    agree(ensemble[1].sensitivities, single.sensitivities)
    assert abs(ensemble[1].sensitivities["k"].omega[-1, 0]) > 0.01


@needs_compiler
def test_derivatives_at_a_late_start_are_those_of_single_motions():
    """Time is counted from the start there; the torque on an orbit was once evaluated at twice the start."""
    scene = symrot.load_scene("gravity_gradient_satellite").with_(t=[200_000, 202_000], samples=3)
    omega = [float(rate) for rate in scene.initial.omega_b]
    ensemble = symrot.propagate_ensemble(scene, omega=[omega], sensitivities=["omega"])
    agree(ensemble[0].sensitivities, symrot.propagate(scene, sensitivities=["omega"]).sensitivities)


@needs_compiler
def test_derivatives_at_no_time_are_empty(tops):
    alone = symrot.propagate_ensemble(
        TOP, omega=OMEGA, quaternion=ATTITUDES, parameters={"weight": WEIGHTS}, t=[], sensitivities=KEYS
    )
    assert alone.sensitivities.omega.shape == (3, 0, 3, 2)


@needs_compiler
def test_derivatives_have_labels(tops):
    pytest.importorskip("xarray")
    assert tops.to_xarray().omega_by_weight.dims == ("trajectory", "time", "body_axis")
    table = tops.to_dataframe()["rotation_2_by_weight"]
    assert np.array_equal(table, tops.sensitivities["weight"].rotation[..., 1].ravel())


@needs_compiler
def test_motions_through_switches_have_the_derivatives_of_single_motions():
    """The third wheel starts at rest, at a kink of its torque: it has no derivative, and its message says so."""
    scene = {
        "schema": 1, "body": {"principal": [2, 2, 3]}, "initial": {"omega": [0, 0, 1]},
        "span": {"t": [0, 4], "samples": 2},
        "torque": [{"kind": "expression", "parameters": {"c": 1}, "torque": ["0", "0", "-c*sign(omega_3) + abs(omega_1)"]}],
    }  # fmt: skip
    omega, c = [[1, 0, 1], [1, 0, 2], [0, 0, 1]], [1.0, 0.5, 1.0]
    ensemble = symrot.propagate_ensemble(
        scene, omega=omega, parameters={"c": c}, t=[1, 2], sensitivities=["omega", "c"]
    )
    for own, start, value in zip(ensemble.sensitivities.omega[:2], omega, c, strict=False):
        alone = symrot.propagate(scene, omega=start, parameters={"c": value}, t=[1, 2], sensitivities=["omega", "c"])
        assert np.array_equal(own, alone.sensitivities.omega)
    assert np.isnan(ensemble.sensitivities.omega[2]).all() and "stays at zero" in ensemble.messages[2]


@pytest.mark.parametrize(
    ("scene", "options", "message"),
    [
        (TOP, {"sensitivities": "omega"}, "expected a list of names"),
        (TOP, {"sensitivities": ["wieght"]}, "did you mean 'weight'"),
        (
            "heavy_top_loops",
            {"sensitivities": ["gravity"], "parameters": {"weight": [1.0, 2.0, 3.0]}},
            "gravity changes weight",
        ),
        (
            TOP
            | {"initial": {"omega": [1, 2, 3], "attitude": {"sequence": "ZXZ", "angles": [0, 30, 0], "degrees": True}}},
            {"sensitivities": ["initial.attitude.angles[1]"], "quaternion": ATTITUDES},
            "changes quaternion, whose values differ between the motions; name attitude as the variable instead",
        ),
    ],
)
def test_what_has_no_derivatives_is_refused_in_a_sentence(scene, options, message):
    with pytest.raises(InputError, match=message):
        symrot.propagate_ensemble(scene, omega=OMEGA, t=[0, 1], **options)

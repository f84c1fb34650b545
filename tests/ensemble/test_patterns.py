"""To the last bit, a motion does not depend on zero or equal constants of the other motions in its ensemble."""

import numpy as np
import pytest

import symrot
from tests.needs import needs_compiler
from tests.sweeps.scenes import DAMPED_TOP

pytestmark = pytest.mark.usefixtures("quick_compiler")

SCENE = DAMPED_TOP | {"span": {"t": [0, 2], "samples": 3}, "accuracy": {"tolerance": "1e-10"}}


def ensemble(parameters, scene=SCENE):
    return symrot.propagate_ensemble(symrot.Scene.from_dict(scene), parameters=parameters)


@pytest.mark.thinned(2)
@needs_compiler
@pytest.mark.parametrize(
    "parameters",
    [
        {"linear": [[0.0, 0, 0], [0.1, 0.1, 0.1], [0, 0, 0.1]]},
        {"linear_3": [0.0, 0.1, 0.0]},
        {"principal": [[1, 1, 0.5], [1, 1.2, 0.5], [1, 1, 1]]},
        {"center_of_mass": [[0, 0, 0.5], [0.1, 0.2, 0.5], [0, 0, 0.5]]},
        {"I_xy": [0.0, 0.1, 0.0], "quadratic": [0.0, 0.0, 0.1]},
    ],
    ids=lambda parameters: ", ".join(parameters),
)
def test_a_motion_has_the_bits_of_its_motion_alone(parameters):
    together = ensemble(parameters)
    for k in range(3):
        alone = ensemble({name: values[k : k + 1] for name, values in parameters.items()})
        assert np.array_equal(together.omega[k], alone.omega[0])
        assert np.array_equal(together.quaternion[k], alone.quaternion[0])
        assert together.methods[k] == alone.methods[0] and together.stats.steps[k] == alone.stats.steps[0]


def test_a_motion_without_a_closed_form_is_named_by_its_place_in_the_ensemble():
    scene = {**SCENE, "torque": SCENE["torque"][:1]}
    with pytest.raises(symrot.InputError, match="trajectory 2 of the scene"):
        symrot.propagate_ensemble(
            symrot.Scene.from_dict(scene), parameters={"principal": [[1, 1, 0.5]] * 2 + [[1, 1.2, 0.5]]}, method="exact"
        )

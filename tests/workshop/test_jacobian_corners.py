"""Emitted derivatives of torques with roots say where they have no value."""

import numpy as np
import pytest

import symrot

SCENE = {
    "schema": 1, "body": {"principal": [2, 3, 4]}, "initial": {"omega": [1, 2, 3]}, "span": {"t": [0, 1]},
    "torque": [{"kind": "damping", "quadratic": 1}],
}  # fmt: skip


def test_the_head_says_that_derivatives_of_a_root_are_nan_where_it_is_zero():
    """The quotient omega_i omega_j/|omega| is 0/0 at rest."""
    emitted = symrot.emit(SCENE, "numpy", jacobian=["omega"])
    assert "where a root of them is zero, the derivatives are NaN" in emitted.source
    space = {}
    exec(emitted.source, space)
    with np.errstate(all="ignore"):
        at_rest = space[emitted.name](0.0, np.array([0.0, 0, 0, 1, 0, 0, 0]), np.ones(6))
    assert np.isnan(at_rest[1]).any() and np.isfinite(at_rest[0]).all()


@pytest.mark.parametrize(("options", "note"), [({"step": "taylor"}, "the results are NaN"), ({"step": "rk4"}, "")])
def test_the_head_of_a_step_says_so_too(options, note):
    text = symrot.emit(SCENE, "numpy", **options).source
    assert (note in text) if note else "NaN" not in text

"""What two documents say of a motion, in numbers and in words: the shipped scenes move as they say."""

import numpy as np
import pytest

import symrot


def test_the_cylinder_of_chen_follows_the_analytic_solution_of_page_23():
    """I1 = I2 = 0.6375, I3 = 0.075, omega = (1, 0, 1) at the start: (cos, sin) of -15/17 rad/s t, and a constant."""
    motion = symrot.propagate("chen_cylinder")
    rate = (0.075 - 0.6375) / 0.6375
    expected = np.column_stack([np.cos(rate * motion.t), np.sin(rate * motion.t), np.ones_like(motion.t)])
    assert np.abs(motion.omega - expected).max() < 1e-12  # a closed form: some rounding errors of 1e-16


@pytest.mark.parametrize(
    ("scene", "is_stable"),
    [("tumbling_prism_largest", True), ("tumbling_prism_smallest", True), ("tumbling_prism", False)],
)
def test_the_prism_of_brown_tumbles_about_its_middle_axis_only(scene, is_stable):
    """Pages 57 and 59: about the axis of the largest or smallest moment, a small disturbance stays small."""
    omega = np.abs(symrot.propagate(scene).omega)
    axis = omega[0].argmax()
    across = np.delete(omega, axis, axis=1).max()
    assert (across < 0.1 * omega[0, axis]) == is_stable
    assert (omega[:, axis].min() > 0.9 * omega[0, axis]) == is_stable

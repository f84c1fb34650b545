"""Stress tests S35 to S38: conversions of attitudes agree with 50 digits."""

import numpy as np
from mpmath import mp, mpf
from scipy.spatial.transform import Rotation

from symrot.conventions import SEQUENCES
from symrot.kinematics import conversions as cv
from symrot.kinematics.rates import angular_velocity, quaternion_rate
from tests.reference import quaternions as exact
from tests.reference.figures import Figure, body, propagated

BAR = 4e-16  # of a rotation: a unit quaternion in doubles is known to 1.1e-16 per component


def s35(long):
    found = []
    for name, sequences in (("ZYX, ZXZ", ("ZYX", "ZXZ")), ("all 24 sequences", SEQUENCES)):
        rng, worst = np.random.default_rng(35), mpf(0)
        with mp.workdps(50):
            for sequence in sequences:
                for lock in exact.LOCKED[exact.is_proper(sequence)]:
                    inward = -1 if lock > 0 else 1
                    for distance in [0.0, *10.0 ** -np.arange(3, 18)]:
                        first, third = rng.uniform(-np.pi, np.pi, 2)
                        q = exact.doubles(
                            exact.exact_euler((first, mpf(lock) + inward * mpf(distance), third), sequence)
                        )
                        angles = cv.quaternion_to_euler(q, sequence)[0]
                        worst = max(worst, exact.difference(exact.exact_euler(angles, sequence), exact.exact_unit(q)))
        found.append(Figure("conversions", f"{name}, 1e-3 to 1e-17 and 0 from lock", BAR, float(worst)))
    return found


def s36(long):
    worst = 0.0
    for exponent in range(1, 301, 1 if long else 13):
        axes = np.random.default_rng(exponent).normal(size=(50, 3))
        v = axes / np.linalg.norm(axes, axis=1, keepdims=True) * 10.0**-exponent
        back = cv.quaternion_to_rotation_vector(cv.rotation_vector_to_quaternion(v))
        worst = max(worst, float(np.linalg.norm((back - v) * 10.0**exponent, axis=1).max()))
    return [Figure("conversions", "log(exp(v)), relative, 1e-1 to 1e-300", BAR, worst)]


def s37(long):
    worst, axis_worst = mpf(0), 0.0
    with mp.workdps(50):
        for distance in [*10.0 ** -np.arange(1, 16), 0.0]:
            axes = np.random.default_rng(37).normal(size=(30, 3))
            axes /= np.linalg.norm(axes, axis=1, keepdims=True)
            q = cv.rotation_vector_to_quaternion(axes * (np.pi - distance))
            back = cv.quaternion_to_rotation_vector(q)
            worst = max(worst, *(exact.difference(exact.exact_exponential(w), exact.exact_unit(p))
                                 for w, p in zip(back, q, strict=True)))  # fmt: skip
            axis_worst = max(axis_worst, float(exact.apart(cv.quaternion_to_axis_angle(q)[0], axes).max()))
    return [Figure("conversions", "rotation", BAR, float(worst)),
            Figure("conversions", "axis up to sign", BAR, axis_worst)]  # fmt: skip


def s38(long):
    """Count the signs and orders of components that differ from the textbook conventions."""
    h, tilt = np.sqrt(0.5), np.array([np.cos(0.5), np.sin(0.5), 0.0, 0.0])
    dcm = cv.quaternion_to_dcm(tilt)
    spin = [0.0, 0.0, 2.0]
    in_body, in_space = (quaternion_rate(tilt, spin, frame) for frame in ("body", "space"))
    trajectory = propagated(body((2, 2, 2), (0, 0, 1), attitude={"quaternion": [1, 0, 0, 0]}), "auto", 1e-12, [0.5])
    checks = (
        np.allclose(cv.quaternion_to_dcm([h, 0, 0, h]) @ [1, 0, 0], [0, 1, 0], atol=3e-16),  # active, body to space
        np.array_equal(cv.multiply([0, 1, 0, 0], [0, 0, 1, 0]), [0, 0, 0, 1]),  # Hamilton: i j = k
        np.allclose(cv.to_scipy_order([h, 0, 0, h]), Rotation.from_euler("z", 90, degrees=True).as_quat()),
        np.allclose(in_body, cv.multiply(tilt, [0, *spin]) / 2), np.allclose(in_space, cv.multiply([0, *spin], tilt) / 2),
        np.allclose(angular_velocity(tilt, in_body, "space"), dcm @ spin), not np.allclose(in_body, in_space),
        np.allclose(trajectory.quaternion[0], [np.cos(0.25), 0, 0, np.sin(0.25)], atol=1e-15),
        np.allclose(cv.euler_to_dcm([0.3, 0.0, 0.0], "ZXZ")[0, 1], -np.sin(0.3)),
        np.allclose(cv.euler_to_dcm([0.1, 0.2, 0.3], "ZYX"), cv.euler_to_dcm([0.3, 0.2, 0.1], "xyz")),
    )  # fmt: skip
    return [Figure("conversions", f"of {len(checks)} signs and orders wrong", 0, len(checks) - sum(map(bool, checks)))]

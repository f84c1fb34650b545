"""The motion of a gyrostat by mpmath and NumPy, without a C compiler; formulas of :file:`gyrostat.h`."""

import numpy as np

from symrot.closed_form.build import Floats
from symrot.closed_form.portable.phases import DIGITS, Phase, number, power_of_two, vector
from symrot.closed_form.portable.quaternions import mapping, matrix_quaternion, unit
from symrot.formula.precision import digits, mp
from symrot.kinematics.hamilton import conjugate, hamilton

__all__ = ["PortableGyrostat"]


mpf = mp.mpf


class PortableGyrostat:
    """The motion of a gyrostat, computed with mpmath and NumPy.

    The arguments are those of the C function symrot_gyrostat_prepare in :file:`gyrostat.c`, which explains them and
    computes the constants of the motion. All but ``axis`` are lists hi, lo, hi, lo, .. of doubles, in which each sum
    hi + lo is one number. ValueError is raised if the moment about a transverse axis is not positive, or if the
    quaternion is zero.
    """

    regime = "steady"

    @digits(DIGITS)
    def __init__(
        self, moments: list[float], rotor: list[float], omega: list[float], quaternion: list[float], axis: list[float]
    ) -> None:
        a, c = vector(moments)
        extra, w = number(*rotor) / a, vector(omega)
        if a <= 0 or not any(vector(quaternion)):
            raise ValueError("expected positive moments of inertia and a quaternion that is not zero")
        self.scale = power_of_two(max(abs(extra), *(abs(x) for x in w)))
        w = [x / self.scale for x in w]
        along = (c / a) * w[2] + extra / self.scale  # L3/A
        speed = mp.sqrt(w[0] ** 2 + w[1] ** 2 + along**2)
        self.precession = Phase.of(speed / (4 * mp.pi))
        self.spin = Phase.of((w[2] - along) / (4 * mp.pi))
        name = [int(x) for x in axis[:3]]
        self.omega = np.zeros((3, 3))
        first, second, third = (float(x * self.scale) for x in w)
        self.omega[name[0]] = first, second, 0.0
        self.omega[name[1]] = second, -first, 0.0
        self.omega[name[2]] = 0.0, 0.0, third
        renaming = matrix_quaternion([[int(name[k] == j) for j in range(3)] for k in range(3)])
        start = hamilton(unit(vector(quaternion)), conjugate(renaming))
        direction = [mpf(0), *(x / speed if speed else mpf(0) for x in (w[0], w[1], along))]
        about = [mpf(0), mpf(0), mpf(0), mpf(1)]
        turned = hamilton(start, direction)
        columns = [start, hamilton(start, about), turned, hamilton(turned, about)]
        self.attitude = mapping([hamilton(column, renaming) for column in columns])

    def evaluate(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        """Write the samples at ``times``, s, into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped.
        """
        t = times * float(self.scale)
        s, c = self.spin.circle(t)
        if omega is not None:
            omega[:] = np.stack([(c - s) * (c + s), 2.0 * s * c, np.ones_like(t)], axis=1) @ self.omega.T
        if quaternion is not None:
            sine, cosine = self.precession.circle(t)
            quaternion[:] = np.stack([cosine * c, cosine * s, sine * c, sine * s], axis=1) @ self.attitude.T

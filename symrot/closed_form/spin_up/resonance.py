"""Attitude of the rotating axes of a driven symmetric body near resonance, by Taylor series about evenly spaced points.

The rotating axes rotate with the body's transverse angular velocity (see :mod:`symrot.closed_form.spin_up.motion`).
Their own angular velocity has the components ``(kappa, 0, x)`` along these axes, where x is the scaled time. Their
attitude q, with ``q = 1`` at x = 0, is given by ``alpha = q0 + i q3`` and ``beta = q1 + i q2``, with

    2 alpha' = i x alpha - kappa beta,  2 beta' = kappa alpha - i x beta.

At each point these equations give each Taylor coefficient from the two previous ones. Numbers are fixed-point integers.

Proof: ``derivations/driven_rotation.md``.
"""

from fractions import Fraction

import numpy as np

from symrot.closed_form.build import Floats
from symrot.closed_form.spin_up.off_resonance import FIXED, Quaternion
from symrot.closed_form.spin_up.series import NEAR

__all__ = ["DEGREE", "PIECES", "Near"]

PIECES = 4
"""Number of Taylor polynomials of the attitude per unit of the scaled time x: each holds on an interval of 1/PIECES."""

DEGREE = 19
"""Degree of the Taylor polynomials of the attitude in the scaled time x, for the times near x = 0.

The axes rotate with the angular speed r = sqrt(kappa^2 + x^2) (see the module's text), below 13.5 near x = 0. So on an
interval of half width 1/8 the first omitted term is near (r/2)^20/20!/8^20 < 2e-20.
"""

_TERMS = 34  # terms of a series in integers

_Spinor = tuple[int, int, int, int]  # the complex pair alpha, beta as q0, q3, q1, q2


class Near:
    """Attitudes of the rotating axes near resonance, the time at which their axial rate Omega is zero.

    The attitudes depend on the scaled time x = Omega/sqrt(s), from -NEAR to NEAR, and on kappa = W/sqrt(s), where s is
    the rate at which Omega grows, and W the length of the transverse angular velocity.
    """

    def __init__(self, kappa: Fraction) -> None:
        self._kappa = self._fixed(kappa)
        half = Fraction(1, 2 * PIECES)
        spinor = self._sum(self._coefficients((1 << FIXED, 0, 0, 0), Fraction(0)), half)
        self._series: list[list[_Spinor]] = []
        for piece in range(int(NEAR) * PIECES):
            self._series.append(self._coefficients(spinor, (2 * piece + 1) * half))
            spinor = self._sum(self._series[-1], 2 * half)

    @staticmethod
    def _fixed(value: Fraction) -> int:
        return (value.numerator << FIXED) // value.denominator

    def _coefficients(self, spinor: _Spinor, place: Fraction) -> list[_Spinor]:
        """Return the coefficients of the Taylor series of the attitude about the scaled time x = ``place``.

        ``spinor`` is the attitude at x = ``place``, as integers q0, q3, q1, q2 in units of 2^-FIXED; the coefficients,
        from the power 0 on, are of the same kind. The denominator of ``place`` must be a power of two.
        """
        top, shift, kappa = place.numerator, place.denominator.bit_length() - 1, self._kappa
        coefficients: list[_Spinor] = [spinor]
        before: _Spinor = (0, 0, 0, 0)
        for n in range(1, _TERMS):
            q0, q3, q1, q2 = now = coefficients[-1]
            p0, p3, p1, p2 = before
            coefficients.append(
                (
                    (-(q3 * top >> shift) - p3 - (kappa * q1 >> FIXED)) // (2 * n),
                    ((q0 * top >> shift) + p0 - (kappa * q2 >> FIXED)) // (2 * n),
                    ((q2 * top >> shift) + p2 + (kappa * q0 >> FIXED)) // (2 * n),
                    (-(q1 * top >> shift) - p1 + (kappa * q3 >> FIXED)) // (2 * n),
                )
            )
            before = now
        return coefficients

    def _sum(self, series: list[_Spinor], step: Fraction) -> _Spinor:
        x, total = self._fixed(step), [0, 0, 0, 0]
        for term in reversed(series):
            total = [(value * x >> FIXED) + more for value, more in zip(total, term, strict=True)]
        return total[0], total[1], total[2], total[3]

    def quaternion(self, x: Fraction) -> Quaternion:
        """Return the attitude at the scaled time x, relative to resonance (x = 0), with an error below 1e-30.

        The components of the quaternion are integers in units of 2^-FIXED.
        """
        piece = min(int(abs(x) * PIECES), len(self._series) - 1)
        q0, q3, q1, q2 = self._sum(self._series[piece], abs(x) - Fraction(2 * piece + 1, 2 * PIECES))
        # at -x, q1 and q2 have the opposite signs
        sign = -1 if x < 0 else 1
        return q0, sign * q1, sign * q2, q3

    def table(self) -> Floats:
        """Return the Taylor coefficients of the attitude as doubles, an array ``table[i, n, k]``.

        i is an interval of the scaled time x, n a power, and k a component q0 to q3.
        """
        # powers of the distance from the middle of the interval
        one = 1 << FIXED
        return np.array(
            [[[q0 / one, q1 / one, q2 / one, q3 / one] for q0, q3, q1, q2 in s[: DEGREE + 1]] for s in self._series]
        )

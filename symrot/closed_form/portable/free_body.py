"""The motion of a free body, computed by mpmath and NumPy without a C compiler.

The formulas are those of :file:`free_body.h`. In this module the number |L|^2 - 2 T I_mid of a motion is called its
defect: L is the angular momentum, T the kinetic energy and I_mid the middle moment of inertia.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from symrot.closed_form.build import Floats
from symrot.closed_form.portable.phases import (
    DIGITS,
    SWITCH,
    TERMS,
    Phase,
    hyperbolic,
    multiples,
    number,
    power_of_two,
    quarter_periods,
    turned_by,
    vector,
)
from symrot.closed_form.portable.quaternions import Axes, mapping, matrix_quaternion, unit
from symrot.formula.precision import digits, mp
from symrot.kinematics.hamilton import conjugate, hamilton

__all__ = ["PortableFreeBody"]

mpf = mp.mpf

NEGLIGIBLE = mpf(10) ** -150  # size, relative to the largest component of omega, that counts as zero


class PortableFreeBody:
    """The motion of a free body, computed with mpmath and NumPy.

    The arguments are those of the C function symrot_free_body_prepare in :file:`free_body.c`, which computes the
    constants of the motion: lists hi, lo, hi, lo, .. of doubles, in which each sum hi + lo is one number.

    Parameters
    ----------
    inertia : list of 6 floats
        Principal moments of inertia, kg m^2.
    omega : list of 6 floats
        Initial angular velocity along the principal axes, rad/s.
    quaternion : list of 8 floats
        Initial attitude, body to space, of any norm except zero.
    exact : list of 8 floats, or None
        I2 - I3, I3 - I1, I1 - I2, and the defect |L|^2 - 2 T I_mid divided by (largest moment times largest component
        of ``omega``)^2; None if the sums in ``inertia`` and ``omega`` are exact.
    axes : list of 26 floats, or None
        The matrix, row by row, that converts components along the principal axes to components along the body axes, and
        its unit quaternion; None if the body axes are principal axes.

    Raises
    ------
    ValueError
        If a moment is not positive, if the quaternion is zero, or if the rotation is about the middle axis except for
        components of ``omega`` that are not zero but below 1e-150 of the largest: such a rotation is unstable.
    """

    @digits(DIGITS)
    def __init__(
        self, inertia: list[float], omega: list[float], quaternion: list[float], exact: list[float] | None,
        axes: list[float] | None,
    ) -> None:  # fmt: skip
        moments, w = vector(inertia), vector(omega)
        if min(moments) <= 0 or not any(vector(quaternion)):
            raise ValueError("expected positive moments of inertia and a quaternion that is not zero")
        fastest = max(abs(x) for x in w)
        self.scale = power_of_two(fastest)
        w = [mpf(0) if abs(x) < NEGLIGIBLE * self.scale else x / self.scale for x in w]
        frame = Axes(axes)
        start = hamilton(unit(vector(quaternion)), frame.quaternion)
        if exact is None:
            differences, defect = _differences(inertia, omega, w)
            defect /= self.scale**2
        else:
            differences = vector(exact[:6])
            defect = number(exact[6], exact[7]) * (max(moments) * fastest / self.scale) ** 2
        if not any(differences[i] and w[i - 2] and w[i - 1] for i in range(3)):
            for i, rate in enumerate(w):  # rotation about the middle axis is unstable
                middle = differences[i - 2] * differences[i - 1] > 0
                if middle and rate and sum(x != 0 for x in vector(omega)) > 1:
                    raise ValueError(
                        "expected omega exactly along the middle axis, or with another component above 1e-150 of the "
                        f"largest, got {[float(x) for x in vector(omega)]}"
                    )
            self._steady(w, start, frame)
            return
        self._elliptic(moments, w, differences, defect, start, frame)

    def _steady(self, w: list[Any], start: Sequence[Any], frame: Axes) -> None:
        self.regime = "steady"
        speed = mp.sqrt(sum(x * x for x in w))
        axis = [mpf(0), *(x / speed if speed else mpf(0) for x in w)]
        back = conjugate(frame.quaternion)
        zero = [mpf(0)] * 4
        self.attitude = mapping([hamilton(start, back), hamilton(hamilton(start, axis), back), zero, zero])
        self.omega = np.array(
            [[float(sum(m * x for m, x in zip(row, w, strict=True)) * self.scale)] for row in frame.matrix]
        )
        self.turning = Phase.of(speed / (4 * mp.pi))

    def _elliptic(
        self, moments: list[Any], w: list[Any], differences: list[Any], defect: Any, start: Sequence[Any], frame: Axes
    ) -> None:
        axis, direction, s = _canonical(moments, w, differences, defect)
        inertia = [moments[k] for k in axis]
        momenta = [inertia[k] * w[axis[k]] * direction[k] for k in range(3)]
        i32, i31, i21 = (abs(differences[k]) for k in axis)
        squares = [x * x for x in momenta]
        a1 = squares[0] + squares[1] * inertia[0] * i32 / (inertia[1] * i31)
        a2 = squares[1] + squares[0] * inertia[1] * i31 / (inertia[0] * i32)
        a3 = squares[2] + squares[1] * inertia[2] * i21 / (inertia[1] * i31)
        amplitudes = [mp.sqrt(x) for x in (a1, a2, a3)]
        total = mp.sqrt(sum(squares))
        energy = sum(x * x / i for x, i in zip(momenta, inertia, strict=True))  # twice the kinetic energy
        share = inertia[2] / (i32 * a3)
        m, complement = i21 * a1 * share / inertia[0], abs(defect) * share
        rate = amplitudes[2] / inertia[2] * mp.sqrt(i32 * i31 / (inertia[0] * inertia[1]))
        u = s * momenta[1] / amplitudes[1] * mp.elliprf(squares[0] / a1, squares[2] / a3, 1)
        k, k_prime = quarter_periods(m, complement)
        eta = amplitudes[2] / total * mp.elliprf(a1 / total**2, (a1 + m * a3) / total**2, 1)
        turning = (energy + total * amplitudes[2] / inertia[2]) / (total + amplitudes[2]) / 2  # psi/2 at u = 0
        series = self._circular if m < SWITCH else self._hyperbolic
        kappa, n_start, lead = series(m, k, k_prime, eta, s, rate, u, turning)
        self.turning = Phase.of(kappa / (2 * mp.pi))

        level = n_start * mp.expjpi(2 * lead)
        p = [total + momenta[2], momenta[1], -momenta[0]]
        x = [
            level.real * p[0],
            level.real * p[1] - level.imag * p[2],
            level.real * p[2] + level.imag * p[1],
            level.imag * p[0],
        ]
        rows = [[direction[k] if axis[k] == j else 0 for j in range(3)] for k in range(3)]
        renaming = matrix_quaternion(rows)
        left = hamilton(start, conjugate(hamilton(unit(x), renaming)))
        right = hamilton(renaming, conjugate(frame.quaternion))
        basis = [[mpf(int(i == j)) for j in range(4)] for i in range(4)]
        self.attitude = mapping([hamilton(hamilton(left, e), right) for e in basis])
        signs = (1, s, 1)
        self.momentum = [float(signs[i] * amplitudes[i] / total) for i in range(3)]
        rates = [signs[i] * direction[i] * amplitudes[i] / inertia[i] * self.scale for i in range(3)]
        self.omega = mapping([[frame.matrix[i][axis[n]] * rates[n] for i in range(3)] for n in range(3)])

    def _circular(self, m: Any, k: Any, k_prime: Any, eta: Any, s: int, rate: Any, u: Any, turning: Any) -> Any:
        self.regime = "circular"
        per = mp.pi / k
        q = mp.exp(-per * k_prime) if m else mpf(0)
        self.nome = float(q)
        theta2 = sum(q ** (n * (n + 1)) for n in range(TERMS))
        theta3, theta4 = (1 + 2 * sum(sign**n * q ** (n * n) for n in range(1, TERMS)) for sign in (1, -1))
        self.sizes = [float(theta4 / theta2), float(theta3 / theta2), float(theta4 / theta3)]
        growing = [q ** (2 * n * n + n) * mp.exp(n * per * eta) if q else mpf(0) for n in range(TERMS)]
        shrinking = [q ** (2 * n * n - n) * mp.exp(-n * per * eta) if q or n < 1 else mpf(0) for n in range(TERMS)]
        cosines = [mpf(1), *((-1) ** n * (shrinking[n] + growing[n]) for n in range(1, TERMS))]
        sines = [mpf(0), *((-1) ** n * s * (shrinking[n] - growing[n]) for n in range(1, TERMS))]
        self.even, self.odd = ([float(x) for x in terms] for terms in (cosines, sines))
        z = mp.pi * u / (2 * k)
        start = mp.mpc(
            sum(c * mp.cos(2 * n * z) for n, c in enumerate(cosines)),
            sum(c * mp.sin(2 * n * z) for n, c in enumerate(sines)),
        )
        self.axial, self.slope = Phase.of(rate / k / 4, u / k / 4), 0.0
        drift = sum(2 * n * c for n, c in enumerate(sines)) / sum(cosines)
        return turning - rate * per / 2 * drift, start, mpf(0)

    def _hyperbolic(self, m: Any, k: Any, k_prime: Any, eta: Any, s: int, rate: Any, u: Any, turning: Any) -> Any:
        endless = k == mp.inf
        self.regime = "separatrix" if endless else "hyperbolic"
        per = mp.pi / k_prime
        q = mpf(0) if endless else mp.exp(-per * k)
        self.log_nome = -np.inf if endless else float(-per * k)
        theta2 = sum(q ** (n * (n + 1)) for n in range(TERMS))
        theta3, theta4 = (1 + 2 * sum(sign**n * q ** (n * n) for n in range(1, TERMS)) for sign in (1, -1))
        self.sizes = [float(theta2 / theta4), float(theta3 / theta4), float(theta2 / theta3)]
        x = s * mp.pi * (k_prime - eta) / (4 * k_prime)
        real = [mp.cos((2 * n + 1) * x) for n in range(TERMS)]
        imaginary = [-mp.sin((2 * n + 1) * x) for n in range(TERMS)]
        self.even, self.odd = ([float(c) for c in terms] for terms in (real, imaginary))
        weights = [q ** (n * (n + 1) // 2) for n in range(TERMS)]
        v, v_rate = per * u / 2, per * rate / 2
        start = mp.mpc(
            sum(w * c * mp.cosh((2 * n + 1) * v / 2) for n, (w, c) in enumerate(zip(weights, real, strict=True))),
            sum(w * c * mp.sinh((2 * n + 1) * v / 2) for n, (w, c) in enumerate(zip(weights, imaginary, strict=True))),
        )
        level = sum(w * c for w, c in zip(weights, real, strict=True))
        drift = sum(w * c * (n + mpf(1) / 2) for n, (w, c) in enumerate(zip(weights, imaginary, strict=True))) / level
        kappa = turning - v_rate * drift
        self.slope = 0.0
        if endless:
            self.axial = Phase.of(v_rate, v, periodic=False)
            return kappa, start, mpf(0)
        slope = x / mp.pi
        self.slope, self.stretch = float(slope), float(per * k)
        self.axial = Phase.of(rate / k / 4, u / k / 4)
        return kappa - slope * mp.pi / k * rate, start, u / k / 2 * slope

    def evaluate(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        """Write the samples at ``times``, s, into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped.
        """
        t = times * float(self.scale)
        if self.regime == "steady":
            if omega is not None:
                omega[:] = self.omega[:, 0]
            if quaternion is not None:
                sine, cosine = self.turning.circle(t)
                quaternion[:] = np.outer(cosine, self.attitude[:, 0]) + np.outer(sine, self.attitude[:, 1])
            return
        (cn, sn, dn), (re, im), whole = self._sums(t)
        if omega is not None:
            omega[:] = np.stack([cn, sn, dn], axis=1) @ self.omega.T
        if quaternion is not None:
            re, im = turned_by(re, im, *self.turning.circle(t, self.slope * whole))
            p0, p1, p2 = 1.0 + self.momentum[2] * dn, self.momentum[1] * sn, -self.momentum[0] * cn
            x = np.stack([re * p0, re * p1 - im * p2, re * p2 + im * p1, im * p0], axis=1)
            quaternion[:] = (x / np.sqrt(2.0 * p0 * (re * re + im * im))[:, None]) @ self.attitude.T

    def _sums(self, t: Floats) -> tuple[Any, Any, Floats]:
        """Return the tuple ((cn, sn, dn), (re, im), phase), each entry at the times t.

        cn, sn and dn are the elliptic functions. re and im are the real and the imaginary part of a theta series. If
        ``regime`` is "hyperbolic", phase is the argument of the elliptic functions in units of their half period 2K,
        minus the nearest whole number; otherwise it is 0.
        """
        # cn, sn and dn give the angular velocity; re, im and the phase the attitude
        if self.regime == "circular":
            sine, cosine = self.axial.circle(t)
            z = multiples(sine, cosine)
            q = self.nome
            theta1 = sum((-1.0) ** n * q ** (n * (n + 1)) * f for n, (f, _) in enumerate(z[1::2]))
            theta2 = sum(q ** (n * (n + 1)) * f for n, (_, f) in enumerate(z[1::2]))
            theta3 = 1.0 + sum(2.0 * q ** (n * n) * f for n, (_, f) in enumerate(z[2::2], start=1))
            theta4 = 1.0 + sum(2.0 * (-1.0) ** n * q ** (n * n) * f for n, (_, f) in enumerate(z[2::2], start=1))
            functions = (
                self.sizes[0] * theta2 / theta4,
                self.sizes[1] * theta1 / theta4,
                self.sizes[2] * theta3 / theta4,
            )
            re = sum(c * f for c, (_, f) in zip(self.even, z[0::2], strict=False))
            im = sum(c * f for c, (f, _) in zip(self.odd, z[0::2], strict=False))
            return functions, (re, im), np.zeros_like(t)
        whole, flip, v = (
            self.axial.argument_once(t) if self.regime == "separatrix" else self.axial.argument(t, self.stretch)
        )
        pair = partial(hyperbolic, self.log_nome, v=v)
        odd = [pair(n * (n + 1), 2 * n + 1) for n in range(TERMS)]
        even = [pair(n * n, 2 * n) for n in range(1, TERMS)]
        below = sum(c for c, _ in odd)
        cn = self.sizes[0] * (1.0 + sum(2.0 * (-1.0) ** n * c for n, (c, _) in enumerate(even, start=1))) / below
        sn = self.sizes[1] * sum((-1.0) ** n * s for n, (_, s) in enumerate(odd)) / below
        dn = self.sizes[2] * (1.0 + sum(2.0 * c for c, _ in even)) / below
        halves = [pair(n * (n + 1) / 2, n + 0.5) for n in range(TERMS)]
        re = sum(a * c for a, (c, _) in zip(self.even, halves, strict=True))
        im = sum(a * s for a, (_, s) in zip(self.odd, halves, strict=True))
        return (flip * cn, flip * sn, dn), (re, im), whole


def _differences(inertia: list[float], omega: list[float], w: list[Any]) -> tuple[list[Any], Any]:
    """Return (differences, defect): [I2 - I3, I3 - I1, I1 - I2], and |L|^2 - 2 T I_mid, as mpmath numbers.

    ``inertia`` and ``omega`` are the moments and the angular velocity along the principal axes, as lists hi, lo, hi,
    lo, .. of doubles. ``w`` is the same angular velocity in another unit, with zeros for negligible components; these
    components count as zero in the defect too.
    """
    moments = [Fraction(high) + Fraction(low) for high, low in zip(inertia[::2], inertia[1::2], strict=True)]
    rates = [Fraction(high) + Fraction(low) for high, low in zip(omega[::2], omega[1::2], strict=True)]
    middle = sorted(moments)[1]
    # the sum of I (I - I_mid) omega_k^2 without the axes whose tiny component was set to zero in w
    shares = (i * (i - middle) * x * x for i, x, component in zip(moments, rates, w, strict=True) if component)
    differences = [moments[i - 2] - moments[i - 1] for i in range(3)]
    return [_rounded(x) for x in differences], _rounded(sum(shares, Fraction(0)))


def _rounded(x: Fraction) -> Any:
    return mpf(x.numerator) / x.denominator


def _canonical(
    moments: list[Any], w: list[Any], differences: list[Any], defect: Any
) -> tuple[list[int], list[int], int]:
    """Return (axes, signs, sign of I3 - I2) for which the formulas of the motion hold.

    ``axes`` are the indices of the principal axes that :file:`free_body.h` calls e1, e2, e3, so that I2 lies between I1
    and I3. ``signs`` has -1 for each of e1, e2, e3 that points against its principal axis, else 1. ``w`` is the angular
    velocity along the principal axes, ``differences`` are I2 - I3, I3 - I1 and I1 - I2 of the body's own axes 1, 2, 3,
    and ``defect`` is |L|^2 - 2 T I_mid, of which only the sign counts.
    """
    above = [differences[2] >= 0, differences[0] >= 0, differences[1] >= 0]  # I_i >= I_(i+1)
    largest = 0 if above[0] and not above[2] else 1 if above[1] else 2
    a, b = (largest + 1) % 3, (largest + 2) % 3
    smallest = b if above[a] else a
    # I2 must lie between I1 and I3; the sign of the defect tells whether I3 is the largest or the smallest moment
    outer = (largest, smallest) if defect >= 0 else (smallest, largest)
    axis = [outer[1], 3 - largest - smallest, outer[0]]
    direction = [-1 if w[k] < 0 else 1 for k in axis]
    cyclic = 1 if (axis[1] + 1) % 3 == axis[2] else -1  # e2 = e3 x e1
    direction[1] = direction[0] * direction[2] * cyclic
    return axis, direction, 1 if defect >= 0 else -1

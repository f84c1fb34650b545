"""Rotation of the rotating axes of a driven symmetric body between two times far from resonance, in exact arithmetic.

The rotating axes are not fixed in the body: they rotate with the body's transverse angular velocity, whose length is W.
Their own angular velocity is ``(W, 0, Omega)``, with ``Omega = Omega0 + s t`` (see
:mod:`symrot.closed_form.spin_up.motion`). Resonance is at Omega = 0. Far from it, the angular velocity of these axes
stays near a vector n that is fixed in space (see :mod:`symrot.closed_form.spin_up.series`). Between two times the axes
rotate about n by the integral of their angular speed ``S = sqrt(Omega^2 + W^2)``, plus the change of delta. The angle
delta is a small function of Omega. The integral over a time t is, with S0 = S at the start,

    t/(2 D) (E sqrt(1 + z^2) + W^2 asinh(z)/z),  E = S0 S + Omega0 Omega,  D^2 = (W^2 + E)/2,  z = s t/(2 D).

All terms of the sum are positive, so no digits cancel for any s.

Proof: ``derivations/driven_rotation.md``.
"""

from collections.abc import Sequence
from fractions import Fraction

from symrot.closed_form.build import Floats
from symrot.closed_form.spin_up.series import NEAR, Series
from symrot.formula import exact_numbers as number
from symrot.formula.exact_numbers import rounded
from symrot.kinematics.hamilton import conjugate, hamilton

__all__ = ["FIXED", "ONE", "Quaternion", "Sweep", "about_third", "fixed", "product"]

FIXED = 144
"""Number of bits after the binary point in the fixed-point integers that are the components of unit quaternions.

Fixed-point arithmetic is four times as fast as arithmetic with Fractions.
"""

Quaternion = tuple[int, int, int, int]

ONE: Quaternion = (1 << FIXED, 0, 0, 0)

_HALVINGS = 12  # smallest number of halvings of the argument of asinh
_SMALL = Fraction(1, 1 << _HALVINGS)


def fixed(values: Sequence[Fraction]) -> Quaternion:
    """Convert the components of a unit quaternion from fractions to integers in units of 2^-FIXED."""
    q0, q1, q2, q3 = ((x.numerator << FIXED) // x.denominator for x in values)
    return q0, q1, q2, q3


def product(a: Quaternion, *others: Quaternion) -> Quaternion:
    """Return the product of unit quaternions, from left to right; components are integers in units of 2^-FIXED."""
    for b in others:
        q0, q1, q2, q3 = hamilton(a, b)
        a = (q0 >> FIXED, q1 >> FIXED, q2 >> FIXED, q3 >> FIXED)
    return a


def about_third(angle: Fraction) -> Quaternion:
    """Return the unit quaternion of a rotation by an angle, rad, about the third axis."""
    return fixed([number.cos(angle / 2), Fraction(0), Fraction(0), number.sin(angle / 2)])


def _asinh_ratio(z: Fraction) -> Fraction:
    """Return asinh(z)/z with a relative error near 2^-320."""
    # asinh(z) is halved repeatedly until the series of atanh(z/sqrt(1 + z^2)) is short
    if not z:
        return Fraction(1)
    halvings, small = 0, abs(z)
    while small > _SMALL:
        root = number.sqrt(rounded(1 + small * small))
        small = rounded(small / number.sqrt(2 * (1 + root)))
        halvings += 1
    t = rounded(small / number.sqrt(rounded(1 + small * small)))
    square, total = rounded(t * t), Fraction(0)
    for k in range(number.BITS // (2 * _HALVINGS) + 2, -1, -1):
        total = rounded(total * square + Fraction(1, 2 * k + 1))
    return rounded(total * t * (1 << halvings) / abs(z))


def _polynomial(coefficients: Floats, y: float) -> float:
    total: float = 0.0
    for c in reversed(coefficients.tolist()):
        total = total * y + c
    return total


class Sweep:
    """The rotation of the rotating axes of a driven symmetric body far from resonance (Omega = 0).

    ``across`` is W, the constant length of the body's transverse angular velocity, rad/s. The rotating axes rotate with
    the transverse angular velocity; Omega is their rate about the body's axis, and ``s`` is the rate, rad/s^2, at which
    Omega grows. ``series`` gives the axis and the angle of their rotation; it depends on kappa^2 = W^2/s alone.
    """

    def __init__(self, across: Fraction, s: Fraction, series: Series) -> None:
        self.across, self.s, self.series = across, s, series
        self._square = rounded(across * across)
        self.unit = self._square + (0 if series.wide else Fraction(NEAR) ** 2 * s)

    def speed(self, omega: Fraction) -> Fraction:
        """Return S = sqrt(omega^2 + W^2), rad/s, the angular speed of the rotating axes at the axial rate ``omega``."""
        return number.sqrt(rounded(omega * omega + self._square))

    def _direction(self, omega: Fraction) -> tuple[float, float, float]:
        """Return (W/S, omega/S, y) at the axial rate ``omega``, with the angular speed S = sqrt(omega^2 + W^2).

        The rotating axes have the angular velocity (W, 0, omega), so that (W/S, 0, omega/S) is its direction. y is the
        variable of the polynomials in ``self.series``.
        """
        # y = unit/S^2
        speed = self.speed(omega)
        return float(self.across / speed), float(omega / speed), float(rounded(self.unit / (speed * speed)))

    def delta(self, omega: Fraction) -> float:
        """Return the small angle delta, rad, at the axial rate ``omega``.

        The rotating axes rotate with the body's transverse angular velocity. Between two times they rotate, about the
        vector n of :meth:`axes`, by the integral of their angular speed over time plus the change of delta.
        """
        _, cosine, y = self._direction(omega)
        return cosine * _polynomial(self.series.e, y)

    def axes(self, omega: Fraction) -> Quaternion:
        """Return the rotation that maps the third rotating axis to n, at the axial rate ``omega``.

        n is a vector, fixed in space, near the direction of the angular velocity of the rotating axes, which rotate
        about n. The components of n along these axes come from the polynomials in ``self.series``.
        """
        sine, cosine, y = self._direction(omega)
        g, c = _polynomial(self.series.g, y), _polynomial(self.series.c, y)
        m1, m2 = Fraction(sine * cosine * y * y * g), Fraction(sine * y * c)
        m3 = 1 + number.sqrt(1 - m1 * m1 - m2 * m2)
        larger = number.sqrt(rounded((1 + abs(omega) / self.speed(omega)) / 2))
        smaller = rounded(self.across / (2 * larger * self.speed(omega)))
        half = (larger, smaller) if omega >= 0 else (smaller, larger)
        turn = fixed([half[0], Fraction(0), half[1], Fraction(0)])
        return product(turn, fixed(number.unit((m3, -m2, m1, Fraction(0)))))

    def angle(self, start: Fraction, time: Fraction) -> Fraction:
        """Return the angle, rad, by which the rotating axes rotate in ``time`` s about the vector n of :meth:`axes`.

        n is fixed in space, near the direction of the angular velocity. ``start`` is the axial rate, rad/s, at the
        beginning of this time.
        """
        omega = start + self.s * time
        here, there, product = self.speed(omega), self.speed(start), rounded(omega * start)
        if product >= 0:
            together = here * there + product
        else:
            together = self._square * (self._square + omega * omega + start * start) / (here * there - product)
        middle = number.sqrt(rounded((self._square + together) / 2))
        half = rounded(time / (2 * middle))
        z = rounded(self.s * half)
        steady = half * (number.sqrt(rounded(1 + z * z)) * together + self._square * _asinh_ratio(z))
        return rounded(steady) + Fraction(self.delta(omega)) - Fraction(self.delta(start))

    def rotation(self, start: Fraction, time: Fraction) -> Quaternion:
        """Return the rotation of the rotating axes in ``time`` s, as a quaternion of integers in units of 2^-FIXED.

        ``start`` is the axial rate, rad/s, at the beginning of this time.
        """
        end = conjugate(self.axes(start + self.s * time))
        return product(self.axes(start), about_third(self.angle(start, time)), end)

"""Motion of a free rigid body at any time in closed form, for spherical, symmetric and asymmetric bodies.

Each sample takes the same time and has an error of a few 1e-16, however far from the start it lies. The formulas are in
:file:`free_body.c`. The defect of a motion is |L|^2 - 2 T I_mid (angular momentum L, kinetic energy T, middle moment
I_mid); its sign tells around which axis the motion goes.

Source: Whittaker, Analytical Dynamics, 4th ed., section 69; van Zon & Schofield, J. Comput. Phys. 225 (2007) 145.

Proof: ``derivations/free_body_attitude.md``, ``derivations/free_body_separatrix.md``.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

from symrot.closed_form.arithmetic.frames import quaternion_of
from symrot.closed_form.arithmetic.pairs import (
    SMALLEST,
    Number,
    attitude,
    flatten_pairs,
    numbers,
    over_common_denominator,
    quotient,
)
from symrot.closed_form.motion import ExactMotion, prepared
from symrot.formula.exact_numbers import NEGLIGIBLE_BITS
from symrot.inertia.principal import Principal
from symrot.scene.tables import Initial

__all__ = ["Defect", "FreeRigidBody", "gaps", "motion", "starts"]


def motion(
    inertia: Sequence[Number], omega0: Sequence[Number], quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0)
) -> ExactMotion:
    """Return the motion of a free body from its initial state.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments, kg m^2, positive, in any order. Fractions, ints and floats are taken at their exact values.
    omega0 : 3 numbers
        Angular velocity along the principal axes, rad/s. Components below 1e-150 of the largest count as zero.
    quaternion0 : 4 numbers
        Attitude, body to space, scalar first; it is normalised.

    Raises
    ------
    InputError
        If a number is outside its domain, such as a moment that is not positive.

    Examples
    --------
    >>> omega, _ = motion((1, 1, 2), (0, 0, 1)).evaluate([0.0], quaternion=False)
    >>> omega.tolist()
    [[0.0, 0.0, 1.0]]
    """
    moments, rates = numbers("inertia", inertia, 3, SMALLEST), numbers("omega", omega0, 3)
    start = attitude(numbers("quaternion", quaternion0, 4))
    exact = None if all(isinstance(x, float) for x in (*moments, *rates)) else _differences(moments, rates)
    return _prepared(flatten_pairs(moments), flatten_pairs(rates), start, exact, None)


def starts(principal: Principal) -> Callable[[Initial], ExactMotion]:
    """Return a function from an initial state to the motion of the free body with the principal axes ``principal``."""
    # from principal moments and axes to 110 digits, before anything is rounded to doubles
    body = FreeRigidBody(principal)
    return lambda start: body.motion(start.omega_b, start.quaternion)


class FreeRigidBody:
    """A free body with the constants that all its motions share: moments, their differences, and principal axes."""

    def __init__(self, body: Principal) -> None:
        integers, shared = over_common_denominator(body.moments)
        self.moments, self.gaps, self.defect = flatten_pairs(body.moments), gaps(integers, shared), Defect(integers)
        entries = [x for row in body.axes for x in row]
        self._axes, self._unit = over_common_denominator(entries)
        self._rates: tuple[Sequence[Number], list[float], list[float]] = (
            (),
            [],
            [],
        )  # constants of the previous motion, which the next motion may reuse
        self._attitude: tuple[Sequence[Number], list[float]] = (), []
        self.axes = None if body.given_axes else flatten_pairs([*entries, *quaternion_of(body.axes)])
        self._principal = body

    @cached_property
    def fixed(self) -> Any:
        """Principal moments and axes as integers for C; see :func:`symrot.closed_form.free_body.bodies.fixed_body`."""
        from symrot.closed_form.free_body.bodies import fixed_body

        return fixed_body(self._principal.moments, [x for row in self._principal.axes for x in row])

    def along(self, omega0: Sequence[Number]) -> tuple[list[int], int]:
        """Return an angular velocity along the principal axes as three integers and their common denominator.

        Components that are negligible relative to the largest one are zero.
        """
        rates, shared = over_common_denominator(omega0)
        x, y, z = rates
        largest = max(abs(x), abs(y), abs(z))
        if self.axes is not None:
            xx, xy, xz, yx, yy, yz, zx, zy, zz = self._axes
            rates = [xx * x + yx * y + zx * z, xy * x + yy * y + zy * z, xz * x + yz * y + zz * z]
            largest, shared = largest * self._unit, shared * self._unit
        if largest.bit_length() <= NEGLIGIBLE_BITS:  # even the integer 1 is not negligible
            return rates, shared
        return [0 if abs(x) << NEGLIGIBLE_BITS < largest else x for x in rates], shared

    def motion(self, omega0: Sequence[Number], quaternion0: Sequence[Number]) -> ExactMotion:
        """Return the motion from an initial state: ``omega0``, rad/s, and ``quaternion0``, body to space.

        Both refer to the body axes, to which the inertia tensor refers; these need not be principal axes.
        """
        omega_before, omega, exact = self._rates
        if omega0 is not omega_before:
            rates, shared = self.along(numbers("omega", omega0, 3))
            omega = [part for x in rates for part in quotient(x, shared)]
            exact = [*self.gaps, *self.defect(rates)]
            self._rates = omega0, omega, exact
        attitude0, start = self._attitude
        if quaternion0 is not attitude0:
            start = attitude(numbers("quaternion", quaternion0, 4))
            self._attitude = quaternion0, start
        return _prepared(self.moments, omega, start, exact, self.axes)


def _differences(moments: Sequence[Number], omega: Sequence[Number]) -> list[float]:
    """Return I2 - I3, I3 - I1, I1 - I2 of a free body and |L|^2 - 2 T I_mid of its motion as a list hi, lo, hi, lo, ..

    |L|^2 - 2 T I_mid, the last pair, is divided by (largest moment times largest rate)^2 (see :class:`Defect`).
    """
    # exactly, since differences of doubles would lose digits
    integers, shared = over_common_denominator(moments)
    return [*gaps(integers, shared), *Defect(integers)(over_common_denominator(omega)[0])]


def gaps(i: list[int], shared: int) -> list[float]:
    """Return I2 - I3, I3 - I1, I1 - I2 of the principal moments ``i[k]/shared`` as one list hi, lo, hi, lo, ..

    Differences that are negligible relative to the moments are zero.
    """
    differences: list[float] = []
    for k in range(3):
        difference = i[(k + 1) % 3] - i[(k + 2) % 3]
        if abs(difference) << NEGLIGIBLE_BITS < max(i[(k + 1) % 3], i[(k + 2) % 3]):
            difference = 0
        differences += quotient(difference, shared)
    return differences


class Defect:
    """A function from the rates of one free body to |L|^2 - 2 T I_mid over (largest moment times largest rate)^2.

    L is the angular momentum, T the kinetic energy, I_mid the middle moment. The moments are given as integers in any
    common unit, since the result does not depend on units.
    """

    def __init__(self, i: list[int]) -> None:
        middle = sorted(i)[1]
        self._one, self._two, self._three = [moment * (moment - middle) for moment in i]
        self._largest = max(i)

    def __call__(self, w: list[int]) -> tuple[float, float]:
        """Return |L|^2 - 2 T I_mid over (largest moment times largest rate)^2 as two doubles (hi, lo).

        ``w`` are the rates about the principal axes, as integers in any common unit. A result that is negligible
        relative to the summands of |L|^2 - 2 T I_mid is returned as zero.
        """
        x, y, z = w
        one, two, three = self._one * x * x, self._two * y * y, self._three * z * z
        defect, largest = one + two + three, self._largest * max(abs(x), abs(y), abs(z))
        if not defect:
            return 0.0, 0.0
        widest = max(one.bit_length(), two.bit_length(), three.bit_length())
        if defect.bit_length() + NEGLIGIBLE_BITS < widest + 2 and abs(defect) << NEGLIGIBLE_BITS < max(
            abs(one), abs(two), abs(three)
        ):
            return 0.0, 0.0
        return quotient(defect, largest * largest)


def _prepared(
    moments: list[float], omega: list[float], start: list[float], exact: list[float] | None, axes: list[float] | None
) -> ExactMotion:
    return prepared(
        "free_body",
        (moments, omega, start, exact, axes),
        lambda: (
            "free body: expected three positive moments of inertia in kg m^2, a finite angular velocity in rad/s "
            "(about the middle axis exactly, or with another component above 1e-150 of the largest) and a quaternion "
            f"that is not zero, got moments {moments[::2]}, omega {omega[::2]}, quaternion {start[::2]}"
        ),
    )

"""Constants of many free bodies, computed in one call of a C function (:file:`bodies_at.c`).

Each constant is a pair of doubles (hi, lo), whose sum approximates it to 31 digits. A body is called doubtful if 248
bits do not determine how to round one of its constants; the caller then computes them with fractions. The scaled defect
of a motion is |L|^2 - 2 T I_mid (angular momentum L, kinetic energy T, middle moment of inertia I_mid) over (largest
moment times largest component of the angular velocity)^2.
"""

from collections.abc import Sequence
from ctypes import Structure, addressof, c_int32, c_ssize_t, c_void_p
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build.address import address
from symrot.closed_form.arithmetic.pairs import LARGEST, SMALLEST
from symrot.closed_form.build import Floats, load

__all__ = ["PrincipalBodies", "defects", "fixed_body", "principal_bodies", "rates_of_body"]

Doubtful = NDArray[np.intp]
Column = Floats | Fraction

FRACTION = 248  # bits after the binary point
_TERMS = 5  # doubles whose sum represents a fraction to 2^-265


class _Tensors(Structure):
    """The C struct ``tensors`` of bodies_at.c: the inertia tensors of n bodies, for :func:`principal_bodies`."""

    _fields_ = (
        ("entries", c_void_p * 6), ("strides", c_ssize_t * 6), ("terms", c_ssize_t), ("exact", c_int32 * 6)
    )  # fmt: skip


@cache
def _functions() -> tuple[Any, Any, Any]:
    (library,) = load("bodies")
    names = ("symrot_rates_of_body", "symrot_defects", "symrot_principal_bodies")
    arguments = (
        (c_ssize_t, *[c_void_p] * 5), (c_ssize_t, *[c_void_p] * 4), (c_ssize_t, *[c_void_p] * 7)
    )  # fmt: skip
    functions = [getattr(library, name) for name in names]
    for function, types in zip(functions, arguments, strict=True):
        function.argtypes, function.restype = types, None
    rates, defect, principal = functions
    return rates, defect, principal


def fixed_body(moments: Sequence[Fraction], axes: Sequence[Fraction]) -> NDArray[np.uint64]:
    """Return the principal moments and axes of one body as integers for C, in units of 2^-248.

    Each of the 12 integers is four 64-bit words, the lowest first; the result has shape (48,). The moments are first
    divided by the power of two that makes the largest one at least 1/2 and below 1.
    """
    largest = max(moments)
    length = largest.numerator.bit_length() - largest.denominator.bit_length()  # the power of two, or one more
    if largest >= Fraction(2) ** length:
        length += 1
    scaled = [moment / Fraction(2) ** length for moment in moments]
    units = [int(x * 2**FRACTION).to_bytes(32, "little", signed=True) for x in (*scaled, *axes)]
    return np.frombuffer(b"".join(units), dtype="<u8").astype(np.uint64)


def rates_of_body(body: NDArray[np.uint64], omega: Floats) -> tuple[Floats, Floats, Doubtful]:
    """Return (rates, defects, doubtful) of the motions of one body from n angular velocities ``omega``, shape (n, 3).

    ``omega`` is in rad/s, body components. ``rates``, shape (n, 6), are the components along the principal axes: hi, lo
    of the first, then of the others. ``defects``, shape (n, 2), are hi and lo of |L|^2 - 2 T I_mid over (largest moment
    times largest rate)^2. ``doubtful`` are the indices of the motions for which the last digit of a number is
    uncertain. ``body`` comes from :func:`fixed_body`.
    """
    n = len(omega)
    rates, exact, doubtful = np.empty((n, 6)), np.empty((n, 8)), np.empty(n, np.uint8)
    omega = np.ascontiguousarray(omega)
    _functions()[0](n, body.ctypes.data, address(omega), address(rates), address(exact), doubtful.ctypes.data)
    # the caller must compute doubtful motions exactly
    return rates, exact[:, 6:], np.flatnonzero(doubtful)


def defects(moments: Floats, omega: Floats) -> tuple[Floats, Doubtful]:
    """Return (defects, doubtful) of n free bodies, from their principal moments and their rates about these axes.

    ``defects``, shape (n, 2), are hi and lo of |L|^2 - 2 T I_mid over (largest moment times largest rate)^2.
    ``doubtful`` are the indices of the bodies for which the last digit of this number is uncertain.
    """
    n = len(omega)
    exact, doubtful = np.empty((n, 8)), np.empty(n, np.uint8)
    moments, omega = np.ascontiguousarray(moments), np.ascontiguousarray(omega)
    _functions()[1](n, address(moments), address(omega), address(exact), doubtful.ctypes.data)
    return exact[:, 6:], np.flatnonzero(doubtful)


class PrincipalBodies(NamedTuple):
    """Constants of n free bodies, arguments of the C function symrot_free_body_prepare, each number as hi and lo.

    ``doubtful`` are the indices of the bodies for which the last digit of a constant is uncertain.
    """

    moments: Floats  # (n, 6): principal moments
    rates: Floats  # (n, 6): components of omega along the principal axes
    exact: Floats  # (n, 8): differences of the moments, and the scaled defect
    axes: Floats  # (n, 26): matrix and quaternion of the principal axes
    doubtful: Doubtful


def principal_bodies(entries: Sequence[Column], omega: Floats) -> PrincipalBodies | None:
    """Return the constants of n free bodies, whose principal axes are computed from their inertia tensors.

    ``entries`` are the tensor components xx, yy, zz, xy, xz and yz, kg m^2; a Fraction holds for all bodies. ``omega``,
    shape (n, 3), rad/s, has the components of the angular velocities along the axes of these tensors; ``rates`` and
    ``exact`` of the result depend on it. The result is None if a Fraction is nonzero and not between SMALLEST and
    LARGEST in absolute value.
    """
    n, tensors, arrays = len(omega), _Tensors(terms=_TERMS), []
    for k, entry in enumerate(entries):
        if isinstance(entry, Fraction):
            if entry and not SMALLEST <= abs(entry) <= LARGEST:
                return None  # no sum of doubles represents it
            values, tensors.exact[k] = _sum_of_doubles(entry)
        else:
            values, tensors.exact[k], tensors.strides[k] = np.ascontiguousarray(entry), 1, 1
        arrays.append(values)
        tensors.entries[k] = address(values)
    room = [np.empty((n, length)) for length in (6, 6, 8, 26)]
    omega, doubtful = np.ascontiguousarray(omega), np.empty(n, np.uint8)
    places = [address(values) for values in room]
    _functions()[2](n, addressof(tensors), address(omega), *places, doubtful.ctypes.data)
    moments, rates, exact, axes = room
    return PrincipalBodies(moments, rates, exact, axes, np.flatnonzero(doubtful))


def _sum_of_doubles(value: Fraction) -> tuple[Floats, bool]:
    """Return a few doubles whose sum approximates a fraction, and whether the sum is exact: 1/2 gives 0.5 and True."""
    terms = np.zeros(_TERMS)
    for k in range(_TERMS):
        terms[k] = float(value)
        value -= Fraction(float(value))
    return terms, value == 0

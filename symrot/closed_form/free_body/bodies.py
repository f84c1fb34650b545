"""Constants of many free bodies, computed in one call of a C function (:file:`bodies_at.c`).

Each constant is a pair of doubles (hi, lo), both correctly rounded, whose sum approximates the exact value to 31
digits. If 248 bits do not determine how to round a constant, its body is reported as doubtful, and the caller computes
the constant with fractions. The defect of a motion is |L|^2 - 2 T I_mid, with the angular momentum L, the kinetic
energy T and the middle moment of inertia I_mid; its sign tells whether the motion goes around the axis of the smallest
or of the largest moment of inertia.
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
    """Return the principal moments and the principal axes of one body as integers for C, in units of 2^-248.

    The moments are scaled by a power of two so that the largest moment lies between 1/2 and 1.
    """
    largest = max(moments)
    length = largest.numerator.bit_length() - largest.denominator.bit_length()  # the power of two, or one more
    if largest >= Fraction(2) ** length:
        length += 1
    scaled = [moment / Fraction(2) ** length for moment in moments]
    units = [int(x * 2**FRACTION).to_bytes(32, "little", signed=True) for x in (*scaled, *axes)]
    return np.frombuffer(b"".join(units), dtype="<u8").astype(np.uint64)


def rates_of_body(body: NDArray[np.uint64], omega: Floats) -> tuple[Floats, Floats, Doubtful]:
    """Return n angular velocities along a body's principal axes, the defects of the motions, and the doubtful rows.

    The angular velocities have the shape (n, 6), the defects |L|^2 - 2 T I_mid the shape (n, 2): hi and lo of each
    number. A row whose last digit is not certain is doubtful: its index is in the third result, and the caller must
    compute it exactly. ``omega`` holds the angular velocities in the body, shape (n, 3); ``body`` is a result of
    :func:`fixed_body`.
    """
    n = len(omega)
    rates, exact, doubtful = np.empty((n, 6)), np.empty((n, 8)), np.empty(n, np.uint8)
    omega = np.ascontiguousarray(omega)
    _functions()[0](n, body.ctypes.data, address(omega), address(rates), address(exact), doubtful.ctypes.data)
    return rates, exact[:, 6:], np.flatnonzero(doubtful)


def defects(moments: Floats, omega: Floats) -> tuple[Floats, Doubtful]:
    """Return the defects |L|^2 - 2 T I_mid of free bodies, and the indices of the doubtful rows.

    The defects have the shape (n, 2): the doubles hi and lo, whose sum is the defect. A row is doubtful if the last
    digit of lo is not certain; the caller must compute it exactly. ``moments`` are principal moments and ``omega``
    angular velocities along the principal axes, both of shape (n, 3).
    """
    n = len(omega)
    exact, doubtful = np.empty((n, 8)), np.empty(n, np.uint8)
    moments, omega = np.ascontiguousarray(moments), np.ascontiguousarray(omega)
    _functions()[1](n, address(moments), address(omega), address(exact), doubtful.ctypes.data)
    return exact[:, 6:], np.flatnonzero(doubtful)


class PrincipalBodies(NamedTuple):
    """Arguments of the C function symrot_free_body_prepare for many bodies, and the indices of doubtful bodies.

    Of a doubtful body, the last digit of a constant is not certain, so that the caller must compute it exactly.
    """

    moments: Floats  # (n, 6)
    rates: Floats  # (n, 6)
    exact: Floats  # (n, 8)
    axes: Floats  # (n, 26)
    doubtful: Doubtful


def principal_bodies(entries: Sequence[Column], omega: Floats) -> PrincipalBodies | None:
    """Return the constants of free bodies, with principal axes computed from inertia tensors, for a batch.

    ``entries`` are the components xx, yy, zz, xy, xz and yz, kg m^2: arrays with one value per body, or one Fraction
    for all bodies. ``omega`` are the angular velocities in the given axes, shape (n, 3). Return None if such a Fraction
    is too large or too small to be a sum of doubles.
    """
    n, tensors, arrays = len(omega), _Tensors(terms=_TERMS), []
    for k, entry in enumerate(entries):
        if isinstance(entry, Fraction):
            if entry and not SMALLEST <= abs(entry) <= LARGEST:
                return None
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
    """Return a few doubles whose sum approximates a fraction, and whether their sum equals the fraction exactly.

    C computes with such sums and must know whether they are exact.
    """
    terms = np.zeros(_TERMS)
    for k in range(_TERMS):
        terms[k] = float(value)
        value -= Fraction(float(value))
    return terms, value == 0

"""Driven symmetric bodies by compiled code: constants (:file:`spin_up.c`) and samples (:file:`spin_up_at.c`)."""

import ctypes
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from symrot.build.address import address
from symrot.closed_form.build import Floats, load
from symrot.closed_form.spin_up import series as spin_up_series
from symrot.closed_form.spin_up.resonance import DEGREE, PIECES
from symrot.errors import CompilerError

__all__ = ["TABLE", "Compiled", "functions", "limits"]

TABLE = int(spin_up_series.NEAR) * PIECES * (DEGREE + 1) * 4
"""Number of doubles in a motion's table of Taylor polynomials, for attitudes near resonance (axial rate Omega = 0)."""

_LACKING, _LOST = 1, 2  # status of samples that could not be computed, see spin_up.h


class _Functions(NamedTuple):
    prepare: Any
    evaluate: Any
    record: Any
    numbers: Any
    limits: Any


def limits() -> tuple[float, float, float]:
    """Return (NEAR, WIDE, MOST) of :mod:`symrot.closed_form.spin_up.series`, as arguments for C.

    The asymptotic series of the attitude are accurate if the scaled time Omega/sqrt(s) is at least NEAR in absolute
    value, or if kappa = W/sqrt(s) is at least WIDE (see there). MOST is the largest angle of rotation, rad, that is
    computed with double-double numbers.
    """
    return spin_up_series.NEAR, spin_up_series.WIDE, spin_up_series.MOST


@cache
def functions() -> _Functions:
    """Return the compiled functions of :file:`spin_up.c` and :file:`spin_up_at.c`, and ctypes types of their arguments.

    Raises
    ------
    CompilerError
        If there is no C compiler, or it rejects the source.
    """
    constants, samples = load("spin_up")
    prepare, length = constants.symrot_spin_up_prepare, constants.symrot_spin_up_length
    evaluate, pointer, size = samples.symrot_spin_up_at, ctypes.c_void_p, ctypes.c_ssize_t
    length.restype, prepare.restype, evaluate.restype = size, ctypes.c_int, ctypes.c_int
    prepare.argtypes = (ctypes.c_int, pointer, pointer, pointer, pointer)
    evaluate.argtypes = (pointer, pointer, size, pointer, pointer, pointer)
    double = ctypes.c_double
    return _Functions(prepare, evaluate, double * length(), double * 20, double * 3)


class Compiled:
    """The constants of one motion, computed by C, and the compiled loop over its samples.

    Parameters
    ----------
    axis : 0, 1 or 2
        Index of the body axis about which the torque acts.
    numbers : 20 floats
        Two moments (normal to the axis, about it), the torque, the angular velocity and the quaternion at the start,
        each number as hi and lo: the arguments of the C function ``symrot_spin_up_prepare``.

    Attributes
    ----------
    longest : float
        The time, s, beyond which the number of revolutions may be too large for double-double numbers. Samples at later
        times must be computed in integers (:mod:`symrot.closed_form.spin_up.integers`).

    Raises
    ------
    CompilerError
        If the C compiler rejects the source, or does not round after every operation but fuses some, such as a*b + c.
    """

    def __init__(self, axis: int, numbers: list[float]) -> None:
        self._axis, self._numbers = axis, functions().numbers(*numbers)
        self._evaluate = functions().evaluate
        self._known = constants, _, _ = self._prepared(None)
        self.longest: float = constants[1] / constants[0]

    def _prepared(self, table: Floats | None) -> tuple[Any, int, Floats | None]:
        """Compute the motion's constants in C, and return (constants as a ctypes array, address of the array, table).

        ``table`` is the argument: None, or an array of ``TABLE`` doubles, which C fills with the Taylor polynomials for
        samples near resonance (axial rate Omega = 0).
        """
        bound = functions()
        constants = bound.record()
        place = ctypes.addressof(constants)
        if bound.prepare(self._axis, self._numbers, bound.limits(*limits()), address(table), place):
            raise CompilerError(
                "expected a C compiler that rounds after every operation, got one that fuses some, such as a*b + c; "
                "set CC to another compiler"
            )
        return constants, place, table

    def fill(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> bool:
        """Write the samples at ``times``, s, into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped. Return whether some times exceed :attr:`longest`; the samples at these times
        are not valid.
        """
        samples = len(times), address(times), address(omega), address(quaternion)
        _, place, table = self._known
        status: int = self._evaluate(place, address(table), *samples)
        if status & _LACKING:
            self._known = _, place, table = self._prepared(np.empty(TABLE))
            status = self._evaluate(place, address(table), *samples)
        return bool(status & _LOST)

"""The base class of motions in closed form: angular velocity and attitude at any time."""

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cache
from math import isnan
from struct import Struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot.build.address import address
from symrot.closed_form.build import Floats, available, load, times_of
from symrot.errors import CompilerError, InputError

__all__ = ["REGIMES", "ExactMotion", "functions", "prepared"]

REGIMES = ("steady", "circular", "hyperbolic", "separatrix")
"""The four kinds of functions by which a motion is computed, in this order.

Elementary functions; theta series; transformed theta series, which converge faster for large moduli; functions on the
separatrix.
"""

_DOMAIN, _IN_DOUBT = 1, 3


class ExactMotion(ABC):
    """One body's motion from one initial state, computed by a closed form at any time."""

    regime: str
    """How the motion is computed, an entry of :data:`REGIMES`; for instance, "circular" means by theta series."""

    @abstractmethod
    def _fill(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None: ...

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity and attitude at any times, in any order.

        Parameters
        ----------
        t : number or sequence of n numbers
            Times from the initial state, s, in any order; negative times are allowed.
        omega, quaternion : bool
            Whether to compute the angular velocity and the attitude; a result that is not computed is None.

        Returns
        -------
        omega : array, shape (n, 3), or None
            Angular velocity, rad/s, body components.
        quaternion : array, shape (n, 4), or None
            Attitude as unit quaternions, body to space, scalar first, continuous in time.

        Raises
        ------
        InputError
            If a time is not finite, if a product of a rate and a time exceeds the range of doubles, or if a motion with
            theta functions makes more than 7e16 revolutions: 31 digits of its frequencies then do not give its phase.
        """
        times = times_of(t)
        rates = np.empty((len(times), 3)) if omega else None
        attitudes = np.empty((len(times), 4)) if quaternion else None
        self._fill(times, rates, attitudes)
        samples = rates if attitudes is None else attitudes
        if samples is not None and _has_nan(samples):
            low, high = float(times.min()), float(times.max())
            raise InputError(
                "expected a motion within the range of doubles and within 7e16 revolutions, got larger numbers at "
                f"times {low!r} to {high!r} s; use times nearer to the start, or other units"
            )
        return rates, attitudes


def _has_nan(samples: Floats) -> bool:
    """Return whether an array of samples, shape (n, 3) or (n, 4), contains NaN; a sample is NaN in all components."""
    if len(samples) <= 2:  # in a tenth of the time
        return bool(len(samples) and isnan(samples.item(0) + samples.item(-1)))
    # the sum of the squares of all numbers is NaN only if one of them is
    return isnan(np.einsum("ij,ij->", samples, samples))


class _Compiled(ExactMotion):
    """A motion in closed form whose constants and samples are computed by compiled C functions."""

    def __init__(self, constants: Any, evaluate: Any) -> None:
        self._constants, self._evaluate = constants, evaluate
        self._address = ctypes.addressof(constants)
        self.regime = REGIMES[int(constants[0])]

    def _fill(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        self._evaluate(self._address, len(times), address(times), address(omega), address(quaternion))


class _Portable(ExactMotion):
    """A motion in closed form that needs no C compiler: mpmath computes the constants, NumPy the samples."""

    def __init__(self, motion: Any) -> None:
        self.regime, self._motion = motion.regime, motion

    def _fill(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        self._motion.evaluate(times, omega, quaternion)


@cache
def functions(name: str, arguments: int) -> tuple[Any, Any, Any]:
    """Return the C functions `prepare` and `at` of the closed form ``name``, and the ctypes type of their constants.

    `prepare` computes the constants of a motion from ``arguments`` arrays; `at` computes samples.
    """
    constants, samples = load(name)
    prepare, length = (getattr(constants, f"symrot_{name}_{part}") for part in ("prepare", "length"))
    evaluate = getattr(samples, f"symrot_{name}_at")
    pointer, size = ctypes.c_void_p, ctypes.c_ssize_t
    prepare.argtypes, prepare.restype = (pointer,) * (arguments + 1), ctypes.c_int
    evaluate.argtypes, evaluate.restype = (pointer, size, pointer, pointer, pointer), None
    length.restype = size
    return prepare, evaluate, ctypes.c_double * length()


def prepared(
    name: str,
    arguments: tuple[list[float] | None, ...],
    refusal: Callable[[], str],
    exact: Callable[[], tuple[list[Any] | None, ...]] | None = None,
) -> ExactMotion:
    """Return a motion of the closed form ``name``; ``arguments`` are the arrays for its C function `prepare`.

    ``refusal`` returns the error message for numbers outside the domain. ``exact`` returns the same arguments with
    fractions for the numbers hi, and zeros for lo, where 31 digits may not determine the motion.

    Raises
    ------
    InputError
        With the text of ``refusal``, if the numbers are outside the domain of the closed form.
    CompilerError
        If the C compiler rejects the source, or does not round after every operation but fuses some, such as a*b + c.
    """
    # without a C compiler, NumPy and mpmath compute the motion
    if not available(name):
        return _portable(name, arguments if exact is None else exact(), refusal)
    prepare, evaluate, record = functions(name, len(arguments))
    constants = record()
    arrays = [None if values is None else _packed(values) for values in arguments]
    status = prepare(*arrays, ctypes.addressof(constants))
    if status == _DOMAIN:
        raise InputError(refusal())
    if status == _IN_DOUBT:
        return _portable(name, arguments if exact is None else exact(), refusal)
    if status:
        raise CompilerError(
            "expected a C compiler that rounds after every operation, got one that fuses some, such as a*b + c; "
            "set CC to another compiler"
        )
    return _Compiled(constants, evaluate)


def _portable(name: str, arguments: tuple[list[Any] | None, ...], refusal: Callable[[], str]) -> ExactMotion:
    """Return the motion with constants of 120 digits or more; other arguments are those of :func:`prepared`."""
    from symrot.closed_form.portable import MOTIONS

    try:
        return _Portable(MOTIONS[name](*arguments))
    except ValueError:
        raise InputError(refusal()) from None


_packing = {length: Struct(f"{length}d").pack for length in (2, 4, 6, 8, 26)}


def _packed(values: list[float]) -> bytes:
    """Return a list of doubles as bytes, in the machine's format, for a C function."""
    # takes a fifth of the time of making a ctypes array
    return _packing[len(values)](*values)

"""The compiled constants and loops of :mod:`.spin_up`: :file:`spin_up.c`, :file:`spin_up_at.c`."""

import ctypes
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from symrot.closed_form import spin_up_series
from symrot.closed_form.library import Floats, address, load
from symrot.closed_form.spin_up_near import DEGREE, PIECES
from symrot.closed_form.spin_up_span import Span
from symrot.codegen import library
from symrot.errors import CompilerError

__all__ = ["Compiled", "available"]

_PLACES = 9  # of the numbers in spin_up.h before those of chi


class _Functions(NamedTuple):
    prepare: Any
    evaluate: Any
    record: Any
    numbers: Any
    limits: Any


_bound: list[_Functions] = []


def available() -> bool:
    """Return whether the loops are loaded, or there is a compiler."""
    return bool(_bound) or not library.missing()


def _functions() -> _Functions:
    if not _bound:
        constants, samples = load("spin_up")
        prepare, length = constants.symrot_spin_up_prepare, constants.symrot_spin_up_length
        evaluate, pointer, size = samples.symrot_spin_up_at, ctypes.c_void_p, ctypes.c_ssize_t
        length.restype, prepare.restype, evaluate.restype = size, ctypes.c_int, None
        prepare.argtypes = (ctypes.c_int, pointer, pointer, pointer, pointer)
        evaluate.argtypes = (pointer, pointer, size, pointer, pointer, pointer)
        double = ctypes.c_double
        _bound.append(_Functions(prepare, evaluate, double * length(), double * 20, double * 2))
    return _bound[0]


class Compiled:
    """The constants of one motion, found by C, and its loops over samples.

    Parameters
    ----------
    axis : 0, 1 or 2
    numbers : 20 floats
        What ``symrot_spin_up_prepare`` takes.

    Raises
    ------
    CompilerError
        If the C compiler refuses the source, or breaks error-free arithmetic.
    """

    def __init__(self, axis: int, numbers: list[float]) -> None:
        functions = _functions()
        self._axis, self._numbers = axis, functions.numbers(*numbers)
        self._limits = functions.limits(spin_up_series.NEAR, spin_up_series.WIDE)
        self._table: Floats | None = None
        self._constants = functions.record()
        self._place = ctypes.addressof(self._constants)
        self._evaluate = functions.evaluate
        self._prepare()
        scale, edge, whole, start, _, s, _, across, _, turn, _, growth = self._constants[: _PLACES + 3]
        self.span = Span(scale, edge, start, s, across, bool(whole), turn * (4.0 * math.pi), growth * (4.0 * math.pi))

    def _prepare(self) -> None:
        status = _functions().prepare(self._axis, self._numbers, self._limits, address(self._table), self._place)
        if status:
            raise CompilerError("the C compiler breaks error-free arithmetic: it must round every operation as written")

    def fill(self, near: bool) -> Callable[..., None]:
        """Return the loops over samples; those over samples far from resonance only, or over all."""
        if near and self._table is None:
            self._table = np.empty((int(spin_up_series.NEAR) * PIECES, DEGREE + 1, 4))
            self._prepare()
        return self._loops

    def _loops(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        self._evaluate(
            self._place, address(self._table), len(times), address(times), address(omega), address(quaternion)
        )

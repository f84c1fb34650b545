"""The compiled loops of :mod:`.spin_up`: :file:`spin_up.c` for the table near resonance, :file:`spin_up_at.c`."""

import ctypes
from collections.abc import Callable
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from symrot.closed_form.library import Floats, address, load
from symrot.closed_form.pairs import pair
from symrot.closed_form.spin_up_exact import FIXED, Quaternion
from symrot.closed_form.spin_up_near import DEGREE, PIECES
from symrot.closed_form.spin_up_series import NEAR
from symrot.codegen import library
from symrot.errors import CompilerError

__all__ = ["CompiledNear", "available", "loops"]

_COUNT = int(NEAR) * PIECES


class _Functions(NamedTuple):
    record: Any
    evaluate: Any
    near: Any
    further: Any


_bound: list[_Functions] = []


def available() -> bool:
    """Return whether the loops are loaded, or there is a compiler."""
    return bool(_bound) or not library.missing()


def _functions() -> _Functions:
    if not _bound:
        table, samples = load("spin_up")
        if not table.symrot_spin_up_sound():
            raise CompilerError("the C compiler breaks error-free arithmetic: it must round every operation as written")
        length, evaluate = samples.symrot_spin_up_length, samples.symrot_spin_up_at
        near, further = table.symrot_spin_up_near, table.symrot_spin_up_from
        pointer, size = ctypes.c_void_p, ctypes.c_ssize_t
        length.restype = size
        evaluate.restype = near.restype = further.restype = None
        evaluate.argtypes = (pointer, pointer, size, pointer, pointer, pointer)
        near.argtypes, further.argtypes = (
            (pointer, size, pointer, pointer),
            (pointer, ctypes.c_double, pointer, pointer),
        )
        _bound.append(_Functions(ctypes.c_double * length(), evaluate, near, further))
    return _bound[0]


class CompiledNear:
    """As :class:`.Near`, in pairs of doubles: to 1e-29."""

    def __init__(self, kappa: Fraction) -> None:
        self._kappa = np.array(pair(kappa))
        self._table, self._middles = np.empty((_COUNT, DEGREE + 1, 4)), np.empty((_COUNT, 4, 2))
        _functions().near(address(self._kappa), _COUNT, address(self._table), address(self._middles))

    def quaternion(self, x: Fraction) -> Quaternion:
        """Return the attitude at one x."""
        piece = min(int(abs(x) * PIECES), _COUNT - 1)
        place, attitude = Fraction(2 * piece + 1, 2 * PIECES), self._middles[piece].copy()
        distance = np.array(pair(abs(x) - place))
        _functions().further(address(self._kappa), float(place), address(distance), address(attitude))
        q0, q1, q2, q3 = (int(high * 2.0**FIXED) + int(low * 2.0**FIXED) for high, low in attitude.tolist())
        sign = -1 if x < 0 else 1
        return q0, sign * q1, sign * q2, q3

    def table(self) -> Floats:
        """Return the coefficients, by piece, power of the distance from its middle, and component of the quaternion."""
        return self._table


def loops(constants: list[float], table: Floats | None) -> Callable[..., None]:
    """Return the loops over samples, with their constants."""
    functions = _functions()
    kept = functions.record(*constants)

    def fill(times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        functions.evaluate(kept, address(table), len(times), address(times), address(omega), address(quaternion))

    return fill

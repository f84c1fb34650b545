"""Rotation about one axis by compiled loops: :file:`axial_at.c`, with constants from exact integers.

The angle of a driven body grows with the square of time: the phase at 1e15 s takes 212 bits of its constants. They are
elementary, so that Python's integers give as many as it takes, at once; nothing of them is left to C.
"""

import ctypes
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.build import cache as codegen
from symrot.build.address import address
from symrot.closed_form import build as library
from symrot.closed_form.build import Floats
from symrot.errors import CompilerError
from symrot.formula import exact_numbers as number

__all__ = ["EARLY", "LOST", "Loops", "available", "loops", "parts"]

LOST, EARLY = 1, 2
"""What the loops return where samples have more turns than they know, and where a time lies before the doubles."""

_LARGEST = 200  # 2^200 stands for what is larger: whatever it multiplies is more turns than the loops know
_BITS = 260  # more than four doubles hold
_WIDE, _WIDER, _PAIR = 3, 4, 2  # parts of a constant
_PI_TOP, _PI_BOTTOM = number.PI.as_integer_ratio()
_bound: dict[str, tuple[Any, Any]] = {}


def parts(top: int, bottom: int, count: int) -> list[float]:
    """Return top/bottom as so many doubles, each the rounded rest of those before it."""
    size = top.bit_length() - bottom.bit_length()
    if size > _LARGEST:
        return [2.0**_LARGEST if top > 0 else -(2.0**_LARGEST), *[0.0] * (count - 1)]
    shift = _BITS - size
    left, found = (top << shift) // bottom if shift > 0 else top // (bottom << -shift), []
    for _ in range(count):
        high = float(left)
        left -= int(high)
        found.append(math.ldexp(high, -shift))
    return found


class Loops(NamedTuple):
    """The constants of one motion, and the compiled loops that take them."""

    evaluate: Any
    constants: Any
    place: int

    def __call__(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> int:
        """Write angular velocity (n, 3) and attitude (n, 4) at the times, where an array is given; return how it went.

        0; :data:`LOST`, with NaN in the rows that are not known; :data:`EARLY`, with nothing written.
        """
        status: int = self.evaluate(self.place, len(times), address(times), address(omega), address(quaternion))
        return status


def available() -> bool:
    """Return whether the loops are loaded, or there is a compiler."""
    return bool(_bound) or not codegen.missing()


def _functions() -> tuple[Any, Any]:
    if not _bound:
        (compiled,) = library.load("axial")
        if not compiled.symrot_axial_sound():
            raise CompilerError("the C compiler breaks error-free arithmetic: it must round every operation as written")
        evaluate, length = compiled.symrot_axial_at, compiled.symrot_axial_length
        pointer, size = ctypes.c_void_p, ctypes.c_ssize_t
        evaluate.argtypes, evaluate.restype = (pointer, size, pointer, pointer, pointer), ctypes.c_int
        length.restype = size
        _bound["axial"] = evaluate, ctypes.c_double * length()
    return _bound["axial"]


def _turning(share: Fraction, rate: Fraction, push: Fraction, decay: Fraction) -> list[float]:
    """Return the constants of so many times the angle, in turns: `turning` of axial.h."""
    top, bottom = share.numerator * _PI_BOTTOM, 2 * share.denominator * _PI_TOP

    def turns(x: Fraction, count: int) -> list[float]:
        return parts(x.numerator * top, x.denominator * bottom, count)

    if not decay:
        return [*turns(rate, _WIDE), 0.0, 0.0, 0.0, *turns(push / 2, _WIDER), *[0.0] * 4]
    gain = push - decay * rate
    rest = gain / decay**2
    below = rest.denominator * bottom
    beyond = -rest.numerator * top % below
    fraction = (beyond - below if 2 * beyond > below else beyond), below
    return [
        *turns(rate, _WIDE),
        *turns(push / decay, _WIDE),
        *turns(gain, _PAIR),
        0.0,
        0.0,
        *turns(rest, _PAIR),
        *parts(*fraction, _PAIR),
    ]


def loops(
    axis: int,
    axial: tuple[Fraction, Fraction, Fraction],
    rates: Sequence[Fraction],
    across: tuple[Fraction, Fraction],
    attitude: tuple[list[float], list[float]],
    first: float,
) -> Loops:
    """Return the loops of a motion.

    Parameters
    ----------
    axis : 0, 1 or 2
    axial : 3 Fractions
        Angular velocity at the start, rad/s, constant acceleration, rad/s^2, and decay, 1/s, about the axis.
    rates : 3 Fractions
        Angular velocity at the start, rad/s.
    across : 2 Fractions
        Lag of the transverse angular velocity per angle about the axis, and its decay, 1/s.
    attitude : 2 lists of 4 floats
        What cosine and sine of half the angle multiply.
    first : float
        s; earlier times are refused.

    Raises
    ------
    CompilerError
        If there is no C compiler, or it breaks error-free arithmetic.
    """
    evaluate, record = _functions()
    rate, push, decay = axial
    lag, slowing = across
    one, other = rates[axis - 2], rates[axis - 1]
    turned, shapes = bool(one or other), [[0.0] * 3 for _ in range(3)]
    shapes[axis][2] = 1.0
    shapes[axis - 2][:2] = float(one), -float(other)
    shapes[axis - 1][:2] = float(other), float(one)
    final = push / decay if decay else Fraction(0)
    values = [
        float(bool(decay)), 1.0, float(turned), first,
        *parts(*(-decay).as_integer_ratio(), _PAIR), *parts(*(-slowing).as_integer_ratio(), _PAIR),
        *(parts(*x.as_integer_ratio(), 1)[0] for x in (rate, push - decay * rate, final, rate - final)),
        *_turning(Fraction(1, 2), *axial), *(_turning(lag, *axial) if turned else [0.0] * 14),
        *(x for row in shapes for x in row),
        *(x for pair in zip(*attitude, strict=True) for x in (*pair, 0.0, 0.0)),
    ]  # fmt: skip
    constants = record(*values)
    return Loops(evaluate, constants, ctypes.addressof(constants))

"""Quaternions and changes of axes with arrays and numbers of any precision, by the formulas of :file:`series.h`."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from symrot.closed_form.arithmetic.frames import quaternion_of
from symrot.closed_form.build import Floats
from symrot.closed_form.portable.phases import vector
from symrot.formula.precision import mp

__all__ = ["UNIT", "Axes", "mapping", "matrix_quaternion", "unit"]

mpf = mp.mpf

UNIT = [mpf(1), mpf(0), mpf(0), mpf(0)]


def unit(a: Sequence[Any]) -> list[Any]:
    """Return a vector or quaternion divided by its norm."""
    norm = mp.sqrt(sum(x * x for x in a))
    return [x / norm for x in a]


def matrix_quaternion(r: Sequence[Sequence[int]]) -> list[Any]:
    """Return the unit quaternion of a rotation matrix that renames axes: rows ``r`` with the entries 0, 1 and -1."""
    quaternion = quaternion_of([list(map(Fraction, row)) for row in r])
    return [mpf(x.numerator) / x.denominator for x in quaternion]


class Axes:
    """The rotation from the axes in which the formulas hold to the given axes of the body: v_given = matrix*v."""

    def __init__(self, axes: list[float] | None) -> None:
        # hi and lo of the 9 entries of the matrix and of the 4 components of its quaternion; None: the identity
        values = vector(axes) if axes else [mpf(int(i % 4 == 0)) for i in range(9)] + UNIT
        self.matrix, self.quaternion = [values[3 * i : 3 * i + 3] for i in range(3)], values[9:]


def mapping(images: Sequence[Sequence[Any]]) -> Floats:
    """Return the matrix whose columns are ``images``, as an array of doubles: ``[[1, 2], [3, 4]]`` has the row 1, 3."""
    return np.array([[float(x) for x in image] for image in images]).T

"""The cubic splines of a torque that is given by a table of samples."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError

__all__ = ["table_splines"]

Floats = NDArray[np.float64]


def table_splines(t: Floats, values: Floats, switching: Sequence[float]) -> list[Any]:
    """Return the cubic splines (SciPy) of a table, divided at each switching time, s, that has two samples.

    ``t``: times of the samples, shape (n,); ``values``: the samples, shape (n, m). Raise InputError if one of the
    parts has only one sample.
    """
    from scipy.interpolate import CubicSpline

    cuts, splines = [0], []
    for switch in switching:
        inside = np.flatnonzero(t == switch)
        if len(inside) == 2:
            cuts.append(int(inside[1]))
    cuts.append(len(t))
    for low, high in pairwise(cuts):
        if high - low < 2:
            raise InputError(
                f"torque: expected two samples or more between switching times, got only one, at {t[low]} s"
            )
        splines.append(CubicSpline(t[low:high], values[low:high]))
    return splines

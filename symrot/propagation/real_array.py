"""Conversion of arguments to arrays of doubles; an error is raised for values that are not numbers."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.formula import exact_numbers as number

__all__ = ["real_array"]

ADVICE = {  # NumPy's kind -> what to write instead
    "M": "write ({0} - {0}[0])/numpy.timedelta64(1, 's') for dates",
    "m": "write {0}/numpy.timedelta64(1, 's') for differences of dates",
    "c": "write {0}.real for complex numbers that are real",
    "b": "write numbers for true and false",
    "O": "write float(x) for objects",
    "S": "write float(x) for text",
    "U": "write float(x) for text",
}


NO_NUMBERS = (bool, np.bool_, np.datetime64, np.timedelta64, np.complexfloating, str, bytes)


def real_array(values: Any, place: str, expected: str, ndmin: int = 0) -> NDArray[np.float64]:
    """Return the argument ``values`` as a new array of doubles.

    Parameters
    ----------
    place, expected : str
        Name of the argument and its expected content, such as ``"t"`` and ``"times in s"``, for the error.
    ndmin : int
        Smallest number of dimensions of the result.

    Raises
    ------
    InputError
        If the values are dates, differences of dates, complex numbers, true or false, text, or objects that are not
        real numbers (fractions are accepted), or do not form an array.
    """
    try:
        array = np.asarray(values)
        kind = array.dtype.kind
        if kind in "iuf" or (kind == "O" and all(map(_is_number, array.ravel()))):
            return np.array(array, dtype=np.float64, ndmin=ndmin)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{place}: expected {expected}, got {number.show(values)}") from None
    advice = ADVICE.get(kind, "write numbers").format(place)
    raise InputError(f"{place}: expected {expected}, got an array of type {array.dtype}; {advice}")


def _is_number(item: Any) -> bool:
    return hasattr(item, "__float__") and not isinstance(item, NO_NUMBERS)

"""Numbers from text that is separated by white space, as an array."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["numbers_of"]


def numbers_of(text: bytes, kind: Any = np.float64) -> NDArray[Any] | None:
    """Return the numbers of a text as an array of the type ``kind``; None if a word of it is no such number."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # of text that is no number
            return np.fromstring(text, dtype=kind, sep=" ")
    except (ValueError, DeprecationWarning):
        return None

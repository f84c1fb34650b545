"""Arrays of attitudes: checks of their shapes, computation by components, lengths without overflow. NumPy alone."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError

__all__ = ["Array", "Components", "Mask", "array_of", "by_components", "in_range", "largest", "length"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Components = Sequence[Array] | Array  # one array per component, all of the same length

BLOCK = 8192  # samples processed at once
SAFE = 1e-250, 1e250  # squared lengths between these bounds neither lose digits to underflow nor overflow


def array_of(values: Any, *shape: int, what: str) -> Array:
    """Return ``values`` as a float64 array; raise ``InputError`` unless they are real, with last dimensions ``shape``.

    ``what`` names the values in the message, such as "a quaternion".
    """
    try:
        array = np.asarray(values)
        real = array.dtype.kind in "fiu"
    except ValueError:  # rows of different lengths
        real = False
    if not real:
        raise InputError(
            f"expected {what}, an array of real numbers with last dimensions {shape}, got {type(values).__name__}"
        )
    if array.ndim < len(shape) or array.shape[array.ndim - len(shape) :] != shape:
        raise InputError(f"expected {what} with last dimensions {shape}, got an array of shape {array.shape}")
    return array.astype(np.float64, copy=False)


@np.errstate(all="ignore")
def by_components(function: Callable[..., Components], rows: Array, width: int) -> Array:
    """Apply ``function`` to the n components of ``rows``, shape (..., n); return its results, shape (..., width)."""
    flat = rows.reshape(-1, rows.shape[-1])
    result: Array = np.empty((len(flat), width))
    for start in range(0, len(flat), BLOCK):
        # With blocks of contiguous components, the temporaries stay in the processor's cache.
        block = slice(start, start + BLOCK)
        for place, component in enumerate(function(*np.ascontiguousarray(flat[block].T))):
            result[block, place] = component
    return result.reshape(*rows.shape[:-1], width)


def _sum_of_squares(components: Components) -> Array:
    total: Array = components[0] * components[0]
    for component in components[1:]:
        total += component * component
    return total


def largest(components: Components) -> Array:
    """Return the largest absolute value of the components of each sample."""
    size: Array = np.max(np.abs(components), axis=0)
    return size


def in_range(*components: Array) -> tuple[Components, Array]:
    """Return the components of samples and their squared lengths, as needed to normalise them.

    A sample whose squares would overflow or underflow is first divided by its largest absolute component; samples that
    are zero, infinite or NaN become NaN.
    """
    squares = _sum_of_squares(components)
    extreme = ~((squares > SAFE[0]) & (squares < SAFE[1]))
    if not extreme.any():
        return components, squares
    fixed = np.array(components)
    size = largest(fixed[:, extreme])
    fixed[:, extreme] = np.where(np.isfinite(size), fixed[:, extreme] / size, np.nan)
    return fixed, _sum_of_squares(fixed)


def length(*components: Array) -> Array:
    """Return the lengths of vectors, of which ``components`` are the arrays x, y, .., without overflow or underflow."""
    squares = _sum_of_squares(components)
    lengths: Array = np.sqrt(squares)
    extreme = ~((squares > SAFE[0]) & (squares < SAFE[1]))
    if extreme.any():
        rows = np.array(components)[:, extreme]
        size = largest(rows)
        lengths[extreme] = size * np.sqrt(_sum_of_squares(rows / np.where(size > 0, size, 1.0)))
    return lengths

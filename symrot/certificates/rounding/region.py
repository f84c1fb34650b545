"""What holds in a box of inputs beyond its sides, and what that leaves of the box.

A unit quaternion in a box: each component is at most what the least of the others leave of 1, and at least what the
largest do. So halves in three components narrow the fourth.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.rounding import intervals
from symrot.certificates.rounding.intervals import Array

__all__ = ["EVERYWHERE", "UNIT_NORM", "Region", "narrowed", "off_unit"]

UNIT_NORM = 2.0**-20  # how far the squared norm of a unit quaternion may be from 1: rounded components are nearer


@dataclass(frozen=True)
class Region:
    """What holds in a box beyond its sides.

    ``unit`` are groups of places whose squares add up to 1, but for 2^-20; ``clearance`` is the least length of the
    arguments (y, x) of every atan2, so that the angle is defined.
    """

    unit: tuple[tuple[str, ...], ...] = ()
    clearance: float = 0.0


EVERYWHERE = Region()


def _numbers(region: Region, places: Sequence[str]) -> list[list[int]]:
    """Return the inputs, by number, of each group that are among some places."""
    return [[places.index(place) for place in group if place in places] for group in region.unit]


def off_unit(boxes: Array, region: Region, places: Sequence[str]) -> NDArray[np.bool_]:
    """Tell which boxes, shape (2, inputs, n), hold no point of a region: squares that add up to too much or little."""
    outside = np.zeros(boxes.shape[2], bool)
    for group, numbers in zip(region.unit, _numbers(region, places), strict=True):
        total = intervals.point(0.0, boxes.shape[2])
        for number in numbers:
            total = intervals.add(total, intervals.square(boxes[:, number]))
        outside |= total[0] > 1 + UNIT_NORM
        if len(numbers) == len(group):
            outside |= total[1] < 1 - UNIT_NORM
    return outside


def narrowed(boxes: Array, region: Region, places: Sequence[str]) -> Array:
    """Return boxes within others that hold all their points of a region; empty ones stay as they are."""
    found = boxes
    for group, numbers in zip(region.unit, _numbers(region, places), strict=True):
        for number in numbers:
            rest = [found[:, other] for other in numbers if other != number]
            least, most = _left_by(rest, boxes.shape[2])
            if len(numbers) < len(group):  # others may have any size
                least = np.zeros_like(least)
            low, high = np.maximum(found[0, number], -most), np.minimum(found[1, number], most)
            positive, negative = low > -least, high < least  # too near to zero to be of the other sign
            low = np.where(positive, np.maximum(low, least), low)
            high = np.where(negative, np.minimum(high, -least), high)
            found = found.copy()
            found[:, number] = np.where(low <= high, np.stack([low, high]), found[:, number])
    return found


def _left_by(others: Sequence[Array], count: int) -> tuple[Array, Array]:
    """Return the least and largest size of a number whose square adds up to 1 with those of others."""
    rest = intervals.point(1.0, count) + np.array([[-UNIT_NORM], [UNIT_NORM]])
    for other in others:
        rest = intervals.add(rest, intervals.negative(intervals.square(other)))
    least, most = intervals.square_root(np.maximum(rest, 0.0))
    return least, most

"""Regions: restrictions of the inputs in a box, such as a quaternion of unit norm.

The ranges of three components of a unit quaternion limit the fourth, so that halving a box in three components narrows
the fourth as well.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.rounding import intervals
from symrot.certificates.rounding.intervals import Array

__all__ = ["EVERYWHERE", "UNIT_NORM", "Region", "narrowed", "off_unit"]

UNIT_NORM = 2.0**-20  # tolerance of the squared norm of a unit quaternion; rounding the components stays well within


@dataclass(frozen=True)
class Region:
    """Restrictions of the inputs in a box, such as a quaternion of unit norm."""

    # input components, such as ("q[0]", "q[1]", "q[2]", "q[3]"), whose squares add up to 1, within 2^-20
    unit: tuple[tuple[str, ...], ...] = ()
    # least length of the vector (y, x) of arguments of every atan2, so that the angle is defined
    clearance: float = 0.0


EVERYWHERE = Region()


def _numbers(region: Region, places: Sequence[str]) -> list[list[int]]:
    """Return, for each group of inputs with unit norm, the positions of its inputs in the list ``places``."""
    return [[places.index(place) for place in group if place in places] for group in region.unit]


def off_unit(boxes: Array, region: Region, places: Sequence[str]) -> NDArray[np.bool_]:
    """Return a Boolean array: whether each of n boxes surely has no point where the groups of inputs have unit norm.

    ``boxes`` has the shape (2, inputs, n): the least and the largest value of each input; ``places`` names the inputs.
    """
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
    """Return ``boxes`` with the sides shortened so that the allowed inputs, such as unit quaternions, stay in them.

    ``boxes`` has the shape (2, inputs, n): the least and the largest value of each input in n boxes. ``places`` names
    the inputs, such as ``"q[0]"``. If a box contains no allowed value of an input, its side in this input is not
    changed.
    """
    shrunk = boxes
    for group, numbers in zip(region.unit, _numbers(region, places), strict=True):
        for number in numbers:
            rest = [shrunk[:, other] for other in numbers if other != number]
            least, most = _left_by(rest, boxes.shape[2])
            if len(numbers) < len(group):  # the other inputs of the group are free
                least = np.zeros_like(least)
            low, high = np.maximum(shrunk[0, number], -most), np.minimum(shrunk[1, number], most)
            positive, negative = low > -least, high < least  # values of the other sign are too small
            low = np.where(positive, np.maximum(low, least), low)
            high = np.where(negative, np.minimum(high, -least), high)
            shrunk = shrunk.copy()
            shrunk[:, number] = np.where(low <= high, np.stack([low, high]), shrunk[:, number])
    return shrunk


def _left_by(others: Sequence[Array], count: int) -> tuple[Array, Array]:
    """Return, for each of ``count`` boxes, the least and the largest |x| if x^2 plus other squares is 1.

    ``others`` holds the ranges of the other numbers, such as the other components of a unit quaternion.
    """
    # the sum may differ from 1 by the tolerance UNIT_NORM
    rest = intervals.point(1.0, count) + np.array([[-UNIT_NORM], [UNIT_NORM]])
    for other in others:
        rest = intervals.add(rest, intervals.negative(intervals.square(other)))
    # 0 where the other squares exceed 1
    least, most = intervals.square_root(np.maximum(rest, 0.0))
    return least, most

"""The segments of a motion between switching times, and sample times in the order of the motion."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Segment", "segments", "split_at"]

Floats = NDArray[np.float64]

SLIVER = 2.0**-100  # part of a segment: so near its end, every formula has the same value as at the end


class Segment(NamedTuple):
    """Interval of time from ``start`` to ``stop``, s, between two switching times or ends of the motion.

    Torques are evaluated from ``first`` to ``last``: these are the ends themselves or, at a switching time, where a
    torque may jump, times just inside the interval.
    """

    start: float
    stop: float
    first: float
    last: float


def segments(t0: float, end: float, breaks: Sequence[float]) -> list[Segment]:
    """Return the segments into which switching times divide the span from t0 to ``end``, in this order.

    For t0 = 2, ``end`` = 0 and a break at 1: from 2 to 1, from 1 to 0.
    """
    if not breaks:
        return [Segment(t0, end, t0, end)]
    low, high = min(t0, end), max(t0, end)
    # switching times outside the span do not count
    inside, known = [time for time in breaks if low < time < high], set(breaks)
    edges = [t0, *(inside if end >= t0 else reversed(inside)), end]
    return [
        Segment(
            start,
            stop,
            _inside(start, stop) if start in known else start,
            _inside(stop, start) if stop in known else stop,
        )
        for start, stop in pairwise(edges)
    ]


def _inside(edge: float, other: float) -> float:
    """Return a time just inside a segment, next to its end ``edge``; ``other`` is the time of its other end.

    If a torque jumps at ``edge``, its value at the returned time is the value inside the segment.
    """
    # too near the edge to affect the choice of the first step
    time = edge + SLIVER * (other - edge)
    return time if time != edge else math.nextafter(edge, other)


def split_at(times: Floats, t0: float) -> Iterator[NDArray[np.intp]]:
    """Yield the indices of the times from t0 on, then of the times before t0, each sorted by distance from t0.

    An empty array is left out.
    """
    # for the times 3, 0, 2 and t0 = 1: [2, 0], then [1]
    order = np.argsort(times, kind="stable")
    first_after = int(np.searchsorted(times[order], t0))
    for part in (order[first_after:], order[:first_after][::-1]):
        if len(part):
            yield part

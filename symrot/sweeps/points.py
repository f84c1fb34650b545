"""Random points of the unit cube, from which the values of a sweep are drawn.

Each point is computed from the seed and its index alone. Therefore any process can compute any range of points, and
the points have the same bits however the ranges are chosen.
"""

import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError

__all__ = ["SAMPLINGS", "unit_points"]

Floats = NDArray[np.float64]
Words = NDArray[np.uint64]
SOBOL_BITS = 30  # scipy's default: at most 2^30 points
FEISTEL_ROUNDS = 6
BLOCK = 4  # words of 64 bits that Philox computes from one value of its counter


def _key(seed: int, stream: str, words: int = 2) -> Words:
    """Return the key, an array of ``words`` 64-bit words, for the random numbers of the stream named ``stream``."""
    # each varied value has a stream of its own; other seeds or names give other keys
    sequence = np.random.SeedSequence(seed, spawn_key=tuple(stream.encode()))
    return sequence.generate_state(words, np.uint64).astype(np.uint64)


def _words(seed: int, stream: str, start: int, stop: int) -> Words:
    """Return the random 64-bit words number ``start`` to ``stop - 1`` of a stream, without computing those before."""
    bits = np.random.Philox(key=_key(seed, stream), counter=start // BLOCK)
    words: Words = bits.random_raw(stop - start // BLOCK * BLOCK)[start % BLOCK :]
    return words


def _uniform(words: Words) -> Floats:
    """Convert random words to numbers in (0, 1): midpoints of 2^52 equal intervals, exact in doubles."""
    return ((words >> np.uint64(12)).astype(np.float64) + 0.5) * 2.0**-52


# random: one stream of Philox numbers for each varied value. Philox computes the k-th number directly from k.
def _random(seed: int, streams: Sequence[str], count: int, start: int, stop: int) -> Floats:
    return np.stack([_uniform(_words(seed, stream, start, stop)) for stream in streams], axis=1)


# latin: a Latin hypercube. For n points, the range of each varied value is divided into n equal intervals with one
# point each. The order of the intervals is a permutation by a Feistel network, which needs no memory.
def _latin(seed: int, streams: Sequence[str], count: int, start: int, stop: int) -> Floats:
    index = np.arange(start, stop, dtype=np.uint64)
    points = np.empty((stop - start, len(streams)))
    for k, stream in enumerate(streams):
        within = _uniform(_words(seed, stream, start, stop))
        points[:, k] = (permuted(index, count, _key(seed, f"{stream} order", FEISTEL_ROUNDS)) + within) / count
    return np.clip(points, 2.0**-53, 1 - 2.0**-53)  # the sum may round up to the end of the last interval


def permuted(index: Words, count: int, keys: Words) -> Words:
    """Return the images of ``index`` under a random permutation of 0 to ``count - 1``; ``keys`` determine it."""
    # a Feistel network permutes the numbers below the smallest power of 4 that is not below count
    half = max(1, (int(count - 1).bit_length() + 1) // 2)
    shift, mask = np.uint64(half), np.uint64(2**half - 1)
    places = index.copy()
    active = np.arange(len(index))
    # cycle walking: applied again to results of count or more, it permutes the numbers below count
    while len(active):
        left, right = places[active] >> shift, places[active] & mask
        for key in keys:
            left, right = right, left ^ (_mixed(right ^ key) & mask)
        places[active] = left << shift | right
        active = active[places[active] >= count]
    return places


def _mixed(words: Words) -> Words:
    """Return words with well mixed bits, by the last function of SplitMix64 (Steele, Lea & Flood, OOPSLA 2014)."""
    words = (words ^ (words >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    words = (words ^ (words >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return words ^ (words >> np.uint64(31))


class _Sobol:
    """The Sobol points of one sweep, which fill the unit cube evenly."""

    def __init__(self, dimensions: int, seed: int) -> None:
        # SciPy produces the points one after the other: a range that starts where the last one ended costs nothing
        # extra
        self._dimensions, self._seed, self._lock = dimensions, seed, Lock()
        self._restart()

    def _restart(self) -> None:
        from scipy.stats.qmc import Sobol

        self._engine: Any = Sobol(self._dimensions, scramble=True, seed=self._seed, bits=SOBOL_BITS)
        self._next = 0

    def points(self, start: int, stop: int) -> Floats:
        """Return points ``start`` to ``stop - 1`` of the Sobol sequence, one per row, with coordinates from 0 to 1."""
        # threads share the generator of the sequence
        with self._lock:
            return self._points(start, stop)

    def _points(self, start: int, stop: int) -> Floats:
        if start < self._next:
            self._restart()
        if start > self._next:
            self._engine.fast_forward(start - self._next)
        with warnings.catch_warnings():  # the balance of a part that is no power of two does not matter
            warnings.simplefilter("ignore", UserWarning)
            points: Floats = self._engine.random(stop - start)
        self._next = stop
        return points + 2.0 ** -(SOBOL_BITS + 1)  # the middle of the cell of a point, never 0


_sobol_points = lru_cache(maxsize=4)(_Sobol)


# sobol: scrambled Sobol points of scipy.stats.qmc.Sobol, which skips to the index of the first point.
def _sobol(seed: int, streams: Sequence[str], count: int, start: int, stop: int) -> Floats:
    if count > 2**SOBOL_BITS:
        raise InputError(f"count: expected at most {2**SOBOL_BITS} draws with the sampling 'sobol', got {count}")
    return _sobol_points(len(streams), seed).points(start, stop)


SAMPLINGS: dict[str, Callable[[int, Sequence[str], int, int, int], Floats]] = {
    "random": _random,
    "latin": _latin,
    "sobol": _sobol,
}
"""For each name of a sampling, the function that returns its points."""


def unit_points(sampling: str, seed: int, streams: Sequence[str], count: int, start: int, stop: int) -> Floats:
    """Return the points ``start`` to ``stop - 1`` of ``count`` in the open unit cube, shape (stop - start, d).

    Parameters
    ----------
    sampling : str
        A name in :data:`SAMPLINGS`.
    seed : int
        The seed, zero or more.
    streams : sequence of d texts
        Names of the d coordinates. With ``random`` and ``latin``, the numbers of a coordinate depend on its own name
        and not on the other coordinates.
    count : int
        Number of all points.
    start, stop : int
        The part of the points to compute, 0 <= start <= stop <= count.
    """
    if not streams:
        return np.empty((stop - start, 0))
    return SAMPLINGS[sampling](seed, streams, count, start, stop)

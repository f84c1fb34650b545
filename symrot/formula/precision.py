"""mpmath for motions, with a context of its own: threads do not change the precision in which another one computes.

The precision of ``mpmath.mp`` belongs to the whole process. A thread that ends its computation restores the precision
that it found, also for threads that still compute with more digits.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

from mpmath import MPContext

__all__ = ["bits", "digits", "mp"]

mp = MPContext()
"""The context in which motions are computed; numbers of ``mpmath.mp`` have another type."""

_lock = RLock()


@contextmanager
def bits(count: int) -> Iterator[None]:
    """Compute with ``count`` bits in a ``with`` block or a decorated function, in one thread at a time."""
    with _lock, mp.workprec(count):
        yield


@contextmanager
def digits(count: int) -> Iterator[None]:
    """Compute with ``count`` decimal digits in a ``with`` block or a decorated function, in one thread at a time."""
    with _lock, mp.workdps(count):
        yield

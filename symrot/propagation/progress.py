"""Progress of long motions, reported to a function that displays it, for example on the command line."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["report", "reporting", "within"]

Reporter = Callable[[float, float, float], object]
"""Function that is called every few hundredths of a second with the time reached, the start and the end, s."""

_whole: ContextVar[tuple[float, float, Callable[[], float]] | None] = ContextVar("whole", default=None)
_reporter: ContextVar[Reporter | None] = ContextVar("reporter", default=None)


def report(t: float, start: float, stop: float) -> None:
    """Report that a motion from ``start`` to ``stop``, s, has reached ``t``; do nothing if no reporter is set."""
    reporter = _reporter.get()
    if reporter is not None:
        whole = _whole.get()
        if whole is None:
            reporter(t, start, stop)
        else:
            # inside the block of `within`: progress of the whole motion, of which this one is a part
            reporter(whole[2]() + t, whole[0], whole[1])


@contextmanager
def within(start: float, stop: float, zero: Callable[[], float] = lambda: 0.0) -> Iterator[None]:
    """Context manager: progress inside the block counts as progress of one motion from ``start`` to ``stop``, s.

    ``zero()``, s, is added to reported times.
    """
    # a motion that is computed in several parts; of nested blocks, the outermost applies
    token = _whole.set(_whole.get() or (start, stop, zero))
    try:
        yield
    finally:
        _whole.reset(token)


@contextmanager
def reporting(reporter: Reporter) -> Iterator[None]:
    """Context manager: the progress of each motion inside the block is passed to ``reporter(t, start, stop)``, in s."""
    token = _reporter.set(reporter)
    try:
        yield
    finally:
        _reporter.reset(token)

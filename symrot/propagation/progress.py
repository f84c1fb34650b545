"""Tell how far a long motion has come, to whoever asked: a command line that shows it, or nobody."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["report", "reporting"]

Reporter = Callable[[float, float, float], object]
"""Gets the time reached, the start and the end, s, every few hundredths of a second."""

_reporter: ContextVar[Reporter | None] = ContextVar("reporter", default=None)


def report(t: float, start: float, stop: float) -> None:
    """Tell the reporter, if there is one."""
    reporter = _reporter.get()
    if reporter is not None:
        reporter(t, start, stop)


@contextmanager
def reporting(reporter: Reporter) -> Iterator[None]:
    """Have motions report how far they have come, as long as the block runs."""
    token = _reporter.set(reporter)
    try:
        yield
    finally:
        _reporter.reset(token)

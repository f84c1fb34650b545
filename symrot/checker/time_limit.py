"""A limit on the processor time of a computation inside SymPy, whose steps cannot be counted from outside."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from typing import Any

__all__ = ["TimeUp", "processor_seconds"]

AGAIN = 0.5  # seconds until TimeUp is raised once more, if a callback discarded it


class TimeUp(BaseException):
    """Exception raised when the processor time is used up.

    It is not derived from ``Exception``, because SymPy catches such exceptions and goes on.
    """


@contextmanager
def processor_seconds(limit: float) -> Iterator[None]:
    """Raise TimeUp in a ``with`` block after ``limit`` seconds of processor time.

    There is no limit on a platform without the timer ``ITIMER_PROF``, in a thread other than the main one, inside
    another such block, or if the program uses the signal SIGPROF.
    """
    if not _timer_is_free():
        yield
        return

    running = True

    def time_up(*_: Any) -> None:
        if running:
            raise TimeUp

    previous = signal.signal(signal.SIGPROF, time_up)
    try:
        try:
            signal.setitimer(signal.ITIMER_PROF, limit, AGAIN)
            yield
        finally:
            running = False
    finally:  # a finally of its own: TimeUp may be raised just before the line above
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous)


def _timer_is_free() -> bool:
    return (
        hasattr(signal, "setitimer")
        and current_thread() is main_thread()
        and signal.getsignal(signal.SIGPROF) is signal.SIG_DFL
    )

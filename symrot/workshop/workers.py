"""Processes that work at once, and end at once when the command is interrupted."""

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children

__all__ = ["COUNT", "workers"]

COUNT = min(os.cpu_count() or 1, 4)


def _ignored(arguments: object) -> None:
    """Say nothing of an error in a thread of a pool that is being ended."""


@contextmanager
def workers() -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of processes; whatever leaves the block but its end, as Ctrl-C, kills them where they are.

    What they write appears by renaming (:func:`symrot.files.writing.write`, :mod:`symrot.build.cache`), so that
    nothing stays half-written. Ctrl-C is for the first process alone, which tells the others.
    """
    with ProcessPoolExecutor(COUNT, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)) as pool:
        try:
            yield pool
        except BaseException:
            threading.excepthook = _ignored  # the pool's own thread trips over what was cancelled under it
            for process in active_children():
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)
            raise

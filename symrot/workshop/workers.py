"""A pool of processes for long work; it ends immediately when the command is interrupted."""

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
    """Ignore an error in a thread of a process pool that is being shut down; replaces ``threading.excepthook``."""


@contextmanager
def workers() -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of processes; an exception in the ``with`` block, such as Ctrl-C, kills the processes at once."""
    # the processes rename finished files, so that no incomplete file remains; they ignore Ctrl-C
    with ProcessPoolExecutor(COUNT, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)) as pool:
        try:
            yield pool
        except BaseException:
            threading.excepthook = _ignored  # the pool's own thread raises an error for cancelled futures
            for process in active_children():
                process.terminate()
            pool.shutdown(wait=False, cancel_futures=True)
            raise

"""Computation of the chunks of a sweep (many motions of a scene with varied values) by processes on this machine.

If a process is killed, a new one computes its chunks again. The processes end when the process that started them ends,
even if it is killed.
"""

import multiprocessing
import os
import pickle
import signal
import sys
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import lru_cache
from multiprocessing.connection import wait as wait_for
from threading import Thread
from types import ModuleType
from typing import Any

from symrot.errors import PropagationError
from symrot.sweeps.chunk import Chunk, Job, compute
from symrot.sweeps.design import Draws

__all__ = ["compute_packed", "cores", "packed", "run_here"]

Range = tuple[int, int]
IN_FLIGHT = 2  # chunks for each process: one to compute and one to begin with at once
MOST_LOSSES = 5  # a sweep stops if processes are killed so many times without a complete chunk in between


def cores() -> int:
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def packed(job: Job) -> bytes:
    """Return a job as bytes, so that it is converted only once for all chunks; :func:`compute_packed` takes them."""
    return pickle.dumps(job)


@lru_cache(maxsize=2)
def _unpacked(text: bytes) -> Job:
    job: Job = pickle.loads(text)
    return job


def _import(text: bytes) -> None:
    """Import the modules that a job needs, in a new process; ``text`` is the job from :func:`packed`."""
    _unpacked(text)


def compute_packed(text: bytes, start: int, stop: int, draws: Draws | None = None) -> Chunk:
    """Return the chunk of the trajectories ``start`` to ``stop - 1``; ``text`` is the job from :func:`packed`.

    ``draws`` are their varied values, if these are known already.
    """
    # called in a process of run_here, which unpacks a job only once
    return compute(_unpacked(text), start, stop, draws)


def run_here(job: Job, ranges: Sequence[Range], workers: int) -> Iterator[Chunk]:
    """Yield the chunks of a job, as each is complete, computed by ``workers`` processes.

    ``ranges`` has the pair (start, stop) of each chunk. With a single worker or chunk, this process computes.

    Raises
    ------
    PropagationError
        If processes are killed again and again, for example because memory is short.
    """
    workers = min(workers, len(ranges))
    if workers <= 1:
        yield from (compute(job, *each) for each in ranges)
        return
    context = multiprocessing.get_context("spawn")  # after a fork, other threads of the parent would leave locks behind
    text, missing, losses, is_compiled = packed(job), deque(ranges), 0, False
    while missing:
        pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_begin)
        running: dict[Future[Chunk], Range] = {}
        try:
            if not is_compiled:
                with _without_main():
                    for _ in range(workers):
                        pool.submit(_import, text)
                # compiles the kernel once, before the processes need it and while they start
                compute(job, ranges[0][0], ranges[0][0] + 1)
                is_compiled = True
            while missing or running:
                while missing and len(running) < IN_FLIGHT * workers:
                    each = missing.popleft()
                    # drawn here: a new process would take 0.2 to 1 s to import the distributions of scipy
                    draws = job.design.draws(*each)
                    with _without_main():
                        running[pool.submit(compute_packed, text, *each, draws)] = each
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    chunk = future.result()
                    del running[future]
                    losses = 0
                    yield chunk
        except BrokenProcessPool:
            losses += 1
            missing.extendleft(sorted(running.values(), reverse=True))
            if losses == MOST_LOSSES:
                raise PropagationError(
                    f"{MOST_LOSSES} times in a row a process of the sweep was killed while it computed a chunk; run "
                    "the sweep again, with smaller chunks or fewer workers, to go on"
                ) from None
        finally:
            _stop(pool)


@contextmanager
def _without_main() -> Iterator[None]:
    """Hide the main program from new processes, which compute trajectories and do not need it."""
    # they would import it, which fails for a program without if __name__ == "__main__"
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def _begin() -> None:
    """Prepare a new process: it ignores Ctrl-C, which its parent handles, and it ends when its parent ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    wait_for([sentinel])
    os._exit(1)


def _stop(pool: Any) -> None:
    """End the processes of ``pool`` at once; chunks that they are computing, after Ctrl-C or an error, are lost."""
    processes = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    for process in processes:
        process.join()

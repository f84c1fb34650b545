"""Cases in subprocesses, each with a time limit: a case that does not end is stopped and counted."""

import multiprocessing
import time
from collections.abc import Callable, Iterator
from multiprocessing.connection import wait
from typing import Any

__all__ = ["run_all"]

STARTING = 60.0  # s that the first case of a process is given for imports and compilers
PREPARING = 300.0  # s for what comes before the part of a case that has a limit


def _serve(work: Callable[..., Any], connection: Any) -> None:
    while (job := connection.recv()) is not None:
        connection.send((True, work(job, lambda: connection.send((False, None)))))


class _Worker:
    def __init__(self, context: Any, work: Callable[[Any], Any]) -> None:
        self.connection, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(work, other), daemon=True)
        self.process.start()
        other.close()
        self.job: Any = None
        self.deadline, self.first, self.judged = 0.0, True, False

    def give(self, job: Any) -> None:
        self.job, self.judged, self.deadline = job, False, time.monotonic() + PREPARING
        self.connection.send(job)

    def started(self, limit: float) -> None:
        self.judged, self.deadline = True, time.monotonic() + limit + (STARTING if self.first else 0.0)
        self.first = False

    def end(self) -> None:
        self.process.kill()
        self.process.join()
        self.connection.close()


def run_all(
    work: Callable[..., Any], jobs: list[Any], workers: int, limit: float, broken: Callable[[Any, str], Any]
) -> Iterator[Any]:
    """Yield ``work(job, started)`` for each job, in the order in which they end; ``broken(job, why)`` for a job without
    a result.

    The job calls ``started`` when the part with the time limit (s) begins.
    """
    context = multiprocessing.get_context("spawn")
    waiting = list(reversed(jobs))
    pool = [_Worker(context, work) for _ in range(min(workers, len(jobs)))]
    try:
        for worker in pool:
            worker.give(waiting.pop())
        while busy := [worker for worker in pool if worker.job is not None]:
            next_deadline = min(worker.deadline for worker in busy)
            ready = wait([worker.connection for worker in busy], max(0.0, next_deadline - time.monotonic()))
            for worker in busy:
                result, dead = None, ""
                if worker.connection in ready:
                    try:
                        done, result = worker.connection.recv()
                    except EOFError:
                        dead = "traceback"
                    else:
                        if not done:
                            worker.started(limit)
                            continue
                elif time.monotonic() > worker.deadline:
                    dead = "no end" if worker.judged else "doubt"
                else:
                    continue
                job, worker.job = worker.job, None
                if dead:
                    worker.end()
                    pool[pool.index(worker)] = worker = _Worker(context, work)
                yield broken(job, dead) if dead else result
                if waiting:
                    worker.give(waiting.pop())
    finally:
        for worker in pool:
            worker.end()

"""One run of a campaign: claim after claim, in one process or several, with a log from which the run can be resumed."""

import json
import signal
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from itertools import islice
from pathlib import Path
from time import process_time
from typing import Any

from symrot.checker.verdict import Verdict
from symrot.errors import InputError

__all__ = ["LONGEST_SECONDS", "Answer", "Judged", "Tally", "answer_of", "judged_claims", "read_log"]

LONGEST_SECONDS = 60.0
"""In which every claim has its answer."""

NO_ANSWER = "no answer"
GIVEN_UP_SECONDS = 300.0
"""After which a campaign stops waiting for an answer, and goes on with the next claim."""

CHUNK = 8
"""Claims that a process is given at once: few enough that an interruption loses little."""


@dataclass(frozen=True)
class Judged:
    """A claim, its verdict, the processor time in seconds, the fault of the verdict, and the reason if a true claim was
    refused.
    """

    number: int
    claim: str
    verdict: str
    seconds: float
    wrong: str = ""
    refused: str = ""

    @property
    def late(self) -> bool:
        return self.seconds > LONGEST_SECONDS


class _NoAnswer(BaseException):
    """Raised inside a check that takes too long; no handler of ordinary exceptions catches it."""


@contextmanager
def _given_up_after(seconds: float) -> Iterator[None]:
    """Raise ``_NoAnswer`` after so many seconds, if the system has timers; this can stop only a main thread."""
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(_signal: int, _frame: Any) -> None:
        raise _NoAnswer

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@dataclass(frozen=True)
class Answer:
    """A verdict, or the sentence by which a claim was refused; or, in ``failure``, the reason why there is neither."""

    verdict: Verdict | str
    seconds: float
    failure: str = ""

    @property
    def name(self) -> str:
        if self.failure:
            return "no answer" if self.failure.startswith(NO_ANSWER) else "traceback"
        return "refused" if isinstance(self.verdict, str) else self.verdict.verdict


def answer_of(ask: Callable[[], Verdict]) -> Answer:
    """Return the answer that a user would get, and the processor time in seconds."""
    before = process_time()
    try:
        with _given_up_after(GIVEN_UP_SECONDS):
            verdict: Verdict | str = ask()
    except InputError as refusal:
        verdict = str(refusal)
    except _NoAnswer:
        return Answer("", process_time() - before, f"{NO_ANSWER} in {GIVEN_UP_SECONDS:.0f} s")
    except Exception as failure:  # whatever it is, a user would see a traceback
        return Answer("", process_time() - before, f"{type(failure).__name__}: {failure}"[:200])
    return Answer(verdict, process_time() - before)


# -- many claims ------------------------------------------------------------------------------------------------------

Judge = Callable[[int, Any], Judged]
"""From the number of a claim, and the claim as it was generated, to what became of it."""


def judged_claims(judge: Judge, claims: Iterable[tuple[int, Any]], workers: int, log: Path | None) -> Iterator[Judged]:
    """Yield the result of each claim as soon as it is known; the log contains each result before it is yielded.

    Parameters
    ----------
    judge : function
        A function that other processes can receive, if there are several workers.
    claims : iterable of (int, claim)
    workers : int
        Processes; 1 for this one alone.
    log : Path, optional
        JSON lines; appended to.
    """
    rows = _in_processes(judge, claims, workers) if workers > 1 else (judge(*numbered) for numbered in claims)
    if log is None:
        yield from rows
        return
    with log.open("a", encoding="utf-8") as file:
        for row in rows:
            file.write(json.dumps(asdict(row)) + "\n")
            file.flush()
            yield row


def _in_processes(judge: Judge, claims: Iterable[tuple[int, Any]], workers: int) -> Iterator[Judged]:
    rest = iter(claims)
    with ProcessPoolExecutor(workers) as pool:
        waiting: set[Future[list[Judged]]] = set()
        try:
            while True:
                while len(waiting) < 2 * workers and (chunk := list(islice(rest, CHUNK))):
                    waiting.add(pool.submit(_judged, judge, chunk))
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    yield from future.result()
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _judged(judge: Judge, chunk: Sequence[tuple[int, Any]]) -> list[Judged]:
    return [judge(*numbered) for numbered in chunk]


def read_log(log: Path | None) -> dict[int, Judged]:
    """Return the claims of a log by number, the last line of each; a line that an interruption cut off is left out.

    Raises
    ------
    InputError
        If the file is not the log of a campaign.
    """
    rows: dict[int, Judged] = {}
    if log is None or not log.exists():
        return rows
    *lines, rest = log.read_text(encoding="utf-8").split("\n")
    for line in lines:
        try:
            row = Judged(**json.loads(line))
        except (ValueError, TypeError):
            raise InputError(
                f"expected the log of a campaign, one JSON object a line, got {line[:60]!r} in {log}"
            ) from None
        rows[row.number] = row
    if rest:
        log.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return rows


@dataclass
class Tally:
    """The counts of a run so far: verdicts of each kind; wrong, refused and late ones; the slowest claim."""

    counts: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    late: list[str] = field(default_factory=list)
    slowest: float = 0.0
    slowest_claim: str = ""
    seconds: float = 0.0

    def add(self, row: Judged) -> None:
        """Count a claim."""
        self.counts[row.verdict] += 1
        self.seconds += row.seconds
        if row.wrong:
            self.wrong.append(f"{row.wrong}: {row.claim}")
        if row.refused:
            self.refused.append(f"{row.refused}: {row.claim}")
        if row.late:
            self.late.append(f"{row.seconds:.0f} s: {row.claim}")
        if row.seconds > self.slowest:
            self.slowest, self.slowest_claim = row.seconds, row.claim

    @property
    def count(self) -> int:
        return self.counts.total()

    def show(self, of: int, row: Judged) -> None:
        """Print progress on standard error: each wrong or late answer at once, and the counts now and then."""
        if row.wrong or row.late:
            sys.stderr.write(f"\r{row.number}: {row.wrong or f'{row.seconds:.0f} s'}: {row.claim}\n")
        if self.count % (20 if sys.stderr.isatty() else 500) == 0:
            line = f"{self.count} of {of} claims, {len(self.wrong)} wrong, {len(self.late)} late, {self.seconds:.0f} s"
            sys.stderr.write(f"\r{line}" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()

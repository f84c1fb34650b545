"""The smooth motion up to the next switch of sign, abs, .., in pieces: groups of consecutive steps of a stepper.

Each piece has two forms: polynomials in time, and a function from times to states. A *window* is the interval of time
that SciPy integrates at once; the caller searches it for a switch after it has been integrated whole.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.events.polynomials import Piece, fitted, rows_of
from symrot.propagation.motions.methods import SciPyMotion, SteppedMotion
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.integration_stopped import IntegrationStopped, why_exhausted, why_hopeless
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.regimes import Regime
from symrot.propagation.switched.run_state import RunState

__all__ = ["SciPyPieces", "SteppedPieces", "smooth_pieces"]

ROOM = 4  # steps in the first piece after a switch; each further piece has twice as many, up to a limit of the stepper
WINDOWS, FEWEST = 64, 8  # SciPy follows at most 1/64 of the span at first, later at most 1/8
JOIN = 0.01  # part of the tolerance: largest gap between the ends of two LSODA steps
RECENT = 4  # number of smooth parts whose lengths predict the length of the next one
FIRST_ANGLE = 30.0  # rad: half of the largest rotation in the first window of SciPy
SHORTEST = 1e-6  # part of the span: shortest first window
OVERHEAD = 200  # evaluations that take as long as the other work for a window


class SteppedPieces:
    """A smooth motion that a stepper in C follows; :meth:`pieces` yields it until the caller finds a switch."""

    def __init__(self, run: RunState, regime: Regime, motion: SteppedMotion, rates: list[float]) -> None:
        if not np.isfinite(run.y).all():
            raise IntegrationStopped(run.t, "at this time, a component of the state is not a finite number", run.end)
        start = (motion.library, rates, run.y, run.t, motion.tolerance)
        if motion.choice.method == "taylor":
            self.integration = taylor.integration(*start)
        else:
            self.integration = dop853.integration(*start, clock=run.clock(regime, motion.library))
        self.integration.way, self.end = run.span, run.end
        self.integration.rounding, self.run, self.zero = run.rounding, run, run.zero

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        """Yield each piece in the order of the motion: its polynomials, and a function from its times to states."""
        integration, room = self.integration, ROOM
        for run in integration.runs(self.end):
            while run.t != run.stop:
                rows = np.empty((room, integration.stepper.row))
                try:
                    integration.advance(run, None, 0, None, rows.ctypes.data, room)
                except IntegrationStopped as error:
                    stuck: IntegrationStopped | None = error
                else:
                    stuck = None
                rows = rows[: run.recorded]
                if len(rows):

                    def states(times: Floats, rows: Floats = rows) -> Floats:
                        return integration.stepper.dense(rows, times)

                    yield Piece(np.append(rows[:, 0], run.t), rows_of(integration.stepper, rows)), states
                if stuck is not None:
                    # after the last piece
                    raise stuck
                room = min(2 * room, integration.stepper.rows_per_call)

    def cost(self) -> NDArray[np.int64]:
        """Return the numbers of steps accepted, steps rejected and evaluations so far, as an array.

        Also store in ``self.run`` the time, if any, from which rounding errors may exceed the tolerance
        (:meth:`RunState.note_rounding`).
        """
        integration = self.integration
        self.run.note_rounding(self.zero)
        return np.array([integration.accepted, integration.rejected, integration.evaluations])


class SciPyPieces:
    """A smooth motion that SciPy follows; :meth:`pieces` yields it, one interval of time (window) after another."""

    def __init__(self, run: RunState, regime: Regime, motion: SciPyMotion, rates: list[float]) -> None:
        self.run, self.motion, self.rates, self.counts = run, motion, rates, np.zeros(3, dtype=np.int64)
        self.clock, self.zero = run.clock(regime, motion.rates), run.zero

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        """Yield each piece in the order of the motion: its polynomials, and a function from its times to states."""
        from symrot.propagation.steppers import fallback

        run, t, y = self.run, self.run.t, self.run.y
        side = 1.0 if run.end >= t else -1.0
        length = self._first_length()
        options = replace(self.motion.options(self.rates), clock=self.clock)
        while t != run.end:
            stop = run.end if abs(run.end - t) <= 1.01 * length else t + side * length
            share = max(abs(stop - t) / run.span, 1e-3)
            self._judge_pace(t)
            part = replace(options, whole=fallback.WholeMotion(run.start, run.end, run.spent, run.rounding))
            ended: IntegrationStopped | KeyboardInterrupt | None = None
            recording: Any
            try:
                recording = fallback.record(
                    self.motion.rates, self.rates, y, t, (t, stop), run.motion.tolerance * share, part
                )
            except (IntegrationStopped, KeyboardInterrupt) as error:
                before: fallback.FallbackRecording | None = getattr(error, "recording", None)
                if before is None:
                    raise
                recording, ended = before, error
                stop = recording.span[side > 0.0]
                if isinstance(error, KeyboardInterrupt):  # the interrupt must not be lost if a switch comes before it
                    run.interrupt = error
            self.counts += recording.stats[:3]
            run.spent += recording.stats.evaluations + OVERHEAD
            for edges in recording.edges(t, stop):
                accuracy = JOIN * run.motion.tolerance * share
                yield fitted(recording, edges, *error_blocks(self.motion.plan), accuracy=accuracy), recording
            if ended is not None:
                # an error or interrupt, after the motion before it was yielded
                raise ended
            y, t, length = recording(stop), stop, min(2.0 * length, run.span / FEWEST)

    def _first_length(self) -> float:
        """Return the length, s, of the first window: the interval that SciPy integrates at once, before it is searched.

        The search is for a switch of sign, abs, ..; the motion beyond a switch is computed in vain.
        """
        run = self.run
        (_, rates, *_), _ = error_blocks(self.motion.plan)
        turning = float(np.linalg.norm(run.y[:rates]))  # rad/s, or 1 if omega is not a state
        instants = [Instant(run.motion.start), *run.recent][-RECENT - 1 :]
        # twice the longest recent smooth interval, or the time of about ten rotations; in a longer window, the work
        # beyond the next switch would be wasted
        longest = max((abs(after - before) for before, after in pairwise(instants)), default=run.span)
        likely = min(longest, FIRST_ANGLE / max(turning, FIRST_ANGLE / run.span))
        return min(max(2.0 * likely, SHORTEST * run.span), run.span / WINDOWS)

    def _judge_pace(self, t: float) -> None:
        """Raise IntegrationStopped if the motion, now at the time t, s, exceeds the limit of evaluations.

        Raise it early if, at the present pace, the whole motion would need far more evaluations than the limit allows.
        """
        from symrot.propagation.steppers.fallback import MAX_EVALUATIONS, PATIENCE

        run = self.run
        spent = run.spent - run.mark[0]
        if spent >= PATIENCE:
            way = abs(t - run.start)
            reason = why_hopeless(spent, way - run.mark[1], abs(run.end - t), MAX_EVALUATIONS)
            if reason:
                raise IntegrationStopped(t, reason, run.end)
            run.mark = (run.spent, way)
        if run.spent > MAX_EVALUATIONS:
            raise IntegrationStopped(t, why_exhausted(MAX_EVALUATIONS), run.end)

    def cost(self) -> NDArray[np.int64]:
        """Return the numbers of steps accepted, steps rejected and evaluations so far, as an array.

        Also store in ``self.run`` the time, if any, from which rounding errors may exceed the tolerance
        (:meth:`RunState.note_rounding`).
        """
        self.run.note_rounding(self.zero)
        return self.counts


def smooth_pieces(run: RunState, regime: Regime, rates: list[float]) -> SteppedPieces | SciPyPieces:
    """Return the computation of the smooth motion ``regime`` from the present state of ``run``.

    Its method ``pieces`` yields successive intervals of this motion. Each interval has polynomials of the states in
    time, and a function from times to states.
    ``rates`` are the values of the parameters of the rates.
    """
    motion = regime.motion
    if isinstance(motion, SteppedMotion):
        return SteppedPieces(run, regime, motion, rates)
    return SciPyPieces(run, regime, motion, rates)

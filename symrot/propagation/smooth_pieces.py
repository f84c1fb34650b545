"""The pieces of a smooth motion on its way to the next switch, by each stepper: polynomials, and states at any time."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from symrot.propagation import dop853, taylor
from symrot.propagation.cut_off import CutOff
from symrot.propagation.kernels import error_blocks
from symrot.propagation.polynomials import ROUGH, Piece, fitted, rows_of
from symrot.propagation.regimes import Regime
from symrot.propagation.stepping import Floats

if TYPE_CHECKING:
    from symrot.propagation.switched_run import SwitchedRun

__all__ = ["LEAST_TURN", "SOURCES"]

ROOM = 4  # steps in the first piece after a switch; twice as many in each piece after it
WINDOWS = 64  # pieces of the span that SciPy follows at a time, at first
PER_WINDOW, SHORTER = 20_000, 0.125  # evaluations after which a window ends; the next is that part as long
LEAST_TURN = 1e-3  # rad over the whole span: slower rates are as good as this one
FIT = 0.1  # of the tolerance may be lost where polynomials follow SciPy's solution


class SteppedPieces:
    """Pieces of a motion by a stepper in C."""

    def __init__(self, run: "SwitchedRun", regime: Regime, rates: list[float]) -> None:
        motion = regime.motion
        assert motion.library is not None
        if not np.isfinite(run.y).all():
            raise CutOff(run.t, "its states are not finite there", run.end)
        stepping = taylor if motion.choice.method == "taylor" else dop853
        self.task = stepping.task(motion.library, rates, run.y, run.t, motion.tolerance)
        self.task.way, self.end = run.span, run.end

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        task, room = self.task, ROOM
        for run in task.runs(self.end):
            while run.t != run.stop:
                rows = np.empty((room, task.stepper.row))
                try:
                    task.advance(run, None, 0, None, rows.ctypes.data, room)
                except CutOff as error:
                    stuck: CutOff | None = error
                else:
                    stuck = None
                rows = rows[: run.recorded]
                if len(rows):

                    def states(times: Floats, rows: Floats = rows) -> Floats:
                        inside: Floats = task.stepper.dense(rows, times)
                        return inside

                    yield Piece(np.append(rows[:, 0], run.t), rows_of(task.stepper, rows)), states
                if stuck is not None:
                    raise stuck
                room = min(2 * room, task.stepper.rows_per_call)

    def cost(self) -> Any:
        return np.array([self.task.accepted, self.task.rejected, self.task.evaluations])


class SciPyPieces:
    """Pieces of a motion by SciPy: a window of time after the other."""

    def __init__(self, run: "SwitchedRun", regime: Regime, rates: list[float]) -> None:
        self.run, self.motion, self.rates, self.counts = run, regime.motion, rates, np.zeros(3, dtype=np.int64)

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        from symrot.propagation import fallback

        run, t, y = self.run, self.run.t, self.run.y
        side = 1.0 if run.end >= t else -1.0
        length = run.span / WINDOWS
        options = self.motion.scipy_options | {"deviations": self.motion.rebound(self.rates), "max_steps": PER_WINDOW}
        blocks = error_blocks(self.motion.plan)
        while t != run.end:
            stop = run.end if abs(run.end - t) <= 1.01 * length else t + side * length
            share = max(abs(stop - t) / run.span, 1e-3)
            tolerance = run.motion.tolerance * share
            try:
                recording, stuck = fallback.record_ahead(
                    self.motion.rates, self.rates, y, t, stop, tolerance, **options
                )
            except fallback.Spent as error:  # a shorter window may end before what takes so many, at a switch
                self.counts[2] += PER_WINDOW
                run.spend(PER_WINDOW, t)
                length *= SHORTER
                if t + side * length == t:
                    raise CutOff(t, error.reason, run.end) from None
                continue
            self.counts += recording.stats[:3]
            for edges in recording.edges(t, stop):
                yield fitted(recording, edges, *blocks, least=self._least(recording, edges, tolerance)), recording
            if stuck is not None and not isinstance(stuck, fallback.Spent):
                raise stuck  # beyond a switch, or before one: what was followed may end there
            reached = stop if stuck is None else recording.span[side > 0.0]
            run.spend(recording.stats.evaluations, reached)
            y, t, length = recording(reached), reached, (2.0 if stuck is None else SHORTER) * length

    def _least(self, recording: Any, edges: Floats, tolerance: float) -> float:
        """Return the rates, rad/s, that polynomials need not follow better than to :data:`ROUGH`."""
        (_, rates, *_), scales = error_blocks(self.motion.plan)
        if scales[0] > 0.0:
            return 0.0
        largest = float(np.linalg.norm(recording(edges)[:, :rates], axis=1).max())
        return FIT * tolerance / ROUGH * max(largest, LEAST_TURN / self.run.span)

    def cost(self) -> Any:
        return self.counts


SOURCES: dict[str, Any] = {"taylor": SteppedPieces, "dop853": SteppedPieces, "scipy": SciPyPieces}

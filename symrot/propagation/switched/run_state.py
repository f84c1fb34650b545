"""Present state of a motion under torques with switches (sign, abs, ..): its clock, its states and its cost."""

from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from symrot.propagation.motion import Motion
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.regimes import Modes, Regime

__all__ = ["CHATTER", "RunState"]

CHATTER = 50  # number of recent switches whose times are stored


class RunState:
    """Present state of a motion between its start and one end, on a clock that shows 0 at the last switch.

    Attributes
    ----------
    zero : Instant
        The time at which that clock shows 0.
    t, end, start : float
        Present time, end and start of the motion, s, on that clock.
    span, side : float
        Length of the whole motion, s, and its direction, 1 or -1.
    y : array, shape (N,)
        The states at ``t``.
    spent, mark : int, (int, float)
        SciPy's evaluations; evaluations and distance in time, s, when the pace was last checked.
    interrupt : KeyboardInterrupt or None
        An interrupt that came while SciPy followed the motion beyond a switch.
    recent : deque of Instant
        The times of the last switches.
    """

    def __init__(self, motion: Motion, end: float, modes: Modes) -> None:
        self.motion, self.modes, self.span = motion, modes, abs(end - motion.start)
        self.side = 1.0 if end >= motion.start else -1.0
        self.zero = Instant(motion.start)
        self.t, self.end = 0.0, float(self.zero.since(end))
        self.y = np.array(motion.plan.initial_state, dtype=np.float64)
        self.spent, self.mark = 0, (0, 0.0)
        self.interrupt: KeyboardInterrupt | None = None
        self.recent: deque[Instant] = deque(maxlen=CHATTER)

    @property
    def start(self) -> float:
        return Instant(self.motion.start) - self.zero

    def clock(self, regime: Regime, stepped: Any) -> Callable[[float], tuple[Any, list[float]]] | None:
        """Return a function from an epoch, s, to ``stepped`` (library or function of the rates) and its parameters.

        With these parameters the rates count time from the epoch. The result is None if they do not depend on time.
        """
        parameters = regime.rates_since(self.modes, self.zero)
        return (lambda since: (stepped, parameters(since))) if parameters else None

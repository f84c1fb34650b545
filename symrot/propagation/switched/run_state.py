"""Present state of a motion under torques with switching functions (sign, abs, ..): clock, states and cost."""

from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from symrot.propagation.motions.motion import Motion
from symrot.propagation.steppers.rounding import RoundingSum
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.regimes import Modes, Regime

__all__ = ["CHATTER", "RunState"]

CHATTER = 50  # number of recent switches whose times are stored


class RunState:
    """Present state of a motion under torques that switch, during its computation; time is counted from ``zero``.

    Attributes
    ----------
    zero : Instant
        The instant from which time is counted: the start of the present smooth interval, usually the last switch.
    t, end, start : float
        Present time, end and start of the motion, in s after ``zero``.
    span, side : float
        Length of the whole motion, s, and its direction, 1 or -1.
    y : array, shape (N,)
        The states at ``t``.
    spent : int
        Number of evaluations by SciPy so far, plus a fixed number for each interval that SciPy integrates at once: the
        other work on an interval costs about as much as this number of evaluations.
    mark : (int, float)
        The values of ``spent`` and of the time covered, s, when it was last checked whether the motion advances so
        slowly that its end cannot be reached.
    interrupt : KeyboardInterrupt or None
        A Ctrl-C that came while SciPy computed the motion beyond a switch.
    recent : deque of Instant
        The times of the last switches.
    rounding : RoundingSum
        The sum of the rounding errors, in all steps so far, of torque formulas that contain the time.
    rounded_beyond : list of float
        One time of the scene, s, beyond which these rounding errors may exceed the tolerance; empty if they do not.
    """

    def __init__(self, motion: Motion, end: float, modes: Modes) -> None:
        # a switch: a function such as sign changes its value, which modes holds by name
        self.motion, self.modes, self.span = motion, modes, abs(end - motion.start)
        self.side = 1.0 if end >= motion.start else -1.0
        self.zero = Instant(motion.start)
        self.t, self.end = 0.0, float(self.zero.since(end))
        self.y = np.array(motion.plan.initial_state, dtype=np.float64)
        self.spent, self.mark = 0, (0, 0.0)
        self.interrupt: KeyboardInterrupt | None = None
        self.recent: deque[Instant] = deque(maxlen=CHATTER)
        self.rounding = RoundingSum(motion.tolerance)
        self.rounded_beyond: list[float] = []

    @property
    def start(self) -> float:
        return Instant(self.motion.start) - self.zero

    def note_rounding(self, zero: Instant) -> None:
        """Store in :attr:`rounded_beyond` the time, if any, from which rounding errors may exceed the tolerance.

        The sum of the errors, :attr:`rounding`, has this time as ``rounding.beyond``, in s after the instant ``zero``.
        The stored number is the time of the scene, s. Only the first such time of a motion is stored.
        """
        if not self.rounded_beyond and self.rounding.beyond is not None:
            self.rounded_beyond.append(zero.after(self.rounding.beyond).high)

    def clock(self, regime: Regime, stepped: Any) -> Callable[[float], tuple[Any, list[float]]] | None:
        """Return the function that a stepper calls to count time from a new epoch; None if no rate depends on time.

        The epoch is the time at which the stepper sets its clock to 0. The function takes the epoch, s after the
        instant :attr:`zero`. It returns the pair (``stepped``, values of parameters). ``stepped``, a library or a
        Python function, computes the rates, and is the same for every epoch; with these values of its parameters, the
        rates take the time since the epoch.
        """
        parameters = regime.rates_since(self.modes, self.zero)
        return (lambda since: (stepped, parameters(since))) if parameters else None

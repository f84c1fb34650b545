"""The cost of a propagation, and the times at which torques switch."""

from collections.abc import Iterable
from typing import Any, NamedTuple

__all__ = ["Stats", "Switching", "rounding_warning", "stats_of"]


class Switching(NamedTuple):
    """The time at which a function in a torque, such as ``sign(omega_3)``, switches.

    Attributes
    ----------
    t : float
        The time, s.
    function : str
        The function as the scene writes it.
    how : str
        ``"passed"``: the argument changes its sign, or, for floor and mod, passes a multiple of the divisor.
        ``"held"``: it stays at zero from then on, as omega_3 of a wheel that dry friction holds at rest.
        ``"released"``: it leaves zero after it was held there.
    """

    t: float
    function: str
    how: str


class Stats(NamedTuple):
    """The cost of a propagation.

    Attributes
    ----------
    accepted, rejected : int
        Numbers of accepted and rejected steps.
    evaluations : int
        Evaluations of the kernel; with Taylor series, one evaluation computes all coefficients of a step.
    seconds : float
        Time of the whole propagation.
    switches : int
        Number of changes of the Euler sequence if Euler angles are the state; otherwise the number of switching times.
    switching_times : tuple of float
        Times, s, without repetition, at which functions such as sign switch in the torques.
    switchings : tuple of Switching
        The functions that switch, with their times.
    rounded_beyond : tuple of float
        Times, s, from which on rounding errors may change the motion by more than the tolerance: at most one time after
        the start of the motion and one before it. The errors arise where the formula of a torque contains the time, and
        in the steps of SciPy's methods. Empty if the rounding errors do not matter.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate("t_handle").stats.rejected >= 0
    True
    """

    accepted: int
    rejected: int
    evaluations: int
    seconds: float
    switches: int = 0
    switching_times: tuple[float, ...] = ()
    switchings: tuple[Switching, ...] = ()
    rounded_beyond: tuple[float, ...] = ()

    def later(self, epoch: float) -> "Stats":
        """Return the statistics of an integration with :attr:`rounded_beyond` converted to scene times.

        ``epoch``, s, is added to these times. The times of switches need no conversion: one integration covers one
        smooth interval between switches and records none.
        """
        return self._replace(rounded_beyond=tuple([t + epoch for t in self.rounded_beyond]))


def rounding_warning(t: float, method: str) -> str:
    """Return a warning that from the time t, s, on rounding errors may exceed the tolerance.

    t is one of the times in ``Stats.rounded_beyond``. The errors arise in formulas that contain the time and, if
    ``method`` is a method of SciPy, also in its steps.
    """
    if method.startswith("scipy"):
        return (
            f"beyond t = {t!r} s rounding errors, in the steps of SciPy or in a formula that contains the time, may "
            "change the motion by more than the tolerance; choose a larger tolerance, or the method taylor or dop853"
        )
    return (
        f"beyond t = {t!r} s the rounding of the torque, a formula that contains the time, may change the motion by "
        "more than the tolerance; choose a larger tolerance"
    )


def stats_of(cost: Any, seconds: float, switchings: Iterable[Switching], rounded_beyond: Iterable[float] = ()) -> Stats:
    """Return the statistics of a motion from its cost and its switches, which are sorted by time.

    ``cost`` has the numbers of accepted steps, rejected steps and evaluations; ``seconds`` is the computing time.
    ``rounded_beyond`` has times, s, from which on rounding errors may exceed the tolerance.
    """
    accepted, rejected, evaluations = map(int, cost)
    listed = tuple(sorted(switchings))
    times = tuple(sorted({change.t for change in listed}))  # coinciding switches count once
    return Stats(accepted, rejected, evaluations, seconds, len(times), times, listed, tuple(rounded_beyond))

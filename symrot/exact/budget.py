"""A counted budget for one decision: readings of formulas into rings, of which towers of functions ask for many.

Each root under a root and each inverse function inside another one is read in a ring of its own, and their proofs read
both sides again. The count is the same on every machine.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_RINGS", "one_decision", "spend_ring"]

MOST_RINGS = 2000
"""Readings that one decision may take: seconds of work; the claims of the campaign take 400 at most."""

_left: ContextVar[list[int] | None] = ContextVar("rings left", default=None)


@contextmanager
def one_decision() -> Iterator[None]:
    """Count the readings inside; a decision inside another one has the budget of the outer one."""
    if _left.get() is not None:
        yield
        return
    token = _left.set([MOST_RINGS])
    try:
        yield
    finally:
        _left.reset(token)


def spend_ring() -> None:
    """Count one reading.

    Raises
    ------
    TooLarge
        When the budget of the decision is spent.
    """
    left = _left.get()
    if left is None:
        return
    left[0] -= 1
    if left[0] < 0:
        raise TooLarge(f"the functions inside each other take more than {MOST_RINGS} readings of parts of the formula")

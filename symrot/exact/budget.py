"""A counted budget for one decision: the number of times that formulas are read into rings.

Each root under a root and each inverse function inside another one is read in a ring of its own, and the proofs about
them read both sides again, so that nested functions need many readings. The result of a reading is remembered until the
decision ends, no longer: so the count, and with it the verdict, is the same on every machine and in any order of
decisions.
"""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_RINGS", "one_decision", "remembered", "spend_ring"]

MOST_RINGS = 2000
"""Readings that one decision may need, which is seconds of work; claims of the campaigns need 400 at most."""


@dataclass
class _Budget:
    """The readings that one decision may still do, and the results of those that it has done."""

    left: int = MOST_RINGS
    results: dict[Hashable, Any] = field(default_factory=dict)


_current: ContextVar[_Budget | None] = ContextVar("budget of the decision", default=None)


@contextmanager
def one_decision() -> Iterator[None]:
    """Count the readings of one decision; a decision inside another one shares the budget of the outer one."""
    if _current.get() is not None:
        yield
        return
    token = _current.set(_Budget(MOST_RINGS))
    try:
        yield
    finally:
        _current.reset(token)


def remembered(key: Hashable, compute: Callable[[], Any]) -> Any:
    """Return a result that depends on the key alone: computed once in a decision, outside of one at every call."""
    budget = _current.get()
    if budget is None:
        return compute()
    if key not in budget.results:
        budget.results[key] = compute()
    return budget.results[key]


def spend_ring() -> None:
    """Count one reading.

    Raises
    ------
    TooLarge
        When the budget of the decision is spent.
    """
    budget = _current.get()
    if budget is None:
        return
    budget.left -= 1
    if budget.left < 0:
        raise TooLarge(f"the functions inside each other take more than {MOST_RINGS} readings of parts of the formula")

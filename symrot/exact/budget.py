"""A counted budget for one decision: readings of formulas into rings, of which towers of functions ask for many.

Each root under a root and each inverse function inside another one is read in a ring of its own, and their proofs read
both sides again. What one reading finds is remembered until the decision ends, no longer: so the count, and with it the
verdict, is the same on every machine and after any other decisions.
"""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_RINGS", "one_decision", "remembered", "spend_ring"]

MOST_RINGS = 2000
"""Readings that one decision may take: seconds of work; the claims of the campaign take 400 at most."""


@dataclass
class _Budget:
    """Readings that are left to one decision, and the results that it has already."""

    left: int = MOST_RINGS
    results: dict[Hashable, Any] = field(default_factory=dict)


_current: ContextVar[_Budget | None] = ContextVar("budget of the decision", default=None)


@contextmanager
def one_decision() -> Iterator[None]:
    """Count the readings inside; a decision inside another one has the budget of the outer one."""
    if _current.get() is not None:
        yield
        return
    token = _current.set(_Budget(MOST_RINGS))
    try:
        yield
    finally:
        _current.reset(token)


def remembered(key: Hashable, compute: Callable[[], Any]) -> Any:
    """Return a result that depends on the key alone, computed once in a decision; outside of one, each time."""
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

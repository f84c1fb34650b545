"""A budget for one decision on whether an equation is true: the number of polynomial rings that may be built.

Nested roots and inverse functions need many rings. Results are stored only until the decision ends, so the count,
and with it the verdict, is the same on every machine and for any order of decisions.
"""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from symrot.exact.limits.operations import spend
from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_RINGS", "one_decision", "remembered", "spend_ring"]

MOST_RINGS = 2000
"""Largest number of polynomial rings that may be built to decide one equation; building them takes seconds.

The claims of the random tests need at most 400."""

OPERATIONS_OF_RING = 500
"""Number of operations that one new polynomial ring costs, besides those that depend on the size of its formulas."""


@dataclass
class _Budget:
    """What remains of the budget of one decision, and the results stored for this decision."""

    left: int = MOST_RINGS  # number of polynomial rings that may still be built
    results: dict[Hashable, Any] = field(default_factory=dict)


_current: ContextVar[_Budget | None] = ContextVar("budget of the decision", default=None)


@contextmanager
def one_decision() -> Iterator[None]:
    """Return a context (``with one_decision():``) for deciding one equation, with one budget of polynomial rings.

    A context inside another one shares the budget of the outer one.
    """
    if _current.get() is not None:
        yield
        return
    token = _current.set(_Budget(MOST_RINGS))
    try:
        yield
    finally:
        _current.reset(token)


def remembered(key: Hashable, compute: Callable[[], Any]) -> Any:
    """Return ``compute()``; in a context :func:`one_decision` the result is stored and computed once for each ``key``.

    Outside such a context, ``compute`` is called every time.
    """
    budget = _current.get()
    if budget is None:
        return compute()
    if key not in budget.results:
        budget.results[key] = compute()
    return budget.results[key]


def spend_ring() -> None:
    """Count one more polynomial ring against the budget of the context :func:`one_decision`, if there is one.

    The operations that building the ring takes count against the budget of the claim, if there is one
    (:func:`symrot.exact.limits.operations.one_claim`).

    Raises
    ------
    TooLarge
        If the budget of the context is exhausted.
    OutOfOperations
        If the budget of the claim is exhausted.
    """
    spend(OPERATIONS_OF_RING)
    budget = _current.get()
    if budget is None:
        return
    budget.left -= 1
    if budget.left < 0:
        raise TooLarge(
            f"expected a formula that needs at most {MOST_RINGS} conversions of nested parts to "
            "polynomials, got more; split the formula"
        )

"""The budget of operations for checking one claim, an equation or relation that a document states.

The decision of whether the claim is true counts, and so do other readings of an ambiguous text and the search for
repairs, formulas that correct a false claim.

The count depends on the formulas alone, so a claim gets the same verdict on every machine.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

__all__ = ["MOST_OPERATIONS", "OutOfOperations", "one_claim", "operations_left", "spend"]

MOST_OPERATIONS = 2_000_000
"""Largest number of operations for one claim. An operation takes some microseconds: the product of two terms counts
as one, a value of a sine at a point as twenty."""


class OutOfOperations(BaseException):
    """The exception for a claim that needs more operations than its budget allows.

    It is not derived from ``Exception``, so that code that catches the exceptions of a failed proof does not catch it.
    """


_left: ContextVar[list[int] | None] = ContextVar("operations left for the claim", default=None)


@contextmanager
def one_claim(most: int) -> Iterator[None]:
    """Return a context for one claim, in which at most ``most`` operations are allowed.

    A context inside another one shares the budget of the outer one. For example, the context for a repair, a formula
    that may correct a false claim, lies inside the context for this claim.
    """
    if _left.get() is not None:
        yield
        return
    token = _left.set([most])
    try:
        yield
    finally:
        _left.reset(token)


def spend(operations: int) -> None:
    """Count some operations; outside a claim nothing is counted.

    Raises
    ------
    OutOfOperations
        If the budget of the claim is exhausted.
    """
    left = _left.get()
    if left is None:
        return
    left[0] -= operations
    if left[0] < 0:
        raise OutOfOperations


def operations_left() -> int | None:
    """Return how many operations the budget of the claim still has; None outside a claim."""
    left = _left.get()
    return None if left is None else left[0]

"""Recognise SymPy's error about numbers that it cannot order, as for ``acos(cos(c))`` with c almost equal to pi."""

__all__ = ["is_unordered"]


def is_unordered(reason: BaseException | None) -> bool:
    """Return whether SymPy raised an error because it could not tell which of two numbers is larger."""
    while reason is not None:
        if isinstance(reason, TypeError) and "truth value of Relational" in str(reason):
            return True
        # the error that this one replaced
        reason = reason.__context__
    return False

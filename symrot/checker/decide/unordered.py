"""Numbers that SymPy cannot order while it builds a formula, such as ``acos(cos(c))`` with an unrecognised pi in c."""

__all__ = ["is_unordered"]


def is_unordered(reason: BaseException | None) -> bool:
    """Return whether SymPy raised an error because it could not tell which of two numbers is larger.

    ``reason`` is the error; errors before it, which it replaced, are examined too.
    """
    while reason is not None:
        if isinstance(reason, TypeError) and "truth value of Relational" in str(reason):
            return True
        reason = reason.__context__
    return False

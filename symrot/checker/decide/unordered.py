"""Numbers that SymPy cannot order while it builds a formula, such as ``acos(cos(c))`` with an unrecognised pi in c."""

__all__ = ["is_unordered"]


def is_unordered(reason: BaseException | None) -> bool:
    """Return whether an error of SymPy means that it could not find out which of two numbers is larger."""
    while reason is not None:
        if isinstance(reason, TypeError) and "truth value of Relational" in str(reason):
            return True
        reason = reason.__context__
    return False

"""Numbers that SymPy compares while it builds a formula, and cannot tell apart: ``acos(cos(c))``, c being pi unseen."""

__all__ = ["is_unordered"]


def is_unordered(reason: BaseException | None) -> bool:
    """Return whether an error of SymPy comes from two numbers whose order it could not tell.

    SymPy raises a TypeError, out of which the wrapper of its cache makes an AttributeError.
    """
    while reason is not None:
        if isinstance(reason, TypeError) and "truth value of Relational" in str(reason):
            return True
        reason = reason.__context__
    return False

"""The size of a formula: the number of its subexpressions."""

from collections.abc import Iterable

from sympy import Expr

__all__ = ["pieces"]


def pieces(entries: Iterable[Expr]) -> int:
    """Return the number of subexpressions in formulas as they are written; repeated ones count every time."""
    known: dict[Expr, int] = {}

    def count(node: Expr) -> int:
        if node not in known:
            known[node] = 1 + sum(map(count, node.args))
        return known[node]

    return sum(map(count, entries))

"""The conditions under which a formula is a real number: on its radicands, logarithms and divisors.

All functions take real values for real arguments, on their principal branch. A power ``u^(p/q)`` in lowest terms, q >
1, is real only for u >= 0: SymPy's cube root of -8 is ``1 + sqrt(3) i``.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import sympy
from sympy import Expr, cos, sin, sinh
from sympy.core.function import AppliedUndef
from sympy.matrices.expressions.matexpr import MatrixElement

from symrot.exact.intervals import INTERVAL

__all__ = ["Need", "assumptions_of", "fits_assumptions", "is_leaf", "leaves_of", "needs_of"]


@dataclass(frozen=True)
class Need:
    """A condition such as ``x >= 0``, without which a formula that contains ``sqrt(x)`` has no real value."""

    formula: Expr  # left side
    sign: str  # ">= 0", "> 0" or "!= 0"; "real" for a function that symrot does not know

    def __str__(self) -> str:
        return f"{self.formula} is real" if self.sign == "real" else f"{self.formula} {self.sign}"


# A term that SymPy cancels when it builds a formula (``0*log(x)``) is not seen here; the reader of claims records it.
_NEEDS: dict[type, Callable[..., list[tuple[Expr, str]]]] = {
    sympy.log: lambda u: [(u, "> 0")],
    sympy.asin: lambda u: [(1 - u, ">= 0"), (1 + u, ">= 0")],
    sympy.acos: lambda u: [(1 - u, ">= 0"), (1 + u, ">= 0")],
    sympy.acosh: lambda u: [(u - 1, ">= 0")],
    sympy.atanh: lambda u: [(1 - u, "> 0"), (1 + u, "> 0")],
    sympy.tan: lambda u: [(cos(u), "!= 0")],
    sympy.sec: lambda u: [(cos(u), "!= 0")],
    sympy.cot: lambda u: [(sin(u), "!= 0")],
    sympy.csc: lambda u: [(sin(u), "!= 0")],
    sympy.coth: lambda u: [(sinh(u), "!= 0")],
    sympy.sign: lambda u: [(u, "!= 0")],
    sympy.atan2: lambda y, x: [(x**2 + y**2, "!= 0")],
}
"""Function -> the conditions on its arguments for a real value, as pairs (formula, sign): ``(u, "> 0")`` for log(u).

Other functions of :data:`symrot.exact.intervals.INTERVAL` have no conditions. The function ``sign`` is the derivative
of an absolute value, which does not exist at zero."""


def is_leaf(node: Expr) -> bool:
    """Return whether a node is a symbol, a function of time such as f(t), a derivative of f(t), or a matrix entry."""
    if isinstance(node, sympy.Derivative):
        return isinstance(node.expr, AppliedUndef)
    return bool(node.is_Symbol) or isinstance(node, AppliedUndef | MatrixElement)


def leaves_of(formulas: Iterable[Expr]) -> list[Expr]:
    """Return the symbols and other leaves (:func:`is_leaf`), such as f(t), in formulas, each once, sorted by name."""
    leaves = {node for node in _pieces(formulas) if is_leaf(node)}
    return sorted(leaves, key=lambda leaf: (str(leaf), type(leaf).__name__))


def assumptions_of(leaf: Expr) -> list[Need]:
    """Return the conditions that SymPy's assumptions on a symbol state, such as ``x > 0``."""
    known = ((leaf, "> 0", leaf.is_positive), (-leaf, "> 0", leaf.is_negative), (leaf, ">= 0", leaf.is_nonnegative),
             (-leaf, ">= 0", leaf.is_nonpositive), (leaf, "!= 0", leaf.is_nonzero))  # fmt: skip
    return [Need(formula, sign) for formula, sign, assumed in known if assumed]


def fits_assumptions(leaf: Expr, value: Any) -> bool:
    """Return whether a rational ``value`` agrees with SymPy's assumptions on the symbol ``leaf``, such as positive."""
    return not (
        (leaf.is_positive and value <= 0) or (leaf.is_negative and value >= 0) or (leaf.is_nonnegative and value < 0)
        or (leaf.is_nonpositive and value > 0) or (leaf.is_nonzero and value == 0)
        or (leaf.is_integer and int(value.denominator) != 1)
    )  # fmt: skip


def needs_of(formulas: Iterable[Expr]) -> list[Need]:
    """Return the conditions under which all ``formulas`` are real: ``x > 0`` and ``y != 0`` for ``log(x)/y``."""
    needs: dict[Need, None] = {}
    for node in _pieces(formulas):
        for need in _needs(node):
            # conditions that follow from SymPy's assumptions on the symbols are omitted
            if not _granted(need):
                needs[need] = None
    return list(needs)


def _needs(node: Expr) -> Iterator[Need]:
    if is_leaf(node) or node.is_Rational or node.is_Add or node.is_Mul:
        return
    if node.is_Pow:
        base, exponent = node.args
        if exponent.is_Integer:
            if exponent < 0:
                yield Need(base, "!= 0")
        elif exponent.is_Rational:
            yield Need(base, ">= 0" if exponent > 0 else "> 0")
        else:
            yield Need(base, "> 0")
    elif type(node) in _NEEDS:
        yield from (Need(formula, sign) for formula, sign in _NEEDS[type(node)](*node.args))
    elif type(node) not in INTERVAL and node not in (sympy.pi, sympy.S.Exp1):
        yield Need(node, "real")


def _granted(need: Need) -> bool:
    """Return whether a condition follows from SymPy's assumptions on the symbols, so that it needs no proof."""
    formula = need.formula
    # SymPy's numerical answer for a number such as sqrt(2) - 1 is not trusted
    if need.sign == "real" or not (formula.is_Rational or formula.free_symbols):
        return False
    known = {">= 0": formula.is_nonnegative, "> 0": formula.is_positive, "!= 0": formula.is_nonzero}
    return bool(known[need.sign])


def _pieces(formulas: Iterable[Expr]) -> Iterator[Expr]:
    """Yield every subexpression of formulas once; a function of time f(t) is yielded, but not its argument t."""
    # a stack, because recursion would be too deep for large formulas
    stack, seen = list(formulas), set()
    while stack:
        node = stack.pop()
        if node in seen:
            continue
        seen.add(node)
        yield node
        if not is_leaf(node):
            stack.extend(node.args)

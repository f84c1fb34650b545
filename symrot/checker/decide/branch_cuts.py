"""The equations that a claim becomes on the branch cuts of its functions ``atan2(y, x)``, where y = 0 and x < 0.

A proof that divides by a formula that is zero on a branch cut says nothing about the points of the cut. Nor can these
points be reached as limits of other points, since atan2 jumps at the cut.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sympy import Abs, Expr, Function, Poly, atan2, cos, pi, roots, sin

from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.ranges.text import range_text
from symrot.exact.decide import normal_form
from symrot.exact.printing import as_text

__all__ = ["BranchCut", "branch_cuts"]


@dataclass(frozen=True)
class BranchCut:
    """The branch cut of ``atan2(y, x)``, where y = 0 and x < 0.

    ``zero`` is a formula that is zero where y is zero, such as y without its constant factor; ``negative`` is x.
    ``values`` maps each atan2 whose first argument vanishes on the cut to the value of this atan2 on the cut.
    """

    zero: Expr
    negative: Expr
    values: dict[Expr, Expr]

    @property
    def solutions(self) -> list[dict[Expr, Expr]]:
        """Real solutions of the equation that sets the formula ``zero`` to 0, each as {symbol: value} for one symbol.

        Only two kinds of equations are solved: those in which a symbol has a number as coefficient, such as x in
        ``2*x + y**2 == 0``, and those of degree 2 in their only symbol. For other equations the list is empty.
        """
        for symbol in sorted(self.zero.free_symbols, key=str):
            slope, rest = self.zero.diff(symbol), self.zero.subs(symbol, 0)
            if slope.is_number:
                return [{symbol: -rest / slope}]
            if self.zero.free_symbols == {symbol} and slope.diff(symbol).is_number and self.zero.is_polynomial():
                return [{symbol: root} for root in roots(Poly(self.zero, symbol)) if root.is_real]
        return []

    @property
    def elsewhere(self) -> str:
        """The condition for a point off the cut as text: ``"y != 0 or x > 0"``."""
        positive = range_text([(self.negative, "> 0")]) if self.negative.free_symbols else ""
        return " or ".join(filter(None, (f"{as_text(self.zero)} != 0", positive)))


def branch_cuts(formulas: Sequence[Expr]) -> Iterator[BranchCut]:
    """Yield the branch cuts of the functions atan2 in formulas, each once.

    The cut of ``atan2(y, x)`` is left out in three cases: y is a number; x is never negative, so that there is no cut;
    or y contains a function other than sine and cosine, since points with y = 0 are then hard to find.
    """
    jumps = sorted({node for formula in formulas for node in formula.atoms(atan2)}, key=str)
    known = set()
    for jump in jumps:
        zero, negative = _without_content(jump.args[0]), jump.args[1]
        # no point is found where another function, such as an exponential, is zero
        is_easy = zero.is_polynomial() or zero.atoms(Function) == zero.atoms(sin, cos)
        if zero.is_number or not is_easy or surely_nonnegative(negative) or (zero, negative) in known:
            continue
        known.add((zero, negative))
        values = {}
        for other in jumps:
            if other is jump or normal_form(other.args[0], [zero]) == 0:
                second = other.args[1]
                # 0 if the second argument is positive, pi if it is negative
                values[other] = pi * (1 - second / Abs(second)) / 2
        yield BranchCut(zero, negative, values)


def _without_content(formula: Expr) -> Expr:
    """Return a formula without its numerical factor and sign, and without an outer power: y for ``-2*y**3``."""
    bare = formula.primitive()[1]
    bare = -bare if bare.could_extract_minus_sign() else bare
    return bare.base if bare.is_Pow and bare.exp.is_Integer and bare.exp > 0 else bare

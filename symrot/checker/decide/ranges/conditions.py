"""Conditions on signs in their simplest form: ranges of quantities, signs of products, formulas that are nonzero."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy
from sympy import Abs, Expr, Integer, Mul, cos, sin

from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.ranges.factors import (
    Bound,
    bound_of,
    is_always_positive,
    nonnegative_at_zero,
    sign_and_factors,
)
from symrot.errors import InputError
from symrot.exact.limits.size import pieces
from symrot.exact.plain_arguments import with_plain_arguments

__all__ = ["Conditions", "Range", "Sign"]

MOST_PIECES = 80
"""The largest number of symbols and operations in a formula that is split into factors."""

Sign = tuple[Expr, str]
"""A condition (formula, sign): the formula is ``"> 0"``, ``">= 0"`` or ``"!= 0"``."""


@dataclass
class Range:
    """The lower and the upper bound of a quantity, each a number or None.

    ``low_closed`` and ``high_closed`` say whether the quantity may equal its lower and its upper bound.
    """

    low: Expr | None = None
    high: Expr | None = None
    low_closed: bool = True
    high_closed: bool = True

    def narrow(self, root: Expr, closed: bool, above: bool) -> None:
        """Add the bound ``root``, a lower one if ``above``, otherwise an upper one; the quantity may equal it if
        ``closed``.
        """
        name = "low" if above else "high"
        known = getattr(self, name)
        # a weaker bound than the known one changes nothing
        tighter = known is None or ((root - known) if above else (known - root)).is_positive
        if tighter:
            setattr(self, name, root)
            setattr(self, f"{name}_closed", closed)
        elif known == root:
            setattr(self, f"{name}_closed", closed and getattr(self, f"{name}_closed"))

    def sign_of(self, root: Expr) -> tuple[int, bool]:
        """Return (sign, zero) for the difference q - ``root`` of a quantity q in this range.

        The sign is 1 or -1, and zero says whether the difference may be zero: (1, True) for q >= 2 and root 2. Return
        (0, True) if the sign is unknown.
        """
        for bound, closed, sign in ((self.low, self.low_closed, 1), (self.high, self.high_closed, -1)):
            distance = None if bound is None else sign * (bound - root)
            if distance is not None and distance.is_nonnegative:
                return sign, bool(distance.is_zero) and closed
        return 0, True


@dataclass
class Conditions:
    """Conditions in their simplest form, to be written as text.

    Attributes
    ----------
    ranges : mapping
        Quantity -> its bounds.
    products : list of (mapping, int, str)
        Conditions on products of at least two factors: (factor -> power, direction, sign), which say that direction (1
        or -1) times the product has the sign ``"> 0"`` or ``">= 0"``.
    nonzero : mapping
        Formulas that must not be zero, in the order in which they came.
    whole : list of (Expr, str)
        Conditions whose formulas were not factored.
    """

    ranges: dict[Expr, Range] = field(default_factory=dict)
    products: list[tuple[Mapping[Expr, int], int, str]] = field(default_factory=list)
    nonzero: dict[Expr, None] = field(default_factory=dict)
    whole: list[Sign] = field(default_factory=list)

    @classmethod
    def of(cls, signs: Sequence[Sign], divided: bool = True) -> "Conditions":
        """Return the conditions ``signs`` in their simplest form.

        With ``divided``, the conditions that divisors in their formulas are nonzero are added: y != 0 for x/y >= 0.
        """
        conditions = cls()
        for formula, sign in signs:
            # if ``divided``, x/y >= 0 also gives y != 0; other callers state nonzero divisors themselves
            conditions._add(_with_plain_functions(formula), sign, divided)
        conditions._settle()
        return conditions

    def _add(self, formula: Expr, sign: str, divided: bool = True) -> None:
        factored = sign_and_factors(formula) if pieces([formula]) <= MOST_PIECES else None
        if factored is None:
            self.whole.append((formula, sign))
            return
        direction, powers = factored
        odd: dict[Expr, int] = {}
        square: list[Expr] = []
        for factor, power in powers.items():
            if is_always_positive(factor):
                continue
            if is_always_positive(-factor):
                direction *= -1 if power % 2 else 1
                continue
            signless = isinstance(factor, Abs) or power % 2 == 0
            if sign != ">= 0" or (power < 0 and divided):
                self._exclude(factor)
            if sign != "!= 0" and not signless:
                odd[factor] = 1
            elif sign == ">= 0" and power > 0:
                square.append(factor.args[0] if isinstance(factor, Abs) else factor)
        if sign == "!= 0" or (not odd and direction > 0):
            return
        product = direction * Mul(*odd)
        square = [factor for factor in square if factor not in odd and not nonnegative_at_zero(product, factor)]
        if not odd or square:  # f^2 g >= 0 also where f is zero and g is negative
            if not surely_nonnegative(formula):
                self.whole.append((formula, sign))
            return
        self.products.append((odd, direction, sign))

    def _exclude(self, factor: Expr) -> None:
        """Add the condition that a factor is nonzero."""
        if isinstance(factor, Abs):
            self._add(factor.args[0], "!= 0")
        else:
            self.nonzero[bound_of(factor).formula] = None

    def _settle(self) -> None:
        """Simplify each condition on a product as far as possible: ``x*(y - 1) >= 0`` with x > 0 becomes y >= 1."""
        changed = True
        while changed:
            changed = False
            for entry in list(self.products):
                # a single factor becomes a bound in the ranges
                simpler = self._simpler(entry)
                if simpler != entry:
                    self.products.remove(entry)
                    changed = True
                    if simpler is not None:
                        self.products.append(simpler)
        strict = [entry for entry in self.products if entry[2] == "> 0"]
        for factors, direction, _ in strict:
            same = (factors, direction, ">= 0")
            self.products = [entry for entry in self.products if entry != same]
        self.products = [entry for n, entry in enumerate(self.products) if entry not in self.products[:n]]
        implied = [
            bound_of(factor).formula for factors, _, sign in self.products if sign == "> 0" for factor in factors
        ]
        self.nonzero = {
            formula: None for formula in self.nonzero if formula not in implied and not self._excludes(formula)
        }

    def _simpler(self, entry: tuple[Mapping[Expr, int], int, str]) -> tuple[Mapping[Expr, int], int, str] | None:
        """Return the condition ``entry`` on a product without its factors of known sign, or None if it is not needed.

        The condition is a triple (powers of the factors, direction, sign): ({x: 1, y: 1}, -1, ">= 0") means -x*y >= 0.
        It is not needed in two cases. It always holds; or it bounds a single quantity, as ``2*x - pi >= 0`` does, and
        the method has narrowed the range of this quantity in ``self.ranges``, here to x >= pi/2.
        """
        factors, direction, sign = entry
        bounds = {factor: bound_of(factor) for factor in factors}
        if sign == ">= 0" and all(bound.formula in self.nonzero for bound in bounds.values()):
            sign = "> 0"
        if len(factors) == 1:
            ((factor, bound),) = bounds.items()
            above = direction * bound.slope > 0
            self.ranges.setdefault(bound.quantity, self._new_range(bound.quantity)).narrow(
                bound.root, sign == ">= 0", above
            )
            # a bound on one quantity narrows its range instead
            return None
        if len({bound.quantity for bound in bounds.values()}) == 1 and self._between(bounds, direction, sign):
            return None
        open_factors, may_vanish = {}, False
        for factor, bound in bounds.items():
            known, zero = (
                self.ranges[bound.quantity].sign_of(bound.root) if bound.quantity in self.ranges else (0, True)
            )
            zero = zero and bound.formula not in self.nonzero
            if not known:
                open_factors[factor] = 1
                continue
            may_vanish = may_vanish or zero
            direction *= known * bound.slope
        # it holds everywhere
        if not open_factors and direction > 0 and (sign == ">= 0" or not may_vanish):
            return None
        return (open_factors, direction, sign) if open_factors and not may_vanish else (*entry[:2], sign)

    def _new_range(self, quantity: Expr) -> Range:
        """Return the range that ``quantity`` has by its form alone: -1 to 1 for a sine, 0 and above for a square."""
        if isinstance(quantity, sin | cos):
            return Range(Integer(-1), Integer(1))
        return Range(Integer(0)) if surely_nonnegative(quantity) else Range()

    def _between(self, bounds: Mapping[Expr, Bound], direction: int, sign: str) -> bool:
        """Narrow the range of q to [a, b] if a condition is ``(q - a)*(b - q) >= 0``; return whether it is.

        The condition says that ``direction`` (1 or -1) times a product has the ``sign`` ">= 0" or "> 0"; for "> 0", the
        ends a and b are excluded. ``bounds`` maps each factor of the product to its Bound, ``slope*(q - root)``.
        """
        first, second, *more = sorted(bounds.values(), key=lambda bound: bound.root.evalf())
        if more or direction * first.slope * second.slope > 0:
            return False
        own = self.ranges.setdefault(first.quantity, self._new_range(first.quantity))
        own.narrow(first.root, sign == ">= 0", above=True)
        own.narrow(second.root, sign == ">= 0", above=False)
        return True

    def _excludes(self, formula: Expr) -> bool:
        """Return whether ``self.ranges`` and ``self.products`` state the known condition ``formula != 0`` too.

        If the formula is zero at an end of a range, the method removes this end and returns True: for the formula x,
        the range ``x >= 0`` becomes ``x > 0``, which states x != 0.
        """
        bound = bound_of(formula)
        if bound.root == 0 and isinstance(bound.quantity, sin | cos) and self._angle_excludes(bound.quantity):
            return True
        if any(self._lies_between(bound, factors, direction) for factors, direction, _ in self.products):
            return True
        own = self.ranges.get(bound.quantity)
        if own is None:
            if not isinstance(bound.quantity, sin | cos):
                return False
            own = self._new_range(bound.quantity)
            return own.sign_of(bound.root) != (0, True) and not own.sign_of(bound.root)[1]
        # the zero is an end of the range, which then excludes it
        if own.low == bound.root:
            own.low_closed = False
        if own.high == bound.root:
            own.high_closed = False
        return bool(own.sign_of(bound.root)[0])

    def _lies_between(self, bound: Bound, factors: Mapping[Expr, int], direction: int) -> bool:
        """Return whether a condition on a product excludes the root of ``bound``: (x - 1)*(x + 1) >= 0 excludes x = 0.

        The condition says that ``direction``, 1 or -1, times the product of ``factors`` is not negative. The product
        must have two linear factors in the same quantity, here x. The root of ``bound`` must be between their roots,
        and the condition must fail there.
        """
        pair = [bound_of(factor) for factor in factors]
        if len(pair) != 2 or any(other.quantity != bound.quantity for other in pair):
            return False
        outside = direction * pair[0].slope * pair[1].slope > 0
        return outside and bool(((bound.root - pair[0].root) * (bound.root - pair[1].root)).is_negative)

    def grants(self, quantity: Expr, own: Range) -> bool:
        """Return whether other conditions imply that a cosine is in the range ``own``, which then need not be printed.

        Every cosine is between -1 and 1. The attributes ``nonzero`` and ``products`` may also say that cos(u/2) is not
        zero, which implies cos(u) > -1, or that sin(u/2) is not zero, which implies cos(u) < 1. Return False if
        ``quantity`` is no cosine.
        """
        if not isinstance(quantity, cos):
            return False
        half = quantity.args[0] / 2
        factors = {factor for product in self.products if product[2] == "> 0" for factor in product[0]}
        known = {*self.nonzero, *factors}
        # cos(u) > -1 holds if cos(u/2) is not zero, cos(u) < 1 if sin(u/2) is not zero
        below = own.low == -1 and (own.low_closed or cos(half) in known)
        above = own.high == 1 and (own.high_closed or sin(half) in known)
        return below and above

    def _angle_excludes(self, function: Expr) -> bool:
        """Return whether a sine or cosine is nonzero in the range of its angle, as sin(x) for 0 < x < pi."""
        angle = bound_of(function.args[0])
        own = self.ranges.get(angle.quantity)
        if own is None or own.low is None or own.high is None or angle.slope < 0 or angle.root != 0:
            return False
        scale = (function.args[0] / angle.quantity).cancel()
        if not scale.is_Rational:
            return False
        ends = (-sympy.pi / 2, sympy.pi / 2) if isinstance(function, cos) else (Integer(0), sympy.pi)
        below, above = (scale * own.low - ends[0], ends[1] - scale * own.high)
        return bool(
            (below.is_positive or (below == 0 and not own.low_closed))
            and (above.is_positive or (above == 0 and not own.high_closed))
        )


def _with_plain_functions(formula: Expr) -> Expr:
    """Return a formula with simplified arguments of functions: ``cos(0)``, which is 1, for
    ``cos(sin(x)/cos(x) - tan(x))``.
    """
    try:
        return with_plain_arguments([formula])[0][0]
    except InputError:
        return formula

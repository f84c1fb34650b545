"""Conditions on signs as text, as a book writes them: ``0 <= x <= pi`` for ``x >= 0 and pi - x >= 0``.

A condition is a pair (formula, sign); signs are ``">= 0"``, ``"> 0"`` and ``"!= 0"``. Conditions that follow from
others are dropped. The text holds where the conditions hold and their formulas have values.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import sympy
from sympy import Abs, Add, Dummy, Expr, Integer, Mul, Rational, Symbol, cos, cosh, exp, sin
from sympy.core.relational import Relational
from sympy.polys.polyerrors import PolynomialError

from symrot.checker.decide.definite import surely_nonnegative
from symrot.errors import InputError
from symrot.exact.domain.everywhere import range_everywhere
from symrot.exact.evidence import Requirement
from symrot.exact.factors import is_dear
from symrot.exact.limits.size import pieces
from symrot.exact.plain_arguments import with_plain_arguments
from symrot.exact.printing import as_text
from symrot.exact.ring.roots import is_positive_where_defined

__all__ = ["condition_texts", "follow", "positive_symbols", "range_text", "with_domain"]

MOST_PIECES = 80
"""The most symbols and operations of a formula that is simplified."""

Sign = tuple[Expr, str]
"""A condition (formula, sign): the formula is ``"> 0"``, ``">= 0"`` or ``"!= 0"``."""


def range_text(signs: Sequence[Sign], divided: bool = True) -> str:
    """Return conditions as text, joined by ``and``; empty if they hold everywhere.

    Without ``divided``, the text does not mention that divisors are nonzero.

    Examples
    --------
    >>> from sympy import pi, symbols
    >>> x = symbols("x", real=True)
    >>> range_text([(x, ">= 0"), (pi - x, ">= 0")])
    '0 <= x <= pi'
    """
    return " and ".join(_texts(_Conditions.of(signs, divided)))


def follow(signs: Sequence[Sign], known: Sequence[Sign]) -> bool:
    """Return whether the conditions ``signs`` follow from the conditions ``known``: x*y >= 0 from x > 0 and y > 0."""
    return set(_texts(_Conditions.of([*known, *signs]))) == set(_texts(_Conditions.of(known)))


def condition_texts(conditions: Iterable[Any]) -> tuple[str, ...]:
    """Return the conditions of a decision as texts, such as ``"x >= 0"``: first those that make the claim true."""
    conditions = list(conditions)
    required = [each for each in conditions if isinstance(each, Requirement)]
    # conditions that follow from the only requirement are left out
    assumed = required[0].conditions if len(required) == 1 else []
    texts = _texts(_Conditions.of([*assumed, *_signs(conditions)]))
    stated = required[0].text.split(" and ") if assumed else []
    texts = [_EMPTY_RANGE.sub(r"\2 < \1 and \2 > \1", text) for text in texts]
    return (*(each.text for each in required), *(text for text in texts if text not in stated))


_EMPTY_RANGE = re.compile(r"^(.+) < (\w+) < \1$")
"""A range without a number, such as ``0 < x < 0``, which is easier to read as two conditions."""


def positive_symbols(conditions: Iterable[Any]) -> dict[Expr, Expr]:
    """Return a map from each symbol that conditions make positive or nonnegative to a SymPy symbol with this
    assumption.
    """
    signed = _with_positive_symbols(_Conditions.of(_signs(conditions)).ranges)
    return {
        symbol: Symbol(symbol.name, **{"positive" if other.is_positive else "nonnegative": True})
        for symbol, other in signed.items()
        if symbol.is_nonnegative is None
    }


def with_domain(requirement: Requirement, conditions: Iterable[Any]) -> Requirement:
    """Return ``requirement`` joined with ``conditions`` on the same quantities: ``x > 0`` for ``x >= 0`` and ``x !=
    0``.
    """
    signs = _signs(conditions)
    if not requirement.signs or not signs:
        return requirement
    alone = _texts(_Conditions.of(signs))
    joined = [text for text in _texts(_Conditions.of([*requirement.conditions, *signs])) if text not in alone]
    strict = tuple(sign for sign in requirement.signs if follow([(sign, "> 0")], [*requirement.conditions, *signs]))
    return replace(requirement, text=" and ".join(joined), strict=strict) if joined else requirement


def _signs(conditions: Iterable[Any]) -> list[Sign]:
    return [(each.lhs, f"{each.rel_op} 0") for each in conditions if isinstance(each, Relational)]


# -- one condition in factors -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Bound:
    """A linear factor of a formula in the form ``slope * (quantity - root)``, with the slope 1 or -1."""

    quantity: Expr
    root: Expr
    slope: int

    @property
    def formula(self) -> Expr:
        return self.quantity - self.root


def _bound(factor: Expr) -> _Bound:
    """Return a factor as a quantity minus a number, without its scale: x minus pi/2 for ``2*x - pi``."""
    constant, rest = factor.as_independent(*_leaves(factor), as_Add=True)
    content, quantity = rest.as_coeff_Mul()
    if quantity.is_Add:
        own, quantity = quantity.primitive()
        content *= own
    if quantity.could_extract_minus_sign():
        content, quantity = -content, -quantity
    return _Bound(quantity, -constant / content, 1 if content > 0 else -1)


def _nonnegative_at_zero(product: Expr, factor: Expr) -> bool:
    """Return whether ``product`` is proven to be nonnegative where ``factor`` is zero."""
    bound = _bound(factor)
    return bool(bound.quantity.is_Symbol and surely_nonnegative(product.xreplace({bound.quantity: bound.root})))


def _with_plain_functions(formula: Expr) -> Expr:
    """Return a formula with simplified arguments of functions: ``cos(0)``, which is 1, for
    ``cos(sin(x)/cos(x) - tan(x))``.
    """
    try:
        return with_plain_arguments([formula])[0][0]
    except InputError:
        return formula


def _leaves(formula: Expr) -> list[Expr]:
    return [node for node in formula.atoms(sympy.Symbol, sympy.Function, sympy.Derivative) if not node.is_number]


def _factors(formula: Expr) -> tuple[int, dict[Expr, int]] | None:
    """Return the sign and the factors of a formula, (-1, {x: 2, y: -1}) for ``-4*x**2/y``; None if these are
    unknown.
    """
    above, below = sympy.fraction(sympy.together(formula))
    sign, powers = 1, dict[Expr, int]()
    for part, direction in ((above, 1), (below, -1)):
        try:
            constant, pairs = (Integer(1), [(part, 1)]) if is_dear(part) else sympy.factor_list(part)
        except PolynomialError:
            # SymPy cannot factor it
            return None
        if constant.is_zero or not constant.is_real:
            return None
        # positive numbers are dropped
        sign *= 1 if constant > 0 else -1
        for factor, power in pairs:
            if factor.is_number:
                if factor.is_positive is None:
                    return None
                sign *= 1 if factor.is_positive or power % 2 == 0 else -1
                continue
            stronger = _stronger_term(factor)
            if stronger != factor and (not power % 2 or all(each.is_positive for each in stronger.atoms(sympy.Number))):
                for term in Mul.make_args(stronger):
                    powers[term] = powers.get(term, 0) + direction * int(power)
                continue
            for linear in _linear_factors(factor):
                powers[linear] = powers.get(linear, 0) + direction * int(power)
    return sign, powers


def _stronger_term(factor: Expr) -> Expr:
    """Return x for ``x + sqrt(x^2 - 1)``: the term whose absolute value is always larger; ``factor`` if there is
    none.
    """
    if not factor.is_Add or len(factor.args) != 2 or not factor.has(Abs, sympy.Pow):
        return factor
    for first, second in (factor.args, factor.args[::-1]):
        excess = (first**2 - second**2).expand().replace(Abs, lambda inner: sympy.sqrt(inner**2))
        vanishing = excess.args[0] if excess.is_Pow and excess.is_nonnegative else None
        # its square exceeds that of the other term, unless both are zero
        if excess.is_positive or (vanishing and vanishing.is_Symbol and first.subs(vanishing, 0) == 0):
            return first
    return factor


def _linear_factors(factor: Expr) -> tuple[Expr, ...]:
    """Return the factors ``x - sqrt(2)`` and ``x + sqrt(2)`` of ``x^2 - 2``; other formulas are not split."""
    symbols = factor.free_symbols
    if len(symbols) == 1 and factor.is_polynomial(*symbols):
        poly = sympy.Poly(factor, *symbols)
        if poly.degree() == 2 and poly.LC() == 1 and poly.discriminant() > 0:
            return tuple(poly.gen - root for root in sympy.roots(poly))
    return (factor,)


def _always_positive(factor: Expr) -> bool:
    """Return whether a factor is positive wherever it has a value."""
    if factor.is_positive or is_positive_where_defined(factor) or range_everywhere(factor)[0] > 0:
        return True
    return _exceeds_absolute(factor) or _is_definite(factor)


def _exceeds_absolute(factor: Expr) -> bool:
    """Return whether a factor is ``sqrt(P) + a`` with ``P > a^2``, and so positive, as ``sqrt(x^2 + 1) - x`` is."""
    roots = [term for term in Add.make_args(factor) if term.is_Pow and term.exp == Rational(1, 2)]
    if len(roots) != 1 or not factor.is_Add:
        return False
    rest = (roots[0].base - (factor - roots[0]) ** 2).expand()
    return bool(rest.is_positive)


def _is_definite(factor: Expr) -> bool:
    """Return whether a factor is a quadratic polynomial in one symbol that is always positive, as ``x^2 + x + 1``."""
    symbols = factor.free_symbols
    if len(symbols) != 1 or not factor.is_polynomial(*symbols):
        return False
    poly = sympy.Poly(factor, *symbols)
    return bool(poly.degree() == 2 and poly.discriminant() < 0 and poly.LC() > 0)


# -- all conditions together ------------------------------------------------------------------------------------------


@dataclass
class _Range:
    """The lower and the upper bound of a quantity, each a number or None, and whether the quantity may equal the
    bound.
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
        """Return the sign of q - ``root`` for q in this range, and whether it may be zero: (1, True) for q >= 2 and
        root 2.

        (0, True) if the sign is not known.
        """
        for bound, closed, sign in ((self.low, self.low_closed, 1), (self.high, self.high_closed, -1)):
            distance = None if bound is None else sign * (bound - root)
            if distance is not None and distance.is_nonnegative:
                return sign, bool(distance.is_zero) and closed
        # the sign is not known
        return 0, True


@dataclass
class _Conditions:
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

    ranges: dict[Expr, _Range] = field(default_factory=dict)
    products: list[tuple[Mapping[Expr, int], int, str]] = field(default_factory=list)
    nonzero: dict[Expr, None] = field(default_factory=dict)
    whole: list[Sign] = field(default_factory=list)

    @classmethod
    def of(cls, signs: Sequence[Sign], divided: bool = True) -> "_Conditions":
        """Return the conditions ``signs`` in their simplest form."""
        conditions = cls()
        for formula, sign in signs:
            # if ``divided``, x/y >= 0 also gives y != 0; other callers state nonzero divisors themselves
            conditions._add(_with_plain_functions(formula), sign, divided)
        conditions._settle()
        return conditions

    def _add(self, formula: Expr, sign: str, divided: bool = True) -> None:
        factored = _factors(formula) if pieces([formula]) <= MOST_PIECES else None
        if factored is None:
            self.whole.append((formula, sign))
            return
        direction, powers = factored
        odd: dict[Expr, int] = {}
        square: list[Expr] = []
        for factor, power in powers.items():
            if _always_positive(factor):
                continue
            if _always_positive(-factor):
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
        square = [factor for factor in square if factor not in odd and not _nonnegative_at_zero(product, factor)]
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
            self.nonzero[_bound(factor).formula] = None

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
        implied = [_bound(factor).formula for factors, _, sign in self.products if sign == "> 0" for factor in factors]
        self.nonzero = {
            formula: None for formula in self.nonzero if formula not in implied and not self._excludes(formula)
        }

    def _simpler(self, entry: tuple[Mapping[Expr, int], int, str]) -> tuple[Mapping[Expr, int], int, str] | None:
        """Return a condition on a product without factors of known sign; None if it always holds or becomes a range."""
        # ({x: 1, y: 1}, -1, ">= 0") is -x*y >= 0
        factors, direction, sign = entry
        bounds = {factor: _bound(factor) for factor in factors}
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

    def _new_range(self, quantity: Expr) -> _Range:
        """Return the range that ``quantity`` has by its form alone: -1 to 1 for a sine, 0 and above for a square."""
        if isinstance(quantity, sin | cos):
            return _Range(Integer(-1), Integer(1))
        return _Range(Integer(0)) if surely_nonnegative(quantity) else _Range()

    def _between(self, bounds: Mapping[Expr, _Bound], direction: int, sign: str) -> bool:
        """Narrow the range of q to [a, b] and return True for a condition ``(q - a)*(b - q) >= 0``; otherwise return
        False.
        """
        # each factor is slope*(q - root), and ``direction`` is the factor 1 or -1 of the product
        first, second, *more = sorted(bounds.values(), key=lambda bound: bound.root.evalf())
        if more or direction * first.slope * second.slope > 0:
            return False
        own = self.ranges.setdefault(first.quantity, self._new_range(first.quantity))
        own.narrow(first.root, sign == ">= 0", above=True)
        own.narrow(second.root, sign == ">= 0", above=False)
        return True

    def _excludes(self, formula: Expr) -> bool:
        """Return whether the ranges keep ``formula`` from zero; for the formula x, a range x >= 0 first becomes x >
        0.
        """
        bound = _bound(formula)
        if bound.root == 0 and isinstance(bound.quantity, sin | cos) and self._angle_excludes(bound.quantity):
            return True
        if any(self._lies_between(bound, factors, direction) for factors, direction, _ in self.products):
            return True
        # x >= 0 becomes x > 0
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

    def _lies_between(self, bound: _Bound, factors: Mapping[Expr, int], direction: int) -> bool:
        """Return whether ``(x - 1)*(x + 1) >= 0``, given by ``factors`` and ``direction``, excludes the root of
        ``bound``, x = 0.
        """
        pair = [_bound(factor) for factor in factors]
        if len(pair) != 2 or any(other.quantity != bound.quantity for other in pair):
            return False
        # the condition excludes all points between the roots of both factors
        outside = direction * pair[0].slope * pair[1].slope > 0
        return outside and bool(((bound.root - pair[0].root) * (bound.root - pair[1].root)).is_negative)

    def grants(self, quantity: Expr, own: _Range) -> bool:
        """Return whether a cosine is in the range ``own`` by other conditions, so that this need not be printed.

        False for other quantities.
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
        angle = _bound(function.args[0])
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


# -- as text ----------------------------------------------------------------------------------------------------------


def _texts(conditions: _Conditions) -> list[str]:
    positive = _with_positive_symbols(conditions.ranges)
    one_sided: list[str] = []
    two_sided: list[str] = []
    for quantity, own in conditions.ranges.items():
        text = _range_text(quantity, own)
        if text and not _follows(quantity, own, positive) and not conditions.grants(quantity, own):
            (two_sided if text.count("=") + text.count("<") > 1 and text.count("<") > 1 else one_sided).append(text)
    products = [each for each in conditions.products if not _holds(each[1] * Mul(*each[0]), each[2], positive)]
    one_sided += [_product_text(factors, direction, sign) for factors, direction, sign in products]
    one_sided += [
        f"{as_text(formula)} {sign}" for formula, sign in conditions.whole if not _holds(formula, sign, positive)
    ]
    nonzero = [_nonzero_text(formula) for formula in conditions.nonzero if not _holds(formula, "!= 0", positive)]
    return [*sorted(dict.fromkeys(one_sided)), *sorted(dict.fromkeys(two_sided)), *sorted(dict.fromkeys(nonzero))]


def _product_text(factors: Mapping[Expr, int], direction: int, sign: str) -> str:
    """Return a condition on the sign of a product as text: ``abs(x) >= 1`` for ``(x - 1)*(x + 1) >= 0``."""
    # ``direction`` is the factor 1 or -1 of the product
    bounds = [_bound(factor) for factor in factors]
    if len(bounds) == 2:
        first, second = bounds
        if first.quantity == second.quantity and first.root == -second.root:  # outside of both: see _between
            root = first.root if first.root.is_positive else second.root
            return f"{as_text(Abs(first.quantity))} {sign[:-2]} {as_text(root)}"
        functions = {type(bound.quantity): bound.quantity for bound in bounds if bound.root == 0}
        if set(functions) == {sin, cos} and functions[sin].args == functions[cos].args:
            double = sin(2 * functions[sin].args[0]) * direction * first.slope * second.slope
            return f"{as_text(double)} {sign}"
    return f"{as_text(direction * Mul(*factors))} {sign}"


def _with_positive_symbols(ranges: Mapping[Expr, _Range]) -> dict[Expr, Expr]:
    """Return a map from each symbol with a positive or nonnegative range to a SymPy symbol with this assumption."""
    values: dict[Expr, Expr] = {}
    for quantity, own in ranges.items():
        if quantity.is_Symbol and own.low is not None and own.low.is_nonnegative:
            strict = own.low.is_positive or not own.low_closed
            values[quantity] = Dummy(positive=True) if strict else Dummy(nonnegative=True)
    return values


def _holds(formula: Expr, sign: str, positive: Mapping[Expr, Expr]) -> bool:
    """Return whether a condition follows from the signs of its symbols, as x + y > 0 from x > 0 and y > 0."""
    # ``positive`` replaces symbols of known sign by SymPy symbols that have this sign
    value = formula.xreplace(dict(positive))
    if sign == ">= 0":
        return surely_nonnegative(value)
    return bool(_always_positive(value) or (sign == "!= 0" and (value.is_nonzero or _always_positive(-value))))


def _follows(quantity: Expr, own: _Range, positive: Mapping[Expr, Expr]) -> bool:
    """Return whether the range of a quantity such as x + y follows from the signs of its symbols."""
    if quantity.is_Symbol or own.high is not None or own.low is None:
        return False
    # x + y >= 0 follows from x >= 0 and y >= 0
    return _holds(quantity - own.low, ">= 0" if own.low_closed else "> 0", positive)


def _range_text(quantity: Expr, own: _Range) -> str:
    least, most = own.low, own.high
    if isinstance(quantity, sin | cos):
        least = None if least == -1 and own.low_closed else least
        most = None if most == 1 and own.high_closed else most
    if surely_nonnegative(quantity) and least == 0 and own.low_closed:
        least = None
    if isinstance(quantity, cosh) and least == 1 and own.low_closed:
        least = None
    if isinstance(quantity, exp) and {least, most} <= {None, 1}:  # exp(x) >= 1 where x >= 0
        quantity = quantity.args[0]
        least, most = (None if bound is None else bound - 1 for bound in (least, most))
    below, above = "<=" if own.low_closed else "<", "<=" if own.high_closed else "<"
    text = as_text(quantity)
    if least is not None and least == most and own.low_closed and own.high_closed:
        return _one_sided(quantity, least, "==")
    if least is not None and most is not None:
        return f"{as_text(least)} {below} {text} {above} {as_text(most)}"
    if least is not None:
        return _one_sided(quantity, least, ">=" if own.low_closed else ">")
    return _one_sided(quantity, most, above) if most is not None else ""


def _one_sided(quantity: Expr, root: Expr, sign: str) -> str:
    """Return the text ``quantity sign root``, such as ``x >= 2``; a difference compared with zero becomes ``x >=
    y``.
    """
    terms = quantity.args if quantity.is_Add else ()
    positive = [term for term in terms if not term.could_extract_minus_sign()]
    if root == 0 and len(terms) == 2 and len(positive) == 1:
        return f"{as_text(positive[0])} {sign} {as_text(positive[0] - quantity)}"
    return f"{as_text(quantity)} {sign} {as_text(root)}"


def _nonzero_text(formula: Expr) -> str:
    bound = _bound(formula)
    return _one_sided(bound.quantity, bound.root, "!=")

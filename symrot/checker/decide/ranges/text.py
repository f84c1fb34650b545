"""Conditions on signs as text, as a book writes them: ``0 <= x <= pi`` for ``x >= 0 and pi - x >= 0``.

A condition is a pair (formula, sign); signs are ``">= 0"``, ``"> 0"`` and ``"!= 0"``. Conditions that follow from
others are dropped. The text holds where the conditions hold and their formulas have values.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from sympy import Abs, Dummy, Expr, Mul, Symbol, cos, cosh, exp, sin
from sympy.core.relational import Relational

from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.ranges.conditions import Conditions, Range, Sign
from symrot.checker.decide.ranges.factors import bound_of, is_always_positive
from symrot.exact.evidence import Requirement
from symrot.exact.printing import as_text

__all__ = ["condition_texts", "follow", "positive_symbols", "range_text", "with_domain"]


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
    return " and ".join(_texts(Conditions.of(signs, divided)))


def follow(signs: Sequence[Sign], known: Sequence[Sign]) -> bool:
    """Return whether the conditions ``signs`` follow from the conditions ``known``: x*y >= 0 from x > 0 and y > 0."""
    return set(_texts(Conditions.of([*known, *signs]))) == set(_texts(Conditions.of(known)))


def condition_texts(conditions: Iterable[Any]) -> tuple[str, ...]:
    """Return the conditions of a decision as texts, such as ``"x >= 0"``.

    First come those that make the sides of the claim equal, then those under which sides and proof have real values.
    """
    conditions = list(conditions)
    required = [each for each in conditions if isinstance(each, Requirement)]
    # conditions that follow from the only requirement are left out
    assumed = required[0].conditions if len(required) == 1 else []
    texts = _texts(Conditions.of([*assumed, *_signs(conditions)]))
    stated = required[0].text.split(" and ") if assumed else []
    texts = [_EMPTY_RANGE.sub(r"\2 < \1 and \2 > \1", text) for text in texts]
    return (*(each.text for each in required), *(text for text in texts if text not in stated))


_EMPTY_RANGE = re.compile(r"^(.+) < (\w+) < \1$")
"""Pattern of a range that contains no number, such as ``0 < x < 0``, which is written ``x < 0 and x > 0`` instead."""


def positive_symbols(conditions: Iterable[Any]) -> dict[Expr, Expr]:
    """Return a map from each symbol that conditions make positive or nonnegative to a SymPy symbol with this
    assumption.
    """
    signed = _with_positive_symbols(Conditions.of(_signs(conditions)).ranges)
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
    alone = _texts(Conditions.of(signs))
    joined = [text for text in _texts(Conditions.of([*requirement.conditions, *signs])) if text not in alone]
    strict = tuple(sign for sign in requirement.signs if follow([(sign, "> 0")], [*requirement.conditions, *signs]))
    return replace(requirement, text=" and ".join(joined), strict=strict) if joined else requirement


def _signs(conditions: Iterable[Any]) -> list[Sign]:
    return [(each.lhs, f"{each.rel_op} 0") for each in conditions if isinstance(each, Relational)]


def _texts(conditions: Conditions) -> list[str]:
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
    bounds = [bound_of(factor) for factor in factors]
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


def _with_positive_symbols(ranges: Mapping[Expr, Range]) -> dict[Expr, Expr]:
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
    return bool(is_always_positive(value) or (sign == "!= 0" and (value.is_nonzero or is_always_positive(-value))))


def _follows(quantity: Expr, own: Range, positive: Mapping[Expr, Expr]) -> bool:
    """Return whether the range of a quantity such as x + y follows from the signs of its symbols."""
    if quantity.is_Symbol or own.high is not None or own.low is None:
        return False
    # x + y >= 0 follows from x >= 0 and y >= 0
    return _holds(quantity - own.low, ">= 0" if own.low_closed else "> 0", positive)


def _range_text(quantity: Expr, own: Range) -> str:
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
    bound = bound_of(formula)
    return _one_sided(bound.quantity, bound.root, "!=")

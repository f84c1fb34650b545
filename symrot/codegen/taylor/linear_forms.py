"""Linear forms in Taylor series: a constant plus series times constant weights, such as ``1 + 2*u - a*v``.

Constants and weights are formulas of the parameters of a motion. Standard library only.
"""

from fractions import Fraction
from typing import NamedTuple

from symrot.formula.tree import Node, children, evaluate

__all__ = ["ONE", "ZERO", "Linear", "alone", "folded", "number_and_rest", "scaled", "split_sign", "total", "value_of"]

ONE: Node = ("number", Fraction(1))
ZERO: Node = ("number", Fraction(0))


class Linear(NamedTuple):
    """A linear form, ``constant + sum(weight * series)``: ``terms`` maps indices of series to constant weights.

    A ``constant`` None stands for 0.
    """

    constant: Node | None
    terms: dict[int, Node]


def alone(series: int) -> Linear:
    """Return one Taylor series, given by its index, as a linear form: its weight is 1, and the constant is zero."""
    return Linear(None, {series: ONE})


def value_of(form: Linear) -> Node:
    """Return the constant of a linear form as a formula, 0 if there is none."""
    return form.constant if form.constant is not None else ZERO


def folded(node: Node) -> Node:
    """Return a constant formula, shortened if possible: ``2*3`` gives 6, ``1*a`` gives a, ``a*(-b)`` gives -(a*b)."""
    kind, parts = node[0], children(node)
    if kind == "neg":
        sign, inner = split_sign(parts[0])
        return _signed(-sign, inner)
    if kind in "+-*/" and all(part[0] == "number" for part in parts) and (kind != "/" or parts[1] != ZERO):
        return ("number", evaluate(node, {}))
    if kind not in "*/":
        return node
    (s, a), (r, b) = map(split_sign, parts)
    if b == ONE or (kind == "*" and a == ONE):
        return _signed(s * r, a if b == ONE else b)
    return _signed(s * r, (kind, b, a) if kind == "*" and b[0] == "number" else (kind, a, b))


def _signed(sign: int, node: Node) -> Node:
    if sign > 0:
        return node
    return ("number", -node[1]) if node[0] == "number" else ("neg", node)


def split_sign(node: Node) -> tuple[int, Node]:
    """Return (sign, formula) whose product is ``node``: ``-a`` gives -1 and a, ``a`` gives 1 and a."""
    if node[0] == "neg":
        sign, inner = split_sign(node[1])
        return -sign, inner
    if node[0] == "number" and node[1] < 0:
        return -1, ("number", -node[1])
    return 1, node


def number_and_rest(weight: Node) -> tuple[Fraction, Node]:
    """Return (number, formula) whose product equals a constant formula.

    The formula ``-(2*a)`` gives -2 and a, and ``a`` gives 1 and a.
    """
    sign, size = split_sign(weight)
    if size[0] == "number":
        return (sign * size[1], ONE) if size[1] else (Fraction(1), size)
    if size[0] == "*" and size[1][0] == "number":
        return sign * size[1][1], size[2]
    return Fraction(sign), size


def scaled(form: Linear, factor: Node | int) -> Linear:
    """Return a linear form times a constant, ``factor``."""
    weight: Node = ("number", Fraction(factor)) if isinstance(factor, int) else factor
    if weight == ZERO:
        return Linear(ZERO, {})

    def times(value: Node) -> Node:
        return folded(("*", weight, value))

    constant = None if form.constant is None else times(form.constant)
    return Linear(constant, {series: times(value) for series, value in form.terms.items()})


def total(left: Linear, right: Linear, sign: int) -> Linear:
    """Return ``left + sign*right``, where ``sign`` is 1 or -1; terms whose weights add up to a 0 are left out."""
    right = right if sign > 0 else scaled(right, -1)
    constant = left.constant if right.constant is None else right.constant
    if left.constant is not None and right.constant is not None:
        constant = folded(("+", left.constant, right.constant))
    terms = dict(left.terms)
    for series, weight in right.terms.items():
        both = folded(("+", terms[series], weight)) if series in terms else weight
        if both == ZERO:
            terms.pop(series, None)
        else:
            terms[series] = both
    return Linear(None if terms and constant == ZERO else constant, terms)

"""The canonical form of a tree: formulas that differ only in the order of terms and factors have the same form."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from symrot.checker.claim.tree import Node, negated, number, product, sum_of, text

__all__ = ["canonical", "terms_of_equation", "with_ordered_products"]


def canonical(node: Node, is_matrix: Callable[[Node], bool]) -> Node:
    """Return a tree with sorted terms and scalar factors, so that ``b*a*2`` and ``2*a*b`` are equal.

    Parameters
    ----------
    node : Node
        The tree of a formula.
    is_matrix : function
        Tells whether a node is a matrix; matrices in a product stay in their order.
    """
    args = [canonical(child, is_matrix) for child in node.args]
    if node.kind == "sum":
        return sum_of(sorted(sum_of(args).args or args, key=text))
    if node.kind == "neg":
        return negated(args[0])
    if node.kind == "inv" and args[0].kind == "number" and args[0].value:
        return Node("number", 1 / args[0].value)
    if node.kind == "product":
        return _product(args, is_matrix)
    if node.kind == "power" and not is_matrix(args[0]):
        return _product([Node("power", None, tuple(args))], is_matrix)
    return Node(node.kind, node.value, tuple(args))


def _base_and_exponent(factor: Node) -> tuple[Node, Fraction]:
    """Return the base of a factor and its numeric exponent: (x, -1/2) for ``1/sqrt(x)``, (x**n, 1) for ``x**n``."""
    if factor == Node("call", "sqrt", factor.args):
        base, exponent = _base_and_exponent(factor.args[0])
        return base, exponent / 2
    if factor.kind == "inv":
        base, exponent = _base_and_exponent(factor.args[0])
        return base, -exponent
    if factor.kind == "power" and factor.args[1].kind == "number":
        base, exponent = _base_and_exponent(factor.args[0])
        return base, exponent * factor.args[1].value
    return factor, Fraction(1)


def with_ordered_products(tree: Node, is_matrix: Callable[[Node], bool]) -> Node:
    """Return a tree in which dot and cross products have sorted vectors, and their scalar factors stand in front.

    ``cross(m*v, a)`` becomes ``-m*cross(a, v)``. A dot or cross product with a scalar argument keeps its arguments.
    """
    args = tuple(with_ordered_products(child, is_matrix) for child in tree.args)
    made = replace(tree, args=args)
    if tree.kind != "call" or tree.value not in ("dot", "cross"):
        return product(list(args)) if tree.kind == "product" else negated(args[0]) if tree.kind == "neg" else made
    scalars: list[Node] = []
    vectors = []
    for argument in args:
        inner = argument.args[0] if argument.kind == "neg" else argument
        scalars += [number(-1)] if argument.kind == "neg" else []
        factors = inner.args if inner.kind == "product" else (inner,)
        scalars += [factor for factor in factors if not is_matrix(factor)]
        vectors.append(product([factor for factor in factors if is_matrix(factor)]))
    if not all(map(is_matrix, vectors)):
        return made
    ordered = sorted(vectors, key=text)
    scalars += [number(-1)] if tree.value == "cross" and ordered != vectors else []
    return product([*scalars, replace(tree, args=tuple(ordered))])


def terms_of_equation(left: Node, right: Node, is_matrix: Callable[[Node], bool]) -> frozenset[tuple[Node, Fraction]]:
    """Return pairs (term, coefficient) for ``left - right``, divided by the first coefficient: (a, 1) and (b, -2) for
    ``2*a == 4*b``. Empty for equal sides.
    """
    totals: dict[Node, Fraction] = {}
    for side, sign in ((left, 1), (right, -1)):
        whole = canonical(side, is_matrix)
        for term in whole.args if whole.kind == "sum" else (whole,):
            core, size = _without_number(term)
            totals[core] = totals.get(core, Fraction(0)) + sign * size
    terms = sorted(((core, size) for core, size in totals.items() if size), key=lambda pair: text(pair[0]))
    # divided by the first coefficient, so that multiples of an equation give the same terms
    return frozenset((core, size / terms[0][1]) for core, size in terms)


def _without_number(term: Node) -> tuple[Node, Fraction]:
    """Split a canonical term into the term without its number, and that number: (a*b, -2) for ``-2*a*b``."""
    if term.kind == "neg":
        core, size = _without_number(term.args[0])
        return core, -size
    if term.kind == "number":
        return number(1), term.value
    if term.kind == "product" and term.args[0].kind == "number":
        return product(list(term.args[1:])), term.args[0].value
    return term, Fraction(1)


def _product(args: list[Node], is_matrix: Callable[[Node], bool]) -> Node:
    whole = product(args)
    inner = whole.args[0] if whole.kind == "neg" else whole
    size = Fraction(1)
    scalars: list[Node] = []
    matrices: list[Node] = []
    powers: dict[Node, Fraction] = {}
    for factor in inner.args if inner.kind == "product" else (inner,):
        if factor.kind == "number":
            size *= factor.value
        elif is_matrix(factor):
            matrices.append(factor)
        else:
            base, exponent = _base_and_exponent(factor)
            powers[base] = powers.get(base, Fraction(0)) + exponent
    for base, exponent in powers.items():
        if exponent:
            scalars.append(base if exponent == 1 else Node("power", None, (base, Node("number", exponent))))
    front = [Node("number", size)] if size != 1 or not (scalars or matrices) else []
    made = product([*front, *sorted(scalars, key=text), *matrices])
    return negated(made) if whole.kind == "neg" else made

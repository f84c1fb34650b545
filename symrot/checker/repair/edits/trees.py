"""Edits of trees that keep the form in which people write formulas: merged sums and products, no nested fractions."""

from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction

from symrot.checker.claim.tree import Node, Path, negated, number, product, replaced, sum_of, walk
from symrot.checker.repair.edits.names import OPPOSITE, PRODUCT_OF_INERTIA

__all__ = [
    "flattened", "normalise_factors", "put", "scaled", "square_of", "substituted", "with_cofunctions",
    "with_other_products",
]  # fmt: skip


def put(tree: Node, path: Path, made: Node) -> Node:
    """Return a tree with the node ``made`` at ``path``; a sum in a sum, or a product in a product, is merged."""
    if path and made.kind in ("neg", "sum", "product"):
        *above, place = path
        around = tree
        for step in above:
            around = around.args[step]
        return replaced(tree, tuple(above), _regrouped(around, place, made))
    return replaced(tree, path, made)


def _regrouped(node: Node, place: int, made: Node) -> Node:
    args = [*node.args[:place], made, *node.args[place + 1 :]]
    if node.kind == made.kind == "sum":
        return sum_of(args, node.span)
    if node.kind == made.kind == "product":
        return product(args, node.span)
    return replace(node, args=tuple(args))


def substituted(tree: Node, old: Node, new: Node, inside: Collection[str] | None = None) -> Node:
    """Return a tree with ``new`` for each ``old``; with ``inside``, only for arguments of the functions named there."""
    if tree == old and inside is None:
        return new
    direct = inside is not None and tree.kind == "call" and tree.value in inside and tree.args[0] == old
    args = (new,) if direct else tuple(substituted(child, old, new, inside) for child in tree.args)
    if args == tree.args:
        return tree
    return _rebuilt(replace(tree, args=args))


def with_other_products(tree: Node) -> Node | None:
    """Return a formula with the other sign of every product of inertia, such as I_xy; None if there is no such name."""
    names = sorted({node.value for _, node in walk(tree) if node.kind == "name"})
    products = [Node("name", name) for name in names if PRODUCT_OF_INERTIA.fullmatch(name)]
    for name in products:
        tree = substituted(tree, name, negated(name))
    return tree if products else None


def square_of(tree: Node) -> Node:
    """Return the square of a tree; for 1/a it is 1/a^2."""
    if tree.kind == "inv":
        return Node("inv", None, (square_of(tree.args[0]),))
    return Node("power", None, (tree, number(2)))


def with_cofunctions(tree: Node, angle: Node) -> Node:
    """Return a tree with the sine and the cosine of an angle exchanged, and likewise tan and cot, sec and csc."""
    if tree.kind == "call" and tree.value in OPPOSITE and tree.args == (angle,):
        return replace(tree, value=OPPOSITE[tree.value])
    return replace(tree, args=tuple(with_cofunctions(child, angle) for child in tree.args))


def _rebuilt(node: Node) -> Node:
    """Return a product or negated formula in the form that the reader of claims builds: ``-(a*b)`` for ``a*(-b)``.

    Other nodes are returned unchanged.
    """
    if node.kind == "product":
        return product(list(node.args), node.span)
    if node.kind == "neg":
        return negated(node.args[0])
    return node


def normalise_factors(node: Node) -> Node:
    """Return a tree without factors 1 and without nested fractions, which edits of numbers produce."""
    args = tuple(map(normalise_factors, node.args))
    if node.kind == "power" and args[1] == number(1):
        return args[0]
    if node.kind != "product":
        return node if args == node.args else replace(node, args=args)
    above, below, rest = Fraction(1), Fraction(1), []
    for factor in args:
        if factor.kind == "number":
            above *= factor.value
        elif factor.kind == "inv" and factor.args[0].kind == "number":
            below *= factor.args[0].value
        else:
            rest.append(factor)
    size = above / below
    front = [number(size.numerator)] if size.numerator != 1 else []
    back = [Node("inv", None, (number(size.denominator),))] if size.denominator != 1 else []
    if not front and (not rest or rest[0].kind == "inv"):
        front = [number(1)]
    return product([*front, *rest, *back], node.span)


def scaled(term: Node, ratio: Fraction) -> Node:
    """Return a term times a rational number, written as people write it: ``m*r**2/2``."""
    size = abs(ratio)
    above = [] if size.numerator == 1 else [number(size.numerator)]
    below = [] if size.denominator == 1 else [Node("inv", None, (number(size.denominator),))]
    made = normalise_factors(product([*above, term, *below])) if above or below else term
    return negated(made) if ratio < 0 else made


def flattened(node: Node) -> Node:
    """Return a tree in which nested sums and nested products are merged, and zero terms are left out."""
    args = tuple(map(flattened, node.args))
    if node.kind == "sum":
        return sum_of([term for term in args if term.kind != "number" or term.value], node.span)
    if node.kind == "product":
        return product(list(args), node.span)
    if node.kind == "neg":
        return negated(args[0])
    return node if args == node.args else Node(node.kind, node.value, args, node.span)

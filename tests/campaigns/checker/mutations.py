"""One random fault in a claim, of the kinds that printers and authors make; shares no table with the search that must
undo it.

Every mutation has the code of the diagnosis that should name it; what it drops or exchanges is not available to the
search.
"""

from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from fractions import Fraction
from random import Random

from symrot import symbols
from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.tree import Node, Path, negated, number, product, replaced, sum_of, walk

__all__ = ["MUTATIONS", "mutated", "places"]

TURNS = ("Rx", "Ry", "Rz")
MATRICES = (*TURNS, "skew", "Matrix", "dcm_of", "diag", "eye", "inverse", "transpose", "hstack", "vee", "cross", "qmul")
FAMILIES = tuple(
    tuple(map(str, group)) for group in vars(symbols).values() if isinstance(group, tuple) and len(group) > 1
)
"""Symbols that stand beside each other in :mod:`symrot.symbols`: angles, components, moments."""

TIME = Node("name", "t")
IsMatrix = Callable[[Node], bool]
Made = Iterator[Node]


def _sign_of_term(node: Node, is_matrix: IsMatrix) -> Made:
    if node.kind == "sum":
        for place, term in enumerate(node.args):
            yield sum_of([*node.args[:place], negated(term), *node.args[place + 1 :]])
    elif node.kind == "list" and node.value == ("[", "]"):
        for place, entry in enumerate(node.args):
            if entry.kind not in ("list", "number", "sum"):
                yield replace(node, args=(*node.args[:place], negated(entry), *node.args[place + 1 :]))


def _factor(node: Node, is_matrix: IsMatrix) -> Made:
    """Yield a term or product times 2 and times 1/2, and the product without one of its factors."""
    if node.kind not in ("product", "name", "call") or is_matrix(node):
        return
    for by in (Fraction(2), Fraction(1, 2)):
        yield _multiplied(node, by)
    if node.kind == "product":
        for place, factor in enumerate(node.args):
            rest = [*node.args[:place], *node.args[place + 1 :]]
            if factor.kind not in ("number", "inv") and any(other.kind != "inv" for other in rest):
                yield product(rest)


def _multiplied(node: Node, by: Fraction) -> Node:
    factors = list(node.args) if node.kind == "product" else [node]
    for place, factor in enumerate(factors):
        if factor.kind == "number":
            by *= factor.value
            del factors[place]
            break
    above = [number(by.numerator)] if by.numerator != 1 or not factors else []
    below = [Node("inv", None, (number(by.denominator),))] if by.denominator != 1 else []
    return product([*above, *factors, *below])


def _of_angle(by: Fraction) -> Callable[[Node, IsMatrix], Made]:
    def made(node: Node, is_matrix: IsMatrix) -> Made:
        if node.kind == "call" and node.value in ("sin", "cos", "tan"):
            (angle,) = node.args
            if angle.kind == "sum":
                yield replace(node, args=(sum_of([_scaled(term, by) for term in angle.args]),))
            else:
                yield replace(node, args=(_scaled(angle, by),))

    return made


def _scaled(term: Node, by: Fraction) -> Node:
    """Return an angle times 2 or 1/2; ``x/2`` doubled is ``x``."""
    if term.kind == "neg":
        return negated(_scaled(term.args[0], by))
    factors = list(term.args) if term.kind == "product" else [term]
    for place, factor in enumerate(factors):
        numeric = factor.kind == "number" or (factor.kind == "inv" and factor.args[0].kind == "number")
        if numeric:
            by *= factor.value if factor.kind == "number" else 1 / factor.args[0].value
            factors[place] = number(1)
    return _multiplied(product([factor for factor in factors if factor != number(1)]), by)


def _sin_cos_swap(node: Node, is_matrix: IsMatrix) -> Made:
    if node.kind == "call" and node.value in ("sin", "cos"):
        yield replace(node, value="cos" if node.value == "sin" else "sin")


def _wrong_symbol(node: Node, is_matrix: IsMatrix) -> Made:
    name = node.value if node.kind == "name" or (node.kind == "call" and node.args == (TIME,)) else None
    if is_matrix(node):
        return
    for family in FAMILIES if name else ():
        if name in family:
            for other in family:
                if other != name:
                    yield replace(node, value=other)


def _missing_term(node: Node, is_matrix: IsMatrix) -> Made:
    if node.kind == "sum":
        for place in range(len(node.args)):
            yield sum_of([*node.args[:place], *node.args[place + 1 :]])


def _transposed(node: Node, is_matrix: IsMatrix) -> Made:
    """Yield the transpose of a matrix, the opposite of an angle, and written entries with rows as columns."""
    if node.kind == "transpose":
        yield node.args[0]
    elif node.kind == "call" and node.value in TURNS:
        yield Node("call", node.value, (negated(node.args[0]),))
    elif node.kind == "name" and is_matrix(node):
        yield Node("transpose", None, (node,))
    elif node.kind == "call" and node.value == "Matrix" and node.args[0].kind == "list":
        rows = node.args[0].args
        if all(row.kind == "list" and len(row.args) == len(rows) > 1 for row in rows):
            turned = tuple(replace(row, args=tuple(r.args[i] for r in rows)) for i, row in enumerate(rows))
            yield replace(node, args=(replace(node.args[0], args=turned),))


def _order(node: Node, is_matrix: IsMatrix) -> Made:
    if node.kind == "product":
        for place in range(len(node.args) - 1):
            first, second = node.args[place : place + 2]
            if is_matrix(first) and is_matrix(second):
                yield product([*node.args[:place], second, first, *node.args[place + 2 :]])


def _order_of_quaternions(node: Node, is_matrix: IsMatrix) -> Made:
    if node.kind == "call" and node.value == "qmul":
        yield replace(node, args=node.args[::-1])


def _storage_order(node: Node, is_matrix: IsMatrix) -> Made:
    four = len(node.args) == 4 and (node.kind == "list" or (node.kind == "call" and node.value == "dcm_of"))
    if four and not any(member.kind == "list" for member in node.args):
        yield replace(node, args=(*node.args[1:], node.args[0]))


def _products_of_inertia(node: Node, is_matrix: IsMatrix) -> Made:
    names = tuple(map(str, symbols.products))
    if any(piece.kind == "name" and piece.value in names for _, piece in walk(node)):
        yield _with(node, lambda piece: negated(piece) if piece.kind == "name" and piece.value in names else piece)


def _with(node: Node, edit: Callable[[Node], Node]) -> Node:
    made = edit(replace(node, args=tuple(_with(child, edit) for child in node.args)))
    return product(list(made.args)) if made.kind == "product" else made


def _sequence_type(node: Node, is_matrix: IsMatrix) -> Made:
    """Yield rotations about other axes, of the same and of the other kind of sequence, and the reversed order."""
    if node.kind != "product" or not all(f.kind == "call" and f.value in TURNS for f in node.args):
        return
    angles = [factor.args for factor in node.args]
    if len(angles) == 3:
        for axes in ((a, b, c) for a in TURNS for b in TURNS for c in TURNS if a != b != c):
            yield product([Node("call", axis, args) for axis, args in zip(axes, angles, strict=True)])
    yield product(list(node.args[::-1]))


def _frame(node: Node, is_matrix: IsMatrix) -> Made:
    """Yield ``R W`` for ``W R`` with skew W, and components of the angular velocity in the other frame."""
    if (
        node.kind == "product"
        and len(node.args) == 2
        and any(f.kind == "call" and f.value == "skew" for f in node.args)
    ):
        if all(map(is_matrix, node.args)):
            yield product(list(node.args[::-1]))
    elif node.kind == "product" and [f.kind for f in node.args] == ["transpose", "call"]:
        yield product([node.args[1], node.args[0]])


MUTATIONS: dict[str, Callable[[Node, IsMatrix], Made]] = {
    "frame_body_space": _frame,
    "active_passive_transpose": _transposed,
    "commutator_order": _order,
    "quaternion_product_order": _order_of_quaternions,
    "quaternion_storage_order": _storage_order,
    "sign_of_term": _sign_of_term,
    "overall_sign": lambda node, is_matrix: iter([negated(node)]),
    "factor": _factor,
    "half_angle": _of_angle(Fraction(2)),
    "double_half_angle": _of_angle(Fraction(1, 2)),
    "sin_cos_swap": _sin_cos_swap,
    "wrong_symbol": _wrong_symbol,
    "missing_term": _missing_term,
    "inertia_product_sign": _products_of_inertia,
    "wrong_sequence_type": _sequence_type,
}
"""Code -> what a piece may become. An angle that is doubled is one where its half belongs, ``half_angle``."""

WHOLE = ("overall_sign", "inertia_product_sign")
"""Faults of a whole side or definition."""


def places(claim: Claim, code: str, is_matrix: IsMatrix) -> list[tuple[str, Path]]:
    """Return where a mutation may happen: (side or name of a definition, path of the piece)."""
    assert claim.relation is not None
    trees = {"left": claim.relation[1], "right": claim.relation[2], **dict(claim.define)}
    if code == "overall_sign":
        trees = {place: tree for place, tree in trees.items() if tree.kind != "number"}
    change = MUTATIONS[code]
    return [
        (place, path)
        for place, tree in trees.items()
        for path, node in ([((), tree)] if code in WHOLE else _pieces(tree))
        if next(change(node, is_matrix), None) is not None
    ]


def mutated(claim: Claim, code: str, source: Random, is_matrix: IsMatrix, among: Collection[tuple[str, Path]]) -> Claim:
    """Return a claim with one random mutation of a code, at one of the given places."""
    assert claim.relation is not None
    place, path = source.choice(list(among))
    sign, left, right = claim.relation
    trees = {"left": left, "right": right, **dict(claim.define)}
    node = trees[place]
    for step in path:
        node = node.args[step]
    made = source.choice(list(MUTATIONS[code](node, is_matrix)))
    trees[place] = _flattened(replaced(trees[place], path, made))
    define = tuple((name, trees[name]) for name, _ in claim.define)
    relation = (sign, trees["left"], trees["right"])
    used = {piece.value for tree in trees.values() for _, piece in walk(tree) if piece.kind == "name"}
    called = {piece.value for tree in trees.values() for _, piece in walk(tree) if piece.args == (TIME,)}
    known = {*claim.symbols, *claim.functions, *trees, "pi"}
    return replace(
        claim,
        relation=relation,
        define=define,
        symbols=(*claim.symbols, *sorted(used - known)),
        functions=(*claim.functions, *sorted(called - known)),
        sources={**claim.sources, "claim": relation_text(relation)},
        editable=tuple(trees),
    )


def _flattened(node: Node) -> Node:
    """Return a tree without sums directly in sums or products in products, as the reader gives trees."""
    args = [_flattened(child) for child in node.args]
    if node.kind in ("sum", "product"):
        return (sum_of if node.kind == "sum" else product)(args)
    if node.kind == "neg":
        return negated(args[0])
    return replace(node, args=tuple(args))


def _pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield the pieces that a mutation may change: no exponents, indices or variables of derivatives."""
    yield path, tree
    for place, child in enumerate(tree.args):
        fixed = tree.kind in ("power", "index") or (tree.kind == "call" and tree.value in ("diff", "integrate"))
        if not (fixed and place) and child.kind != "number":
            yield from _pieces(child, (*path, place))

"""The faults that occur in practice, as edits of a tree: each with its code and its cost, the nearest first.

An edit changes one piece. ``single_edits`` yields all edits of a tree; what they mean together, and whether the result
is true, is for :mod:`symrot.checker.repair.diagnose` to find out.
"""

import re
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from symrot.checker.claim.tree import Node, Path, negated, number, product, replaced, sum_of, walk

__all__ = ["OPPOSITE", "TEXTS", "Edit", "neat", "neighbours", "single_edits"]

TEXTS = {
    "none": "",
    "frame_body_space": "the body frame and the space frame are exchanged",
    "active_passive_transpose": "a rotation stands for its inverse: active for passive, or a transpose",
    "quaternion_product_order": "the factors of a quaternion product are exchanged",
    "quaternion_storage_order": "the components of a quaternion are stored in another order",
    "sign_of_term": "a term has the wrong sign",
    "overall_sign": "a whole side has the wrong sign",
    "commutator_order": "the factors of a matrix product are exchanged",
    "factor": "a factor is wrong, missing or too many",
    "half_angle": "an angle stands where half of it belongs",
    "double_half_angle": "an angle stands where twice of it belongs",
    "sin_cos_swap": "sine and cosine are exchanged",
    "wrong_symbol": "a symbol stands where another one belongs",
    "missing_term": "a term is missing",
    "extra_term": "there is a term too many",
    "inertia_product_sign": "the products of inertia have the other sign",
    "wrong_sequence_type": "the rotations belong to another sequence",
    "two_faults": "two things are wrong",
    "requires_unit_norm": "it holds for a unit vector or quaternion only",
    "requires_symmetric_top": "it holds for equal moments of inertia only",
    "requires_condition": "it holds under a condition only",
    "sign_branch": "it holds on one branch of a root only",
    "principal_value": "it holds for principal values of the inverse function only",
}
"""Code of a diagnosis -> what it says."""

COST = {
    "frame_body_space": 0.55, "active_passive_transpose": 0.6, "quaternion_product_order": 0.6,
    "commutator_order": 0.65, "quaternion_storage_order": 0.7,
    "inertia_product_sign": 0.65, "sign_of_term": 0.8, "overall_sign": 0.75,
    "sin_cos_swap": 1.0, "wrong_symbol": 1.0, "half_angle": 1.05, "double_half_angle": 1.05, "factor": 1.1,
    "wrong_sequence_type": 1.2, "extra_term": 1.5, "missing_term": 1.6,
}  # fmt: skip

MOST_NEIGHBOURS = 12

FEW = 3
"""Occurrences of an angle that are as easily wrong together as one of them alone."""

OPPOSITE = {"sin": "cos", "cos": "sin", "tan": "cot", "cot": "tan", "sec": "csc", "csc": "sec"}
ROTATIONS = ("Rx", "Ry", "Rz")
FAMILIES = (("A", "B", "C"), ("phi", "theta", "psi"), ("x", "y", "z"), ("alpha", "beta", "gamma"), ("a", "b", "c"))
_STEM = re.compile(r"([A-Za-z]+?)_?([0-9]+|[xyz]{1,2}|[sb])")
PRODUCT_OF_INERTIA = re.compile(r"[IJP]_?(xy|yx|xz|zx|yz|zy|12|21|13|31|23|32)", re.ASCII)


@dataclass(frozen=True)
class Edit:
    """A changed tree with the code and the cost of the change; ``path`` is the piece that was changed."""

    code: str
    cost: float
    path: Path
    tree: Node


def neighbours(name: str, names: Collection[str]) -> list[str]:
    """Return the names that are easily written for a name: other indices of the same letter, its family, its case."""
    family = next((set(members) for members in FAMILIES if name in members), set())
    match = _STEM.fullmatch(name)
    stem = match and match[1]
    near = []
    for other in names:
        found = _STEM.fullmatch(other)
        same = other in family or other.lower() == name.lower() or (stem and found and found[1] == stem)
        if other != name and same:
            near.append(other)
    return sorted(near)[:MOST_NEIGHBOURS]


def single_edits(
    tree: Node,
    names: Collection[str],
    functions: Collection[str],
    matrices: Callable[[Node], bool],
    moving: bool,
    opened: Callable[[Path], bool] = lambda path: True,
) -> Iterator[Edit]:
    """Yield every single edit of a tree, those of many pieces at once first.

    Parameters
    ----------
    tree : Node
    names, functions : collection of str
        Symbols and definitions, and functions of time, that may stand for each other.
    matrices : function
        Whether a piece is a matrix.
    moving : bool
        Whether the claim differentiates: an exchanged order is then one of frames.
    opened : function
        Whether the piece at a path may be changed.
    """
    yield from _everywhere(tree, matrices)
    order = "frame_body_space" if moving else "commutator_order"
    entries = {id(member) for _, node in walk(tree) if node.kind == "list" for member in node.args}
    for path, node in walk(tree):
        if not opened(path):
            continue
        for code, made, extra in _changes(node, path, names, functions, matrices, order, id(node) in entries):
            yield Edit(code, COST[code] + extra, path, _put(tree, path, made))


def _put(tree: Node, path: Path, made: Node) -> Node:
    """Return a tree with another piece: a sign comes in front of a product, terms join the sum that holds them."""
    if path and made.kind in ("neg", "sum", "product"):
        *above, place = path
        return replaced(tree, tuple(above), lambda node: _regrouped(node, place, made))
    return replaced(tree, path, lambda _: made)


def _regrouped(node: Node, place: int, made: Node) -> Node:
    args = [*node.args[:place], made, *node.args[place + 1 :]]
    if node.kind == made.kind == "sum":
        return sum_of(args, node.span)
    if node.kind == made.kind == "product":
        return product(args, node.span)
    return replace(node, args=tuple(args))


Change = tuple[str, Node, float]


def _changes(
    node: Node, path: Path, names: Collection[str], functions: Collection[str],
    matrices: Callable[[Node], bool], order: str, lone: bool,
) -> Iterator[Change]:  # fmt: skip
    """Yield (code, piece, extra cost) for one piece; a lone one is an entry of a matrix."""
    if node.kind == "sum":
        yield from _of_sum(node, matrices)
    elif node.kind == "product":
        yield from _of_product(node, matrices, order)
    elif node.kind == "call":
        yield from _of_call(node, functions)
    elif node.kind == "name":
        for other in neighbours(node.value, names):
            yield "wrong_symbol", replace(node, value=other), 0.0
    elif node.kind == "number":
        for value in (node.value * 2, node.value / 2, node.value + 1, node.value - 1):
            if value > 0 or (value == 0 and (not path or lone)):
                yield "factor", number(value), 0.0 if value in (node.value * 2, node.value / 2) else 0.15
    elif node.kind == "power" and node.args[0].kind == "call" and node.args[1].value == 2:
        yield "factor", node.args[0], 0.15
    elif node.kind == "transpose":
        yield "active_passive_transpose", node.args[0], 0.0
    if node.kind == "call" and node.value == "Matrix" and node.args[0].kind == "list":
        yield from _of_rows(node)
    if node.kind == "list" and len(node.args) == 4:
        yield from _of_quaternion(node)
    if (node.kind == "list" and node.value == ("[", "]")) or (node.kind == "call" and node.value in ("skew", "diag")):
        for place, member in enumerate(node.args):
            if member.kind not in ("list", "number", "sum"):
                made = (*node.args[:place], negated(member), *node.args[place + 1 :])
                yield "sign_of_term", replace(node, args=made), 0.0
    if node.kind in ("name", "call") and matrices(node) and not _is_own_transpose(node):
        yield "active_passive_transpose", Node("transpose", None, (node,)), 0.02
    if node.kind != "number" and node.kind != "list" and (not path or node.kind == "neg"):
        yield "overall_sign" if not path else "sign_of_term", negated(node), 0.0


def _of_rows(node: Node) -> Iterator[Change]:
    """Yield a square matrix that is written out with its rows as columns."""
    (written,) = node.args
    size = len(written.args)
    if size > 1 and all(row.kind == "list" and len(row.args) == size for row in written.args):
        columns = zip(*(row.args for row in written.args), strict=True)
        turned = [replace(row, args=tuple(column)) for row, column in zip(written.args, columns, strict=True)]
        yield "active_passive_transpose", replace(node, args=(replace(written, args=tuple(turned)),)), 0.01


def _is_own_transpose(node: Node) -> bool:
    """Return whether a transpose changes nothing, or only the shape, or is the same as another edit."""
    return node.kind == "call" and node.value in ("vee", "qmul", "Matrix", "eye", "diag", "cross", *ROTATIONS)


def _of_sum(node: Node, matrices: Callable[[Node], bool]) -> Iterator[Change]:
    terms = list(node.args)
    plain = [term.args[0] if term.kind == "neg" else term for term in terms]
    if len(terms) == 2 and all(p.kind == "product" for p in plain) and matrices(plain[0]):
        first, second = (set(p.args) for p in plain)
        if first == second:
            yield "commutator_order", sum_of([negated(term) for term in terms]), 0.0
    for place, term in enumerate(terms):
        others = [*terms[:place], *terms[place + 1 :]]
        yield "sign_of_term", sum_of([*terms[:place], negated(term), *terms[place + 1 :]]), 0.0
        yield "extra_term", sum_of(others), 0.0
        for factor in (number(2), number(Fraction(1, 2))):
            yield "factor", sum_of([*terms[:place], product([factor, term]), *terms[place + 1 :]]), 0.0


def _of_product(node: Node, matrices: Callable[[Node], bool], order: str) -> Iterator[Change]:
    factors = list(node.args)
    for place in range(len(factors) - 1):
        first, second = factors[place : place + 2]
        if matrices(first) and matrices(second) and first != second:
            yield order, product([*factors[:place], second, first, *factors[place + 2 :]]), 0.0
    turns = [place for place, factor in enumerate(factors) if factor.kind == "call" and factor.value in ROTATIONS]
    if len(turns) == len(factors) > 1:
        yield from _of_sequence(factors)
    for place in range(len(factors)):
        rest = [*factors[:place], *factors[place + 1 :]]
        if all(factor.kind == "inv" for factor in rest):
            rest = [number(1), *rest]
        yield "factor", product(rest), 0.1
    yield from _of_quotients(factors)
    if not any(map(matrices, factors)):
        yield "factor", product([number(2), node]), 0.05
        yield "factor", product([number(Fraction(1, 2)), node]), 0.05


def _of_quotients(factors: list[Node]) -> Iterator[Change]:
    """Yield ``b/a`` for ``a/b``."""
    for below, divisor in enumerate(factors):
        if divisor.kind != "inv" or divisor.args[0].kind != "name":
            continue
        for above, factor in enumerate(factors):
            if factor.kind == "name":
                made = list(factors)
                made[above], made[below] = divisor.args[0], Node("inv", None, (factor,))
                yield "wrong_symbol", product(made), 0.1


def _of_sequence(factors: list[Node]) -> Iterator[Change]:
    """Yield the product of elementary rotations in the other order, and about other axes."""
    yield "wrong_sequence_type", product(factors[::-1]), -0.3
    angles = [factor.args for factor in factors]
    for place, factor in enumerate(factors):
        for axis in ROTATIONS:
            if axis != factor.value:
                made = [*factors[:place], Node("call", axis, factor.args), *factors[place + 1 :]]
                yield "wrong_sequence_type", product(made), 0.0
    if len(factors) == 3:
        for first in ROTATIONS:
            for second in ROTATIONS:
                for third in ROTATIONS:
                    if first != second != third:
                        turned = [Node("call", a, args) for a, args in zip((first, second, third), angles, strict=True)]
                        yield "wrong_sequence_type", product(turned), 0.2


def _of_call(node: Node, functions: Collection[str]) -> Iterator[Change]:
    name, arguments = node.value, node.args
    if name in OPPOSITE:
        yield "sin_cos_swap", replace(node, value=OPPOSITE[name]), 0.0
        (argument,) = arguments
        yield "half_angle", replace(node, args=(product([argument, Node("inv", None, (number(2),))]),)), 0.0
        yield "double_half_angle", replace(node, args=(product([number(2), argument]),)), 0.0
    elif name in ROTATIONS:
        yield "active_passive_transpose", replace(node, args=(negated(arguments[0]),)), 0.0
        for axis in ROTATIONS:
            if axis != name:
                yield "wrong_sequence_type", replace(node, value=axis), 0.0
    elif name == "qmul":
        yield "quaternion_product_order", replace(node, args=arguments[::-1]), 0.0
    elif name == "cross":
        yield "sign_of_term", replace(node, args=arguments[::-1]), 0.02
    elif name in functions:
        for other in neighbours(name, functions):
            yield "wrong_symbol", replace(node, value=other), 0.0
    if len(arguments) == 4 and name == "dcm_of":
        yield from _of_quaternion(node)


def _of_quaternion(node: Node) -> Iterator[Change]:
    """Yield four components with the scalar last or first, and the conjugate."""
    first, *vector = node.args
    yield "quaternion_storage_order", replace(node, args=(*vector, first)), 0.0
    yield "quaternion_storage_order", replace(node, args=(node.args[3], *node.args[:3])), 0.0
    if not all(member.kind == "list" for member in node.args):
        yield "active_passive_transpose", replace(node, args=(first, *map(negated, vector))), 0.05
        return
    turned = [replace(member, args=tuple(map(negated, member.args))) for member in vector]
    yield "active_passive_transpose", replace(node, args=(first, *turned)), 0.05


def _everywhere(tree: Node, matrices: Callable[[Node], bool]) -> Iterator[Edit]:
    """Yield changes of one thing wherever it occurs: an angle, a matrix by name, all products of inertia."""
    found = [node for _, node in walk(tree)]
    angles = {node.args[0] for node in found if node.kind == "call" and node.value in OPPOSITE}
    arguments = [node.args[0] for node in found if node.kind == "call" and node.value in OPPOSITE]
    repeated = [angle for angle in angles if arguments.count(angle) > 1]
    for angle in sorted(repeated, key=str):
        for code, made in (
            ("half_angle", product([angle, Node("inv", None, (number(2),))])),
            ("double_half_angle", product([number(2), angle])),
        ):
            cost = 0.9 if arguments.count(angle) <= FEW else 1.07
            yield Edit(code, cost, (), _substituted(tree, angle, made, inside=OPPOSITE))
        swapped = _swapped_functions(tree, angle)
        yield Edit("sin_cos_swap", 0.95, (), swapped)
    names = sorted({node.value for node in found if node.kind == "name"})
    for name in names:
        node = Node("name", name)
        if sum(other == node for other in found) > 1 and matrices(node):
            yield Edit("active_passive_transpose", 0.58, (), _substituted(tree, node, Node("transpose", None, (node,))))
    products = [name for name in names if PRODUCT_OF_INERTIA.fullmatch(name)]
    if products:
        made = tree
        for name in products:
            made = _substituted(made, Node("name", name), negated(Node("name", name)))
        yield Edit("inertia_product_sign", COST["inertia_product_sign"], (), made)


def _substituted(tree: Node, old: Node, new: Node, inside: Collection[str] | None = None) -> Node:
    """Return a tree with a piece replaced everywhere (only as the argument of certain functions, if they are given)."""
    if tree == old and inside is None:
        return new
    direct = inside is not None and tree.kind == "call" and tree.value in inside and tree.args[0] == old
    args = (new,) if direct else tuple(_substituted(child, old, new, inside) for child in tree.args)
    if args == tree.args:
        return tree
    return _rebuilt(replace(tree, args=args))


def _rebuilt(node: Node) -> Node:
    """Return a node with its signs in front again, as the reader makes them."""
    if node.kind == "product":
        return product(list(node.args), node.span)
    if node.kind == "neg":
        return negated(node.args[0])
    return node


def _swapped_functions(tree: Node, angle: Node) -> Node:
    if tree.kind == "call" and tree.value in OPPOSITE and tree.args[0] == angle:
        return replace(tree, value=OPPOSITE[tree.value])
    return replace(tree, args=tuple(_swapped_functions(child, angle) for child in tree.args))


def neat(node: Node) -> Node:
    """Return a tree without factors 1 and without fractions under a fraction bar, which edits of numbers leave."""
    args = tuple(map(neat, node.args))
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

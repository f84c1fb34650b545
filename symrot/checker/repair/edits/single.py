"""The faults that occur in practice (a lost factor, a wrong sign), as edits of a tree; each has a code and a cost.

An edit changes one part of a formula; it costs less if its fault is more likely. The argument ``is_matrix`` of the
functions tells whether a node is a matrix.
"""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace

from symrot.checker.claim.tree import Node, Path, negated, number, product, walk
from symrot.checker.repair.edits.calls import edits_of_call, edits_of_quaternion, edits_of_rows, is_own_transpose
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import OPPOSITE, neighbours
from symrot.checker.repair.edits.sums_and_products import PartEdit, edits_of_product, edits_of_sum
from symrot.checker.repair.edits.trees import put, square_of, substituted, with_cofunctions, with_other_products

__all__ = ["Edit", "single_edits"]

FEW = 3
"""The largest number of sines and cosines of one angle in which it is cheap to halve or double the angle.

The edit halves or doubles the angle in all of them. It costs ``COST["angle_everywhere"]`` for up to this number of
sines and cosines, and ``COST["angle_everywhere_often"]``, which is higher, for more.
"""


@dataclass(frozen=True)
class Edit:
    """A tree after one edit, with the cost of the edit and a code such as ``sign_of_term`` for the corrected fault."""

    code: str
    cost: float
    path: Path  # to the edited part; empty if the whole tree changes
    tree: Node


def single_edits(
    tree: Node,
    names: Collection[str],
    functions: Collection[str],
    is_matrix: Callable[[Node], bool],
    moving: bool,
    is_tried: Callable[[Path], bool] = lambda path: True,
) -> Iterator[Edit]:
    """Yield every single edit of a tree; edits that change all occurrences of a name or angle come first.

    Parameters
    ----------
    tree : Node
    names : collection of str
        Names of symbols and definitions.
    functions : collection of str
        Names of functions of time. An edit may put any of these names in place of another.
    is_matrix : function
        Tells whether a node is a matrix.
    moving : bool
        Whether the claim contains a derivative. Exchanged factors, as in ``diff(R, t) == R*W`` for ``W*R``, then count
        as a confusion of the body frame with the space frame; otherwise as a wrong order of factors.
    is_tried : function
        Tells whether edits of the part at a path are yielded; by default they are for every part. Edits that change all
        occurrences of a name or angle are always yielded.
    """
    yield from _everywhere(tree, is_matrix)
    order = "frame_body_space" if moving else "commutator_order"
    nodes = [node for _, node in walk(tree)]
    entries = {id(member) for node in nodes if node.kind == "list" for member in node.args}
    exponents = {id(node.args[1]) for node in nodes if node.kind == "power"}
    closed = {id(part) for node in nodes if node.kind in ("power", "index", "call") and not _admits_squares(node)
              for part in node.args}  # fmt: skip
    for path, node in walk(tree):
        if not is_tried(path):
            continue
        for code, made, extra in _changes(node, path, names, functions, is_matrix, order, id(node) in entries):
            is_exponent = code == "factor" and id(node) in exponents
            code = "exponent" if is_exponent else code
            yield Edit(code, COST[code] + extra, path, put(tree, path, made))
        if id(node) not in closed and _is_scalar(node, is_matrix):
            squared = square_of(node)
            yield Edit("exponent", COST["exponent"], path, put(tree, path, squared))


def _admits_squares(node: Node) -> bool:
    """Return whether `single_edits` may square an argument of a call: in ``Matrix``, ``diag`` and ``sqrt`` only."""
    return node.kind == "call" and node.value in ("Matrix", "sqrt", "diag")


def _is_scalar(node: Node, is_matrix: Callable[[Node], bool]) -> bool:
    """Return whether a part is a scalar name or call, such as r or sin(x), which the author may have meant squared."""
    if node.kind not in ("name", "call") or node == Node("name", "pi") or node.value in ("Matrix", "diff", "integrate"):
        return False
    # calls with scalar values and matrices as arguments
    return not is_matrix(node) or node.value in ("dot", "det", "trace")


def _changes(
    node: Node, path: Path, names: Collection[str], functions: Collection[str],
    is_matrix: Callable[[Node], bool], order: str, lone: bool,
) -> Iterator[PartEdit]:  # fmt: skip
    """Yield the edits of the part ``node``, which is at ``path`` in its tree: code, new part and additional cost.

    Parameters
    ----------
    names, functions : collection of str
        Names of symbols and definitions, and of functions of time; an edit may put any of them in place of another.
    is_matrix : function
        Tells whether a node is a matrix.
    order : str
        The code of the fault if two matrices in a product are in the wrong order.
    lone : bool
        Whether the part is an entry of a matrix or list; a number may become 0 only as such an entry or a whole tree.
    """
    if node.kind == "sum":
        yield from edits_of_sum(node, is_matrix)
    elif node.kind == "product":
        yield from edits_of_product(node, is_matrix, order)
    elif node.kind == "call":
        yield from edits_of_call(node, path, functions, is_matrix)
    elif node.kind == "name":
        for other in neighbours(node.value, names):
            yield "wrong_symbol", replace(node, value=other), 0.0
    elif node.kind == "number":
        for value in (node.value * 2, node.value / 2, node.value + 1, node.value - 1):
            if value > 0 or (value == 0 and (not path or lone)):
                doubled = value in (node.value * 2, node.value / 2)
                yield "factor", number(value), 0.0 if doubled else COST["number_off_by_one"]
    elif node.kind == "power" and node.args[1] == number(2):
        yield "exponent", node.args[0], 0.0
    elif node.kind == "transpose":
        yield "active_passive_transpose", node.args[0], 0.0
    if node.kind == "call" and node.value == "Matrix" and node.args[0].kind == "list":
        yield from edits_of_rows(node)
    if node.kind == "list" and len(node.args) == 4:
        yield from edits_of_quaternion(node)
    if (node.kind == "list" and node.value == ("[", "]")) or (node.kind == "call" and node.value in ("skew", "diag")):
        for place, member in enumerate(node.args):
            if member.kind not in ("list", "number", "sum"):
                made = (*node.args[:place], negated(member), *node.args[place + 1 :])
                yield "sign_of_term", replace(node, args=made), 0.0
    if node.kind in ("name", "call") and is_matrix(node) and not is_own_transpose(node):
        yield "active_passive_transpose", Node("transpose", None, (node,)), COST["name_transposed"]
    if node.kind != "number" and node.kind != "list" and (not path or node.kind == "neg"):
        yield "overall_sign" if not path else "sign_of_term", negated(node), 0.0


def _everywhere(tree: Node, is_matrix: Callable[[Node], bool]) -> Iterator[Edit]:
    """Yield edits that change all occurrences of a name or angle in a tree, such as every u to u/2."""
    nodes = [node for _, node in walk(tree)]
    angles = {node.args[0] for node in nodes if node.kind == "call" and node.value in OPPOSITE}
    arguments = [node.args[0] for node in nodes if node.kind == "call" and node.value in OPPOSITE]
    repeated = [angle for angle in angles if arguments.count(angle) > 1]
    for angle in sorted(repeated, key=str):
        for code, made in (
            ("half_angle", product([angle, Node("inv", None, (number(2),))])),
            ("double_half_angle", product([number(2), angle])),
        ):
            cost = COST["angle_everywhere" if arguments.count(angle) <= FEW else "angle_everywhere_often"]
            yield Edit(code, cost, (), substituted(tree, angle, made, inside=OPPOSITE))
        swapped = with_cofunctions(tree, angle)
        yield Edit("sin_cos_swap", COST["sin_cos_swap_everywhere"], (), swapped)
    # a matrix that occurs several times is transposed
    names = sorted({node.value for node in nodes if node.kind == "name"})
    for name in names:
        node = Node("name", name)
        if sum(other == node for other in nodes) > 1 and is_matrix(node):
            transposed = substituted(tree, node, Node("transpose", None, (node,)))
            yield Edit("active_passive_transpose", COST["transpose_everywhere"], (), transposed)
    if (other := with_other_products(tree)) is not None:
        yield Edit("inertia_product_sign", COST["inertia_product_sign"], (), other)

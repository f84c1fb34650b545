"""The faults that occur in practice (a lost factor, a wrong sign), as edits of a tree; each has a code and a cost.

An edit changes one part of a formula; it costs less if its fault is more likely. The argument ``matrices`` of the
functions tells whether a node is a matrix.
"""

import itertools
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import isqrt

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, Path, negated, number, product, replaced, sum_of, walk

__all__ = [
    "COST",
    "FAULT_DESCRIPTIONS",
    "OPPOSITE",
    "Edit",
    "bracketed",
    "flattened",
    "neighbours",
    "normalise_factors",
    "put",
    "scaled",
    "single_edits",
]

FAULT_DESCRIPTIONS = {
    "none": "",
    "frame_body_space": "the body frame and the space frame are exchanged",
    "active_passive_transpose": "a rotation is used in place of its inverse: active for passive, or a transpose",
    "quaternion_product_order": "the factors of a quaternion product are exchanged",
    "quaternion_storage_order": "the components of a quaternion are stored in another order",
    "sign_of_term": "a term has the wrong sign",
    "overall_sign": "a whole side has the wrong sign",
    "commutator_order": "the factors of a matrix product are exchanged",
    "factor": "a factor is wrong, missing or too many",
    "exponent": "a power is wrong, such as a square that is missing",
    "half_angle": "an angle is used in place of its half",
    "double_half_angle": "an angle is used in place of its double",
    "sin_cos_swap": "sine and cosine are exchanged",
    "wrong_symbol": "a symbol is used in place of another one",
    "missing_term": "a term is missing",
    "extra_term": "there is a term too many",
    "lost_brackets": "brackets are missing or enclose too little",
    "inertia_product_sign": "the products of inertia have the other sign",
    "wrong_sequence_type": "the rotations belong to another sequence",
    "two_faults": "two things are wrong",
    "requires_unit_norm": "it holds for a unit vector or quaternion only",
    "requires_symmetric_top": "it holds for equal moments of inertia only",
    "requires_condition": "it holds under a condition only",
    "sign_branch": "it holds on one branch of a root only",
    "principal_value": "it holds for principal values of the inverse function only",
}
"""Code of a diagnosis -> its sentence."""

COST = {
    "frame_body_space": 0.55, "active_passive_transpose": 0.6, "quaternion_product_order": 0.6,
    "commutator_order": 0.65, "quaternion_storage_order": 0.7,
    "inertia_product_sign": 0.65, "sign_of_term": 0.8, "overall_sign": 0.75,
    "sin_cos_swap": 1.0, "wrong_symbol": 1.0, "half_angle": 1.05, "double_half_angle": 1.05, "factor": 1.1,
    "two_faults": 1.6, "wrong_sequence_type": 1.2, "extra_term": 1.5, "missing_term": 1.6,
    "lost_brackets": 1.15,
    # added to the cost of the code
    "in_definition": 0.4, "number_off_by_one": 0.15, "name_transposed": 0.02,
    "rows_as_columns": 0.01, "names_exchanged": 0.1, "root_left_out": 0.1,
    "cross_product_order": 0.02, "whole_cross_product_order": -0.04,
    "factor_removed": 0.1, "product_doubled_or_halved": 0.05,
    "quotient_inverted": 0.1, "quaternion_conjugated": 0.05, "sequence_reversed": -0.3, "three_axes_changed": 0.2,
    # one fault everywhere in a tree
    "angle_everywhere": 0.9, "angle_everywhere_often": 1.07, "sin_cos_swap_everywhere": 0.95,
    "transpose_everywhere": 0.58,
    # several wrong entries of a matrix, each with its own edit: times the sum of the costs of these edits
    "share_of_entries": 0.6,
    # additions to a tree
    "missing_term_of_entry": 1.75, "missing_term_in_bracket": 1.8, "missing_matrix": 1.4, "other_definition": 1.3,
    # a piece replaced by the value that it needs
    "solved_sign": 0.85, "solved_factor_2": 1.16, "solved_rational_factor": 1.3, "solved_number": 1.25,
    "solved_factor": 1.22, "solved_factor_of_number": 0.5, "solved_term_of_sum": 1.5, "solved_term": 1.65,
    "solved_swap": 1.0, "solved_neighbour": 1.0, "solved_symbol": 1.2, "solved_matrix_term": 0.04,
    # a part of a formula near a known one: per factor e between two numbers, a fraction in place of a number, a power
    # other than the square, and a function other than the one that is often confused with it
    "exponent": 1.1, "per_factor_e": 0.1, "no_integer": 0.15, "not_a_square": 0.1, "other_function": 0.1,
    # growth with the size of the inserted formula, and with the depth of the piece
    "per_piece_added": 0.02, "rational_in_front": 0.04, "per_level": 0.01, "per_level_of_matrix": 0.05,
}  # fmt: skip
"""Costs of edits, by code or by kind of edit: the order in which repairs are tried and offered."""

MOST_NEIGHBOURS = 12
"""The most names that are tried in place of one name."""

MOST_NAMES_EXCHANGED = 6
"""The most names of a product of which two are exchanged."""

MOST_TERMS_IN_PAIRS = 6
"""The most terms of a sum of which two signs are changed together."""

FEW = 3
"""Up to this number of occurrences of an angle, all of them are as likely to be wrong together as one alone."""

OPPOSITE = {"sin": "cos", "cos": "sin", "tan": "cot", "cot": "tan", "sec": "csc", "csc": "sec"}
INVERSE_OPPOSITE = {"asin": "acos", "acos": "asin"}
FAMILIES = (("A", "B", "C"), ("phi", "theta", "psi"), ("x", "y", "z"), ("alpha", "beta", "gamma"), ("a", "b", "c"))
_STEM = re.compile(r"([A-Za-z]+?)_?([0-9]+|[xyz]{1,2}|[sb])")
PRODUCT_OF_INERTIA = re.compile(r"[IJP]_?(xy|yx|xz|zx|yz|zy|12|21|13|31|23|32)", re.ASCII)


@dataclass(frozen=True)
class Edit:
    """A tree after one edit, with the cost of the edit and a code such as ``sign_of_term`` for the corrected fault."""

    code: str
    cost: float
    path: Path  # to the edited part; empty if the whole tree changes
    tree: Node


def neighbours(name: str, names: Collection[str]) -> list[str]:
    """Return those of ``names`` that are easily confused with ``name``: ``w_2`` and ``w_1``, ``theta`` and ``phi``."""
    family = next((set(members) for members in FAMILIES if name in members), set())
    match = _STEM.fullmatch(name)
    stem = match and match[1]
    near = []
    for other in names:
        other_match = _STEM.fullmatch(other)
        same_stem = stem and other_match and other_match[1] == stem
        same = other in family or other.lower() == name.lower() or same_stem
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
    """Yield every single edit of a tree; edits that change all occurrences of a name or angle come first.

    Parameters
    ----------
    tree : Node
    names : collection of str
        Names of symbols and definitions.
    functions : collection of str
        Names of functions of time. An edit may put any of these names in place of another.
    matrices : function
        Tells whether a node is a matrix.
    moving : bool
        Whether the claim contains a derivative. Exchanged factors, as in ``diff(R, t) == R*W`` for ``W*R``, then count
        as a confusion of the body frame with the space frame; otherwise as a wrong order of factors.
    opened : function
        Tells whether an edit may change the part at a path; by default it may change every part.
    """
    yield from _everywhere(tree, matrices)
    order = "frame_body_space" if moving else "commutator_order"
    nodes = [node for _, node in walk(tree)]
    entries = {id(member) for node in nodes if node.kind == "list" for member in node.args}
    exponents = {id(node.args[1]) for node in nodes if node.kind == "power"}
    closed = {id(part) for node in nodes if node.kind in ("power", "index", "call") and not _admits_squares(node)
              for part in node.args}  # fmt: skip
    for path, node in walk(tree):
        if not opened(path):
            continue
        for code, made, extra in _changes(node, path, names, functions, matrices, order, id(node) in entries):
            is_exponent = code == "factor" and id(node) in exponents
            code = "exponent" if is_exponent else code
            yield Edit(code, COST[code] + extra, path, put(tree, path, made))
        if id(node) not in closed and _is_scalar(node, matrices):
            squared = Node("power", None, (node, number(2)))
            yield Edit("exponent", COST["exponent"], path, put(tree, path, squared))


def _admits_squares(node: Node) -> bool:
    """Return whether an edit may square the arguments of ``node``: True for ``Matrix``, ``diag`` and ``sqrt``."""
    return node.kind == "call" and node.value in ("Matrix", "sqrt", "diag")


def _is_scalar(node: Node, matrices: Callable[[Node], bool]) -> bool:
    """Return whether a part is a scalar name or call, such as r or sin(x), that may have lost a square."""
    if node.kind not in ("name", "call") or node == Node("name", "pi") or node.value in ("Matrix", "diff", "integrate"):
        return False
    # calls with scalar values and matrices as arguments
    return not matrices(node) or node.value in ("dot", "det", "trace")


def put(tree: Node, path: Path, made: Node) -> Node:
    """Return a tree with the node ``made`` at ``path``; a sum in a sum, or a product in a product, is merged."""
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
"""The code of an edit, the new piece, and the cost beyond that of the code."""


def _changes(
    node: Node, path: Path, names: Collection[str], functions: Collection[str],
    matrices: Callable[[Node], bool], order: str, lone: bool,
) -> Iterator[Change]:  # fmt: skip
    """Yield the edits of the part ``node``, which is at ``path`` in its tree: code, new part and additional cost.

    Parameters
    ----------
    names, functions : collection of str
        Names of symbols and definitions, and of functions of time; an edit may put any of them in place of another.
    matrices : function
        Tells whether a node is a matrix.
    order : str
        The code of the fault if two matrices in a product are in the wrong order.
    lone : bool
        Whether the part is an entry of a matrix or list; only such an entry, or a whole side, may become 0.
    """
    if node.kind == "sum":
        yield from _of_sum(node, matrices)
    elif node.kind == "product":
        yield from _of_product(node, matrices, order)
    elif node.kind == "call":
        yield from _of_call(node, path, functions, matrices)
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
        yield from _of_rows(node)
    if node.kind == "list" and len(node.args) == 4:
        yield from _of_quaternion(node)
    if (node.kind == "list" and node.value == ("[", "]")) or (node.kind == "call" and node.value in ("skew", "diag")):
        for place, member in enumerate(node.args):
            if member.kind not in ("list", "number", "sum"):
                made = (*node.args[:place], negated(member), *node.args[place + 1 :])
                yield "sign_of_term", replace(node, args=made), 0.0
    if node.kind in ("name", "call") and matrices(node) and not _is_own_transpose(node):
        yield "active_passive_transpose", Node("transpose", None, (node,)), COST["name_transposed"]
    if node.kind != "number" and node.kind != "list" and (not path or node.kind == "neg"):
        yield "overall_sign" if not path else "sign_of_term", negated(node), 0.0


def _of_rows(node: Node) -> Iterator[Change]:
    """Yield the edit that transposes a matrix if it is square and its rows are written out; otherwise yield nothing."""
    (written,) = node.args
    size = len(written.args)
    if size > 1 and all(row.kind == "list" and len(row.args) == size for row in written.args):
        columns = zip(*(row.args for row in written.args), strict=True)
        rows = tuple(replace(row, args=tuple(column)) for row, column in zip(written.args, columns, strict=True))
        transposed = replace(node, args=(replace(written, args=rows),))
        yield "active_passive_transpose", transposed, COST["rows_as_columns"]


def _is_own_transpose(node: Node) -> bool:
    """Return whether a node is a call whose transpose is no useful edit, such as ``diag(..)``."""
    # a transposed rotation matrix has the angle with the other sign, which another edit gives
    return node.kind == "call" and node.value in ("vee", "qmul", "Matrix", "eye", "diag", "cross", *ROTATIONS)


def _of_sum(node: Node, matrices: Callable[[Node], bool]) -> Iterator[Change]:
    terms = list(node.args)
    plain = [term.args[0] if term.kind == "neg" else term for term in terms]
    if len(terms) == 2 and all(p.kind == "product" for p in plain) and matrices(plain[0]):
        first, second = (set(p.args) for p in plain)
        if first == second:
            yield "commutator_order", sum_of([negated(term) for term in terms]), 0.0
    for both in itertools.combinations(range(len(terms)), 2) if 2 < len(terms) <= MOST_TERMS_IN_PAIRS else ():
        signs = [negated(term) if place in both else term for place, term in enumerate(terms)]
        yield "two_faults", sum_of(signs), 0.0
    for factor in (number(2), number(Fraction(1, 2))) if len(terms) <= MOST_TERMS_IN_PAIRS else ():
        yield "factor", product([factor, node]), COST["product_doubled_or_halved"]
    if len(terms) <= MOST_TERMS_IN_PAIRS:
        for made in bracketed(terms):
            yield "lost_brackets", made, 0.0
    for place, term in enumerate(terms):
        others = [*terms[:place], *terms[place + 1 :]]
        yield "sign_of_term", sum_of([*terms[:place], negated(term), *terms[place + 1 :]]), 0.0
        yield "extra_term", sum_of(others), 0.0
        for factor in (number(2), number(Fraction(1, 2))):
            yield "factor", sum_of([*terms[:place], product([factor, term]), *terms[place + 1 :]]), 0.0


def bracketed(terms: Sequence[Node]) -> Iterator[Node]:
    """Yield sums with brackets that may be missing: ``(a - b)*c`` for ``a - b*c``, ``c*(a - b)`` for ``c*a - b``."""
    for first, last in itertools.combinations(range(len(terms)), 2):
        before, after = terms[:first], terms[last + 1 :]
        start, is_negative = (terms[first].args[0], True) if terms[first].kind == "neg" else (terms[first], False)
        end, is_end_negative = (terms[last].args[0], True) if terms[last].kind == "neg" else (terms[last], False)
        inside = terms[first + 1 : last]
        if end.kind == "product" and end.args[0].kind != "inv":
            *rest, factor = end.args
            lone = negated(product(rest)) if is_end_negative else product(rest)
            whole = product([sum_of([start, *inside, lone]), factor])
            yield sum_of([*before, negated(whole) if is_negative else whole, *after])
        if start.kind == "product" and start.args[1].kind != "inv":
            factor, *others = start.args
            whole = product([factor, sum_of([product(others), *inside, terms[last]])])
            yield sum_of([*before, negated(whole) if is_negative else whole, *after])


def _of_product(node: Node, matrices: Callable[[Node], bool], order: str) -> Iterator[Change]:
    factors = list(node.args)
    for place in range(len(factors) - 1):
        first, second = factors[place : place + 2]
        if matrices(first) and matrices(second) and first != second:
            yield order, product([*factors[:place], second, first, *factors[place + 2 :]]), 0.0
    if len(factors) > 1 and all(factor.kind == "call" and factor.value in ROTATIONS for factor in factors):
        yield from _of_sequence(factors)
    for place in range(len(factors)):
        rest = [*factors[:place], *factors[place + 1 :]]
        if all(factor.kind == "inv" for factor in rest):
            rest = [number(1), *rest]
        yield "factor", product(rest), COST["factor_removed"]
    yield from _of_quotients(factors)
    yield from _with_exchanged_names(node, matrices)
    yield from _with_roots(node, matrices)
    if not any(map(matrices, factors)):
        yield "factor", product([number(2), node]), COST["product_doubled_or_halved"]
        yield "factor", product([number(Fraction(1, 2)), node]), COST["product_doubled_or_halved"]


def _with_roots(node: Node, matrices: Callable[[Node], bool]) -> Iterator[Change]:
    """Yield edits of a product that take the root of some factors: ``2*sqrt(g*h)``, ``g*h*sqrt(2)`` for ``2*g*h``."""
    if any(map(matrices, node.args)):
        return
    kinds = [any(part.kind in ("name", "call") and part.value != "pi" for _, part in walk(f)) for f in node.args]
    numbers, others = (
        [f for f, named in zip(node.args, kinds, strict=True) if named == kind] for kind in (False, True)
    )
    for rooted, rest in ((numbers, others), (others, numbers)):
        if rooted and rest and not all(map(_is_square, rooted)):
            yield "exponent", product([*rest, Node("call", "sqrt", (product(rooted),))]), COST["root_left_out"]


def _is_square(node: Node) -> bool:
    """Return whether a factor is the square of a rational number, such as 4/9, or 1 divided by such a square."""
    value = (node.args[0] if node.kind == "inv" else node).value
    return isinstance(value, Fraction) and all(isqrt(n) ** 2 == n for n in (value.numerator, value.denominator))


def _with_exchanged_names(node: Node, matrices: Callable[[Node], bool]) -> Iterator[Change]:
    """Yield the edits of a product that exchange two vectors or easily confused letters, such as phi and theta."""
    names = list(dict.fromkeys(part for _, part in walk(node) if part.kind == "name" and part.value != "pi"))
    if len(names) > MOST_NAMES_EXCHANGED or all(part.kind == "name" for part in node.args):
        return
    for first, second in itertools.combinations(names, 2):
        if (matrices(first) and matrices(second)) or second.value in neighbours(first.value, [second.value]):
            hole = Node("name", "?")
            made = _substituted(_substituted(_substituted(node, first, hole), second, first), hole, second)
            yield "wrong_symbol", made, COST["names_exchanged"]


def _of_quotients(factors: list[Node]) -> Iterator[Change]:
    """Yield edits of a product of ``factors`` that invert a quotient of two letters: ``b/a*c`` for ``a/b*c``."""
    for below, divisor in enumerate(factors):
        if divisor.kind != "inv" or divisor.args[0].kind != "name":
            continue
        for above, factor in enumerate(factors):
            if factor.kind == "name":
                made = list(factors)
                made[above], made[below] = divisor.args[0], Node("inv", None, (factor,))
                yield "wrong_symbol", product(made), COST["quotient_inverted"]


def _of_sequence(factors: list[Node]) -> Iterator[Change]:
    """Yield edits of a product of elementary rotations: ``Rx(b)*Rz(a)`` and ``Ry(a)*Rx(b)`` for ``Rz(a)*Rx(b)``."""
    yield "wrong_sequence_type", product(factors[::-1]), COST["sequence_reversed"]
    angles = [factor.args for factor in factors]
    for place, factor in enumerate(factors):
        for axis in _spelled_like(factor.value):
            if axis != factor.value:
                made = [*factors[:place], Node("call", axis, factor.args), *factors[place + 1 :]]
                yield "wrong_sequence_type", product(made), 0.0
    if len(factors) == 3:
        for axes in itertools.product(_spelled_like(factors[0].value), repeat=3):
            if axes[0] != axes[1] != axes[2]:
                made = [Node("call", axis, args) for axis, args in zip(axes, angles, strict=True)]
                yield "wrong_sequence_type", product(made), COST["three_axes_changed"]


def _spelled_like(rotation: str) -> tuple[str, ...]:
    """Return the names of the rotations about x, y and z in the spelling of ``rotation``: Rx, Ry and Rz for ``Rz``."""
    return tuple(rotation[:-1] + axis for axis in "xyz")


def _scalars_in_front(node: Node, matrices: Callable[[Node], bool]) -> tuple[list[Node], Node]:
    """Return the scalar factors of a vector, and the vector without these factors: ([m], v) for ``m*v``."""
    scalars = [factor for factor in node.args if not matrices(factor)] if node.kind == "product" else []
    rest = [factor for factor in node.args if factor not in scalars]
    return (scalars, product(rest)) if scalars and rest else ([], node)


def _of_call(node: Node, path: Path, functions: Collection[str], matrices: Callable[[Node], bool]) -> Iterator[Change]:
    name, arguments = node.value, node.args
    if name in OPPOSITE:
        yield "sin_cos_swap", replace(node, value=OPPOSITE[name]), 0.0
        (argument,) = arguments
        yield "half_angle", replace(node, args=(product([argument, Node("inv", None, (number(2),))]),)), 0.0
        yield "double_half_angle", replace(node, args=(product([number(2), argument]),)), 0.0
    elif name in INVERSE_OPPOSITE:
        yield "sin_cos_swap", replace(node, value=INVERSE_OPPOSITE[name]), 0.0
    elif name == "atan2":
        yield "wrong_symbol", replace(node, args=arguments[::-1]), COST["names_exchanged"]
    elif name == "sqrt":
        yield "exponent", arguments[0], COST["root_left_out"]
    elif name in ROTATIONS:
        yield "active_passive_transpose", replace(node, args=(negated(arguments[0]),)), 0.0
        for axis in _spelled_like(name):
            if axis != name:
                yield "wrong_sequence_type", replace(node, value=axis), 0.0
    elif name == "qmul":
        yield "quaternion_product_order", replace(node, args=arguments[::-1]), 0.0
    elif name == "cross":
        first, second = (_scalars_in_front(argument, matrices) for argument in arguments)
        made = product([*first[0], *second[0], replace(node, args=(second[1], first[1]))])
        yield "sign_of_term", made, COST["cross_product_order" if path else "whole_cross_product_order"]
    elif name in functions:
        for other in neighbours(name, functions):
            yield "wrong_symbol", replace(node, value=other), 0.0
    if len(arguments) == 4 and name == "dcm_of":
        yield from _of_quaternion(node)


def _of_quaternion(node: Node) -> Iterator[Change]:
    """Yield edits of a quaternion with written-out components: another order of storage, or the conjugate."""
    first, *vector = node.args
    yield "quaternion_storage_order", replace(node, args=(*vector, first)), 0.0
    yield "quaternion_storage_order", replace(node, args=(node.args[3], *node.args[:3])), 0.0
    if all(member.kind == "list" for member in node.args):
        conjugate = [replace(member, args=tuple(map(negated, member.args))) for member in vector]
    else:
        conjugate = [negated(member) for member in vector]
    yield "active_passive_transpose", replace(node, args=(first, *conjugate)), COST["quaternion_conjugated"]


def _everywhere(tree: Node, matrices: Callable[[Node], bool]) -> Iterator[Edit]:
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
            yield Edit(code, cost, (), _substituted(tree, angle, made, inside=OPPOSITE))
        swapped = _swapped_functions(tree, angle)
        yield Edit("sin_cos_swap", COST["sin_cos_swap_everywhere"], (), swapped)
    # a matrix that occurs several times is transposed
    names = sorted({node.value for node in nodes if node.kind == "name"})
    for name in names:
        node = Node("name", name)
        if sum(other == node for other in nodes) > 1 and matrices(node):
            transposed = _substituted(tree, node, Node("transpose", None, (node,)))
            yield Edit("active_passive_transpose", COST["transpose_everywhere"], (), transposed)
    products = [name for name in names if PRODUCT_OF_INERTIA.fullmatch(name)]
    if products:
        made = tree
        for name in products:
            made = _substituted(made, Node("name", name), negated(Node("name", name)))
        yield Edit("inertia_product_sign", COST["inertia_product_sign"], (), made)


def _substituted(tree: Node, old: Node, new: Node, inside: Collection[str] | None = None) -> Node:
    """Return a tree with ``new`` for each ``old``; with ``inside``, only for arguments of the functions named there."""
    if tree == old and inside is None:
        return new
    direct = inside is not None and tree.kind == "call" and tree.value in inside and tree.args[0] == old
    args = (new,) if direct else tuple(_substituted(child, old, new, inside) for child in tree.args)
    if args == tree.args:
        return tree
    return _rebuilt(replace(tree, args=args))


def _rebuilt(node: Node) -> Node:
    """Return a product or negated formula in the form that the reader of claims builds: ``-(a*b)`` for ``a*(-b)``.

    Other nodes are returned unchanged.
    """
    if node.kind == "product":
        return product(list(node.args), node.span)
    if node.kind == "neg":
        return negated(node.args[0])
    return node


def _swapped_functions(tree: Node, angle: Node) -> Node:
    if tree.kind == "call" and tree.value in OPPOSITE and tree.args[0] == angle:
        return replace(tree, value=OPPOSITE[tree.value])
    return replace(tree, args=tuple(_swapped_functions(child, angle) for child in tree.args))


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

"""Index notation with Kronecker's delta and the Levi-Civita symbol, written out for the indices 1, 2 and 3.

An index that occurs twice in a term is summed. An index that occurs once is free: the equation holds for each value of
it, so both sides become matrices with an entry for each combination of the free indices.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product as combinations

from symrot.checker.claim.tree import Node, factors_of, matrix_of_rows, negated, nodes_of, number, product, sum_of
from symrot.checker.claim.vectors import MARK
from symrot.errors import InputError

__all__ = ["component_of_cross", "has_index_symbols", "written_out"]

Relation = tuple[str, Node, Node]
INDEXED = re.compile(r"([A-Za-z]+)_([i-np-s]{1,4})")
SYMBOLS = {"delta": 2, "epsilon": 3}
"""Maps delta and epsilon to the number of their indices."""

OF_PAULI = frozenset({"sigma", "i", "I"})
"""The letters of identities such as ``σ_j σ_k = δ_jk + i ε_jkl σ_l``: Pauli's matrices, i and the unit matrix."""

MOST_ENTRIES, WIDTH = 81, 9
"""MOST_ENTRIES is the largest number of terms of a written-out sum, and of components of a written-out equation. If an
equation has more than WIDTH components, each side usually becomes a matrix with WIDTH components in a row."""


def written_out(relation: Relation) -> tuple[Relation, str]:
    """Return an equation with delta_ij or epsilon_ijk written out in components, and a note for the user.

    Other equations are returned unchanged, with an empty note.

    Raises
    ------
    InputError
        For an index that occurs more than twice in a term, for terms with different free indices, and for more than
        four free indices or four summed ones.
    """
    sign, left, right = relation
    nodes = nodes_of(left, right)
    # a condition such as R_ik R_jk = delta_ij stays as it is too
    if not any(_symbol(node) for node in nodes) or _is_condition(left, right):
        return relation, ""
    free = {_free(term) for side in (left, right) for term in _terms(side)}
    if len(free) > 1:
        *_, few, many = sorted(("".join(indices) or "none" for indices in free), key=len)
        raise InputError(f"expected the same free indices in each term, got {few} in one term and {many} in another")
    (indices,) = free
    name = next((side for side in (left, right) if _is_component(side, right if side is left else left)), None)
    indices = indices if name is None else tuple(_indices(name))
    if 3 ** len(indices) > MOST_ENTRIES:
        raise InputError(f"expected at most 4 free indices, got {len(indices)}: {', '.join(indices)}")
    values = [dict(zip(indices, choice, strict=True)) for choice in combinations("123", repeat=len(indices))]
    lefts, rights = ([_component(side, value) for value in values] for side in (left, right))
    is_pauli = "sigma" in {*_quantities(left), *_quantities(right)}  # each entry is then a matrix itself
    width = 3 if is_pauli else WIDTH
    if name is not None and len(indices) < 3:
        width, stem = (1, 3)[len(indices) - 1], Node("name", str(name.value).rpartition("_")[0])
        lefts, rights = ([stem], rights) if name is left else (lefts, [stem])
    first, second = (
        entries[0]
        if len(entries) == 1
        else matrix_of_rows([entries[n : n + width] for n in range(0, len(entries), width)])
        for entries in (lefts, rights)
    )
    take = "takes" if len(indices) == 1 else "take"
    free_words = f"; {', '.join(indices)} {take} every value" if indices else ""
    return (sign, first, second), f"indices run from 1 to 3, and one that occurs twice in a term is summed{free_words}"


def component_of_cross(pair: Sequence[Node], index: str, used: str) -> Node | None:
    """Return ``epsilon_ijk a_j b_k``, the component i of a x b; ``pair`` holds a and b, ``index`` is i.

    The summed indices j and k are letters that do not occur in ``used``, a text of the indices in use. None if a or b
    is no name, if ``index`` is no index, or if no letters are left.
    """
    left, right = pair
    free = [letter for letter in "pqrskjlmni" if letter not in used + index]
    if left.kind != "name" or right.kind != "name" or len(free) < 2 or not re.fullmatch("[i-np-s]", index):
        return None
    j, k = free[:2]
    return product([Node("name", f"epsilon_{index}{j}{k}"), *(
        Node("name", f"{str(vector.value).removesuffix(MARK)}_{n}") for vector, n in ((left, j), (right, k))
    )])  # fmt: skip


def has_index_symbols(relation: Relation) -> bool:
    """Return whether an equation contains a symbol delta_ij or epsilon_ijk."""
    # written_out leaves them in an equation such as R_ik R_jk = delta_ij, which says that R is orthogonal
    return any(_symbol(node) for node in nodes_of(*relation[1:]))


def _symbol(node: Node) -> str:
    """Return the indices of delta_ij or epsilon_ijk; an empty text for any other tree."""
    match = INDEXED.fullmatch(str(node.value)) if node.kind == "name" else None
    return match[2] if match and SYMBOLS.get(match[1].removeprefix("var")) == len(match[2]) else ""


def _indices(node: Node) -> str:
    match = INDEXED.fullmatch(str(node.value)) if node.kind == "name" else None
    return match[2] if match else ""


def _is_condition(left: Node, right: Node) -> bool:
    """Return whether an equation is no identity but restricts quantities, as R_ik R_jk = delta_ij does."""
    own = [Counter(_quantities(side)) for side in (left, right)]
    if "sigma" in (names := {*own[0], *own[1]}) and names <= OF_PAULI:
        return False
    for side, other in ((0, 1), (1, 0)):
        # an equation v_i = .. defines v
        if _is_component((left, right)[side], (left, right)[other]):
            return False
        if (left, right)[side] == number(0):
            # the terms of a side that equals 0 can cancel only if a quantity occurs twice
            return not any(count > 1 for count in own[other].values())
    # an identity has the same quantities on both sides
    return {*own[0]} != {*own[1]}


def _is_component(side: Node, other: Node) -> bool:
    """Return whether ``side`` is a component such as v_i, and ``other`` a formula without v that defines it."""
    if not _indices(side) or _symbol(side):
        return False
    return str(side.value).rpartition("_")[0] not in {*_quantities(other)}


def _quantities(side: Node) -> Iterator[str]:
    """Yield the names of the quantities on a side, without indices: R for R_ij. Delta and epsilon are left out."""
    for node in nodes_of(side):
        if node.kind == "name" and not _symbol(node) and node.value != "pi":
            yield str(node.value).rpartition("_")[0] if _indices(node) else str(node.value)


def _terms(side: Node) -> Iterator[Node]:
    """Yield the terms of a side; products of sums are multiplied out."""
    if side.kind in ("sum", "neg"):
        for part in side.args:
            yield from _terms(part)
    elif side.kind == "product" and any(factor.kind == "sum" for factor in side.args):
        place = next(n for n, factor in enumerate(side.args) if factor.kind == "sum")
        for term in side.args[place].args:
            yield from _terms(_flat([*side.args[:place], term, *side.args[place + 1 :]]))
    elif side != number(0):
        yield side


def _flat(factors: Sequence[Node]) -> Node:
    return product([part for factor in factors for part in factors_of(factor)])


def _counts(term: Node) -> Counter[str]:
    """Return how often each index occurs in a term: i twice in ``a_i b_i`` and in ``a_i^2``."""
    counts: Counter[str] = Counter(_indices(term))
    for part in term.args:
        own = _free_counts(part) if term.value == "integral_over_body" else _counts(part)
        is_square = term.kind == "power" and part is term.args[0] and term.args[1] == number(2)
        counts.update(own + own if is_square else own)
    return counts


def _free_counts(integrand: Node) -> Counter[str]:
    """Return the free indices of the integrand of an integral over a body: {"i": 1, "j": 1} for ``r_i r_j``."""
    # an index that occurs twice in a term, as k in r_k r_k, is summed inside the integral
    free = [_once(_counts(term)) for term in _terms(integrand)]
    # for terms with different free indices, the number of terms that have the index
    return free[0] if len({frozenset(own) for own in free}) == 1 else sum(free, Counter())


def _once(counts: Counter[str]) -> Counter[str]:
    return Counter({index: count for index, count in counts.items() if count == 1})


def _free(term: Node) -> tuple[str, ...]:
    """Return the free indices of a term in alphabetical order: i and j for ``a_ik b_kj``.

    InputError is raised for an index that occurs more than twice.
    """
    counts = _counts(term)
    often = [index for index, count in counts.items() if count > 2]
    if often:
        raise InputError(f"expected every index at most twice in a term, got {often[0]} {counts[often[0]]} times")
    return tuple(sorted(index for index, count in counts.items() if count == 1))


def _component(side: Node, values: Mapping[str, str]) -> Node:
    """Return one component of a side, for the ``values`` of its free indices, with its sums written out.

    ``A_ij b_j`` gives ``A_11 b_1 + ..`` for i = 1.
    """
    if side.kind == "sum":
        return sum_of([_component(part, values) for part in side.args])
    if side.kind == "neg":
        return negated(_component(side.args[0], values))
    if side.kind == "product" and any(factor.kind == "sum" for factor in side.args):
        place = next(n for n, factor in enumerate(side.args) if factor.kind == "sum")
        before, after = side.args[:place], side.args[place + 1 :]
        parts = []
        for term in side.args[place].args:
            whole = _component(_flat([*before, term, *after]), values)
            parts.append(negated(whole) if term.kind == "neg" else whole)
        return sum_of(parts)
    summed = sorted(index for index, count in _counts(side).items() if count == 2 and index not in values)
    if 3 ** len(summed) > MOST_ENTRIES:
        raise InputError(f"expected at most 4 summed indices in a term, got {len(summed)}: {', '.join(summed)}")
    terms = [
        _with_values(side, {**values, **dict(zip(summed, choice, strict=True))})
        for choice in combinations("123", repeat=len(summed))
    ]
    present = [term for term in terms if term != number(0)]
    return sum_of(present) if present else number(0)


def _with_values(term: Node, values: Mapping[str, str]) -> Node:
    """Return a term with numbers in place of its indices: A_12 for A_ij and the ``values`` {"i": "1", "j": "2"}."""
    if term.kind == "call" and term.value == "integral_over_body":
        return replace(term, args=tuple(_as_coordinates(_component(part, values)) for part in term.args))
    if indices := _indices(term):
        digits = "".join(values[index] for index in indices)
        if _symbol(term):
            return number(_delta(digits) if len(digits) == 2 else _epsilon(digits))
        return replace(term, value=f"{str(term.value).rpartition('_')[0]}_{digits}")
    args = tuple(_with_values(part, values) for part in term.args)
    if term.kind == "product" and number(0) in args:
        return number(0)
    return replace(term, args=args)


def _as_coordinates(tree: Node) -> Node:
    """Return the integrand of an integral over a body with x, y, z for x_1, x_2, x_3, and x² + y² + z² for r²."""
    if tree.kind == "name" and (match := re.fullmatch("[xr]_([123])", str(tree.value))):
        return replace(tree, value="xyz"[int(match[1]) - 1])
    if tree.kind == "power" and tree.args == (Node("name", "r"), number(2)):
        return sum_of([Node("power", None, (Node("name", axis), number(2))) for axis in "xyz"])
    return replace(tree, args=tuple(map(_as_coordinates, tree.args)))


def _delta(digits: str) -> int:
    return int(digits[0] == digits[1])


def _epsilon(digits: str) -> int:
    i, j, k = map(int, digits)
    return (j - i) * (k - j) * (k - i) // 2

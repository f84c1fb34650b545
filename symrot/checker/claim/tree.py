"""The tree of a claim's text: the formula as it is written, with positions, before any simplification. No SymPy.

Sums and products are flat lists in written order: ``a - b`` is a sum with a ``neg``, ``a/b`` a product with an ``inv``.

=========  =======================  ==================================
kind       value                    args
=========  =======================  ==================================
number     Fraction
name       str
call       name of the function     arguments
sum                                 terms
product                             factors, in order
neg, inv                            one
power                               base, exponent
transpose                           one
index                               matrix, then one or two indices
list                                members, of ``[..]`` or ``(a, b)``
=========  =======================  ==================================
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

__all__ = [
    "MOST_DERIVATIVES",
    "TIME",
    "Node",
    "column_vector",
    "derivative",
    "differentiated",
    "exchanged",
    "factors_of",
    "is_derivative",
    "is_inverse",
    "is_name",
    "is_rate",
    "listed",
    "matrix_of_rows",
    "names_in",
    "negated",
    "nodes_of",
    "number",
    "product",
    "quotient",
    "replaced",
    "substituted",
    "sum_of",
    "text",
    "untimed",
    "walk",
    "with_names",
    "without_sign",
]

Path = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Node:
    """One node of a formula's tree. ``span`` is the position in the source text, which comparisons ignore."""

    kind: str
    value: Any = None
    args: tuple["Node", ...] = ()
    span: tuple[int, int] = field(default=(0, 0), compare=False)


MOST_DERIVATIVES = 8
"""The highest order of a derivative."""

TIME = Node("name", "t")
"""The name t of the time; derivatives such as ``diff(omega_1, t)`` are with respect to it."""


def is_derivative(node: Node) -> bool:
    """Return whether the root of a tree is a derivative: ``diff(omega_1, t)``."""
    return node.kind == "call" and node.value == "diff"


def derivative(args: Sequence[Node], span: tuple[int, int] = (0, 0)) -> Node:
    """Return the tree of a derivative from arguments as SymPy's ``diff`` takes them, with counts written out.

    Both ``x, t, 2`` and ``x, (t, 2)`` give ``diff(x, t, t)``. ``span`` is the place of the derivative in its text.
    """
    inner, *others = args
    variables: list[Node] = []
    for other in others:
        pair = other.args if other.kind == "list" and len(other.args) == 2 else (other,)
        for argument in pair:
            is_count = argument.kind == "number" and argument.value.denominator == 1 and variables
            if is_count and 1 <= argument.value <= MOST_DERIVATIVES:
                variables += [variables[-1]] * (int(argument.value) - 1)
            else:
                variables.append(argument)
    return Node("call", "diff", (inner, *variables), span)


def differentiated(formula: Node, variable: Node, order: int = 1) -> Node:
    """Return the derivative of a formula with respect to a variable: ``diff(x, t, t)`` for ``diff(x, t)`` and t."""
    is_rate_of_time = is_derivative(formula) and formula.args[-1] == variable == TIME
    return Node("call", "diff", (*(formula.args if is_rate_of_time else (formula,)), *[variable] * order))


def number(value: int | Fraction) -> Node:
    """Return the tree of a number; -2 is ``neg`` of the number 2, as in the trees of the reader."""
    value = Fraction(value)
    return Node("neg", None, (Node("number", -value),)) if value < 0 else Node("number", value)


def sum_of(terms: list[Node], span: tuple[int, int] = (0, 0)) -> Node:
    """Return the sum of ``terms`` as one flat node: ``a + b + c`` for a + b and c; 0 for an empty list."""
    flat: list[Node] = []
    for term in terms:
        flat.extend(term.args if term.kind == "sum" else (term,))
    if len(flat) == 1:
        return flat[0]
    return Node("sum", None, tuple(flat), span) if flat else number(0)


def product(factors: list[Node], span: tuple[int, int] = (0, 0)) -> Node:
    """Return the product of ``factors`` as one flat node, with a sign in front: ``-a*b*c`` for -a and b*c.

    Return 1 for an empty list.
    """
    flat: list[Node] = []
    negative = False
    for factor in factors:
        while factor.kind == "neg":
            negative, factor = not negative, factor.args[0]
        flat.extend(factor.args if factor.kind == "product" else (factor,))
    made = flat[0] if len(flat) == 1 else Node("product", None, tuple(flat), span) if flat else number(1)
    return Node("neg", None, (made,), span) if negative else made


def listed(members: Sequence[Node]) -> Node:
    """Return the list ``[a, b]`` of trees a and b."""
    return Node("list", ("[", "]"), tuple(members))


def column_vector(entries: Sequence[Node]) -> Node:
    """Return the column vector ``Matrix([a, b])`` with the entries a and b."""
    return Node("call", "Matrix", (listed(entries),))


def matrix_of_rows(rows: Sequence[Sequence[Node]]) -> Node:
    """Return the matrix ``Matrix([[a, b], [c, d]])`` with the given rows."""
    return column_vector([listed(row) for row in rows])


def quotient(above: Node, below: Node) -> Node:
    """Return ``above/below``."""
    return product([above, Node("inv", None, (below,), below.span)], below.span)


def without_sign(term: Node) -> Node:
    """Return x for ``-x``, and any other tree unchanged."""
    return term.args[0] if term.kind == "neg" else term


def factors_of(term: Node) -> tuple[Node, ...]:
    """Return the factors of a term without its sign: a and b for ``-a*b``, and (x,) for x."""
    bare = without_sign(term)
    return bare.args if bare.kind == "product" else (bare,)


def untimed(node: Node) -> Node:
    """Return the name x for ``x(t)``, and any other tree unchanged."""
    return Node("name", node.value, (), node.span) if node.kind == "call" and node.args == (TIME,) else node


def is_name(node: Node) -> bool:
    """Return whether a tree is a name, or a function of time such as ``theta(t)``."""
    return untimed(node).kind == "name"


def is_rate(node: Node) -> bool:
    """Return whether a tree is a time derivative, of any order, of a name or of a function of time."""
    return is_derivative(node) and is_name(node.args[0]) and {*node.args[1:]} == {TIME}


def is_inverse(node: Node) -> bool:
    """Return whether a tree is a power with the exponent -1, such as ``R**(-1)``."""
    return node.kind == "power" and node.args[1] == number(-1)


def negated(node: Node) -> Node:
    """Return -node; for a node that is ``-x``, return x."""
    return node.args[0] if node.kind == "neg" else Node("neg", None, (node,), node.span)


def walk(node: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield every node with the path to it, parents before children, left to right."""
    yield path, node
    for place, child in enumerate(node.args):
        yield from walk(child, (*path, place))


def nodes_of(*trees: Node) -> list[Node]:
    """Return all nodes of one or more trees, parents before children, left to right."""
    nodes, rest = list[Node](), [*reversed(trees)]
    while rest:
        node = rest.pop()
        nodes.append(node)
        rest.extend(reversed(node.args))
    return nodes


def names_in(*trees: Node) -> set[str]:
    """Return the names of the symbols in one or more trees: x and y for ``x + f(y)``."""
    return {str(node.value) for node in nodes_of(*trees) if node.kind == "name"}


def replaced(node: Node, path: Path, made: Node) -> Node:
    """Return the tree with ``made`` in place of the node at the given path."""
    if not path:
        return made
    place, *rest = path
    args = list(node.args)
    args[place] = replaced(args[place], tuple(rest), made)
    return replace(node, args=tuple(args))


def exchanged(node: Node, trees: Mapping[Node, Node]) -> Node:
    """Return the tree with each subtree that is a key of ``trees`` replaced by its value.

    The new subtrees are not searched for further keys.
    """
    return trees.get(node) or replace(node, args=tuple(exchanged(child, trees) for child in node.args))


SUM, PRODUCT, SIGN, POWER, ATOM = 10, 20, 30, 40, 50
_BINDING = {"sum": SUM, "neg": SUM, "product": PRODUCT, "inv": PRODUCT, "power": POWER}


def text(node: Node, binding: int = 0) -> str:
    """Return the text of a tree, with brackets for the order of operations: ``x*(y + z)``.

    ``binding`` is the rank of the operation around the tree: below this rank, the whole text gets brackets.
    """
    own = _BINDING.get(node.kind, ATOM)
    if node.kind == "number" and node.value.denominator != 1:
        own = PRODUCT
    written = _WRITE[node.kind](node)
    return f"({written})" if own < binding else written


def _sum(node: Node) -> str:
    written = text(node.args[0], SUM)
    for term in node.args[1:]:
        negative = term.kind == "neg"
        written += (" - " if negative else " + ") + text(term.args[0] if negative else term, SUM + 1)
    return written


def _product(node: Node) -> str:
    first, *rest = node.args
    written = _inverse(first) if first.kind == "inv" else text(first, PRODUCT)
    for factor in rest:
        inverse = factor.kind == "inv"
        written += ("/" if inverse else "*") + text(factor.args[0] if inverse else factor, PRODUCT + 1)
    return written


def _inverse(node: Node) -> str:
    return "1/" + text(node.args[0], PRODUCT + 1)


def _list(node: Node) -> str:
    opening, closing = node.value
    return f"{opening}{', '.join(map(text, node.args))}{closing}"


_WRITE: dict[str, Callable[[Node], str]] = {
    "number": lambda node: str(node.value),
    "name": lambda node: str(node.value),
    "call": lambda node: f"{node.value}({', '.join(map(text, node.args))})",
    "sum": _sum,
    "product": _product,
    "neg": lambda node: "-" + text(node.args[0], PRODUCT),
    "inv": _inverse,
    "power": lambda node: f"{text(node.args[0], POWER + 1)}**{text(node.args[1], POWER)}",
    "transpose": lambda node: text(node.args[0], ATOM) + ".T",
    "index": lambda node: text(node.args[0], ATOM) + f"[{', '.join(map(text, node.args[1:]))}]",
    "list": _list,
}


def substituted(tree: Node, formulas: Mapping[str, Node]) -> Node:
    """Return a tree in which ``formulas`` replace names: ``cos(x)*y`` for ``c*y`` with {"c": cos(x)}."""
    if tree.kind == "name" and tree.value in formulas:
        return formulas[tree.value]
    return replace(tree, args=tuple(substituted(child, formulas) for child in tree.args)) if tree.args else tree


def with_names(node: Node, names: Mapping[str, str]) -> Node:
    """Return a tree with new names of symbols, by the map ``names`` from old to new; functions keep their names."""
    if node.kind == "name" and node.value in names:
        return replace(node, value=names[str(node.value)])
    return replace(node, args=tuple(with_names(child, names) for child in node.args))

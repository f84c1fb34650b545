"""Lowering of SymPy expressions to a straight-line program with few operations.

A straight-line program consists of assignments: first temporaries (intermediate results), then outputs. Formulas that
depend on neither time nor state become constants, computed once per motion. Common factors and sums are computed once,
and temporaries get names. The result depends only on the expressions, never on the order of a hash table.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from sympy import Expr, Number, Symbol

from symrot.codegen.lowering.common_factors import Share
from symrot.codegen.lowering.constants import HOISTED, Gather, Tree
from symrot.codegen.lowering.formulas import chain, to_node
from symrot.codegen.lowering.sums import negative, summed
from symrot.codegen.lowering.temporary_names import with_names
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import Node, children, names, rename, text

__all__ = ["ANONYMOUS", "Lowered", "lower"]

ANONYMOUS = "#"
"""First character of the preliminary name, such as ``#2``, of a temporary that will get a descriptive name."""


@dataclass(frozen=True)
class Lowered:
    """A straight-line program made by :func:`lower`, and the formulas of its parameters, the constants of a motion."""

    program: Program
    # pairs (name, formula of physical constants), such as ("p0", (A - C)/A), one for each component of the argument p
    parameters: tuple[tuple[str, Node], ...]


class _Writer:
    """Writes formulas with common parts as assignments to temporaries, in order of computation.

    The formulas are nodes of a :class:`Share`, which refer to each other by index.
    """

    def __init__(self, share: Share, roots: Sequence[int], named: dict[int, str]) -> None:
        # roots: indices of the output nodes; named: index of a node -> name of its temporary
        self.nodes, self.named = share.nodes, dict(named)
        self.anonymous: list[str] = []  # temporaries that are named after the program is complete
        self.uses: Counter[int] = Counter()
        seen: set[int] = set()
        for root in roots:
            self._count(root, seen)
        self.temporaries: list[tuple[str, Node]] = []
        self.written: set[int] = set()

    def _operands(self, index: int) -> list[int]:
        node = self.nodes[index]
        if node[0] == "mul":
            return [*node[1], *node[2]]
        if node[0] == "add":
            return [i for i, _ in node[1]]
        return list(node[2]) if node[0] == "call" else []

    def _count(self, index: int, seen: set[int]) -> None:
        self.uses[index] += 1
        if index not in seen:
            seen.add(index)
            for operand in self._operands(index):
                self._count(operand, seen)

    def node(self, index: int) -> Node:
        """Return the formula of the node ``index``, or the symbol of the temporary that holds its value."""
        kind = self.nodes[index][0]
        if kind == "num":
            return ("number", self.nodes[index][1])
        if kind == "sym":
            return ("symbol", self.nodes[index][1])
        # a temporary is a node that is used repeatedly, calls a function or has a name
        if index not in self.named and kind != "call" and self.uses[index] < 2:
            return self._formula(index)
        # the first call appends the assignment
        if index not in self.written:
            formula = self._formula(index)
            if index not in self.named:
                self.named[index] = f"{ANONYMOUS}{len(self.anonymous)}"
                self.anonymous.append(self.named[index])
            self.written.add(index)
            self.temporaries.append((self.named[index], formula))
        return ("symbol", self.named[index])

    def _is_constant(self, index: int) -> bool:
        kind, first, *_ = self.nodes[index]
        return bool(kind == "num" or (kind == "sym" and first.startswith(HOISTED)))

    def _is_sum(self, index: int) -> bool:
        """Return whether a node is printed as a sum in brackets; a temporary is printed as its name."""
        return bool(self.nodes[index][0] == "add" and self.uses[index] < 2 and index not in self.named)

    def _formula(self, index: int) -> Node:
        node = self.nodes[index]
        if node[0] == "call":
            return ("call", node[1], tuple(self.node(argument) for argument in node[2]))
        if node[0] == "mul":
            # constants first, then sums in brackets: (A - B) x y
            factors = sorted(node[1], key=lambda i: (not self._is_constant(i), not self._is_sum(i)))
            top = chain("*", [self.node(i) for i in factors] or [("number", Fraction(1))])
            return top if not node[2] else ("/", top, chain("*", [self.node(i) for i in node[2]]))
        terms = sorted(node[1], key=lambda item: item[1] < 0)
        first, sign = terms[0]
        start = self.node(first) if sign > 0 else negative(self.node(first))
        return summed(start, [(sign, self.node(term)) for term, sign in terms[1:]])


def lower(
    signature: Signature,
    outputs: Sequence[tuple[str, Expr]],
    definitions: Sequence[tuple[Symbol, Expr]] = (),
    parameter_argument: str = "p",
) -> Lowered:
    """Return a straight-line program with few operations that computes the given expressions.

    Parameters
    ----------
    signature : Signature
        Name and arguments of the program. The components of the input arguments are the variables; every other symbol
        is a physical constant or one of ``definitions``. The signature must not contain the parameter argument, which
        this function adds.
    outputs : sequence of (component name, Expr)
        Component names and expressions, in the order of the output arguments.
    definitions : sequence of (Symbol, Expr)
        Quantities with a physical name: pairs of the symbol and its expression. Later definitions and the outputs may
        contain the symbol. A name that begins with :data:`ANONYMOUS` is replaced by a descriptive one.
    parameter_argument : str
        Name of the array argument for the constants that are computed once.

    Returns
    -------
    Lowered
        The program and the formulas of its parameters in terms of the physical constants.

    Raises
    ------
    InputError
        If an expression contains a float, or a function or a power that kernels do not support.
    """
    ways = [_lowered(signature, outputs, definitions, parameter_argument, flat) for flat in (False, True)]
    lowered, anonymous = min(ways, key=lambda way: way[0].program.operations().total())
    numbers = {} if parameter_argument == "p" else _numbers(lowered.parameters)
    return replace(lowered, program=with_names(lowered.program, anonymous, numbers))


def _lowered(
    signature: Signature, outputs: Sequence[tuple[str, Expr]], definitions: Sequence[tuple[Symbol, Expr]],
    parameter_argument: str, flat: bool,
) -> tuple[Lowered, list[str]]:  # fmt: skip
    """Return the program with its parameters, and the preliminary names, such as ``#2``, of temporaries in it.

    :func:`lower` replaces these names by descriptive ones. ``flat`` turns ``a + (b + c)`` into ``a + b + c`` first.
    """
    inputs = [name for a in signature.arguments if a.role == "in" for name, *_ in a.components]
    held = {symbol for _, expr in [*outputs, *definitions] for symbol in expr.free_symbols}
    defined = [symbol for symbol, _ in definitions]
    # flat: before repeated sums and products are extracted
    gather = Gather([symbol for symbol in held if str(symbol) in inputs or symbol in defined], flat)
    share, named = Share(), {}
    alias: dict[str, Tree] = {}
    for symbol, expr in definitions:
        alias[str(symbol)] = _substitute(gather.whole(_exact(expr)), alias)
        index = share.add(alias[str(symbol)])
        if share.nodes[index][0] not in ("sym", "num") and not str(symbol).startswith(ANONYMOUS):
            named[index] = str(symbol)
    signed = [gather.scaled(*gather.split(_exact(expr))) for _, expr in outputs]
    roots = [share.add(_substitute(tree, alias)) for _, tree in signed]
    share.extract()
    writer = _Writer(share, roots, named)
    formulas = [writer.node(root) for root in roots]
    formulas = [node if sign > 0 else negative(node) for (sign, _), node in zip(signed, formulas, strict=True)]
    targets = [name for name, _ in outputs]
    lowered = _numbered(signature, gather.hoisted, writer.temporaries, targets, formulas, parameter_argument)
    return lowered, writer.anonymous


def _numbers(parameters: Iterable[tuple[str, Node]]) -> dict[str, Node]:
    """Return the parameters, by name, whose formula contains only numbers, such as ``2*pi`` or ``sqrt(3)``."""
    return {name: formula for name, formula in parameters if names(formula) <= {"pi"}}


def _numbered(
    signature: Signature,
    hoisted: dict[Expr, str],
    temporaries: Sequence[tuple[str, Node]],
    targets: Sequence[str],
    formulas: Sequence[Node],
    parameter_argument: str,
) -> Lowered:
    """Return a program in which each constant is a parameter ``p0, p1, ..``, with the formulas of the parameters.

    ``hoisted`` maps the formula of each constant to its preliminary name; the new names are numbered in order of use,
    and ``parameter_argument`` is the start of each, here ``p``. ``temporaries`` are pairs (name, formula) in order of
    computation. ``targets`` are the names of the outputs, and ``formulas`` are their formulas in the same order.
    """
    # preliminary name of a constant (a value of hoisted) -> parameter, numbered by first use
    order: dict[str, str] = {}
    for node in [node for _, node in temporaries] + list(formulas):
        for name in _leaves(node):
            if name.startswith(HOISTED):
                order.setdefault(name, f"{parameter_argument}{len(order)}")
    values = {name: to_node(value) for value, name in hoisted.items()}
    parameters = tuple((new, values[old]) for old, new in order.items())
    inputs = [a for a in signature.arguments if a.role == "in"]
    outs = [a for a in signature.arguments if a.role == "out"]
    described = tuple((name, "", text(formula)) for name, formula in parameters)
    full = Signature(signature.name, (*inputs, Argument(parameter_argument, "in", described), *outs))
    program = Program(
        full,
        tuple((name, rename(node, order)) for name, node in temporaries),
        tuple((name, rename(node, order)) for name, node in zip(targets, formulas, strict=True)),
    )
    return Lowered(program, parameters)


def _leaves(node: Node) -> Iterable[str]:
    """Yield the names of the symbols in a formula from left to right."""
    if node[0] == "symbol":
        yield node[1]
    for child in children(node):
        yield from _leaves(child)


def _exact(expr: Expr) -> Expr:
    """Return the expression unchanged; raise InputError if it contains a float, because formulas must be exact."""
    if expr.has(Number) and any(not number.is_Rational for number in expr.atoms(Number)):
        raise InputError(f"expected exact numbers in a kernel, got a float in {expr}")
    return expr


def _substitute(tree: Tree, alias: dict[str, Tree]) -> Tree:
    """Return a formula tree in which each symbol that ``alias`` contains is replaced by the tree of its definition."""
    kind = tree[0]
    if kind == "sym":
        return alias.get(tree[1], tree)
    if kind == "num":
        return tree
    if kind == "call":
        return ("call", tree[1], tuple(_substitute(argument, alias) for argument in tree[2]))
    if kind == "mul":
        return ("mul", *(tuple(_substitute(item, alias) for item in part) for part in tree[1:]))
    return ("add", tuple((sign, _substitute(item, alias)) for sign, item in tree[1]))

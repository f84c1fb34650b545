"""The LaTeX reader: from an equation to the tree of a claim. Every token is used, or refused with its position.

Where usage is ambiguous (``\\sin\\theta/2``, ``\\sin^{-1}``, ``a/bc``, ``x_12``, ``a \\times b \\times c``) the reader
asks for brackets and does not choose. The text of the claim shows how the LaTeX was read.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

from symrot.checker.claim.reader import Chain, Reading, Relation, read_expression, read_relation
from symrot.checker.claim.tree import Node, text, walk
from symrot.checker.claim.vectors import Vector, used_vectors, without_marks
from symrot.checker.latex.calculus import DOTS, CalculusPart
from symrot.checker.latex.cursor import TIME, UPRIGHT, Names, is_letter
from symrot.checker.latex.names import NAME_MARKS, OPERATORS, VECTOR_MARKS
from symrot.checker.latex.sums import FUNCTIONS
from symrot.errors import InputError
from symrot.latex import tree

__all__ = ["Equation", "Names", "latex_reading", "read_latex", "read_latex_formula"]

ALIGNED = ("align", "aligned", "gather", "gathered", "eqnarray", "split")
"""Environments whose lines hold equations."""


@dataclass(frozen=True)
class Equation:
    """An equation read from LaTeX, with its text in the language of claims, and its vectors that need components."""

    relation: Relation
    text: str
    vectors: tuple[Vector, ...] = ()


def read_latex(source: str, where: str = "", names: Names | None = None) -> Equation:
    """Return the only equation of a LaTeX text.

    Parameters
    ----------
    source : str
        One equation, with or without ``$`` around it.
    where : str
        Its place, for error messages.
    names : Names, optional
        The declared names; by default every name is a real symbol, or a function of time if it is differentiated or
        written ``f(t)``.

    Raises
    ------
    InputError
        With the position of the first token that cannot be read.

    Examples
    --------
    >>> read_latex(r"\\ddot{\\theta} = -\\frac{g}{l}\\sin\\theta").text
    'diff(theta(t), t, t) == -g/l*sin(theta(t))'
    """
    (sides,), reader = _read(source, where, names or Names(), _Interpreter.equation)
    sides, vectors = without_marks([_timed(side, reader.timed) for side in sides], reader.vectors)
    claim = " == ".join(map(text, sides))
    return Equation(read_relation(claim, where), claim, used_vectors(sides, vectors))


def latex_reading(source: str, names: Names | None = None) -> Reading:
    """Return the equations of a LaTeX text: chains ``a = b = c``, with commas between them or on lines of their own.

    Raises
    ------
    InputError
        With the position of the first token that cannot be read.

    Examples
    --------
    >>> reading = latex_reading(r"a = b = c, \\quad d = e")
    >>> [len(chain.sides) for chain in reading.lines]
    [3, 2]
    """
    lines, reader = _read(source, "", names or Names(), _Interpreter.equations)
    sides, vectors = without_marks([_timed(side, reader.timed) for line in lines for side in line], reader.vectors)
    remaining = iter([read_expression(text(side)) for side in sides])
    chains = [tuple(next(remaining) for _ in line) for line in lines]
    return Reading(
        tuple(Chain(("==",) * (len(chain) - 1), chain) for chain in chains),
        plain=True,
        notes=(*dict.fromkeys(reader.notes), *_on_constants(sides, vectors)),
        timed=frozenset(reader.timed),
        vectors=vectors,
    )


def _read(
    source: str, where: str, names: Names, read: "Callable[[_Interpreter], list[list[Node]]]"
) -> "tuple[list[list[Node]], _Interpreter]":
    """Return what ``read`` reads from a LaTeX text, and the reader after it.

    A name without a mark may turn out to be a vector after other places with it have been read; then it is read again.
    """
    crossed: frozenset[str] = frozenset()
    while True:
        reader = _Interpreter(source, where, names)
        reader.crossed = set(crossed)
        try:
            lines = read(reader)
        except InputError:
            if reader.crossed == crossed:
                raise
        else:
            if reader.crossed == crossed:
                return lines, reader
        crossed = frozenset(reader.crossed)


def _on_constants(sides: Sequence[Node], vectors: Collection[str]) -> tuple[str, ...]:
    """Return a note on the symbols, other than vectors, that are constants in derivatives with respect to time."""
    nodes = [node for side in sides for _, node in walk(side)]
    rates = [node.args[0] for node in nodes if node.kind == "call" and node.value == "diff" and node.args[-1] == TIME]
    parts = (part for rate in rates if rate.kind != "call" for _, part in walk(rate))
    inner = {argument for node in nodes if node.kind == "call" for argument in node.args if argument == TIME}
    names = sorted({str(part.value) for part in parts if part.kind == "name" and part not in inner} - {"pi", *vectors})
    if not names:
        return ()
    are = "is read as a constant" if len(names) == 1 else "are read as constants"
    return (f"{', '.join(names)} {are}, having no rate in the text",)


def read_latex_formula(source: str, where: str = "") -> tuple[str, tuple[Vector, ...]]:
    """Return the text, in the language of claims, of a formula in LaTeX that has no equals sign, and its vectors.

    Raises
    ------
    InputError
        As :func:`read_latex`.
    """
    ((formula,),), reader = _read(source, where, Names(), _Interpreter.formula)
    (formula,), vectors = without_marks([_timed(formula, reader.timed)], reader.vectors)
    return text(formula), used_vectors([formula], vectors)


def _timed(node: Node, names: Collection[str]) -> Node:
    """Return a tree in which names that depend on time are written ``f(t)``."""
    if node.kind == "name" and node.value in names:
        return Node("call", node.value, (TIME,))
    if node.kind == "call" and node.value in names:
        return node
    return Node(node.kind, node.value, tuple(_timed(child, names) for child in node.args), node.span)


class _Interpreter(CalculusPart):
    """The complete LaTeX reader, put together from its parts."""

    readers: ClassVar[Mapping[str, Callable[[Any, Any], Node]]] = {
        "letter": CalculusPart.letter,
        **dict.fromkeys(("(", "[", "\\{", "{"), CalculusPart.bracket),
        **dict.fromkeys(("|", "\\|"), CalculusPart.bars),
        **dict.fromkeys(VECTOR_MARKS, CalculusPart.marked),
        **dict.fromkeys(NAME_MARKS, CalculusPart.overlined),
        **dict.fromkeys(DOTS, CalculusPart.dotted),
        **dict.fromkeys(FUNCTIONS, CalculusPart.trigonometric),
        **dict.fromkeys(OPERATORS, CalculusPart.operator),
        **dict.fromkeys((*UPRIGHT, "\\operatorname"), CalculusPart.spelled),
        "\\sum": CalculusPart.total,
        "\\frac": CalculusPart.fraction,
        "\\sqrt": CalculusPart.root,
        "\\int": CalculusPart.integral,
        "table": CalculusPart.environment,
    }

    def formula(self) -> list[list[Node]]:
        """Read one formula without an equals sign."""
        formula = self.expression()
        if self.peek().kind != "end":
            raise self.fail("one formula without '='" if self.at("=") else "an operator or the end")
        return [[formula]]

    def equation(self) -> list[list[Node]]:
        """Read one equation."""
        (sides,) = self.chains()
        return [sides]

    def equations(self) -> list[list[Node]]:
        """Read equations; in an environment of several lines, a line with ``=`` first continues the line before it."""
        table, after = self.peek(), self.peek(1)
        if not (isinstance(table, tree.Table) and table.name.rstrip("*") in ALIGNED and after.kind == "end"):
            return self.chains(",")
        chains: list[list[Node]] = []
        for line in table.lines:
            items = [item for cell in line for item in cell.items]
            while items and items[-1].text in (",", "."):
                items.pop()
            if all(item.kind == "space" for item in items):
                continue
            row = tree.Row(tuple(items), line[0].start, line[-1].end)
            continued = chains.pop() if chains and items[0].text == "=" else None
            chains += self.inside(row, partial(self.chains, ",", continued))
        return chains

    def chains(self, between: str = "", sides: list[Node] | None = None) -> list[list[Node]]:
        """Read chains ``a = b = c`` up to the end; ``sides`` are the sides of the first on the line before."""
        chains = []
        while True:
            sides = [self.head() or self.expression()] if sides is None else sides
            if not self.at("="):
                raise self.fail("an operator or '='" if self.peek().kind != "end" else "'=' and a right side")
            while self.at("="):
                if len(sides) > 1 and not between:
                    raise self.fail("one '=' in a claim, not a chain of them")
                self.next()
                sides.append(self.expression())
            chains.append(sides)
            if self.peek().kind == "end":
                return chains
            if not (between and (self.take(between) or self.at("\\\\"))):
                raise self.fail("an operator or the end")
            while self.take("\\\\"):
                pass
            sides = None

    def head(self) -> Node | None:
        r"""Read the head of a matrix, such as ``R(\phi) =`` before its entries, as the name R; or return None."""
        place = 2 if isinstance(self.peek(1), tree.Script) else 1
        texts = [item.text for item in self.items[self.index + place :]]
        end = texts.index(")") if ")" in texts else 0
        rest = self.items[self.index + place + end + 1 :]
        is_matrix = any(item.kind == "table" or item.text == "\\times" for item in rest)
        if texts[:1] != ["("] or not is_letter(self.peek()) or texts[end + 1 : end + 2] != ["="] or not is_matrix:
            return None
        inside = self.items[self.index + place + 1 : self.index + place + end]
        if texts[1 : end + 1] == ["t", ")"] or not all(is_letter(i) or i.text in (",", *VECTOR_MARKS) for i in inside):
            return None
        item = self.next()
        subscript = self.script("_")
        self.index += end + 1
        name = item.text.removeprefix("\\")
        name = self.resolved(name, self.subscript(subscript)) if subscript else name
        self.notes.append(f"{name}(..) is read as the name {name}")
        return Node("name", name)

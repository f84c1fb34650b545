"""The LaTeX reader: from an equation to the tree of a claim. Every token is used, or refused with its position.

Where usage is ambiguous (``\\sin\\theta/2``, ``\\sin^{-1}``, ``a/bc``, ``x_12``, ``a \\times b \\times c``) the reader
asks for brackets and does not choose. The text of the claim shows how the LaTeX was read.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from symrot.checker.claim.reader import Relation, read_relation
from symrot.checker.claim.tree import Node, text
from symrot.checker.latex.calculus import DOTS, CalculusPart
from symrot.checker.latex.cursor import TIME, UPRIGHT, Names
from symrot.checker.latex.names import NAME_MARKS, OPERATORS, VECTOR_MARKS
from symrot.checker.latex.sums import FUNCTIONS

__all__ = ["Names", "Reading", "latex_sides", "read_latex", "read_latex_formula"]


@dataclass(frozen=True)
class Reading:
    """An equation read from LaTeX, with its text in the language of claims."""

    relation: Relation
    text: str


def read_latex(source: str, where: str = "", names: Names | None = None) -> Reading:
    """Return the equation that a LaTeX text states.

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
    reader = _Interpreter(source, where, names or Names())
    left = reader.expression()
    if not reader.take("="):
        raise reader.fail("an operator or '='" if reader.peek().kind != "end" else "'=' and a right side")
    right = reader.expression()
    if reader.peek().kind != "end":
        raise reader.fail("one '=' in a claim, not a chain of them" if reader.at("=") else "an operator or the end")
    claim = " == ".join(text(_timed(side, reader.timed)) for side in (left, right))
    return Reading(read_relation(claim, where), claim)


def latex_sides(source: str, where: str = "") -> list[str]:
    """Return the sides of a chain ``a = b = c`` in LaTeX, each in the language of claims.

    Raises
    ------
    InputError
        As :func:`read_latex`.
    """
    reader = _Interpreter(source, where, Names())
    sides = [reader.expression()]
    while reader.take("="):
        sides.append(reader.expression())
    if reader.peek().kind != "end":
        raise reader.fail("an operator or '='")
    return [text(_timed(side, reader.timed)) for side in sides]


def read_latex_formula(source: str, where: str = "") -> str:
    """Return the text, in the language of claims, of a formula in LaTeX that has no equals sign.

    Raises
    ------
    InputError
        As :func:`read_latex`.
    """
    reader = _Interpreter(source, where, Names())
    formula = reader.expression()
    if reader.peek().kind != "end":
        raise reader.fail("one formula without '='" if reader.at("=") else "an operator or the end")
    return text(_timed(formula, reader.timed))


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
        "\\frac": CalculusPart.fraction,
        "\\sqrt": CalculusPart.root,
        "\\int": CalculusPart.integral,
        "table": CalculusPart.environment,
    }

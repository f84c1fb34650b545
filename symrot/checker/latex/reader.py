r"""The LaTeX reader: from an equation to the tree of a claim. Every token is used, or refused with its position.

Where usage is ambiguous, as in ``\sin\theta/2`` or ``a/bc``, :func:`read_latex` asks for brackets, and
:func:`latex_readings` returns an interpretation for each meaning.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

from symrot.checker.claim.reader import on_constants, read_expression, read_relation, with_time
from symrot.checker.claim.tree import TIME, Node, is_derivative, nodes_of, sum_of, text
from symrot.checker.claim.vectors import Vector, may_be_mixed, on_direction, used_vectors, without_marks
from symrot.checker.latex.calculus import DOTS, CalculusPart
from symrot.checker.latex.cursor import JOINTS, UPRIGHT, Names, is_letter
from symrot.checker.latex.names import NAME_MARKS, OPERATORS, VECTOR_MARKS
from symrot.checker.latex.sums import FUNCTIONS, SEVERAL_LINES, SIGNS
from symrot.checker.typed.readings import Chain, Reading, Relation, distinct_readings, each_reading
from symrot.errors import InputError
from symrot.latex import tree

__all__ = ["Equation", "Names", "latex_readings", "read_latex", "read_latex_formula"]

Line = tuple[list[str], list[Node]]
"""A chain ``a = b = c`` as (its relation signs, its sides): (["==", "=="], [a, b, c])."""

ALIGNED = (*SEVERAL_LINES, "array")
"""Names of the LaTeX environments in which each line is an equation."""

AROUND = ("equation", "subequations", "displaymath", "math")
"""Names of the LaTeX environments that hold one formula, or one environment of several lines such as ``aligned``."""

SEPARATORS = (",", ";", "\\\\")
"""Tokens that separate two equations."""


@dataclass(frozen=True)
class Equation:
    """An equation read from LaTeX, its text in SymPy syntax, and the vectors in it, whose components get names."""

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
        If the text cannot be read, has several equations, or is ambiguous.

    Examples
    --------
    >>> read_latex(r"\\ddot{\\theta} = -\\frac{g}{l}\\sin\\theta").text
    'diff(theta(t), t, t) == -g/l*sin(theta(t))'
    """
    ((_, sides),), reader = _read(source, where, names or Names(), _Interpreter.equation)
    sides, vectors = without_marks([with_time(side, reader.timed) for side in sides], reader.vectors)
    claim = " == ".join(map(text, sides))
    return Equation(read_relation(claim, where), claim, used_vectors(sides, vectors))


def latex_readings(source: str, names: Names | None = None) -> list[Reading]:
    r"""Return the readings (interpretations) of a LaTeX text, the usual one first.

    There are at most six. In each but the first, one ambiguous part such as ``\cos^{-1} x``, or all parts with the same
    kind of ambiguity, have their less usual meaning.

    Raises
    ------
    InputError
        If the text cannot be read.

    Examples
    --------
    >>> (reading,) = latex_readings(r"a = b = c, \quad d = e")
    >>> [len(chain.sides) for chain in reading.lines]
    [3, 2]
    >>> [reading.flipped for reading in latex_readings(r"\theta = \cos^{-1} x")]
    [(), ('\\cos^{-1} x',)]
    """
    # a text may have chains a = b = c, with commas between them or on lines of their own; \pm gives the equations with
    # the upper signs and those with the lower ones, in every reading
    return distinct_readings(each_reading(partial(_reading, source, names or Names())))


def _reading(source: str, names: Names, flips: Collection[tuple[str, int]]) -> Reading:
    """Return the reading of a LaTeX text in which the ambiguous parts ``flips`` have their less usual meaning.

    Each of them is (kind of ambiguity, position in the text).
    """
    lines, reader = _read(source, "", names, _Interpreter.equations, flips)
    if reader.both_signs:
        lines += _read(source, "", names, _Interpreter.equations, flips, upper=False)[0]
    timed = [with_time(side, reader.timed) for _, sides in lines for side in sides]
    sides, vectors = without_marks(timed, reader.vectors)
    remaining = iter([read_expression(text(side)) for side in sides])
    return Reading(
        tuple(Chain(tuple(signs), tuple(next(remaining) for _ in own), reader.both_signs) for signs, own in lines),
        plain=True,
        doubts=tuple(reader.doubts),
        notes=(*dict.fromkeys(reader.notes), *_on_constants(sides, vectors)),
        timed=frozenset(reader.timed),
        vectors=vectors,
        flipped=tuple(dict.fromkeys(doubt.excerpt for doubt in reader.doubts if doubt.key in flips)),
    )


def _read(
    source: str, where: str, names: Names, read: "Callable[[_Interpreter], list[Line]]",
    flips: Collection[tuple[str, int]] | None = None, upper: bool = True,
) -> "tuple[list[Line], _Interpreter]":  # fmt: skip
    r"""Return the lines that ``read`` parses from a LaTeX text, and the interpreter that parsed them.

    ``flips`` are keys of the ambiguous parts of the text that get their less usual meaning; with None, an ambiguous
    text is refused with InputError. ``upper`` chooses the upper signs of ``\pm`` and ``\mp``, otherwise the lower ones.
    """
    # if a name without a mark turns out to be a vector only late in the text, the text is parsed again
    # so it is if a vector turns out to occur with and without a hat
    crossed, mixed = frozenset[str](), frozenset[str]()
    while True:
        reader = _Interpreter(source, where, names, flips, upper)
        reader.crossed, reader.mixed = set(crossed), mixed
        try:
            lines = read(reader)
        except InputError:
            if reader.crossed == crossed:
                raise
        else:
            names_in_lines = {node.value for _, sides in lines for node in nodes_of(*sides)}
            both = frozenset(filter(may_be_mixed, reader.hatted & ({*+reader.bare} | names_in_lines)))
            if reader.crossed == crossed and both == mixed:
                reader.notes += map(on_direction, sorted(mixed))
                return lines, reader
            mixed = both
        crossed = frozenset(reader.crossed)


def _on_constants(sides: Sequence[Node], vectors: Collection[str]) -> tuple[str, ...]:
    """Return (note,) on the symbols that time derivatives in ``sides`` treat as constants; () without such symbols."""
    nodes = nodes_of(*sides)
    rates = [node.args[0] for node in nodes if is_derivative(node) and node.args[-1] == TIME]
    parts = (part for rate in rates if rate.kind != "call" for part in nodes_of(rate))
    inner = {argument for node in nodes if node.kind == "call" for argument in node.args if argument == TIME}
    names = sorted({str(part.value) for part in parts if part.kind == "name" and part not in inner} - {"pi", *vectors})
    if not names:
        return ()
    return (on_constants(names),)


def read_latex_formula(source: str, where: str = "") -> tuple[str, tuple[Vector, ...]]:
    """Return the text, in SymPy syntax, of a LaTeX formula without an equals sign, and the vectors in it.

    Raises
    ------
    InputError
        As :func:`read_latex`.
    """
    ((_, (formula,)),), reader = _read(source, where, Names(), _Interpreter.formula)
    (formula,), vectors = without_marks([with_time(formula, reader.timed)], reader.vectors)
    return text(formula), used_vectors([formula], vectors)


class _Interpreter(CalculusPart):
    """The complete LaTeX reader, combined from the classes that parse sums, names and calculus."""

    readers: ClassVar[Mapping[str, Callable[[Any, Any], Node]]] = {
        "letter": CalculusPart.letter,
        **dict.fromkeys(("(", "[", "\\{", "{"), CalculusPart.bracket),
        **dict.fromkeys(("|", "\\|"), CalculusPart.bars),
        **dict.fromkeys(VECTOR_MARKS, CalculusPart.marked),
        **dict.fromkeys(NAME_MARKS, CalculusPart.overlined),
        **dict.fromkeys(DOTS, CalculusPart.dotted),
        **dict.fromkeys(FUNCTIONS, CalculusPart.trigonometric),
        **dict.fromkeys(OPERATORS, CalculusPart.operator),
        **dict.fromkeys((*UPRIGHT, "\\operatorname", "\\text"), CalculusPart.spelled),
        "\\sum": CalculusPart.total,
        "\\frac": CalculusPart.fraction,
        "\\sqrt": CalculusPart.root,
        "\\int": CalculusPart.integral,
        "table": CalculusPart.environment,
    }

    def formula(self) -> list[Line]:
        """Parse one formula without an equals sign; return it as a single line with a single side."""
        formula = self.expression()
        if self.peek().kind != "end":
            raise self.fail("one formula without '='" if self.at("=") else "an operator or the end")
        return [([], [formula])]

    def equation(self) -> list[Line]:
        """Parse a text that is a single equation; return it as a list of one line."""
        (line,) = self.chains()
        return [line]

    def equations(self) -> list[Line]:
        """Parse equations and return them as lines; a line such as ``= c`` or ``+ c`` continues the line before it."""
        self.items = [item for item in self.items if item.text != "&"]
        while isinstance(self.peek(), tree.Row) and self.peek(1).kind == "end":  # \boxed{..}
            self.enter(self.peek())
        table, after = self.peek(), self.peek(1)
        while isinstance(table, tree.Table) and after.kind == "end" and table.name.rstrip("*") in AROUND:
            self.enter(table.lines[0][0])
            table, after = self.peek(), self.peek(1)
        if not (isinstance(table, tree.Table) and table.name.rstrip("*") in ALIGNED and after.kind == "end"):
            return self.chains(SEPARATORS)
        lines: list[Line] = []
        for items, is_open in _rows(table):
            row = tree.Row(items, items[0].start, items[-1].start + 1)
            continued = lines.pop() if lines and (items[0].text in SIGNS or is_open) else None
            lines += self.inside(row, partial(self.chains, SEPARATORS, continued))
        return lines

    def chains(self, between: Collection[str] = (), line: Line | None = None) -> list[Line]:
        """Parse chains ``a = b = c``, with marks such as a comma ``between`` them; return one line for each chain.

        ``line`` is the beginning of the first chain if it is parsed already.
        """
        lines: list[Line] = []
        while True:
            # otherwise the beginning of the first chain is already parsed
            if line is None:
                line = [], [self.head() or self.expression()]
            signs, sides = line
            if signs and not self.at(*SIGNS):  # a line that starts with a plus sign
                sides[-1] = sum_of([sides[-1], self.expression()])
            elif not self.at(*SIGNS) or (self.flips is None and not self.at("=")):
                raise self.fail("an operator or '='" if self.peek().kind != "end" else "'=' and a right side")
            while self.at(*SIGNS):
                if len(sides) > 1 and not between:
                    raise self.fail("one '=' in a claim, not a chain of them")
                signs.append(SIGNS[self.next().text])
                sides.append(self.expression())
            lines.append(line)
            if self.peek().kind == "end" or (between and self.is_remark()):
                return lines
            if not (between and (self.at(*between) or self.is_joint())):
                raise self.fail("an operator or the end")
            while (self.at(*between) or self.is_joint()) and not self.is_remark():
                self.next()
            if self.peek().kind == "end" or self.is_remark():
                return lines
            line = None

    def is_joint(self) -> bool:
        r"""Return whether the next item is a word that joins two equations, such as ``\text{and}``."""
        return self.words(self.peek()) in JOINTS

    def is_remark(self) -> bool:
        r"""Return whether words without an equation follow, such as ``\text{for all } x``.

        If so, a note says that they are not read.
        """
        rest = self.items[self.index :]
        if not self.words(self.peek()) or any(item.text in SIGNS for item in rest):
            return False
        self.notes.append(f"{self.source[self.peek().start : rest[-1].start].strip()} is not read")
        return True

    def head(self) -> Node | None:
        r"""Parse the left side of a definition, ``R(\phi) =``, and return the name R; None if it may be a product.

        The right side must have a matrix, a cross product, or all letters in the brackets of the left side.
        """
        # brackets around it, as in [M_3(\theta)] =, are left out
        opened = 1 if self.at("[") else 0
        item = self.peek(opened)
        letter = tree.alone(item.inside) if isinstance(item, tree.Font) else item
        named = 2 if isinstance(self.peek(opened + 1), tree.Script) else 1
        first = self.index + opened + named
        texts = [item.text for item in self.items[first:]]
        end = texts.index(")") if ")" in texts else 0
        if texts[:1] != ["("] or not is_letter(letter) or texts[1 : end + 1] == ["t", ")"]:
            return None
        if texts[end + 1 : end + 2 + opened] != [*"]"[:opened], "="]:
            return None
        inside = self.items[first + 1 : first + end]
        letters = [item.text for item in inside if is_letter(item)]
        rest = _texts(self.items[first + end + 1 :])
        if not all(is_letter(item) or item.text in (",", *VECTOR_MARKS) or item.text == "_" for item in inside):
            return None
        is_matrix = opened or {"table", "\\times"} & rest
        # otherwise R(\phi) is a product
        if not (is_matrix or (letters and {*letters} <= rest)):
            return None
        self.index += opened + 1
        subscript = self.script("_")
        self.index += end + 1 + opened
        name = letter.text.removeprefix("\\")
        name = self.resolved(name, self.subscript(subscript)) if subscript else name
        self.notes.append(f"{name}(..) is read as the name {name}")
        return Node("name", name)


def _rows(table: tree.Table) -> Iterator[tuple[tuple[tree.Node, ...], bool]]:
    """Yield (nodes, continues) for each line of an environment.

    ``continues`` tells whether the line continues the equation before it, as ``+ b`` does.
    """
    for line in table.lines:
        items = [item for cell in line for item in cell.items if item.kind != "space"]
        # spaces, and commas and full stops at the end of a line, are left out
        while items and items[-1].text in (",", ".", ";"):
            items.pop()
        if items:
            # a line continues if it starts with a plus or minus sign, and has no relation sign or an empty first cell
            whole = not any(item.text in SIGNS for item in items) or not line[0].items
            yield tuple(items), items[0].text in ("+", "-") and whole


def _texts(items: Sequence[tree.Node]) -> set[str]:
    """Return the texts of LaTeX nodes and of all nodes inside them, such as ``\\times``, and "table" for a matrix."""
    texts: set[str] = set()
    for item in items:
        texts |= {item.text}
        parts = [getattr(item, name) for name in ("inside", "above", "below", "base") if hasattr(item, name)]
        texts |= _texts(parts)
        texts |= _texts(item.items) if isinstance(item, tree.Row) else set()
        texts |= _texts(item.scripts) if isinstance(item, tree.Scripts) else set()
        cells = [cell for line in item.lines for cell in line] if isinstance(item, tree.Table) else []
        texts |= _texts(cells)
    return texts

"""The LaTeX reader: from an equation to the tree of a claim. Every token is used, or refused with its position.

Where usage is ambiguous (``\\sin\\theta/2``, ``\\sin^{-1}``, ``a/bc``, ``x_12``, ``a \\times b \\times c``) the reader
asks for brackets and does not choose. The text of the claim shows how the LaTeX was read.
"""

from collections.abc import Collection
from dataclasses import dataclass
from fractions import Fraction

from symrot.checker.claim.reader import DEEPEST_NESTING, Relation, read_relation
from symrot.checker.claim.tree import Node, negated, number, product, sum_of, text
from symrot.checker.latex.calculus import DOTS, FUNCTIONS
from symrot.checker.latex.cursor import CLOSING, TIME, UPRIGHT, Names, is_letter
from symrot.checker.latex.matrices import MATRIX_CALLS, MatricesPart
from symrot.checker.latex.names import NAME_MARKS, OPERATORS, VECTOR_MARKS
from symrot.latex import tree

__all__ = ["MATRIX_CALLS", "TIME", "Names", "Reading", "read_latex", "read_latex_formula"]

ENDS = frozenset(
    ["", "+", "-", "=", ")", "]", "\\}", "}", "&", "\\\\", ",", "\\end", "\\cdot", "\\times", "*", "/", "^", "_", "'"]
)
"""Items that cannot start a factor."""


@dataclass(frozen=True)
class Reading:
    """An equation with its text in the language of claims."""

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
    reader = _Reader(source, where, names or Names())
    left = reader.expression()
    if not reader.take("="):
        raise reader.fail("an operator or '='" if reader.peek().kind != "end" else "'=' and a right side")
    right = reader.expression()
    if reader.peek().kind != "end":
        raise reader.fail("one '=' in a claim, not a chain of them" if reader.at("=") else "an operator or the end")
    claim = " == ".join(text(_timed(side, reader.timed)) for side in (left, right))
    return Reading(read_relation(claim, where), claim)


def read_latex_formula(source: str, where: str = "") -> str:
    """Return the text, in the language of claims, of a formula in LaTeX that has no equals sign.

    Raises
    ------
    InputError
        As :func:`read_latex`.
    """
    reader = _Reader(source, where, Names())
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


class _Reader(MatricesPart):
    """The whole reader: sums, products and factors, with the parts for names, calculus and matrices."""

    def expression(self) -> Node:
        self.depth += 1
        if self.depth > DEEPEST_NESTING // 2:
            raise self.fail(f"at most {DEEPEST_NESTING // 2} nested levels")
        terms = [self.term(sign=True)]
        while self.at("+", "-"):
            negative = self.next().text == "-"
            term = self.term(sign=False)
            terms.append(negated(term) if negative else term)
        self.depth -= 1
        return sum_of(terms)

    def term(self, sign: bool) -> Node:
        negative = False
        if sign and self.at("+", "-"):
            negative = self.next().text == "-"
        left = self.run()
        crossed = False
        while self.at("\\cdot", "\\times", "*"):
            operator = self.next()
            right = self.run()
            kinds = self.is_matrix(left), self.is_matrix(right)
            if operator.text == "*" or not any(kinds) or (operator.text == "\\cdot" and not all(kinds)):
                left = product([left, right])
            elif not all(kinds):
                raise self.fail("two vectors or two scalars around \\times", operator)
            elif crossed:
                raise self.fail("brackets that say which product of vectors comes first", operator)
            else:
                left, crossed = Node("call", "cross" if operator.text == "\\times" else "dot", (left, right)), True
        return negated(left) if negative else left

    def run(self) -> Node:
        """Read factors side by side, with slashes: ``\\frac12 m v^2``, ``a/b``, ``1/2 m``."""
        factors = [self.factor()]
        divided: tree.Node | None = None
        while True:
            token = self.peek()
            if token.text == "/":
                self.next()
                if divided:
                    raise self.fail("brackets, since a second slash is ambiguous", token)
                if factors[-1].kind == "call" and factors[-1].value in FUNCTIONS.values():
                    raise self.fail("brackets, since the slash may belong to the argument", token)
                factors.append(Node("inv", None, (self.factor(),)))
                simple = len(factors) == 2 and all(f.kind == "number" for f in (factors[0], factors[1].args[0]))
                divided = None if simple else token
            elif not self.starts_factor():
                return product(factors)
            elif divided:
                raise self.fail("brackets, since it is not clear how much the slash divides by", divided)
            elif token.kind == "number":
                raise self.fail("brackets or a product sign before a number")
            else:
                factors.append(self.factor())

    def starts_factor(self) -> bool:
        item = self.peek()
        if item.text in ENDS:
            return False
        if item.text in ("|", "\\|"):
            return item.text not in self.open_bars
        return not (self.integrals and self.differential())

    def factor(self) -> Node:
        item = self.next()
        node = self.base(item)
        while raised := self.script("^"):
            if node.kind == "power":
                raise self.fail("brackets around a repeated power", raised)
            if node.kind == "call" and node.value in FUNCTIONS.values():
                raise self.fail(f"the power after the name, {item.text}^n(..)", raised)
            node = self.raised(node, raised.inside)
        return node

    def raised(self, node: Node, inside: tree.Node) -> Node:
        """Return a transpose, a cross-product matrix or a power."""
        mark = tree.alone(inside)
        if isinstance(mark, tree.Font) and mark.text in UPRIGHT:
            mark = tree.alone(mark.inside)
        if mark.text in ("T", "\\top", "\\intercal"):
            return Node("transpose", None, (node,))
        if mark.text in ("\\times", "×"):
            return Node("call", "skew", (node,))
        texts = [item.text for item in getattr(inside, "items", ())]
        if texts[:3:2] == ["(", ")"] or (isinstance(mark, tree.Delimited) and len(mark.inside.items) == 1):
            raise self.fail("a power like x^2 instead of x^{(2)}", inside)
        exponent = self.argument(inside)
        if exponent == number(2) and self.is_column(node):
            return Node("call", "dot", (node, node))
        return Node("power", None, (node, exponent))

    def argument(self, node: tree.Node) -> Node:
        if isinstance(node, tree.Row):
            return self.inside(node, self.expression)
        if node.kind == "number":
            if self.is_cut(node):
                raise self.fail("braces around a number of several digits", node)
            return number(Fraction(node.text))
        if is_letter(node) or node.text == "\\pi":
            return Node("name", self.resolved(node.text.removeprefix("\\"), ""))
        raise self.fail("a group in braces", node)

    def base(self, item: tree.Node, script: bool = True) -> Node:
        if item.kind == "number":
            return number(Fraction(item.text))
        if is_letter(item):
            return self.named(item.text.removeprefix("\\"), item, script)
        if item.text == "\\pi":
            return Node("name", "pi")
        read = _READ.get(item.text)
        if read is None:
            known = "a command that is known" if item.text.startswith("\\") else "a number, a symbol or a bracket"
            raise self.fail(known, item)
        return read(self, item)

    def bracket(self, opening: tree.Node) -> Node:
        bars, self.open_bars = self.open_bars, ()
        if opening.kind == "row":
            inner = self.inside(opening, self.expression)
        else:
            inner = self.expression()
            self.expect(CLOSING[opening.text])
        self.open_bars = bars
        mark = self.peek()
        if opening.text == "[" and isinstance(mark, tree.Script) and tree.alone(mark.inside).text in ("\\times", "×"):
            self.next()
            return Node("call", "skew", (inner,))
        return inner


_READ = {
    **dict.fromkeys(("(", "[", "\\{", "{"), _Reader.bracket),
    **dict.fromkeys(("|", "\\|"), _Reader.bars),
    **dict.fromkeys(VECTOR_MARKS, _Reader.marked),
    **dict.fromkeys(NAME_MARKS, _Reader.barred),
    **dict.fromkeys(DOTS, _Reader.dotted),
    **dict.fromkeys(FUNCTIONS, _Reader.trigonometric),
    **dict.fromkeys(OPERATORS, _Reader.operator),
    **dict.fromkeys((*UPRIGHT, "\\operatorname"), _Reader.spelled),
    "\\frac": _Reader.fraction,
    "\\sqrt": _Reader.root,
    "\\int": _Reader.integral,
    "\\begin": _Reader.environment,
}

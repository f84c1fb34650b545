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
from symrot.checker.latex.cursor import CLOSING, TIME, Names
from symrot.checker.latex.matrices import MATRIX_CALLS, MatricesPart
from symrot.checker.latex.names import NAME_MARKS, OPERATORS, VECTOR_MARKS
from symrot.checker.latex.tokens import GREEK, Token

__all__ = ["MATRIX_CALLS", "TIME", "Names", "Reading", "read_latex", "read_latex_formula"]

ENDS = ("+", "-", "=", ")", "]", "\\}", "}", "&", "\\\\", ",", "\\end", "\\cdot", "\\times", "*", "/", "^", "_", "'")
"""Tokens that cannot start a factor."""


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
        divided: Token | None = None
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
        token = self.peek()
        if token.kind == "end" or token.text in ENDS:
            return False
        if token.text in ("|", "\\|"):
            return token.text not in self.open_bars
        return not (self.integrals and self.differential())

    def factor(self) -> Node:
        token = self.peek()
        node = self.base()
        while self.at("^"):
            mark = self.next()
            if node.kind == "power":
                raise self.fail("brackets around a repeated power", mark)
            if node.kind == "call" and node.value in FUNCTIONS.values():
                raise self.fail(f"the power after the name, {token.text}^n(..)", mark)
            node = self.raised(node)
        return node

    def raised(self, node: Node) -> Node:
        """Read a transpose, a cross-product matrix or an exponent after ``^``."""
        group = self.at("{")
        start = self.index
        if group:
            self.next()
        upright = self.take("\\mathrm")
        if upright:
            self.take("{")
        if self.at("T", "\\T"):
            self.next()
            for _ in range(group + upright):
                self.take("}")
            return Node("transpose", None, (node,))
        if not upright and self.take("\\times"):
            for _ in range(group):
                self.expect("}")
            return Node("call", "skew", (node,))
        self.index = start
        if [self.peek(n).text for n in range(2)] == ["{", "("] and self.peek(3).text == ")":
            raise self.fail("a power like x^2 instead of x^{(2)}")
        exponent = self.argument()
        if exponent == number(2) and self.is_column(node):
            return Node("call", "dot", (node, node))
        return Node("power", None, (node, exponent))

    def argument(self) -> Node:
        """Read a group in braces, or one token."""
        token = self.peek()
        if self.take("{"):
            inner = self.expression()
            self.expect("}")
            return inner
        if token.kind == "number":  # ^12 is ^1 2
            if len(token.text) > 1:
                raise self.fail("braces around a number of several digits")
            return number(Fraction(self.next().text))
        if token.kind == "letter" or token.text[1:] in GREEK or token.text == "\\pi":
            return self.base(script=False)
        raise self.fail("a group in braces")

    def base(self, script: bool = True) -> Node:
        token = self.next()
        if token.kind == "number":
            return number(Fraction(token.text))
        if token.kind == "letter" or (token.text[1:] in GREEK and token.kind == "command"):
            return self.named(token.text.removeprefix("\\"), token, script)
        if token.text == "\\pi":
            return Node("name", "pi")
        reader = _READ.get(token.text)
        if reader is None:
            known = "a command that is known" if token.kind == "command" else "a number, a symbol or a bracket"
            raise self.fail(known, token)
        return reader(self, token)

    def bracket(self, token: Token) -> Node:
        bars, self.open_bars = self.open_bars, ()
        inner = self.expression()
        self.expect(CLOSING[token.text])
        self.open_bars = bars
        if token.text == "[" and self.at("_") and "\\times" in (self.peek(1).text, self.peek(2).text):
            self.next()
            group = self.take("{")
            self.expect("\\times")
            if group:
                self.expect("}")
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
    "\\mathrm": _Reader.spelled,
    "\\operatorname": _Reader.spelled,
    "\\frac": _Reader.fraction,
    "\\sqrt": _Reader.root,
    "\\int": _Reader.integral,
    "\\begin": _Reader.environment,
}

"""The reader of claims, from text to tree: tokens, then precedence climbing, without Python's evaluator or SymPy.

It reads ``left == right`` with numbers, names, ``+ - * / **``, brackets, calls, ``Matrix([[..], [..]])``, ``.T`` and
``M[0, 1]``. Any other text is refused with its position; nothing is dropped.
"""

import re
from collections.abc import Iterator
from fractions import Fraction

from symrot.checker.claim.tree import Node, negated, product, sum_of
from symrot.errors import InputError, complaint

__all__ = ["DEEPEST_NESTING", "LONGEST_TEXT", "Relation", "read_expression", "read_relation"]

LONGEST_TEXT = 20_000
DEEPEST_NESTING = 60
LONGEST_NUMBER = 200
MOST_PIECES = 5_000

SIGNS = ("==", "=", "!=", ">=", "<=", ">", "<")

_TOKEN = re.compile(
    r"(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![A-Za-z_])|(?P<name>[A-Za-z][A-Za-z0-9_]*)"
    r"|(?P<mark>\*\*|==|!=|>=|<=|[-+*/(),\[\].=<>])",
    re.ASCII,
)
_HINTS = {
    "^": "write ** for a power", "'": "write diff(x, t) for a derivative", "\\": "LaTeX goes into latex = ..",
    "\u2212": "write - for a minus sign", "\u00b7": "write * for a product", "\u00d7": "write * for a product",
    "\u00b2": "write **2 for a square",
}  # fmt: skip

Relation = tuple[str, Node, Node]


class _Reader:
    def __init__(self, source: str, where: str) -> None:
        self.source, self.where = source, where
        prefix = f"{where}: " if where else ""
        if not isinstance(source, str):
            raise InputError(f"{prefix}expected the text of a formula, got {type(source).__name__}")
        if not source.strip():
            raise InputError(f"{prefix}expected a formula, got empty text")
        if len(source) > LONGEST_TEXT:
            raise InputError(f"{prefix}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")
        self.depth = self.index = 0
        self.tokens = list(self._split())
        if len(self.tokens) > MOST_PIECES:
            raise InputError(f"{prefix}expected a formula of at most {MOST_PIECES} pieces, got {len(self.tokens)}")

    def fail(self, expected: str, position: int | None = None) -> InputError:
        return complaint(self.source, self.where, self.start() if position is None else position, expected)

    def _split(self) -> Iterator[tuple[str, str, int]]:
        position, end = 0, len(self.source.rstrip())
        while position < end:
            if self.source[position].isspace():
                position += 1
                continue
            match = _TOKEN.match(self.source, position)
            if match is None:
                hint = _HINTS.get(self.source[position])
                expected = "a number, a name, an operator or a bracket" + (f" ({hint})" if hint else "")
                raise complaint(self.source, self.where, position, expected)
            yield str(match.lastgroup), match[0], position
            position = match.end()
        yield "end", "", end

    # -- tokens -----------------------------------------------------------------------------------------------------

    def peek(self) -> str:
        return self.tokens[self.index][1]

    def next(self) -> tuple[str, str, int]:
        token = self.tokens[self.index]
        self.index += token[0] != "end"
        return token

    def take(self, mark: str) -> bool:
        """Step over a mark if it is the next token, and return whether it was."""
        is_next = self.peek() == mark
        self.index += is_next
        return is_next

    def expect(self, mark: str) -> None:
        if not self.take(mark):
            raise self.fail(f"'{mark}'")

    def start(self) -> int:
        return self.tokens[self.index][2]

    def span(self, start: int) -> tuple[int, int]:
        _, last, position = self.tokens[self.index - 1]
        return start, position + len(last)

    # -- grammar ----------------------------------------------------------------------------------------------------

    def whole(self) -> Node:
        node = self.expression()
        if self.tokens[self.index][0] != "end":
            raise self.fail("an operator or the end")
        return node

    def relation(self) -> Relation:
        left = self.expression()
        sign = self.peek()
        if sign not in SIGNS:
            raise self.fail("'==' between two sides" if not sign else "an operator or '=='")
        self.next()
        right = self.expression()
        if self.peek() in SIGNS:
            raise self.fail("one '==' in a claim, not a chain of them")
        if self.tokens[self.index][0] != "end":
            raise self.fail("an operator or the end")
        return "==" if sign == "=" else sign, left, right

    def expression(self) -> Node:
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels")
        start = self.start()
        terms = [self.term()]
        while self.peek() in ("+", "-"):
            negative = self.next()[1] == "-"
            term = self.term()
            terms.append(negated(term) if negative else term)
        self.depth -= 1
        return sum_of(terms, self.span(start)) if len(terms) > 1 else terms[0]

    def term(self) -> Node:
        start = self.start()
        factors = [self.factor()]
        while self.peek() in ("*", "/"):
            at = self.start()
            inverse = self.next()[1] == "/"
            factor = self.factor()
            factors.append(Node("inv", None, (factor,), self.span(at)) if inverse else factor)
        return product(factors, self.span(start)) if len(factors) > 1 else factors[0]

    def factor(self) -> Node:
        negative, start = False, self.start()
        while self.peek() in ("+", "-"):
            negative ^= self.next()[1] == "-"
        made = self.power()
        return Node("neg", None, (made,), self.span(start)) if negative else made

    def power(self) -> Node:
        start = self.start()
        base = self.postfix()
        if not self.take("**"):
            return base
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels")
        exponent = self.factor()
        self.depth -= 1
        return Node("power", None, (base, exponent), self.span(start))

    def postfix(self) -> Node:
        start = self.start()
        node = self.atom()
        while self.peek() in (".", "["):
            if self.take("["):
                indices = self.members("]")
                node = Node("index", None, (node, *indices), self.span(start))
                continue
            self.next()
            if not self.take("T"):
                raise self.fail("T, the transpose, after '.'")
            node = Node("transpose", None, (node,), self.span(start))
        return node

    def atom(self) -> Node:
        kind, token, position = self.next()
        if kind == "number":
            return Node("number", self.number(token, position), (), self.span(position))
        if kind == "name":
            if not self.take("("):
                return Node("name", token, (), self.span(position))
            arguments = self.members(")")
            return Node("call", token, tuple(arguments), self.span(position))
        if token == "(":
            inner = self.members(")")
            if len(inner) == 1:
                return inner[0]
            return Node("list", ("(", ")"), tuple(inner), self.span(position))
        if token == "[":
            return Node("list", ("[", "]"), tuple(self.members("]")), self.span(position))
        raise self.fail("a number, a name or a bracket", position)

    def members(self, closing: str) -> list[Node]:
        members = [self.expression()]
        while self.take(","):
            members.append(self.expression())
        self.expect(closing)
        return members

    def number(self, token: str, position: int) -> Fraction:
        exponent = re.split("[eE]", token)[1:]
        if len(token) > LONGEST_NUMBER:
            raise self.fail(f"a number of at most {LONGEST_NUMBER} characters", position)
        if exponent and abs(int(exponent[0])) > LONGEST_NUMBER:
            raise self.fail(f"a power of ten within {LONGEST_NUMBER}", position)
        return Fraction(token)


def read_expression(source: str, where: str = "") -> Node:
    """Return the tree of a formula.

    Parameters
    ----------
    source : str
        At most 20 000 characters, nested at most 60 deep.
    where : str
        The place of the text, which begins every error message.

    Raises
    ------
    InputError
        Naming the first position that cannot be read.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> text(read_expression("a - (b*(c))/d"))
    'a - b*c/d'
    """
    return _Reader(source, where).whole()


def read_relation(source: str, where: str = "") -> Relation:
    """Return (sign, left, right) of ``left == right``; the signs ``!= > >= < <=`` are read for hypotheses.

    Raises
    ------
    InputError
        As :func:`read_expression`, and if there is no relation sign or more than one.
    """
    return _Reader(source, where).relation()

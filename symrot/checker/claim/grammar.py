"""The grammar of claims: from tokens to trees by precedence, with tables for operators, functions and methods.

SymPy's text has one meaning. A formula as people type it has products without a sign (``2x``, ``m g l``), functions
without brackets (``sin 2x``), powers (``x^2``, ``x²``), primes and dots, and it may have several readings. The parser
takes the usual one and records each such place as a :class:`Doubt`; with the place among ``flips`` it takes the other.
"""

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import ClassVar

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tokens import GREEK_WORDS, SIGNS, Token
from symrot.checker.claim.tree import Node, negated, number, product, sum_of, walk
from symrot.checker.claim.words import ALIASES, SINGLE_ARGUMENT
from symrot.errors import InputError, complaint

__all__ = ["DEEPEST_NESTING", "TIME", "Doubt", "Parser", "Vocabulary"]

DEEPEST_NESTING = 60
LONGEST_NUMBER = 200
TIME = Node("name", "t")
ADDING = ("+", "-")
TIMES = ("*", "/", "·", "×")
FACTOR_MARKS = ("(", "[", "√")
"""Marks with which a factor without a sign before it may start."""

METHODS = {
    "T": ("transpose", 0), "inv": ("inverse", 0), "det": ("det", 0), "trace": ("trace", 0),
    "transpose": ("transpose", 0), "adjugate": ("adjugate", 0),
    "cross": ("cross", 1), "dot": ("dot", 1), "diff": ("diff", 8), "norm": ("norm", 0),
}  # fmt: skip
"""Method of SymPy's matrices -> the function, and the most arguments of the method; T is an attribute."""

CONSTRUCTORS = {"hstack": "hstack", "eye": "eye", "diag": "diag"}
"""Name after ``Matrix.`` -> the function."""

BROKEN_EXPONENTS = frozenset([*(("1", n) for n in "23456789"), *((n, "2") for n in "13579"), ("2", "3"), ("4", "3")])
"""Numbers around a slash after ``^`` that may be a broken exponent, x^(3/2); r^2/5 is (r^2)/5."""

VECTOR_FUNCTIONS = ("cross", "vee", "Matrix")
USUAL_VECTORS = frozenset([*"abcdeuvwrpqnsFLHMNRT", "omega", "Omega", "alpha", "tau"])
"""Names between which a letter x with blanks around it is a product sign, unless x is a name of the text."""


@dataclass(frozen=True)
class Doubt:
    """A place of a text that has two readings.

    Attributes
    ----------
    key : (str, int)
        The kind of the place, and its position.
    excerpt : str
        The text of the place.
    """

    key: tuple[str, int]
    excerpt: str


@dataclass(frozen=True)
class Vocabulary:
    """The names with a meaning: declared symbols, functions of time and matrices; those that the text uses alone.

    ``vectors`` are names on either side of a cross, which a text uses as vectors.
    """

    symbols: frozenset[str] = frozenset()
    functions: frozenset[str] = frozenset()
    alone: frozenset[str] = frozenset()
    vectors: frozenset[str] = frozenset()

    def function(self, name: str) -> str | None:
        """Return the name of a built-in or declared function, None for any other name."""
        if name in self.symbols:
            return None
        if name in BUILT_IN or name in self.functions:
            return name
        return ALIASES.get(name)


class Parser:
    """A place in the tokens of a formula, with the functions that read a tree from there.

    Attributes
    ----------
    plain : bool
        Whether the formula uses anything that SymPy's text does not have.
    doubts : list of Doubt
    notes : list of str
        Sentences about readings that a reader should know.
    timed : set of str
        Names with a prime or a dot, which are functions of time.
    """

    def __init__(
        self, tokens: Sequence[Token], source: str, where: str = "", vocabulary: Vocabulary | None = None,
        flips: Collection[tuple[str, int]] = (), as_sympy: bool = False,
    ) -> None:  # fmt: skip
        self.tokens, self.source, self.where = tokens, source, where
        self.vocabulary, self.flips, self.as_sympy = vocabulary or Vocabulary(), flips, as_sympy
        self.depth = self.index = self.bars = 0
        self.plain = False
        self.doubts: list[Doubt] = []
        self.notes: list[str] = []
        self.timed: set[str] = set()

    # -- tokens -----------------------------------------------------------------------------------------------------

    def fail(self, expected: str, position: int | None = None) -> InputError:
        return complaint(self.source, self.where, self.start() if position is None else position, expected)

    def token(self, ahead: int = 0) -> Token:
        return self.tokens[min(self.index + ahead, len(self.tokens) - 1)]

    def peek(self) -> str:
        """Return the mark at the cursor, or an empty text."""
        token = self.token()
        return token.text if token.kind == "mark" else ""

    def next(self) -> Token:
        token = self.token()
        self.index += token.kind != "end"
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
        return self.token().start

    def span(self, start: int) -> tuple[int, int]:
        return start, self.tokens[self.index - 1].end

    def deeper(self) -> None:
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels")

    def other_reading(self, kind: str, at: int, start: int, stop: int) -> bool:
        """Record a place with two readings, and the text around it; return whether its other reading is wanted."""
        self.plain = True
        doubt = Doubt((kind, at), self.source[start:stop].strip())
        if doubt.key not in [known.key for known in self.doubts]:
            self.doubts.append(doubt)
        return doubt.key in self.flips

    def note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)

    # -- sums and products ------------------------------------------------------------------------------------------

    def whole(self) -> Node:
        node = self.expression()
        if self.token().kind != "end":
            raise self.fail("an operator or the end")
        return node

    def relation(self) -> tuple[list[str], list[Node]]:
        """Read a chain of sides; return the signs between them, and the sides."""
        if self.token().text == "Eq" and self.token(1).text == "(":
            self.index += 2
            sides = self.members(")")
            if len(sides) != 2:
                raise self.fail("two sides in Eq(..)")
            signs = ["=="]
        else:
            sides, signs = [self.expression()], []
            while (sign := self.peek()) in SIGNS:
                signs.append("==" if sign == "=" else sign)
                self.plain |= sign == "="
                self.next()
                sides.append(self.expression())
        if self.token().kind != "end":
            raise self.fail("an operator or the end" if signs else "an operator or '=='")
        if not signs:
            raise self.fail("'==' between two sides")
        return signs, sides

    def expression(self) -> Node:
        self.deeper()
        start = self.start()
        terms = [self.term()]
        while self.peek() in ADDING:
            negative = self.next().text == "-"
            term = self.term()
            terms.append(negated(term) if negative else term)
        self.depth -= 1
        return sum_of(terms, self.span(start)) if len(terms) > 1 else terms[0]

    def term(self) -> Node:
        start = before = self.start()
        factors = [self.factor()]
        while True:
            mark = self.peek()
            if mark == "×" or self.is_cross_letter():
                self.crossed(factors)
            elif mark == "·" and self.is_vector(factors[-1]):
                self.dotted(factors)
            elif mark in TIMES:
                at = self.start()
                self.plain |= mark == "·"
                if self.next().text == "/":
                    factors.append(self.divisor(factors[-1], before, at))
                else:
                    before = self.start()
                    factors.append(self.factor())
            elif self.starts_factor():
                self.plain = True
                before = self.start()
                factors.append(self.factor())
            else:
                return product(factors, self.span(start)) if len(factors) > 1 else factors[0]

    def starts_factor(self) -> bool:
        """Return whether a factor without a sign before it starts at the cursor."""
        token = self.token()
        if token.kind in ("number", "fraction"):
            raise self.fail("a product sign before a number" if token.kind == "number" else "an operator")
        return token.kind == "name" or token.text in FACTOR_MARKS or (token.text == "|" and not self.bars)

    def divisor(self, above: Node, start: int, slash: int) -> Node:
        """Read the formula after a slash; without brackets it may be one factor, or the product that follows.

        Usually ``1/2 m`` and ``a/b c`` are (1/2)*m and (a/b)*c, but ``p^2/2m`` and ``g/ωr``, without blanks, divide by
        the product.
        """
        first = self.token()
        below = [self.factor()]
        while above.kind in ("neg", "inv"):
            above = above.args[0]
        coefficient = above.kind == below[0].kind == "number"  # 1/2 m
        while first.text != "(" and self.token().kind not in ("number", "fraction") and self.starts_factor():
            token = self.token()
            if coefficient and token.spaced:
                break
            usual = token.tight and token.text not in ("(", "[")
            if coefficient:  # 1/2π is 1/(2π), but 4/3πr³ is (4/3)πr³
                after = self.token(1)
                alone = not (after.kind == "name" and after.tight)
                usual = token.text == "pi" and alone and (above, first.text) in ((number(1), "2"), (number(1), "4"))
            if self.other_reading("divisor", token.start, start, self.end_of_run()) == usual:
                break
            below.append(self.factor())
        node = product(below, self.span(first.start)) if len(below) > 1 else below[0]
        return Node("inv", None, (node,), self.span(slash))

    def end_of_run(self) -> int:
        """Return where the factor at the cursor ends, by its tokens."""
        depth = 0
        for token in self.tokens[self.index :]:
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            if depth <= 0:
                return token.end
        return len(self.source)

    def factor(self) -> Node:
        negative, start = False, self.start()
        while self.peek() in ADDING:
            negative ^= self.next().text == "-"
        made = self.power()
        return Node("neg", None, (made,), self.span(start)) if negative else made

    # -- vectors ----------------------------------------------------------------------------------------------------

    def is_vector(self, node: Node) -> bool:
        """Return whether a tree is a vector: a list, a cross product, a name that the text uses as a vector."""
        if node.kind == "name":
            return node.value in self.vocabulary.vectors
        if node.kind == "call":
            return node.value in VECTOR_FUNCTIONS or (node.value == "diff" and self.is_vector(node.args[0]))
        return node.kind == "list" or (node.kind in ("sum", "neg", "product") and any(map(self.is_vector, node.args)))

    def is_cross_letter(self) -> bool:
        """Return whether a letter x between the names of two vectors, with blanks around it, is a product sign."""
        token, after, before = self.token(), self.token(1), self.tokens[self.index - 1]
        if token.kind != "name" or token.text != "x" or not token.spaced or not after.spaced:
            return False
        if "x" in self.vocabulary.alone or not is_cross_letter(before, after):
            return False
        return not self.other_reading("cross", token.start, before.start, after.end)

    def crossed(self, factors: list[Node]) -> None:
        """Read a product with a cross: of vectors if one side is a vector, else of numbers."""
        self.plain = True
        closed = self.tokens[self.index - 1].text == ")"
        sign = self.next()
        right, left = self.factor(), factors[-1]
        if not self.is_vector(left) and not self.is_vector(right):
            factors.append(right)
            return
        if left.kind == "call" and left.value == "cross" and not closed:
            raise self.fail("brackets that say which of the products comes first", sign.start)
        if right.kind == "name" and self.token().kind == "name" and not self.is_cross_letter():
            raise self.fail("brackets around the right side of the product of vectors")
        factors[-1] = Node("call", "cross", (left, right), self.span(left.span[0]))

    def dotted(self, factors: list[Node]) -> None:
        """Read a product with a dot after a vector."""
        self.plain = True
        self.next()
        right = self.factor()
        if self.is_vector(right):
            factors[-1] = Node("call", "dot", (factors[-1], right), self.span(factors[-1].span[0]))
        else:
            factors.append(right)

    # -- powers -----------------------------------------------------------------------------------------------------

    def power(self) -> Node:
        start = self.start()
        base = self.postfix()
        while self.token().kind == "power":
            base = self.raised(base, self.next(), start)
        if self.take("**"):
            self.deeper()
            exponent = self.factor()
            self.depth -= 1
            return Node("power", None, (base, exponent), self.span(start))
        if self.take("^"):
            self.plain = True
            return self.caret(base, start)
        return base

    def raised(self, base: Node, token: Token, start: int) -> Node:
        """Return a power with raised digits, a transpose or an inverse."""
        self.plain = True
        digits, transposed = token.text.removesuffix("T"), token.text.endswith("T")
        if transposed and digits in ("", "-"):
            base = Node("transpose", None, (base,), self.span(start))
            digits = "-1" if digits else ""
        if not digits:
            return base
        if not re.fullmatch(r"[+-]?\d+", digits, re.ASCII):
            raise self.fail("a whole number as a raised exponent", token.start)
        return Node("power", None, (base, number(int(digits))), self.span(start))

    def caret(self, base: Node, start: int) -> Node:
        """Read the exponent after ``^``: a factor, or T for the transpose."""
        if self.token().text == "T" and self.token(1).text != "(":
            self.next()
            return Node("transpose", None, (base,), self.span(start))
        if self.peek() == "-" and self.token(1).text == "T":
            self.index += 2
            inverse = Node("power", None, (base, number(-1)), self.span(start))
            return Node("transpose", None, (inverse,), self.span(start))
        self.deeper()
        first = self.token()
        exponent = self.factor()
        slash, below = self.token(), self.token(1)
        if slash.text == "/" and slash.tight and below.tight and (first.text, below.text) in BROKEN_EXPONENTS:
            usual = exponent == number(1)  # x^1/2 is a root, since a power of 1 would not be written
            if self.other_reading("exponent", start, start, below.end) != usual:
                self.index += 2
                exponent = product([exponent, Node("inv", None, (self.numeral(below),), self.span(slash.start))])
        is_e = base.kind == "name" and base.value == "e" and "e" not in self.vocabulary.symbols
        follower = self.token()
        goes_on = is_e and exponent.kind in ("number", "neg") and follower.kind == "name" and follower.tight
        if goes_on and not self.other_reading("exponent of e", start, start, follower.end):
            exponent = product([exponent, self.factor()])
        self.depth -= 1
        if is_e and any(node.kind in ("name", "call") for _, node in walk(exponent)):
            self.note("e is read as the base of the exponential function")
            return Node("call", "exp", (exponent,), self.span(start))
        return Node("power", None, (base, exponent), self.span(start))

    # -- pieces and their ends --------------------------------------------------------------------------------------

    def postfix(self) -> Node:
        start = self.start()
        node = self.atom()
        while True:
            token = self.token()
            if token.text == "." and token.kind == "mark":
                self.next()
                node = self.method(node, start)
            elif token.text == "[" and token.tight and node.kind != "number" and self.is_index():
                self.next()
                node = Node("index", None, (node, *self.members("]")), self.span(start))
            elif token.kind in ("prime", "dots"):
                node = self.rate(node, self.next(), start)
            elif token.text == "°":
                self.plain = True
                self.next()
                degrees = [node, Node("name", "pi"), Node("inv", None, (number(180),))]
                node = product(degrees, self.span(start))
            else:
                return node

    def is_index(self) -> bool:
        """Return whether square brackets are an index, ``M[0, 1]``, and not brackets of a formula, ``m[a^2 + b^2]``."""
        depth, inside = 0, self.tokens[self.index + 1 :]
        names = False
        for token in inside:
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            if depth < 0:
                return not names
            if token.text == "," and depth == 0:
                return True
            names |= token.kind != "number" and token.text not in ("+", "-", "*")
        return True

    def method(self, node: Node, start: int) -> Node:
        """Read a method of a matrix after a dot."""
        token = self.token()
        if token.kind != "name" or token.text not in METHODS:
            names = ", ".join(name if name == "T" else f"{name}()" for name in METHODS)
            raise self.fail(f"T, the transpose, or another of {names} after '.'")
        self.next()
        name, most = METHODS[token.text]
        if token.text == "T":
            return Node("transpose", None, (node,), self.span(start))
        self.expect("(")
        arguments = [] if self.take(")") else self.members(")")
        if len(arguments) > most or (most and not arguments):
            raise self.fail(f"{'one argument' if most else 'no arguments'} of .{token.text}", token.start)
        if name == "norm":
            squares = Node("call", "dot", (node, node), self.span(start))
            return Node("call", "sqrt", (squares,), self.span(start))
        if name == "transpose":
            return Node("transpose", None, (node,), self.span(start))
        return Node("call", name, (node, *arguments), self.span(start))

    def rate(self, node: Node, mark: Token, start: int) -> Node:
        """Return the derivative with respect to time that primes or dots mean; x' may also be a name of its own."""
        self.plain = True
        order = int(mark.text) if mark.kind == "dots" else len(mark.text)
        if node.kind == "name":
            name = str(node.value)
            if mark.kind == "prime" and self.other_reading("prime", start, start, mark.end):
                return Node("name", name + "_prime" * order, (), self.span(start))
            if name in ("t", "pi"):
                raise self.fail(f"a name that may depend on t instead of {name}", start)
            if name not in self.vocabulary.functions and name in self.vocabulary.symbols:
                raise self.fail(f"{name} to be declared as a function of t", start)
            if [self.token(n).text for n in range(3)] == ["(", "t", ")"]:
                self.index += 3
            self.timed.add(name)
            node = Node("call", name, (TIME,), node.span)
        elif node.kind == "call" and node.value == "diff" and node.args[-1] == TIME:
            return Node("call", "diff", (*node.args, *[TIME] * order), self.span(start))
        return Node("call", "diff", (node, *[TIME] * order), self.span(start))

    def atom(self) -> Node:
        token = self.next()
        read = self.readers.get(token.text if token.kind == "mark" else token.kind)
        if read is None:
            raise self.fail("a number, a name or a bracket", token.start)
        return read(self, token)

    def numeral(self, token: Token) -> Node:
        exponent = re.split("[eE]", token.text)[1:]
        if len(token.text) > LONGEST_NUMBER:
            raise self.fail(f"a number of at most {LONGEST_NUMBER} characters", token.start)
        if exponent and abs(int(exponent[0])) > LONGEST_NUMBER:
            raise self.fail(f"a power of ten within {LONGEST_NUMBER}", token.start)
        if exponent and self.token().kind == "name" and self.token().tight:
            raise self.fail(f"a product sign after the number {token.text}")
        return Node("number", Fraction(token.text), (), self.span(token.start))

    def fraction(self, token: Token) -> Node:
        self.plain = True
        value = Fraction(token.text)
        below = Node("inv", None, (number(value.denominator),), self.span(token.start))
        return product([number(value.numerator), below], self.span(token.start))

    def name(self, token: Token) -> Node:
        word = token.text
        if (leibniz := self.leibniz(token)) is not None:
            return leibniz
        if word == "Matrix" and self.peek() == "." and self.token(1).text in CONSTRUCTORS:
            self.index += 2
            return self.called(CONSTRUCTORS[self.tokens[self.index - 1].text], token)
        function = self.vocabulary.function(word)
        if function is None and word in SINGLE_ARGUMENT and word not in self.vocabulary.symbols and not self.as_sympy:
            function = word  # a function that is not built in, which the interpreter refuses
        if word == "Rational" and self.peek() == "(":
            return self.rational(token)
        if function is None:
            return self.symbol(token)
        if self.peek() == "(" or function in self.vocabulary.functions:
            return (
                self.called(function, token) if self.peek() == "(" else Node("name", word, (), self.span(token.start))
            )
        if word not in SINGLE_ARGUMENT:
            return Node("name", word, (), self.span(token.start))
        return self.applied(function, token)

    def called(self, function: str, token: Token) -> Node:
        self.expect("(")
        arguments = self.members(")")
        return Node("call", function, tuple(arguments), self.span(token.start))

    def rational(self, token: Token) -> Node:
        call = self.called("Rational", token)
        if len(call.args) != 2:
            raise self.fail("two numbers in Rational(..)", token.start)
        above, below = call.args
        return product([above, Node("inv", None, (below,), below.span)], call.span)

    def symbol(self, token: Token) -> Node:
        """Read a name that is no built-in function: a function of time, or a symbol, perhaps before a bracket."""
        word = token.text
        inside = [self.token(n).text for n in range(1, 3)]
        if self.peek() == "(" and (inside == ["t", ")"] or not self.is_factor(word)):
            return self.called(word, token)
        if self.peek() == "(":
            self.plain = True
            if self.token().tight and word not in self.vocabulary.alone and word not in self.vocabulary.vectors:
                self.note(f"{word}(..) is read as the product of {word} and the bracket")
        return Node("name", word, (), self.span(token.start))

    def is_factor(self, word: str) -> bool:
        """Return whether a name before a bracket is a symbol: used alone elsewhere, or a letter before a formula."""
        if word in self.vocabulary.symbols or word in self.vocabulary.alone:
            return True
        depth = pieces = 0
        for token in self.tokens[self.index :]:
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            if depth == 0:
                break
            if token.text == "," and depth == 1:
                return False
            pieces += token.text not in ("(", ")", "[", "]")
        short = word[:1].isalpha() and (len(word.rstrip("0123456789")) == 1 or "_" in word or word in GREEK_WORDS)
        return pieces > 1 and short and word != "f"

    def bracket(self, token: Token) -> Node:
        bars, self.bars = self.bars, 0
        inner = self.members(")")
        self.bars = bars
        if len(inner) == 1:
            return inner[0]
        return Node("list", ("(", ")"), tuple(inner), self.span(token.start))

    def square_bracket(self, token: Token) -> Node:
        bars, self.bars = self.bars, 0
        rows = [self.row()]
        while self.take(";"):
            self.plain = True
            rows.append(self.row())
        self.expect("]")
        self.bars = bars
        span = self.span(token.start)
        if all(len(row) == 1 for row in rows) and all(self.has_blanks(row[0]) for row in rows):
            raise self.fail("commas between the entries of a matrix, or * in a product,", token.start)
        if len(rows) == 1:
            return Node("list", ("[", "]"), tuple(rows[0]), span)
        return Node("list", ("[", "]"), tuple(Node("list", ("[", "]"), tuple(row), span) for row in rows), span)

    def has_blanks(self, entry: Node) -> bool:
        """Return whether an entry is a product with nothing but blanks between two names: perhaps two entries."""
        inner = entry.args[0] if entry.kind == "neg" else entry
        pairs = pairwise(inner.args if inner.kind == "product" else ())
        gaps = [self.source[a.span[1] : b.span[0]] for a, b in pairs if a.kind in ("name", "call", "number")]
        return bool(gaps) and all(gap.isspace() for gap in gaps)

    def row(self) -> list[Node]:
        entries = [self.expression()]
        while self.take(","):
            entries.append(self.expression())
        return entries

    def members(self, closing: str) -> list[Node]:
        bars, self.bars = self.bars, 0
        members = self.row()
        self.expect(closing)
        self.bars = bars
        return members

    def absolute(self, token: Token) -> Node:
        self.plain = True
        self.bars += 1
        inner = self.expression()
        self.expect("|")
        self.bars -= 1
        if self.is_vector(inner):
            return Node("call", "sqrt", (Node("call", "dot", (inner, inner), self.span(token.start)),))
        return Node("call", "abs", (inner,), self.span(token.start))

    # -- functions without brackets ---------------------------------------------------------------------------------

    def applied(self, function: str, token: Token) -> Node:
        """Read a function without brackets: ``sin 2x``, ``sin^2 x``, ``tan^-1 x``."""
        exponent = self.function_exponent(token)
        inverse = exponent == number(-1) and function in ("sin", "cos", "tan")
        if inverse and not self.other_reading("inverse", token.start, token.start, self.end_of_run()):
            function, exponent = f"a{function}", None
        if self.peek() == "(":
            call = self.called(function, token)
        else:
            call, exponent = self.open_call(function, token, exponent)
        if exponent is None:
            return call
        return Node("power", None, (call, exponent), self.span(token.start))

    def function_exponent(self, token: Token) -> Node | None:
        """Read the power between a function and its argument."""
        if self.token().kind == "power":
            raised = self.next()
            self.plain = True
            if not re.fullmatch(r"[+-]?\d+", raised.text, re.ASCII):
                raise self.fail("a whole number as the power of a function", raised.start)
            return number(int(raised.text))
        if self.peek() not in ("^", "**"):
            return None
        self.plain = True
        self.next()
        bracket = self.take("(")
        negative = self.take("-")
        digits = self.next()
        if digits.kind != "number":
            raise self.fail(f"a number as the power of {token.text}", digits.start)
        if bracket:
            self.expect(")")
        value = self.numeral(digits)
        return Node("neg", None, (value,), value.span) if negative else value

    def open_call(self, function: str, token: Token, exponent: Node | None) -> tuple[Node, Node | None]:
        """Read the argument of a function without brackets; return the call, and the power of the whole of it."""
        self.plain = True
        first = self.token()
        if first.kind not in ("number", "name", "fraction") and first.text not in ("√", "-", "[", "|"):
            raise self.fail(f"brackets after the function {token.text}")
        self.deeper()
        negative = self.take("-")
        factors = [self.argument_factor(token)]
        power = self.power_of_call(token, factors)
        while power is None and self.absorbs(token, factors):
            factors.append(self.argument_factor(token))
            power = self.power_of_call(token, factors)
        argument = product(factors, self.span(first.start))
        if power is None and self.peek() == "/" and self.slash_belongs(token, factors):
            slash = self.next()
            divisor = Node("inv", None, (self.factor(),), self.span(slash.start))
            argument = product([argument, divisor], self.span(first.start))
        self.depth -= 1
        if negative:
            argument = negated(argument)
        call = Node("call", function, (argument,), self.span(token.start))
        if power is not None:
            exponent = power if exponent is None else product([exponent, power])
        return call, exponent

    def argument_factor(self, token: Token) -> Node:
        if self.peek() in ADDING:
            raise self.fail(f"brackets around the argument of {token.text}")
        return self.power()

    def power_of_call(self, token: Token, factors: list[Node]) -> Node | None:
        """Return the power at the end of an argument if it belongs to the function, (sin x)^2; usually it does not."""
        last = factors[-1]
        if last.kind != "power" or last.args[0].kind not in ("name", "call"):
            return None
        if not self.other_reading("power of argument", last.span[0], token.start, last.span[1]):
            return None
        factors[-1] = last.args[0]
        return last.args[1]

    def absorbs(self, function: Token, factors: list[Node]) -> bool:
        """Return whether the next factor belongs to the argument of a function without brackets."""
        token = self.token()
        if token.text in ("*", "·") and token.kind == "mark":
            if self.other_reading("product after argument", token.start, function.start, self.token(1).end):
                self.next()
                return True
            return False
        if token.kind != "name" and token.text not in FACTOR_MARKS:
            return False
        if self.vocabulary.function(token.text) is not None or token.text in SINGLE_ARGUMENT or self.is_cross_letter():
            return False  # sin x cos y
        if token.tight and token.kind == "name":
            return True  # sin ωt
        only_numbers = not any(node.kind in ("name", "call") for factor in factors for _, node in walk(factor))
        if self.token(1).kind in ("prime", "dots") and not only_numbers:
            return False  # sin θ φ'
        usual = only_numbers or (token.text == "t" and TIME not in factors)
        return self.other_reading("argument", token.start, function.start, self.end_of_run()) != usual

    def slash_belongs(self, function: Token, factors: list[Node]) -> bool:
        """Return whether a slash after the argument of a function without brackets belongs to the argument."""
        slash, below = self.token(), self.token(1)
        if below.kind == "name" and (self.vocabulary.function(below.text) or below.text in SINGLE_ARGUMENT):
            return False
        usual = (
            below.kind == "number"
            and slash.tight
            and below.tight
            and len(factors) == 1
            and factors[0].kind in ("name", "call")
        )  # cos θ/2
        return self.other_reading("slash after argument", slash.start, function.start, below.end) != usual

    def root(self, token: Token) -> Node:
        """Read the formula under a root sign without a bar over it."""
        self.plain = True
        first = self.token()
        bracketed = first.text == "("
        inside = [self.power()]
        while not bracketed and self.token().tight and (self.token().kind == "name" or self.token().text == "("):
            usual = inside[0].kind != "number"
            if self.other_reading("root", self.start(), token.start, self.end_of_run()) == usual:
                break
            inside.append(self.power())
        slash, below = self.token(), self.token(1)
        open_end = not bracketed and slash.text == "/" and below.kind in ("name", "number") and first.kind == "name"
        if open_end and self.other_reading("slash after root", token.start, token.start, below.end):
            self.next()
            inside.append(Node("inv", None, (self.power(),), self.span(slash.start)))
        return Node("call", "sqrt", (product(inside, self.span(first.start)),), self.span(token.start))

    # -- derivatives as quotients -----------------------------------------------------------------------------------

    def leibniz(self, token: Token) -> Node | None:
        """Read ``dx/dt``, ``d²x/dt²`` or ``d/dt x`` as a derivative; None for any other text."""
        texts = [self.token(n).text for n in range(8)]
        word = token.text
        if word.startswith("d") and texts[:2] == ["/", "dt"] and not self.continues(1):
            if word == "d":
                return self.derivative_of_next(token)
            return self.quotient_rate(token, word[1:], 1, 2)
        if word == "d" and self.token().kind == "name" and self.token().tight and texts[1:3] == ["/", "dt"]:
            return self.quotient_rate(token, texts[0], 1, 3)
        if word == "d" and texts[0] == "^" and texts[1].isdigit() and texts[3:7] == ["/", "dt", "^", texts[1]]:
            return self.quotient_rate(token, texts[2], int(texts[1]), 7)
        if word == "d" and self.token().kind == "power" and texts[2:5] == ["/", "dt", texts[0]] and texts[0].isdigit():
            return self.quotient_rate(token, texts[1], int(texts[0]), 5)
        return None

    def continues(self, ahead: int) -> bool:
        """Return whether a power or a bracket follows a token."""
        after = self.token(ahead + 1)
        return after.text in ("^", "**") or after.kind == "power"

    def quotient_rate(self, token: Token, name: str, order: int, length: int) -> Node | None:
        if name in ("t", "pi") or name in self.vocabulary.symbols or token.text in self.vocabulary.symbols:
            return None
        if self.as_sympy and order == 1 and token.text != "d":
            return None  # a quotient of two names
        self.plain = True
        self.index += length
        self.timed.add(name)
        return Node("call", "diff", (Node("call", name, (TIME,)), *[TIME] * order), self.span(token.start))

    def derivative_of_next(self, token: Token) -> Node:
        self.plain = True
        self.index += 2
        operand = self.factor()
        for _, node in walk(operand):
            if node.kind == "name" and node.value not in ("t", "pi") and node.value not in self.vocabulary.symbols:
                self.timed.add(str(node.value))
        if self.peek() == "" and self.starts_factor():
            raise self.fail("brackets around the formula after d/dt")
        return Node("call", "diff", (operand, TIME), self.span(token.start))

    readers: ClassVar[dict[str, Callable[["Parser", Token], Node]]] = {
        "number": numeral, "name": name, "fraction": fraction, "(": bracket, "[": square_bracket, "|": absolute,
        "√": root,
    }  # fmt: skip
    """Kind of a token, or the mark -> the function that reads a piece that starts with it."""


def is_cross_letter(before: Token, after: Token) -> bool:
    """Return whether a letter x between two pieces may be a product of vectors, by their names."""
    pieces = [(token.kind == "name", re.split("[_0-9]", token.text)[0], token.text) for token in (before, after)]
    usual = [name and word in USUAL_VECTORS for name, word, _ in pieces]
    brackets = [text in ("(", ")", "[", "]") for _, _, text in pieces]
    return any(usual) and all(u or b for u, b in zip(usual, brackets, strict=True))

"""Parsing the smallest parts of formulas: numbers, names, calls, brackets and matrices, with indices and primes."""

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, ClassVar

from symrot.checker.arrays.index_notation import component_of_cross
from symrot.checker.arrays.quaternions import CONJUGATE
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import (
    TIME,
    Node,
    derivative,
    differentiated,
    factors_of,
    listed,
    number,
    product,
    quotient,
)
from symrot.checker.claim.vectors import direction, length
from symrot.checker.typed.cursor import ADDING, DEEPEST_NESTING, MASS
from symrot.checker.typed.densities import over_mass
from symrot.checker.typed.open_functions import OpenFunctionsPart
from symrot.checker.typed.tokens import GREEK_WORDS, SIGNS, Token
from symrot.checker.typed.words import PARTS, SINGLE_ARGUMENT

__all__ = ["PiecesPart"]

METHODS = {
    "T": ("transpose", 0), "inv": ("inverse", 0), "det": ("det", 0), "trace": ("trace", 0),
    "transpose": ("transpose", 0), "adjugate": ("adjugate", 0),
    "cross": ("cross", 1), "dot": ("dot", 1), "diff": ("diff", 8), "norm": ("norm", 0),
}  # fmt: skip
"""Method of SymPy's matrices, or their attribute T -> (function that it means, largest number of its arguments)."""

CONSTRUCTORS = {"hstack": "hstack", "eye": "eye", "diag": "diag"}
"""Name after ``Matrix.`` -> name of the function in trees."""


ELEMENTS = (MASS, "dV", "dA", "ds", "dt")
"""Names of the usual differentials in integrals: of mass, volume, area and length of a body, and of time."""

MOST_DOTS = 4
"""The highest order of a derivative that is written with primes or dots."""


class PiecesPart(OpenFunctionsPart):
    """The part of the parser for numbers, names, calls, brackets and matrices."""

    def postfix(self) -> Node:
        start = self.start()
        node = self.atom()
        first = self.index
        while True:
            token = self.token()
            if self.index - first > 5 * DEEPEST_NESTING:
                raise self.fail(f"at most {5 * DEEPEST_NESTING} methods and indices after one name (M.T[0, 1] has two)")
            if token.text == "." and token.kind == "mark":
                if self.is_vector(node) and token.spaced and self.token(1).spaced:
                    return node  # the dot of a scalar product
                self.next()
                node = self.method(node, start)
            elif token.text == "[" and token.tight and node.kind != "number" and self.is_index():
                self.next()
                node = Node("index", None, (node, *self.members("]")), self.span(start))
            elif token.kind in ("prime", "dots"):
                node = self.rate(node, self.next(), start)
            elif token.kind == "hat":
                self.plain = True
                self.next()
                if node.value in self.vocabulary.mixed:
                    node = direction(node)
            elif token.kind == "tilde" or self.is_skew_cross(node):
                self.plain = True
                self.next()
                inner = node.args[0] if node.kind == "list" else node
                node = Node("call", "skew", (inner,), self.span(start))
            elif token.text == "*" and self.is_star():
                self.plain = True
                self.next()
                node = Node("call", CONJUGATE, (node,), self.span(start))
            elif token.text == "_" and (component := self.component(node)) is not None:
                node = component
            elif token.text == "°":
                if self.tokens[self.index - 1].text == "°":
                    raise self.fail("a single degree sign")
                self.plain = True
                self.next()
                node = replace(quotient(product([node, Node("name", "pi")]), number(180)), span=self.span(start))
            else:
                return node

    def component(self, node: Node) -> Node | None:
        """Parse the index in ``(ω × r)_i`` and return this component of the cross product ``node``.

        Return None for any other node or index; the cursor then stays before the index.
        """
        index, used = self.token(1), "".join(token.text.partition("_")[2] for token in self.tokens if "_" in token.text)
        made = component_of_cross(node.args, index.text, used) if node.value == "cross" else None
        self.plain = True
        self.index += 2 * (made is not None)
        return made

    def is_star(self) -> bool:
        """Return whether the star at the cursor marks a conjugate, as in ``q v q*``, and is no product sign."""
        after, before = self.token(1), self.tokens[self.index - 1]
        # q* q': the same letter follows after a blank
        if not self.token().spaced and after.spaced and after.kind == "name" and after.text == before.text:
            return True
        if self.is_conjugate_before_factor():
            return True
        # no factor follows
        ends = after.text in (*ADDING, *SIGNS, ")", "]", ",", "⊗", "∘", "/")
        return not self.token().spaced and (
            after.kind == "end" or (ends and (after.spaced or after.text not in ADDING))
        )

    def is_conjugate_before_factor(self) -> bool:
        """Return whether the star at the cursor marks a conjugate before another factor, as in ``q* v q``."""
        if self.token().spaced or not self.token(1).spaced or self.token(1).kind != "name":
            return False
        before = self.tokens[self.index - 1]
        # elsewhere a star without a factor after it, as the first one in (p q)* = q* p*, or the same name again
        has_mark = any(
            star.text == "*" and star.tight and (after.kind == "end" or after.text in SIGNS)
            for star, after in pairwise(self.tokens)
        )
        return has_mark or (before.kind == "name" and self.token(2).text == before.text)

    def is_skew_cross(self, node: Node) -> bool:
        """Return whether a cross directly after square brackets, as in ``[n]x`` or ``[n]×``, means a skew matrix."""
        token, after = self.token(), self.token(1)
        if node.kind != "list" or len(node.args) != 1 or token.text not in ("x", "×") or token.spaced:
            return False
        return self.tokens[self.index - 1].text == "]" and (after.spaced or after.kind in ("end", "mark", "power"))

    def is_index(self) -> bool:
        """Return whether square brackets hold an index, as in ``M[0, 1]``, and not a factor, as in ``m[a^2 + b^2]``."""
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
        """Parse a matrix method after a dot, such as ``.T``, and return the tree of its value."""
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
            return replace(length(node), span=self.span(start))
        if name == "transpose":
            return Node("transpose", None, (node,), self.span(start))
        if name == "diff":
            return derivative((node, *arguments), self.span(start))
        return Node("call", name, (node, *arguments), self.span(start))

    def rate(self, node: Node, mark: Token, start: int) -> Node:
        """Return ``diff(x(t), t)`` for ``x'``, or the name ``x_prime`` in a reading with the prime as part of the name.

        ``node`` is the formula x, ``mark`` the token of the primes or dots after x.
        """
        self.plain = True
        order = int(mark.text) if mark.kind == "dots" else len(mark.text)
        if order > MOST_DOTS:
            raise self.fail(f"a time derivative of order at most {MOST_DOTS}", mark.start)
        if node.kind == "number":
            raise self.fail(
                "a unit instead of a prime after a number (deg for an angle, such as 0.5 deg; ft or in for a length)",
                mark.start,
            )
        if node.kind == "name":
            name = str(node.value)
            doubtful = mark.kind == "prime" and name not in self.vocabulary.functions
            if doubtful and self.other_reading("prime", start, start, mark.end):
                return Node("name", name + "_prime" * order, (), self.span(start))
            if name in ("t", "pi"):
                raise self.fail(f"a prime or dot only after a quantity that can depend on t, not after {name}", start)
            if name not in self.vocabulary.functions and name in self.vocabulary.symbols:
                raise self.fail(f"{name} to be declared as a function of t (in the claim's list of functions)", start)
            if [self.token(n).text for n in range(3)] == ["(", "t", ")"]:
                self.index += 3
            self.timed.add(name)
            node = Node("call", name, (TIME,), node.span)
        return replace(differentiated(node, TIME, order), span=self.span(start))

    def atom(self) -> Node:
        token = self.next()
        read = self.readers.get(token.text if token.kind == "mark" else token.kind)
        if read is None:
            raise self.fail("a number, a name or a bracket", token.start)
        return read(self, token)

    def fraction(self, token: Token) -> Node:
        self.plain = True
        if re.search("/0+$", token.text):
            raise self.fail("a divisor that is not zero", token.start)
        value = Fraction(token.text)
        return replace(quotient(*map(number, value.as_integer_ratio())), span=self.span(token.start))

    def name(self, token: Token) -> Node:
        word = token.text
        if (leibniz := self.leibniz(token)) is not None:
            return leibniz
        if self.source[token.start] == "∂":
            raise self.fail("∂ only in a derivative such as ∂f/∂x (or write diff(f, x))", token.start)
        if word == "Matrix" and self.peek() == "." and self.token(1).text in CONSTRUCTORS:
            self.index += 2
            return self.called(CONSTRUCTORS[self.tokens[self.index - 1].text], token)
        function = self.vocabulary.function(word)
        if self.as_sympy and self.peek() != "(" and word not in BUILT_IN and word not in self.vocabulary.functions:
            function = None  # a name in SymPy syntax
        elif function is None and word in SINGLE_ARGUMENT and word not in self.vocabulary.symbols:
            function = word  # a function that is not built in, which the interpreter refuses
        if word == "Rational" and self.peek() == "(":
            return self.rational(token)
        if function is None:
            return self.symbol(token)
        if self.peek() == "(" or function in self.vocabulary.functions:
            return (
                self.called(function, token) if self.peek() == "(" else Node("name", word, (), self.span(token.start))
            )
        if word not in SINGLE_ARGUMENT and not (function in PARTS and self.token().kind == "name"):
            return Node("name", word, (), self.span(token.start))
        return self.applied(function, token)

    def rational(self, token: Token) -> Node:
        call = self.called("Rational", token)
        if len(call.args) != 2:
            raise self.fail("two numbers in Rational(..)", token.start)
        above, below = call.args
        return replace(quotient(above, below), span=call.span)

    def symbol(self, token: Token) -> Node:
        """Parse a name that is not built in; return a symbol, or the call of a function with its arguments."""
        word = token.text
        inside = [self.token(n).text for n in range(1, 3)]
        if word == "S" and self.peek() == "(" and inside[0] in self.vocabulary.vectors and inside[1] == ")":
            self.note("S(..) is read as the skew matrix of a vector")
            self.plain = True
            return self.called("skew", token)
        if self.peek() == "(" and inside[1] == ")" and self.is_matrix_of(word, inside[0]):
            self.plain = True
            self.index += 3
            self.note(f"{word}({inside[0]}) is read as the name {word}")
            return Node("name", word, (), self.span(token.start))
        if self.peek() == "(" and (inside == ["t", ")"] or not self.is_factor(word)):
            return self.called(word, token)
        if self.peek() == "(":
            self.plain = True
            if self.token().tight and word not in self.vocabulary.alone and word not in self.vocabulary.vectors:
                self.note(f"{word}(..) is read as the product of {word} and the bracket")
        return Node("name", word, (), self.span(token.start))

    def is_matrix_of(self, word: str, argument: str) -> bool:
        """Return whether ``word``, R in ``R(q) v``, is a matrix that depends on the quaternion ``argument``."""
        after = self.token(3)
        is_name = re.fullmatch("[A-Z]", word) is not None and argument in ("q", "Q", "p") and argument != "t"
        return is_name and not self.as_sympy and after.kind == "name" and after.spaced

    def is_factor(self, word: str) -> bool:
        """Return whether the name ``word`` before a bracket is a factor, as m in ``m(a + b)``, and no function."""
        # the text uses the name without a bracket elsewhere
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
        # a single letter, other than f, before more than one name or number: m(a + b), but not m(a)
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
        if self.holds_skew_vector():
            inner = self.expression()
            self.expect("]")
            self.bars = bars
            return replace(listed([inner]), span=self.span(token.start))
        rows = [self.row()]
        if len(rows[0]) == 1 and self.token().text in ("x", "×") and self.token(1).text == "]":  # [n×], a skew matrix
            self.plain = True
            self.index += 2
            self.bars = bars
            return Node("call", "skew", tuple(rows[0]), self.span(token.start))
        while self.take(";"):
            self.plain = True
            rows.append(self.row())
        self.expect("]")
        self.bars = bars
        span = self.span(token.start)
        if all(len(row) == 1 for row in rows) and all(self.has_blanks(row[0]) for row in rows):
            raise self.fail("[a, b] with commas between the entries of a matrix (or [a*b] for a product)", token.start)
        members = rows[0] if len(rows) == 1 else [replace(listed(row), span=span) for row in rows]
        return replace(listed(members), span=span)

    def holds_skew_vector(self) -> bool:
        """Return whether the square bracket before the cursor is the skew matrix of a vector, ``[R ω]×``."""
        inside = [token.text for token in self.tokens[self.index :]]
        end = inside.index("]") if "]" in inside else 0
        cross = self.token(end + 1)
        return end > 0 and not {",", ";", "["} & {*inside[:end]} and cross.text == "×" and cross.tight

    def has_blanks(self, entry: Node) -> bool:
        """Return whether a matrix entry has names with only blanks between them: ``[a b]`` may have two entries."""
        pairs = pairwise(factors_of(entry))
        gaps = [self.source[a.span[1] : b.span[0]] for a, b in pairs if a.kind in ("name", "call", "number")]
        return bool(gaps) and all(gap.isspace() for gap in gaps)

    def absolute(self, token: Token) -> Node:
        self.plain = True
        self.bars += 1
        inner = self.expression()
        self.expect(token.text)
        self.bars -= 1
        if self.is_vector(inner) or token.text == "‖":
            return replace(length(inner), span=self.span(token.start))
        return Node("call", "abs", (inner,), self.span(token.start))

    def integral(self, token: Token) -> Node:
        """Parse ``∫_0^1 x dx``, or ``∫ x² dm`` and ``∫ ρ x² dV`` over a body of unknown shape; return the tree."""
        self.plain = True
        limits = self.limits() if self.take("_") else None
        outer = self.in_integral, self.element
        self.in_integral, self.element = True, self.element_ahead(limits is not None)
        inner = number(1) if self.is_element() else self.expression()
        if not self.is_element():
            raise self.fail("dm at the end of an integral over a body, or limits and dx, as in ∫_0^1 x dx")
        element = self.next().text
        self.in_integral, self.element = outer
        if limits is not None:
            variable = Node("list", ("(", ")"), (Node("name", element[1:]), *limits))
            return Node("call", "integrate", (inner, variable), self.span(token.start))
        if element == "dt":
            variable = Node("list", ("(", ")"), (TIME, Node("name", "t_initial"), Node("name", "t_final")))
            return Node("call", "integrate", (inner, variable), self.span(token.start))
        if element != MASS:
            mass = over_mass(inner)
            if mass is None:
                raise self.fail(
                    f"limits of the integral or, for an integral over a body, either dm or a density before {element}"
                )
            self.note(f"the density times {element} is read as dm")
            inner = mass
        return Node("call", "integral_over_body", (inner,), self.span(token.start))

    def limits(self) -> tuple[Node, Node]:
        """Parse the limits of an integral after its sign, as in ``∫_0^1`` or ``∫₀¹``, and return them."""
        lower = self.limit()
        if self.token().kind == "power":
            upper = self.next()
            if upper.text == "T":  # ∫₀ᵀ
                return lower, Node("name", "T", (), (upper.start, upper.end))
            if not re.fullmatch(r"[+-]?\d+", upper.text, re.ASCII):
                raise self.fail("a whole number or the name T as the superscript upper limit", upper.start)
            return lower, number(int(upper.text))
        self.expect("^")
        return lower, self.limit()

    def limit(self) -> Node:
        negative, first = self.take("-"), self.token()
        node = self.postfix()
        if first.kind == "number" and self.token().tight and self.token().text == "pi":
            node = product([node, self.postfix()])  # ∫_0^2π
        return Node("neg", None, (node,), node.span) if negative else node

    def element_ahead(self, has_limits: bool) -> str:
        """Return the differential that ends the integral at the cursor: dm, dV or, after limits, dx.

        Return dm if the integral has no differential.
        """
        depth = inner = 0
        for before, token in pairwise(self.tokens[self.index - 1 :]):
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            if depth < 0 or token.text in SIGNS:
                break
            is_short = len(token.text) > 1 and token.text.startswith("d") and token.text not in BUILT_IN
            is_element = token.kind == "name" and depth == 0 and before.text != "/" and is_short
            if is_element and inner == 0 and (has_limits or token.text in ELEMENTS):
                return token.text
            inner += (token.text == "∫") - is_element
        # there is no element
        return MASS

    readers: ClassVar[Mapping[str, Callable[[Any, Token], Node]]] = {
        "number": OpenFunctionsPart.numeral, "name": name, "fraction": fraction, "(": bracket, "[": square_bracket,
        "|": absolute, "‖": absolute, "∫": integral, "√": OpenFunctionsPart.root,
    }  # fmt: skip
    """Text of a mark such as "(", or kind of another token -> the method that parses what starts with this token."""

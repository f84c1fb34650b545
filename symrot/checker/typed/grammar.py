"""The grammar of claims: a parser by precedence, with tables for operators, functions and methods.

SymPy syntax has one meaning. A formula as people type it, such as ``sin 2x`` or ``a/b c``, may be ambiguous. The parser
records each ambiguity as a :class:`Doubt` and chooses the usual meaning, or the other one if the key of the doubt is in
its argument ``flips``.
"""

import re
from collections.abc import Sequence

from symrot.checker.arrays.quaternions import CONJUGATE, quaternion_product
from symrot.checker.claim.tree import Node, negated, number, product, sum_of
from symrot.checker.claim.vectors import beside_directions
from symrot.checker.typed.cursor import ADDING
from symrot.checker.typed.pieces import PiecesPart
from symrot.checker.typed.tokens import SIGNS, Token

__all__ = ["Parser"]

QUATERNION_SIGNS = ("⊗", "∘")
TIMES = ("*", "/", "·", "×")
BROKEN_EXPONENTS = frozenset([*(("1", n) for n in "23456789"), *((n, "2") for n in "13579"), ("2", "3"), ("4", "3")])
"""Pairs of numbers that may be a fraction as exponent: ("3", "2"), since ``x^3/2`` may mean x^(3/2).

The pair ("2", "5") is not one of them: ``r^2/5`` is always (r^2)/5.
"""


def _is_matrix_name(node: Node) -> bool:
    """Return whether a tree is a name with a capital letter in front, so that it may be a matrix."""
    return node.kind == "name" and str(node.value)[0].isupper()


def _from_matrix(factors: Sequence[Node]) -> int:
    """Return the index in ``factors`` at which the left operand of a cross product starts.

    In ``R a × b``, which means (R a) × b for a matrix R, this is the index of R; otherwise that of the last factor.
    """
    return len(factors) - (2 if len(factors) > 1 and _is_matrix_name(factors[-2]) else 1)


class Parser(PiecesPart):
    """The complete parser of claims, from chains of equals signs down to powers."""

    def whole(self) -> Node:
        node = self.expression()
        if self.token().kind != "end":
            raise self.fail("an operator or the end")
        return node

    def relation(self) -> tuple[list[str], list[Node]]:
        """Parse an equation, or a chain ``a = b = c``; return the relation signs and the sides."""
        if self.token().text == "Eq" and self.token(1).text == "(":
            self.index += 2
            sides = self.members(")")
            if len(sides) != 2:
                raise self.fail("two arguments in Eq(left, right)")
            signs = ["=="]
        else:
            sides, signs = [self.head() or self.expression()], []
            while (sign := self.peek()) in SIGNS:
                signs.append("==" if sign == "=" else sign)
                self.plain |= sign == "="
                self.next()
                sides.append(self.expression())
        if self.peek() == "," and signs:
            raise self.fail("an operator, the end, or the next claim on a line of its own")
        if self.token().kind != "end":
            raise self.fail("an operator or the end" if signs else "an operator or '=='")
        if not signs:
            raise self.fail("'==' between two sides")
        return signs, sides

    def head(self) -> Node | None:
        """Parse a left side such as ``R(φ)`` in ``R(φ) = ..``, and return the name R; None if there is none."""
        name, texts = self.token(), [token.text for token in self.tokens]
        end = texts.index(")") if ")" in texts else 0
        inside, rest = self.tokens[2:end], texts[end + 2 :]
        known = self.vocabulary.function(name.text) is not None or name.text in self.vocabulary.symbols
        if name.kind != "name" or known or texts[1:2] != ["("] or texts[end + 1 : end + 2] not in (["="], ["=="]):
            return None
        names = [token.text for token in inside if token.kind == "name"]
        plain = all(token.kind == "name" or token.text == "," for token in inside)
        # R(φ) is a name with its arguments, and no product, if the right side contains φ or is a matrix
        if self.as_sympy or not names or names == ["t"] or not plain or not (rest[0] == "[" or {*names} <= {*rest}):
            return None
        self.plain = True
        self.index = end + 1
        self.note(f"{name.text}(..) is read as the name {name.text}")
        return Node("name", name.text, (), self.span(name.start))

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
            if self.token().text in ("×", "x") and self.token(1).text == "]":
                return product(factors, self.span(start)) if len(factors) > 1 else factors[0]  # [n×]
            if mark == "×" or self.is_cross_letter():
                self.crossed(factors)
            elif mark in QUATERNION_SIGNS:
                self.plain = True
                self.next()
                factors = [quaternion_product(product(factors), self.factor())]
            elif (mark == "·" or self.is_spaced_dot()) and self.is_vector(factors[-1]):
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
                return product(beside_directions(factors), self.span(start)) if len(factors) > 1 else factors[0]

    def divisor(self, above: Node, start: int, slash: int) -> Node:
        """Parse and return the divisor after ``above`` and a slash: one factor, or a product such as ``2m`` in
        ``p^2/2m``.
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
            # without blanks, as in p^2/2m and g/ωr, the whole product divides
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

    def factor(self) -> Node:
        negative, start = False, self.start()
        while self.peek() in ADDING:
            negative ^= self.next().text == "-"
        made = self.power()
        return Node("neg", None, (made,), self.span(start)) if negative else made

    def crossed(self, factors: list[Node]) -> None:
        """Parse ``×`` and the factor b after it; put ``cross(a, b)`` in place of the last factor a in ``factors``.

        If neither a nor b is a vector, append b to ``factors``.
        """
        self.plain = True
        closed = self.tokens[self.index - 1].text == ")"
        sign = self.next()
        own = _from_matrix(factors)
        right, left = self.factor(), product(factors[own:])
        is_factor = right.kind == "name" and not self.is_vector(right)
        if is_factor and self.token().kind == "name" and self.token().text in self.vocabulary.vectors:
            right = product([right, self.factor()])  # R a x R b and r x m v
        if not self.is_vector(left) and not self.is_vector(right):
            factors.append(right)
            return
        if left.kind == "call" and left.value == "cross" and not closed:
            raise self.fail("brackets that say which of the products comes first", sign.start)
        if self.token().kind == "name" and self.token().text in self.vocabulary.vectors:
            raise self.fail("brackets around the right factor of the cross product (a further vector follows)")
        factors[own:] = [Node("call", "cross", (left, right), self.span(left.span[0]))]

    def dotted(self, factors: list[Node]) -> None:
        """Parse a dot after a vector a, and the factor b after it; put ``dot(a, b)`` in place of a in ``factors``.

        If b is not a vector, append it to ``factors``.
        """
        self.plain = True
        self.next()
        right = self.factor()
        if self.is_vector(right):
            factors[-1] = Node("call", "dot", (factors[-1], right), self.span(factors[-1].span[0]))
        else:
            factors.append(right)

    def is_spaced_dot(self) -> bool:
        """Return whether a full stop with blanks around it is the sign of a scalar product, as in ``a . b``."""
        return self.peek() == "." and self.token().spaced and self.token(1).spaced

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
        if self.take("†"):
            self.plain = True
            return Node("transpose", None, (base,), self.span(start))
        return base

    def raised(self, base: Node, token: Token, start: int) -> Node:
        """Return ``base`` with the raised ``token``: a power ``x²``, a transpose ``Rᵀ`` or an inverse ``R⁻¹``."""
        self.plain = True
        digits, transposed = token.text.removesuffix("T"), token.text.endswith("T")
        if transposed and digits in ("", "-"):
            base = Node("transpose", None, (base,), self.span(start))
            digits = "-1" if digits else ""
        if not digits:
            return base
        if not re.fullmatch(r"[+-]?\d+", digits, re.ASCII):
            raise self.fail("a whole number as a superscript exponent", token.start)
        return Node("power", None, (base, number(int(digits))), self.span(start))

    def caret(self, base: Node, start: int) -> Node:
        """Parse the exponent after ``^``; return ``x^2``, a transpose for ``R^T``, or a conjugate for ``q^*``."""
        if self.peek() == "*":
            self.next()
            return Node("call", CONJUGATE, (base,), self.span(start))
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
        while is_e and self.token().kind == "name" and self.token().tight:  # e^-kt
            if self.other_reading("exponent of e", self.start(), start, self.token().end):
                break
            exponent = product([exponent, self.power()])
        self.depth -= 1
        return Node("power", None, (base, exponent), self.span(start))

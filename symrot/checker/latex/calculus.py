"""Functions, roots, fractions, derivatives and integrals in LaTeX."""

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node, number, product, walk
from symrot.checker.latex.cursor import CLOSING, TIME
from symrot.checker.latex.names import NamesPart
from symrot.checker.latex.tokens import GREEK, Token

__all__ = ["DOTS", "FUNCTIONS", "CalculusPart"]

FUNCTIONS = {
    f"\\{command}": name
    for command, name in (
        *((name, name) for name in ("sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp")),
        *(("arcsin", "asin"), ("arccos", "acos"), ("arctan", "atan"), ("ln", "log")),
    )
    if name in BUILT_IN
}
"""Command -> function; ``\\log``, whose base differs from book to book, is refused."""

DOTS = {"\\dot": 1, "\\ddot": 2, "\\dddot": 3}


class CalculusPart(NamesPart):
    """The part of the reader for functions and calculus."""

    def trigonometric(self, token: Token) -> Node:
        power = None
        if self.take("^"):
            power = self.argument()
            if power.kind != "number":
                raise self.fail("a positive power of a sine or cosine (\\sin^{-1} may be read in two ways)", token)
        opening = self.peek()
        if opening.text in CLOSING:
            self.next()
            argument = self.bracket(opening)
        else:
            argument = self.loose_argument(token)
        node = Node("call", FUNCTIONS[token.text], (argument,))
        return node if power is None else Node("power", None, (node, power))

    def loose_argument(self, function: Token) -> Node:
        """Read ``2\\theta``, ``\\omega t`` or ``\\frac{\\theta}{2}`` after a sine; refuse an ambiguous argument."""
        factors = [self.factor()] if not self.at("-") else []
        if not factors or factors[0].kind == "power":
            raise self.fail(f"brackets around the argument of {function.text}")
        if factors[0].kind == "number" or (factors[0].kind == "product" and not any(
            piece.kind in ("name", "call") for _, piece in walk(factors[0]))):  # fmt: skip
            if not self.starts_factor():
                return factors[0]
            factors.append(self.factor())
        if self.at("t") and not self.peek().spaced and self.peek(1).text not in ("^", "_"):
            factors.append(self.factor())
        follower = self.peek()
        ambiguous = follower.kind == "letter" or follower.text[1:] in GREEK or follower.text in (
            "\\frac", "\\sqrt", "(", "[", "\\pi", "/")  # fmt: skip
        free = follower.spaced or (self.integrals and self.differential())
        if follower.text == "/" or (ambiguous and not free):
            raise self.fail(f"brackets around the argument of {function.text}", follower)
        return product(factors)

    def root(self, token: Token) -> Node:
        index = None
        if self.take("["):
            index = self.expression()
            self.expect("]")
        inner = self.argument()
        if index is None:
            return Node("call", "sqrt", (inner,))
        return Node("power", None, (inner, product([number(1), Node("inv", None, (index,))])))

    def fraction(self, token: Token) -> Node:
        derivative = self.derivative_fraction(token)
        if derivative is not None:
            return derivative
        digits = self.peek()
        if digits.kind == "number" and len(digits.text) == 2 and digits.text.isdigit():  # \frac12
            self.next()
            return product([number(int(digits.text[0])), Node("inv", None, (number(int(digits.text[1])),))])
        above, below = self.argument(), self.argument()
        return product([above, Node("inv", None, (below,))])

    def is_d(self, ahead: int = 0) -> int:
        """Return the number of tokens of the d, \\partial, \\mathrm{d} or \\mathrm d at the cursor, or 0."""
        texts = [self.peek(ahead + n).text for n in range(4)]
        if texts[0] in ("d", "\\partial"):
            return 1
        if texts[0] == "\\mathrm":
            return 4 if texts[1:] == ["{", "d", "}"] else 2 if texts[1] == "d" else 0
        return 0

    def differential(self) -> bool:
        """Return whether a ``dx`` is at the cursor."""
        length = self.is_d()
        token = self.peek(length)
        return bool(length) and (token.kind == "letter" or token.text[1:] in GREEK)

    def derivative_fraction(self, token: Token) -> Node | None:
        """Read ``\\frac{d^n X}{d x^n}`` or ``\\frac{d}{dx} X``; None for any other fraction."""
        start = self.index
        if not self.take("{") or not self.is_d():
            self.index = start
            return None
        self.index += self.is_d()
        order = self.order()
        operand = None if self.at("}") else self.expression()
        self.expect("}")
        if not (self.at("{") and self.is_d(1)):
            self.index = start
            return None
        if "d" in self.names:
            raise self.fail("another name for the symbol d, since d means a derivative here", token)
        self.next()
        variables: list[Node] = []
        while not self.at("}"):
            if not self.is_d():
                raise self.fail("d or \\partial before each variable")
            self.index += self.is_d()
            variable = self.base()
            variables += [variable] * self.order()
        self.expect("}")
        if len(variables) != order:
            raise self.fail(f"a derivative of order {order} both above and below the line", token)
        if operand is None:
            operand = self.factor()
            if self.starts_factor() or self.at("/"):
                raise self.fail("brackets around the formula to differentiate")
        for variable in variables:
            in_time = variable == TIME
            operand = self.derivative(operand, 1, token) if in_time else _appended(operand, variable)
        return operand

    def order(self) -> int:
        if not self.take("^"):
            return 1
        node = self.argument()
        if node.kind != "number" or node.value.denominator != 1 or not 1 <= node.value <= 4:
            raise self.fail("the order of a derivative, 1 to 4")
        return int(node.value)

    def dotted(self, token: Token) -> Node:
        start = self.peek()
        node = self.argument() if self.at("{") else self.base(script=False)
        if node.kind == "name" and self.at("_", "'"):
            node = self.named(str(node.value), start)
        derivative = self.derivative(node, DOTS[token.text], token)
        if self.called_with_time() and node.kind == "name":
            self.index += 3
        return derivative

    def derivative(self, node: Node, times: int, token: Token) -> Node:
        """Return a time derivative; an undeclared name becomes a function of time."""
        if node.kind == "name" and node.value not in (*self.names.functions, *self.names.matrices, *self.names.others):
            name = str(node.value)
            forms = ["d" * times + name, name + "dot", name + "d" * times]
            declared = [form for form in forms if form in self.names.symbols] if times == 1 else forms[:0]
            if declared:
                return Node("name", declared[0])
            if not self.names.implied:
                raise self.fail(f"a function of time, since {name} is differentiated,", token)
            self.timed.add(name)
        for _ in range(times):
            node = _appended(node, TIME)
        return node

    def integral(self, token: Token) -> Node:
        limits = []
        self.index -= 1
        while self.take("\\int"):
            self.expect("_")
            lower = self.argument()
            self.expect("^")
            limits.append((lower, self.argument()))
        self.integrals += 1
        integrand = number(1) if self.differential() else self.expression()
        self.integrals -= 1
        ranges = []
        for lower, upper in reversed(limits):
            if not self.differential():
                raise self.fail("dx, the variable of the integral")
            self.index += self.is_d()
            ranges.append(Node("list", ("(", ")"), (self.base(), lower, upper)))
        return Node("call", "integrate", (integrand, *ranges))


def _appended(node: Node, variable: Node) -> Node:
    """Return the derivative of a tree with respect to one more variable."""
    if node.kind == "call" and node.value == "diff" and node.args[-1] == variable == TIME:
        return Node("call", "diff", (*node.args, variable))
    return Node("call", "diff", (node, variable))

"""Parsing functions without brackets, ``sin 2x`` and ``√x``, and derivatives as quotients, ``dx/dt``.

An argument ``place`` is the index of a token, counted from the cursor.
"""

import re
from dataclasses import replace

from symrot.checker.claim.tree import (
    MOST_DERIVATIVES,
    TIME,
    Node,
    differentiated,
    negated,
    nodes_of,
    number,
    product,
    untimed,
)
from symrot.checker.typed.cursor import ADDING, FACTOR_MARKS, Cursor
from symrot.checker.typed.defined_functions import DEFINED, DISPUTED, INVERSES, instead
from symrot.checker.typed.tokens import Token
from symrot.checker.typed.words import SINGLE_ARGUMENT

__all__ = ["OpenFunctionsPart"]


class OpenFunctionsPart(Cursor):
    """The part of the parser for functions without brackets, and for derivatives written as quotients."""

    def applied(self, function: str, token: Token) -> Node:
        """Parse what follows a function's name in ``sin 2x``, ``sin^2 x`` or ``tan^-1 x``; return the call or power."""
        exponent = self.function_exponent(token)
        inverse = exponent == number(-1)
        if inverse and function in DISPUTED:
            raise self.fail(instead(function), token.start)
        inverse = inverse and function in INVERSES
        if inverse and not self.other_reading("inverse", token.start, token.start, self.end_of_run()):
            function, exponent = INVERSES[function], None
        if self.peek() == "(":
            call = self.called(function, token)
        else:
            call, exponent = self.open_call(function, token, exponent)
        if exponent is None:
            return call
        return Node("power", None, (call, exponent), self.span(token.start))

    def function_exponent(self, token: Token) -> Node | None:
        """Parse the exponent between a function and its argument, 2 in ``sin^2 x``; return None if there is none."""
        if self.token().kind == "power":
            raised = self.next()
            self.plain = True
            if not re.fullmatch(r"[+-]?\d+", raised.text, re.ASCII):
                raise self.fail("a whole number as the exponent of a function, as in sin²(x)", raised.start)
            return number(int(raised.text))
        if self.peek() not in ("^", "**"):
            return None
        self.plain = True
        self.next()
        bracket = self.take("(")
        negative = self.take("-")
        digits = self.next()
        if digits.kind != "number":
            raise self.fail(f"a number as the exponent of {token.text}, as in {token.text}^2 x", digits.start)
        if bracket:
            self.expect(")")
        value = self.numeral(digits)
        return Node("neg", None, (value,), value.span) if negative else value

    def open_call(self, function: str, token: Token, exponent: Node | None) -> tuple[Node, Node | None]:
        """Parse a function's argument without brackets, as in ``sin 2x``; return (call sin(2*x), its exponent or None).

        ``exponent`` is the exponent that was read before the argument, 2 in ``sin^2 x``. If ``sin x^2`` is read as
        (sin x)^2, the exponent returned is that 2, times ``exponent`` if there is one.
        """
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
        defined = DEFINED.get(function)
        call = defined(argument) if defined else Node("call", function, (argument,), self.span(token.start))
        if power is not None:
            # sin x^2 as (sin x)^2 gives the call sin(x) and the exponent 2
            exponent = power if exponent is None else product([exponent, power])
        return call, exponent

    def argument_factor(self, token: Token) -> Node:
        if self.peek() in ADDING:
            raise self.fail(f"brackets around the argument of {token.text}")
        return self.power()

    def power_of_call(self, token: Token, factors: list[Node]) -> Node | None:
        """Return the exponent 2 of ``sin x^2`` if it is read as (sin x)^2, the less usual meaning; else None."""
        last = factors[-1]
        if last.kind != "power" or last.args[0].kind not in ("name", "call"):
            return None
        if not self.other_reading("power of argument", last.span[0], token.start, last.span[1]):
            return None
        # the exponent is removed from the argument
        factors[-1] = last.args[0]
        return last.args[1]

    def absorbs(self, function: Token, factors: list[Node]) -> bool:
        """Return whether the factor at the cursor belongs to the argument of ``function``, as x in ``sin 2 x`` does."""
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
        only_numbers = not any(node.kind in ("name", "call") for node in nodes_of(*factors))
        if self.token(1).kind in ("prime", "dots") and not only_numbers:
            return False  # sin θ φ'
        usual = only_numbers or (token.text == "t" and TIME not in factors)
        return self.other_reading("argument", token.start, function.start, self.end_of_run()) != usual

    def slash_belongs(self, function: Token, factors: list[Node]) -> bool:
        """Return whether the slash of ``sin x/2`` divides the argument: True for sin(x/2), False for (sin x)/2."""
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
        """Parse the formula after a root sign √ without a bar, and return its square root."""
        self.plain = True
        self.deeper()
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
        self.depth -= 1
        return Node("call", "sqrt", (product(inside, self.span(first.start)),), self.span(token.start))

    def leibniz(self, token: Token) -> Node | None:
        """Parse a derivative that starts with ``token``, as d, dx or dy, and return it; None for any other text.

        The forms are ``dx/dt``, ``d²x/dt²``, ``d/dt x``, ``dy/dx``, ``d/dx (..)`` and ``d(..)/dx``.
        """
        if not token.text.startswith("d") or token.text in self.vocabulary.symbols:
            return None
        if (
            token.text == "d"
            and self.peek() == "("
            and not self.as_sympy
            and (end := self.end_of_bracket()) is not None
        ):
            return self.derivative_of_bracket(token, end)
        name, order, place = self.differentiated_name(token)
        slash, (variable, place) = self.token(place).text, self.differential(place + 1)
        if slash != "/" or not variable or name == variable:
            return None
        if variable == "t":
            below, place = self.order_at(place)
            return self.derivative_by_time(token, name, order, place) if order == below else None
        mark = self.token(place)
        order_of_rate = int(mark.text) if mark.kind == "dots" else len(mark.text) if mark.kind == "prime" else 0
        below, place = self.order_at(place + bool(order_of_rate))
        if order != below or self.as_sympy:
            return None
        by = Node("name", variable)
        if order_of_rate:  # ∂T/∂θ'
            by = self.derived(token, Node("call", variable, (TIME,)), TIME, order_of_rate)
        return self.derivative_by(token, name, by, order, place)

    def differentiated_name(self, token: Token) -> tuple[str, int, int]:
        """Return (name, order, next place) for the part of a derivative above the slash, which starts with ``token``.

        The next place is the place of the first token after this part, counted from 0 at the cursor; the cursor is
        directly after ``token``. For ``dx/dt`` the result is ("x", 1, 0), for ``d²x/dt²`` ("x", 2, 2), and for
        ``d²/dt² x`` ("", 2, 1). Raise InputError for ``dx²/dt²``, which may be meant as ``d²x/dt²`` or as a square.
        """
        order, place = self.order_at(0)
        if token.text != "d":
            if order > 1 and self.token(place).text == "/" and self.differential(place + 1)[0]:
                raise self.fail(f"d²{token.text[1:]}/.. for a second derivative, or brackets for a square, (..)²")
            return token.text[1:], 1, 0
        own = self.token(place)
        is_differentiated = own.kind == "name" and (own.tight or order != 1)
        return (own.text, order, place + 1) if is_differentiated else ("", order, place)

    def derived(self, token: Token, operand: Node, variable: Node, order: int) -> Node:
        """Return the derivative of ``operand`` with respect to ``variable``, of the given order.

        ``token`` is the first token of the typed derivative. Raise InputError for an order below 1 or above
        ``MOST_DERIVATIVES``.
        """
        if not 1 <= order <= MOST_DERIVATIVES:
            raise self.fail(f"a derivative of order 1 to {MOST_DERIVATIVES}", token.start)
        self.plain = True
        return replace(differentiated(operand, variable, order), span=self.span(token.start))

    def derivative_by_time(self, token: Token, name: str, order: int, length: int) -> Node | None:
        """Return the time derivative of the function ``name``, or of the factor after ``d/dt`` if ``name`` is empty.

        ``token`` is the first token of ``dx/dt`` or ``d/dt``, and ``length`` the number of its further tokens. Return
        None if the name is t, pi or a declared symbol. Also return None for ``dx/dt`` and ``d**2/dt**2`` if the parser
        reads SymPy syntax (``as_sympy``), where they are quotients of names and powers.
        """
        is_quotient = self.as_sympy and (token.text != "d" if name else order > 1)
        if is_quotient or name in ("t", "pi") or name in self.vocabulary.symbols:
            return None
        self.index += length
        if name:
            self.timed.add(name)
            return self.derived(token, Node("call", name, (TIME,)), TIME, order)
        operand = self.operand_after("t")
        self.varies(operand)
        return self.derived(token, operand, TIME, order)

    def derivative_by(self, token: Token, name: str, variable: Node, order: int, length: int) -> Node | None:
        """Return the derivative of ``name``, or of the factor after ``d/dx`` if ``name`` is empty.

        It is the derivative with respect to ``variable``, a symbol x or a rate x'. ``token`` is the first token of
        ``dy/dx`` or ``d/dx``, and ``length`` the number of its further tokens. Return None if ``name`` is empty and no
        name, bracket, bar or root follows.
        """
        after = self.token(length)
        if not name and not (after.text in ("(", "|", "√") or after.kind == "name"):
            return None
        self.index += length
        letter = str(untimed(variable.args[0] if variable.args else variable).value)
        if variable.args:
            self.timed.add(letter)
        return self.derived(token, Node("name", name) if name else self.operand_after(letter), variable, order)

    def operand_after(self, variable: str) -> Node:
        """Parse the factor after ``d/dx`` and return it; ``variable`` is x."""
        self.plain = True
        self.deeper()
        operand = self.factor()
        self.depth -= 1
        if self.peek() == "" and self.starts_factor():
            raise self.fail(f"brackets around the formula after d/d{variable}, as in d/d{variable} (a*b)")
        return operand

    def end_of_bracket(self) -> int | None:
        """Return the number of tokens of the bracket at the cursor if ``/dx`` follows it, as in ``(x^2)/dx``; otherwise
        None.
        """
        depth, place = 0, 0
        while self.token(place).kind != "end":
            depth += (self.token(place).text == "(") - (self.token(place).text == ")")
            place += 1
            if depth == 0:
                return place if self.token(place).text == "/" and self.differential(place + 1)[0] else None
        return None

    def derivative_of_bracket(self, token: Token, end: int) -> Node:
        """Parse ``(x^2)/dx`` after the d of ``d(x^2)/dx``, which is ``token``; return the derivative.

        ``end`` is the number of tokens in the bracket.
        """
        variable, after = self.differential(end + 1)
        self.deeper()
        operand = self.factor()
        self.depth -= 1
        self.index += after - end
        if variable == "t":
            self.varies(operand)
        return self.derived(token, operand, Node("name", variable), 1)

    def order_at(self, place: int) -> tuple[int, int]:
        """Return (order, next place) of a derivative: order 2 if ``^2`` or ² is at ``place``, 1 without an exponent."""
        length = 2 if self.token(place).text in ("^", "**") else 1 if self.token(place).kind == "power" else 0
        digits = self.token(place + length - 1).text
        if not length or not digits.isdigit():
            return 1, place
        return int(digits), place + length

    def tight_name(self, place: int) -> tuple[str, int]:
        """Return (name, next place) for the name at ``place``; ("", place) if none is there, or a blank before it."""
        token = self.token(place)
        return (token.text, place + 1) if token.kind == "name" and token.tight else ("", place)

    def differential(self, place: int) -> tuple[str, int]:
        """Return ("x", next place) if the differential ``dx`` is at ``place``; for other tokens, the text is empty."""
        token = self.token(place)
        if token.kind != "name" or not token.text.startswith("d"):
            return "", place
        return (token.text[1:], place + 1) if token.text != "d" else self.tight_name(place + 1)

    def varies(self, operand: Node) -> None:
        """Record that the names in ``operand``, a formula after d/dt, may be functions of time."""
        for node in nodes_of(operand):
            is_open = node.kind == "name" and node.value not in ("t", "pi", *self.vocabulary.symbols)
            if is_open or (node.kind == "call" and node.args == (TIME,)):
                self.differentiated.add(str(node.value))

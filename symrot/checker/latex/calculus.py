"""Parsing functions, roots, fractions, derivatives and integrals in LaTeX."""

from dataclasses import replace
from itertools import takewhile

from symrot.checker.claim.tree import TIME, Node, differentiated, negated, nodes_of, number, product, quotient
from symrot.checker.latex.cursor import CLOSING, is_d, is_letter
from symrot.checker.latex.names import NamesPart
from symrot.checker.latex.sums import FUNCTIONS
from symrot.checker.typed.defined_functions import DEFINED, DISPUTED, INVERSES, instead
from symrot.checker.typed.densities import over_mass
from symrot.latex import tree

__all__ = ["DOTS", "CalculusPart"]

DOTS = {"\\dot": 1, "\\ddot": 2, "\\dddot": 3}


class CalculusPart(NamesPart):
    """The methods of the LaTeX reader that parse functions, roots, fractions, derivatives and integrals."""

    def trigonometric(self, function: tree.Node) -> Node:
        power = None
        name = FUNCTIONS[function.text]
        if raised := self.script("^"):
            power = self.argument(raised.inside)
            sure = "a positive power of a sine or cosine (\\sin^{-1} may be read in two ways)"
            is_inverse = power == negated(number(1))
            if is_inverse and name in DISPUTED:
                raise self.fail(instead(name), function)
            if is_inverse and name in INVERSES and not self.doubtful("inverse", function, self.end_of_next(), sure):
                name, power = INVERSES[name], None
            elif power is not None and power.kind != "number" and (self.flips is None or power.kind != "neg"):
                raise self.fail(sure, function)
        opening = self.peek()
        if opening.text in CLOSING or opening.kind == "row":
            argument = self.bracket(self.next())
        else:
            argument, own = self.loose_argument(function)
            power = own if power is None else power if own is None else product([power, own])
        node = DEFINED[name](argument) if name in DEFINED else Node("call", name, (argument,))
        return node if power is None else Node("power", None, (node, power))

    def spelled(self, font: tree.Font) -> Node:
        r"""Parse a word in upright letters; return a name, or a function with its argument, ``\mathrm{sin}^2 x``."""
        letters = font.inside.items if isinstance(font.inside, tree.Row) else (font.inside,)
        command = f"\\{''.join(letter.text for letter in letters)}"
        return self.trigonometric(replace(font, text=command)) if command in FUNCTIONS else super().spelled(font)

    def loose_argument(self, function: tree.Node) -> tuple[Node, Node | None]:
        r"""Parse an argument without brackets, ``2\theta``; return (argument, power).

        The power is that of the whole function: 2 if ``\sin\theta^2`` is read as (sin theta)^2, otherwise None.
        """
        expected = f"brackets around the argument of {function.text}"
        if self.at("-") and self.flips is None:
            raise self.fail(expected)
        negative = self.take("-")
        factors, power = [self.factor()], None
        is_power = factors[0].kind == "power"
        if is_power and self.doubtful("power of argument", function, self.peek().start, expected):
            factors, power = [factors[0].args[0]], factors[0].args[1]
        only_number = factors[0].kind == "number" or (factors[0].kind == "product" and not any(
            piece.kind in ("name", "call") for piece in nodes_of(factors[0])))  # fmt: skip
        if power is None and not (only_number and not self.starts_factor()):
            factors += self.further_factors(function, expected, only_number)
        argument = product(factors)
        return (negated(argument) if negative else argument), power

    def further_factors(self, function: tree.Node, expected: str, required: bool) -> list[Node]:
        r"""Parse and return the factors after the first one in an argument without brackets: t in ``\sin\omega t``.

        ``expected`` are words for an error message.
        """
        # after a number alone, one more factor is required
        factors = [self.factor()] if required else []
        first = self.items[self.index - 1]
        if self.at("t") and not self.is_spaced() and self.peek(1).text not in ("^", "_"):
            factors.append(self.factor())
        follower = self.peek()
        free = self.is_spaced() or (self.integrals and self.differential())
        if follower.text == "[" and self.holds_skew_matrix():
            return factors
        if follower.text == "/":
            below = self.peek(1)
            if below.text in FUNCTIONS:
                return factors  # \sin\phi/\cos\theta
            usual = below.kind == "number"  # \cos\theta/2
            if self.doubtful("slash after argument", function, below.start + 1, expected, follower) != usual:
                self.next()
                factors.append(Node("inv", None, (self.factor(),)))
            return factors
        letters = is_letter(follower) or follower.text == "\\pi"
        if not free and (letters or follower.text in ("\\frac", "\\sqrt", "(", "[")):
            tight = first.kind == "letter" and first.start + 1 == follower.start and letters  # \cos kx
            if self.doubtful("argument", function, self.end_of_next(), expected, follower) != tight:
                factors.append(self.factor())
        return factors

    def holds_skew_matrix(self) -> bool:
        r"""Return whether the square bracket at the cursor is the skew matrix of a vector, ``[a\times]``."""
        end = next((n for n, item in enumerate(self.items[self.index :]) if item.text == "]"), 0)
        mark = self.peek(end + 1)
        crossed = isinstance(mark, tree.Script) and tree.alone(mark.inside).text in ("\\times", "×")
        return end > 0 and (crossed or self.peek(end - 1).text in ("\\times", "×"))

    def is_spaced(self) -> bool:
        r"""Return whether a LaTeX command for a space, such as ``\,``, is directly before the cursor."""
        return self.peek().start in self.after_space

    def root(self, root: tree.Root) -> Node:
        index = None if root.index is None else self.inside(root.index, self.expression, "']'")
        inner = self.argument(root.inside)
        if index is None:
            return Node("call", "sqrt", (inner,))
        return Node("power", None, (inner, quotient(number(1), index)))

    def fraction(self, fraction: tree.Fraction) -> Node:
        sides = above, below = fraction.above, fraction.below
        if all(isinstance(side, tree.Row) and side.items and is_d(side.items[0]) for side in sides):
            return self.derivative_fraction(fraction)
        if above.kind == below.kind == "number" and above.start + 1 == below.start and not self.is_cut(below):
            return quotient(number(int(above.text)), number(int(below.text)))  # \frac12
        return quotient(self.argument(above), self.argument(below))

    def leibniz(self) -> Node | None:
        r"""Parse and return a time derivative with a slash, such as ``d\mathbf L/dt``; return None if there is none."""
        texts = [item.text for item in self.items[self.index : self.index + 8]]
        slash = texts.index("/") if "/" in texts else 0
        below = self.index + slash + 1
        if not is_d(self.peek()) or slash < 2 or not is_d(self.peek(slash + 1)) or self.items[below + 1].text != "t":
            return None
        item = self.next()
        order = self.order()
        operand = self.base(self.next())
        if not self.take("/"):
            raise self.fail("one name between d and /dt, or \\frac{d}{dt}(..)")
        self.index += 2
        if self.order() != order:
            raise self.fail(f"the same order of the derivative above and below the slash ({order})", item)
        return self.derivative(operand, order, item)

    def derivative_fraction(self, fraction: tree.Fraction) -> Node:
        r"""Parse a derivative written as a fraction, ``\frac{d^n X}{d x^n}`` or ``\frac{d}{dx} X``; return its tree."""
        order, operand = self.inside(fraction.above, self.differentiated)
        if "d" in self.names:
            raise self.fail("another name for the symbol d, since d means a derivative here", fraction)
        variables = self.inside(fraction.below, self.variables)
        if len(variables) != order:
            raise self.fail(f"the same order of the derivative above and below the line ({order})", fraction)
        if operand is None:
            operand = self.factor()
            if self.starts_factor() or self.at("/"):
                raise self.fail("brackets around the formula to differentiate")
        for variable in variables:
            in_time = variable == TIME
            operand = self.derivative(operand, 1, fraction) if in_time else differentiated(operand, variable)
        return operand

    def differentiated(self) -> tuple[int, Node | None]:
        r"""Parse ``d^n X``, the numerator of a derivative; return n and X.

        X is None if it follows the fraction, as in ``\frac{d}{dt} X``.
        """
        self.next()
        order = self.order()
        return order, None if self.peek().kind == "end" else self.expression()

    def variables(self) -> list[Node]:
        """Parse the denominator of a derivative, such as ``dx^2 dy``; return its variables, here x, x and y."""
        variables: list[Node] = []
        while self.peek().kind != "end":
            if not is_d(self.next()):
                self.index -= 1
                raise self.fail("d or \\partial before each variable")
            variable = self.base(self.next())
            variables += [variable] * self.order()
        return variables

    def order(self) -> int:
        raised = self.script("^")
        if raised is None:
            return 1
        node = self.argument(raised.inside)
        if node.kind != "number" or node.value.denominator != 1 or not 1 <= node.value <= 4:
            raise self.fail("the order of a derivative, 1 to 4")
        return int(node.value)

    def dotted(self, dot: tree.Accent) -> Node:
        if isinstance(dot.inside, tree.Row) and len(dot.inside.items) > 1 and self.at("_", "'"):
            raise self.fail(f"one symbol under {dot.text}")
        node = self.under(dot, self.expression)
        derivative = self.derivative(node, DOTS[dot.text], dot)
        if self.called_with_time() and node.kind == "name":
            self.index += 3
        return derivative

    def over_body(self) -> Node:
        r"""Parse the rest of ``\int x^2\,dm``, an integral over a body of unknown shape; return the integral's tree.

        The integral over time ``\int M\,dt`` without limits gets the limits t_initial and t_final.
        """
        self.script("_")
        self.integrals += 1
        integrand = number(1) if self.differential() else self.expression()
        self.integrals -= 1
        if self.differential() and self.peek(1).text == "t":
            self.index += 2
            limits = Node("name", "t_initial"), Node("name", "t_final")
            return Node("call", "integrate", (integrand, Node("list", ("(", ")"), (TIME, *limits))))
        if self.differential() and self.peek(1).text in ("V", "A", "s") and (mass := over_mass(integrand)) is not None:
            self.notes.append(f"the density times d{self.peek(1).text} is read as dm")
            integrand = mass
        elif not self.differential() or self.peek(1).text != "m":
            raise self.fail("limits as in \\int_a^b; or, for an integral over a body, dm or a density and dV")
        self.index += 2
        return Node("call", "integral_over_body", (integrand,))

    def integral(self, sign: tree.Node) -> Node:
        if not self.has_limits():
            while self.take("\\int"):
                pass  # \\iiint_V
            return self.over_body()
        limits = [(self.limit("_"), self.limit("^"))]
        while self.take("\\int"):
            limits.append((self.limit("_"), self.limit("^")))
        self.integrals += 1
        integrand = number(1) if self.differential() else self.expression()
        self.integrals -= 1
        ranges = []
        for lower, upper in reversed(limits):
            if not self.differential():
                raise self.fail("dx, the variable of the integral")
            self.next()
            ranges.append(Node("list", ("(", ")"), (self.base(self.next()), lower, upper)))
        return Node("call", "integrate", (integrand, *ranges))

    def has_limits(self) -> bool:
        """Return whether limits follow an integral sign, and not the name of a body below the sign."""
        lower = self.peek()
        marks = {item.text for item in takewhile(lambda item: isinstance(item, tree.Script), self.items[self.index :])}
        is_body = isinstance(lower, tree.Script) and tree.alone(lower.inside).text in ("V", "B", "m", "M", "\\mathcal")
        return bool(marks) and not (is_body and "^" not in marks)

    def limit(self, mark: str) -> Node:
        limit = self.script(mark)
        if limit is None:
            raise self.fail(f"'{mark}'")
        return self.argument(limit.inside)

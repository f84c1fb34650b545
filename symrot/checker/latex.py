"""Reads an equation in LaTeX into the tree of claims: every token is used or refused with its place.

Where usage is not unique (``\\sin\\theta/2``, ``\\sin^{-1}``, ``a/bc``, ``x_12``, ``a \\times b \\times c``) the reader
asks for brackets and does not choose. What was understood is shown as the text of the claim.
"""

from collections.abc import Collection
from dataclasses import dataclass, field
from fractions import Fraction

from symrot.checker.latex_tokens import GREEK, Token, tokens
from symrot.checker.meaning import BUILT_IN
from symrot.checker.reader import DEEPEST_NESTING, Relation, complaint, read_relation
from symrot.checker.tree import Node, negated, number, product, sum_of, text, walk
from symrot.errors import InputError

__all__ = ["Names", "Reading", "read_latex"]

FUNCTIONS = {f"\\{name}": name for name in ("sin", "cos", "tan", "cot", "sec", "csc")}
OPERATORS = {"\\det": "det", "\\tr": "trace", "\\diag": "diag"}
SPELLED = {"tr": "trace", "trace": "trace", "Tr": "trace"} | {name: name for name in BUILT_IN}
MATRICES = {"matrix": "", "pmatrix": "", "bmatrix": "", "Bmatrix": "", "smallmatrix": "", "array": "", "vmatrix": "det"}
CLOSING = {"(": ")", "[": "]", "\\{": "\\}", "{": "}"}
VECTOR_MARKS = ("\\vec", "\\mathbf", "\\hat", "\\overrightarrow", "\\underline")
NAME_MARKS = {"\\bar": "_bar", "\\tilde": "_tilde", "\\overline": "_bar", "\\widetilde": "_tilde"}
DOTS = {"\\dot": 1, "\\ddot": 2, "\\dddot": 3}
MATRIX_CALLS = ("Matrix", "cross", "skew", "vee", "Rx", "Ry", "Rz", "inverse", "transpose", "eye", "diag", "qmul",
                "dcm_of", "hstack")  # fmt: skip
ENDS = ("+", "-", "=", ")", "]", "\\}", "}", "&", "\\\\", ",", "\\end", "\\cdot", "\\times", "*", "/", "^", "_", "'")
"""What cannot start a factor."""

TIME = Node("name", "t")


@dataclass(frozen=True)
class Names:
    """What is declared: symbols, functions of time, definitions that are matrices or columns, other definitions.

    With ``implied`` nothing needs to be declared.
    """

    symbols: Collection[str] = ()
    functions: Collection[str] = ()
    matrices: Collection[str] = ()
    columns: Collection[str] = ()
    others: Collection[str] = ()
    implied: bool = True

    def __contains__(self, name: str) -> bool:
        return name in {*self.symbols, *self.functions, *self.matrices, *self.others}


@dataclass(frozen=True)
class Reading:
    """The equation, and its text in the language of claims."""

    relation: Relation
    text: str


def read_latex(source: str, where: str = "", names: Names | None = None) -> Reading:
    """Return the equation that a LaTeX text states.

    Parameters
    ----------
    source : str
        One equation, with or without ``$`` around it.
    where : str
        Its place, for complaints.
    names : Names, optional
        What is declared; by default every name is a real symbol, or a function of time if it is differentiated or
        written ``f(t)``.

    Raises
    ------
    InputError
        With the position of the first token that is not understood.

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
    shown = " == ".join(text(_timed(side, reader.timed)) for side in (left, right))
    return Reading(read_relation(shown, where), shown)


def _timed(node: Node, names: Collection[str]) -> Node:
    """Return a tree in which the names that depend on time are written ``f(t)``."""
    if node.kind == "name" and node.value in names:
        return Node("call", node.value, (TIME,))
    if node.kind == "call" and node.value in names:
        return node
    return Node(node.kind, node.value, tuple(_timed(child, names) for child in node.args), node.span)


@dataclass
class _Reader:
    source: str
    where: str
    names: Names
    timed: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        if not isinstance(self.source, str) or not self.source.strip():
            raise InputError(f"{self.where + ': ' if self.where else ''}expected LaTeX of an equation, got empty text")
        self.tokens = tokens(self.source, self.where)
        self.index = self.depth = self.integrals = 0
        self.timed.update(self.names.functions)

    # -- tokens -----------------------------------------------------------------------------------------------------

    def peek(self, ahead: int = 0) -> Token:
        return self.tokens[min(self.index + ahead, len(self.tokens) - 1)]

    def at(self, *texts: str) -> bool:
        return self.peek().text in texts

    def next(self) -> Token:
        token = self.peek()
        self.index += token.kind != "end"
        return token

    def take(self, text: str) -> bool:
        found = self.at(text)
        self.index += found
        return found

    def expect(self, text: str) -> None:
        if not self.take(text):
            raise self.fail(f"'{text}'")

    def fail(self, expected: str, token: Token | None = None) -> InputError:
        return complaint(self.source, self.where, (token or self.peek()).position, expected)

    # -- sums and products ------------------------------------------------------------------------------------------

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
                raise self.fail("two vectors or two scalars beside \\times", operator)
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
                    raise self.fail("brackets around what is divided", token)
                if factors[-1].kind == "call" and factors[-1].value in FUNCTIONS.values():
                    raise self.fail("brackets, since the slash may belong to the argument", token)
                factors.append(Node("inv", None, (self.factor(),)))
                simple = len(factors) == 2 and all(f.kind == "number" for f in (factors[0], factors[1].args[0]))
                divided = None if simple else token
            elif not self.starts_factor():
                return product(factors)
            elif divided:
                raise self.fail("brackets, since it is not clear what stands under the slash", divided)
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

    # -- factors ----------------------------------------------------------------------------------------------------

    open_bars: tuple[str, ...] = ()

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
        """Read what stands after ``^``: a transpose or an exponent."""
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
        self.index = start
        return Node("power", None, (node, self.argument()))

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
        return inner

    def bars(self, token: Token) -> Node:
        outside = self.open_bars
        self.open_bars = (*outside, token.text)
        inner = self.expression()
        self.open_bars = outside
        self.expect(token.text)
        if token.text == "\\|" or self.is_column(inner):
            return Node("call", "sqrt", (Node("call", "dot", (inner, inner)),))
        return Node("call", "det" if self.is_matrix(inner) else "abs", (inner,))

    # -- names ------------------------------------------------------------------------------------------------------

    def named(self, name: str, token: Token, script: bool = True) -> Node:
        """Read the rest of a name, its subscript, primes and ``(t)``; return its node."""
        primes = 0
        subscript = ""
        while script and self.at("_", "'"):
            if self.take("'"):
                primes += 1
            elif subscript:
                raise self.fail("one subscript")
            else:
                self.next()
                subscript = self.subscript()
        if script and self.at("^") and self.primes_raised():
            primes += self.primes_raised()
            self.index += 1 + (1 if self.peek(1).text == "'" else self.primes_raised() + 2)
        known = self.resolved(name, subscript)
        if primes and (known in self.names.functions or self.called_with_time()):
            self.take_time_call(known)
            return self.derivative(Node("name", known), primes, token)
        if primes:
            known = self.resolved(known + "_prime" * primes, "", (known + "p" * primes,))
        self.take_time_call(known)
        return Node("name", known)

    def primes_raised(self) -> int:
        """Return how many primes stand in ``^'`` or ``^{''}``."""
        if self.peek(1).text == "'":
            return 1
        count = 0
        while self.peek(1).text == "{" and self.peek(2 + count).text == "'":
            count += 1
        return count if count and self.peek(2 + count).text == "}" else 0

    def subscript(self) -> str:
        token = self.next()
        pieces = [token]
        if token.text == "{":
            pieces = []
            while not self.at("}"):
                piece = self.next()
                if piece.text in ("\\mathrm", "\\text", "{", ","):
                    continue
                if (piece.kind not in ("letter", "number") and piece.text[1:] not in GREEK) or "." in piece.text:
                    raise self.fail("letters and digits in a subscript", piece)
                pieces.append(piece)
                while piece.text != "}" and self.at("}") and self.depth_of_subscript(pieces):
                    self.next()
            self.expect("}")
        elif token.kind == "number" and len(token.text) > 1:
            raise self.fail("braces around a subscript of several digits", token)
        elif token.kind not in ("letter", "number") and token.text[1:] not in GREEK:
            raise self.fail("a subscript of letters and digits", token)
        if not pieces:
            raise self.fail("a subscript of letters and digits", token)
        return "".join(piece.text.removeprefix("\\") for piece in pieces)

    def depth_of_subscript(self, pieces: list[Token]) -> bool:
        """Return whether a brace closes an upright part inside the subscript."""
        opened = closed = 0
        place = self.index - 1
        while self.tokens[place].text != "_":
            opened += self.tokens[place].text == "{"
            closed += self.tokens[place].text == "}"
            place -= 1
        return opened - closed > 1

    def resolved(self, name: str, subscript: str, others: tuple[str, ...] = ()) -> str:
        """Return the declared name that is meant, ``I_1`` or ``I1`` for a subscript; the first form if none is."""
        forms = [f"{name}_{subscript}", f"{name}{subscript}"] if subscript else [name]
        return next((form for form in [*forms, *others] if form in self.names), forms[0])

    def called_with_time(self) -> bool:
        return [self.peek(n).text for n in range(3)] == ["(", "t", ")"]

    def take_time_call(self, name: str) -> None:
        if not self.called_with_time():
            return
        if name in self.names.functions or (self.names.implied and name not in self.names):
            self.index += 3
            self.timed.add(name)

    def marked(self, token: Token) -> Node:
        """Read ``\\vec{r}``, ``\\mathbf R``, ``\\hat n``: names of vectors and matrices, which must be defined."""
        opened = self.take("{")
        inner = self.next()
        if inner.kind == "number" and token.text == "\\mathbf":
            raise self.fail("eye(n) among the definitions for a unit matrix", inner)
        node = self.named(inner.text.removeprefix("\\"), inner, script=opened)
        if opened:
            self.expect("}")
        if self.at("_") or self.at("'"):
            node = self.named(str(node.value), inner)
        if node.value not in self.names.matrices:
            raise self.fail(f"a vector or matrix that is defined under the name {node.value!r}", token)
        return node

    def barred(self, token: Token) -> Node:
        opened = self.take("{")
        inner = self.next()
        node = self.named(inner.text.removeprefix("\\") + NAME_MARKS[token.text], inner, script=opened)
        if opened:
            self.expect("}")
        return self.named(str(node.value), inner) if self.at("_", "'") else node

    def spelled(self, token: Token) -> Node:
        """Read ``\\operatorname{tr}(..)`` or ``\\mathrm{abc}``: a function that is built in, or a name of letters."""
        if not self.take("{"):
            inner = self.next()
            return self.named(inner.text.removeprefix("\\"), inner)
        name = ""
        while self.peek().kind in ("letter", "number") and self.peek().text.isalnum():
            name += self.next().text
        if not name or not name[0].isalpha():
            raise self.fail("a name of letters and digits")
        if self.at("_"):
            node = self.named(name, token)
            self.expect("}")
            return node
        self.expect("}")
        if name == "d":
            raise self.fail("a derivative or an integral around d", token)
        return self.called(SPELLED[name], token) if name in SPELLED else self.named(name, token)

    # -- functions --------------------------------------------------------------------------------------------------

    def operator(self, token: Token) -> Node:
        return self.called(OPERATORS[token.text], token)

    def called(self, name: str, token: Token) -> Node:
        """Read the arguments of a function in brackets, or one factor."""
        opening = self.peek()
        if opening.text not in ("(", "[", "\\{"):
            return Node("call", name, (self.factor(),))
        self.next()
        arguments = [self.expression()]
        while self.take(","):
            arguments.append(self.expression())
        self.expect(CLOSING[opening.text])
        return Node("call", name, tuple(arguments))

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
        """Read ``2\\theta``, ``\\omega t`` or ``\\frac{\\theta}{2}`` after a sine, nothing that reads in two ways."""
        factors = [self.factor()] if not self.at("-") else []
        if not factors:
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

    # -- fractions and derivatives ----------------------------------------------------------------------------------

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
        """Return how many tokens a sign of differentiation takes here: d, \\partial, \\mathrm{d}, \\mathrm d; or 0."""
        texts = [self.peek(ahead + n).text for n in range(4)]
        if texts[0] in ("d", "\\partial"):
            return 1
        if texts[0] == "\\mathrm":
            return 4 if texts[1:] == ["{", "d", "}"] else 2 if texts[1] == "d" else 0
        return 0

    def differential(self) -> bool:
        """Return whether ``dx`` stands here."""
        taken = self.is_d()
        token = self.peek(taken)
        return bool(taken) and (token.kind == "letter" or token.text[1:] in GREEK)

    def derivative_fraction(self, token: Token) -> Node | None:
        """Read ``\\frac{d^n X}{d x^n}`` or ``\\frac{d}{dx} X``; None if the fraction is another one."""
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
            raise self.fail("another name for the symbol d, which differentiates here", token)
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
            raise self.fail(f"a derivative of order {order} above and below", token)
        if operand is None:
            operand = self.factor()
            if self.starts_factor() or self.at("/"):
                raise self.fail("brackets around what is differentiated")
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
        return self.derivative(node, DOTS[token.text], token)

    def derivative(self, node: Node, times: int, token: Token) -> Node:
        """Return a derivative in time; a name by itself becomes a function of time."""
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

    # -- matrices ---------------------------------------------------------------------------------------------------

    def environment(self, token: Token) -> Node:
        name = self.environment_name()
        if name not in MATRICES:
            raise self.fail(f"one of the environments {', '.join(MATRICES)}", token)
        if name == "array":
            self.expect("{")
            while self.at("c", "l", "r", "|"):
                self.next()
            self.expect("}")
        bars, self.open_bars = self.open_bars, ()
        rows = [[self.expression()]]
        while not self.at("\\end"):
            if self.take("&"):
                rows[-1].append(self.expression())
            elif self.take("\\\\"):
                if not self.at("\\end"):
                    rows.append([self.expression()])
            else:
                raise self.fail("& or \\\\ between the entries of a matrix")
        self.next()
        self.open_bars = bars
        if self.environment_name() != name:
            raise self.fail(f"\\end{{{name}}}", token)
        if len({len(row) for row in rows}) > 1:
            raise self.fail("rows of equal length in a matrix", token)
        made = Node("call", "Matrix", (_listed([_listed(row) for row in rows]),))
        return Node("call", MATRICES[name], (made,)) if MATRICES[name] else made

    def environment_name(self) -> str:
        self.expect("{")
        name = ""
        while self.peek().kind == "letter":
            name += self.next().text
        self.expect("}")
        return name

    def is_matrix(self, node: Node) -> bool:
        """Return whether a tree stands for a vector or matrix."""
        if node.kind == "name":
            return node.value in self.names.matrices
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        if node.kind == "index":
            return False
        kinds = [self.is_matrix(child) for child in node.args]
        if node.kind == "product" and len(kinds) > 1 and node.args[0].kind == "transpose":
            return True  # a row times a column is a 1 x 1 matrix
        return any(kinds)

    def is_column(self, node: Node) -> bool:
        """Return whether a matrix is a column: bars around it mean its length, around others the determinant."""
        if node.kind == "name":
            return node.value in self.names.columns
        if node.kind == "call" and node.value == "Matrix":
            return len(node.args[0].args[0].args) == 1
        if node.kind == "call":
            return node.value in ("cross", "vee") or (node.value == "diff" and self.is_column(node.args[0]))
        if node.kind == "product":
            return self.is_column(node.args[-1]) and node.args[0].kind != "transpose"
        return node.kind in ("sum", "neg") and self.is_column(node.args[0])


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


def _appended(node: Node, variable: Node) -> Node:
    """Return the derivative of a tree by one more variable."""
    if node.kind == "call" and node.value == "diff" and node.args[-1] == variable == TIME:
        return Node("call", "diff", (*node.args, variable))
    return Node("call", "diff", (node, variable))


def _listed(members: list[Node]) -> Node:
    return Node("list", ("[", "]"), tuple(members))

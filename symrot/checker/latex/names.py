"""Names in LaTeX: subscripts, primes, arguments of time, marks of vectors, words in upright letters."""

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node
from symrot.checker.latex.cursor import CLOSING, Cursor
from symrot.checker.latex.tokens import GREEK, Token

__all__ = ["NAME_MARKS", "OPERATORS", "VECTOR_MARKS", "NamesPart"]

OPERATORS = {"\\det": "det", "\\tr": "trace", "\\diag": "diag"}
SPELLED = {"tr": "trace", "trace": "trace", "Tr": "trace"} | {name: name for name in BUILT_IN}
VECTOR_MARKS = ("\\vec", "\\mathbf", "\\hat", "\\overrightarrow", "\\underline")
NAME_MARKS = {"\\bar": "_bar", "\\tilde": "_tilde", "\\overline": "_bar", "\\widetilde": "_tilde", "\\mathcal": "_cal"}


class NamesPart(Cursor):
    """The part of the reader for names, and for functions that are called by name."""

    def named(self, name: str, token: Token, script: bool = True) -> Node:
        """Read the rest of a name, its subscript, primes and ``(t)``; return its node."""
        primes = 0
        subscript = ""
        if name in ("Delta", "delta") and script and name not in self.names and not self.at("_", "'"):
            follower = self.peek()
            if follower.kind == "letter" or follower.text[1:] in GREEK:
                raise self.fail(f"\\{name}_{{..}} for a change, or \\cdot for a product,", follower)
        if script and self.at("^") and self.peek(1).kind == "number" and self.peek(2).text == "_":  # x^2_1 is x_1^2
            self.subscript_first()
        while script and self.at("_", "'"):
            if self.take("'"):
                primes += 1
            elif subscript:
                raise self.fail("only one subscript")
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
        self.refuse_call()
        return Node("name", known)

    def subscript_first(self) -> None:
        """Swap a one-digit power at the cursor with the subscript that follows it: ``x^2_1`` becomes ``x_1^2``."""
        end = self.index + 4
        if self.peek(3).text == "{":
            while self.tokens[end - 1].text not in ("}", ""):
                end += 1
        power = self.tokens[self.index : self.index + 2]
        self.tokens[self.index : end] = [*self.tokens[self.index + 2 : end], *power]

    def refuse_call(self) -> None:
        """Refuse ``f(x)`` and ``f(0)``, which may be products or values of a function."""
        inner = self.peek(1)
        alone = inner.kind in ("letter", "number") or inner.text[1:] in GREEK
        if self.at("(") and alone and self.peek(2).text == ")":
            raise self.fail("a function that is declared, or \\cdot before the bracket of a product,")

    def primes_raised(self) -> int:
        """Return the number of primes in ``^'`` or ``^{''}``."""
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
                if piece.text == ",":
                    piece = piece._replace(text="_", kind="letter")
                elif piece.text in ("\\mathrm", "\\text", "\\rm", "{"):
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
        """Return whether a brace closes an upright group inside the subscript."""
        opened = closed = 0
        place = self.index - 1
        while self.tokens[place].text != "_":
            opened += self.tokens[place].text == "{"
            closed += self.tokens[place].text == "}"
            place -= 1
        return opened - closed > 1

    def resolved(self, name: str, subscript: str, others: tuple[str, ...] = ()) -> str:
        """Return the declared name with a subscript, ``I_1`` or ``I1``; ``I_1`` if neither is declared."""
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
        if inner.text in VECTOR_MARKS:  # \\hat{\\mathbf n}
            node = self.marked(inner)
            if opened:
                self.expect("}")
            return self.marked_name(self.named(str(node.value), inner) if self.at("_", "'") else node, token)
        if inner.kind == "number" and token.text == "\\mathbf":
            raise self.fail("eye(n) among the definitions for a unit matrix", inner)
        node = self.named(inner.text.removeprefix("\\"), inner, script=opened)
        if opened:
            self.expect("}")
        if self.at("_", "'"):
            node = self.named(str(node.value), inner)
        self.refuse_call()
        return self.marked_name(node, token)

    def marked_name(self, node: Node, token: Token) -> Node:
        """Return a name that is marked as a vector or matrix; refuse it unless it is defined as one."""
        subscript_follows = self.at("}") and self.peek(1).text == "_"  # \\dot{\\mathbf{H}}_G
        if node.value not in self.names.matrices and (self.names.implied or not subscript_follows):
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
        """Read ``\\operatorname{tr}(..)`` or ``\\mathrm{abc}``: a built-in function, or a name of several letters."""
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

"""Names in LaTeX: subscripts, primes, arguments of time, marks of vectors, words in upright letters."""

from collections.abc import Iterator

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node
from symrot.checker.latex.cursor import CLOSING, UPRIGHT, Cursor, is_letter
from symrot.latex import tree

__all__ = ["NAME_MARKS", "OPERATORS", "VECTOR_MARKS", "NamesPart"]

OPERATORS = {"\\det": "det", "\\tr": "trace", "\\diag": "diag"}
SPELLED = {"tr": "trace", "trace": "trace", "Tr": "trace"} | {name: name for name in BUILT_IN}
BOLD = ("\\mathbf", "\\bm", "\\boldsymbol")
VECTOR_MARKS = ("\\vec", *BOLD, "\\hat", "\\overrightarrow", "\\underline")
NAME_MARKS = {"\\bar": "_bar", "\\tilde": "_tilde", "\\overline": "_bar", "\\widetilde": "_tilde", "\\mathcal": "_cal"}


class NamesPart(Cursor):
    """The part of the checker's interpreter for names, and for functions that are called by name."""

    def named(self, name: str, item: tree.Node, script: bool = True) -> Node:
        """Read the rest of a name, its subscript, primes and ``(t)``; return its node."""
        if name in ("Delta", "delta") and script and name not in self.names and not self.at("_", "'"):
            follower = self.peek()
            if is_letter(follower):
                raise self.fail(f"\\{name}_{{..}} for a change, or \\cdot for a product,", follower)
        primes, subscript = 0, ""
        while script and (mark := self.script("_") or self.script("'")):
            if mark.text == "'":
                primes = len(mark.inside.text)
            else:
                subscript = self.subscript(mark)
        known = self.resolved(name, subscript)
        if primes and (known in self.names.functions or self.called_with_time()):
            self.take_time_call(known)
            return self.derivative(Node("name", known), primes, item)
        if primes:
            known = self.resolved(known + "_prime" * primes, "", (known + "p" * primes,))
        self.take_time_call(known)
        self.refuse_call()
        return Node("name", known)

    def refuse_call(self) -> None:
        """Refuse ``f(x)`` and ``f(0)``, which may be products or values of a function."""
        inner = self.peek(1)
        if self.at("(") and (inner.kind == "number" or is_letter(inner)) and self.peek(2).text == ")":
            raise self.fail("a function that is declared, or \\cdot before the bracket of a product,")

    def subscript(self, mark: tree.Script) -> str:
        """Return the text of a subscript."""
        inside = mark.inside
        if inside.kind == "number" and self.is_cut(inside):
            raise self.fail("braces around a subscript of several digits", inside)
        group = isinstance(inside, tree.Row | tree.Font)
        pieces = "".join(self.pieces((inside,))) if group or inside.kind == "number" or is_letter(inside) else ""
        if not pieces:
            raise self.fail("a subscript of letters and digits", inside)
        return pieces

    def pieces(self, items: tuple[tree.Node, ...]) -> Iterator[str]:
        """Yield the letters and numbers of a subscript, upright or not, with ``_`` for a comma."""
        for item in items:
            if isinstance(item, tree.Row):
                yield from self.pieces(item.items)
            elif isinstance(item, tree.Font) and item.text in (*UPRIGHT, "\\text"):
                yield from self.pieces((item.inside,))
            elif item.text == ",":
                yield "_"
            elif (item.kind == "number" or is_letter(item)) and "." not in item.text:
                yield item.text.removeprefix("\\")
            elif item.text != "\\rm" and item.kind != "space":
                place = item.scripts[0] if isinstance(item, tree.Scripts) else item
                raise self.fail("letters and digits in a subscript", place)

    def is_cut(self, digit: tree.Node) -> bool:
        """Return whether a number without braces is one digit of several: LaTeX reads ``x^12`` as ``x^1 2``."""
        return len(digit.text) > 1 or self.source[digit.end : digit.end + 1].isdigit()

    def resolved(self, name: str, subscript: str, others: tuple[str, ...] = ()) -> str:
        """Return the declared name with a subscript, ``I_1`` or ``I1``; ``I_1`` if neither is declared."""
        forms = [f"{name}_{subscript}", f"{name}{subscript}"] if subscript else [name]
        return next((form for form in [*forms, *others] if form in self.names), forms[0])

    def called_with_time(self) -> bool:
        return self.at("(") and self.peek(1).text == "t" and self.peek(2).text == ")"

    def take_time_call(self, name: str) -> None:
        if not self.called_with_time():
            return
        if name in self.names.functions or (self.names.implied and name not in self.names):
            self.index += 3
            self.timed.add(name)

    def marked(self, mark: tree.Node) -> Node:
        """Read ``\\vec{r}``, ``\\mathbf R``, ``\\hat n``: names of vectors and matrices, which must be defined."""
        node, letter = self.letter(mark)
        if self.at("_", "'"):
            node = self.named(str(node.value), letter)
        self.refuse_call()
        known = node.value in self.names.matrices
        if not known and (self.names.implied or not self.is_group_with_subscript()):
            raise self.fail(f"a vector or matrix that is defined under the name {node.value!r}", mark)
        return node

    def is_group_with_subscript(self) -> bool:
        """Return whether the group ends here and has a subscript, as in ``\\dot{\\mathbf{H}}_G``."""
        end = self.peek()
        return end.kind == "end" and self.source[end.start + 1 :].lstrip().startswith("_")

    def barred(self, mark: tree.Node) -> Node:
        """Read a name with a mark that belongs to it, ``\\bar I``."""
        node, letter = self.letter(mark, NAME_MARKS[mark.text])
        return self.named(str(node.value), letter) if self.at("_", "'") else node

    def letter(self, mark: tree.Node, ending: str = "") -> tuple[Node, tree.Node]:
        """Read the letter under a mark, or a letter with a second mark; in braces, with its subscript and primes."""
        assert isinstance(mark, tree.Accent | tree.Font)

        def read(inner: tree.Node, script: bool) -> tuple[Node, tree.Node]:
            if inner.text in VECTOR_MARKS and not ending:  # \\hat{\\mathbf n}
                return self.marked(inner), inner
            if inner.kind == "number" and mark.text in BOLD:
                raise self.fail("eye(n) among the definitions for a unit matrix", inner)
            return self.named(self.symbol(inner) + ending, inner, script), inner

        if isinstance(mark.inside, tree.Row):
            return self.inside(mark.inside, lambda: read(self.next(), True))
        return read(mark.inside, False)

    def symbol(self, item: tree.Node) -> str:
        """Return the name of a letter, a number or a command without arguments."""
        if item.kind not in ("letter", "number", "command"):
            raise self.fail("a letter", item)
        return item.text.removeprefix("\\")

    def spelled(self, font: tree.Node) -> Node:
        """Read ``\\operatorname{tr}(..)`` or ``\\mathrm{abc}``: a built-in function, or a name of several letters."""
        assert isinstance(font, tree.Font)
        if not isinstance(font.inside, tree.Row):
            return self.named(self.symbol(font.inside), font.inside)
        name, node = self.inside(font.inside, lambda: self.word(font))
        if node is not None:
            return node
        if name == "d":
            raise self.fail("a derivative or an integral around d", font)
        return self.called(SPELLED[name]) if name in SPELLED else self.named(name, font)

    def word(self, font: tree.Node) -> tuple[str, Node | None]:
        """Read letters and digits; return them, with the name that they and a subscript make."""
        name = ""
        while self.peek().kind in ("letter", "number") and self.peek().text.isalnum():
            name += self.next().text
        if not name[:1].isalpha():
            raise self.fail("a name of letters and digits")
        return name, self.named(name, font) if self.at("_") else None

    def operator(self, item: tree.Node) -> Node:
        return self.called(OPERATORS[item.text])

    def called(self, name: str) -> Node:
        """Read the arguments of a function in brackets, or one factor."""
        opening = self.peek()
        if opening.text not in CLOSING:
            return Node("call", name, (self.factor(),))
        self.next()
        arguments = [self.expression()]
        while self.take(","):
            arguments.append(self.expression())
        self.expect(CLOSING[opening.text])
        return Node("call", name, tuple(arguments))

"""The reader of LaTeX: from tokens to the tree of what is written. What it cannot read is refused with its place."""

from collections.abc import Callable, Iterator, Sequence
from string import ascii_letters

from symrot.errors import InputError, complaint
from symrot.latex.tokens import Token, tokens
from symrot.latex.tree import Accent, Delimited, Font, Fraction, Node, Root, Row, Script, Scripts, Sized, Table

__all__ = ["read"]

DEEPEST_NESTING = 60
PRIMES = ("'", "′", "\\prime")
SCRIPTS = frozenset(["_", "^", *PRIMES])
ENDS = frozenset(["", "}", "&", "\\\\", "\\end", "\\right"])
"""Tokens that cannot be an argument."""
LINES = ("\\\\", "\\cr")
ACCENTS = ("dot", "ddot", "dddot", "hat", "bar", "overline", "vec", "overrightarrow", "tilde", "widetilde", "underline")
FONTS = ("mathbf", "bm", "boldsymbol", "mathrm", "mathit", "mathsf", "mathcal", "text", "textrm", "operatorname")
DELIMITERS = frozenset(["(", ")", "[", "]", "|", "/", ".", "<", ">", *(f"\\{name}" for name in (
    "{", "}", "|", "lbrace", "rbrace", "lbrack", "rbrack", "vert", "lvert", "rvert", "Vert", "lVert", "rVert",
    "langle", "rangle", "lfloor", "rfloor", "lceil", "rceil"))])  # fmt: skip
SIZES = ("big", "Big", "bigl", "bigr", "Bigl", "Bigr", "biggl", "biggr", "middle")


def read(source: str, where: str = "", pieces: Sequence[Token] = ()) -> Row:
    """Return the tree of a formula.

    Parameters
    ----------
    source : str
    where : str
        Its place, for error messages.
    pieces : sequence of Token, optional
        The tokens of the part of the source that is to be read; by default those of the whole source.

    Raises
    ------
    InputError
        For a group, a matrix or a delimiter that is not closed, for a missing argument, and for two indices or two
        powers of one piece, with the position.
    """
    return _Reader(source, where, pieces or tokens(source)).row("")


class _Reader:
    def __init__(self, source: str, where: str, pieces: Sequence[Token]) -> None:
        self.source, self.where, self.tokens = source, where, pieces
        self.place = self.depth = 0

    def fail(self, expected: str, token: Token) -> InputError:
        return complaint(self.source, self.where, token.start, expected)

    def next(self) -> Token:
        """Return the next token that is no space."""
        while (token := self.tokens[self.place]).kind == "space":
            self.place += 1
        self.place += token.kind != "end"
        return token

    def row(self, *stops: str) -> Row:
        """Read items up to one of the stops, which is not used."""
        items: list[Node] = []
        first = token = self.tokens[self.place]
        while token.text not in stops:
            if token.kind == "end":
                raise self.fail(f"'{stops[-1]}'", token)
            following = self.tokens[self.place + 1]
            if token.text in STRUCTURES or following.text in SCRIPTS or following.kind == "space":
                items.append(self.item())
            else:  # most items are a token
                items.append(token)
                self.place += 1
            token = self.tokens[self.place]
        return Row(tuple(items), first.start, token.start)

    def closed(self, opening: Token, closing: str) -> Row:
        """Read a row and the token that closes it."""
        row = self.row(closing)
        self.place += 1
        return Row(row.items, opening.start, row.end)

    def item(self) -> Node:
        """Read a piece with its scripts."""
        base, place = self.atom(), self.place
        while (token := self.tokens[place]).kind == "space":
            place += 1
        if token.text not in SCRIPTS or base.kind == "space":
            return base
        self.place = place
        scripts: list[Script] = []
        for script in self.scripts():
            if script.text in [other.text for other in scripts]:
                raise complaint(self.source, self.where, script.start, REPEATED[script.text])
            scripts.append(script)
        return Scripts(base, tuple(sorted(scripts, key=lambda script: script.text == "^")))

    def scripts(self) -> Iterator[Script]:
        while (mark := self.tokens[self.place]).text in SCRIPTS:
            self.place += mark.text in ("_", "^")
            primes = "" if mark.text == "_" else self.primes()
            if primes:
                yield Script("'", Token("mark", primes, mark.start), mark.start)
            else:
                yield Script(mark.text, self.argument(), mark.start)

    def primes(self) -> str:
        """Read primes, or a group of nothing else, and return them."""
        braces = self.tokens[self.place].text == "{"
        place = self.place + braces
        while self.tokens[place].text in PRIMES:
            place += 1
        count = place - self.place - braces
        if braces and self.tokens[place].text != "}":
            count = 0
        if count:
            self.place = place + braces
        return "'" * count

    def argument(self) -> Node:
        """Read a group in braces, or one piece; of a number, one digit."""
        token = self.next()
        if token.text == "{":
            return self.closed(token, "}")
        if token.text in ENDS:
            raise self.fail("a group in braces", token)
        self.place -= 1
        if token.kind == "number" and token.text.isdigit() and len(token.text) > 1:
            digit, rest = Token("number", token.text[0], token.start), Token("number", token.text[1:], token.start + 1)
            self.tokens = [*self.tokens[: self.place], digit, rest, *self.tokens[self.place + 1 :]]
        return self.atom()

    def atom(self) -> Node:
        token = self.tokens[self.place]
        self.place += 1
        if token.text in SCRIPTS:
            raise self.fail("a number, a symbol or a bracket", token)
        reader = READERS.get(token.text)
        if reader is None:
            return token
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels", token)
        node = reader(self, token)
        self.depth -= 1
        return node

    def group(self, token: Token) -> Row:
        return self.closed(token, "}")

    def fraction(self, token: Token) -> Fraction:
        return Fraction(token.text, self.argument(), self.argument(), token.start)

    def root(self, token: Token) -> Root:
        index = None
        if self.tokens[self.place].text == "[":
            self.place += 1
            index = self.closed(self.tokens[self.place - 1], "]")
        return Root(index, self.argument(), token.start)

    def delimited(self, token: Token) -> Delimited:
        return Delimited(self.delimiter(), self.closed(token, "\\right"), self.delimiter(), token.start)

    def delimiter(self) -> Token:
        token = self.next()
        if token.text not in DELIMITERS:
            raise self.fail("a delimiter, such as ( or |", token)
        return token

    def command(self, token: Token) -> Accent | Font:
        return COMMANDS[token.text](token.text, self.argument(), token.start)

    def sized(self, token: Token) -> Sized:
        return Sized(token.text, self.delimiter(), token.start)

    def table(self, token: Token) -> Table:
        name = self.word()
        if name == "array":
            self.word("clr|")
        lines = [[self.row("&", *LINES, "\\end")]]
        while (mark := self.next()).text != "\\end":
            cell = self.row("&", *LINES, "\\end")
            if mark.text == "&":
                lines[-1].append(cell)
            elif cell.items or self.tokens[self.place].text != "\\end":
                lines.append([cell])
        if self.word() != name:
            raise self.fail(f"\\end{{{name}}}", token)
        return Table(name, tuple(map(tuple, lines)), token.start, self.tokens[self.place - 1].end)

    def word(self, letters: str = ascii_letters + "*") -> str:
        """Read the name of an environment, or the letters of its columns, in braces."""
        word, opening = "", self.next()
        if opening.text != "{":
            raise self.fail("'{'", opening)
        while (token := self.next()).text and token.text in letters:
            word += token.text
        if token.text != "}":
            raise self.fail("'}'", token)
        return word


REPEATED = {"_": "only one subscript", "^": "brackets around a repeated power", "'": "primes in one place"}
COMMANDS: dict[str, type[Accent | Font]] = {
    **dict.fromkeys((f"\\{name}" for name in ACCENTS), Accent),
    **dict.fromkeys((f"\\{name}" for name in FONTS), Font),
}
READERS: dict[str, Callable[[_Reader, Token], Node]] = {
    "{": _Reader.group,
    "\\sqrt": _Reader.root,
    "\\left": _Reader.delimited,
    "\\begin": _Reader.table,
    **dict.fromkeys(("\\frac", "\\tfrac", "\\dfrac", "\\cfrac"), _Reader.fraction),
    **dict.fromkeys((f"\\{name}" for name in SIZES), _Reader.sized),
    **dict.fromkeys(COMMANDS, _Reader.command),
}
STRUCTURES = SCRIPTS | READERS.keys()

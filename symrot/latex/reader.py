"""The parser of LaTeX: it turns tokens into the tree of a formula, or raises InputError with an error's position."""

from collections.abc import Callable, Sequence

from symrot.errors import InputError, complaint
from symrot.latex.tokens import Token, tokens
from symrot.latex.tree import Accent, Delimited, Font, Fraction, Node, Root, Row, Script, Scripts, Table

__all__ = ["read"]

DEEPEST_NESTING = 60
REPEATED = {"_": "only one subscript", "^": "brackets around a repeated power", "'": "primes in one place"}
AFTER = frozenset(["script", "prime", "space"])
"""Kinds of tokens that can continue an item: a script (index, power or prime), or a space that may precede a script."""


def read(source: str, where: str = "", pieces: Sequence[Token] = ()) -> Row:
    """Return the tree of a LaTeX formula.

    If ``pieces`` are passed, these tokens are parsed; ``source`` is then only quoted in messages.

    Raises
    ------
    InputError
        If a group, matrix or delimiter is not closed, an argument is missing, an item has two indices or two powers, or
        there are more than :data:`DEEPEST_NESTING` nested levels; the message names the position.
    """
    return _with_open_fractions(_Reader(source, where, pieces or tokens(source)).row("", "end"))


class _Reader:
    """A position in the tokens of one formula, with a method for each kind of item that is more than a token."""

    def __init__(self, source: str, where: str, pieces: Sequence[Token]) -> None:
        self.source, self.where, self.tokens = source, where, pieces
        self.place = self.depth = 0

    def fail(self, expected: str, token: Token) -> InputError:
        return complaint(self.source, self.where, token.start, expected)

    def row(self, closing: str, *stops: str) -> Row:
        """Parse and return the items before a token with a kind or text in ``stops``; ``closing`` is named in an error
        message.
        """
        items: list[Node] = []
        first = token = self.tokens[self.place]
        while token.kind not in stops and token.text not in stops:
            if token.kind in ("end", "right", "close"):
                # the formula or the group ends too early
                raise self.fail(f"'{closing}'" if closing else "\\left or \\begin before this", token)
            if token.kind in READERS or self.tokens[self.place + 1].kind in AFTER:
                items.append(self.item())
            else:  # most items are a single token
                items.append(token)
                self.place += 1
            token = self.tokens[self.place]
        return Row(tuple(items), first.start, token.start)

    def group(self, opening: Token, closing: str = "}") -> Row:
        """Parse a row of items and the bracket ``closing``; return the row, with the position of ``opening``."""
        row = self.row(closing, closing)
        self.place += 1
        return Row(_with_old_fractions(row).items, opening.start, row.end)

    def item(self) -> Node:
        """Parse an item with its scripts (index, power and primes) and return its node."""
        base = self.atom()
        scripts: dict[str, Script] = {}
        while base.kind != "space" and (mark := self.mark()):
            text = mark.text[0]
            if text in scripts:
                raise self.fail(REPEATED[text], mark)
            scripts[text] = Script(text, mark if text == "'" else self.argument(), mark.start)
        if not scripts:
            return base
        if "^" in scripts:
            scripts["^"] = scripts.pop("^")  # moves the power to the end
        return Scripts(base, tuple(scripts.values()), base.start)

    def mark(self) -> Token | None:
        """Return the mark of the next script (index, power, primes) and move past it; None if no script follows."""
        place = self.place
        while self.tokens[place].kind == "space":
            place += 1
        token = self.tokens[place]
        if token.kind not in ("script", "prime"):
            return None
        self.place = place + 1
        return token

    def argument(self) -> Node:
        """Parse and return the argument of a command: a group in braces, a single item or, as in LaTeX, one digit."""
        while self.tokens[self.place].kind == "space":
            self.place += 1
        token = self.tokens[self.place]
        if token.kind in ("end", "right", "close", "line", "script") or token.text in ("}", "&"):
            raise self.fail("a group in braces", token)
        if token.kind == "number" and token.text.isdigit() and len(token.text) > 1:
            digits = Token("number", token.text[0], token.start), Token("number", token.text[1:], token.start + 1)
            self.tokens = [*self.tokens[: self.place], *digits, *self.tokens[self.place + 1 :]]
        return self.atom()

    def atom(self) -> Node:
        token = self.tokens[self.place]
        self.place += 1
        reader = READERS.get(token.kind)
        if reader is None:
            return token
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels", token)
        node = reader(self, token)
        self.depth -= 1
        return node

    def no_piece(self, token: Token) -> Node:
        raise self.fail("a number, a symbol or a bracket", token)

    def unpaired(self, token: Token) -> Node:
        after = "a bracket" if token.text in ("\\left", "\\right") else "the name of an environment in braces"
        raise self.fail(f"{after} after {token.text}", token)

    def fraction(self, token: Token) -> Fraction:
        return Fraction(token.text, self.argument(), self.argument(), token.start)

    def root(self, token: Token) -> Root:
        opening = self.tokens[self.place]
        self.place += opening.text == "["
        return Root(self.group(opening, "]") if opening.text == "[" else None, self.argument(), token.start)

    def delimited(self, token: Token) -> Delimited:
        row = _with_old_fractions(self.row("\\right", "right"))
        self.place += 1
        return Delimited(token, row, self.tokens[self.place - 1], token.start)

    def table(self, token: Token) -> Table:
        end = f"\\end{{{token.text}}}"
        lines: list[list[Row]] = [[]]
        while True:
            lines[-1].append(self.row(end, "&", "line", "close"))
            mark = self.tokens[self.place]
            self.place += 1
            if mark.kind == "close":
                break
            lines += [[]] if mark.kind == "line" else []
        if mark.text != token.text:
            raise self.fail(f"'{end}'", mark)
        if len(lines) > 1 and len(lines[-1]) == 1 and not lines[-1][0].items:
            lines.pop()
        return Table(token.text, tuple(map(tuple, lines)), token.start)


def _with_old_fractions(row: Row) -> Row:
    r"""Return a row in which TeX's ``above \over below`` has become a fraction; other rows are returned unchanged."""
    place = next((n for n, item in enumerate(row.items) if item.text == "\\over"), None)
    if place is None:
        return row
    above, below = row.items[:place], row.items[place + 1 :]
    middle = row.items[place].start
    fraction = Fraction("\\frac", Row(above, row.start, middle), Row(below, middle, row.end), middle)
    return Row((fraction,), row.start, row.end)


def _with_open_fractions(row: Row) -> Row:
    r"""Return a formula in which ``above \over below`` outside of braces has become a fraction.

    Such a fraction extends from the equals sign, comma, ``&`` or ``\\`` before it to the next one.
    """
    if all(item.text != "\\over" for item in row.items):
        return row
    items: list[Node] = []
    ends = [*(n for n, item in enumerate(row.items) if item.text in ("=", "\\\\", "&", ",")), len(row.items)]
    first = 0
    for end in ends:
        side = row.items[first:end]
        start = side[0].start if side else row.start
        stop = row.items[end].start if end < len(row.items) else row.end
        items += [*_with_old_fractions(Row(side, start, stop)).items, *row.items[end : end + 1]]
        first = end + 1
    return Row(tuple(items), row.start, row.end)


READERS: dict[str, Callable[[_Reader, Token], Node]] = {
    "group": _Reader.group, "fraction": _Reader.fraction, "root": _Reader.root, "left": _Reader.delimited,
    "begin": _Reader.table,
    "accent": lambda reader, token: Accent(token.text, reader.argument(), token.start),
    "font": lambda reader, token: Font(token.text, reader.argument(), token.start),
    "script": _Reader.no_piece, "prime": _Reader.no_piece, "unpaired": _Reader.unpaired,
}  # fmt: skip

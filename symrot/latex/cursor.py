"""The cursor with which interpreters read the tree of a LaTeX formula, item by item.

An item is a token, a fraction, a root, a table or another node of a row.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import ClassVar, TypeVar

from symrot.errors import InputError, complaint
from symrot.latex.tokens import Token
from symrot.latex.tree import Delimited, Node, Row, Script, Scripts

__all__ = ["Cursor"]

Value = TypeVar("Value")


class Cursor:
    r"""A position in a row of items of the LaTeX tree, from which the next item is read.

    Spaces, ``\left`` and ``\right`` are skipped.

    Attributes
    ----------
    source, where : str
        The whole formula, and the name of its place (such as a file) for error messages.
    synonyms : mapping
        A map from the text of a token to the text under which the interpreter knows the token.
    open_bars : tuple of str
        The bars, ``|`` or ``\|``, that are open at the cursor: the next one of the same text closes them.
    after_space : set of int
        Positions in the source of the items that follow a LaTeX command for space.
    """

    synonyms: ClassVar[Mapping[str, str]] = {}
    open_bars: tuple[str, ...] = ()

    def __init__(self, source: str, where: str, row: Row) -> None:
        self.source, self.where = source, where
        self.after_space: set[int] = set()
        self.enter(row)

    def fail(self, expected: str, item: Node | None = None) -> InputError:
        """Return an InputError that says what was ``expected`` at the position of ``item``, by default of the next
        item.
        """
        return complaint(self.source, self.where, (item or self.peek()).start, expected)

    def enter(self, node: Node) -> None:
        """Move to the beginning of ``node``: a row of the LaTeX tree, or a single item that is read like a row."""
        self.items: list[Node] = []
        self.index = 0
        self.flatten(node.items if isinstance(node, Row) else (node,))
        self.items.append(Token("end", "", node.end if isinstance(node, Row) else node.start))

    def flatten(self, nodes: Iterable[Node]) -> None:
        """Append nodes to the items of the cursor, without spaces, and with indices and powers after their symbols."""
        space = False
        for node in nodes:
            # an index or a power is an item after its symbol
            if isinstance(node, Scripts):
                self.flatten((node.base, *node.scripts))
            elif isinstance(node, Delimited):
                self.flatten((node.opening, *node.inside.items, node.closing))
            elif node.kind == "space":
                space = space or node.text[0] == "\\"
                continue
            else:
                text = self.synonyms.get(node.text)
                self.items.append(Token("command" if text[0] == "\\" else "mark", text, node.start) if text else node)
            if space:
                self.after_space.add(node.start)
                space = False

    def inside(self, node: Node, read: Callable[[], Value], closing: str = "'}'") -> Value:
        """Call ``read`` at the start of ``node``, move back to the item where the cursor was, and return the value.

        Raise InputError if ``read`` does not read all items of the node; the message says that ``closing`` is expected.
        """
        outside = self.items, self.index, self.open_bars
        self.enter(node)
        self.open_bars = ()
        value = read()
        if self.peek().kind != "end":
            # items are left
            raise self.fail(closing)
        self.items, self.index, self.open_bars = outside
        return value

    def listed(self, read: Callable[[], Value], closing: str) -> list[Value]:
        """Parse values, separated by commas, up to the bracket ``closing``; return the list and move past the bracket.

        ``read`` parses one value.
        """
        bars, self.open_bars = self.open_bars, ()
        values = [read()]
        while self.take(","):
            values.append(read())
        self.expect(closing)
        self.open_bars = bars
        return values

    def barred(self, read: Callable[[], Value], bar: str) -> Value:
        """Parse a value between two bars, as in ``|x|``, by ``read``, and return it.

        The cursor is after the opening bar.
        """
        outside, self.open_bars = self.open_bars, (*self.open_bars, bar)
        value = read()
        self.expect(bar)
        self.open_bars = outside
        return value

    def peek(self, ahead: int = 0) -> Node:
        """Return the next item, or the one that is ``ahead`` items after it, and stay; past the end, return the end."""
        place = self.index + ahead
        return self.items[place] if place < len(self.items) else self.items[-1]

    def at(self, *texts: str) -> bool:
        """Return whether the text of the next item is one of ``texts``."""
        return self.items[self.index].text in texts

    def next(self) -> Node:
        """Return the next item and move past it, unless it is the end."""
        item = self.items[self.index]
        self.index += item.kind != "end"
        return item

    def take(self, text: str) -> bool:
        """Skip the next item if its text is ``text``; return whether it was skipped."""
        is_next = self.items[self.index].text == text
        self.index += is_next
        return is_next

    def expect(self, text: str) -> None:
        """Skip the next item; raise InputError if its text is not ``text``."""
        if not self.take(text):
            raise self.fail(f"'{text}'")

    def script(self, mark: str) -> Script | None:
        """Return the next item, and move past it, if it is a script with this mark (``_``, ``^`` or ``'``).

        Otherwise return None and stay.
        """
        item = self.items[self.index]
        if isinstance(item, Script) and item.text == mark:
            self.index += 1
            return item
        return None

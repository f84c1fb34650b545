"""The cursor of the LaTeX reader: the tokens of a formula, and the methods that parts of its grammar call in others."""

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass, field

from symrot.checker.claim.reader import complaint
from symrot.checker.claim.tree import Node
from symrot.checker.latex.tokens import Token, tokens
from symrot.errors import InputError

__all__ = ["CLOSING", "TIME", "Cursor", "Names"]

CLOSING = {"(": ")", "[": "]", "\\{": "\\}", "{": "}"}
TIME = Node("name", "t")


@dataclass(frozen=True)
class Names:
    """The declared names: symbols, functions of time, definitions that are matrices or columns, other definitions.

    With ``implied`` undeclared names are allowed.
    """

    symbols: Collection[str] = ()
    functions: Collection[str] = ()
    matrices: Collection[str] = ()
    columns: Collection[str] = ()
    others: Collection[str] = ()
    implied: bool = True

    def __contains__(self, name: str) -> bool:
        return name in {*self.symbols, *self.functions, *self.matrices, *self.others}


@dataclass
class Cursor(ABC):
    """The position in the tokens of a formula, with the integrals and bars that are open there."""

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

    def peek(self, ahead: int = 0) -> Token:
        return self.tokens[min(self.index + ahead, len(self.tokens) - 1)]

    def at(self, *texts: str) -> bool:
        return self.peek().text in texts

    def next(self) -> Token:
        token = self.peek()
        self.index += token.kind != "end"
        return token

    def take(self, text: str) -> bool:
        is_next = self.at(text)
        self.index += is_next
        return is_next

    def expect(self, text: str) -> None:
        if not self.take(text):
            raise self.fail(f"'{text}'")

    def fail(self, expected: str, token: Token | None = None) -> InputError:
        return complaint(self.source, self.where, (token or self.peek()).position, expected)

    # -- methods that parts of the grammar call in other parts --------------------------------------------------------

    open_bars: tuple[str, ...] = ()

    @abstractmethod
    def expression(self) -> Node:
        """Read a sum."""

    @abstractmethod
    def factor(self) -> Node:
        """Read a piece with its powers."""

    @abstractmethod
    def base(self, script: bool = True) -> Node:
        """Read a piece without its powers."""

    @abstractmethod
    def argument(self) -> Node:
        """Read a group in braces, or one token."""

    @abstractmethod
    def bracket(self, token: Token) -> Node:
        """Read an expression and its closing bracket, after the opening one."""

    @abstractmethod
    def starts_factor(self) -> bool:
        """Return whether a factor may start at the cursor."""

    @abstractmethod
    def derivative(self, node: Node, times: int, token: Token) -> Node:
        """Return a time derivative."""

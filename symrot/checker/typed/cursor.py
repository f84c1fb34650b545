"""The cursor of the claim reader: a position in the tokens of a formula, its names, and its ambiguous pieces.

Each ambiguous piece has a key (kind, position). ``flips`` are the keys of the pieces that get their less usual meaning.
"""

import re
from abc import ABC, abstractmethod
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from fractions import Fraction

from symrot.checker.claim.functions import BUILT_IN, ROTATIONS
from symrot.checker.claim.tree import Node, derivative
from symrot.checker.typed.defined_functions import DEFINED
from symrot.checker.typed.tokens import LONGEST_NUMBER, Token
from symrot.checker.typed.words import ALIASES, ENGLISH
from symrot.errors import InputError, complaint

__all__ = [
    "ADDING", "DEEPEST_NESTING", "FACTOR_MARKS", "MASS", "Cursor", "Doubt", "Vocabulary", "is_cross_letter",
    "is_mass_before_vector", "is_usual_vector",
]  # fmt: skip

DEEPEST_NESTING = 60
ADDING = ("+", "-")
MASS = "dm"
"""Name of the element of mass in an integral over a body."""

FACTOR_MARKS = ("(", "[", "√")
"""Characters that may start a factor directly after another factor, without a product sign: ``2(a + b)``, ``2√x``."""

VECTOR_FUNCTIONS = ("cross", "vee", "Matrix")
USUAL_VECTORS = frozenset([*"abcdeuvwrpqnsFLHMNRT", "omega", "Omega", "alpha", "tau", "epsilon", "eps", "sigma"])
"""Names that books usually give to vectors; between two of them, as in ``a x b``, a letter x may be the sign ×."""

SHARED = ("R", "T", "N", "s", "sigma", "epsilon", "eps")
"""Names that books give to vectors and just as often to numbers: a radius, a tension, a normal force, a length."""


@dataclass(frozen=True)
class Doubt:
    """An ambiguous piece of a text, such as ``1/2m``: it can be read in two ways.

    Attributes
    ----------
    key : (str, int)
        The kind of ambiguity, and the position of the piece.
    excerpt : str
        The text of the piece.
    """

    key: tuple[str, int]
    excerpt: str


@dataclass(frozen=True)
class Vocabulary:
    """What a text tells about its names: which are declared, which stand without a bracket, and which are vectors.

    A name that stands somewhere without a bracket after it is probably not the name of a function.
    """

    symbols: frozenset[str] = frozenset()  # declared
    functions: frozenset[str] = frozenset()  # declared
    alone: frozenset[str] = frozenset()  # names that occur without a bracket after them
    vectors: frozenset[str] = frozenset()  # names that, for example, cross products and hats show to be vectors
    mixed: frozenset[str] = frozenset()  # vectors that occur with and without a hat

    def function(self, name: str) -> str | None:
        """Return the name of the function that ``name`` means, asin for arcsin; None if it means no function."""
        if name in self.symbols or (name in ROTATIONS and name in self.alone):
            return None
        if name in BUILT_IN or name in self.functions or name in DEFINED:
            return name
        return ALIASES.get(name)


class Cursor(ABC):
    """A position in the tokens of a formula, with the methods that parse what follows it.

    Attributes
    ----------
    plain : bool
        Whether the formula uses notation of plain text, such as ``2x`` or ``sin x``, which is not SymPy syntax.
    doubts : list of Doubt
        The ambiguous pieces that were met so far.
    notes : list of str
        Sentences about the way in which the formula is read.
    timed : set of str
        Names with a prime or a dot, or in ``dx/dt``, which are functions of time.
    differentiated : set of str
        Names in formulas after d/dt, which may be functions of time.
    """

    def __init__(
        self, tokens: Sequence[Token], source: str, where: str = "", vocabulary: Vocabulary | None = None,
        flips: Collection[tuple[str, int]] = (), as_sympy: bool = False,
    ) -> None:  # fmt: skip
        self.tokens, self.source, self.where = tokens, source, where
        self.vocabulary, self.flips, self.as_sympy = vocabulary or Vocabulary(), flips, as_sympy
        self.depth = self.index = self.bars = 0
        self.plain = self.in_integral = False
        self.element = MASS
        self.doubts: list[Doubt] = []
        self.notes: list[str] = []
        self.timed: set[str] = set()
        self.differentiated: set[str] = set()

    def fail(self, expected: str, position: int | None = None) -> InputError:
        return complaint(self.source, self.where, self.start() if position is None else position, expected)

    def token(self, ahead: int = 0) -> Token:
        """Return the token at the cursor, or the one ``ahead`` tokens after it; past the end, return the end token."""
        return self.tokens[min(self.index + ahead, len(self.tokens) - 1)]

    def peek(self) -> str:
        """Return the text of the operator or bracket at the cursor; an empty text if it is another token."""
        token = self.token()
        return token.text if token.kind == "mark" else ""

    def next(self) -> Token:
        """Return the token at the cursor and move past it, unless it is the end token."""
        token = self.token()
        self.index += token.kind != "end"
        return token

    def take(self, mark: str) -> bool:
        """Skip an operator or bracket if it is the next token, and return whether it was."""
        is_next = self.peek() == mark
        self.index += is_next
        return is_next

    def expect(self, mark: str) -> None:
        """Skip the operator or bracket ``mark``; raise InputError if it is not the next token."""
        if not self.take(mark):
            raise self.fail(f"'{mark}'")

    def start(self) -> int:
        return self.token().start

    def span(self, start: int) -> tuple[int, int]:
        """Return the positions in the text from ``start`` to the end of the token before the cursor."""
        return start, self.tokens[self.index - 1].end

    def deeper(self) -> None:
        """Add 1 to ``depth``, the number of nested brackets and arguments; raise InputError if there are too many.

        The caller must subtract 1 again.
        """
        self.depth += 1
        if self.depth > DEEPEST_NESTING:
            raise self.fail(f"at most {DEEPEST_NESTING} nested levels of brackets and arguments")

    def other_reading(self, kind: str, at: int, start: int, stop: int) -> bool:
        """Record an ambiguous piece of the text, from ``start`` to before ``stop``, with the key (``kind``, ``at``).

        Return whether it gets its less usual meaning.
        """
        self.plain = True
        doubt = Doubt((kind, at), self.source[start:stop].strip())
        if doubt.key not in [known.key for known in self.doubts]:
            self.doubts.append(doubt)
        return doubt.key in self.flips

    def note(self, sentence: str) -> None:
        """Append a sentence for the user to the notes, unless it is among them already."""
        if sentence not in self.notes:
            self.notes.append(sentence)

    @abstractmethod
    def expression(self) -> Node:
        """Parse a sum and return its tree."""

    @abstractmethod
    def factor(self) -> Node:
        """Parse a power, with the signs before it, and return its tree."""

    @abstractmethod
    def power(self) -> Node:
        """Parse a number, name, call or bracket, with its exponents, and return its tree."""

    def row(self) -> list[Node]:
        """Parse formulas with commas between them, and return their trees."""
        entries = [self.expression()]
        while self.take(","):
            entries.append(self.expression())
        return entries

    def members(self, closing: str) -> list[Node]:
        """Parse formulas with commas between them and the bracket ``closing`` after them; return their trees."""
        bars, self.bars = self.bars, 0
        members = self.row()
        self.expect(closing)
        self.bars = bars
        return members

    def called(self, function: str, token: Token) -> Node:
        """Parse the arguments of a function, in brackets, and return the tree of the call."""
        self.expect("(")
        arguments = self.members(")")
        if function in DEFINED and function not in self.vocabulary.functions and len(arguments) == 1:
            return DEFINED[function](arguments[0])
        if function == "diff":  # SymPy writes Derivative(x(t), (t, 2))
            return derivative(arguments, self.span(token.start))
        return Node("call", function, tuple(arguments), self.span(token.start))

    def numeral(self, token: Token) -> Node:
        """Return the node of the number ``token``.

        Raise InputError if it has too large an exponent, or an exponent directly before a name, as in ``2e3x``.
        """
        exponent = re.split("[eE]", token.text)[1:]
        if exponent and abs(int(exponent[0])) > LONGEST_NUMBER:
            raise self.fail(f"a power of ten with an exponent up to {LONGEST_NUMBER}", token.start)
        if exponent and self.token().kind == "name" and self.token().tight:
            raise self.fail(f"a product sign after the number {token.text}")
        return Node("number", Fraction(token.text), (), self.span(token.start))

    def starts_factor(self) -> bool:
        """Return whether another factor, without a product sign before it, starts at the cursor.

        Raise InputError if a number, a fraction such as ½ or an English word such as "and" is there.
        """
        token = self.token()
        if self.in_integral and self.is_element():
            return False
        if token.kind in ("number", "fraction"):
            raise self.fail("a product sign before a number" if token.kind == "number" else "an operator")
        if token.text in ENGLISH:
            raise self.fail(f"each claim on a line of its own, without the word {token.text!r}")
        is_mark = token.text in (*FACTOR_MARKS, "∫") or (token.text in ("|", "‖") and not self.bars)
        return token.kind == "name" or is_mark

    def is_element(self) -> bool:
        """Return whether the token at the cursor is the element that ends the integral being parsed: dm or dx."""
        return self.token().text == self.element

    def end_of_run(self) -> int:
        """Return the position in the text after the token at the cursor; for a bracket, after its closing one."""
        depth = 0
        for token in self.tokens[self.index :]:
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            if depth <= 0:
                return token.end
        return len(self.source)

    def is_vector(self, node: Node) -> bool:
        """Return whether a formula is a vector: a list, a cross product, or a name that the text uses as a vector.

        Sums, products and derivatives of vectors are vectors too.
        """
        if node.kind == "name":
            return node.value in self.vocabulary.vectors
        if node.kind == "call":
            return node.value in VECTOR_FUNCTIONS or (node.value == "diff" and self.is_vector(node.args[0]))
        return node.kind == "list" or (node.kind in ("sum", "neg", "product") and any(map(self.is_vector, node.args)))

    def is_cross_letter(self) -> bool:
        """Return whether the token at the cursor is a letter x that is the sign of a cross product, as in ``a x b``."""
        token, after, before = self.token(), self.token(1), self.tokens[self.index - 1]
        # it has blanks around it
        if token.kind != "name" or token.text != "x" or not token.spaced or not after.spaced:
            return False
        after = self.token(2) if is_mass_before_vector(after, self.token(2)) else after
        # it is between names of vectors, and no name itself
        if "x" in self.vocabulary.alone or not is_cross_letter(before, after, self.vocabulary.vectors):
            return False
        return not self.other_reading("cross", token.start, before.start, after.end)


def is_usual_vector(name: str) -> bool:
    """Return whether books usually mean a vector by a name such as r, v or omega."""
    return re.split("[_0-9]", name)[0] in USUAL_VECTORS


def is_mass_before_vector(token: Token, after: Token) -> bool:
    """Return whether ``token`` is the mass m and ``after`` is a vector, as m and v in ``r x m v``."""
    return token.text in ("m", "M") and after.kind == "name" and is_usual_vector(after.text)


def is_cross_letter(before: Token, after: Token, vectors: Collection[str] = ()) -> bool:
    """Return whether a letter x between two tokens may be the sign of a cross product: if both may be vectors."""
    pieces = [(token.kind == "name", re.split("[_0-9]", token.text)[0], token.text) for token in (before, after)]
    usual = [name and (word in USUAL_VECTORS or own in vectors) for name, word, own in pieces]
    brackets = [text in ("(", ")", "[", "]") for _, _, text in pieces]
    return any(usual) and all(u or b for u, b in zip(usual, brackets, strict=True))

"""Words of a text that are several names, short forms or names with an index: ``mgl``, ``cθ`` and ``ωp``."""

import re
from collections.abc import Collection, Iterator, Sequence
from functools import cached_property
from itertools import pairwise

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.typed.cursor import Doubt
from symrot.checker.typed.readings import Declared
from symrot.checker.typed.tokens import GREEK_WORDS, SIGNS, Token
from symrot.checker.typed.words import (
    UNITS,
    lost_power,
    pieces_of_word,
    shorthands,
    shorthands_of_letters,
    split_tokens,
)

__all__ = ["WordReader"]

FIRST_AND_LAST = ("i", "f")
"""Indices that mark the first (initial) and the last (final) value of a quantity."""


class WordReader:
    """A reader that splits and joins the words of a text according to their meaning: ``mgl`` into m, g and l.

    An ambiguous word has a usual and a less usual meaning, and a key: (kind of the ambiguity, position). It gets its
    less usual meaning if its key is in ``flips``.

    Attributes
    ----------
    flips : collection of (str, int)
        The keys of the words that get their less usual meaning.
    notes : list of str
        Sentences about how the words are read.
    doubts : list of Doubt
        The ambiguous words that were met.
    """

    def __init__(
        self, source: str, tokens: Sequence[Token], declared: Declared, flips: Collection[tuple[str, int]]
    ) -> None:
        self.source, self.tokens, self.declared, self.flips = source, tokens, declared, flips
        self.notes, self.doubts = list[str](), list[Doubt]()

    def read(self, alone: Collection[str], vectors: Collection[str]) -> list[Token]:
        """Return the tokens of the text after splitting words that mean several names and joining pieces of one name.

        ``alone`` are the names that no bracket follows, so that they are not functions; ``vectors`` are the names of
        vectors.
        """
        tokens = list(split_tokens(self.tokens, self.products(alone, vectors)))
        tokens = self.with_indices(self.without_shorthand(tokens))
        for before, after in pairwise(self.tokens):
            if before.kind == "number" and after.text in UNITS:
                self.notes.append(f"{after.text} is read as a name, not as a unit")
        return tokens

    def other_reading(self, kind: str, start: int, excerpt: str) -> bool:
        """Add the ambiguous text ``excerpt`` to ``doubts``; return whether it gets its less usual meaning.

        ``kind`` is the kind of the ambiguity, and ``start`` the position of ``excerpt`` in the text. The less usual
        meaning is chosen if the reader's attribute ``flips`` contains the key (kind, start).
        """
        self.doubts.append(Doubt((kind, start), excerpt))
        return (kind, start) in self.flips

    def products(self, alone: Collection[str], vectors: Collection[str]) -> dict[str, tuple[str, ...]]:
        """Return {word: its parts} for the words that are not read as one name: {"mgl": ("m", "g", "l")} for a product.

        {"sin2": ("sin", "^", "2")} is returned for a squared sine whose exponent became an ordinary digit when the text
        was copied; in its less usual meaning, the sine of 2 x, ``sin2`` has the parts ("sin", "2").
        """
        words: dict[str, tuple[str, ...]] = {}
        short = {self.tokens[form.place].text for form in shorthands_of_letters(self.tokens)}
        alone = {*alone} | ({"x", "y", "z"} if any(token.text == "∫" for token in self.tokens) else set())
        first = {token.text: token.start for token in reversed(self.tokens) if token.kind == "name"}
        named = set(_beside_quantities(self.tokens))
        for word, start in sorted(first.items(), key=lambda item: item[1]):
            if word in BUILT_IN or word in self.declared.symbols or word in self.declared.functions:
                continue
            if word in vectors or word in self.differentials or word in short:
                continue
            if (power := lost_power(word)) and self.is_spaced_after(word):
                words[word] = power
                if self.other_reading("power of function", start, word):
                    words[word] = (power[0], power[2])
                else:
                    read = f"{word} before a blank is read as {power[0]}^{power[2]}"
                    self.notes.append(f"{read}, whose raised digit was lost")
                continue
            pieces, usual = pieces_of_word(word, alone)
            if not pieces:
                continue
            usual = usual and (pieces[0], word) not in named
            if self.declared.symbols and all(piece in self.declared.symbols or piece.isdigit() for piece in pieces):
                words[word] = pieces  # the claim says which names it has
                continue
            if usual != self.other_reading("word" if usual else "name", start, word):
                alone |= {piece for piece in pieces if piece in ("x", "y", "z")}
                words[word] = pieces
                self.notes.append(f"{word} is read as {_in_words(pieces)}, not as one name")
        return words

    @cached_property
    def differentials(self) -> set[str]:
        """The names that start with d and occur as in ``dy/dx``, ``d/dx (..)``, ``∂y`` or ``∫ y dx``: dy and dx."""
        words = {token.text for token in self.tokens if self.source[token.start : token.start + 1] == "∂"}
        if any(token.text == "∫" for token in self.tokens):
            words |= {token.text for token in self.tokens if re.fullmatch("d[A-Za-z]", token.text)}
        for n, slash in enumerate(self.tokens):
            above, below = self.tokens[max(n - 1, 0)], self.tokens[min(n + 1, len(self.tokens) - 1)]
            is_above = above.text == "d" or re.fullmatch(r"d[A-Za-z]", above.text) or above.kind in ("power", "number")
            is_above = above.text == ")" or is_above
            if slash.text == "/" and is_above and re.fullmatch(r"d[A-Za-z]", below.text):
                words |= {word for word in (above.text, below.text) if re.fullmatch(r"d[A-Za-z]", word)}
        return words

    def is_spaced_after(self, word: str) -> bool:
        """Return whether every occurrence of a word in the text is followed by a blank and another name."""
        pairs = [after for token, after in pairwise(self.tokens) if token.kind == "name" and token.text == word]
        return all(after.kind == "name" and after.spaced for after in pairs)

    def without_shorthand(self, tokens: list[Token]) -> list[Token]:
        """Return tokens with ``cos(θ)`` for ``cθ`` and ``sin(θ)`` for ``sθ``, if the text uses them as short forms."""
        short = [form for form in shorthands(tokens) if tokens[form.place].text not in self.declared.symbols]
        if not short:
            return tokens
        places = {form.place for form in short}
        alone = {token.text for index, token in enumerate(tokens) if index not in places}
        both = {form.function for form in short} == {"cos", "sin"}
        if not both and all(form.length == 1 for form in short):
            return tokens  # a name with an index
        # short forms, if the text has cθ and sθ but neither c nor s alone; in the less usual reading the opposite
        usual = both and not alone & {"c", "s", "C", "S"}
        first, last = tokens[short[0].place], tokens[short[0].place + short[0].length - 1]
        excerpt = self.source[first.start : last.end]
        if usual == self.other_reading("shorthand", first.start, excerpt):
            return tokens
        for form in reversed(short):
            own = tokens[form.place : form.place + form.length]
            tokens[form.place : form.place + form.length] = form.tokens(own[0], own[-1])
        self.notes.append(
            f"{excerpt} is read as {short[0].function}({short[0].angle}), and similar short forms likewise"
        )
        return tokens

    def with_indices(self, tokens: list[Token]) -> list[Token]:
        """Return tokens in which a Greek letter and an index after it, such as ω and p of ``ωp``, are one name omega_p.

        The letter and the index are joined in two cases: ``ωp`` is the whole left side of an equation, or the text has
        both ``ωi`` and ``ωf``, an initial and a final value. The less usual meaning is the product of ω and p, without
        joining; the attribute ``flips`` can ask for it (see `other_reading`).
        """
        padded = [None, *tokens]
        for place in range(len(tokens) - 3, -1, -1):
            before, first, second, after = padded[place], *tokens[place : place + 3]
            greek = first.kind == second.kind == "name" and first.text in GREEK_WORDS and first.end == first.start + 1
            whole = (before is None or first.breaks) and after.text in SIGNS
            if greek and second.tight and second.text in FIRST_AND_LAST and self.has_first_and_last(first.text):
                whole = True
            if not greek or not whole or not second.tight or len(second.text) > 1 or first.text == "pi":
                continue
            if not self.other_reading("index", first.start, self.source[first.start : second.end]):
                merged = first._replace(text=f"{first.text}_{second.text}", end=second.end)
                tokens[place : place + 2] = [merged]
        return tokens

    def has_first_and_last(self, letter: str) -> bool:
        """Return whether the text has an initial and a final value of ``letter``: ``ωi`` and ``ωf`` for ω."""
        pairs = list(pairwise(self.tokens))
        after = {second.text for first, second in pairs if first.text == letter and second.tight}
        alone = {second.text for first, second in pairs if not second.tight or first.kind != "name"}
        # if i or f is a name of its own, ωi is probably ω times i
        return {*FIRST_AND_LAST} <= after and not alone & {*FIRST_AND_LAST}


def _beside_quantities(tokens: Sequence[Token]) -> Iterator[tuple[str, str]]:
    """Yield pairs (quantity, name): a quantity alone on the left side of an equation, and each name after its sign =.

    For ``I = Ic + m d^2`` they are (I, Ic), (I, m) and (I, d): Ic is then probably one name, not the product I*c.
    """
    quantity = ""
    for before, token, after in zip((None, *tokens), tokens, (*tokens[1:], tokens[-1]), strict=False):
        if before is None or token.breaks or token.text in (";", ","):
            quantity = ""
        starts = before is None or token.breaks or before.text in (";", ",")
        if starts and token.kind == "name" and after.text in ("=", "=="):
            quantity = token.text
        elif quantity and token.kind == "name":
            yield quantity, token.text


def _in_words(pieces: Sequence[str]) -> str:
    if pieces[0] in ("sin", "cos", "tan", "cot", "sec", "csc") or pieces[0].startswith(("asin", "acos", "atan", "arc")):
        return f"{pieces[0]} {''.join(pieces[1:])}"
    return f"the product {'*'.join(pieces)}"

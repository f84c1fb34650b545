"""The reader of claims: from text to trees, without Python's ``eval`` and without SymPy.

It reads SymPy syntax, and formulas as people type them, such as ``2x``. A typed text may have several interpretations
(readings), as ``1/2m`` has. Each ambiguous piece of a text has a key (kind, position); ``flips`` are the keys of the
pieces with their less usual meaning.
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import TIME, Node, number
from symrot.checker.claim.vectors import length, may_be_mixed, on_direction
from symrot.checker.typed.copied_text import without_surroundings
from symrot.checker.typed.cursor import (
    DEEPEST_NESTING,
    SHARED,
    Doubt,
    Vocabulary,
    is_cross_letter,
    is_mass_before_vector,
    is_usual_vector,
)
from symrot.checker.typed.grammar import Parser
from symrot.checker.typed.tokens import GREEK_WORDS, SIGNS, Token, tokens_of, without_dots
from symrot.checker.typed.words import (
    UNITS,
    lost_power,
    pieces_of_word,
    shorthands,
    shorthands_of_letters,
    split_tokens,
)
from symrot.errors import InputError, complaint

__all__ = [
    "DEEPEST_NESTING", "LONGEST_TEXT", "Chain", "Declared", "Reading", "Relation", "distinct_readings", "each_reading",
    "read_expression", "read_relation", "readings_of", "with_time",
]  # fmt: skip

LONGEST_TEXT = 20_000
MOST_PIECES = 5_000
MOST_READINGS = 6
MOST_DOUBTS = 40
"""The most readings of one text, and the most ambiguous pieces of a text that are examined."""

DOT_OF_PRODUCTS = ("(", None, None, ")", "·", "(", None, None, ")")
"""The tokens of ``(R a)·(R b)``, with None in place of each name."""

FIRST_AND_LAST = ("i", "f")
"""Indices that mark the first (initial) and the last (final) value of a quantity."""

Relation = tuple[str, Node, Node]


@dataclass(frozen=True)
class Declared:
    """The names of symbols and functions of time that a claim declares: a declared ``mgl`` is not split into m g l."""

    symbols: Collection[str] = ()
    functions: Collection[str] = ()


@dataclass(frozen=True)
class Chain:
    """One line of a text: formulas (sides) with relation signs between them.

    There is usually one sign, or several equals signs (``a = b = c``).

    Attributes
    ----------
    signs : tuple of str
    sides : tuple of Node
    both_signs : bool
        Whether this is one of the two lines that a typed line with ± stands for.
    """

    signs: tuple[str, ...]
    sides: tuple[Node, ...]
    both_signs: bool = False

    @property
    def links(self) -> tuple[Relation, ...]:
        """The relations between neighbouring sides; but in ``I_x = I_y = F`` each name is related to the formula F."""
        formulas = [side for side in self.sides if side.kind != "name"]
        rights = list(self.sides[1:])
        if formulas and set(self.signs) == {"=="}:
            for n in range(len(rights) - 2, -1, -1):
                if self.sides[n].kind == rights[n].kind == "name":
                    rights[n] = rights[n + 1]
        return tuple(zip(self.signs, self.sides, rights, strict=False))


@dataclass(frozen=True)
class Reading:
    """One interpretation of a text that a user typed; ``1/2m`` has two of them.

    Attributes
    ----------
    lines : tuple of Chain
        The lines of the text, each as formulas with relation signs between them: ``a = b = c`` is one Chain.
    plain : bool
        Whether the text is read as people type, not as SymPy syntax.
    doubts : tuple of Doubt
        The ambiguous pieces of the text.
    notes : tuple of str
        Sentences about how the text is read.
    spelling : dict
        Name in the trees -> name as it was typed, where they differ.
    timed : frozenset of str
        Names that are functions of time.
    vectors : mapping of str to bool
        Names that the text uses as vectors; True for a name with a hat.
    flipped : tuple of str
        The ambiguous pieces of the text that have their less usual meaning in this reading.
    """

    lines: tuple[Chain, ...]
    plain: bool = False
    doubts: tuple[Doubt, ...] = ()
    notes: tuple[str, ...] = ()
    spelling: Mapping[str, str] = field(default_factory=dict, compare=False)
    timed: frozenset[str] = frozenset()
    vectors: Mapping[str, bool] = field(default_factory=dict, compare=False)
    flipped: tuple[str, ...] = ()

    @property
    def relation(self) -> Relation:
        """The first relation of the text, as (sign, left, right); most texts have only one."""
        return self.lines[0].links[0]


class _Text:
    """The tokens of one text, with the methods that interpret them."""

    def __init__(self, source: str, where: str, declared: Declared, numbers: bool = True) -> None:
        self.source, self.where, self.declared = source, where, declared
        prefix = f"{where}: " if where else ""
        if not isinstance(source, str):
            raise InputError(f"{prefix}expected the text of a formula, got {type(source).__name__}")
        if not source.strip():
            raise InputError(f"{prefix}expected a formula, got empty text")
        if len(source) > LONGEST_TEXT:
            raise InputError(f"{prefix}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")
        self.copied = without_surroundings(source, numbers)
        tokens = list(tokens_of(self.copied.text, where))
        if (place := self.copied.where) >= 0:  # a clause after "where" defines names of the formula before it
            clauses = [token for token in tokens[:-1] if token.start >= place]
            end = Token("mark", ";", place, place)
            tokens = [*clauses, *([end] if clauses else []), *tokens[: len(tokens) - 1 - len(clauses)], tokens[-1]]
        self.tokens, self.totals = _without_totals(_without_lowering(tokens))
        if len(self.tokens) > MOST_PIECES:
            raise InputError(f"{prefix}expected at most {MOST_PIECES} numbers, names and signs, got {len(self.tokens)}")

    def read(
        self, whole: bool, as_sympy: bool, flips: Collection[tuple[str, int]] = (), one_side: bool = False
    ) -> Reading:
        """Return the reading (interpretation) of the text in which the pieces ``flips`` have their less usual meaning.

        Parameters
        ----------
        whole : bool
            True to keep a word such as ``mgl`` as one name; False to split it into names where that is usual.
        as_sympy : bool
            Whether ``dx/dt`` is a quotient of two names, not a derivative.
        flips : collection of (str, int)
            The keys of ambiguous pieces (:class:`Doubt`) that get their less usual meaning.
        one_side : bool
            Whether the text is a formula without a relation.
        """
        marked = frozenset(_marked(self.tokens))
        marked |= _dotted(self.tokens, {*marked, *_crossed(self.tokens, marked, flips)})
        alone = {*_alone(self.tokens, marked), *self.declared.symbols}
        tokens, notes, doubts = list(self.tokens), list[str](), list[Doubt]()
        if not whole:
            words, notes, doubts = self.words(alone, flips, {*_crossed(tokens, marked, flips), *marked})
            tokens = self.without_shorthand(list(split_tokens(tokens, words)), flips, notes, doubts)
            tokens = self.with_indices(tokens, flips, doubts)
            pairs = pairwise(self.tokens)
            units = [after.text for before, after in pairs if before.kind == "number" and after.text in UNITS]
            notes += [f"{unit} is read as a name, not as a unit" for unit in units]
            alone |= set(_alone(tokens, marked))
        hats = {name.text for name, mark in pairwise(tokens) if mark.kind == "hat"}
        bare = {name.text for name, mark in pairwise(tokens) if mark.kind != "hat"}
        mixed = frozenset(filter(may_be_mixed, hats & bare))
        notes += map(on_direction, sorted(mixed))
        vocabulary = Vocabulary(
            frozenset(self.declared.symbols),
            frozenset(self.declared.functions),
            frozenset(alone),
            frozenset([*_crossed(tokens, marked, flips), *marked]),
            mixed,
        )
        lines, plain = [], not self.source.isascii() or not whole
        timed, differentiated = set[str]() if whole else {*self.declared.functions}, set[str]()
        divided = [tokens] if one_side else list(self.lines(tokens))
        if not divided:
            raise complaint(self.source, self.where, 0, "a formula")
        for pieces, line in ((own, line) for own in map(list, map(_with_signs, divided)) for line in own):
            parser = Parser(line, self.source, self.where, vocabulary, flips, as_sympy)
            signs, sides = ([], [parser.whole()]) if one_side else parser.relation()
            lines.append((signs, sides, len(pieces) > 1))
            plain |= parser.plain
            doubts += parser.doubts
            notes += [note for note in parser.notes if note not in notes]
            timed |= parser.timed
            differentiated |= parser.differentiated
        notes += [note for note in (*self.totals, *self.copied.notes) if note not in notes]
        plain |= bool(self.totals) or self.copied.text != self.source
        constants = differentiated - timed
        if constants and len(constants) < len(differentiated):
            doubt = Doubt(("constants", 0), f"d/dt with {_listed(sorted(constants))}")
            doubts.append(doubt)
            if doubt.key not in flips:
                are = "is read as a constant" if len(constants) == 1 else "are read as constants"
                notes.append(f"{_listed(sorted(constants))} {are}, having no rate in the text")
                constants = set()
        timed |= constants
        plain |= len(lines) > 1 or any(len(sides) > 2 for _, sides, _ in lines)
        finished = tuple(
            Chain(tuple(signs), tuple(_finished(side, timed, vocabulary.vectors) for side in sides), both_signs)
            for signs, sides, both_signs in lines
        )
        typed = {t.text: without_dots(self.source[t.start : t.end]) for t in tokens if t.kind == "name"}
        typed |= {name: typed[name].replace("\N{COMBINING CIRCUMFLEX ACCENT}", "") for name in mixed}
        spelling = {name: word for name, word in typed.items() if word not in ("", name)}
        flipped = tuple(dict.fromkeys(doubt.excerpt for doubt in doubts if doubt.key in flips))
        return Reading(
            finished,
            plain,
            tuple(doubts),
            tuple(dict.fromkeys(notes)),
            spelling,
            frozenset(timed),
            {name: name in hats - mixed for name in sorted(vocabulary.vectors)},
            flipped,
        )

    def words(
        self, alone: Collection[str], flips: Collection[tuple[str, int]], vectors: Collection[str]
    ) -> tuple[dict[str, tuple[str, ...]], list[str], list[Doubt]]:
        """Return the factors of each word that is a product, {"mgl": ("m", "g", "l")}, notes, and the ambiguous
        words.
        """
        # ``alone``: names that no bracket follows, so that they are no functions
        words: dict[str, tuple[str, ...]] = {}
        notes, doubts = [], []
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
                doubt = Doubt(("power of function", start), word)
                doubts.append(doubt)
                words[word] = (power[0], power[2]) if doubt.key in flips else power
                if doubt.key not in flips:
                    notes.append(f"{word} before a blank is read as {power[0]}^{power[2]}, whose raised digit was lost")
                continue
            pieces, usual = pieces_of_word(word, alone)
            if not pieces:
                continue
            usual = usual and (pieces[0], word) not in named
            if self.declared.symbols and all(piece in self.declared.symbols or piece.isdigit() for piece in pieces):
                words[word] = pieces  # the claim says which names it has
                continue
            doubt = Doubt(("word" if usual else "name", start), word)
            doubts.append(doubt)
            if usual != (doubt.key in flips):
                alone |= {piece for piece in pieces if piece in ("x", "y", "z")}
                words[word] = pieces
                notes.append(f"{word} is read as {_in_words(pieces)}, not as one name")
        return words, notes, doubts

    @property
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

    def without_shorthand(
        self, tokens: list[Token], flips: Collection[tuple[str, int]], notes: list[str], doubts: list[Doubt]
    ) -> list[Token]:
        """Return tokens with ``cos(θ)`` for ``cθ`` and ``sin(θ)`` for ``sθ`` if these are read as short forms; extend
        ``notes`` and ``doubts``.
        """
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
        doubt = Doubt(("shorthand", first.start), self.source[first.start : last.end])
        doubts.append(doubt)
        if usual == (doubt.key in flips):
            return tokens
        for form in reversed(short):
            own = tokens[form.place : form.place + form.length]
            tokens[form.place : form.place + form.length] = form.tokens(own[0], own[-1])
        notes.append(f"{doubt.excerpt} is read as {short[0].function}({short[0].angle}), and so are letters like it")
        return tokens

    def with_indices(self, tokens: list[Token], flips: Collection[tuple[str, int]], doubts: list[Doubt]) -> list[Token]:
        """Return tokens in which ``ωp``, if it is a whole left side, is usually one name omega_p, not ω times p.

        So are ``ωi`` and ``ωf`` if both occur.
        """
        padded = [None, *tokens]
        for place in range(len(tokens) - 3, -1, -1):
            before, first, second, after = padded[place], *tokens[place : place + 3]
            greek = first.kind == second.kind == "name" and first.text in GREEK_WORDS and first.end == first.start + 1
            whole = (before is None or first.breaks) and after.text in SIGNS
            # ωi and ωf anywhere, if both occur
            if greek and second.tight and second.text in FIRST_AND_LAST and self.has_first_and_last(first.text):
                whole = True
            if not greek or not whole or not second.tight or len(second.text) > 1 or first.text == "pi":
                continue
            # the less usual meaning is the product
            doubt = Doubt(("index", first.start), self.source[first.start : second.end])
            doubts.append(doubt)
            if doubt.key not in flips:
                merged = first._replace(text=f"{first.text}_{second.text}", end=second.end)
                tokens[place : place + 2] = [merged]
        return tokens

    def has_first_and_last(self, letter: str) -> bool:
        """Return whether the text has the initial and the final value of ``letter``, as ``ωi`` and ``ωf`` for ω."""
        pairs = list(pairwise(self.tokens))
        after = {second.text for first, second in pairs if first.text == letter and second.tight}
        alone = {second.text for first, second in pairs if not second.tight or first.kind != "name"}
        # if i or f is a name of its own, ωi is probably ω times i
        return {*FIRST_AND_LAST} <= after and not alone & {*FIRST_AND_LAST}

    def lines(self, tokens: Sequence[Token]) -> Iterator[list[Token]]:
        """Yield the tokens of each equation; semicolons, commas and most line breaks end one.

        A line that starts or ends with an operator, or has no relation sign, is joined to another line.
        """
        line: list[Token] = []
        depth = 0
        for token in tokens:
            at_top = depth == 0
            depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
            separates = at_top and (token.text == ";" or self.is_comma_between(line, token, tokens))
            if line and at_top and (separates or (token.breaks and self.is_new_line(line, token, tokens))):
                yield self.ended(line)
                line = []
            if separates:
                continue
            if token.kind == "end":
                break
            line.append(token)
        if line:
            yield self.ended(line)

    @staticmethod
    def is_comma_between(line: Sequence[Token], token: Token, tokens: Sequence[Token]) -> bool:
        """Return whether ``token`` is a comma between two equations, as in ``a = b, c = d``; ``line`` holds ``a =
        b``.
        """
        if token.text != "," or not any(piece.text in SIGNS for piece in line):
            return False
        after = tokens[list(tokens).index(token) + 1 :]
        end = next((n for n, piece in enumerate(after) if piece.text == "," or piece.kind == "end"), len(after))
        return any(piece.text in SIGNS for piece in after[:end])

    def is_new_line(self, line: Sequence[Token], token: Token, tokens: Sequence[Token]) -> bool:
        """Return whether the first token after a line break starts a new equation; if not, it continues ``line``."""
        if line[-1].text in ("+", "-", "*", "/", "^", "**", "·", "×", "⊗", *SIGNS) or token.kind == "end":
            return False
        if token.text in SIGNS or token.text in ("+", "*", "/", "^", "**", "·", "×", "⊗", ")", "]", ","):
            return False
        if not any(piece.text in SIGNS for piece in line):
            return False
        if token.text == "-":
            following = tokens[list(tokens).index(token) + 1 :]
            rest = next((n for n, piece in enumerate(following) if piece.breaks), len(following))
            return any(piece.text in SIGNS for piece in following[:rest])
        return True

    @staticmethod
    def ended(line: list[Token]) -> list[Token]:
        """Return the tokens of a line without commas and full stops at its end, and with an end token."""
        while len(line) > 1 and line[-1].kind == "mark" and line[-1].text in (",", "."):
            line = line[:-1]
        return [*line, Token("end", "", line[-1].end, line[-1].end)]


def _with_signs(line: list[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of a line; for a line with ± or ∓, first with the upper signs, then with the lower signs."""
    if not any(sign in token.text for token in line for sign in "±∓"):
        yield line
        return
    for signs in ({"±": "+", "∓": "-"}, {"±": "-", "∓": "+"}):
        names = {mark: {"+": "plus", "-": "minus"}[sign] for mark, sign in signs.items()}
        yield [
            token._replace(text=signs[token.text]) if token.text in signs
            else token._replace(text=token.text[:-1] + names[token.text[-1]]) if token.text[-1:] in names
            else token
            for token in line
        ]  # fmt: skip


def _alone(tokens: Sequence[Token], vectors: Collection[str]) -> Iterator[str]:
    """Yield the names in a text that no bracket follows, so that they are no functions."""
    padded = [*tokens, tokens[-1]]
    for before, token, after, last in zip((None, *tokens), tokens, tokens[1:], padded[2:], strict=False):
        own = last if is_mass_before_vector(after, last) else after
        # the x of a cross product is a sign, no name
        if token.kind == "name" and after.text != "(" and not _is_cross(before, token, after, own, vectors):
            yield token.text


def _beside_quantities(tokens: Sequence[Token]) -> Iterator[tuple[str, str]]:
    """Yield (I, Ic) for each word after ``I =`` in one equation: in ``I = Ic + m d^2`` the quantity I is no factor."""
    quantity = ""
    for before, token, after in zip((None, *tokens), tokens, (*tokens[1:], tokens[-1]), strict=False):
        if before is None or token.breaks or token.text in (";", ","):
            quantity = ""
        starts = before is None or token.breaks or before.text in (";", ",")
        if starts and token.kind == "name" and after.text in ("=", "=="):
            quantity = token.text
        elif quantity and token.kind == "name":
            yield quantity, token.text


def _is_cross(before: Token | None, token: Token, after: Token, factor: Token, vectors: Collection[str]) -> bool:
    """Return whether ``token`` is an x that means a cross product, as in ``r x v``; ``before`` is r, ``factor`` is
    v.
    """
    if token.text != "x" or not token.spaced or not after.spaced or before is None:
        return False
    # in r x m v the token after the x is the mass m, and the factor is v
    return is_cross_letter(before, factor, vectors)


def _crossed(tokens: Sequence[Token], vectors: Collection[str], flips: Collection[tuple[str, int]]) -> Iterator[str]:
    """Yield the names next to a cross product's sign, ``×`` or an x: they are vectors."""
    alone = set(_alone(tokens, vectors))
    padded = [*tokens, tokens[-1]]
    # a text with rates would make functions of time of the names in cross(a, b)
    if any(token.kind in ("prime", "dots") for token in tokens):
        for function, opening, operand, closing in zip(tokens, tokens[1:], tokens[2:], padded[3:], strict=False):
            is_call = function.text in ("cross", "skew") and opening.text == "(" and closing.text in (",", ")")
            if is_call and operand.kind == "name":
                yield operand.text
    for before, sign, after, last in zip(tokens, tokens[1:], tokens[2:], padded[3:], strict=False):
        factor = last if is_mass_before_vector(after, last) else after
        # flips holds the keys of letters x that are names in this reading
        if (sign.kind == "mark" and sign.text == "×") or (
            "x" not in alone and _is_cross(before, sign, after, factor, vectors) and ("cross", sign.start) not in flips
        ):
            if "number" in (before.kind, after.kind):
                continue
            is_factor = after.text[:1].isupper() or not is_usual_vector(after.text)  # R a x R b and r x m v
            is_vector = is_usual_vector(last.text) or after.text in ("m", "M")
            is_followed = last.kind == "name" and last.text != "x" and is_vector
            own = last if is_factor and is_followed and not last.breaks else after
            yield from (token.text for token in (before, own) if token.kind == "name")


def _without_lowering(tokens: list[Token]) -> list[Token]:
    """Return tokens without the mark that lowers a cross, as in ``[k]_×``."""
    padded = [*tokens, tokens[-1]]
    triples = zip([tokens[0], *tokens], tokens, padded[1:], strict=False)
    return [
        token for before, token, after in triples
        if not (before.text == "]" and token.text == "_" and after.text in ("×", "x"))
    ]  # fmt: skip


def _without_totals(tokens: list[Token]) -> tuple[list[Token], list[str]]:
    """Return tokens with M_x for a total ``ΣM_x``, without the sum sign, and a note on each total."""
    others, notes = [], []
    for token, after in zip(tokens, [*tokens[1:], tokens[-1]], strict=True):
        # the total of all torques is one quantity, named M_x
        is_sum = token.kind == "sum" or (token.kind, token.text) == ("name", "sum")
        if is_sum and after.kind == "name" and re.fullmatch(r"(M|F|N|T|tau|Gamma)(_\w+|[A-Za-z0-9])?", after.text):
            notes.append(f"the sum of {after.text} is read as one quantity, the total")
        else:
            others.append(token)
    return others, notes


def _marked(tokens: Sequence[Token]) -> Iterator[str]:
    """Yield the names that signs show to be vectors, such as ``a`` with a hat, ``[n]×`` or ``a . b``."""
    triples = list(zip(tokens, tokens[1:], tokens[2:], strict=False))
    yield from _by_angle(tokens)
    lengths = {name.text for left, name, right in triples if left.text == right.text == "|" and name.kind == "name"}
    norms = [place for place, token in enumerate(tokens) if token.text == "‖"]
    for start, end in zip(norms[::2], norms[1::2], strict=False):
        lengths |= {token.text for token in tokens[start:end] if token.kind == "name"} - {"q", "p"}  # no quaternions
    # a·b = |a| |b| cos x, ‖a + b‖² = ‖a‖² + 2 a·b + ‖b‖²: names whose lengths occur
    for left, dot, right in triples:
        if dot.text == "·" and {left.text, right.text} <= lengths:
            yield from (left.text, right.text)
    for place in range(len(tokens) - len(DOT_OF_PRODUCTS)):
        pieces = [tokens[place + n].text for n in range(len(DOT_OF_PRODUCTS))]
        if all(sign in (None, piece) for sign, piece in zip(DOT_OF_PRODUCTS, pieces, strict=True)):
            (matrix, first), (other, second) = pieces[1:3], pieces[6:8]
            # (R a)·(R b): names that one matrix rotates
            if matrix == other and matrix.isupper() and is_usual_vector(first) and is_usual_vector(second):
                yield from (first, second)
    for place, name in enumerate(tokens[:-1]):
        before, after, last = tokens[max(place - 1, 0)], tokens[place + 1], tokens[min(place + 2, len(tokens) - 1)]
        bracketed = before.text == "["
        if name.kind == "name" and (
            after.kind in ("hat", "tilde")
            or (bracketed and after.text == "]" and last.text in ("x", "×") and last.tight)
            or (bracketed and after.text in ("x", "×") and last.text == "]")
            or (before.text == "(" and after.text == ")" and tokens[max(place - 2, 0)].text == "S")
            or (_is_dot(after) and last.spaced and last.kind == "name")
            or (_is_dot(before) and name.spaced)
        ):
            yield name.text


def _dotted(tokens: Sequence[Token], vectors: Collection[str]) -> set[str]:
    """Return the usual names of vectors at a dot beside one of ``vectors`` or beside a cross product: v in ``n·v``."""
    names: set[str] = set()
    for place, dot in enumerate(tokens):
        if dot.text != "·" or not 0 < place < len(tokens) - 1:
            continue
        before, after = tokens[place - 1], tokens[place + 1]
        owner = tokens[place - 2] if before.kind == "hat" else before
        is_crossed = before.text == ")" and "×" in [
            token.text for token in tokens[max(place - 4, 0) : place]
        ]  # (a × b)·c
        is_left = owner.text in vectors or is_crossed
        names |= {token.text for token, beside in ((after, is_left), (before, after.text in vectors)) if beside}
    usual = {name for name in names if is_usual_vector(name) or name == "g"}
    return usual - {*vectors, *SHARED}


SCALARS = ("m", "I", "J", "t")
"""Letters that no book uses for a vector: masses, moments of inertia and times."""


def _by_angle(tokens: Sequence[Token]) -> Iterator[str]:
    """Yield F and d for ``F·d = F d cos θ``: a scalar product that equals the product of both lengths."""
    sides: list[list[str]] = [[]]
    for token in tokens:
        if token.text in ("=", "=="):
            sides.append([])
        elif token.kind != "end":
            sides[-1].append(token.text)
    for product, lengths in [*pairwise(sides), *pairwise(sides[::-1])]:
        if len(product) != 3 or product[1] != "·" or product[0] == product[2]:
            continue
        first, _, second = product
        names = [word for word in lengths if word not in ("*", "·", "|", "(", ")")]
        has_lengths = {first, second} <= {*names} or first + second in names
        has_cosine = "cos" in names and len(names) <= 4 and first.isalpha() and second.isalpha()
        has_vectors = is_usual_vector(first) and is_usual_vector(second)
        are_letters = len(first) == len(second) == 1 and not {first, second} & {*SCALARS}
        # for numbers, F·d = F d without a cosine says nothing: the letters are vectors if books usually mean vectors
        is_bare = lengths in ([first, second], [second, first], [first + second]) and has_vectors
        if has_lengths and (is_bare or (has_cosine and (has_vectors or are_letters))):
            yield from (first, second)


def _is_dot(token: Token) -> bool:
    return token.kind == "mark" and token.text == "." and token.spaced


def _in_words(pieces: Sequence[str]) -> str:
    if pieces[0] in ("sin", "cos", "tan", "cot", "sec", "csc") or pieces[0].startswith(("asin", "acos", "atan", "arc")):
        return f"{pieces[0]} {''.join(pieces[1:])}"
    return f"the product {'*'.join(pieces)}"


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _finished(node: Node, timed: Collection[str], vectors: Collection[str], parent: str = "") -> Node:
    """Return the final tree of a typed formula: ``f(t)`` for the names ``timed``, and matrices for lists."""
    # vectors stay without (t), and their squares become scalar products
    if node.kind in ("name", "call") and node.value in vectors:
        return Node("name", node.value, (), node.span)
    if node.kind == "name" and node.value in timed:
        return Node("call", node.value, (TIME,), node.span)
    if node.kind == "call" and node.value in timed:
        return node
    if node.kind == "power" and node.args[0].value in vectors and node.args[1] == number(2):
        own = _finished(node.args[0], timed, vectors)
        return Node("call", "dot", (own, own), node.span)
    if node.kind == "power" and node.args[0].value in vectors and node.args[1].kind == "number":
        return replace(node, args=(length(_finished(node.args[0], timed, vectors)), node.args[1]))
    nested = parent == "transpose" and node.kind == "list" and node.args[0].kind == "list"
    if node.kind == "list" and (parent not in ("call", "list", "transpose", "index") or nested):
        if len(node.args) == 1:
            return _finished(node.args[0], timed, vectors, parent)
        inside = replace(node, value=("[", "]"), args=tuple(_finished(a, timed, vectors, "list") for a in node.args))
        return Node("call", "Matrix", (inside,), node.span)
    if not node.args:
        return node
    return replace(node, args=tuple(_finished(child, timed, vectors, node.kind) for child in node.args))


def with_time(node: Node, names: Collection[str]) -> Node:
    """Return a tree with ``f(t)`` for each name f in ``names``."""
    if node.kind == "name" and node.value in names:
        return Node("call", node.value, (TIME,))
    if node.kind == "call" and node.value in names:
        return node
    return Node(node.kind, node.value, tuple(with_time(child, names) for child in node.args), node.span)


def readings_of(source: str, where: str = "", declared: Declared | None = None) -> list[Reading]:
    """Return the readings (interpretations) of a claim, the usual one first.

    Raises
    ------
    InputError
        If the text cannot be read; the message gives the first such position.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> [text(reading.relation[2]) for reading in readings_of("T = 1/2m v^2")]
    ['1/2*m*v**2', '1/(2*m)*v**2']
    """
    text = _Text(source, where, declared or Declared())
    readings = list(_readings(text, False))
    if text.copied.numbers:
        try:
            others = _readings(_Text(source, where, declared or Declared(), numbers=False), False)
        except InputError:
            return readings
        readings += [replace(reading, flipped=text.copied.numbers) for reading in others]
    return distinct_readings(readings)


def _readings(text: _Text, one_side: bool) -> Iterable[Reading]:
    strict, refusal = None, None
    try:
        strict = text.read(whole=True, as_sympy=True, one_side=one_side)
    except InputError as reason:
        refusal = reason
    if strict is not None and not strict.plain:
        others = (
            replace(r, flipped=r.flipped or tuple(d.excerpt for d in r.doubts)) for r in _typed(text, one_side, False)
        )
        return distinct_readings([strict, *others])
    try:
        return distinct_readings(_typed(text, one_side, True))
    except InputError as reason:
        raise (refusal or reason) from None


def _typed(text: _Text, one_side: bool, required: bool) -> Iterator[Reading]:
    """Yield the readings of a text that is not SymPy syntax, the usual one first.

    Raise InputError for an unreadable text if ``required``.
    """
    try:
        yield from each_reading(lambda flips: text.read(False, False, flips, one_side))
    except InputError:
        if required:
            raise


def each_reading(read: Callable[[Collection[tuple[str, int]]], Reading]) -> Iterator[Reading]:
    """Yield the usual reading ``read(())`` of a text, then ``read(flips)`` for other sets of keys ``flips``."""
    usual = read(())
    yield usual
    keys = list(dict.fromkeys(doubt.key for doubt in usual.doubts))[:MOST_DOUBTS]
    kinds = dict.fromkeys(kind for kind, _ in keys)
    choices = [{key for key in keys if key[0] == kind} for kind in kinds]  # a writer is consistent
    choices += [{key} for key in keys if key[0] not in ("word", "name")]
    for flips in choices:
        try:
            yield read(flips)
        except InputError:
            continue


def distinct_readings(readings: Iterable[Reading]) -> list[Reading]:
    """Return at most MOST_READINGS readings (interpretations) with different trees, the usual one first."""
    by_trees: dict[Any, Reading] = {}
    for reading in readings:
        by_trees.setdefault(reading.lines, reading)
    usual, *others = by_trees.values()
    if len(others) >= MOST_READINGS:
        # the user learns that some are dropped
        note = f"the text has more readings than the {MOST_READINGS} that are decided here; brackets leave fewer"
        usual = replace(usual, notes=(*usual.notes, note))
    return [usual, *others[: MOST_READINGS - 1]]


def _only(readings: Sequence[Reading], source: str, where: str, rates: bool = False) -> Reading:
    """Return the usual reading of a text; raise InputError if the text is ambiguous, except for primes if ``rates``."""
    usual = readings[0]
    # with ``rates``, x' is always the rate of x, and no prime is ambiguous
    doubts = [doubt for doubt in usual.doubts if not (rates and doubt.key[0] == "prime")]
    if usual.plain and len(readings) > 1 and doubts:
        doubt = doubts[0]
        raise complaint(source, where, doubt.key[1], f"brackets or product signs ({doubt.excerpt!r} has two readings)")
    return usual


def read_expression(source: str, where: str = "", declared: Declared | None = None) -> Node:
    """Return the tree of a formula.

    Parameters
    ----------
    source : str
        At most 20 000 characters, nested at most 60 deep.
    where : str
        The place of the text, which begins every error message.
    declared : Declared, optional
        The names that have a meaning.

    Raises
    ------
    InputError
        If the text cannot be read or has two readings; the message gives the first such position.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> text(read_expression("a - (b*(c))/d")), text(read_expression("2x sin^2(y)"))
    ('a - b*c/d', '2*x*sin(y)**2')
    """
    text = _Text(source, where, declared or Declared())
    strict, refusal = _strict(text, True)
    if strict is not None:
        return strict.lines[0].sides[0]
    try:
        readings = distinct_readings(_typed(text, True, True))
    except InputError as reason:
        raise (refusal or reason) from None
    return _only(readings, source, where).lines[0].sides[0]


def read_relation(source: str, where: str = "", declared: Declared | None = None, rates: bool = False) -> Relation:
    """Return (sign, left, right) of an equation or inequality.

    If ``rates``, ``x'`` is the rate of x; otherwise a prime is ambiguous.

    Raises
    ------
    InputError
        As :func:`read_expression`, and if there is no relation sign or more than one.
    """
    text = _Text(source, where, declared or Declared())
    strict, refusal = _strict(text, False)
    if strict is None:
        try:
            strict = _only(distinct_readings(_typed(text, False, True)), source, where, rates)
        except InputError as reason:
            raise (refusal or reason) from None
    if len(strict.lines) > 1 or len(strict.lines[0].signs) > 1:
        second = strict.lines[1].sides[0] if len(strict.lines) > 1 else strict.lines[0].sides[2]
        raise complaint(source, where, second.span[0], "one '==', not a chain of them,")
    if hats := [name for name, has_hat in strict.vectors.items() if has_hat]:
        hat = source.index("\N{COMBINING CIRCUMFLEX ACCENT}") if "\N{COMBINING CIRCUMFLEX ACCENT}" in source else 0
        name = hats[0]
        expected = f"a vector without a hat here (write {name}, and add the hypothesis {name} . {name} = 1)"
        raise complaint(source, where, hat, expected)
    return strict.relation


def _strict(text: _Text, one_side: bool) -> tuple[Reading | None, InputError | None]:
    """Return (reading, None) for SymPy syntax, (None, error) for an unreadable text, (None, None) for a typed one,
    ``2x``.
    """
    try:
        strict = text.read(whole=True, as_sympy=True, one_side=one_side)
    except InputError as reason:
        return None, reason
    # a readable text may have other notation too, such as 2x
    return (None if strict.plain else strict), None

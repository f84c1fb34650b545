"""The reader of claims: from text to trees, without Python's ``eval`` and without SymPy.

It reads SymPy syntax, and formulas as people type them, such as ``2x``, which may have several readings: see
:mod:`symrot.checker.typed.readings`.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from symrot.checker.claim.tree import TIME, Node, number
from symrot.checker.claim.vectors import length, may_be_mixed, on_direction
from symrot.checker.typed.ambiguous_words import WordReader
from symrot.checker.typed.copied_text import without_surroundings
from symrot.checker.typed.cursor import Doubt, Vocabulary
from symrot.checker.typed.grammar import Parser
from symrot.checker.typed.lines import lines_of, with_signs
from symrot.checker.typed.readings import Chain, Declared, Reading, Relation, distinct_readings, each_reading
from symrot.checker.typed.tokens import Token, tokens_of, without_dots
from symrot.checker.typed.vector_names import crossed, dotted, marked, names_alone
from symrot.errors import InputError, complaint

__all__ = [
    "MOST_PIECES", "check_length", "on_constants", "read_expression", "read_relation", "readings_of", "with_time",
]  # fmt: skip

LONGEST_TEXT = 20_000
MOST_PIECES = 5_000


def check_length(source: str, place: str = "") -> None:
    """Raise InputError for a text of more than LONGEST_TEXT characters; ``place`` is the beginning of the message."""
    if len(source) > LONGEST_TEXT:
        raise InputError(f"{place}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")


class _Text:
    """The tokens of one text, with the methods that interpret them."""

    def __init__(self, source: str, where: str, declared: Declared, numbers: bool = True) -> None:
        self.source, self.where, self.declared = source, where, declared
        prefix = f"{where}: " if where else ""
        if not isinstance(source, str):
            raise InputError(f"{prefix}expected the text of a formula, got {type(source).__name__}")
        if not source.strip():
            raise InputError(f"{prefix}expected a formula, got empty text")
        check_length(source, prefix)
        self.copied = without_surroundings(source, numbers)
        tokens = list(tokens_of(self.copied.text, where))
        if (place := self.copied.where) >= 0:  # a clause after "where" defines names of the formula before it
            clauses = [token for token in tokens[:-1] if token.start >= place]
            end = Token("mark", ";", place, place)
            tokens = [*clauses, *([end] if clauses else []), *tokens[: len(tokens) - 1 - len(clauses)], tokens[-1]]
        self.tokens, self.totals = _without_totals(_without_lowering(tokens))
        if len(self.tokens) > MOST_PIECES:
            raise InputError(f"{prefix}expected at most {MOST_PIECES} numbers, names and signs, got {len(self.tokens)}")

    def read(self, as_sympy: bool, one_side: bool, flips: Collection[tuple[str, int]] = ()) -> Reading:
        """Return the reading (interpretation) of the text in which the parts ``flips`` have their less usual
        meaning.

        Parameters
        ----------
        as_sympy : bool
            Whether a word such as ``mgl`` is one name, and ``dx/dt`` a quotient of two names, not a derivative.
        one_side : bool
            Whether the text is a formula without a relation.
        flips : collection of (str, int)
            The keys of ambiguous pieces (:class:`Doubt`) that get their less usual meaning.
        """
        marked_names = frozenset(marked(self.tokens))
        marked_names |= dotted(self.tokens, {*marked_names, *crossed(self.tokens, marked_names, flips)})
        alone = {*names_alone(self.tokens, marked_names), *self.declared.symbols}
        tokens, notes, doubts = list(self.tokens), list[str](), list[Doubt]()
        if not as_sympy:
            words = WordReader(self.source, self.tokens, self.declared, flips)
            tokens = words.read(alone, {*crossed(tokens, marked_names, flips), *marked_names})
            notes, doubts = words.notes, words.doubts
            alone |= set(names_alone(tokens, marked_names))
        hats = {name.text for name, mark in pairwise(tokens) if mark.kind == "hat"}
        bare = {name.text for name, mark in pairwise(tokens) if mark.kind != "hat"}
        mixed = frozenset(filter(may_be_mixed, hats & bare))
        notes += map(on_direction, sorted(mixed))
        vocabulary = Vocabulary(
            frozenset(self.declared.symbols),
            frozenset(self.declared.functions),
            frozenset(alone),
            frozenset([*crossed(tokens, marked_names, flips), *marked_names]),
            mixed,
        )
        lines, plain = [], not self.source.isascii() or not as_sympy
        timed, differentiated = set[str]() if as_sympy else {*self.declared.functions}, set[str]()
        divided = [tokens] if one_side else list(lines_of(tokens))
        if not divided:
            raise complaint(self.source, self.where, 0, "a formula")
        for pieces, line in ((own, line) for own in map(list, map(with_signs, divided)) for line in own):
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
                notes.append(on_constants(sorted(constants)))
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


def _without_lowering(tokens: list[Token]) -> list[Token]:
    """Return tokens without the mark ``_`` between a bracket and a cross, as in ``[k]_×``."""
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


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def on_constants(names: Sequence[str]) -> str:
    """Return the note for the user that ``names`` inside a time derivative are read as constants."""
    are, them = ("is read as a constant", "it") if len(names) == 1 else ("are read as constants", "them")
    return f"{_listed(names)} {are}, since the text has no rate of {them}, such as d{names[0]}/dt"


def _finished(node: Node, timed: Collection[str], vectors: Collection[str], parent: str = "") -> Node:
    """Return a parsed formula with ``f(t)`` for each name in ``timed``, and with a matrix for each list.

    The names in ``vectors`` stay without (t), and their squares become scalar products. ``parent`` is the kind of the
    node above ``node``: a list remains a list if it is, for instance, an argument of a function ("call").
    """
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
    """Return up to 6 readings (interpretations) of a claim, the usual one first.

    Raises
    ------
    InputError
        If the text cannot be read.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> [text(reading.relation[2]) for reading in readings_of("T = 1/2m v^2")]
    ['1/2*m*v**2', '1/(2*m)*v**2']
    """
    text = _Text(source, where, declared or Declared())
    readings = _readings(text)
    if text.copied.numbers:
        try:
            others = _readings(_Text(source, where, declared or Declared(), numbers=False))
        except InputError:
            return readings
        readings += [replace(reading, flipped=text.copied.numbers) for reading in others]
    return distinct_readings(readings)


def _readings(text: _Text) -> list[Reading]:
    strict, refusal = _strict(text, False)
    if strict is None:
        return _all_typed(text, False, refusal)
    try:
        typed = list(_typed(text, False))
    except InputError:
        return [strict]
    others = (replace(r, flipped=r.flipped or tuple(doubt.excerpt for doubt in r.doubts)) for r in typed)
    return distinct_readings([strict, *others])


def _all_typed(text: _Text, one_side: bool, refusal: InputError | None) -> list[Reading]:
    """Return the readings of a text that is not SymPy syntax.

    ``one_side`` says that the text is a formula without a relation. ``refusal`` is the error with which the rules of
    SymPy refused the text, or None. If the text has no other reading either, raise ``refusal``; if that is None, raise
    the error with which the other rules refused the text.
    """
    try:
        return distinct_readings(_typed(text, one_side))
    except InputError as reason:
        raise (refusal or reason) from None


def _typed(text: _Text, one_side: bool) -> Iterator[Reading]:
    """Yield the readings of a text that is not SymPy syntax, the usual one first; raise InputError if unreadable."""
    return each_reading(lambda flips: text.read(False, one_side, flips))


def _only(text: _Text, one_side: bool, rates: bool = False) -> Reading:
    """Return the usual reading of a text; raise InputError if the text is unreadable, or ambiguous.

    ``one_side`` says that the text is a formula without a relation. If ``rates``, a prime always means a rate, and x'
    makes no text ambiguous.
    """
    strict, refusal = _strict(text, one_side)
    if strict is not None:
        return strict
    usual, *others = _all_typed(text, one_side, refusal)
    doubts = [doubt for doubt in usual.doubts if not (rates and doubt.key[0] == "prime")]
    if usual.plain and others and doubts:
        expected = f"brackets or product signs ({doubts[0].excerpt!r} has two readings)"
        raise refusal or complaint(text.source, text.where, doubts[0].key[1], expected)
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
        The names of symbols and functions of time.

    Raises
    ------
    InputError
        If the text cannot be read or has two readings.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> text(read_expression("a - (b*(c))/d")), text(read_expression("2x sin^2(y)"))
    ('a - b*c/d', '2*x*sin(y)**2')
    """
    return _only(_Text(source, where, declared or Declared()), True).lines[0].sides[0]


def read_relation(source: str, where: str = "", declared: Declared | None = None, rates: bool = False) -> Relation:
    """Return (sign, left, right) of an equation or inequality.

    If ``rates``, ``x'`` is the rate of x; otherwise a prime is ambiguous.

    Raises
    ------
    InputError
        As :func:`read_expression`, and if there is no relation sign or more than one, a second line, or a hat on a
        vector.
    """
    usual = _only(_Text(source, where, declared or Declared()), False, rates)
    if len(usual.lines) > 1 or len(usual.lines[0].signs) > 1:
        second = usual.lines[1].sides[0] if len(usual.lines) > 1 else usual.lines[0].sides[2]
        raise complaint(source, where, second.span[0], "one '==', not a chain of them,")
    if hats := [name for name, has_hat in usual.vectors.items() if has_hat]:
        hat, name = max(source.find("\N{COMBINING CIRCUMFLEX ACCENT}"), 0), hats[0]
        expected = f"a vector without a hat here (write {name}, and add the hypothesis {name} . {name} = 1)"
        raise complaint(source, where, hat, expected)
    return usual.relation


def _strict(text: _Text, one_side: bool) -> tuple[Reading | None, InputError | None]:
    """Return (reading, None) for SymPy syntax, and (None, error) for a text that cannot be read by the rules of SymPy.

    Return (None, None) for a text that these rules can read, but that has other notation too, such as ``2x``.
    """
    try:
        strict = text.read(True, one_side)
    except InputError as reason:
        return None, reason
    return (None if strict.plain else strict), None

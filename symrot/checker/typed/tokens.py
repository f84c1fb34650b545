"""Splitting a claim as people type it into tokens: ASCII and Unicode, each with its position in the text.

Greek letters become names, dots and primes derivatives, raised digits powers. A character that means nothing in a
formula is refused.
"""

import re
import unicodedata
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from symrot.errors import complaint
from symrot.latex.tokens import GREEK

__all__ = ["GREEK_WORDS", "LETTERS", "LONGEST_NUMBER", "SIGNS", "Token", "tokens_of", "without_dots"]

LONGEST_NUMBER = 200
"""The largest number of characters in a number, also in a superscript; Python converts at most 4300 digits."""

SIGNS = ("==", "=", "!=", ">=", "<=", ">", "<")
"""The signs between the two sides of an equation or inequality."""


class Token(NamedTuple):
    """A token of a claim.

    Attributes
    ----------
    kind : str
        ``number``, ``name``, ``mark``, ``power`` (raised digits), ``fraction`` (such as ½), ``dots`` (over the name
        before), ``hat``, ``tilde``, ``prime``, ``sum`` (Σ before a total) or ``end``.
    text : str
        The text, with names and digits in ASCII: ``omega_1`` for ω₁.
    start, end : int
        Its first position in the source, and the position after it.
    spaced, breaks : bool
        Whether blanks, or the end of a line, are before it.
    """

    kind: str
    text: str
    start: int
    end: int
    spaced: bool = False
    breaks: bool = False

    @property
    def tight(self) -> bool:
        """Whether there is no blank between this token and the token before it."""
        return not self.spaced


LETTERS: Mapping[str, str] = {
    character: name.removeprefix("var") for name, character in GREEK.items() if name not in ("Sigma", "Pi")
} | {"π": "pi"}
"""Greek letter -> its name. Capital sigma and pi are left out, since they mean sums and products."""

GREEK_WORDS = frozenset(LETTERS.values())
_GREEK = "".join(LETTERS)
_DOTS = {"\u0307": 1, "\u0308": 2, "\u20db": 3}
_SIGNS_OVER = {"\u0302": "hat", "\u0303": "tilde", "\u0304": "bar", "\u0305": "bar"}
"""Mark over a letter -> name of the mark.

A hat marks a unit vector, a tilde a skew matrix. A letter with a bar is a name of its own: x̄ is x_bar.
"""

_OVER = {*_DOTS, *_SIGNS_OVER}
_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ᵀ", "0123456789+-T", strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉ₓₐₑₒₕₖₗₘₙₚₛₜᵢⱼᵣᵤᵥᵧ", "0123456789xaeohklmnpstijruvy", strict=True))
_ALIKE = {
    "−": "-", "–": "-", "∗": "*", "∙": "·", "⋅": "·", "•": "·", "÷": "/", "∕": "/", "⁄": "/", "≡": "==", "≠": "!=",
    "≥": ">=", "≤": "<=", "⩾": ">=", "⩽": "<=",
    "′": "'", "’": "'", "″": "''", "‴": "'''", "µ": "μ",
    "\u2126": "Ω", "º": "°", "⨯": "×", "∥": "‖", "⊙": "⊗", "˚": "°", "\ufeff": " ", "\u2061": " ", "\u2062": " ",
    "˙": "\u0307", "¨": "\u0308", "ˆ": "\u0302", "˜": "\u0303", "¯": "\u0304",
}  # fmt: skip
"""Character -> the usual character or characters with the same meaning, which replace it."""

_FRACTIONS = frozenset("½⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅛⅜⅝⅞⅒")

_HINTS = {
    "\\": "LaTeX goes into latex = ..",     "∬": "write integrate(f, (x, from, to))",
    "∭": "write integrate(f, (x, from, to))",
    "∑": "write the terms of a sum with +", "Σ": "write the terms of a sum with +", "∏": "write the factors with *",
    "Π": "write the factors of a product with *",
    "{": "write ( ) or [ ] for brackets", "}": "write ( ) or [ ] for brackets", "∞": "a claim is about finite numbers",
    "\u20d7": "write cross([ax, ay, az], [bx, by, bz]) for vectors",
    "!": "a factorial is read for numbers up to 30; write other products with *",
    "%": "write /100", "∇": "write diff(f, x)", "\u00ad": "a soft hyphen: write - or delete it",
    "&": "write two claims, each on a line",
    "≈": "write = and the value to as many digits as you know, such as x = 0.333",
    "→": "write =", "⇒": "write two claims, each on a line",
}  # fmt: skip
"""Character that is refused -> what to write instead."""

_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_MARK = re.compile(r"\*\*|==|!=|>=|<=|:=|[-+*/(),\[\].=<>^;|√×·°⊗∘‖±∓†∫]")
_SUBSCRIPT = re.compile(rf"_(?:[A-Za-z0-9]+|[{_GREEK}±∓])|[{''.join(_LOWERED)}]+")
_PRIMED = re.compile(rf"'+(?=[{''.join(_LOWERED)}])")
"""Pattern of the primes between a letter and its lowered subscript, as in ``ω'₁``."""

_OF_MOMENTUM = re.compile(rf"[φϕθψ](?![{''.join(_OVER)}_{''.join(_LOWERED)}0-9(])")
"""Pattern of an angle after a p, such as φ in ``pφ``: together they name the momentum that belongs to the angle."""

_AXIS_PAIR = re.compile("[IJP]_[xyz]'[xyz]'")
"""Pattern of a product of inertia about two axes with primes, such as ``I_x'y'``."""

_COMPONENT = re.compile(r"[0-9]+|(?:xx|yy|zz|xy|yz|zx|xz|yx|zy|[xyz])(?![A-Za-z0-9])", re.ASCII)
_SMALL_FRACTION = re.compile(r"(?<![\w)\]])([⁰¹²³⁴⁵⁶⁷⁸⁹]+)/([₀₁₂₃₄₅₆₇₈₉]+)")
_DIGITS = re.compile(r"[0-9]+", re.ASCII)


def tokens_of(source: str, where: str = "") -> Iterator[Token]:
    """Yield the tokens of a text; the last one has the kind ``end``.

    Raises
    ------
    InputError
        For a character that means nothing in a formula, with what to write instead if that is known; for a number of
        more than LONGEST_NUMBER characters.
    """
    text, places = _accents_after_letters(*_written_out(source.rstrip()))
    places.append(len(source.rstrip()))
    at, last = 0, len(text)
    blank = line = False
    while at < last:
        if text[at].isspace():
            blank, line = True, line or text[at] == "\n"
            at += 1
            continue
        begin = at
        for kind, word, stop in _pieces(text, at):
            if kind in ("number", "power", "fraction") and len(word) > LONGEST_NUMBER:
                raise complaint(source, where, places[at], f"a number of at most {LONGEST_NUMBER} characters")
            yield Token(kind, word, places[at], places[stop], blank, line)
            blank = line = False
            at = stop
        if at == begin:
            hint = _HINTS.get(text[at])
            expected = "a number, a name, an operator or a bracket" + (f" ({hint})" if hint else "")
            raise complaint(source, where, places[at], expected)
    yield Token("end", "", places[last], places[last], blank, line)


def without_dots(name: str) -> str:
    """Return a typed name without the dots over it."""
    parts = (_ALIKE.get(part, part) for part in unicodedata.normalize("NFD", name))
    return "".join(part for part in parts if part not in _DOTS)


def _written_out(source: str) -> tuple[str, list[int]]:
    """Return the text with one spelling of each sign, ``*`` for ``∗``, and the position in ``source`` of each
    character.
    """
    written: list[str] = []
    places: list[int] = []
    for place, character in enumerate(source):
        alike = _alike(character)
        written.append(alike)
        places.extend([place] * len(alike))
    return "".join(written), places


def _accents_after_letters(text: str, places: list[int]) -> tuple[str, list[int]]:
    """Return a text with each dot or hat moved behind its letter, and the position of each character in the source.

    ``places`` are these positions for the given ``text``.
    """
    # text that was copied from a PDF has them before the letters
    text, places = _without_blanks_before_dots(text, places)
    characters, places = list(text), [*places]
    for at in range(len(characters) - 1):
        alone = characters[at] in _OVER and not (at and (characters[at - 1].isalpha() or characters[at - 1] in _OVER))
        if alone and characters[at + 1].isalpha():
            characters[at], characters[at + 1] = characters[at + 1], characters[at]
            places[at], places[at + 1] = places[at + 1], places[at]
    return "".join(characters), places


def _without_blanks_before_dots(text: str, places: list[int]) -> tuple[str, list[int]]:
    """Return a text with ``ω˙ =`` for ``ω ˙ =``, and where each of its characters is in the source.

    ``places`` are the positions of the characters of ``text``.
    """
    dots = "".join(_DOTS)
    # some PDFs have a blank between a letter and its dot; a dot before a letter may belong to that letter
    gaps = [match.start(1) for match in re.finditer(rf"(?<=[^\W\d_])( )[{dots}](?=\s|$)", text)]
    return (
        "".join(character for place, character in enumerate(text) if place not in gaps),
        [where for place, where in enumerate(places) if place not in gaps],
    )


def _alike(character: str) -> str:
    if character.isascii():
        return character
    if "\U0001d400" <= character <= "\U0001d7ff" or character in "ℎ":  # slanted and bold letters of a typeset text
        character = unicodedata.normalize("NFKC", character)
    parts = unicodedata.normalize("NFD", character)
    if len(parts) > 1 and (parts[0].isascii() or parts[0] in LETTERS) and all(part in _OVER for part in parts[1:]):
        return parts  # a letter with dots or another mark over it
    return _ALIKE.get(character, character)


def _pieces(text: str, at: int) -> Iterator[tuple[str, str, int]]:
    """Yield (kind, text, end) of the tokens that start at the position ``at``; end is the position after the token.

    They are one token, or a name and its marks, such as primes and dots; none if no token can start there.
    """
    character = text[at]
    if number := _NUMBER.match(text, at):
        yield "number", number[0], number.end()
    elif character in "Σ∑" and re.match(r"[Σ∑]\s*[MFNTτΓ]", text[at:]):
        yield "sum", character, at + 1
    elif fraction := _SMALL_FRACTION.match(text, at):
        yield "fraction", "/".join(_written(part) for part in fraction.groups()), fraction.end()
    elif character in LETTERS:
        yield from _letter(text, at, LETTERS[character])
    elif character == "∂":
        yield from _differential(text, at + 1)
    elif character == "_" and at and text[at - 1] in ")]":
        yield "mark", "_", at + 1
    elif text[:at].rstrip().endswith("∫") and (character == "_" or character in _LOWERED):
        yield from _lower_limit(text, at)
    elif name := _NAME.match(text, at):
        yield from _name(text, at, name)
    elif mark := _MARK.match(text, at):
        yield "mark", "=" if mark[0] == ":=" else mark[0], mark.end()
    elif character == "'":
        stop = at + 1
        while text[stop : stop + 1] == "'":
            stop += 1
        yield "prime", text[at:stop], stop
    elif character == "~" and at and text[at - 1].isalnum():
        yield "tilde", "tilde", at + 1
    elif character in _RAISED:
        stop = at
        while text[stop : stop + 1] and text[stop] in _RAISED:
            stop += 1
        yield "power", "".join(_RAISED[c] for c in text[at:stop]), stop
    elif character in _FRACTIONS:
        yield "fraction", str(Fraction(unicodedata.numeric(character)).limit_denominator(10)), at + 1


def _differential(text: str, at: int) -> Iterator[tuple[str, str, int]]:
    """Yield (kind, text, end) of the tokens of a partial differential, without its sign: the name dT for ``∂T``.

    ``at`` is the position after the sign ``∂``. Yield the name d for ``∂`` alone.
    """
    name = _NAME.match(text, at)
    if text[at : at + 1] in LETTERS:
        pieces = [*_pieces(text, at)]
    else:
        pieces = [*_name(text, at, name)] if name else [("name", "", at)]
    kind, word, stop = pieces[0]
    yield kind, f"d{word}", stop
    yield from pieces[1:]


def _lower_limit(text: str, at: int) -> Iterator[tuple[str, str, int]]:
    """Yield (kind, text, end) of the tokens at the start of an integral's lower limit; end is the position after each.

    They are the mark ``_`` and, if the limit is lowered as in ``∫₀``, the limit itself: a number or a name.
    """
    lowered = re.compile(f"[{''.join(_LOWERED)}]+").match(text, at)
    yield "mark", "_", at if lowered else at + 1
    if lowered is not None:
        digits = _written(lowered[0])
        yield "number" if digits.isdigit() else "name", digits, lowered.end()


def _name(text: str, at: int, name: re.Match[str]) -> Iterator[tuple[str, str, int]]:
    """Yield (kind, text, end) of the tokens of a ``name`` of Latin letters and of the primes after it."""
    word, stop = name[0], name.end()
    if word == "d" and text[stop : stop + 1] and text[stop] in LETTERS:  # a differential, or the rate of an angle
        yield from _letter(text, stop, f"d{LETTERS[text[stop]]}")
        return
    if text[stop : stop + 1] and text[stop] in _OVER and word[-1].isalpha():
        # dots belong to the last letter only: mẍ has two names
        if len(word) > 1:
            yield "name", word[:-1], stop - 1
        yield from _letter(text, stop - 1, word[-1])
        return
    if word.endswith("_") and text[stop : stop + 1] and text[stop] in LETTERS:
        word, stop = word + LETTERS[text[stop]], stop + 1
    if word in ("p", "P") and _OF_MOMENTUM.match(text, stop):  # a PDF loses the lower place of an index
        word, stop = f"{word}_{LETTERS[text[stop]]}", stop + 1
    if _AXIS_PAIR.fullmatch(f"{word}{text[stop : stop + 3]}"):  # I_x'y' is one name, as in LaTeX
        yield "name", f"{word}_prime{text[stop + 1]}_prime", stop + 3
        return
    primes = _PRIMED.match(text, stop)
    stop = primes.end() if primes else stop
    lowered = re.compile(f"[{''.join(_LOWERED)}]+").match(text, stop)
    if lowered is not None:
        word, stop = f"{word}_{''.join(_LOWERED[c] for c in lowered[0])}", lowered.end()
    elif word.endswith("_") and text[stop : stop + 1] in ("±", "∓"):
        word, stop = word + text[stop], stop + 1
    yield "name", word, stop
    if primes:
        yield "prime", primes[0], stop


def _written(digits: str) -> str:
    """Return raised or lowered digits as ordinary digits."""
    return "".join(_RAISED.get(digit, _LOWERED.get(digit, digit)) for digit in digits)


def _letter(text: str, at: int, word: str) -> Iterator[tuple[str, str, int]]:
    """Yield (kind, text, end) of the tokens of one letter and its marks: the name, then primes, a hat or tilde, dots.

    ``word`` is the name of the letter, omega for ω; a subscript and a bar are added to it, as in omega_1. The end of a
    token is the position after the letter and all its marks.
    """
    stop = at + 1
    dots = 0
    over = ""
    while text[stop : stop + 1] and text[stop] in _OVER:
        dots, over = dots + _DOTS.get(text[stop], 0), _SIGNS_OVER.get(text[stop], over)
        stop += 1
    word += "_bar" if over == "bar" else ""
    primes = _PRIMED.match(text, stop)
    stop = primes.end() if primes else stop
    if subscript := _SUBSCRIPT.match(text, stop):
        letters = (_LOWERED.get(c, LETTERS.get(c, c)) for c in subscript[0].removeprefix("_"))
        word, stop = f"{word}_{''.join(letters)}", subscript.end()
    elif word != "pi" and (component := (_COMPONENT if text[at] in LETTERS else _DIGITS).match(text, stop)):
        word, stop = f"{word}_{component[0]}", component.end()
    elif word == "Delta" and text[stop : stop + 1].isascii() and text[stop : stop + 1].isalpha():
        word, stop = f"{word}_{text[stop]}", stop + 1
    elif word == "Delta" and text[stop : stop + 1] in LETTERS:
        word, stop = f"{word}_{LETTERS[text[stop]]}", stop + 1
    yield "name", word, stop
    if primes:
        yield "prime", primes[0], stop
    if over in ("hat", "tilde"):
        yield over, over, stop
    if dots:
        yield "dots", str(dots), stop

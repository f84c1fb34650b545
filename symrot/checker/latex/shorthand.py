r"""Short forms of cosines, sines and versines in LaTeX: ``c_\theta``, ``s\alpha``, ``v\theta`` and ``c_{12}``.

They are functions only if the text has both a cosine and a sine of this form, and neither c nor s alone.
"""

import re
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from symrot.latex.tokens import GREEK, Token, tokens

__all__ = ["Shorthand", "extent_of", "shorthands", "without_definitions"]

FUNCTIONS: tuple[Mapping[str, str], ...] = (
    {"c": "cos", "s": "sin", "v": "vers"},
    {"C": "cos", "S": "sin", "V": "vers"},
)
"""Two maps, letter of a short form -> its function, for small and for capital letters; vers is the versine 1 - cos.

A text must have both a cosine and a sine from one of the maps: c and s, or C and S.
"""

NO_ANGLES = ("pi", "omega", "Omega")
"""Greek letters that name no angle: the number pi, and angular velocities."""

ANGLE_NUMBERS = "123"
"""Subscripts of the three angles of a sequence: with ``\\dot\\theta_1`` in the text, ``c_2`` means cos(theta_2)."""

_DEFINITION = re.compile(
    r"(?:(?:c|C)_?\{?(\\[A-Za-z]+)\}? *= *\\cos *[({ ]*\1[)} ]*|(?:s|S)_?\{?(\\[A-Za-z]+)\}? *= *\\sin *[({ ]*\2[)} ]*)"
)
"""Pattern of a definition of a short form, ``c_\\theta = \\cos\\theta``; one of its two groups is the angle."""

FEWEST_NUMBERED = 2
"""The smallest number of different cosines, and of different sines, at which letters with numbers, such as c_1, c_2,
s_1 and s_2, are read as short forms."""


class Shorthand(NamedTuple):
    """A short form of a cosine or sine: its function and the angles whose sum is the argument."""

    function: str
    angles: tuple[str, ...]  # empty if the angle is the item after the letter, as in c\theta


def shorthands(pieces: Sequence[Token], declared: Collection[str] = ()) -> dict[int, Shorthand]:
    r"""Return the short forms in a LaTeX text, each by the position of its letter, such as c or s.

    Parameters
    ----------
    pieces : sequence of Token
        The tokens of the text.
    declared : collection of str
        Names that the claim declares. If c, s or v is one of them, with or without a subscript, as in c_1, the text has
        no short forms in small letters. Likewise, the declared names C, S and V exclude short forms in capital letters.

    Examples
    --------
    >>> from symrot.latex.tokens import tokens
    >>> shorthands(tokens(r"c_\psi s_\psi"))
    {0: Shorthand(function='cos', angles=('psi',)), 7: Shorthand(function='sin', angles=('psi',))}
    >>> shorthands(tokens(r"c_\psi + k"))
    {}
    """
    bases = {name.partition("_")[0] for name in declared}
    cases = [_of_letters(pieces, letters) for letters in FUNCTIONS if not bases & {*letters}]
    return {start: form for short in cases for start, form in short.items()}


def extent_of(pieces: Sequence[Token], start: int) -> tuple[Token, int]:
    r"""Return the letter of the short form at the position ``start``, and the position at which its text ends.

    Examples
    --------
    >>> from symrot.latex.tokens import tokens
    >>> extent_of(tokens(r"2 s_{12} c_3"), 2)
    (Token(kind='letter', text='s', start=2), 8)
    """
    first = next(place for place, piece in enumerate(pieces) if piece.start == start)
    last = _after_power(pieces, first + 1)
    last += pieces[last].text == "_"
    last += 2 if pieces[last].text == "{" else 0  # a subscript is one token, or one in braces
    return pieces[first], pieces[last].start + len(pieces[last].text)


def _of_letters(pieces: Sequence[Token], letters: Mapping[str, str]) -> dict[int, Shorthand]:
    """Return {position: short form} for a text; ``letters`` maps the letters of short forms to functions, as c to cos.

    Return {} if the text lacks a short form of a cosine or of a sine, or if it has c or s alone, as a name.
    """
    named: dict[int, Shorthand] = {}
    numbered: dict[int, tuple[str, str]] = {}
    for before, piece in enumerate(pieces[:-1]):
        if piece.kind != "letter" or piece.text not in letters:
            continue
        function = letters[piece.text]
        place = _after_power(pieces, before + 1)
        after = pieces[place]
        subscript = _subscript(pieces, place + 1) if after.text == "_" else ""
        if _is_angle(after):
            named[piece.start] = Shorthand(function, ())
        elif _is_angle_name(subscript):
            named[piece.start] = Shorthand(function, (subscript,))
        elif subscript.isdigit():
            numbered[piece.start] = function, subscript
        elif after.text != "_" and function != "vers":
            # one of the letters is a name
            return {}
    # numbered has ("sin", "12") for s_{12}, which means sin(theta_1 + theta_2)
    short = named or _numbered(pieces, numbered)
    # a cosine without a sine, or the reverse, is no evidence
    return short if {"cos", "sin"} <= {form.function for form in short.values()} else {}


def _numbered(pieces: Sequence[Token], numbered: Mapping[int, tuple[str, str]]) -> dict[int, Shorthand]:
    """Return {position: short form} for letters with a number, such as ``c_1``, which means cos(theta_1).

    ``numbered`` is {position: (function, number)}, {0: ("cos", "1")} for ``c_1`` at position 0. Return {} if there are
    so few cosines or sines that they may be names, or if the letter of the angles (theta) is unclear.
    """
    digits = {digit for _, number in numbered.values() for digit in number}
    # next to the rate of theta_1, c_2 and s_3 are functions of theta_2 and theta_3
    fewest = 1 if _has_rate(pieces, digits) and len(numbered) > 1 else FEWEST_NUMBERED
    numbers = {name: {number for function, number in numbered.values() if function == name} for name in ("cos", "sin")}
    # c_1 alone may be a name
    if min(map(len, numbers.values())) < fewest:
        return {}
    letter = _numbered_angle(pieces, {*digits, *ANGLE_NUMBERS} if fewest == 1 else digits)
    if not letter:
        return {}
    return {
        start: Shorthand(function, tuple(f"{letter}_{digit}" for digit in digits))
        for start, (function, digits) in numbered.items()
    }


def _has_rate(pieces: Sequence[Token], digits: Collection[str]) -> bool:
    r"""Return whether a text has the rate of a numbered angle, such as ``\dot\theta_1``, and all numbers are 1, 2 or 3.

    The numbers are the number of this angle, here 1, and ``digits``: the numbers in names such as ``c_2``, which may be
    short for cos(theta_2).
    """
    for place, piece in enumerate(pieces[:-3]):
        grouped = pieces[place + 1].text == "{"
        inner = pieces[place + 1 + grouped]
        after = place + 2 + 2 * grouped
        if piece.text == "\\dot" and _is_angle(inner) and pieces[after].text == "_":
            number = _subscript(pieces, after + 1)
            # beside the rate, c_2 and s_3 are probably cos(theta_2) and sin(theta_3)
            if number and {number, *digits} <= {*ANGLE_NUMBERS}:
                return True
    return False


def without_definitions(hypotheses: Sequence[str], claim: str) -> list[str]:
    r"""Return the hypotheses that do more than define a short form of the claim: not ``c\alpha = \cos\alpha``.

    Examples
    --------
    >>> without_definitions([r"c\alpha = \cos\alpha", "a > 0"], r"s\alpha c\alpha = a")
    ['a > 0']
    """
    if not shorthands(tokens(claim)):
        return list(hypotheses)
    return [hypothesis for hypothesis in hypotheses if not _DEFINITION.fullmatch(hypothesis.strip().strip("$"))]


def _after_power(pieces: Sequence[Token], place: int) -> int:
    r"""Return the position after a power of one token, as in ``c^2_\theta``; return ``place`` if there is no power."""
    if pieces[place].text != "^" or place + 4 > len(pieces):
        return place
    is_group = pieces[place + 1].text == "{" and pieces[place + 3].text == "}"
    return place + (4 if is_group else 2)


def _is_angle_name(name: str) -> bool:
    return name in GREEK and name not in NO_ANGLES


def _is_angle(piece: Token) -> bool:
    return piece.kind == "command" and _is_angle_name(piece.text[1:])


def _subscript(pieces: Sequence[Token], place: int) -> str:
    r"""Return the subscript that starts at ``place``, if it is a command, such as ``\alpha``, or a number; else ""."""
    grouped = pieces[place].text == "{"
    inner = pieces[place + grouped]
    if grouped and [piece.text for piece in pieces[place + 2 : place + 3]] != ["}"]:
        return ""
    return inner.text.removeprefix("\\") if inner.kind in ("command", "number") else ""


def _numbered_angle(pieces: Sequence[Token], digits: Collection[str]) -> str:
    r"""Return the letter of the angles in the short forms ``c_1``, ``s_2``: "theta" if ``c_1`` means cos(theta_1).

    The text shows the letter by an angle with one of the ``digits``, such as ``\theta_1``. Return "theta" if the text
    has no angle at all, and "" if the letter is unclear.
    """
    numbered: dict[str, set[str]] = {}
    for place, piece in enumerate(pieces[:-2]):
        after = place + 1 + (pieces[place + 1].text == "}")  # the subscript of \dot{\theta}_1 follows the bracket
        if (_is_angle(piece) or piece.text == "q") and pieces[after].text == "_":
            numbered.setdefault(piece.text.removeprefix("\\"), set()).add(_subscript(pieces, after + 1))
    # without any angle, theta is usual
    if not numbered and not any(_is_angle(piece) for piece in pieces):
        return "theta"
    letters = [letter for letter, subscripts in numbered.items() if subscripts & {*digits}]
    return letters[0] if len(letters) == 1 else ""

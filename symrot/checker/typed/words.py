"""Words that may be several names: ``mgh`` is m*g*h and ``sinx`` is sin(x), unless the whole word is a name.

A word is split only into names that the text uses separately (``alone``), or that nearly every book on mechanics uses.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from symrot.checker.typed.tokens import GREEK_WORDS, Token

__all__ = [
    "ALIASES",
    "ENGLISH",
    "PARTS",
    "SINGLE_ARGUMENT",
    "UNITS",
    "Shorthand",
    "lost_power",
    "pieces_of_word",
    "shorthands",
    "shorthands_of_letters",
    "split_tokens",
]

SINGLE_ARGUMENT = (
    "sin", "cos", "tan", "cot", "sec", "csc", "asin", "acos", "atan", "arcsin", "arccos", "arctan", "sinh", "cosh",
    "tanh", "coth", "sech", "csch", "asinh", "acosh", "atanh", "arcsinh", "arccosh", "arctanh", "acoth", "asech",
    "acsch", "arsinh", "arcosh", "artanh", "arcoth", "arsech", "arcsch",
    "tg", "ctg", "cosec",
    "exp", "log", "ln", "sqrt", "abs", "arg", "det", "trace", "tr", "inverse", "transpose",
)  # fmt: skip
"""The functions that may be written without brackets, ``sin x``."""

ALIASES = {
    "ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "Abs": "abs", "Derivative": "diff",
    "Integral": "integrate", "ImmutableMatrix": "Matrix", "ImmutableDenseMatrix": "Matrix",
    "MutableDenseMatrix": "Matrix", "Determinant": "det", "Trace": "trace", "Transpose": "transpose",
    "Inverse": "inverse", "arctan2": "atan2", "conj": "conjugate",
    "Re": "real_part", "Im": "imaginary_part",
    **{f"arc{name}": f"a{name}" for name in ("sinh", "cosh", "tanh", "coth", "sech", "csch")},
    **{f"ar{name}": f"a{name}" for name in ("sinh", "cosh", "tanh", "coth", "sech", "csch")},
    "tr": "trace", "tg": "tan", "ctg": "cot", "cosec": "csc",
}  # fmt: skip
"""Other names of built-in functions -> the name in trees. Names that SymPy's own text uses are among them."""

PARTS = ("real_part", "imaginary_part")

_JOINED = re.compile(
    rf"(a(?:rc)?(?:sin|cos|tan)|(?:sin|cos|tan|cot|sec|csc))(\d*)([A-Za-z]|{'|'.join(sorted(GREEK_WORDS))}|)(_?[0-9xyz])?",
    re.ASCII,
)
_LETTER = re.compile(r"[A-Za-z][0-9]*", re.ASCII)
_WITH_INDEX = re.compile(r"([A-Za-z]{1,3})([A-Za-z]_[A-Za-z0-9]+)", re.ASCII)
"""Pattern of a product whose last letter has an index, such as ``EI_1``."""

USUAL_LETTERS = frozenset("mMghlLrRvatFIkwsuc")
"""Letters that nearly every book on mechanics uses for a quantity."""

_WITH_INDICES = re.compile(r"([A-Za-z]_[0-9]){2,}", re.ASCII)
"""Pattern of a product of letters with indices, such as ``a_1b_2``."""

BEFORE_INDEX = USUAL_LETTERS | {"E", "T"}
"""The letters that may stand directly before a letter with an index, as a factor: E in ``EI_1``, read as E times I_1.
"""

UNITS = ("rpm", "deg", "rad", "kg", "mm", "cm", "km", "Hz", "ms", "rev", "min")

ENGLISH = frozenset(
    ["and", "or", "if", "for", "where", "then", "with", "when", "mod", "is", "are", "so", "but", "not", "of", "the"]
)
"""Words between formulas, which are not read as factors."""

SCALARS = frozenset("bckmn")
"""First letters of words of two letters that are usually products with x, y or z, such as ``kx``."""

VECTORS = frozenset("IJvwFLMHTRNPeuprfgst")
"""First letters of words of two letters that are components along x, y or z, such as ``Fx``."""

WHOLE_WORDS = frozenset(
    [*GREEK_WORDS, *SINGLE_ARGUMENT, *ALIASES, "pi", "diff", "KE", "PE", "TE", "dt", "dm", "id", *UNITS]
)

MOST_LETTERS = 3
"""The largest number of letters in a word that may be split although the text does not use each letter by itself."""


_OF_CENTRE = re.compile("[A-Za-z](cm|CM|com|COM|cg|CG)", re.ASCII)
"""Pattern of the name of a quantity of the centre of mass or of gravity, such as ``vcm``."""

WORDS_WITH_I = ("if", "in", "is")
"""English words of two letters that start with i; they are not read as products of i and a letter."""


def pieces_of_word(word: str, alone: Collection[str]) -> tuple[tuple[str, ...], bool]:
    """Return (pieces, usual): the names and numbers into which a word may be split, and whether that is usual.

    Parameters
    ----------
    word : str
        A name of Latin letters, digits and underscores.
    alone : collection of str
        The names that the text uses by themselves.

    Examples
    --------
    >>> pieces_of_word("mgh", ()), pieces_of_word("ab", ("a", "b")), pieces_of_word("cos2theta", ())
    ((('m', 'g', 'h'), True), (('a', 'b'), True), (('cos', '2', 'theta'), True))
    >>> pieces_of_word("EI_1", ("I_1",)), pieces_of_word("EI_1", ())
    ((('E', 'I_1'), True), ((), False))
    >>> pieces_of_word("ab", ()), pieces_of_word("phi", ()), pieces_of_word("KE", ())
    ((('a', 'b'), False), ((), False), ((), False))
    """
    # a name is not split
    if (
        word in WHOLE_WORDS
        or len(word) < 2
        or _OF_CENTRE.fullmatch(word)
        or (word.startswith("d") and word[1:] in GREEK_WORDS)
    ):
        return (), False
    if joined := _JOINED.fullmatch(word):
        function, number, name, index = joined.groups()
        if (number or name) and not (index and not name):
            return tuple(piece for piece in (function, number, name + (index or "")) if piece), True
    if with_index := _WITH_INDEX.fullmatch(word):
        before, last = str(with_index[1]), str(with_index[2])
        is_product = last in alone and all(letter in alone or letter in BEFORE_INDEX for letter in before)
        return ((*before, last), True) if is_product else ((), False)
    if _WITH_INDICES.fullmatch(word):
        return tuple(re.findall("[A-Za-z]_[0-9]", word)), True
    letters = tuple(_LETTER.findall(word))
    if "".join(letters) != word or len(letters) < 2:
        return (), False
    if all(letter in alone for letter in letters):
        return letters, True
    if len(word) == 2 and word[0] == "i" and word not in WORDS_WITH_I:
        return letters, True  # the imaginary unit, or an index, times a letter
    if word[0] == "i" and all(letter in alone for letter in letters[1:]):
        return letters, True
    if len(word) == 2 and word[1] in "xyz":
        return ((), False) if word[0] in VECTORS else (letters, word[0] in SCALARS or word[1] in alone)
    if word[-1] in "xyz" or len(letters) > MOST_LETTERS or len(set(letters)) < len(letters):
        return (), False
    usual = all(
        letter in alone or letter in USUAL_LETTERS or (place and letter == "d") for place, letter in enumerate(letters)
    )
    return letters, usual


class Shorthand(NamedTuple):
    """A short form of a cosine or sine, ``cθ`` or ``c_theta``; ``place`` is the index of its first token.

    ``length`` is the number of its tokens; ``function`` and ``angle`` are the names that it means, cos and theta.
    """

    place: int
    length: int
    function: str
    angle: str

    def tokens(self, first: Token, last: Token) -> tuple[Token, ...]:
        """Return the tokens ``cos ( theta )`` that replace the tokens of ``cθ``, from ``first`` to ``last``."""
        # the positions of the replaced tokens, so that messages point to the right part of the text
        mark = Token("mark", "(", first.start, first.start)
        start = last.start if self.length == 2 else first.start + 2
        return (
            first._replace(kind="name", text=self.function, end=first.start), mark,
            Token("name", self.angle, start, last.end), Token("mark", ")", last.end, last.end),
        )  # fmt: skip


FEWEST_OF_LETTERS = 2
"""In a text, ``ca`` is read as cos(alpha) only if at least this many angles have both a cosine and a sine.

Such an angle is alpha in a text with ``ca`` and ``sa``. With fewer of these angles, ``ca`` is probably c times a.
"""

ANGLES = {"a": "alpha", "b": "beta", "g": "gamma", "t": "theta", "p": "phi", "x": "x", "y": "y", "z": "z"}
"""Second letter of a short form such as ``ca`` for cos(alpha) -> the name of the angle."""

OF_LETTERS = re.compile(f"[cs][{''.join(ANGLES)}]")
"""Pattern of the short form of a cosine or sine, such as ``ca`` for cos(alpha)."""


def shorthands_of_letters(tokens: Sequence[Token]) -> list[Shorthand]:
    """Return the short forms among ``tokens``: ``ca`` for cos(alpha) and ``sb`` for sin(beta).

    Return only short forms for angles that have both a cosine and a sine in the text. Return an empty list if there are
    fewer than two such angles.
    """
    places = [place for place, token in enumerate(tokens) if token.kind == "name" and OF_LETTERS.fullmatch(token.text)]
    forms = {tokens[place].text for place in places}
    angles = {form[1] for form in forms if {f"c{form[1]}", f"s{form[1]}"} <= forms}
    if len(angles) < FEWEST_OF_LETTERS:
        return []
    functions = {"c": "cos", "s": "sin"}
    return [
        Shorthand(place, 1, functions[tokens[place].text[0]], ANGLES[tokens[place].text[1]])
        for place in places
        if tokens[place].text[1] in angles
    ]


def shorthands(tokens: Sequence[Token]) -> list[Shorthand]:
    """Return the short forms of cosines and sines that a text may contain, such as ``cθ`` and ``s_theta``."""
    # the caller decides whether the text means them: c may also be a name of its own
    short = shorthands_of_letters(tokens)
    if short:
        return short
    for place, token in enumerate(tokens[:-1]):
        letter, _, angle = token.text.partition("_")
        function = {"c": "cos", "s": "sin", "C": "cos", "S": "sin"}.get(letter)
        if token.kind != "name" or function is None:
            continue
        after = tokens[place + 1]
        if angle in GREEK_WORDS and angle != "pi" and after.text != "(":
            short.append(Shorthand(place, 1, function, angle))
        elif (
            not angle and after.kind == "name" and after.tight and after.text.partition("_")[0] in GREEK_WORDS - {"pi"}
        ):
            short.append(Shorthand(place, 2, function, after.text))
    return short


def lost_power(word: str) -> tuple[str, ...]:
    """Return sin, ^ and 2 for ``sin2``, which may be sin² with a lost raised digit; an empty tuple for other words.

    Examples
    --------
    >>> lost_power("cos2"), lost_power("r2")
    (('cos', '^', '2'), ())
    """
    match = re.fullmatch("(sin|cos|tan|cot)([23])", word)
    return (match[1], "^", match[2]) if match else ()


def split_tokens(tokens: Sequence[Token], words: Mapping[str, Sequence[str]]) -> Iterator[Token]:
    """Yield the tokens with words split into names: m, g, l for ``mgl`` if ``words`` maps mgl to these names."""
    for token in tokens:
        pieces = words.get(token.text, ()) if token.kind == "name" else ()
        has_lowered = bool(pieces) and "_" in pieces[-1] and token.end - token.start == len(token.text) - 1  # EI₁
        if not pieces or (token.end - token.start != len(token.text) and not has_lowered):
            yield token
            continue
        at, spaced, breaks = token.start, token.spaced, token.breaks
        for piece in pieces:
            kind = "number" if piece.isdigit() else "mark" if piece == "^" else "name"
            yield Token(kind, piece, at, min(at + len(piece), token.end), spaced, breaks)
            at, spaced, breaks = at + len(piece), False, False

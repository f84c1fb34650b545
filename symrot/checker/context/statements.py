"""Reading the context of a claim from the words in which a person states it, such as "disk of radius r".

Words that name nothing known, and words that contradict each other, are refused.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from difflib import get_close_matches

from symrot.checker.claim.reader import read_expression
from symrot.checker.context.bodies import BODIES, Body, body_of_words, with_article
from symrot.checker.context.context import Context, Meaning, name_of
from symrot.checker.context.quantities import (
    AMBIGUOUS,
    QUANTITIES,
    Quantity,
    meaningful_words,
    place_of_words,
    plain_words,
)
from symrot.checker.latex.reader import read_latex_formula
from symrot.checker.units.units import conventional_unit, read_unit
from symrot.conventions import SEQUENCES
from symrot.errors import InputError

__all__ = ["read_context", "read_frame", "read_sequence"]

FRAMES = {
    "body": ("body", "body frame", "body axes", "body-fixed", "b", "moving"),
    "space": ("space", "space frame", "space axes", "space-fixed", "s", "inertial", "inertial frame", "fixed"),
}
"""Maps "body" and "space" to the words for the frame."""

_FRAME_WORDS = (("body", r"in (the )?body( frame| axes)?"), ("space", r"in (the )?(space|inertial)( frame| axes)?"))

SEQUENCE_WORDS = {
    "yaw-pitch-roll": "ZYX", "aerospace": "ZYX", "aircraft": "ZYX", "tait-bryan": "ZYX", "roll-pitch-yaw": "xyz",
    "rpy": "xyz", "ypr": "ZYX", "euler": "ZXZ",
}  # fmt: skip
"""Maps a usual name, such as yaw-pitch-roll, to the sequence of Euler angles."""

RATES = ("rad/s", "rad/s^2", "W", "m/s", "m/s^2", "")
"""Units of quantities that may be rates of change; "" is for quantities without a unit. If the words about x' mean a
quantity with one of these units, x' is read as the rate of x, otherwise as another name."""

MOST_NAMES = 40
MOST_NEAREST = 3


def read_context(
    where: Sequence[str] = (), body: str = "", frame: str = "", sequence: str = "", label: str = ""
) -> Context:
    """Return the context that a person states in words.

    Parameters
    ----------
    where : sequence of str
        Texts ``"NAME = words"``, such as ``"I = moment of inertia about the centre"``.
    body, frame, sequence : str
        A body ("solid cylinder of radius r"), ``"body"`` or ``"space"``, and a sequence of angles ("ZXZ", "3-1-3").
    label : str
        Where the words come from, for messages.

    Raises
    ------
    InputError
        For words that name nothing that symrot knows, and for words that contradict each other.

    Examples
    --------
    >>> read_context(["I = moment of inertia about the centre"], body="rod").echo
    'I = moment of inertia about the centre of mass; body thin rod'
    """
    prefix = f"{label}: " if label else ""
    for key, value in (("body", body), ("frame", frame), ("sequence", sequence)):
        if not isinstance(value, str):
            raise InputError(f"{prefix}{key}: expected a string, got {value!r}")
    if isinstance(where, str) or not isinstance(where, Collection) or not all(isinstance(text, str) for text in where):
        raise InputError(f"{prefix}where: expected a list of strings like 'I = moment of inertia', got {where!r}")
    meanings = tuple(_meaning(text, f"{prefix}where: ") for text in where)
    context = Context(
        meanings,
        _body(body, prefix) if body.strip() else None,
        read_frame(frame, prefix) if frame.strip() else "",
        read_sequence(sequence, prefix) if sequence.strip() else "",
    )
    _check_consistency(context, prefix)
    return context


def _meaning(text: str, prefix: str) -> Meaning:
    """Return the meaning that one text ``NAME = words`` or ``NAME, NAME = words`` states."""
    left, sign, words = text.partition("=")
    if not (left.strip() and sign and words.strip(" =")):
        raise InputError(f"{prefix}expected 'NAME = words' like 'I = moment of inertia', got {text[:60]!r}")
    written = tuple(part.strip() for part in left.split(",") if part.strip())
    if len(written) > MOST_NAMES:
        raise InputError(f"{prefix}expected at most {MOST_NAMES} names, got {len(written)}")
    words = words.strip(" =")
    if "=" in words:
        raise InputError(
            f"{prefix}expected one meaning in each string, like 'I = moment of inertia', got {text[:60]!r}; write "
            "a string of its own for each meaning"
        )
    frame, rest = _frame_in(plain_words(words))
    quantity, phrase = _quantity(rest, words, prefix)
    rest = rest.replace(phrase, " ", 1)
    place, rest = place_of_words(rest)
    body = body_of_words(_original(rest, words)) if rest.strip() else None
    if body is not None:
        place, rest = place or body.place, body.rest
    is_rate = quantity.unit in RATES
    spellings = tuple(tuple(_readings_of_name(part, prefix, is_rate)) for part in written)
    return Meaning(spellings, quantity, place, body, frame, written, meaningful_words(rest))


def _original(rest: str, words: str) -> str:
    """Return the text ``rest``, a lower-case part of ``words``, with the capital letters that ``words`` have."""
    cases = {word.lower().strip(","): word.strip(",") for word in words.split()}
    return " ".join(cases.get(word.strip(","), word.strip(",")) + "," * word.endswith(",") for word in rest.split())


def _readings_of_name(part: str, prefix: str, is_rate: bool = False) -> Iterator[str]:
    """Yield the names that ``part``, a typed name, can mean: for ``x_dot``, the name x_dot and the rate dx of x.

    For ``x'``, yield dx if ``is_rate``, else x_prime. Raise InputError, with a message that begins with ``prefix``, if
    ``part`` is not a name.
    """
    bare = part.rstrip("'\u2032")
    primes = len(part) - len(bare)
    latex = "\\" in bare or "{" in bare
    try:
        tree = read_expression(read_latex_formula(bare)[0] if latex else bare)
    except InputError:
        raise InputError(f"{prefix}expected a name before '=', got {part[:40]!r}") from None
    name = name_of(tree)
    if name is None:
        raise InputError(
            f"{prefix}expected a name before '=', got the formula {part[:40]!r}; state the equation with --given"
        )
    # x' is a rate only if the words about the name mean a rate
    yield f"{'d' * primes}{name}" if is_rate else name + "_prime" * primes
    if name.endswith("_dot"):
        yield f"d{name.removesuffix('_dot')}"


def _frame_in(words: str) -> tuple[str, str]:
    """Return (frame, other words): ("body", "velocity") for "velocity in the body frame"; ("", words) without a
    frame.
    """
    for frame, pattern in _FRAME_WORDS:
        if match := re.search(rf"\b{pattern}(?![\w-])", words):
            return frame, words.replace(match[0], " ", 1)
    return "", words


_NO_AXIS_OF = ("", r"(?! (?:in|through|perpendicular|normal|parallel|at)\b)")
"""Two patterns, placed after a phrase for a quantity. The first allows any words. The second, for phrases that end with
"axis", allows no words such as "in": "axis of rotation" is a quantity, but not in "axis of rotation in the plane"."""


def _quantity(plain: str, words: str, prefix: str) -> tuple[Quantity, str]:
    """Return the quantity with which words begin, such as the torque, and the phrase for this quantity.

    ``plain`` are the words in the spelling of ``plain_words``. Raise InputError if they do not begin with a quantity;
    the message begins with ``prefix`` and quotes ``words`` as the user typed them.
    """
    phrases = [
        (match.start(), -len(phrase), phrase, quantity)
        for quantity in QUANTITIES
        for phrase in quantity.phrases
        if (match := re.search(rf"(?<![\w-]){re.escape(phrase)}(?![\w-]){_NO_AXIS_OF[phrase.endswith('axis')]}", plain))
    ]
    if phrases:
        start, _, phrase, quantity = min(phrases, key=lambda entry: entry[:2])
        # the quantity comes first: "mass" is not what "distance of the mass" names
        if not meaningful_words(plain[:start]):
            return quantity, phrase
    for word, instead in AMBIGUOUS.items():
        if word in plain.split():
            raise InputError(f"{prefix}expected {instead}, got {words[:60]!r}, which is ambiguous")
    everything = {phrase: phrase for quantity in QUANTITIES for phrase in quantity.phrases}
    raise InputError(f"{prefix}expected words for a quantity, got {words[:60]!r}{_hint(plain, everything)}")


def _hint(words: str, phrases: dict[str, str]) -> str:
    """Return the end of an error message that suggests known phrases similar to the unknown ``words``."""
    # ``phrases`` maps each known phrase to the suggested text
    nearest = get_close_matches(words, phrases, MOST_NEAREST, 0.4)
    whole = [phrase for phrase in phrases if set(words.split()) & set(phrase.split())]
    names = list(dict.fromkeys(phrases[phrase] for phrase in [*nearest, *whole]))[:MOST_NEAREST]
    names = names or ["moment of inertia", "torque", "rate of precession"]
    return f" (write for example {', '.join(map(repr, names))})"


def _body(words: str, prefix: str) -> Body:
    """Return the body that words describe, with the letters of its dimensions as in a claim's tree: r_prime for r'.

    Raise InputError, with a message that begins with ``prefix``, if symrot knows no such body.
    """
    body = body_of_words(words)
    if body is None:
        phrases = {phrase: phrase for kind in BODIES for phrase in kind.phrases}
        raise InputError(f"{prefix}body: expected a body, got {words[:60]!r}{_hint(plain_words(words), phrases)}")
    letters = {symbol: next(_readings_of_name(letter, prefix)) for symbol, letter in body.letters.items()}
    return replace(body, letters=letters)


def read_frame(words: str, prefix: str = "") -> str:
    """Return the frame that words state, ``"body"`` or ``"space"``.

    Raises
    ------
    InputError
        For other words.
    """
    for frame, phrases in FRAMES.items():
        if words.strip().lower() in phrases:
            return frame
    raise InputError(f"{prefix}frame: expected 'body' or 'space', got {words[:40]!r}")


def read_sequence(words: str, prefix: str = "") -> str:
    """Return the sequence of Euler angles that words state: upper case for moving axes, lower case for fixed axes.

    Raises
    ------
    InputError
        For words that name no sequence.

    Examples
    --------
    >>> read_sequence("3-1-3"), read_sequence("zyx"), read_sequence("yaw-pitch-roll"), read_sequence("space 1-2-3")
    ('ZXZ', 'zyx', 'ZYX', 'xyz')
    """
    plain = words.strip()
    if plain.lower() in SEQUENCE_WORDS:
        return SEQUENCE_WORDS[plain.lower()]
    match = re.fullmatch(
        r"(?:(body|space|intrinsic|extrinsic|fixed)[ -](?:three |two )?)?([xyzXYZ1-3])-?([xyzXYZ1-3])-?([xyzXYZ1-3])"
        r"(?: \(?(intrinsic|extrinsic)\)?)?",
        plain,
    )
    if match:
        letters = "".join("XYZ"[int(part) - 1] if part.isdigit() else part for part in match.groups()[1:4])
        kinds = [kind for kind in (match[1], match[5]) if kind]
        name = _with_case(letters, kinds)
        if name in SEQUENCES:
            return name
    raise InputError(
        f"{prefix}sequence: expected three axes, no two neighbours equal, such as ZXZ or 3-1-3 (about moving axes) "
        f"or zyx (about fixed axes), got {words[:40]!r}"
    )


def _with_case(letters: str, kinds: Sequence[str]) -> str:
    """Return axes in upper case if ``kinds`` has words for moving axes ("body"), in lower case for fixed ones
    ("space").

    Return the axes unchanged without such words, and "" if the words contradict each other.
    """
    fixed = {kind in ("space", "extrinsic", "fixed") for kind in kinds}
    if len(fixed) > 1:
        return ""
    return letters if not fixed else letters.lower() if fixed == {True} else letters.upper()


def _check_consistency(context: Context, prefix: str) -> None:
    """Raise InputError if two statements of the context contradict each other, or if the quantity that a name means has
    another unit than this name usually has.
    """
    seen: dict[str, Meaning] = {}
    for meaning in context.meanings:
        for name in meaning.names:
            other = seen.setdefault(name, meaning)
            if (other.quantity, other.place, other.frame) != (meaning.quantity, meaning.place, meaning.frame):
                raise InputError(
                    f"{prefix}where: expected one meaning of {meaning.written[0]}, "
                    f"got {other.quantity.title!r} and {meaning.quantity.title!r}"
                )
        if meaning.quantity.sign not in ("", context.sign_of_products):
            first = next(meaning for meaning in context.meanings if meaning.quantity.sign)
            raise InputError(
                f"{prefix}where: expected all products of inertia with the same sign convention, got "
                f"{first.written[0]} as the {first.quantity.title}, and {meaning.written[0]} as the "
                f"{meaning.quantity.title}"
            )
        _check_unit(meaning, prefix)
        if meaning.frame and context.frame and meaning.frame != context.frame:
            raise InputError(
                f"{prefix}frame: expected the {meaning.frame} frame, which 'where' gives for {meaning.written[0]}, got "
                f"{context.frame!r} (give the same frame in both)"
            )
        if meaning.body and context.body and meaning.body.kind != context.body.kind:
            raise InputError(
                f"{prefix}body: expected {with_article(meaning.body.kind.title)}, the body that 'where' gives for "
                f"{meaning.written[0]}, got {context.body.kind.title!r} (give the same body in both)"
            )


def _check_unit(meaning: Meaning, prefix: str) -> None:
    """Raise InputError if a name of several letters has a meaning with an unusual unit, as in "omega = mass"."""
    for name in meaning.names:
        # the usual unit of omega is rad/s
        usual = conventional_unit(name) if len(name) > 1 else None
        own = meaning.quantity.unit
        if usual and own and read_unit(own) != read_unit(usual) and "_prime" not in name:
            raise InputError(
                f"{prefix}where: expected a quantity with the unit {usual}, which {meaning.written[0]} usually has, "
                f"got {meaning.quantity.title!r}, which has the unit {own}"
            )

"""The context of a claim, which a person states in words: it is parsed and checked for contradictions here.

The words say which known formula a claim means, so that a claim such as ``I = m l^2/3`` can be decided.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from fractions import Fraction

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, is_derivative, walk
from symrot.checker.context.bodies import BODIES, Body, body_of_words, with_article
from symrot.checker.context.quantities import (
    AMBIGUOUS,
    LINES,
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

__all__ = [
    "FRAMES",
    "NO_CONTEXT",
    "Context",
    "Meaning",
    "letters_of",
    "matrix_of",
    "quantities_of",
    "read_context",
    "read_frame",
    "read_sequence",
]

FRAMES = {
    "body": ("body", "body frame", "body axes", "body-fixed", "b", "moving"),
    "space": ("space", "space frame", "space axes", "space-fixed", "s", "inertial", "inertial frame", "fixed"),
}
"""Maps a frame to words for it."""

_FRAME_WORDS = (("body", r"in (the )?body( frame| axes)?"), ("space", r"in (the )?(space|inertial)( frame| axes)?"))

SEQUENCE_WORDS = {
    "yaw-pitch-roll": "ZYX", "aerospace": "ZYX", "aircraft": "ZYX", "tait-bryan": "ZYX", "roll-pitch-yaw": "xyz",
    "rpy": "xyz", "ypr": "ZYX", "euler": "ZXZ",
}  # fmt: skip
"""Maps a usual name, such as yaw-pitch-roll, to the sequence of Euler angles."""

RATES = ("rad/s", "rad/s^2", "W", "m/s", "m/s^2", "")
"""The units of quantities that may be rates."""

MOST_NAMES = 40
MOST_NEAREST = 3


def matrix_of(name: str) -> str:
    """Return the matrix of which ``name`` is an entry: A for A_12, J_c for J_c_xy; return any other name unchanged."""
    return re.sub(r"_?([xyz]{2}|[1-3]{2})$", "", name)


@dataclass(frozen=True)
class Meaning:
    """What the words of the context say about one name, or about several.

    Attributes
    ----------
    names : tuple of str
        The names as they are spelled in trees, with all readings of an ambiguous name; a rate has ``d`` in front.
    quantity : Quantity
    place : str
        The title of a place, such as "about an end", or an empty text.
    body : Body or None
        The body that the words mention.
    frame : str
        ``"body"``, ``"space"`` or empty.
    written : tuple of str
        The names as they were typed.
    rest : str
        The words that symrot does not use.
    """

    names: tuple[str, ...]
    quantity: Quantity
    place: str = ""
    body: Body | None = None
    frame: str = ""
    written: tuple[str, ...] = ()
    rest: str = ""

    def is_of(self, name: str) -> bool:
        """Return whether this is the meaning of ``name``, or of a vector or matrix with the entry ``name``, as L for
        L_x.
        """
        # a quaternion beta has the entry beta_0, a matrix A the entry A_12
        stem = re.sub(r"_?[0-4]$" if self.quantity.title == "quaternion" else r"_?[xyz1-3]$", "", name)
        return name in self.names or stem in self.names or f"{stem}_i" in self.names or matrix_of(name) in self.names


@dataclass(frozen=True)
class Context:
    """The context of a claim: meanings of names, the body, the frame, and the sequence of Euler angles.

    Attributes
    ----------
    meanings : tuple of Meaning
    body : Body or None
    frame : str
        ``"body"``, ``"space"`` or empty.
    sequence : str
        One of :data:`symrot.conventions.SEQUENCES`, or empty.
    """

    meanings: tuple[Meaning, ...] = ()
    body: Body | None = None
    frame: str = ""
    sequence: str = ""

    def __bool__(self) -> bool:
        return bool(self.meanings or self.body or self.frame or self.sequence)

    def meaning_of(self, name: str) -> Meaning | None:
        """Return the meaning that the user's words give to a name, or None if they do not mention it."""
        exact = (meaning for meaning in self.meanings if name in meaning.names)
        return next(exact, None) or next((meaning for meaning in self.meanings if meaning.is_of(name)), None)

    @property
    def place(self) -> str:
        """The place of the axis in the words about the body, such as "about an end"; otherwise an empty text."""
        return self.body.place if self.body else ""

    @property
    def sign_of_products(self) -> str:
        """ "minus" or "plus" if the words say that products of inertia have or lack the minus sign; otherwise empty."""
        return next((meaning.quantity.sign for meaning in self.meanings if meaning.quantity.sign), "")

    @property
    def rest(self) -> tuple[str, ...]:
        """The words of the context that symrot does not use."""
        own = [meaning.rest for meaning in self.meanings] + ([self.body.rest] if self.body else [])
        return tuple(words for words in own if words)

    @property
    def obscure(self) -> str:
        """Words about the body, or about the axis of a quantity, that symrot does not understand; often empty."""
        own = [self.body.obscure] if self.body else []
        for meaning in self.meanings:
            own += [meaning.body.obscure] if meaning.body else []
            own += [meaning.rest] if _OF_AXES.search(meaning.rest) else []
            own += [meaning.place] if self.body and not _has_line(self.body, meaning.place) else []
        return " ".join(words for words in own if words)

    def fits(self, names: set[str]) -> bool:
        """Return whether every name that the context describes is among ``names``, those of a text."""
        return all(any(meaning.is_of(name) for name in names) for meaning in self.meanings)

    def check_names(self, names: set[str]) -> None:
        """Raise InputError if the context describes a name that is not in ``names``, the names of the claim."""
        for meaning in self.meanings:
            if not any(meaning.is_of(name) for name in names):
                raise InputError(
                    f"where: expected meanings only of names that occur in the claim, got {meaning.written[0]!r}"
                )

    def units(self, names: Iterable[str], explicit: Mapping[str, str]) -> dict[str, str]:
        """Return the units of ``names`` that follow from their meanings.

        Raises
        ------
        InputError
            If ``explicit`` has another unit for a name.
        """
        units: dict[str, str] = {}
        for name in names:
            meaning = next((meaning for meaning in self.meanings if name in meaning.names), None)
            if meaning is None or meaning.quantity.unit in ("", "1"):
                continue
            if name in explicit and read_unit(explicit[name], name) != read_unit(meaning.quantity.unit):
                raise InputError(
                    f"where: expected a quantity in {explicit[name]}, the unit stated for {meaning.written[0]}, "
                    f"got {meaning.quantity.title!r}, which is in {meaning.quantity.unit}"
                )
            units[name] = meaning.quantity.unit
        return units

    @property
    def echo(self) -> str:
        """The context in one line, as symrot understood it."""
        parts = [f"{', '.join(meaning.written)} = {_described(meaning)}" for meaning in self.meanings]
        parts += [f"body {_described_body(self.body)}"] if self.body else []
        parts += [f"{self.frame} frame"] if self.frame else []
        parts += [f"sequence {self.sequence}"] if self.sequence else []
        return "; ".join(parts)


NO_CONTEXT = Context()

_OF_AXES = re.compile(
    r"\b(about|through|perpendicular|normal|parallel|vertical|horizontal|edge|tangent|diameter|plane|inclined)\b"
)


def _has_line(body: Body, line: str) -> bool:
    """Return whether a body has the stated axis: a disk has one "about a diameter", a box has not."""
    # a place such as "about an end" is no axis, and suits every body
    return line not in LINES or bool({*body.formulas} & {*LINES[line][1]})


def _described(meaning: Meaning) -> str:
    body = f"of {with_article(_described_body(meaning.body))}" if meaning.body else ""
    frame = f"in the {meaning.frame} frame" if meaning.frame else ""
    return " ".join(part for part in (meaning.quantity.title, body, meaning.place, frame) if part)


def _described_body(body: Body) -> str:
    letters = ", ".join(f"{_scaled(body, symbol)} for {symbol}" for symbol in body.letters)
    motion = f" {'in general motion' if body.motion == 'general' else f'that {body.motion}'}" if body.motion else ""
    place = f" {body.place}" if body.place else ""
    place += f" with axis {body.symmetry_axis}" if body.symmetry_axis else ""
    return f"{body.kind.title}{motion}{place}" + (f" (with {letters})" if letters else "")


def _scaled(body: Body, symbol: str) -> str:
    """Return a dimension of a body in the letters of the user: d/2 for the ``symbol`` R of a body "of diameter d"."""
    above, below = body.factors.get(symbol, Fraction(1)).as_integer_ratio()
    return f"{above}*" * (above != 1) + body.letters[symbol] + f"/{below}" * (below != 1)


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
            raise InputError(f"{prefix}{key}: expected a text, got {value!r}")
    if isinstance(where, str) or not all(isinstance(text, str) for text in where):
        raise InputError(f"{prefix}where: expected a list of texts like 'I = moment of inertia', got {where!r}")
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
            f"{prefix}expected the meaning of one name in a text, got {text[:60]!r}; write one text for each"
        )
    frame, rest = _frame_in(plain_words(words))
    quantity, phrase = _quantity(rest, words, prefix)
    rest = rest.replace(phrase, " ", 1)
    place, rest = place_of_words(rest)
    body = body_of_words(_original(rest, words)) if rest.strip() else None
    if body is not None:
        place, rest = place or body.place, body.rest
    is_rate = quantity.unit in RATES
    names = tuple(dict.fromkeys(name for part in written for name in _readings_of_name(part, prefix, is_rate)))
    return Meaning(names, quantity, place, body, frame, written, meaningful_words(rest))


def _original(rest: str, words: str) -> str:
    """Return the text ``rest``, a lower-case part of ``words``, with the capital letters that ``words`` have."""
    cases = {word.lower().strip(","): word.strip(",") for word in words.split()}
    return " ".join(cases.get(word.strip(","), word.strip(",")) + "," * word.endswith(",") for word in rest.split())


def _readings_of_name(part: str, prefix: str, is_rate: bool = False) -> Iterator[str]:
    """Yield the names that a typed name can mean: ``x_dot`` itself, and ``dx``, the rate of x."""
    bare = part.rstrip("'\u2032")
    primes = len(part) - len(bare)
    latex = "\\" in bare or "{" in bare
    try:
        tree = read_expression(read_latex_formula(bare)[0] if latex else bare)
    except InputError:
        raise InputError(f"{prefix}expected a name before '=', got {part[:40]!r}") from None
    name = _name(tree)
    if name is None:
        raise InputError(
            f"{prefix}expected a name before '=', got the formula {part[:40]!r}; state the equation with --given"
        )
    # x' is a rate only if the words about the name mean a rate
    yield f"{'d' * primes}{name}" if is_rate else name + "_prime" * primes
    if name.endswith("_dot"):
        yield f"d{name.removesuffix('_dot')}"


def quantities_of(tree: Node) -> Iterator[str]:
    """Yield the names in a formula's tree; for a time derivative of x, yield both ``dx`` and x."""
    for _, node in walk(tree):
        if (name := _name(node)) is not None:
            yield name


def letters_of(tree: Node) -> Iterator[str]:
    """Yield the names in a formula's tree; for a time derivative of x, yield only ``dx``."""
    name = _name(tree)
    if name is not None:
        yield name
    else:
        for child in tree.args:
            yield from letters_of(child)


def _name(tree: Node) -> str | None:
    """Return the name that a tree is, x for ``x(t)`` and ``dx`` for its time derivative; None for any other formula."""
    if tree.kind == "name":
        return str(tree.value)
    if is_derivative(tree):
        inner = _name(tree.args[0])
        return None if inner is None else "d" * (len(tree.args) - 1) + inner
    if tree.kind == "call" and [argument.value for argument in tree.args] == ["t"]:
        return str(tree.value)
    return None


def _frame_in(words: str) -> tuple[str, str]:
    """Return the frame that words state, and the other words: "body" and "velocity" for "velocity in the body
    frame".
    """
    for frame, pattern in _FRAME_WORDS:
        if match := re.search(rf"\b{pattern}(?![\w-])", words):
            return frame, words.replace(match[0], " ", 1)
    return "", words


_NO_AXIS_OF = ("", r"(?! (?:in|through|perpendicular|normal|parallel|at)\b)")
"""What may not follow a phrase that ends with "axis" (second pattern): "axis in the plane" is not the axis of a
body."""


def _quantity(plain: str, words: str, prefix: str) -> tuple[Quantity, str]:
    """Return the quantity that words state, such as the torque, and the phrase that states it."""
    # ``plain`` are the words in the usual spelling, ``words`` and ``prefix`` are for messages
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
    """Return the body that words describe, with the letters of its dimensions spelled as in the trees of formulas."""
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

    Unchanged without such words; empty if they contradict each other.
    """
    fixed = {kind in ("space", "extrinsic", "fixed") for kind in kinds}
    if len(fixed) > 1:
        return ""
    # ``kinds`` are words such as "body" and "extrinsic"
    return letters if not fixed else letters.lower() if fixed == {True} else letters.upper()


def _check_consistency(context: Context, prefix: str) -> None:
    """Raise InputError if two statements of the context contradict each other, or a meaning the usual unit of its
    name.
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
            raise InputError(
                f"{prefix}where: expected all products of inertia with the same sign convention, got "
                f"{meaning.written[0]} as the {meaning.quantity.title}, and another product of inertia with the "
                f"{context.sign_of_products} sign"
            )
        _check_unit(meaning, prefix)
        if meaning.frame and context.frame and meaning.frame != context.frame:
            raise InputError(
                f"{prefix}frame: expected the {meaning.frame} frame, as the words about {meaning.written[0]} say, "
                f"got {context.frame!r}"
            )
        if meaning.body and context.body and meaning.body.kind != context.body.kind:
            raise InputError(
                f"{prefix}body: expected a {meaning.body.kind.title}, as the words about {meaning.written[0]} say, "
                f"got {context.body.kind.title!r}"
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

"""Whether a known formula fits the context of a claim, judged by the words in the formula's name.

The name of a formula is a phrase such as "moment of inertia of a thin rod about an end, x axis". Its place is the
point of the body through which the axis goes, here "about an end".
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

from symrot.checker.context.angle_orders import AXIS_OF_ANGLE, has_order, place_by_words
from symrot.checker.context.bodies import bodies_of_formula
from symrot.checker.context.context import Context, Meaning, matrix_of
from symrot.checker.context.quantities import LINES, PLACES, RIM, SURFACE, plain_words
from symrot.conventions import SEQUENCES

__all__ = [
    "COMPONENTS",
    "EXCHANGED",
    "admits_letters",
    "admits_name",
    "guesses",
    "is_at_open_place",
    "is_component",
    "is_place",
    "is_usual_for_body",
    "misfits",
    "same_rotation",
]

_FRAME = re.compile(r"\b(body|space)[ -]frame")
_STOP = frozenset({
    "relation", "of", "in", "and", "or", "from", "with", "for", "to", "that", "which", "what", "is", "by", "as",
    "at", "about", "along", "across", "the", "a", "an", "its", "their", "on", "whose", "any", "axes", "axis",
    "frame", "body", "two", "one", "another", "other", "euler's", "equations", "equation", "solved", "rates",
    "formula", "theorem", "principal", "components", "component", "unit", "dq/dt", "omega", "b", "e", "b^-1", "=",
    "i", "squared", "acos", "asin", "atan2", "2", "without", "minus", "sign", "physical",
})  # fmt: skip
"""Words in the names of derived formulas, such as "of" and "axis", that do not distinguish formulas for one quantity.

For a formula to fit a claim, the claim's context (words about its names and its body) need not contain these words."""


COMPONENTS = {
    "first": "x1Ap", "second": "y2Bq", "third": "z3Cr", "scalar": "04sw", "x": "x1Ap", "y": "y2Bq", "z": "z3Cr",
}  # fmt: skip
"""Maps a word for a component or an axis, such as "second", to the last letters of names of this component.

The second component may be omega_y, omega_2, the moment of inertia B, or q, since p, q and r are the rates of an
aircraft."""

INDICES = frozenset("xyz0123")
ANGLES = ("phi", "theta", "psi")


def frame_of(name: str) -> str:
    """Return the frame that a derived formula's ``name`` states: ``"body"``, ``"space"`` or an empty text."""
    match = _FRAME.search(name)
    return match[1] if match else ""


OF_BODY_AXES = ("principal axes", "in the body", "Euler's equations", "rotation of a symmetric body")
"""Phrases in the names of derived formulas: a formula whose name has one is for components along axes of the body."""


def _axes_of(name: str) -> str:
    """Return "body" for a derived formula for components along axes of the body, as its ``name`` says; else ""."""
    # Euler's equations as an equation of vectors, "any body axes", hold in the space frame too
    return "body" if any(words in name for words in OF_BODY_AXES) and "any body axes" not in name else ""


def sequence_of(name: str) -> str:
    """Return the Euler sequence that a derived formula's ``name`` contains, such as "ZXZ", or an empty text."""
    return next((word for word in re.findall(r"[A-Za-z]+", name) if word in SEQUENCES), "")


def place_of(name: str) -> str:
    """Return the place in the name of a derived formula, such as "about an end"; empty if it names none."""
    places = [(phrase, title) for title, _, phrases in PLACES for phrase in phrases if phrase in name]
    # the longest phrase counts: "about the centre of an end" means an end, not the centre
    return max(places, key=lambda pair: len(pair[0]))[1] if places else ""


def admits_name(context: Context, name: str, quantity: str) -> bool:
    """Return whether a claim about ``quantity``, such as I_z, may be about the derived formula called ``name``."""
    # "moment of inertia of a rod about an end" contradicts the context "about the centre"
    return not any(misfits(context, name, quantity))


def is_usual_for_body(context: Context, sequence: str) -> bool:
    """Return whether books use an Euler sequence for the context's body: ZXZ or ZYZ for a top, any for other bodies.

    If the context states a sequence, return True for every sequence.
    """
    is_top = context.body is not None and context.body.kind.title in TITLES_OF_TOPS
    # the second angle of ZXZ and ZYZ tilts the axis of the top
    return bool(context.sequence) or not is_top or sequence.upper() in ("ZXZ", "ZYZ")


def misfits(context: Context, name: str, quantity: str) -> Iterator[str]:
    """Yield words for each contradiction between a formula's ``name`` and a claim about ``quantity``: "for another
    axis".
    """
    is_relation = name.startswith("relation for ") or not quantity
    meaning = None if is_relation else context.meaning_of(quantity)
    if not is_relation and not is_component(name, quantity):
        # a formula for the x axis does not fit I_zz
        yield "for another component"
    frame, sequence, place = frame_of(name), sequence_of(name), place_of(name)
    if meaning is None and "component of the angle rates" in name and has_order(sequence):
        yield from () if name.startswith(PLACE_OF_RATE.get(quantity, "")) else ("for another angle",)
    if context.sign_of_products == "minus" and name.endswith("without the minus sign"):
        yield "without the minus sign of products of inertia"
    expected = context.frame or (meaning.frame if meaning else "")
    own = frame or _axes_of(name)
    if expected and own and own != expected:
        yield f"for the {own} frame"
    if context.sequence and sequence and sequence not in (context.sequence, same_rotation(context.sequence)):
        yield f"for the sequence {sequence}"
    if sequence and not is_usual_for_body(context, sequence):
        yield f"for the sequence {sequence}"
    for body in (context.body, meaning.body if meaning else None):
        if body is not None and not body.has(name):
            yield "of another body"
    is_stated = any(other.quantity.title == GYRATION for other in context.meanings)
    if context.body and context.body.kind.shape and name.endswith(f"from the {GYRATION}") and not is_stated:
        yield "with a radius of gyration"  # r is the radius of the body
    own_place = (meaning.place if meaning else "") or context.place
    if own_place in LINES and (" of a " in name or place):
        yield from () if _is_along(name, own_place) else (_where_else(place, own_place, name),)
    elif own_place and place and place != own_place and place_exists(own_place):
        yield place
    elif own_place == place and _is_radial(name, quantity):
        yield "about an axis through the centre of mass"
    if meaning is not None and (line := DIRECTIONS.get(meaning.quantity.title)) and not _has_axes(name, line):
        yield "for another axis"
    phrases = meaning.quantity.formulas if meaning is not None else ()
    if meaning is not None and meaning.frame == "body" and meaning.quantity.title == "precession rate":
        phrases = ("goes round its axis",)  # the precession of the angular velocity, seen from the body
    if phrases and not any(phrase in name for phrase in phrases):
        yield "for another quantity"


TITLES_OF_TOPS = ("symmetric top", "heavy top", "fast top", "sleeping top")
GYRATION = "radius of gyration"
DIRECTIONS = {"axial moment of inertia": "z", "transverse moment of inertia": "xy"}
"""Maps the title of a moment of inertia of a rod or round body to the letters of the axes that it can be about; z is
the axis of symmetry."""


def _has_axes(name: str, axes: str) -> bool:
    """Return whether the axis in a formula's ``name``, x in "moment of inertia of a disk, x axis", is one of ``axes``.

    Return True also if the name has no axis, or if its body is neither a rod nor round.
    """
    _, bodies = LINES["about a transverse axis through the centre"]
    axis = re.search(r", ([xyz]) axis", name)
    return axis is None or not bodies_of_formula(name) & {*bodies} or axis[1] in axes


def _is_along(name: str, line: str) -> bool:
    """Return whether a formula for a moment of inertia is for an axis along ``line``, such as "about a diameter".

    ``name`` is the formula's name, such as "moment of inertia of a disk, x axis".
    """
    _, bodies = LINES[line]
    axis = re.search(r", ([xyz]) axis", name)
    return any(
        place_of(name) == place and (axis is None or axis[1] in axes)
        for body, (place, axes) in bodies.items()
        if body in bodies_of_formula(name)
    )


def _where_else(place: str, line: str, name: str) -> str:
    """Return words for the axis of a formula called ``name``, which differs from the axis ``line`` of the context.

    The words are usually ``place``, the place in the formula's name, such as "about an end". They are "about another
    axis" if ``place`` is empty, or if ``line``, such as "about a diameter", goes through the point that ``place``
    names.
    """
    _, bodies = LINES[line]
    places = [own for body, (own, _) in bodies.items() if body in bodies_of_formula(name)]
    return place if place and place not in places else "about another axis"


def _is_radial(name: str, quantity: str) -> bool:
    """Return whether the axis in a formula's ``name`` goes along the radius to a point of the rim or surface.

    Return False if the index of ``quantity`` states the axis, as in I_x.
    """
    # hardly anybody means this axis by "about a point of the rim"
    return place_of(name) in (RIM, SURFACE) and quantity[-1:] not in INDICES and not _is_along(name, "about a tangent")


def is_component(name: str, quantity: str) -> bool:
    """Return whether the name of a formula agrees with the index at the end of ``quantity``.

    "Moment of inertia of a disk, z axis" agrees with I_zz and not with I_xx. A quantity without an index agrees with
    every name.
    """
    axis = re.search(r", ([xyz]) axis", name)
    word = axis[1] if axis else name.partition(" ")[0] if " component" in name else ""
    index = quantity[-1:]
    # without an index, every name agrees; dphi is a rate
    is_indexed = len(quantity) > 1 and not quantity.startswith("d") and index in INDICES
    return not is_indexed or word not in COMPONENTS or index in COMPONENTS[word]


def place_exists(place: str) -> bool:
    """Return whether symrot derives formulas for an axis at ``place``, one of the titles in PLACES: "about an end"."""
    return any(title == place and phrases for title, _, phrases in PLACES)


def is_at_open_place(context: Context, name: str) -> bool:
    """Return whether the context leaves open through which point of the body the axis of a formula goes.

    Such a context says only "about the pivot", or similar words, while the formula's ``name`` states a body and a
    point, such as an end.
    """
    places = {context.place, *(meaning.place for meaning in context.meanings)}
    return bool(places & {*OPEN_PLACES} and place_of(name) and bodies_of_formula(name))


OPEN_PLACES = tuple(title for title, _, phrases in PLACES if not phrases)
"""Titles in PLACES that do not say which point of the body is meant, such as "about the fixed point". No name of a
derived formula has words for them."""


def admits_letters(context: Context, name: str, mapping: Mapping[str, str], letters: Iterable[str]) -> bool:
    """Return whether the context allows ``mapping``, from symbols of the formula ``name`` to letters of a claim:
    {"R": "r"}.
    """
    sequence = sequence_of(name)
    # ``mapping`` has the letter for each renamed symbol; other letters mean the symbol of the same name
    pairs = [(plain(known), plain(new)) for known, new in mapping.items()]
    renamed = {new for _, new in pairs}
    parts = {part for new in renamed for part in (re.sub(r"_?[xyz1-3]$", "", new), matrix_of(new))}
    pairs += [(letter, letter) for letter in map(plain, letters) if letter not in renamed | parts]
    for symbol, letter in pairs:
        meaning = context.meaning_of(letter)
        if meaning is None and {symbol[:1], letter[:1]} == {"d"} and (of_angle := context.meaning_of(letter[1:])):
            meaning, symbol = of_angle, symbol[1:]
        title = meaning.quantity.title if meaning is not None else ""
        if sequence and title in AXIS_OF_ANGLE and symbol.removeprefix("d") in ANGLES:
            if ANGLES.index(symbol.removeprefix("d")) != place_by_words(title, sequence):
                return False  # yaw is the angle about z, wherever it stands in the sequence
            continue
        if meaning is None and has_order(context.sequence) and {symbol, letter} in EXCHANGED:
            return False
        # a letter r cannot mean theta if the context says that r is a radius
        if meaning is not None and not _is_symbol_of(meaning, symbol):
            return False
    if context.body is None:
        return True
    if context.body.factors:
        return False  # no letter of the claim is a symbol of a derived formula
    own = dict(pairs)
    inverse = {new: known for known, new in pairs}
    return all(
        own.get(symbol, letter) == letter and (symbol in own or inverse.get(letter, symbol) == symbol)
        for symbol, letter in context.body.letters.items()
    )


EXCHANGED = ({"phi", "psi"}, {"dphi", "dpsi"})
"""Pairs of letters that some authors exchange: phi and psi for the first and the third angle, dphi and dpsi for their
rates."""

PLACE_OF_RATE = {"dphi": "first", "dtheta": "second", "dpsi": "third"}


def same_rotation(sequence: str) -> str:
    """Return the sequence of the same rotation with the angles in reverse order, such as xyz for ZYX.

    Return "" for sequences such as ZXZ, whose first and last axes are equal.

    Examples
    --------
    >>> same_rotation("ZYX"), same_rotation("ZXZ")
    ('xyz', '')
    """
    # all books call the first angle of ZXZ phi and the third psi: in reverse order these letters mean other angles
    # lower case means fixed axes, upper case moving axes
    return "" if has_order(sequence) else sequence[::-1].swapcase()


def _is_symbol_of(meaning: Meaning, symbol: str) -> bool:
    """Return whether a meaning fits ``symbol`` of a derived formula, as "rate of precession" fits dphi."""
    pattern = meaning.quantity.symbols
    if not pattern:
        return True
    is_rate = any(re.fullmatch(r"d(phi|theta|psi|alpha|beta|gamma|varphi)", name) for name in meaning.names)
    if is_rate and symbol == "omega_3":
        return False  # the spin is the rate of the spin angle plus a part of the precession
    return re.fullmatch(pattern, symbol) is not None


def plain(name: str) -> str:
    """Return the name of a symbol, a function of time or its rate: x for x(t), dx for its derivative."""
    rate = re.fullmatch(r"diff\((\w+)(\(t\))?((, t)+)\)", name)
    return "d" * rate[3].count("t") + rate[1] if rate else name.removesuffix("(t)")


def guesses(context: Context, name: str, stated: str) -> list[str]:
    """Return the words in a formula's ``name`` that neither the context nor ``stated``, the claim's own words, imply.

    A place is returned as a whole, "about an end", and so is a frame, "in the body frame", not word by word.
    """
    # "moment of inertia z axis" is stated by I_zz
    words = [stated, context.frame, context.sequence, "moment of inertia" if "inertia" in stated else ""]
    for meaning in context.meanings:
        words += [*meaning.quantity.phrases, *meaning.quantity.formulas, meaning.place, meaning.rest, meaning.frame]
    for body in [context.body, *(meaning.body for meaning in context.meanings)]:
        if body is not None:
            words += [*body.kind.formulas, *body.kind.phrases, body.motion, body.rest, "rolls" * bool(body.motion)]
            words += [body.place]
    if context.sequence:
        words += ["intrinsic extrinsic", same_rotation(context.sequence)]
    if context.place in LINES or any(meaning.place in LINES for meaning in context.meanings):
        words.append(place_of(name))
    own = {word for text in words for word in _tokens(text)}
    own |= {word for title, _, phrases in PLACES if title in words for phrase in phrases for word in _tokens(phrase)}
    frame = frame_of(name)
    stated_frames = {context.frame, *(meaning.frame for meaning in context.meanings)}
    open_words = [word for word in dict.fromkeys(_tokens(name.replace("body to space", ""))) if word not in own]
    open_words = [word for word in open_words if word != "space"]
    place = place_of(name)
    words_of_place = {word for title, _, phrases in PLACES if title == place for p in phrases for word in _tokens(p)}
    stated_places = {context.place, *(meaning.place for meaning in context.meanings)}
    stated_places |= {meaning.body.place for meaning in context.meanings if meaning.body}
    stated_places |= {place} if stated_places & {*LINES} else set()
    if place and place not in stated_places:
        open_words = [*(word for word in open_words if word not in words_of_place), place]
    return [*open_words, *([f"in the {frame} frame"] if frame and frame not in stated_frames else [])]


def is_place(words: str) -> bool:
    """Return whether ``words``, such as "about an end", are a title in PLACES, the list of places of axes."""
    return any(words == title for title, _, _ in PLACES)


@lru_cache(maxsize=20_000)
def _tokens(text: str) -> tuple[str, ...]:
    """Return the words of a text without single letters and words such as "of", in a uniform spelling."""
    return tuple(
        word
        for word in re.findall(r"[\w'/^-]+", plain_words(text).replace("-frame", " frame"))
        if word.strip("'") not in _STOP and len(word) > 1
    )

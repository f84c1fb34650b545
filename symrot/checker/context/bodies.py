"""The bodies that words such as "solid cylinder of radius r" name, with the letters of their dimensions."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from symrot.checker.context.quantities import place_of_words, plain_words, unused_words
from symrot.inertia.shapes import SHAPES

__all__ = ["BODIES", "Body", "Kind", "bodies_of_formula", "body_of_words"]


@dataclass(frozen=True)
class Kind:
    """A kind of body.

    Attributes
    ----------
    title : str
        Its usual name, as a person writes it.
    synonyms : tuple of str
        Other names.
    formulas : tuple of str
        The phrases for it in the names of derived formulas.
    shape : str
        The shape of :mod:`symrot.inertia.shapes`, or an empty text.
    """

    title: str
    synonyms: tuple[str, ...]
    formulas: tuple[str, ...]
    shape: str = ""

    @cached_property
    def phrases(self) -> tuple[str, ...]:
        """The title and the synonyms as plain words."""
        return tuple(map(plain_words, (self.title, *self.synonyms)))


@dataclass(frozen=True)
class Body:
    """A body in words: its kind, and the letters of its dimensions and moments.

    Attributes
    ----------
    kind : Kind
    motion : str
        ``"rolls"``, ``"rolls down a slope"``, ``"rolls from a height"``, ``"general"``; otherwise empty.
    letters : mapping
        Symbol of the derived formulas -> letter in the claim, such as ``{"R": "r"}`` for "of radius r".
    place : str
        The title of a place of :data:`symrot.checker.context.quantities.PLACES`, such as "about an end"; or empty.
    rest : str
        The words that symrot does not use.
    """

    kind: Kind
    motion: str = ""
    letters: Mapping[str, str] = field(default_factory=dict)
    place: str = ""
    rest: str = ""

    def has(self, name: str) -> bool:
        """Return whether a derived formula, by its name, is one for this body or for any body."""
        phrases = bodies_of_formula(name)
        own = {phrase for phrase in phrases if phrase in self.kind.formulas}
        if phrases - own and not (own and ", or of " in name):
            return False
        if self.motion == GENERAL:
            return not name.endswith(ALONE)
        rolls = self.motion in MOTIONS
        if (" roll" in name) != rolls:
            return not own and " roll" not in name
        return not rolls or name.removesuffix(", squared").endswith(MOTIONS[self.motion])


GENERAL = "general"
MOTIONS = {"rolls": "rolls", "rolls down a slope": "down a slope", "rolls from a height": "from a height"}
"""Motion of a body that rolls -> the end of the names of derived formulas for it."""

TOPS = ("symmetric top", "heavy top", "fast top", "of a top", "on a top", "steady precession", "sleeping top")

BODIES: tuple[Kind, ...] = (
    Kind("solid cylinder", ("cylinder", "homogeneous cylinder", "circular cylinder"), ("a cylinder",), "cylinder"),
    Kind("hollow cylinder", ("thick tube", "annular cylinder"), ("a hollow cylinder",), "hollow_cylinder"),
    Kind("thin tube", ("cylindrical shell", "thin hollow cylinder"), ("a thin tube",)),
    Kind("annulus", ("annular disk",), ("a annulus",)),
    Kind("conical shell", ("hollow cone",), ("a conical shell",)),
    Kind("thin rod", ("rod", "slender rod", "bar", "thin bar", "slender bar"), ("a rod",), "rod"),
    Kind("box", ("solid box", "block", "cuboid", "brick", "rectangular prism", "parallelepiped"), ("a box",), "box"),
    Kind("cube", ("solid cube",), ("a box",), "box"),
    Kind("plate", ("thin plate", "rectangular plate"), ("a plate", "a flat body"), "plate"),
    Kind("flat body", ("lamina", "plane body"), ("a flat body",)),
    Kind("solid sphere", ("sphere", "homogeneous sphere", "ball"), ("a sphere",), "sphere"),
    Kind("spherical shell", ("thin spherical shell", "hollow ball"), ("a spherical shell",), "spherical_shell"),
    Kind("hollow sphere", ("thick spherical shell",), ("a hollow sphere",), "hollow_sphere"),
    Kind("hemisphere", ("solid hemisphere", "half ball"), ("a hemisphere",), "hemisphere"),
    Kind("solid cone", ("cone", "homogeneous cone", "circular cone"), ("a cone",), "cone"),
    Kind("frustum", ("frustum of a cone", "truncated cone"), ("a frustum",), "frustum"),
    Kind("ellipsoid", ("solid ellipsoid",), ("a ellipsoid",), "ellipsoid"),
    Kind("torus", ("solid torus", "ring with circular section", "doughnut"), ("a torus",), "torus"),
    Kind("disk", ("thin disk", "homogeneous disk", "solid disk", "circular plate"),
         ("a disk", "a cylinder that rolls"), "disk"),
    Kind("ring", ("hoop", "thin ring", "thin hoop"), ("a ring",), "ring"),
    Kind("triangular plate", ("triangle", "thin triangle"), ("a triangular plate", "a flat body"), "triangular_plate"),
    Kind("triangular prism", (), ("a triangular prism",), "triangular_prism"),
    Kind("tetrahedron", (), ("a tetrahedron",), "tetrahedron"),
    Kind("point mass", ("particle",), ("a point mass",)),
    Kind("two masses", ("dumbbell",), ("two masses about",)),
    Kind("round body", ("wheel that rolls",), ("a body that rolls",)),
    Kind("symmetric top", ("heavy symmetric top", "heavy top", "lagrange top", "top"), TOPS),
    Kind("fast top", ("fast symmetric top", "fast heavy top"), TOPS),
    Kind("sleeping top", ("sleeping top at its least spin",), TOPS),
    Kind("free symmetric body", ("free symmetric top", "symmetric body free of torque"),
         ("a free symmetric body", "a free body", "symmetric top", "of a top")),
    Kind("free body", ("torque-free body", "free asymmetric body"), ("a free body", "a principal axis")),
    Kind("asymmetric body", ("rigid body", "general body", "body", "asymmetric rigid body"), ("a asymmetric body",)),
    Kind("compound pendulum", ("physical pendulum", "pendulum"), ("a physical pendulum",)),
    Kind("torsional pendulum", ("torsion pendulum", "torsional spring"),
         ("a torsional pendulum", "a torsional spring")),
    Kind("two masses on a pulley", ("atwood's machine", "atwood machine"), ("two masses on a pulley",)),
    Kind("aircraft", ("body with a plane of symmetry",), ("a body with a plane of symmetry",)),
    Kind("gyroscope", ("wheel", "gyroscopic wheel", "rotor"), ("a level axle", "steady precession", "of a top")),
)  # fmt: skip
"""Every body that words can name; the longest phrase in a text decides which one it is. The phrases for an ellipsoid
and other words with a vowel have the article "a", as names are compared without "an"."""

ALONE = (" about one axis", " about the z axis")
"""The ends of names of formulas for rotation about a fixed axis, which no body in general motion has."""

_FORMULA_PHRASES = tuple(
    sorted({phrase for kind in BODIES for phrase in kind.formulas}, key=lambda phrase: (-len(phrase), phrase))
)

_ROLLS = r"(that )?(has )?roll(s|ed|ing)( without slipping)?"
_MOTION_WORDS = (
    ("rolls from a height", rf"{_ROLLS}( from rest)? (from|down) height( [a-z])?"),
    ("rolls down a slope", rf"{_ROLLS} down (incline|slope|inclined plane)"),
    ("rolls", _ROLLS),
    (GENERAL, r"in general motion"),
)  # fmt: skip

_LETTER = r"[A-Za-z](?:_?[A-Za-z0-9])?'?"
_NOUNS = {
    "radius": ("base radius", "radius"), "length": ("length", "height"), "height": ("height", "length"),
    "inner": ("inner radius",), "outer": ("outer radius",), "ring": ("ring radius", "radius"),
    "tube": ("tube radius",), "base": ("base",), "apex": ("apex",), "bottom": ("bottom radius",),
    "top": ("top radius",),
}  # fmt: skip
"""Name of a dimension of a shape -> the nouns for it, as in "of height h"."""


def bodies_of_formula(name: str) -> set[str]:
    """Return the phrases for bodies that are in the name of a derived formula."""
    phrases: set[str] = set()
    rest = re.sub(r"\ban\b", "a", name)
    for phrase in _FORMULA_PHRASES:
        if re.search(rf"\b{re.escape(phrase)}\b", rest):
            phrases.add(phrase)
            rest = re.sub(rf"\b{re.escape(phrase)}\b", " ", rest)
    return phrases


def body_of_words(words: str) -> Body | None:
    """Return the body that words name, or None if they name no body that symrot knows.

    Examples
    --------
    >>> body = body_of_words("solid cylinder of radius r and height h")
    >>> body.kind.title, body.letters
    ('solid cylinder', {'R': 'r', 'L': 'h'})
    """
    plain = plain_words(words)
    phrases = [(phrase, kind) for kind in BODIES for phrase in kind.phrases
               if re.search(rf"(?<![\w-]){re.escape(phrase)}(?![\w-])", plain)]  # fmt: skip
    if not phrases:
        return None
    phrase, kind = max(phrases, key=lambda pair: len(pair[0]))
    rest = plain.replace(phrase, " ", 1)
    motion = ""
    for name, pattern in _MOTION_WORDS:
        if re.search(pattern, rest):
            motion, rest = name, re.sub(pattern, " ", rest, count=1)
            break
    letters, rest = _letters(kind, words, rest)
    place, rest = place_of_words(rest)
    return Body(kind, motion, letters, place, unused_words(rest))


def _letters(kind: Kind, words: str, rest: str) -> tuple[dict[str, str], str]:
    """Return the letters of the dimensions and moments of a body, and the words without them.

    ``words`` are in the upper and lower case of the input, ``rest`` in lower case.
    """
    letters: dict[str, str] = {}
    dimensions = SHAPES[kind.shape].dimensions if kind.shape else ()
    for dimension in dimensions:
        for noun in _NOUNS.get(dimension.name, ()):
            pattern = (
                rf"(?<!base )(?<!inner )(?<!outer )(?<!tube )\b(?:of |with |and )?(?:a )?{noun} ({_LETTER})(?![\w'])"
            )
            if (match := re.search(pattern, words)) and dimension.symbol not in letters:
                if match[1] in letters.values():
                    continue
                letters[dimension.symbol] = match[1]
                rest = re.sub(pattern, " ", rest, count=1, flags=re.IGNORECASE)
    if match := re.search(rf"\b(?:of |with )?(?:sides?|edges?|semi-?axes) ((?:{_LETTER}(?:,? and |, ?)?)+)", words):
        names = re.findall(_LETTER, match[1].replace(" and ", ","))
        if kind.title == "cube":
            names *= 3
        symbols = [dimension.symbol for dimension in dimensions]
        letters |= dict(zip(symbols, names, strict=False))
        rest = rest.replace(match[0].lower().strip(), " ", 1)
        rest = re.sub(r"(along|in) x, y,? (and )?z|along x( and|,)? .? ?along y", " ", rest)
    if match := re.search(r"\bwith (?:the )?moments ([\w']+), ?([\w']+),?(?: and)? ?([\w']+)", words):
        first, second, third = match.groups()
        letters |= {"A": first, "C": third} if first == second else {"A": first, "B": second, "C": third}
        rest = re.sub(r"with (the )?moments? [\w']+, ?[\w']+,?( and)? ?[\w']+", " ", rest)
    return letters, rest

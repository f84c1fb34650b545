"""The bodies that words such as "solid cylinder of radius r" mean, with the letters of their dimensions."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, cached_property

from symrot.checker.context.quantities import meaningful_words, place_of_words, plain_words
from symrot.inertia.shapes import SHAPES, Dimension

__all__ = ["BODIES", "Body", "Kind", "bodies_of_formula", "body_of_words", "with_article"]


@dataclass(frozen=True)
class Kind:
    """A kind of body, such as a solid cylinder.

    Attributes
    ----------
    title : str
        Its usual name, as a person writes it.
    synonyms : tuple of str
        Other names.
    formulas : tuple of str
        Phrases for this body in the names of derived formulas, such as "hollow cylinder".
    shape : str
        The name of this shape in :mod:`symrot.inertia.shapes`, or an empty text.
    thin : tuple (str, str) or empty
        Phrase and shape of the same body with a thin wall. If only one radius is stated, the thin body is meant; if
        none is stated, either body may be meant.
    """

    title: str
    synonyms: tuple[str, ...]
    formulas: tuple[str, ...]
    shape: str = ""
    thin: tuple[str, str] | tuple[()] = ()

    @cached_property
    def phrases(self) -> tuple[str, ...]:
        """All names of this kind of body, the title and the synonyms, spelled as ``plain_words`` spells them: disk for
        Disc.
        """
        return tuple(map(plain_words, (self.title, *self.synonyms)))


@dataclass(frozen=True)
class Body:
    """A body as words describe it: its kind, and the letters of its dimensions and moments.

    Attributes
    ----------
    kind : Kind
    motion : str
        ``"rolls"``, ``"rolls down a slope"``, ``"rolls from a height"``, or ``"general"`` if the words say "in general
        motion", without a fixed axis; empty if the words state no motion.
    letters : mapping
        Symbol in the derived formulas -> letter in the claim, such as ``{"R": "r"}`` for "of radius r".
    place : str
        The title of a place of :data:`symrot.checker.context.quantities.PLACES`, such as "about an end", or of a line
        of :data:`symrot.checker.context.quantities.LINES`; or empty.
    rest : str
        The words about the body that symrot does not understand.
    factors : mapping
        Symbol -> its ratio to the letter, if it is not 1: ``{"R": 1/2}`` for "of diameter d", since R = d/2.
    axes : str
        The axes that the words allow, such as ``"z"`` for "perpendicular to its plane"; empty for all.
    symmetry_axis : str
        The axis of symmetry that the words state, "x" for "cone with axis x"; empty for z, as in derived formulas.
    """

    kind: Kind
    motion: str = ""
    letters: Mapping[str, str] = field(default_factory=dict)
    place: str = ""
    rest: str = ""
    factors: Mapping[str, Fraction] = field(default_factory=dict)
    axes: str = ""
    symmetry_axis: str = ""

    @property
    def formulas(self) -> tuple[str, ...]:
        """The phrases by which names of derived formulas mention this body, such as "hollow cylinder"."""
        if not self.kind.thin:
            return self.kind.formulas
        # two radii mean a thick wall, one a thin wall; without radii it may be either
        thin = self.kind.thin[0]
        if self.letters.keys() & {"R_1", "R_2"}:
            return self.kind.formulas
        return (thin,) if "R" in self.letters else (*self.kind.formulas, thin)

    @property
    def obscure(self) -> str:
        """The words about the body that symrot does not understand and that may change its moments of inertia."""
        return self.rest if self.kind.shape else ""

    def has(self, name: str) -> bool:
        """Return whether the derived formula with this ``name`` is for this body or for bodies of any kind.

        The name must also agree with the axes and the motion of this body.
        """
        phrases = bodies_of_formula(name)
        own = {phrase for phrase in phrases if phrase in self.formulas}
        if self.axes and own and (axis := re.search(r", ([xyz]) axis", name)) and axis[1] not in self.axes:
            return False
        if phrases - own and not (own and ", or of " in name):
            return False
        if self.motion == GENERAL:
            return not name.endswith(ALONE)
        rolls = self.motion in MOTIONS
        if (" roll" in name) != rolls:
            return not own and " roll" not in name
        return True  # the quantity tells apart the formulas of a body that rolls: energy, acceleration, speed


GENERAL = "general"
MOTIONS = ("rolls", "rolls down a slope", "rolls from a height")
"""The values of ``Body.motion`` that mean that the body rolls."""

TOPS = ("symmetric top", "heavy top", "fast top", "of a top", "on a top", "steady precession", "sleeping top")

BODIES: tuple[Kind, ...] = (
    Kind("solid cylinder", ("cylinder", "homogeneous cylinder", "circular cylinder", "right circular cylinder"),
         ("a cylinder", "a cylinder that rolls"), "cylinder"),
    Kind("hollow cylinder", ("thick tube", "annular cylinder", "tube", "pipe", "thick-walled tube",
                             "thick-walled cylinder", "thick-walled hollow cylinder", "thick-walled pipe",
                             "thick cylindrical shell"),
         ("a hollow cylinder",), "hollow_cylinder", ("a thin tube", "cylinder")),
    Kind("thin tube", ("cylindrical shell", "thin hollow cylinder", "thin-walled cylinder", "thin-walled tube",
                       "thin-walled hollow cylinder", "thin cylindrical shell"), ("a thin tube",), "cylinder"),
    Kind("annulus", ("annular disk",), ("a annulus",), "hollow_cylinder"),
    Kind("elliptical disk", ("elliptic disk", "elliptical plate", "elliptic plate", "elliptical lamina",
                             "elliptic lamina"), ("a elliptical disk",), "ellipsoid"),
    Kind("elliptical cylinder", ("elliptic cylinder",), ("a elliptical cylinder",), "ellipsoid"),
    Kind("conical shell", ("hollow cone",), ("a conical shell",), "cone"),
    Kind("thin rod", ("rod", "slender rod", "bar", "thin bar", "slender bar", "stick", "thin stick",
                      "metre stick", "meter stick", "beam", "slender beam", "pole", "baton"), ("a rod",), "rod"),
    Kind("box", ("solid box", "block", "cuboid", "brick", "rectangular prism", "parallelepiped"), ("a box",), "box"),
    Kind("cube", ("solid cube",), ("a box",), "box"),
    Kind("plate", ("thin plate", "rectangular plate", "thin rectangular plate", "rectangular lamina", "door",
                   "gate", "trapdoor"), ("a plate", "a flat body"), "plate"),
    Kind("flat body", ("lamina", "plane body"), ("a flat body",)),
    Kind("solid sphere", ("sphere", "homogeneous sphere", "ball"), ("a sphere",), "sphere"),
    Kind("spherical shell", ("thin spherical shell", "hollow ball", "thin-walled sphere", "thin-walled hollow sphere",
                             "thin hollow sphere"), ("a spherical shell",), "spherical_shell"),
    Kind("hollow sphere", ("thick spherical shell",), ("a hollow sphere",), "hollow_sphere",
         ("a spherical shell", "spherical_shell")),
    Kind("hemisphere", ("solid hemisphere", "half ball"), ("a hemisphere",), "hemisphere"),
    Kind("solid cone", ("cone", "homogeneous cone", "circular cone", "right circular cone", "right cone"),
         ("a cone",), "cone"),
    Kind("frustum", ("frustum of a cone", "truncated cone"), ("a frustum",), "frustum"),
    Kind("ellipsoid", ("solid ellipsoid", "ellipsoid of revolution", "spheroid", "oblate spheroid",
                       "prolate spheroid"), ("a ellipsoid",), "ellipsoid"),
    Kind("torus", ("solid torus", "ring with circular section", "doughnut"), ("a torus",), "torus"),
    Kind("disk", ("thin disk", "homogeneous disk", "solid disk", "circular plate", "circular disk",
                  "thin circular disk", "circular lamina", "coin", "turntable"),
         ("a disk", "a cylinder that rolls"), "disk"),
    Kind("ring", ("hoop", "thin ring", "thin hoop", "circular ring"), ("a ring",), "ring"),
    Kind("triangular plate", ("triangle", "thin triangle"),
         ("a triangular plate", "a right triangular plate", "a flat body"), "triangular_plate"),
    Kind("right triangular plate", ("right triangle", "right-angled triangle", "right-angled triangular plate"),
         ("a right triangular plate", "a flat body")),
    Kind("triangular prism", (), ("a triangular prism",), "triangular_prism"),
    Kind("tetrahedron", (), ("a tetrahedron",), "tetrahedron"),
    Kind("point mass", ("particle",), ("a point mass",)),
    Kind("two masses", ("dumbbell",), ("two masses about",)),
    Kind("round body", ("wheel that rolls",), ("a body that rolls",)),
    Kind("symmetric top", ("top",), (*TOPS, "a free symmetric body")),
    Kind("heavy top", ("heavy symmetric top", "lagrange top"), TOPS),
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
    Kind("gyroscope", ("wheel", "gyroscopic wheel", "rotor"),
         ("a level axle", "steady precession", "of a top", "fast top")),
)  # fmt: skip
"""Every kind of body that a user can name in words. If the user's words contain phrases for several kinds, the kind
with the longest phrase is taken. In the names of derived formulas, the article is "a" also before a vowel: "a
annulus"."""

ALONE = (" about one axis", " about the z axis")
"""Endings of the names of formulas that hold only for rotation about a fixed axis, not in general motion."""

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
_TERM = rf"(?!\d*[cmk]?m\b)(?:[1-9]\d{{0,8}})?{_LETTER}(?:/[1-9]\d{{0,8}})?"
_NOUNS = {
    "radius": ("base radius", "radius"), "length": ("length", "height"), "height": ("height", "length"),
    "inner": ("inner radius",), "outer": ("outer radius",), "ring": ("ring radius", "radius"),
    "tube": ("tube radius",), "base": ("base",), "apex": ("apex",), "bottom": ("bottom radius",),
    "top": ("top radius",), "a": ("length",), "b": ("width", "breadth"), "c": ("height", "thickness", "depth"),
}  # fmt: skip
"""Maps a dimension of a body to nouns for it, as in "of height h". For a noun with "radius" in it, "diameter" in its
place is understood too."""

_SIDES: dict[str, tuple[tuple[str, Fraction], ...]] = {
    "ellipsoid": ((r"(?:half|semi)-?\s?ax[ei]s", Fraction(1)), (r"diameters|full axes", Fraction(1, 2))),
    "other": ((r"(?:half|semi)[- ]?(?:sides?|edges?|ax[ei]s)", Fraction(2)), ("sides?|edges?", Fraction(1))),
}  # fmt: skip
"""Maps "ellipsoid", or "other" for all other shapes, to pairs (pattern of a noun for the dimensions, factor), as in
"semi-axes a, b, c": the author's letter times the factor is symrot's dimension."""

_HARMLESS = re.compile(
    r"\b(uniform|homogeneous|rigid|solid|(of |with )?(constant|uniform) density|(of |with |and )?mass( [a-zA-Z]\b)?"
    r"|(of |with |and )?density (rho|ρ)|(with )?axis [xyz]"
    r"|free to rotate|hinged|pivoted|rotating|rotates|spinning|spins|turning|turns|swinging|swings|oscillating"
    r"|flywheel|pulley|platform|in (form|shape) of|shaped like|shaped as|modelled as|modeled as|treated as)(?![\w-])"
)
"""Pattern of words about a body that change none of its formulas."""

_LINE = r"(?:(?:,? (?:and )?)?(?:axis |line )?(?:that is )?)?"
_FACES = r"(?:it|plane|disk|ring|hoop|plate|lamina|surface|faces?|flat faces?|bases?|ends?|end faces?)\b"
_OWN_AXIS = r"(?:axis of (?:symmetry|revolution)|(?:symmetry |own |figure |central |cylinder |longitudinal )?axis)\b"
_ROUND = (*("cylinder", "hollow_cylinder", "cone", "frustum", "hemisphere", "torus"), "disk", "ring")
_FLAT = ("disk", "ring", "annulus", "elliptical disk", "plate", "triangular plate", "flat body")
ROD = "thin rod"
_DIRECTIONS: tuple[tuple[tuple[str, ...], str, str], ...] = (
    ((ROD,), r"(?:perpendicular|normal) to (?:it|rod|bar|stick|length|axis)\b", "xy"),
    (_ROUND, rf"(?:perpendicular|normal) to {_OWN_AXIS}", "xy"),
    (_ROUND, rf"parallel to {_OWN_AXIS}", "z"),
    ((*_FLAT, *_ROUND), rf"(?:perpendicular|normal) to (?:plane of )?{_FACES}", "z"),
    ((*_FLAT, *_ROUND), rf"(?:parallel to|lying in|in) (?:plane of )?{_FACES}", "xy"),
)
"""Triples (titles or shapes of bodies, pattern, axes): the pattern matches words for the direction of an axis through
such a body, the axes are those with this direction, "z" for "perpendicular to its plane"."""

_PLANE = re.compile(
    r",? ?\b(?:that )?(?:lying |lies |placed |is )?in (?:plane (?:of )?)?"
    r"([xyz])(?:,? and |, ?|[- ])?([xyz])(?:[- ]?plane)?(?![\w-])"
)
"""Pattern of words for the plane of a flat body, such as "in the xy-plane"."""
_HEIGHT_OF_FALL = re.compile(r"\b(from|down)( a| the)? height( [a-zA-Z]\b)?")
_WITHOUT_AXIS = ("box", "plate", "ellipsoid", "triangular_plate", "triangular_prism", "tetrahedron")
"""Shapes whose formulas have no axis of symmetry."""

_ALONG = re.compile(
    r",?(?<!about)(?<!about its)(?<!about the)\s(?:with |and |whose )?(?:its |the |an )?"
    r"(?:(?:symmetry )?axis(?: of symmetry)?(?: is)?(?: along| in)?|along)(?: the)? ([xyz])"
    r"(?:[- ](?:axis|direction))?(?!\w)(?!,? (?:and )?(?:along )?[xyz]\b)"
)
"""Pattern of words for the axis of symmetry of a body, such as "with axis x"."""


@cache
def with_article(words: str) -> str:
    """Return ``an ellipsoid`` for ``ellipsoid``, and ``a unit vector`` for ``unit vector``."""
    return f"an {words}" if words[0] in "aeio" else f"a {words}"


def bodies_of_formula(name: str) -> frozenset[str]:
    """Return the bodies that the ``name`` of a derived formula mentions, as phrases such as "a hollow cylinder"."""
    phrases: set[str] = set()
    rest = re.sub(r"\ban\b", "a", name)
    for phrase in _FORMULA_PHRASES:
        if phrase in rest:
            without = re.sub(rf"\b{re.escape(phrase)}\b", " ", rest)
            phrases |= {phrase} if without != rest else set()
            rest = without
    return frozenset(phrases)


def body_of_words(words: str) -> Body | None:
    """Return the body that words describe, or None if symrot knows no such body.

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
    along = _ALONG.search(rest) if kind.shape and kind.shape not in _WITHOUT_AXIS else None
    rest = _ALONG.sub(" ", rest, count=1) if along else rest
    letters, factors, rest = _letters(kind, _HEIGHT_OF_FALL.sub(" ", words), rest)
    rest, normal = _without_plane(kind, rest)
    axes, rest = _direction(kind, rest)
    own = Body(kind, motion, letters).formulas
    place, rest = place_of_words(" ".join(rest.split()), own)
    if axes and re.fullmatch(r"(.* )?about", " ".join(rest.split())):
        rest = rest.strip().removesuffix("about")
    symmetry_axis = (along[1] if along else normal).replace("z", "")
    return Body(kind, motion, letters, place, meaningful_words(_HARMLESS.sub(" ", rest)), factors, axes, symmetry_axis)


def _without_plane(kind: Kind, words: str) -> tuple[str, str]:
    """Return ``words`` without "in the xy plane", and the normal "z"; unchanged words and "" if no plane is stated."""
    match = _PLANE.search(words) if kind.title in _FLAT else None
    normal = "xyz".replace(match[1], "").replace(match[2], "") if match else ""
    # the derived formulas have the sides of a plate along x and y: only this plane is known
    if match is None or len(normal) > 1 or (normal != "z" and kind.shape not in _ROUND):
        return words, ""
    return " ".join(_PLANE.sub(" ", words, count=1).split()), normal


def _direction(kind: Kind, words: str) -> tuple[str, str]:
    """Return (axes, other words) for words about a body that may state the direction of an axis.

    The axes are "xy" for "parallel to its base", which leaves open whether x or y is meant, and "" if the words state
    no direction. ``kind`` is the kind of the body: "perpendicular to its axis" is understood for a rod or a round body
    only.
    """
    for kinds, pattern, axes in _DIRECTIONS:
        if kind.title in kinds or kind.shape in kinds:
            rest = re.sub(rf"{_LINE}{pattern}", " ", words, count=1)
            if rest != words:
                return axes, rest
    return "", words


def _scaled(term: str) -> tuple[str, Fraction]:
    """Return the letter and the factor of a dimension: a and 2 for "2a", d and 1/2 for "d/2"."""
    match = re.fullmatch(rf"(\d+)?({_LETTER})(?:/(\d+))?", term)
    assert match is not None
    return match[2], Fraction(int(match[1] or 1), int(match[3] or 1))


def _dimensions(kind: Kind) -> list[Dimension]:
    """Return the dimensions of a kind of body, such as radius and length, with and without a thin wall."""
    shapes = [name for name in (kind.shape, *kind.thin[1:]) if name]
    return [dimension for name in shapes for dimension in SHAPES[name].dimensions]


def _letters(kind: Kind, words: str, rest: str) -> tuple[dict[str, str], dict[str, Fraction], str]:
    """Return (letters, factors, other words) for words that state the dimensions of a body or its moments of inertia.

    For "diameter d", the letters are {"R": "d"} and the factors {"R": 1/2}: the radius R of the derived formulas is
    d/2. A factor 1 is left out. ``kind`` is the kind of the body, which determines its dimensions. They are looked for
    in ``words``, as typed, since case matters. ``rest`` are the words in lower case that symrot has not used so far;
    the other words are ``rest`` without the words for dimensions and moments.
    """
    letters: dict[str, str] = {}
    factors: dict[str, Fraction] = {}
    dimensions = _dimensions(kind)
    for dimension in dimensions:
        nouns = [(noun, Fraction(1)) for noun in _NOUNS.get(dimension.name, ())]
        nouns += [(noun.replace("radius", "diameter"), Fraction(1, 2)) for noun, _ in nouns if "radius" in noun]
        nouns = [(f"(?:half|semi)[- ]?{noun}", 2 * unit) for noun, unit in nouns] + nouns
        for noun, unit in nouns:
            pattern = (
                r"(?<!half[- ])(?<!semi[- ])(?<!base )(?<!inner )(?<!outer )(?<!tube )"
                rf"\b(?:of |with |and )?(?:a )?{noun} ({_TERM})(?![\w'/])"
            )
            if (match := re.search(pattern, words)) and dimension.symbol not in letters:
                letter, factor = _scaled(match[1])
                if letter in letters.values():
                    continue
                letters[dimension.symbol], factors[dimension.symbol] = letter, factor * unit
                rest = re.sub(pattern, " ", rest, count=1, flags=re.IGNORECASE)
    for side, unit in _SIDES["ellipsoid" if kind.shape == "ellipsoid" else "other"]:
        sides = rf"\b(?:of |with )?(?<!half[- ])(?:{side})(?: lengths?)? ((?:{_TERM}(?![\w'/])(?:,? and |, ?)?)+)"
        if not (match := re.search(sides, words)):
            continue
        terms = [_scaled(term) for term in re.findall(_TERM, re.sub(r",? and |, ?", ";", match[1]))]
        if kind.title == "cube":
            terms *= 3
        for dimension, (letter, factor) in zip(dimensions, terms, strict=False):
            letters[dimension.symbol], factors[dimension.symbol] = letter, factor * unit
        rest = rest.replace(plain_words(match[0]), " ", 1)
        rest = re.sub(r"(along|in) x, y,? (and )?z|along x( and|,)? .? ?along y", " ", rest)
    if match := re.search(r"\bwith (?:the )?moments ([\w']+), ?([\w']+),?(?: and)? ?([\w']+)", words):
        first, second, third = match.groups()
        letters |= {"A": first, "C": third} if first == second else {"A": first, "B": second, "C": third}
        rest = re.sub(r"with (the )?moments? [\w']+, ?[\w']+,?( and)? ?[\w']+", " ", rest)
    if not dimensions:  # the derived formulas have no dimensions of such a body
        rest = re.sub(rf"\b(of |with |and )?(radius|length) {_LETTER}(?![\w'/])", " ", rest, flags=re.IGNORECASE)
    return letters, {symbol: factor for symbol, factor in factors.items() if factor != 1}, rest

"""The quantities that words such as "moment of inertia about the centre" mean, with their synonyms.

Each quantity has phrases and symbols by which the known formulas for it are found: the name of a formula for the
kinetic energy contains the phrase "kinetic energy", and the formula has the symbol E_k for it.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

__all__ = [
    "AMBIGUOUS", "CENTRE", "LINES", "PLACES", "QUANTITIES", "RIM", "SURFACE", "Quantity", "meaningful_words",
    "place_of_words", "plain_words",
]  # fmt: skip


@dataclass(frozen=True)
class Quantity:
    """A quantity of mechanics, such as the moment of inertia.

    Attributes
    ----------
    title : str
        Its usual name.
    synonyms : tuple of str
        Other phrases for it.
    formulas : tuple of str
        Phrases: the name of every known formula for the quantity contains one of them. Empty if any name fits.
    symbols : str
        A pattern of the symbols that derived formulas use for it; empty if they use none.
    unit : str
        Its unit, "1" for a number; empty if its entries have several units.
    sign : str
        "minus" for a product of inertia that its title defines with the minus sign, as in -m x y, "plus" for one that
        its title defines without it, and empty for all other quantities.
    """

    title: str
    synonyms: tuple[str, ...]
    formulas: tuple[str, ...]
    symbols: str
    unit: str
    sign: str = ""

    @cached_property
    def phrases(self) -> tuple[str, ...]:
        """The title and the synonyms, spelled as ``plain_words`` spells them: centre for Center, about for around."""
        return tuple(map(plain_words, (self.title, *self.synonyms)))


MOMENT, MOMENTUM, RATE, ENERGY, TORQUE = "kg m^2", "kg m^2/s", "rad/s", "J", "N m"
INERTIA = ("moment of inertia", "inertia tensor", "parallel-axis")
MOMENTS, OMEGAS = "A|B|C|I_xx|I_yy|I_zz", "omega_[123xyzif]"

QUANTITIES: tuple[Quantity, ...] = (
    Quantity("moment of inertia", ("inertia",), INERTIA, MOMENTS, MOMENT),
    Quantity("axial moment of inertia",
             ("axial moment", "moment about the spin axis", "moment about the axis",
              "moment of inertia about the axis", "inertia about the axis",
              "moment about the symmetry axis", "moment of inertia about the symmetry axis"), INERTIA, "C", MOMENT),
    Quantity("transverse moment of inertia",
             ("transverse moment", "transverse inertia", "moment about a transverse axis", "equatorial moment",
              "moment of inertia about a transverse axis"), INERTIA, "A|B", MOMENT),
    Quantity("principal moment of inertia", ("principal moment",), INERTIA, MOMENTS, MOMENT),
    Quantity("product of inertia", (), ("product of inertia",), "I_xy|I_xz|I_yz", MOMENT),
    Quantity("product of inertia without the minus sign",
             ("product of inertia with a plus sign", "integral of x y dm", "integral of x z dm", "integral of y z dm",
              "positive product of inertia"),
             ("product of inertia",), "I_xy|I_xz|I_yz", MOMENT, sign="plus"),
    Quantity("product of inertia with the minus sign",
             ("product of inertia with a minus sign", "minus integral of x y dm", "minus integral of x z dm",
              "minus integral of y z dm", "negative product of inertia"),
             ("product of inertia",), "I_xy|I_xz|I_yz", MOMENT, sign="minus"),
    Quantity("inertia tensor", ("inertia matrix", "tensor of inertia", "matrix of inertia"),
             ("inertia tensor", "parallel-axis"), f"{MOMENTS}|I_xy|I_xz|I_yz", MOMENT),
    Quantity("radius of gyration", (), ("radius of gyration",), "k_O|k_G|i|k", "m"),
    Quantity("kinetic energy", ("kinetic energy of rotation", "rotational energy", "energy of rotation"),
             ("kinetic energy",), "E_k", ENERGY),
    Quantity("potential energy", ("potential",), ("potential",), "E_k", ENERGY),
    Quantity("energy", ("total energy", "mechanical energy"), ("energy of",), "E_k|E", ENERGY),
    Quantity("effective potential", (), ("effective potential",), "", ENERGY),
    Quantity("Lagrangian", (), ("Lagrangian",), "", ENERGY),
    Quantity("work", (), ("work",), "W_k", ENERGY),
    Quantity("power", (), ("power",), "", "W"),
    Quantity("angular momentum", ("moment of momentum",), ("angular momentum",), "H|L_[123]|h_[123]|h_w", MOMENTUM),
    Quantity("momentum of precession", ("momentum of phi", "momentum of the precession angle"),
             ("momentum of precession",), "p_phi", MOMENTUM),
    Quantity("momentum of nutation", ("momentum of theta", "momentum of the nutation angle"),
             ("momentum of nutation",), "p_theta", MOMENTUM),
    Quantity("momentum of spin", ("momentum of psi", "momentum of the spin angle"),
             ("momentum of spin",), "p_psi", MOMENTUM),
    Quantity("torque", ("couple", "moment of force", "rolling moment", "pitching moment", "yawing moment",
                        "torque of gravity"),
             ("torque",), "M|tau_[123]", TORQUE),
    Quantity("angular velocity", ("body rate", "angular rate", "angular speed", "rotation rate"),
             ("angular velocity", "length of the angular velocity"), f"{OMEGAS}|Omega|omega_p|n", RATE),
    Quantity("mean motion", ("orbital rate", "orbit rate", "rate of the orbit", "orbital angular velocity"),
             (), "n", RATE),
    Quantity("precession rate", ("rate of precession", "precession", "angular velocity of precession"),
             ("precession",), "dphi|Omega|n", RATE),
    Quantity("slow precession rate", ("rate of slow precession", "slow precession"), ("slow precession",),
             "dphi|Omega|n", RATE),
    Quantity("steady precession rate", ("rate of steady precession", "steady precession"), ("steady precession",),
             "dphi|Omega|n", RATE),
    Quantity("spin", ("spin rate", "rate of spin", "angular velocity of spin"),
             ("spin", "along the axis"), "dpsi|omega_3|p", RATE),
    Quantity("angular velocity along the axis", ("component of the angular velocity along the axis",),
             ("along the axis", "angular velocity"), "omega_3", RATE),
    Quantity("nutation rate", ("rate of nutation",), ("nutation",), "dtheta", RATE),
    Quantity("frequency", ("angular frequency", "frequency of nutation", "frequency of small oscillations"),
             ("frequency",), "n|Omega", RATE),
    Quantity("angle rate", ("rate of the angles", "rate of an angle", "rate of the euler angles", "euler angle rate"),
             ("angle rates",), "dphi|dtheta|dpsi", RATE),
    Quantity("angular acceleration", ("constant angular acceleration",),
             ("angular acceleration", "Euler's equations"), "alpha_a|domega_[123]|ddtheta|ddomega_1", "rad/s^2"),
    Quantity("precession angle", ("angle of precession",), ("angle of", "yaw"), "phi", "rad"),
    Quantity("angle of the axis", ("nutation angle", "angle of nutation", "angle of the axis from the vertical",
                                   "angle of the axis from the upward vertical", "nutation",
                                   "angle between the axis and the angular momentum", "angle between axis and H",
                                   "angle between the angular momentum and the axis",
                                   "angle between the axis and the vertical",
                                   "angle between the rod and the axis"), ("angle of",), "theta", "rad"),
    Quantity("spin angle", ("angle of spin",), ("angle of", "roll"), "psi", "rad"),
    Quantity("angle between the axis and the angular velocity",
             ("angle between the angular velocity and the axis", "angle between axis and omega"),
             ("angle of",), "gamma", "rad"),
    Quantity("angle of the slope", ("angle of the incline", "slope", "angle of the incline from the horizontal"),
             (), "beta", "rad"),
    Quantity("angle of rotation", ("angle of the rotation", "rotation angle"), ("angle of", "angle at"),
             "alpha|theta_i|theta_f", "rad"),
    Quantity("yaw", ("heading", "yaw angle"), ("yaw",), "phi", "rad"),
    Quantity("pitch", ("pitch angle",), ("pitch",), "theta", "rad"),
    Quantity("roll", ("bank", "roll angle"), ("roll",), "psi", "rad"),
    Quantity("mass", (), (), "m|m_[12]", "kg"),
    Quantity("weight", (), (), "W", "N"),
    Quantity("tension", ("tension of string", "tension in string", "string tension", "force in string",
                         "tension of rope", "tension in rope"), ("tension of",), "T_s", "N"),
    Quantity("gravity", ("gravitational acceleration", "acceleration of gravity"), (), "g", "m/s^2"),
    Quantity("radius", (), (), "R|r|R_1|R_2", "m"),
    Quantity("length", (), (), "L", "m"),
    Quantity("height", (), (), "h|L", "m"),
    Quantity("distance of the centre of mass",
             ("distance of the centre of mass from the pivot", "distance of the centre of mass from the fixed point"),
             (), "c_3|r|L", "m"),
    Quantity("distance of the axes", ("distance between the axes", "distance of two axes"), (), "r|d_[xyz]", "m"),
    Quantity("distance of the centre of percussion",
             ("centre of percussion", "distance of the centre of percussion from the pivot"),
             ("distance of",), "q_d", "m"),
    Quantity("speed", ("velocity",), ("speed", "velocity of"), "v", "m/s"),
    Quantity("acceleration", (), ("acceleration of",), "a_l", "m/s^2"),
    Quantity("period", ("period of oscillation", "period of small oscillations"), ("period",), "T_p", "s"),
    Quantity("time", (), (), "t", "s"),
    Quantity("stiffness", ("torsional stiffness", "spring constant"), (), "k_t|k_s", "N m/rad"),
    Quantity("Rodrigues parameter", ("classical rodrigues parameter", "gibbs vector"),
             ("Rodrigues parameters",), "g[123]|sigma", "1"),
    Quantity("modified Rodrigues parameter", ("length of the modified rodrigues parameter",),
             ("modified Rodrigues parameters",), "s[123]|sigma", "1"),
    Quantity("quaternion",
             ("euler parameter", "unit quaternion", "scalar euler parameter", "scalar part of a quaternion"),
             ("quaternion",), "q[0123]|p[0123]", "1"),
    Quantity("rate matrix", ("matrix of the angle rates", "rate jacobian", "jacobian of the rates"),
             ("rate Jacobian", "rate matrix"), "", ""),
    Quantity("rotation matrix", ("attitude matrix", "direction cosine matrix", "matrix of a rotation"),
             ("rotation matrix", "rotation about"), "R_[123][123]", "1"),
    Quantity("unit vector along the axis", ("axis of rotation", "unit axis", "rotation axis"),
             ("axis of",), "n[123]", "1"),
)  # fmt: skip
"""Every quantity that a user can name in words. If phrases of several quantities occur at the same place in the user's
words, the longest phrase is used."""

AMBIGUOUS = {"moment": "'moment of inertia' or 'torque'", "rate": "a rate with its quantity, as in 'rate of spin'"}
"""Maps words that name more than one quantity to what should be written instead."""

CENTRE, END, CORNER, RIM, SURFACE = (
    "about the centre of mass", "about an end", "about a corner", "about a point of the rim",
    "about a point of the surface",
)  # fmt: skip
PLACES: tuple[tuple[str, tuple[str, ...], tuple[str, ...]], ...] = (
    (CENTRE, ("centre", "centre of mass", "centroid", "central axis", "centre of gravity", "geometric centre",
              "middle", "midpoint", "middle point", "cm", "com", "c.m."),
     ("about its centre of mass", "about their centre of mass", "of given density", "radius of gyration of a",
      "through its centre")),
    (END, ("end", "ends", "end point", "endpoint", "centre of an end", "centre of one end"),
     ("about an end", "about the centre of an end", "through an end")),
    ("about the tip", ("tip", "apex", "vertex"), ("about its tip",)),
    ("about the base", ("base", "centre of the base", "centre of the flat face", "bottom", "centre of the bottom"),
     ("about the centre of the base", "about the centre of the flat face", "about the centre of the bottom")),
    (CORNER, ("corner", "first corner", "right corner", "corner of right angle", "right angle"),
     ("about a corner", "about the first corner", "about the corner at (0, 0)", "about the corner of its right angle")),
    (RIM, ("rim", *(f"point {word} {place}" for word in ("of", "on") for place in ("rim", "edge", "circumference"))),
     ("about a point of its rim",)),
    (SURFACE, ("point of surface", "point on surface"),
     ("about a point of its surface",)),
    ("about the middle of a side", ("middle of a side",), ("about the middle of a side",)),
    ("about the fixed point", ("pivot", "fixed point", "point o", "o", "pivot o"), ()),
    ("about the fixed axis", ("fixed axis", "one axis"), ("about one axis",)),
)  # fmt: skip
"""Triples for points of a body through which axes go: (title of the point, such as "about an end"; words that users
write for it after "about"; words for it in the names of derived formulas)."""

ROUND = (
    "a cylinder", "a hollow cylinder", "a thin tube", "a annulus", "a cone", "a frustum", "a disk", "a ring", "a torus",
    "a hemisphere",
)  # fmt: skip
BALLS = ("a sphere", "a spherical shell", "a hollow sphere")
LINES: dict[str, tuple[tuple[str, ...], dict[str, tuple[str, str]]]] = {
    "about a diameter": (
        ("diameter", "central diameter", "diameter through centre", "transverse diameter",
         "axis in plane through centre"),
        {**dict.fromkeys(ROUND, (CENTRE, "xy")), **dict.fromkeys(BALLS, (CENTRE, "xyz"))},
    ),
    "about its axis": (
        ("axis", "symmetry axis", "axis of symmetry", "own axis", "longitudinal axis", "figure axis", "geometric axis",
         "cylinder axis", "polar axis", "z axis", "z-axis", "central axis", "axis of revolution",
         "axle"),
        {**dict.fromkeys(ROUND, (CENTRE, "z")), **dict.fromkeys(BALLS, (CENTRE, "xyz")),
         "a conical shell": ("about the tip", "z")},
    ),
    "about a transverse axis through the centre": (
        ("transverse axis", "transverse axis through centre", "transverse axis through centre of mass"),
        dict.fromkeys((*ROUND, "a rod"), (CENTRE, "xy")),
    ),
    "about a tangent": (
        ("tangent", "tangent line", "tangential axis", "axis tangent to it"),
        {"a disk": (RIM, "yz"), "a ring": (RIM, "yz"), "a sphere": (SURFACE, "xy")},
    ),
    "about the centre of an end face": (
        ("base", "centre of base", "centre of one base", "centre of bottom", "centre of one face",
         "centre of end face"),
        {"a cylinder": (END, "xyz")},
    ),
    "about an edge": (
        ("edge", "side", "edges", "sides", "hinge", "hinges"),
        {"a box": (CORNER, "xyz"), "a plate": (CORNER, "xy")},
    ),
    "about its base": (
        ("base", "base line", "base edge"), {"a plate": (CORNER, "xy"), "a triangular plate": (CORNER, "x")}
    ),
}  # fmt: skip
"""Lines that serve as axes of bodies: {title: (phrases, {body: (point, axes)})}.

An example of a title is "about a diameter". The phrases are the words that users write after "about" for this line. The
inner dictionary says where the line is in each body that has it: a diameter of a disk goes through the centre of mass
along x or y, so that its entry is {"a disk": (CENTRE, "xy")}. The name of a derived formula states a body, a point and
perhaps an axis. The formula is for the line if the entry of its body has the same point, and also the stated axis if
there is one."""

UNUSED = frozenset({
    "a", "an", "the", "of", "its", "their", "any", "some", "this", "that", "is", "are", "and", "in", "by",
    "constant", "unit", "axes", "axis", "component", "with",
})  # fmt: skip
"""Words that the check does not need to understand a statement."""

_SPELLINGS = (
    (r"∫|\\int|\bint\b", " integral of "), (r"\bcenter", "centre"), (r"\bdisc\b", "disk"), (r"φ|\\varphi|\\phi", "phi"),
    (r"θ|ϑ|\\vartheta|\\theta", "theta"), (r"ψ|\\psi", "psi"), (r"ω|\\boldsymbol\\omega|\\omega", "omega"),
    (r"\bx\s*y\s*(\\,)?\s*dm\b", "x y dm"), (r"\bx\s*z\s*(\\,)?\s*dm\b", "x z dm"),
    (r"\by\s*z\s*(\\,)?\s*dm\b", "y z dm"), (r"\bmoments\b", "moment"), (r"\bproducts\b", "product"),
    (r"\b(rate|quaternion|parameter|torque|rotation|couple|angle)s\b", r"\1"), (r"\baxes\b", "axis"),
    (r"\b(with|in|by) (the )?(euler )?angles? phi,? theta,?( and)? psi\b|\bat (the )?(finite )?angle theta\b", " "),
    (r"\baround\b|\bround (?=(a|an|the|its) )", "about "), (r"\b(the|an|its|their)\b", " "),
    (r"\b(with )?\s*(centred|centre) +(at|on|in) +(origin|o)\b", "about centre"),
    (r"(?<!radius )(?<!length )(?<!height )(?<!side )(?<!sides )(?<!, )\ba (?!and )(?=[a-z]{3})", ""),
)  # fmt: skip


def plain_words(text: str) -> str:
    """Return words in lower case and in one spelling, without articles, with single blanks.

    Examples
    --------
    >>> plain_words("Moments of  inertia around its center")
    'moment of inertia about centre'
    """
    words = text.lower()
    for pattern, spelling in _SPELLINGS:
        words = re.sub(pattern, spelling, words)
    words = re.sub(r"integral of\s+(integral of\s+)+", "integral of ", words)
    words = re.sub(r"[-−]\s*(?=integral)", "minus ", words)
    words = re.sub(r"product of inertia\W*(?:as |defined as |given by )?(?=(?:minus )?integral of)", "", words)
    return " ".join(words.split())


def place_of_words(words: str, formulas: Collection[str] = ()) -> tuple[str, str]:
    """Return the place of an axis that words state, such as "about an end", or "" for none, and the other words.

    ``formulas`` are the names of the body in derived formulas, such as "a disk". A line such as "about a diameter"
    counts as a place only if the body has this line. Without ``formulas``, the body is unknown, and all lines count.

    Examples
    --------
    >>> place_of_words("of a rod about one end")
    ('about an end', 'of a rod')
    """
    titled = [(title, phrases) for title, phrases, _ in PLACES]
    lines = [(title, phrases) for title, (phrases, bodies) in LINES.items() if not formulas or {*bodies} & {*formulas}]
    places = [
        (match, title)
        for title, phrases in (*lines, *titled)
        for phrase in phrases
        if (match := re.search(rf"{_BEFORE_PLACE} {plain_words(phrase)}{_END_OF_PLACE}", words))
    ]
    if not places:
        return "", words
    match, title = max(places, key=lambda pair: len(pair[0][0]))
    rest = words.replace(match[0], " ", 1)
    if match[1] == "through":
        rest = re.sub(r"\babout (axis )?(?=\s|$)", " ", rest, count=1)
    return title, " ".join(rest.split())


_BEFORE_PLACE = r"(through|about|hung at|hung from|at)(?: (?:any|some|one|either)(?: of)?(?! axis))?"
"""Pattern of the words in front of a point or line, such as "about one of" in "about one of its ends".

In "about one axis" only "about" matches, which leaves "one axis", a phrase for the fixed axis of a body. If "about one"
matched, "axis" would be left, a phrase for the axis of symmetry."""

_END_OF_PLACE = r"(?![\w-])(?! (?:of|in|through|perpendicular|normal|parallel|along|at|inclined|tilted)\b)"


def meaningful_words(words: str) -> str:
    """Return ``words`` without those that no check needs, such as articles and prepositions.

    Examples
    --------
    >>> meaningful_words("of the body, with a torque")
    'body torque'
    """
    return " ".join(word for word in re.findall(r"[^\s,;]+", words) if word not in UNUSED)

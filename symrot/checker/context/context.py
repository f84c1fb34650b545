"""The context of a claim: what a person states in words about its names, the body, the frame and the angles.

The words say which known formula a claim means, so that a claim such as ``I = m l^2/3`` can be decided.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from symrot.checker.claim.tree import Node, is_derivative, is_name, nodes_of
from symrot.checker.context.bodies import Body, with_article
from symrot.checker.context.quantities import LINES, Quantity
from symrot.checker.units.units import read_unit
from symrot.errors import InputError

__all__ = ["NO_CONTEXT", "Context", "Meaning", "letters_of", "matrix_of", "name_of", "quantities_of"]

_OF_AXES = re.compile(
    r"\b(about|through|perpendicular|normal|parallel|vertical|horizontal|edge|tangent|diameter|plane|inclined)\b"
)
"""Pattern of the words that say where an axis is, such as "about" and "diameter"."""

_OF_RATE = re.compile(r"^d+(?=.)|_?d+ot$|(_prime)+$")
"""Pattern of the mark of a rate in its name: the "d" of dphi, the "_dot" of phi_dot, the "_prime" of phi_prime."""


def matrix_of(name: str) -> str:
    """Return the matrix of which ``name`` is an entry: A for A_12, J_c for J_c_xy; return any other name unchanged."""
    return re.sub(r"_?([xyz]{2}|[1-3]{2})$", "", name)


@dataclass(frozen=True)
class Meaning:
    """What the words of the context say about one name, or about several.

    Attributes
    ----------
    spellings : tuple of tuple of str
        For each name, its spellings in the tree of a parsed formula: ``omega`` for ω, ``dphi`` for φ'. An ambiguous
        name has several spellings.
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

    spellings: tuple[tuple[str, ...], ...]
    quantity: Quantity
    place: str = ""
    body: Body | None = None
    frame: str = ""
    written: tuple[str, ...] = ()
    rest: str = ""

    @cached_property
    def names(self) -> tuple[str, ...]:
        """All spellings of the names with this meaning, as in the tree of a parsed formula: omega for ω."""
        return tuple(dict.fromkeys(name for spelling in self.spellings for name in spelling))

    def is_of(self, name: str) -> bool:
        """Return whether this meaning belongs to ``name``.

        A meaning of a vector or matrix also belongs to its entries: that of L to L_x.
        """
        return self._is_spelled(name, self.names)

    def absent(self, names: set[str]) -> list[str]:
        """Return the names of this meaning, as the user typed them, that do not occur among ``names``.

        The name of a vector or matrix occurs if one of its entries does: I if I_xx is among ``names``.
        """
        pairs = zip(self.written, self.spellings, strict=True)
        return [written for written, spelling in pairs if not any(self._is_spelled(name, spelling) for name in names)]

    def _is_spelled(self, name: str, spelling: tuple[str, ...]) -> bool:
        # a quaternion beta has the entry beta_0, a matrix A the entry A_12
        stem = re.sub(r"_?[0-4]$" if self.quantity.title == "quaternion" else r"_?[xyz1-3]$", "", name)
        return not {name, stem, f"{stem}_i", matrix_of(name)}.isdisjoint(spelling)


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
        """Where the axis is, as the context's words about the body state: "about an end" for "rod about one end".

        Empty if these words state no place.
        """
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
        """The words about the body, or about the axis of a quantity, that symrot does not understand; "" if none."""
        own = [self.body.obscure] if self.body else []
        for meaning in self.meanings:
            own += [meaning.body.obscure] if meaning.body else []
            own += [meaning.rest] if _OF_AXES.search(meaning.rest) else []
            own += [meaning.place] if self.body and not _has_line(self.body, meaning.place) else []
        return " ".join(words for words in own if words)

    def fits(self, names: set[str], elsewhere: set[str]) -> bool:
        """Return whether each meaning belongs to a name that occurs; otherwise :meth:`check_names` raises an error.

        ``names`` are the names of the claim, ``elsewhere`` those in its hypotheses and definitions.
        """
        return not self._absent(names, elsewhere)

    def check_names(self, names: set[str], elsewhere: set[str]) -> None:
        """Raise InputError if the context gives a meaning to a name that does not occur.

        One text of the context, such as "A, B = moment of inertia", can give one meaning to several names. At least one
        of them must be among ``names``, the names of the claim. Each of the remaining names may also occur elsewhere:
        as a letter for a dimension of a body, or among ``elsewhere``, the names in hypotheses and definitions. A rate
        such as x_dot counts as an occurrence of x.
        """
        for name in self._absent(names, elsewhere):
            raise InputError(f"where: expected meanings only of names that occur in the claim, got {name!r}")

    def _absent(self, names: set[str], elsewhere: set[str]) -> list[str]:
        bodies = [self.body, *(meaning.body for meaning in self.meanings)]
        known = names.union(elsewhere, *(body.letters.values() for body in bodies if body))
        known |= {_OF_RATE.sub("", name) for name in known}
        return [
            name
            for meaning in self.meanings
            for name in meaning.absent(known if any(map(meaning.is_of, names)) else names)
        ]

    def units(self, names: Iterable[str], explicit: Mapping[str, str]) -> dict[str, str]:
        """Return the units of those ``names`` whose meaning has one: {"I": "kg m^2"}.

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
                    f"where: expected a quantity with the unit {explicit[name]} as the meaning of "
                    f"{meaning.written[0]}, since this unit is stated for {name}, got {meaning.quantity.title!r}, "
                    f"which has the unit {meaning.quantity.unit} (change one of the two statements)"
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


def quantities_of(tree: Node) -> Iterator[str]:
    """Yield the names in a formula's tree; for a time derivative of x, yield ``dx``, x and t."""
    for node in nodes_of(tree):
        if (name := name_of(node)) is not None:
            yield name


def letters_of(tree: Node) -> Iterator[str]:
    """Yield the names in a formula's tree; for a derivative of x, yield only ``dx``."""
    name = name_of(tree)
    if name is not None:
        yield name
    else:
        for child in tree.args:
            yield from letters_of(child)


def name_of(tree: Node) -> str | None:
    """Return the name if a tree is only a name, a function of time or a derivative of one; None for any other formula.

    The name is x for ``x`` and ``x(t)``, and ``dx`` for the derivative of x.
    """
    if is_derivative(tree):
        inner = name_of(tree.args[0])
        return None if inner is None else "d" * (len(tree.args) - 1) + inner
    return str(tree.value) if is_name(tree) else None

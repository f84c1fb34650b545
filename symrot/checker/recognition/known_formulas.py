"""The formulas that symrot derives, with their names; running this module prints them into ``known_formulas.toml``.

Formulas are found there by their fingerprint, a hash that does not depend on the names of symbols.
"""

import json
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from sympy import Expr, ImmutableMatrix, Mul

from symrot import catalogue
from symrot.checker.recognition.fingerprint import NotInField, fingerprint
from symrot.checker.recognition.formulas.attitudes import axes, charts, quaternions, sequences
from symrot.checker.recognition.formulas.bodies import bodies
from symrot.checker.recognition.formulas.common_factors import primitive
from symrot.checker.recognition.formulas.dynamics import rigid_bodies, torques
from symrot.checker.recognition.formulas.kinematics import GYROSCOPE, OF_ONE_ENTRY, along_axes, rotations, vectors
from symrot.checker.recognition.formulas.mechanics import one_axis, tops
from symrot.checker.recognition.formulas.named import Named
from symrot.checker.recognition.formulas.points import ANY_VECTORS, GENERAL, points
from symrot.checker.recognition.formulas.relation import solved
from symrot.checker.recognition.formulas.relations import relations
from symrot.checker.recognition.formulas.solids import solids, thin_bodies
from symrot.exact.decision import flatten
from symrot.exact.printing import as_text

__all__ = ["FILE", "Known", "by_fingerprint", "derived", "ending_of", "page", "relation_key", "stated"]

FILE = Path(__file__).with_name("known_formulas.toml")

LONGEST = 6000
"""The largest number of characters in the text of a formula in ``known_formulas.toml`` that has a name of its own, such
as "moment of inertia of a disk, x axis"."""

LONGEST_DERIVED = 900
"""The largest number of characters in the text of a formula in ``known_formulas.toml`` that is named after a step of a
derivation. Such a formula is one side of an equation in this step."""


@dataclass(frozen=True)
class Known:
    """A formula that symrot derives: its name, its derivation page and its text."""

    name: str
    source: str
    text: str
    scaled: bool = False  # multiples of the formula have the same name
    only_named: bool = False  # such as C*omega_3: a claim must name it, L = .., and use the letters of books
    is_relation: bool = False  # the left side of an equation minus the right side

    @property
    def has_fixed_axes(self) -> bool:
        """Whether the axes 1, 2 and 3 in the formula must not be permuted.

        This holds for the angles yaw, pitch and roll, each of which has its own axis, and for an entry of a matrix.
        """
        return self.name.startswith(("yaw", "pitch", "roll", "entry"))

    @property
    def is_step(self) -> bool:
        """Whether the formula is one side of an equation in a step of a derivation; then it is named after the step."""
        return ", step " in self.source


@cache
def _formulas_of(group: Callable[[], Iterator[Named]]) -> tuple[Named, ...]:
    """Return the formulas that the function ``group`` yields, such as `tops`; they are derived once per process."""
    return tuple(group())


def stated() -> Iterator[Named]:
    """Yield the formulas of kinematics, inertia and dynamics in a fixed order, then the components of their columns.

    The columns are the formulas for a vector of three components or a quaternion. A component with fewer than
    LEAST_OF_COMPONENT symbols is left out.
    """
    columns: list[Named] = []
    for group in (
        axes,
        sequences,
        quaternions,
        charts,
        solids,
        thin_bodies,
        rigid_bodies,
        torques,
        one_axis,
        tops,
        _solved,
        vectors,
        points,
        along_axes,
        rotations,
        bodies,
    ):
        for name, source, value in _formulas_of(group):
            yield name, source, value
            if getattr(value, "shape", None) in COMPONENTS and group is not along_axes:
                columns.append((name, source, value))
    for name, source, column in columns:
        for place, entry in zip(COMPONENTS[column.shape], column, strict=True):
            if len(entry.free_symbols) >= LEAST_OF_COMPONENT:
                yield f"{place} component of the {name}", source, entry


COMPONENTS = {(3, 1): ("first", "second", "third"), (4, 1): ("scalar", "first", "second", "third")}
"""Shape of a column -> the names of its components; a quaternion begins with the scalar."""
LEAST_OF_RELATION = 3
"""The smallest number of symbols in a relation of mechanics in ``known_formulas.toml``."""
LEAST_OF_COMPONENT = 3
"""The smallest number of symbols in a component of a known vector for the component to be stored as a known formula.

A component with fewer symbols could mean many formulas.
"""


def derived() -> Iterator[Named]:
    """Yield both sides of each step, and of each intermediate equation of a step, of all derivations."""
    for name in catalogue.names():
        derivation = catalogue.derivation(name)
        for number, step in enumerate(derivation.steps, start=1):
            claim = " ".join(step.claim.split()).rstrip(".:")
            between = (side for _, before, after in step.via for side in (before, after))
            for side in (step.left, step.right, *between):
                yield f"{derivation.title}: {claim}", f"derivations/{name}.md, step {number}", side


def _solved() -> Iterator[Named]:
    """Yield the relations of mechanics, solved for the quantities for which books solve them."""
    for relation in relations():
        yield from solved(relation)


def _related() -> Iterator[Named]:
    """Yield each relation of mechanics as (name, source, left side minus right side)."""
    for relation in relations():
        yield f"relation for {relation.title}", relation.source, primitive(relation.difference)


SCALAR_PRODUCTS = ("power of a torque", "kinetic energy of rotation from the angular momentum")
"""Names of known formulas that are a scalar product of two vectors, such as M . omega for a power.

A claim with any other product a . b would match them too; so it must use the letters of books for the two vectors.
"""


def _selected(
    formulas: Iterator[Named],
    least: int,
    longest: int,
    is_relation: bool = False,  # kept in each formula: relations are looked up for equations only
) -> Iterator[tuple[str, Known]]:
    """Yield (key, formula) for formulas with at least ``least`` symbols and at most ``longest`` characters.

    The key is the hash by which the formula is looked up, with ``=`` in front if ``is_relation``. Leave out formulas
    without such a hash (:func:`fingerprint` raises NotInField) and repetitions. Leave out, too, formulas whose nonzero
    entries are nothing but different symbols, except the formulas named in ``GENERAL`` and ``OF_ONE_ENTRY`` and those
    for a function of the quantity, such as its square.
    """
    general = (*GENERAL, *OF_ONE_ENTRY)
    of_letters = {*(name for name, *_ in _formulas_of(along_axes)), GYROSCOPE, *SCALAR_PRODUCTS, *ANY_VECTORS, *general}
    groups = (tops, one_axis, _solved, rotations, bodies, points)
    seen, few = set(), {name for group in groups for name, *_ in _formulas_of(group)}
    for name, source, value in formulas:
        entries, shape = flatten(value)
        if sum(entry.count_ops() for entry in entries) > longest // 3:
            continue
        text = " ".join(as_text(ImmutableMatrix(value) if shape else value).split())
        try:
            own = fingerprint(entries)
        except NotInField:
            continue
        is_general = _is_general(entries) and not ending_of(name) and name not in general
        if is_general or len(own.atoms) < least or len(text) > longest or (name, text) in seen:
            continue
        seen.add((name, text))
        scaled = "quaternion rate" in name
        only_named = (name in few and all(map(_is_monomial, entries))) or name in of_letters
        known = Known(name, source, text, scaled or is_relation, only_named, is_relation)
        yield relation_key(own.key(shape, range(len(entries))), is_relation), known


@cache
def ending_of(name: str) -> str:
    """Return ", squared" or an inverse function, such as ", 2 atan2", at the end of a formula's name; else ""."""
    # the formula then is a function of the quantity: its square, cosine, or half angle's cosine
    ending = re.search(r", (squared|(\S+ )?(acos|asin|atan2))$", name)
    return ending[0] if ending else ""


def relation_key(key: str, is_relation: bool) -> str:
    """Return the key of a formula in ``known_formulas.toml``: the hash ``key``, with ``=`` in front for a relation.

    The hash, a result of :meth:`Fingerprint.key`, does not depend on the names of symbols.
    """
    return f"={key}" if is_relation else key


def _is_monomial(entry: Expr) -> bool:
    """Return whether a formula is a product of powers of symbols."""
    factors = [factor.as_base_exp()[0] for factor in Mul.make_args(entry)]
    return all(factor.is_Symbol or factor.is_number for factor in factors)


def _is_general(entries: Sequence[Expr]) -> bool:
    """Return whether the nonzero entries of a formula are different symbols, as in ``diag(A, B, C)``."""
    nonzero = [entry for entry in entries if entry != 0]  # all such matrices have the same fingerprint
    return all(entry.is_Symbol for entry in nonzero) and len(set(nonzero)) == len(nonzero)


def page(*groups: Iterator[Named]) -> str:
    """Return the text of the file ``known_formulas.toml``, with all formulas that symrot derives.

    A test may pass ``groups`` of formulas to print only these.
    """
    lines = [
        "# The formulas that symrot derives. The key of a formula is a hash that does not depend on the names of its",
        "# symbols (checker/recognition/fingerprint.py).",
        "# Printed by `python -m symrot.checker.recognition.known_formulas`; do not edit.",
    ]
    texts: set[str] = set()
    bounds = ((1, LONGEST, False), (3, LONGEST_DERIVED, False), (LEAST_OF_RELATION, LONGEST, True))
    for (least, longest, relation), formulas in zip(bounds, groups or (stated(), derived(), _related()), strict=False):
        for key, known in _selected(formulas, least, longest, relation):
            if least > 1 and known.text in texts:
                continue
            texts.add(known.text)
            lines += ["", "[[formula]]", f'key = "{key}"']
            for field in ("name", "source", "text"):
                lines.append(f"{field} = {json.dumps(getattr(known, field), ensure_ascii=False)}")
            lines += [f"{flag} = true" for flag in ("scaled", "only_named", "is_relation") if getattr(known, flag)]
    return "\n".join(lines) + "\n"


@cache
def by_fingerprint() -> dict[str, list[Known]]:
    """Return {key: known formulas}; formulas with one key differ only in the names of symbols or by a factor."""
    # values that `page` prints are JSON too, which is read in a fraction of the time of TOML
    formulas: dict[str, list[Known]] = {}
    _, *entries = FILE.read_text(encoding="utf-8").split("\n[[formula]]\n")
    for entry in entries:
        fields = {
            name: json.loads(value) for name, _, value in (line.partition(" = ") for line in entry.splitlines() if line)
        }
        formulas.setdefault(fields.pop("key"), []).append(Known(**fields))
    return formulas


if __name__ == "__main__":
    FILE.write_bytes(page().encode())

"""Moments of inertia in terms of other lengths: half the sides of a box, the axes of an ellipsoid, or a diameter.

symrot uses the sides of a box, the semi-axes of an ellipsoid and radii. A formula that is exact for an author's other
lengths is recognised, with a note.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node, nodes_of, number, product
from symrot.checker.recognition.naming.fit import MOMENT
from symrot.checker.verdict import Verdict

__all__ = ["by_other_sizes"]


@dataclass(frozen=True)
class Size:
    """Dimensions that authors use in place of symrot's, such as the diameter d for the radius R.

    Attributes
    ----------
    letters : dict
        Maps the author's letters to symrot's: {"d": "R"}.
    factor : Fraction
        symrot's dimension divided by the author's, 1/2.
    bodies : tuple of str
        The bodies for which authors use these dimensions.
    note : str
        Tells the user what the author's letters mean: "d is the diameter".
    """

    letters: dict[str, str]
    factor: Fraction
    bodies: tuple[str, ...]
    note: str


SIZES = (
    Size({"a": "a", "b": "b", "c": "c"}, Fraction(2), (" box ", " plate "), "a, b and c are half the sides"),
    Size({"a": "a", "b": "b", "c": "c"}, Fraction(1, 2), (" ellipsoid ",), "a, b and c are the whole axes"),
    Size({"d": "R"}, Fraction(1, 2), (" cylinder ", " disk ", " sphere ", " ring ", " spherical shell "),
         "d is the diameter"),
    Size({"D": "R"}, Fraction(1, 2), (" cylinder ", " disk ", " sphere ", " ring ", " spherical shell "),
         "D is the diameter"),
)  # fmt: skip

TRIED = ("definition", "doubtful", "false")
Judge = Callable[[Claim, NamedFormula], Verdict]


def by_other_sizes(claim: Claim, named: NamedFormula, verdict: Verdict, judge: Judge) -> Verdict:
    """Return "recognised" for a moment of inertia that is right in terms of other lengths, such as a diameter.

    For instance, ``m*d^2/8`` is right for a disk with the diameter d. Otherwise return ``verdict``. ``judge`` returns
    the verdict on a claim.
    """
    body = claim.context.body
    if verdict.verdict not in TRIED or not MOMENT.fullmatch(named.name) or (body is not None and body.letters):
        # words about the body may say what its letters are: then nothing else is tried
        return verdict
    own: set[Any] = {node.value for node in nodes_of(named.formula) if node.kind == "name"}
    for size in SIZES:
        clash = ({*size.letters.values()} - {*size.letters}) & own
        if (
            clash
            or not own & {*size.letters}
            or (body is not None and f" {body.kind.shape.replace('_', ' ')} " not in size.bodies)
        ):
            continue
        formula = _in_dimensions(named.formula, size)
        other = judge(
            claim.with_relation(("==", named.side, formula), alternatives=()), named._replace(formula=formula)
        )
        known = [k for k in other.recognised_as if any(title in k.name for title in size.bodies) and not k.how]
        if other.verdict in ("true", "recognised") and known:
            note = f"guessed, not stated: {size.note}"
            return Verdict("recognised", recognised_as=tuple(known), notes=(*other.notes, note))
    return verdict


def _in_dimensions(tree: Node, size: Size) -> Node:
    """Return a formula in symrot's dimensions: ``m*(2*R)^2/8`` for ``m*d^2/8``, where d is the diameter."""
    if tree.kind == "name" and tree.value in size.letters:
        return product([number(1 / size.factor), Node("name", size.letters[str(tree.value)])])
    return replace(tree, args=tuple(_in_dimensions(child, size) for child in tree.args))

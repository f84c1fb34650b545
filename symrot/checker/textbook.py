"""Verdicts on the claims of a printed document, with allowance for characters that were lost in extracting its text.

The left side of a claim is the printed formula, the right side is the formula that it should equal. If a claim becomes
true only by adding lost characters, such as minus signs, on the left, the document may have no error.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.source.file import read_claims
from symrot.checker.claim.tree import Node, is_derivative, product, sum_of, text, walk
from symrot.checker.claim_verdict import check_readings
from symrot.checker.decide.decision import decide_equation
from symrot.checker.repair.derived_part import derived_part
from symrot.checker.rounding import rounded_value
from symrot.checker.typed.readings import Declared
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.textbook import Condition, Document, PrintedFormula, conditions, errata

__all__ = ["LOSSES", "OUTCOMES", "Finding", "differs_by_lost_characters", "finding_of", "findings"]

OUTCOMES = {
    "holds": "holds",
    "other reading": "holds in another reading of the extracted text",
    "conditional": "holds under a condition that is not stated",
    "fails": "does not hold",
    "fails or lost": "does not hold as extracted; the extraction lost characters here that may be the reason",
    "undecided": "undecided",
}
"""Outcome of a claim -> its description, from good to bad."""

ANGLES = ("sin", "cos", "tan", "cot", "sec", "csc")
"""Names of the trigonometric functions, whose argument is an angle."""


@dataclass(frozen=True)
class Finding:
    """The result of checking one claim of a document.

    Attributes
    ----------
    claim : dict
        The data of the claim.
    verdict : Verdict
    outcome : str
        A key of ``OUTCOMES``, such as ``"holds"``, ``"conditional"`` or ``"fails"``.
    reading : str
        Another reading of the printed text that is true; otherwise empty.
    right : str
        The right formula, or the right digits of a worked number, if the claim is not true.
    parts, corrected : mapping of str to Node
        The trees of the claim, and the corrected trees: ``{"left": tree, "R": tree}`` for a side and a definition.
    origin : str
        The source of the corrected formula: ``"search"`` if the search for repairs found it, ``"derivation"`` if it is
        computed from the rest of the claim, ``"proposal"`` if a person wrote it in the errata.
    conditions : tuple of str
        Conditions of the formula that the document does not state, such as ``sin(theta) != 0``. If the verdict is
        "conditional", any one of the conditions makes the formula true. Otherwise the formula needs all of them. A
        formula with the verdict "true" is undefined where one of them fails; conditions that hold for all quantities
        with their usual signs, such as ``m != 0`` for a mass, are then left out.
    words : str
        Words for the conditions from the document's file; empty if it has none.
    """

    claim: dict[str, Any]
    verdict: Verdict
    outcome: str
    reading: str = ""
    right: str = ""
    parts: Mapping[str, Node] = field(default_factory=dict)
    corrected: Mapping[str, Node] = field(default_factory=dict)
    origin: str = "search"
    conditions: tuple[str, ...] = ()
    words: str = ""

    @property
    def reason(self) -> str:
        """A sentence that says why the claim is false, true only under conditions, or undecided."""
        if self.outcome == "conditional":
            joint = " or " if self.verdict.verdict == "conditional" else " and "
            return "true if " + joint.join(self.conditions)
        if self.verdict.diagnosis.code != "none":
            return self.verdict.diagnosis.text
        return str(self.verdict.counterexample or self.verdict.reason)


def findings(
    document: Document, repair: bool = True, progress: Callable[[str], None] = lambda text: None
) -> Iterator[Finding]:
    """Yield the result of checking each claim of a document, in order.

    ``progress`` is called with a line of text before each claim.
    """
    formulas = {formula.claim: formula for erratum in errata() for formula in erratum.formulas}
    unstated = {condition.claim: condition for condition in conditions()}
    for claim in read_claims(document.path):
        progress(f"checking {claim.id} ..")
        yield finding_of(document.claims[claim.id], claim, repair, formulas.get(claim.id), unstated.get(claim.id))


def finding_of(
    data: dict[str, Any], claim: Claim, repair: bool, formula: PrintedFormula | None, condition: Condition | None = None
) -> Finding:
    """Return the result of checking one claim, whose record in the document's file is ``data``.

    ``formula`` is the claim's entry in the errata, or None. ``condition`` makes the claim true although the document
    does not state it, or is None. Raise InputError if the exact engine does not prove the correction of the errata, or
    the claim under the condition.
    """
    if "editable" not in data:
        claim = replace(claim, editable=("left",))  # the left side is what the document prints
    lost = data.get("lost", [])
    readings = tuple(other for other in claim.alternatives if _is_reading(claim, other, lost))
    claim = replace(claim, alternatives=readings)
    verdict, other = check_readings(claim, repair)
    # a false claim that is true under the condition is conditional, as is a true one that divides by a possible zero
    listed, words = ((), "") if condition is None else (condition.hypotheses, condition.words)
    if verdict.holds:
        broken = tuple(text for text in verdict.conditions if text in listed or _may_be_broken(text))
        return Finding(data, verdict, "conditional" if broken else "holds", conditions=broken, words=words)
    if other is not None:
        return Finding(data, verdict, "other reading", other.text, other.text)
    if verdict.verdict != "false":
        outcome = "conditional" if verdict.verdict == "conditional" else "undecided"
        return Finding(data, verdict, outcome, conditions=verdict.requires, words=words)
    if claim.relation is None:
        return Finding(data, verdict, "fails", right=rounded_value(claim))
    if condition is not None:
        _prove(claim, condition)
        return Finding(data, verdict, "conditional", conditions=listed, words=words)
    parts = {"left": claim.relation[1], "right": claim.relation[2], **dict(claim.define)}
    origin, corrected = _correction(claim, verdict, formula)
    is_loss = corrected and all(
        differs_by_lost_characters(parts[place], tree, lost) for place, tree in corrected.items()
    )
    right = " with ".join(f"{text(tree)}" if place in ("left", "right") else f"{place} = {text(tree)}"
                          for place, tree in corrected.items())  # fmt: skip
    return Finding(data, verdict, "fails or lost" if is_loss else "fails", "", right, parts, corrected, origin)


def _may_be_broken(condition: str) -> bool:
    """Return whether a condition can fail although all quantities have their usual signs: ``sin(theta) != 0``."""
    sign, *trees = read_relation(condition)
    sides = [[node for _, node in walk(tree)] for tree in trees]
    nodes = [node for side in sides for node in side]
    # m*g*L <= kappa can fail too, but a length, a mass or a moment of inertia is positive by its meaning
    is_on_an_angle = any(node.kind == "call" and node.value in ANGLES for node in nodes)
    has_difference = any(node.kind == "neg" for node in nodes) or all(
        any(node.kind == "name" for node in side) for side in sides
    )
    return is_on_an_angle or (sign != "!=" and has_difference)


def _prove(claim: Claim, condition: Condition) -> None:
    """Raise InputError if the exact engine does not prove that a claim is true under a proposed condition."""
    declared = Declared({*claim.symbols, *(name for name, _ in claim.define)}, claim.functions)
    hypotheses = tuple(read_relation(source, f"{claim.id}: condition", declared) for source in condition.hypotheses)
    if decide_equation(replace(claim, hypotheses=(*claim.hypotheses, *hypotheses)).equation).verdict != "true":
        texts = " and ".join(condition.hypotheses)
        raise InputError(f"{claim.id}: expected a condition under which the claim is true, got {texts!r}")


def _correction(claim: Claim, verdict: Verdict, formula: PrintedFormula | None) -> tuple[str, dict[str, Node]]:
    """Return the origin of a claim's correction and the corrected trees: ("search", {"left": tree}).

    The origin is "proposal" if the errata contain the corrected formula, and "derivation" if the errata name a part to
    be computed from the rest of the claim. Otherwise it is "search": the correction is the nearest repair that the
    check of the claim found. If it found none, the dictionary is empty.

    Raises
    ------
    InputError
        If a corrected part is not in ``claim.editable``, which by default has just the left side, and if the exact
        engine does not prove the claim with the correction.
    """
    origin = "search"  # the nearest repair, unless the errata propose a correction or ask to derive it
    changes: Mapping[str, str] = verdict.repairs[0].edited if verdict.repairs else {}
    if formula is not None and formula.derived:
        origin = "derivation"
        tree = derived_part(claim, formula.derived)
        changes = {} if tree is None else {formula.derived: text(tree)}
    elif formula is not None and formula.proposal:
        origin, changes = "proposal", formula.proposal
    names = {*claim.symbols, *(name for name, _ in claim.define)}
    trees = {}
    for place, source in changes.items():
        if place not in claim.editable:
            parts = ", ".join(claim.editable)
            raise InputError(
                f"{claim.id}: {origin}: expected a correction of {parts}, as the claim's key 'editable' states "
                f"(without this key, only left may be corrected), got a correction of {place!r}"
            )
        trees[place] = read_expression(source, f"{claim.id}: {place}", Declared(names, claim.functions))
    if origin != "search" and decide_equation(claim.with_parts(trees).equation).verdict != "true":
        got = " and ".join(changes.values()) or "none"
        raise InputError(f"{claim.id}: {origin}: expected a formula that is true, got {got!r}")
    return origin, trees


# -- characters that the extraction lost -------------------------------------------------------------------------------


def _inner(kind: str) -> Callable[[Node], Node]:
    """Return a function that replaces a node of the given kind by its first argument: ``-a`` by a for "neg".

    The function returns any other node unchanged.
    """
    return lambda node: node.args[0] if node.kind == kind else node


def _without_dots(node: Node) -> Node:
    return node.args[0] if is_derivative(node) else node


def _without_transpose(node: Node) -> Node:
    return node.args[0] if node.kind == "transpose" or (node.kind, node.value) == ("call", "transpose") else node


def _without_primes(node: Node) -> Node:
    return (
        replace(node, value=str(node.value).rstrip("p")) if node.kind == "name" and len(str(node.value)) > 1 else node
    )


LOSSES: dict[str, Callable[[Node], Node]] = {
    "minus signs": _inner("neg"),
    "fraction bars": _inner("inv"),
    "absolute-value bars": _inner("power"),
    "transposes": _without_transpose,
    "dots": _without_dots,
    "primes": _without_primes,
}
"""Kind of characters that may be lost when the text of a document is extracted -> function that removes them.

The function takes a node of a formula and returns the node without such characters. A power on lost absolute-value bars
is lost with the bars.
"""


def _is_reading(claim: Claim, other: tuple[str, Node, Node], lost: Collection[str]) -> bool:
    """Return whether a relation differs from a claim only by lost characters on the left side.

    ``other`` is the relation as (sign, left side, right side); ``lost`` are kinds of characters, keys of ``LOSSES``.
    """
    assert claim.relation is not None
    return other[2] == claim.relation[2] and differs_by_lost_characters(claim.relation[1], other[1], lost)


def differs_by_lost_characters(printed: Node, right: Node, lost: Collection[str]) -> bool:
    """Return whether two formulas are equal after the characters of the kinds ``lost`` are removed from both.

    The kinds are the keys of ``LOSSES``. If "token order" is in ``lost`` too, the letters may be in any order.

    Examples
    --------
    >>> from symrot.checker.claim.reader import read_expression
    >>> printed, right = read_expression("a + b"), read_expression("a - b")
    >>> differs_by_lost_characters(printed, right, ["minus signs"])
    True
    >>> differs_by_lost_characters(printed, right, ["dots"])
    False
    """
    first, second = (_extracted(tree, lost) for tree in (printed, right))
    if "token order" in lost:
        return Counter(_letters(first)) == Counter(_letters(second))
    return first == second


def _extracted(node: Node, lost: Collection[str]) -> Node:
    """Return a formula without the characters of the kinds ``lost``, as if extracting the document's text lost them.

    For "minus signs", ``a - b``, the sum of a and -b, becomes ``a + b``. The kinds are keys of ``LOSSES``; "token
    order" and unknown kinds change nothing here.
    """
    node = replace(node, args=tuple(_extracted(child, lost) for child in node.args))
    for loss in lost:
        node = LOSSES[loss](node) if loss in LOSSES else node
    if node.kind in ("sum", "product"):
        return (sum_of if node.kind == "sum" else product)(list(node.args))
    return node


def _letters(tree: Node) -> list[Any]:
    """Return the letters, numbers, signs and bars of a formula in reading order."""
    kinds = ("name", "number", "call", "neg", "inv", "transpose")
    return [(node.kind, node.value) for _, node in walk(tree) if node.kind in kinds]

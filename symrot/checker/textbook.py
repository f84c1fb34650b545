"""Verdicts on what a document says, with the doubt that a lossy extraction leaves."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from symrot.checker.claim.claims import Claim, read_claims
from symrot.checker.claim.tree import text
from symrot.checker.interface import check_readings
from symrot.checker.verdict import Verdict
from symrot.textbook import Document

__all__ = ["OUTCOMES", "Finding", "findings"]

OUTCOMES = {
    "holds": "holds",
    "other reading": "holds in another reading of the extracted text",
    "conditional": "holds under a condition that is not stated",
    "fails": "does not hold",
    "fails or lost": "does not hold as extracted; the extraction lost characters here that may be the reason",
    "undecided": "undecided",
}
"""What became of a claim, from good to bad."""


EXPLAINS = {
    "minus signs": {"sign_of_term", "overall_sign", "inertia_product_sign"},
    "dots": {"wrong_symbol"},
    "primes": {"wrong_symbol"},
}
"""What a lossy extraction can make of a true formula: characters lost -> codes of the fault that this looks like."""


@dataclass(frozen=True)
class Finding:
    """What was found of one claim: its data, the verdict, another reading that holds, and the outcome."""

    claim: dict[str, Any]
    verdict: Verdict
    outcome: str
    reading: str  # the alternative that holds, else empty
    right: str  # what would be right, where the claim is not

    @property
    def reason(self) -> str:
        """Why the claim is not simply true."""
        if self.verdict.verdict == "conditional":
            return "true if " + " or ".join(self.verdict.requires)
        if self.verdict.diagnosis.code != "none":
            return self.verdict.diagnosis.text
        return str(self.verdict.counterexample or self.verdict.reason)


def findings(
    document: Document, repair: bool = True, progress: Callable[[str], None] = lambda text: None
) -> Iterator[Finding]:
    """Yield what is found of each claim of a document, in its order."""
    for claim in read_claims(document.path):
        progress(f"checking {claim.id} ..")
        yield _finding(document.claims[claim.id], claim, repair)


def _finding(data: dict[str, Any], claim: Claim, repair: bool) -> Finding:
    verdict, other = check_readings(claim, repair)
    if verdict:
        return Finding(data, verdict, "holds", "", "")
    if other is not None:
        return Finding(data, verdict, "other reading", other.text, other.text)
    outcome = {"conditional": "conditional", "undecided": "undecided"}.get(verdict.verdict, "fails")
    if outcome == "fails" and any(verdict.diagnosis.code in EXPLAINS.get(what, ()) for what in data.get("lost", [])):
        outcome = "fails or lost"
    return Finding(data, verdict, outcome, "", _right_form(claim, verdict))


def _right_form(claim: Claim, verdict: Verdict) -> str:
    """Return what would be right: the value, the nearest proven repair, or the side that was derived."""
    if claim.relation is None:
        return verdict.counterexample.lhs if verdict.counterexample else ""
    if verdict.repairs:
        return verdict.repairs[0].text
    return text(claim.relation[2])

"""Verdicts on the claims of a document, with allowance for characters that the extraction of its text lost."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from symrot.checker.claim.claims import Claim, read_claims
from symrot.checker.claim.tree import text
from symrot.checker.claim_verdict import check_readings
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
"""Outcome of a claim -> its description, from good to bad."""


EXPLAINS = {
    "minus signs": {"sign_of_term", "overall_sign", "inertia_product_sign"},
    "dots": {"wrong_symbol"},
    "primes": {"wrong_symbol"},
}
"""Characters that an extraction may lose -> codes of the faults that a true formula without them seems to have."""


@dataclass(frozen=True)
class Finding:
    """The result of checking one claim of a document: data, verdict, an alternative reading that is true, outcome."""

    claim: dict[str, Any]
    verdict: Verdict
    outcome: str
    reading: str  # the alternative that holds, else empty
    right: str  # the right formula, if the claim is not true

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
    """Yield the result of checking each claim of a document, in the order of the document."""
    for claim in read_claims(document.path):
        progress(f"checking {claim.id} ..")
        yield _finding(document.claims[claim.id], claim, repair)


def _finding(data: dict[str, Any], claim: Claim, repair: bool) -> Finding:
    if "editable" not in data:
        claim = replace(claim, editable=("left",))  # what a document prints stands on the left
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
    """Return the corrected formula: the exact value, the nearest proven repair, or the side that symrot derived."""
    if claim.relation is None:
        return verdict.counterexample.lhs if verdict.counterexample else ""
    if verdict.repairs:
        return verdict.repairs[0].text
    return text(claim.relation[2])

"""The section "A common mistake" of a page: a wrong formula, and how the checker refutes it."""

from collections.abc import Iterator
from functools import cache
from shlex import quote

from symrot.checker.interface import check
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.lessons.lesson import Mistake
from symrot.proof.page import Passage

__all__ = ["mistake_passages", "refutation"]


def refutation(mistake: Mistake) -> Verdict:
    """Return the verdict on a mistake, with its counterexample.

    Raises
    ------
    InputError
        If the checker does not refute the claim by a counterexample.

    Examples
    --------
    >>> refutation(Mistake("The square is lost.", "sin(x)**2 + cos(x) == 1")).verdict
    'false'
    """
    verdict = _verdict(mistake.claim, mistake.facts)
    if verdict.verdict not in ("false", "conditional") or verdict.counterexample is None:
        raise InputError(f"expected a mistake that the checker refutes, got {mistake.claim!r}, {verdict.verdict}")
    return verdict


@cache
def _verdict(claim: str, facts: tuple[str, ...]) -> Verdict:
    return check(claim, assume=facts)


def mistake_passages(mistake: Mistake) -> Iterator[Passage]:
    """Yield the paragraphs of the section "A common mistake": wrong formula, counterexample and lesson, shell command.

    A corrected formula is named if the checker has one and ``mistake.repair`` is not None.
    """
    verdict = refutation(mistake)
    yield Passage(f"{mistake.words} They write `{mistake.claim}`.")
    facts = _facts(mistake.facts)
    sentences = [f"{facts} The checker refutes it by a counterexample, `{verdict.counterexample}`.".strip()]
    if verdict.requires:
        sentences.append(f"The claim holds only if `{' or '.join(verdict.requires)}`.")
    elif verdict.diagnosis.code != "none":
        sentences.append(f"Its diagnosis: {verdict.diagnosis.text}.")
    if mistake.repair is not None and verdict.repairs:
        sentences.append(f"A similar formula, which the checker proves: `{verdict.repairs[mistake.repair].text}`.")
    yield Passage(" ".join([*sentences, mistake.lesson]).strip())
    options = "".join(f" --given {quote(text)}" for text in mistake.facts)
    yield Passage(f"Try it: `symrot check {quote(mistake.claim)}{options}`.")


def _facts(facts: tuple[str, ...]) -> str:
    """Return a sentence with the hypotheses of a claim, those of the form ``x > 0`` last; empty if there are none."""
    # as symrot check takes them, such as A == B or m > 0
    equations = [f"`{text}`" for text in facts if not text.endswith(" > 0")]
    positive = [f"`{text.removesuffix(' > 0')}`" for text in facts if text.endswith(" > 0")]
    clauses = []
    if equations:
        clauses.append(_listed(equations))
    if positive:
        clauses.append(f"{_listed(positive)} {'is' if len(positive) == 1 else 'are'} positive")
    sentence = ", and ".join(clauses)
    return f"Here {sentence}." if sentence else ""


def _listed(texts: list[str]) -> str:
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} and {texts[-1]}"

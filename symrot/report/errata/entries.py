"""The entries of the errata: each describes one error of a document, with its formulas, its reason and its proof."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.tree import number, sum_of
from symrot.checker.textbook import Finding, findings
from symrot.checker.typed.readings import Relation
from symrot.report.errata.typesetting import filled, latex, marked
from symrot.textbook import DOCUMENTS, Document, Erratum, PrintedFormula, document, errata

__all__ = ["Correction", "Entry", "Survey", "condition_words", "entries", "survey"]

Survey = list[tuple[Document, list[Finding]]]


def survey(
    names: Sequence[str] = DOCUMENTS, repair: bool = True, progress: Callable[[str], None] = lambda text: None
) -> Survey:
    """Check the claims (printed formulas) of documents; return a pair (document, findings with verdicts) for each name.

    ``repair`` asks for corrections of false claims.
    """
    documents = []
    for name in names:
        source = document(name)
        documents.append((source, list(findings(source, repair, progress))))
    return documents


@dataclass(frozen=True)
class Correction:
    """A faulty formula of a document: its place, its LaTeX as printed, and its corrected LaTeX.

    The corrected LaTeX is empty if no correction is known.
    """

    where: str
    printed: str
    corrected: str


@dataclass(frozen=True)
class Entry:
    """One error of a document.

    Attributes
    ----------
    title, where, why : str
        The subject of the error, its places in the document, and the reason why the formula is wrong.
    corrections : tuple of Correction
        The faulty formulas that show the error, each with its correction.
    proof : str
        One or two sentences: the reference with which the formula was compared, and a point, if known, at which the
        two differ.
    extracted : tuple of str
        The lines of the document, as they were extracted from its PDF file.
    """

    title: str
    where: str
    why: str
    corrections: tuple[Correction, ...]
    proof: str
    extracted: tuple[str, ...]


def entries(findings_of_document: Sequence[Finding]) -> list[Entry]:
    """Return one entry for each error of a document, from the findings about its claims."""
    failing = {item.claim["id"]: item for item in findings_of_document if item.outcome == "fails"}
    # errata that a person wrote, each about one or several faulty formulas
    listed = [
        _entry(erratum, [failing[formula.claim] for formula in erratum.formulas if formula.claim in failing])
        for erratum in errata()
        if any(formula.claim in failing for formula in erratum.formulas)
    ]
    described = {formula.claim for erratum in errata() for formula in erratum.formulas}
    # a faulty formula without an erratum gets its own entry, with the checker's reason
    others = [
        _entry(Erratum(name, f"{item.reason}.", (PrintedFormula(name, "@left@", "@left@", {}, {}),)), [item])
        for name, item in failing.items()
        if name not in described
    ]
    return [*listed, *others]


def _entry(erratum: Erratum, items: Sequence[Finding]) -> Entry:
    formulas = {formula.claim: formula for formula in erratum.formulas}
    corrections = [
        _correction(item, formulas[item.claim["id"]]) for item in items if formulas[item.claim["id"]].template
    ]
    places = dict.fromkeys(item.claim["where"] for item in items)
    extracted = dict.fromkeys(item.claim["printed"] for item in items)
    return Entry(
        erratum.title,
        ", ".join(places),
        erratum.why,
        tuple(corrections),
        _proof(items[0], formulas[items[0].claim["id"]].letters),
        tuple(extracted),
    )


def _correction(item: Finding, formula: PrintedFormula) -> Correction:
    """Return a faulty formula as printed and as corrected, in LaTeX, with boxes around the differences."""
    # The template is the printed LaTeX with names in place of the parts that the checker read; the finding has these
    # parts and their corrections.
    where = item.claim["where"]
    if not item.parts:
        digits = item.claim["printed_value"]
        corrected_text = formula.corrected.replace("@printed@", f"\\boxed{{{item.right}}}") if item.right else ""
        return Correction(where, formula.template.replace("@printed@", digits), corrected_text)
    printed, corrected = dict(item.parts), dict(item.parts)
    for place, tree in item.corrected.items():
        printed[place], corrected[place] = marked(item.parts[place], tree)
    functions = item.claim.get("functions", [])
    return Correction(
        where,
        filled(formula.template, printed, formula.letters, functions),
        filled(formula.corrected, corrected, formula.letters, functions) if item.corrected else "",
    )


ORIGINS = {
    "search": "found by a search near the printed formula",
    "derivation": "derived from the reference",
    "proposal": "proposed by a person",
}
"""Origin of a correction -> the words that follow "The correction was" in the sentence about its proof."""


def _proof(item: Finding, letters: Mapping[str, str]) -> str:
    """Return one or two sentences that say how the formula of a finding was proven wrong.

    ``letters`` maps the checker's names of quantities to the LaTeX of the document's letters.
    """
    against = item.claim["against"]
    example = _example(item, letters)
    if not item.parts:
        value = f"`{item.verdict.counterexample.lhs}`" if item.verdict.counterexample else "another number"
        return f"The value of the reference ({against}) is {value}, which rounds to {item.right}."
    if not item.corrected:
        return f"The printed formula differs from the reference ({against}){example}."
    return (
        f"The correction was {ORIGINS[item.origin]}. Its difference from the reference ({against}) is exactly zero; "
        f"that of the printed formula is not{example}."
    )


def _example(item: Finding, letters: Mapping[str, str]) -> str:
    """Return the end of a sentence: a point at which formula and reference differ, with both values; empty without a
    point.
    """
    witness = item.verdict.counterexample
    if witness is None:
        return ""
    functions = item.claim.get("functions", [])
    at = [
        f"${latex(read_expression(name), letters, functions)} = {latex(read_expression(value))}$"
        for name, value in witness.values.items()
        if value != "0"
    ]
    rest = ["all other letters 0"] if 0 < len(at) < len(witness.values) else []
    entry = f"in entry {witness.entry}, " if witness.entry else ""
    values = f"`{witness.lhs}` against `{witness.rhs}`"
    return f": for example, {entry}{values}" + (f" at {', '.join([*at, *rest])}" if at else "")


# -- conditions --------------------------------------------------------------------------------------------------------

WORDS = {
    ("sin", "!="): "{} is not a multiple of 180 degrees",
    ("cos", "!="): "{} is not an odd multiple of 90 degrees",
    ("sin", ">="): "{} lies between 0 and 180 degrees",
    ("cos", ">="): "{} lies between -90 and 90 degrees",
}
"""(function of an angle, comparison of its value with zero) -> the condition on the angle in words.

``("sin", "!=")`` is the condition ``sin(angle) != 0``; ``{}`` in the words is the angle."""


def condition_words(condition: str) -> str:
    """Return a condition, given as typed text, in the form in which a book would print it.

    Examples
    --------
    >>> condition_words("sin(theta) != 0")
    '$\\\\sin \\\\theta \\\\neq 0$: $\\\\theta$ is not a multiple of 180 degrees'
    """
    sign, left, right = _without_negative_terms(read_relation(condition))
    signs = {"!=": "\\neq", ">=": "\\ge", "<=": "\\le", "==": "="}
    formula = f"${latex(left)} {signs.get(sign, sign)} {latex(right)}$"
    words = WORDS.get((str(left.value), sign)) if left.kind == "call" and right == number(0) else None
    if words:
        return f"{formula}: {words.format(f'${latex(left.args[0])}$')}"
    return formula


def _without_negative_terms(relation: Relation) -> Relation:
    """Move the negative terms of a sum to the other side of a relation if that is 0: ``-a + b >= 0`` -> ``b >= a``.

    The relation is unchanged if the sum has terms of one sign only.
    """
    sign, left, right = relation
    negative = [term.args[0] for term in left.args if term.kind == "neg"] if left.kind == "sum" else []
    positive = [term for term in left.args if term.kind != "neg"]
    if not negative or not positive or right != number(0):
        return relation
    return sign, sum_of(positive), sum_of(negative)

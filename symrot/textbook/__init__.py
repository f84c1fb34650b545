"""Claims of four documents on rigid-body rotation, as data in one TOML file per document, and the errors found in them.

A claim has its place, its printed text, and the formula as symrot reads it, but no verdict. ``errata.toml`` groups the
claims that show one error. A correction in it is printed only if it is proven.
"""

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError, with_hint

__all__ = [
    "DOCUMENTS", "LINE_KINDS", "Condition", "Document", "Erratum", "Line", "PrintedFormula", "conditions", "document",
    "errata", "lines",
]  # fmt: skip

DOCUMENTS = ("chen", "sahakian", "brown", "beer-johnston")
"""Short names of the four documents on rigid-body rotation whose claims come with symrot."""

LINE_KINDS = {
    "operators": "the signs of a formula whose letters the extraction put on other lines",
    "letters": "a formula whose letters the double encoding garbled",
    "repeats": "a formula that the document prints in another place too",
    "input": "what is given in a worked example",
    "definition": "a symbol, a component or a form of an equation is introduced",
    "law": "a law of mechanics that the document takes as given",
    "assumption": "a choice or an approximation that the document makes",
    "observation": "a measured value, which no formula of the document gives",
    "label": "the label of a figure, a heading, or a number of an equation that was extracted without its formula",
    "other": "the title of another document",
}
"""Kind of a line of a document that has a relation sign (such as =) but states no new formula -> its description.

A line of the kind operators, letters, repeats or input belongs to a claim: its attribute ``claim`` is the name of the
claim that states the formula."""


class Document(NamedTuple):
    """A document whose claims are checked: its name, title, kind, and its claims."""

    name: str
    title: str
    kind: str
    # kinds of characters that the extraction of the text from print lost, such as primes
    lost: tuple[str, ...]
    path: Path
    claims: dict[str, dict[str, Any]]


class PrintedFormula(NamedTuple):
    """How a claim's printed formula and its correction are typeset."""

    claim: str
    # LaTeX with holes @left@, @right@ or @name@ for the parts of the claim
    template: str
    corrected: str
    # the LaTeX of names
    letters: dict[str, str]
    # the corrected parts, if the search for repairs does not find the correction
    proposal: dict[str, str]
    # or the part that is to be derived from the rest of the claim
    derived: str = ""


class Erratum(NamedTuple):
    """An error in a document: its title, the reason in words, and the formulas that show it, the clearest first."""

    title: str
    why: str
    formulas: tuple[PrintedFormula, ...]


class Condition(NamedTuple):
    """A condition that a document does not state.

    It consists of the label of the claim that needs it, the condition as formulas, and the condition in words.
    """

    claim: str
    hypotheses: tuple[str, ...]
    words: str


class Line(NamedTuple):
    """A line of a document with a relation sign (such as =) that states no new formula, for example a repetition."""

    printed: str
    # a key of LINE_KINDS
    kind: str
    # the claim that states the formula, or an empty text
    claim: str


def document(name: str) -> Document:
    """Return a document by its short name.

    Raises
    ------
    InputError
        If no document has this name.
    """
    if name not in DOCUMENTS:
        message = f"expected the name of a document, one of {', '.join(DOCUMENTS)}; got {name!r}"
        raise InputError(with_hint(message, name, DOCUMENTS))
    path = Path(__file__).with_name(f"{name}.toml")
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    claims = {claim["id"]: claim for claim in content["claim"]}
    return Document(name, content["title"], content["kind"], tuple(content["lost"]), path, claims)


def errata() -> tuple[Erratum, ...]:
    """Return the errors in all documents, in the order of the documents; each is an :class:`Erratum`."""
    return tuple(
        Erratum(entry["title"], entry["why"], tuple(map(_printed_formula, entry["formula"])))
        for entry in _content("errata")["error"]
    )


def conditions() -> tuple[Condition, ...]:
    """Return conditions that documents leave out although their claims are true only with them.

    Conditions that symrot infers from a claim by itself are not in the list.
    """
    return tuple(
        Condition(entry["claim"], tuple(entry["given"]), entry["words"]) for entry in _content("errata")["condition"]
    )


def lines(name: str) -> tuple[Line, ...]:
    """Return the lines of the document ``name`` that have a relation sign but state no new formula, such as
    repetitions.
    """
    return tuple(Line(*entry) for entry in _content("lines")[name])


def _content(file: str) -> dict[str, Any]:
    return tomllib.loads(Path(__file__).with_name(f"{file}.toml").read_text(encoding="utf-8"))


def _printed_formula(entry: dict[str, Any]) -> PrintedFormula:
    template = entry.get("print", "")
    return PrintedFormula(
        entry["claim"], template, entry.get("corrected", template), entry.get("letters", {}), entry.get("proposal", {}),
        entry.get("derived", ""),
    )  # fmt: skip

"""Claims of four documents on rigid-body rotation, as data in one TOML file per document, and their errata.

For each claim the data give its place, its printed text, and the formula as symrot reads it. They contain no verdicts;
:mod:`symrot.checker.textbook` computes these. The file ``errata.toml`` groups the claims that show the same error, and
says how the formula is typeset. A correction in it is a proposal that is printed only if it is proven.
"""

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError

__all__ = ["DOCUMENTS", "Document", "Erratum", "PrintedFormula", "document", "errata"]

DOCUMENTS = ("chen", "sahakian", "brown", "beer-johnston")
"""The short names of the documents."""


class Document(NamedTuple):
    """A document: name, kind, a note on text lost in extraction, the file of its claims, and the claims as data."""

    name: str
    title: str
    kind: str
    lost: tuple[str, ...]
    path: Path
    claims: dict[str, dict[str, Any]]


class PrintedFormula(NamedTuple):
    """How the printed formula of a claim is typeset.

    ``template`` is LaTeX with holes ``@left@``, ``@right@`` or ``@name@`` for the parts of the claim, ``corrected`` the
    template of the correction, ``letters`` the LaTeX of names, and ``proposal`` the corrected parts, if the search for
    repairs does not find them.
    """

    claim: str
    template: str
    corrected: str
    letters: dict[str, str]
    proposal: dict[str, str]


class Erratum(NamedTuple):
    """An error: its name, the reason in words, and the formulas and words that show it, the clearest first."""

    title: str
    why: str
    formulas: tuple[PrintedFormula, ...]


def document(name: str) -> Document:
    """Return a document by its short name.

    Raises
    ------
    InputError
        If no document has this name.
    """
    if name not in DOCUMENTS:
        raise InputError(f"expected the name of a document, one of {', '.join(DOCUMENTS)}; got {name!r}")
    path = Path(__file__).with_name(f"{name}.toml")
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    claims = {claim["id"]: claim for claim in content["claim"]}
    return Document(name, content["title"], content["kind"], tuple(content["lost"]), path, claims)


def errata() -> tuple[Erratum, ...]:
    """Return the errors of all documents, in the order of the documents."""
    content = tomllib.loads(Path(__file__).with_name("errata.toml").read_text(encoding="utf-8"))
    return tuple(
        Erratum(entry["title"], entry["why"], tuple(map(_printed_formula, entry["formula"])))
        for entry in content["error"]
    )


def _printed_formula(entry: dict[str, Any]) -> PrintedFormula:
    template = entry.get("print", "")
    return PrintedFormula(
        entry["claim"], template, entry.get("corrected", template), entry.get("letters", {}), entry.get("proposal", {})
    )

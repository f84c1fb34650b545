"""Claims of four documents on rigid-body rotation, as data in one TOML file per document.

For each claim the data give its place, its printed text, and the formula as symrot reads it. They contain no verdicts;
:mod:`symrot.checker.textbook` computes these.
"""

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError

__all__ = ["DOCUMENTS", "Document", "document"]

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

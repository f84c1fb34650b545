"""Data types for Coq files: definitions, and theorems with their proofs."""

from collections.abc import Sequence
from dataclasses import dataclass

from symrot.build.code_digest import text_digest
from symrot.certificates.coq.text import comment, folded

__all__ = ["CoqFile", "Theorem", "derivatives", "statement"]


@dataclass(frozen=True)
class Theorem:
    """A Coq theorem, with the tactics that prove it."""

    name: str
    # the statement in words
    about: str
    statement: str
    proof: str
    # whether the theorem is about the library kernel of the same name
    kernel: bool = True

    @property
    def text(self) -> str:
        """The theorem as Coq text: a comment with its statement in words, then statement and proof."""
        lines = [f"Theorem {self.name} :", *f"{self.statement}.".split("\n"), "Proof.", *self.proof.split("\n"), "Qed."]
        return "\n".join([comment(self.about), *(_short(line) for line in lines)])


@dataclass(frozen=True)
class CoqFile:
    """A file of theorems; Coq checks it after the files in ``requires``.

    Attributes
    ----------
    name : str
        The file's name without the suffix ``.v``.
    title : str
        The title in the comment at the start of the file.
    requires : tuple of str
        The names of all files that this file needs directly or indirectly, in the order in which Coq must check them.
    definitions : tuple of str
        The definitions of functions, as Coq text.
    theorems : tuple of Theorem
        The theorems about these functions, in order.
    """

    name: str
    title: str
    requires: tuple[str, ...]
    definitions: tuple[str, ...]
    theorems: tuple[Theorem, ...]

    @property
    def text(self) -> str:
        """The file as Coq text, which ``coqc`` reads; the same formulas give the same bytes."""
        opening = [
            comment(f"{self.title} Printed by `symrot prove --coq`; do not edit."),
            "",
            "From Coq Require Import Reals.",
            f"From symrot Require Import {' '.join(self.requires)}.",
            "Open Scope R_scope.",
        ]
        return "\n\n".join(["\n".join(opening), *self.definitions, *(each.text for each in self.theorems)]) + "\n"

    @property
    def digest(self) -> str:
        """The SHA-256 of the file's text, which certificates state."""
        return text_digest(self.text)


def _short(line: str) -> str:
    """Return a line of Coq text, folded into several indented lines if it is too long."""
    return folded(line, len(line) - len(line.lstrip()) + 2)


def derivatives(functions: Sequence[str], rates: Sequence[str]) -> str:
    """Return Coq hypotheses, each about one function and its derivative at time t: ``derivable_pt_lim x t v ->``."""
    pairs = zip(functions, rates, strict=True)
    return folded("  " + " ".join(f"derivable_pt_lim {each} t {rate} ->" for each, rate in pairs), 2)


def statement(quantified: str, *hypotheses: str, conclusion: str) -> str:
    """Return a theorem's statement as Coq text: ``forall`` the variables ``quantified``, hypotheses, and conclusion."""
    # each hypothesis ends with "->"; an empty hypothesis is left out
    lines = [folded(f"  forall {quantified},", 4), *hypotheses, *(f"  {line}" for line in conclusion.split("\n"))]
    return "\n".join(line for line in lines if line)

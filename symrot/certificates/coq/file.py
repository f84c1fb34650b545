"""A file of Coq: definitions, and theorems with their proofs."""

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256

from symrot.certificates.coq.text import comment, folded

__all__ = ["CoqFile", "Theorem", "derivatives", "statement"]


@dataclass(frozen=True)
class Theorem:
    """A theorem: what it says in words and in Coq, and the tactics that prove it.

    ``statement`` is the text between the name and the proof; ``kernel`` whether the theorem of this name is about the
    kernel of the same name.
    """

    name: str
    about: str
    statement: str
    proof: str
    kernel: bool = True

    @property
    def text(self) -> str:
        lines = [f"Theorem {self.name} :", *f"{self.statement}.".split("\n"), "Proof.", *self.proof.split("\n"), "Qed."]
        return "\n".join([comment(self.about), *(_short(line) for line in lines)])


@dataclass(frozen=True)
class CoqFile:
    """A file that Coq checks by itself, after those it requires.

    Attributes
    ----------
    name : str
        Without the suffix ``.v``.
    title : str
    requires : tuple of str
        Names of the files that it needs, those they need among them, in order.
    definitions : tuple of str
    theorems : tuple of Theorem
    """

    name: str
    title: str
    requires: tuple[str, ...]
    definitions: tuple[str, ...]
    theorems: tuple[Theorem, ...]

    @property
    def text(self) -> str:
        """The file's text: same formulas, same bytes."""
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
        return sha256(self.text.encode()).hexdigest()


def _short(line: str) -> str:
    """Return a line folded, if it must be, under its own indent."""
    return folded(line, len(line) - len(line.lstrip()) + 2)


def derivatives(functions: Sequence[str], rates: Sequence[str]) -> str:
    """Return the hypotheses that functions have derivatives at t, each with its arrow."""
    pairs = zip(functions, rates, strict=True)
    return folded("  " + " ".join(f"derivable_pt_lim {each} t {rate} ->" for each, rate in pairs), 2)


def statement(quantified: str, *hypotheses: str, conclusion: str) -> str:
    """Return a statement: variables, hypotheses (each with its arrow) and conclusion, a line or more for each."""
    lines = [folded(f"  forall {quantified},", 4), *hypotheses, *(f"  {line}" for line in conclusion.split("\n"))]
    return "\n".join(line for line in lines if line)

"""The answer to a claim: what is known, under which conditions, the evidence, and what would be true instead."""

from dataclasses import dataclass, field
from typing import Any

from symrot.exact.evidence import Counterexample

__all__ = ["Counterexample", "Diagnosis", "Dimensions", "Repair", "Verdict"]


@dataclass(frozen=True)
class Diagnosis:
    """What probably went wrong: a code of the table in :mod:`symrot.checker.codes`, and a sentence."""

    code: str
    text: str


@dataclass(frozen=True)
class Repair:
    """A formula near the claim that is true; ``proven`` by the exact engine; the smaller the cost the nearer."""

    text: str
    code: str
    cost: float
    proven: bool = True


@dataclass(frozen=True)
class Dimensions:
    """Whether the units fit: ``"consistent"``, ``"inconsistent"`` (``text`` says where) or ``"unknown"``.

    ``units`` holds what follows for names that came without a unit.
    """

    status: str = "unknown"
    text: str = ""
    units: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Verdict:
    """What is known about a claim.

    Attributes
    ----------
    verdict : str
        ``"true"``, ``"false"``, ``"conditional"`` (true under ``requires``) or ``"undecided"``.
    conditions : tuple of str
        Where both sides are defined, ``"sin(theta) != 0"``; for a conditional claim first what it requires.
    requires : tuple of str
        What a conditional claim needs beyond being defined; any one of them suffices.
    counterexample : Counterexample or None
    diagnosis : Diagnosis
    repairs : tuple of Repair
        At most three, nearest first.
    reason : str
        Why a claim is undecided; otherwise empty.
    dimension : Dimensions
        Whether the units fit, which has no part in ``verdict``.
    notes : tuple of str
        What a reader should know beside the verdict: that no point is known at which the hypotheses hold.
    id, where, text : str
        The claim.
    seconds : float
    """

    verdict: str
    conditions: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    counterexample: Counterexample | None = None
    diagnosis: Diagnosis = Diagnosis("none", "")
    repairs: tuple[Repair, ...] = ()
    reason: str = ""
    dimension: Dimensions = Dimensions()
    notes: tuple[str, ...] = ()
    id: str = ""
    where: str = ""
    text: str = ""
    seconds: float = 0.0

    @property
    def entry(self) -> tuple[int, int] | None:
        """The place in a matrix where the sides differ, (row, column) from 1."""
        return self.counterexample.entry if self.counterexample else None

    def __bool__(self) -> bool:
        return self.verdict == "true"

    def __str__(self) -> str:
        return "\n".join([self.verdict, *(f"  {name}: {text}" for name, text in self.facts())])

    def facts(self) -> list[tuple[str, str]]:
        """Return what goes with the verdict, as pairs of a name and a text for a person."""
        defined = [condition for condition in self.conditions if condition not in self.requires]
        wrong = self.diagnosis.code != "none"
        rows = [
            ("claim", self.text),
            ("true if", " or ".join(self.requires)),
            ("where", ", ".join(defined)),
            ("counterexample", str(self.counterexample or "")),
            ("because", self.reason),
            ("units", self.dimension.text),
            *(("note", note) for note in self.notes),
            ("diagnosis", f"{self.diagnosis.text} [{self.diagnosis.code}]" if wrong else ""),
            *(("true instead", f"{repair.text}  [{repair.code}]") for repair in self.repairs),
        ]
        return [(name, text) for name, text in rows if text]

    def to_json(self) -> dict[str, Any]:
        """Return the verdict as JSON data."""
        witness = self.counterexample
        return {
            "id": self.id,
            "verdict": self.verdict,
            "entry": list(self.entry) if self.entry else None,
            "conditions": list(self.conditions),
            "counterexample": witness and {
                "values": witness.values, "lhs": witness.lhs, "rhs": witness.rhs,
                "entry": list(witness.entry) if witness.entry else None,
            },
            "diagnosis": {"code": self.diagnosis.code, "text": self.diagnosis.text},
            "repairs": [
                {"text": r.text, "code": r.code, "cost": r.cost, "proven": r.proven} for r in self.repairs
            ],
            "seconds": round(self.seconds, 4),
            "where": self.where,
            "claim": self.text,
            "requires": list(self.requires),
            "reason": self.reason,
            "dimension": {
                "status": self.dimension.status, "text": self.dimension.text, "units": self.dimension.units,
            },
            "notes": list(self.notes),
        }  # fmt: skip

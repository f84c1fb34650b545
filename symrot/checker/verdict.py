"""The answer to a claim: what is known, under which conditions, the evidence, and what would be true instead."""

from dataclasses import dataclass, field
from typing import Any

__all__ = ["Counterexample", "Diagnosis", "Dimensions", "Repair", "Verdict"]


@dataclass(frozen=True)
class Counterexample:
    """A point, with exact values as text, where the two sides of a claim differ.

    Attributes
    ----------
    values : dict of str to str
        Name of each symbol -> its value.
    lhs, rhs : str
        The values of the two sides.
    entry : (int, int) or None
        Row and column, from 1, of the entry of a matrix where they differ.

    Examples
    --------
    >>> import symrot
    >>> verdict = symrot.check("sin(2*x) == sin(x)*cos(x)")
    >>> verdict.counterexample.lhs != verdict.counterexample.rhs
    True
    """

    values: dict[str, str]
    lhs: str
    rhs: str
    entry: tuple[int, int] | None = None

    def __str__(self) -> str:
        point = ", ".join(f"{name} = {value}" for name, value in self.values.items())
        place = f"entry {self.entry}: " if self.entry else ""
        return f"{place}{self.lhs} against {self.rhs}" + (f" at {point}" if point else "")


@dataclass(frozen=True)
class Diagnosis:
    """The probable fault of a claim.

    Attributes
    ----------
    code : str
        Key of the table of faults, such as ``"factor"``; ``"none"`` without a fault.
    text : str
        One sentence.

    Examples
    --------
    >>> import symrot
    >>> verdict = symrot.check("sin(2*x) == sin(x)*cos(x)")
    >>> verdict.diagnosis.code
    'factor'
    """

    code: str
    text: str


@dataclass(frozen=True)
class Repair:
    """A true formula near a claim.

    Attributes
    ----------
    text : str
        The formula.
    code : str
        Key of the table of faults.
    cost : float
        The smaller, the nearer to the claim.
    proven : bool
        Whether the exact engine proved it.

    Examples
    --------
    >>> import symrot
    >>> verdict = symrot.check("sin(2*x) == sin(x)*cos(x)")
    >>> verdict.repairs[0].text
    'sin(2*x) == 2*sin(x)*cos(x)'
    """

    text: str
    code: str
    cost: float
    proven: bool = True


@dataclass(frozen=True)
class Dimensions:
    """Whether the units of a claim fit.

    Attributes
    ----------
    status : str
        ``"consistent"``, ``"inconsistent"`` or ``"unknown"``.
    text : str
        Where they do not fit.
    units : dict of str to str
        Units that follow for names that came without a unit.

    Examples
    --------
    >>> import symrot
    >>> symrot.check("x == x", units={"x": "m"}).dimension.status
    'consistent'
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

    Examples
    --------
    >>> import symrot
    >>> bool(symrot.check("sin(x)**2 + cos(x)**2 == 1"))
    True
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
        shown = self.counterexample
        return {
            "id": self.id,
            "verdict": self.verdict,
            "entry": list(self.entry) if self.entry else None,
            "conditions": list(self.conditions),
            "counterexample": shown and {
                "values": shown.values, "lhs": shown.lhs, "rhs": shown.rhs,
                "entry": list(shown.entry) if shown.entry else None,
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

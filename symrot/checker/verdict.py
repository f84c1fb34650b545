"""The verdict on a claim: its conditions, its evidence, a diagnosis, and true formulas near the claim."""

from dataclasses import asdict, dataclass, field
from typing import Any

import symrot
from symrot.checker.marks import html_with_marks, latex_with_marks
from symrot.exact.evidence import Counterexample

__all__ = ["Diagnosis", "Dimensions", "Identification", "Repair", "Verdict"]


@dataclass(frozen=True)
class Diagnosis:
    """The probable fault of a claim.

    Attributes
    ----------
    code : str
        A short name of the kind of fault, such as ``"factor"``; ``"none"`` if no fault is known.
    text : str
        One sentence; usually empty if no fault is known.

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
        A short name of the kind of fault that the repair corrects, such as ``"factor"``.
    cost : float
        The distance from the claim: a smaller cost means a nearer formula.
    proven : bool
        Whether the exact engine proved it.
    edited : dict of str to str
        The changed parts of the claim, ``"left"``, ``"right"`` or the name of a definition, with their new text.
    changed : tuple of (int, int)
        Start and end (exclusive) of each part of the text that differs from the claim.
    entry : (int, int) or None
        Row and column, from 1, of the only entry that differs, if a side is a matrix.
    requires : str
        The range in which the formula holds, such as ``"-pi < a <= pi"``; empty if it holds wherever it is defined.

    Examples
    --------
    >>> import symrot
    >>> verdict = symrot.check("sin(2*x) == sin(x)*cos(x)")
    >>> verdict.repairs[0].text
    'sin(2*x) == 2*sin(x)*cos(x)'
    >>> verdict.repairs[0].html
    'sin(2*x) == <mark>2*</mark>sin(x)*cos(x)'
    """

    text: str
    code: str
    cost: float
    proven: bool = True
    edited: dict[str, str] = field(default_factory=dict)
    changed: tuple[tuple[int, int], ...] = ()
    entry: tuple[int, int] | None = None
    requires: str = ""

    @property
    def html(self) -> str:
        """The repair as HTML, with the parts that differ from the claim in ``<mark>``."""
        return html_with_marks(self.text, self.changed)

    @property
    def latex(self) -> str:
        """The repair in LaTeX, with the parts that differ from the claim underlined."""
        return latex_with_marks(self.text, self.changed)

    @property
    def note(self) -> str:
        """A text such as "[factor, entry (1, 2), if x > 0]": the fault, the wrong entry, and where the repair holds."""
        entry = f", entry {self.entry}" if self.entry else ""
        return f"[{self.code}{entry}{f', if {self.requires}' * bool(self.requires)}]"


@dataclass(frozen=True)
class Dimensions:
    """The result of checking the units in a claim.

    Attributes
    ----------
    status : str
        ``"consistent"``, ``"inconsistent"`` or ``"unknown"``.
    text : str
        Where the units do not fit, and which they are; empty if the status is not ``"inconsistent"``.
    units : dict of str to str
        Units that the claim implies for names without a stated or conventional unit.

    Examples
    --------
    >>> import symrot
    >>> symrot.check("x == x", units={"x": "m"}).dimension.status
    'consistent'
    """

    status: str = "unknown"
    text: str = ""
    units: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, repr=False)
class Identification:
    """A known formula to which a formula was proven equal.

    Attributes
    ----------
    name : str
    how : str
        The change that makes the formulas equal, such as ``"transposed"`` or ``"with the other sign"``; ``""`` for no
        change.
    mapping : dict
        Symbol of the known formula -> symbol of the user's formula, where their names differ.
    source : str
        The place of the formula in symrot: a call, or a page with its step.
    proven : bool
        Always true: names without a proof are not returned.

    Examples
    --------
    >>> import symrot
    >>> symrot.identify("(A*p**2 + B*q**2 + C*r**2)/2")[0].name
    'kinetic energy of rotation, principal axes'
    """

    name: str
    how: str
    mapping: dict[str, str]
    source: str
    proven: bool = True

    @property
    def renaming(self) -> str:
        """The renamed symbols as text: "with a for dphi" if the claim writes a where the known formula has dphi.

        Empty if no name differs.
        """
        pairs = ", ".join(f"{other} for {own}" for own, other in self.mapping.items())
        return f"with {pairs}" if pairs else ""

    def __repr__(self) -> str:
        return f"<Identification: {self}>"

    def __str__(self) -> str:
        return "; ".join(part for part in (self.name, self.how, self.renaming) if part)

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    def to_json(self) -> dict[str, Any]:
        """Return the identification as JSON data."""
        return asdict(self)


@dataclass(frozen=True, repr=False)
class Verdict:
    """The verdict on a claim.

    Attributes
    ----------
    verdict : str
        ``"true"``, ``"false"``, ``"conditional"`` (true under ``requires``) or ``"undecided"``. For a claim that gives
        a formula for a quantity without defining it, such as ``I_zz == m/12*(a**2 + b**2)``: ``"recognised"`` (symrot
        derives this formula), ``"doubtful"`` (a single edit makes it a formula that symrot derives) or
        ``"definition"`` (neither: symrot does not judge it). An equation or inequality that restricts its letters, such
        as ``x^2 = 4``, is a ``"definition"`` too. A claim of a file that cannot be read or has no meaning is
        ``"refused"``.
    conditions : tuple of str
        Conditions under which both sides are defined, such as ``"sin(theta) != 0"``; for a conditional claim, its
        requirements come first.
    requires : tuple of str
        Requirements of a conditional claim beyond being defined; any one of them suffices.
    counterexample : Counterexample or None
        An exact point where the sides differ, or where an inequality fails.
    diagnosis : Diagnosis
    repairs : tuple of Repair
        At most three, nearest first.
    recognised_as : tuple of Identification
        The formulas of symrot to which the claim's formula, or its repair, is proven equal, the likeliest first; for a
        claim that is false by its context, the formula that is meant.
    reason : str
        The reason why a claim is undecided, refused, or only a definition; usually empty for other verdicts.
    dimension : Dimensions
        The result of the check of units. If they do not fit, a "definition" may become "false".
    notes : tuple of str
        Further remarks, such as the name of a matrix in the claim.
    id, where, text : str
        The name of the claim, its place in a document, and its text.
    seconds : float
        The time that the check took, in seconds.
    reading : str
        The claim as it was read, in the notation of the input; empty if that is the same as the text.
    context : str
        The user's statements in words about names, body, frame and sequence, as they were understood.

    Notes
    -----
    The truth value of a verdict is :attr:`holds`, which is False for "doubtful" and "conditional" too. So
    ``check(a) or check(b)`` loses such a verdict on a: compare ``.verdict`` with a word instead. Write
    ``verdict is None`` to ask whether there is no verdict.

    Examples
    --------
    >>> import symrot
    >>> symrot.check("sin(x)**2 + cos(x)**2 == 1").holds
    True
    """

    verdict: str
    conditions: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    counterexample: Counterexample | None = None
    diagnosis: Diagnosis = Diagnosis("none", "")
    repairs: tuple[Repair, ...] = ()
    recognised_as: tuple[Identification, ...] = ()
    reason: str = ""
    dimension: Dimensions = Dimensions()
    notes: tuple[str, ...] = ()
    id: str = ""
    where: str = ""
    text: str = ""
    seconds: float = 0.0
    reading: str = ""
    context: str = ""

    @property
    def entry(self) -> tuple[int, int] | None:
        """The matrix entry in which the sides differ, (row, column) from 1; None if there is none."""
        return self.counterexample.entry if self.counterexample else None

    @property
    def holds(self) -> bool:
        """Whether the verdict is "true" or "recognised", the only ones that vouch for the formula."""
        return self.verdict in ("true", "recognised")

    def __bool__(self) -> bool:
        return self.holds

    def __str__(self) -> str:
        return "\n".join([self.verdict, *(f"  {name}: {text}" for name, text in self.facts())])

    def __repr__(self) -> str:
        return f"<Verdict {self.verdict}: {self.text}>" if self.text else f"<Verdict {self.verdict}>"

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    def facts(self) -> list[tuple[str, str]]:
        """Return the lines that are printed below the word ``verdict``, as pairs (name, text) with nonempty texts."""
        defined = [condition for condition in self.conditions if condition not in self.requires]
        wrong = self.diagnosis.code != "none"
        near = self.verdict == "doubtful"
        first = {"doubtful": "near to", "false": "meant"}.get(self.verdict, "formula of")
        kinds = [first, *["or to" if near else "or of"] * len(self.recognised_as)]
        rows = [
            ("claim", self.text),
            ("read as", self.reading),
            ("context", self.context),
            *((kind, f"the {reading}") for kind, reading in zip(kinds, self.recognised_as, strict=False)),
            ("true if", " or ".join(self.requires)),
            ("where", ", ".join(defined)),
            ("counterexample", str(self.counterexample or "")),
            ("because", self.reason),
            ("units", self.dimension.text),
            *(("note", note) for note in self.notes),
            ("diagnosis", f"{self.diagnosis.text} [{self.diagnosis.code}]" if wrong else ""),
            *(("instead" if near else "true instead", f"{repair.text}  {repair.note}") for repair in self.repairs),
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
                {
                    "text": r.text, "code": r.code, "cost": r.cost, "proven": r.proven,
                    "changed": [list(span) for span in r.changed], "entry": list(r.entry) if r.entry else None,
                }
                for r in self.repairs
            ],
            "seconds": round(self.seconds, 4),
            "where": self.where,
            "claim": self.text,
            "reading": self.reading,
            "context": self.context,
            "requires": list(self.requires),
            "reason": self.reason,
            "dimension": {
                "status": self.dimension.status, "text": self.dimension.text, "units": self.dimension.units,
            },
            "notes": list(self.notes),
            "recognised_as": [reading.to_json() for reading in self.recognised_as],
        }  # fmt: skip

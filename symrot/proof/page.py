"""A page of a derivation as data: its headings, passages and proven steps, for whatever prints it."""

from dataclasses import dataclass, field
from typing import Any

from sympy import Expr

__all__ = ["Page", "Passage", "Section", "Step"]


@dataclass(frozen=True)
class Section:
    """A heading."""

    title: str


@dataclass(frozen=True)
class Passage:
    """What is given or defined, in words, perhaps with equations (left, right); nothing in it is proven."""

    text: str
    equations: tuple[tuple[Any, Any], ...] = ()


@dataclass(frozen=True)
class Step:
    """A proven relation ``left = right``, or ``left > 0``.

    Attributes
    ----------
    claim : str
        What it says, a sentence.
    left, right : Expr or Matrix
        As the derivation built them, not simplified.
    reason : str
        Why, the end of a sentence that begins with "because".
    relation : str
        ``"="`` or ``">"``.
    hypotheses : tuple of Expr
        Each is zero where the step holds.
    conditions : tuple
        Denominators that must not vanish, radicands that must not be negative.
    named : str
        LaTeX of what the left side is, shown in its place where its formula is long; empty otherwise.
    shown : Any
        The right side as a reader wants it (LaTeX, or a product left as it is), where that differs; None otherwise.
    source : str
        Book and page, where the step is printed elsewhere.
    via : tuple of (str, Expr, Expr)
        Proven equations on the way, (words, left, right), for a reader who asks for detail.
    printed : (bool, bool)
        Of each side: whether the page shows what was proven, printed from it or read back and decided; otherwise it
        shows a name, or words in LaTeX, that stand for it.
    """

    claim: str
    left: Any
    right: Any
    reason: str
    relation: str = "="
    hypotheses: tuple[Expr, ...] = ()
    conditions: tuple[Any, ...] = ()
    named: str = ""
    shown: Any = None
    source: str = ""
    via: tuple[tuple[str, Any, Any], ...] = ()
    printed: tuple[bool, bool] = (True, True)


@dataclass
class Page:
    """A page: what is given, and what follows from it, step by step.

    Parameters
    ----------
    name : str
        Of the catalogue file, e.g. ``"symmetric_top"``.
    title : str
    source : str
        Where it is treated in print.
    about : str
        What it shows and what it is for, one paragraph.
    items : list
        Headings, passages and steps, in order.
    first : int
        The number of the first step; not 1 on a page that shows a part of a derivation.
    file : str
        The file that derives it, from the folder of symrot on; empty for a page outside the catalogue.
    """

    name: str
    title: str
    source: str = ""
    about: str = ""
    items: list[Section | Passage | Step] = field(default_factory=list)
    first: int = 1
    file: str = ""

    @property
    def steps(self) -> tuple[Step, ...]:
        """The proven steps, in order."""
        return tuple(item for item in self.items if isinstance(item, Step))

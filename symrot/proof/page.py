"""Pages of derivations as data: headings, passages and proven steps, for the printers."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Protocol

from sympy import Expr

import symrot

__all__ = ["Drawing", "Figure", "Page", "Passage", "Section", "Step", "Table"]


@dataclass(frozen=True)
class Section:
    """A heading on a page; ``title`` is its text, and the section ends at the next heading."""

    title: str


@dataclass(frozen=True)
class Passage:
    """Paragraph of assumptions or definitions (``text``), optionally with ``equations``, pairs (left, right), below it.

    Nothing in it is proven.
    """

    text: str
    equations: tuple[tuple[Any, Any], ...] = ()


@dataclass(frozen=True, repr=False)
class Step:
    """Proven relation on a page: ``left = right``, or ``left > 0``.

    Attributes
    ----------
    claim : str
        The statement, a sentence.
    left, right : Expr or Matrix
        The sides of the relation as the derivation built them, not simplified.
    reason : str
        The reason, the end of a sentence that begins with "because".
    relation : str
        ``"="`` or ``">"``.
    hypotheses : tuple of Expr
        Expressions that are assumed to be zero.
    conditions : tuple
        Conditions such as ``Ne(b, 0)``: denominators do not vanish, radicands are not negative.
    named : str
        LaTeX to display instead of the left side, if its formula is long; otherwise empty.
    display : Any
        The form in which the right side is displayed (LaTeX, or for example an unevaluated product), if it differs from
        ``right``; otherwise None.
    source : str
        Book and page, if the step is printed elsewhere.
    via : tuple of (str, Expr, Expr)
        Proven intermediate equations (words, left, right), for the page that shows the step in detail.
    board : tuple of (str, str)
        The proof as a teacher writes it on the board: reasons, and expressions in LaTeX that lead from the left side to
        the right one. Each was parsed and proven equal to the left side.
    printed : (bool, bool)
        For each side: True if the page displays the proven expression itself, or a form that was parsed and proven
        equal to the expression; False if the page displays a name or words instead.

    Examples
    --------
    >>> import symrot
    >>> isinstance(symrot.derivation("intermediate_axis").steps[0], symrot.Step)
    True
    """

    claim: str
    left: Any
    right: Any
    reason: str
    relation: str = "="
    hypotheses: tuple[Expr, ...] = ()
    conditions: tuple[Any, ...] = ()
    named: str = ""
    display: Any = None
    source: str = ""
    via: tuple[tuple[str, Any, Any], ...] = ()
    printed: tuple[bool, bool] = (True, True)
    board: tuple[tuple[str, str], ...] = ()

    def __repr__(self) -> str:
        return f"<Step: {self.claim}>"

    def _repr_markdown_(self) -> str:
        return symrot.in_notebook(self)


@dataclass(frozen=True)
class Table:
    """Table on a page: results of one kind, one row for each case, such as each sequence of Euler angles.

    Attributes
    ----------
    text : str
        The paragraph above the table.
    head : tuple of str
        Titles of the columns; the printers put a column with the numbers of the steps in front.
    rows : tuple of (tuple of str, tuple of Step)
        The cells of each row, and the steps that prove them. Formulas in cells are LaTeX between ``$``.

    Examples
    --------
    >>> Table("Sums:", ("n", "sum"), ((("1", "$1$"), ()),)).steps
    ()
    """

    text: str
    head: tuple[str, ...]
    rows: tuple[tuple[tuple[str, ...], tuple[Step, ...]], ...]

    @property
    def steps(self) -> tuple[Step, ...]:
        """The proven steps to which the rows of the table belong, row by row; empty if no row has a step."""
        return tuple(step for _, steps in self.rows for step in steps)

    @property
    def is_proven(self) -> bool:
        """Whether any row has a proven step; if so, the first printed column has the numbers of the steps."""
        return bool(self.steps)


class Drawing(Protocol):
    """Protocol of a drawing that can be written as SVG, the format of the figures on pages."""

    def svg(self, title: str, description: str) -> str:
        """Return the drawing as the text of an SVG file; screen readers speak its ``title`` and its ``description``."""


@dataclass(frozen=True)
class Figure:
    """Figure on a page; ``draw`` is called only when the SVG is needed, because drawing takes time.

    Attributes
    ----------
    name : str
        The name of its file, without ``.svg``.
    title : str
        A few words without formulas, which say what the figure shows.
    caption : str
        Sentences below the figure; formulas are LaTeX between ``$``.
    draw : callable
        Takes no argument and returns the drawing, see :class:`Drawing`.
    section : str
        The title of the section that begins with this figure; empty for a figure at the top of the page.
    """

    name: str
    title: str
    caption: str
    draw: Callable[[], Drawing]
    section: str = ""

    @property
    def file(self) -> str:
        """The path of the figure's SVG file, relative to the folder of the page: ``figures/NAME.svg``."""
        return f"figures/{self.name}.svg"

    @property
    def description(self) -> str:
        """The caption as plain text, without Markdown and LaTeX; screen readers speak this text for the drawing."""
        return re.sub(r"[$`{}\\]", "", re.sub(r"\\[,;]|~", " ", self.caption)).replace("_", " ")

    def svg(self) -> str:
        """Return the figure as a document of SVG; it is drawn once per process."""
        return _svg(self)


@cache
def _svg(figure: Figure) -> str:
    return figure.draw().svg(figure.title, figure.description)


@dataclass
class Page:
    """Page of a derivation: assumptions, and the consequences that follow from them step by step.

    Parameters
    ----------
    name : str
        The name of the catalogue file, such as ``"symmetric_top"``.
    title : str
    source : str
        Books and pages that treat the subject.
    about : str
        One paragraph about the subject and its use.
    items : list
        Headings, passages, steps, tables and figures, in order.
    first : int
        The number of the first step; not 1 on a page with a part of a derivation.
    opening : list
        Paragraphs and figures above the paragraph about the subject.
    closing : list
        Headings and paragraphs below the steps and the units.
    file : str
        The path of the catalogue file, relative to the folder of symrot; empty for a page outside the catalogue.
    """

    name: str
    title: str
    source: str = ""
    about: str = ""
    items: list[Section | Passage | Step | Table | Figure] = field(default_factory=list)
    first: int = 1
    file: str = ""
    opening: list[Passage | Figure] = field(default_factory=list)
    closing: list[Section | Passage] = field(default_factory=list)

    @property
    def extent(self) -> str:
        """The number of steps in words for a table of contents: "1 step", "12 steps"."""
        count = len(self.steps)
        return f"{count} {'step' if count == 1 else 'steps'}"

    @property
    def steps(self) -> tuple[Step, ...]:
        """The proven steps of the page in order, including those that stand as rows of tables."""
        steps: list[Step] = []
        for item in self.items:
            if isinstance(item, Step):
                steps.append(item)
            elif isinstance(item, Table):
                steps += item.steps
        return tuple(steps)

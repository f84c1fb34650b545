"""The data of a lesson: a question, the required pages, numbers of a scene, a common mistake, and links."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Rational, S, Symbol

__all__ = ["Lesson", "Mistake", "Number"]


@dataclass(frozen=True)
class Mistake:
    """A wrong formula that students write; the checker refutes it when the page is printed.

    Attributes
    ----------
    words : str
        How students come to write the formula: the text before it on the page.
    claim : str
        The formula in the language of claims.
    facts : tuple of str
        Hypotheses of the claim.
    lesson : str
        The correct statement: the text after the verdict on the page.
    repair : int or None
        Index of the checker's repair (corrected formula) that the page prints; None if no repair helps the student.

    Examples
    --------
    >>> Mistake("The square is lost.", "sin(x)**2 + cos(x) == 1").facts
    ()
    """

    words: str
    claim: str
    facts: tuple[str, ...] = ()
    lesson: str = ""
    repair: int | None = 0


@dataclass(frozen=True)
class Number:
    """A number on a page: the formula of one of its steps, evaluated with the numbers of a scene.

    Attributes
    ----------
    words : str
        The sentence that introduces the number on the page.
    name : str
        Name of the number, LaTeX.
    step : str
        The first words of the step's claim. The formula is the right side of the step's equation, in the form that the
        page displays. If the page displays LaTeX written by hand, the formula is the right side as it was proven.
    unit : str
        Unit of the number; "1" for a pure number.
    entry : int or None
        Index of the entry if the right side is a matrix, counted row by row from 0.
    where : mapping of Symbol to Expr
        Replacements of symbols in the formula, simultaneous, by expressions in symbols that have a value in the scene.
    power : Rational
        Exponent that is applied to the formula, such as 1/2 for a rate whose square the step gives.
    scale : Expr
        Factor by which this power is multiplied.
    section : str
        Title of the section that contains the step; needed if several steps have the same claim.
    page : str
        Name of the derivation that contains the step, if it is on another page.

    Examples
    --------
    >>> Number("The frequency:", "p", "The frequency.", "rad/s", power=Rational(1, 2)).entry is None
    True
    """

    words: str
    name: str
    step: str
    unit: str
    entry: int | None = None
    where: Mapping[Symbol, Expr] = field(default_factory=dict)
    power: Rational = S.One
    scale: Expr = S.One
    section: str = ""
    page: str = ""


@dataclass(frozen=True)
class Lesson:
    """The additions for students to the page of one derivation.

    Attributes
    ----------
    question : str
        The question that the page answers, as a student would ask it.
    before : tuple of str
        Names of the pages that a student should read before.
    mistake : Mistake
        A mistake that students often make about the subject of the page; the page shows how the checker refutes it.
    scene : str
        Name of a shipped scene that shows the effect; empty if there is none.
    numbers : tuple of Number
        Numbers of the scene. A page without numbers shows a solved exercise instead.
    worked : str
        Name of the template of the solved exercise.
    kernel : str
        Name of the kernel that computes the result; empty if there is none.
    topic : str
        Topic of exercises.
    library : tuple of str
        Titles of the sections at the end of the derivation that matter only for symrot's numeric library. The lesson
        leaves out these sections; they are printed as an appendix, on a page of their own.

    Examples
    --------
    >>> Lesson("Why?", (), Mistake("", "x == 1"), topic="inertia").scene
    ''
    """

    question: str
    before: tuple[str, ...]
    mistake: Mistake
    scene: str = ""
    numbers: tuple[Number, ...] = ()
    worked: str = ""
    kernel: str = ""
    topic: str = ""
    library: tuple[str, ...] = ()

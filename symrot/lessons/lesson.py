"""What a page has for students: a question, what is needed before, numbers, a mistake, and where to go on."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Rational, S, Symbol

__all__ = ["Lesson", "Mistake", "Number"]


@dataclass(frozen=True)
class Mistake:
    """A wrong formula that students write, which the checker refutes when the page is printed.

    Attributes
    ----------
    words : str
        How one comes to write it: a sentence before the formula.
    claim : str
        The formula in the language of claims.
    facts : tuple of str
        Hypotheses of the claim.
    body : str
        The body in words, as ``symrot check --body`` takes it.
    lesson : str
        What is right: a sentence after the verdict.
    repair : int or None
        Which of the checker's repairs the page prints; None for none, where they are true but lead elsewhere.

    Examples
    --------
    >>> Mistake("The square is lost.", "sin(x)**2 + cos(x) == 1").facts
    ()
    """

    words: str
    claim: str
    facts: tuple[str, ...] = ()
    body: str = ""
    lesson: str = ""
    repair: int | None = 0


@dataclass(frozen=True)
class Number:
    """A number that follows from the formula of a step for a scene.

    Attributes
    ----------
    words : str
        What the number is: a sentence, which ends with a colon.
    name : str
        Its name, LaTeX.
    step : str
        How the claim of the step begins. The formula is the displayed right side if that is an expression, otherwise
        the right side as it was derived.
    unit : str
    entry : int or None
        Which entry of a right side that is a matrix, row by row from 0.
    where : mapping of Symbol to Expr
        Values of symbols that are not numbers of the scene, in terms of symbols that are.
    power : Rational
        The power of the formula that is the number, such as 1/2 for a rate whose square the step gives.
    scale : Expr
        A factor of that power.
    section : str
        The title of the section of the step, if several steps have one claim.
    page : str
        The derivation of the step, if it is on another page.

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
    """What the page of one derivation has for students.

    Attributes
    ----------
    question : str
        The question that the page answers, as a student would ask it.
    before : tuple of str
        Names of the pages that are needed before.
    mistake : Mistake
    scene : str
        Name of the shipped scene that shows the effect; empty if there is none.
    numbers : tuple of Number
        Numbers of the scene. A page without them works an exercise instead.
    worked : str
        Name of the template of the exercise that the page works.
    kernel : str
        Name of the kernel that computes the result; empty if there is none.
    topic : str
        Topic of exercises.
    library : tuple of str
        Titles of the sections that only the library needs, to evaluate motions; a course can leave them out.

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

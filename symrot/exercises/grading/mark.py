"""The mark of one answer, and the marks of all answers to a sheet."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

__all__ = ["Grades", "Mark"]


@dataclass(frozen=True)
class Mark:
    """The result of grading one answer.

    Attributes
    ----------
    key : str
        The question, such as ``"1a"`` or ``"a"``.
    answer : str
        The answer as the student wrote it; its first 60 characters if it is too long to be graded.
    outcome : str
        ``"right"``, ``"wrong"``, ``"unread"`` (the answer cannot be read), ``"undecided"`` or ``"missing"``.
    credit : Fraction
        The share of the question's points that the answer gets, from 0 to 1.
    code : str
        The kind of error of a wrong answer, such as ``"sign"``; otherwise empty.
    text : str
        One sentence for the student; empty for a right answer.

    Examples
    --------
    >>> import symrot
    >>> grades = symrot.grade(symrot.exercise("rod_about_end")[0], {"a": "m*L**2/6"})
    >>> grades.marks[0].code, grades.marks[0].credit
    ('factor', Fraction(1, 2))
    """

    key: str
    answer: str
    outcome: str
    credit: Fraction = Fraction(0)
    code: str = ""
    text: str = ""

    def __str__(self) -> str:
        credit = f"{self.outcome}, {float(self.credit):.0%}"
        return f"({self.key}) {credit}{f': {self.text}' if self.text else ''}"

    def to_json(self) -> dict[str, Any]:
        """Return the mark as plain data for JSON."""
        return {**vars(self), "credit": float(self.credit)}


@dataclass(frozen=True)
class Grades:
    """The marks for all questions of one exercise or of a sheet.

    Attributes
    ----------
    marks : tuple of Mark
        One mark for each question, in the order of the questions.

    Examples
    --------
    >>> import symrot
    >>> print(symrot.grade(symrot.exercise("rod_about_end")[0], {"a": "L^2 m/3"}))
    (a) right, 100%
    (b) missing, 0%: no answer was written
    1 of 2 points
    """

    marks: tuple[Mark, ...]

    def __iter__(self) -> Iterator[Mark]:
        return iter(self.marks)

    @property
    def credit(self) -> Fraction:
        """The sum of the credits of all questions, each from 0 to 1."""
        return sum((mark.credit for mark in self.marks), Fraction(0))

    def __str__(self) -> str:
        total = f"{float(self.credit):g} of {len(self.marks)} points"
        return "\n".join([*map(str, self.marks), total])

    def to_json(self) -> dict[str, Any]:
        """Return all marks as plain data for JSON."""
        return {"credit": float(self.credit), "of": len(self.marks), "marks": [mark.to_json() for mark in self.marks]}

"""Removing the text around a formula that was copied from a page: its equation number, ``where`` clauses, ``and``."""

import re
from dataclasses import dataclass

__all__ = ["Copied", "without_surroundings"]

_NUMBER = re.compile(
    r"(?:(?<=[,.;])|(?<=\s))\((?:\d+[.\-–:]\d+(?:[.\-–]\d+)?[a-z]?|[A-Z][.\-–]?\d+(?:\.\d+)?)\)[ \t.]*(?=\n|$)"
    r"|(?:(?<=[,.;\t])|(?<=[ \t]{2})|(?<=[,.;] ))\(\d+[a-z]?\)[ \t.]*(?=\n|$)"
)
"""The number of an equation at the end of a line: ``(1.23)``, or ``(12)`` after a wide blank or a comma."""

_REMARK = re.compile(
    r"\s\((?!(?i:d?(?:alpha|beta|gamma|delta|epsilon|theta|kappa|lambda|sigma|omega|phi|psi|rho|tau)))"
    r"[A-Za-z]{4,}(?:[ '-][A-Za-z]+)*\)[ \t.]*(?=\n|$)"
)
"""Words in brackets at the end of a line, as ``(Steiner)``."""

_OPERATORS = tuple("+-−*·⋅×/^=<>≤≥(")

_WHERE = re.compile(r"[,;.]?\s*\b(?:where|wherein|in which|with)\b:?")
_CLAUSE = re.compile(r"[^,;\n]+?(?=\s\band\b|[,;\n]|$)|\s\band\b")
_PROSE = re.compile(r"\s(?:is|are|denotes?|being)\b.*", re.DOTALL)
_AND = re.compile(r"(?<=\s)and(?=\s)")


@dataclass(frozen=True)
class Copied:
    """A text in which blanks replace everything but its formulas, so that the formulas keep their positions.

    Attributes
    ----------
    text : str
    where : int
        The position at which the ``where`` clauses start; -1 if there are none.
    numbers : tuple of str
        The numbers of equations, such as "(2.1)".
    notes : tuple of str
        Sentences that say which words are left out.
    """

    text: str
    where: int = -1
    numbers: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def without_surroundings(source: str, numbers: bool = True) -> Copied:
    """Return the equations of a text without the words around them and, if ``numbers``, without their numbers.

    Examples
    --------
    >>> without_surroundings("F = m a, where m is the mass  (2.1)").text.rstrip()
    'F = m a'
    >>> without_surroundings("x = 2 (1.5)", numbers=False).text
    'x = 2 (1.5)'
    """
    labels, text = _without(_NUMBER, source) if numbers else ([], source)
    labels = [label.strip(" \t.") for label in labels]
    notes = [f"{number} is read as the number of the equation" for number in labels]
    remarks, text = _without(_REMARK, text)
    notes += [f"{remark.strip()!r} is not read" for remark in remarks]
    where = -1
    if (match := _WHERE.search(text)) and "=" in text[: match.start()]:
        where = match.start()
        # clauses without an equation, such as "where m is the mass", are left out
        rest, left_out = _clauses(text[match.end() :])
        rest = rest if "=" in rest else " " * len(rest)
        text = text[:where] + " " * (match.end() - where) + rest
        notes += [f"{clause!r} is not read" for clause in left_out]
    if text.count("=") > 1:
        text = _AND.sub(" ; ", text)
    return Copied(text, where, tuple(labels), tuple(notes))


def _without(pattern: re.Pattern[str], text: str) -> tuple[list[str], str]:
    """Return the matches of a pattern in a text, and the text with blanks in their place.

    A match after an operator stays in the text, since it is part of the formula.
    """
    removed: list[str] = []

    def blank(match: re.Match[str]) -> str:
        if text[: match.start()].rstrip()[-1:] in _OPERATORS:
            return match[0]
        removed.append(match[0])
        return " " * len(match[0])

    return removed, pattern.sub(blank, text)


def _clauses(text: str) -> tuple[str, list[str]]:
    """Return (the equations in ``text``, the clauses without an equation, such as "m is the mass").

    The equations keep their positions in ``text``: clauses without an equation, and words after an equation, are
    overwritten with blanks. A semicolon replaces each "and" between clauses.
    """
    left_out: list[str] = []

    def equation_or_blank(match: re.Match[str]) -> str:
        clause = match[0]
        if "=" in clause:
            short = _PROSE.sub("", clause)
            return short.ljust(len(clause))
        if clause.strip() not in ("", "and"):
            left_out.append(clause.strip())
        # blanks keep the positions of all other characters
        return ";".rjust(len(clause)) if clause.strip() == "and" else " " * len(clause)

    return _CLAUSE.sub(equation_or_blank, text), left_out

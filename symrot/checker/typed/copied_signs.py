"""Normalising a copied text, so that the readers of claims understand it.

Commas that separate thousands are removed: ``1,500`` becomes ``1500``. The sign ≈ before a rounded value becomes =.
Factorials are computed. Braces used as brackets become brackets. In LaTeX, superscript digits such as ² and fractions
such as ½ become commands, and definitions after "where" move to the front.
"""

import re
import unicodedata
from math import factorial

__all__ = ["with_plain_signs"]

_THOUSANDS = re.compile(r"(?<![\w.,(\[])\d{1,3}(?:,\d{3})+(?![\d,])(?![^()\[\]]*[)\]])")
"""Pattern of a number with commas between thousands, such as 1,500, outside of brackets.

Inside brackets, a comma separates arguments, as in ``atan2(1,500)``.
"""

_ROUNDED = re.compile(r"(?:≈|\\approx\b)(?=\s*[-−]?\s*\d+(?:\.\d+|\s*(?:°|\^\{?\\circ|[a-zA-Z\\])))")
"""Pattern of the sign ≈ before a decimal number or a number with a unit, which is a rounded value."""

_FUNCTION = re.compile(r"(?<![A-Za-z\\_])(?:sin|cos|tan|sinh|cosh|tanh|sqrt|exp|ln|log|asin|acos|atan)(?![A-Za-z])")
_WHERE = re.compile(
    r"[,;.]?\s*(?:\\(?:text|mathrm|textrm)\{\s*where:?\s*\}|(?<![A-Za-z\\])where\b:?)(?:\\[,;: ]|\\q?quad)*"
)
_BETWEEN = re.compile(r"\s(?:\\(?:text|mathrm|textrm)\{\s*and\s*\}|and)\s")
_RAISED = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")
"""Pattern of superscript digits such as ², which LaTeX writes as ``^{2}``."""

_FRACTION = re.compile("[½⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅛⅜⅝⅞]")
"""Pattern of a fraction in one character such as ½, which LaTeX writes with ``\\frac``."""

_SUBSCRIPT = re.compile(r"_\{(\w+)\}")

_FACTORIAL = re.compile(r"(?<![\w.])([12]?\d|30)!(?![=!])")
"""Pattern of a factorial such as ``10!``; its group is the number, 30 at most."""


def with_plain_signs(source: str) -> str:
    r"""Return a copied text in the notation that the readers of claims understand: ``1500`` in place of ``1,500``.

    The head of this file lists the changes. A sign that may mean something else stays unchanged: a comma inside
    brackets may separate arguments, and ≈ before a letter states no rounded value.

    Examples
    --------
    >>> with_plain_signs("1,500 rpm = 157.08 rad/s"), with_plain_signs("sqrt(2) ≈ 1.41")
    ('1500 rpm = 157.08 rad/s', 'sqrt(2) = 1.41')
    >>> with_plain_signs("10! = 3628800")
    '3628800 = 3628800'
    >>> with_plain_signs("e^{i x} = cos x + i sin x")
    'e^(i x) = cos x + i sin x'
    >>> with_plain_signs(r"T = ½ m \dot x²")
    'T = \\frac{1}{2} m \\dot x^{2}'
    >>> with_plain_signs(r"\bar z z = x^2 + y^2 where z = x + i y")
    'z = x + i y, \\bar z z = x^2 + y^2'
    """
    text = _THOUSANDS.sub(lambda match: match[0].replace(",", ""), source)
    text = _ROUNDED.sub("=", text)
    text = _FACTORIAL.sub(lambda match: str(factorial(int(match[1]))), text)
    if "\\" not in text and "$" not in text and "{" in text and (_FUNCTION.search(text) or "∫" in text):
        text = _SUBSCRIPT.sub(r"_\1", text).replace("{", "(").replace("}", ")")
    if "\\" in text or "$" in text:
        text = _RAISED.sub(lambda match: f"^{{{unicodedata.normalize('NFKC', match[0])}}}".replace("\u2212", "-"), text)
        text = _FRACTION.sub(_in_latex, text)
    return _with_definitions_first(text) if "\\" in text or "{" in text else text


def _in_latex(fraction: re.Match[str]) -> str:
    """Return the LaTeX of a character such as ½."""
    above, below = unicodedata.normalize("NFKC", fraction[0]).split("\u2044")
    return rf"\frac{{{above}}}{{{below}}}"


def _with_definitions_first(text: str) -> str:
    """Return LaTeX with the definitions after ``where`` moved to the front.

    ``z^2 = -1 where z = i`` becomes ``z = i, z^2 = -1``.
    """
    match = _WHERE.search(text)
    if match is None or "=" not in text[: match.start()] or "\\begin" in text:
        return text
    clauses = _BETWEEN.sub(", ", text[match.end() :]).strip(" $.")
    formula = text[: match.start()].strip(" $")
    parts = re.split(r",(?![^{(]*[})])", clauses)
    if not all("=" in part for part in parts):
        return rf"{formula} \text{{where}} {clauses}" if "=" not in clauses else text
    return f"{clauses}, {formula}"

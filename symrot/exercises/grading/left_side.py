"""The left side of a student's equation: whether it only names the quantity that a question asks for."""

import re
from collections.abc import Collection, Iterator

from symrot.exercises.units import unit_of

__all__ = ["is_multiple", "names_only"]

_DECORATION = re.compile(
    r"\\(?:d?dot|vec|hat|bar|mathrm|text|operatorname|left|right|[,;:! ])|\$|[-_ ]?dot\b"
    r"|(?:\\[dt]?frac)?\{?(?<![^\W\d_])d(?:²|\^\{?2\}?)?\s*\\?[^\W\d_][\w\\{}]*\s*(?:/|\}\s*\{)\s*d\s*t(?:²|\^\{?2\}?|\b)\}?"
)
"""Pattern of dots, hats, brackets and the like that belong to a name, and of a derivative such as dphi/dt.

Neither counts as an operation: dphi/dt is a name of a quantity, although it contains a slash.
"""

_INDEX = re.compile(r"(?<=\w)(?:[(\[]\d(?:,\s*\d)?[)\]])+|_\{[^{}]*\}|_?(?<=[^\W\d])\d+|_\d+")
_OPERATIONS = re.compile(
    r"\\[dt]?frac|(?:arc|a)?(?:sin|cos|tan)h?|sqrt|√|exp\b|log|ln\b|[-−+*/^·⋅×÷²³!<>≠≤≥]|\\(?:neq?|leq?|geq?)\b|\d+"
)
_MULTIPLE = re.compile(
    r"[-−]?\s*(?:\d[\d.]*)?\s*[*·⋅/]?\s*(\\?[^\W\d_](?:(?![²³])[\w'{}\\\u0307\u0308])*)\s*(?:[*·⋅/]\s*\d[\d.]*|(?:\^|\*\*)\s*\d+|[²³])?"
)


def names_only(left: str, name: str, symbols: Collection[str]) -> bool:
    """Return whether the left side of an equation is only a name, such as that of the asked quantity.

    It may contain operations that occur in ``name``, the name of the asked quantity, such as the square in ``d^2``, but
    no others: ``I_O`` and ``I`` are names for ``I_O``, but ``2 I_O`` and ``1/I_O`` are not. A given quantity, one of
    ``symbols``, is not accepted.
    """
    return left not in symbols and set(_operations(left)) <= set(_operations(name))


def _operations(text: str) -> Iterator[str]:
    """Yield the operations in a typed or LaTeX text, such as ``"+"`` and ``"sin"``, and ``"number"`` for each number.

    Both ways to write a quotient give ``"/"``. Indices of names, dots and derivatives such as dphi/dt do not count.
    """
    plain = _INDEX.sub("", _DECORATION.sub(" ", text))
    for match in _OPERATIONS.findall(plain):
        yield "number" if match.isdecimal() else "/" if "frac" in match else "^" if match in "²³" else match


def is_multiple(left: str, name: str, symbols: Collection[str]) -> bool:
    """Return whether a left side is a multiple, the reciprocal or a power of an unknown: ``2 I``, ``1/I`` or ``I^2``.

    An unknown is a name other than the given quantities, ``symbols``. The result is False for a number with a unit, as
    in ``60 rpm = 6.283 rad/s``, and for a name alone, such as ``name``, the name of the asked quantity.
    """
    match = _MULTIPLE.fullmatch(_DECORATION.sub(" ", left).strip())
    if match is None or names_only(left, name, ()):
        return False
    return match[1] not in symbols and unit_of(match[1]) is None

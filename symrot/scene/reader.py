"""Readers of the values and tables of a scene; every error names the place of the value.

A reader is a function ``(value, where) -> result`` that checks a value of a scene and converts it, or raises
:class:`symrot.errors.InputError` with one sentence: file, key, expectation, value. ``where`` is the place of the value,
such as ``"tumbling.toml: body.mass"``. Standard library only.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple, NoReturn

from symrot.errors import InputError, nearest
from symrot.formula.exact_numbers import read, show

__all__ = [
    "LARGEST",
    "Entry",
    "Reader",
    "choice",
    "fail",
    "flag",
    "items",
    "key_path",
    "number",
    "read_table",
    "text",
    "unchanged",
    "vector",
]  # fmt: skip

Reader = Callable[[Any, str], Any]

LARGEST = Fraction(10) ** 100
"""Largest magnitude of a quantity in a scene; the smallest is its inverse. Products of three are then finite doubles.
"""


class Entry(NamedTuple):
    """The rules for one key of a table: the function that reads its value, whether it is required, and its default."""

    read: Reader
    required: bool = False
    default: Any = None


def key_path(where: str, key: str) -> str:
    """Return the place of a key in the table at ``where``: ``"f.toml: body.mass"`` for mass in ``"f.toml: body"``."""
    printable = str(key)[:80] if str(key).isprintable() else repr(key)[:80]
    return f"{where}{printable}" if where.endswith(": ") or not where else f"{where}.{printable}"


def fail(where: str, expectation: str, value: object = ..., reason: str = "") -> NoReturn:
    """Raise InputError with the sentence "where: expected .., got .. (reason)".

    Without ``value`` the part "got .." is left out, without ``reason`` the part in brackets.
    """
    place = where.removesuffix(": ")
    got = "" if value is ... else f", got {show(value)}"
    raise InputError(f"{place}: expected {expectation}{got}" + (f" ({reason})" if reason else ""))


def table(value: object, where: str, expectation: str = "a table") -> Mapping[str, Any]:
    """Return the value if it is a table (a mapping); raise InputError otherwise.

    ``expectation``, such as "a table [body]", is part of the message.
    """
    if not isinstance(value, Mapping):
        fail(where, expectation, value)
    return value


def read_table(value: object, where: str, entries: Mapping[str, Entry], what: str = "a table") -> dict[str, Any]:
    """Return a map from key to value of a table; the rules in ``entries`` say how each value is read.

    A missing key gets its default. Raise InputError for a value that is no table, an unknown key, a missing key that is
    required, and a value that its reader refuses; ``what`` names the table in the messages.
    """
    entries_by_key = table(value, where, f"{what} with the keys {', '.join(entries)}")
    for key in entries_by_key:
        if key not in entries:
            reason = ", ".join(filter(None, ("unknown key", nearest(key, entries))))
            fail(key_path(where, key), f"one of the keys {', '.join(entries)} of {what}", entries_by_key[key], reason)
    for key, entry in entries.items():
        if entry.required and key not in entries_by_key:
            fail(key_path(where, key), f"a value; the key is missing ({what} needs it)")
    return {
        key: entry.read(entries_by_key[key], key_path(where, key)) if key in entries_by_key else entry.default
        for key, entry in entries.items()
    }


def number(expectation: str = "a number", sign: str = "any") -> Reader:
    """Return a reader that accepts numbers and returns them as Fractions.

    ``sign`` is "any", "positive" or "nonnegative". The text ``expectation``, such as "a mass in kg", goes into error
    messages; it begins with "a ".
    """
    expected_number = {
        "any": expectation,
        "positive": f"a positive {expectation.removeprefix('a ')}",
        "nonnegative": f"{expectation}, zero or more",
    }[sign]

    def reader(value: Any, where: str) -> Fraction:
        value_read = read(value, where, expected_number)
        if value_read and not 1 / LARGEST <= abs(value_read) <= LARGEST:
            fail(where, f"{expectation} of a magnitude between 1e-100 and 1e100", value)
        if (sign == "positive" and value_read <= 0) or (sign == "nonnegative" and value_read < 0):
            fail(where, expected_number, value)
        return value_read

    return reader


def items(count: int, read: Reader, expectation: str) -> Reader:
    """Return a reader that accepts lists of ``count`` items and returns the results of ``read`` for them as a tuple.

    ``expectation``, such as "three numbers", goes into the error message for other values.
    """

    def reader(value: Any, where: str) -> tuple[Any, ...]:
        if not isinstance(value, list | tuple) or len(value) != count:
            fail(where, expectation, value)
        return tuple(read(item, f"{where}[{index}]") for index, item in enumerate(value))

    return reader


def vector(unit: str, sign: str = "any") -> Reader:
    """Return a reader that accepts lists of three numbers in ``unit`` and returns them as three Fractions.

    ``sign`` is "any", "nonzero" (only the zero vector is refused) or "nonnegative" (each component).
    """
    expectation = f"three numbers [x, y, z] in {unit}" if unit != "1" else "three numbers [x, y, z]"
    component = number(f"a number in {unit}" if unit != "1" else "a number", "any" if sign == "nonzero" else sign)
    components = items(3, component, expectation)

    def reader(value: Any, where: str) -> tuple[Fraction, Fraction, Fraction]:
        x, y, z = components(value, where)
        if sign == "nonzero" and not (x or y or z):
            fail(where, f"{expectation}, not all zero", value)
        return x, y, z

    return reader


def unchanged(value: Any, where: str) -> Any:
    """Return any value unchanged: the reader of values that are checked later."""
    return value


def text(value: Any, where: str) -> str:
    """Return the value if it is a line of at most 1000 printable characters; raise InputError otherwise.

    Control characters are excluded since they may disturb a terminal.
    """
    if not isinstance(value, str) or len(value) > 1000 or not value.isprintable():
        fail(where, "a line of text of at most 1000 characters", value)
    return value


def flag(value: Any, where: str) -> bool:
    """Return the value if it is true or false; otherwise raise InputError with the place ``where``."""
    if not isinstance(value, bool):
        fail(where, "true or false", value)
    return value


def choice(*options: str) -> Reader:
    """Return a reader that accepts each of the words ``options`` and refuses all other values with InputError."""

    def reader(value: Any, where: str) -> str:
        if not isinstance(value, str) or value not in options:
            fail(where, "one of " + ", ".join(f'"{option}"' for option in options), value, nearest(value, options))
        return value

    return reader

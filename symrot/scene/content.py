"""The content of a scene: the keys and values of its file, converted from Python values and printed as TOML.

Standard library only. NumPy arrays, rotations of SciPy and values of SymPy are recognised by their attributes, so none
of these packages is imported.
"""

import re
from collections.abc import Mapping
from decimal import Context, Decimal, Inexact
from fractions import Fraction
from math import isfinite
from typing import Any

from symrot.errors import InputError
from symrot.formula.exact_numbers import show

__all__ = ["Content", "plain", "toml_text"]

Content = dict[str, Any]
"""A table of a scene: text, numbers, true or false, lists and tables by key."""

DEEPEST = 40
DIGITS = 34  # most digits of a fraction that is printed as a decimal
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def plain(value: Any, where: str, depth: int = 0) -> Any:
    """Convert a Python value to the form of a scene file.

    An array or a matrix of SymPy becomes a list, a rotation of SciPy a quaternion, an expression of SymPy with symbols
    a formula. Other values stay unchanged.

    Raises
    ------
    InputError
        If tables and lists are nested more than :data:`DEEPEST` levels deep, or if a rotation holds several rotations.
    """
    if depth > DEEPEST:
        raise InputError(f"{where.removesuffix(': ')}: expected at most {DEEPEST} levels of tables and lists, got more")
    if isinstance(value, Mapping):
        return {str(key): plain(item, where, depth + 1) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item, where, depth + 1) for item in value]
    if hasattr(value, "as_quat") and hasattr(value, "as_matrix"):
        return {"quaternion": _scalar_first(value, where)}
    if getattr(value, "is_Matrix", False):  # of SymPy
        return plain(list(value) if 1 in value.shape else value.tolist(), where, depth + 1)
    if hasattr(value, "tolist") and hasattr(value, "dtype"):
        return plain(value.tolist(), where, depth + 1)
    if getattr(value, "is_commutative", False) and value.free_symbols:  # of SymPy; 17 digits keep the value of a double
        return str(value.replace(lambda part: part.is_Float, lambda part: part.func(part, 17)))
    return value


def _scalar_first(rotation: Any, where: str) -> list[float]:
    quaternion = rotation.as_quat().tolist()
    if len(quaternion) != 4 or isinstance(quaternion[0], list):
        raise InputError(
            f"{where.removesuffix(': ')}: expected a single rotation, got {len(quaternion)} rotations; "
            "write rotation[0] for the first"
        )
    x, y, z, w = quaternion
    return [w, x, y, z]


def toml_text(content: Content) -> str:
    """Return the content of a scene as the text of a scene file (TOML); numbers keep their exact values.

    Raise InputError for a value that TOML cannot hold, such as None.
    """
    lines: list[str] = []
    _write_table(content, "", lines)
    return "\n".join(lines).strip() + "\n"


def _write_table(content: Content, name: str, lines: list[str]) -> None:
    """Append the TOML lines of a table to ``lines``: first its values, then its tables and lists of tables."""
    # name is the dotted name in the header [name]; empty for the whole file
    later = [key for key, value in content.items() if _is_section(value, name)]
    lines += [f"{_key(key)} = {_value(value)}" for key, value in content.items() if key not in later]
    for key in later:
        path = f"{name}.{_key(key)}" if name else _key(key)
        tables = content[key] if isinstance(content[key], list) else [content[key]]
        for item in tables:
            lines += ["", f"[[{path}]]" if isinstance(content[key], list) else f"[{path}]"]
            _write_table(item, path, lines)


def _is_section(value: Any, name: str) -> bool:
    """Return whether a value has its own TOML header: ``[body]`` for a table, ``[[torque]]`` for a list of tables."""
    if isinstance(value, list):
        return bool(value) and all(isinstance(item, dict) for item in value)
    # tables inside named tables are written as key = value
    return isinstance(value, dict) and not name


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t"}
    return '"' + "".join(escapes.get(c, c if c.isprintable() else f"\\U{ord(c):08x}") for c in text) + '"'


def _value(value: Any) -> str:
    """Return a value as TOML on one line, such as ``[1, 2.5]``.

    A fraction without an exact decimal becomes text, such as ``"1/3"``, which scenes accept as a number.
    """
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _quoted(value)
        case Fraction():
            return str(value.numerator) if value.denominator == 1 else _fraction(value)
        case int():
            return str(value)
        case float() if isfinite(value):
            return _decimal(Decimal(value))
        case Decimal() if value.is_finite():
            return _decimal(value)
        case list():
            return "[" + ", ".join(map(_value, value)) + "]"
        case dict():
            return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + " }"
    raise InputError(f"expected a value that TOML can hold, got {show(value)}")


def _fraction(value: Fraction) -> str:
    context = Context(prec=DIGITS)
    quotient = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    return _quoted(str(value)) if context.flags[Inexact] else _decimal(quotient)


def _decimal(value: Decimal) -> str:
    """Return the exact decimal digits of a number, with a point or an exponent, so that TOML reads a float."""
    text = str(value).replace("E", "e").replace("e+", "e")
    return text if any(mark in text for mark in ".e") else f"{text}.0"

"""The option ``--set KEY=VALUE`` of the commands; it changes values of a scene. Standard library only."""

from collections.abc import Sequence
from decimal import Decimal
from typing import Any

from symrot.errors import InputError

__all__ = ["SET_HELP", "settings"]

SET_HELP = "another value in the scene, written as in its file: body.mass=2, omega_3=1/3, 't=[0, 5]'; may be repeated"


def settings(texts: Sequence[str]) -> dict[str, Any]:
    """Return the values that the texts of ``--set KEY=VALUE`` give, as a dict by key.

    A value is read as TOML; a text that is no TOML value, such as ``1/3``, stays a text.

    Raises
    ------
    InputError
        If a text is not of the form KEY=VALUE, or if a key occurs twice.
    """
    values: dict[str, Any] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        key = key.strip()
        if not equals or not key:
            raise InputError(f"--set: expected KEY=VALUE, such as body.mass=2, got {text[:80]!r}")
        if key in values:
            raise InputError(f"--set: expected each key once, got {key[:80]!r} a second time")
        values[key] = _value(value.strip())
    return values


def _value(text: str) -> Any:
    from tomllib import TOMLDecodeError, loads

    try:
        content = loads(f"value = {text}", parse_float=Decimal)
    except (TOMLDecodeError, ValueError, ArithmeticError, RecursionError):
        return text
    return content["value"] if content.keys() == {"value"} else text

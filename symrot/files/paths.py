"""Paths that a user gives as arguments of functions."""

from os import PathLike
from pathlib import Path

from symrot.errors import InputError

__all__ = ["path_of"]


def path_of(value: object, place: str) -> Path:
    """Return the path that an argument names; raise InputError, with the name ``place``, if it is no string or path."""
    if not isinstance(value, str | PathLike):
        raise InputError(f"{place}: expected the path of a file, as a string or Path, got {repr(value)[:60]}")
    return Path(value)

"""Access to the C files of the package by their paths inside it."""

from pathlib import Path

__all__ = ["PACKAGE", "c_text"]

PACKAGE = Path(__file__).parents[1]


def c_text(path: str) -> str:
    """Return the text of a C file or header, such as ``propagation/steppers/taylor.c``."""
    return (PACKAGE / path).read_text(encoding="utf-8")

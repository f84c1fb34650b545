"""Types and expressions of the C text that a :class:`Machine` (machine.py) runs in Python.

The address of a variable, and so a pointer, is a pair ``(container, index)``, called a place. The container is a list:
an array, the fields of a structure, or the variables of a function (its frame). An expression becomes a
Python function that computes its value from the frame.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

__all__ = [
    "INT", "REAL", "VOID", "Frame", "Function", "Place", "Return", "Run", "Struct", "Type", "Value", "called",
    "copied", "pointer",
]  # fmt: skip

Frame = list[Any]
Run = Callable[[Frame], Any]
Place = tuple[list[Any], int]


class Type(NamedTuple):
    """A type of C."""

    kind: str  # "int", "real", "void", "struct", "array" or "pointer"
    of: Any = None  # the structure's name, or the type of the elements
    size: int = 0  # of an array; -1 if the declaration gives none


INT, REAL, VOID = Type("int"), Type("real"), Type("void")


def pointer(kind: Type) -> Type:
    """Return the type with which an argument of type ``kind`` is passed: an array becomes a pointer to its elements."""
    return Type("pointer", kind.of) if kind.kind == "array" else kind


class Struct(NamedTuple):
    """A structure: the names and the types of its members."""

    names: list[str]
    types: list[Type]


class Function(NamedTuple):
    """A C function: the types of its result and parameters, its body as a function, and the number of its variables."""

    result: Type
    parameters: list[Type]
    body: list[Run]  # one element, once the body is read: the Python function that runs the body on the frame
    slots: list[int]  # one element: the number of variables


class Value(NamedTuple):
    """An expression of C: its type, and the Python function ``run`` that computes its value from the frame.

    For a variable, the function ``place`` computes its address, a pair (container, index); otherwise ``place`` is None.
    """

    type: Type
    run: Run
    place: Run | None = None


class Return(Exception):
    """Raised by a ``return`` statement to leave the C function; the exception's argument is the function's result."""


def called(function: Function, arguments: Sequence[Any]) -> Any:
    """Run a C function on numbers, integers and pointers; return its result, or None if it has none."""
    frame: Frame = [None] * function.slots[0]
    frame[: len(arguments)] = arguments
    try:
        function.body[0](frame)
    except Return as result:
        return result.args[0]
    return None


def copied(value: Any) -> Any:
    """Return a copy of a structure or array, in which inner structures and arrays are copied too; else the value."""
    return [copied(each) for each in value] if isinstance(value, list) else value

"""Compile the closed forms, once per machine, and load them: all scenes share them, only their constants differ.

A closed form is two C files, compiled side by side: ``name.c`` finds the constants of a motion, once, and is compiled
at -Og, in a third of the time that -O2 takes for 1 us less; ``name_at.c`` holds the loops over samples. Elementary
constants need no ``name.c``; ``bodies_at.c`` loops over bodies. Error-free arithmetic needs every rounding as written:
contraction is off, and each prepared motion first asks the compiled code whether that is so.
"""

import ctypes
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build import cache as library
from symrot.errors import CompilerError, InputError
from symrot.formula.exact_numbers import show

__all__ = ["FLAGS", "PARTS", "Floats", "begin", "load", "loaded", "source", "times_of"]

Floats = NDArray[np.float64]

FLAGS = (
    "-std=c99",
    library.NATIVE,
    "-ffp-contract=off",  # double-double arithmetic counts on every rounding
    "-fno-math-errno",  # sqrt in one instruction
    "-fno-tree-slp-vectorize",  # it slows long straight-line code
    "-fno-trapping-math",  # loops with comparisons become SIMD code
    "-fPIC",
    "-shared",
)

INCLUDE = '\n#include "'

PARTS = {"": (*FLAGS, "-Og"), "_at": (*FLAGS, "-O2")}
"""The two files of a closed form, by what follows its name, with their flags."""

_begun: dict[str, list[library.Building]] = {}
_loaded: dict[str, tuple[Any, ...]] = {}


@cache
def _files() -> dict[str, Path]:
    """Return the C files and headers of all closed forms by name: arithmetic, and a folder for each form."""
    return {file.name: file for file in Path(__file__).parent.rglob("*.[ch]")}


def source(name: str) -> str:
    """Return the text of ``name.c`` with its headers put in, each once: a whole translation unit."""
    places, seen = _files(), set()

    def text(file: str) -> str:
        seen.add(file)
        first, *rest = ("\n" + places[file].read_text(encoding="utf-8")).removesuffix("\n").split(INCLUDE)
        parts = [first]
        for part in rest:
            included, _, after = part.partition('"')
            parts += [*([] if included in seen else ["\n", text(included)]), after]
        return "".join(parts).removeprefix("\n")

    return text(f"{name}.c") + "\n"


def begin(name: str) -> list[library.Building]:
    """Return the libraries of a closed form, one for each of its :data:`PARTS`, from the cache or while they compile.

    Raises
    ------
    CompilerError
        If there is no C compiler.
    """
    if name not in _begun:
        _begun[name] = [
            library.Building(source(f"{name}{part}"), f"closed_form_{name}{part}", flags)
            for part, flags in PARTS.items()
            if f"{name}{part}.c" in _files()
        ]
    return _begun[name]


def loaded(name: str) -> bool:
    """Return whether a closed form is at hand, so that no compiler is needed for it."""
    return name in _loaded


def load(name: str) -> tuple[Any, ...]:
    """Return the loaded libraries of a closed form: that of its constants, if C finds them, and that of its samples.

    Raises
    ------
    CompilerError
        If there is no C compiler, it refuses them, or one cannot be loaded.
    """
    if name not in _loaded:
        for attempt in (1, 2, 3):
            parts = begin(name)
            del _begun[name]
            try:
                _loaded[name] = tuple(ctypes.CDLL(str(part.path())) for part in parts)
                break
            except OSError as error:  # another process may have cleared the cache since
                if attempt == 3 or all(part.path().exists() for part in parts):
                    raise CompilerError(f"the compiled closed form {name!r} cannot be loaded: {error}") from error
    return _loaded[name]


def times_of(t: ArrayLike) -> Floats:
    """Return times as a vector of doubles.

    Raises
    ------
    InputError
        If they are not finite numbers in a sequence.
    """
    try:
        times = np.ascontiguousarray(t, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"times are a number or a sequence of numbers (s), got {show(t)}") from None
    if times.ndim > 1:
        raise InputError(f"times are a number or a sequence of numbers (s), got an array of shape {times.shape}")
    times = times.reshape(-1)
    if not isfinite(np.add.reduce(times)) and not np.isfinite(times).all():
        raise InputError(f"times must be finite, got {times[~np.isfinite(times)][0]}")
    return times

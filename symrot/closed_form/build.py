"""Compilation of the closed forms, once per machine: all scenes share the code and differ only in constants.

Most closed forms consist of two C files, compiled in parallel: ``name.c`` computes the constants of a motion, and
``name_at.c`` contains the loops over samples; some need no ``name.c``. Double-double arithmetic (sums of two doubles)
requires that every operation is rounded separately; the compiled code is tested for this before it computes a motion.
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

__all__ = ["FLAGS", "PARTS", "Floats", "available", "begin", "joined", "load", "source", "times_of"]

Floats = NDArray[np.float64]

FLAGS = (
    "-std=c99",
    library.NATIVE,
    "-ffp-contract=off",  # double-double arithmetic relies on every rounding
    "-fno-math-errno",  # sqrt in one instruction
    "-fno-tree-slp-vectorize",  # it slows long straight-line code
    "-fno-trapping-math",  # loops with comparisons become SIMD code
    "-fPIC",
    "-shared",
)

INCLUDE = '\n#include "'

# -Og takes a third of the compile time of -O2, but makes each motion 1 us slower
PARTS = {"": (*FLAGS, "-Og"), "_at": (*FLAGS, "-O2")}
"""Compiler flags for the C files of a closed form, by the ending of the file name."""

_begun: dict[str, list[library.Building]] = {}
_loaded: dict[str, tuple[Any, ...]] = {}


@cache
def _files() -> dict[str, Path]:
    """Return the paths of all C files and headers of the closed forms, by file name, such as ``"free_body.c"``."""
    return {file.name: file for file in Path(__file__).parent.rglob("*.[ch]")}


def source(name: str) -> str:
    """Return the text of the C file ``name.c``, in which the text of each header replaces its ``#include`` line."""
    return joined(name)


def joined(*names: str) -> str:
    """Return the texts of several C files as one text, in which the text of each header replaces its ``#include``."""
    # a header is inserted only where it is included first
    places, seen = _files(), set()

    def text(file: str) -> str:
        seen.add(file)
        first, *rest = ("\n" + places[file].read_text(encoding="utf-8")).removesuffix("\n").split(INCLUDE)
        parts = [first]
        for part in rest:
            included, _, after = part.partition('"')
            parts += [*([] if included in seen else ["\n", text(included)]), after]
        return "".join(parts).removeprefix("\n")

    return "\n".join(f"{text(f'{name}.c')}\n" for name in names)


def begin(name: str) -> list[library.Building]:
    """Start to compile the C files of a closed form, such as ``"free_body"``, in the background.

    The result has one compilation for each C file.

    Raises
    ------
    CompilerError
        If there is no C compiler.
    """
    # one library for each C file (elementary constants need no name.c); a cached library is not compiled again
    if name not in _begun:
        _begun[name] = [
            library.Building(source(f"{name}{part}"), f"closed_form_{name}{part}", flags)
            for part, flags in PARTS.items()
            if f"{name}{part}.c" in _files()
        ]
    return _begun[name]


def available(name: str) -> bool:
    """Return whether C can compute the closed form ``name``: its libraries are loaded, or there is a C compiler."""
    return name in _loaded or not library.missing()


def load(name: str) -> tuple[Any, ...]:
    """Load the compiled libraries of a closed form and return them; the last one contains the loops over samples.

    Raises
    ------
    CompilerError
        If there is no C compiler, if it rejects the source, or if a library cannot be loaded.
    """
    if name not in _loaded:
        for attempt in (1, 2, 3):
            parts = begin(name)
            del _begun[name]
            try:
                _loaded[name] = tuple(ctypes.CDLL(str(part.path())) for part in parts)
                break
            except OSError as error:  # another process may have cleared the cache in the meantime
                if attempt == 3 or all(part.path().exists() for part in parts):
                    raise CompilerError(f"the compiled closed form {name!r} cannot be loaded: {error}") from error
    return _loaded[name]


def times_of(t: ArrayLike) -> Floats:
    """Return times, s, as a vector of doubles.

    Raises
    ------
    InputError
        If the times are not a finite number or a sequence of finite numbers.
    """
    try:
        times = np.ascontiguousarray(t, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"t: expected times in s, a number or a sequence, got {show(t)}") from None
    if times.ndim > 1:
        raise InputError(f"t: expected times in s, a number or sequence, got an array of shape {times.shape}")
    times = times.reshape(-1)
    if not isfinite(np.add.reduce(times)) and not np.isfinite(times).all():
        raise InputError(f"t: expected finite times in s, got {times[~np.isfinite(times)][0]}")
    return times

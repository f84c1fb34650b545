"""Compile the closed forms: one C file with the headers it includes, once, and load it.

Error-free arithmetic needs every rounding as written: contraction is off, and each prepared motion first asks the
compiled code whether that is so.
"""

import ctypes
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.codegen import library
from symrot.errors import CompilerError, InputError

__all__ = ["FLAGS", "Floats", "address", "load", "source", "times_of"]

Floats = NDArray[np.float64]

FLAGS = (
    "-std=c99",
    "-O2",
    library.NATIVE,
    "-ffp-contract=off",  # double-double arithmetic counts on every rounding
    "-fno-math-errno",  # sqrt in one instruction
    "-fno-tree-slp-vectorize",  # it slows long straight-line code
    "-fno-trapping-math",  # loops with comparisons become SIMD code
    "-fPIC",
    "-shared",
)

_loaded: dict[str, Any] = {}


def source(name: str) -> str:
    """Return the text of ``name.c`` with its headers put in, each once: a whole translation unit."""
    here, seen = Path(__file__).parent, set()

    def text(file: str) -> str:
        seen.add(file)
        lines = []
        for line in (here / file).read_text(encoding="utf-8").splitlines():
            included = line.split('"')[1] if line.startswith('#include "') else ""
            if included not in seen:
                lines.append(text(included) if included else line)
        return "\n".join(lines)

    return text(f"{name}.c") + "\n"


def load(name: str) -> Any:
    """Return the loaded library of ``name.c``.

    Raises
    ------
    CompilerError
        If there is no C compiler, or the library cannot be loaded.
    """
    if name not in _loaded:
        path = library.build(source(name), f"closed_form_{name}", FLAGS)
        try:
            _loaded[name] = ctypes.CDLL(str(path))
        except OSError as error:
            raise CompilerError(f"the compiled library {path} cannot be loaded: {error}") from error
    return _loaded[name]


def times_of(t: ArrayLike) -> Floats:
    """Return times as a vector of doubles.

    Raises
    ------
    InputError
        If they are not finite numbers in a sequence.
    """
    times = np.ascontiguousarray(t, dtype=np.float64)
    if times.ndim > 1:
        raise InputError(f"times are a number or a sequence of numbers (s), got an array of shape {times.shape}")
    times = times.reshape(-1)
    if not isfinite(times.sum()) and not np.isfinite(times).all():
        raise InputError(f"times must be finite, got {times[~np.isfinite(times)][0]}")
    return times


def address(array: Floats | None) -> int | None:
    """Return where an array begins; NumPy's `ctypes` attribute takes four times as long."""
    if array is None:
        return None
    place: int = array.__array_interface__["data"][0]
    return place

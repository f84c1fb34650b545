"""Do two C texts of a kernel compute the same bits? Run both, where reading cannot tell, as for x*x and (-x)*(-x)."""

import ctypes
from collections.abc import Mapping
from random import Random
from typing import Any

import numpy as np

from symrot.build import cache as library
from symrot.errors import CompilerError

__all__ = ["same_bits"]

FLAGS = ("-std=c99", "-O1", "-ffp-contract=off", "-fPIC", "-shared")
SAMPLES, RUNS = 3, 20


def same_bits(files: Mapping[str, str], name: str, other: str, data: Mapping[str, Any], random: Random) -> bool:
    """Return whether all functions of NAME.c and of another text of this file give the same bits at random points.

    Parameters
    ----------
    files : mapping of str to str
        The texts of NAME.c and of what it includes, by the names in its ``#include``.
    name : str
        The kernel.
    other : str
        The other text of NAME.c; if it does not compile, the result is False.
    data : mapping
        The kernel's certificate: its functions, places of inputs and outputs.
    """
    try:
        first, second = (_loaded(text, files) for text in (files[f"{name}.c"], other))
    except CompilerError:
        return False
    inputs = [place for place, *_ in data["inputs"]]
    places = [*inputs, *(place for place, *_ in data["spec"]["formulas"])]
    for function, readback in data["readback"].items():
        kind = np.float32 if readback["type"] == "float" else np.float64
        for many in (0, SAMPLES):
            for _ in range(RUNS):
                arrays: dict[str, list[float]] = {}
                for place in places:
                    base = place.partition("[")[0]
                    count = 1 if base == "p" or not many else many
                    drawn = [random.uniform(-2, 2) for _ in range(count)]
                    arrays.setdefault(base, []).extend(drawn if place in inputs else [0.0] * count)
                outputs = [_called(loaded, function, arrays, places, kind, many) for loaded in (first, second)]
                if outputs[0] != outputs[1]:
                    return False
    return True


def _loaded(text: str, files: Mapping[str, str]) -> ctypes.CDLL:
    for file, content in files.items():
        text = text.replace(f'#include "{file}"', content)
    return ctypes.CDLL(str(library.build(text, "same_bits", FLAGS)))


def _called(
    loaded: ctypes.CDLL, name: str, arrays: Mapping[str, list[float]], places: list[str], kind: Any, many: int
) -> list[bytes]:
    """Return the contents of the arrays after a call for one sample, or for many."""
    real = ctypes.c_float if kind is np.float32 else ctypes.c_double
    held = {base: np.array(values, kind) for base, values in arrays.items()}
    arguments: list[Any] = [ctypes.c_size_t(many)] if many else []
    for base, values in held.items():
        plain = base in places and not many  # a number by itself
        arguments.append(real(values[0]) if plain else ctypes.c_void_p(values.ctypes.data))
    getattr(loaded, f"{name}_batch" if many else name)(*arguments)
    return [values.tobytes() for values in held.values()]

"""Addresses of the functions that heyoka compiles, so that its machine code is timed in the same loops as other
code.
"""

import ctypes
import subprocess
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from symrot.bench.by_hand.kernel_peers import input_names, textbook_program
from symrot.build import cache as build_cache

__all__ = ["LANES", "heyoka_code"]

LANES = 4  # number of doubles that heyoka's batch functions process at once
_LOADED = Path("/proc/self/maps")


@cache
def _function(name: str) -> Any:
    """Return heyoka's compiled function of the textbook formulas for the kernel ``name``.

    The function can also compute ``LANES`` samples at once, in a SIMD vector.
    """
    import heyoka

    variables = dict(zip(input_names(name), heyoka.make_vars(*input_names(name)), strict=True))
    functions = {each: getattr(heyoka, each) for each in ("sin", "cos", "tan", "sqrt")}
    formulas = textbook_program(name).evaluate(variables, functions, float)
    outputs = [heyoka.expression(each) if isinstance(each, float) else each for each in formulas.values()]
    return heyoka.cfunc(outputs, list(variables.values()), fast_math=True, batch_size=LANES)


def heyoka_code(name: str) -> tuple[Any, Any, Any]:
    """Return the addresses of the three functions that heyoka compiles for a kernel.

    The first computes one sample whose inputs, and outputs, are adjacent in memory. The two others compute samples of a
    batch, in which component i of sample k of n has the index i*n + k: the second computes one sample, and the third
    computes ``LANES`` adjacent samples in a SIMD vector.

    Raises
    ------
    ImportError
        If heyoka is not installed, or the system has no file /proc/self/maps, in which heyoka's library is looked up.
    """
    # The object code is linked without change; its sines come from the library that heyoka has loaded.
    states = _function(name).llvm_states
    if not _LOADED.exists():
        raise ImportError(
            f"expected the file {_LOADED}, in which symrot looks up where the library of heyoka lies; this system "
            "lacks the file, so heyoka cannot be measured on it"
        )
    for line in _LOADED.read_text(encoding="utf-8").splitlines():
        if "/libheyoka" in line:
            ctypes.CDLL(line.split(maxsplit=5)[5], ctypes.RTLD_GLOBAL)
            break
    with TemporaryDirectory() as directory:
        return tuple(_linked(Path(directory), index, state.object_code) for index, state in enumerate(states))


def _linked(directory: Path, index: int, code: bytes) -> Any:
    """Link heyoka's object code into a shared library in ``directory``; return the address of the function.

    ``index`` is part of the library's file name.
    """
    (directory / f"{index}.o").write_bytes(code)
    made = directory / f"{index}.so"
    subprocess.run(
        [*build_cache.compiler().command, "-shared", "-o", made, directory / f"{index}.o", "-lm"], check=True
    )
    return ctypes.cast(ctypes.CDLL(str(made)).cfunc, ctypes.c_void_p)

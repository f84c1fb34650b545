"""Loading of emitted NumPy kernels: the text is written to a file and imported as a module, as a user would do it."""

from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.formula.program import Program

__all__ = ["load_numpy_kernel"]

_UNNAMED = Description(
    "kernel of a scene", "all states", "derivations/euler_equations.md", "symrot emit --target numpy"
)


def load_numpy_kernel(program: Program) -> Callable[..., Any]:
    """Return the Python function that computes a program's outputs: its emitted NumPy text, imported as a module."""
    with TemporaryDirectory(prefix="symrot-") as directory:
        path = Path(directory) / f"{program.signature.name}.py"
        path.write_text(numpy_source(program, _UNNAMED), encoding="utf-8")
        spec = spec_from_file_location(program.signature.name, path)
        assert spec is not None and spec.loader is not None
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
    function: Callable[..., Any] = getattr(module, program.signature.name)
    return function

"""Loading of emitted NumPy kernels: the text is written to a file and imported as a module, as a user would do it."""

from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.formula.program import Program

__all__ = ["UNNAMED", "function_in", "load_numpy_kernel"]

UNNAMED = Description("kernel of a scene", "all states", "derivations/euler_equations.md", "symrot emit --target numpy")
"""Texts, without the name of a scene, for the head comment of a kernel that is only imported and that nobody reads."""


def load_numpy_kernel(program: Program) -> Callable[..., Any]:
    """Return the Python function that computes a program's outputs: its emitted NumPy text, imported as a module."""
    return function_in(numpy_source(program, UNNAMED), program.signature.name)


def function_in(text: str, name: str) -> Callable[..., Any]:
    """Return the function ``name`` of the Python module whose text is ``text``."""
    with TemporaryDirectory(prefix="symrot-") as directory:
        path = Path(directory) / f"{name}.py"
        path.write_text(text, encoding="utf-8")
        spec = spec_from_file_location(name, path)
        assert spec is not None and spec.loader is not None
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
    function: Callable[..., Any] = getattr(module, name)
    return function

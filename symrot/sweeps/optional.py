"""Packages that only some sweeps need; they are imported when they are used."""

from importlib import import_module
from typing import Any

from symrot.errors import InputError

__all__ = ["optional"]


def optional(name: str, where: str, extra: str = "sweep") -> Any:
    """Return the module ``name`` of an optional package, such as ``"xarray"``.

    The error names ``where`` it is needed and ``symrot[extra]``, which installs it.

    Raises
    ------
    InputError
        If the package is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise InputError(
            f"{where}: expected {package}, but it is not installed; install it with pip install 'symrot[{extra}]'"
        ) from None

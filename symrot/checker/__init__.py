"""Verdicts on formulas. The functions ``check``, ``check_file`` and ``identify`` are loaded on first use."""

from importlib import import_module
from typing import Any

_HOME = {
    "check": "interface",
    "check_file": "interface",
    "Verdict": "verdict",
    "identify": "recognition.identification",
}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

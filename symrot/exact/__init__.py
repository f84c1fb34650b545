"""Exact decision of whether two formulas are equal at all real points where both are defined."""

from importlib import import_module
from typing import Any

# imported on first use: ``import symrot`` must not load SymPy
_HOME = {"normal_form": "decide", "is_zero": "decide", "Decision": "decision"}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""Exact decision whether two formulas are equal at all real points where both are defined.

``normal_form``, ``is_zero`` and ``Decision`` are imported here on first use; the function ``decide`` is in
:mod:`symrot.exact.decide`.
"""

from importlib import import_module
from typing import Any

_HOME = {"normal_form": "decide", "is_zero": "decide", "Decision": "decision"}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

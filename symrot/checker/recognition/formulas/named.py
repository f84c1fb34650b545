"""A formula with its name and its source, as the modules of this folder yield them."""

from typing import Any

__all__ = ["Named"]

Named = tuple[str, str, Any]
"""The name of a formula, the page or call that derives it, and its SymPy value."""

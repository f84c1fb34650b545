"""Exact decision of equality (see ``derivations/`` and the module docstrings)."""

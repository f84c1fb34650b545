"""Lowering: translation of SymPy formulas into straight-line programs with few operations."""

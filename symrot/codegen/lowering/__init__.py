"""Lowering: SymPy formulas are turned into straight-line programs with few operations."""

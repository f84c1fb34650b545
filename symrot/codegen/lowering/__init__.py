"""Lowering: translation of SymPy formulas into straight-line programs (lists of assignments) with few operations."""

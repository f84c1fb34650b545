"""Formulas as trees, exact numbers, straight-line programs, functions with jumps; mpmath where needed."""

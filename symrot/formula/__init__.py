"""Formulas as trees, exact numbers, straight-line programs, functions with jumps. Standard library only."""

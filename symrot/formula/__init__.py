"""Formulas as trees, exact numbers, straight-line programs, and functions with jumps. Standard library only."""

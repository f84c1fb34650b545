"""Formulas as trees, exact numbers, straight-line programs, and functions that jump. Standard library only."""

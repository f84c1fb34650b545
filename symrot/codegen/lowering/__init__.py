"""From formulas of SymPy to straight-line programs with few operations."""

"""Claims: their text read into trees, and trees interpreted as formulas of SymPy."""

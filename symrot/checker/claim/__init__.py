"""Claims (equations that a user wants checked): their text is parsed into trees, the trees become SymPy formulas."""

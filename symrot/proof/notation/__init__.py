"""How formulas are written on a page: SymPy to LaTeX, LaTeX to MathML, LaTeX read back as SymPy."""

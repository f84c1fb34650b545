"""Translate the formulas of a page: SymPy to LaTeX, LaTeX to MathML, and LaTeX back to SymPy."""

"""Translations of the formulas on a page: SymPy to LaTeX, LaTeX to MathML, and LaTeX back to SymPy."""

"""The parser of LaTeX formulas: tokens, the tree of a formula, and a cursor that moves through the tree.

The tree describes how a formula is written. Its meaning comes from interpreters: the checker (claims), derivations
(SymPy expressions) and pages (MathML).
"""

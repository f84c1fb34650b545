"""The parser of LaTeX formulas: tokens, the tree of a formula, and a cursor that moves through the tree.

The tree describes how a formula is written, not what it means. Three interpreters give it a meaning: the checker turns
it into claims (:mod:`symrot.checker.latex`), derivations turn it into SymPy expressions
(:mod:`symrot.proof.notation.latex_reader`), and pages turn it into MathML (:mod:`symrot.proof.notation.mathml`).
"""

"""The reader of LaTeX formulas: tokens, the tree of a formula, and the cursor that moves through the tree.

The tree describes how a formula is written, not its meaning. Three interpreters read it: the checker makes claims
(:mod:`symrot.checker.latex`), derivations make SymPy expressions (:mod:`symrot.proof.notation.latex_reader`), and pages
make MathML (:mod:`symrot.proof.notation.mathml`).
"""

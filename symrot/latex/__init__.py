"""The reader of LaTeX formulas: tokens, the tree of what is written, and the cursor that interpreters move along it.

The tree says how a formula is written and nothing about its meaning. Three interpreters give it one: the checker makes
claims (:mod:`symrot.checker.latex`), the derivations make SymPy (:mod:`symrot.proof.notation.latex_reader`), and the
pages make MathML (:mod:`symrot.proof.notation.mathml`).
"""

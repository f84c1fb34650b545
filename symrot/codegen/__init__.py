"""Code generation: proven formulas become straight-line programs, which are printed as C, NumPy, JAX or JavaScript.

A straight-line program is a list of assignments without loops and branches: first temporaries (intermediate results),
then outputs. A kernel is a program together with the code that is printed from it.
"""

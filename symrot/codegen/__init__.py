"""Code generation: from proven formulas to straight-line programs, and from programs to C and NumPy text.

A straight-line program is a list of assignments without loops and branches: first temporaries (intermediate results),
then outputs. A kernel is a program together with the code that is printed from it.
"""

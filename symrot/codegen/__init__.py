"""Code generation: from proven formulas to straight-line programs, and from programs to C and NumPy text."""

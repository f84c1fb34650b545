"""The library of kernels, whose formulas are derived from their names; :mod:`symrot.codegen` prints them."""

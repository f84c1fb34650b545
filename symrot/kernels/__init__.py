"""The library of kernels: definitions whose formulas are derived from the kernel's name.

:mod:`symrot.codegen` prints them as code.
"""

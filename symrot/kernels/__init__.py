"""The library of kernels: small computations of attitude, dynamics and inertia, whose formulas symrot derives.

Each kernel is a definition; :mod:`symrot.codegen` prints it as C or NumPy code.
"""

"""The library of kernels: small computations of attitude, dynamics and inertia, whose formulas symrot derives.

Each kernel has a definition, which :mod:`symrot.codegen` prints as C or NumPy code.
"""

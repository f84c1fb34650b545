"""The functions behind symrot's commands: emit, certify, audit and bound kernels, print derivations, check the
installation.
"""

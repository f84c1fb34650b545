"""The functions behind the commands: they emit, certify, audit and bound kernels, print derivations, check the install.

The public functions symrot.emit, certify, audit, bound and plan, among others, are defined here.
"""

"""The work behind the commands that emit, certify, audit and bound kernels, print derivations and check the install.

Some of these functions are public.
"""

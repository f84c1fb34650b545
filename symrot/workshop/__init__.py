"""The functions that emit, certify, audit and bound kernels and that check an installation, for the command line."""

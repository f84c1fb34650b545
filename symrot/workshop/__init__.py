"""The functions behind the commands that emit, certify, audit and bound kernels, and that check an installation."""

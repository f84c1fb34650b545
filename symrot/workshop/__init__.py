"""The functions behind the commands that emit, certify, audit and bound kernels, print derivations, check the
install."""

"""The functions behind the commands: they emit, certify, audit and bound kernels, print derivations, check the
install."""

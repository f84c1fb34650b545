"""The work behind the commands: emit, certify, audit and bound kernels, and check an installation."""

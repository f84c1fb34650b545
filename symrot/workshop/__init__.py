"""The work behind the commands: emit kernels, certify and audit them, bound their errors, look after an
installation."""

"""Vectors, matrices, quaternions and complex numbers in texts that do not define their components."""

"""Vectors, matrices, quaternions and complex numbers that a text uses without a definition."""

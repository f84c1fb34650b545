"""Printing of programs as C, NumPy, JAX and JavaScript text."""

"""Printing of programs as C and NumPy text."""

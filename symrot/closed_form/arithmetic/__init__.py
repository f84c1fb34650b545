"""Arithmetic on pairs of doubles, in C and in Python, and the functions that all closed forms share."""

"""Arithmetic that all closed forms use: exact numbers, sums of two doubles (double-double), and changes of axes."""

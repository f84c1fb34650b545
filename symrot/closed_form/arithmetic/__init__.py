"""Pairs of doubles, in C and in Python, and what the closed forms share."""

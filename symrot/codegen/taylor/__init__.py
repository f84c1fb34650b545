"""Recurrences of Taylor coefficients, and C code that computes them, for one motion or for many motions at once."""

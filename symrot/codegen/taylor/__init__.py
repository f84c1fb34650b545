"""Recurrences of Taylor coefficients, and C code that computes the coefficients, for one motion or for many at once."""

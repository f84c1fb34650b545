"""Recurrences of Taylor coefficients, and their C: for one motion and for lanes of motions."""

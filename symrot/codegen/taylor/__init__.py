"""Recurrences of Taylor coefficients, and C text that computes them for one motion or for many in SIMD lanes."""

"""Recurrences of Taylor coefficients and C text that computes them, for one motion and for many motions in SIMD
lanes.
"""

"""Sweeps: many motions of one scene with varied values.

They are computed in chunks, and a store collects the results.
"""

"""Propagation of scenes: the choice of a method, steppers in C and SciPy, events, switches, and trajectories."""

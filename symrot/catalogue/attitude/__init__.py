"""Attitude: rotation matrices, axis and angle, composition, Euler parameters."""

"""Equations of motion: Euler's and Lagrange's, work and power, impulse and momentum, planar motion."""

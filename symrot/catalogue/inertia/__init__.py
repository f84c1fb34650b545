"""Inertia: angular momentum, kinetic energy, parallel axes, rotation of the tensor, standard solids."""

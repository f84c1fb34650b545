"""Bounds of the rounding errors of a kernel's outputs on a box of inputs."""

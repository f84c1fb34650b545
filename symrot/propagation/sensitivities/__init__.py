"""Derivatives of a motion with respect to its initial values and the constants of its scene."""

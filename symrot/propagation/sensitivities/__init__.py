"""Derivatives of a motion by its initial values and by the constants of its scene."""

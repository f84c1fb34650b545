"""Bounds of the rounding errors of a kernel's outputs, valid for all inputs in a box (a product of ranges)."""

"""Certificates of exact steps: C code computes the exact motion, and bounds of its rounding errors are proven."""

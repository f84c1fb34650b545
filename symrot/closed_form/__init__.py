"""Exact motions: rotations at any time without stepping."""

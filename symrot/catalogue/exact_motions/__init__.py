"""Exact motions: elliptic functions and the motions in closed form."""

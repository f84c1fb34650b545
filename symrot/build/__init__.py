"""Compile C, keep the result in the user's cache, load it."""

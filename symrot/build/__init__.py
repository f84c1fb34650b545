"""Compile C and store the shared libraries in the user's cache."""

"""Compilation of C, and the cache that stores the shared libraries for the user."""

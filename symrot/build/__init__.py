"""Compilation of C into shared libraries, and the cache that stores them for the user."""

"""Compilation of C into shared libraries, and the cache that stores the libraries for the user."""

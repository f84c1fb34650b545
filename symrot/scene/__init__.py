"""Scenes: descriptions of a body, its torques and its initial state, read from files and checked."""

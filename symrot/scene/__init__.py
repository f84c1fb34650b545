"""Scenes: read, checked and kept as exact numbers."""

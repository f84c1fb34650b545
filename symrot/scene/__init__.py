"""Scenes: problems as data, read, checked and stored as exact numbers."""

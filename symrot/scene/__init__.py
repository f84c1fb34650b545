"""Scenes: problems of rotation as data, read from files, checked, and stored as exact numbers."""

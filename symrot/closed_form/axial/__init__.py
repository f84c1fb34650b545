"""Rotation driven and damped about one axis."""

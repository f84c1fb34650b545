"""Closed-form motion of a body driven and damped about one axis."""

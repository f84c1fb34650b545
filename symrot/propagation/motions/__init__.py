"""Motions: the equations of a scene with numbers and one initial state; they give the states at any time."""

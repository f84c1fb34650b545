"""Motions under torques that jump or bend."""

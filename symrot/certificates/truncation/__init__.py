"""Bounds of the truncation error of one time step: the difference between the exact motion and the step's formula."""
